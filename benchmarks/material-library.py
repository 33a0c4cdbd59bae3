# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shipped materials: their curves in uniaxial tension by the program, beside theory."""

from __future__ import annotations

import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

from billet_runs import PROGRAM, ROOT, arguments, publish, table

sys.path.insert(0, str(ROOT / "tests/cli"))
from material_theory import constants_of, tension, tension_scene  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

options = arguments("material-library")
RATES = (1.0, 1e4)


def pull(file: Path, stretch: float, rate: float) -> list[tuple[float, float]]:
    """Returns stretch and force of each step."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "cube.prm").write_text(tension_scene(file.name, stretch, rate), encoding="utf-8")
        subprocess.run(
            [PROGRAM, "cube.prm", "--output", "pulled", "--quiet"],
            cwd=folder,
            check=True,
            stdout=subprocess.PIPE,
        )
        with open(Path(folder) / "pulled/history.csv", encoding="utf-8", newline="") as rows:
            return [
                (math.exp(rate * float(row["time"])), float(row["cube.support head.force_x"]))
                for row in csv.DictReader(rows)
            ]


figure, panels = pyplot.subplots(1, 3, figsize=(14, 4.6))
titles = ("metals, heated by plastic work", "sheets, along the rolling direction", "rubbers")
rows = []
for file in sorted((ROOT / "materials").glob("*.prm")):
    constants = constants_of(file)
    panel = 2 if "Elasticity" in constants else 0 if "Rate factor" in constants else 1
    stretch = 3.0 if panel == 2 else math.exp(0.5)
    colour = None
    for rate in RATES if panel == 0 else RATES[:1]:
        curve = pull(file, stretch, rate)
        if panel == 2:
            x, y = [1.0] + [s for s, _ in curve], [0.0] + [f for _, f in curve]
        else:
            x, y = [math.log(s) for s, _ in curve], [f * s for s, f in curve]
        (line,) = panels[panel].plot(
            x,
            y,
            color=colour,
            linestyle="-" if rate == RATES[0] else "--",
            label=file.stem if rate == RATES[0] else None,
        )
        colour = line.get_color()
        last, force = curve[-1]
        error = force / tension(constants, last, rate) - 1
        rows.append(
            [
                f"`materials/{file.name}`",
                f"{rate:g}" if panel == 0 else "any",
                f"{last:.3g}",
                f"{y[-1]:.4g}",
                f"{100 * error:+.1g} %",
            ]
        )
for axes, title in zip(panels, titles):
    axes.set_title(title)
    axes.set_xlabel("logarithmic strain" if axes is not panels[2] else "stretch")
    axes.set_ylabel("Kirchhoff stress, MPa" if axes is not panels[2] else "nominal stress, MPa")
    axes.legend(fontsize=7)
    axes.grid(alpha=0.3)
panels[0].set_ylim(0, 1800)  # room for the legend
figure.tight_layout()
if not options.quick:
    figure.savefig(ROOT / "doc/images/material_library.png", dpi=110)

publish(
    "material-library",
    "Shipped materials",
    options,
    (
        "This page shows the materials of the folder `materials/` in uniaxial tension, as the program"
        " computes them with one brick and 100 steps. Each file names its source and its units. A scene"
        " takes one by `include materials/OFHC_copper.prm` in its subsection `Material`.\n\n"
        "Solid lines are at a rate of 1/s, dashed ones at 10,000/s. Stresses of metals and sheets are over"
        " the logarithmic strain, those of rubbers are force over undeformed area.\n\n"
        "![Curves of all shipped materials](../images/material_library.png)\n\n"
        "The last column compares the last force with theory. Heating by plastic work is of first order in"
        " the step."
    ),
    table(["file", "rate, 1/s", "stretch", "last stress, MPa", "difference"], rows),
)
