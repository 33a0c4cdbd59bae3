# SPDX-License-Identifier: LGPL-2.1-or-later
"""The order of things in --explain: the sources of error are found, run and judged, and the page is written;
with a target, what may be the cheapest way to it runs as well."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Sequence, Tuple

from .. import UserError
from ..program import Stopped
from ..scene import Scene
from ..text import percent, table
from . import bars
from .budget import Budget
from .cheapest import Cheapest, by_program, predict
from .explanation import Explanation
from .options import Options, read_outputs
from .paste import HOW
from .plan import read_presets
from .results import Result
from .run import Progress, Runner, Task, Work, clock
from .sources import (
    GEOMETRY,
    MESH,
    QUARTER,
    UNKNOWN_GEOMETRY,
    Given,
    Source,
    Variant,
    end_of_ramps,
    moved_pair,
    same_steps,
    sources_of,
)
from .sweep import command_text, make_force, make_outputs, refuse_outputs, remarks_of, say, write_files


def without_ladder(scene: Scene, runner: Runner) -> tuple[Scene, list[str]]:
    """The scene on its given mesh, whose error is measured by levels of its own, with the part of the target
    that is left to all else."""
    if scene.get("Target error of") != "everything":
        return scene, []
    part = runner.check(scene)[2].get("target error", scene.get("Target error"))
    given = scene.changed({"Target error of": None, "Finest mesh level": None, "Target error": part})
    given.presets = read_presets(runner.check(given)[2])
    return given, ["'Target error of = everything' is left out: the bars are those of the mesh as given"]


Usable = Tuple[Source, Variant, Scene]


def without_odd_level(
    usable: Sequence[Usable], elements: int, runner: Runner
) -> tuple[list[Usable], Usable | None]:
    """Removes a coarser mesh that is no whole level, such as two layers in place of five, if there is a finer
    one; the difference of such meshes has no order. Returns the removed one, too, in case the finer one
    fails."""
    counts = {variant.label: runner.elements(changed) for _, variant, changed in usable}
    for item in usable:
        source, variant, _ = item
        fine = counts.get(source.finer.label) if source.finer else None
        is_coarser_mesh = source.name == MESH and variant is source.coarser
        if is_coarser_mesh and fine and counts[variant.label] * fine != elements**2:
            return [other for other in usable if other is not item], item
    return list(usable), None


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
    more = len(by_program(scene, options.target)) + 1 if options.target is not None else 0
    say(
        f"Budget: {count + more} runs at most, the scene as it is and {count - 1} others"
        + (f", and {more} on the way to {percent(options.target)}" if more else "")
        + (f"; limited to {budget.text}" if budget.is_limited else "")
    )
    if not runner.finished(scene, options.repeat):
        budget.take(0.0)  # without it nothing can be said
    base = runner.run(scene, options.repeat, max(1.0, min(runner.limit, budget.seconds_left())))
    if base.status != "ok":
        raise UserError(f"the scene as it is {base.status} ({base.reason}): its error is not known", 3)
    force = make_force(options, scene, base)
    outputs, weights = make_outputs(options, scene, base, force, as_estimated=True)
    times = [float(t) for t in base.history["time"] if t > 0.0]
    depths = base.depths(end_of_ramps(scene))
    known = Given(times, max(depths.values(), default=math.nan), checked, depths)
    sources = sources_of(scene, known)

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
            elif source.name == GEOMETRY and (pair := moved_pair(checked, runner.check(changed)[2])):
                why_not[variant.label] = f"it would change the gap of '{pair}'; {UNKNOWN_GEOMETRY}"
            else:
                usable.append((source, variant, changed))
    usable, spare = without_odd_level(usable, elements, runner)
    costs = [work.expected(changed, options.repeat) for _, _, changed in usable]
    order = in_order(
        [(source, variant) for source, variant, _ in usable],
        [1.0] * len(usable) if budget.is_of_runs else costs,
    )
    say(
        f"By the first run, {base.core_seconds:.2g} core-s, {len(usable)} runs take about"
        f" {clock(sum(costs) / options.jobs)}: {', '.join(usable[i][1].label for i in order)}"
    )
    results = run_all(
        work, [(usable[i][1].label, usable[i][2], options.repeat) for i in order], options.jobs, why_not
    )
    if spare is not None:
        source, variant, changed = spare
        if source.finer is not None and source.finer.label in results:
            why_not[variant.label] = "no whole level: its numbers of elements have no ratio of two"
        elif not work.was_stopped:
            results.update(run_all(work, [(variant.label, changed, options.repeat)], options.jobs, why_not))
    if (trial := results.get(QUARTER)) is not None and not is_shallower(trial, base, end_of_ramps(scene)):
        del results[QUARTER]
        why_not[QUARTER] = "the run has no less penetration than the scene"
    explanation = Explanation(scene, base, outputs, weights, sources, results, why_not)
    cheapest = None
    if options.target is not None and explanation.counted and not work.was_stopped:
        cheapest = find_cheapest(options, runner, work, explanation, known, options.target)
        explanation.more = cheapest.section()
    write(explanation, cheapest, options, runner, file, arguments, remarks)
    if work.was_stopped:
        raise Stopped
    return 0 if explanation.counted and (cheapest is None or cheapest.is_shown) else 3


def is_shallower(trial: Result, base: Result, begin: float) -> bool:
    """Returns whether penetration from a time on is smaller in some contact, and larger in none."""
    before, after = base.depths(begin), trial.depths(begin)
    ratios = [after[name] / depth for name, depth in before.items() if name in after and depth > 0.0]
    return bool(ratios) and max(ratios) < 1.001 and min(ratios) < 0.999


def run_all(work: Work, tasks: Sequence[Task], jobs: int, why_not: dict[str, str]) -> dict[str, Result]:
    """Results that ended by their labels; why there are none of the others goes to `why_not`."""
    found = work.run(tasks, jobs)
    results: dict[str, Result] = {}
    for label, scene, _ in tasks:
        if not work.has(found, scene):
            why_not[label] = "beyond the budget" if label in work.left_out else "the study was stopped"
            continue
        result = work.result(found, scene)
        if result.status == "ok":
            results[label] = result
        else:
            why_not[label] = f"{result.status} ({result.reason})"
    return results


def find_cheapest(
    options: Options, runner: Runner, work: Work, explanation: Explanation, given: Given, target: float
) -> Cheapest:
    """Runs what may be the cheapest way to the target: what the bars predict, and what the program
    chooses."""
    scene = explanation.scene
    predicted = predict(explanation, given, target)
    own = by_program(scene, target)
    candidates = ([predicted] if predicted and predicted.changes else []) + own
    why_not: dict[str, str] = {}
    tasks: list[Task] = []
    for candidate in candidates:
        changed = scene.changed(candidate.changes)
        against = runner.check(changed)[1]
        if against:
            why_not[candidate.label] = f"billet refuses it: {against}"
        else:
            tasks.append((candidate.label, changed, options.repeat))
    if predicted is None:
        say(f"By the bars no setting is within {percent(target)}")
    results = run_all(work, tasks, options.jobs, why_not)
    return Cheapest(explanation, candidates, results, why_not, target)


def write(
    explanation: Explanation,
    cheapest: Cheapest | None,
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
    if cheapest is not None:
        print(f"\n{cheapest.table()}\n\n{cheapest.words()}")
        if cheapest.lines():
            print(f"\n{HOW}:\n\n{cheapest.lines()}", end="")
    print(f"\n{name}.csv, {name}.md, {drawn}")
