# SPDX-License-Identifier: LGPL-2.1-or-later
"""Elements and elasticities of implicit scenes on the billet: force, iterations, and what they
cost."""

from __future__ import annotations

import os
import re
import subprocess
import tempfile
from pathlib import Path
from typing import Any, Callable

from billet_runs import (
    PAIR,
    PROGRAM,
    SCENE,
    TANGENT,
    Changes,
    Run,
    arguments,
    count_instructions,
    curve_error,
    fixed_steps,
    mesh,
    n_elements,
    number,
    percent,
    publish,
    read_scene,
    table,
    variant,
)
from billet_tools.output import read_rows

options = arguments("elements")
COST = str(Path(PROGRAM).resolve().parents[1] / "benchmarks/bin/element_cost")
ELEMENT, KINEMATICS = "Bodies/billet/Element", "Bodies/billet/Material/Elasticity"
ELEMENTS, LAWS = ("assumed strain", "mean dilatation", "one point"), ("Hencky", "neo-Hookean", "hypoelastic")
CLASSES = {
    "AssumedStrainElement": "assumed strain",
    "MeanDilatationElement": "mean dilatation",
    "OnePointElement": "one point",
}
# By the rows' length and the symmetry of their moduli.
FORMS = {("6", "true"): "Hencky", ("6", "false"): "neo-Hookean", ("9", "false"): "hypoelastic"}
STEPS = 50
FRICTIONLESS = {PAIR + "Friction coefficient": 0}


def run(element: str, law: str, changes: Changes, ranks: int = options.ranks) -> Run:
    return Run({ELEMENT: element, KINEMATICS: law, **changes}, ranks)


def force(result: Run) -> str:
    return number(result.force(1.0), 5)


def evaluation_instructions(what: str) -> dict[tuple[str, str], float]:
    """Instructions of one evaluation by (element, law): callgrind's inclusive count of
    LawBlock::evaluate()."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", "--callgrind-out-file=" + out, COST, what],
            capture_output=True,
            text=True,
            check=True,
        )
        n = int(done.stdout)
        said = subprocess.run(
            ["callgrind_annotate", "--inclusive=yes", "--threshold=100", out],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
    counts: dict[tuple[str, str], float] = {}
    for line in said.splitlines():
        found = re.match(
            r"\s*([\d,]+) .*LawBlock<billet::(\w+)(?:<\w+>)?, billet::LawForm<.*?double, (\d)ul>.*?>, "
            r"(\w+)>, \w+>::evaluate\(",
            line,
        )
        if found and found.group(2) in CLASSES:
            key = CLASSES[found.group(2)], FORMS[found.group(3), found.group(4)]
            counts[key] = max(counts.get(key, 0), int(found.group(1).replace(",", "")) / n)
    return counts


def instructions_of_run(text: str, column: str) -> tuple[int, int]:
    """Returns the instructions of billet without those of libraries before it, and the last number in this
    column of the history."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "scene.prm").write_text(text)
        instructions = count_instructions(place)
        return instructions, int(read_rows(place / "results/history.csv")[-1][column])


def instructions_of_each(text_of: Callable[[float], str], column: str) -> float:
    """Returns the instructions of an iteration or a step: the difference of a short run and a longer one."""
    (short, few), (long, more) = (instructions_of_run(text_of(end), column) for end in (0.3, 1))
    return (long - short) / (more - few)


def implicit_scene(element: str, law: str) -> Callable[[float], str]:
    """The billet of 60 bricks, in its first steps; to `end` of them."""
    return lambda end: variant(
        read_scene(SCENE),
        {
            ELEMENT: element,
            KINEMATICS: law,
            **mesh(1),
            **fixed_steps(STEPS),
            "Time stepping/End time": repr(round(10 * end) / STEPS),
            "Output/Format": "none",
            "Output/Verbosity": "quiet",
            "Output/Folder": "results",
        },
    )


def explicit_scene(element: str, law: str) -> Callable[[float], str]:
    """A block of 6³ bricks that yields at once."""
    return lambda end: variant(
        "",
        {
            "Bodies/block/Symmetry planes": "x = 0 ; y = 0 ; z = 0",
            "Bodies/block/Element": element,
            "Bodies/block/Initial velocity": "0 ; 0 ; -1000*z",
            "Bodies/block/Mesh/Primitive": "subdivided_hyper_rectangle",
            "Bodies/block/Mesh/Arguments": "6, 6, 6 : 0, 0, 0 : 6, 6, 6 : true",
            "Bodies/block/Material/Density": "7.8e-9",
            "Bodies/block/Material/Young modulus": "200e3",
            "Bodies/block/Material/Elasticity": law,
            "Bodies/block/Material/Yield stress": 100,
            "Bodies/block/Material/Hardening modulus": 1000,
            "Time stepping/Scheme": "explicit",
            "Time stepping/End time": repr(1e-4 * end),
            "Explicit dynamics/Instruction set": "AVX2",
            "Output/Format": "none",
            "Output/Verbosity": "quiet",
            "Output/Folder": "results",
        },
    )


def beside_mean_dilatation(rows_of_runs: list[list[Any]]) -> list[list[str]]:
    """Returns the cost of iterations and steps over those with mean dilatation, the default until 2026-11-22,
    and the limits set for it."""
    found, some = [], LAWS[:1] if options.quick else LAWS
    for law in some:
        each = {
            element: instructions_of_each(implicit_scene(element, law), "total_iterations")
            for element in ELEMENTS
        }
        found.append(
            [
                "an iteration of 60 bricks",
                law,
                *(number(each[e] / each["mean dilatation"], 3) for e in ("assumed strain", "one point")),
                "1.2, –",
            ]
        )
    for law in some:
        found.append(
            [
                "one evaluation with matrix",
                law,
                *(
                    number(tangents[e, law] / tangents["mean dilatation", law], 3)
                    for e in ("assumed strain", "one point")
                ),
                "1.2, –",
            ]
        )
    for law in some:
        each = {element: instructions_of_each(explicit_scene(element, law), "step") for element in ELEMENTS}
        found.append(
            [
                "an explicit step",
                law,
                *(number(each[e] / each["mean dilatation"], 3) for e in ("assumed strain", "one point")),
                "1.4, 0.45",
            ]
        )
    for law in LAWS:
        clock = {
            e: float(row[-1])
            for e in ELEMENTS
            for row in rows_of_runs
            if row[0] == n_elements(levels[-1]) and row[1:3] == [e, law]
        }
        found.append(
            [
                f"an iteration of {n_elements(levels[-1])} bricks, on the clock",
                law,
                *(number(clock[e] / clock["mean dilatation"], 3) for e in ("assumed strain", "one point")),
                "1.2, –",
            ]
        )
    return found


levels = (1,) if options.quick else (1, 2)
finest = levels[-1] + (1 if options.large else 0)
reference = run("assumed strain", "Hencky", {**mesh(finest), **fixed_steps(STEPS)})
rows = []
for level in levels:
    usual = None
    for element in ELEMENTS:
        for law in LAWS:
            result = run(element, law, {**mesh(level), **fixed_steps(STEPS)})
            usual = usual or result
            cost = result.seconds / max(result.iterations, 1) / (usual.seconds / usual.iterations)
            rows.append(
                [
                    n_elements(level),
                    element,
                    law,
                    f"{result.steps}{'' if result.converged else ', then ' + result.failure}",
                    result.iterations,
                    force(result),
                    percent(curve_error(result, usual)) if result is not usual else "",
                    (
                        percent(curve_error(result, reference))
                        if level < finest or result is not usual
                        else "(reference)"
                    ),
                    number(cost, 2),
                ]
            )

step_rows = []
for steps in (10, 20, 50, 100) if options.quick else (10, 20, 50, 100, 200):
    results = [run("assumed strain", law, {**FRICTIONLESS, **fixed_steps(steps)}) for law in LAWS]
    step_rows.append([steps] + [force(result) for result in results])

tangent_rows = []
for element, law in (
    ("assumed strain", "neo-Hookean"),
    ("assumed strain", "hypoelastic"),
    ("one point", "hypoelastic"),
):
    cells = []
    for tolerance in (1e-6, 1e-11):
        for tangent in ("exact", "symmetrised"):
            result = run(
                element,
                law,
                {
                    TANGENT: "exact",
                    "Solver/Force tolerance": tolerance,
                    "Solver/Material tangent": tangent,
                    **fixed_steps(25),
                },
            )
            cells.append(str(result.iterations) if result.converged else result.failure)
    tangent_rows.append([element, law] + cells)

forces, tangents = evaluation_instructions("forces"), evaluation_instructions("tangents")
base = tangents["assumed strain", "Hencky"]
cost_rows = [
    [
        element,
        law,
        number(forces[element, law] / 1e3, 3),
        number(tangents[element, law] / 1e3, 3),
        number(tangents[element, law] / base, 2),
    ]
    for element in ELEMENTS
    for law in LAWS
]

publish(
    "elements",
    "Elements and elasticity in implicit scenes",
    options,
    (
        "This page shows what each element and each law costs, and how far its force is off. The billet is"
        f" upset by 64 % with µ = 0.1 and the paper's penalty, in {STEPS} fixed steps.\n\n"
        "The table has the force on the whole billet at the end in kN. Differences are those of the force"
        " curve, ∫|F − F*| / ∫|F*|. They are taken from the usual element and law on the same mesh, and"
        f" from the same on {n_elements(finest)} bricks. Cost is CPU seconds of an iteration, all counted,"
        " over those of the usual element and law. Each run is done once: the last column is rough."
    ),
    table(
        [
            "bricks",
            "element",
            "elasticity",
            "steps",
            "iterations",
            "force",
            "from the usual",
            "from the finer mesh",
            "cost of an iteration",
        ],
        rows,
    ),
    "## One evaluation",
    (
        "The table has thousands of instructions by callgrind, of one element in which all points yield."
        " Hardening is linear; tangents are exact. Columns are forces alone, forces with the matrix, and"
        " the latter over that of the usual element."
    ),
    table(["element", "elasticity", "forces", "with matrix", "over the usual"], cost_rows),
    "## Over mean dilatation",
    (
        "The table shows what an iteration and a step cost over those with mean dilatation, the default"
        " until 2026-11-22. Costs are instructions by callgrind. The last column is what was wanted of"
        " assumed strains and of one point.\n\n"
        "An iteration is that of the billet, its first ten steps, with factors of MUMPS and contact. A step"
        " is that of a block of 6³ bricks that yields, AVX2, double. Both leave out set-up, and what the"
        " program watches a hundred times in a run."
    ),
    table(
        ["what", "elasticity", "assumed strain", "one point", "wanted, at most"], beside_mean_dilatation(rows)
    ),
    (
        "The evaluation, by callgrind, and the explicit step are above the limit. The strains of a point"
        " have six tensors that vary, where mean dilatation has gradients alone. Explicit steps of assumed"
        " strains are 1.04 to 1.29 times as long. The shipped explicit scenes therefore take 0.92 to 1.0 of"
        " the time ([default-cost](default-cost.md))."
    ),
    "## Steps",
    (
        "The table has the force at the end in kN without friction, on 60 bricks, for each number of steps."
        " Without friction the Hencky law integrates exactly. The closed form is 877.02 for Hencky's law"
        " and a rigid die."
    ),
    table(["steps"] + list(LAWS), step_rows),
    "## Symmetric part of the tangent",
    (
        "The table has the iterations with friction in 25 steps on 60 bricks. The contact tangent is exact;"
        " tolerances are 1e-6 and 1e-11. Without friction, where the billet's deformation is uniform, exact"
        " and symmetrised tangents are alike."
    ),
    table(
        ["element", "elasticity", "exact, 1e-6", "symmetrised, 1e-6", "exact, 1e-11", "symmetrised, 1e-11"],
        tangent_rows,
    ),
)
