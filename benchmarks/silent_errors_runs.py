# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of the benchmark silent-errors: kept in a folder, so that it can be interrupted, and judged against
references."""

from __future__ import annotations

import math
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Sequence

import numpy

from billet_runs import PROGRAM, Measured  # finds billet_tools, too
from billet_tools.kept import hash_of, hash_of_file, read_json, write_json
from billet_tools.output import Array, Fields, pictures_of, read_grid, read_history
from billet_tools.program import ALONE
from billet_tools.records import Record, read_records, warnings_of
from billet_tools.scene import scene_text

# Warnings about the mesh hold for a reference on the same mesh, too: they do not explain a difference from
# it.
OF_THE_MESH = {
    "bricks-may-lock",
    "coarse-on-tool",
    "element-too-soft",
    "element-too-stiff",
    "faceted-curvature",
    "few-contact-nodes",
    "flat-elements",
    "pressure-checkerboard",
    "tool-smaller-than-facets",
}
OUTCOMES = ("right", "warned", "stopped", "wrong", "no end", "crashed", "refused", "unclear")
Sections = dict[str, Any]  # of a scene, {name: value or sections}
Judge = Callable[..., float]
SECONDS, REFERENCE_SECONDS = 240, 240  # of a processor
UNKNOWN = 0.25  # error of a reference without another one


@dataclass(frozen=True)
class Reference:
    """Reference of a run: that of `scene`, and that of `finer` if the comparison fails. A run is wrong only
    if its error exceeds the allowed one and twice the difference of both. Without scenes the reference is a
    closed form, which the judge has."""

    scene: Sections | None
    finer: Sections | None = None
    excused: frozenset[str] = frozenset()  # warnings that explain no difference from it
    # (run, its reference) -> the relative error; of closed forms the reference is None
    judge: Judge | None = None
    allowed: float = 0.03
    name: str = "small steps"


@dataclass(frozen=True)
class Case:
    family: str
    name: str  # its settings
    scene: Sections
    references: tuple[Reference, ...] = ()


class Kept:
    """Stored output of a run: `code` (None: out of time), `stderr`, `history` (columns), `bodies` (means of
    displacements and velocities at the end), `records`."""

    def __init__(self, record: Record) -> None:
        self.code, self.stderr, self.seconds = record["code"], record["stderr"], record["seconds"]
        self.history = {name: numpy.array(column) for name, column in record["history"].items()}
        self.bodies, self.records = record["bodies"], record["records"]

    @property
    def warnings(self) -> list[str]:
        return warnings_of(self.records)

    @property
    def finished(self) -> bool:
        return self.code in (0, 7)

    def force(self, name: str) -> Array:
        return numpy.stack([self.history[f"{name}.force_{axis}"] for axis in "xyz"], axis=1)


class Runner:
    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        (self.folder / "wrong").mkdir(parents=True, exist_ok=True)
        self.program = Path(PROGRAM).resolve()
        self.fingerprint = hash_of_file(self.program)

    def _file(self, text: str) -> Path:
        return self.folder / f"{hash_of(self.fingerprint, text)[:24]}.json"

    def has(self, scene: Sections) -> bool:
        return self._file(scene_text(scene)).exists()

    def run(self, scene: Sections, seconds: int = SECONDS) -> Kept:
        text = scene_text(scene)
        file = self._file(text)
        record = read_json(file)
        if record is None or (record["code"] is None and record["limit"] < seconds):
            record = self._execute(text, seconds)
            if record["code"] != 5:  # stopped by a signal
                write_json(file, record)
        return Kept(record)

    def _execute(self, text: str, seconds: int) -> Record:
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder)
            (place / "scene.prm").write_text(text)
            done = Measured(
                [str(self.program), "scene.prm"],
                place,
                seconds,
                environment={**ALONE, "TMPDIR": folder},
            )
            out_of_time = done.code < 0 and done.seconds > 0.9 * seconds
            results = place / "results"
            history = {
                name: values.tolist()
                for name, values in read_history(results / "history.csv").items()
                if name in ("time", "total_iterations", "total_cuts")
                or name.endswith(
                    (
                        "force_x",
                        "force_y",
                        "force_z",
                        "moment_x",
                        "moment_y",
                        "moment_z",
                        "_energy",
                        "_work",
                        "_dissipation",
                        "energy_drift",
                        "travel_x",
                        "travel_y",
                        "travel_z",
                        "turn",
                        "momentum_x",
                        "momentum_y",
                        "momentum_z",
                    )
                )
            }
            pictures = pictures_of(results)
            return {
                "code": None if out_of_time else done.code,
                "limit": seconds,
                "seconds": done.seconds,
                "stderr": done.stderr[-1500:],
                "history": history,
                "records": read_records(results / "diagnostics.jsonl"),
                "bodies": means(read_grid(pictures[-1])) if pictures and not out_of_time else {},
            }

    def outcome(self, case: Case) -> tuple[str, str, dict[str, float]]:
        """Returns the outcome of a case, its reason, and its errors: {reference: error}."""
        run = self.run(case.scene)
        if run.code is None:
            return "no end", f"after {SECONDS} s of a processor, time {last(run)}", {}
        if run.code == 2:
            return "refused", run.stderr.strip(), {}
        if run.code == 3:
            return ("stopped" if run.stderr.strip() else "wrong"), run.stderr.strip(), {}
        if not run.finished:
            return "crashed", f"exit code {run.code}: {run.stderr.strip()}", {}
        worst, why, errors = "right", "", {}
        for reference in case.references:
            outcome, said, error = self._compare(run, reference)
            errors[reference.name] = error
            if OUTCOMES_BY_WEIGHT.index(outcome) > OUTCOMES_BY_WEIGHT.index(worst):
                worst, why = outcome, said
        return worst, why, errors

    def _compare(self, run: Kept, reference: Reference) -> tuple[str, str, float]:
        error, doubt = self._error(run, reference)
        if not math.isnan(error) and error <= reference.allowed:
            return "right", "", error
        said = f"off by {100 * error:.3g} % ({reference.name})"
        warnings = set(run.warnings) - reference.excused
        if warnings:
            return "warned", said + f"; warned: {', '.join(sorted(warnings))}", error
        if math.isnan(error) or error <= reference.allowed + 2 * doubt:
            return "unclear", said + f", references by {100 * doubt:.3g} %", error
        return "wrong", said + (f"; only: {', '.join(run.warnings)}" if run.warnings else ""), error

    def _error(self, run: Kept, reference: Reference) -> tuple[float, float]:
        """And by how much references differ, where the run is off."""
        judge = reference.judge
        assert judge is not None, f"the reference {reference.name} has no judge"
        if reference.scene is None:
            return judge(run, None), 0.0
        first = self.run(reference.scene, REFERENCE_SECONDS)
        error = judge(run, first) if first.finished else math.nan
        if error <= reference.allowed:
            return error, 0.0
        if reference.finer is None:
            return error, UNKNOWN
        second = self.run(reference.finer, REFERENCE_SECONDS)
        if not second.finished:
            return error, UNKNOWN
        return judge(run, second), (judge(first, second, True) if first.finished else UNKNOWN)


OUTCOMES_BY_WEIGHT = ("right", "unclear", "warned", "wrong")


def last(run: Kept) -> str:
    times = run.history.get("time", numpy.zeros(0))
    return f"{times[-1]:.3g}" if len(times) else "0"


def last_force(run: Kept) -> float:
    """The largest component of a force at the end."""
    return max(
        (abs(float(values[-1])) for name, values in run.history.items() if "force_" in name and len(values)),
        default=0.0,
    )


def means(fields: Fields) -> dict[str, dict[str, list[float]]]:
    """Mean displacement and velocity of each body, in the order of their numbers; of elements of equal
    size."""
    found = {}
    for number in sorted(set(fields["body"])):
        of = fields["body"] == number
        found[str(int(round(number)))] = {
            name: fields[name][of].mean(axis=0).tolist()
            for name in ("displacement", "velocity")
            if name in fields
        }
    return found


def force_curve(names: Sequence[str], clock: Callable[[Array], Array] = lambda time: time) -> Judge:
    """Largest difference of the forces at the ends of the run's steps, relative to the largest force of the
    reference. `clock`: the reference's time at a time of the run."""

    def judge(run: Kept, reference: Kept, same_clock: bool = False) -> float:
        if not len(run.history.get("time", [])):
            return math.nan
        times = run.history["time"] if same_clock else clock(run.history["time"])
        of = numpy.concatenate([[0.0], reference.history["time"]])
        off, size = 0.0, 0.0
        for name in names:
            curve = numpy.concatenate([numpy.zeros((1, 3)), reference.force(name)])
            exact = numpy.stack([numpy.interp(times, of, column, left=0.0) for column in curve.T], axis=1)
            off = max(off, float(numpy.linalg.norm(run.force(name) - exact, axis=1).max()))
            size = max(size, float(numpy.linalg.norm(curve, axis=1).max()))
        return off / size if size > 0 else math.nan

    return judge


def force_at(names: Sequence[str], times: Sequence[float]) -> Judge:
    """The same at ends of steps that all runs have: between them forces may change faster than references
    have steps."""

    def judge(run: Kept, reference: Kept, same_clock: bool = False) -> float:
        rows = [
            [int(numpy.argmin(abs(r.history["time"] - time))) for time in times] for r in (run, reference)
        ]
        off = max(
            float(numpy.linalg.norm(run.force(n)[rows[0]] - reference.force(n)[rows[1]], axis=1).max())
            for n in names
        )
        return off / max(float(numpy.linalg.norm(reference.force(n)[rows[1]], axis=1).max()) for n in names)

    return judge


def impulse(body: str, start: Sequence[float]) -> Judge:
    """Difference of the mean velocity of a body at the end, relative to its change in the reference."""

    def judge(run: Kept, reference: Kept, same_clock: bool = False) -> float:
        ends = [numpy.array(r.bodies[body]["velocity"]) for r in (run, reference)]
        return float(numpy.linalg.norm(ends[0] - ends[1]) / numpy.linalg.norm(ends[1] - numpy.array(start)))

    return judge
