# SPDX-License-Identifier: LGPL-2.1-or-later
"""The billet in billet and in CalculiX, on the same meshes, alternately."""

from __future__ import annotations

import re
import statistics
import subprocess
from typing import Any, NamedTuple

from billet_runs import (
    PAIR,
    PENALTY,
    PROGRAM,
    Changes,
    Measured,
    Run,
    arguments,
    fixed_steps,
    frictionless_force,
    interpolate,
    mesh,
    n_elements,
    number,
    publish,
    table,
)
from ccx_billet import CcxRun, read_mesh
from ccx_decks import FACES_CONTACT, NODES

options = arguments("billet-ccx")
REPEAT = 3


class Settings(NamedTuple):
    element: str
    contact: str
    friction: float = 0.1
    increment: float = 0.02


BILLET: dict[str, Changes] = {
    "billet, default": {},
    "billet, tolerance 5e-3": {"Solver/Force tolerance": 5e-3, "Solver/Energy tolerance": 5e-3},
    "billet, steps of 2 %": fixed_steps(50),
}
CCX: dict[str, Settings] = {
    "ccx C3D8R, node to surface": Settings("C3D8R", NODES),
    "ccx C3D8R, surface to surface": Settings("C3D8R", FACES_CONTACT),
    "ccx C3D8R, node to surface, 10 %": Settings("C3D8R", NODES, 0.1, 0.1),
    "ccx C3D8, node to surface, 10 %": Settings("C3D8", NODES, 0.1, 0.1),
    "ccx C3D8, node to surface": Settings("C3D8", NODES),
    "ccx C3D8I, node to surface": Settings("C3D8I", NODES),
}

rows = []
for level in (1,) if options.quick else (1, 2, 3) if options.large else (1, 2):
    nodes, bricks = read_mesh(level)
    entries: dict[str, Any] = {**BILLET, **CCX}
    if level == 3:  # ccx takes minutes
        entries = {
            name: entry for name, entry in entries.items() if "C3D8," not in name and "C3D8I" not in name
        }
    runs: dict[str, list[Run | CcxRun]] = {name: [] for name in entries}
    for _ in range(1 if level == 3 else REPEAT):
        for name, entry in entries.items():
            if "C3D8I" in name and level > 1 and runs[name]:  # half a minute, for an answer of no use
                continue
            runs[name].append(
                CcxRun(nodes, bricks, *CCX[name]) if name in CCX else Run({**mesh(level), **entry})
            )
    for name, repeated in runs.items():
        run = repeated[0]
        rows.append(
            [
                n_elements(level),
                name,
                run.steps,
                run.cuts,
                run.iterations,
                number(statistics.median(r.seconds for r in repeated), 3),
                number(interpolate(run.times, run.forces, 0.8), 4),
                number(run.forces[-1], 4) if run.converged else f"stops at {run.times[-1]:.2g}",
            ]
        )


def ends(run: Run | CcxRun) -> str:
    """Returns the forces at 60 and at 64 % reduction."""
    return " / ".join(f"{interpolate(run.times, run.forces, time):.2f}" for time in (0.9375, 1.0))


STEPS = (48, 192, 768)  # of which one ends at 60 %
nodes, bricks = read_mesh(1)
frictionless = [["billet"] + [ends(Run({**fixed_steps(n), PAIR + "Friction coefficient": 0})) for n in STEPS]]
for name in ("ccx C3D8R, node to surface", "ccx C3D8R, surface to surface"):
    frictionless += [
        [name] + [ends(CcxRun(nodes, bricks, *CCX[name][:2], friction=0, increment=1.0 / n)) for n in STEPS]
    ]
exact = " / ".join(f"{frictionless_force(time, PENALTY):.2f}" for time in (0.9375, 1.0))
frictionless += [["closed form"] + [exact] * len(STEPS)]

start = Measured([PROGRAM, "--version"], ".").seconds
said = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
version = re.findall(r"Version (\S+)", said)[0]

publish(
    "billet-ccx",
    "The billet in billet and in CalculiX",
    options,
    (
        f"This page compares billet and CalculiX {version} on the same billet: their cost, and the forces"
        " that they find. Both upset the same nodes and bricks by 64 %, with µ = 0.1 and penalties of 3.5e5"
        " N/mm³.\n\n"
        "CalculiX has its own direct solver (SPOOLES) and its default tolerances (0.5 % of the force). Its"
        " increments are at most 2 % of the travel. Where the table says so, they are at most 10 %. billet"
        " may take steps of 10 % by default.\n\n"
        "Programs run alternately on one core without other threads. CPU seconds (user and system) are the"
        f" median of {REPEAT}"
        f" runs{'' if options.quick else ' (one of C3D8I on 480 bricks)'}"
        f"{' (one each on 3840 bricks)' if options.large else ''}."
        f" {start:.2g} of billet's seconds are its start: MPI and the loading of libraries. Iterations count"
        " those of cut steps. Forces are those on the whole billet in kN, at 80 % and at the end of the"
        " travel."
    ),
    table(
        [
            "bricks",
            "program",
            "steps",
            "cuts",
            "iterations",
            "CPU seconds",
            "force at 80 %",
            "force at the end",
        ],
        rows,
    ),
    (
        "C3D8R has one point and hourglass control. C3D8 has full integration, which locks. C3D8I has"
        " incompatible modes, which collapse. In both programs the force depends on the step with friction"
        " (see [billet-work-precision](billet-work-precision.md)), in CalculiX also without:"
    ),
    (
        "## Without friction\n\n"
        "Forces are in kN at 60 / 64 % reduction, on 60 bricks, for each number of steps. Each run is done"
        " once. The closed form assumes yield in Kirchhoff stress and includes the penalty's penetration."
    ),
    table(["program"] + [f"{n} steps" for n in STEPS], frictionless),
)
