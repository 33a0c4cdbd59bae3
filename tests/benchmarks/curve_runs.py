# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of any scene, their cost, and the errors of their curves: what benchmarks of profiles and target
errors share."""

import copy
import csv
import functools
import hashlib
import os
import subprocess
import sys
import tempfile
from bisect import bisect_right
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from billet_runs import PROGRAM, ROOT, read_scene, variant  # finds billet_trade, too
from billet_trade.runs import read_json, write_json

KEPT = ROOT / "results/runs"
_asked = Counter()  # what this process runs several times, to time it, runs as often


@functools.lru_cache(maxsize=1)
def program_hash():
    return hashlib.sha256(Path(PROGRAM).read_bytes()).hexdigest()


class CurveRun:
    """A run of a scene with changes as of billet_runs.variant(), None for what is left out: whether it
    `finished`, `times`, `forces` of tools and pairs of bodies by name, `energies` and `curves` (forces; of
    explicit scenes energies), `seconds` (user and system), `steps`, `work` (Newton iterations; of explicit
    scenes element updates), what it `believed` (error_estimate.csv), what was `said`, and its `failure`. Kept
    in results/runs, where the same run of the same program is found again."""

    def __init__(self, scene, changes, ranks=1):
        left_out = {key for key, value in changes.items() if value is None}
        changes = {key: value for key, value in changes.items() if value is not None}
        text = variant(
            without(absolute_files(read_scene(scene), scene.parent), left_out),
            {"Output/Format": "none", "Output/Verbosity": "steps", "Output/Folder": "results", **changes},
        )
        key = hashlib.sha256(f"{program_hash()} {ranks} {text}".encode()).hexdigest()[:24]
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

    def _run(self, text, ranks):
        with tempfile.TemporaryDirectory() as place:
            (Path(place) / "scene.prm").write_text(text)
            command = ([] if ranks == 1 else ["mpirun", "-n", str(ranks)]) + [PROGRAM, "scene.prm"]
            # Of this process and its own, since others may run beside it.
            with open(Path(place) / "out", "w+") as out, open(Path(place) / "errors", "w+") as errors:
                process = subprocess.Popen(command, cwd=place, stdout=out, stderr=errors)
                _, status, usage = os.wait4(process.pid, 0)
                code = process.returncode = os.waitstatus_to_exitcode(status)
                self.seconds = usage.ru_utime + usage.ru_stime
            self.said, self.failure = ((Path(place) / name).read_text() for name in ("out", "errors"))
            if code not in (0, 3, 6, 7):
                raise RuntimeError(f"billet ended with {code}: {self.failure}")
            with open(Path(place) / "results/history.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            believed = Path(place) / "results/error_estimate.csv"
            self.believed = {}
            if believed.exists():
                with open(believed, newline="") as file:
                    self.believed = {row["quantity"]: float(row["value"]) for row in csv.DictReader(file)}
        self.finished, self.failure = code != 3, self.failure.strip()
        self.is_explicit = bool(rows) and "total_iterations" not in rows[0]
        self.times = [float(row["time"]) for row in rows]
        names = [key[: -len(".force_x")] for key in (rows[0] if rows else {}) if key.endswith(".force_x")]
        self.forces = {
            name: [tuple(float(row[f"{name}.force_{axis}"]) for axis in "xyz") for row in rows]
            for name in names
        }
        self.energies = {
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
        self.curves = self.energies if self.is_explicit else self.forces
        self.steps = int(rows[-1]["step"]) if rows else 0
        said_elements = [
            line for line in self.said.splitlines() if " elements, " in line and " dofs, " in line
        ]
        self.elements = int(said_elements[0].split()[0]) if said_elements else 0
        self.work = (
            self.steps * self.elements
            if self.is_explicit
            else (int(rows[-1]["total_iterations"]) if rows else 0)
        )

    def at(self, name, time):
        """The curve's value, straight lines between the rows, from zero at time 0."""
        times, curve = self.times, self.curves[name]
        i = bisect_right(times, time)
        if i == len(times):
            return curve[-1]
        before = curve[i - 1] if i > 0 else tuple(0.0 for _ in curve[0])
        start = times[i - 1] if i > 0 else 0.0
        part = (time - start) / (times[i] - start)
        return tuple(a + part * (b - a) for a, b in zip(before, curve[i]))


def run_all(scene, variants, ranks=1, at_once=3):
    """A CurveRun of each of these changes, in their order."""
    with ThreadPoolExecutor(at_once) as pool:
        return list(pool.map(lambda changes: CurveRun(scene, changes, ranks), variants))


def without(text, keys):
    """The scene without the entries 'Subsection/.../key'."""
    path, lines = [], []
    for line in text.splitlines():
        statement = line.split("#")[0].strip()
        if statement.startswith("subsection "):
            path.append(statement.split(None, 1)[1].strip())
        elif statement == "end":
            path.pop()
        elif statement.startswith("set ") and "/".join(path + [statement[4:].split("=")[0].strip()]) in keys:
            continue
        lines.append(line)
    return "\n".join(lines) + "\n"


def read_entries(scene):
    """What a scene sets: {'Subsection/.../key': value}."""
    path, entries = [], {}
    for line in read_scene(scene).splitlines():
        statement = line.split("#")[0].strip()
        if statement.startswith("subsection "):
            path.append(statement.split(None, 1)[1].strip())
        elif statement == "end":
            path.pop()
        elif statement.startswith("set "):
            key, value = statement[4:].split("=", 1)
            entries["/".join(path + [key.strip()])] = value.strip()
    return entries


def absolute_files(text, folder):
    """The scene with the files that it names found from anywhere."""
    lines = []
    for line in text.splitlines():
        words = line.split("#")[0].split()
        if words[:2] == ["set", "File"] and words[3:] and not words[3].startswith("/"):
            line = line.replace(words[3], str((folder / words[3]).resolve()), 1)
        lines.append(line)
    return "\n".join(lines) + "\n"


def error(run, reference):
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

    def integral(values):
        return sum(
            0.5 * (a + b) * (t - s) for a, b, s, t in zip(values, values[1:], run.times, run.times[1:])
        )

    return integral(off) / integral(size) if integral(size) > 0 else float("nan")


def impulses(run):
    """∫F dt of each tool and pair until each of the run's times, by the trapezoidal rule."""
    result = {}
    for name, forces in run.forces.items():
        sums = [(0.0, 0.0, 0.0)]
        for s, t, a, b in zip(run.times, run.times[1:], forces, forces[1:]):
            sums.append(tuple(total + 0.5 * (t - s) * (x + y) for total, x, y in zip(sums[-1], a, b)))
        result[name] = sums
    return result


def with_curves(run, curves):
    """The run with other curves, for error()."""
    run = copy.copy(run)
    run.curves = curves
    return run


def write_csv(name, head, rows):
    """doc/results/NAME.csv."""
    with open(ROOT / "doc/results" / f"{name}.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows(rows)
