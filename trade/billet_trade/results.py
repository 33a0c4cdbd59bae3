# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a run gave, and the outputs whose errors count: tool force, strain profile, final shape, rebound."""

import csv
import math
import re
import shutil
from functools import cached_property

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import reference, vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_HEXAHEDRON,
    vtkGenericCell,
    vtkStaticCellLocator,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader

from . import TradeError, measure
from .records import failure_of, read_records, value_of

FORMAT = 3  # of what is kept; another one makes runs anew
SAMPLES = 2000  # of an explicit history
FACES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def output_settings(scene):
    """What a measured run writes: its history, and fields at the start and the end."""
    changes = {
        "Output/Folder": "results",
        "Output/Format": "vtu",
        "Output/Every steps": 0,
        "Output/Verbosity": "steps",
        "Output/Stress": "false",
    }
    if scene.number("Output/Interval") > 0:
        changes["Output/Interval"] = 0
    for key in ("Every steps", "Interval"):
        if scene.number("Output/Checkpoint/" + key) > 0:
            changes["Output/Checkpoint/" + key] = 0
    if scene.is_explicit:
        changes["Output/History interval"] = f"{scene.end_time / SAMPLES:.9g}"
    return changes


# --- what is kept of a run ------------------------------------------------------------------------


def read_history(file):
    """{column: array}; a line that was cut off is left out."""
    try:
        with open(file, newline="") as stream:
            rows = list(csv.reader(stream))
    except OSError:
        return {}
    if len(rows) < 2:
        return {name: numpy.zeros(0) for name in (rows[0] if rows else [])}
    values = numpy.array([[float(v) for v in row] for row in rows[1:] if len(row) == len(rows[0])])
    return dict(zip(rows[0], values.reshape(-1, len(rows[0])).T))


def largest_drift(history):
    """Of the energies' balance, as part of the largest sum of energies."""
    if "energy_drift" not in history or not len(history["energy_drift"]):
        return math.nan
    kinds = [
        name
        for name in history
        if name.endswith(("_energy", "_work", "_dissipation")) and name != "external_work"
    ]
    total = sum(history[name] for name in kinds)
    largest = float(numpy.max(numpy.abs(total), initial=0.0))
    return float(numpy.max(numpy.abs(history["energy_drift"]))) / largest if largest > 0 else math.nan


def read_grid(file):
    """All fields of a written picture by name, its `points` and its `cells`."""
    reader = vtkXMLPUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    fields = {
        data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)).astype(float)
        for i in range(data.GetNumberOfArrays())
    }
    fields["points"] = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    fields["cells"] = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 8)
    return fields


def read_fields(file):
    arrays = read_grid(file)
    kept = {
        "places": arrays["points"] - arrays["displacement"],
        "displacement": arrays["displacement"],
        "body": arrays["body"],
        "cells": arrays["cells"],
    }
    for name in ("velocity", "equivalent_plastic_strain", "contact_pair"):
        if name in arrays:
            kept[name] = arrays[name]
    return kept


def facet_size(fields):
    """Median edge of the undeformed facets whose nodes belong to a contact pair; NaN without contact."""
    if "contact_pair" not in fields:
        return math.nan
    cells, inside = fields["cells"], fields["contact_pair"] >= 0
    areas = []
    for face in FACES:
        corners = cells[:, face]
        p = fields["places"][corners[inside[corners].all(axis=1)]]
        areas.append(0.5 * numpy.linalg.norm(numpy.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1]), axis=1))
    areas = numpy.concatenate(areas)
    return math.sqrt(float(numpy.median(areas))) if len(areas) else math.nan


# exit codes of runs that came to their end: without complaint, with warnings, beside the target error
COMPLETED = (0, 6, 7)


def failure(code, said, time, error):
    """Status and reason of an exit code, what was said on standard error, and the message that ended the
    run."""
    if code in COMPLETED:
        return "ok", ""
    reason = re.sub(
        r"\s+", " ", re.sub(r"-{40,}.*?-{40,}", "", error.get("message", said), flags=re.DOTALL)
    ).strip()
    reason = re.sub(r"^error\[[\w-]+\]: ", "", reason)
    if code is None:
        return (
            "out of time",
            f"at time {time:.3g}: a longer --time-limit, or a smaller pilot (--mesh, --until), may do",
        )
    if code == 2:
        return "refused", reason
    if code == 3:
        return ("drifted" if error.get("key") == "energy-drift" else "diverged"), reason
    return "crashed", f"exit code {code}: {reason}"


def collect(folder, code, limit):
    """Keeps what counts of a run in `folder` and takes the rest away; returns what is kept as numbers."""
    history = read_history(folder / "results/history.csv")
    times = history.get("time", numpy.zeros(0))
    lengths = history.get("step_length", times)
    lengths = lengths[lengths > 0]

    def last_of(name):
        return history[name][-1] if len(times) and name in history else 0

    last = float(last_of("time"))
    error = failure_of(read_records(folder / "results/diagnostics.jsonl"))
    status, reason = failure(code, (folder / "stderr").read_text(), last, error)
    kept = {
        "status": status,
        "reason": reason[:2000],
        "code": code,
        "limit": limit,
        "time": last,
        "steps": max(int(last_of("step")), int(value_of(error, "steps"))),
        # With those of a step that failed for good, which no history has.
        "newton": max(int(last_of("total_iterations")), int(value_of(error, "Newton iterations"))),
        "cuts": int(last_of("total_cuts")),
        "linear": int(numpy.sum(history.get("linear_iterations", 0))),
        "first_step": float(lengths[0]) if len(lengths) else 0.0,
        "drift": largest_drift(history),
        "penetration": math.nan,
        "facet": math.nan,
        "elements": 0,
    }
    pictures = sorted((folder / "results").glob("fields_*.pvtu"))
    if pictures and status == "ok":
        fields = read_fields(pictures[-1])
        kept["elements"] = len(fields["cells"])
        kept["facet"] = facet_size(fields)
        numpy.savez_compressed(folder / "fields.npz", **fields)
    depths = [numpy.max(v) for name, v in history.items() if name.endswith(".deepest_penetration") and len(v)]
    if depths:
        kept["penetration"] = float(max(depths)) / kept["facet"]
    if history:
        shutil.move(folder / "results/history.csv", folder / "history.csv")
    shutil.rmtree(folder / "results", ignore_errors=True)
    return kept


class Result:
    """A run that has ended, `numbers` as collect() keeps them."""

    def __init__(self, folder, numbers):
        self.folder, self.numbers = folder, numbers

    def __getattr__(self, name):
        try:
            return self.__dict__["numbers"][name]
        except KeyError:
            raise AttributeError(name) from None

    @cached_property
    def history(self):
        return read_history(self.folder / "history.csv")

    @cached_property
    def fields(self):
        with numpy.load(self.folder / "fields.npz") as file:
            return dict(file)

    @cached_property
    def body_meshes(self):
        return {int(body): BodyMesh(self.fields, body) for body in numpy.unique(self.fields["body"])}


class BodyMesh:
    """The undeformed mesh of a body, and fields at places in it."""

    def __init__(self, fields, body):
        cells = fields["cells"][fields["body"][fields["cells"][:, 0]] == body]
        points, cells = numpy.unique(cells, return_inverse=True)
        self.points, self.cells = points, cells.reshape(-1, 8)
        self.places = fields["places"][points]
        self.grid = vtkUnstructuredGrid()
        corners = vtkPoints()
        corners.SetData(numpy_to_vtk(numpy.ascontiguousarray(self.places), deep=True))
        self.grid.SetPoints(corners)
        self.grid.Allocate(len(self.cells))
        for cell in self.cells:
            self.grid.InsertNextCell(VTK_HEXAHEDRON, 8, cell.tolist())
        self.locator = vtkStaticCellLocator()
        self.locator.SetDataSet(self.grid)
        self.locator.BuildLocator()

    @cached_property
    def centres(self):
        return self.places[self.cells].mean(axis=1)

    @cached_property
    def volumes(self):
        """By the diagonals: exact for parallelepipeds, and no more than a weight here."""
        p = self.places[self.cells]
        edges = [
            p[:, [1, 2, 5, 6]].mean(1) - p[:, [0, 3, 4, 7]].mean(1),
            p[:, [2, 3, 6, 7]].mean(1) - p[:, [0, 1, 4, 5]].mean(1),
            p[:, [4, 5, 6, 7]].mean(1) - p[:, [0, 1, 2, 3]].mean(1),
        ]
        return numpy.abs(numpy.einsum("ij,ij->i", edges[0], numpy.cross(edges[1], edges[2])))

    def nodal(self, values):
        """Means of what elements have, at the nodes that they share."""
        scale = max(1e-300, float(numpy.ptp(self.places, axis=0).max()))
        _, node = numpy.unique(numpy.round(self.places / scale, 6), axis=0, return_inverse=True)
        node = node.ravel()
        return (numpy.bincount(node, values[self.points]) / numpy.bincount(node))[node]

    def at(self, place, *fields):
        """Values at the point of the body that is nearest to the place, of fields by its own points; and the
        distance."""
        cell, sub, distance = reference(0), reference(0), reference(0.0)
        nearest, pcoords, weights = [0.0] * 3, [0.0] * 3, [0.0] * 8
        self.locator.FindClosestPoint(place, nearest, vtkGenericCell(), cell, sub, distance)
        self.grid.GetCell(int(cell)).EvaluatePosition(
            nearest, [0.0] * 3, sub, pcoords, reference(0.0), weights
        )
        corners = self.cells[int(cell)]
        return [numpy.tensordot(weights, f[corners], 1) for f in fields], math.sqrt(max(0.0, float(distance)))


# --- outputs --------------------------------------------------------------------------------------


class Output:
    """An output of a run as an array of vectors, with a norm. `values` are those that the reference
    extrapolates."""

    def error(self, result, reference_values):
        """Relative to the reference's own size."""
        return self.norm(self.values(result) - reference_values) / self.scale(reference_values)

    def scale(self, reference_values):
        return self.norm(reference_values)


class Force(Output):
    """Forces of tools, or of contact pairs of bodies where there are no tools: ∫|F − F*| / ∫|F*| over time,
    at the ends of steps. Explicit histories, which ring, by running means.

    What the reference extrapolates are curves at the ends of the centre's steps. Between them it goes as the
    `finest` run does, by whose difference from it, which has hardly any corners, it is carried over: curves
    have corners, which no interpolation of long steps can tell (Roache and Knupp 1993, completed
    extrapolation)."""

    name, meaning = "force", "∫|F − F*| / ∫|F*| over time"

    def __init__(self, result, scene, columns, window, finest=None):
        self.columns = columns or self.all_forces(result, scene)
        self.finest = finest or result
        for column in self.columns:
            if column not in result.history:
                have = sorted(c for c in result.history if ".force_" in c)
                raise TradeError(
                    f"--force: the history has no column '{column}'; it has"
                    f" {', '.join(have) or 'no force at all'}"
                )
        self.window = window * scene.end_time if scene.is_explicit else 0.0
        self.times = (
            numpy.linspace(0.0, scene.end_time, 201)[1:] if self.window else self._curve(result)[0][1:]
        )
        self.weights = measure.trapezoids(self.times)

    @staticmethod
    def all_forces(result, scene):
        found = [c for name in scene.names("Tools") for c in result.history if c.startswith(f"{name}.force_")]
        return found or [c for c in result.history if ".force_" in c]

    def _curve(self, result):
        """As the history has it, from a force of zero at time zero on."""
        times = result.history["time"]
        forces = numpy.stack([result.history[c] for c in self.columns], -1)
        if times[0] > 0.0:
            return numpy.append(0.0, times), numpy.vstack([numpy.zeros(forces.shape[1]), forces])
        return times, forces

    def values(self, result):
        times, forces = self._curve(result)
        if self.window:
            return measure.running_mean(times, forces, self.window, self.times)
        return measure.interpolate(times, forces, self.times)

    def norm(self, forces):
        return measure.mean_length(forces, self.weights)

    def error(self, result, reference_values):
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
        weights = measure.trapezoids(times) if len(times) > 1 else numpy.ones(1)
        return measure.mean_length(forces - exact, weights) / measure.mean_length(exact, weights)

    def excess(self, result, reference_values):
        """How much larger the mean force is than the reference's, as part of it: what locking shows in."""
        return self.norm(self.values(result)) / self.norm(reference_values) - 1.0


class Profile(Output):
    """Along a line in the undeformed bodies: the logarithmic stretch along it, or the equivalent plastic
    strain."""

    name, meaning = "strain", "L2 norm along the line"
    SEGMENTS = 40

    def __init__(self, line, kind):
        numbers = re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", line)
        if len(numbers) != 6 or " to " not in line:
            raise TradeError(f"--line: found '{line}', allowed is 'x, y, z to x, y, z'")
        ends = numpy.array(numbers, dtype=float).reshape(2, 3)
        if not numpy.linalg.norm(ends[1] - ends[0]) > 0:
            raise TradeError(f"--line: found '{line}', allowed are two different points")
        self.kind = kind
        parameters = numpy.linspace(0.0, 1.0, self.SEGMENTS + 1)
        self.places = ends[0] + parameters[:, None] * (ends[1] - ends[0])
        self.weights = numpy.ones(self.SEGMENTS) if kind == "stretch" else measure.trapezoids(parameters)

    def values(self, result):
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
            raise TradeError("--profile: nothing yields in this scene; 'stretch' does without")
        smooth = {id(mesh): mesh.nodal(result.fields["equivalent_plastic_strain"]) for mesh in meshes}
        return numpy.array(
            [
                min((mesh.at(place, smooth[id(mesh)]) for mesh in meshes), key=lambda found: found[1])[0]
                for place in self.places
            ]
        )

    def norm(self, values):
        return measure.root_mean_square(values, self.weights)


class Shape(Output):
    """Final places of material points over the bodies' volume: root mean square of the difference, over that
    of the reference's displacements without the rigid motion of each body."""

    name, meaning = (
        "shape",
        "root mean square of the differences of final places over that of the deformation",
    )
    MOST = 1500

    def __init__(self, result):
        self.places, self.weights = {}, {}
        total = sum(len(mesh.cells) for mesh in result.body_meshes.values())
        stride = max(1, math.ceil(total / self.MOST))
        for body, mesh in result.body_meshes.items():
            self.places[body] = mesh.centres[::stride]
            self.weights[body] = mesh.volumes[::stride]
        self.all_weights = numpy.concatenate(list(self.weights.values()))

    def values(self, result):
        found = []
        for body, places in self.places.items():
            mesh = result.body_meshes[body]
            displacement = result.fields["displacement"][mesh.points]
            found += [mesh.at(place, displacement)[0][0] for place in places]
        return numpy.array(found)

    def norm(self, values):
        return measure.root_mean_square(values, self.all_weights)

    def scale(self, reference_values):
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

    def __init__(self, result, scene):
        self.tools = [name for name in scene.names("Tools") if scene.number(f"Tools/{name}/Motion/Mass") > 0]

    def values(self, result):
        found = []
        for mesh in result.body_meshes.values():
            velocity = result.fields["velocity"][mesh.points][mesh.cells].mean(axis=1)
            found.append(numpy.average(velocity, axis=0, weights=mesh.volumes))
        for name in self.tools:
            travel = numpy.stack([result.history[f"{name}.travel_{axis}"][-2:] for axis in "xyz"], -1)
            found.append((travel[1] - travel[0]) / numpy.diff(result.history["time"][-2:]))
        return numpy.array(found)

    def norm(self, values):
        return measure.root_mean_square(values, numpy.ones(len(values)))
