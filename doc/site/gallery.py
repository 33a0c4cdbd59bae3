# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: gallery.py PROGRAM FOLDER [SCENE...]

Runs shipped scenes, all or those named, and writes what they cost to doc/scenes/costs.csv. Results go to
FOLDER/SCENE. The processor time is that of the process, its start included; one run each, on one process.
Draws the stress over the strain of the cyclic coupon, which no picture of its shape shows.
"""

from __future__ import annotations

import csv
import math
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COSTS = ROOT / "doc/scenes/costs.csv"
LOOP = ROOT / "doc/images/cyclic_coupon.png"
STRIPS = ("free_bend", "u_bend")  # of which a picture shows the springback
COLUMNS = (
    "scene",
    "method",
    "elements",
    "unknowns",
    "steps",
    "iterations",
    "processor time, s",
    "memory, MB",
    "program",
)


def measure(program: str, scene: Path, folder: Path) -> dict[str, str]:
    """Runs a scene; returns what it costs."""
    command = [program, str(scene), "--output", str(folder), "--force"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        assert process.stdout
        output = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{scene.name}: exit code {process.returncode}\n{output[-2000:]}")
    with (folder / "history.csv").open(encoding="utf-8", newline="") as file:
        last = list(csv.DictReader(file))[-1]
    text = (folder / "scene.prm").read_text(encoding="utf-8")
    scheme = re.search(r"^\s*set Scheme\s*=\s*([^#\n]+?)\s*(?:#.*)?$", text, re.MULTILINE)
    elements = re.search(r"^(\d+) elements", output, re.MULTILINE)
    unknowns = re.search(r"\b(\d+) unknowns", output)
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    return {
        "scene": scene.stem,
        "method": scheme[1] if scheme else "quasi-static",
        "elements": elements[1] if elements else "",
        "unknowns": unknowns[1] if unknowns else "",
        "steps": last["step"],
        "iterations": last.get("total_iterations", ""),
        "processor time, s": f"{usage.ru_utime + usage.ru_stime:.3g}",
        "memory, MB": f"{usage.ru_maxrss / 1024:.0f}",
        "program": version.split("\n")[0].strip(),
    }


def draw_loop(program: str, folder: Path) -> None:
    """Draws the loops of the cyclic coupon, from a run with steps that show its corners."""
    from matplotlib import pyplot  # the rest runs without it

    command = [program, str(ROOT / "prm/cyclic_coupon.prm"), "--set", "Time stepping/Initial step=0.005"]
    subprocess.run([*command, "--output", str(folder), "--force", "--quiet"], check=True)
    with (folder / "history.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    strain = [0.01 * math.sin(2 * math.pi * float(row["time"])) for row in rows]
    stress = [float(row["coupon.mean_stress_zz"]) for row in rows]
    figure, axes = pyplot.subplots(figsize=(6.4, 4), layout="constrained")
    axes.plot([0, *(100 * value for value in strain)], [0, *stress])
    axes.set_xlabel("logarithmic strain, %")
    axes.set_ylabel("axial stress, MPa")
    axes.grid(alpha=0.3)
    figure.savefig(LOOP, dpi=100, metadata={"Software": None})
    pyplot.close(figure)


def draw_strip(folder: Path, picture: Path) -> None:
    """Draws the section of a strip when formed and after springback, in the colours of its plastic strain."""
    from matplotlib import collections, pyplot  # the rest runs without these

    sys.path.insert(0, str(ROOT / "tools"))
    from billet_tools.output import pictures_of, read_grid

    *_, formed, last = pictures_of(folder)
    grids = [read_grid(file) for file in (formed, last)]
    limit = max(float(grid["equivalent_plastic_strain"].max()) for grid in grids)
    figure, axes = pyplot.subplots(1, 2, figsize=(8, 3), layout="constrained", sharex=True, sharey=True)
    for part, grid, title in zip(axes, grids, ("formed", "after springback")):
        corners = grid["points"].reshape(-1, 8, 3)[:, (0, 1, 3, 2), :2]  # of the lower face, around
        half = collections.PolyCollection(corners, cmap="viridis", edgecolor="face", linewidth=1.2)
        half.set_array(grid["equivalent_plastic_strain"][::8])
        half.set_clim(0, limit)
        mirrored = collections.PolyCollection(
            corners * (-1, 1), facecolor="0.75", edgecolor="0.75", linewidth=1.2
        )
        for section in (half, mirrored):
            part.add_collection(section)
        part.set_aspect("equal")
        part.autoscale_view()
        part.set_title(title)
        part.set_xlabel("x, mm")
    axes[0].set_ylabel("y, mm")
    figure.colorbar(half, ax=axes, label="equivalent plastic strain", shrink=0.7)
    figure.savefig(picture, dpi=100, metadata={"Software": None})
    pyplot.close(figure)


def main() -> None:
    program, folder = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    names = sys.argv[3:] or sorted(path.stem for path in (ROOT / "prm").glob("*.prm"))
    rows: dict[str, dict[str, str]] = {}
    if COSTS.exists():
        with COSTS.open(encoding="utf-8", newline="") as file:
            rows = {row["scene"]: row for row in csv.DictReader(file)}
    for name in names:
        rows[name] = measure(program, ROOT / f"prm/{name}.prm", folder / name)
        print(", ".join(rows[name].values()), flush=True)
        with COSTS.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows[key] for key in sorted(rows))
        if name == LOOP.stem and not LOOP.exists():
            draw_loop(program, folder / f"{name}_loop")
        strip = ROOT / f"doc/images/{name}.png"
        if name in STRIPS and not strip.exists():
            draw_strip(folder / name, strip)


if __name__ == "__main__":
    main()
