# SPDX-License-Identifier: LGPL-2.1-or-later
"""The error of a mesh by coarser levels of it, with the rules of the program (source/run/body_levels.cc)."""

from __future__ import annotations

import math
from typing import Sequence

LOWEST_ORDER, HIGHEST_ORDER = 0.5, 2.0  # of convergence that count
SAFETY = 1.25  # of an observed order


def expected_order(before: float, now: float) -> float:
    """Returns the order that estimates (W5) of a mesh and of the next finer one show, at least 1, that of
    contact."""
    if not (before > 0 and now > 0):
        return 1.0
    return min(HIGHEST_ORDER, max(1.0, math.log2(before / now)))


def by_levels(differences: Sequence[float], estimates: Sequence[float]) -> float:
    """Returns (W6), the error of the finest of some meshes, by the differences between each and the next, and
    by the estimates (W5) of all; NaN of one mesh alone."""
    if not differences:
        return math.nan
    last, factor = differences[-1], 1.0
    if len(differences) < 2:
        order = expected_order(*estimates[-2:])
    else:
        before = differences[-2]
        if not before > 2**LOWEST_ORDER * last:
            return max(before, last)
        order = min(HIGHEST_ORDER, math.log2(before / last)) if last > 0 else HIGHEST_ORDER
        factor = SAFETY
    return factor * last / (2**order - 1)
