# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of edited scenes in an empty current folder, for runs.py and failed_runs.py: block.prm, or another of
this folder, with an edit (edits.py)."""

from __future__ import annotations

import sys
from typing import Callable

from checks import HERE, Checks, Program, Run, Runner, enter_folder, read_text, require, run, write_text

BLOCK, IMPACT, CAVITY, STRIP = (
    read_text(HERE / f"{name}.prm") for name in ("block", "impact", "cavity", "held_strip")
)
NO_MESH = "Mesh: - Primitive & Mesh: - Arguments & Mesh: - Boundary ids & Mesh: Source = file & Mesh: File = "
FIXED = "Time stepping: Step control = fixed & Time stepping: - Maximum step"
NO_LAW = "Material: - Yield stress & Material: - Hardening modulus & Material: Hardening = "
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


reference = billet()
COLUMNS = (
    "time",
    "die.force_x",
    "die.force_y",
    "die.force_z",
    "die.contact_area",
    "elastic_energy",
    "plastic_work",
    "friction_dissipation",
)


def require_same(ran: Run, other: Run, tolerance: float) -> None:
    """Compares all rows of the history with those of another run."""
    for name in COLUMNS:
        found, expected = ran.column(name), other.column(name)
        require(len(found) == len(expected), f"{len(found)} steps, not {len(expected)}")
        size = max(abs(value) for value in expected)
        for row, (x, y) in enumerate(zip(found, expected)):
            require(abs(x - y) <= tolerance * size + 1e-9, f"{name} in row {row} is {x}, not {y}")


def same(
    name: str,
    edits: str,
    *,
    ranks: int = 1,
    rewrite: Callable[[str], str] | None = None,
    as_run: Run = reference,
    tolerance: float = 1e-6,
) -> None:
    """Checks that a scene comes out as another one."""

    @check(name)
    def _() -> None:
        require_same(billet(edits, ranks=ranks, rewrite=rewrite), as_run, tolerance)
