#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: refinement.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

Runs of refined.prm and refined_impact.prm whose meshes become finer on the way. They are judged by runs on
meshes that are fine from the start, by fields that a finer mesh must carry over exactly, and by each other on
other numbers of ranks and after restarts.
"""

from __future__ import annotations

import re
import sys
from glob import glob

from checks import HERE, Checks, Program, Run, Runner, enter_folder, near, read_text, require, says
from edits import edit

BLOCK, IMPACT = (read_text(HERE / f"{name}.prm") for name in ("refined", "refined_impact"))
program = Program(sys.argv[1:])
runner = Runner(program)
check = Checks()
enter_folder()

HALF = "block: + set Refinement times = 0.5"
FINE = "Bodies / block / Mesh: Refinements = 1"
ROUGH = "top on die: + set Friction coefficient = 0.3"
LAYERS = ("mean dilatation", "assumed strain", "one point")


def runs(base: str, edits: str, ranks: int = 1) -> Run:
    """Returns a run that must succeed."""
    result = runner.run(base, edits, ranks=ranks)
    require(result.ended.code == 0, f"exit code {result.ended.code}: {result.complained}{result.said[-500:]}")
    return result


def combined(*edits: str) -> str:
    """Returns all edits as one."""
    return " & ".join(text for text in edits if text)


def worst(a: Run, b: Run, column: str) -> float:
    """Returns the largest difference of a column, relative to its largest number."""
    x, y = a.column(column), b.column(column)
    require(len(x) == len(y), f"{len(x)} rows, not {len(y)}")
    return max(abs(p - q) for p, q in zip(x, y)) / max(1e-300, *(abs(p) for p in x))


def note(result: Run) -> re.Match[str]:
    """Returns the message about the refinement: its energy."""
    return says(r"Each element is divided into eight: .*?The energy changes by (\S+)", result.said)


# --- fields that a finer mesh has, too ------------------------------------------------------------

STATIC = ("die.force_z", "elastic_energy", "plastic_work", "external_work")
for element in LAYERS:

    @check(f"uniform upsetting, {element}")
    def _() -> None:
        shape = f"block: + set Element = {element}"
        coarse, refined = runs(BLOCK, shape), runs(BLOCK, combined(shape, HALF))
        for column in STATIC:
            difference = worst(coarse, refined, column)
            require(difference < 1e-8, f"{column} differs by {difference}")
        note(refined)
        says("4 elements become 32", refined.said)


@check("uniform upsetting, refined twice")
def _() -> None:
    coarse = runs(BLOCK, "")
    refined = runs(BLOCK, "block: + set Refinement times = 0.3, 0.7")
    for column in STATIC:
        difference = worst(coarse, refined, column)
        require(difference < 1e-8, f"{column} differs by {difference}")
    says("32 elements become 256", refined.said)


sys.exit(check.finish() if hasattr(check, "finish") else 0)
