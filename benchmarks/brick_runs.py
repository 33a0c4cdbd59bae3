# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shared parts of the benchmarks of elements: meshes of bricks, runs of one body, parts of its scene."""

from __future__ import annotations

import math
import signal
import sys
import tempfile
from pathlib import Path
from typing import Callable, Iterator, Sequence

import numpy

from billet_runs import PROGRAM, Changes, Measured, variant
from billet_tools.output import Array, Fields, pictures_of, read_grid, read_numbers
from billet_tools.records import read_records, warnings_of

Picture = tuple[Array, Array, Fields]  # where nodes are, where they were, all fields

ELEMENTS = ("assumed strain", "mean dilatation", "one point")
AS, MD, OP = ELEMENTS
STIFF, SOFT = "element-too-stiff", "element-too-soft"
ABOUT_ELEMENTS = {
    STIFF,
    SOFT,
    "plastic-bending-coarse",
    "inverted-corners",
    "inverted-at-end",
    "inverted-elements",
    "coarse-on-tool",
    "lumped-inertia",
}
E, NU = 1e5, 0.3  # unless a scene says otherwise


class Bricks:
    """A grid over x, y, z as a mesh of bricks; boundary ids 1 to 6 at both ends along x, y and z. `place`
    moves its points, rows of x, y, z."""

    def __init__(
        self,
        x: Sequence[float] | Array,
        y: Sequence[float] | Array,
        z: Sequence[float] | Array,
        place: Callable[..., Sequence[Array]] | None = None,
    ) -> None:
        counts = len(x), len(y), len(z)
        numbers = numpy.arange(math.prod(counts)).reshape(counts[::-1]).transpose()  # [i, j, k]
        self.points = numpy.array([(a, b, c) for c in z for b in y for a in x], float)
        if place:
            self.points = numpy.column_stack(place(*self.points.T))
            self.points[abs(self.points) < 1e-12] = 0.0
        self.n, square = len(self.points), ((0, 0), (1, 0), (1, 1), (0, 1))
        self.cells = [
            [numbers[i + a, j + b, k + c] for c in (0, 1) for a, b in square]
            for k in range(counts[2] - 1)
            for j in range(counts[1] - 1)
            for i in range(counts[0] - 1)
        ]
        self.faces = []
        for axis in range(3):
            for side in (0, 1):
                layer = numpy.take(numbers, -side, axis)
                self.faces += [
                    (2 * axis + side + 1, [layer[p + a, q + b] for a, b in square])
                    for p in range(layer.shape[0] - 1)
                    for q in range(layer.shape[1] - 1)
                ]

    def rename(self, old: int, new: int, condition: Callable[..., bool]) -> None:
        """Another id for the faces of this one whose centre fulfils a condition."""
        self.faces = [
            (new if kind == old and condition(*self.points[face].mean(axis=0)) else kind, face)
            for kind, face in self.faces
        ]

    def add_handle(self, kind: int, corner: Sequence[float], size: Sequence[float], across: int = 2) -> None:
        """A brick from `corner` by `size` that shares an edge or a corner with the grid, and no more. Its
        face across an axis through `corner` gets the id: held by that, the handle moves as a rigid body, and
        holds what it shares."""
        cell = []
        for c in (0, 1):
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                point = numpy.array(corner) + numpy.array(size) * (a, b, c)
                near = numpy.flatnonzero(abs(self.points[: self.n] - point).max(axis=1) < 1e-9)
                cell.append(near[0] if len(near) else len(self.points))
                if not len(near):
                    self.points = numpy.vstack([self.points, point])
        self.faces.append((kind, [cell[i] for i in ((0, 4, 7, 3), (0, 1, 5, 4), (0, 1, 2, 3))[across]]))
        self.cells.append(cell if math.prod(size) > 0 else cell[4:] + cell[:4])

    def write(self, path: str | Path) -> None:
        def elements() -> Iterator[str]:
            for kind, face in self.faces:
                yield f"3 2 {kind} {kind} " + " ".join(str(node + 1) for node in face)
            for cell in self.cells:
                yield "5 2 0 0 " + " ".join(str(node + 1) for node in cell)

        with open(path, "w") as out:
            out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(self.points)}\n")
            out.writelines(f"{i + 1} {x!r} {y!r} {z!r}\n" for i, (x, y, z) in enumerate(self.points.tolist()))
            out.write(f"$EndNodes\n$Elements\n{len(self.faces) + len(self.cells)}\n")
            out.writelines(f"{i + 1} {text}\n" for i, text in enumerate(elements()))
            out.write("$EndElements\n")


class Solution:
    """A run: its `rows`, `warnings` about elements, the `work` done on the body; `moved` and `start`,
    positions of the nodes and where they were, with their `fields`, in each picture (in single precision), if
    there are `pictures`. `failure` is empty if it ended; after `limit` seconds of a processor the system ends
    it. `keys`: all its warnings. `keep`: where mesh and scene stay."""

    law = "Hencky"  # where none is given

    def __init__(
        self,
        label: str,
        mesh: Bricks,
        element: str,
        changes: Changes,
        law: str | None = None,
        modulus: float = E,
        nu: float = NU,
        steps: int | None = 1,
        pictures: bool = False,
        limit: int | None = None,
        keep: Path | None = None,
    ) -> None:
        body, material = "Bodies/body/", "Bodies/body/Material/"
        scene = {
            body + "Mesh/Source": "file",
            body + "Mesh/File": "mesh.msh",
            body + "Element": element,
            material + "Law": "elastic",
            material + "Elasticity": law or Solution.law,
            material + "Young modulus": repr(modulus),
            material + "Poisson ratio": repr(nu),
            "Solver/Force tolerance": 1e-6,
            "Solver/Energy tolerance": 1e-10,
            "Solver/Linear solver": "MUMPS",
            "Output/Format": "vtu" if pictures else "none",
            "Output/Step interval": 0,
            "Output/Verbosity": "quiet",
        }
        if steps:
            scene.update(
                {"Time stepping/Step control": "fixed", "Time stepping/Initial step": repr(1 / steps)}
            )
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(keep or temporary)
            folder.mkdir(parents=True, exist_ok=True)
            mesh.write(folder / "mesh.msh")
            (folder / "scene.prm").write_text(variant("", {**scene, **changes}))
            done = Measured([PROGRAM, "scene.prm"], folder, limit)
            if done.code not in (0, 3, *((-signal.SIGXCPU, -signal.SIGKILL) if limit else ())):
                sys.exit(f"billet ended with {done.code}: {done.stderr}")
            self.rows = read_numbers(folder / "results/history.csv")
            records = read_records(folder / "results/diagnostics.jsonl")
            self.pictures = [self.read(file) for file in pictures_of(folder / "results")] if pictures else []
        self.failure = "it takes too long" if done.code < 0 else done.stderr.strip() if done.code else ""
        self.keys = warnings_of(records)
        self.warnings = sorted(set(self.keys) & ABOUT_ELEMENTS)
        self.seconds = done.seconds
        self.work = self.rows[-1]["external_work"] if self.rows else math.nan
        print(
            f"[{label}, {element}] {done.seconds:.3g} s{', failed' if self.failure else ''}",
            file=sys.stderr,
            flush=True,
        )

    @staticmethod
    def read(file: Path) -> Picture:
        fields = read_grid(file)
        return fields["points"], fields["points"] - fields["displacement"], fields

    def where(self, point: Sequence[float], picture: int = -1) -> Array:
        """Returns the current place of the node that was at this point."""
        moved, start, _ = self.pictures[picture]
        return moved[abs(start - numpy.array(point)).max(axis=1).argmin()]

    def slope(self, length: float = 1.0) -> float:
        """Work per path in the last step; `length` is the path of all of the run."""
        last, before = self.rows[-1], self.rows[-2]
        return (last["external_work"] - before["external_work"]) / (last["time"] - before["time"]) / length


def held(name: str, kind: object, components: str, displacement: str | None = None) -> dict[str, object]:
    path = f"Bodies/body/Supports/{name}/"
    return {
        path + "Boundary ids": kind,
        path + "Components": components,
        **({path + "Displacement": displacement} if displacement else {}),
    }


def planes(text: str) -> dict[str, object]:
    return {"Bodies/body/Symmetry planes": text}


def plastic(yield_stress: float, hardening: float = 0.0) -> dict[str, str]:
    return {
        "Bodies/body/Material/Law": "elastoplastic",
        "Bodies/body/Material/Yield stress": repr(yield_stress),
        "Bodies/body/Material/Hardening modulus": repr(hardening),
    }


def signed(error: float) -> str:
    value = 100 * error
    return f"{value:+.{2 if abs(value) < 10 else 1 if abs(value) < 100 else 0}f}"
