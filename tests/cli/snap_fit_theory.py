# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closed forms of prm/snap_fit.prm, per width: its test and its benchmark share them."""

from __future__ import annotations

import math
from typing import NamedTuple

YOUNG, POISSON, FRICTION = 2600.0, 0.35, 0.2
BENDING = YOUNG / (1 - POISSON**2) / 12  # stiffness of the beam, 1 thick, in plane strain
SHEAR = YOUNG / (2 * (1 + POISSON)) / 1.2
BELOW = 1.5  # what touches the catch is so far below the middle of the beam


class Way(NamedTuple):
    """One way over the catch: distance from the root of what touches it, angle of the ramp in degrees, and
    whether the ramp pushes the free end back (1) or pulls it (-1)."""

    arm: float
    angle: float
    push: int


INSERTION, REMOVAL = Way(20.0, 30.0, 1), Way(18.5, 45.0, -1)


def force_ratio(way: Way) -> float:
    """Returns axial over transverse force of a wedge with friction: (mu + tan a)/(1 - mu tan a)."""
    slope = math.tan(math.radians(way.angle))
    return (FRICTION + slope) / (1 - FRICTION * slope)


def design_force(way: Way, rise: float) -> float:
    """Returns the force of snap-fit design guides: a cantilever with the transverse force alone."""
    return 3 * BENDING * rise / way.arm**3


def beam_force(way: Way, rise: float, n: int = 200) -> float:
    """Returns the transverse force that raises the hook. The axial force acts, too, below the middle of the
    beam, and equilibrium holds in the deformed state: B v'' = P (x_hook - x) - W (y_axis - y_hook)."""
    dx = way.arm / n

    def rise_of(force: float) -> float:
        axial = way.push * force_ratio(way) * force
        deflection, turn, risen = [0.0] * (n + 1), 0.0, 0.0
        for _ in range(20):
            ahead = way.arm + BELOW * math.sin(turn)
            curvature = [
                (force * (ahead - i * dx) - axial * (BELOW + v - risen)) / BENDING
                for i, v in enumerate(deflection)
            ]
            deflection, turn = [0.0], 0.0
            for before, now in zip(curvature, curvature[1:]):
                turned = turn + 0.5 * dx * (before + now)
                deflection.append(deflection[-1] + 0.5 * dx * (turn + turned))
                turn = turned
            risen = deflection[-1] + BELOW * (1 - math.cos(turn)) + force * way.arm / SHEAR
        return risen

    low, high = 0.0, 2 * design_force(way, rise)
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if rise_of(middle) < rise else (low, middle)
    return low
