# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures the savings and errors of the default tolerances of Newton's method, beside those for comparisons
to many digits, on the shipped scenes of statics and implicit dynamics."""

from __future__ import annotations

import math
from pathlib import Path

from billet_runs import ROOT, Changes, arguments, number, percent, publish, table  # finds billet_tools, too
from billet_tools.scene import read_entries
from curve_runs import CurveRun, error

options = arguments("tolerances")

# The defaults of every static scene up to the change to those of today, and what is as good as none.
TIGHT: Changes = {"Solver/Force tolerance": 1e-6, "Solver/Energy tolerance": 1e-10}
EXACT: Changes = {
    "Solver/Force tolerance": 1e-8,
    "Solver/Energy tolerance": 1e-12,
    "Solver/Displacement tolerance": 1e-6,
}
LOOSE: Changes = {key: None for key in EXACT}

# Scenes that take minutes: what is left of them shows the same.
CUT: dict[str, Changes] = {
    "wagoner_punch": {"Bodies/blank/Mesh/Refinements": 3, "Time stepping/End time": 0.25},
    "wagoner_punch_mu_0": {"Bodies/blank/Mesh/Refinements": 3, "Time stepping/End time": 0.25},
    "wagoner_punch_mu_015": {"Bodies/blank/Mesh/Refinements": 3, "Time stepping/End time": 0.25},
    "twisted_hemisphere": {
        "Bodies/block/Mesh/Arguments": "8, 8, 3 : -1, -1, -1 : 1, 1, 0 : true",
        "Bodies/punch/Mesh/Arguments": "7, 7, 3 : -1, -1, 0 : 1, 1, 1 : true",
    },
    "tube_impact": {"Time stepping/End time": 1e-4},
}


def same_steps(run: CurveRun, path: Path, cut: Changes) -> dict[str, object]:
    """Steps that end where those of a run did."""
    entries = {**read_entries(path), **{key: str(value) for key, value in cut.items()}}
    end = float(entries.get("Time stepping/End time", 1))
    if entries.get("Time stepping/Step control") == "fixed":
        return {}
    return {
        "Time stepping/Stops": ", ".join(f"{time:.17g}" for time in run.times),
        "Time stepping/Initial step": repr(end),
        "Time stepping/Maximum step": repr(end),
        "Time stepping/Growth iterations": 998,
        "Time stepping/Shrink iterations": 999,
    }


def last_change(run: CurveRun, other: CurveRun) -> float:
    """Returns the relative difference of the forces at the end."""
    ends = [(run.curves[name][-1], other.curves[name][-1]) for name in run.curves]
    size = sum(math.hypot(*b) for _, b in ends)
    return sum(math.dist(a, b) for a, b in ends) / size if size > 0 else math.nan


def shown(run: CurveRun) -> list[object]:
    return (
        [run.steps, run.work, number(run.seconds)]
        if run.finished
        else [f"stops at {run.times[-1] if run.times else 0:.2g}", run.work, number(run.seconds)]
    )


rows, totals = [], [0, 0, 0.0, 0.0]
for path in sorted((ROOT / "prm").glob("*.prm")):
    entries = read_entries(path)
    scheme = entries.get("Time stepping/Scheme", "quasi-static")
    if scheme == "explicit":
        continue
    cut = CUT.get(path.stem, {})
    before, after = CurveRun(path, {**cut, **TIGHT}, options.ranks), CurveRun(
        path, {**cut, **LOOSE}, options.ranks
    )
    off = math.nan
    if after.finished and scheme == "quasi-static" and not options.quick:
        exact = CurveRun(path, {**cut, **EXACT, **same_steps(after, path, cut)}, options.ranks)
        off = error(after, exact) if exact.finished else math.nan
    change = last_change(after, before) if before.finished and after.finished else math.nan
    if before.finished and after.finished:
        totals = [a + b for a, b in zip(totals, (before.work, after.work, before.seconds, after.seconds))]
    rows.append(
        [path.stem + (" (cut)" if cut else "")]
        + shown(before)
        + shown(after)
        + [percent(off), percent(change), after.said.count("warning[stalled-step]") or ""]
    )

publish(
    "tolerances",
    "Cost and error of the tolerances of Newton's method",
    options,
    (
        "This page shows that the default tolerances of Newton's method save iterations, and what error"
        " they make. Each shipped scene of statics and implicit dynamics runs with tight tolerances and"
        " with the [defaults](../theory.md#convergence-criteria).\n\n"
        "Tight tolerances are `Force tolerance` = 1e-6 and `Energy tolerance` = 1e-10, in place of what"
        " scenes set themselves. The defaults are 5e-3, 5e-5 and a `Displacement tolerance` of 1e-2. Scenes"
        " marked cut have less time or a coarser mesh, as in the script. Iterations are Newton's, with"
        " those of failed steps."
    ),
    (
        "- *Error*: ∫Σ|F − F*| dt over ∫Σ|F*| dt of the forces of all tools and pairs: what the tolerances"
        " alone make. F* has the same steps and tolerances of 1e-8, 1e-12 and 1e-6. It is given in statics"
        " only, and for scenes with such forces.\n- *Last force*: how far the forces at the end are from"
        " those with tight tolerances. Their steps may have other lengths, since steps follow the"
        " iterations.\n- *Stalled*: warnings of that kind."
    ),
    table(
        [
            "scene",
            "steps, tight",
            "iterations",
            "seconds",
            "steps, default",
            "iterations",
            "seconds",
            "error",
            "last force",
            "stalled",
        ],
        rows,
    ),
    (
        f"Together the scenes take {totals[0]} iterations and {totals[2]:.0f} s with tight tolerances,"
        f" {totals[1]} iterations and {totals[3]:.0f} s with the defaults. That is"
        f" {100 * (1 - totals[1] / totals[0]):.0f} % fewer iterations and"
        f" {100 * (1 - totals[3] / totals[2]):.0f} % less time."
    ),
)
