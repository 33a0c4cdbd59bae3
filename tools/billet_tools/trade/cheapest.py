# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cheapest way to a target error by the bars of an explanation: settings that they predict, and what the
program chooses by itself, each run and compared with the limit that the bars extrapolate."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Mapping, Sequence

from ..scene import Changes, Scene
from ..text import number, percent, table
from .explanation import Bar, Explanation
from .paste import HOW, lines_to_paste
from .results import Result
from .sources import MESH, Given, Source, midpoints, sources_of

FINEST = 3  # halvings of steps and elements
DEAREST = 1000.0  # times the cost of the scene: nobody wants to run that


@dataclass
class Candidate:
    """Settings that may be within the target. `error` is the distance from the limit that the bars
    extrapolate; NaN without a run."""

    label: str
    changes: Changes
    predicted: float = math.nan
    price: float = math.nan  # beside the scene; predicted until it has run
    error: float = math.nan
    why: str = ""


def changes_at(scene: Scene, source: Source, level: int, given: Given) -> Changes | None:
    """Changes that reduce a source so many times over; of level −1 those of the coarser run. None if there
    are none."""
    if level < 0:
        return source.coarser.paste if source.coarser else None
    changes: dict[str, object] = {}
    for _ in range(level):
        if source.finer is None:
            return None
        changes.update(source.finer.paste)
        # The source of the scene as it is now.
        if source.name == "steps":
            given = given._replace(times=midpoints(given.times))
        given = given._replace(penetration=0.25 * given.penetration)
        again = sources_of(scene.changed(changes), given)
        source = next((s for s in again if s.name == source.name), Source(source.name, None))
    return changes


def levels_of(bar: Bar) -> list[tuple[int, float, float]]:
    """[(level, error, times the cost)] of a source."""
    found = [(0, bar.error, 1.0)]
    if bar.left is None or not bar.price > 0.0 or not bar.error > 0.0:
        return found
    fall, price = min(bar.left / bar.error, 0.95), max(bar.price, 1.02)
    most = FINEST if 2.0 <= bar.source.ratio <= 4.0 else 1
    found += [(n, bar.error * fall**n, price**n) for n in range(1, most + 1)]
    if bar.source.name == MESH and bar.source.coarser and fall > 0.0:
        found.append((-1, bar.error / fall, 1.0 / price))
    return [level for level in found if level[2] <= DEAREST]


def predict(explanation: Explanation, given: Given, target: float) -> Candidate | None:
    """The cheapest combination of levels whose errors add up to no more than the target; None if there is
    none."""
    counted = explanation.counted
    choices = [levels_of(bar) for bar in counted]
    within = [
        combination
        for combination in itertools.product(*choices)
        if sum(error for _, error, _ in combination) <= target
        and math.prod(price for _, _, price in combination) <= DEAREST
    ]
    scene = explanation.scene
    for combination in sorted(within, key=lambda c: float(math.prod(price for _, _, price in c))):
        changes: dict[str, object] = {}
        told = []
        for bar, (level, _, _) in zip(counted, combination):
            more = changes_at(scene, bar.source, level, given)
            if more is None:
                break
            changes.update(more)
            variant = bar.source.coarser if level < 0 else bar.source.finer
            if level and variant is not None:
                told.append(variant.label + (f" ({level} times so)" if level > 1 else ""))
        else:
            label = "by the bars: " + (", ".join(told) or "the scene as it is")
            error = sum(error for _, error, _ in combination)
            return Candidate(label, changes, error, math.prod(price for _, _, price in combination))
    return None


def by_program(scene: Scene, target: float) -> list[Candidate]:
    """The program's own choice, with the mesh and without."""
    text = f"{target:.6g}"
    found = [Candidate(f"target error {text}", {"Profile": None, "Target error": text})]
    if scene.knows("Target error of"):
        changes = {"Profile": None, "Target error": text, "Target error of": "everything"}
        found.append(Candidate(f"target error {text} of everything", changes))
    return found if scene.knows("Target error") else []


class Cheapest:
    """Results of the candidates, and the choice among them."""

    def __init__(
        self,
        explanation: Explanation,
        candidates: Sequence[Candidate],
        results: Mapping[str, Result],
        why_not: Mapping[str, str],
        target: float,
    ) -> None:
        """`results` by the label of the candidate."""
        self.scene, self.target = explanation.scene, target
        as_it_is = Candidate("the scene as it is", {}, explanation.sum, 1.0)
        as_it_is.error = explanation.distance(explanation.base)
        self.candidates = [as_it_is]
        self.uncertainty = sum(bar.high - bar.error for bar in explanation.counted)
        for candidate in candidates:
            result = results.get(candidate.label)
            if result is None:
                candidate.why = why_not.get(candidate.label, "no run")
            else:
                candidate.error = explanation.distance(result)
                candidate.price = result.core_seconds / explanation.base.core_seconds
            self.candidates.append(candidate)
        within = [c for c in self.candidates if c.error <= target]
        self.chosen = min(within, key=lambda c: c.price) if within else None

    @property
    def is_shown(self) -> bool:
        """Returns whether the choice is within the target wherever the limit is in its range."""
        return self.chosen is not None and self.chosen.error + self.uncertainty <= self.target

    def words(self) -> str:
        limit = "The limit that the bars extrapolate " + (
            "has no known range, since a source does not converge"
            if math.isinf(self.uncertainty)
            else f"is uncertain by up to {percent(self.uncertainty)}"
        )
        if self.chosen is None:
            return " ".join([f"**Nothing tried is within {percent(self.target)}.** {limit}.", *self._best()])
        cost = f"{percent(self.chosen.error)} off, {number(self.chosen.price, 2)} times the scene's cost"
        if self.is_shown:
            return (
                f"**Within {percent(self.target)}, the cheapest that was tried is {self.chosen.label}**:"
                f" {cost}. {limit}." + self._surprises()
            )
        return (
            f"**Nothing is shown to be within {percent(self.target)}.** {limit}. Beside this limit the"
            f" cheapest within the target is {self.chosen.label}: {cost}."
            " A finer scene (--mesh 2), explained again, narrows the ranges." + self._surprises()
        )

    def _best(self) -> list[str]:
        """Sentences on the run that is least far off where none is within the target."""
        tried = [c for c in self.candidates if not math.isnan(c.error)]
        if not tried:
            return []
        best = min(tried, key=lambda c: c.error)
        off = f"It is {percent(best.error)} off, at {number(best.price, 2)} times the scene's cost."
        return [f"The best that was tried is {best.label}.", off + self._surprises()]

    def _surprises(self) -> str:
        """Sentences on runs that the bars predict within the target and that are not."""
        missed = [c for c in self.candidates if c.predicted <= self.target < c.error]
        return "".join(
            f" The bars predict {percent(c.predicted)} for '{c.label}'. It is {percent(c.error)} off: their"
            f" limit may be wrong by {percent(c.error - c.predicted)}."
            for c in missed
        )

    def lines(self) -> str:
        return lines_to_paste(self.chosen.changes, self.scene) if self.chosen else ""

    def rows(self) -> list[list[object]]:
        return [
            [
                c.label,
                percent(c.predicted),
                c.why or percent(c.error),
                number(c.price, 2),
                "**chosen**" if c is self.chosen else "",
            ]
            for c in self.candidates
        ]

    def table(self) -> str:
        head = ["setting", "error predicted", "error", "times the cost of the scene", ""]
        return table(head, self.rows())

    def section(self) -> list[str]:
        """Parts of a page."""
        parts = [f"## The cheapest way to {percent(self.target)}", self.words(), self.table()]
        if self.lines():
            parts.append(f"{HOW}:\n\n```prm\n{self.lines()}```")
        return parts
