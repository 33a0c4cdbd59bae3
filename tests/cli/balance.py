#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: balance.py BILLET

Begins every scene of prm/ in an empty current folder, and stops it some processor time after tools, supports
or pairs have begun to bear forces. In each line of its history the sum of reactions, contact, loads and
inertia is that of the residuals. contact_scenes.py, loaded_scenes.py and rubber_scenes.py check all lines of
variants that run to their ends. Scenes, and the files that they include, must be short.
"""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import time

from checks import SHIPPED, Checks, enter_folder, require, rows_of
from shipped import require_short

N_LINES = 2  # with forces, at least
EXTRA = 0.25  # processor time after these lines [s]
LIMIT = 1e-12  # over the sum of the forces' sizes
SECONDS = 240.0  # for a scene on a busy machine

program = os.path.abspath(sys.argv[1])
check = Checks()
enter_folder()


def lines_of(folder: str) -> list[dict[str, float]]:
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


def begin(scene: str, folder: str) -> list[dict[str, float]]:
    """Runs a scene for some time after enough lines have forces, or to its end."""
    with open(f"{folder}.log", "w", encoding="utf-8") as log, subprocess.Popen(
        [program, "--quiet", "--output", folder, scene], stdout=log, stderr=log
    ) as run:
        end = time.monotonic() + SECONDS
        began = math.inf
        while run.poll() is None and time.monotonic() < end:
            time.sleep(0.1)
            spent = processor_time(run.pid)
            if began == math.inf and sum(map(bears, lines_of(folder)[:-1])) >= N_LINES:
                began = spent
            if spent >= began + EXTRA:
                break
        run.send_signal(signal.SIGTERM)
        run.wait()
    return lines_of(folder)


n_checked: list[int] = []


@check("scenes and their parts are short")
def _() -> None:
    for file in sorted(SHIPPED.rglob("*.prm")):
        require_short(str(file.relative_to(SHIPPED).with_suffix("")))


for scene in sorted(SHIPPED.glob("*.prm")):

    @check(f"{scene.stem}: forces balance")
    def _() -> None:
        lines = begin(str(scene), scene.stem)
        require(sum(map(bears, lines)) > 0, f"none of {len(lines)} lines has a force")
        for line in lines:
            defect = line["force_balance_defect"]
            require(abs(defect) <= LIMIT, f"defect {defect} at time {line['time']}")
        n_checked.append(len(lines))


print(f"{sum(n_checked)} lines of {len(n_checked)} scenes balance")
sys.exit(check.finish())
