# SPDX-License-Identifier: LGPL-2.1-or-later
"""The converged reference: the limit over mesh, step and penalty, each from a sequence of its own about one
centre.

The results are taken to add up: F* = F_c + Σ (F_axis − F_c), with F_axis the limit along an axis while the
others stay at the centre. One more run, off the centre along all axes at once, tells by how much they do not,
which joins the uncertainty.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable, Mapping, NamedTuple, Sequence

from .. import UserError
from ..output import Array
from ..scene import Changes, Scene
from . import parameters, measure
from .options import GIVEN
from .outputs import Output
from .results import Result

Level = tuple[str, Scene]  # its label and its scene
Mesh = tuple[tuple[str, str], ...]  # what a scene says of its meshes


@dataclass
class Axis:
    """Sequence of `levels` [(label, scene)] from coarse to fine, each `ratio` times finer; levels[centre] is
    the centre."""

    name: str
    ratio: float
    levels: list[Level]
    centre: int


Ended = tuple[Axis, int, list[tuple[str, Result]]]  # an axis, the first of its levels that ended, and these

# Elements up to which the finest of the reference's own meshes is four times as fine as the scene's: some
# minutes' work.
AUGMENTED = 0.01  # facet sizes, the coarsest level where bodies touch in implicit scenes
AFFORDABLE = {True: 150_000, False: 10_000}


def mesh_factors(scene: Scene, wanted: str | None, count: Callable[[Changes], int]) -> list[float]:
    """Returns the given factors, which must have one ratio and contain 1. By default they are 1, 2, 4 if
    count(changes) elements are affordable, else those of 0.5, 1, 2 that the mesh allows."""
    if wanted:
        factors = sorted(
            parameters.number(f, "factors > 0, such as 0.5,1,2", "--reference-mesh")
            for f in wanted.split(",")
        )
        ratios = [b / a for a, b in zip(factors, factors[1:])]
        if 1.0 not in factors or not ratios or max(ratios) > 1.001 * min(ratios) or min(ratios) <= 1:
            raise UserError(
                f"--reference-mesh is '{wanted}'; allowed are at least two factors in one ratio, 1 among"
                " them"
            )
        return factors
    try:
        if count(parameters.scaled_meshes(scene, 4.0)) <= AFFORDABLE[scene.is_explicit]:
            return [1.0, 2.0, 4.0]
    except parameters.CannotTurn:
        pass
    factors = []
    for factor in (0.5, 1.0, 2.0):
        try:
            parameters.scaled_meshes(scene, factor)
            factors.append(factor)
        except parameters.CannotTurn:
            pass
    return factors


class Plan:
    """The runs of a reference."""

    def __init__(
        self,
        scene: Scene,
        count: Callable[[Scene], int],
        mesh: str | None = None,
        steps: int | None = None,
        settings: Changes | None = None,
    ) -> None:
        """`count(scene)`: its elements."""
        base = scene.changed({**parameters.reference_settings(scene), **(settings or {})})
        levels: list[tuple[str, Changes]]
        if scene.is_explicit:
            safety = base.number("Explicit dynamics/Safety factor")
            levels = [
                (
                    f"safety factor {parameters.shown(safety / d)}",
                    {"Explicit dynamics/Safety factor": parameters.shown(safety / d)},
                )
                for d in (1, 2, 4)
            ]
        else:
            n = steps or min(100, max(20, parameters.longest_steps(scene)))
            levels = [(f"{m} steps", parameters.equal_steps(scene, m)) for m in (n, 2 * n, 4 * n)]
        tolerances = (
            {}
            if scene.is_explicit
            else {
                # 'automatic' is as far as the program thinks fit, which is no level of an axis.
                pair: (
                    AUGMENTED
                    if math.isinf(base.penetration_tolerance(pair))
                    else base.penetration_tolerance(pair)
                )
                or (AUGMENTED if pair == "General contact/" or base.get(pair + "Second body") else 0.0)
                for pair in scene.pairs
            }
        )
        augmented: dict[str, object] = {
            pair + "Penetration tolerance": parameters.shown(0.25 * t)
            for pair, t in tolerances.items()
            if t > 0
        }
        if augmented:
            augmented["Solver/Maximum augmentations"] = 100
        self.centre = base.changed({**levels[0][1], **augmented})
        self.axes = [
            Axis("step", 2.0, [(label, self.centre.changed(changes)) for label, changes in levels], 0)
        ]
        self._add_mesh(scene, mesh, lambda changes: count(scene.changed(changes)))
        self._add_penalty(scene)
        self._add_cross()

    def _add_mesh(self, scene: Scene, wanted: str | None, count: Callable[[Changes], int]) -> None:
        if wanted == GIVEN:
            return
        try:
            factors = mesh_factors(scene, wanted, count)
            levels = [
                (f"mesh {f:g}", self.centre.changed({} if f == 1 else parameters.scaled_meshes(scene, f)))
                for f in factors
            ]
        except parameters.CannotTurn as why:
            raise UserError(f"--reference-mesh: {why}") from None
        if len(factors) < 2:
            raise UserError(
                "the mesh can be made neither finer nor coarser, so that its error cannot be measured; "
                "--reference-mesh given measures the others'"
            )
        self.axes.append(Axis("mesh", factors[1] / factors[0], levels, factors.index(1.0)))

    def _add_penalty(self, scene: Scene) -> None:
        """Adds the axis of augmentation if the scene augments, or if bodies touch in an implicit scene.
        Penalties and mesh errors do not add up well there. Else adds the axis of the penalty."""
        pairs = scene.pairs
        augmented = [pair for pair in pairs if self.centre.number(pair + "Penetration tolerance") > 0]
        if augmented:
            # The centre in the middle: what is left of the penetration scatters, and would blur the other
            # axes.
            levels = [
                (
                    f"penetration tolerance / {d}",
                    self.centre.changed(
                        {
                            pair
                            + "Penetration tolerance": parameters.shown(
                                4 * self.centre.number(pair + "Penetration tolerance") / d
                            )
                            for pair in augmented
                        }
                        if d != 4
                        else {}
                    ),
                )
                for d in (1, 4, 16)
            ]
            self.axes.append(Axis("penetration tolerance", 4.0, levels, 1))
        elif pairs:
            levels = [
                (
                    f"penalty × {f}",
                    self.centre.changed(parameters.scaled_penalties(self.centre, f) if f > 1 else {}),
                )
                for f in (1, 4, 16)
            ]
            self.axes.append(Axis("penalty", 4.0, levels, 0))

    def _add_cross(self) -> None:
        """Adds the run one step away from the centre along all axes; along the mesh it is a coarser one if
        possible, which costs less."""
        changes = {}
        self.neighbours = {}
        for axis in self.axes:
            at = axis.centre - 1 if axis.centre > 0 else axis.centre + 1
            self.neighbours[axis.name] = at
            scene = axis.levels[at][1]
            changes.update(
                {
                    path: value
                    for path, value in scene.entries.items()
                    if self.centre.entries.get(path) != value
                }
            )
        self.cross = self.centre.changed(changes)

    def runs(self) -> list[Level]:
        """[(label, scene)], the centre first."""
        found = [("centre", self.centre)]
        for axis in self.axes:
            found += [level for i, level in enumerate(axis.levels) if i != axis.centre]
        return found + [("all of them", self.cross)]


class Row(NamedTuple):
    """Derivation of the reference of an output along an axis."""

    output: str
    axis: str
    levels: str
    differences: list[float]  # of neighbours, relative
    observed: float | None  # order
    order: float | None  # that was used
    uncertainty: float


class Reference:
    """`values`, and `uncertainty` relative to them, by output; `rows` tells how they came about; `remarks`
    what fell short."""

    def __init__(self, plan: Plan, results: Sequence[Result | None], outputs: Sequence[Output]) -> None:
        """`results`: of plan.runs(), in its order; None where there was no run."""
        pairs = zip(plan.runs(), results)
        by_scene = {scene.text: result for (_, scene), result in pairs if result is not None}
        self.remarks = [
            f"{label}: no run, for the budget or an early end"
            for (label, _), result in zip(plan.runs(), results)
            if result is None
        ]
        if plan.centre.text not in by_scene:
            raise UserError("the reference could not be made: its centre was not run", 3)
        centre = by_scene[plan.centre.text]
        if centre.status == "out of time":
            raise UserError(
                (
                    f"the reference could not be made: its centre was not done in the {centre.limit:g} s of"
                    f" --time-limit ({centre.reason})"
                ),
                3,
            )
        if centre.status != "ok":
            raise UserError(
                (
                    f"the reference could not be made: its centre {centre.status} ({centre.reason}). "
                    "--reference-steps with a larger number, or --reference 'path=value', may help"
                ),
                3,
            )
        sequences = {}
        for axis in plan.axes:
            found = [(label, by_scene.get(scene.text)) for label, scene in axis.levels]
            for label, result in found:
                if result is not None and result.status != "ok":
                    self.remarks.append(f"{label} {result.status}: {result.reason or 'no reason given'}")
            # The remaining levels must be neighbours, the centre among them.
            low = high = axis.centre
            while low > 0 and has_ended(found[low - 1][1]):
                low -= 1
            while high + 1 < len(found) and has_ended(found[high + 1][1]):
                high += 1
            if low == high:
                raise UserError(
                    (
                        "the reference could not be made: nothing beside its centre came to an end along the"
                        f" axis '{axis.name}': {'; '.join(self.remarks)}"
                    ),
                    3,
                )
            ended = [(label, result) for label, result in found[low : high + 1] if result is not None]
            sequences[axis.name] = (axis, low, ended)
        self.values: dict[str, Array] = {}
        self.uncertainty: dict[str, float] = {}
        self.rows: list[Row] = []
        self._mesh_errors: dict[Mesh, dict[str, float]] = {}  # {mesh: {output: error of this mesh alone}}
        for output in outputs:
            self._extrapolate(output, plan, sequences, centre, by_scene.get(plan.cross.text))

    def _extrapolate(
        self, output: Output, plan: Plan, sequences: Mapping[str, Ended], centre: Result, cross: Result | None
    ) -> None:
        known = {}

        def values(result: Result) -> Array:
            key = str(result.folder)
            if key not in known:
                known[key] = output.values(result)
            return known[key]

        middle = values(centre)
        total, limits, predicted = middle.copy(), [], middle.copy()
        for axis, low, levels in sequences.values():
            limit = measure.richardson([values(result) for _, result in levels], axis.ratio, output.norm)
            limits.append((axis, levels, limit))
            total = total + (limit.values - middle)
            place = plan.neighbours[axis.name] - low
            if 0 <= place < len(levels):
                predicted = predicted + (values(levels[place][1]) - middle)
        scale = output.scale(total)
        if not scale > 0.0:
            raise UserError(
                f"the output '{output.name}' is zero in this scene: choose others with --outputs", 2
            )
        uncertainty = 0.0
        for axis, levels, limit in limits:
            uncertainty += limit.uncertainty
            self.rows.append(
                Row(
                    output.name,
                    axis.name,
                    " → ".join(label for label, _ in levels),
                    [d / scale for d in limit.differences],
                    limit.observed,
                    limit.order,
                    limit.uncertainty / scale,
                )
            )
        off = math.nan
        if cross is not None and cross.status == "ok":
            off = output.norm(values(cross) - predicted)
            uncertainty += off
        elif cross is not None:
            self.remarks.append(f"the run off all axes {cross.status}: whether they add up is not known")
        self.rows.append(Row(output.name, "off all axes", "", [], None, None, off / scale))
        self.values[output.name], self.uncertainty[output.name] = total, uncertainty / scale
        for axis, low, levels in sequences.values():
            limit = next(found for other, _, found in limits if other is axis)
            for (_, scene), (_, result) in zip(axis.levels[low:], levels) if axis.name == "mesh" else []:
                self._mesh_errors.setdefault(mesh_of(scene), {})[output.name] = (
                    output.norm(values(result) - limit.values) / scale
                )

    def mesh_alone(self, scene: Scene) -> dict[str, float] | None:
        """Returns {output: error} of the scene's mesh and elements with all else converged; None if the
        reference has no such mesh."""
        return self._mesh_errors.get(mesh_of(scene))

    def uncertainty_by_axis(self) -> list[tuple[str, str, float]]:
        """[(output, axis, uncertainty)]."""
        return [
            (row.output, row.axis, row.uncertainty) for row in self.rows if not math.isnan(row.uncertainty)
        ]


def has_ended(result: Result | None) -> bool:
    return result is not None and result.status == "ok"


SPATIAL = ("Element", "Facets", "Passes", "Smoothing", "Target error of")


def mesh_of(scene: Scene) -> Mesh:
    """Returns the settings of the scene's meshes and elements, however the scene writes them. Other settings
    have other mesh errors."""
    return tuple(
        sorted(
            (path, "".join(value.split()))
            for path, value in scene.entries.items()
            if ("/Mesh/" in path or path.split("/")[-1] in SPATIAL) and value != scene.default(path)
        )
    )
