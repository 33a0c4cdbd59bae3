#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: sheet_scenes.py BILLET

Runs sheets that are bent and spring back in an empty current folder: pure bending beside its closed form,
and a coarse and short variant of the shipped U-bend beside what strip theory says. The scenes themselves run
in benchmarks, the free bend only there. cup_scenes.py runs the cups.
"""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path

from checks import HERE, SHIPPED, Checks, enter_folder, equal, near, require, run
from pure_bending_theory import MILD_STEEL, bend_and_release, changes, read_release
from shipped import require_page, require_short, run_variant

THREE_SHEETS = str(HERE / "three_sheets.prm")
program = sys.argv[1]
check = Checks()
enter_folder()


def slope(row: dict[str, float], i: int) -> float:
    """Angle of the line of a scene between the points i and i + 1 of its probe, against x [degrees]."""
    x, y = (row[f"line.{i + 1}.position_{c}"] - row[f"line.{i}.position_{c}"] for c in "xy")
    return math.degrees(math.atan2(y, x))


@check("moment and springback of pure bending are those of the closed form")
def _() -> None:
    for radius in (20.0, 50.0):
        exact = bend_and_release(MILD_STEEL, radius)
        for layers, points, tolerance in ((1, 7, 2e-2), (2, 5, 5e-3)):
            name = f"bent_{radius:g}_{layers}"
            rows = run_variant(program, str(HERE / "pure_bending.prm"), name, changes(radius, layers, points))
            moment, part = read_release(rows)
            near(f"{name}: moment", moment, exact[0], tolerance)
            near(f"{name}: springback", part, exact[1], tolerance)


@check("the wall of the U-bend bears what friction and bending take, and springs back")
def _() -> None:
    rows = run_variant(
        program,
        str(SHIPPED / "u_bend.prm"),
        "u_bend",
        {
            "Bodies/strip/Mesh/Arguments": "132, 1 : 0, 0 : 132, 0.78",
            "Bodies/strip/Mesh/Positions": "2*min(x, 9) + max(0, min(x, 99) - 9) + 2*max(0, x - 99) ; y ; z",
            "Tools/punch/Motion/Translation": "0 ; -14*t ; 0",
        },
    )
    steady = [abs(row["punch.force_y"]) for row in rows if 0.9 < row["time"] <= 1]
    # Friction on both faces of the flange, bending and unbending over the die, and friction there (Swift).
    moment, capstan = bend_and_release(MILD_STEEL, 5.39)[0], math.exp(0.144 * math.pi / 2)
    theory = (2 * 0.144 * 35 + moment / 5.39) * capstan + moment / 5.39
    near("force of the punch", sum(steady) / len(steady), theory, 0.15)
    formed = next(row for row in rows if abs(row["time"] - 1) < 1e-9)
    near("force of the holder", abs(formed["holder.force_y"]), 35.0, 1e-2)
    require(slope(rows[-1], 7) < slope(formed, 7) - 3, "the walls do not open")


@check("a stack of sheets is as stiff as its closed form")
def _() -> None:
    rows = run_variant(program, THREE_SHEETS, "three_sheets", {})
    for row in rows[1:]:
        stretch = 1 - 0.03 * row["time"] / 0.15
        theory = 10 * 1000 * math.log(1 / stretch) / stretch
        near(f"force at time {row['time']}", abs(row["lid.force_y"]), theory, 5e-3)


@check("a sheet that is stretched keeps its penalty, and the force that low penalties reduce")
def _() -> None:
    options: dict[str, object] = {
        "Bodies/blank/Mesh/Refinements": 2,
        "Time stepping/End time": 0.13,
        "Time stepping/Maximum step": 0.005,
    }
    for pair in ("blank on punch", "blank on die"):
        options |= {f"Contact pairs/{pair}/{key}": "" for key in ("Penalty unit", "Normal penalty")}
    scene = str(SHIPPED / "wagoner_punch_mu_0.prm")
    found = run_variant(program, scene, "stretched", options)[-1]["punch.force_z"]
    for tool in ("punch", "die"):
        options[f"Contact pairs/blank on {tool}/Penetration tolerance"] = 1e-5
    stiff = run_variant(program, scene, "stretched_stiff", options)[-1]["punch.force_z"]
    # With 0.03 E/h from the start it is 0.8 % less.
    near("force of the punch", found, stiff, 1e-3)


@check("a sheet with friction converges under tight tolerances; no penalty falls below its start")
def _() -> None:
    left = {
        "Contact pairs/blank on punch": ("Penalty unit", "Normal penalty"),
        "Contact pairs/blank on die": ("Penalty unit", "Normal penalty"),
        "Time stepping": ("Initial step", "Maximum step"),
    }
    rows = run_variant(
        program,
        str(SHIPPED / "wagoner_punch_mu_015.prm"),
        "tight",
        {
            "Profile": "accurate",
            "Bodies/blank/Mesh/Refinements": 2,
            "Time stepping/End time": 0.25,
            **{f"{section}/{key}": "" for section, keys in left.items() for key in keys},
        },
    )
    # It takes 1,738 if nodes that have left a tool rest on it and penalties of 320 E/h fall to 0.04 E/h.
    iterations = sum(row["iterations"] for row in rows)
    require(iterations < 800, f"{iterations} iterations")
    # Whether nodes chatter depends on round-off; what they do then, not.
    fallen = re.findall(r"The penalty is reduced from \d+ to (\S+) E/h", Path("tight/billet.log").read_text())
    require(all(float(penalty) >= 10.0 for penalty in fallen), f"penalties fall to {fallen} E/h")
    near("force of the punch", rows[-1]["punch.force_z"], -2116.7, 1e-3)


@check("--check tells that penalties of pairs with tools may fall, and no others")
def _() -> None:
    told = re.findall(
        r"^Penalty +(.*): may fall to 0\.0390625 E/h",
        run(program, "--check", THREE_SHEETS).output,
        re.MULTILINE,
    )
    equal("pairs", told, [f"s{sheet} on {tool}" for sheet in range(3) for tool in ("floor", "lid")])
    given = run(program, "--check", THREE_SHEETS, "--set", "General contact/Normal penalty=1").output
    require("Penalty" not in given, given)


@check("pages")
def _() -> None:
    for name in ("u_bend", "free_bend"):
        require_short(name)
        require_page(name, name)


sys.exit(check.finish())
