# SPDX-License-Identifier: LGPL-2.1-or-later
"""Estimates the error of a scene and its sources: a bar for each source of error."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Mapping, Sequence

import numpy

from .. import UserError
from ..output import Array
from ..scene import Scene
from ..text import items, number, percent, table, written_by
from . import measure
from .outputs import Output
from .paste import HOW, lines_to_paste
from .results import Result
from .sources import GEOMETRY, MESH, Source, Variant

WIDTH = 30  # of the longest bar in text
USELESS = 0.5  # error beyond which differences are not extrapolated with reason


@dataclass
class Bar:
    """The error that a source makes, beside that of all others. Without a run it has none, and `why` says
    so."""

    source: Source
    error: float = math.nan
    low: float = math.nan
    high: float = math.nan
    order: float | None = None  # observed
    left: float | None = None  # by the finer run
    price: float = math.nan  # of the finer run, beside the scene
    corrections: dict[str, Array] = field(default_factory=dict)  # by output
    why: str = ""

    @property
    def is_known(self) -> bool:
        return not math.isnan(self.error)

    @property
    def in_sum(self) -> bool:
        return self.is_known and not self.source.is_of_mesh

    @property
    def range(self) -> str:
        if not self.is_known:
            return "–"
        if math.isinf(self.high):
            return f"{percent(self.low)} or more"
        return f"{percent(self.low)} to {percent(self.high)}" if self.high > 1.001 * self.low else "–"

    @property
    def method(self) -> str:
        """Describes how the error follows from the runs."""
        if not self.is_known:
            return self.why
        said = self.source.finer.label if self.source.finer and self.left is not None else ""
        if self.order is not None:
            said = f"three levels, observed order {number(self.order, 2)}"
            if self.order < measure.LEAST_ORDER:
                said += ": no convergence, a lower bound"
        elif self.source.ratio < 100.0:
            said = (said or "one level coarser") + ", order 1 assumed, range of orders 2 to 1/2"
        return said


def gain_of(bar: Bar) -> str:
    """A sentence on what the finer run of a bar brings, and costs."""
    run = bar.source.finer.label if bar.source.finer else ""
    left = "what it leaves is unknown" if bar.left is None else f"it leaves {percent(bar.left)}"
    return f"a run with '{run}' takes {number(bar.price, 2)} times the scene's seconds; {left}."


def relative_norm(output: Output, scale: float, values: Array) -> float:
    return output.norm(values) / scale


class Explanation:
    """The bars of a scene, from the runs that there are."""

    def __init__(
        self,
        scene: Scene,
        base: Result,
        outputs: Sequence[Output],
        weights: Mapping[str, float],
        sources: Sequence[Source],
        results: Mapping[str, Result],
        why_not: Mapping[str, str],
    ) -> None:
        """`results` by the label of the variant; `why_not` for those that are missing."""
        self.scene, self.base, self.outputs, self.weights = scene, base, outputs, weights
        self.values = {output.name: output.values(base) for output in outputs}
        self.scales = {output.name: output.scale(self.values[output.name]) for output in outputs}
        for name, scale in self.scales.items():
            if not scale > 0.0:
                raise UserError(f"the output '{name}' is zero in this scene: choose others with --outputs", 2)
        self.results, self.why_not = results, why_not
        self.more: list[str] = []  # parts of the page that follow
        self.bars = [self._bar(source) for source in sources]
        self._separate_geometry()
        self.bars.sort(
            key=lambda bar: (not bar.is_known, not bar.in_sum, -bar.error if bar.is_known else 0.0)
        )

    def _mean(self, values: Mapping[str, float]) -> float:
        names = [output.name for output in self.outputs]
        return measure.weighted_mean([values[n] for n in names], [self.weights[n] for n in names])

    def _result(self, variant: Variant | None) -> Result | None:
        return self.results.get(variant.label) if variant else None

    def _bar(self, source: Source) -> Bar:
        fine, coarse = self._result(source.finer), self._result(source.coarser)
        if fine is None and coarse is None:
            reasons = [
                f"{v.label}: {self.why_not[v.label]}" for v in source.variants if v.label in self.why_not
            ]
            return Bar(source, why="; ".join(reasons + source.remarks) or "no run")
        parts: dict[str, measure.Part] = {}
        for output in self.outputs:
            scale = self.scales[output.name]
            parts[output.name] = measure.error_part(
                output.values(coarse) if coarse else None,
                self.values[output.name],
                output.values(fine) if fine else None,
                source.ratio,
                partial(relative_norm, output, scale),
            )
        is_left = all(part.left is not None for part in parts.values())
        orders = [part.order for part in parts.values() if part.order is not None]
        return Bar(
            source,
            error=self._mean({name: part.error for name, part in parts.items()}),
            low=self._mean({name: part.low for name, part in parts.items()}),
            high=self._mean({name: part.high for name, part in parts.items()}),
            order=min(orders) if orders else None,
            left=self._mean({name: part.left or 0.0 for name, part in parts.items()}) if is_left else None,
            price=fine.core_seconds / self.base.core_seconds if fine else math.nan,
            corrections={name: part.correction for name, part in parts.items()},
        )

    def _separate_geometry(self) -> None:
        """Takes the error of the geometry, where it has a run of its own, out of that of the mesh."""
        of = {bar.source.name: bar for bar in self.bars}
        mesh, geometry = of.get(MESH), of.get(GEOMETRY)
        if mesh is None or geometry is None or not mesh.is_known or not geometry.is_known:
            return
        if not math.isfinite(mesh.high):
            geometry.source.is_of_mesh = True  # no limit to take it from
            return
        rest = {name: value - geometry.corrections[name] for name, value in mesh.corrections.items()}
        error = self._size(rest)
        factor = error / mesh.error if mesh.error > 0.0 else 1.0
        mesh.corrections, mesh.error = rest, error
        mesh.low, mesh.high = factor * mesh.low, factor * mesh.high
        mesh.left = None if mesh.left is None else factor * mesh.left

    def _size(self, corrections: Mapping[str, Array]) -> float:
        return self._mean({o.name: o.norm(corrections[o.name]) / self.scales[o.name] for o in self.outputs})

    @property
    def counted(self) -> list[Bar]:
        return [bar for bar in self.bars if bar.in_sum]

    @property
    def sum(self) -> float:
        return sum(bar.error for bar in self.counted)

    @property
    def signed_sum(self) -> float:
        """Returns the size of the sum of all corrections with their signs."""
        total = {
            name: numpy.sum([bar.corrections[name] for bar in self.counted], axis=0) for name in self.values
        }
        return self._size(total) if self.counted else math.nan

    def distance(self, result: Result) -> float:
        """The error of a run, beside the limit that the bars extrapolate."""
        off = {}
        for output in self.outputs:
            corrections = [bar.corrections[output.name] for bar in self.counted]
            limit = self.values[output.name] + numpy.sum(corrections, axis=0)
            off[output.name] = output.norm(output.values(result) - limit) / self.scales[output.name]
        return self._mean(off)

    # --- words ---

    def words(self) -> list[str]:
        counted = self.counted
        names = " and ".join(o.name for o in self.outputs)
        if not counted:
            return ["No source of error has a run yet: nothing is known of the error."]
        largest = counted[0]
        low, high = sum(b.low for b in counted), sum(b.high for b in counted)
        reach = f"{percent(low)} or more" if math.isinf(high) else f"{percent(low)} to {percent(high)}"
        said = [
            f"The scene is about {percent(self.sum)} off in {names} ({reach}) if the errors of all sources"
            f" add up. It is {percent(self.signed_sum)} off with their signs.",
            f"The largest source is {largest.source.name}, {percent(largest.error)}.",
        ]
        if len(counted) > 1 and largest.low < counted[1].high:
            said.append(
                f"Its range overlaps that of {counted[1].source.name}, the next one: their order is open."
            )
        if largest.price > 0.0:
            said.append(gain_of(largest)[:1].upper() + gain_of(largest)[1:])
        bought = [b for b in counted if b.left is not None and b.price > 0.0]
        if bought:
            best = max(bought, key=lambda b: (b.error - (b.left or 0.0)) / max(0.05, b.price - 1.0))
            if best is not largest:
                said.append("The cheapest gain: " + gain_of(best))
        if largest.error > USELESS:
            said.append(
                f"A difference of {percent(largest.error)} is too large to extrapolate: it gives the order of"
                f" the sources at most. {self._better_known()} may be known better."
            )
        missing = [
            bar
            for bar in self.bars
            if not bar.is_known and bar.source.variants and bar.source.name != GEOMETRY
        ]
        if missing:
            said.append(
                f"Not in the sum, for want of a run: {', '.join(bar.source.name for bar in missing)}."
            )
        said.append(self._estimate())
        return said

    def _better_known(self) -> str:
        if any(output.name == "shape" for output in self.outputs):
            return "A finer scene (--mesh 2), explained again,"
        return "Other --outputs, such as shape,"

    def _estimate(self) -> str:
        """Returns a sentence on the error that the run itself estimates."""
        own = self.base.estimates
        if not own:
            return "The run itself estimates no error."
        return (
            "The run itself estimates "
            + ", ".join(f"{percent(value)} for {name}" for name, value in own.items())
            + f": {percent(sum(own.values()))} together."
        )

    def rows(self) -> list[list[object]]:
        largest = max((bar.error for bar in self.bars if bar.is_known), default=0.0)
        own = self.base.estimates
        names = {"penetration": "penetrations"}
        rows: list[list[object]] = []
        for bar in self.bars:
            share = bar.error / largest if bar.is_known and largest > 0.0 else 0.0
            blocks = "#" * max(1 if share > 0.0 else 0, round(WIDTH * share))
            name = bar.source.name + (" (part of the mesh's)" if bar.source.is_of_mesh else "")
            rows.append(
                [
                    name,
                    blocks,
                    percent(bar.error),
                    bar.range,
                    percent(bar.left),
                    number(bar.price, 2),
                    percent(own.get(names.get(bar.source.name, bar.source.name))),
                    bar.method,
                ]
            )
        if self.counted:
            rows.append(
                ["**sum**", "", percent(self.sum), "–", "–", "–", percent(sum(own.values()) or None), ""]
            )
        return rows

    HEAD = ["source", "", "error", "range", "left by the run", "its cost", "run's own estimate", "how"]

    def lines(self) -> list[tuple[str, str]]:
        """[(what, lines to paste)] that reduce the largest errors, at most three."""
        found = []
        for bar in self.bars:
            if bar.is_known and bar.source.finer and bar.price > 0.0 and bar.error > 0.1 * self.sum:
                text = lines_to_paste(bar.source.finer.paste, self.scene)
                if text:
                    found.append((bar.source.finer.label, text))
        return found[:3]

    def remarks(self) -> list[str]:
        return [
            f"{bar.source.name}: {remark}."
            for bar in self.bars
            if bar.is_known
            for remark in bar.source.remarks
        ] + [
            f"{label}: {why}."
            for label, why in self.why_not.items()
            if any(bar.is_known and label in [v.label for v in bar.source.variants] for bar in self.bars)
        ]

    def page(self, title: str, command: str, remarks: Sequence[str], picture: str) -> str:
        outputs = [f"Error of {o.name}: {o.meaning}, weight {self.weights[o.name]:g}." for o in self.outputs]
        parts = [f"# How far off, and why: {title}", written_by(command)]
        parts.append(
            "This page shows how far off results of a scene are, and what each source of error adds."
        )
        parts.append(items(self.words()))
        parts.append(f"![Errors by source]({picture})")
        parts.append(table(self.HEAD, self.rows()))
        parts.append(
            items(
                [
                    *outputs,
                    "Runs: each reduces one source alone, and all take the steps of the scene.",
                    "Costs: core-seconds over those of the scene,"
                    f" {number(self.base.core_seconds)}. The cost of the run is the price to halve the error,"
                    " or to remove what a run removes.",
                    "Ranges: with three levels the order is observed, and used from 1/2 to 2. The range ends"
                    " at 1.25 times what the finer run leaves. With two levels the order is assumed.",
                ]
            )
        )
        notes = [*remarks, *self.remarks()]
        if notes:
            parts.append(items(notes))
        for label, text in self.lines():
            parts += [f"{HOW}, for {label}:", f"```prm\n{text}```"]
        parts += self.more
        return "\n\n".join(parts) + "\n"

    def write_csv(self, file: Path) -> None:
        with open(file, "w", newline="") as stream:
            out = csv.writer(stream, lineterminator="\n")
            out.writerow(
                ["source", "error", "low", "high", "order", "left", "cost", "in_sum", "own_estimate", "how"]
            )
            own = {**self.base.estimates}
            own["penetration"] = own.get("penetrations", math.nan)
            for bar in self.bars:
                cells = [
                    bar.error,
                    bar.low,
                    bar.high,
                    bar.order,
                    bar.left,
                    bar.price,
                ]
                texts = ["" if c is None or math.isnan(c) else f"{c:.6g}" for c in cells]
                estimate = own.get(bar.source.name, math.nan)
                out.writerow(
                    [
                        bar.source.name,
                        *texts,
                        int(bar.in_sum),
                        "" if math.isnan(estimate) else f"{estimate:.6g}",
                        bar.method,
                    ]
                )
