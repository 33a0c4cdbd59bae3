# SPDX-License-Identifier: LGPL-2.1-or-later
"""The billet between elastic dies: how the force comes to that of rigid ones as the dies grow stiff."""

from __future__ import annotations

import tempfile
from pathlib import Path

from billet_runs import (
    ROOT,
    Changes,
    Run,
    arguments,
    curve_error,
    fixed_steps,
    number,
    percent,
    publish,
    read_scene,
    table,
    variant,
)

options = arguments("deformable-dies")
SCENE = ROOT / "prm/billet_deformable_dies.prm"
PAIR = "Contact pairs/billet on die/"
E = 200e3  # MPa, the billet's
METHODS = [("overlap", "one"), ("planed", "one"), ("planed", "two"), ("bilinear", "two")]
RATIOS = (10, 1000) if options.quick else (1, 10, 100, 1000)
LOADED = {"Time stepping/End time": 1, "Time stepping/Stops": "", **fixed_steps(50)}
FOLDER = tempfile.TemporaryDirectory()
IN_FIXED_STEPS = Path(FOLDER.name) / "scene.prm"  # they have no largest one
IN_FIXED_STEPS.write_text(variant(read_scene(SCENE), {"Time stepping/Maximum step": None}))
rigid = Run(fixed_steps(50), options.ranks)


def die(ratio: float) -> dict[str, object]:
    return {"Bodies/die/Material/Young modulus": ratio * E}


def method(facets: str, passes: str) -> dict[str, object]:
    return {PAIR + "Facets": facets, PAIR + "Passes": passes}


def line(*changes: Changes) -> list[object]:
    """Figures of a run in the rigid one's steps."""
    joined = {key: value for change in changes for key, value in change.items()}
    run = Run({**joined, **LOADED}, options.ranks, IN_FIXED_STEPS, "billet on die")
    if not run.converged:
        return [f"{run.failure} at {number(run.times[-1])}", *["–"] * 4]
    difference = max(abs(f / g - 1) for f, g in zip(run.forces[1:], rigid.forces[1:]))
    return [
        number(run.forces[-1], 4),
        percent(run.forces[-1] / rigid.forces[-1] - 1),
        percent(difference),
        percent(curve_error(run, rigid)),
        run.iterations,
    ]


def at_ease(*changes: Changes) -> list[object]:
    """Figures of the scene as it is, in automatic steps, with the way up."""
    joined = {key: value for change in changes for key, value in change.items()}
    run = Run(joined, options.ranks, SCENE, "billet on die")
    return (
        [run.steps, run.iterations, run.cuts, number(-run.forces[-1] if run.forces[-1] else 0.0)]
        if run.converged
        else [f"{run.failure} at {number(run.times[-1])}", *["–"] * 3]
    )


HEAD = [
    "final force [kN]",
    "final force against the rigid die's",
    "largest difference of the force",
    "difference of the curves (integral)",
    "iterations in 50 steps",
    "automatic: steps",
    "iterations",
    "failed steps",
    "force after unloading",
]
publish(
    "deformable-dies",
    "The billet between elastic dies",
    options,
    (
        "This page shows what elastic dies change, and that stiff ones give nearly the force of rigid ones."
        " The scene is `prm/billet_deformable_dies.prm`. The billet is that of `prm/billet_upsetting.prm`"
        " (60 bricks, µ = 0.1, upset by 64 %, k_n = 3.5·10⁵ N/mm³). Elastic blocks (400 bricks, 10 mm"
        " thick) take the place of rigid planes.\n\n"
        "Forces are compared step by step with those of the rigid dies, in the same 50 equal steps. The"
        f" rigid dies' final force is {number(rigid.forces[-1], 4)} kN, and they take {rigid.iterations}"
        " iterations. The automatic steps are those of the whole scene, in which the dies leave the billet"
        " again."
    ),
    "## Young's modulus of the dies (overlap)",
    table(["die / billet"] + HEAD, [[ratio] + line(die(ratio)) + at_ease(die(ratio)) for ratio in RATIOS]),
    (
        "The difference that stays with stiff dies is not compliance. In the part that touches, overlapping"
        " facets meet the billet's outermost facets; a rigid die meets their nodes."
    ),
    "## Facets, dies a thousand times as stiff",
    table(
        ["facets", "passes"] + HEAD,
        [
            [facets, passes]
            + line(die(1000), method(facets, passes))
            + at_ease(die(1000), method(facets, passes))
            for facets, passes in METHODS
        ],
    ),
)
