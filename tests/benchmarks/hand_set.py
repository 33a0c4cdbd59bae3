# SPDX-License-Identifier: LGPL-2.1-or-later
"""Counts in words, which must not count what cannot be compared."""

from __future__ import annotations

import math
from typing import Sequence

MOST = 1.5  # times what the cheapest run by hand costs


def beside_hand_set(works: Sequence[float], seconds: Sequence[float]) -> str:
    """How many of the ratios of work, and of seconds, to the cheapest run by hand are at most MOST; NaN: no
    run by hand is as accurate as that, so that there is nothing to compare with, and the try counts on
    neither side."""
    known = [w for w in works if not math.isnan(w)]
    times = [s for s in seconds if not math.isnan(s)]
    none = len(works) - len(known)
    return (
        f"Beside the cheapest run by hand that is within the target {sum(w <= MOST for w in known)} of"
        f" {len(known)} take at most {MOST:g} times the work, {sum(s <= MOST for s in times)} of"
        f" {len(times)} at most {MOST:g} times the CPU seconds (set-up included)"
        + (
            f"; for {none} no run by hand that was tried is within the target, and they are not counted."
            if none
            else "."
        )
    )
