# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures the cost of each capability of a scene: instructions and memory, from one elastic body on."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

from billet_runs import PROGRAM, Measured, arguments, count_instructions, number, publish, table
from billet_tools.output import read_rows

options = arguments("capabilities")
EDGE = 6
# Each scene runs twice, for a part of the time and for all of it: what setting up costs is in both. Of static
# scenes steps, of explicit ones seconds.
STEPS, FEW_STEPS = 3, 1
END, SHORT_END = 1e-5, 2e-6


def body(name: str, bottom: str, plastic: bool, element: str, more: str) -> str:
    supports = {
        "lower": "set Symmetry planes = x = 0 ; y = 0 ; z = 0",
        "upper": "set Symmetry planes = x = 0 ; y = 0",
    }
    layers, low, high = (EDGE, 0, 10) if bottom == "lower" else (1, 10, 12)
    hardening = "set Yield stress = 300\n set Hardening modulus = 1000" if plastic else "set Law = elastic"
    return f"""subsection {name}
 {supports[bottom]}
 set Element = {element}
 subsection Mesh
 set Primitive = subdivided_hyper_rectangle
 set Arguments = {EDGE}, {EDGE}, {layers} : 0, 0, {low} : 10, 10, {high} : true
 end
 subsection Material
 set Density = 7.8e-9
 set Young modulus = 200e3
 {hardening}
 end
 {more}
end
"""


def scene(
    whole: bool = True,
    explicit: bool = False,
    plastic: bool = False,
    element: str = "assumed strain",
    tool: bool = False,
    friction: bool = False,
    second: bool = False,
    augmented: bool = False,
    edges: bool = False,
    self_contact: bool = False,
) -> str:
    push = (
        "subsection Loads\n subsection push\n set Type = pressure\n set Boundary ids = 5\n set Pressure ="
        f" 400*t/{END}\n end\n end"
        if explicit
        else (
            "subsection Supports\n subsection push\n set Boundary ids = 5\n set Components = z\n"
            " set Displacement = 0 ; 0 ; -0.05*t\n end\n end"
        )
    )
    pairs, time = "", "t" + (f"/{END}" if explicit else "")
    of_pair = (
        "set Normal penalty = 1\n"
        + ("set Friction coefficient = 0.1\n" if friction else "")
        + ("set Penetration tolerance = 1e-4\n" if augmented else "")
        + ("set Edge contact = true\n" if edges else "")
    )
    if second:
        pairs += (
            "subsection block on cap\n set Body = block\n set Boundary ids = 5\n set Second body = cap\n"
            " set Second boundary ids = 4\n" + of_pair + "end\n"
        )
    if tool:
        pairs += (
            "subsection die\n set Body = block\n set Boundary ids = 1\n set Tool = die\n"
            + of_pair.replace("set Edge contact = true\n", "")
            + "end\n"
        )
    if self_contact:
        pairs += (
            "subsection folds\n set Body = block\n set Boundary ids = 1, 3\n set Second body = block\n set"
            " Normal penalty = 1\nend\n"
        )
    text = "subsection Bodies\n" + body("block", "lower", plastic, element, "" if second else push)
    if second:
        text += body("cap", "upper", False, "assumed strain", push)
    text += "end\n"
    if tool:
        text += (
            "subsection Tools\n subsection die\n subsection Surfaces\n subsection face\n set Point = 10, 0,"
            f" 0\n set Normal = -1, 0, 0\n end\n end\n subsection Motion\n set Translation = -0.01*{time} ; 0"
            " ; 0\n end\n end\nend\n"
        )
    if pairs:
        text += "subsection Contact pairs\n" + pairs + "end\n"
    if explicit:
        text += (
            "subsection Time stepping\n set Scheme = explicit\n set End time ="
            f" {END if whole else SHORT_END}\nend\n"
            "subsection Explicit dynamics\n set Instruction set = AVX2\n"  # what valgrind knows
            # many steps: what looks a hundred times in a run is in both runs
            " set Safety factor = 0.05\nend\n"
        )
    else:
        text += (
            f"subsection Time stepping\n set Step control = fixed\n set Initial step = {1 / STEPS!r}\n"
            f" set End time = {1 if whole else FEW_STEPS / STEPS!r}\nend\n"
        )
    return (
        text + "subsection Output\n set Folder = results\n set Format = none\n set Verbosity = quiet\nend\n"
    )


class Run:
    """`instructions` of a run, without what libraries do before it; `rows` of capabilities.csv by name, the
    `last` of the history, `megabytes`."""

    def __init__(self, text: str) -> None:
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder)
            (place / "scene.prm").write_text(text)
            plain = Measured([PROGRAM, "scene.prm"], place)
            if plain.code != 0:
                sys.exit(f"billet ended with {plain.code}: {plain.stderr}\n{text}")
            self.megabytes = plain.megabytes
            self.instructions = count_instructions(place)
            self.rows = {
                row["capability"]: {key: int(row[key]) for key in ("calls", "items", "bytes")}
                for row in read_rows(place / "results/capabilities.csv")
            }
            self.last = read_rows(place / "results/history.csv")[-1]
        print(
            f"{self.instructions / 1e6:.5g} million instructions, {self.megabytes:.4g} MB",
            file=sys.stderr,
            flush=True,
        )

    def paid(self) -> str:
        return ", ".join(name.lower() for name, row in self.rows.items() if row["calls"])

    def counted(self) -> float:
        return sum(row["bytes"] for row in self.rows.values()) / 1e6

    def iterations(self) -> int:
        return int(self.last["total_iterations"])

    def steps(self) -> int:
        return int(self.last["step"])


def runs_of(changes: dict[str, Any]) -> tuple[Run, Run]:
    """The short run and the whole one."""
    return Run(scene(whole=False, **changes)), Run(scene(**changes))


Cases = list[tuple[str, dict[str, bool]]]  # a name, and what of scene() is true


def static_rows(cases: Cases) -> list[list[object]]:
    rows, base = [], None
    for name, changes in cases:
        short, run = runs_of(changes)
        each = (run.instructions - short.instructions) / (run.iterations() - short.iterations())
        base = base or each
        factors = run.rows["Matrix"]["bytes"] + run.rows["Unsymmetric"]["bytes"]
        rows.append(
            [
                name,
                run.paid(),
                run.iterations() - short.iterations(),
                number(short.instructions / 1e6, 4),
                number(each / 1e6, 4),
                number(each / base, 3),
                number(factors / 1e6, 3),
                number(run.counted(), 3),
                number(run.megabytes, 4),
            ]
        )
    return rows


def explicit_rows(cases: Cases) -> list[list[object]]:
    rows, base = [], None
    for name, changes in cases:
        short, run = runs_of({"explicit": True, **changes})
        steps = run.steps() - short.steps()
        n_elements = EDGE**3 + (EDGE**2 if changes.get("second") else 0)
        each = (run.instructions - short.instructions) / steps / n_elements
        base = base or each
        rows.append(
            [
                name,
                run.paid(),
                steps,
                number(short.instructions / 1e6, 4),
                number(each, 4),
                number(each / base, 3),
                number(run.counted(), 3),
                number(run.megabytes, 4),
            ]
        )
    return rows


STATIC: Cases = [
    ("one elastic body", {}),
    ("plastic", {"plastic": True}),
    ("against a tool", {"plastic": True, "tool": True}),
    ("the tool rough", {"plastic": True, "tool": True, "friction": True}),
    ("two bodies", {"plastic": True, "second": True}),
    ("two bodies, rough", {"plastic": True, "second": True, "friction": True}),
    (
        "all: two bodies and a tool, rough, augmented",
        {"plastic": True, "tool": True, "friction": True, "second": True, "augmented": True},
    ),
]
EXPLICIT: Cases = [
    ("one elastic body", {}),
    ("plastic", {"plastic": True}),
    ("against a tool", {"plastic": True, "tool": True}),
    ("the tool rough", {"plastic": True, "tool": True, "friction": True}),
    ("two bodies", {"plastic": True, "second": True}),
    ("two bodies, rough", {"plastic": True, "second": True, "friction": True}),
    (
        "all: two bodies and a tool, rough, edges, self-contact",
        {
            "plastic": True,
            "tool": True,
            "friction": True,
            "second": True,
            "edges": True,
            "self_contact": True,
        },
    ),
]
static, explicit = static_rows(STATIC), explicit_rows(EXPLICIT)
publish(
    "capabilities",
    "What capabilities cost",
    options,
    (
        "This page shows what each capability costs a run that uses it. Each line is a scene that uses"
        " what stands in its second column and nothing else. `tests/cli/capabilities.py` holds each"
        " capability to that.\n\n"
        f"The scene is a block of {EDGE} × {EDGE} × {EDGE} bricks, and what is added to it. It is pressed"
        f" by 0.5 % (explicit: by a pressure). The second body is a cap of {EDGE} × {EDGE} bricks. The tool"
        " is a plane at the side.\n\n"
        f"Instructions are counted by callgrind. Each scene runs twice: for {FEW_STEPS} of {STEPS} steps"
        " (explicit: for a fifth of the time) and whole. The difference of the two is what iterations and"
        " steps cost. The first of them, with all that setting up costs, stands beside it.\n\n"
        "Memory is counted by capability in `capabilities.csv`. The last column is the largest memory of"
        " the process, of which 100 MB and more are libraries."
    ),
    "## Static",
    "The last column but three has the instructions of an iteration over those of the first line.",
    table(
        [
            "scene",
            "uses",
            "iterations",
            "10⁶ instructions, set-up and first step",
            "10⁶ of an iteration",
            "over the first",
            "MB of matrix and factors",
            "MB counted",
            "MB of the process",
        ],
        static,
    ),
    "## Explicit",
    (
        "Runs use AVX2. Instructions are those of a step and element. They leave out set-up, and what the"
        " program watches a hundred times in a run. Steps are a twentieth of the stable one."
    ),
    table(
        [
            "scene",
            "uses",
            "steps",
            "10⁶ instructions, set-up and a fifth of the time",
            "of a step and element",
            "over the first",
            "MB counted",
            "MB of the process",
        ],
        explicit,
    ),
)
