# SPDX-License-Identifier: LGPL-2.1-or-later
"""The billet in billet and in CalculiX on finer meshes: processor seconds and memory for each Newton
iteration."""

from __future__ import annotations

import statistics

from billet_runs import Run, arguments, mesh, n_elements, number, publish, table
from ccx_billet import CcxRun, read_mesh
from ccx_decks import FACES_CONTACT, NODES

options = arguments("billet-ccx-rates")
REPEAT, PART, STEP = {2: 3, 3: 1}, 0.1, 0.02
LIMIT = 40  # CPU seconds of CalculiX
steps = {
    "Time stepping/End time": PART,
    "Time stepping/Initial step": STEP,
    "Time stepping/Maximum step": STEP,
}
BILLET = {"billet, MUMPS": "MUMPS", "billet, GMRES with multigrid": "GMRES"}
CCX = {"ccx C3D8R, node to surface": NODES, "ccx C3D8R, surface to surface": FACES_CONTACT}

rows = []
for level in (2,) if options.quick else (2, 3):
    nodes, bricks = read_mesh(level)
    runs: dict[str, list[Run | CcxRun]] = {name: [] for name in [*BILLET, *CCX]}
    for _ in range(REPEAT[level]):
        for name, solver in BILLET.items():
            runs[name].append(Run({**mesh(level), **steps, "Solver/Linear solver": solver}))
        for name, contact in CCX.items():
            runs[name].append(CcxRun(nodes, bricks, "C3D8R", contact, increment=STEP, part=PART, limit=LIMIT))
    rates = {
        name: statistics.median(run.seconds / run.iterations for run in repeated)
        for name, repeated in runs.items()
    }
    for name, repeated in runs.items():
        run = repeated[0]
        rows.append(
            [
                n_elements(level),
                name,
                run.steps,
                run.cuts,
                run.iterations,
                number(statistics.median(r.seconds for r in repeated)),
                number(rates[name]),
                number(rates[name] / rates["billet, MUMPS"], 2),
                number(rates[name] / rates["billet, GMRES with multigrid"], 2),
                number(round(max(r.megabytes for r in repeated))),
                (
                    number(run.forces[-1], 4)
                    if run.converged
                    else f"(at {100 * run.times[-1]:.2g} % of the travel)"
                ),
            ]
        )

publish(
    "billet-ccx-rates",
    "The billet in billet and in CalculiX: seconds for each iteration",
    options,
    (
        "This page compares what one iteration of Newton's method costs in billet and in CalculiX. Both"
        " programs upset the same nodes and bricks with µ = 0.1 and the same penalties. They do the first"
        f" {100 * PART:.0f} % of the travel, in steps of at most {100 * STEP:.0f} %.\n\n"
        f"Programs run alternately on one core of a busy machine: {REPEAT[2]} times (480 bricks) and once"
        f" (3840). CalculiX ends after {LIMIT} CPU seconds, however far it has come. CPU seconds (user and"
        " system) are medians over whole programs. Seconds for each iteration count the iterations of cut"
        " steps, too. Read them as ratios.\n\n"
        "GMRES is what `automatic` takes at 3840 bricks, MUMPS at 480. Force is that on the whole billet in"
        " kN."
    ),
    table(
        [
            "bricks",
            "program",
            "steps",
            "cuts",
            "iterations",
            "CPU seconds",
            "for each iteration",
            "over billet's with MUMPS",
            "over billet's with GMRES",
            "peak memory [MB]",
            "force",
        ],
        rows,
    ),
)
