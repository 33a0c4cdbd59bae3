# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of any scene, their cost, and the errors of their curves: what benchmarks of profiles and target
errors share."""

from __future__ import annotations

import copy
import csv
import functools
import sys
import tempfile
from bisect import bisect_right
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Iterable, Sequence

from billet_runs import PROGRAM, ROOT, Changes, read_scene, variant  # finds billet_tools, too
from billet_tools.kept import hash_of, hash_of_file, read_json, write_json
from billet_tools.output import read_estimates, read_rows
from billet_tools.program import COMPLETED, FAILED, Measured, command_of
from billet_tools.scene import with_absolute_files

Curves = dict[str, list[tuple[float, ...]]]  # vectors at the times of a run, by name

KEPT = ROOT / "results/runs"
# In names of forces that (W1) of the theory leaves out.
OTHERS = ("pair ", ".support ", ".symmetry plane ", ".load ")
LAYOUT = "with reactions"  # of kept runs: others are not found
_asked: Counter[str] = Counter()  # what this process runs several times, to time it, runs as often


@functools.lru_cache(maxsize=1)
def program_hash() -> str:
    return hash_of_file(Path(PROGRAM))


class CurveRun:
    """A run of a scene with changes as of billet_runs.variant(), None for what is left out: whether it
    `finished`, `times`, `forces` of tools and pairs of bodies by name, `reactions` (these, and forces of
    supports, symmetry planes, loads and each pair with a tool), `energies` and `curves` (forces; without any,
    reactions; of explicit scenes energies), `seconds` (user and system), `steps`, `work` (Newton iterations;
    of explicit scenes element updates), what it `believed` (error_estimate.csv), what was `said`, and its
    `failure`. Kept in results/runs, where the same run of the same program is found again."""

    timed = False  # once more, alone

    def __init__(self, scene: Path, changes: Changes, ranks: int = 1) -> None:
        text = variant(
            with_absolute_files(read_scene(scene), scene.parent),
            {"Output/Format": "none", "Output/Verbosity": "steps", "Output/Folder": "results", **changes},
        )
        key = hash_of(LAYOUT, program_hash(), str(ranks), text)[:24]
        _asked[key] += 1
        file = KEPT / f"{key}-{_asked[key]}.json"
        kept = read_json(file)
        if kept is None:
            self._run(text, ranks)
            KEPT.mkdir(parents=True, exist_ok=True)
            write_json(file, self.__dict__)
        else:
            self.__dict__.update(kept)
        print(
            f"[{scene.stem}: "
            + ", ".join(f"{key.split('/')[-1]} = {value}" for key, value in changes.items())
            + f"] {self.steps} steps, {self.work}, {self.seconds:.3g} s"
            + ("" if self.finished else ", failed"),
            file=sys.stderr,
            flush=True,
        )

    def _run(self, text: str, ranks: int) -> None:
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder)
            (place / "scene.prm").write_text(text)
            done = Measured(command_of(PROGRAM, ranks, "scene.prm"), place)
            if done.code not in (*COMPLETED, FAILED):
                raise RuntimeError(f"billet ended with {done.code}: {done.stderr}")
            rows = read_rows(place / "results/history.csv")
            self.believed = read_estimates(place / "results")
        self.mesh_error = float(rows[-1]["mesh_error"]) if rows else float("nan")
        self.geometry_error = float(rows[-1]["geometry_error"]) if rows else float("nan")
        self.seconds, self.said = done.seconds, done.stdout
        self.finished, self.failure = done.code != FAILED, done.stderr.strip()
        self.is_explicit = bool(rows) and "total_iterations" not in rows[0]
        self.times = [float(row["time"]) for row in rows]
        names = [key[: -len(".force_x")] for key in (rows[0] if rows else {}) if key.endswith(".force_x")]
        self.reactions: Curves = {
            name: [tuple(float(row[f"{name}.force_{axis}"]) for axis in "xyz") for row in rows]
            for name in names
        }
        self.forces = {
            name: curve for name, curve in self.reactions.items() if not any(word in name for word in OTHERS)
        }
        self.energies: Curves = {
            "kinetic": [(float(row.get("kinetic_energy", 0.0)),) for row in rows],
            "stored or dissipated": [
                (
                    float(row["elastic_energy"])
                    + float(row["plastic_work"])
                    + float(row["friction_dissipation"]),
                )
                for row in rows
            ],
        }
        self.curves = self.energies if self.is_explicit else self.forces or self.reactions
        self.steps = int(rows[-1]["step"]) if rows else 0
        said_elements = [
            line for line in self.said.splitlines() if " elements, " in line and " unknowns, " in line
        ]
        self.elements = int(said_elements[0].split()[0]) if said_elements else 0
        self.work = (
            self.steps * self.elements
            if self.is_explicit
            else (int(rows[-1]["total_iterations"]) if rows else 0)
        )

    def at(self, name: str, time: float) -> tuple[float, ...]:
        """The curve's value, straight lines between the rows, from zero at time 0."""
        times, curve = self.times, self.curves[name]
        i = bisect_right(times, time)
        if i == len(times):
            return curve[-1]
        before = curve[i - 1] if i > 0 else tuple(0.0 for _ in curve[0])
        start = times[i - 1] if i > 0 else 0.0
        part = (time - start) / (times[i] - start)
        return tuple(a + part * (b - a) for a, b in zip(before, curve[i]))


def run_all(scene: Path, variants: Iterable[Changes], ranks: int = 1, at_once: int = 3) -> list[CurveRun]:
    """A CurveRun of each of these changes, in their order."""
    with ThreadPoolExecutor(at_once) as pool:
        return list(pool.map(lambda changes: CurveRun(scene, changes, ranks), variants))


def error(run: CurveRun, reference: CurveRun) -> float:
    """∫Σ|F − F*| dt over ∫Σ|F*| dt at the ends of the run's steps, by the trapezoidal rule, over all
    curves."""
    if not run.finished or not run.times:
        return float("nan")
    off, size = [], []
    for i, time in enumerate(run.times):
        exact = {name: reference.at(name, time) for name in run.curves}
        off.append(
            sum(
                sum((a - b) ** 2 for a, b in zip(run.curves[name][i], exact[name])) ** 0.5
                for name in run.curves
            )
        )
        size.append(sum(sum(b * b for b in exact[name]) ** 0.5 for name in run.curves))

    def integral(values: Sequence[float]) -> float:
        return sum(
            0.5 * (a + b) * (t - s) for a, b, s, t in zip(values, values[1:], run.times, run.times[1:])
        )

    return integral(off) / integral(size) if integral(size) > 0 else float("nan")


def impulses(run: CurveRun) -> Curves:
    """∫F dt of each tool and pair until each of the run's times, by the trapezoidal rule."""
    result = {}
    for name, forces in run.forces.items():
        sums: list[tuple[float, ...]] = [(0.0, 0.0, 0.0)]
        for s, t, a, b in zip(run.times, run.times[1:], forces, forces[1:]):
            sums.append(tuple(total + 0.5 * (t - s) * (x + y) for total, x, y in zip(sums[-1], a, b)))
        result[name] = sums
    return result


def with_curves(run: CurveRun, curves: Curves) -> CurveRun:
    """The run with other curves, for error()."""
    run = copy.copy(run)
    run.curves = curves
    return run


def write_csv(name: str, head: Iterable[str], rows: Iterable[Iterable[object]]) -> None:
    """doc/results/NAME.csv."""
    with open(ROOT / "doc/results" / f"{name}.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows(rows)
