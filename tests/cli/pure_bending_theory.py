# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pure bending of a wide sheet with power-law hardening, and its springback: fibres in plane strain."""

from __future__ import annotations

from typing import NamedTuple

import numpy
from numpy.typing import NDArray

Array = NDArray[numpy.float64]


class Sheet(NamedTuple):
    """Isotropic; the flow stress is strength (prestrain + plastic strain)^exponent."""

    young: float
    poisson: float
    strength: float
    prestrain: float
    exponent: float
    thickness: float


MILD_STEEL = Sheet(206e3, 0.3, 565.32, 0.007117, 0.2589, 0.78)  # of pure_bending.prm
TURN, RETURN = 0.01, 0.4  # angle of its end, and the part that it turns back


def changes(radius: float, layers: int, points: int) -> dict[str, object]:
    """Returns changes of pure_bending.prm for a radius, bricks through the thickness and points in each."""
    size = f"0, -0.39, 0 : {TURN * radius!r}, 0.39, 1"
    return {
        "Bodies/strip/Mesh/Arguments": f"1, {layers}, 1 : {size} : true",
        "Bodies/strip/Points through thickness": points,
        "Bodies/strip/Thickness direction": "0 ; 1 ; 0" if points > 2 else "",
    }


def read_release(rows: list[dict[str, float]]) -> tuple[float, float]:
    """Returns the moment of a run when bent, and the part 1 - R/Rf of the curvature until it vanishes."""
    column = "strip.support end.moment_z"
    back = [row for row in rows if row["time"] > 1 - 1e-9]
    bent = back[0][column]
    for before, after in zip(back, back[1:]):
        if after[column] / bent <= 0:
            part = before[column] / (before[column] - after[column])
            return abs(bent), RETURN * (before["time"] + part * (after["time"] - before["time"]) - 1)
    raise ValueError("the moment does not vanish")


class Fibres:
    """Fibres of the upper half of a sheet, at Gauss points of thin layers; the lower half is alike. Stresses
    along the sheet and across it follow J2 plasticity in rates (Hill, The Mathematical Theory of Plasticity,
    1950, ch. II); the stress through the thickness is zero."""

    def __init__(self, sheet: Sheet, n_layers: int) -> None:
        nodes, weights = numpy.polynomial.legendre.leggauss(2)
        height = sheet.thickness / 2 / n_layers
        middles = height * (numpy.arange(n_layers) + 0.5)
        self.sheet = sheet
        self.places: Array = (middles[:, None] + height / 2 * nodes).ravel()
        self.weights: Array = numpy.tile(height / 2 * weights, n_layers)
        self.along, self.across, self.plastic = (numpy.zeros_like(self.places) for _ in range(3))

    def flow_stress(self) -> Array:
        stress: Array = self.sheet.strength * (self.sheet.prestrain + self.plastic) ** self.sheet.exponent
        return stress

    def bend(self, curvature: float) -> float:
        """Adds to the curvature, by an elastic predictor and returns to the yield surface; returns the moment
        per width."""
        sheet = self.sheet
        modulus = sheet.young / (1 - sheet.poisson**2)
        x, z = self.along, self.across
        x += modulus * curvature * self.places
        z += sheet.poisson * modulus * curvature * self.places
        while True:
            mises = numpy.sqrt(x * x - x * z + z * z)
            excess = mises - self.flow_stress()
            yields = excess > 1e-10 * sheet.strength
            if not yields.any():
                return float(2 * (self.weights * x * self.places).sum())
            normal_x, normal_z = (2 * x - z) / (2 * mises), (2 * z - x) / (2 * mises)
            fall_x = modulus * (normal_x + sheet.poisson * normal_z)
            fall_z = modulus * (normal_z + sheet.poisson * normal_x)
            slope = sheet.exponent * self.flow_stress() / (sheet.prestrain + self.plastic)
            flow = numpy.where(yields, excess / (normal_x * fall_x + normal_z * fall_z + slope), 0.0)
            x -= flow * fall_x
            z -= flow * fall_z
            self.plastic += flow


def bend_and_release(
    sheet: Sheet, radius: float, n_layers: int = 200, n_steps: int = 2000
) -> tuple[float, float]:
    """Returns the moment per width at a radius of the middle line, and the part 1 - R/Rf of the curvature
    that springs back until the moment vanishes. Strains are the distance from the middle over the radius."""
    fibres = Fibres(sheet, n_layers)
    step = 1 / radius / n_steps
    bent = [fibres.bend(step) for _ in range(n_steps)][-1]
    moment, n_back = bent, 0
    while True:
        n_back += 1
        before, moment = moment, fibres.bend(-step)
        if moment <= 0:
            return bent, (n_back - 1 + before / (before - moment)) / n_steps
