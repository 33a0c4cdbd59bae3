# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads the output of a run of billet: history, error estimates, fields."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from xml.etree import ElementTree

import numpy
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

Array = NDArray[numpy.float64]
Whole = NDArray[numpy.int64]
Fields = dict[str, Array]
History = dict[str, Array]


def read_rows(file: Path) -> list[dict[str, str]]:
    """Returns the rows of a table in CSV, {column: cell}."""
    with open(file, newline="") as stream:
        return list(csv.DictReader(stream))


def read_numbers(file: Path) -> list[dict[str, float]]:
    """Returns the rows of a table of numbers in CSV, {column: number}."""
    return [{name: float(cell) for name, cell in row.items()} for row in read_rows(file)]


def read_history(file: Path) -> History:
    """Returns {column: array}; a line that was cut off is left out, and nothing is there without a file."""
    try:
        with open(file, newline="") as stream:
            rows = list(csv.reader(stream))
    except OSError:
        return {}
    if len(rows) < 2:
        return {name: numpy.zeros(0) for name in (rows[0] if rows else [])}
    values = numpy.array([[float(v) for v in row] for row in rows[1:] if len(row) == len(rows[0])])
    return dict(zip(rows[0], values.reshape(-1, len(rows[0])).T))


def read_estimates(folder: Path) -> dict[str, float]:
    """Returns {quantity: value} of error_estimate.csv in a folder of results; nothing without one."""
    file = folder / "error_estimate.csv"
    return {row["quantity"]: float(row["value"]) for row in read_rows(file)} if file.exists() else {}


def energies_of(history: History) -> Array:
    """Returns the sum of what is stored and dissipated."""
    kinds = [
        values
        for name, values in history.items()
        if name.endswith(("_energy", "_work", "_dissipation")) and name != "external_work"
    ]
    total: Array = numpy.sum(kinds, axis=0, dtype=float)
    return total


def max_drift(history: History) -> float:
    """Returns that of the energies' balance, as part of the largest sum of energies."""
    if "energy_drift" not in history or not len(history["energy_drift"]):
        return math.nan
    largest = float(numpy.max(numpy.abs(energies_of(history)), initial=0.0))
    return float(numpy.max(numpy.abs(history["energy_drift"]))) / largest if largest > 0 else math.nan


def pictures_of(folder: Path) -> list[Path]:
    """Returns the files of the bodies' fields in a folder of results, in the order of time."""
    return sorted(folder.glob("fields_*.vtm"))


# Corners of a hexahedron in lexicographic order, by their places in VTK's order, and the other way round.
LEXICOGRAPHIC = [0, 1, 3, 2, 4, 5, 7, 6]
SYMMETRIC = ("xx", "yy", "zz", "xy", "yz", "xz")  # VTK's order
FULL = tuple(i + j for i in "xyz" for j in "xyz")


def blocks_of(file: Path, group: str) -> dict[str, Path]:
    """Returns the files of a group of blocks in a .vtm file by their names."""
    return {
        part.attrib["name"]: file.parent / part.attrib["file"]
        for block in ElementTree.parse(file).iter("Block")
        if block.get("name") == group
        for part in block.iter("DataSet")
    }


def components(name: str, values: Array) -> Fields:
    """Returns a tensor's components as fields of their own; any other field as it is."""
    names = {6: SYMMETRIC, 9: FULL}.get(values.shape[1] if values.ndim > 1 else 1)
    return {f"{name}_{n}": values[:, i] for i, n in enumerate(names)} if names else {name: values}


def read_block(file: Path) -> tuple[Fields, Fields, Array, Whole]:
    """Returns the fields of points and of cells of a .vtu file of hexahedra, its points and its cells."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    found: list[Fields] = [{}, {}]
    for fields, data in zip(found, (grid.GetPointData(), grid.GetCellData())):
        for i in range(data.GetNumberOfArrays()):
            values = vtk_to_numpy(data.GetArray(i)).astype(float)
            fields.update(components(data.GetArrayName(i), values))
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    return found[0], found[1], points, vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 8)


def read_grid(file: Path) -> Fields:
    """Returns all fields of the bodies in a .vtm file by name, their `points` and their `cells`. Each element
    has its own copy of its eight corners, one behind the other in lexicographic order, so that fields of
    elements and of nodes have the same length. `node` numbers the nodes that the copies are of."""
    parts: list[Fields] = []
    n_nodes = 0
    for block in blocks_of(file, "Bodies").values():
        of_points, of_cells, points, cells = read_block(block)
        corners = cells[:, LEXICOGRAPHIC].ravel()
        parts.append({name: values[corners] for name, values in of_points.items()})
        parts[-1].update({name: numpy.repeat(values, 8, axis=0) for name, values in of_cells.items()})
        parts[-1]["points"], parts[-1]["node"] = points[corners], (corners + n_nodes).astype(float)
        n_nodes += len(points)
    fields = {name: numpy.concatenate([part[name] for part in parts]) for name in parts[0]}
    first = numpy.arange(0, len(fields["points"]), 8)[:, None]
    fields["cells"] = first + numpy.array(LEXICOGRAPHIC)
    return fields
