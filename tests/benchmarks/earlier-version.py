# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shipped scenes of an earlier version with its program and with this one: forces, energies, steps and
iterations, instructions, and the outcomes of the scenes at the extremes."""

from __future__ import annotations

import io
import json
import math
import os
import re
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

from billet_runs import PROGRAM, ROOT, Changes, arguments, count_instructions, number, publish, table
from billet_tools.kept import hash_of, hash_of_file, read_json, write_json
from billet_tools.output import read_rows
from billet_tools.program import ALONE, Measured
from billet_tools.scene import read_scene, variant, with_absolute_files

COMMIT = "f6fd959e"  # the last one before the classes were divided
BEFORE = os.environ.get("BILLET_BEFORE", "")
ALLOWED = 1e-10
ALLOWED_INSTRUCTIONS = 0.03
# Part of the scenes at the extremes. BILLET_PART=1/1 runs all, for about two hours; finished runs are kept.
PART = os.environ.get("BILLET_PART", "1/32")

# Parts of long runs.
CUT: dict[str, Changes] = {
    "tube_crush": {"Time stepping/End time": 2.5e-4},
    "cartridge": {"Time stepping/End time": 1e-4},
    "twisted_hemisphere": {"Time stepping/End time": 2.2, "Time stepping/Stops": "1, 2"},
}
# Set as profiles did then, where they choose shorter steps now.
AS_THEN: dict[str, Changes] = {"billet_upsetting": {"Time stepping/Largest step": 0.1}}
# Changed on purpose since; and settings of both programs that leave no room for the change.
AUGMENTED_LESS = "friction is augmented no further than equilibrium is resolved"
BALANCED = "iterations continue until the resultants of each body balance to 1 %"
TO_THE_END: Changes = {"Solver/Force tolerance": 1e-8}
WITHOUT_CAUSE: dict[str, Changes] = {
    "billet_deformable_dies": TO_THE_END,
    "ring_crush": TO_THE_END,
    "drop_hammer": TO_THE_END,
    "ironing": {"Contact pairs/face/Penetration tolerance": 0, "Solver/Force tolerance": 1e-10},
    "twisted_hemisphere": {
        "Contact pairs/face/Penetration tolerance": 0,
        "Time stepping/End time": 1.4,
        "Time stepping/Stops": "1",
    },
}
CAUSES = {
    "ring_crush": BALANCED,
    "drop_hammer": BALANCED,
    "ironing": AUGMENTED_LESS,
    "twisted_hemisphere": AUGMENTED_LESS,
    "billet_deformable_dies": "contact chatters at the release: a change of 1e-13 in E has the same effect",
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
KEPT = ROOT / "results/earlier_version"


def write(scenes: Path, scene: str, changes: Changes, place: Path) -> None:
    text = variant(
        with_absolute_files(read_scene(scenes / f"{scene}.prm"), scenes),
        {
            "Output/Folder": "results",
            "Output/Format": "none",
            "Output/Verbosity": "quiet",
            **AS_THEN.get(scene, {}),
            **changes,
        },
    )
    (place / "scene.prm").write_text(text)


def kept_file(program: str, what: str, scene: str, changes: Changes) -> Path:
    settings = repr(sorted({**AS_THEN.get(scene, {}), **changes}.items()))
    return KEPT / f"{hash_of(hash_of_file(Path(program)), what, scene, settings)[:24]}.json"


def run(program: str, scenes: Path, scene: str, changes: Changes) -> Rows:
    file = kept_file(program, "rows", scene, changes)
    kept: Rows | None = read_json(file)
    if kept is not None:
        return kept
    with tempfile.TemporaryDirectory() as folder:
        write(scenes, scene, changes, Path(folder))
        done = Measured([program, "scene.prm"], folder, environment=ALONE)
        if done.code not in (0, 6):
            raise SystemExit(f"{program} {scene}: {done.stderr}")
        print(f"[{scene}] {done.seconds:.3g} s", flush=True)
        rows = read_rows(Path(folder) / "results/history.csv")
    write_json(file, rows)
    return rows


def is_energy(column: str) -> bool:
    return bool(re.search("energy|work|dissipation", column)) and "error" not in column


def group_of(column: str) -> str:
    """Components of a vector are measured together, and all energies."""
    return "energies" if is_energy(column) else re.sub("_[xyz]$", "", column)


class Difference:
    """The largest differences between two histories, at the times that both have: of forces and moments, over
    the largest of the vector, and of energies, over the largest of them. `missing`: rows at other times."""

    def __init__(self, before: Rows, now: Rows) -> None:
        times = {round(float(row["time"]), 12): row for row in now}
        shared = [(row, times.get(round(float(row["time"]), 12))) for row in before]
        pairs = [(one, other) for one, other in shared if other is not None]
        self.missing = len(before) + len(now) - 2 * len(pairs)
        columns = [
            column
            for column in before[0]
            if column in now[0] and (is_energy(column) or re.search(r"\.(force|moment)_[xyz]$", column))
        ]
        largest: dict[str, float] = {}
        apart: dict[str, float] = {}
        for one, other in pairs:
            for column in columns:
                a, b, group = float(one[column]), float(other[column]), group_of(column)
                largest[group] = max(largest.get(group, 0.0), abs(a), abs(b))
                apart[group] = max(apart.get(group, 0.0), abs(a - b))
        ratios = {group: apart[group] / size if size else 0.0 for group, size in largest.items()}
        self.energies = ratios.pop("energies", 0.0)
        self.forces = max(ratios.values(), default=0.0)

    @property
    def largest(self) -> float:
        return max(self.forces, self.energies)


def difference_text(value: float) -> str:
    return "0" if value == 0.0 else f"{value:.1e}"


class Compared:
    """A scene with both programs."""

    def __init__(self, scenes: Path, scene: str) -> None:
        changes = CUT.get(scene, {})
        before, now = run(BEFORE, scenes, scene, changes), run(PROGRAM, scenes, scene, changes)
        end = changes.get("Time stepping/End time")
        self.name = scene + (f", to {number(float(str(end)))}" if end else "")
        self.difference = Difference(before, now)
        self.steps = [rows[-1]["step"] for rows in (before, now)]
        self.iterations = [rows[-1].get("total_iterations", "") for rows in (before, now)]
        self.without = math.nan
        if self.difference.largest > ALLOWED and scene in WITHOUT_CAUSE:
            settings = {**changes, **WITHOUT_CAUSE[scene]}
            self.without = Difference(
                run(BEFORE, scenes, scene, settings), run(PROGRAM, scenes, scene, settings)
            ).largest
        self.cause = "" if self.is_same else CAUSES.get(scene, "unknown")

    @property
    def is_same(self) -> bool:
        return (
            self.difference.largest <= ALLOWED
            and self.difference.missing == 0
            and self.steps[0] == self.steps[1]
            and self.iterations[0] == self.iterations[1]
        )

    def row(self) -> list[object]:
        return [
            self.name,
            " / ".join(self.steps),
            " / ".join(self.iterations) if self.iterations[0] else "",
            self.difference.missing,
            difference_text(self.difference.forces),
            difference_text(self.difference.energies),
            "" if math.isnan(self.without) else difference_text(self.without),
            self.cause,
        ]


def count(program: str, scenes: Path, scene: str) -> int:
    changes, function, _ = COUNTED[scene]
    file = kept_file(program, "instructions", scene, changes)
    kept: dict[str, int] | None = read_json(file)
    if kept is None:
        with tempfile.TemporaryDirectory() as folder:
            write(scenes, scene, changes, Path(folder))
            kept = {"instructions": count_instructions(folder, function, program)}
        write_json(file, kept)
    print(f"[{scene}] {kept['instructions']} instructions", flush=True)
    return kept["instructions"]


def count_row(scenes: Path, scene: str) -> list[object]:
    before, now = count(BEFORE, scenes, scene), count(PROGRAM, scenes, scene)
    return [
        scene,
        COUNTED[scene][2],
        f"{before / 1e6:.1f}",
        f"{now / 1e6:.1f}",
        f"{100 * (now / before - 1):+.2f} %",
    ]


def outcomes(program: str, version: Path, chosen: list[str]) -> dict[str, tuple[str, str]]:
    """The outcomes of scenes at the extremes by name, with their steps and iterations. Plan and checks are
    those of the version in that folder: its checks read what its program writes."""
    folder = KEPT / f"extremes-{hash_of_file(Path(program))[:12]}"
    subprocess.run(
        [
            sys.executable,
            str(version / "tests/extremes/run.py"),
            "--program",
            program,
            "--folder",
            str(folder),
            *chosen,
        ],
        check=True,
        env={**os.environ, **ALONE},
    )
    kept = [json.loads(path.read_text()) for path in sorted((folder / "kept").glob("*.json"))]
    return {one["name"]: (one["outcome"], f"{one.get('steps')}, {one.get('iterations')}") for one in kept}


def compare_outcomes(earlier: Path) -> list[dict[str, tuple[str, str]]]:
    """Returns the outcomes of a part of the earlier plan, with both programs."""
    before = outcomes(BEFORE, earlier, ["--part", PART])
    whole = ["--part", PART] if PART == "1/1" else []  # names of all would be too long a command
    return [before, outcomes(PROGRAM, ROOT, whole or [part for name in before for part in ("--only", name)])]


def git(*command: str) -> bytes:
    return subprocess.run(["git", *command], cwd=ROOT, check=True, capture_output=True).stdout


options = arguments("earlier-version")
if not BEFORE:
    print(
        f"earlier-version: left out. Build the program of commit {COMMIT}, and name it in BILLET_BEFORE.",
        flush=True,
    )
    raise SystemExit(0)
KEPT.mkdir(parents=True, exist_ok=True)
with tempfile.TemporaryDirectory() as folder:
    place = Path(folder)
    with tarfile.open(
        fileobj=io.BytesIO(git("archive", COMMIT, "prm", "tests/extremes", "trade"))
    ) as archive:
        archive.extractall(place)
    names = sorted(path.stem for path in (place / "prm").glob("*.prm"))
    if options.quick:
        names = ["billet_upsetting", "press_fit"]
    compared = [Compared(place / "prm", name) for name in names]
    counts = [] if options.quick else [count_row(place / "prm", name) for name in COUNTED]
    extremes = [] if options.quick else compare_outcomes(place)
same = [scene for scene in compared if scene.is_same]
exact = [scene for scene in same if scene.difference.largest == 0.0]
worst = max((abs(float(str(row[4]).split()[0])) for row in counts), default=math.nan)
shared = [name for name in extremes[0] if name in extremes[1]] if extremes else []
other = [name for name in shared if extremes[0][name][0] != extremes[1][name][0]]
as_many = sum(extremes[0][name][1] == extremes[1][name][1] for name in shared)

others = table(
    ["scene", "outcome before", "now", "steps, iterations before", "now"],
    [
        [
            f"`{name}`",
            extremes[0][name][0],
            extremes[1][name][0],
            extremes[0][name][1],
            extremes[1][name][1],
        ]
        for name in other
    ],
)
publish(
    "earlier-version",
    "Beside an earlier version",
    options,
    (
        f"This page compares the program with that of commit {COMMIT}, before its classes were divided. The"
        " numbers should not change with the form of the code. The scenes are those of that commit, which"
        " this program still reads. Their steps have the limits that profiles chose then.\n\n"
        "Differences are those of all forces and moments, and of all energies, in all rows that both"
        " histories have. They are relative to the largest vector of that name, or to the largest energy."
        f" Steps and iterations are those of before / now. Allowed is {ALLOWED:g}."
    ),
    (
        f"{len(same)} of {len(compared)} scenes keep forces, energies, steps and iterations;"
        f" {len(exact)} of them to the last bit."
        " The column 'without it' has the larger difference where both programs run without the cause."
    ),
    table(
        ["scene", "steps", "iterations", "other rows", "forces", "energies", "without it", "cause"],
        [scene.row() for scene in compared],
    ),
    (
        "## Instructions\n\n"
        "Millions of instructions by callgrind, with the same steps and iterations. Allowed is"
        f" {100 * ALLOWED_INSTRUCTIONS:g} %; the most is {number(worst)} %."
    ),
    table(["scene", "part", "before", "now", "change"], counts),
    (
        "## Scenes at the extremes\n\n"
        f"{'All' if PART == '1/1' else f'Part {PART}'} of the {COMMIT} plan, {len(shared)} scenes, ran with"
        " both programs. Each was judged by"
        f" the checks of its version. {len(shared) - len(other)} have the same outcome,"
        f" {as_many} as many steps and iterations."
        f"{' The others are:' if other else ''}"
    ),
    *([others] if other else []),
)
