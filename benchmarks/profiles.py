# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures cost and error of the profiles fast, balanced and accurate, on every shipped scene."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from billet_runs import ROOT, Changes, arguments, number, percent, publish, table  # finds billet_tools, too
from billet_tools.scene import read_entries
from billet_tools.text import first_sentence
from curve_runs import CurveRun, error, with_curves, write_csv
from profile_runs import (
    BEGIN_LOOSER,
    CUT,
    OTHER_STEPS,
    LEFT_OUT,
    REFERENCE_STEPS,
    TIGHT,
    WHY,
    before,
    by_hand,
    left_to_profiles,
    reference,
    with_changes,
)
from profile_words import (
    AS_GOOD,
    PROFILES,
    Point,
    above,
    beside_hand,
    cheapest,
    missed_by,
    on_front,
    reasons,
    with_looser,
    within_limits,
    without_errors,
)

options = arguments("profiles")
HAND_LIMIT = 600.0  # CPU seconds of a scene's runs by hand


def off(run: CurveRun, exact: CurveRun) -> float:
    """Returns the error of a run: of energies where no tool and no pair has a force."""
    if not (run.finished and exact.finished):
        return math.nan
    if not exact.forces:
        run, exact = (with_curves(one, one.energies) for one in (run, exact))
    return error(run, exact)


def off_with_reactions(run: CurveRun, exact: CurveRun) -> float:
    """Returns the same error with the forces of supports and symmetry planes in it, of scenes with tools or
    pairs in statics and implicit dynamics; else NaN."""
    if exact.is_explicit or not exact.forces or not (run.finished and exact.finished):
        return math.nan
    return error(*(with_curves(one, one.reactions) for one in (run, exact)))


class Measured:
    """The runs of a scene: `exact`, the reference, whose augmentation is `depth`, `runs` by name, and `hand`,
    those by hand with words."""

    def __init__(self, path: Path) -> None:
        name = path.stem
        base: dict[str, object] = {**left_to_profiles(path), **CUT.get(name, {})}
        entries = with_changes(read_entries(path), base)
        for self.depth, residual, dynamic in TIGHT[BEGIN_LOOSER.get(name, 0) :]:
            changes = reference(name, entries, self.depth, residual, dynamic)
            self.exact = CurveRun(path, {**base, **changes}, options.ranks)
            if self.exact.finished or self.exact.is_explicit:
                break
        variants: dict[str, Changes] = {profile: {**base, "Profile": profile} for profile in PROFILES}
        for profile, changes in before(entries).items():
            variants[f"{profile}, before"] = {**base, "Profile": profile, **changes}
        variants["as shipped"] = CUT.get(name, {})
        self.runs = {key: CurveRun(path, changes, options.ranks) for key, changes in variants.items()}
        self.hand = [
            (words, CurveRun(path, {**base, **changes}, options.ranks)) for words, changes in by_hand(entries)
        ]

    def point(self, name: str) -> Point:
        """Returns a run's work and error."""
        return Point(self.runs[name].work, off(self.runs[name], self.exact))

    def points_by_hand(self) -> list[Point]:
        """Returns works and errors of the runs by hand that reached the end."""
        points = [Point(run.work, off(run, self.exact), words) for words, run in self.hand]
        return [point for point in points if not math.isnan(point.error)]

    def csv_rows(self, scene: str) -> list[list[object]]:
        """Returns a row for each run."""
        unit = "element updates" if self.exact.is_explicit else "iterations"
        runs = [("reference", self.exact), *self.runs.items()]
        runs += [("by hand: " + words, run) for words, run in self.hand]
        return [
            [
                scene,
                words,
                run.finished,
                run.steps,
                run.work,
                unit,
                f"{run.seconds:.4g}",
                "" if words == "reference" else f"{off(run, self.exact):.4g}",
            ]
            for words, run in runs
        ]

    def rows(self, scene: str) -> list[list[Any]]:
        """Returns the page's lines: the profiles, and the scene as shipped."""
        rows: list[list[Any]] = []
        hand = self.points_by_hand()
        for name in (*PROFILES, "as shipped"):
            run, point = self.runs[name], self.point(name)
            earlier = self.runs.get(f"{name}, before")
            best = cheapest(hand, point.error) if name in PROFILES else None
            rows.append(
                [
                    scene if name == PROFILES[0] else "",
                    name,
                    run.steps if run.finished else f"stops at {run.times[-1] if run.times else 0:.2g}",
                    run.work,
                    number(run.seconds),
                    percent(point.error) if not math.isnan(point.error) else "–",
                    (
                        f"{earlier.work}, {number(earlier.seconds)} s: {percent(off(earlier, self.exact))}"
                        if earlier
                        else ""
                    ),
                    f"{best.words}: {number(best.work)}, {percent(best.error)}" if best else "",
                    number(run.work / best.work) if best else "",
                ]
            )
        return rows


scenes = {
    path.stem: Measured(path) for path in sorted((ROOT / "prm").glob("*.prm")) if path.stem not in LEFT_OUT
}

points = {name: {profile: of.point(profile) for profile in PROFILES} for name, of in scenes.items()}
hand = {name: of.points_by_hand() for name, of in scenes.items()}
with_reactions = {
    name: {profile: Point(0, off_with_reactions(of.runs[profile], of.exact)) for profile in PROFILES}
    for name, of in scenes.items()
}
shipped = {name: of.point("as shipped") for name, of in scenes.items()}
earlier = {
    profile: {
        name: off(of.runs[f"{profile}, before"], of.exact)
        for name, of in scenes.items()
        if f"{profile}, before" in of.runs
    }
    for profile in ("fast", "balanced", "accurate")
}
n_hand = [len(of.hand) for of in scenes.values()]
seconds = sum(
    run.seconds
    for of in scenes.values()
    for run in [of.exact, *of.runs.values(), *(run for _, run in of.hand)]
)
long = [name for name, of in scenes.items() if sum(run.seconds for _, run in of.hand) > HAND_LIMIT]
publish(
    "profiles",
    "Cost and error of the profiles",
    options,
    (
        "This page shows what `Profile` = fast, balanced and accurate cost, and what errors they make. Each"
        " shipped scene runs without what a profile sets: steps, tolerances, penalties, elements and laws of"
        " rates. In implicit dynamics the steps of the scene stay."
        " Scenes marked cut have less time or a coarser mesh, as in benchmarks/profile_runs.py."
        " Each run is done once.\n\n"
        "- Work: Newton iterations with those of failed steps and of estimates; of explicit scenes element"
        " updates.\n"
        "- Error: ∫Σ|F − F*| dt over ∫Σ|F*| dt of the forces of all tools and pairs of bodies, as in (W1) of"
        " the theory. For explicit scenes, and scenes without contact, it is that of kinetic energy and of"
        " what is stored or dissipated. The error of the mesh is not in it.\n"
        "- Before: work, CPU seconds and error as they were, on the same mesh. Contact of fast had penalties"
        " alone. Static steps of balanced were up to a tenth of the end time, those of accurate up to 0.02"
        " of it. Dynamics are unchanged.\n"
        "- As shipped: the scene's own settings, with balanced for what it leaves open.\n"
        "- By hand: the cheapest of"
        f" {min(n_hand)} to {max(n_hand)} settings whose error is at most {AS_GOOD:g} times the profile's."
        " Static scenes: 5, 20 or 50 equal steps, with a `Penetration tolerance` that is automatic, or 0.01"
        " up to 20 steps. Explicit: one-point elements with penalty factors of 1 and 10, assumed strains with"
        " 10 and 40, all with a safety factor of 0.9. Implicit dynamics: five error tolerances.\n"
        "- Ratio: work of the profile over that of this run by hand.\n\n"
        "The reference F* is a run on the same mesh.\n\n"
        f"- Statics: {REFERENCE_STEPS} equal steps, augmented to {TIGHT[0][0]:g} of a facet, residuals below"
        f" {TIGHT[0][1]:g}. The number of steps is another where forces depend little on them, where the"
        " scene takes long, or where it has cycles. A table below has these scenes.\n"
        "- The patch tests have penalties of 1000 E/h instead: repeated augmentation shears facets that do"
        " not match.\n"
        "- Implicit dynamics: an error tolerance of 1e-6 instead.\n"
        "- Explicit: assumed strains, the scene's law, a safety factor of 0.3, a contact resolution of 4 and"
        " a penalty factor of 100."
    ),
    f"All runs take {number(seconds / 60)} CPU minutes, on a machine with other work."
    + (f" The runs by hand take more than ten CPU minutes in {', '.join(long)}." if long else "")
    + " These scenes are not measured:\n\n"
    + table(["scene", "why"], LEFT_OUT.items()),
    "## Errors\n\n" + within_limits(points),
    "The same with the forces of supports and symmetry planes in it, as on this page until 2026-11-29."
    " Those that hold a plane strain are as large as the tool's, and err more:\n\n"
    + within_limits(with_reactions),
    f"- Before, static scenes with fast above 5 %: {above(earlier['fast'], 0.05)}.\n"
    f"- Before, static scenes with balanced above 2 %: {above(earlier['balanced'], 0.02)}.\n"
    "- As shipped, the error is above 2 % or unknown in these scenes:"
    f" {above({name: of.error for name, of in shipped.items()}, 0.02)}.",
    "## Beside settings by hand\n\n" + beside_hand(points, hand),
    on_front(points),
    "## What is missed, and why\n\n" + reasons(missed_by(points, hand), WHY),
    "## References\n\nThese scenes have another number of steps:\n\n"
    + table(["scene", "steps"], [item for item in sorted(OTHER_STEPS.items()) if item[0] in scenes])
    + "\n\n"
    + "\n\n".join(
        part
        for part in (
            without_errors(
                {
                    name: first_sentence(of.exact.failure)
                    for name, of in scenes.items()
                    if not of.exact.finished
                }
            ),
            with_looser(
                {
                    name: of.depth
                    for name, of in scenes.items()
                    if of.exact.finished and not of.exact.is_explicit and of.depth > TIGHT[0][0]
                }
            ),
        )
        if part
    ),
    "## All scenes\n\n"
    + table(
        [
            "scene",
            "profile",
            "steps",
            "work",
            "CPU seconds",
            "error",
            "before",
            "cheapest by hand that is as good",
            "ratio",
        ],
        [row for name, of in scenes.items() for row in of.rows(name + (" (cut)" if name in CUT else ""))],
    ),
)
if not options.quick:
    write_csv(
        "profiles",
        ["scene", "run", "finished", "steps", "work", "unit", "cpu_seconds", "error"],
        [row for name, of in scenes.items() for row in of.csv_rows(name)],
    )
