# SPDX-License-Identifier: LGPL-2.1-or-later
"""Patch tests in statics: stress errors of facets, passes, penalties and augmentation on distorted meshes
that do not match."""

from __future__ import annotations

import tempfile
from typing import Sequence

import numpy

from billet_runs import ROOT, Changes, arguments, publish, table
from explicit_runs import ExplicitRun

options = arguments("implicit-patch")
PAIR = "Contact pairs/cut/"
UNIT = 2e5 / 0.5  # E/h of the lower part
METHODS = [
    ("overlap", "one"),
    ("overlap", "two"),
    ("planed", "one"),
    ("planed", "two"),
    ("bilinear", "one"),
    ("bilinear", "two"),
]
PENALTIES = (0.01, 1, 10, 100) if options.quick else (0.01, 0.1, 1, 10, 100, 1e4)


def solve(scene: str, facets: str, passes: str, penalty: float, tolerance: float, changes: Changes) -> str:
    """Largest deviation of an element's stress from the mean, relative to the mean, and Newton iterations."""
    with tempfile.TemporaryDirectory() as folder:
        r = ExplicitRun(
            ROOT / "prm" / scene,
            {
                PAIR + "Facets": facets,
                PAIR + "Passes": passes,
                PAIR + "Normal penalty": penalty,
                PAIR + "Penetration tolerance": tolerance,
                "Output/Step interval": 0,
                "Solver/Maximum augmentations": 100,
                **changes,
            },
            folder,
            options.ranks,
        )
        if not r.finished:
            return "–"
        fields = r.picture()[1]
    stress = numpy.array([fields["stress_" + name] for name in ("xx", "yy", "zz", "xy", "xz", "yz")])
    stress = stress.T.reshape(-1, 8, 6).mean(axis=1)
    weights = numpy.array([1, 1, 1, 2, 2, 2])
    mean = stress.mean(axis=0)
    error = float(numpy.sqrt(((stress - mean) ** 2 @ weights).max() / (mean**2 @ weights)))
    return (
        "< 1e-7" if error < 1e-7 else f"{100 * error:.2g} %"
    ) + f" ({int(r.rows[-1]['total_iterations'])})"


def rows(
    scene: str,
    tolerance: float = 0,
    unit: float = UNIT,
    changes: Changes | None = None,
    penalties: Sequence[float] = PENALTIES,
) -> list[list[str]]:
    return [
        [facets, passes]
        + [solve(scene, facets, passes, unit * k, tolerance, changes or {}) for k in penalties]
        for facets, passes in METHODS
    ]


HEAD = ["facets", "passes"] + [f"{k:g} E/h" for k in PENALTIES]
STIFF = [k for k in PENALTIES if k >= 1]
STIFF_HEAD = ["facets", "passes"] + [f"{k:g} E/h" for k in STIFF]
FACTOR = {PAIR + "Penalty unit": "factor"}
publish(
    "implicit-patch",
    "Patch tests in statics",
    options,
    (
        "This page shows which facets pass a uniform stress on exactly, and with which penalties. Two parts"
        " of a block meet, 4 elements across on 3. All vertices within them and on the interface are"
        " moved. They move by 22 % of an element in the lower part, and by 30 % in the upper. The nodal"
        " elements, which hold nodes out of facets, cannot be exact, whatever their penalty.\n\n"
        "The table has the largest deviation of an element's stress from the mean of all, relative to that."
        " Newton iterations of two steps stand in parentheses. Field output holds single precision: what is"
        " below 1e-7 is uniform to that. The test `implicit_patch` asserts 1e-8. A dash: no solution,"
        " without cuts of the steps; at 0.01 and 0.1 E/h nodes would go deeper than contact follows them."
    ),
    "For comparison, CalculiX 2.20 on undistorted meshes that do not match (own measurements):"
    " node-to-surface 14 to 31 %.",
    "## Turned block (`prm/patch_test.prm`)\n\n" + table(HEAD, rows("patch_test.prm")),
    "## The same, augmented to a penetration of 1e-6 facet sizes\n\n"
    + table(STIFF_HEAD, rows("patch_test.prm", 1e-6, penalties=STIFF)),
    "## The same with penalties as factors\n\n"
    "Overlapping facets take the mean factor of E/h for a whole surface. For nodes the penalty is larger"
    " where facets are smaller.\n\n" + table(HEAD, rows("patch_test.prm", unit=1, changes=FACTOR)),
    "## Inclined cut with friction (`prm/patch_test_cut.prm`)\n\n"
    "The penetration displaces the upper part along the cut, beyond whose ends it finds nothing. That error"
    " goes with the penetration. At 10000 E/h nothing is left of the forces but the round-off of positions"
    " times the penalty.\n\n" + table(HEAD, rows("patch_test_cut.prm")),
)
