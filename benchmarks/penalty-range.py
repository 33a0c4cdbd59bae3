# SPDX-License-Identifier: LGPL-2.1-or-later
"""Iterations and errors of three scenes over eight decades of the penalty, beside augmentation."""

from __future__ import annotations

import math

from billet_runs import ROOT, Changes, Run, arguments, percent, publish, table

options = arguments("penalty-range")
FACTORS = (0.1, 1, 10, 1e3, 1e5) if options.quick else (0.1, 1, 10, 100, 1e3, 1e4, 1e5, 1e6)
TOLERANCES = (1e-2, 1e-3, 1e-4)
SCENES: dict[str, tuple[str, str, Changes]] = {  # pair, body whose force is shown, further changes
    "billet_upsetting": ("billet on die", "die", {"Time stepping/End time": 0.5}),
    "hertz_cylinders": ("faces", "faces", {}),
    "press_fit": ("fit", "fit", {}),
}


def run(scene: str, pair: str, column: str, changes: Changes) -> Run:
    return Run({**SCENES[scene][2], **changes}, options.ranks, ROOT / f"prm/{scene}.prm", column)


def force(result: Run, column: str) -> float:
    """Largest component at the end."""
    return (
        max(abs(float(result.rows[-1][f"{column}.force_{i}"])) for i in "xyz")
        if result.converged
        else math.nan
    )


parts = []
for scene, (pair, column, _) in SCENES.items():
    text = (ROOT / f"prm/{scene}.prm").read_text()
    if f"subsection {pair}" not in text:
        raise SystemExit(f"{scene}: no pair '{pair}'")
    settings = {f"Contact pairs/{pair}/Penalty unit": "factor"}

    def at(factor: float, tolerance: float, **more: float) -> Run:
        return run(
            scene,
            pair,
            column,
            {
                **settings,
                f"Contact pairs/{pair}/Normal penalty": factor,
                f"Contact pairs/{pair}/Penetration tolerance": tolerance,
                "Solver/Maximum augmentations": 60,
                "Solver/Force tolerance": 1e-8,
                **more,
            },
        )

    exact = force(at(10, 1e-6), column)
    rows = []
    for factor in FACTORS:
        result = at(factor, 0)
        tight = at(factor, 0, **{"Solver/Force tolerance": 1e-15, "Solver/Energy tolerance": 1e-24})
        residual = max(float(row["residual"]) for row in tight.rows) if tight.converged else math.nan
        rows.append(
            [
                f"{factor:g}",
                "–",
                result.steps if result.converged else "fails",
                result.cuts,
                result.iterations,
                percent(abs(force(result, column) / exact - 1)) if result.converged else "–",
                f"{residual:.0e}" if tight.converged else "not reached",
            ]
        )
    for tolerance in TOLERANCES:
        for factor in (1, 10, 100):
            result = at(factor, tolerance)
            rows.append(
                [
                    f"{factor:g}",
                    f"{tolerance:g}",
                    result.steps if result.converged else "fails",
                    result.cuts,
                    result.iterations,
                    percent(abs(force(result, column) / exact - 1)) if result.converged else "–",
                    "",
                ]
            )
    parts.append(
        f"## {scene}\n\n"
        + table(
            [
                "penalty [E/h]",
                "augmented to",
                "steps",
                "cuts",
                "iterations",
                "error of the force",
                "residual at best",
            ],
            rows,
        )
    )

publish(
    "penalty-range",
    "Eight decades of the penalty",
    options,
    (
        "This page shows in which range of the penalty forces are right and Newton's method converges. The"
        " scenes are the billet until half of its travel, two cylinders, and a press fit. They are as"
        " shipped but for the penalty, in parts of E/h, and the augmentation, in facet sizes. Residuals are"
        " below 1e-8 of the forces.\n\n"
        "Errors are those of the force at the end. The reference is 10 E/h augmented to 1e-6 of a facet on"
        " the same mesh. Where errors no longer fall as the penalty grows they are the reference's.\n\n"
        "The last column shows how many of sixteen digits the penalty takes. It is what is left of the"
        " residual where Newton's method is asked for 1e-15, the largest of all steps. Three last bits of a"
        " position times the penalty count as nothing."
    ),
    *parts,
)
