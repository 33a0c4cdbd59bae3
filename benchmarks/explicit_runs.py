# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shared parts of the benchmarks of explicit scenes: runs, their histories and their last pictures."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Iterable

import numpy

from billet_runs import PROGRAM, Changes, read_scene, variant
from billet_tools.output import Array, Fields, max_drift, pictures_of, read_grid, read_history, read_numbers
from billet_tools.program import FAILED, Measured, command_of


class ExplicitRun:
    """A run in `folder`: `rows` of the history as numbers, `seconds` (user and system, of all ranks), whether
    it `finished`, what was `said`, and `failure`."""

    def __init__(self, scene: Path, changes: Changes, folder: str | Path, ranks: int = 1) -> None:
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / "scene.prm").write_text(
            variant(read_scene(scene), {"Output/Folder": "results", "Output/Verbosity": "quiet", **changes})
        )
        done = Measured(command_of(PROGRAM, ranks, "scene.prm"), self.folder)
        done.require_end()
        self.seconds, self.finished = done.seconds, done.code != FAILED
        self.said, self.failure = done.stdout, done.stderr.strip()
        self.rows = read_numbers(self.folder / "results/history.csv")
        said = ", ".join(f"{key.split('/')[-1]} = {value}" for key, value in changes.items())
        print(f"[{scene.stem}: {said}] {self.steps} steps, {self.seconds:.3g} s", file=sys.stderr, flush=True)

    @property
    def steps(self) -> int:
        return int(self.rows[-1]["step"]) if self.rows else 0

    def max_drift(self) -> float:
        """Returns the maximum drift of the energy ledger, relative to the largest sum of energies."""
        return max_drift(read_history(self.folder / "results/history.csv"))

    def picture(self, number: int = -1) -> tuple[Array, Fields]:
        """Points of a written picture, and its fields by name."""
        fields = read_grid(pictures_of(self.folder / "results")[number])
        return fields["points"], fields


def norm(vectors: Array, axes: Iterable[int]) -> Array:
    total: Array = numpy.sqrt(sum(vectors[:, axis] ** 2 for axis in axes))
    return total
