# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results of a run as they are kept: numbers, history and fields."""

from __future__ import annotations

import math
import re
import shutil
from functools import cached_property
from pathlib import Path
from typing import Any, Mapping

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import reference, vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_HEXAHEDRON,
    vtkGenericCell,
    vtkStaticCellLocator,
    vtkUnstructuredGrid,
)

from ..output import Array, Fields, History, max_drift, pictures_of, read_estimates, read_grid, read_history
from ..program import COMPLETED
from ..records import Record, failure_of, read_records, value_of
from ..scene import Changes, Scene

FORMAT = 3  # of what is kept; another one makes runs anew
SAMPLES = 2000  # of an explicit history
FACES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def output_settings(scene: Scene) -> Changes:
    """Returns the output settings of a measured run: its history, and fields at the start and the end."""
    changes = {
        "Output/Folder": "results",
        "Output/Format": "vtu",
        "Output/Step interval": 0,
        "Output/Verbosity": "steps",
        "Output/Stress": "false",
    }
    if scene.number("Output/Interval") > 0:
        changes["Output/Interval"] = 0
    for key in ("Step interval", "Interval"):
        if scene.number("Output/Checkpoint/" + key) > 0:
            changes["Output/Checkpoint/" + key] = 0
    if scene.is_explicit:
        changes["Output/History interval"] = f"{scene.end_time / SAMPLES:.9g}"
    return changes


# --- what is kept of a run ------------------------------------------------------------------------


def read_fields(file: Path) -> Fields:
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


def facet_size(fields: Fields) -> float:
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


def failure(code: int | None, said: str, time: float, error: Record) -> tuple[str, str]:
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


def collect(folder: Path, code: int | None, limit: float) -> dict[str, Any]:
    """Keeps what counts of a run in `folder` and takes the rest away; returns what is kept as numbers."""
    history = read_history(folder / "results/history.csv")
    times = history.get("time", numpy.zeros(0))
    lengths = history.get("step_length", times)
    lengths = lengths[lengths > 0]

    def last_of(name: str) -> float:
        return float(history[name][-1]) if len(times) and name in history else 0.0

    last = last_of("time")
    error = failure_of(read_records(folder / "results/diagnostics.jsonl"))
    status, reason = failure(code, (folder / "stderr").read_text(), last, error)
    kept: dict[str, Any] = {
        "status": status,
        "reason": reason[:2000],
        "code": code,
        "limit": limit,
        "time": last,
        "steps": max(int(last_of("step")), int(value_of(error, "steps"))),
        # They include those of a step that failed for good, which no history has.
        "newton": max(int(last_of("total_iterations")), int(value_of(error, "Newton iterations"))),
        "cuts": int(last_of("total_cuts")),
        "linear": int(numpy.sum(history.get("linear_iterations", 0))),
        "first_step": float(lengths[0]) if len(lengths) else 0.0,
        "drift": max_drift(history),
        "penetration": math.nan,
        "facet": math.nan,
        "elements": 0,
    }
    pictures = pictures_of(folder / "results")
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
    if (folder / "results/error_estimate.csv").exists():
        shutil.move(folder / "results/error_estimate.csv", folder / "error_estimate.csv")
    kept["coarser_work"] = sum(map(level_work, sorted((folder / "results").glob("mesh_level_*"))))
    shutil.rmtree(folder / "results", ignore_errors=True)
    return kept


def level_work(folder: Path) -> float:
    """Work of a coarser level of the mesh that a target error of everything ran first: elements times
    iterations, or steps in explicit scenes."""
    history = read_history(folder / "history.csv")
    pictures = pictures_of(folder)
    if not pictures or not len(history.get("time", ())):
        return 0.0
    last = {name: float(history[name][-1]) for name in ("step", "total_iterations") if name in history}
    iterations = last.get("total_iterations", 0.0) + float(numpy.sum(history.get("linear_iterations", 0)))
    return len(read_grid(pictures[-1])["cells"]) * (iterations or last.get("step", 0.0))


class Result:
    """A run that has ended, as collect() keeps it."""

    status: str  # 'ok', or what became of it
    reason: str
    code: int | None  # None: out of time
    limit: float  # [s]
    time: float  # at which it ended
    steps: int
    newton: int  # iterations
    linear: int  # iterations of the linear solver
    cuts: int
    elements: int
    first_step: float
    drift: float  # of the energies' balance; NaN where there is none
    penetration: float  # the deepest [facet sizes]; NaN without contact
    facet: float  # its size
    seconds: list[float]  # of all cores, each time that it was timed
    core_seconds: float  # their median
    clock: float  # [s]
    coarser_work: float = 0.0  # on coarser levels of the mesh, before this one

    def __init__(self, folder: Path, numbers: Mapping[str, Any]) -> None:
        self.folder = folder
        vars(self).update(numbers)

    @cached_property
    def history(self) -> History:
        return read_history(self.folder / "history.csv")

    def depths(self, begin: float) -> dict[str, float]:
        """Returns the maximum penetration from a time on in facet sizes, by its column."""
        rows = self.history["time"] >= begin * (1.0 - 1e-9)
        columns = [name for name in self.history if name.endswith(".deepest_penetration")]
        return {n: float(numpy.max(self.history[n][rows])) / self.facet for n in columns if rows.any()}

    @cached_property
    def estimates(self) -> dict[str, float]:
        """{source: error} as the run itself estimates them, among 'mesh', 'steps', 'penetrations' and
        'iterations'."""
        of_run = read_estimates(self.folder)
        found = {name: of_run[name] for name in ("steps", "penetrations", "iterations") if name in of_run}
        mesh = self.history.get("mesh_error", numpy.zeros(0))
        if len(mesh) and numpy.isfinite(mesh[-1]) and mesh[-1] > 0:
            found = {"mesh": float(mesh[-1]), **found}
        return found

    @cached_property
    def fields(self) -> Fields:
        with numpy.load(self.folder / "fields.npz") as file:
            return dict(file)

    @cached_property
    def body_meshes(self) -> dict[int, BodyMesh]:
        return {int(body): BodyMesh(self.fields, body) for body in numpy.unique(self.fields["body"])}


class BodyMesh:
    """The undeformed mesh of a body, and fields at places in it."""

    def __init__(self, fields: Fields, body: float) -> None:
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
    def centres(self) -> Array:
        centres: Array = self.places[self.cells].mean(axis=1)
        return centres

    @cached_property
    def volumes(self) -> Array:
        """Returns volumes by the diagonals: exact for parallelepipeds, and otherwise good enough for
        weights."""
        p = self.places[self.cells]
        edges = [
            p[:, [1, 2, 5, 6]].mean(1) - p[:, [0, 3, 4, 7]].mean(1),
            p[:, [2, 3, 6, 7]].mean(1) - p[:, [0, 1, 4, 5]].mean(1),
            p[:, [4, 5, 6, 7]].mean(1) - p[:, [0, 1, 2, 3]].mean(1),
        ]
        volumes: Array = numpy.abs(numpy.einsum("ij,ij->i", edges[0], numpy.cross(edges[1], edges[2])))
        return volumes

    def nodal(self, values: Array) -> Array:
        """Means of what elements have, at the nodes that they share."""
        scale = max(1e-300, float(numpy.ptp(self.places, axis=0).max()))
        _, node = numpy.unique(numpy.round(self.places / scale, 6), axis=0, return_inverse=True)
        node = node.ravel()
        means: Array = numpy.bincount(node, values[self.points]) / numpy.bincount(node)
        return means[node]

    def at(self, place: Array, *fields: Array) -> tuple[list[Array], float]:
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
