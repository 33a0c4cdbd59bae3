#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: capabilities.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

A scene pays for what it asks for and for nothing else: with each capability and without it, what --check says
that it requires are the lines of capabilities.csv that are not 0, and no other.
"""

from __future__ import annotations

import re
import sys
from typing import NamedTuple

from checks import HERE, Checks, Program, enter_folder, read_text, require, rows_of, run, write_text
from edits import edit

# An elastic block that is pressed from the side; what cases add stands below.
STATIC = """\
subsection Bodies
  subsection block
    set Symmetry planes = x = 0 ; y = 0 ; z = 0
    subsection Mesh
      set Primitive    = subdivided_hyper_rectangle
      set Arguments    = 2, 1, 2 : 0, 0, 0 : 2, 1, 2 : true
      set Boundary ids = 7 : abs(z - 2) < 1e-6
    end
    subsection Material
      set Law           = elastic
      set Density       = 1
      set Young modulus = 1000
    end
    subsection Supports
      subsection push
        set Boundary ids = 1
        set Components   = x
        set Displacement = -0.01*t ; 0 ; 0
      end
    end
  end
end
subsection Time stepping
  set End time     = 1
  set Initial step = 0.25
  set Maximum step = 0.25
end
subsection Output
  set Format = none
end
"""
IMPACT = read_text(HERE / "impact.prm")


def tool(motion: str) -> str:
    """Returns the edit for a plane above the block."""
    return (
        "+ subsection Tools\n subsection die\n subsection Surfaces\n subsection face\n set Point = 0, 0, 2\n"
        f" set Normal = 0, 0, -1\n end\n end\n subsection Motion\n {motion}\n end\n end\nend"
    )


def pair(partner: str) -> str:
    """Returns the edit for contact of the block's upper face."""
    return (
        "+ subsection Contact pairs\n subsection top\n set Body = block\n set Boundary ids = 7\n"
        f" set Normal penalty = 1\n {partner}\n end\nend"
    )


def dynamic(tolerance: str) -> str:
    """Returns the edit for implicit dynamics."""
    return (
        "Time stepping: Scheme = implicit dynamics"
        f" & + subsection Implicit dynamics\n set Error tolerance = {tolerance}\nend"
    )


LOAD = (
    "block: + subsection Loads\n subsection weight\n set Type = acceleration\n"
    " set Acceleration = 0 ; 0 ; -t\n end\nend"
)
DIE = tool("set Translation = 0 ; 0 ; -0.01*t") + " & "
ANVIL = (
    "Bodies: + subsection anvil\n set Symmetry planes = x = 0 ; y = 0 ; z = 3\n subsection Mesh\n"
    " set Primitive = subdivided_hyper_rectangle\n set Arguments = 2, 1, 1 : 0, 0, 2 : 2, 1, 3 : true\n end\n"
    " subsection Material\n set Law = elastic\n set Density = 1\n set Young modulus = 1000\n end\nend & "
)
PLASTIC = "Material: Law = elastoplastic & Material: Yield stress = 0.5 & Material: Hardening modulus = 50"
ON_ANVIL = "set Second body = anvil\n set Second boundary ids = 4\n"
FRICTION = "set Friction coefficient = 0.1"
FOLDS = (
    "Contact pairs: + subsection folds\n set Body = block\n set Boundary ids = 0, 1\n"
    " set Second body = block\nend"
)


class Case(NamedTuple):
    """Scene, and the capabilities that it uses."""

    name: str
    base: str
    edits: str
    capabilities: str


BLOW = "Plasticity, Hourglass, Contact, Body contact"

# fmt: off
CASES = [
    Case("a body", STATIC, "", "Moving support, Matrix"),
    Case("plasticity", STATIC, PLASTIC, "Plasticity, Moving support, Matrix"),
    Case("stabilisation", STATIC, "block: Element = one point", "Hourglass, Moving support, Matrix"),
    Case("both", STATIC, f"{PLASTIC} & block: Element = one point",
         "Plasticity, Hourglass, Moving support, Matrix"),
    Case("an unsymmetric tangent", STATIC,
         "Material: Elasticity = hypoelastic & + subsection Solver\n set Material tangent = exact\nend",
         "Moving support, Matrix, Unsymmetric"),
    Case("a tool", STATIC, DIE + pair("set Tool = die"), "Contact, Moving support, Matrix"),
    Case("a tool instead of the support", STATIC, DIE + pair("set Tool = die") + " & Supports: delete",
         "Contact, Matrix"),
    Case("friction", STATIC, DIE + pair(f"set Tool = die\n {FRICTION}"),
         "Contact, Friction, Moving support, Matrix, Unsymmetric"),
    Case("augmentation", STATIC, DIE + pair("set Tool = die\n set Penetration tolerance = 1e-5"),
         "Contact, Augmentation, Moving support, Matrix"),
    Case("automatic augmentation", STATIC,
         DIE + pair("set Tool = die\n set Penetration tolerance = automatic"),
         "Contact, Augmentation, Moving support, Matrix"),
    Case("a driven tool", STATIC,
         tool("set Force = t\n set Force direction = 0, 0, -1") + " & " + pair("set Tool = die"),
         "Contact, Driven tools, Moving support, Matrix"),
    Case("another body", STATIC, ANVIL + pair(ON_ANVIL),
         "Contact, Body contact, Moving support, Matrix, Unsymmetric"),
    Case("another body and friction", STATIC, ANVIL + pair(f"{ON_ANVIL} {FRICTION}"),
         "Contact, Friction, Body contact, Moving support, Matrix, Unsymmetric"),
    Case("another body, augmented", STATIC, ANVIL + pair(ON_ANVIL + " set Penetration tolerance = 1e-5"),
         "Contact, Body contact, Augmentation, Moving support, Matrix, Unsymmetric"),
    Case("errors controlled", STATIC, "Time stepping: Error tolerance = 1e-2",
         "Moving support, Error control, Matrix"),
    Case("an iterative solver", STATIC, "+ subsection Solver\n set Linear solver = CG\nend",
         "Moving support, Matrix, Iterative"),
    Case("checkpoints", STATIC, "Output: + subsection Checkpoint\n set Step interval = 2\nend",
         "Moving support, Checkpoints, Matrix"),
    Case("implicit dynamics", STATIC, dynamic("0"), "Moving support, Inertia, Matrix"),
    Case("a load", STATIC, f"{dynamic('0')} & {LOAD}", "Moving support, Inertia, Loads, Matrix"),
    Case("its errors controlled", STATIC, dynamic("1e-2"), "Moving support, Inertia, Error control, Matrix"),
    Case("explicit: all at once", IMPACT, "",
         f"{BLOW}, Edges, Driven tools, Loads, Inertia"),
    Case("explicit: no plasticity", IMPACT,
         "block / Material: Law = elastic & block / Material: - Yield stress"
         " & block / Material: - Hardening modulus",
         "Hourglass, Contact, Body contact, Edges, Driven tools, Loads, Inertia"),
    Case("explicit: no stabilisation", IMPACT, "block: - Element",
         "Plasticity, Contact, Body contact, Edges, Driven tools, Loads, Inertia"),
    Case("explicit: no loads", IMPACT, "Loads: delete",
         f"{BLOW}, Edges, Driven tools, Inertia"),
    Case("explicit: no second body", IMPACT, "block on slab: delete",
         "Plasticity, Hourglass, Contact, Driven tools, Loads, Inertia"),
    Case("explicit: no tool", IMPACT, "Tools: delete & hammer on block: delete",
         f"{BLOW}, Edges, Loads, Inertia"),
    Case("explicit: no contact", IMPACT, "Tools: delete & Contact pairs: delete",
         "Plasticity, Hourglass, Loads, Inertia"),
    Case("explicit: friction", IMPACT, "block on slab: Friction coefficient = 0.1",
         "Plasticity, Hourglass, Contact, Friction, Body contact, Edges, Driven tools, Loads, Inertia"),
    Case("explicit: edges that are free", IMPACT, "block on slab: Edge contact = false",
         f"{BLOW}, Driven tools, Loads, Inertia"),
    Case("explicit: self-contact", IMPACT, FOLDS,
         f"{BLOW}, Self-contact, Edges, Driven tools, Loads, Inertia"),
    Case("explicit: a support that moves", IMPACT, "bottom: Displacement = 0 ; 0 ; -0.01*ramp",
         f"{BLOW}, Edges, Moving support, Driven tools, Loads, Inertia"),
    Case("explicit: errors controlled", IMPACT, "Target error = 5 percent",
         f"{BLOW}, Edges, Driven tools, Loads, Inertia, Error control"),
    Case("explicit: checkpoints", IMPACT, "Output: + subsection Checkpoint\n set Interval = 0.25e-3\nend",
         f"{BLOW}, Edges, Driven tools, Loads, Inertia, Checkpoints"),
]
# fmt: on
ON_TWO_RANKS = ("another body and friction", "explicit: all at once")
# the memory of all others is counted, too; nothing is kept once they are written
HOLDS_NOTHING = ("Checkpoints",)


def write_scene(name: str, case: Case, folder: str) -> None:
    """Writes the scene of a case."""
    edits = f"Output: Folder = {folder} & {case.edits}"
    write_text(name, edit(case.base, edits).text)


def check_at_once() -> dict[Case, str]:
    """Checks the scenes of all cases in one start of the program, and returns what is said of each."""
    files = {f"case_{i:02d}.prm": case for i, case in enumerate(CASES)}
    for name, case in files.items():
        write_scene(name, case, "checked")
    ended = run(program.path, "--check", *files)
    require(ended.code == 0, f"--check ends with {ended.code}: {ended.errors}")
    _, *said = re.split(r"^Scene +(\S+)\n", ended.output, flags=re.MULTILINE)
    of_file = dict(zip(said[::2], said[1::2]))
    return {case: of_file[name] for name, case in files.items()}


def require_costs(case: Case, checked: str, folder: str, command: list[str]) -> None:
    """Raises a fault unless the scene pays for what --check says that it requires, and what is expected."""
    write_scene("scene.prm", case, folder)
    required = dict(re.findall(r"^([A-Z][\w -]*?) +(yes)\b", checked, re.MULTILINE))
    for names in re.findall(r"^Not modelled +(.*(?:\n .*)*)", checked, re.MULTILINE):
        required.update((name, "no") for name in re.split(r",\s+", names))
    ended = run(*command)
    may_miss = ended.code == 7 and "Target error" in case.edits
    require(ended.code == 0 or may_miss, f"it ends with {ended.code}: {ended.errors}")

    head, *rows = rows_of(f"{folder}/capabilities.csv")
    require(head == ["capability", "calls", "items", "bytes"], f"the columns are {', '.join(head)}")
    paid = []
    for name, *numbers in rows:
        calls, items, n_bytes = (int(number) for number in numbers)
        costs = f"{calls} calls, {items} items, {n_bytes} bytes"
        if name in required:
            agrees = (required[name] == "yes") == (calls > 0)
            require(agrees, f"{name} is paid for, {costs}, and --check says '{required[name]}'")
        if calls == 0:
            require(items + n_bytes == 0, f"{name} has {costs}")
        else:
            require(items > 0 and (n_bytes > 0 or name in HOLDS_NOTHING), f"{name} has {costs}")
            paid.append(name)
        required.pop(name, None)
    require(not required, "no line of " + ", ".join(sorted(required)))
    expected = sorted(case.capabilities.split(", "))
    require(sorted(paid) == expected, f"it pays for {', '.join(sorted(paid))}, not {', '.join(expected)}")


program = Program(sys.argv[1:])
check = Checks()
enter_folder()
checked_cases = check_at_once()
for case in CASES:
    for ranks in (1, 2) if case.name in ON_TWO_RANKS else (1,):

        @check(f"{case.name}, {ranks} ranks")
        def _() -> None:
            require_costs(case, checked_cases[case], f"r{check.n}", program.on(ranks, "scene.prm"))


sys.exit(check.finish())
