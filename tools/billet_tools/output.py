# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a run of billet writes: history, estimates of errors, fields."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader

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
    return sorted(folder.glob("fields_*.pvtu"))


def read_grid(file: Path) -> Fields:
    """Returns all fields of a file .pvtu or .vtu by name, its `points` and its `cells`."""
    reader = vtkXMLPUnstructuredGridReader() if file.suffix == ".pvtu" else vtkXMLUnstructuredGridReader()
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
