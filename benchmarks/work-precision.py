# SPDX-License-Identifier: LGPL-2.1-or-later
"""Error over CPU seconds of six scenes, in billet and in CalculiX on the same meshes."""

from __future__ import annotations

import argparse
import csv
import math
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Callable, NamedTuple, Sequence

from billet_runs import PROGRAM, ROOT, Changes, Measured, number, percent, publish, table
from ccx_decks import CcxJob
from precision_picture import Point, draw, without_luck
from precision_scenes import SCENES, Curve, Job, Reference, Scene, difference

parser = argparse.ArgumentParser(prog="scripts/benchmarks work-precision")
parser.add_argument("--quick", action="store_true", help="two meshes a scene; the page stays as it is")
parser.add_argument("--large", action="store_true", help="nothing more")
parser.add_argument("--ranks", type=int, default=1, help="of no use: CalculiX has one")
parser.add_argument("--scene", action="append", help="only these; other rows stay as they are")
parser.add_argument("--page", action="store_true", help="write the page from the raw data, and run nothing")
options = parser.parse_args()
options.large, options.ranks = False, 1
LIMIT = 40  # seconds of a processor for each run of CalculiX
SHORT = 0.5  # runs that take less are timed three times
FILE = ROOT / "doc/results/work-precision.csv"
PICTURES = ROOT / "doc/images"
PROGRAMS = ("billet", "CalculiX")
GOAL = 0.01
REFERENCE = "reference"
START = "start"  # stands for a scene in the raw data: the program alone
TARGETS = (0.05, 0.02, 0.01, 0.005, 0.002)


class Row(NamedTuple):
    """A run as a line of the raw data. `stops` is why it ended before its time."""

    scene: str
    program: str
    setting: str
    elements: int
    steps: int
    iterations: int
    seconds: float
    value: float
    error: float
    stops: str

    @property
    def point(self) -> Point:
        return Point(self.program, self.setting, self.elements, self.seconds, self.error)


class Result(NamedTuple):
    """Result of a run: steps, iterations, seconds, the compared curve, and the reason of its end."""

    steps: int
    iterations: int
    seconds: float
    curve: Curve
    stops: str


def billet(scene: Scene, changes: Changes) -> Result:
    with tempfile.TemporaryDirectory() as folder:
        run = scene.run(changes, folder)
        iterations = int(run.rows[-1]["total_iterations"]) if run.rows else 0
        failure = re.sub(r"\s+", " ", run.failure)[:100]
        return Result(run.steps, iterations, run.seconds, scene.curve(run), "" if run.finished else failure)


def calculix(scene: Scene, mesh: Changes, job: Job) -> tuple[int, Callable[[], Result]]:
    """Returns the number of elements of the bodies, and what runs the deck."""
    deck = scene.deck({**scene.always, **mesh}, job.element)

    def run() -> Result:
        with tempfile.TemporaryDirectory() as folder:
            penalty = scene.penalty or (deck.penalty() if deck.pairs else 0.0)
            end = deck.write(
                Path(folder, "deck.inp"),
                job.contact,
                scene.friction,
                penalty * job.penalty,
                scene.prints,
                job.shorter,
            )
            done = CcxJob(folder, end, LIMIT)
            curve = scene.printed(Path(folder), deck) if not done.failure else []
        stops = f"at {done.time:.3g} of {end:.3g}: {done.failure}" if done.failure else ""
        return Result(done.steps, done.iterations, done.seconds, curve, stops)

    return sum(len(bricks) for bricks in deck.bodies[: scene.n_bodies]), run


def measured(
    scene: Scene, program: str, setting: str, elements: int, run: Callable[[], Result], exact: Reference
) -> Row:
    found = run()
    seconds = found.seconds
    if found.seconds < SHORT and not found.stops:
        seconds = statistics.median([seconds, run().seconds, run().seconds])
    value = found.curve[-1][1] if found.curve else math.nan
    error = math.nan if found.stops else difference(found.curve, exact.curve)
    row = Row(
        scene.name,
        program,
        setting,
        elements,
        found.steps,
        found.iterations,
        round(seconds, 4),
        value,
        error,
        found.stops,
    )
    print(f"[{', '.join(str(cell) for cell in row)}]", file=sys.stderr, flush=True)
    return row


def rows_of(scene: Scene, exact: Reference) -> list[Row]:
    rows = []
    for mesh in scene.levels[: 2 if options.quick else scene.n_levels]:
        elements = 0
        found = []
        for job in scene.jobs:
            elements, run = calculix(scene, mesh, job)
            found.append(measured(scene, "CalculiX", job.name, elements, run, exact))
        for name, changes in scene.settings.items():
            both = {**mesh, **changes}
            rows.append(measured(scene, "billet", name, elements, lambda: billet(scene, both), exact))
        rows += found
    return rows


def reference_row(scene: Scene, exact: Reference) -> Row:
    """Returns the reference as a line of the raw data; its error is its uncertainty."""
    return Row(scene.name, REFERENCE, scene.source, 0, 0, 0, 0.0, exact.curve[-1][1], exact.uncertainty, "")


def counted(rows: Sequence[Row], program: str) -> list[Point]:
    return without_luck([row.point for row in rows if row.program == program])


def cheapest(rows: Sequence[Row], program: str, target: float) -> Point | None:
    """Returns the run of least seconds whose error is at most the target, also on finer meshes."""
    good = [point for point in counted(rows, program) if point.error <= target]
    return min(good, key=lambda point: point.seconds) if good else None


def targets_table(rows: Sequence[Row], uncertainty: float) -> str:
    lines = []
    for target in (t for t in TARGETS if t >= uncertainty):
        line: list[object] = [percent(target)]
        for program in PROGRAMS:
            row = cheapest(rows, program, target)
            line += [number(row.seconds, 3), row.elements, row.setting] if row else ["–", "–", "none"]
        lines.append(line)
    head = [word for name in PROGRAMS for word in (f"{name}: CPU s", "elements", "setting")]
    return table(["error at most", *head], lines)


def section(scene: Scene, rows: Sequence[Row]) -> str:
    exact, *runs = rows
    picture = PICTURES / f"work_precision_{scene.name}.png"
    draw(picture, scene.title, [row.point for row in runs], exact.error)
    elements = sorted({row.elements for row in runs})
    return (
        f"## {scene.title}\n\n"
        f"![Error over CPU seconds](../images/{picture.name})\n\n"
        f"- Compared: {scene.quantity}, {number(exact.value, 5)} {scene.unit}.\n"
        f"- Reference: {scene.source}. It is known to {percent(exact.error)}.\n"
        f"- Elements: {', '.join(str(n) for n in elements)}.\n\n" + targets_table(runs, exact.error)
    )


def summary(rows: dict[str, list[Row]], start: float) -> tuple[str, str]:
    """Returns the sentence and the table of what 1 % costs."""
    lines, wins, wins_without = [], {name: 0 for name in PROGRAMS}, 0
    for scene in SCENES:
        found = {name: cheapest(rows[scene.name], name, GOAL) for name in PROGRAMS}
        line: list[object] = [scene.title]
        for row in found.values():
            line += [number(row.seconds, 3), row.setting] if row else ["–", "none"]
        seconds = {name: row.seconds if row else math.inf for name, row in found.items()}
        if min(seconds.values()) < math.inf:
            wins[min(seconds, key=lambda name: seconds[name])] += 1
            wins_without += seconds["billet"] - start < seconds["CalculiX"]
        best = {
            name: min((point.error for point in counted(rows[scene.name], name)), default=math.nan)
            for name in PROGRAMS
        }
        known = rows[scene.name][0].error
        least = (f"< {percent(known)}" if best[name] < known else percent(best[name]) for name in PROGRAMS)
        lines.append([*line, *least])
    said = (
        f"Within {percent(GOAL)}, billet takes fewer CPU seconds in {wins['billet']} of {len(SCENES)}"
        f" scenes, and CalculiX in {wins['CalculiX']}. Without the {start:.2g} s that billet takes to start,"
        f" billet is the cheaper one in {wins_without}."
    )
    head = [word for name in PROGRAMS for word in (f"{name}: CPU s", "setting")]
    return said, table(["scene", *head, *(f"{name}: least error" for name in PROGRAMS)], lines)


def read_file() -> dict[str, list[Row]]:
    if not FILE.exists():
        return {}
    kept: dict[str, list[Row]] = {}
    with FILE.open(encoding="utf-8", newline="") as file:
        for line in csv.DictReader(file):
            row = Row(
                line["scene"],
                line["program"],
                line["setting"],
                int(line["elements"]),
                int(line["steps"]),
                int(line["iterations"]),
                float(line["seconds"]),
                float(line["value"]),
                float(line["error"]),
                line["stops"],
            )
            kept.setdefault(row.scene, []).append(row)
    return kept


def write_file(rows: dict[str, list[Row]]) -> None:
    with FILE.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(Row._fields)
        for name in (*(scene.name for scene in SCENES), START):
            for row in rows.get(name, []):
                writer.writerow([f"{cell:.6g}" if isinstance(cell, float) else cell for cell in row])


def main() -> None:
    rows = read_file() if options.scene or options.page else {}
    if START not in rows:
        start = statistics.median(Measured([PROGRAM, "--version"], ".").seconds for _ in range(9))
        rows[START] = [Row(START, "billet", "--version", 0, 0, 0, start, math.nan, math.nan, "")]
    for scene in SCENES:
        if not options.page and (not options.scene or scene.name in options.scene):
            exact = scene.reference()
            rows[scene.name] = [reference_row(scene, exact), *rows_of(scene, exact)]
            if not options.quick:
                write_file(rows)
    if options.quick or len(rows) <= len(SCENES):
        return
    write_file(rows)
    start = rows[START][0].seconds
    parts = [section(scene, rows[scene.name]) for scene in SCENES]
    said = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
    version = re.findall(r"Version (\S+)", said)[0]
    stops = [row for scene in SCENES for row in rows[scene.name] if row.stops]
    sentence, costs = summary(rows, start)
    n_seconds = sum(row.seconds for scene in SCENES for row in rows[scene.name])
    publish(
        "work-precision",
        "Error over CPU seconds, beside CalculiX",
        options,
        (
            f"This page shows what accuracy costs in billet and in CalculiX {version}, on six scenes and the"
            " same meshes. Each picture has the error of one result over the CPU seconds of the run. A line"
            " joins the meshes of one setting, each twice as fine as the one before. The wide lines are the"
            " cheapest runs of each program for their error. [work-precision.csv](work-precision.csv) has"
            f" all {sum(len(rows[scene.name]) - 1 for scene in SCENES)} runs."
        ),
        (
            "- CPU seconds: user and system of each run, on one core of a busy machine. Runs that take less"
            f" than {SHORT:g} s are the median of three. Read seconds as ratios.\n"
            "- billet: the three profiles, and other penalties or steps where they matter."
            f" {start:.2g} s of each run are its start.\n"
            "- CalculiX: elements C3D8, C3D8R, C3D8I and C3D20R, two kinds of penalty contact, and its"
            " default tolerances and solver. C3D20R gets nodes between those of the mesh, on the arcs of"
            f" round bodies. It gets at most {LIMIT} s.\n"
            "- Penalties of CalculiX are those that billet chooses, ten times E/h of both sides in series,"
            " or 10 or 100 times that. The billet has the penalty of its scene.\n"
            "- Error: the relative difference from the reference at the end. For the billet it is ∫|F − F*| /"
            " ∫|F*| over the travel.\n"
            "- In tables and wide lines a run counts with the largest error of its setting on its mesh and"
            " on finer ones. Errors of a coarse mesh and a soft penalty may cancel, as some points show."
        ),
        "## What an error of at most 1 % costs\n\n" + sentence + "\n\n" + costs,
        *parts,
        "## Runs that stop\n\n"
        + (
            "What the program says is quoted.\n\n"
            + table(
                ["scene", "program", "setting", "elements", "CPU s", "stops"],
                [[r.scene, r.program, r.setting, r.elements, number(r.seconds, 3), r.stops] for r in stops],
            )
            if stops
            else "None does."
        ),
    )
    print(f"{n_seconds:.0f} s of runs", file=sys.stderr)


main()
