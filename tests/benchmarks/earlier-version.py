# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shipped scenes of an earlier version with its program and with this one: forces, energies, steps and
iterations, instructions, and the outcomes of the scenes at the extremes."""

from __future__ import annotations

import io
import math
import os
import re
import subprocess
import tarfile
import tempfile
from pathlib import Path

import billet_runs
from billet_runs import PROGRAM, ROOT, Changes, arguments, count_instructions, number, publish, table
from billet_tools.output import read_rows
from billet_tools.program import ALONE, Measured
from billet_tools.scene import read_scene, variant, with_absolute_files

COMMIT = "f6fd959e"  # the last one before the classes were divided
BEFORE = os.environ.get("BILLET_BEFORE", "")
ALLOWED = 1e-10
ALLOWED_INSTRUCTIONS = 0.03

# Parts of long runs.
CUT: dict[str, Changes] = {
    "tube_crush": {"Time stepping/End time": 2.5e-4},
    "cartridge": {"Time stepping/End time": 1e-4},
    "twisted_hemisphere": {"Time stepping/End time": 2.2, "Time stepping/Stops": "1, 2"},
}
# Changed on purpose since; and settings of both programs without the change.
ON_PURPOSE = "friction is augmented no further than equilibrium is resolved"
PENALTY_ALONE: dict[str, Changes] = {
    "ironing": {"Contact pairs/face/Penetration tolerance": 0, "Solver/Force tolerance": 1e-10},
    "twisted_hemisphere": {"Contact pairs/face/Penetration tolerance": 0, "Time stepping/End time": 1.4},
}
CAUSES = {
    "ironing": ON_PURPOSE,
    "twisted_hemisphere": ON_PURPOSE,
    "billet_deformable_dies": "rattles when it is released: a change of 1e-13 in E does as much",
}
COUNTED: dict[str, tuple[Changes, str, str]] = {
    "billet_upsetting": ({}, "billet::run_simulation(*", "the whole run"),
    "ironing": (
        {
            "Time stepping/End time": 0.15,
            "Time stepping/Stops": "",
            "Contact pairs/face/Penetration tolerance": 0,
        },
        "billet::run_simulation(*",
        "to time 0.15, penalty alone",
    ),
    "tube_crush": (
        {"Time stepping/End time": 2e-5},
        "billet::ExplicitDynamics::prepare_step(*",
        "forces and velocities of 256 steps",
    ),
}
Rows = list[dict[str, str]]


def write(scenes: Path, scene: str, changes: Changes, place: Path) -> None:
    text = variant(
        with_absolute_files(read_scene(scenes / f"{scene}.prm"), scenes),
        {"Output/Folder": "results", "Output/Format": "none", "Output/Verbosity": "quiet", **changes},
    )
    (place / "scene.prm").write_text(text)


def run(program: str, scenes: Path, scene: str, changes: Changes) -> Rows:
    with tempfile.TemporaryDirectory() as folder:
        write(scenes, scene, changes, Path(folder))
        done = Measured([program, "scene.prm"], folder, environment=ALONE)
        if done.code not in (0, 6):
            raise SystemExit(f"{program} {scene}: {done.stderr}")
        print(f"[{scene}] {done.seconds:.3g} s", flush=True)
        return read_rows(Path(folder) / "results/history.csv")


def is_energy(column: str) -> bool:
    return bool(re.search("energy|work|dissipation", column)) and "error" not in column


def group_of(column: str) -> str:
    """Components of a vector are measured together, and all energies."""
    return "energies" if is_energy(column) else re.sub("_[xyz]$", "", column)


def differences(before: Rows, now: Rows) -> tuple[float, float]:
    """The largest difference of forces and moments, and of energies, over the largest of the vector or of
    the energies; infinite if the rows are at other times."""
    if [float(row["time"]) for row in before] != [float(row["time"]) for row in now]:
        times = {round(float(row["time"]), 12): row for row in now}
        before = [row for row in before if round(float(row["time"]), 12) in times]
        now = [times[round(float(row["time"]), 12)] for row in before]
    columns = [
        column
        for column in before[0]
        if column in now[0] and (is_energy(column) or re.search(r"\.(force|moment)_[xyz]$", column))
    ]
    largest: dict[str, float] = {}
    apart: dict[str, float] = {}
    for one, other in zip(before, now):
        for column in columns:
            a, b, group = float(one[column]), float(other[column]), group_of(column)
            largest[group] = max(largest.get(group, 0.0), abs(a), abs(b))
            apart[group] = max(apart.get(group, 0.0), abs(a - b))
    ratios = {group: apart[group] / size if size else 0.0 for group, size in largest.items()}
    return (
        max((ratio for group, ratio in ratios.items() if group != "energies"), default=0.0),
        ratios.get("energies", 0.0),
    )


def difference_text(value: float) -> str:
    return "0" if value == 0.0 else f"{value:.1e}"


def scene_row(scenes: Path, scene: str) -> list[object]:
    changes = CUT.get(scene, {})
    before, now = run(BEFORE, scenes, scene, changes), run(PROGRAM, scenes, scene, changes)
    forces, energies = differences(before, now)
    again = ""
    if max(forces, energies) > ALLOWED and scene in PENALTY_ALONE:
        settings = {**changes, **PENALTY_ALONE[scene]}
        pair = differences(run(BEFORE, scenes, scene, settings), run(PROGRAM, scenes, scene, settings))
        again = difference_text(max(pair))
    end = changes.get("Time stepping/End time")
    last = [rows[-1].get("total_iterations", "") for rows in (before, now)]
    return [
        scene + (f", to {number(float(str(end)))}" if end else ""),
        " / ".join(str(rows[-1]["step"]) for rows in (before, now)),
        " / ".join(last) if last[0] else "",
        difference_text(forces),
        difference_text(energies),
        again,
        CAUSES.get(scene, "") if max(forces, energies) > ALLOWED or last[0] != last[1] else "",
    ]


def count(program: str, scenes: Path, scene: str) -> int:
    changes, function, _ = COUNTED[scene]
    billet_runs.PROGRAM = program
    with tempfile.TemporaryDirectory() as folder:
        write(scenes, scene, changes, Path(folder))
        instructions = count_instructions(folder, function)
    print(f"[{scene}] {instructions} instructions", flush=True)
    return instructions


def count_row(scenes: Path, scene: str) -> list[object]:
    before, now = count(BEFORE, scenes, scene), count(PROGRAM, scenes, scene)
    return [
        scene,
        COUNTED[scene][2],
        f"{before / 1e6:.1f}",
        f"{now / 1e6:.1f}",
        f"{100 * (now / before - 1):+.2f} %",
    ]


def outcomes(page: str) -> dict[str, str]:
    """The outcomes of all scenes at the extremes, by name."""
    lines = page.splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("| all |"))
    cells = [[cell.strip() for cell in lines[i].strip("|").split("|")] for i in (at - 2, at)]
    return dict(zip(cells[0][1:], cells[1][1:]))


def git(*command: str) -> bytes:
    return subprocess.run(["git", *command], cwd=ROOT, check=True, capture_output=True).stdout


options = arguments("earlier-version")
if not BEFORE:
    print(
        f"earlier-version: left out. Build the program of commit {COMMIT}, and name it in BILLET_BEFORE.",
        flush=True,
    )
    raise SystemExit(0)
with tempfile.TemporaryDirectory() as folder:
    with tarfile.open(fileobj=io.BytesIO(git("archive", COMMIT, "prm"))) as archive:
        archive.extractall(folder)
    scenes = Path(folder) / "prm"
    names = sorted(path.stem for path in scenes.glob("*.prm"))
    if options.quick:
        names = ["billet_upsetting", "press_fit"]
    rows = [scene_row(scenes, name) for name in names]
    counts = [] if options.quick else [count_row(scenes, name) for name in COUNTED]
same = sum(max(float(str(row[3])), float(str(row[4]))) <= ALLOWED for row in rows)
exact = sum(row[3] == row[4] == "0" for row in rows)
pages = (
    git("show", f"{COMMIT}:doc/results/extremes.md").decode(),
    (ROOT / "doc/results/extremes.md").read_text(),
)
extremes = [outcomes(page) for page in pages]
kinds = [kind for kind in extremes[1] if kind != "scenes"] + ["scenes"]
worst = max((abs(float(str(row[4]).split()[0])) for row in counts), default=math.nan)

publish(
    "earlier-version",
    "Beside an earlier version",
    options,
    (
        f"This page compares the program with that of commit {COMMIT}, before its classes were divided. The"
        " numbers should not change with the form of the code. The scenes are those of that commit, which"
        " this program still reads.\n\n"
        "Differences are those of all forces and moments, and of all energies, in all rows of the history."
        " They are relative to the largest vector of that name, or to the largest energy."
        f" Steps and iterations are those of before / now. Allowed is {ALLOWED:g}."
    ),
    (
        f"{same} of {len(rows)} scenes keep their forces and energies, {exact} of them to the last bit."
        " The column 'without it' has the larger difference where both programs run without the cause."
    ),
    table(
        ["scene", "steps", "iterations", "forces", "energies", "without it", "cause"],
        rows,
    ),
    (
        "## Instructions\n\n"
        "Millions of instructions by callgrind, with the same steps and iterations. Allowed is"
        f" {100 * ALLOWED_INSTRUCTIONS:g} %; the most is {number(worst)} %."
    ),
    table(["scene", "part", "before", "now", "change"], counts),
    (
        "## Scenes at the extremes\n\n"
        "What became of them, as the page of each version says. This version has more of them."
    ),
    table(
        ["version", *kinds],
        [[name, *(of.get(kind, "") for kind in kinds)] for name, of in zip(("before", "now"), extremes)],
    ),
)
