# SPDX-License-Identifier: LGPL-2.1-or-later
"""The units and the frame in which scenes are written down."""

from __future__ import annotations

import math
from typing import Any, Iterable, Sequence

import numpy

from billet_tools.output import Array

Vector = Sequence[float]


def number(value: float) -> str:
    """So that it is read back as it is."""
    short = f"{value:.15g}"
    return short if float(short) == float(value) else repr(float(value))


def rotation(axis: Vector, degrees: float) -> Array:
    axis = numpy.asarray(axis, float) / numpy.linalg.norm(axis)
    angle = math.radians(degrees)
    cross = numpy.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return numpy.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


class Frame:
    """Numbers are thought of in base units and an upright frame, and written down in others: lengths,
    stresses and times times so much, everything turned by `degrees` about `axis`. What a run gives is read
    back into base units."""

    def __init__(
        self,
        length: float = 1.0,
        stress: float = 1.0,
        time: float = 1.0,
        axis: Vector = (1, 1, 1),
        degrees: float = 0.0,
    ) -> None:
        self.length, self.stress, self.time = length, stress, time
        self.axis, self.degrees = axis, degrees
        self.turn = rotation(axis, degrees)
        self.force = stress * length**2
        self.energy = stress * length**3
        self.speed = length / time
        self.acceleration = length / time**2
        self.density = stress * time**2 / length**2
        self.mass = self.density * length**3
        self.momentum = self.mass * self.speed

    def vector(self, v: Vector | Array, unit: float = 1.0) -> str:
        return ", ".join(number(x) for x in self.turned(v) * unit)

    def turned(self, v: Vector | Array) -> Array:
        v = numpy.asarray(v, float)
        return self.turn @ v if self.degrees else v

    def expressions(self, parts: Iterable[object], unit: float = 1.0) -> str:
        """Three expressions of t, for x, y, z; t in base units."""
        texts = [str(part) for part in parts]
        scale = "" if unit == 1.0 else f"{number(unit)}*"
        if self.degrees:
            texts = [" + ".join(f"{number(r)}*({e})" for r, e in zip(row, texts)) for row in self.turn]
        return " ; ".join(self.expression(e, scale) for e in texts)

    def expression(self, part: str, scale: str = "") -> str:
        if self.time != 1.0:
            part = part.replace("{t}", f"(t/{number(self.time)})")
        part = part.replace("{t}", "t")
        return part if part in ("0", "0.0") or not scale else f"{scale}({part})"

    def mesh(self, **what: Any) -> dict[str, Any]:
        """A mesh whose lengths are base units."""
        what = dict(what)
        if self.length != 1.0:
            what["Scale"] = number(self.length)
        if self.degrees:
            what["Rotation axis"] = ", ".join(number(x) for x in self.axis)
            what["Rotation angle"] = number(self.degrees)
        return what

    def planes(self, planes: Iterable[tuple[Vector, float]]) -> str:
        """Symmetry planes (normal, distance)."""
        return " ; ".join(f"{self.vector(n)} = {number(d * self.length)}" for n, d in planes)
