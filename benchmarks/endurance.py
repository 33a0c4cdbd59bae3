# SPDX-License-Identifier: LGPL-2.1-or-later
"""A million explicit steps of a stack at rest, and the memory of long runs."""

from __future__ import annotations

import subprocess
import tempfile
import time
from pathlib import Path
from typing import Sequence

import numpy

from billet_runs import PROGRAM, ROOT, Changes, arguments, number, publish, read_scene, table, variant
from billet_tools.output import Array, pictures_of, read_grid, read_numbers

options = arguments("endurance")
STEP = 3.026e-5  # of the stack, about
N_STEPS = 100_000 if options.quick else 1_000_000


class WatchedRun:
    """A run whose resident memory is sampled: `memory`, pairs of (accepted steps, megabytes)."""

    def __init__(self, scene: Path, changes: Changes, folder: str) -> None:
        self.folder = Path(folder)
        (self.folder / "scene.prm").write_text(
            variant(read_scene(scene), {"Output/Folder": "results", "Output/Verbosity": "quiet", **changes})
        )
        process = subprocess.Popen([PROGRAM, "scene.prm"], cwd=folder, stdout=subprocess.DEVNULL)
        history, self.memory = self.folder / "results/history.csv", []
        while process.poll() is None:
            time.sleep(0.5)
            try:
                status = Path(f"/proc/{process.pid}/status").read_text()
                step = int(history.read_text().rsplit("\n", 2)[-2].split(",")[0])
                self.memory.append((step, int(status.split("VmRSS:")[1].split()[0]) / 1024))
            except (OSError, IndexError, ValueError):  # not begun, or over
                continue
        self.ended = process.returncode == 0
        self.rows = read_numbers(history)

    def at(self, part: float) -> float:
        """Megabytes when this part of the steps was done."""
        last = self.memory[-1][0]
        return next(megabytes for step, megabytes in self.memory if step >= part * last)

    def displacements(self, index: int) -> Array:
        return read_grid(pictures_of(self.folder / "results")[index])["displacement"]


def window(rows: Sequence[dict[str, float]], key: str, low: float, high: float) -> tuple[float, float]:
    values = numpy.array([row[key] for row in rows if low <= row["time"] <= high])
    return values.mean(), values.max() - values.min()


memory = []
with tempfile.TemporaryDirectory() as folder:
    end = N_STEPS * STEP
    run = WatchedRun(
        ROOT / "benchmarks/resting_stack.prm",
        {"Time stepping/End time": end, "Output/Interval": end / 10},
        folder,
    )
    n_steps = int(run.rows[-1]["step"])
    middle, late = (0.45 * end, 0.55 * end), (0.9 * end, end)  # well after the blocks have come to rest
    quantities = (
        ("elastic energy [J]", "elastic_energy"),
        ("energy in contact springs [J]", "contact_energy"),
        ("force on the ground [N]", "ground.force_z"),
        ("penetration below the lowest block [m]", "ground.deepest_penetration"),
        ("between middle and lowest [m]", "middle on lowest.deepest_penetration"),
        ("taken by friction [J]", "friction_dissipation"),
        ("energy drift [J]", "energy_drift"),
    )
    rows = []
    for name, key in quantities:
        (first, width), (last, last_width) = window(run.rows, key, *middle), window(run.rows, key, *late)
        rows.append(
            [
                name,
                f"{first:.9g}",
                f"{last:.9g}",
                number(abs(last - first) / max(abs(first), 1e-300), 2),
                number(width, 2),
                number(last_width, 2),
            ]
        )
    kinetic = [window(run.rows, "kinetic_energy", *span)[0] for span in (middle, late)]
    weight = 3 * 0.1**3 * 1000 * 9.81
    largest_side = max(abs(row[f"ground.force_{i}"]) for row in run.rows if row["time"] > 1.5 for i in "xy")
    halfway, final = run.displacements(5), run.displacements(-1)
    moved = numpy.abs(final - halfway).max() / numpy.abs(final).max()
    memory.append(["stack, explicit", n_steps] + [number(run.at(part), 4) for part in (0.05, 0.5, 1.0)])

with tempfile.TemporaryDirectory() as folder:
    n = 1000 if options.quick else 10_000
    turned = WatchedRun(
        ROOT / "prm/turned_blocks.prm",
        {"Time stepping/Initial step": 47 / n, "Output/Format": "none"},
        folder,
    )
    memory.append(
        ["two blocks turned by 360°, implicit", int(turned.rows[-1]["step"])]
        + [number(turned.at(part), 4) for part in (0.05, 0.5, 1.0)]
    )

with tempfile.TemporaryDirectory() as folder:
    n_cycles = 1000 if options.quick else 100_000
    cycled = WatchedRun(ROOT / "benchmarks/friction_cycles.prm", {"Time stepping/End time": n_cycles}, folder)
    memory.append(
        [f"{n_cycles} cycles of friction, implicit", int(cycled.rows[-1]["step"])]
        + [number(cycled.at(part), 4) for part in (0.05, 0.5, 1.0)]
    )


def cycle(rows: Sequence[dict[str, float]], last: float) -> tuple[float, float, float]:
    """Largest sideways force of the four steps of the cycle that ends then, the force down, and what friction
    takes in it."""
    steps = {row["time"]: row for row in rows if last - 1 <= row["time"] <= last}
    return (
        max(steps[last - part]["plate.force_x"] for part in (0, 0.25, 0.5, 0.75)),
        steps[last]["plate.force_z"],
        steps[last]["friction_dissipation"] - steps[last - 1]["friction_dissipation"],
    )


early_cycle, last_cycle = cycle(cycled.rows, 100), cycle(cycled.rows, n_cycles)
cycles = [
    [name, f"{a:.15g}", f"{b:.15g}", number(abs(b / a - 1), 2)]
    for name, a, b in zip(
        ("largest sideways force [N]", "force down [N]", "taken by friction in the cycle [mJ]"),
        early_cycle,
        last_cycle,
    )
]

publish(
    "endurance",
    "Long runs",
    options,
    (
        "This page shows that long runs neither drift nor grow in memory.\n\n"
        "## A stack at rest\n\n"
        "Three blocks of rubber lie on each other and on the ground (`benchmarks/resting_stack.prm`)."
        f" Friction is 0.3; the run takes {n_steps} explicit steps. Gravity grows within the first"
        " second.\n\n"
        "The table has means over a tenth of the time, in the middle and at the end, and their relative"
        " difference. The last columns show how far single values lie apart within each."
    ),
    table(
        [
            "quantity",
            "in the middle",
            "at the end",
            "difference",
            "apart, in the middle",
            "apart, at the end",
        ],
        rows,
    ),
    (
        f"Kinetic energy is {number(kinetic[0], 2)} J in the middle and {number(kinetic[1], 2)} J at the"
        f" end, of {number(rows and float(rows[0][1]), 3)} J elastic energy. The largest sideways force on"
        f" the ground after 1.5 s is {number(largest_side / weight, 2)} of the weight. Between half of the"
        f" time and the end, displacements of all nodes change by at most {number(moved, 2)} of the largest"
        " one. Field output holds single precision."
    ),
    (
        "## Cycles of friction\n\n"
        "A plate presses a brick and cycles with friction (`benchmarks/friction_cycles.prm`). The run"
        f" has {n_cycles} cycles of four steps. The table compares an early cycle with the last one."
        " Friction's work is a difference of sums that grow, whose last bits are lost."
    ),
    table(["quantity", "cycle 100", f"cycle {n_cycles}", "difference"], cycles),
    "## Memory\n\n"
    "The table has the resident memory in MB when 5, 50 and 100 % of the steps were done, sampled twice a"
    " second.",
    table(["run", "steps", "5 %", "50 %", "100 %"], memory),
)
