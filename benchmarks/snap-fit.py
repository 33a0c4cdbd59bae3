# SPDX-License-Identifier: LGPL-2.1-or-later
"""Snap-fit: forces of insertion and removal against beam theory and the formula of design guides."""

from __future__ import annotations

import sys

from billet_runs import ROOT, Run, arguments, number, publish, table

sys.path.insert(0, str(ROOT / "tests/cli"))
from snap_fit_theory import INSERTION, REMOVAL, Way, beam_force, design_force, force_ratio  # noqa: E402

options = arguments("snap-fit")
SCENE = ROOT / "prm/snap_fit.prm"
RISE = 0.6  # of the hook, on the straight part of either ramp


def difference(value: float, reference: float) -> str:
    return f"{100 * (value / reference - 1):+.2g} %"


def at_rise(rows: list[dict[str, float]], way: Way, node: str) -> dict[str, float]:
    """Returns the line of the history on this way in which the hook is nearest to RISE."""
    there = [row for row in rows if (row["time"] < 1) == (way is INSERTION)]
    there = [row for row in there if way.push * row["catch.force_x"] < 0]  # up the ramp, not down the other
    return min(there, key=lambda row: abs(row[f"{node}.displacement_y"] - RISE))


def line(elements: str, max_step: float) -> list[object]:
    run = Run(
        {
            "Bodies/clip/Mesh/Arguments": f"{elements} : 0, 0 : 20.5, 1",
            "Time stepping/Maximum step": max_step,
            "Time stepping/End time": 1.2,
        },
        options.ranks,
        SCENE,
        "catch",
    )
    rows = [{name: float(value) for name, value in row.items()} for row in run.rows]
    found: list[object] = [elements.replace(", ", " × "), max_step]
    for way, node in ((INSERTION, "toe"), (REMOVAL, "heel")):
        row = at_rise(rows, way, node)
        rise, force = row[f"{node}.displacement_y"], row["catch.force_y"]
        found += [
            difference(-way.push * row["catch.force_x"] / force, force_ratio(way)),
            difference(force, beam_force(way, rise)),
            difference(force, design_force(way, rise)),
            number(
                max(-way.push * r["catch.force_x"] for r in rows if (r["time"] < 1) == (way is INSERTION)), 4
            ),
        ]
    return [*found, run.iterations]


STEPS = [("41, 2", 0.02), ("82, 4", 0.02)]
if not options.quick:
    STEPS += [("82, 4", 0.01), ("164, 8", 0.02)]
WAYS = ["force ratio", "beam", "design guides", "largest force, N/mm"]
publish(
    "snap-fit",
    "Snap-fit",
    options,
    (
        "This page compares the forces of a snap-fit with those of a beam and of design guides. The scene"
        " is `prm/snap_fit.prm`, in plane strain with a friction of 0.2. A clip of 20.5 × 1 mm with a hook"
        " goes up a ramp of 30 degrees and back over one of 45 degrees.\n\n"
        f"Forces are compared where the hook has risen by {RISE} mm.\n\n"
        "- Force ratio: axial over transverse force, beside (μ + tan α)/(1 − μ tan α).\n"
        "- Beam: transverse force beside that of a cantilever under both forces in its deformed state.\n"
        "- Design guides: transverse force beside 3 E I y/((1 − ν²) L³).\n"
        "- Largest force: the largest axial force of the steps, near the fillets of the catch."
    ),
    table(
        [
            "elements",
            "largest step",
            *[f"in: {way}" for way in WAYS],
            *[f"out: {way}" for way in WAYS],
            "iterations",
        ],
        [line(*step) for step in STEPS],
    ),
)
