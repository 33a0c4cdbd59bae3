#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: balance.py BILLET

Begins scenes of prm/ in an empty current folder, some on coarser meshes, and stops each some processor time
after tools, supports or pairs have begun to bear forces. In each line of its history the sum of reactions,
contact, loads and inertia is that of the residuals. Those that contact_scenes.py, cup_scenes.py,
loaded_scenes.py, rubber_scenes.py and sheet_scenes.py run are left out: they check this in all lines. What no
script runs as it is shipped is checked, in one start of the program. Scenes, and the files that they include,
must be short.

Runs switched.prm to its end in every scheme: the columns of tools, supports, loads and inertia have this sum
while forces fade.
"""

from __future__ import annotations

import math
import os
import re
import signal
import sys
import time

from checks import (
    HERE,
    SHIPPED,
    Checks,
    enter_folder,
    equal,
    fork_server,
    near,
    read_text,
    require,
    rows_of,
    run,
    write_text,
)
from billet_tools.fork_server import OwnProcesses
from edits import edit
from shipped import history, require_short

N_LINES = 2  # with forces, at least
EXTRA = 0.1  # processor time after these lines [s]
LIMIT = 1e-12  # over the sum of the forces' sizes
SECONDS = 240.0  # for a scene on a busy machine

# which others run to their ends, most of them coarser
ELSEWHERE = (
    "balloon bracket cyclic_coupon cylindrical_cup drop o_ring pressurised_cylinder seal"
    " slab_rolling slab_rolling_explicit snap_fit square_cup stack step_punch u_bend wagoner_punch_mu_0"
    " wagoner_punch_mu_015"
).split()
COARSER = {
    "twisted_hemisphere": (
        "Bodies/block/Mesh/Arguments=6, 6, 3 : -1, -1, -1 : 1, 1, 0 : true",
        "Bodies/punch/Mesh/Arguments=5, 5, 3 : -1, -1, 0 : 1, 1, 1 : true",
    ),
    "billet_deformable_dies": (
        "Bodies/billet/Mesh/Layers=2",
        "Bodies/die/Mesh/Arguments=4, 4, 2 : 0, 0, 15 : 20, 20, 25 : true",
    ),
    "hertz_cylinders": (
        "Bodies/lower/Mesh/Arguments=12, 1, 6 : 0, 0, -1 : 1, 0.1, 0 : true",
        "Bodies/upper/Mesh/Arguments=10, 1, 6 : 0, 0, 0 : 1, 0.1, 1 : true",
    ),
}

program = os.path.abspath(sys.argv[1])
starter = fork_server(program) or OwnProcesses([program])
check = Checks()
enter_folder()


def lines_of(folder: str) -> list[dict[str, float]]:
    """Returns the whole lines of a history that grows."""
    if not os.path.exists(f"{folder}/history.csv"):
        return []
    whole = rows_of(f"{folder}/history.csv")
    if not whole:  # its head is on the way
        return []
    head, *rows = whole
    return [dict(zip(head, map(float, row))) for row in rows if len(row) == len(head) and row[-1] != ""]


def bears(line: dict[str, float]) -> bool:
    """Tells whether any force is not 0."""
    return any(value != 0.0 for name, value in line.items() if name[:-2].endswith(".force"))


def processor_time(process: int) -> float:
    """Returns the processor time of a process that runs, in seconds."""
    with open(f"/proc/{process}/stat", encoding="utf-8") as file:
        times = file.read().rpartition(")")[2].split()[11:13]  # of the program, and of the system for it
    return sum(map(int, times)) / os.sysconf("SC_CLK_TCK")


def begin(scene: str, folder: str) -> list[dict[str, float]]:
    """Runs a scene for some time after enough lines have forces, or to its end."""
    settings = [part for change in COARSER.get(folder, ()) for part in ("--set", change)]
    with open(f"{folder}.log", "wb") as log:
        process = starter.start(["--quiet", "--output", folder, *settings, scene], os.getcwd(), log, log)
    end = time.monotonic() + SECONDS
    began = math.inf
    while time.monotonic() < end:
        try:
            starter.wait(0.05)
            return lines_of(folder)
        except TimeoutError:
            spent = processor_time(process)
        if began == math.inf and sum(map(bears, lines_of(folder)[:-1])) >= N_LINES:
            began = spent
        if spent >= began + EXTRA:
            break
    os.kill(process, signal.SIGTERM)
    starter.wait()
    return lines_of(folder)


n_checked: list[int] = []


@check("scenes and their parts are short")
def _() -> None:
    for file in sorted(SHIPPED.rglob("*.prm")):
        require_short(str(file.relative_to(SHIPPED).with_suffix("")))


@check("--check passes every scene that is not begun as it is")
def _() -> None:
    names = {scene.stem for scene in SHIPPED.glob("*.prm")} & {*ELSEWHERE, *COARSER}
    scenes = [str(SHIPPED / f"{name}.prm") for name in sorted(names)]
    ended = run(program, "--check", *scenes)
    require(ended.code == 0, ended.errors)
    equal("scenes", re.findall(r"^Scene +(.*)$", ended.output, re.MULTILINE), scenes)
    n_sound = len(re.findall(r"^Elements +[1-9]\d* in all", ended.output, re.MULTILINE))
    equal("scenes with elements", n_sound, len(scenes))


for scene in sorted(SHIPPED.glob("*.prm")):
    if scene.stem in ELSEWHERE:
        continue

    @check(f"{scene.stem}: forces balance")
    def _() -> None:
        lines = begin(str(scene), scene.stem)
        require(sum(map(bears, lines)) > 0, f"none of {len(lines)} lines has a force")
        for line in lines:
            defect = line["force_balance_defect"]
            require(abs(defect) <= LIMIT, f"defect {defect} at time {line['time']}")
        n_checked.append(len(lines))


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
