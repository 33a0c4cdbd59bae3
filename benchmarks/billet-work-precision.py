# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures the cost of accuracy of the billet's force curve: mesh, step and contact tangent."""

from __future__ import annotations

from typing import Iterator

from billet_runs import (
    TANGENT,
    Run,
    arguments,
    curve_error,
    fixed_steps,
    mesh,
    n_elements,
    number,
    percent,
    publish,
    table,
)

options = arguments("billet-work-precision")
TANGENTS = ("exact", "consistent", "continuum", "symmetrised lower", "symmetrised mean")
levels = (1, 2) if options.quick else (1, 2, 3)
REFERENCE_STEPS = 400  # on the finest mesh


def combinations() -> Iterator[tuple[int, int | None, str]]:
    """Mesh, steps (None: automatic) and tangent of every run. On the largest mesh the exact tangent alone,
    and the consistent one once: the tangents' answers do not differ, and the smaller meshes tell how their
    costs do. The mean needs thousands of automatic steps."""
    for level in levels:
        for steps in (None, 4, 10, 40, 100, REFERENCE_STEPS):
            for tangent in TANGENTS:
                if steps is None and tangent == "symmetrised mean":
                    continue
                if level < 3 or tangent == "exact" or (tangent, steps) == ("consistent", 40):
                    yield level, steps, tangent


runs = {}
for level, steps, tangent in combinations():
    changes: dict[str, object] = {**mesh(level), TANGENT: tangent}
    if steps is not None:
        changes.update(fixed_steps(steps))
    run = Run(changes, options.ranks)
    if run.converged and run.seconds < 5.0:  # what takes longer scatters little
        run.seconds = sorted([run.seconds] + [Run(changes, options.ranks).seconds for _ in range(2)])[1]
    runs[level, steps, tangent] = run

reference = runs[levels[-1], REFERENCE_STEPS, "exact"]
rows = []
for (level, steps, tangent), run in runs.items():
    same_mesh = runs[level, REFERENCE_STEPS, "exact"]
    if run.converged:
        error = "(reference)" if run is reference else percent(curve_error(run, reference))
        result = [
            str(run.iterations),
            number(run.seconds, 3),
            error,
            "–" if run is same_mesh else percent(curve_error(run, same_mesh)),
        ]
    else:
        result = [f"stops at {run.times[-1]:.2g}", number(run.seconds, 3), "–", "–"]
    rows.append([n_elements(level), f"automatic: {run.steps}" if steps is None else steps, tangent] + result)

publish(
    "billet-work-precision",
    "What accuracy of the billet's force curve costs",
    options,
    "This page shows what accuracy of the billet's force curve costs, for several meshes, steps and"
    " tangents. The billet is upset by 64 % with µ = 0.1 and the paper's penalty.\n\n"
    "- Cost: Newton iterations, and CPU seconds (user and system, start included). Seconds are the median"
    " of three runs where a run takes less than 5 s, else of one run. Failed runs are done once.\n"
    "- Error: ∫|F − F*| / ∫|F*| of the force curve at the ends of the steps. F* is that of"
    f" {n_elements(levels[-1])} bricks, {REFERENCE_STEPS} steps and the exact tangent.\n"
    "- By the steps: the part of the error that the steps alone make. It is the difference from"
    f" {REFERENCE_STEPS} steps on the same mesh.\n\n"
    "Failed runs stay in the table, with the part of the travel that they reached."
    + (
        ""
        if options.quick
        else (
            f" To save time, all tangents but the exact one are left out on {n_elements(3)} bricks, except"
            " the consistent one with 40 steps."
        )
    )
    + " The upper symmetrised tangent is left out, and with automatic steps the symmetrised mean. They"
    " take thousands of iterations (see [billet-tangents](billet-tangents.md)). Four fixed steps of 16"
    " % of the height are too long for every tangent.",
    table(["bricks", "steps", "tangent", "iterations", "CPU seconds", "error", "by the steps"], rows),
)
