# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs a sweep: plans it, runs it, judges its points and writes them."""

from __future__ import annotations

import os
import shlex
import sys
import time
from pathlib import Path
from typing import Callable, Mapping, Sequence

from .. import UserError
from ..program import Stopped
from ..scene import Scene
from ..text import items, number, percent, table, wrapped, written_by
from . import parameters, picture, report
from .options import GIVEN, Options, read_outputs, read_settings
from .outputs import (
    Energy,
    Force,
    Output,
    Profile,
    Rebound,
    Shape,
    contact_forces,
    has_supports,
    moves_support,
)
from .paste import HOW
from .plan import Candidates
from .reference import Plan, Reference
from .report import Forces, Point, Sweep
from .results import Result
from .run import Progress, Runner, Work, clock


NO_FORCE = "--outputs: the scene has no tool, no pair of bodies and no support, hence no force"


def refuse_outputs(weights: Mapping[str, float], scene: Scene) -> None:
    """Refuses outputs that the scene cannot have, before anything runs."""
    if "rebound" in weights and not scene.is_dynamic:
        raise UserError("--outputs: nothing rebounds in a static scene")
    if "force" in weights and not (scene.names("Tools") or scene.pairs or has_supports(scene)):
        raise UserError(NO_FORCE)


def make_force(options: Options, scene: Scene, centre: Result, finest: Result | None = None) -> Force | None:
    """Returns the force, whether it counts or only judges; None without one. Forces of supports alone count
    if the user names them, or in statics if a support moves. `finest`: the run with the shortest steps."""
    columns = [c.strip() for c in options.force.split(",")] if options.force else None
    is_wanted = columns or "force" in read_outputs(options.outputs)
    has_force = (
        contact_forces(centre, scene) or has_supports(scene) and not scene.is_dynamic and moves_support(scene)
    )
    columns = columns or (Force.all_forces(centre, scene) if is_wanted or has_force else [])
    if not columns:
        return None
    return Force(centre, scene, columns, options.window, finest)


def make_outputs(
    options: Options, scene: Scene, centre: Result, force: Force | None, as_estimated: bool = False
) -> tuple[list[Output], dict[str, float]]:
    """Returns the outputs that count, and their weights. By default they are the force and the shape. With
    `as_estimated` they are those of the runs' own estimates: the force, in dynamics the energy. Columns that
    the user names are forces that count."""
    weights = read_outputs(options.outputs)
    if not weights and as_estimated and not options.line and (scene.is_dynamic or force):
        weights = {"energy" if scene.is_dynamic and not options.force else "force": 1.0}
    if not weights:
        weights = {
            **({"force": 1.0} if force else {}),
            "shape": 1.0,
            **({"strain": 1.0} if options.line else {}),
        }
    found: list[Output] = []
    for name in weights:
        if name == "force":
            if not force:
                raise UserError(NO_FORCE)
            found.append(force)
        elif name == "strain":
            found.append(Profile(options.line, options.profile))
        elif name == "energy":
            found.append(Energy(scene))
        elif name == "shape":
            found.append(Shape(centre))
        else:
            found.append(Rebound(scene))
    return found, weights


def judging_forces(
    plan: Plan, reference_results: Sequence[Result | None], force: Force | None, reference: Reference
) -> Forces:
    """Returns the force by which runs are judged as locked or soft, and the reference that knows it; None
    without one. It need not be among the outputs."""
    if not force or "force" in reference.values:
        return (force, reference) if force else None
    try:
        return force, Reference(plan, reference_results, [force])
    except UserError:  # it is zero, which only matters to who asks for it
        return None


def combine(sweep: Sweep, target: float, candidates: Candidates, run: Callable[[Point], bool]) -> list[Point]:
    """Joins to the chosen point what makes it cheaper within the target, parameter by parameter, most
    promising first; returns the points that were tried. `run` says whether the budget reached it."""
    chosen = sweep.chosen or (sweep.base if sweep.base.is_good else None)
    tried: list[Point] = []
    if chosen is None or sweep.is_blind:
        return tried
    cheaper = {}
    for parameter, points in sweep.curves().items():
        good = [
            p
            for p in points
            if p.is_good
            and sweep.is_cheaper(p)
            and sweep.ranked(p) <= max(target, 1.5 * max(sweep.ranked(sweep.base), sweep.uncertainty))
            and parameter != chosen.curve
        ]
        if good:
            cheaper[parameter] = min(good, key=sweep.cost_of)
    best = chosen
    for parameter, point in sorted(cheaper.items(), key=lambda item: sweep.cost_of(item[1])):
        if set(point.changes) & set(best.changes):
            continue
        changes = {**best.changes, **point.changes}
        scene = candidates.scene.changed(changes)
        if candidates.runner.check(scene)[1]:
            continue
        value = (
            point.label
            if best.is_base
            else f"{best.value if best.curve == 'combined' else best.label}, {point.label}"
        )
        trial = report.Point("combined", value, changes, scene)
        if not run(trial):
            continue
        tried.append(trial)
        within = trial.is_good and (
            trial.error + sweep.uncertainty <= target or sweep.chosen is None and trial.error < best.error
        )
        if within and sweep.cost_of(trial) < sweep.cost_of(best):
            best = trial
    return tried


# Parameters that change errors most as a rule; a budget reaches them first, and the others in their order.
PROMISING = (
    "target error of everything",
    "mesh",
    "target error",
    "steps",
    "maximum step",
    "safety factor",
    "element",
    "penalty",
    "augmentation",
    "profile",
    "tolerance",
)


def most_promising_first(points: Sequence[Point]) -> list[Point]:
    """Returns the points by parameter, the first values of each parameter before the others' further ones."""
    rank = {name: place for place, name in enumerate(PROMISING)}
    places: dict[str, int] = {}
    keys = {}
    for place, point in enumerate(points):
        nth = places[point.curve] = places.get(point.curve, -1) + 1
        known = rank.get(point.curve)
        # Parameters that a user named, as by --product, come with the promising ones.
        keys[id(point)] = (known is None and point.curve in parameters.PARAMETERS, nth, known or 0, place)
    return sorted(points, key=lambda point: keys[id(point)])


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def affordable_plan(plan: Plan, coarser: Plan | None, work: Work) -> Plan:
    """Returns the plan of the reference, or the one on coarser meshes if it exceeds half of the seconds of a
    budget."""
    allowed = 0.5 * work.budget.seconds_left()
    seconds = sum(work.expected(scene, 1) for _, scene in plan.runs())
    if seconds <= allowed or coarser is None:
        return plan
    less = sum(work.expected(scene, 1) for _, scene in coarser.runs())
    if less >= seconds:
        return plan
    say(
        f"The reference would take about {clock(seconds)} of {clock(work.budget.seconds_left())}. It is made"
        f" on meshes of 0.5, 1 and 2 times the elements along each edge, in about {clock(less)}"
    )
    return coarser


def sweep_over(
    options: Options, runner: Runner, scene: Scene, elements: int, file: Path, arguments: Sequence[str]
) -> int:
    budget = options.budget
    settings = read_settings("--reference", options.reference)

    def plan_on(mesh: str | None) -> Plan:
        return Plan(scene, runner.elements, mesh, options.reference_steps, settings)

    plan = plan_on(options.reference_mesh)
    if runner.check(plan.centre)[1]:
        raise UserError(f"--reference: billet refuses the reference's centre: {runner.check(plan.centre)[1]}")
    refuse_outputs(read_outputs(options.outputs), scene)
    base = report.Point("", "as written", {}, scene, is_base=True)
    started = time.monotonic()
    count = len({p.scene.text for p in Candidates(scene, runner, options).points()} - {scene.text})
    say(
        f"Budget: {1 + len(plan.runs()) + count} runs, the scene as it is, {len(plan.runs())} of the"
        f" reference and {count} points"
        + (f"; points that others do not dominate {options.repeat} times" if options.repeat > 1 else "")
        + (f"; limited to {budget.text}" if budget.is_limited else "")
    )
    if not runner.finished(scene, 1):
        budget.take(0.0)  # without it nothing can be said
    base.result = runner.run(scene, 1, max(1.0, min(runner.limit, budget.seconds_left())))
    if base.result.status == "ok":
        # before all else runs: it may have no such column, or nothing that yields
        make_outputs(options, scene, base.result, make_force(options, scene, base.result))
    scene.first_step = base.result.first_step
    candidates = Candidates(scene, runner, options)
    points = [base] + candidates.points()

    progress = Progress(
        elements, max(1, base.result.steps), base.result.clock, scene.is_explicit, options.jobs
    )
    work = Work(runner, progress, scene, budget)
    if budget.is_limited and not options.reference_mesh:
        plan = affordable_plan(plan, coarser_plan(plan_on, scene), work)
    tasks = [("as written", scene, 1)]
    tasks += [(f"reference, {label}", level, 1) for label, level in plan.runs()]
    of_reference = len(tasks)
    ordered = most_promising_first(points[1:]) if budget.is_limited else points[1:]
    tasks += [(p.label, p.scene, 1) for p in ordered]
    different = {level.text: level for _, level, _ in tasks}
    say(
        f"By the first run, {base.result.core_seconds:.2g} core-s, {len(different)} runs take about"
        f" {clock(sum(work.expected(level, 1) for level in different.values()) / options.jobs)}"
    )
    if options.jobs > 1:
        say(f"{options.jobs} runs at a time: core-seconds are blurred by each other")
    found = work.run(tasks[:of_reference], options.jobs)

    def result_of(level: Scene) -> Result | None:
        return work.result(found, level) if work.has(found, level) else None

    reference_results = [result_of(level) for _, level in plan.runs()]
    centre = reference_results[0]
    if centre is not None and centre.status == "ok":
        ended = [r for r in (result_of(level) for _, level in plan.axes[0].levels) if r and r.status == "ok"]
        force = make_force(options, scene, centre, ended[-1])
        outputs, weights = make_outputs(options, scene, centre, force)
    else:
        force, outputs, weights = None, [], {}
    try:
        reference = Reference(plan, reference_results, outputs)
    except UserError as error:
        if not (work.was_stopped or work.left_out):
            raise
        return write_costs(points, result_of, str(error), options, runner, scene, file, arguments, work)
    uncertainty = report.uncertainty_of(reference, outputs, weights)
    is_hopeless = budget.is_limited and options.target is not None and uncertainty >= options.target
    if is_hopeless:
        say(f"The reference is known to {percent(uncertainty)} only: the budget is not spent on points")
    elif not work.was_stopped:
        found.update(work.run(tasks[of_reference:], options.jobs))
    forces = judging_forces(plan, reference_results, force, reference)
    limits = report.Limits(
        options.largest_drift,
        options.largest_penetration,
        options.locked,
        options.soft,
        options.largest_error,
    )

    def judge(point: Point) -> None:
        point.work = report.work_of(point.result, runner.elements(point.scene), scene.is_explicit)
        if point.scene.get("Target error of") == "everything" and point.result.elements:
            point.work = report.work_of(point.result, point.result.elements, scene.is_explicit)
        report.judge(point, outputs, weights, reference, scene, limits, forces)

    def swept(some: Sequence[Point]) -> Sweep:
        return report.Sweep(
            some, reference, outputs, weights, scene, options.cost, options.target, limits.error
        )

    run_points = [p for p in points if p.is_base or result_of(p.scene) is not None]
    for point in run_points:
        point.result = result_of(point.scene) or point.result
        judge(point)
    sweep = swept(run_points)

    def run_again(some: Sequence[Point]) -> None:
        """Repeats points that are not dominated until they have enough timings."""
        if options.repeat > 1 and not work.was_stopped:
            again = work.run([(p.label, p.scene, options.repeat) for p in some], options.jobs)
            for point in some:
                if work.has(again, point.scene):
                    point.result = work.result(again, point.scene)

    run_again(sweep.worth_timing())
    sweep = swept(run_points)

    if options.combine and not work.was_stopped:

        def run(point: Point) -> bool:
            made = work.run([(point.label, point.scene, options.repeat)], 1)
            if not work.has(made, point.scene):
                return False
            point.result = work.result(made, point.scene)
            judge(point)
            return True

        tried = combine(sweep, options.target, candidates, run)
        sweep = swept([*run_points, *tried])

    write(
        sweep,
        plan,
        reference_results,
        options,
        runner,
        scene,
        file,
        arguments,
        what_is_missing(points, run_points, work, is_hopeless),
    )
    say(f"({clock(time.monotonic() - started)})")
    if work.was_stopped:
        raise Stopped
    return 3 if options.target is not None and sweep.chosen is None or not sweep.front else 0


def coarser_plan(plan_on: Callable[[str | None], Plan], scene: Scene) -> Plan | None:
    """Returns the plan of a reference on the coarsest meshes that give an order, if the scene has them."""
    try:
        return plan_on("0.5,1,2")
    except UserError:
        return None


def what_is_missing(
    points: Sequence[Point], run_points: Sequence[Point], work: Work, is_hopeless: bool
) -> list[str]:
    """Sentences on the points that did not run."""
    missing = [p.label for p in points if all(p is not q for q in run_points)]
    if not missing:
        return []
    unknown = "the reference is not known well enough for the target"
    why = "the study was stopped" if work.was_stopped else unknown if is_hopeless else "beyond the budget"
    return [f"Not run, {why}: " + ", ".join(f"`{label}`" for label in missing) + "."]


def write_costs(
    points: Sequence[Point],
    result_of: Callable[[Scene], Result | None],
    against: str,
    options: Options,
    runner: Runner,
    scene: Scene,
    file: Path,
    arguments: Sequence[str],
    work: Work,
) -> int:
    """Writes the page of a study that ended before its reference was complete: costs without errors."""
    ended = [(p, p.result if p.is_base else result_of(p.scene)) for p in points]
    rows = [
        [p.label, r.status, r.elements or "–", r.steps, number(r.core_seconds)]
        for p, r in ended
        if r is not None
    ]
    title = options.title or scene.get("Title") or file.stem
    name = Path(options.output or runner.folder / "trade")
    said = f"No error is known yet: {against}."
    left = [f"Beyond the budget: {', '.join(work.left_out)}."] if work.left_out else []
    told = table(["point", "status", "elements", "steps", "core-seconds"], rows)
    parts = [f"# What accuracy costs: {title}", written_by(command_text(arguments)), said, *left, told]
    try:
        name.parent.mkdir(parents=True, exist_ok=True)
        page = "\n\n".join([*parts, *remarks_of(options, runner)])
        name.with_name(name.name + ".md").write_text(wrapped(page) + "\n")
    except OSError as error:
        raise UserError(f"what came out cannot be written: {error}") from None
    print("\n\n".join([told, said, *left, f"{name}.md"]))
    if work.was_stopped:
        raise Stopped
    return 3


def remarks_of(options: Options, runner: Runner) -> list[str]:
    """Returns remarks on all runs of a page."""
    remarks = [
        f"{runner.program.version}, {'one rank' if options.ranks == 1 else f'{options.ranks} ranks'}"
        + (f", {options.jobs} runs at a time" if options.jobs > 1 else "")
        + "."
    ]
    if options.reference_mesh == GIVEN:
        remarks.append("The mesh is taken as given: errors are those of everything else.")
    if options.until or options.mesh or options.set:
        told = [f"until {options.until:g} of the end time"] if options.until else []
        told += [f"{options.mesh} times the elements along each edge"] if options.mesh else []
        values = "\n\n" + items(f"`{entry}`" for entry in options.set)
        told += [f"with these values:{values}"] if options.set else []
        remarks.append(f"Pilot form: {', '.join(told)}" + "." * (not options.set))
    return remarks


def command_text(arguments: Sequence[str]) -> str:
    """Returns the command, each option on a line of its own."""
    return "billet-trade " + shlex.join(arguments).replace(" --", " \\\n  --")


def write_files(
    options: Options,
    default: Path,
    write_csv: Callable[[Path], None],
    draw: Callable[[Path], None],
    page: Callable[[str], str],
) -> tuple[Path, Path]:
    """Writes CSV file, picture and page to --output or the default name. `page` takes the picture's place
    beside it. Returns name and picture."""
    name = Path(options.output or default)
    drawn = Path(options.picture) if options.picture else name.with_name(name.name + ".png")
    try:
        name.parent.mkdir(parents=True, exist_ok=True)
        drawn.parent.mkdir(parents=True, exist_ok=True)
        write_csv(name.with_name(name.name + ".csv"))
        draw(drawn)
        name.with_name(name.name + ".md").write_text(wrapped(page(os.path.relpath(drawn, name.parent))))
    except (OSError, ValueError) as error:
        raise UserError(f"what came out cannot be written: {error}") from None
    return name, drawn


def write(
    sweep: Sweep,
    plan: Plan,
    reference_results: Sequence[Result | None],
    options: Options,
    runner: Runner,
    scene: Scene,
    file: Path,
    arguments: Sequence[str],
    remarks: Sequence[str],
) -> None:
    title = options.title or scene.get("Title") or file.stem
    ended = [(label, r) for (label, _), r in zip(plan.runs(), reference_results) if r is not None]
    said = [" ".join([*remarks_of(options, runner), *remarks])]
    name, drawn = write_files(
        options,
        runner.folder / "trade",
        lambda file: sweep.write_csv(file, ended),
        lambda file: picture.draw(sweep, file, title),
        lambda drawn: sweep.page(title, command_text(arguments), said, drawn),
    )
    print(table(sweep.head(), sweep.rows()) + "\n")
    print("\n".join([*sweep.words(), *remarks]))
    if sweep.lines():
        print(f"\n{HOW}:\n\n{sweep.lines()}", end="")
    print(f"\n{name}.csv, {name}.md, {drawn}")
