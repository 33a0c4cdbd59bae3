# SPDX-License-Identifier: LGPL-2.1-or-later
"""The billet on finer meshes: a direct and an iterative linear solver."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from billet_runs import (
    PROGRAM,
    SCENE,
    Measured,
    arguments,
    mesh,
    n_elements,
    number,
    publish,
    read_scene,
    table,
    variant,
)
from billet_tools.output import read_rows

options = arguments("billet-solvers")
# Mesh, and part of the travel: a direct solver takes hours for all of it on the finest.
CASES = ((2, 1.0),) if options.quick else ((2, 1.0), (3, 1.0)) + (((4, 0.04),) if options.large else ())


def run(level: int, end: float, solver: str) -> tuple[list[dict[str, str]], float, float]:
    """History of the run, processor seconds, peak memory in MB; of one rank."""
    text = variant(
        read_scene(SCENE),
        {
            **mesh(level),
            "Time stepping/End time": end,
            "Time stepping/Maximum step": 0.02,
            "Solver/Linear solver": solver,
            "Output/Format": "none",
            "Output/Verbosity": "quiet",
            "Output/Folder": "results",
        },
    )
    with tempfile.TemporaryDirectory() as place:
        (Path(place) / "scene.prm").write_text(text)
        done = Measured([PROGRAM, "scene.prm"], place)
        if done.code != 0:
            sys.exit(f"billet ended with {done.code}: {done.stderr}")
        rows = read_rows(Path(place) / "results/history.csv")
    print(
        f"[{n_elements(level)}, {solver}] {rows[-1]['total_iterations']} iterations, {done.seconds:.3g} s",
        file=sys.stderr,
        flush=True,
    )
    return rows, done.seconds, done.megabytes


rows = []
for level, end in CASES:
    for solver in ("MUMPS", "GMRES"):
        history, seconds, megabytes = run(level, end, solver)
        iterations = int(history[-1]["total_iterations"])
        linear = sum(int(row["linear_iterations"]) for row in history)
        rows.append(
            [
                n_elements(level),
                number(end),
                solver,
                len(history),
                iterations,
                number(linear / iterations) if linear else "direct",
                number(seconds),
                number(seconds / iterations),
                number(round(megabytes)),
                number(-4e-3 * float(history[-1]["die.force_z"]), 6),
            ]
        )

publish(
    "billet-solvers",
    "The billet by a direct and by an iterative solver",
    options,
    (
        "This page compares a direct and an iterative linear solver on the billet. The billet is upset with"
        " µ = 0.1 and the paper's penalty, in steps of at most 2 %. The travel is the part of 64 % that the"
        " table gives. Each run is done once, on a busy machine.\n\n"
        "Linear iterations are those for each iteration of Newton's method, forced after Eisenstat and"
        " Walker. CPU seconds are those of the whole program, and for each iteration of Newton's method."
        " Force is that on the whole billet at the end in kN."
    ),
    table(
        [
            "bricks",
            "travel",
            "solver",
            "steps",
            "iterations",
            "linear iterations",
            "CPU seconds",
            "for each iteration",
            "peak memory [MB]",
            "force",
        ],
        rows,
    ),
)
