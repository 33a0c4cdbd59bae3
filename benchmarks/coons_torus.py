# SPDX-License-Identifier: LGPL-2.1-or-later
"""Prints Coons patches of a part of a torus about an axis along z, a file for `Shape = coons patches`.

Angles are those of billet's shape `torus`: in the tube's section 0 away from the axis and 90 along it; around
the axis from x."""

from __future__ import annotations

import argparse
import math
from typing import Any, Sequence


def parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    number: dict[str, Any] = {"type": float, "metavar": "X"}
    parser.add_argument(
        "--centre", type=float, nargs=3, default=[0.0, 0.0, 0.0], metavar="X", help="of the ring"
    )
    parser.add_argument("--ring", **number, required=True, help="radius of the circle in the tube's middle")
    parser.add_argument("--tube", **number, required=True, help="radius of the tube")
    parser.add_argument(
        "--from-angle", **number, default=90.0, help="where the part begins in the tube's section"
    )
    parser.add_argument("--to-angle", **number, default=180.0, help="where it ends")
    parser.add_argument("--start", **number, default=0.0, help="where the sector begins, in degrees from x")
    parser.add_argument("--sector", **number, default=90.0, help="how far it goes round, in degrees")
    parser.add_argument("--around", type=int, default=4, metavar="N", help="patches around the axis")
    parser.add_argument("--along", type=int, default=4, metavar="N", help="patches around the tube")
    parser.add_argument("--inside", action="store_true", help="the bodies are inside the tube")
    options = parser.parse_args()
    if not (options.ring > 0 and options.tube > 0):
        parser.error("both radii must be > 0")
    if not (options.to_angle > options.from_angle and options.sector > 0):
        parser.error("angles must grow from 'from' to 'to', and the sector be > 0")
    if options.around < 1 or options.along < 1:
        parser.error("there must be at least one patch each way")
    if (
        options.sector / options.around >= 180
        or (options.to_angle - options.from_angle) / options.along >= 180
    ):
        parser.error("a patch must be less than half a circle each way")
    return options


def main() -> None:
    options = parsed()

    def point(around: float, along: float) -> str:
        """Returns a point by fractions of the sector and of the tube's angle."""
        turn = math.radians(options.start + around * options.sector)
        angle = math.radians(options.from_angle + along * (options.to_angle - options.from_angle))
        radius = options.ring + options.tube * math.cos(angle)
        offset = (radius * math.cos(turn), radius * math.sin(turn), options.tube * math.sin(angle))
        return ", ".join(repr(c + d) for c, d in zip(options.centre, offset))

    def arc(start: Sequence[float], end: Sequence[float]) -> str:
        middle = [0.5 * (a + b) for a, b in zip(start, end)]
        return f"arc: {point(*start)} via {point(*middle)} to {point(*end)}"

    print(
        f"# Torus: ring radius {options.ring:g}, tube radius {options.tube:g}, tube angles"
        f" {options.from_angle:g} to {options.to_angle:g}, sector {options.sector:g}, {options.around} x"
        f" {options.along} patches"
    )
    for i in range(options.around):
        for j in range(options.along):
            low, high = (i / options.around, j / options.along), (
                (i + 1) / options.around,
                (j + 1) / options.along,
            )
            corners = [low, (high[0], low[1]), high, (low[0], high[1])]
            if options.inside:
                corners = [corners[0], corners[3], corners[2], corners[1]]
            print(" ; ".join(arc(corners[k], corners[(k + 1) % 4]) for k in range(4)))


if __name__ == "__main__":
    main()
