# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line, and the order of things."""

import argparse
import itertools
import os
import shlex
import signal
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

from . import TradeError, knobs, picture, report, results
from .reference import GIVEN, Plan, Reference
from .runs import Program, Runner, Stopped, find_program
from .scene import Scene, read_scene

HELP = """What accuracy costs in a scene of billet: turns one knob after the other, measures each run against
a converged reference that it makes itself, and writes a table, a CSV file and a picture of error over cost.
What has been run is kept; after Ctrl-C the same command goes on."""


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="billet-trade", description=HELP, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("scene", help="a scene file of billet")
    add(
        "--list", action="store_true", help="say which knobs the scene can use and with which values, and end"
    )
    group = parser.add_argument_group("what is turned")
    add = group.add_argument
    add(
        "--knobs",
        nargs="+",
        metavar="KNOB[=V,V]",
        help="these only, with these values: mesh=0.5,1 tangent penalty=1,10 (all that the scene can use)",
    )
    add(
        "--knob",
        action="append",
        default=[],
        metavar="[NAME: ]PATH=V,V",
        help=(
            "a knob of your own: a parameter by its path, 'Solver/Line search=energy,none'; "
            "several at once joined by ' & '; values with commas separated by '|'"
        ),
    )
    add(
        "--product",
        action="append",
        nargs="+",
        default=[],
        metavar="KNOB[=V,V]",
        help="all combinations of the values of these knobs, too; may be given more than once",
    )
    add(
        "--combine",
        action="store_true",
        help="with --target: join to the chosen point, knob by knob, what is cheaper still",
    )
    group = parser.add_argument_group("the scene in pilot form")
    add = group.add_argument
    add("--until", type=float, metavar="PART", help="this part of the end time only")
    add(
        "--mesh",
        metavar="FACTOR",
        help="elements along each edge, factor of the scene's: 0.5 for a coarser mesh",
    )
    add("--set", action="append", default=[], metavar="PATH=VALUE", help="any parameter")
    group = parser.add_argument_group("what counts")
    add = group.add_argument
    add(
        "--outputs",
        default="",
        metavar="O[=W],...",
        help=(
            "of force, strain, shape, rebound, with weights: force=2,shape "
            "(force, where there is one, and shape; strain, too, with --line)"
        ),
    )
    add(
        "--force",
        metavar="COLUMN,...",
        help="columns of history.csv, such as die.force_z (forces of all tools, else of all pairs of bodies)",
    )
    add(
        "--window",
        type=float,
        default=0.05,
        metavar="PART",
        help="explicit scenes: forces are means over this part of the time (0.05)",
    )
    add("--line", metavar="'X,Y,Z to X,Y,Z'", help="in the undeformed bodies, of the strain profile")
    add(
        "--profile",
        choices=("stretch", "plastic"),
        default="stretch",
        help="logarithmic stretch along the line, or equivalent plastic strain",
    )
    add("--target", metavar="ERROR", help="such as 1%% or 0.01: name the cheapest point within it")
    add(
        "--cost",
        choices=("seconds", "work"),
        default="seconds",
        help="what 'cheap' means: core-seconds, or work without regard to the machine",
    )
    group = parser.add_argument_group("the reference")
    add = group.add_argument
    add(
        "--reference-mesh",
        metavar="F,F,F",
        help=(
            "factors of the mesh in one ratio, 1 among them (1,2,4 where that is affordable, else 0.5,1,2);"
            " given: the scene's mesh is taken as it is, and errors are those of all else"
        ),
    )
    add(
        "--reference-steps",
        type=int,
        metavar="N",
        help="implicit scenes: N, 2N and 4N equal steps (as many as the largest step makes, 20 to 100)",
    )
    add(
        "--reference",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="a parameter that the reference has otherwise than the scene",
    )
    group = parser.add_argument_group("running")
    add = group.add_argument
    add("--ranks", type=int, default=1, help="processes of each run (1)")
    add("-j", "--jobs", type=int, default=1, help="runs at a time; more than one blurs the core-seconds (1)")
    add("--repeat", type=int, default=3, help="times that each point is timed; the median counts (3)")
    add(
        "--time-limit", type=float, default=600.0, metavar="S", help="seconds on the clock for each run (600)"
    )
    add("--program", help="billet itself (the one beside this program, or in BILLET, or on the path)")
    group = parser.add_argument_group("what fails beside what does not come to its end")
    add = group.add_argument
    add("--largest-drift", type=float, default=0.05, help="of the energy balance of dynamic scenes (0.05)")
    add("--largest-penetration", type=float, default=0.5, help="in facet sizes (0.5)")
    add(
        "--locked",
        type=float,
        default=0.2,
        help="forces larger by this part in the mean are those of locking (0.2)",
    )
    add(
        "--soft",
        type=float,
        default=0.2,
        help="forces smaller by this part in the mean are those of too soft a contact (0.2)",
    )
    add(
        "--largest-error",
        type=float,
        default=0.5,
        help="beyond which a run is of no use; of the reference, too (0.5)",
    )
    group = parser.add_argument_group("where to")
    add = group.add_argument
    add("--folder", help="where runs are kept (results/trade/SCENE)")
    add("--output", metavar="NAME", help="NAME.csv, NAME.md and NAME.png are written (FOLDER/trade)")
    add("--picture", metavar="FILE", help="another place for the picture, .png, .svg or .pdf")
    add("--title", help="of picture and page (the scene's)")
    options = parser.parse_args(arguments)
    for name, least in (("ranks", 1), ("jobs", 1), ("repeat", 1)):
        if getattr(options, name) < least:
            raise TradeError(
                f"--{name}: found {getattr(options, name)}, allowed are whole numbers from {least} on"
            )
    if options.reference_steps is not None and options.reference_steps < 1:
        raise TradeError(
            f"--reference-steps: found {options.reference_steps}, allowed are whole numbers from 1 on"
        )
    if options.until is not None and not 0 < options.until <= 1:
        raise TradeError(f"--until: found {options.until:g}, allowed is a part of the end time, > 0 and <= 1")
    if options.combine and not options.target:
        raise TradeError("--combine wants a --target to stay within")
    if options.reference_mesh == GIVEN and any(
        k.partition("=")[0] == "mesh" for k in (options.knobs or []) + sum(options.product, [])
    ):
        raise TradeError("--reference-mesh given: the mesh cannot be a knob then")
    options.target = read_error(options.target)
    if "strain" in read_outputs(options.outputs) and not options.line:
        raise TradeError("--outputs: the strain profile wants a --line 'x, y, z to x, y, z'")
    if options.line:
        results.Profile(options.line, options.profile)  # says what is wrong with it
    if not options.time_limit > 0:
        raise TradeError(f"--time-limit: found {options.time_limit:g}, allowed are seconds > 0")
    return options


def read_error(text):
    if text is None:
        return None
    cleaned = text.replace("percent", "%").strip()
    value = knobs.number(cleaned.rstrip("% "), "an error > 0, such as 1% or 0.01", "--target") * (
        0.01 if "%" in cleaned else 1.0
    )
    if value >= 1:
        raise TradeError(f"--target: found '{text}', allowed is an error below 100 %, such as 1% or 0.01")
    return value


def read_settings(option, texts):
    changes = {}
    for text in texts:
        path, equals, value = text.partition("=")
        if not equals or not path.strip():
            raise TradeError(f"{option}: found '{text}', allowed is 'path/to/parameter=value'")
        changes["/".join(" ".join(part.split()) for part in path.split("/"))] = value.strip()
    return changes


def read_outputs(text):
    """{name: weight}."""
    weights = {}
    for part in filter(None, (p.strip() for p in text.split(","))):
        name, equals, weight = part.partition("=")
        if name not in ("force", "strain", "shape", "rebound"):
            raise TradeError(
                f"--outputs: found '{name}', allowed are force, strain, shape, rebound, each with =WEIGHT if"
                " need be"
            )
        weights[name] = knobs.number(weight, "a weight > 0", f"--outputs: {name}") if equals else 1.0
    return weights


# --- the scene and its knobs ----------------------------------------------------------------------


def pilot(scene, options):
    """The scene that is measured: in pilot form, with the output that measuring needs."""
    scene = scene.changed(read_settings("--set", options.set))
    if options.mesh:
        try:
            scene = scene.changed(knobs.make_mesh(scene, knobs.number(options.mesh, option="--mesh")))
        except knobs.CannotTurn as why:
            raise TradeError(f"--mesh: {why}") from None
    if options.until:
        end = knobs.shown(options.until * scene.end_time)
        stops = [s.strip() for s in scene.get("Time stepping/Stops").split(",") if s.strip()]
        left = (
            {"Time stepping/Stops": ", ".join(s for s in stops if float(s) <= float(end)) or None}
            if stops
            else {}
        )
        scene = scene.changed({"Time stepping/End time": end, **left})
    return scene.changed(results.output_settings(scene))


def read_presets(checked):
    """{path: value} of what a profile or a target error sets in a scene, as --check --json says."""
    return {path.replace(" / ", "/"): value for path, value in checked.get("presets", {}).items()}


def is_number(text):
    try:
        return bool(float(text)) or True
    except ValueError:
        return False


class Candidates:
    """The knobs that were asked for, or all, and what the scene can use of them."""

    def __init__(self, scene, runner, options):
        self.scene, self.runner = scene, runner
        self.own = {k.name: k for k in map(knobs.own_knob, options.knob)}
        self.known = {**knobs.KNOBS, **self.own}
        if options.knobs:
            chosen = [knobs.asked_knob(text, self.known) for text in options.knobs]
            self.knobs = chosen + [k for k in self.own.values() if k.name not in {c.name for c in chosen}]
        elif options.knob or options.product:
            self.knobs = list(self.own.values())
        else:
            self.knobs = [
                k for k in knobs.KNOBS.values() if k.name != "mesh" or options.reference_mesh != GIVEN
            ]
        self.is_asked = bool(options.knobs or options.knob)
        self.products = [
            [knobs.asked_knob(text, self.known) for text in product] for product in options.product
        ]
        self.left_out = {}  # {knob: {argument: why}}
        self.taken = set()

    def changes(self, knob, argument):
        """Of one value; raises CannotTurn with the reason."""
        changes = knob.turned(self.scene, argument)
        # Where one number is taken the others are; what is out of range the run itself tells.
        kind = (knob.name, tuple(changes)) if is_number(argument) else None
        if kind is None or kind not in self.taken:
            _, against, _ = self.runner.check(self.scene.changed(changes))
            if against:
                raise knobs.CannotTurn(against)
            self.taken.add(kind)
        return changes

    def values(self, knob):
        """[(argument, changes)] that the scene can use."""
        found = []
        for argument in knob.arguments:
            try:
                found.append((argument, self.changes(knob, argument)))
            except knobs.CannotTurn as why:
                self.left_out.setdefault(knob.name, {})[argument] = str(why)
        return found

    def _ask(self):
        """The program about all that values() will want to know, several at a time: what it says is kept."""
        scenes, kinds = [self.scene], set()
        for knob in self.knobs:
            for argument in knob.arguments:
                try:
                    changes = knob.turned(self.scene, argument)
                except knobs.CannotTurn:
                    continue
                kind = (knob.name, tuple(changes)) if is_number(argument) else None
                if kind is None or kind not in kinds:
                    kinds.add(kind)
                    scenes.append(self.scene.changed(changes))
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            list(pool.map(self.runner.check, scenes))

    def possible(self):
        """[(knob, values)] of knobs with something to turn: values that differ from the scene, and not from
        each other."""
        self._ask()
        found = []
        for knob in self.knobs:
            values = self.values(knob)
            texts = {self.runner.key(self.scene.changed(changes).text) for _, changes in values}
            if values and texts != {self.runner.key(self.scene.text)}:
                found.append((knob, values))
            elif values:
                self.left_out.setdefault(knob.name, {})[
                    values[0][0]
                ] = "it is the only one, and the scene has it"
            if self.is_asked and not (found and found[-1][0] is knob):
                raise TradeError(
                    f"the scene cannot use the knob '{knob.name}': "
                    + "; ".join(f"{a}: {w}" for a, w in self.left_out.get(knob.name, {}).items())
                )
        return found

    def points(self):
        points = [
            report.Point(knob.name, argument, changes, self.scene.changed(changes))
            for knob, values in self.possible()
            for argument, changes in values
        ]
        for product in self.products:
            points += self._combinations(product)
        return points

    def _combinations(self, product):
        """All that the program takes; a later knob sees what the earlier ones did: a factor of a factor."""
        points, against = [], []
        for arguments in itertools.product(*(knob.arguments for knob in product)):
            changed, changes = self.scene, {}
            label = ", ".join(f"{knob.name} {argument}" for knob, argument in zip(product, arguments))
            try:
                for knob, argument in zip(product, arguments):
                    more = knob.turned(changed, argument)
                    changes.update(more)
                    changed = changed.changed(more)
                _, why, _ = self.runner.check(changed)
            except knobs.CannotTurn as reason:
                why = str(reason)
            if why:
                against.append(f"{label}: {why}")
                continue
            *first, last = arguments
            name = (
                ", ".join(f"{k.name} {a}" for k, a in zip(product, first))
                + (" × " if first else "")
                + product[-1].name
            )
            points.append(report.Point(name, last, changes, changed))
        if not points:
            raise TradeError("--product: the scene cannot use any of it: " + "; ".join(against))
        for text in against:
            print(f"left out of the product: {text}", file=sys.stderr)
        return points

    def tell(self):
        said = []
        for knob, values in self.possible():
            said.append(f"{knob.name}: {knob.meaning}\n    " + ", ".join(argument for argument, _ in values))
        said.append("\nNot in this scene:")
        for name, whys in self.left_out.items():
            reasons = {}
            for argument, why in whys.items():
                reasons.setdefault(why, []).append(argument)
            said += [f"  {name} {', '.join(arguments)}: {why}" for why, arguments in reasons.items()]
        return "\n".join(said)


# --- running --------------------------------------------------------------------------------------


class Progress:
    """A line for each run, with the time to go: by the clock of the runs so far, and what size, steps and
    repeats of the rest let expect."""

    def __init__(self, base_elements, base_steps, base_clock, is_explicit, jobs):
        self.base, self.is_explicit, self.jobs = (
            (base_elements, base_steps, max(base_clock, 1e-3)),
            is_explicit,
            jobs,
        )
        self.done = self.total = 0
        self.left, self.spent, self.expected_so_far = 0.0, 0.0, 0.0

    def expected(self, elements, steps, repeats):
        size = (elements / max(1, self.base[0])) ** (4 / 3)
        return (
            self.base[2]
            * max(0.3, size * (1.0 if self.is_explicit else (steps / self.base[1]) ** 0.7))
            * repeats
        )

    def plan(self, seconds):
        self.total += 1
        self.left += seconds

    def tell(self, label, result, planned, took, was_kept):
        self.done += 1
        self.left = max(0.0, self.left - planned)
        if not was_kept:
            self.spent += took
            self.expected_so_far += planned
        pace = self.spent / self.expected_so_far if self.expected_so_far > 0 else 1.0
        work = (
            f"{result.newton + result.linear} iterations" if not self.is_explicit else f"{result.steps} steps"
        )
        to_go = "" if self.done == self.total else f"; about {clock(self.left * pace / self.jobs)} to go"
        kept = ", kept from before" if was_kept else ""
        print(
            (
                f"[{self.done:>{len(str(self.total))}}/{self.total}] {label}: {result.status},"
                f" {result.core_seconds:.3g} core-s, {work}{kept}{to_go}"
            ),
            file=sys.stderr,
            flush=True,
        )


def clock(seconds):
    return (
        f"{seconds:.0f} s"
        if seconds < 100
        else f"{seconds / 60:.0f} min"
        if seconds < 6000
        else f"{seconds / 3600:.1f} h"
    )


class Work:
    """Runs that are to be made, each scene once."""

    def __init__(self, runner, progress, scene):
        self.runner, self.progress, self.scene = runner, progress, scene

    def expected(self, scene, repeats):
        elements = self.runner.elements(scene)
        steps = self.progress.base[1]
        if not scene.is_explicit:
            steps *= knobs.longest_steps(scene) / knobs.longest_steps(self.scene)
        return self.progress.expected(elements, steps, repeats)

    def run(self, tasks, jobs):
        """Results by the key of the scene, of (label, scene, repeats)."""
        planned, found = {}, {}
        for label, scene, repeats in tasks:
            key = self.runner.key(self.runner.prepared(scene))
            known = planned.get(key)
            planned[key] = (known[0] if known else label, scene, max(repeats, known[2] if known else 0))
        left = {key: self.expected(scene, repeats) for key, (_, scene, repeats) in planned.items()}
        for seconds in left.values():
            self.progress.plan(seconds)

        def one(key):
            label, scene, repeats = planned[key]
            was_kept = self.runner.finished(scene, repeats)
            begin = time.monotonic()
            return key, self.runner.run(scene, repeats), time.monotonic() - begin, was_kept

        with ThreadPoolExecutor(jobs) as pool:
            futures = [pool.submit(one, key) for key in planned]
            try:
                for future in as_completed(futures):
                    key, result, took, was_kept = future.result()
                    found[key] = result
                    self.progress.tell(planned[key][0], result, left[key], took, was_kept)
            except BaseException:
                self.runner.stop.set()
                pool.shutdown(wait=True, cancel_futures=True)
                raise
        return found

    def result(self, found, scene):
        return found[self.runner.key(self.runner.prepared(scene))]


# --- outputs --------------------------------------------------------------------------------------


def refuse_outputs(weights, scene):
    """What the scene cannot have, before anything runs."""
    if "rebound" in weights and not scene.is_dynamic:
        raise TradeError("--outputs: nothing rebounds in a static scene")
    if "force" in weights and not scene.names("Tools") and not scene.names("Contact pairs"):
        raise TradeError("--outputs: the scene has no tool and no pair of bodies, hence no force")


def make_force(options, scene, centre, finest=None):
    """The force, whether it counts or only judges; None where there is none. `finest`: the run with the
    shortest steps."""
    if not any(".force_" in column for column in centre.history):
        return None
    columns = [c.strip() for c in options.force.split(",")] if options.force else None
    return results.Force(centre, scene, columns, options.window, finest)


def make_outputs(options, scene, centre, force):
    """The outputs that count, and their weights."""
    weights = read_outputs(options.outputs)
    if not weights:
        weights = {
            **({"force": 1.0} if force else {}),
            "shape": 1.0,
            **({"strain": 1.0} if options.line else {}),
        }
    found = []
    for name in weights:
        if name == "force":
            if not force:
                raise TradeError("--outputs: the scene has no tool and no pair of bodies, hence no force")
            found.append(force)
        elif name == "strain":
            found.append(results.Profile(options.line, options.profile))
        elif name == "shape":
            found.append(results.Shape(centre))
        else:
            found.append(results.Rebound(centre, scene))
    return found, weights


def judging_forces(plan, reference_results, force, reference):
    """What tells locked and soft: (the force, the reference that knows it), whether it is among the outputs
    or not; None where there is none to speak of."""
    if not force or "force" in reference.values:
        return (force, reference) if force else None
    try:
        return force, Reference(plan, reference_results, [force])
    except TradeError:  # it is zero, which only matters to who asks for it
        return None


def combine(sweep, candidates, run):
    """Joins to the chosen point what makes it cheaper within the target, knob by knob, most promising first;
    returns the points that were tried."""
    chosen, tried = sweep.chosen or (sweep.base if sweep.base.is_good else None), []
    if chosen is None:
        return tried
    cheaper = {}
    if sweep.is_blind:
        return tried
    for knob, points in sweep.curves().items():
        good = [
            p
            for p in points
            if p.is_good
            and sweep.is_cheaper(p)
            and sweep.ranked(p) <= max(sweep.target, 1.5 * max(sweep.ranked(sweep.base), sweep.uncertainty))
            and knob != chosen.curve
        ]
        if good:
            cheaper[knob] = min(good, key=sweep.cost_of)
    best = chosen
    for knob, point in sorted(cheaper.items(), key=lambda item: sweep.cost_of(item[1])):
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
            trial.error + sweep.uncertainty <= sweep.target
            or sweep.chosen is None
            and trial.error < best.error
        )
        if within and sweep.cost_of(trial) < sweep.cost_of(best):
            best = trial
    return tried


# --- all of it ------------------------------------------------------------------------------------


def read_user_scene(options, program):
    file = Path(options.scene)
    if not file.is_file():
        raise TradeError(f"{options.scene}: there is no such scene file")
    code, _, against = program.check(file)
    if code != 0:
        raise TradeError(f"billet refuses the scene:\n{against}", 2)
    try:
        return Scene(read_scene(file), program.parameters), file
    except (OSError, UnicodeDecodeError) as error:
        raise TradeError(f"{options.scene}: cannot be read: {error}") from None


def main(arguments, beside):
    options = parse(arguments)
    program = Program(find_program(options.program, beside), options.ranks)
    original, file = read_user_scene(options, program)
    folder = Path(options.folder or Path("results/trade") / file.stem)
    runner = Runner(program, folder, options.time_limit, options.repeat)
    handlers = {
        number: signal.signal(number, lambda *_: runner.stop.set())
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        runner.files = original.files(file.parent)
        scene = pilot(original, options)
        elements, against, checked = runner.check(scene)
        if against:
            raise TradeError(f"billet refuses the scene as it would be measured: {against}")
        scene.presets = read_presets(checked)
        if options.list:
            print(Candidates(scene, runner, options).tell())
            return 0
        return sweep_over(options, runner, scene, elements, file, arguments)
    except Stopped:
        kept = len(list((folder / "runs").glob("*/result.json")))
        print(
            (
                f"billet-trade: stopped; {kept} runs are kept in {folder}, and the same command goes on from"
                " there"
            ),
            file=sys.stderr,
        )
        return 5
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        runner.close()


def sweep_over(options, runner, scene, elements, file, arguments):
    settings = read_settings("--reference", options.reference)
    plan = Plan(scene, runner.elements, options.reference_mesh, options.reference_steps, settings)
    if runner.check(plan.centre)[1]:
        raise TradeError(
            f"--reference: billet refuses the reference's centre: {runner.check(plan.centre)[1]}"
        )
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

    def judge(point):
        point.work = report.work_of(point.result, runner.elements(point.scene), scene.is_explicit)
        report.judge(point, outputs, weights, reference, scene, limits, forces)

    for point in points:
        point.result = work.result(found, point.scene)
        judge(point)
    sweep = report.Sweep(
        points, reference, outputs, weights, scene, options.cost, options.target, limits.error
    )

    if options.combine:

        def run(point):
            point.result = work.result(work.run([(point.label, point.scene, options.repeat)], 1), point.scene)
            judge(point)

        tried = combine(sweep, candidates, run)
        sweep = report.Sweep(
            points + tried, reference, outputs, weights, scene, options.cost, options.target, limits.error
        )

    write(sweep, plan, reference_results, options, runner, scene, file, arguments)
    print(f"({clock(time.monotonic() - started)})", file=sys.stderr)
    return 3 if options.target is not None and sweep.chosen is None or not sweep.front else 0


def write(sweep, plan, reference_results, options, runner, scene, file, arguments):
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
        raise TradeError(f"what came out cannot be written: {error}") from None
    print(report.table(sweep.head(), sweep.rows()) + "\n")
    print("\n".join(sweep.words()))
    print(f"\n{name}.csv, {name}.md, {drawn}")


def run(arguments, beside):
    try:
        return main(arguments, beside)
    except TradeError as error:
        print(f"billet-trade: {error}", file=sys.stderr)
        return error.code
    except knobs.CannotTurn as why:
        print(f"billet-trade: {why}", file=sys.stderr)
        return 2
