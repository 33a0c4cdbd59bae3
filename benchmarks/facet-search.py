# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cost of the search of contact partners over the number of facets."""

from __future__ import annotations

import math
import subprocess
from pathlib import Path

from billet_runs import PROGRAM, arguments, number, publish, table

options = arguments("facet-search")
COST = str(Path(PROGRAM).resolve().parents[1] / "benchmarks/bin/facet_search_cost")
largest = "1e5" if options.quick else "1e6"
said = subprocess.run([COST, largest], check=True, capture_output=True, text=True).stdout
rows = [[float(word) for word in line.split()] for line in said.splitlines()[1:]]


def exponent(column: int) -> float:
    """Returns the exponent of the whole cost over n log n, fitted to all sizes: 0 if both grow alike."""
    points = [(math.log(row[0]), math.log(row[column] / math.log(row[0]))) for row in rows]
    mean = [sum(values) / len(points) for values in zip(*points)]
    return sum((x - mean[0]) * (y - mean[1]) for x, y in points) / sum((x - mean[0]) ** 2 for x, _ in points)


names = {"making lists": 1, "a step, planed": 2, "a step, bilinear": 3}
publish(
    "facet-search",
    "Search of facets near nodes",
    options,
    (
        "This page shows that the search for facets costs little more per facet on large surfaces than on"
        " small ones. One of two curved sheets of facets slides on the other, with all nodes near; all"
        " nodes are slaves.\n\n"
        "The table has two costs per facet, in ns. The first is making the lists of candidates. The second"
        " is a step, in which nodes choose among their lists (planed, bilinear facets). Lists last for the"
        " number of steps in the last column, at a hundredth of a facet's size a step. There is one run on"
        " one core."
    ),
    table(
        [
            "facets",
            "lists [ns]",
            "step, planed [ns]",
            "step, bilinear [ns]",
            "candidates of a node",
            "touching nodes",
            "steps between lists",
        ],
        [
            [f"{row[0]:.0f}"]
            + [number(value, 3) for value in row[1:4]]
            + [number(row[4], 2), f"{row[5]:.0f}", number(row[6], 2)]
            for row in rows
        ],
    ),
    "The cost over n log n changes with a power of n. If that is below 0, the cost grows more slowly than n"
    " log n.\n\n" + "\n".join(f"- {name}: {exponent(column):+.2f}" for name, column in names.items()),
)
