# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ears of a cup that is drawn from a sheet with Hill's anisotropy, in closed form: each ring of the flange is
compressed along its circumference alone, and its r-value says how it grows along the radius. Limits are rings
of the same strain all around, and of the same stress. Bending, holder, friction and radial tension are left
out."""

from __future__ import annotations

import math
from typing import NamedTuple, Sequence

import numpy
from numpy.typing import NDArray

Array = NDArray[numpy.float64]
QUARTER: Array = numpy.radians(numpy.linspace(0, 90, 91))


class Cup(NamedTuple):
    """Radius of the blank and of the wall [length]; r-values at 0, 45 and 90 degrees to the rolling direction
    x; the flow stress is proportional to (prestrain + plastic strain)^exponent. Angles are those of the
    radius to x [radians]."""

    blank: float
    wall: float
    r_values: Sequence[float]
    prestrain: float = 0.007117  # mild steel of NUMISHEET'93
    exponent: float = 0.2589

    def coefficients(self) -> tuple[float, float, float, float]:
        """F, G, H and N of Hill's function."""
        r0, r45, r90 = self.r_values
        g, h, f = 1 / (1 + r0), r0 / (1 + r0), r0 / (r90 * (1 + r0))
        return f, g, h, (f + g) * (1 + 2 * r45) / 2

    def r_value(self, angle: float) -> float:
        """Ratio of the strains across a tension in this direction: in the sheet over through it."""
        f, g, h, n = self.coefficients()
        s2, c2 = math.sin(angle) ** 2, math.cos(angle) ** 2
        return (h + (2 * n - f - g - 4 * h) * s2 * c2) / (f * s2 + g * c2)

    def strength(self, angle: float) -> float:
        """Yield stress in this direction over that along x."""
        f, g, h, n = self.coefficients()
        s2, c2 = math.sin(angle) ** 2, math.cos(angle) ** 2
        return 1 / math.sqrt(f * s2**2 + g * c2**2 + h * (c2 - s2) ** 2 + 2 * n * s2 * c2)

    def share(self, angle: float) -> float:
        """Share of the radial strain in what the compression along the circumference displaces."""
        r = self.r_value(angle + math.pi / 2)
        return r / (1 + r)

    def height(self, angle: float) -> float:
        """Height of the wall when all of the flange is drawn in [length], rings of the same strain: the
        integral of the radial stretch (R/wall)^share over the flange."""
        m = self.share(angle) + 1
        return self.wall * ((self.blank / self.wall) ** m - 1) / m

    def draw_in(self, angle: float, depth: float) -> float:
        """Travel of the rim when the wall is so deep [length], rings of the same strain: of the integral of
        r^share dr = R^share dR."""
        m = self.share(angle) + 1
        return self.blank - (self.blank**m - m * depth * self.wall ** (m - 1)) ** (1 / m)

    def draw_ins(self, mean: float) -> tuple[float, float, float]:
        """Draw-in at 0, 45 and 90 degrees at the depth at which their mean is this [length]."""
        low, high = 0.0, min(self.height(math.radians(angle)) for angle in (0, 45, 90))
        for _ in range(60):
            depth = (low + high) / 2
            x, diagonal, y = (self.draw_in(math.radians(angle), depth) for angle in (0, 45, 90))
            low, high = (depth, high) if x + diagonal + y < 3 * mean else (low, depth)
        return x, diagonal, y

    def stretches_of_same_stress(self, means: Array) -> Array:
        """Radial stretch along a quarter of each ring, by the mean compression of rings whose stress is the
        same all around."""
        share = numpy.array([self.share(angle) for angle in QUARTER])
        strength = numpy.array([self.strength(angle + math.pi / 2) for angle in QUARTER])
        stress = numpy.linspace(0, 2, 4001)[:, None]  # over the flow stress at a strain of 1 - prestrain
        flow = (stress / strength) ** (1 / self.exponent) - self.prestrain
        strains = numpy.maximum(flow, 0) / strength
        found = [numpy.interp(means, strains.mean(axis=1), column) for column in strains.T]
        stretches: Array = numpy.exp(share * numpy.transpose(found))
        return stretches

    def heights_of_same_stress(self) -> Array:
        """Heights at the angles of QUARTER as of height(), but of rings of the same stress."""
        radii = numpy.linspace(self.wall, self.blank, 201)
        stretches = self.stretches_of_same_stress(numpy.log(radii / self.wall))
        heights: Array = numpy.trapz(stretches, radii, axis=0)
        return heights

    def draw_ins_of_same_stress(self, mean: float) -> tuple[float, float, float]:
        """Returns the draw-in as draw_ins() does, but for rings of the same stress."""
        logs = numpy.linspace(0, math.log(self.blank / self.wall), 1001)
        stretches = self.stretches_of_same_stress(logs)
        step = (self.blank - self.wall) / 400
        low, high = 0.0, float(self.heights_of_same_stress().min())
        for _ in range(30):
            depth = (low + high) / 2
            height, radius = numpy.zeros_like(QUARTER), numpy.full_like(QUARTER, self.wall)
            for i in range(400):
                ring = math.log((self.wall + (i + 0.5) * step) / radius.mean())
                growth = step * stretches[min(1000, round(1000 * ring / logs[-1]))]
                to_wall = numpy.clip(depth - height, 0, growth)
                height, radius = height + to_wall, radius + growth - to_wall
            x, diagonal, y = self.blank - radius[::45]
            low, high = (depth, high) if x + diagonal + y < 3 * mean else (low, depth)
        return float(x), float(diagonal), float(y)
