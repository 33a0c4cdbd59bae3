# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures the cost of the default element and the default contact: every shipped scene, beside the same with
mean dilatation and penalties alone, the former defaults."""

from __future__ import annotations

import re
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
from billet_tools.output import read_rows
from billet_tools.program import ALONE
from billet_tools.scene import read_entries, with_absolute_files

options = arguments("default-cost")
LIMIT = 1.15  # of the iterations
# Explicit scenes end earlier: their steps are alike.
ENDS = {"cartridge": 1e-4, "tube_crush": 2e-4, "tube_impact": 2e-4, "taylor_bar": 2e-5}


def run(path: Path, changes: Changes) -> tuple[int, int, float, float, int]:
    text = variant(
        with_absolute_files(read_scene(path), path.parent),
        {
            "Output/Format": "none",
            "Output/Verbosity": "steps",
            "Output/Folder": "results",
            **changes,
        },
    )
    with tempfile.TemporaryDirectory() as place:
        (Path(place) / "scene.prm").write_text(text)
        done = Measured([PROGRAM, "scene.prm"], place, environment=ALONE)
        if done.code not in (0, 6):
            raise SystemExit(f"{path.stem}: {done.stderr}")
        last = read_rows(Path(place) / "results/history.csv")[-1]
    print(
        f"[{path.stem}] {last.get('total_iterations', '')} {done.seconds:.3g} s {done.megabytes:.0f} MB",
        flush=True,
    )
    elements = max([int(found) for found in re.findall(r"(\d+) elements, \d+ dofs", done.stdout)], default=0)
    return int(last["step"]), int(last.get("total_iterations", 0)), done.seconds, done.megabytes, elements


implicit, explicit, sums = [], [], [0, 0, 0]
for path in sorted((ROOT / "prm").glob("*.prm")):
    entries = read_entries(path)
    is_explicit = entries.get("Time stepping/Scheme") == "explicit"
    if options.quick and path.stem not in ("billet_upsetting", "taylor_bar"):
        continue
    changes: dict[str, object] = (
        {"Time stepping/End time": ENDS[path.stem], "Time stepping/Stops": None} if path.stem in ENDS else {}
    )
    bodies = {key.split("/")[1] for key in entries if key.startswith("Bodies/")}
    pairs = {key.split("/")[1] for key in entries if key.startswith("Contact pairs/")}
    # Taylor's bar sets one point.
    changes.update(
        {f"Bodies/{body}/Element": "assumed strain" for body in bodies if f"Bodies/{body}/Element" in entries}
    )
    element = {f"Bodies/{body}/Element": "mean dilatation" for body in bodies}
    contact = (
        {}
        if entries.get("Time stepping/Scheme", "quasi-static") != "quasi-static"
        else {
            f"Contact pairs/{pair}/Penetration tolerance": 0
            for pair in pairs
            if f"Contact pairs/{pair}/Penetration tolerance" not in entries
        }
    )
    now, before = run(path, changes), run(path, {**changes, **element, **contact})
    between = run(path, {**changes, **contact}) if contact and now[1] else now
    if is_explicit:
        per_step = [seconds / steps for steps, _, seconds, _, _ in (now, before)]
        explicit.append(
            [
                path.stem,
                now[4],
                f"{before[0]} → {now[0]}",
                number(per_step[0] / per_step[1]),
                number(now[2] / before[2]),
                f"{before[3]:.0f} → {now[3]:.0f}",
            ]
        )
    else:
        for i, result in enumerate((before, between, now)):
            sums[i] += result[1]
        implicit.append(
            [
                path.stem,
                now[4],
                before[1],
                between[1],
                now[1],
                f"{number(before[2])} → {number(now[2])}",
                f"{before[3]:.0f} → {now[3]:.0f}",
            ]
        )

publish(
    "default-cost",
    "What the default element and contact cost",
    options,
    (
        "This page shows what the default element and contact cost beside the defaults until 2026-11-22."
        " Those now are assumed strains and the automatic penetration tolerance; those before were mean"
        " dilatation and penalties alone. Scenes are the shipped ones; other values that a scene sets"
        " stay.\n\n"
        "Megabytes are the largest resident size. Seconds are those of a shared machine. Explicit scenes"
        " end early. Each run is done once."
    ),
    (
        f"The scenes take {sums[0]} Newton iterations in total before, {sums[1]} with the element alone"
        f" ({number(sums[1] / max(1, sums[0]))} times). With the contact, too, they take {sums[2]}"
        f" ({number(sums[2] / max(1, sums[0]))} times; wanted: at most {LIMIT})."
    ),
    table(
        [
            "implicit scene",
            "elements",
            "iterations before",
            "with the element",
            "with contact, too",
            "CPU seconds",
            "megabytes",
        ],
        implicit,
    ),
    table(
        ["explicit scene", "elements", "steps", "seconds a step, times", "seconds, times", "megabytes"],
        explicit,
    ),
)
