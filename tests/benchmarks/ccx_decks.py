# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the comparisons with CalculiX share: billet's mesh from its own output, runs of CalculiX."""

from __future__ import annotations

import os
import re
from pathlib import Path

from billet_runs import Measured
from billet_tools.output import blocks_of, read_block

Node = tuple[float, ...]  # x, y, z
Brick = list[int]  # numbers of its nodes

CCX_ENVIRONMENT = {
    **os.environ,
    "OMP_NUM_THREADS": "1",
    "CCX_NPROC_EQUATION_SOLVER": "1",
    "CCX_NPROC_RESULTS": "1",
    "NUMBER_OF_CPUS": "1",
}
FACES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))  # S1 ... S6


def read_bodies(file: Path, digits: int) -> tuple[list[Node], list[list[Brick]]]:
    """Nodes, and the bricks (in VTK's order, which is Abaqus', too) of each body, of the fields that billet
    writes at time 0, to so many decimals."""
    nodes: list[Node] = []
    bodies: list[list[Brick]] = []
    for block in blocks_of(file, "Bodies").values():
        _, _, points, cells = read_block(block)
        bodies.append((cells + len(nodes)).tolist())
        nodes += [tuple(place) for place in points.round(digits).tolist()]
    return nodes, bodies


def read_bricks(file: Path, digits: int) -> tuple[list[Node], list[Brick]]:
    """The same of all bodies together."""
    nodes, bodies = read_bodies(file, digits)
    return nodes, [brick for bricks in bodies for brick in bricks]


class CcxJob:
    """A run of `deck.inp` in `folder`, of so many seconds of a processor at most: `seconds`, `megabytes`,
    `iterations` (with those of cut increments), `steps`, `cuts`, the `time` until which it has come, and
    `failure`: why not farther."""

    def __init__(self, folder: str | Path, end: float, limit: int | None = None) -> None:
        def records(name: str) -> list[list[str]]:
            path = Path(folder, name)
            lines = [line.split() for line in path.read_text().splitlines()] if path.exists() else []
            return [words for words in lines if words and words[0].isdigit()]

        done = Measured(["ccx", "deck"], folder, limit, environment=CCX_ENVIRONMENT)
        self.seconds, self.megabytes = done.seconds, done.megabytes
        increments = records("deck.sta")
        self.iterations = len(records("deck.cvg"))
        self.cuts = sum(words[2].endswith("U") for words in increments)
        accepted = [words for words in increments if not words[2].endswith("U")]
        self.steps = len(accepted)
        self.time = float(accepted[-1][4]) if accepted else 0.0
        said = [line.strip() for line in (done.stdout + done.stderr).splitlines() if "*ERROR" in line]
        self.failure = (
            ""
            if self.time > end * (1 - 1e-6)
            else (
                f"{limit} s are over"
                if limit and self.seconds > 0.99 * limit
                else re.sub(r"\s+", " ", said[0])
                if said
                else f"ends with code {done.code}"
            )
        )
