# SPDX-License-Identifier: LGPL-2.1-or-later
"""The impact of two tubes in billet and in CalculiX's explicit dynamics, on the same mesh: cost per element
and step."""

from __future__ import annotations

import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from billet_runs import (
    PROGRAM,
    ROOT,
    Changes,
    Measured,
    arguments,
    number,
    publish,
    read_scene,
    table,
    variant,
)
from ccx_decks import CCX_ENVIRONMENT, FACES, Brick, Node, read_bricks

options = arguments("tube-impact")
REPEAT = 1 if options.quick else 3
SCENE = read_scene(ROOT / "prm/tube_impact.prm")
BODIES = ("left", "right")
STEP = 5e-7  # the longest of ccx, below its bound of 9e-7: it takes all of this length
SHORT, LONG = 50, 250  # ccx's steps: their difference is free of its start


# For the flight: the same tubes, which do not see each other.
FLYING = re.sub(r"(?ms)^subsection Contact pairs$.*?^end$\n", "", SCENE)


def run_billet(changes: Changes, folder: str, scene: str = SCENE) -> tuple[int, float]:
    text = variant(scene, {"Output/Folder": "results", "Output/Interval": 0, **changes})
    Path(folder, "scene.prm").write_text(text)
    done = subprocess.run([PROGRAM, "scene.prm"], cwd=folder, capture_output=True, text=True)
    found = re.search(
        r"(\d+) steps of (\d+) elements in (\S+) s: \S+ ns for each element and step, (\S+) of", done.stdout
    )
    if done.returncode or not found:
        sys.exit(f"billet ended with {done.returncode}: {done.stderr}")
    return int(found.group(1)), float(found.group(4))


def read_mesh() -> tuple[list[Node], list[Brick]]:
    with tempfile.TemporaryDirectory() as folder:
        run_billet({"Time stepping/End time": 1e-5}, folder)
        return read_bricks(Path(folder, "results/fields_00000.vtm"), 6)


def write_deck(path: Path, nodes: list[Node], bricks: list[Brick], n_steps: int, contact: bool) -> None:
    """Tubes along x with their axes at y = ∓0.1005, flying towards each other along y."""
    count: dict[tuple[int, ...], int] = {}
    for brick in bricks:
        for face in FACES:
            key = tuple(sorted(brick[i] for i in face))
            count[key] = count.get(key, 0) + 1
    outside: dict[int, list[str]] = {-1: [], 1: []}
    for i, brick in enumerate(bricks):
        for side, face in enumerate(FACES):
            corners = [nodes[brick[c]] for c in face]
            sign = 1 if corners[0][1] > 0 else -1
            if count[tuple(sorted(brick[c] for c in face))] == 1 and all(
                ((y - sign * 0.1005) ** 2 + z**2) ** 0.5 > 0.0999 for _, y, z in corners
            ):
                outside[sign].append(f"{i + 1}, S{side + 1}")
    lines = ["*NODE, NSET=ALL"] + [f"{i + 1}, {x:.9g}, {y:.9g}, {z:.9g}" for i, (x, y, z) in enumerate(nodes)]
    lines += ["*ELEMENT, TYPE=C3D8R, ELSET=TUBES"]
    lines += [", ".join(str(v) for v in [i + 1] + [c + 1 for c in brick]) for i, brick in enumerate(bricks)]
    for name, sign in (("LEFT", -1), ("RIGHT", 1)):
        lines += [f"*NSET, NSET={name}"] + [str(i + 1) for i, node in enumerate(nodes) if sign * node[1] > 0]
    lines += [
        "*MATERIAL, NAME=TUBE",
        "*ELASTIC",
        "25e9, 0.3",
        "*PLASTIC",
        "2e6, 0",
        "632e6, 1",
        "*DENSITY",
        "7840",
        "*SOLID SECTION, ELSET=TUBES, MATERIAL=TUBE",
    ]
    if contact:
        lines += ["*SURFACE, NAME=A"] + outside[-1] + ["*SURFACE, NAME=B"] + outside[1]
        lines += [
            "*SURFACE INTERACTION, NAME=TOUCH",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
            "2.5e12",
            "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE",
            "A, B",
        ]
    lines += [
        "*INITIAL CONDITIONS, TYPE=VELOCITY",
        "LEFT, 2, 50",
        "RIGHT, 2, -50",
        "*STEP, NLGEOM, INC=1000000",
        "*DYNAMIC, EXPLICIT",
        f"{STEP:g}, {n_steps * STEP:g}, 1e-10, {STEP:g}",
        f"*NODE PRINT, NSET=ALL, TOTALS=ONLY, FREQUENCY={SHORT}",
        "RF",
        "*END STEP",
    ]
    path.write_text("\n".join(lines) + "\n")


def run_ccx(nodes: list[Node], bricks: list[Brick], n_steps: int, contact: bool) -> float | None:
    """Its processor seconds; None if it gave up before the end."""
    with tempfile.TemporaryDirectory() as folder:
        write_deck(Path(folder, "deck.inp"), nodes, bricks, n_steps, contact)
        done = Measured(["ccx", "deck"], folder, environment=CCX_ENVIRONMENT)
        seconds = done.seconds
        printed = Path(folder, "deck.dat").read_text().count("total force")  # every SHORT steps
    is_done = done.code == 0 and printed == n_steps // SHORT
    print(
        (
            f"[ccx, {n_steps} steps{', contact' if contact else ''}] {printed} prints, {seconds:.3g} s, "
            f"{'done' if is_done else done.stdout[-400:]}"
        ),
        file=sys.stderr,
        flush=True,
    )
    return seconds if is_done else None


nodes, bricks = read_mesh()
n = len(bricks)
ways: dict[str, Changes] = {
    "billet, as the scene is": {},
    "billet, one point": {f"Bodies/{b}/Element": "one point" for b in BODIES},
    "billet, one point, hypoelastic": {
        key: value
        for b in BODIES
        for key, value in (
            (f"Bodies/{b}/Element", "one point"),
            (f"Bodies/{b}/Material/Elasticity", "hypoelastic"),
        )
    },
}
END_TIME, FLIGHT_TIME = 0.3e-3, 0.12e-3
END: dict[str, object] = {
    "Time stepping/End time": END_TIME,
    "Output/History interval": 0.1e-3,
    "Output/Format": "none",
}
FLIGHT: dict[str, object] = {**END, "Time stepping/End time": FLIGHT_TIME}
LEGS: list[tuple[str, Changes, str]] = [("", END, SCENE), (", in flight", FLIGHT, FLYING)]
costs: dict[str, list[float]] = {
    name: [] for name in [*ways, *(f"{name}, in flight" for name in ways), "ccx", "ccx, contact"]
}
steps, loads = {}, []
for _ in range(REPEAT):
    loads.append(os.getloadavg()[0])
    for name, changes in ways.items():
        for suffix, end, scene in LEGS:
            with tempfile.TemporaryDirectory() as folder:
                steps[name + suffix], ns = run_billet({**changes, **end}, folder, scene)
            costs[name + suffix].append(ns)
    for name, contact in (("ccx", False), ("ccx, contact", True)):
        if costs["ccx, contact"] and contact:  # ten times dearer, once will do
            continue
        short, long = (run_ccx(nodes, bricks, count, contact) for count in (SHORT, LONG))
        steps[name] = LONG - SHORT
        if short and long:
            costs[name].append(1e9 * (long - short) / (steps[name] * n))

rows = []
for name, values in costs.items():
    contact = name == "ccx, contact" or (name in ways)
    beside = costs["ccx, contact" if contact else "ccx"]
    if values:
        rows.append(
            [
                name.split(", in flight")[0].replace(", contact", ""),
                "yes" if contact else "no",
                steps[name],
                number(statistics.median(values), 4),
                number(min(values), 4),
                number(statistics.median(beside) / statistics.median(values), 3) if beside else "–",
            ]
        )
said = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
version = re.findall(r"Version (\S+)", said)[0]

publish(
    "tube-impact",
    "The impact of two tubes, per element and step, beside CalculiX",
    options,
    (
        "This page compares the cost of an explicit step per element in billet and in CalculiX. Wanted: at"
        " least ten times cheaper than CalculiX.\n\n"
        f"The scene is `prm/tube_impact.prm`, {n} bricks. CalculiX {version} (`*DYNAMIC, EXPLICIT`, C3D8R)"
        f" has the same nodes, bricks, material and velocities, and steps of {STEP:g} s. Processor time is"
        " that on one core without other threads.\n\n"
        f"- billet: the stepping loop for the first {END_TIME * 1000.0:g} ms, contact included, and for"
        f" {FLIGHT_TIME * 1000.0:g} ms of flight, without the contact pair.\n"
        f"- CalculiX: the difference of runs of {LONG} and {SHORT} steps, without contact and with it"
        " (surface to surface, linear, 2.5e12 N/m³).\n\n"
        f"The table has the median and least of {REPEAT} runs (ccx with contact: one), programs in turn. The"
        f" load average was {min(loads):.1f} to {max(loads):.1f} on {os.cpu_count()} cores."
    ),
    table(
        ["program", "contact", "steps", "ns per element and step", "least", "times cheaper than ccx"], rows
    ),
    "" if costs["ccx, contact"] else "With contact CalculiX did not finish these steps.",
)
