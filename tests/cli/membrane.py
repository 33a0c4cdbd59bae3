# SPDX-License-Identifier: LGPL-2.1-or-later
"""A spherical membrane of an incompressible neo-Hookean solid, inflated against a plane without friction.

The meridian is integrated from the pole to the equator (Adkins & Rivlin 1952): tensions T1 along it and T2
around, stretches l1 and l2, slope phi, radius r. On the plane phi = 0; beyond it kappa_1 T1 + kappa_2 T2 = p.
Two numbers, the stretch at the pole and the angle where the plane ends, follow from the slope and the height
of the equator.
"""

from __future__ import annotations

import math
from typing import NamedTuple


class Membrane(NamedTuple):
    """Sphere of radius R and thickness t with the shear modulus mu."""

    radius: float
    thickness: float
    shear_modulus: float

    def tension(self, along: float, across: float) -> float:
        """Returns the force per deformed length."""
        return (
            self.shear_modulus * self.thickness / (along * across) * (along**2 - 1 / (along * across) ** 2)
        )

    def slopes(self, angle: float, y: list[float], pressure: float) -> list[float]:
        """Returns derivatives of r, z, phi and l1 by the undeformed angle; without pressure on the plane."""
        r, _, phi, l1 = y
        rho = self.radius * math.sin(angle)
        l2 = r / rho
        t1, t2 = self.tension(l1, l2), self.tension(l2, l1)
        dr = l1 * self.radius * math.cos(phi)
        dl2 = dr / rho - r * self.radius * math.cos(angle) / rho**2
        h = 1e-6
        by_l1 = (self.tension(l1 + h, l2) - self.tension(l1 - h, l2)) / (2 * h)
        by_l2 = (self.tension(l1, l2 + h) - self.tension(l1, l2 - h)) / (2 * h)
        dl1 = ((t2 - t1) * dr / r - by_l2 * dl2) / by_l1
        turn = l1 * self.radius * (pressure - t2 * math.sin(phi) / r) / t1 if pressure > 0 else 0.0
        return [dr, -l1 * self.radius * math.sin(phi), turn, dl1]

    def integrate(self, y: list[float], start: float, end: float, pressure: float, n: int) -> list[float]:
        """Integrates by n steps of fourth order."""
        h = (end - start) / n
        for i in range(n):
            angle = start + i * h
            k: list[list[float]] = [[0.0] * 4]
            for part in (0.0, 0.5, 0.5, 1.0):
                moved = [a + part * h * b for a, b in zip(y, k[-1])]
                k.append(self.slopes(angle + part * h, moved, pressure))
            y = [a + h / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(y, k[1], k[2], k[3], k[4])]
        return y

    def misfit(
        self, pressure: float, height: float, stretch: float, end: float
    ) -> tuple[float, float, float]:
        """Returns the errors of slope and height at the equator, and the radius of the flat part."""
        first = 1e-4
        start = [stretch * self.radius * math.sin(first), 0.0, 0.0, stretch]
        flat = self.integrate(start, first, end, 0.0, 100)
        y = self.integrate(flat, end, math.pi / 2, pressure, 400)
        above = height - self.thickness / (2 * stretch**2)  # the middle of the wall
        return y[2] - math.pi / 2, (-y[1] - above) / self.radius, flat[0]

    def force_on_plane(self, pressure: float, height: float, stretch: float, end: float) -> float:
        """Returns the force on a plane at this height above the equator; `stretch`, `end`: first guess."""
        h = 1e-5
        for _ in range(30):
            f = self.misfit(pressure, height, stretch, end)
            by_stretch = self.misfit(pressure, height, stretch + h, end)
            by_end = self.misfit(pressure, height, stretch, end + h)
            a, b = (by_stretch[0] - f[0]) / h, (by_end[0] - f[0]) / h
            c, d = (by_stretch[1] - f[1]) / h, (by_end[1] - f[1]) / h
            det = a * d - b * c
            change = (-f[0] * d + f[1] * b) / det, (-a * f[1] + c * f[0]) / det
            stretch, end = stretch + change[0], end + change[1]
            if max(abs(change[0]), abs(change[1])) < 1e-9:
                return pressure * math.pi * f[2] ** 2
        raise ValueError("the membrane's equations have not been solved")
