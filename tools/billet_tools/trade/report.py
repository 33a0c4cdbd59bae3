# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of a sweep, what they are judged to be, and what is said of them: table, CSV and words."""

from __future__ import annotations

import csv
import math
import statistics
from dataclasses import dataclass, field
from pathlib import Path
from typing import Iterable, Mapping, Optional, Sequence

from ..scene import Changes, Scene
from ..text import big, first_sentence, items, number, percent, shortened, table, written_by
from . import measure
from .outputs import Force, Output
from .paste import HOW, lines_to_paste
from .reference import Reference
from .results import Result

# A parameter, the point with the least error, and the cheapest that keeps it.
Purchase = tuple[str, Optional["Point"], Optional["Point"]]
Forces = Optional[tuple[Force, Reference]]  # a force, and the reference that knows it


@dataclass
class Limits:
    """Limits beyond which a completed run counts as failed."""

    drift: float = 0.05  # of the energy balance, dynamic scenes
    penetration: float = 0.5  # of a facet
    locked: float = 0.2  # how much larger the mean force is than the reference's
    soft: float = 0.2  # how much smaller
    # a larger error makes a run useless; a reference with a larger uncertainty ranks nothing
    error: float = 0.5


@dataclass
class Point:
    """A run of a sweep: `curve` to which it belongs, `value` on it."""

    curve: str
    value: str
    changes: Changes
    scene: Scene
    result: Result = field(init=False)  # once it has run
    errors: dict[str, float] = field(default_factory=dict)
    error: float = math.nan
    status: str = ""
    reason: str = ""
    work: float = math.nan
    is_base: bool = False

    @property
    def seconds(self) -> float:
        return self.result.core_seconds

    @property
    def is_good(self) -> bool:
        return self.status == "ok"

    @property
    def label(self) -> str:
        return "as written" if self.is_base else f"{self.curve} = {self.value}"


def work_of(result: Result, elements: int, is_explicit: bool) -> float:
    """Returns the work independent of the machine. For explicit scenes it is elements times steps. For others
    it is elements times the iterations of Newton's method and of the linear solver."""
    last = elements * (result.steps if is_explicit else result.newton + result.linear)
    return last + result.coarser_work


# Advice for a better reference, by the source of its largest uncertainty.
ADVICE = {
    "mesh": (
        "Finer meshes of the reference (--reference-mesh 1,2,4) tell more; --reference-mesh given leaves the"
        " mesh out of the errors."
    ),
    "step": "More steps of the reference (--reference-steps N) tell more.",
    "penalty": (
        "A stiffer penalty of the reference (--reference 'Contact pairs/NAME/Normal penalty=VALUE') tells"
        " more."
    ),
    "penetration tolerance": (
        "A smaller one in the reference (--reference 'Contact pairs/NAME/Penetration tolerance=VALUE') tells"
        " more."
    ),
    "": "A finer one (--reference-mesh, --reference-steps) tells more.",
}
WORK = {
    True: "element updates (elements × steps)",
    False: "element iterations (elements × (Newton + linear iterations))",
}


def uncertainty_of(reference: Reference, outputs: Sequence[Output], weights: Mapping[str, float]) -> float:
    return measure.weighted_mean(
        [reference.uncertainty[o.name] for o in outputs], [weights[o.name] for o in outputs]
    )


def judge_forces(result: Result, forces: tuple[Force, Reference], limits: Limits) -> list[tuple[str, str]]:
    """[(status, reason)] by the mean of the forces, where it is off by more than the reference's is
    uncertain. One that is not even known to its own size may be round-off, and judges nothing."""
    force, reference = forces
    excess = force.excess(result, reference.values["force"])
    if not reference.uncertainty["force"] < min(1.0, abs(excess)):
        return []
    if excess > limits.locked:
        return [("locked", f"forces are {percent(excess)} too large in the mean")]
    if excess < -limits.soft:
        return [
            (
                "soft",
                f"forces are {percent(-excess)} too small in the mean"
                + (f", nodes {number(result.penetration, 2)} facets deep" if result.penetration > 0 else ""),
            )
        ]
    return []


def judge(
    point: Point,
    outputs: Sequence[Output],
    weights: Mapping[str, float],
    reference: Reference,
    scene: Scene,
    limits: Limits,
    forces: Forces,
) -> None:
    """Fills in errors and status. What failed has no error: nothing that failed looks good. By a reference
    that is itself known no better than a useless run nobody is judged, but by forces, if these are known
    better. `forces`: (Force, Reference that knows it), which tell whether a run is locked or soft whatever
    the outputs; None where there are none."""
    result = point.result
    point.status, point.reason = result.status, result.reason
    if result.status != "ok":
        return
    point.errors = {output.name: output.error(result, reference.values[output.name]) for output in outputs}
    error = measure.weighted_mean([point.errors[o.name] for o in outputs], [weights[o.name] for o in outputs])
    failures = []
    if scene.is_dynamic and result.drift > limits.drift:
        failures.append(("drifted", f"the energies fail to balance by {percent(result.drift)}"))
    if result.penetration > limits.penetration:
        failures.append(("pierced", f"nodes are {number(result.penetration)} facets deep"))
    is_known = uncertainty_of(reference, outputs, weights) <= limits.error
    if forces and (is_known or forces[1].uncertainty["force"] <= limits.error):
        failures += judge_forces(result, forces, limits)
    if is_known and not error <= limits.error:
        failures.append(("useless", f"the error is {percent(error)}"))
    if failures:
        point.status, point.reason = failures[0][0], "; ".join(reason for _, reason in failures)
    else:
        point.error = error


# --- numbers --------------------------------------------------------------------------------------


def error_text(error: float, uncertainty: float) -> str:
    return f"< {percent(uncertainty)}" if error < uncertainty else percent(error)


class Sweep:
    """Points of a sweep, their reference, and the conclusions from them."""

    def __init__(
        self,
        points: Sequence[Point],
        reference: Reference,
        outputs: Sequence[Output],
        weights: Mapping[str, float],
        scene: Scene,
        cost: str,
        target: float | None,
        useless: float = Limits.error,
    ) -> None:
        """`useless`: the error beyond which a run is of no use; a reference that is known no better ranks
        nothing."""
        self.points, self.reference, self.outputs, self.weights = points, reference, outputs, weights
        self.scene, self.cost, self.target = scene, cost, target
        self.uncertainty = uncertainty_of(reference, outputs, weights)
        self.is_blind = not self.uncertainty <= useless
        self.base = next(p for p in points if p.is_base)
        good = [p for p in points if p.is_good]
        self._find_cancellations(good)
        costs, errors = [self.cost_of(p) for p in good], [self.ranked(p) for p in good]
        self.noise = 0.0 if cost == "work" else timing_noise([p.result.seconds for p in good])
        self.front = (
            [] if self.is_blind else [good[i] for i in measure.pareto_front(costs, errors, self.uncertainty)]
        )
        self.chosen = None
        if target is not None and not self.is_blind:
            i = measure.cheapest_within(
                costs, errors, self.uncertainty, target, self.noise, list(map(self._preference, good))
            )
            self.chosen = None if i is None else good[i]

    def cost_of(self, point: Point) -> float:
        return point.seconds if self.cost == "seconds" else point.work

    def _find_cancellations(self, good: Sequence[Point]) -> None:
        """Finds {point: (error, by what)} of points with less error than their meshes allow, by more than the
        uncertainty. Such a point has less error than its mesh alone, which the reference knows of its own
        meshes. Or it has less than a point with a finer mesh, or clearly less than its own mesh in the
        shortest steps. Errors of opposite sign cancel there, which need not happen in another scene."""
        self.cancelled = {}
        for p in good:
            known = []
            alone = self.reference.mesh_alone(p.scene)
            if alone:
                known.append(
                    (
                        measure.weighted_mean(
                            [alone[o.name] for o in self.outputs],
                            [self.weights[o.name] for o in self.outputs],
                        ),
                        "which its mesh alone makes",
                    )
                )
            known += [
                (q.error, f"that of `{q.label}`, on a finer mesh")
                for q in good
                if q.result.elements > p.result.elements and but_the_mesh(q) == but_the_mesh(p)
            ]
            # errors within the uncertainty are told apart by nothing
            known = [
                (error, by)
                for error, by in known
                if error > self.uncertainty and error - p.error > self.uncertainty
            ]
            # but what the reference does not know of the mesh is the same of runs that differ in their steps
            # alone
            finest = max(
                (q for q in good if has_shorter_steps(q, p)), key=lambda q: q.result.steps, default=p
            )
            if finest.error > CLEARLY * max(p.error, self.uncertainty):
                known.append((finest.error, f"that of `{finest.label}`, in shorter steps"))
            if known:
                self.cancelled[id(p)] = max(known)

    def ranked(self, point: Point) -> float:
        """Returns the error by which points are compared: the expected one if errors cancel."""
        return max(point.error, self.cancelled.get(id(point), (0.0, ""))[0])

    def curves(self) -> dict[str, list[Point]]:
        """{parameter: points}, each point once."""
        found: dict[str, list[Point]] = {}
        for point in self.points:
            if not point.is_base:
                found.setdefault(point.curve, []).append(point)
        return found

    def _floored(self, point: Point) -> float:
        return max(self.ranked(point), self.uncertainty)

    def is_cheaper(self, point: Point) -> bool:
        """Returns whether a point is cheaper than the scene as written by more than the scatter of
        timings."""
        return self.cost_of(point) * (1.0 + max(0.05, self.noise)) < self.cost_of(self.base)

    def _preference(self, point: Point) -> tuple[bool, float]:
        """Returns the order of points whose timings do not differ: no cancelling errors first, then the least
        work."""
        return id(point) in self.cancelled, point.work

    def _cheapest(self, points: Sequence[Point]) -> Point:
        """Returns the preferred one of the points whose costs the timings do not distinguish from the
        lowest."""
        least = min(map(self.cost_of, points))
        return min((p for p in points if self.cost_of(p) <= least * (1.0 + self.noise)), key=self._preference)

    def _allowed(self) -> float:
        """Returns the error that the target allows beside the reference's uncertainty."""
        return (self.target or 0.0) - self.uncertainty

    def _keeping(self) -> str:
        return (
            "within the target" if self._allowed() > self._floored(self.base) * 1.02 else "at no more error"
        )

    def purchases(self) -> list[Purchase]:
        """Returns by parameter the point with the least error, and the cheapest point within the bound. The
        bound is the error of the scene as written, or the target if that is larger."""
        rows: list[Purchase] = []
        base = self.base
        if not base.is_good:
            return rows
        bound = max(self._floored(base) * 1.02, self._allowed())
        for parameter, points in self.curves().items():
            good = [p for p in points if p.is_good]
            if not good:
                rows.append((parameter, None, None))
                continue
            best = min(good, key=lambda p: (self._floored(p), self.cost_of(p)))
            keeping = [p for p in good if self._floored(p) <= bound]
            rows.append(
                (
                    parameter,
                    best if self._floored(best) < 0.95 * self._floored(base) else None,
                    self._cheapest(keeping) if keeping else None,
                )
            )
        return rows

    def times(self, point: Point) -> str:
        """Its cost beside that of the scene as written."""
        ratio = self.cost_of(point) / self.cost_of(self.base)
        return (
            f"{number(1 / ratio, 2)} times cheaper"
            if ratio < 0.95
            else (f"{number(ratio, 2)} times the cost" if ratio > 1.05 else "about the same cost")
        )

    def say(self, point: Point) -> str:
        return (
            f"`{point.label}`: error {error_text(self.ranked(point), self.uncertainty)}, {self.times(point)}"
        )

    def seems_better(self, point: Point) -> bool:
        """Returns whether the error of a point is smaller than that of the scene as written."""
        return not point.is_base and self.base.is_good and self.ranked(point) < self.ranked(self.base)

    def may_cancel(self, point: Point) -> str:
        """Returns a warning if fewer elements have a smaller error, since errors of mesh and steps may
        cancel; else nothing."""
        if (
            id(point) in self.cancelled
            or not self.seems_better(point)
            or not 0 < point.result.elements < self.base.result.elements
        ):
            return ""
        return (
            " That mesh is coarser than the scene's. Errors of mesh and steps may cancel there: a reference"
            f" known to {percent(self.uncertainty)} cannot tell."
        )

    def hint(self, point: Point) -> str:
        """Returns a remark if the gain of a point is below the reference's uncertainty."""
        small = self.seems_better(point) and self.ranked(self.base) - self._floored(point) < self.uncertainty
        return " (a gain below the reference's uncertainty)" if small else ""

    def words(self) -> list[str]:
        """Returns the findings in sentences for the console."""
        said = self.findings()
        if self.failed():
            said.append(
                "Failed: "
                + "; ".join(
                    f"{label} {status}" + (f" ({reason})" if reason else "")
                    for label, status, reason in self.failed()
                )
                + "."
            )
        if self.cancelling():
            said.append(
                "Not to be relied on, since errors of opposite sign cancel: "
                + "; ".join(
                    f"{label}, off by {error} where {expected} would be expected, {by}"
                    for label, error, expected, by in self.cancelling()
                )
                + ". They count with the larger error, and stand in brackets."
            )
        if self.target is not None:
            said.append(self.choice(self.target))
        return said

    def failed(self) -> list[list[str]]:
        """Label, status and reason of runs that failed."""
        return [
            [f"`{p.label}`", p.status, shortened(first_sentence(p.reason)) if p.reason else ""]
            for p in self.points
            if not p.is_good and not p.is_base
        ]

    def cancelling(self) -> list[list[str]]:
        """Label, error, expected error and its source of runs whose errors cancel."""
        return [
            [
                f"`{p.label}`",
                error_text(p.error, self.uncertainty),
                percent(self.ranked(p)),
                self.cancelled[id(p)][1],
            ]
            for p in self.points
            if id(p) in self.cancelled and not self.is_blind
        ]

    def findings(self) -> list[str]:
        """Returns the findings from the good runs in sentences."""
        base, said = self.base, []
        u = self.uncertainty
        if self.is_blind:
            said.append(self.blindness())
        elif base.is_good:
            said.append(
                f"The scene as it is written has an error of {error_text(self.ranked(base), u)}; it takes"
                f" {number(base.seconds)} core-seconds and {big(base.work)} {WORK[self.scene.is_explicit]}."
            )
            buys = self.purchases()
            better = [best for _, best, _ in buys if best]
            cheaper = [keep for _, _, keep in buys if keep and self.is_cheaper(keep)]
            if better:
                least = min(map(self._floored, better))
                best = min((p for p in better if self._floored(p) <= 1.1 * least), key=self.cost_of)
                said.append(
                    f"Most accuracy is bought by {self.say(best)}{self.hint(best)}.{self.may_cancel(best)}"
                )

                # Accuracy for money: decades of error for a decade of cost.
                def rate(p: Point) -> float:
                    gain = math.log(self._floored(base) / self._floored(p))
                    return gain / max(0.05, math.log(max(self.cost_of(p) / self.cost_of(base), 1.0)))

                value = max(better, key=rate)
                if value is not best:
                    said.append(
                        f"Most accuracy for its price is bought by {self.say(value)}{self.hint(value)}."
                    )
            else:
                said.append(
                    "No parameter alone makes the error measurably smaller"
                    + (": it is below the reference's uncertainty already." if self.ranked(base) < u else ".")
                )
            if cheaper:
                said.append(
                    f"Most speed is bought, {self._keeping()}, by {self.say(self._cheapest(cheaper))}."
                )
            else:
                said.append(
                    "No parameter alone makes it cheaper by more than"
                    f" {percent(max(0.05, self.noise))} {self._keeping()}."
                )
            idle = [
                parameter
                for parameter, points in self.curves().items()
                if sum(p.is_good for p in points) > 1
                and all(
                    abs(error - base.errors[name]) <= max(1e-3 * self.reference.uncertainty[name], 1e-6)
                    for p in points
                    if p.is_good
                    for name, error in p.errors.items()
                )
            ]
            if idle:
                said.append(
                    f"Only the cost, not the result, changes with {', '.join(f'`{k}`' for k in idle)}."
                )
        else:
            said.append(f"The scene as it is written is no good: {base.status}, {base.reason}.")
        return said

    def worth_timing(self) -> list[Point]:
        """Points that no other one dominates clearly: with no more error and less cost than timings of one
        run scatter."""
        good = [p for p in self.points if p.is_good]
        scatter = 1.0 if self.cost == "work" else 1.3
        return [
            p
            for p in good
            if p.is_base
            or not any(
                self._floored(q) <= self._floored(p) and scatter * self.cost_of(q) < self.cost_of(p)
                for q in good
            )
        ]

    def blindness(self) -> str:
        worst = max(self.reference.uncertainty_by_axis(), key=lambda row: row[2])
        return (
            f"**The reference is known to {percent(self.uncertainty)} only, so that errors are unknown, and"
            f" no run is ranked.** Most of that is of {worst[0]}, from the"
            f" {worst[1]} ({percent(worst[2])}). {ADVICE.get(worst[1], ADVICE[''])} --until PART and"
            " --outputs, too, may choose what is known better."
        )

    def choice(self, target: float) -> str:
        u = self.uncertainty
        if self.chosen:
            return (
                f"**Within {percent(target)}, the reference's uncertainty included, the cheapest is"
                f" {self.say(self.chosen)}.** It takes {number(self.chosen.seconds)} core-seconds."
                f"{self.may_cancel(self.chosen)}"
            )
        if self.is_blind:
            return f"**No choice within {percent(target)}.**"
        if u >= target:
            return (
                f"**No choice within {percent(target)}: the reference itself is known to {percent(u)} only.**"
                " A finer one (--reference-mesh, --reference-steps) can tell more."
            )
        best = min((p for p in self.points if p.is_good), key=self.ranked, default=None)
        return (
            f"**Nothing tried is within {percent(target)}, the reference's uncertainty of"
            f" {percent(u)} included.** "
            + (f"Nearest comes {self.say(best)}." if best else "Every run failed.")
        )

    def lines(self) -> str:
        """Returns the lines of the chosen point to paste into the scene; empty without a choice, or if the
        scene has them already."""
        return lines_to_paste(self.chosen.changes, self.scene) if self.chosen else ""

    # --- what is written ---

    def rows(self) -> list[list[object]]:
        front = set(map(id, self.front))
        rows: list[list[object]] = []
        for p in self.points:
            r = p.result
            marks = (
                ["front"] * (id(p) in front)
                + ["**chosen**"] * (p is self.chosen)
                + ["errors cancel"] * (id(p) in self.cancelled)
            )
            rows.append(
                [
                    p.curve if not p.is_base else "–",
                    p.value,
                    r.elements or "–",
                    r.steps,
                    *([] if self.scene.is_explicit else [r.newton, r.linear, r.cuts]),
                    big(p.work),
                    number(r.core_seconds),
                    self._shown_error(p) if p.is_good else f"**{p.status}**",
                    *(
                        error_text(p.errors[o.name], self.reference.uncertainty[o.name]) if p.errors else "–"
                        for o in self.outputs
                    ),
                    number(r.penetration, 2),
                    percent(r.drift),
                    ", ".join(marks),
                ]
            )
        return rows

    def _shown_error(self, point: Point) -> str:
        told = error_text(point.error, self.uncertainty)
        return f"({told})" if id(point) in self.cancelled else told

    def head(self) -> list[str]:
        return [
            "parameter",
            "value",
            "elements",
            "steps",
            *([] if self.scene.is_explicit else ["Newton", "linear", "cuts"]),
            "work",
            "core-seconds",
            "error",
            *(o.name for o in self.outputs),
            "penetration / h",
            "drift",
            "",
        ]

    def reference_table(self) -> str:
        rows = [
            [
                name,
                axis,
                levels,
                ", ".join(percent(d) for d in differences) or "–",
                number(observed, 2),
                "–" if not levels else "extrapolated" if order else "finest taken",
                percent(uncertainty),
            ]
            for name, axis, levels, differences, observed, order, uncertainty in self.reference.rows
        ]
        return table(
            [
                "output",
                "axis",
                "from coarse to fine",
                "differences",
                "observed order",
                "limit",
                "uncertainty",
            ],
            rows,
        )

    def bought_table(self) -> str:
        base = self.base
        rows = []
        for parameter, best, keep in self.purchases():

            def cell(p: Point | None) -> str:
                if p is None:
                    return "–"
                ratio = self.cost_of(p) / self.cost_of(base)
                return f"{p.value}: {error_text(self.ranked(p), self.uncertainty)} at {number(ratio, 2)}"

            rows.append([parameter, cell(best), cell(keep)])
        return table(
            ["parameter", "least error, at times the cost", f"cheapest {self._keeping()}, at times the cost"],
            rows,
        )

    def page(self, title: str, command: str, remarks: Sequence[str], picture: str) -> str:
        outputs = [f"Error of {o.name}: {o.meaning}, weight {self.weights[o.name]:g}." for o in self.outputs]
        uncertainty = ", ".join(
            f"{percent(self.reference.uncertainty[o.name])} for {o.name}" for o in self.outputs
        )
        times = f"median of {self.timed()}"
        if self.noise and any(len(p.result.seconds) > 1 for p in self.points):
            times += f", which differ by {percent(self.noise)} (median)"
        parts = [f"# What accuracy costs: {title}", written_by(command)]
        parts += [
            "This page compares runs of one scene, each with one or a few parameters changed, by error and"
            " cost."
        ]
        parts += [self.choice(self.target)] if self.target is not None else []
        parts += [items(self.findings())]
        if self.lines():
            parts.append(f"{HOW}:\n\n```prm\n{self.lines()}```")
        if picture:
            parts.append(f"![Error over cost]({picture})")
        parts += [
            items(
                [
                    *outputs,
                    *(["Error: the weighted mean of these errors."] if len(outputs) > 1 else []),
                    f"Work: {WORK[self.scene.is_explicit]}.",
                    "Core-seconds: user and system, of all ranks, start-up and output included."
                    f" They are the {times}.",
                ]
            ),
            *remarks,
        ]
        parts += (
            [
                "## What each parameter buys",
                "Each parameter is changed alone. An error below the reference's uncertainty counts as that.",
                self.bought_table(),
            ]
            if self.base.is_good and not self.is_blind
            else []
        )
        if self.failed():
            parts += ["## Failed runs", table(["run", "status", "reason"], self.failed())]
        if self.cancelling():
            parts += [
                "## Errors that cancel",
                "Do not rely on these runs: errors of opposite sign cancel. They count with the larger"
                " error.",
                table(["run", "error", "expected error", "from"], self.cancelling()),
            ]
        parts += [
            "## All runs",
            (
                "Failed runs have no error; errors that cancel stand in brackets. Penetration is the deepest,"
                " in facet sizes. Drift is the largest of the energy balance, over the largest sum of"
                " energies."
            ),
            table(self.head(), self.rows()),
            "## The reference",
            (
                f"The uncertainty is {uncertainty}, and {percent(self.uncertainty)} for the weighted mean."
                " Errors below it are unknown. Differences are those of neighbouring levels."
            ),
            self.reference_table(),
        ]
        if self.reference.remarks:
            parts.append("Remarks on the runs of the reference:")
            parts.append(table(["remark"], [[remark] for remark in self.reference.remarks]))
        return "\n\n".join(parts) + "\n"

    def timed(self) -> str:
        counts = sorted({len(p.result.seconds) for p in self.points if p.is_good})
        if not counts:
            return "one run"
        return f"{counts[0]} runs" if counts[0] == counts[-1] else f"{counts[0]} to {counts[-1]} runs"

    def write_csv(self, file: Path, reference_runs: Iterable[tuple[str, Result]]) -> None:
        names = [o.name for o in self.outputs]
        front = set(map(id, self.front))
        with open(file, "w", newline="") as stream:
            out = csv.writer(stream, lineterminator="\n")
            out.writerow(
                [
                    "kind",
                    "knob",  # the old name of a parameter, which programs that read the file know
                    "value",
                    "status",
                    "reason",
                    "elements",
                    "steps",
                    "newton_iterations",
                    "linear_iterations",
                    "cuts",
                    "work",
                    "core_seconds",
                    "timed",
                    "error",
                    "difference",
                    "uncertainty",
                    *(f"{kind}_{n}" for n in names for kind in ("difference", "uncertainty")),
                    "penetration_over_facet",
                    "energy_drift",
                    "on_front",
                    "chosen",
                    "error_to_rank_by",
                    "changes",
                ]
            )

            def line(
                kind: str,
                parameter: str,
                value: str,
                status: str,
                reason: str,
                r: Result,
                work: float,
                error: float,
                errors: Mapping[str, float],
                on_front: bool,
                chosen: bool,
                ranked: float,
                changes: Changes,
            ) -> None:
                out.writerow(
                    [
                        kind,
                        parameter,
                        value,
                        status,
                        first_sentence(reason),
                        r.elements,
                        r.steps,
                        r.newton,
                        r.linear,
                        r.cuts,
                        plain(work),
                        plain(r.core_seconds),
                        len(r.seconds),
                        plain(max(error, self.uncertainty) if error == error else error),
                        plain(error),
                        plain(self.uncertainty),
                        *(
                            plain(v)
                            for n in names
                            for v in (errors.get(n, math.nan), self.reference.uncertainty[n])
                        ),
                        plain(r.penetration),
                        plain(r.drift),
                        int(on_front),
                        int(chosen),
                        plain(ranked),
                        " ; ".join(f"{k} = {'' if v is None else v}" for k, v in changes.items()),
                    ]
                )

            for p in self.points:
                line(
                    "scene" if p.is_base else "sweep",
                    "" if p.is_base else p.curve,
                    p.value,
                    p.status,
                    p.reason,
                    p.result,
                    p.work,
                    p.error,
                    p.errors,
                    id(p) in front,
                    p is self.chosen,
                    max(self.ranked(p), self.uncertainty) if p.is_good else math.nan,
                    p.changes,
                )
            for label, result in reference_runs:
                line(
                    "reference",
                    "reference",
                    label,
                    result.status,
                    result.reason,
                    result,
                    work_of(result, result.elements, self.scene.is_explicit),
                    math.nan,
                    {},
                    False,
                    False,
                    math.nan,
                    {},
                )


def but_the_mesh(point: Point) -> dict[str, str]:
    """Returns a point's scene without its meshes."""
    return {path: value for path, value in point.scene.entries.items() if "/Mesh/" not in path}


CLEARLY = 1.2  # times an error or the uncertainty: more than other steps scatter
STEPS = ("Time stepping/", "Implicit dynamics/Error tolerance", "Explicit dynamics/Safety factor")


def but_the_steps(point: Point) -> dict[str, str]:
    """Returns a point's scene without the settings of its steps."""
    return {path: value for path, value in point.scene.entries.items() if not path.startswith(STEPS)}


def has_shorter_steps(point: Point, other: Point) -> bool:
    """Returns whether a point has at least 1.5 times the steps of another one in a scene that is the same
    otherwise."""
    return point.result.steps >= 1.5 * other.result.steps and but_the_steps(point) == but_the_steps(other)


def timing_noise(timings: Sequence[Sequence[float]]) -> float:
    """Returns the median over points of the relative spread of repeated timings; a fifth if nothing was
    repeated."""
    spreads = [(max(t) - min(t)) / max(1e-9, statistics.median(t)) for t in timings if len(t) > 1]
    return statistics.median(spreads) if spreads else 0.2


def plain(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.6g}"
