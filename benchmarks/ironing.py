# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shallow ironing: forces of a deformable die on a deformable slab, by facets and by the length of the steps;
stopped and gone on with."""

from __future__ import annotations

import tempfile
from pathlib import Path

from billet_runs import ROOT, Run, arguments, number, percent, publish, table

options = arguments("ironing")
SCENE = ROOT / "prm/ironing.prm"
PAIR = "Contact pairs/face/"
FACET = 0.5  # mm, of the slab
FROM, SLIDE = 0.6, 1.8  # mm: means are over this stretch of the path
PRESSING = 10  # steps
METHODS = [("overlap", "one"), ("planed", "one"), ("planed", "two"), ("bilinear", "two")]
PARTS = (0.02, 0.1, 0.6) if options.quick else (0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6)


def method(facets: str, passes: str) -> dict[str, object]:
    return {PAIR + "Facets": facets, PAIR + "Passes": passes}


def sweep(facets: str, passes: str, part: float) -> tuple[float | None, float | None, Run]:
    """The slide alone, in equal steps of 1, of `part` of a facet each. Means of both forces over the
    stretch."""
    n = round(SLIDE / (part * FACET))
    run = Run(
        {
            **method(facets, passes),
            "Amplitudes/down/Times": f"0, {PRESSING}",
            "Amplitudes/down/Values": "0, -0.6",
            "Amplitudes/along/Times": f"{PRESSING}, {PRESSING + n}",
            "Amplitudes/along/Values": f"0, {SLIDE}",
            "Time stepping/End time": PRESSING + n,
            "Time stepping/Stops": "",
            "Time stepping/Step control": "fixed",
            "Time stepping/Initial step": 1,
            "Time stepping/Maximum step": None,
        },
        options.ranks,
        SCENE,
        "face",
    )
    if not run.converged:
        return None, None, run
    path = [
        (
            FACET * part * (float(row["time"]) - PRESSING),
            -float(row["face.force_x"]),
            float(row["face.force_z"]),
        )
        for row in run.rows
    ]
    path = [row for row in path if row[0] > FROM - 1e-6]

    def mean(k: int) -> float:
        return sum(0.5 * (a[k] + b[k]) * (b[0] - a[0]) for a, b in zip(path, path[1:])) / (
            path[-1][0] - path[0][0]
        )

    return mean(1), mean(2), run


def ratio(run: Run, time: float) -> float:
    row = min(run.rows, key=lambda r: abs(float(r["time"]) - time))
    return -float(row["face.force_x"]) / float(row["face.force_z"])


rows: list[list[object]] = []
for facets, passes in METHODS:
    run = Run(method(facets, passes), options.ranks, SCENE, "face")
    drawn = [
        -float(r["face.force_x"]) / float(r["face.force_z"])
        for r in run.rows
        if 1.2 - 1e-6 < float(r["time"]) < 2.8 + 1e-6
    ]
    after = run.rows[-1]
    rows.append(
        [
            facets,
            passes,
            *(
                [
                    run.steps,
                    run.iterations,
                    run.cuts,
                    f"{min(drawn):.4f} to {max(drawn):.4f}",
                    number(max(float(r["face.deepest_penetration"]) for r in run.rows) / FACET, 2),
                    number(max(abs(float(after["face.force_" + i])) for i in "xyz"), 2),
                    number(float(after["elastic_energy"]), 2),
                ]
                if run.converged
                else [f"{run.failure} at {number(run.times[-1])}", *["–"] * 6]
            ),
        ]
    )

sweeps = [[sweep(facets, passes, part) for facets, passes in METHODS] for part in PARTS]


def spread(k: int) -> str:
    ratios = [x / z for x, z, _ in (line[k] for line in sweeps) if x is not None and z is not None]
    return percent((max(ratios) - min(ratios)) / min(ratios)) if len(ratios) == len(sweeps) else "–"


STOP = 20  # steps: the die is being drawn


def forces(run: Run) -> list[list[float]]:
    return [[float(row["face.force_" + i]) for i in "xyz"] for row in run.rows]


def going_on() -> list[list[object]]:
    """The scene on 1 and 2 ranks, and the rest of it from a checkpoint on 1 and 2: difference of each force
    from the run without interruption on as many ranks as before, relative to the largest."""
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        for before in (1, 2):
            place = f"{folder}/{before}"
            whole = Run(
                {"Output/Checkpoint/Step interval": STOP, "Output/Checkpoint/Keep": 9},
                before,
                SCENE,
                "face",
                place,
            )
            checkpoint = min(Path(place, "results").glob("checkpoint_*.h5"))  # the last is that of the end
            largest = max(abs(f) for force in forces(whole) for f in force)
            for after in (1, 2):
                rest = Run({"Restart/File": checkpoint}, after, SCENE, "face", f"{place}/{after}")
                expected = whole.rows[STOP:]
                same_times = [row["time"] for row in expected] == [row["time"] for row in rest.rows]
                difference = max(
                    abs(f - g)
                    for force, other in zip(forces(whole)[STOP:], forces(rest))
                    for f, g in zip(force, other)
                )
                columns = [key for key in expected[0] if not key.startswith("total_")]
                same = same_times and all(
                    row[key] == other[key] for row, other in zip(expected, rest.rows) for key in columns
                )
                lines.append(
                    [
                        before,
                        after,
                        number(float(whole.rows[STOP - 1]["time"])),
                        len(rest.rows),
                        (
                            "other steps"
                            if not same_times
                            else "0"
                            if difference == 0
                            else number(difference / largest, 2)
                        ),
                        "yes" if same else "no",
                    ]
                )
    return lines


publish(
    "ironing",
    "Shallow ironing",
    options,
    (
        "This page shows how the forces of ironing depend on facets and steps, and that a run can be"
        " resumed in its middle. The scene is `prm/ironing.prm`. An elastic die (E 1000 MPa) is pressed 0.6"
        " mm into an elastic slab (E 100 MPa, facets of 0.5 mm). It is drawn 10 mm over the slab with a"
        " friction coefficient of 0.3, and lifted. Forces are those in the plane of 0.5 mm."
    ),
    "## All of the scene, steps as they come",
    table(
        [
            "facets",
            "passes",
            "steps",
            "iterations",
            "failed steps",
            "horizontal / vertical force, from 1 to 9 mm",
            "deepest penetration / facet",
            "largest force after lifting [N]",
            "elastic energy after lifting [N mm]",
        ],
        rows,
    ),
    "## Steps of equal length",
    (
        "The table has horizontal over vertical force for steps of each length. Values are means over the"
        f" slide from {FROM} to {SLIDE} mm (trapezoidal rule). Newton iterations for each step of all of the"
        " run stand in brackets."
    ),
    table(
        ["slide in a step / facet"]
        + [f"{facets}, {passes} pass{'es' if passes == 'two' else ''}" for facets, passes in METHODS],
        [
            [part]
            + [
                (
                    f"{x / z:.4f} ({run.iterations / run.steps:.1f})"
                    if x is not None and z is not None
                    else f"{run.failure} after {run.steps} steps"
                )
                for x, z, run in line
            ]
            for part, line in zip(PARTS, sweeps)
        ]
        + [["largest less smallest"] + [spread(k) for k in range(len(METHODS))]],
    ),
    "## Stopped while the die is drawn, and resumed",
    (
        f"The scene as it is resumes from a checkpoint after {STOP} steps. The rest is compared with the run"
        " without interruption on as many ranks as before the stop. The table has the largest difference of"
        " a force's component, relative to the largest. It also says whether all of the history agrees to"
        " its last digit."
    ),
    table(
        [
            "ranks until the stop",
            "ranks after it",
            "time of the stop",
            "steps after it",
            "difference of forces",
            "same digits",
        ],
        going_on(),
    ),
    (
        "With planed facets in two passes this holds until the die is lifted. There friction turns round,"
        " and round-off chooses between two solutions whose forces differ by 1e-4."
    ),
    (
        "For comparison, CalculiX 2.20 (own measurements, the same bodies): node-to-surface contact stops."
        " Surface-to-surface contact gives 0.88, 0.37, 0.31 and 0.30 as the increments shrink."
    ),
)
