# SPDX-License-Identifier: LGPL-2.1-or-later
"""What benchmarks of explicit scenes share: runs, their histories and their last pictures."""

import csv
import subprocess
import sys
from pathlib import Path

import numpy
from vtk import vtkXMLPUnstructuredGridReader
from vtk.util.numpy_support import vtk_to_numpy

from billet_runs import PROGRAM, children_seconds, read_scene, variant


class ExplicitRun:
    """A run in `folder`: `rows` of the history as numbers, `seconds` (user and system, of all ranks), whether
    it `finished`, what was `said`, and `failure`."""

    def __init__(self, scene, changes, folder, ranks=1):
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / "scene.prm").write_text(
            variant(read_scene(scene), {"Output/Folder": "results", "Output/Verbosity": "quiet", **changes})
        )
        command = ([] if ranks == 1 else ["mpirun", "-n", str(ranks)]) + [PROGRAM, "scene.prm"]
        before = children_seconds()
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        self.seconds = children_seconds() - before
        if done.returncode not in (0, 3, 6, 7):
            sys.exit(f"billet ended with {done.returncode}: {done.stderr}")
        self.finished, self.said, self.failure = done.returncode != 3, done.stdout, done.stderr.strip()
        with open(self.folder / "results/history.csv", newline="") as file:
            self.rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        said = ", ".join(f"{key.split('/')[-1]} = {value}" for key, value in changes.items())
        print(f"[{scene.stem}: {said}] {self.steps} steps, {self.seconds:.3g} s", file=sys.stderr, flush=True)

    @property
    def steps(self):
        return int(self.rows[-1]["step"]) if self.rows else 0

    def largest_drift(self):
        """Of the energy ledger, relative to the largest sum of energies."""
        kinds = [
            key
            for key in self.rows[0]
            if key.endswith(("_energy", "_work", "_dissipation")) and key not in ("external_work",)
        ]
        largest = max(sum(row[kind] for kind in kinds) for row in self.rows)
        return max(abs(row["energy_drift"]) for row in self.rows) / largest

    def picture(self, number=-1):
        """Points of a written picture, and its fields by name."""
        file = sorted((self.folder / "results").glob("fields_*.pvtu"))[number]
        reader = vtkXMLPUnstructuredGridReader()
        reader.SetFileName(str(file))
        reader.Update()
        grid = reader.GetOutput()
        data = grid.GetPointData()
        fields = {
            data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)).astype(float)
            for i in range(data.GetNumberOfArrays())
        }
        return vtk_to_numpy(grid.GetPoints().GetData()).astype(float), fields


def norm(vectors, axes):
    return numpy.sqrt(sum(vectors[:, axis] ** 2 for axis in axes))
