# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far off a scene is, and what makes it so: a bar for each source of error."""

from __future__ import annotations

import csv
import math
import sys
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Mapping, Sequence

import numpy

from .. import UserError
from ..output import Array
from ..program import Stopped
from ..scene import Scene
from ..text import number, percent, table
from . import bars, measure
from .budget import Budget
from .options import Options, read_outputs
from .outputs import Output
from .paste import lines_to_paste
from .plan import read_presets
from .results import Result
from .run import Progress, Runner, Task, Work, clock
from .sources import GEOMETRY, MESH, Given, Source, Variant, same_steps, sources_of
from .sweep import command_text, make_force, make_outputs, refuse_outputs, remarks_of, write_files

WIDTH = 30  # of the longest bar in text


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
        """How the error follows from the runs."""
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
        """That of the corrections with their signs, over the runs of all sources."""
        total = {
            name: numpy.sum([bar.corrections[name] for bar in self.counted], axis=0) for name in self.values
        }
        return self._size(total) if self.counted else math.nan

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
            f" add up, and {percent(self.signed_sum)} with their signs.",
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
        missing = [bar for bar in self.bars if not bar.is_known and bar.source.variants]
        if missing:
            said.append(
                f"Not in the sum, for want of a run: {', '.join(bar.source.name for bar in missing)}."
            )
        said.append(self._estimate())
        return said

    def _estimate(self) -> str:
        """What the run itself says."""
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
        weights = ", ".join(f"{o.name} ({o.meaning}), weight {self.weights[o.name]:g}" for o in self.outputs)
        parts = [f"# How far off, and why: {title}", f"Written by `{command}`.", " ".join(self.words())]
        parts.append(f"![Errors by source]({picture})")
        parts.append(table(self.HEAD, self.rows()))
        parts.append(
            f"Errors: {weights}. Each run reduces one source alone, and all take the steps of the scene."
            " Costs are core-seconds over those of the scene,"
            f" {number(self.base.core_seconds)}; the cost of the run is the price to halve the error, or to"
            " remove what a run removes. With three levels the order is observed, from 1/2 to 2 used, and the"
            " range ends at 1.25 times what the finer run leaves. With two levels the order is assumed."
        )
        notes = [*remarks, *self.remarks()]
        if notes:
            parts.append("\n".join(f"- {note}" for note in notes))
        for label, text in self.lines():
            parts += [f"To paste at the end of the scene for {label}:", f"```prm\n{text}```"]
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


def without_ladder(scene: Scene, runner: Runner) -> tuple[Scene, list[str]]:
    """The scene on its given mesh, whose error is measured by levels of its own, with the part of the target
    that is left to all else."""
    if scene.get("Target error of") != "everything":
        return scene, []
    part = runner.check(scene)[2].get("target error", scene.get("Target error"))
    given = scene.changed({"Target error of": None, "Finest mesh level": None, "Target error": part})
    given.presets = read_presets(runner.check(given)[2])
    return given, ["'Target error of = everything' is left out: the bars are those of the mesh as given"]


def in_order(variants: Sequence[tuple[Source, Variant]], costs: Sequence[float]) -> list[int]:
    """Indices, those first that tell most for what they cost."""
    return sorted(range(len(variants)), key=lambda i: -variants[i][0].weight / max(1e-9, costs[i]))


def explain(
    options: Options, runner: Runner, scene: Scene, elements: int, file: Path, arguments: Sequence[str]
) -> int:
    budget: Budget = options.budget
    scene, remarks = without_ladder(scene, runner)
    refuse_outputs(read_outputs(options.outputs), scene)
    checked = runner.check(scene)[2]
    expected_sources = sources_of(scene, Given(checked=checked))
    count = 1 + sum(len(source.variants) for source in expected_sources)
    print(
        f"Budget: {count} runs at most, the scene as it is and {count - 1} others"
        + (f"; limited to {budget.text}" if budget.is_limited else ""),
        file=sys.stderr,
        flush=True,
    )
    budget.take(0.0)  # without it nothing can be said
    base = runner.run(scene, options.repeat, max(1.0, min(runner.limit, budget.seconds_left())))
    if base.status != "ok":
        raise UserError(f"the scene as it is {base.status} ({base.reason}): its error is not known", 3)
    force = make_force(options, scene, base)
    outputs, weights = make_outputs(options, scene, base, force, forces_alone=True)
    times = [float(t) for t in base.history["time"] if t > 0.0]
    sources = sources_of(scene, Given(times, base.penetration, checked))

    work = Work(
        runner,
        Progress(elements, max(1, base.steps), base.clock, scene.is_explicit, options.jobs),
        scene.changed(same_steps(scene, times)),
        budget,
    )
    why_not: dict[str, str] = {}
    usable: list[tuple[Source, Variant, Scene]] = []
    for source in sources:
        for variant in source.variants:
            changed = scene.changed(variant.changes)
            against = runner.check(changed)[1]
            if against:
                why_not[variant.label] = f"billet refuses it: {against}"
            else:
                usable.append((source, variant, changed))
    costs = [work.expected(changed, options.repeat) for _, _, changed in usable]
    order = in_order(
        [(source, variant) for source, variant, _ in usable],
        [1.0] * len(usable) if budget.is_of_runs else costs,
    )
    print(
        f"By the first run, {base.core_seconds:.2g} core-s, {len(usable)} runs take about"
        f" {clock(sum(costs) / options.jobs)}: {', '.join(usable[i][1].label for i in order)}",
        file=sys.stderr,
        flush=True,
    )
    tasks: list[Task] = [(usable[i][1].label, usable[i][2], options.repeat) for i in order]
    found = work.run(tasks, options.jobs)
    results: dict[str, Result] = {}
    for _, variant, changed in usable:
        if not work.has(found, changed):
            is_beyond = variant.label in work.left_out
            why_not[variant.label] = "beyond the budget" if is_beyond else "the study was stopped"
            continue
        result = work.result(found, changed)
        if result.status == "ok":
            results[variant.label] = result
        else:
            why_not[variant.label] = f"{result.status} ({result.reason})"

    explanation = Explanation(scene, base, outputs, weights, sources, results, why_not)
    write(explanation, options, runner, file, arguments, remarks)
    if work.was_stopped:
        raise Stopped
    return 0 if explanation.counted else 3


def write(
    explanation: Explanation,
    options: Options,
    runner: Runner,
    file: Path,
    arguments: Sequence[str],
    remarks: Sequence[str],
) -> None:
    title = options.title or explanation.scene.get("Title") or file.stem
    command = command_text(arguments)
    name, drawn = write_files(
        options,
        runner.folder / "explain",
        explanation.write_csv,
        lambda picture: bars.draw(explanation, picture, title),
        lambda picture: explanation.page(
            title, command, [" ".join(remarks_of(options, runner)), *(f"{r}." for r in remarks)], picture
        ),
    )
    print(table(explanation.HEAD, explanation.rows()) + "\n")
    print("\n".join(explanation.words()))
    for label, text in explanation.lines():
        print(f"\n# {label}\n{text}", end="")
    print(f"\n{name}.csv, {name}.md, {drawn}")
