# SPDX-License-Identifier: LGPL-2.1-or-later
"""The billet in CalculiX: its mesh, its deck, its runs."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Sequence

from billet_runs import PENALTY, PROGRAM, SCENE, mesh, variant
from ccx_decks import FACES, Brick, CcxJob, Node, read_bricks


def read_mesh(refinements: int) -> tuple[list[Node], list[Brick]]:
    """Nodes and bricks (in VTK's order, which is Abaqus', too) of billet's mesh, from its fields at time
    0."""
    changes = {
        **mesh(refinements),
        "Time stepping/End time": 1e-3,
        "Time stepping/Initial step": 1e-3,
        "Output/Folder": "results",
        "Output/Verbosity": "quiet",
    }
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "scene.prm").write_text(variant(SCENE.read_text(), changes))
        subprocess.run([PROGRAM, "scene.prm"], cwd=folder, check=True)
        return read_bricks(Path(folder, "results/fields_00000.vtm"), 4)


def write_deck(
    path: Path,
    nodes: list[Node],
    bricks: list[Brick],
    element: str,
    contact: str,
    friction: float,
    increment: float,
    part: float,
) -> None:
    """The deck of one eighth of the billet under a die that is one brick with all nodes prescribed, until
    that part of the travel."""
    count: dict[tuple[int, ...], int] = {}
    for brick in bricks:
        for face in FACES:
            key = tuple(sorted(brick[i] for i in face))
            count[key] = count.get(key, 0) + 1
    slave = []  # faces on the top and on the mantle, as in billet's scene
    for number_, brick in enumerate(bricks):
        for side, face in enumerate(FACES):
            corners = [brick[i] for i in face]
            outer = count[tuple(sorted(corners))] == 1
            if outer and not any(all(nodes[c][axis] < 1e-6 for c in corners) for axis in range(3)):
                slave.append(f"{number_ + 1}, S{side + 1}")

    def node_set(name: str, members: Sequence[int]) -> list[str]:
        lines = [", ".join(str(m + 1) for m in members[i : i + 12]) for i in range(0, len(members), 12)]
        return [f"*NSET, NSET={name}"] + lines

    first, wide, high = len(nodes), 40.0, 55.0
    die: list[Node] = [
        (x, y, z) for z in (15.0, high) for x, y in ((-5.0, -5.0), (wide, -5.0), (wide, wide), (-5.0, wide))
    ]
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i + 1}, {x:.6f}, {y:.6f}, {z:.6f}" for i, (x, y, z) in enumerate(nodes + die)]
    lines += [f"*ELEMENT, TYPE={element}, ELSET=BILLET"]
    lines += [", ".join(str(v) for v in [i + 1] + [c + 1 for c in brick]) for i, brick in enumerate(bricks)]
    lines += [
        "*ELEMENT, TYPE=C3D8, ELSET=DIE",
        ", ".join(str(v) for v in [len(bricks) + 1] + [first + 1 + i for i in range(8)]),
    ]
    for axis, name in enumerate("XYZ"):
        lines += node_set(name + "0", [i for i, node in enumerate(nodes) if node[axis] < 1e-6])
    lines += node_set("DIENODES", [first + i for i in range(8)])
    lines += ["*SURFACE, NAME=SLAVE"] + slave + ["*SURFACE, NAME=MASTER", f"{len(bricks) + 1}, S1"]
    lines += [
        "*MATERIAL, NAME=STEEL",
        "*ELASTIC",
        "200e3, 0.3",
        "*PLASTIC",
        "700, 0",
        "2200, 5",
        "*SOLID SECTION, ELSET=BILLET, MATERIAL=STEEL",
        "*MATERIAL, NAME=TOOL",
        "*ELASTIC",
        "200e3, 0.3",
        "*SOLID SECTION, ELSET=DIE, MATERIAL=TOOL",
        "*SURFACE INTERACTION, NAME=TOUCH",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{PENALTY}",
    ]
    lines += ["*FRICTION", f"{friction}, {PENALTY}"] if friction else []
    lines += [
        f"*CONTACT PAIR, INTERACTION=TOUCH, TYPE={contact}",
        "SLAVE, MASTER",
        "*BOUNDARY",
        "X0, 1, 1",
        "Y0, 2, 2",
        "Z0, 3, 3",
        "DIENODES, 1, 2",
        "*STEP, NLGEOM, INC=10000",
        "*STATIC",
        f"{increment}, {part}, 1e-6, {increment}",
        "*BOUNDARY",
        f"DIENODES, 3, 3, {-9.6 * part}",
        "*NODE PRINT, NSET=DIENODES, TOTALS=ONLY",
        "RF",
        "*END STEP",
    ]
    path.write_text("\n".join(lines) + "\n")


class CcxRun:
    """A run of CalculiX until that part of the travel, of so many CPU seconds at most: `seconds`,
    `megabytes`, `iterations` (with those of cut increments), `steps`, `cuts`, `converged`, `times` and
    `forces` (on the whole billet, in kN, from time 0 on), as a run of billet has them."""

    def __init__(
        self,
        nodes: list[Node],
        bricks: list[Brick],
        element: str,
        contact: str,
        friction: float = 0.1,
        increment: float = 0.02,
        part: float = 1.0,
        limit: int | None = None,
    ) -> None:
        with tempfile.TemporaryDirectory() as folder:
            write_deck(Path(folder, "deck.inp"), nodes, bricks, element, contact, friction, increment, part)
            job = CcxJob(folder, part, limit)
            forces = re.findall(
                r"total force.*?time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)",
                Path(folder, "deck.dat").read_text(),
                re.S,
            )
        self.seconds, self.megabytes, self.iterations, self.cuts = (
            job.seconds,
            job.megabytes,
            job.iterations,
            job.cuts,
        )
        self.steps = len(forces)
        self.times = [0.0] + [float(time) for time, _, _, _ in forces]
        self.forces = [0.0] + [-4e-3 * float(force) for _, _, _, force in forces]
        self.converged = not job.failure
        print(
            (
                f"[ccx {element} {contact}, {len(bricks)} bricks] {self.iterations} iterations,"
                f" {self.seconds:.3g} s"
            ),
            file=sys.stderr,
            flush=True,
        )
