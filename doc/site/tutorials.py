# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: tutorials.py PROGRAM FOLDER [NAME...]

Runs the scenes of the tutorials, all or those named, as their pages say. Draws doc/images/tutorial_NAME.png
and writes the figures that the pages insert to doc/tutorials/values.csv. Writes messages that pages insert
to doc/tutorials/NAME.txt. 'accuracy' measures the times of the commands of that tutorial. Results go to
FOLDER/NAME.
"""

from __future__ import annotations

import csv
import math
import os
import re
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Callable, NamedTuple

from matplotlib import pyplot

ROOT = Path(__file__).resolve().parents[2]
VALUES = ROOT / "doc/tutorials/values.csv"

# Pressure of the press fit in plane strain: E d (c^2 - b^2) (b^2 - a^2) / (2 b^3 (1 - nu^2) (c^2 - a^2))
LAME = (
    2e5
    / (1 - 0.3**2)
    * 0.01
    * (30**2 - 20**2)
    * (20**2 - 10**2)
    / (2 * 20**3 * (30**2 - 10**2))
)

Rows = list[dict[str, float]]
Value = tuple[str, Callable[[Rows], str]]


class Curve(NamedTuple):
    """A line of the plot."""

    label: str
    x: Callable[[dict[str, float]], float]
    y: Callable[[dict[str, float]], float]


class Tutorial(NamedTuple):
    """A scene, what is plotted of it and which figures its page has."""

    scene: str
    options: tuple[str, ...]
    x_label: str
    y_label: str
    curves: tuple[Curve, ...]
    values: tuple[Value, ...]
    below: tuple[str, tuple[Curve, ...]] = ("", ())  # label and curves of a second plot over the same axis
    is_included: bool = False  # by the scene on the page, which runs in its place


def at(rows: Rows, time: float) -> dict[str, float]:
    """Returns the row nearest to a time."""
    return min(rows, key=lambda row: abs(row["time"] - time))


def largest(rows: Rows, value: Callable[[dict[str, float]], float]) -> float:
    return max(abs(value(row)) for row in rows)


def mean(rows: Rows, value: Callable[[dict[str, float]], float], begin: float, end: float) -> float:
    chosen = [value(row) for row in rows if begin <= row["time"] <= end]
    return sum(chosen) / len(chosen)


def friction_of_ironing(row: dict[str, float]) -> float:
    """Returns the horizontal over the vertical force."""
    return abs(row["face.force_x"] / row["face.force_z"])


def angle_of_strip(row: dict[str, float]) -> float:
    """Returns by how many degrees the free end of the strip points down."""
    x, y = (row[f"flank.2.position_{axis}"] - row[f"flank.1.position_{axis}"] for axis in "xy")
    return -math.degrees(math.atan2(y, x))


def radius_of_strip(row: dict[str, float]) -> float:
    """Returns the radius of the circle through three points of the bend."""
    a, b, c = (complex(row[f"corner.{i}.position_x"], row[f"corner.{i}.position_y"]) for i in (1, 2, 3))
    area = abs(((b - a).conjugate() * (c - a)).imag) / 2
    return abs(b - a) * abs(c - b) * abs(a - c) / (4 * area)


TUTORIALS = {
    "forging": Tutorial(
        "prm/billet_upsetting.prm",
        (),
        "travel of the die, mm",
        "force on the whole billet, kN",
        (Curve("", lambda r: -r["die.travel_z"], lambda r: 4e-3 * abs(r["die.force_z"])),),
        (
            ("force on the whole billet at the end, kN", lambda r: f"{4e-3 * abs(r[-1]['die.force_z']):.1f}"),
            ("plastic work of the modelled eighth, J", lambda r: f"{1e-3 * r[-1]['plastic_work']:.1f}"),
        ),
    ),
    "drawing": Tutorial(
        "prm/templates/drawing.prm",
        (),
        "travel of the punch, mm",
        "force, quarter, kN",
        (
            Curve("punch", lambda r: abs(r["punch.travel_z"]), lambda r: 1e-3 * abs(r["punch.force_z"])),
            Curve("holder", lambda r: abs(r["punch.travel_z"]), lambda r: 1e-3 * abs(r["holder.force_z"])),
        ),
        (
            (
                "largest vertical force of the punch, quarter, kN",
                lambda r: f"{1e-3 * largest(r, lambda x: x['punch.force_z']):.2f}",
            ),
            (
                "friction dissipation over plastic work",
                lambda r: f"{r[-1]['friction_dissipation'] / r[-1]['plastic_work']:.3f}",
            ),
        ),
    ),
    "press_fit": Tutorial(
        "prm/press_fit.prm",
        ("--set", "Time stepping/Initial step=0.1"),
        "radial interference so far, mm",
        "pressure between the rings, MPa",
        (
            Curve("run", lambda r: 0.01 * r["time"], lambda r: abs(r["fit.force_x"]) / 20),
            Curve("Lamé", lambda r: 0.01 * r["time"], lambda r: LAME * r["time"]),
        ),
        (
            ("pressure of the run, MPa", lambda r: f"{abs(r[-1]['fit.force_x']) / 20:.2f}"),
            ("pressure by Lamé, MPa", lambda r: f"{LAME:.2f}"),
        ),
    ),
    "ironing": Tutorial(
        "prm/ironing.prm",
        (),
        "time",
        "force on the slab, N",
        (
            Curve("vertical", lambda r: r["time"], lambda r: abs(r["face.force_z"])),
            Curve("horizontal", lambda r: r["time"], lambda r: abs(r["face.force_x"])),
        ),
        (
            (
                "horizontal over vertical force, mean while drawn",
                lambda r: f"{mean(r, friction_of_ironing, 1.2, 2.8):.3f}",
            ),
            ("largest vertical force, N", lambda r: f"{largest(r, lambda x: x['face.force_z']):.1f}"),
        ),
    ),
    "tube_crush": Tutorial(
        "prm/tube_crush.prm",
        ("--set", "Time stepping/End time=1e-3"),
        "travel of the plane, mm",
        "force of the whole tube, kN",
        (Curve("", lambda r: -r["plane.travel_z"], lambda r: 4e-3 * abs(r["plane.force_z"])),),
        (
            ("explicit steps", lambda r: f"{r[-1]['step']:.0f}"),
            ("plastic work, quarter, J", lambda r: f"{1e-3 * r[-1]['plastic_work']:.1f}"),
            (
                "kinetic energy over plastic work",
                lambda r: f"{r[-1]['kinetic_energy'] / r[-1]['plastic_work']:.3f}",
            ),
        ),
    ),
    "taylor_bar": Tutorial(
        "prm/taylor_bar.prm",
        (),
        "time, µs",
        "energy, quarter, J",
        (
            Curve("kinetic", lambda r: 1e6 * r["time"], lambda r: 1e-3 * r["kinetic_energy"]),
            Curve("plastic work", lambda r: 1e6 * r["time"], lambda r: 1e-3 * r["plastic_work"]),
        ),
        (
            ("explicit steps", lambda r: f"{r[-1]['step']:.0f}"),
            (
                "kinetic energy at the end over that at the start",
                lambda r: f"{r[-1]['kinetic_energy'] / r[0]['kinetic_energy']:.4f}",
            ),
        ),
    ),
    "springback": Tutorial(
        "prm/templates/bending.prm",
        (),
        "time",
        "force, N/mm",
        (
            Curve("punch", lambda r: r["time"], lambda r: abs(r["punch.force_y"])),
            Curve("holder", lambda r: r["time"], lambda r: abs(r["holder.force_y"])),
        ),
        (
            (
                "largest vertical force of the punch, N/mm",
                lambda r: f"{largest(r, lambda x: x['punch.force_y']):.1f}",
            ),
            ("elastic energy when the punch leaves, mJ", lambda r: f"{at(r, 0.8)['elastic_energy']:.1f}"),
            ("elastic energy at the end, mJ", lambda r: f"{r[-1]['elastic_energy']:.1f}"),
            ("angle of the free end when the punch leaves, °", lambda r: f"{angle_of_strip(at(r, 0.8)):.1f}"),
            ("angle after springback, °", lambda r: f"{angle_of_strip(r[-1]):.1f}"),
            ("inner radius when the punch leaves, mm", lambda r: f"{radius_of_strip(at(r, 0.8)):.2f}"),
            ("inner radius after springback, mm", lambda r: f"{radius_of_strip(r[-1]):.2f}"),
        ),
        ("angle of the free end, °", (Curve("", lambda r: r["time"], angle_of_strip),)),
        True,
    ),
}


class Printed(NamedTuple):
    """Settings in the scene of the billet, and the keys of the messages that a page shows."""

    settings: tuple[str, ...]
    keys: str


PRINTED = {
    "error_estimate": Printed(("Target error=1 percent",), "error-estimate|mesh-.*"),
    "mesh_levels": Printed(
        ("Target error=3 percent", "Target error of=everything", "Finest mesh level=1"), "mesh-levels"
    ),
    "mesh_error": Printed((), "mesh-error"),
    "penalty_too_low": Printed(("Contact pairs/billet on die/Normal penalty=1e3",), "penalty-too-low"),
}


# Commands of accuracy.md on the billet, by what its table calls them
TIMED = {
    "as shipped": (),
    "`Target error=1 percent`": ("--set", "Target error=1 percent"),
    "a mesh twice as fine": (
        "--set",
        "Bodies/billet/Mesh/Refinements=2",
        "--set",
        "Bodies/billet/Mesh/Layers=10",
    ),
    "`Target error of=everything`": (
        "--set",
        "Target error=3 percent",
        "--set",
        "Target error of=everything",
    ),
}


def ask(command: list[str], name: str) -> tuple[str, float]:
    """Returns what a command prints, and its processor time."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        assert process.stdout
        text = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{name}: exit code {process.returncode}\n{text[-2000:]}")
    return text, usage.ru_utime + usage.ru_stime


def scene_of_page(name: str, folder: Path) -> Path:
    """Writes the scene on a page that includes the tutorial's."""
    text = (ROOT / f"doc/tutorials/{name}.md").read_text(encoding="utf-8")
    scene = re.search(r"^```prm\ninclude \S+\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    if not scene:
        raise SystemExit(f"{name}.md: no scene begins with 'include'")
    file = folder / f"{name}.prm"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(f"include {ROOT / TUTORIALS[name].scene}\n{scene[1]}", encoding="utf-8")
    return file


def run(program: str, name: str, folder: Path) -> tuple[Rows, list[tuple[str, str]]]:
    """Runs a tutorial; returns its history and what it cost."""
    tutorial = TUTORIALS[name]
    output = folder / name
    scene = scene_of_page(name, folder) if tutorial.is_included else ROOT / tutorial.scene
    text, seconds = ask([program, str(scene), *tutorial.options, "--output", str(output), "--force"], name)
    with (output / "history.csv").open(encoding="utf-8", newline="") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    elements = re.search(r"^(\d+) elements", text, re.MULTILINE)
    cost = [("elements", elements[1] if elements else "")]
    if "total_iterations" in rows[-1]:
        cost.append(
            ("steps and Newton iterations", f"{rows[-1]['step']:.0f} and {rows[-1]['total_iterations']:.0f}")
        )
    cost.append(("processor time, s", f"{seconds:.2g}"))
    return rows, cost


def draw(name: str, rows: Rows) -> None:
    tutorial = TUTORIALS[name]
    plots = [(tutorial.y_label, tutorial.curves)] + ([tutorial.below] if tutorial.below[1] else [])
    height = 3.6 if len(plots) == 1 else 5.4
    figure, all_axes = pyplot.subplots(
        len(plots), figsize=(6.4, height), layout="constrained", sharex=True, squeeze=False
    )
    for axes, (label, curves) in zip(all_axes[:, 0], plots):
        for curve in curves:
            style = "o" if curve.label == "run" else "-"  # beside a closed form
            axes.plot(
                [curve.x(row) for row in rows], [curve.y(row) for row in rows], style, label=curve.label
            )
        axes.set_ylabel(label)
        axes.set_ylim(bottom=0)
        axes.grid(alpha=0.3)
        if len(curves) > 1:
            axes.legend()
    all_axes[-1, 0].set_xlabel(tutorial.x_label)
    figure.savefig(ROOT / f"doc/images/tutorial_{name}.png", dpi=100, metadata={"Software": None})
    pyplot.close(figure)


def keep_printed(program: str, name: str, folder: Path) -> None:
    """Keeps the messages that a variant of the billet prints, which pages show, in lines of 100 columns."""
    printed = PRINTED[name]
    command = [program, str(ROOT / "prm/billet_upsetting.prm"), "--output", str(folder / name), "--force"]
    command += [word for setting in printed.settings for word in ("--set", setting)]
    output = subprocess.run(command, capture_output=True, text=True, check=True)
    lines = (output.stdout + output.stderr).splitlines()
    found = [line for line in lines if re.match(rf"(note|warning)\[({printed.keys})\]", line)]
    if not found:
        raise SystemExit(f"{name}: the run printed no {printed.keys}")
    text = "\n".join(
        textwrap.fill(line.replace(" %", "\0%"), 100, break_on_hyphens=False).replace("\0%", " %")
        for line in found
    )
    (ROOT / f"doc/tutorials/{name}.txt").write_text(text + "\n", encoding="utf-8")


def times_of_accuracy(program: str, folder: Path) -> list[tuple[str, str]]:
    """Measures the processor times of the commands of the tutorial on accuracy."""
    scene, output = str(ROOT / "prm/billet_upsetting.prm"), str(folder / "accuracy")
    trade = [sys.executable, str(ROOT / "tools/billet-trade"), scene, "--explain", "--program", program]
    commands = {
        label: [program, scene, "--output", output, "--force", *words] for label, words in TIMED.items()
    }
    commands["`billet-trade --explain`"] = [*trade, "--output", str(folder / "explain")]
    return [
        (f"processor time, s: {label}", f"{ask(words, label)[1]:.2g}") for label, words in commands.items()
    ]


def main() -> None:
    program, folder = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    names = sys.argv[3:] or [*TUTORIALS, *PRINTED, "accuracy"]
    for name in PRINTED:
        if name in names:
            names.remove(name)
            keep_printed(program, name, folder)
    kept: list[list[str]] = []
    if VALUES.exists():
        with VALUES.open(encoding="utf-8", newline="") as file:
            kept = list(csv.reader(file))[1:]
    for name in names:
        if name == "accuracy":
            figures = times_of_accuracy(program, folder)
        else:
            rows, figures = run(program, name, folder)
            draw(name, rows)
            figures += [(label, value(rows)) for label, value in TUTORIALS[name].values]
        kept = [row for row in kept if row[0] != name] + [[name, *figure] for figure in figures]
        print(name, figures, flush=True)
        with VALUES.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(("tutorial", "quantity", "value"))
            writer.writerows(row for key in [*TUTORIALS, "accuracy"] for row in kept if row[0] == key)


if __name__ == "__main__":
    main()
