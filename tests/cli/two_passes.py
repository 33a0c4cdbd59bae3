#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: two_passes.py BILLET LAUNCHER

Presses a block on another one in an empty current folder, with both surfaces as slaves. Probes must show the
whole pressure, not the half that each pass bears, and the area in contact must count once.
"""

from __future__ import annotations

import sys

from checks import Checks, Program, enter_folder, near, require, run
from shipped import history

program = Program(sys.argv[1:])
check = Checks()
enter_folder()
PRESSURE, AREA = 100.0, 100.0
# Areas of facets that do not fit are measured on both sides. Explicit blocks oscillate a little.
STATIC, UNEQUAL, MOVING = 1e-6, 1e-4, 2e-2
FINER = "Bodies/bottom/Mesh/Arguments=3, 3, 2 : 0, 0, 0 : 10, 10, 10"
EXPLICIT = ("Time stepping/Scheme=explicit", "Time stepping/End time=4e-4", "Time stepping/Initial step=")
RAMP = ("Bodies/top/Loads/press/Pressure=100*min(1, 5e3*t)", "Bodies/top/Contact stabilisation=")


def last_row(ranks: int, *changes: str) -> dict[str, float]:
    """Runs the scene with changes, and returns the last row of its history."""
    options = [part for change in changes for part in ("--set", change)]
    ended = run(*program.on(ranks, "two_passes.prm", "--output", "pressed", "--force", *options))
    require(ended.code == 0, ended.output + ended.errors)
    return history("pressed")[-1]


def check_pressures(row: dict[str, float], tolerance: float, is_uniform: bool) -> None:
    """Compares pressures and area with those of the load."""
    near("area", row["pair.contact_area"], AREA, max(tolerance, 1e-3))
    for side in ("above", "below"):
        for statistic in ("least", "mean", "largest") if is_uniform else ("mean",):
            near(f"{side}, {statistic}", row[f"{side}.{statistic}_contact_pressure"], PRESSURE, tolerance)


for method in ("planed", "bilinear"):
    facets = f"Contact pairs/pair/Facets={method}"

    @check(f"equal meshes, {method} facets")
    def _() -> None:
        check_pressures(last_row(1, facets), STATIC, True)

    @check(f"other meshes, {method} facets")
    def _() -> None:
        check_pressures(last_row(1, facets, FINER), UNEQUAL, False)


@check("two ranks")
def _() -> None:
    check_pressures(last_row(2, FINER), UNEQUAL, False)


@check("one pass has the same pressure")
def _() -> None:
    row = last_row(1, "Contact pairs/pair/Passes=one")
    near("pressure", row["above.mean_contact_pressure"], PRESSURE, STATIC)
    near("area", row["pair.contact_area"], AREA, STATIC)


@check("no pressure is negative where slaves slide over the edges of facets")
def _() -> None:
    ended = run(program.path, "glide.prm", "--output", "glided", "--force")
    require(ended.code == 0, ended.output + ended.errors)
    rows = history("glided")
    largest = max(row["bed.largest_contact_pressure"] for row in rows)
    least = min(row["bed.least_contact_pressure"] for row in rows)
    require(largest > 0.1 and least >= 0, f"pressures from {least} to {largest}")


@check("the shear stress of both passes together is limited")
def _() -> None:
    changes = (
        "Contact pairs/foot/Friction law=shear limited",
        "Contact pairs/foot/Maximum shear stress=0.05",
        "Bodies/bed/Material/Young modulus=1000",  # its surface stays flat
    )
    options = [part for change in changes for part in ("--set", change)]
    ended = run(program.path, "glide.prm", "--output", "limited", "--force", *options)
    require(ended.code == 0, ended.output + ended.errors)
    touching = [row for row in history("limited") if row["foot.contact_area"] > 0]
    largest = max(abs(row["foot.force_x"]) / row["foot.contact_area"] for row in touching)
    near("largest shear stress", largest, 0.05, 0.01)


@check("explicit")
def _() -> None:
    check_pressures(last_row(1, *EXPLICIT, *RAMP), MOVING, True)


sys.exit(check.finish())
