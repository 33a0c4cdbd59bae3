# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of edited scenes in an empty current folder, for runs.py and failed_runs.py: block.prm, or another of
this folder, with an edit (edits.py)."""

from __future__ import annotations

import sys
from typing import Callable

from checks import HERE, Checks, Program, Run, Runner, enter_folder, read_text, require, run, write_text

BLOCK, IMPACT = (read_text(HERE / f"{name}.prm") for name in ("block", "impact"))
FIXED = "Time stepping: Step control = fixed & Time stepping: - Maximum step"
ELASTIC = (
    "Material: Law = elastic & Material: - Hardening & Material: - Yield stress"
    " & Material: - Hardening modulus"
)

program = Program(sys.argv[1:])
runner = Runner(program)
check = Checks()
enter_folder()


def billet(
    edits: str = "",
    *,
    base: str = BLOCK,
    rewrite: Callable[[str], str] | None = None,
    file: str = "scene.prm",
    ranks: int = 1,
    code: int | None = None,
) -> Run:
    """Runs a scene, edited, into a folder of its own; a fault unless the exit code is the expected one.
    Whether a target is missed is the business of the checks that give a code."""
    folder, text = runner.scene(base, edits)
    write_text(file, rewrite(text) if rewrite else text)
    ran = Run(folder, run(*program.on(ranks, file)))
    expected = code if code is not None else 7 if ran.ended.code == 7 and "Target error" in edits else 0
    said = ran.said + ran.complained
    require(ran.ended.code == expected, f"exit code {ran.ended.code}, not {expected}\n{said}")
    require(expected not in (0, 7) or not ran.complained, ran.complained)
    return ran
