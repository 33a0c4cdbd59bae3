# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans the runs: the scene in pilot form, and the points of the sweep."""

from __future__ import annotations

import dataclasses
import itertools
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Mapping, Sequence

from .. import UserError
from ..scene import Changes, Scene
from . import parameters, results
from .parameters import Parameter
from .options import GIVEN, Options, read_settings
from .report import Point
from .run import Runner

Value = tuple[str, Changes]  # an argument of a parameter, and what it changes


def pilot(scene: Scene, options: Options) -> Scene:
    """The scene that is measured: in pilot form, with the output that measuring needs."""
    scene = scene.changed(read_settings("--set", options.set))
    if options.mesh:
        try:
            scene = scene.changed(
                parameters.scaled_meshes(scene, parameters.number(options.mesh, option="--mesh"))
            )
        except parameters.CannotTurn as why:
            raise UserError(f"--mesh: {why}") from None
    if options.until:
        end = parameters.shown(options.until * scene.end_time)
        stops = [s.strip() for s in scene.get("Time stepping/Stops").split(",") if s.strip()]
        left = (
            {"Time stepping/Stops": ", ".join(s for s in stops if float(s) <= float(end)) or None}
            if stops
            else {}
        )
        scene = scene.changed({"Time stepping/End time": end, **left})
    return scene.changed(results.output_settings(scene))


def read_presets(checked: Mapping[str, Any]) -> dict[str, str]:
    """Returns {path: value} of settings by a profile or a target error, from --check --json."""
    return {path.replace(" / ", "/"): value for path, value in checked.get("presets", {}).items()}


def is_number(text: str) -> bool:
    try:
        return bool(float(text)) or True
    except ValueError:
        return False


def with_value(parameter: Parameter, target: float) -> Parameter:
    """A parameter that is a target error, with the user's target as its first value."""
    if parameter.name not in ("target error", "target error of everything"):
        return parameter
    first = parameters.shown(target)
    others = [a for a in parameter.arguments if float(a) != float(first)]
    return dataclasses.replace(parameter, arguments=[first, *others])


class Candidates:
    """Parameters that the user named, or all, with the values that the scene can use."""

    def __init__(self, scene: Scene, runner: Runner, options: Options) -> None:
        self.scene, self.runner = scene, runner
        self.own = {k.name: k for k in map(parameters.own_parameter, options.parameter)}
        built_in = parameters.known_parameters(runner.program.words)
        self.known = {**built_in, **self.own}
        if options.parameters:
            chosen = [parameters.asked_parameter(text, self.known) for text in options.parameters]
            self.parameters = chosen + [
                k for k in self.own.values() if k.name not in {c.name for c in chosen}
            ]
        elif options.parameter or options.product:
            self.parameters = list(self.own.values())
        else:
            self.parameters = [
                k for k in built_in.values() if k.name != "mesh" or options.reference_mesh != GIVEN
            ]
            if options.target:
                self.parameters = [with_value(k, options.target) for k in self.parameters]
        self.is_asked = bool(options.parameters or options.parameter)
        self.products = [
            [parameters.asked_parameter(text, self.known) for text in product] for product in options.product
        ]
        self.left_out: dict[str, dict[str, str]] = {}  # {parameter: {argument: why}}
        self.taken: set[tuple[str, tuple[str, ...]]] = set()

    def changes(self, parameter: Parameter, argument: str) -> Changes:
        """Returns the changes of one value; raises CannotTurn with the reason."""
        changes = parameter.turned(self.scene, argument)
        # If the program takes one number, it takes others; the run itself reports one that is out of range.
        kind = (parameter.name, tuple(changes)) if is_number(argument) else None
        if kind is None or kind not in self.taken:
            _, against, _ = self.runner.check(self.scene.changed(changes))
            if against:
                raise parameters.CannotTurn(against)
            if kind is not None:
                self.taken.add(kind)
        return changes

    def values(self, parameter: Parameter) -> list[Value]:
        """Returns [(argument, changes)] that the scene can use."""
        found = []
        for argument in parameter.arguments:
            try:
                found.append((argument, self.changes(parameter, argument)))
            except parameters.CannotTurn as why:
                self.left_out.setdefault(parameter.name, {})[argument] = str(why)
        if not parameter.arguments:
            self.left_out[parameter.name] = {"": "the program has no such parameter"}
        return found

    def _ask(self) -> None:
        """Asks the program about all values of values() in advance, several at a time, and keeps its
        answers."""
        scenes, kinds = [self.scene], set()
        for parameter in self.parameters:
            for argument in parameter.arguments:
                try:
                    changes = parameter.turned(self.scene, argument)
                except parameters.CannotTurn:
                    continue
                kind = (parameter.name, tuple(changes)) if is_number(argument) else None
                if kind is None or kind not in kinds:
                    kinds.add(kind)
                    scenes.append(self.scene.changed(changes))
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            list(pool.map(self.runner.check, scenes))

    def possible(self) -> list[tuple[Parameter, list[Value]]]:
        """Returns [(parameter, values)] of parameters with something to change: values that differ from the
        scene, and not from each other."""
        self._ask()
        found = []
        for parameter in self.parameters:
            values = self.values(parameter)
            texts = {self.runner.key(self.scene.changed(changes).text) for _, changes in values}
            if values and texts != {self.runner.key(self.scene.text)}:
                found.append((parameter, values))
            elif values:
                self.left_out.setdefault(parameter.name, {})[
                    values[0][0]
                ] = "it is the only one, and the scene has it"
            if self.is_asked and not (found and found[-1][0] is parameter):
                raise UserError(
                    f"the scene cannot use the parameter '{parameter.name}': "
                    + "; ".join(
                        f"{a}: {w}" if a else w for a, w in self.left_out.get(parameter.name, {}).items()
                    )
                )
        return found

    def points(self) -> list[Point]:
        points = [
            Point(parameter.name, argument, changes, self.scene.changed(changes))
            for parameter, values in self.possible()
            for argument, changes in values
        ]
        for product in self.products:
            points += self._combinations(product)
        return points

    def _combinations(self, product: Sequence[Parameter]) -> list[Point]:
        """Returns all combinations that the program accepts. Later parameters see changes of earlier ones: a
        factor of a factor."""
        points, against = [], []
        for arguments in itertools.product(*(parameter.arguments for parameter in product)):
            changed = self.scene
            changes: dict[str, object] = {}
            label = ", ".join(
                f"{parameter.name} {argument}" for parameter, argument in zip(product, arguments)
            )
            try:
                for parameter, argument in zip(product, arguments):
                    more = parameter.turned(changed, argument)
                    changes.update(more)
                    changed = changed.changed(more)
                _, why, _ = self.runner.check(changed)
            except parameters.CannotTurn as reason:
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
            points.append(Point(name, last, changes, changed))
        if not points:
            raise UserError("--product: the scene cannot use any of it: " + "; ".join(against))
        for text in against:
            print(f"left out of the product: {text}", file=sys.stderr)
        return points

    def describe(self) -> str:
        said = []
        for parameter, values in self.possible():
            said.append(
                f"{parameter.name}: {parameter.meaning}\n    " + ", ".join(argument for argument, _ in values)
            )
        said.append("\nNot in this scene:")
        for name, whys in self.left_out.items():
            reasons: dict[str, list[str]] = {}
            for argument, why in whys.items():
                reasons.setdefault(why, []).append(argument)
            said += [
                f"  {name} {', '.join(arguments)}".rstrip() + f": {why}" for why, arguments in reasons.items()
            ]
        return "\n".join(said)
