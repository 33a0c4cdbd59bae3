# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures the error of forces by penetration with the default contact, beside penalties of 10 E/h alone, the
former default."""

from __future__ import annotations

import math
import re
from pathlib import Path

from billet_runs import ROOT, Changes, arguments, number, percent, publish, table
from billet_tools.scene import read_entries
from curve_runs import CurveRun, impulses
from curve_runs import error as curve_error

options = arguments("penetration")
LIMIT = 0.005
SLAB, PLATES = ROOT / "tests/cli/doubtful/slab.prm", ROOT / "benchmarks/stacked_plates.prm"
SCHEME = "Time stepping/Scheme"
OF_PENALTIES = ("Normal penalty", "Tangential penalty", "Penalty unit", "Penetration tolerance")
IN_MOTION = {"Bodies/R/Material/Density": "1e-3"}  # of the slab


def scene(name: str) -> Path:
    return ROOT / "prm" / f"{name}.prm"


SCENES: list[tuple[str, Path, Changes]] = [  # label, file, changes
    ("hollow block", scene("hollow_block"), {}),
    ("passing spheres", scene("passing_spheres"), {}),
    ("turned blocks", scene("turned_blocks"), {}),
    ("Hertz, cylinders", scene("hertz_cylinders"), {}),
    ("press fit", scene("press_fit"), {}),
    ("thin slab", SLAB, {}),
    ("stacked plates", PLATES, {}),
    ("thin slab", SLAB, {SCHEME: "implicit dynamics", **IN_MOTION}),
    ("stacked plates", PLATES, {SCHEME: "implicit dynamics"}),
    ("drop hammer", scene("drop_hammer"), {}),
    ("thin slab", SLAB, {SCHEME: "explicit", "Time stepping/Initial step": None, **IN_MOTION}),
    ("stacked plates", PLATES, {SCHEME: "explicit"}),
    ("Taylor's bar", scene("taylor_bar"), {}),
    ("tubes", scene("tube_impact"), {}),
    ("tube crush, to 1 ms", scene("tube_crush"), {"Time stepping/End time": "1e-3"}),
    ("cartridge, to 0.3 ms", scene("cartridge"), {"Time stepping/End time": "3e-4"}),
]
if options.quick:
    SCENES = [row for row in SCENES if row[1] in (SLAB, PLATES)]


def impulse_error(run: CurveRun, reference: CurveRun) -> float:
    if not run.finished or not reference.finished:
        return math.nan
    found, right = ({name: sums[-1] for name, sums in impulses(of).items()} for of in (run, reference))
    return sum(math.dist(found[name], right[name]) for name in right) / sum(
        math.hypot(*right[name]) for name in right
    )


rows = []
worst: dict[str, list[tuple[float, str, bool]]] = {}
for label, path, changes in SCENES:
    entries = read_entries(path)
    kind = str(changes.get(SCHEME, entries.get(SCHEME, "quasi-static")))
    pairs = sorted({key.split("/")[1] for key in entries if key.startswith("Contact pairs/")})
    bare: dict[str, object] = {
        **changes,
        **{
            key: None
            for key in entries
            if key.startswith("Contact pairs/") and key.split("/")[-1] in OF_PENALTIES
        },
    }

    def each(**values: object) -> dict[str, object]:
        return {
            f"Contact pairs/{pair}/{key.replace('_', ' ')}": value
            for pair in pairs
            for key, value in values.items()
        }

    before: Changes
    tight: Changes
    flat = 20 if path == SLAB else 1  # facet over thickness
    if kind == "quasi-static":
        error, before, tight = (
            curve_error,
            each(Penetration_tolerance=0),
            {**each(Penetration_tolerance=repr(1e-5 / flat**2)), "Solver/Maximum augmentations": 60},
        )
    else:
        error, before, tight = (
            impulse_error,
            each(Normal_penalty=10),
            each(Normal_penalty=(40 if path.stem == "drop_hammer" else 1000) * flat),
        )
        if kind == "explicit":
            tight = {**tight, "Explicit dynamics/Safety factor": "0.7"}
    more: tuple[Changes, ...] = (tight, {}, before)
    exact, run, old = (CurveRun(path, {**bare, **one}, options.ranks) for one in more)
    off, was = error(run, exact), error(old, exact)
    warnings = sorted(set(re.findall(r"warning\[([a-z-]+)\]", run.said + run.failure)))
    worst.setdefault(kind, []).append((off, label, "contact-too-soft" in warnings))
    raised = re.findall(r"rises to ([0-9.e+]+) E/h", run.said)
    rows.append(
        [
            label,
            kind,
            percent(was),
            percent(off),
            f"{old.work} → {run.work}",
            f"{number(old.seconds)} → {number(run.seconds)}",
            ", ".join(raised[-2:]),
            ", ".join(f"`{w}`" for w in warnings),
        ]
    )

said = []
for kind, found in worst.items():
    above = [f"{label} {percent(off)}" for off, label, _ in found if not off <= LIMIT]
    said.append(
        f"- {kind}: {len(found) - len(above)} of {len(found)} within {100 * LIMIT:g} %"
        + (f", not {', '.join(above)}" if above else "")
    )
publish(
    "penetration",
    "What penetration takes of the forces",
    options,
    (
        "This page shows how much force the penetration of penalty contact loses with the penalties that"
        " the program chooses. Beside them stand 10 E/h alone, the default until 2026-11-22. The scenes are"
        " the shipped ones, a slab of one layer and three plates. Meshes, steps and tolerances are the"
        " scenes'.\n\n"
        "- References: statics augmented to 1e-5 of a facet (slab: 2.5e-8), motion with 1000 E/h. For the"
        " slab h is its thickness. The drop hammer has 40 E/h, as more takes hours.\n"
        "- Errors: in statics ∫Σ|F − F*| dt over ∫Σ|F*| dt of all tools and pairs. In motion they are the"
        " same of the impulses ∫F dt, since forces vibrate.\n"
        "- Work: Newton iterations; of explicit scenes element updates.\n\n"
        "Seconds are those of a shared machine. Each run is done once."
    ),
    "\n".join(said),
    table(
        [
            "scene",
            "scheme",
            "error before",
            "error",
            "work",
            "CPU seconds",
            "penalties raised to [E/h]",
            "warnings",
        ],
        rows,
    ),
)
