# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shared parts of the comparisons with CalculiX: billet's mesh from its own output, decks, runs of
CalculiX."""

from __future__ import annotations

import copy
import math
import os
import re
import signal
import tempfile
from pathlib import Path
from typing import Any, Callable, Sequence

import numpy

from billet_runs import Changes, Measured
from billet_tools.output import Array, blocks_of, read_block
from explicit_runs import ExplicitRun

Node = tuple[float, ...]  # x, y, z
Brick = list[int]  # numbers of its nodes
Midpoint = Callable[[Node, Node], Node]

NODES, FACES_CONTACT = "NODE TO SURFACE", "SURFACE TO SURFACE"

CCX_ENVIRONMENT = {
    **os.environ,
    "OMP_NUM_THREADS": "1",
    "CCX_NPROC_EQUATION_SOLVER": "1",
    "CCX_NPROC_RESULTS": "1",
    "NUMBER_OF_CPUS": "1",
}
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
FACES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))  # S1 ... S6


def read_bodies(file: Path, digits: int) -> tuple[list[Node], list[list[Brick]]]:
    """Nodes, and the bricks (in VTK's order, which is Abaqus', too) of each body, of the fields that billet
    writes at time 0, to so many decimals."""
    nodes: list[Node] = []
    bodies: list[list[Brick]] = []
    for block in blocks_of(file, "Bodies").values():
        _, _, points, cells = read_block(block)
        bodies.append((cells + len(nodes)).tolist())
        nodes += [tuple(place) for place in points.round(digits).tolist()]
    return nodes, bodies


def read_bricks(file: Path, digits: int) -> tuple[list[Node], list[Brick]]:
    """The same of all bodies together."""
    nodes, bodies = read_bodies(file, digits)
    return nodes, [brick for bricks in bodies for brick in bricks]


class CcxJob:
    """A run of `deck.inp` in `folder`, of so many seconds of a processor at most: `seconds`, `megabytes`,
    `iterations` (with those of cut increments), `steps`, `cuts`, the `time` until which it has come, and
    `failure`: why not farther."""

    def __init__(self, folder: str | Path, end: float, limit: int | None = None) -> None:
        def records(name: str) -> list[list[str]]:
            path = Path(folder, name)
            lines = [line.split() for line in path.read_text().splitlines()] if path.exists() else []
            return [words for words in lines if words and words[0].isdigit()]

        done = Measured(["ccx", "deck"], folder, limit, environment=CCX_ENVIRONMENT)
        self.seconds, self.megabytes = done.seconds, done.megabytes
        increments = records("deck.sta")
        self.iterations = len(records("deck.cvg"))
        self.cuts = sum(words[2].endswith("U") for words in increments)
        accepted = [words for words in increments if not words[2].endswith("U")]
        self.steps = len(accepted)
        self.time = float(accepted[-1][4]) if accepted else 0.0
        said = [line.strip() for line in (done.stdout + done.stderr).splitlines() if "*ERROR" in line]
        self.failure = (
            ""
            if self.time > end * (1 - 1e-6)
            else (
                f"{limit} s are over"
                if limit and done.code in (-signal.SIGXCPU, -signal.SIGKILL)
                else re.sub(r"\s+", " ", said[0])
                if said
                else f"ends with code {done.code}"
            )
        )


TOTALS = ["*NODE PRINT, NSET=HELD, TOTALS=ONLY", "RF"]
NODAL = ["*NODE PRINT, NSET=HELD", "RF"]

Motion = dict[tuple[Any, int], float]  # {(set or node, component): displacement}


_meshes: dict[str, tuple[list[Node], list[list[Brick]]]] = {}  # as they are asked for again and again


def read_scene_mesh(scene: Path, changes: Changes, digits: int) -> tuple[list[Node], list[list[Brick]]]:
    """Returns the mesh of a scene with changes, from the fields that billet writes at time 0."""
    begin = {
        **changes,
        "Time stepping/End time": 1e-3,
        "Time stepping/Initial step": 1e-3,
        "Time stepping/Stops": "",
    }
    key = f"{scene} {begin} {digits}"
    if key not in _meshes:
        with tempfile.TemporaryDirectory() as folder:
            ExplicitRun(scene, begin, folder)
            _meshes[key] = read_bodies(Path(folder, "results/fields_00000.vtm"), digits)
    return copy.deepcopy(_meshes[key])


def straight(a: Node, b: Node) -> Node:
    return tuple(0.5 * (x + y) for x, y in zip(a, b))


class Deck:
    """A scene in CalculiX's words: the mesh, sets by conditions on nodes, contact pairs, steps."""

    def __init__(
        self,
        scene: Path,
        materials: Sequence[tuple[Any, ...]],
        digits: int = 5,
        turn: Array | None = None,
        plates: Sequence[tuple[Sequence[float], Sequence[float]]] = (),
        changes: Changes | None = None,
        midpoint: Midpoint = straight,
    ) -> None:
        """`materials` of each body: element, Young's modulus, Poisson's ratio, and yield stresses over
        plastic strains, if any. `plates`, which replace plane tools, are bricks between two corners, the last
        bodies. Elements of 20 nodes get one between the ends of each edge, by `midpoint`."""
        self.nodes, self.bodies = read_scene_mesh(scene, changes or {}, digits)
        if turn is not None:
            self.nodes = [tuple(turn @ numpy.array(node)) for node in self.nodes]
        for (x0, y0, z0), (x1, y1, z1) in plates:
            self.bodies.append([[len(self.nodes) + i for i in range(8)]])
            self.nodes += [(x, y, z) for z in (z0, z1) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
        self.pairs: list[tuple[str, str, float | None]] = [("SLAVE", "MASTER", None)]
        self.materials = materials
        for body, (element, *_) in enumerate(materials):
            if element.startswith("C3D20"):
                self._add_midpoints(body, midpoint)
        self.sizes: dict[str, tuple[int, float]] = {}
        self.lines: list[str] = []
        self.steps: list[tuple[float, float, float, Motion, Sequence[str]]] = []
        self.numbers, last = [], 0
        for bricks in self.bodies:
            self.numbers.append(range(last + 1, last + 1 + len(bricks)))
            last += len(bricks)

    def _add_midpoints(self, body: int, midpoint: Midpoint) -> None:
        found: dict[tuple[int, int], int] = {}
        for brick in self.bodies[body]:
            for a, b in EDGES:
                edge = min(brick[a], brick[b]), max(brick[a], brick[b])
                if edge not in found:
                    found[edge] = len(self.nodes)
                    self.nodes.append(midpoint(self.nodes[edge[0]], self.nodes[edge[1]]))
                brick.append(found[edge])

    def members(self, body: int, condition: Callable[..., bool]) -> list[int]:
        used = sorted({corner for brick in self.bodies[body] for corner in brick})
        return [i for i in used if condition(*self.nodes[i])]

    def node_set(self, name: str, members: Sequence[int]) -> Sequence[int]:
        self.lines += [f"*NSET, NSET={name}"]
        self.lines += [", ".join(str(m + 1) for m in members[i : i + 12]) for i in range(0, len(members), 12)]
        return members

    def faces(self, body: int, condition: Callable[..., bool]) -> list[tuple[int, int, list[int]]]:
        """Returns the outer faces of the body all of whose corners are so: number of the element, number of
        its side, and corners."""
        count: dict[tuple[int, ...], int] = {}
        for brick in self.bodies[body]:
            for face in FACES:
                key = tuple(sorted(brick[i] for i in face))
                count[key] = count.get(key, 0) + 1
        found = []
        for number_, brick in zip(self.numbers[body], self.bodies[body]):
            for side, face in enumerate(FACES, 1):
                corners = [brick[i] for i in face]
                if count[tuple(sorted(corners))] == 1 and all(condition(*self.nodes[c]) for c in corners):
                    found.append((number_, side, corners))
        return found

    def area(self, corners: Sequence[int]) -> float:
        a, b, c, d = (numpy.array(self.nodes[corner]) for corner in corners)
        return 0.5 * float(numpy.linalg.norm(numpy.cross(c - a, d - b)))

    def surface(self, name: str, body: int, condition: Callable[..., bool]) -> None:
        found = self.faces(body, condition)
        self.lines += [f"*SURFACE, NAME={name}"] + [f"{number_}, S{side}" for number_, side, _ in found]
        areas = [self.area(corners) for _, _, corners in found]
        self.sizes[name] = (body, math.sqrt(sum(areas) / len(areas)))

    def pressure(self, body: int, condition: Callable[..., bool], value: float) -> list[str]:
        """Returns the lines of a pressure on outer faces, which follows them."""
        found = self.faces(body, condition)
        return ["*DLOAD"] + [f"{number_}, P{side}, {value:.9g}" for number_, side, _ in found]

    def traction(self, body: int, condition: Callable[..., bool], axis: int, value: float) -> list[str]:
        """Returns the lines of a dead traction on outer faces, as consistent forces on their nodes."""
        forces: dict[int, float] = {}
        for number_, _, corners in self.faces(body, condition):
            brick = self.bodies[body][number_ - self.numbers[body][0]]
            total = value * self.area(corners)
            if len(brick) == 8:
                shares = [(corner, 1 / 4) for corner in corners]
            else:
                middles = [
                    brick[8 + i]
                    for i, (a, b) in enumerate(EDGES)
                    if brick[a] in corners and brick[b] in corners
                ]
                shares = [(c, -1 / 12) for c in corners] + [(m, 1 / 3) for m in middles]
            for node, share in shares:
                forces[node] = forces.get(node, 0.0) + share * total
        return ["*CLOAD"] + [f"{node + 1}, {axis}, {force:.9g}" for node, force in forces.items()]

    def penalty(self) -> float:
        """Returns billet's own: ten times E/h of both sides in series, h the root of the faces' mean area."""
        return 10.0 / sum(size / self.materials[body][1] for body, size in self.sizes.values())

    def hold(self, name: str, members: Sequence[int], *components: int) -> None:
        """Fixes components of nodes for the whole run."""
        self.node_set(name, members)
        self.lines += ["*BOUNDARY"] + [f"{name}, {i}, {i}" for i in components]

    def step(
        self, period: float, first: float, largest: float, motion: Motion, loads: Sequence[str] = ()
    ) -> None:
        """Displacements {(set or node, component): value} at the end; between, they go straight. So do loads,
        lines of the deck."""
        self.steps.append((period, first, largest, motion, loads))

    def write(
        self,
        path: str | Path,
        contact: str,
        friction: float,
        penalty: float,
        prints: Sequence[str],
        shorter: int = 1,
    ) -> float:
        lines = ["*NODE, NSET=ALL"]
        lines += [f"{i + 1}, {x:.7g}, {y:.7g}, {z:.7g}" for i, (x, y, z) in enumerate(self.nodes)]
        for body, bricks in enumerate(self.bodies):
            lines += [f"*ELEMENT, TYPE={self.materials[body][0]}, ELSET=BODY{body}"]
            for i, brick in zip(self.numbers[body], bricks):
                words = [str(v) for v in [i] + [c + 1 for c in brick]]
                lines += [", ".join(words[:15]) + ("," if words[15:] else "")]
                lines += [", ".join(words[15:])] if words[15:] else []
        lines += self.lines
        for body, (_, young, poisson, *plastic) in enumerate(self.materials):
            lines += [f"*MATERIAL, NAME=MATERIAL{body}", "*ELASTIC", f"{young}, {poisson}"]
            # With plasticity, though it never yields, elasticity is one of large strain; without,
            # Saint-Venant and Kirchhoff's, which grows soft in compression.
            lines += ["*PLASTIC"] + [
                f"{stress:g}, {strain:g}"
                for stress, strain in plastic or ((1e3 * young, 0), (2e3 * young, 1))
            ]
            lines += [f"*SOLID SECTION, ELSET=BODY{body}, MATERIAL=MATERIAL{body}"]
        for i, (slave, master, own_penalty) in enumerate(self.pairs):
            lines += [
                f"*SURFACE INTERACTION, NAME=TOUCH{i}",
                "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
                f"{own_penalty or penalty:.6g}",
            ]
            lines += ["*FRICTION", f"{friction}, {penalty:.6g}"] if friction else []
            lines += [f"*CONTACT PAIR, INTERACTION=TOUCH{i}, TYPE={contact}", f"{slave}, {master}"]
        for period, first, largest, motion, loads in self.steps:
            lines += [
                "*STEP, NLGEOM, INC=100000",
                "*STATIC",
                f"{first / shorter}, {period}, 1e-6, {largest / shorter}",
            ]
            lines += (
                ["*BOUNDARY"] + [f"{name}, {i}, {i}, {value:.9g}" for (name, i), value in motion.items()]
                if motion
                else []
            )
            lines += [*loads, *prints, "*END STEP"]
        Path(path).write_text("\n".join(lines) + "\n")
        return sum(step[0] for step in self.steps)


def totals(folder: str | Path) -> list[tuple[float, ...]]:
    """Times and sums of reactions."""
    found = re.findall(
        r"total force.*?time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", Path(folder, "deck.dat").read_text(), re.S
    )
    return [tuple(float(x) for x in line) for line in found]


def blocks(folder: str | Path, what: str, n: int) -> list[tuple[float, list[list[float]]]]:
    """Times and lines of n integers, then numbers, of what CalculiX prints under `what`."""
    result: list[tuple[float, list[list[float]]]] = []
    for line in Path(folder, "deck.dat").read_text().splitlines():
        words = line.split()
        if line.strip().startswith(what):
            result.append((float(words[-1]), []))
        elif result and len(words) > n and words[0].isdigit():
            result[-1][1].append([int(w) for w in words[:n]] + [float(w) for w in words[n:]])
        elif words:
            result = result if not line.strip().startswith(("forces", "total", "stresses")) else result
    return result
