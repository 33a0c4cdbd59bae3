# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shared parts of the tests of shipped scenes: length, history, balance of forces, pages."""

from __future__ import annotations

import re
from pathlib import Path

from checks import SHIPPED, read_text, require, rows_of

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


def require_page(name: str, page_name: str) -> None:
    """Checks that the page of a scene names it, and has its pictures."""
    page = read_text(SHIPPED.parent / f"doc/scenes/{page_name}.md")
    require(f"prm/{name}.prm" in page, f"the page of {name} does not name its scene")
    for picture in re.findall(r"\]\(\.\./(images/\S+?)\)", page):
        require((SHIPPED.parent / "doc" / picture).exists(), f"no {picture}")
