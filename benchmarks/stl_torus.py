# SPDX-License-Identifier: LGPL-2.1-or-later
"""Prints an STL file of a torus fillet about the z axis, as of a die: an open surface, whose normals point
away from the tube's middle."""

from __future__ import annotations

import argparse
import math
import struct
import sys
from typing import Iterator

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument(
    "--centre", type=float, nargs=3, default=(0.0, 0.0, 0.0), metavar=("X", "Y", "Z"), help="of the ring"
)
parser.add_argument("--ring", type=float, required=True, help="radius of the circle in the tube's middle")
parser.add_argument("--tube", type=float, required=True, help="radius of the tube")
parser.add_argument(
    "--tube-angle",
    type=float,
    nargs=2,
    default=(90.0, 180.0),
    metavar=("FROM", "TO"),
    help="the part of the tube, in degrees: 0 away from the axis, 90 along it",
)
parser.add_argument(
    "--sector",
    type=float,
    nargs=2,
    default=(0.0, 360.0),
    metavar=("FROM", "TO"),
    help="how far it goes round, in degrees from the x axis",
)
parser.add_argument("--around", type=int, default=64, help="facets around the axis")
parser.add_argument("--along", type=int, default=8, help="facets along the tube's arc")
parser.add_argument("--inwards", action="store_true", help="let the normals point to the tube's middle")
parser.add_argument("--ascii", action="store_true", help="ASCII instead of binary")

Point = tuple[float, ...]  # x, y, z


def point(options: argparse.Namespace, i: int, j: int) -> Point:
    """Corner i around the axis, j along the arc."""
    turn = options.sector[1] - options.sector[0]
    if turn == 360.0:
        i %= options.around
    around = math.radians(options.sector[0] + turn * i / options.around)
    along = math.radians(
        options.tube_angle[0] + (options.tube_angle[1] - options.tube_angle[0]) * j / options.along
    )
    radius = options.ring + options.tube * math.cos(along)
    return (
        options.centre[0] + radius * math.cos(around),
        options.centre[1] + radius * math.sin(around),
        options.centre[2] + options.tube * math.sin(along),
    )


def facets(options: argparse.Namespace) -> Iterator[tuple[Point, Point, Point]]:
    """Each quadrilateral as two triangles, counter-clockwise seen from outside of the tube."""
    for i in range(options.around):
        for j in range(options.along):
            a, b, c, d = (point(options, i + k, j + l) for k, l in ((0, 0), (1, 0), (1, 1), (0, 1)))
            for corners in ((a, b, d), (b, c, d)):
                yield corners[::-1] if options.inwards else corners


def normal(a: Point, b: Point, c: Point) -> Point:
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(sum(x * x for x in n))
    return tuple(x / length for x in n) if length > 0 else n


def main() -> None:
    options = parser.parse_args()
    if not (options.ring > 0 and options.tube > 0 and options.around > 0 and options.along > 0):
        parser.error("radii and numbers of facets must be positive")
    if not (
        0 < options.sector[1] - options.sector[0] <= 360 and options.tube_angle[1] > options.tube_angle[0]
    ):
        parser.error("angles must ascend, the sector's by at most 360")
    triangles = list(facets(options))
    if options.ascii:
        print("solid torus")
        for corners in triangles:
            print(" facet normal", *map(repr, normal(*corners)), "\n  outer loop")
            for corner in corners:
                print("   vertex", *map(repr, corner))
            print("  endloop\n endfacet")
        print("endsolid torus")
    else:
        out = sys.stdout.buffer
        out.write(b"torus".ljust(80) + struct.pack("<I", len(triangles)))
        for corners in triangles:
            out.write(struct.pack("<12fH", *normal(*corners), *(x for corner in corners for x in corner), 0))


main()
