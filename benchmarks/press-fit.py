# SPDX-License-Identifier: LGPL-2.1-or-later
"""Press fit of two rings: contact pressure and stresses against Lamé, over mesh, with penalty alone and
augmented."""

from __future__ import annotations

import math
import tempfile
from typing import Sequence

import numpy

from billet_runs import ROOT, arguments, number, percent, publish, table
from explicit_runs import ExplicitRun
from billet_tools.output import Array

options = arguments("press-fit")
PAIR = "Contact pairs/fit/"
A, B, C, INTERFERENCE, E, NU = 10.0, 20.0, 30.0, 0.01, 2e5, 0.3
PRESSURE = (
    E
    / (1 - NU**2)
    * INTERFERENCE
    / B
    * (B**2 - A**2)
    * (C**2 - B**2)
    / (2 * B**2 * (C**2 - A**2))
)


def exact(r: Array, sign: float) -> Array:
    """Hoop (sign 1) or radial (sign -1) stress."""
    return numpy.where(
        r < B,
        -PRESSURE * B**2 / (B**2 - A**2) * (1 + sign * A**2 / r**2),
        PRESSURE * B**2 / (C**2 - B**2) * (1 + sign * C**2 / r**2),
    )


def layers(around: int) -> int:
    """Elements across a ring: half as many as around it; of the finest meshes fewer."""
    return max(2, around // (2 if around <= 144 else 8 if around < 250 else 12))


def solve(inner: int, outer: int, tolerance: float) -> tuple[float, float, float, float, float, int] | None:
    """Errors of force, pressures, hoop and radial stresses (root mean squares over the elements) and
    iterations, with so many elements around the quarters; None without a solution."""
    changes = {
        "Bodies/inner/Mesh/Arguments": (
            f"{layers(inner)}, {inner}, 1 : {A}, 0, 0 : {B + INTERFERENCE}, 90, 1 : true"
        ),
        "Bodies/outer/Mesh/Arguments": f"{layers(outer)}, {outer}, 1 : {B}, 0, 0 : {C}, 90, 1 : true",
        PAIR + "Penetration tolerance": tolerance,
        "Output/Step interval": 0,
    }
    with tempfile.TemporaryDirectory() as folder:
        r = ExplicitRun(ROOT / "prm/press_fit.prm", changes, folder, options.ranks)
        if not r.finished:
            return None
        points, fields = r.picture()
    middle = (points - fields["displacement"]).reshape(-1, 8, 3).mean(axis=1)
    stress = {name: fields["stress_" + name].reshape(-1, 8).mean(axis=1) for name in ("xx", "yy", "xy")}
    radius = numpy.hypot(middle[:, 0], middle[:, 1])
    c, s = middle[:, 0] / radius, middle[:, 1] / radius
    hoop = stress["xx"] * s**2 + stress["yy"] * c**2 - 2 * stress["xy"] * s * c
    radial = stress["xx"] * c**2 + stress["yy"] * s**2 + 2 * stress["xy"] * s * c
    touching = fields["contact_area"] > 0
    pressures = fields["contact_pressure"][touching] / PRESSURE - 1

    def deviation(found: Array, sign: float) -> float:
        right = exact(radius, sign)
        return math.sqrt(((found - right) ** 2).mean() / (right**2).mean())

    return (
        abs(r.rows[-1]["fit.force_x"]) / (PRESSURE * B) - 1,
        abs(pressures).max(),
        deviation(hoop, 1),
        deviation(radial, -1),
        r.rows[-1]["fit.contact_area"] / (math.pi / 2 * B),
        int(r.rows[-1]["total_iterations"]),
    )


def rows(pairs: Sequence[tuple[int, int]], tolerance: float) -> list[list[object]]:
    lines: list[list[object]] = []
    last = None
    for inner, outer in pairs:
        found = solve(inner, outer, tolerance)
        if found is None:
            lines.append([f"{inner} in {outer}", *["–"] * 8])
            last = None
            continue
        force, pressure, hoop, radial, area, iterations = found

        def order(now: float, before: float | None) -> str:
            return number(math.log2(before / now), 2) if before else ""

        lines.append(
            [
                f"{inner} in {outer}",
                f"{100 * force:+.2g} %",
                percent(pressure),
                percent(hoop),
                order(hoop, last and last[2]),
                percent(radial),
                order(radial, last and last[3]),
                percent(area, 3),
                iterations,
            ]
        )
        last = found
    return lines


HEAD = [
    "elements around",
    "force",
    "largest of a pressure",
    "hoop stress",
    "order",
    "radial stress",
    "order",
    "area in contact",
    "iterations",
]
SAME = [(n, n) for n in ((8, 16, 32) if options.quick else (8, 16, 32, 64))]
OTHER = [(3 * n, 2 * n) for n in ((6, 12, 24) if options.quick else (6, 12, 24, 48, 96))]
publish(
    "press-fit",
    "Press fit of two rings",
    options,
    (
        "This page compares the pressure and stresses of a press fit with Lamé's. The scene is"
        " `prm/press_fit.prm`: interference 0.01 at a radius of 20, `Initial penetration = ramp`, plane"
        " strain, two steps. A ring has half as many elements across as around (24 of 288 and of 192).\n\n"
        "Errors are those of the force between the halves, of the largest of a node's pressure, and of the"
        " stresses. Those of stresses are root mean squares over elements. Lamé's law is linear and does"
        " not know whose radius is 20; that is some 0.05 % here."
    ),
    "## Meshes that match, penalty alone (10 E/h in series)\n\n" + table(HEAD, rows(SAME, 0)),
    "## The same, augmented to 1e-5 facet sizes\n\n" + table(HEAD, rows(SAME, 1e-5)),
    "## Meshes that do not match, penalty alone\n\n"
    "Faces are flat facets. Chords of different lengths leave their circle by different heights, h²/(8 R),"
    " at 18 facets in 12 more than the interference. They touch where corners are, and fit tighter than the"
    " circles.\n\n"
    "The error of the force falls with the square of the facet size. The pressure becomes smooth only where"
    " h²/(8 R) is smaller than what it takes to press a facet flat, about h p/E.\n\n"
    + table(HEAD, rows(OTHER, 0)),
)
