# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shared parts of the tests of shipped scenes: length, history, balance of forces, pages."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Mapping

from checks import SHIPPED, near, read_text, require, rows_of, run

MAX_LINES = 60

Rows = list[dict[str, float]]


def files_of(scene: Path) -> set[Path]:
    """Returns a scene and the files that it includes, other than materials."""
    included = re.findall(r"^\s*include (?!materials/)(\S+)", read_text(scene), re.MULTILINE)
    return {scene}.union(*(files_of(scene.parent / name) for name in included))


def require_short(name: str, counts_included: bool = False) -> None:
    """Checks the length of a scene, alone or with the files that it includes."""
    scene = SHIPPED / f"{name}.prm"
    n_lines = sum(read_text(file).count("\n") for file in (files_of(scene) if counts_included else {scene}))
    require(n_lines <= MAX_LINES, f"{name}: {n_lines} lines, more than {MAX_LINES}")


def history(folder: str) -> Rows:
    """Returns the rows of a run's history."""
    head, *rows = rows_of(f"{folder}/history.csv")
    return [dict(zip(head, map(float, row))) for row in rows]


def require_balance(rows: Rows) -> None:
    """Checks that the forces of each row balance."""
    for row in rows:
        require(abs(row["force_balance_defect"]) <= 1e-12, f"defect {row['force_balance_defect']}")


def run_variant(program: str, scene: str, folder: str, changed: Mapping[str, object]) -> Rows:
    """Runs a scene with changes to its end, and returns its history, in which forces balance."""
    options = [part for item in changed.items() for part in ("--set", "{}={}".format(*item))]
    ended = run(program, scene, "--output", folder, "--set", "Output/Format=none", *options)
    require(ended.code == 0, ended.output + ended.errors)
    rows = history(folder)
    require_balance(rows)
    return rows


def require_page(name: str, page_name: str) -> None:
    """Checks that the page of a scene names it, and has its pictures."""
    page = read_text(SHIPPED.parent / f"doc/scenes/{page_name}.md")
    require(f"prm/{name}.prm" in page, f"the page of {name} does not name its scene")
    for picture in re.findall(r"\]\(\.\./(images/\S+?)\)", page):
        require((SHIPPED.parent / "doc" / picture).exists(), f"no {picture}")


def require_steps(tutorial: str, folder: str) -> None:
    """Checks that a run has the steps and iterations that a tutorial tells of."""
    _, *rows = rows_of(str(SHIPPED.parent / "doc/tutorials/values.csv"))
    kept = {row[0]: row[2] for row in rows if row[1] == "steps and Newton iterations"}
    last = history(folder)[-1]
    n_steps, n_iterations = map(float, kept[tutorial].split(" and "))
    near(f"steps of {tutorial}", last["step"], n_steps, 0.1)  # other machines round otherwise
    near(f"iterations of {tutorial}", last["total_iterations"], n_iterations, 0.1)
