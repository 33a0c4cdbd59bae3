# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs billet. The result of a run is kept in a folder named by a hash of scene, program and ranks. No run is
ever repeated: a sweep that was stopped continues."""

from __future__ import annotations

import fcntl
import json
import re
import shutil
import statistics
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any, Iterable, Mapping

from .. import UserError
from ..kept import hash_of, hash_of_file, read_json, write_json
from ..program import Program, Stopped, execute
from ..scene import Scene, entries, variant
from . import parameters, results
from .budget import Budget
from .results import Result


Task = tuple[str, Scene, int]  # label, scene, and how often it is timed
Checked = tuple[int, str, dict[str, Any]]  # elements of a scene, why it is refused, and what it is


class Runner:
    """Runs variants of one scene, `jobs` of which may run at a time, each again until it was timed `repeat`
    times."""

    def __init__(self, program: Program, folder: str | Path, limit: float, repeat: int) -> None:
        self.program, self.limit, self.repeat = program, limit, repeat
        self.folder = Path(folder)
        self.stop = threading.Event()
        self._elements: dict[tuple[tuple[str, str], ...], int] = {}
        self._run_here: set[Path] = set()
        self.files: dict[str, Path] = {}  # {path in the scene: absolute file}
        try:
            (self.folder / "runs").mkdir(parents=True, exist_ok=True)
            (self.folder / "checks").mkdir(exist_ok=True)
            self._lock = open(self.folder / "lock", "w")  # as long as this process lives
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UserError(
                f"another billet-trade works in the folder '{folder}': wait for it, or name another --folder"
            ) from None
        except OSError as error:
            raise UserError(f"the folder '{folder}' cannot be written to: {error.strerror}") from None

    def close(self) -> None:
        self._lock.close()

    def prepared(self, scene: Scene) -> str:
        """Returns the text of the run's scene, with absolute names of files."""
        return variant(scene.text, {path: file for path, file in self.files.items() if path in scene.entries})

    def key(self, text: str) -> str:
        contents = [hash_of_file(file) for file in self.files.values()]
        whole = json.dumps(
            [
                results.FORMAT,
                sorted(entries(text).items()),
                contents,
                self.program.fingerprint,
                self.program.ranks,
            ]
        )
        return hash_of(whole)[:20]

    def check(self, scene: Scene) -> Checked:
        """Elements of a scene, why the program refuses it, '' if it does not, and what the program says it
        is."""
        text = self.prepared(scene)
        kept = self.folder / "checks" / (self.key(text) + ".json")
        if not kept.exists():
            file = kept.with_suffix(f".{threading.get_ident()}.prm")
            file.write_text(text)
            code, checked, against = self.program.check(file)
            file.unlink()
            if self.stop.is_set():
                raise Stopped
            if code not in (0, 2):
                raise UserError(f"'{self.program.path} --check' ended with {code}: {against}", 3)
            write_json(
                kept,
                {
                    "code": code,
                    "scene": checked,
                    "against": against.replace(str(file), "scene").replace(file.name, "scene"),
                },
            )
        known = json.loads(kept.read_text())
        why = "" if known["code"] == 0 else known["against"]
        return known["scene"].get("elements", 0), re.sub(r"^scene:?\d*:? ?", "", why), known["scene"]

    def elements(self, scene: Scene) -> int:
        """Returns the number of elements of a scene; scenes with the same meshes are checked once."""
        key = tuple(sorted((path, value) for path, value in scene.entries.items() if "/Mesh/" in path))
        if key not in self._elements:
            self._elements[key] = self.check(scene)[0]
        return self._elements[key]

    def finished(self, scene: Scene, repeat: int | None = None) -> bool:
        """Returns whether a scene needs no more runs."""
        place = self.folder / "runs" / self.key(self.prepared(scene))
        kept = read_json(place / "result.json")
        return kept is not None and kept["status"] != "crashed" and self._enough(kept, repeat or self.repeat)

    def times_left(self, scene: Scene, repeat: int) -> int:
        """Returns the number of runs until the scene has enough timings."""
        if self.finished(scene, repeat):
            return 0
        kept = read_json(self.folder / "runs" / self.key(self.prepared(scene)) / "result.json")
        done = len(kept["seconds"]) if kept is not None and kept["status"] == "ok" else 0
        return max(1, repeat - done)

    def _enough(self, kept: Mapping[str, Any], repeat: int, limit: float | None = None) -> bool:
        if kept["status"] == "out of time" and (limit or self.limit) > 1.01 * kept["limit"]:
            return False
        return kept["status"] != "ok" or len(kept["seconds"]) >= repeat

    def run(self, scene: Scene, repeat: int | None = None, limit: float | None = None) -> Result:
        """The result, from the folder where there is one. `limit`: a shorter time than that of all runs."""
        repeat = repeat or self.repeat
        limit = min(self.limit, limit or self.limit)
        text = self.prepared(scene)
        place = self.folder / "runs" / self.key(text)
        kept = read_json(place / "result.json")
        if kept and kept["status"] == "out of time" and not self._enough(kept, repeat, limit):
            kept = None
        if kept and kept["status"] == "crashed" and place not in self._run_here:
            kept = None  # who knows why: once more
        self._run_here.add(place)
        while kept is None or not self._enough(kept, repeat, limit):
            if self.stop.is_set():
                raise Stopped
            kept = self._run_once(text, place, kept, limit)
        return results.Result(place, kept)

    def _run_once(self, text: str, place: Path, kept: dict[str, Any] | None, limit: float) -> dict[str, Any]:
        work = place if kept is None else place / "again"
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir(parents=True)
        (work / "scene.prm").write_text(text)
        try:
            with self.program.starter() as starter:
                code, seconds, clock = execute(
                    starter, ["scene.prm"], work, limit, self.stop, self.program.ranks
                )
        except Stopped:
            shutil.rmtree(work, ignore_errors=True)
            raise
        if kept is None:
            kept = results.collect(work, code, limit)
            kept.update(seconds=[seconds], clock=clock)
        else:
            kept["seconds"].append(seconds)
            shutil.rmtree(work)
        kept["core_seconds"] = statistics.median(kept["seconds"])
        write_json(place / "result.json", kept)
        return kept


class Progress:
    """Prints a line for each run, with the remaining time. It follows from the runs so far, and from size,
    steps and repeats of the rest."""

    def __init__(
        self, base_elements: int, base_steps: int, base_clock: float, is_explicit: bool, jobs: int
    ) -> None:
        self.base, self.is_explicit, self.jobs = (
            (base_elements, base_steps, max(base_clock, 1e-3)),
            is_explicit,
            jobs,
        )
        self.done = self.total = 0
        self.left, self.spent, self.expected_so_far = 0.0, 0.0, 0.0

    def expected(self, elements: int, steps: float, repeats: int) -> float:
        size: float = (elements / max(1, self.base[0])) ** (4 / 3)
        length: float = 1.0 if self.is_explicit else (steps / self.base[1]) ** 0.7
        return self.base[2] * max(0.3, size * length) * repeats

    def plan(self, seconds: float) -> None:
        self.total += 1
        self.left += seconds

    def pace(self) -> float:
        """Seconds on the clock for one that was expected."""
        return self.spent / self.expected_so_far if self.expected_so_far > 0 else 1.0

    def leave_out(self, planned: float) -> None:
        """Takes a run that the budget does not reach off those to go."""
        self.total -= 1
        self.left = max(0.0, self.left - planned)

    def report(self, label: str, result: Result, planned: float, took: float, was_kept: bool) -> None:
        self.done += 1
        self.left = max(0.0, self.left - planned)
        if not was_kept:
            self.spent += took
            self.expected_so_far += planned
        work = (
            f"{result.newton + result.linear} iterations" if not self.is_explicit else f"{result.steps} steps"
        )
        to_go = (
            "" if self.done == self.total else f"; about {clock(self.left * self.pace() / self.jobs)} to go"
        )
        kept = ", kept from before" if was_kept else ""
        print(
            (
                f"[{self.done:>{len(str(self.total))}}/{self.total}] {label}: {result.status},"
                f" {result.core_seconds:.3g} core-s, {work}{kept}{to_go}"
            ),
            file=sys.stderr,
            flush=True,
        )


def clock(seconds: float) -> str:
    return (
        f"{seconds:.0f} s"
        if seconds < 100
        else f"{seconds / 60:.0f} min"
        if seconds < 6000
        else f"{seconds / 3600:.1f} h"
    )


class Work:
    """Runs that are to be made, each scene once, in order and as far as the budget reaches. `left_out` names
    those that it does not reach; `was_stopped`: by Ctrl-C, so that only a part was run."""

    def __init__(
        self, runner: Runner, progress: Progress, scene: Scene, budget: Budget | None = None
    ) -> None:
        self.runner, self.progress, self.scene = runner, progress, scene
        self.budget = budget or Budget()
        self.left_out: dict[str, float] = {}  # {label: seconds that it should take}
        self.was_stopped = False

    def expected(self, scene: Scene, repeats: int) -> float:
        elements = self.runner.elements(scene)
        if scene.get("Target error of") == "everything":
            elements *= 8 ** int(scene.get("Finest mesh level") or 1)
        steps = float(self.progress.base[1])
        if not scene.is_explicit:
            steps *= parameters.longest_steps(scene) / parameters.longest_steps(self.scene)
        return self.progress.expected(elements, steps, repeats)

    def run(self, tasks: Iterable[Task], jobs: int) -> dict[str, Result]:
        """Results by the key of the scene, of (label, scene, repeats). If the user stops the study, the
        results so far."""
        planned: dict[str, Task] = {}
        found = {}
        for label, scene, repeats in tasks:
            key = self.runner.key(self.runner.prepared(scene))
            known = planned.get(key)
            planned[key] = (known[0] if known else label, scene, max(repeats, known[2] if known else 0))
        times = {key: self.runner.times_left(scene, repeats) for key, (_, scene, repeats) in planned.items()}
        left = {key: self.expected(scene, max(1, times[key])) for key, (_, scene, _) in planned.items()}
        for seconds in left.values():
            self.progress.plan(seconds)

        def one(key: str) -> tuple[str, Result | None, float, bool]:
            label, scene, repeats = planned[key]
            begin = time.monotonic()
            if times[key] == 0:
                return key, self.runner.run(scene, repeats), 0.0, True
            if self.runner.stop.is_set():
                raise Stopped
            if not self.budget.take(left[key] * self.progress.pace(), times[key]):
                return key, None, 0.0, False
            limit = max(1.0, min(self.runner.limit, self.budget.seconds_left()))
            result = self.runner.run(scene, repeats, limit)
            is_cut = result.status == "out of time" and limit < self.runner.limit
            return key, None if is_cut else result, time.monotonic() - begin, False

        beyond = 0
        with ThreadPoolExecutor(jobs) as pool:
            futures = [pool.submit(one, key) for key in planned]
            try:
                for future in as_completed(futures):
                    try:
                        key, result, took, was_kept = future.result()
                    except Stopped:
                        # Those that wait end by themselves. Of cancelled ones the pool tells nothing to
                        # as_completed(), which would wait for ever.
                        self.was_stopped = True
                        continue
                    label = planned[key][0]
                    if result is None:
                        self.left_out[label] = left[key]
                        self.progress.leave_out(left[key])
                        beyond += 1
                    else:
                        found[key] = result
                        self.progress.report(label, result, left[key], took, was_kept)
            except BaseException:
                self.runner.stop.set()
                pool.shutdown(wait=True, cancel_futures=True)
                raise
        if beyond:
            print(f"beyond what is left of the budget, and left out: {beyond} of the runs", file=sys.stderr)
        return found

    def has(self, found: Mapping[str, Result], scene: Scene) -> bool:
        return self.runner.key(self.runner.prepared(scene)) in found

    def result(self, found: Mapping[str, Result], scene: Scene) -> Result:
        return found[self.runner.key(self.runner.prepared(scene))]
