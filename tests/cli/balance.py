#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: balance.py BILLET

Begins every scene of prm/ in an empty current folder, and stops it some processor time after tools, supports
or pairs have begun to bear forces. In each line of its history the sum of reactions, contact, loads and
inertia is that of the residuals. So it is where tools leave and supports or loads begin late, in scenes
whose times are brought forward. contact_scenes.py, loaded_scenes.py and rubber_scenes.py check all lines of
variants that run to their ends. Scenes, and the files that they include, must be short.

Runs rolled_strip.prm, in which an end moment rolls up a thin strip: in each step the reaction is the moment
to 1 % of the largest one so far, (Q4) of the theory.

Runs switched.prm to its end in every scheme: the columns of tools, supports, loads and inertia have this sum
while forces fade.
"""

from __future__ import annotations

import math
import os
import re
import signal
import subprocess
import sys
import time
from typing import Dict, List

from checks import (
    HERE,
    SHIPPED,
    Checks,
    enter_folder,
    equal,
    near,
    read_text,
    require,
    rows_of,
    run,
    write_text,
)
from edits import edit
from shipped import history, require_short

N_LINES = 2  # with forces, at least
EXTRA = 0.25  # processor time after these lines [s]
LIMIT = 1e-12  # over the sum of the forces' sizes
SECONDS = 240.0  # for a scene on a busy machine

program = os.path.abspath(sys.argv[1])
check = Checks()
enter_folder()


Lines = List[Dict[str, float]]


def lines_of(folder: str) -> Lines:
    """Returns the whole lines of a history that grows."""
    if not os.path.exists(f"{folder}/history.csv"):
        return []
    head, *rows = rows_of(f"{folder}/history.csv")
    return [dict(zip(head, map(float, row))) for row in rows if len(row) == len(head) and row[-1] != ""]


def bears(line: dict[str, float]) -> bool:
    """Tells whether any force is not 0."""
    return any(value != 0.0 for name, value in line.items() if name[:-2].endswith(".force"))


def processor_time(process: int) -> float:
    """Returns the processor time of a process that runs, in seconds."""
    with open(f"/proc/{process}/stat", encoding="utf-8") as file:
        times = file.read().rpartition(")")[2].split()[11:13]  # of the program, and of the system for it
    return sum(map(int, times)) / os.sysconf("SC_CLK_TCK")


def begin(scene: str, folder: str, settings: tuple[str, ...] = (), after: float = 0.0) -> Lines:
    """Runs a scene for some time after enough lines later than `after` have forces, or to its end."""
    options = [option for setting in settings for option in ("--set", setting)]
    with open(f"{folder}.log", "w", encoding="utf-8") as log, subprocess.Popen(
        [program, "--quiet", "--output", folder, *options, scene], stdout=log, stderr=log
    ) as run:
        end = time.monotonic() + SECONDS
        began = math.inf
        while run.poll() is None and time.monotonic() < end:
            time.sleep(0.1)
            spent = processor_time(run.pid)
            late = [line for line in lines_of(folder)[:-1] if line["time"] > after]
            if began == math.inf and sum(map(bears, late)) >= N_LINES:
                began = spent
            if spent >= began + EXTRA:
                break
        run.send_signal(signal.SIGTERM)
        run.wait()
    return lines_of(folder)


n_checked: list[int] = []


def require_balanced(lines: Lines) -> None:
    """Checks the balance of forces in each line."""
    for line in lines:
        defect = line["force_balance_defect"]
        require(abs(defect) <= LIMIT, f"defect {defect} at time {line['time']}")
    n_checked.append(len(lines))


@check("scenes and their parts are short")
def _() -> None:
    for file in sorted(SHIPPED.rglob("*.prm")):
        require_short(str(file.relative_to(SHIPPED).with_suffix("")))


for scene in sorted(SHIPPED.glob("*.prm")):

    @check(f"{scene.stem}: forces balance")
    def _() -> None:
        lines = begin(str(scene), scene.stem)
        require(sum(map(bears, lines)) > 0, f"none of {len(lines)} lines has a force")
        require_balanced(lines)


def without_tools(time_of_removal: float, *tools: str) -> tuple[str, ...]:
    """Returns settings that remove these tools then, and let a support take over the strip."""
    removals = (f"Tools/{tool}/Motion/Removal time={time_of_removal}" for tool in tools)
    return (f"Bodies/strip/Supports/middle/From={time_of_removal}", *removals)


LATE = {  # settings that bring a later part of the scene forward, and the time at which it begins
    "free_bend": (without_tools(0.05, "punch", "die"), 0.05),
    "u_bend": (without_tools(0.01, "punch", "die", "holder"), 0.01),
    "o_ring": (
        (
            "Bodies/ring/Loads/oil/From=0.1",
            "Bodies/ring/Loads/oil/Pressure=0.3*(t - 0.1)",
            "Time stepping/Stops=0.1",
        ),
        0.1,
    ),
}
for name, (settings, after) in LATE.items():

    @check(f"{name}: forces balance after a change at time {after}")
    def _() -> None:
        lines = begin(str(SHIPPED / f"{name}.prm"), f"{name}_late", settings, after)
        n_late = sum(bears(line) for line in lines if line["time"] > after)
        require(n_late >= N_LINES, f"{n_late} of {len(lines)} lines are later")
        require_balanced(lines)


@check("a strip that an end moment rolls up: moments balance to 1 %")
def _() -> None:
    ended = run(program, "--quiet", "--output", "rolled", str(HERE / "rolled_strip.prm"))
    require(ended.code == 0, ended.output + ended.errors)
    largest = 0.0
    for line in history("rolled"):
        reaction = line["strip.support root.moment_z"]
        largest = max(largest, abs(reaction))
        rest = reaction + 1150 * line["time"]
        require(abs(rest) <= 0.01 * largest, f"{rest} of {largest} at time {line['time']}")


DYNAMIC = (
    "Time stepping: Scheme = implicit dynamics & Time stepping: Step control = fixed"
    " & Time stepping: Initial step = 0.02 & Time stepping: - Maximum step"
)
SCHEMES = {
    "static": "Time stepping: Scheme = static",
    "newmark": DYNAMIC + " & + subsection Implicit dynamics\nset Method = Newmark\nend",
    "generalised": DYNAMIC,
    "explicit": "Time stepping: Scheme = explicit & Time stepping: - Maximum step"
    " & Output: History interval = 0.01",
}
FORCES = re.compile(
    r"(beam\.support \w+\.force|beam\.load [\w ]+\.force|ball\.force|inertia|auxiliary_force)_[xyz]"
)


def require_columns_balance(line: dict[str, float]) -> None:
    """Checks the sums of the columns of forces along each axis, and of the pair of the tool."""
    forces = {name: value for name, value in line.items() if FORCES.fullmatch(name)}
    size = sum(abs(value) for value in forces.values())
    for axis in "xyz":
        along = sum(value for name, value in forces.items() if name.endswith("_" + axis))
        defect = along - line["free_residual_" + axis]
        require(abs(defect) <= LIMIT * size, f"{defect} of {size} along {axis} at time {line['time']}")
        of_pair = line[f"pair beam on ball.force_{axis}"]
        of_tool = line[f"ball.force_{axis}"]
        require(abs(of_pair - of_tool) <= LIMIT * size, f"the pair has {of_pair} of {of_tool}")
    # Without stabilisation and restarts, forces have columns of their own.
    auxiliary = line.get("auxiliary_force_z", 0.0)
    require(abs(auxiliary) <= LIMIT * size, f"{auxiliary} of {size} is in no other column")


def at(lines: list[dict[str, float]], time_of_line: float) -> dict[str, float]:
    """Returns the line at this time."""
    found = [line for line in lines if abs(line["time"] - time_of_line) < 1e-6]
    require(len(found) == 1, f"{len(found)} lines at time {time_of_line}")
    return found[0]


for name, edits in SCHEMES.items():

    @check(f"switched.prm, {name}: the columns of forces balance while forces fade")
    def _() -> None:
        write_text(f"{name}.prm", edit(read_text(HERE / "switched.prm"), edits).text)
        ended = run(program, "--quiet", "--output", name, f"{name}.prm")
        require(ended.code == 0, ended.output + ended.errors)
        lines = history(name)
        for line in lines:
            require_columns_balance(line)
            require(abs(line["force_balance_defect"]) <= LIMIT, f"defect at time {line['time']}")
        require(sum(0.4 < line["time"] < 0.6 for line in lines) > 2, "few lines while the support fades")
        require(sum(0.9 < line["time"] < 1.0 for line in lines) > 0, "no line while the tool fades")
        if name == "explicit":  # whose steps do not end at these times
            return
        tip = "beam.support tip.force_z"
        near("half of the support's force", at(lines, 0.5)[tip], 0.5 * at(lines, 0.4)[tip], 1e-9)
        equal("its force in the end", at(lines, 0.6)[tip], 0.0)
        fading = next(line for line in lines if line["time"] > 0.9 + 1e-6)
        left = (1.0 - fading["time"]) / 0.1
        near("the tool's force", fading["ball.force_z"], left * at(lines, 0.9)["ball.force_z"], 1e-9)


print(f"{sum(n_checked)} lines of {len(n_checked)} scenes balance")
sys.exit(check.finish())
