# SPDX-License-Identifier: LGPL-2.1-or-later
"""The billet without friction against the closed form: what is left is the penalty's penetration."""

from __future__ import annotations

import math

from billet_runs import (
    PAIR,
    PENALTY,
    Run,
    arguments,
    fixed_steps,
    frictionless_force,
    mesh,
    n_elements,
    number,
    publish,
    table,
)

options = arguments("billet-frictionless")
TIMES = {0.9375: "60 %", 1.0: "64 %"}


def errors(run: Run, penalty: float) -> list[str]:
    cells = []
    for time in TIMES:
        reached = any(abs(t - time) < 1e-9 for t in run.times)
        force = run.force(time) if reached else math.nan
        for reference in (frictionless_force(time), frictionless_force(time, penalty)):
            cells.append(number(100.0 * (force / reference - 1.0), 2))
    return cells


def row(refinements: int, steps: int, factor: float) -> list[object]:
    run = Run(
        {
            **mesh(refinements),
            **fixed_steps(steps),
            PAIR + "Friction coefficient": 0,
            PAIR + "Normal penalty": factor * PENALTY,
            "Solver/Force tolerance": 1e-6,
        },
        options.ranks,
    )
    cells: list[object] = [run.failure, *["–"] * 4]
    if run.converged:
        cells = [run.iterations, *errors(run, factor * PENALTY)]
    return [n_elements(refinements), steps, f"{factor:g}", *cells]


meshes = (1, 2) if options.quick else (1, 2, 3)
head = ["bricks", "steps", "penalty / 3.5e5", "iterations"] + [
    f"{text}: error {of}" for text in TIMES.values() for of in ("[%]", "[%], penetration taken off")
]
publish(
    "billet-frictionless",
    "The billet without friction against the closed form",
    options,
    (
        "This page compares the force on the billet with a closed form, which exists since upsetting with µ"
        " = 0 is homogeneous. The closed form is for a law that yields in Kirchhoff stress, as billet's"
        f" does. It gives {frictionless_force(0.9375):.2f} kN on the whole billet at 60 % reduction,"
        f" {frictionless_force(1.0):.2f} kN at 64 %.\n\n"
        "The die's penalty lets the billet in by pressure / penalty. The last column of each pair takes"
        " this off, in closed form, too. Steps are fixed; each run is done once. A dash: no step ends at"
        " this time."
    ),
    "## Meshes and steps: no influence",
    table(head, [row(m, n, 1) for m in meshes for n in ((5, 48, 480) if m < 3 else (5, 48))]),
    "## Penalty",
    table(head, [row(m, 48, factor) for m in meshes for factor in (0.1, 1, 10, 100)]),
)
