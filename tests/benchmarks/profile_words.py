# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the errors of profiles say, in words."""

from __future__ import annotations

import math
from typing import Mapping

from billet_runs import table


def no_better(errors: Mapping[str, Mapping[str, float]]) -> str:
    """{scene: {profile: error}}: where balanced is hardly better than fast, and for how many of them accurate
    is."""
    known = {
        name: by
        for name, by in errors.items()
        if not any(math.isnan(by.get(p, math.nan)) for p in ("fast", "balanced", "accurate"))
    }
    alike = [name for name, by in known.items() if by["balanced"] > 0.8 * by["fast"] and by["fast"] > 1e-6]
    mended = [name for name in alike if known[name]["accurate"] < 0.5 * known[name]["balanced"]]
    if not alike:
        return ""
    return (
        f"In {len(alike)} of {len(known)} scenes whose errors are known, balanced is no better than fast, or"
        " by less than a fifth.\n\n"
        f"- These are {', '.join(alike)}.\n"
        f"- In {len(mended)} of these accurate, which augments, has at most half of its error. There"
        " penalties, which let contacts give way, make most of the error. Fast and balanced share them in"
        " static scenes. Neither shorter steps nor tighter tolerances help."
    )


def without_errors(reasons: Mapping[str, str]) -> str:
    """{scene: why}: scenes whose reference failed, and what was said."""
    return (
        "No error is given where the reference itself comes to no end:\n\n"
        + table(["scene", "what the program says"], reasons.items())
        if reasons
        else ""
    )


def with_looser(depths: Mapping[str, float]) -> str:
    """{scene: facet sizes}: scenes whose reference is augmented less than others."""
    return (
        "The reference is a looser one where the tightest finds no end. Errors near those of accurate are no"
        " more than an order of magnitude there:\n\n"
        + table(["scene", "augmented to [facet]"], ([name, f"{depth:g}"] for name, depth in depths.items()))
        if depths
        else ""
    )
