# SPDX-License-Identifier: LGPL-2.1-or-later
"""The billet with all of its load in one step: what cuts make of it, and how far one step goes without, by
tangent."""

from __future__ import annotations

from billet_runs import (
    TANGENT,
    TANGENTS,
    Changes,
    Run,
    arguments,
    fixed_steps,
    mesh,
    n_elements,
    percent,
    publish,
    table,
)

options = arguments("single-step")
LEVELS = (1,) if options.quick else (1, 2)
whole = {"Time stepping/Initial step": 1, "Time stepping/Maximum step": 1, "Output/Verbosity": "steps"}


def has_changed_tangent(run: Run) -> bool:
    """Returns whether the exact tangent has taken over, as it does if steps cannot be cut any more."""
    return any(record["key"] == "exact-tangent" for record in run.records)


def reach(changes: Changes, n: int) -> list[str]:
    """Returns the steps of 1/n, 2/n, ... of the travel that this tangent does alone, without a cut. These are
    the upsetting up to which it does all of them, and the largest that it does. It may take 60 iterations."""
    done = []
    for i in range(1, n + 1):
        run = Run(
            {
                **changes,
                "Time stepping/Step control": "fixed",
                "Time stepping/Initial step": i / n,
                "Time stepping/End time": i / n,
                "Output/Verbosity": "steps",
            },
            options.ranks,
        )
        done.append(run.converged and not has_changed_tangent(run))
    first = done.index(False) if False in done else n
    furthest = max((i + 1 for i, is_done in enumerate(done) if is_done), default=0)
    return [percent(0.64 * first / n), percent(0.64 * furthest / n)]


parts = []
for level in LEVELS:
    exact = Run({**mesh(level), **fixed_steps(200)}, options.ranks)
    rows = []

    def off(run: Run) -> float:
        return abs(run.forces[-1] / exact.forces[-1] - 1)

    for n in (10, 20, 50):
        run = Run({**mesh(level), **fixed_steps(n)}, options.ranks)
        rows.append(
            [
                f"exact, {n} steps",
                run.steps,
                run.cuts,
                run.iterations,
                percent(0.64 / n),
                percent(off(run)) if run.converged else run.failure,
                "",
                "",
                "",
            ]
        )
        if n == 20:
            slope = off(run) * n  # the error is of first order in the step
    for tangent in (*TANGENTS, "numerical"):
        for search in ("none", "energy"):
            changes: dict[str, object] = {**mesh(level), TANGENT: tangent, "Solver/Line search": search}
            name = tangent + (", line search" if search == "energy" else "")
            if level == 1 or tangent in TANGENTS[:2]:
                run = Run({**changes, **whole}, options.ranks)
                largest = max(b - a for a, b in zip(run.times, run.times[1:]))
                row = [
                    name + ", all at once" + (", then exact" if has_changed_tangent(run) else ""),
                    run.steps,
                    run.cuts,
                    run.iterations,
                    percent(0.64 * largest),
                    percent(off(run)) if run.converged else run.failure,
                    percent(slope * largest),
                ]
            else:
                row = [name, "", "", "", "", "", ""]
            rows.append(row + reach(changes, 50 if level == 1 else 20))
    parts.append(
        f"## {n_elements(level)} bricks\n\n"
        + table(
            [
                "tangent",
                "steps",
                "cuts",
                "iterations",
                "largest step [of the height]",
                "force at the end",
                "equal steps as large",
                "every single step to",
                "furthest",
            ],
            rows,
        )
    )

publish(
    "single-step",
    "The whole load in one step",
    options,
    (
        "This page shows what happens if the whole load is the first step, and what that costs. The billet"
        " is upset by 64 % with µ = 0.1 and the paper's penalty. It is upset first in equal steps. Then the"
        " whole travel is the first and largest step, which is cut as Newton's method asks for it and grows"
        " again.\n\n"
        "- Force at the end: compared with that of 200 equal steps.\n"
        "- *Equal steps as large*: the difference that these would have, in proportion to twenty equal"
        " steps. The error is of first order in the step.\n"
        "- *Every single step to*, *furthest*: fixed steps from the undeformed state, with this tangent"
        " alone, without a cut. Steps are parts of the height, in fiftieths of the travel (for 480 bricks"
        " in twentieths). Up to the first all converge, and the second is the largest of all that do; in"
        " between it is luck.\n"
        "- *Then exact*: steps could not be cut any more, and the exact tangent took over.\n"
        "- Empty: not run, since the same on 60 bricks took up to thousands of iterations."
    ),
    *parts,
)
