# SPDX-License-Identifier: LGPL-2.1-or-later
"""The order of things: a sweep is planned, run, judged and written."""

from __future__ import annotations

import os
import shlex
import sys
import time
from pathlib import Path
from typing import Callable, Mapping, Sequence

from .. import UserError
from ..scene import Scene
from ..text import table
from . import picture, report
from .options import Options, read_outputs, read_settings
from .outputs import Force, Output, Profile, Rebound, Shape, contact_forces
from .plan import Candidates
from .reference import GIVEN, Plan, Reference
from .report import Forces, Point, Sweep
from .results import Result
from .run import Progress, Runner, Work, clock


def refuse_outputs(weights: Mapping[str, float], scene: Scene) -> None:
    """What the scene cannot have, before anything runs."""
    if "rebound" in weights and not scene.is_dynamic:
        raise UserError("--outputs: nothing rebounds in a static scene")
    if "force" in weights and not scene.names("Tools") and not scene.pairs:
        raise UserError("--outputs: the scene has no tool and no pair of bodies, hence no force")


def make_force(options: Options, scene: Scene, centre: Result, finest: Result | None = None) -> Force | None:
    """The force, whether it counts or only judges; None where there is none. `finest`: the run with the
    shortest steps."""
    if not contact_forces(centre):
        return None
    columns = [c.strip() for c in options.force.split(",")] if options.force else None
    return Force(centre, scene, columns, options.window, finest)


def make_outputs(
    options: Options, scene: Scene, centre: Result, force: Force | None
) -> tuple[list[Output], dict[str, float]]:
    """The outputs that count, and their weights."""
    weights = read_outputs(options.outputs)
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
                raise UserError("--outputs: the scene has no tool and no pair of bodies, hence no force")
            found.append(force)
        elif name == "strain":
            found.append(Profile(options.line, options.profile))
        elif name == "shape":
            found.append(Shape(centre))
        else:
            found.append(Rebound(scene))
    return found, weights


def judging_forces(
    plan: Plan, reference_results: Sequence[Result], force: Force | None, reference: Reference
) -> Forces:
    """What tells locked and soft: (the force, the reference that knows it), whether it is among the outputs
    or not; None where there is none to speak of."""
    if not force or "force" in reference.values:
        return (force, reference) if force else None
    try:
        return force, Reference(plan, reference_results, [force])
    except UserError:  # it is zero, which only matters to who asks for it
        return None


def combine(sweep: Sweep, target: float, candidates: Candidates, run: Callable[[Point], None]) -> list[Point]:
    """Joins to the chosen point what makes it cheaper within the target, parameter by parameter, most
    promising first; returns the points that were tried."""
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
        run(trial)
        tried.append(trial)
        within = trial.is_good and (
            trial.error + sweep.uncertainty <= target or sweep.chosen is None and trial.error < best.error
        )
        if within and sweep.cost_of(trial) < sweep.cost_of(best):
            best = trial
    return tried


def sweep_over(
    options: Options, runner: Runner, scene: Scene, elements: int, file: Path, arguments: Sequence[str]
) -> int:
    settings = read_settings("--reference", options.reference)
    plan = Plan(scene, runner.elements, options.reference_mesh, options.reference_steps, settings)
    if runner.check(plan.centre)[1]:
        raise UserError(f"--reference: billet refuses the reference's centre: {runner.check(plan.centre)[1]}")
    refuse_outputs(read_outputs(options.outputs), scene)
    base = report.Point("", "as written", {}, scene, is_base=True)
    started = time.monotonic()
    base.result = runner.run(scene)
    if base.result.status == "ok":
        # before all else runs: it may have no such column, or nothing that yields
        make_outputs(options, scene, base.result, make_force(options, scene, base.result))
    scene.first_step = base.result.first_step
    candidates = Candidates(scene, runner, options)
    points = [base] + candidates.points()

    progress = Progress(
        elements, max(1, base.result.steps), base.result.clock, scene.is_explicit, options.jobs
    )
    work = Work(runner, progress, scene)
    tasks = [("as written", scene, options.repeat)]
    tasks += [(f"reference, {label}", level, 1) for label, level in plan.runs()]
    tasks += [(p.label, p.scene, options.repeat) for p in points[1:]]
    if options.jobs > 1:
        print(f"{options.jobs} runs at a time: core-seconds are blurred by each other", file=sys.stderr)
    found = work.run(tasks, options.jobs)

    reference_results = [work.result(found, level) for _, level in plan.runs()]
    centre = reference_results[0]
    if centre.status == "ok":
        ended = [work.result(found, level) for _, level in plan.axes[0].levels]
        force = make_force(options, scene, centre, [result for result in ended if result.status == "ok"][-1])
        outputs, weights = make_outputs(options, scene, centre, force)
    else:
        force, outputs, weights = None, [], {}
    reference = Reference(plan, reference_results, outputs)
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
        report.judge(point, outputs, weights, reference, scene, limits, forces)

    for point in points:
        point.result = work.result(found, point.scene)
        judge(point)
    sweep = report.Sweep(
        points, reference, outputs, weights, scene, options.cost, options.target, limits.error
    )

    if options.combine:

        def run(point: Point) -> None:
            point.result = work.result(work.run([(point.label, point.scene, options.repeat)], 1), point.scene)
            judge(point)

        tried = combine(sweep, options.target, candidates, run)
        sweep = report.Sweep(
            points + tried, reference, outputs, weights, scene, options.cost, options.target, limits.error
        )

    write(sweep, plan, reference_results, options, runner, scene, file, arguments)
    print(f"({clock(time.monotonic() - started)})", file=sys.stderr)
    return 3 if options.target is not None and sweep.chosen is None or not sweep.front else 0


def write(
    sweep: Sweep,
    plan: Plan,
    reference_results: Sequence[Result],
    options: Options,
    runner: Runner,
    scene: Scene,
    file: Path,
    arguments: Sequence[str],
) -> None:
    title = options.title or scene.get("Title") or file.stem
    name = Path(options.output or runner.folder / "trade")
    drawn = Path(options.picture) if options.picture else name.with_name(name.name + ".png")
    remarks = [
        f"{runner.program.version}, {'one rank' if options.ranks == 1 else f'{options.ranks} ranks'}"
        + (f", {options.jobs} runs at a time" if options.jobs > 1 else "")
        + "."
    ]
    if options.reference_mesh == GIVEN:
        remarks.append("The mesh is taken as given: errors are those of all else.")
    if options.until or options.mesh or options.set:
        told = [f"until {options.until:g} of the end time"] if options.until else []
        told += [f"{options.mesh} times the elements along each edge"] if options.mesh else []
        remarks.append("Pilot form: " + ", ".join(told + options.set) + ".")
    try:
        name.parent.mkdir(parents=True, exist_ok=True)
        drawn.parent.mkdir(parents=True, exist_ok=True)
        sweep.write_csv(
            name.with_name(name.name + ".csv"), zip([label for label, _ in plan.runs()], reference_results)
        )
        picture.draw(sweep, drawn, title)
        relative = os.path.relpath(drawn, name.parent)
        page = sweep.page(title, "billet-trade " + shlex.join(arguments), [" ".join(remarks)], relative)
        name.with_name(name.name + ".md").write_text(page)
    except (OSError, ValueError) as error:
        raise UserError(f"what came out cannot be written: {error}") from None
    print(table(sweep.head(), sweep.rows()) + "\n")
    print("\n".join(sweep.words()))
    print(f"\n{name}.csv, {name}.md, {drawn}")
