# SPDX-License-Identifier: LGPL-2.1-or-later
"""The units and the frame in which scenes are written down."""

import math

import numpy


def number(value):
    """So that it is read back as it is."""
    short = f"{value:.15g}"
    return short if float(short) == float(value) else repr(float(value))


def rotation(axis, degrees):
    axis = numpy.asarray(axis, float) / numpy.linalg.norm(axis)
    angle = math.radians(degrees)
    cross = numpy.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return numpy.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


class Frame:
    """Numbers are thought of in base units and an upright frame, and written down in others: lengths,
    stresses and times times so much, everything turned by `degrees` about `axis`. What a run gives is read
    back into base units."""

    def __init__(self, length=1.0, stress=1.0, time=1.0, axis=(1, 1, 1), degrees=0.0):
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

    def vector(self, v, unit=1.0):
        return ", ".join(number(x) for x in self.turned(v) * unit)

    def turned(self, v):
        v = numpy.asarray(v, float)
        return self.turn @ v if self.degrees else v

    def expressions(self, parts, unit=1.0):
        """Three expressions of t, for x, y, z; t in base units."""
        parts = [str(part) for part in parts]
        scale = "" if unit == 1.0 else f"{number(unit)}*"
        if self.degrees:
            parts = [" + ".join(f"{number(r)}*({e})" for r, e in zip(row, parts)) for row in self.turn]
        return " ; ".join(self.expression(e, scale) for e in parts)

    def expression(self, part, scale=""):
        if self.time != 1.0:
            part = part.replace("{t}", f"(t/{number(self.time)})")
        part = part.replace("{t}", "t")
        return part if part in ("0", "0.0") or not scale else f"{scale}({part})"

    def mesh(self, **what):
        """A mesh whose lengths are base units."""
        what = dict(what)
        if self.length != 1.0:
            what["Scale"] = number(self.length)
        if self.degrees:
            what["Rotation axis"] = ", ".join(number(x) for x in self.axis)
            what["Rotation angle"] = number(self.degrees)
        return what

    def planes(self, planes):
        """Symmetry planes (normal, distance)."""
        return " ; ".join(f"{self.vector(n)} = {number(d * self.length)}" for n, d in planes)
