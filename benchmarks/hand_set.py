# SPDX-License-Identifier: LGPL-2.1-or-later
"""Counts in words, which must not count what cannot be compared."""

from __future__ import annotations

import math
from typing import Sequence

MOST = 1.5  # times what the cheapest run by hand costs


def beside_hand_set(works: Sequence[float], seconds: Sequence[float]) -> str:
    """Returns how many of the ratios of work, and of seconds, to the cheapest run by hand are at most MOST.
    NaN: no run by hand is as accurate, so that there is nothing to compare with, and the run does not
    count."""
    known = [w for w in works if not math.isnan(w)]
    times = [s for s in seconds if not math.isnan(s)]
    none = len(works) - len(known)
    return (
        "They are compared with the cheapest run by hand that is within the target:"
        f" {sum(w <= MOST for w in known)} of {len(known)} take at most {MOST:g} times the work."
        f" {sum(s <= MOST for s in times)} of {len(times)} take at most {MOST:g} times the CPU seconds"
        " (set-up included)."
        + (f" For {none} no run by hand is within the target: they are not counted." if none else "")
    )
