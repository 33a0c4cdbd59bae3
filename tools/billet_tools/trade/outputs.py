# SPDX-License-Identifier: LGPL-2.1-or-later
"""The outputs whose errors count: tool force, energy, strain profile, final shape, rebound."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Sequence

import numpy

from .. import UserError
from ..output import Array
from ..scene import Scene
from . import measure
from .options import read_line
from .results import Result


class Output(ABC):
    """An output of a run as an array of vectors, with a norm. `values` are those that the reference
    extrapolates."""

    name: str
    meaning: str

    @abstractmethod
    def values(self, result: Result) -> Array:
        """Returns those of a run."""

    @abstractmethod
    def norm(self, values: Array) -> float:
        """Returns the size of values or of their differences."""

    def error(self, result: Result, reference_values: Array) -> float:
        """Returns the error relative to the reference's own size."""
        return self.norm(self.values(result) - reference_values) / self.scale(reference_values)

    def scale(self, reference_values: Array) -> float:
        return self.norm(reference_values)


def reactions(result: Result) -> list[str]:
    """Columns with forces of supports; with their moments where forces are round-off beside them, as in
    torsion."""
    forces, moments = (
        [c for c in result.history if f".{what}_" in c and ".support " in c] for what in ("force", "moment")
    )

    def largest(columns: list[str]) -> float:
        return float(max((numpy.abs(result.history[c]).max() for c in columns), default=0.0))

    far = 1e3  # a force makes a moment of no more than itself times its distance from the origin
    if largest(moments) > far * largest(forces):
        reach = max(numpy.linalg.norm(mesh.centres, axis=1).max() for mesh in result.body_meshes.values())
        if largest(moments) > far * reach * largest(forces):
            return moments
    return forces


def contact_forces(result: Result, scene: Scene) -> list[str]:
    """Columns with forces of tools and of pairs of bodies: not reactions, nor parts of a tool's force, nor
    what loads and tools under a force are given."""
    given = tuple(
        f"{tool}.force_" for tool in scene.names("Tools") if scene.get(f"Tools/{tool}/Motion/Force").strip()
    )
    return [
        column
        for column in result.history
        if ".force_" in column
        and not column.startswith(("pair ", *given))
        and ".support " not in column
        and ".symmetry plane " not in column
        and ".load " not in column
    ]


def has_supports(scene: Scene) -> bool:
    """Returns whether a body has a support."""
    return any(scene.names("Bodies", body, "Supports") for body in scene.names("Bodies"))


def moves_support(scene: Scene) -> bool:
    """Returns whether a support moves. The forces of supports at rest alone follow from the loads, whatever
    the error."""

    def is_zero(text: str) -> bool:
        try:
            return all(float(part) == 0.0 for part in text.split(";"))
        except ValueError:
            return False

    return any(
        path.split("/")[2:3] == ["Supports"] and path.endswith("/Displacement") and not is_zero(value)
        for path, value in scene.entries.items()
    )


class Force(Output):
    """Forces of tools, or without tools of contact pairs of bodies, or without either of supports:
    ∫|F − F*| / ∫|F*| over time, at the ends of steps. Explicit histories, which ring, by running means.

    What the reference extrapolates are curves at the ends of the centre's steps. Between them it goes as the
    `finest` run does, by whose difference from it, which has hardly any corners, it is carried over: curves
    have corners, which no interpolation of long steps can tell (Roache and Knupp 1993, completed
    extrapolation)."""

    name, meaning = "force", "∫|F − F*| / ∫|F*| over time"

    def __init__(
        self,
        result: Result,
        scene: Scene,
        columns: Sequence[str] | None,
        window: float,
        finest: Result | None = None,
    ) -> None:
        self.columns = columns or self.all_forces(result, scene)
        self.finest = finest or result
        for column in self.columns:
            if column not in result.history:
                have = sorted(c for c in result.history if ".force_" in c)
                raise UserError(
                    f"--force: the history has no column '{column}'; it has"
                    f" {', '.join(have) or 'no force at all'}"
                )
        self.window = window * scene.end_time if scene.is_explicit else 0.0
        self.times = (
            numpy.linspace(0.0, scene.end_time, 201)[1:] if self.window else self._curve(result)[0][1:]
        )
        self.weights = measure.trapezoids(self.times)

    @staticmethod
    def all_forces(result: Result, scene: Scene) -> list[str]:
        found = contact_forces(result, scene)
        tools = tuple(f"{name}.force_" for name in scene.names("Tools"))
        of_tools = [column for column in found if column.startswith(tools)]
        return of_tools or found or reactions(result)

    def _curve(self, result: Result) -> tuple[Array, Array]:
        """Returns times and forces of the history, with a force of zero at time zero."""
        times = result.history["time"]
        forces = numpy.stack([result.history[c] for c in self.columns], -1)
        if times[0] > 0.0:
            return numpy.append(0.0, times), numpy.vstack([numpy.zeros(forces.shape[1]), forces])
        return times, forces

    def values(self, result: Result) -> Array:
        times, forces = self._curve(result)
        if self.window:
            return measure.running_mean(times, forces, self.window, self.times)
        return measure.interpolate(times, forces, self.times)

    def norm(self, forces: Array) -> float:
        return measure.mean_length(forces, self.weights)

    def error(self, result: Result, reference_values: Array) -> float:
        if self.window:
            return super().error(result, reference_values)
        # At the ends of the run's own steps: what lies between them was not computed, and the jump within the
        # first step of the reference is nobody's fault.
        times, forces = self._curve(result)
        inside = times >= self.times[0] * (1 - 1e-9)
        times, forces = times[inside], forces[inside]
        finest_times, finest = (values[1:] for values in self._curve(self.finest))
        differences = reference_values - measure.interpolate(finest_times, finest, self.times)
        exact = measure.interpolate(finest_times, finest, times) + measure.interpolate(
            self.times, differences, times
        )
        weights = measure.trapezoids(times)
        return measure.mean_length(forces - exact, weights) / measure.mean_length(exact, weights)

    def excess(self, result: Result, reference_values: Array) -> float:
        """Returns the relative difference of the mean force from the reference's; it is positive if elements
        lock."""
        return self.norm(self.values(result)) / self.norm(reference_values) - 1.0


class Energy(Output):
    """Kinetic energy, and what is stored or dissipated, over time. Two meshes share these curves of an
    impact, and not its forces, which ring."""

    name, meaning = "energy", "∫Σ|E − E*| / ∫Σ|E*| over time, of kinetic and of stored or dissipated energy"
    KINETIC = "kinetic_energy"
    OTHERS = ("elastic_energy", "plastic_work", "friction_dissipation")

    def __init__(self, scene: Scene) -> None:
        self.times = numpy.linspace(0.0, scene.end_time, 201)[1:]
        self.weights = measure.trapezoids(self.times)

    def values(self, result: Result) -> Array:
        history = result.history
        curves = [sum(history[name] for name in self.OTHERS)]
        if self.KINETIC in history:
            curves.append(history[self.KINETIC])
        return numpy.stack([numpy.interp(self.times, history["time"], curve) for curve in curves], -1)

    def norm(self, values: Array) -> float:
        sums = numpy.abs(values).sum(axis=1)
        return float(numpy.sum(self.weights * sums) / numpy.sum(self.weights))


class Profile(Output):
    """Logarithmic stretch, or equivalent plastic strain, along a line in the undeformed bodies."""

    name, meaning = "strain", "L2 norm along the line"
    SEGMENTS = 40

    def __init__(self, line: str, kind: str) -> None:
        ends = numpy.array(read_line(line), dtype=float)
        self.kind = kind
        parameters = numpy.linspace(0.0, 1.0, self.SEGMENTS + 1)
        self.places = ends[0] + parameters[:, None] * (ends[1] - ends[0])
        self.weights = numpy.ones(self.SEGMENTS) if kind == "stretch" else measure.trapezoids(parameters)

    def values(self, result: Result) -> Array:
        meshes = result.body_meshes.values()
        if self.kind == "stretch":
            nearest = [
                min(
                    (
                        mesh.at(place, mesh.places, result.fields["displacement"][mesh.points])
                        for mesh in meshes
                    ),
                    key=lambda found: found[1],
                )[0]
                for place in self.places
            ]
            places = numpy.array([n[0] for n in nearest])
            lengths = numpy.linalg.norm(numpy.diff(places, axis=0), axis=1)
            moved = numpy.linalg.norm(
                numpy.diff(places + numpy.array([n[1] for n in nearest]), axis=0), axis=1
            )
            good = lengths > 0
            return numpy.where(
                good, numpy.log(numpy.where(good, moved, 1.0) / numpy.where(good, lengths, 1.0)), 0.0
            )[:, None]
        if "equivalent_plastic_strain" not in result.fields:
            raise UserError("--profile: nothing yields in this scene; 'stretch' does without")
        smooth = {id(mesh): mesh.nodal(result.fields["equivalent_plastic_strain"]) for mesh in meshes}
        return numpy.array(
            [
                min((mesh.at(place, smooth[id(mesh)]) for mesh in meshes), key=lambda found: found[1])[0]
                for place in self.places
            ]
        )

    def norm(self, values: Array) -> float:
        return measure.root_mean_square(values, self.weights)


class Shape(Output):
    """Final places of material points over the bodies' volume: root mean square of the difference, over that
    of the reference's displacements without the rigid motion of each body."""

    name, meaning = (
        "shape",
        "root mean square of the differences of final places over that of the deformation",
    )
    MOST = 1500

    def __init__(self, result: Result) -> None:
        self.places, self.weights = {}, {}
        total = sum(len(mesh.cells) for mesh in result.body_meshes.values())
        stride = max(1, math.ceil(total / self.MOST))
        for body, mesh in result.body_meshes.items():
            self.places[body] = mesh.centres[::stride]
            self.weights[body] = mesh.volumes[::stride]
        self.all_weights = numpy.concatenate(list(self.weights.values()))

    def values(self, result: Result) -> Array:
        found = []
        for body, places in self.places.items():
            mesh = result.body_meshes[body]
            displacement = result.fields["displacement"][mesh.points]
            found += [mesh.at(place, displacement)[0][0] for place in places]
        return numpy.array(found)

    def norm(self, values: Array) -> float:
        return measure.root_mean_square(values, self.all_weights)

    def scale(self, reference_values: Array) -> float:
        deformations, begin = [], 0
        for body, places in self.places.items():
            u = reference_values[begin : begin + len(places)]
            deformations.append(measure.without_rigid_motion(places, u, self.weights[body]))
            begin += len(places)
        deformation = self.norm(numpy.concatenate(deformations))
        return (
            deformation if deformation > 1e-6 * self.norm(reference_values) else self.norm(reference_values)
        )


class Rebound(Output):
    """Mean velocities of the bodies at the end, and those of tools with mass."""

    name, meaning = "rebound", "difference of the bodies' final velocities over these velocities"

    def __init__(self, scene: Scene) -> None:
        self.tools = [name for name in scene.names("Tools") if scene.number(f"Tools/{name}/Motion/Mass") > 0]

    def values(self, result: Result) -> Array:
        found = []
        for mesh in result.body_meshes.values():
            velocity = result.fields["velocity"][mesh.points][mesh.cells].mean(axis=1)
            found.append(numpy.average(velocity, axis=0, weights=mesh.volumes))
        for name in self.tools:
            travel = numpy.stack([result.history[f"{name}.travel_{axis}"][-2:] for axis in "xyz"], -1)
            found.append((travel[1] - travel[0]) / numpy.diff(result.history["time"][-2:]))
        return numpy.array(found)

    def norm(self, values: Array) -> float:
        return measure.root_mean_square(values, numpy.ones(len(values)))
