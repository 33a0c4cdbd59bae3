#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: cup_scenes.py BILLET

Draws cups in an empty current folder: coarse and short variants of the shipped ones, beside the closed form
of ears. The scenes themselves run in benchmarks.
"""

from __future__ import annotations

import math
import sys

from checks import SHIPPED, Checks, enter_folder, near, require
from earing_theory import Cup
from shipped import require_page, require_short, run_variant

program = sys.argv[1]
check = Checks()
enter_folder()


def cup_draw_in(folder: str, r_values: tuple[float, float, float]) -> tuple[float, float, float]:
    """Draw-in at 0, 45 and 90 degrees to the rolling direction, after a tenth of the travel."""
    last = run_variant(
        program,
        str(SHIPPED / "cylindrical_cup.prm"),
        folder,
        {
            "Bodies/blank/Mesh/Arguments": "16, 6, 1 : 0, 0, 0 : 24, 1, 1",
            "Bodies/blank/Material/r-values": ", ".join(map(str, r_values)),
            "Tools/holder/Motion/Removal time": "",
            "Tools/holder/Motion/Release time": "",
            "Time stepping/End time": 0.1,
        },
    )[-1]
    near(f"{folder}: force of the holder", abs(last["holder.force_z"]), 20e3, 1e-2)
    diagonal = math.hypot(last["rim_45.displacement_x"], last["rim_45.displacement_y"])
    return -last["rim_0.displacement_x"], diagonal, -last["rim_90.displacement_y"]


@check("the flange of a cup is drawn in by Hill's anisotropy as the closed form of ears says")
def _() -> None:
    r_values = (1.73, 1.34, 2.24)
    found = cup_draw_in("anisotropic", r_values)
    theory = Cup(100, 50.5, r_values).draw_ins_of_same_stress(sum(found) / 3)
    valley, expected = (dd - (dx + dy) / 2 for dx, dd, dy in (found, theory))
    near("draw-in along the diagonal less that along the axes", valley, expected, 0.2)
    round_one = cup_draw_in("isotropic", (1, 1, 1))
    spread = max(round_one) - min(round_one)
    require(spread < 0.01 * (max(found) - min(found)), f"the isotropic flange is not round by {spread}")


@check("the square cup begins symmetric about its diagonal")
def _() -> None:
    # benchmarks/square-cup.py draws it to the end, beside the experiment.
    rows = run_variant(
        program, str(SHIPPED / "square_cup.prm"), "square_cup", {"Time stepping/End time": 2e-4}
    )
    require(rows[-1]["punch.travel_z"] < -0.2, f"the punch has gone {rows[-1]['punch.travel_z']}")
    for row in rows:
        across = abs(row["corner.displacement_x"] - row["corner.displacement_y"])
        require(across <= 1e-9, f"the corner moves {across} off the diagonal")
    require(rows[-1]["plastic_work"] > 0, "nothing yields")
    require(abs(rows[-1]["energy_drift"]) < 1e-3, f"energy drifts by {rows[-1]['energy_drift']}")


@check("pages")
def _() -> None:
    for name in ("cylindrical_cup", "square_cup"):
        require_short(name)
        require_page(name, name)


sys.exit(check.finish())
