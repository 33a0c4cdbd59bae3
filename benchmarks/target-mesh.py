# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures whether runs with 'Target error of = everything' are as accurate as they should be, mesh included,
and their cost beside runs set by hand."""

from __future__ import annotations

import math
import re
from itertools import product
from typing import Callable, Iterator, NamedTuple, Sequence

from billet_runs import ROOT, Changes, arguments, number, percent, publish, table
from curve_runs import CurveRun

options = arguments("target-mesh")
TARGETS = (0.1, 0.05, 0.02, 0.01)
ALLOWED_COST = 2.0
N_TIMES = 3  # runs that ratios compare
WANTED_RIGHT, WANTED_CHEAP = 0.9, 0.75  # parts of the runs
MISSED = "[mesh-target-missed]", "[target-error-missed]"


class Case(NamedTuple):
    """A scene. `mesh`: changes for a level of its meshes, 0 as given. Levels up to `finest` are allowed, and
    the reference is of the three levels up to `reference`."""

    name: str
    scene: str
    mesh: Callable[[int], Changes]
    finest: int
    reference: int
    levels: Sequence[int]  # of runs by hand
    pairs: Sequence[str] = ()
    end: float = 1.0
    is_explicit: bool = False
    by_energies: bool = False  # where loads are given, forces are, too
    others: Changes = {}
    n_steps: int = 160  # of the reference

    def pair(self, key: str, value: object) -> Changes:
        return {f"Contact pairs/{pair}/{key}": value for pair in self.pairs}

    def steps(self, n: int) -> Changes:
        return {
            "Time stepping/Initial step": repr(self.end / n),
            "Time stepping/Maximum step": repr(self.end / n),
        }

    def references(self) -> Iterator[Changes]:
        for level in range(self.reference - 2, self.reference + 1):
            if self.is_explicit:
                yield {
                    **self.others,
                    **self.mesh(level),
                    **self.pair("Normal penalty", 30),
                    "Explicit dynamics/Contact resolution": 2,
                    "Output/History interval": repr(self.end / 400),
                }
            else:
                yield {
                    **self.others,
                    **self.mesh(level),
                    **self.steps(self.n_steps),
                    **self.pair("Penetration tolerance", 1e-4),
                    "Solver/Force tolerance": 1e-6,
                    "Solver/Maximum augmentations": 60,
                }

    def by_hand(self) -> Iterator[tuple[str, Changes]]:
        """Yields settings of a user: 27 at most."""
        if self.is_explicit:
            for level, penalty, safety in product(self.levels, (1, 3, 10), (0.9, 0.75)):
                yield f"level {level}, penalty {penalty}, safety {safety:g}", {
                    **self.others,
                    **self.mesh(level),
                    **self.pair("Normal penalty", penalty),
                    "Explicit dynamics/Safety factor": safety,
                }
            return
        depths = (None, 1e-2, 1e-3) if self.pairs else (None,)
        for level, n, depth in product(self.levels, (3, 10, 40), depths):
            said = f"augmented to {depth:g}" if depth else "penalties" if self.pairs else ""
            yield f"level {level}, {n} steps" + (f", {said}" if said else ""), {
                **self.others,
                **self.mesh(level),
                **self.steps(n),
                **self.pair("Penetration tolerance", depth),
            }

    def target(self, target: float) -> Changes:
        own = (
            self.pair("Normal penalty", None)
            if self.is_explicit
            else self.pair("Penetration tolerance", None)
        )
        free: Changes = {} if self.is_explicit else {key: None for key in self.steps(1)}
        return {
            **self.others,
            **self.mesh(0),
            **own,
            **free,
            "Target error": target,
            "Target error of": "everything",
            "Finest mesh level": self.finest,
        }


def refined(body: str, given: int, layers: int = 0) -> Callable[[int], Changes]:
    def mesh(level: int) -> Changes:
        changes: dict[str, object] = {f"Bodies/{body}/Mesh/Refinements": given + level}
        if layers:
            changes[f"Bodies/{body}/Mesh/Layers"] = int(layers * 2**level)
        return changes

    return mesh


def boxes(**bodies: str) -> Callable[[int], Changes]:
    """Subdivided boxes by body: 'nx, ny, nz : the rest'; numbers of 1 stay."""

    def mesh(level: int) -> Changes:
        changes: dict[str, object] = {}
        for body, text in bodies.items():
            counts, rest = text.split(" : ", 1)
            numbers = [n if n == "1" else str(max(1, int(int(n) * 2**level))) for n in counts.split(", ")]
            changes[f"Bodies/{body}/Mesh/Arguments"] = ", ".join(numbers) + " : " + rest
        return changes

    return mesh


def tubes(level: int) -> Changes:
    changes: dict[str, object] = {}
    for body in ("left", "right"):
        mesh = f"Bodies/{body}/Mesh/"
        changes[mesh + "Arguments"] = "0, 0 : 0.09 : 0.1 : 1 : 0 : 16 : true"
        changes[mesh + "Layers"] = 8 * 2**level
        changes[mesh + "Refinements"] = level
    return changes


ARC = {"inner": "x*cos(pi/180*y) ; x*sin(pi/180*y) ; z", "outer": "x*cos(pi/180*y) ; x*sin(pi/180*y) ; z"}
CASES = [
    Case(
        "billet upsetting",
        "prm/billet_upsetting",
        refined("billet", 1, 6),
        1,
        2,
        (-1, 0, 1),
        ["billet on die"],
    ),
    Case(
        "Hertz, two cylinders",
        "prm/hertz_cylinders",
        boxes(
            lower="16, 1, 8 : 0, 0, -1 : 1, 0.1, 0 : true",
            upper="14, 1, 8 : 0, 0, 0 : 1, 0.1, 1 : true",
        ),
        1,
        2,
        (-1, 0, 1),
        ["faces"],
    ),
    Case(
        "press fit",
        "prm/press_fit",
        boxes(
            inner="4, 12, 1 : 10, 0, 0 : 20.01, 90, 1 : true", outer="4, 12, 1 : 20, 0, 0 : 30, 90, 1 : true"
        ),
        1,
        2,
        (-1, 0, 1),
        ["fit"],
        others={
            "Time stepping/Step control": None,
            **{f"Bodies/{body}/Mesh/Positions": positions for body, positions in ARC.items()},
        },
    ),
    Case(
        "ring crushed",
        "prm/ring_crush",
        boxes(ring="2, 1, 48 : 9.5, 0, -90 : 10, 0.5, 90 : true"),
        1,
        2,
        (0, 1),
        ["ring under die", "ring on ground"],
        end=2.1,
        others={"Bodies/ring/Mesh/Boundary ids": "6 : z < -9.98"},
    ),
    Case(
        "cylinder under pressure",
        "prm/pressurised_cylinder",
        boxes(cylinder="4, 8 : 10, 0 : 20, 90 : true"),
        1,
        2,
        (-1, 0, 1),
        by_energies=True,
        others={
            "Bodies/cylinder/Mesh/Primitive": "subdivided_hyper_rectangle",
            "Bodies/cylinder/Mesh/Refinements": 0,
            "Bodies/cylinder/Mesh/Positions": ARC["inner"],
        },
    ),
    Case(
        "cantilever",
        "tests/cli/cantilever",
        boxes(beam="16, 1, 8 : 0, 0, 0 : 20, 1, 10"),
        1,
        2,
        (-1, 0, 1),
    ),
    Case(
        "block on a stiff base",
        "tests/cli/stiff_base",
        boxes(block="8, 1, 4 : -5, 0, 0 : 5, 1, 5", base="16, 1, 8 : -10, 0, -10 : 10, 1, 0"),
        1,
        2,
        (-1, 0, 1),
    ),
    Case(
        "Wagoner's punch without friction",
        "prm/wagoner_punch_mu_0",
        refined("blank", 2),
        1,
        2,
        (-1, 0, 1),
        ["blank on punch", "blank on die"],
    ),
    Case(
        "Taylor bar",
        "prm/taylor_bar",
        refined("bar", 1, 24),
        1,
        2,
        (-1, 0, 1),
        ["bar on wall"],
        end=80e-6,
        is_explicit=True,
        others={"Output/Interval": 0},
    ),
    Case(
        "impact of two tubes",
        "prm/tube_impact",
        tubes,
        1,
        2,
        (0, 1),
        ["tubes"],
        end=1e-3,
        is_explicit=True,
        others={"Time stepping/End time": 1e-3, "Output/Interval": 0},
    ),
]


def run_case(case: Case, changes: Changes) -> CurveRun:
    """Returns a run with the curves that are compared."""
    run = CurveRun(ROOT / f"{case.scene}.prm", changes)
    run.curves = run.energies if case.by_energies or run.is_explicit else run.reactions
    return run


class Reference:
    """The finest of three meshes, extrapolated by the order that they show."""

    def __init__(self, case: Case) -> None:
        self.runs = [run_case(case, changes) for changes in case.references()]
        before, last = (self.difference(a, b) for a, b in zip(self.runs, self.runs[1:]))
        self.order = min(2.0, math.log2(before / last)) if before > last > 0 else math.nan
        self.factor = 0.0 if math.isnan(self.order) else 1 / (2**self.order - 1)

    def difference(self, run: CurveRun, other: CurveRun) -> float:
        return self.integrate(run, other.at)

    def exact(self, name: str, time: float) -> list[float]:
        coarse, fine = (run.at(name, time) for run in self.runs[-2:])
        return [b + self.factor * (b - a) for a, b in zip(coarse, fine)]

    def error(self, run: CurveRun) -> float:
        return self.integrate(run, self.exact) if run.finished and run.times else math.nan

    def integrate(self, run: CurveRun, other: Callable[[str, float], Sequence[float]]) -> float:
        """∫Σ|F − F*| dt over ∫Σ|F*| dt at the ends of the run's steps, by the trapezoidal rule."""
        curves = run.curves
        off, size = [], []
        for i, time in enumerate(run.times):
            exact = {name: other(name, time) for name in curves}
            off.append(sum(math.dist(curves[name][i], exact[name]) for name in curves))
            size.append(sum(math.hypot(*exact[name]) for name in curves))

        def integral(values: Sequence[float]) -> float:
            times = run.times
            return sum(
                0.5 * (a + b) * (t - s) for a, b, s, t in zip(values, values[1:], times, times[1:])
            ) + (0.5 * values[0] * times[0])

        return integral(off) / integral(size)


class Try(NamedTuple):
    """A run to a target, and the cheapest by hand that is within it: of all, and of those whose mesh with the
    finest steps and tolerances is, too."""

    target: float
    error: float
    run: CurveRun
    cheapest: str
    seconds_by_hand: float
    safe_seconds: float

    @property
    def is_missed(self) -> bool:
        of_last_level = self.run.said.rsplit("Mesh level ", 1)[-1] + self.run.failure
        return any(key in of_last_level for key in MISSED) or not self.run.finished

    @property
    def estimated(self) -> float:
        """Returns the error that the run estimates, of all sources; NaN if it is unknown."""
        found = re.findall(r"iterations it is ([0-9.e+-]+) %", self.run.said)
        return float(found[-1]) / 100 if found else math.nan

    @property
    def is_right(self) -> bool:
        return self.error <= self.target or self.is_missed

    def ratio(self, by_hand: float) -> float:
        return self.run.seconds / by_hand

    def is_cheap(self, by_hand: float) -> bool:
        """Returns whether a run within the target costs little enough; it always does if no run by hand is
        within the target."""
        if math.isnan(by_hand):
            return self.error <= self.target
        return self.error <= self.target and self.ratio(by_hand) <= ALLOWED_COST


def least_seconds(case: Case, changes: Changes, first: CurveRun) -> float:
    """Returns the least CPU seconds of a run that has been done once: times are noisy."""
    return min(first.seconds, *(run_case(case, changes).seconds for _ in range(N_TIMES - 1)))


def tries_of(case: Case) -> list[Try]:
    reference = Reference(case)
    by_hand = list(case.by_hand())
    runs = [run_case(case, changes) for _, changes in by_hand]
    errors = [reference.error(run) for run in runs]
    levels = [said.split(",")[0] for said, _ in by_hand]
    finest = dict(zip(levels, errors))  # of each level the last one
    timed: set[int] = set()
    tries = []
    for target in TARGETS:
        run = run_case(case, case.target(target))
        run.seconds = least_seconds(case, case.target(target), run)
        within = [i for i, error in enumerate(errors) if not math.isnan(error) and error <= target]
        within.sort(key=lambda i: runs[i].seconds)
        safe = [i for i in within if finest[levels[i]] <= target]
        for i in {*within[:1], *safe[:1]} - timed:
            runs[i].seconds = least_seconds(case, by_hand[i][1], runs[i])
            timed.add(i)
        tries.append(
            Try(
                target,
                reference.error(run),
                run,
                by_hand[within[0]][0] if within else "none",
                runs[within[0]].seconds if within else math.nan,
                runs[safe[0]].seconds if safe else math.nan,
            )
        )
    return tries


def row(case: Case, one: Try) -> list[object]:
    return [
        case.name,
        percent(one.target),
        "" if math.isnan(one.error) else percent(one.error),
        "" if math.isnan(one.estimated) else percent(one.estimated),
        "yes" if one.is_missed else "",
        number(one.run.seconds, 3),
        one.cheapest,
        *(
            "" if math.isnan(seconds) else number(one.ratio(seconds), 3)
            for seconds in (one.seconds_by_hand, one.safe_seconds)
        ),
    ]


cases = CASES[:1] if options.quick else CASES
tries = [(case, one) for case in cases for one in tries_of(case)]
n_met = sum(one.error <= one.target for _, one in tries)
n_told = sum(one.is_right for _, one in tries) - n_met
n_doubted = sum(one.error <= one.target and one.is_missed for _, one in tries)
n_below = sum(float(f"{one.error:.2g}") > one.estimated for _, one in tries)  # which has two digits
n_cheap = sum(one.is_cheap(one.seconds_by_hand) for _, one in tries)
n_safe = sum(one.is_cheap(one.safe_seconds) for _, one in tries)
n_lucky = sum(one.safe_seconds != one.seconds_by_hand for _, one in tries if one.cheapest != "none")
n_compared = sum(not math.isnan(one.seconds_by_hand) for _, one in tries)
publish(
    "target-mesh",
    "Runs with a target error of everything",
    options,
    (
        "This page shows how well runs reach the error that `Target error` asks for with"
        " `Target error of = everything`, the mesh included. It shows what they cost beside runs set by"
        " hand, too.\n\n"
        "- Error: ∫Σ|F − F*| dt over ∫Σ|F*| dt. F are the forces of all tools, pairs and supports; of the"
        " cylinder and in explicit scenes kinetic energy and what is stored or dissipated.\n"
        "- Reference: meshes twice as fine as the finest that is allowed, extrapolated by the order that the"
        " last three show. It has 160 steps and penetrations below 1e-4 of a facet; explicit ones a penalty"
        " factor of 30.\n"
        "- Estimated: the error that the run states for the mesh, steps, penetrations and iterations"
        " together.\n"
        "- Reported: the run says that it does not reach the target, and exits with code 7.\n"
        "- By hand: meshes half as fine, as given and twice as fine; 3, 10 and 40 equal steps; penalties, or"
        " augmented to 0.01 or 0.001. In explicit scenes penalty factors of 1, 3 and 10, and safety factors."
        " That is 27 settings at most, and the cheapest that is within the target is known afterwards.\n"
        "- Ratio: CPU seconds of the run, coarser levels included, over those of the cheapest by hand. Of"
        f" both the least of {N_TIMES} runs counts.\n"
        "- Safe ratio: the same beside the cheapest by hand whose mesh is also within the target with the"
        " finest steps and tolerances that were tried. Others owe it to errors that cancel."
    ),
    (
        f"- Wanted: {WANTED_RIGHT * len(tries):.0f} of {len(tries)} runs are within their target or say that"
        f" they may miss it. Reached: {n_met + n_told} of {len(tries)}.\n"
        f"- {n_met} of {len(tries)} runs are within their target, and {n_told} more say that they are not.\n"
        f"- Of the {n_met} runs within their target, {n_doubted} also report that they may miss it.\n"
        f"- Wanted: the error exceeds the estimate in at most {(1 - WANTED_RIGHT) * len(tries):.0f} of"
        f" {len(tries)} runs. Reached, in two digits: {n_below}.\n"
        f"- Wanted: {WANTED_CHEAP * len(tries):.0f} of {len(tries)} runs are within their target and take at"
        f" most {ALLOWED_COST:g} times the CPU seconds of the cheapest run by hand. Reached: {n_cheap} of"
        f" {len(tries)}.\n"
        f"- For {len(tries) - n_compared} no run by hand is within the target.\n"
        f"- For {n_lucky} the cheapest run by hand owes it to errors that cancel. No estimate can foresee"
        f" that. Beside the cheapest safe run by hand, {n_safe} of {len(tries)} are within the target and"
        f" take at most {ALLOWED_COST:g} times its CPU seconds."
    ),
    table(
        [
            "scene",
            "target",
            "error",
            "estimated",
            "reported",
            "CPU seconds",
            "cheapest by hand",
            "ratio",
            "safe ratio",
        ],
        [row(case, one) for case, one in tries],
    ),
)
