# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the comparisons with CalculiX share: billet's mesh from its own output, runs of CalculiX."""

from __future__ import annotations

import base64
import os
import re
import struct
import zlib
from pathlib import Path
from typing import Any

from billet_runs import Measured

Node = tuple[float, ...]  # x, y, z
Brick = list[int]  # numbers of its nodes

CCX_ENVIRONMENT = {
    **os.environ,
    "OMP_NUM_THREADS": "1",
    "CCX_NPROC_EQUATION_SOLVER": "1",
    "CCX_NPROC_RESULTS": "1",
    "NUMBER_OF_CPUS": "1",
}
FACES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))  # S1 ... S6


def data_array(text: str, name: str, form: str) -> list[Any]:
    """The values of a DataArray as deal.II writes it: base64 of (blocks, size, last size, packed sizes), then
    zlib."""
    pattern = r'<DataArray[^>]*Name="' + name + r'"[^>]*>' if name else r"<Points>\s*<DataArray[^>]*>"
    found = re.search(pattern + r"\s*(\S+)\s*</DataArray>", text)
    assert found, f"no data array {name}"
    encoded = found[1]
    n_blocks = struct.unpack("<I", base64.b64decode(encoded[:8])[:4])[0]
    head_length = 4 * ((4 * (3 + n_blocks) + 2) // 3)
    packed_sizes = struct.unpack(
        f"<{3 + n_blocks}I", base64.b64decode(encoded[:head_length])[: 4 * (3 + n_blocks)]
    )[3:]
    packed, values, start = base64.b64decode(encoded[head_length:]), b"", 0
    for size in packed_sizes:
        values += zlib.decompress(packed[start : start + size])
        start += size
    return [value for value, in struct.iter_unpack("<" + form, values)]


def read_bodies(text: str, digits: int) -> tuple[list[Node], list[list[Brick]]]:
    """Nodes, and the bricks (in VTK's order, which is Abaqus', too) of each body, of the fields that billet
    writes at time 0. Corners of a body that agree to so many decimals are one node."""
    flat = data_array(text, "", "f")
    points = list(zip(flat[0::3], flat[1::3], flat[2::3]))
    corners = data_array(text, "connectivity", "i")
    body_of = [int(body) for body in data_array(text, "body", "f")]
    index: dict[tuple[float, ...], int] = {}
    nodes: list[Node] = []
    of_point = []
    for point, body in zip(points, body_of):  # deal.II writes each brick's own corners
        place = tuple(round(x, digits) for x in point)
        key = (body,) + place
        if key not in index:
            index[key] = len(nodes)
            nodes.append(place)
        of_point.append(index[key])
    bodies: dict[int, list[Brick]] = {body: [] for body in sorted(set(body_of))}
    for i in range(0, len(corners), 8):
        bodies[body_of[corners[i]]].append([of_point[corner] for corner in corners[i : i + 8]])
    return nodes, list(bodies.values())


def read_bricks(text: str, digits: int) -> tuple[list[Node], list[Brick]]:
    """The same of all bodies together."""
    nodes, bodies = read_bodies(text, digits)
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
                if limit and self.seconds > 0.99 * limit
                else re.sub(r"\s+", " ", said[0])
                if said
                else f"ends with code {done.code}"
            )
        )
