# SPDX-License-Identifier: LGPL-2.1-or-later
"""The estimated error of the mesh beside the true one, from finer meshes and closed forms."""

from __future__ import annotations

import math
import tempfile
from bisect import bisect_right
from pathlib import Path
from typing import Callable, NamedTuple, Sequence

from billet_runs import (
    ROOT,
    Changes,
    arguments,
    count_instructions,
    number,
    percent,
    program_hash,
    publish,
    read_scene,
    table,
    variant,
)
from billet_tools.kept import hash_of, read_json, write_json
from billet_tools.scene import entries
from curve_runs import KEPT, CurveRun
from level_errors import by_levels

options = arguments("mesh-error")

Curve = list[tuple[float, ...]]  # values at the same places for all runs of a case
Course = list[tuple[float, tuple[float, ...]]]  # places, ascending, with values


class Case(NamedTuple):
    """A scene, with the changes of its meshes, each twice as fine as the one before. The last ones only serve
    the reference. `course`: what is compared over which places; none: the forces of `compared` over time."""

    scene: str
    meshes: list[Changes]
    compared: str = ""
    axis: int | None = None  # of the travel, along which forces do work; None: all components do
    n_samples: int = 20  # in equal parts of the run, each the end of a step
    course: Callable[[CurveRun], Course] | None = None
    exact: float = 0.0  # norm of the force at the end, by a closed form
    on_facets: Callable[[int], Changes] | None = None  # the finest mesh with the facets of a mesh
    n_estimated: int = 2


def merged(*parts: Sequence[Changes]) -> list[Changes]:
    return [{key: value for part in level for key, value in part.items()} for level in zip(*parts)]


def arguments_of(body: str, texts: list[str]) -> list[Changes]:
    return [{f"Bodies/{body}/Mesh/Arguments": text} for text in texts]


def refined(body: str, levels: Sequence[int], layers: Sequence[int] = ()) -> list[Changes]:
    changes: list[Changes] = [{f"Bodies/{body}/Mesh/Refinements": level} for level in levels]
    return merged(changes, [{f"Bodies/{body}/Mesh/Layers": n} for n in layers]) if layers else changes


def circle(angle: str, facet: float = 0.0) -> tuple[str, str]:
    """Expressions of cosine and sine of an angle in degrees, or on the chords of facets of that angle."""
    if facet == 0.0:
        return f"cos(pi/180*{angle})", f"sin(pi/180*{angle})"
    chord = f"floor({angle}/{facet} + 1e-9)"
    part = f"({angle}/{facet} - {chord})"
    begin, end = f"pi/180*{facet}*{chord}", f"pi/180*{facet}*({chord} + 1)"
    return (
        f"((1 - {part})*cos({begin}) + {part}*cos({end}))",
        f"((1 - {part})*sin({begin}) + {part}*sin({end}))",
    )


def hertz(n: int) -> Changes:
    return {
        "Bodies/lower/Mesh/Arguments": f"{n}, 1, {n // 2} : 0, 0, -1 : 1, 0.1, 0 : true",
        "Bodies/upper/Mesh/Arguments": f"{n - n // 8}, 1, {n // 2} : 0, 0, 0 : 1, 0.1, 1 : true",
    }


def press_fit(n: int, facet: float = 0.0) -> Changes:
    cosine, sine = circle("y", facet)
    return {
        "Bodies/inner/Mesh/Arguments": f"{n}, {3 * n}, 1 : 10, 0, 0 : 20.01, 90, 1 : true",
        "Bodies/outer/Mesh/Arguments": f"{n}, {3 * n}, 1 : 20, 0, 0 : 30, 90, 1 : true",
        "Bodies/inner/Mesh/Positions": f"x*{cosine} ; x*{sine} ; z",
        "Bodies/outer/Mesh/Positions": f"x*{cosine} ; x*{sine} ; z",
    }


def press_fit_force() -> float:
    """Returns the force on a quarter, by Lamé's pressure in plane strain."""
    inner, fit, outer, interference, modulus = 10.0, 20.0, 30.0, 0.01, 2e5 / (1 - 0.3**2)
    pressure = modulus * interference / fit * (fit**2 - inner**2) * (outer**2 - fit**2)
    return math.sqrt(2.0) * fit * pressure / (2 * fit**2 * (outer**2 - inner**2))


def ring(n: int, facet: float = 0.0) -> Changes:
    """The foot, which the boundary id names, is of the same width on each."""
    cosine, sine = circle("z", facet)
    return {
        "Bodies/ring/Mesh/Arguments": f"{n}, 1, {24 * n} : 9.5, 0, -90 : 10, 0.5, 90 : true",
        "Bodies/ring/Mesh/Positions": f"x*{cosine} ; y ; x*{sine}",
        "Bodies/ring/Mesh/Boundary ids": "6 : z < -9.98",
    }


def cylinder(n: int, facet: float = 0.0) -> Changes:
    """The shipped one as a box of radii and angles, whose facets can be kept."""
    cosine, sine = circle("y", facet)
    return {
        "Bodies/cylinder/Mesh/Primitive": "subdivided_hyper_rectangle",
        "Bodies/cylinder/Loads/gas/Pressure": "180*t",
        "Bodies/cylinder/Mesh/Refinements": 0,
        "Bodies/cylinder/Mesh/Arguments": f"{n}, {2 * n} : 10, 0 : 20, 90 : true",
        "Bodies/cylinder/Mesh/Positions": f"x*{cosine} ; x*{sine} ; z",
    }


def load_over_travel(run: CurveRun) -> Course:
    """Returns the course of a load in proportion to time; its travel follows from the work of deformation at
    that load."""
    travel, before = 0.0, (0.0, 0.0)
    course: Course = [(0.0, (0.0,))]
    for time, (work,) in zip(run.times, run.energies["stored or dissipated"]):
        if time > before[0]:
            travel += (work - before[1]) / (0.5 * (time + before[0]))
        before = (time, work)
        course.append((travel, (time,)))
    return course


def bar_over_travel(run: CurveRun) -> Course:
    """Kinetic energy that Taylor's bar has lost over the travel at its root mean square velocity, until a
    tenth of that is left."""
    mass, velocity = 8.93e-9 * math.pi * 3.2**2 * 32.4 / 4, 227e3
    velocities = [math.sqrt(2 * kinetic / mass) for (kinetic,) in run.energies["kinetic"]]
    travel = 0.0
    course: Course = [(0.0, (0.0,))]
    for s, t, v, w in zip(run.times, run.times[1:], velocities, velocities[1:]):
        if w < 0.1 * velocity:
            break
        travel += 0.5 * (v + w) * (t - s)
        course.append((travel, (0.5 * mass * (velocity**2 - w**2),)))
    return course


CASES = [
    Case("prm/billet_upsetting", refined("billet", (0, 1, 2, 3), (3, 6, 12, 24)), "die", axis=2),
    Case("prm/hertz_cylinders", [hertz(n) for n in (10, 20, 40, 80)], "upper.support top", axis=2),
    Case(
        "prm/press_fit",
        [press_fit(n) for n in (2, 4, 8, 16)],
        "fit",
        n_samples=1,
        exact=press_fit_force(),
        on_facets=lambda level: press_fit(16, 15.0 / 2**level),
    ),
    Case(
        "prm/ring_crush",
        [ring(n) for n in (2, 4, 8)],
        "die",
        axis=2,
        n_samples=42,
        on_facets=lambda level: ring(8, 3.75 / 2**level),
    ),
    Case(
        "prm/pressurised_cylinder",
        [cylinder(n) for n in (2, 4, 8, 16)],
        n_samples=40,
        course=load_over_travel,
        on_facets=lambda level: cylinder(16, 22.5 / 2**level),
    ),
    Case(
        "prm/snap_fit",
        arguments_of("clip", [f"{41 * n}, {2 * n} : 0, 0 : 20.5, 1" for n in (1, 2, 4)]),
        "catch",
        axis=0,
        n_samples=100,
    ),
    Case(
        "tests/cli/cantilever",
        arguments_of("beam", [f"{n}, 1, {n // 2} : 0, 0, 0 : 20, 1, 10" for n in (8, 16, 32, 64)]),
        "beam.support end",
        axis=2,
        n_samples=2,
    ),
    Case(
        "prm/step_punch",
        arguments_of("block", [f"{n}, {n}, {n // 2 + 1} : 0, 0, 0 : 10, 10, 10" for n in (4, 8, 16)]),
        "punch",
        axis=2,
        n_samples=5,
    ),
    Case("prm/wagoner_punch_mu_0", refined("blank", (2, 3, 4)), "punch", axis=2, n_samples=80),
    Case(
        "prm/taylor_bar",
        refined("bar", (0, 1, 2), (12, 24, 48)),
        n_samples=400,
        course=bar_over_travel,
    ),
]
if not options.quick:
    CASES.append(
        Case(
            "prm/tube_crush",
            merged(
                arguments_of(
                    "tube", [f"{8 * n}, {n}, {25 * n} : 0, 0, 0 : 2, 1, 150 : true" for n in (1, 2)]
                ),
                [{"Time stepping/End time": 2e-3}] * 2,
            ),
            "plane",
            axis=2,
            n_samples=200,
            n_estimated=1,
        )
    )


class Runs:
    """Runs of a case on its meshes, their curves at the same places, and a reference."""

    def __init__(self, case: Case) -> None:
        self.case, self.scene = case, ROOT / f"{case.scene}.prm"
        self.set_in_scene = entries(read_scene(self.scene))
        end = next(
            (mesh["Time stepping/End time"] for mesh in case.meshes if "Time stepping/End time" in mesh), None
        )
        self.end = float(str(end or self.set_in_scene["Time stepping/End time"]))
        self.runs = [self.run(mesh) for mesh in case.meshes]
        self.on_facets = (
            [self.run(case.on_facets(k)) for k in range(case.n_estimated)] if case.on_facets else []
        )
        self.places = self.common_places()
        self.curves = [self.curve(run) for run in self.runs]

    def run(self, mesh: Changes) -> CurveRun:
        times = [self.end * (i + 1) / self.case.n_samples for i in range(self.case.n_samples)]
        if self.set_in_scene.get("Time stepping/Scheme") == "explicit":
            sampled: Changes = {"Output/History interval": repr(times[0])}
        else:
            stops = sorted({*(f"{time:.10g}" for time in times), *self.stops()}, key=float)
            sampled = {"Time stepping/Stops": ", ".join(stops), "Solver/Force tolerance": 1e-4}
        return CurveRun(self.scene, {**mesh, **sampled}, options.ranks)

    def stops(self) -> list[str]:
        text = self.set_in_scene.get("Time stepping/Stops", "")
        return [f"{float(stop):.10g}" for stop in text.split(",") if stop.strip()]

    def course(self, run: CurveRun, with_sideways: bool = False) -> Course:
        if self.case.course:
            return self.case.course(run)
        forces = run.reactions[self.case.compared]
        if self.case.axis is None or with_sideways:
            return list(zip(run.times, forces))
        return [(time, (force[self.case.axis],)) for time, force in zip(run.times, forces)]

    def common_places(self) -> list[float]:
        n = self.case.n_samples
        end = (
            min(self.course(run)[-1][0] for run in self.runs + self.on_facets)
            if self.case.course
            else self.end
        )
        return [end * (i + 1) / n for i in range(n)]

    def curve(self, run: CurveRun, with_sideways: bool = False) -> Curve:
        course = self.course(run, with_sideways)
        places = [place for place, _ in course]
        values = []
        for place in self.places:
            i = min(max(1, bisect_right(places, place * (1 - 1e-9))), len(places) - 1)
            (s, a), (t, b) = course[i - 1], course[i]
            part = min(1.0, (place - s) / (t - s)) if t > s else 1.0
            values.append(tuple(x + part * (y - x) for x, y in zip(a, b)))
        return values


def norm(vector: Sequence[float]) -> float:
    return math.sqrt(sum(x * x for x in vector))


def difference(curve: Curve, reference: Curve) -> float:
    """∫|F − F*| over ∫|F*| at equidistant places."""
    off = sum(norm([x - y for x, y in zip(a, b)]) for a, b in zip(curve, reference))
    return off / sum(norm(b) for b in reference)


def order_of(before: float, last: float) -> float:
    """Observed order of convergence, at most 2; NaN where differences do not fall."""
    return min(2.0, math.log2(before / last)) if before > last > 0 else math.nan


def extrapolated_curve(coarse: Curve, fine: Curve, order: float) -> Curve:
    factor = 1 / (2**order - 1)
    return [tuple(y + factor * (y - x) for x, y in zip(a, b)) for a, b in zip(coarse, fine)]


class Line(NamedTuple):
    """Errors of a mesh beside its estimates, as parts; NaN: there is none."""

    scene: str
    elements: int
    error: float  # in all
    with_sideways: float  # the same of whole force vectors, beside the finest mesh
    of_facets: float
    geometry: float  # as the run estimates it
    of_elements: float
    estimate: float
    levels: float  # error by levels
    seconds: float
    seconds_of_levels: float  # with those of coarser meshes
    reference: str
    is_known: bool  # whether the run does not call its error unknown

    @property
    def ratio(self) -> float:
        return self.estimate / self.of_elements

    @property
    def ratio_of_levels(self) -> float:
        return self.levels / self.error

    def cells(self) -> list[object]:
        def filled(value: float, text: str) -> str:
            return "" if math.isnan(value) else text

        return [
            self.scene,
            self.elements,
            percent(self.error),
            filled(self.with_sideways, percent(self.with_sideways)),
            filled(self.of_facets, percent(self.of_facets)),
            percent(self.geometry) if self.geometry > 1e-6 else "",
            percent(self.of_elements),
            percent(self.estimate),
            number(self.ratio, 2) + ("" if self.is_known else " (unknown)"),
            filled(self.levels, percent(self.levels)),
            filled(self.levels, number(self.ratio_of_levels, 2)),
            number(self.seconds, 3),
            number(self.seconds_of_levels, 3),
            self.reference,
        ]


def reference_of(runs: Runs) -> tuple[Curve, str]:
    """The curve that others are compared with, and what it is."""
    curves = runs.curves
    if runs.case.exact > 0:
        size = runs.case.exact / norm(curves[-1][-1])
        return [tuple(size * x for x in curves[-1][-1])], "closed form"
    said = f"{runs.runs[-1].elements} elements"
    if len(curves) < 3:
        return curves[-1], said
    order = order_of(difference(curves[-3], curves[-2]), difference(curves[-2], curves[-1]))
    if math.isnan(order):
        return curves[-1], f"{said}, no order"
    return extrapolated_curve(curves[-2], curves[-1], order), f"{said}, extrapolated by order {order:.1f}"


def lines_of(case: Case) -> list[Line]:
    runs = Runs(case)
    reference, of_reference = reference_of(runs)
    finest = runs.curves[-1]
    differences = [difference(a, b) for a, b in zip(runs.curves, runs.curves[1:])]
    lines = []
    for k in range(case.n_estimated):
        run, curve = runs.runs[k], runs.curves[k]
        error = of_elements = difference(curve, reference)
        of_facets = sideways = math.nan
        if case.axis is not None:
            whole = [runs.curve(of, with_sideways=True) for of in (run, runs.runs[-1])]
            if (
                difference(
                    [*whole][1],
                    [tuple(f if i == case.axis else 0.0 for i, f in enumerate(v)) for v in whole[1]],
                )
                > 0.01
            ):
                sideways = difference(whole[0], whole[1])
        if runs.on_facets:
            faceted = runs.curve(runs.on_facets[k])
            of_facets, of_elements = difference(faceted, finest), difference(curve, faceted)
        lines.append(
            Line(
                case.scene.split("/")[-1],
                run.elements,
                error,
                sideways,
                of_facets,
                run.geometry_error,
                of_elements,
                run.mesh_error,
                by_levels(differences[:k], [one.mesh_error for one in runs.runs[: k + 1]]),
                run.seconds,
                sum(coarser.seconds for coarser in runs.runs[: k + 1]),
                of_reference,
                "error is unknown" not in " ".join(run.said.split()),
            )
        )
    return lines


def part_within(ratios: list[float]) -> str:
    return percent(sum(0.5 <= ratio <= 3.0 for ratio in ratios) / len(ratios))


def count(ratios: list[float]) -> str:
    n_within = sum(0.5 <= ratio <= 3.0 for ratio in ratios)
    n_smaller, n_larger = sum(ratio < 0.5 for ratio in ratios), sum(ratio > 3.0 for ratio in ratios)
    return (
        f"{n_within} of {len(ratios)} are from 0.5 to 3, {n_smaller} smaller, {n_larger} larger;"
        f" {sum(ratio < 1.0 for ratio in ratios)} estimates are below the error"
    )


def price(scene: str, elements: int, changes: Changes) -> list[object]:
    """Instructions of a run and of its estimates, and their part; kept as runs are."""
    text = variant(
        read_scene(ROOT / f"prm/{scene}.prm"),
        {"Output/Format": "none", "Output/Folder": "results", **changes},
    )
    file = KEPT / f"{hash_of(program_hash(), 'price', text)[:24]}.json"
    kept = read_json(file)
    if kept is None:
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "scene.prm").write_text(text)
            kept = {
                "run": count_instructions(folder),
                "estimate": count_instructions(folder, "billet::MeshErrors::add(*"),
            }
        write_json(file, kept)
    return [scene, elements, kept["run"], kept["estimate"], percent(kept["estimate"] / kept["run"])]


lines = [line for case in CASES for line in lines_of(case)]
costs = [
    price("billet_upsetting", 72, refined("billet", (1,), (6,))[0]),
    price("hertz_cylinders", 95, hertz(10)),
    price("taylor_bar", 36, {**refined("bar", (0,), (12,))[0], "Time stepping/End time": 2e-5}),
]
with_levels = [line for line in lines if not math.isnan(line.levels)]
ratios = [line.ratio for line in lines]
known = [line.ratio for line in lines if line.is_known]
of_levels = [line.ratio_of_levels for line in with_levels]
more = [line.seconds_of_levels / line.seconds for line in with_levels]
publish(
    "mesh-error",
    "The error of the mesh, estimated and found",
    options,
    (
        "This page compares the error that the program estimates for a mesh with the true one. Scenes run on"
        " coarser and finer meshes than the shipped ones; the scenes set the rest.\n\n"
        "- Error: ∫|F − F*| dt over ∫|F*| dt of the force of a tool, pair or support along its travel,"
        " the part that does work. All runs of a scene end steps at the same times, and"
        " forces are compared there.\n"
        "- Reference F*: Lamé's closed form for the press fit; else the finest mesh. Where the last three"
        " meshes show an order, it is extrapolated by that.\n"
        "- With sideways: the same of all components, where others matter, beside the finest mesh. No"
        " estimate covers them.\n"
        "- Facets: what flat facets in place of curves change, by the finest mesh on the same facets. The"
        " error of the elements is then that beside this mesh. `geometry_error` is the estimate.\n"
        "- Estimated: the last value of `mesh_error`; its ratio to the error of the elements.\n"
        "- By levels: the error by the rules of `Target error of = everything`, from this mesh and the"
        " coarser one. The difference of both counts with the order by which the estimates fall, from 1 to"
        " 2. Its ratio is to the whole error. CPU seconds with coarser levels are those of both runs.\n\n"
        "A pressure of up to 180 MPa drives the cylinder; it is compared over its travel. The deceleration"
        " of Taylor's bar is compared by the kinetic energy that is lost over the travel. The foot of the"
        " ring is of one width on all meshes. The bracket and the rolling of a slab have no rows, since"
        " meshes two levels finer take too long. The tube, which folds, has a single mesh beside the"
        " reference."
    ),
    f"Wanted are ratios from 0.5 to 3 in nine of ten. Reached are {part_within(ratios)} of all estimates,"
    f" {part_within(known)} of those that the program knows, and {part_within(of_levels)} by levels.\n\n"
    f"Of all ratios of estimates, {count(ratios)}.\n\nThe program calls"
    f" {sum(not line.is_known for line in lines)} of these errors unknown: the mesh does not resolve the"
    " contact, or a wall of one element bends. Of the ratios of the others,"
    f" {count(known)}.\n\n"
    f"Of the ratios by levels, {count(of_levels)}. They take"
    f" {number(min(more), 2)} to {number(max(more), 2)} times the seconds of the run on the mesh alone.",
    table(
        [
            "scene",
            "elements",
            "error",
            "with sideways",
            "facets",
            "`geometry_error`",
            "elements' error",
            "estimated",
            "ratio",
            "by levels",
            "their ratio",
            "CPU seconds",
            "with coarser levels",
            "reference",
        ],
        [line.cells() for line in lines],
    ),
    "## Price of the estimate\n\nInstructions of a run and of its estimate, by callgrind. The bar is"
    " explicit, until 20 µs.",
    table(["scene", "elements", "run", "estimate", "part"], costs),
)
