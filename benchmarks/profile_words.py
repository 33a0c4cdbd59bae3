# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sentences on the errors of profiles."""

from __future__ import annotations

import math
from typing import Mapping, NamedTuple, Sequence

from billet_runs import number, percent, quoted, table

PROFILES = ("fast", "balanced", "accurate")
LIMITS = {"fast": 0.05, "balanced": 0.02, "accurate": 0.002}  # maximum errors that are wanted
MAX_RATIO = 3.0  # times the work of the cheapest run by hand that is as good
AS_GOOD = 1.25  # times the error
MIN_ERROR = 2e-4  # smaller errors are near those of the references, and count as this one


class Point(NamedTuple):
    """A run's `work` and `error`, NaN if there is none, and its settings in `words`."""

    work: float
    error: float
    words: str = ""


Errors = Mapping[str, Mapping[str, Point]]  # by scene and profile


def cheapest(hand: Sequence[Point], error: float) -> Point | None:
    """Returns the cheapest of the runs by hand whose error is as small as this one; none if there is none."""
    good = [point for point in hand if point.error <= AS_GOOD * max(error, MIN_ERROR)]
    return min(good, key=lambda point: point.work) if good else None


def is_beaten(point: Point, others: Sequence[Point]) -> bool:
    """Tells whether one of the others is cheaper and no worse, or better and no dearer."""
    own = max(point.error, MIN_ERROR)
    for other in others:
        error = max(other.error, MIN_ERROR)
        if other.work <= point.work and error <= own and (other.work < point.work or error < own):
            return True
    return False


def names(scenes: Sequence[str]) -> str:
    """Returns the names in a list for a sentence, or 'none'."""
    return ", ".join(scenes) or "none"


def missed_by(points: Errors, hand: Mapping[str, Sequence[Point]]) -> dict[str, list[str]]:
    """Returns, for each scene that misses an error or a ratio, which profiles do."""
    missed: dict[str, list[str]] = {}
    for name, by in points.items():
        for profile, point in by.items():
            best = cheapest(hand[name], point.error)
            if point.error > LIMITS[profile]:
                missed.setdefault(name, []).append(f"{profile}: error")
            if best is not None and point.work > MAX_RATIO * best.work:
                missed.setdefault(name, []).append(f"{profile}: work")
    return missed


def reasons(missed: Mapping[str, Sequence[str]], why: Mapping[str, str]) -> str:
    """Returns the table of scenes that miss a line, with the reasons that are known."""
    if not missed:
        return ""
    return table(
        ["scene", "missed", "why"],
        [[name, ", ".join(which), why.get(name, "not known")] for name, which in missed.items()],
    )


def above(errors: Mapping[str, float], limit: float) -> str:
    """Names the scenes whose error is above a limit or unknown, with the error."""
    return names([f"{name} ({percent(off)})" for name, off in errors.items() if not off <= limit])


def within_limits(points: Errors) -> str:
    """Counts, for each profile, the scenes within the error that is wanted, and names the others."""
    rows = []
    for profile in PROFILES:
        known = {name: by[profile].error for name, by in points.items() if not math.isnan(by[profile].error)}
        missed = [f"{name} ({percent(off)})" for name, off in known.items() if off > LIMITS[profile]]
        ranked = sorted(known.values())
        rows.append(
            [
                profile,
                percent(LIMITS[profile]),
                f"{len(known) - len(missed)} of {len(known)}",
                percent(ranked[len(ranked) // 2]) if ranked else "–",
                names(missed),
            ]
        )
    return table(["profile", "wanted error", "scenes within it", "median error", "others"], rows)


def beside_hand(points: Errors, hand: Mapping[str, Sequence[Point]]) -> str:
    """Counts, for each profile, the scenes in which it costs at most MAX_RATIO times the cheapest run by hand
    that is as good, and names the others."""
    rows = []
    for profile in PROFILES:
        ratios = {}
        for name, by in points.items():
            best = cheapest(hand[name], by[profile].error)
            if best is not None:
                ratios[name] = by[profile].work / best.work
        dear = [f"{name} ({number(ratio)})" for name, ratio in ratios.items() if ratio > MAX_RATIO]
        alone = sum(not math.isnan(by[profile].error) for by in points.values()) - len(ratios)
        rows.append([profile, f"{len(ratios) - len(dear)} of {len(ratios)}", alone, names(dear)])
    return table(["profile", f"at most {MAX_RATIO:g} times", "none by hand is as good", "others"], rows)


def on_front(points: Errors) -> str:
    """Names the scenes in which a profile is beaten by another one, in work and error."""
    known = {name: by for name, by in points.items() if not any(math.isnan(p.error) for p in by.values())}
    beaten = {
        profile: [name for name, by in known.items() if is_beaten(by[profile], list(by.values()))]
        for profile in PROFILES
    }
    whole = [name for name in known if not any(name in scenes for scenes in beaten.values())]
    return (
        f"In {len(whole)} of {len(known)} scenes whose errors are known no profile is beaten by another one."
        " One that costs less and is no worse beats it, and so does one that is better and costs no more.\n\n"
        + "\n".join(
            f"- {profile} is beaten in {names(scenes)}." for profile, scenes in beaten.items() if scenes
        )
    )


def without_errors(reasons: Mapping[str, str]) -> str:
    """{scene: why}: scenes whose reference failed, and what was said."""
    return (
        "No error is given where the reference itself comes to no end:\n\n"
        + quoted((f"`{scene}`", reason) for scene, reason in reasons.items())
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
