# SPDX-License-Identifier: LGPL-2.1-or-later
"""The billet's force curve on finer and finer meshes."""

from __future__ import annotations

import math

from billet_runs import Run, arguments, curve_error, mesh, n_elements, number, percent, publish, table

options = arguments("billet-mesh")
STEPS = 50
stepping = {"Time stepping/Initial step": 1 / STEPS, "Time stepping/Maximum step": 1 / STEPS}
TIMES = (0.2, 0.4, 0.6, 0.8, 0.9, 1.0)
levels = (1, 2) if options.quick else (1, 2, 3, 4) if options.large else (1, 2, 3)
runs = {level: Run({**mesh(level), **stepping}, options.ranks) for level in levels}
finest = runs[levels[-1]]


def order(coarse: float, middle: float, fine: float) -> float:
    """log2 of the ratio of successive differences (each mesh halves the last), where they have one sign."""
    ratio = (coarse - middle) / (middle - fine) if middle != fine else 0.0
    return math.log2(ratio) if ratio > 0 else math.nan


def solver(run: Run) -> str:
    return "iterative" if any(int(row["linear_iterations"]) for row in run.rows) else "direct"


rows = [
    [
        n_elements(level),
        solver(run),
        run.steps,
        run.cuts,
        run.iterations,
        number(run.seconds, 3),
        number(run.seconds / run.iterations, 2),
        number(round(run.megabytes)),
    ]
    + [number(run.force(t), 5) for t in TIMES]
    + ["(reference)" if run is finest else percent(curve_error(run, finest))]
    for level, run in runs.items()
]
if len(levels) > 2:
    last = [runs[level] for level in levels[-3:]]
    orders = [order(*(run.force(t) for run in last)) for t in TIMES]
    rows.append(["order", *[""] * 7, *(number(p, 2) for p in orders), ""])
    step_apart = curve_error(last[0], last[1]), curve_error(last[1], last[2])
    norm = (
        f"In the norm of the last column, each mesh differs from the next by {percent(step_apart[0])}, then "
        f"{percent(step_apart[1])}: order {math.log2(step_apart[0] / step_apart[1]):.1f}."
    )
else:
    norm = ""

publish(
    "billet-mesh",
    "The billet on finer meshes",
    options,
    (
        "This page shows how the force on the billet changes as its mesh becomes finer. The billet is upset"
        f" by 64 % with µ = 0.1 and the paper's penalty. Runs take {STEPS} steps, cut only where Newton's"
        " method asks for it. The linear solver is the one that `automatic` takes. Each run is done once,"
        " on a busy machine.\n\n"
        "Columns headed by a number have the force on the whole billet in kN at this part of the travel."
        " The last column is the difference of the whole curve from the finest mesh's,"
        " ∫|F − F*| / ∫|F*|."
        " The order is Richardson's from the last three meshes. A dash: the differences change sign, and"
        " there is no order."
    ),
    table(
        [
            "bricks",
            "linear solver",
            "steps",
            "cuts",
            "iterations",
            "CPU seconds",
            "for each iteration",
            "peak memory [MB]",
        ]
        + [f"{t:g}" for t in TIMES]
        + ["curve"],
        rows,
    ),
    norm,
)
