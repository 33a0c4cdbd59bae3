# SPDX-License-Identifier: LGPL-2.1-or-later
"""Slab theory of rolling (von Kármán 1925) for prm/slab_rolling.prm: no hardening, Coulomb friction."""

from __future__ import annotations

import math

ENTRY, EXIT, RADIUS, FRICTION, YIELD = 10.0, 7.0, 150.0, 0.2, 250.0
SHEAR = YIELD / math.sqrt(3)


def pressures(angles: list[float], sign: int) -> list[float]:
    """Integrates d(h q)/dphi = 2 R (p sin phi +- tau cos phi), p = q + 2 k, from an end without tension."""
    found, thrust = [2 * SHEAR], 0.0
    for before, now in zip(angles, angles[1:]):

        def slope(phi: float, p: float) -> float:
            return 2 * RADIUS * (p * math.sin(phi) + sign * min(FRICTION * p, SHEAR) * math.cos(phi))

        def pressure(phi: float, hq: float) -> float:
            return hq / (EXIT + 2 * RADIUS * (1 - math.cos(phi))) + 2 * SHEAR

        middle, step = 0.5 * (before + now), now - before
        half = thrust + 0.5 * step * slope(before, found[-1])
        thrust += step * slope(middle, pressure(middle, half))
        found.append(pressure(now, thrust))
    return found


def force_and_torque(n: int = 4000) -> tuple[float, float]:
    """Returns vertical force and torque of one roll, per width. The lower of the pressures from both ends
    holds; where they meet, the slab is as fast as the roll."""
    bite = math.acos(1 - (ENTRY - EXIT) / (2 * RADIUS))
    angles = [i * bite / n for i in range(n + 1)]
    from_exit = pressures(angles, 1)
    from_entry = pressures(angles[::-1], -1)[::-1]
    force = torque = 0.0
    for i, phi in enumerate(angles):
        p = min(from_exit[i], from_entry[i])
        friction = math.copysign(min(FRICTION * p, SHEAR), from_exit[i] - from_entry[i])
        length = RADIUS * bite / n * (0.5 if i in (0, n) else 1.0)
        force += length * (p * math.cos(phi) + friction * math.sin(phi))
        torque += length * RADIUS * friction
    return force, torque
