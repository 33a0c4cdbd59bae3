# SPDX-License-Identifier: LGPL-2.1-or-later
"""Iterations with each contact tangent, under automatic and under fixed steps, beside the paper's."""

from __future__ import annotations

from billet_runs import PAIR, TANGENT, TANGENTS, Changes, Run, arguments, fixed_steps, number, publish, table

options = arguments("billet-tangents")
TIGHT: Changes = {"Solver/Force tolerance": 1e-6}
# The paper needs 1.4 iterations a step: its tolerance, which it does not give, must have been of this kind.
LOOSE: Changes = {"Solver/Force tolerance": 1e-2, "Solver/Energy tolerance": 1e-2}
PLAIN: Changes = {"Solver/Line search": "none", "Solver/Predictor": "tangent"}
OLDER: Changes = {"Bodies/billet/Element": "mean dilatation"}
PAPER = {"consistent": "53 / 38", "continuum": "80 / 43"}

PLAINER: list[tuple[Changes, float]] = [
    ({}, 3.5e5),
    ({}, 3.5e6),
    ({**PLAIN, **LOOSE}, 3.5e5),
    ({**PLAIN, **LOOSE, **OLDER}, 3.5e5),
    ({**PLAIN, **LOOSE, **OLDER}, 3.5e6),
]


def run(tangent: str, *changes: Changes) -> Run:
    merged: dict[str, object] = {TANGENT: tangent}
    for change in changes:
        merged.update(change)
    return Run(merged, options.ranks)


def outcome(r: Run) -> str:
    if r.converged:
        return str(r.iterations)
    return f"{r.times[-1]:.2g}: {r.failure}"


def automatic(tangent: str, *changes: Changes) -> list[object]:
    # A tangent that needs thousands of steps is no choice: it may give up.
    r = run(tangent, {"Time stepping/Minimum step": 1e-4}, *changes)
    return (
        [f"{r.iterations} / {r.steps}", r.cuts, number(r.forces[-1], 4)]
        if r.converged
        else [outcome(r), "–", "–"]
    )


publish(
    "billet-tangents",
    "The billet with each contact tangent",
    options,
    (
        "This page shows how many iterations Newton's method needs with each contact tangent. The billet of"
        " 60 bricks is upset by 64 % with µ = 0.1 and k_n = k_t = 3.5e5 N/mm³. This is example 9.1 of"
        " Bittencourt & Creus (1998).\n\n"
        "Iterations count those of cut steps. Each run is done once: counts do not scatter. Forces are"
        " those of the whole billet at the end, in kN."
    ),
    (
        "## Automatic steps\n\n"
        "The table has iterations / steps, cuts and end force for two tolerances, 1e-6 of the forces and"
        " the default one, 5e-3. The default is about what the paper's 1.4 iterations a step point to."
        " Different steps give different forces: friction and plastic flow are of first order in the step."
    ),
    table(
        [
            "tangent",
            "1e-6: iterations / steps",
            "cuts",
            "force",
            "5e-3: iterations / steps",
            "cuts",
            "force",
            "paper: iterations / steps",
        ],
        [[t] + automatic(t, TIGHT) + automatic(t) + [PAPER.get(t, "–")] for t in TANGENTS],
    ),
    (
        "## Steps of 2 % of the reduction\n\n"
        "The table has the iterations for the 50 steps. If the run stopped, it says where (part of the"
        " travel) and why.\n\n"
        "- *Inside out*: a correction would turn elements inside out, however short.\n"
        "- *Plain*: no line search, no increment continued, tolerance 1e-2.\n"
        "- *Mean dilatation*: `Element = mean dilatation`, the former default.\n\n"
        "Plain steps of the default element alternate in the first plastic step: it needs the line search."
        " In the paper only the consistent tangent still converges."
    ),
    table(
        [
            "tangent",
            "default",
            "penalty × 10",
            "plain",
            "plain, mean dilatation",
            "plain, mean dilatation, penalty × 10",
        ],
        [
            [t]
            + [
                outcome(run(t, fixed_steps(50), {PAIR + "Normal penalty": penalty}, changes))
                for changes, penalty in PLAINER
            ]
            for t in TANGENTS
        ],
    ),
)
