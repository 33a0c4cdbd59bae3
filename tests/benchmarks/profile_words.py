# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the errors of profiles say, in words."""

from __future__ import annotations

import math
from typing import Mapping


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
        f"balanced is no better than fast, or by less than a fifth, in {len(alike)} of {len(known)} scenes"
        f" whose errors are known ({', '.join(alike)}). In {len(mended)} of these accurate, which augments,"
        " has at most half of its error: penalties, which fast and balanced share in static scenes and which"
        " let contacts give way, make most of the error there, and neither shorter steps nor tighter"
        " tolerances help."
    )


def without_errors(reasons: Mapping[str, str]) -> str:
    """{scene: why}: scenes whose reference failed, and what was said."""
    return (
        ""
        if not reasons
        else "No error is told where the reference itself comes to no end: "
        + "; ".join(f"{name} ({why})" for name, why in reasons.items())
        + "."
    )
