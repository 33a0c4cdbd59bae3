#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: contact_scenes.py BILLET

Runs coarser variants of shipped scenes with contact in an empty current folder, and compares them with what
holds for any mesh, and with theory. The scenes themselves run in benchmarks.
"""

from __future__ import annotations

import sys
from pathlib import Path

from checks import SHIPPED, Checks, enter_folder, equal, near, require
from rolling_theory import force_and_torque
from shipped import Rows, require_page, require_short, run_variant
from snap_fit_theory import INSERTION, REMOVAL, Way, beam_force, design_force, force_ratio

PAGES = {
    "snap_fit": "snap_fit",
    "slab_rolling": "slab_rolling",
    "slab_rolling_explicit": "slab_rolling",
}

program = sys.argv[1]
check = Checks()
enter_folder()


def run_shipped(name: str, folder: str, *changes: str) -> Rows:
    """Runs a shipped scene with changes to its end, and returns its history, in which forces balance."""
    changed = dict(change.split("=", 1) for change in changes)
    return run_variant(program, str(SHIPPED / f"{name}.prm"), folder, changed)


def check_climb(rows: Rows, way: Way, node: str) -> None:
    """Compares the forces on a straight ramp, where one corner of the hook slides, with theory."""
    ratio = force_ratio(way)
    sliding = 0
    for row in rows:
        rise, force = row[f"{node}.displacement_y"], row["catch.force_y"]
        if 0.05 < rise < 0.7:
            sliding += 1
            near("axial over transverse force", -way.push * row["catch.force_x"] / force, ratio, 1e-4)
            near("transverse force, beam", force, beam_force(way, rise), 1e-2)
            # Design guides leave out the moment of the axial force.
            near("transverse force, design guides", force, design_force(way, rise), 0.16)
    require(sliding >= 4, f"only {sliding} steps on the ramp")


@check("the hook climbs the catch as a beam on a wedge with friction")
def _() -> None:
    coarse = "Bodies/clip/Mesh/Arguments=41, 2 : 0, 0 : 20.5, 1"
    rows = run_shipped(
        "snap_fit",
        "snap_in",
        coarse,
        "Time stepping/End time=0.34",
        "Time stepping/Stops=0.3",
        "Time stepping/Maximum step=0.04",
    )
    check_climb(rows, INSERTION, "toe")


@check("it snaps in without a force, and is pulled out as a beam on the steeper ramp")
def _() -> None:
    coarse = "Bodies/clip/Mesh/Arguments=41, 2 : 0, 0 : 20.5, 1"
    rows = run_shipped(
        "snap_fit", "snap_fit", coarse, "Time stepping/End time=1.19", "Time stepping/Maximum step=0.04"
    )
    inside = [row for row in rows if abs(row["time"] - 1) < 1e-9]
    equal("steps at the end of the way in", len(inside), 1)
    equal("force on the catch", abs(inside[0]["catch.force_x"]) + abs(inside[0]["catch.force_y"]), 0.0)
    # Friction dissipates the work of the way.
    near("friction", inside[0]["friction_dissipation"], inside[0]["external_work"], 1e-2)
    # Its largest force is that on a flat ramp, but over the run coarse fillets bear some of it.
    said = " ".join(Path("snap_fit/billet.log").read_text(encoding="utf-8").split())
    require("unknown, since" in said and "of the force of the pair 'hook on catch'" in said, said)
    check_climb([row for row in rows if row["time"] > 1], REMOVAL, "heel")


TURN = 0.35  # of the roll in the whole scene, at a constant rate


def check_rolling(name: str, end: float, *changes: str) -> None:
    """Rolls a part of a coarse and shorter slab, and compares means over what is steady with slab theory."""
    coarse = "Bodies/slab/Mesh/Arguments=14, 2 : -56.16, 0 : -21.16, 5"
    rows = run_shipped(name, name, coarse, f"Time stepping/End time={0.65 * end}", *changes)
    steady = [row for row in rows if row["time"] >= 0.45 * end]
    spans = [after["time"] - before["time"] for before, after in zip(steady, steady[1:])]

    def mean(column: str) -> float:
        return sum(span * row[column] for span, row in zip(spans, steady[1:])) / sum(spans)

    def gain(column: str) -> float:
        return steady[-1][column] - steady[0][column]

    force, torque = force_and_torque()
    near("force of the roll", -mean("roll.force_y"), force, 4e-2)
    near("torque of the roll", mean("roll.moment_z"), torque, 4e-2)
    # Friction alone draws the slab, and the roll's work is all that goes into it.
    work = mean("roll.moment_z") * TURN * gain("time") / end
    near("plastic work and friction", gain("plastic_work") + gain("friction_dissipation"), work, 5e-3)
    require(abs(mean("roll.force_x")) < 0.01 * force, f"the roll pushes with {mean('roll.force_x')}")


@check("friction draws the slab in, with the force and torque of slab theory")
def _() -> None:
    check_rolling("slab_rolling", 1.0)


@check("so it does in explicit dynamics")
def _() -> None:
    heavy = "Bodies/slab/Material/Density=3e-8"  # in half the steps; rho v^2 is 0.3 % of the yield stress
    check_rolling("slab_rolling_explicit", 10.5e-3, heavy)


@check("pages")
def _() -> None:
    for name, page_name in PAGES.items():
        require_short(name, counts_included=True)
        require_page(name, page_name)


sys.exit(check.finish())
