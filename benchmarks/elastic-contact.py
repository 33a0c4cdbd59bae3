# SPDX-License-Identifier: LGPL-2.1-or-later
"""Two elastic cylinders against Hertz, over meshes and facets; a round punch twisted on a block, over its
angle."""

from __future__ import annotations

import math
import tempfile

import numpy

from billet_runs import ROOT, arguments, number, percent, publish, table
from explicit_runs import ExplicitRun

options = arguments("elastic-contact")


def cylinders(n: int, facets: str, passes: str, augmented: float) -> list[object]:
    """Half-width and largest pressure relative to Hertz's for the load that is transmitted, from p² linear in
    x²."""
    mesh = {
        "Bodies/lower/Mesh/Arguments": f"{n}, 1, {n // 2} : 0, 0, -1 : 1, 0.1, 0 : true",
        "Bodies/upper/Mesh/Arguments": f"{round(0.85 * n)}, 1, {n // 2} : 0, 0, 0 : 1, 0.1, 1 : true",
    }
    pair = "Contact pairs/faces/"
    with tempfile.TemporaryDirectory() as folder:
        run = ExplicitRun(
            ROOT / "prm/hertz_cylinders.prm",
            {
                **mesh,
                pair + "Facets": facets,
                pair + "Passes": passes,
                pair + "Penetration tolerance": augmented,
                "Output/Step interval": 1000,
            },
            folder,
            options.ranks,
        )
        if not run.finished:
            return ["fails", "", "", "", ""]
        points, fields = run.picture()
    slave = (fields["contact_pressure"] > 0) & (fields["body"] == 1)
    # In two passes each face bears half.
    x, p = points[slave][:, 0], fields["contact_pressure"][slave] * (2 if passes == "two" else 1)
    effective = 1 / ((1 - 0.09) * (1 / 1e5 + 1 / 2e5))
    load = 2 * max(abs(run.rows[-1][f"faces.force_{i}"]) for i in "xyz") / 0.1
    b = math.sqrt(4 * load / (1 / 10 + 1 / 20) / (math.pi * effective))
    p0 = 2 * load / (math.pi * b)
    inner = x < 0.8 * b
    slope, constant = numpy.polyfit(x[inner] ** 2, p[inner] ** 2, 1)
    exact = p0 * numpy.sqrt(numpy.clip(1 - (x / b) ** 2, 0, None))
    return [
        int(run.rows[-1]["total_iterations"]),
        number(b, 4),
        percent(math.sqrt(constant / -slope) / b - 1),
        percent(math.sqrt(constant) / p0 - 1),
        percent(float(numpy.abs(p - exact)[inner].max()) / p0),
    ]


def twist() -> tuple[list[list[str]], int, int]:
    """Torque over the angle relative to full sliding, and the radius to which nodes stick."""
    with tempfile.TemporaryDirectory() as folder:
        mesh = (
            {
                "Bodies/block/Mesh/Arguments": "10, 10, 4 : -1, -1, -1 : 1, 1, 0 : true",
                "Bodies/punch/Mesh/Arguments": "9, 9, 4 : -1, -1, 0 : 1, 1, 1 : true",
            }
            if options.quick
            else {}
        )
        run = ExplicitRun(
            ROOT / "prm/twisted_hemisphere.prm", {**mesh, "Output/Step interval": 1}, folder, options.ranks
        )
        rows = []
        for index, row in enumerate(run.rows, 1):
            if not 1 <= row["time"] <= 2.5 + 1e-9:
                continue
            points, fields = run.picture(index)
            load = abs(row["face.force_z"])
            radius = (0.75 * load * 10 / (1000 / (1 - 0.09) / 2)) ** (1 / 3)
            full = 3 * math.pi / 16 * 0.3 * load * radius
            touching = (fields["contact_pressure"] > 0) & (fields["body"] == 1)
            stuck = touching & (fields["contact_status"] == 1)
            start = points - fields["displacement"]
            reference = numpy.hypot(start[:, 0], start[:, 1])
            angle = 0.16 * (row["time"] - 1) if row["time"] <= 2 else 0.16 - 0.016 * (row["time"] - 2)
            rows.append(
                [
                    f"{row['time']:.2f}",
                    f"{angle:.4f}",
                    number(load, 4),
                    f"{abs(row['face.moment_z']) / full:.3f}",
                    f"{reference[stuck].max() / radius:.2f}" if stuck.any() else "none sticks",
                ]
            )
        return rows, int(run.rows[-1]["total_iterations"]), len(run.rows)


METHODS = [
    ("overlap", "one", 0),
    ("overlap", "one", 1e-3),
    ("planed", "one", 0),
    ("planed", "two", 0),
    ("bilinear", "two", 0),
]
sizes = (20, 40) if options.quick else (20, 40, 80)
lines = [
    [n, facets, passes, f"{augmented:g}" if augmented else "–"] + cylinders(n, facets, passes, augmented)
    for n in sizes
    for facets, passes, augmented in METHODS
]
rows, iterations, steps = twist()
publish(
    "elastic-contact",
    "Elastic bodies: two cylinders, and a twisted punch",
    options,
    (
        "## Two cylinders\n\n"
        "This table compares the contact of two elastic cylinders with Hertz's solution. The scene is"
        " `prm/hertz_cylinders.prm`, without friction, on coarser and finer meshes that do not fit. The"
        " first column has the elements along the lower face; 85 % of them lie along the upper. Penalties"
        " are 10 E/h, alone or augmented.\n\n"
        "Half-width and largest pressure come from least squares of p² over x² within 0.8 b. They are"
        " relative to Hertz's values for the load that is transmitted. Hertz assumes half-spaces, which the"
        " cylinders, b/R up to a tenth, are not quite. The last column is the largest difference of a"
        " node's pressure there, in parts of p_0."
    ),
    table(
        [
            "elements",
            "facets",
            "passes",
            "augmented to",
            "iterations",
            "b [mm]",
            "half-width",
            "largest pressure",
            "a node's pressure",
        ],
        lines,
    ),
    (
        "## A round punch, twisted\n\n"
        "This table shows how sticking gives way to sliding under a round punch that is twisted. The scene"
        f" is `prm/twisted_hemisphere.prm`. It takes {steps} steps and {iterations} iterations.\n\n"
        "The torque about the axis is divided by that of full sliding under Hertz's pressure, 3π/16 µ P a"
        " with a³ = 3 P R/(4 E*). The sticking radius is the largest at which a node of the punch sticks,"
        " over a. From time 2 on the punch is turned back."
    ),
    table(["time", "angle", "load [N]", "torque / full sliding", "sticking radius / a"], rows),
)
