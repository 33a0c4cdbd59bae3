# SPDX-License-Identifier: LGPL-2.1-or-later
"""Answers to scenes of the work-precision page that neither program takes part in: a beam and rings, as one-
dimensional problems at large deformation."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy

import billet_runs  # noqa: F401  finds billet_tools
from billet_tools.output import Array


def beam_deflection(length: float, height: float, width: float, young: float, force: float) -> float:
    """Returns the deflection of the tip of a cantilever under a dead force across it, ν = 0, by Reissner's
    beam: E I θ'' = F ((1 + ε) cos θ − γ sin θ), ε = −F sin θ / (E A), γ = −6/5 F cos θ / (G A), G = E/2, with
    θ(0) = θ'(L) = 0. Shooting for θ'(0) by secants, a Runge-Kutta method of fourth order along the beam.
    Source: Reissner, ZAMP 23 (1972) 795-804."""
    area, inertia = width * height, width * height**3 / 12
    axial, shear, bending = young * area, 5 / 6 * young / 2 * area, young * inertia
    n, step = 2000, length / 2000

    def slope(state: Array) -> Array:  # of θ, θ' and the deflection
        c, s = math.cos(state[0]), math.sin(state[0])
        stretch, slip = 1 - force * s / axial, -force * c / shear
        return numpy.array([state[1], force * (stretch * c - slip * s) / bending, stretch * s + slip * c])

    def shoot(curvature: float) -> Array:
        state = numpy.array([0.0, curvature, 0.0])
        for _ in range(n):
            a = slope(state)
            b = slope(state + 0.5 * step * a)
            c = slope(state + 0.5 * step * b)
            state = state + step / 6 * (a + 2 * b + 2 * c + slope(state + step * c))
        return state

    before, now = 0.0, -0.5 * force * length / bending
    miss = shoot(before)[1]
    for _ in range(50):
        end = shoot(now)
        if abs(end[1]) < 1e-12 * force * length / bending:
            break
        before, now, miss = now, now - end[1] * (now - before) / (end[1] - miss), end[1]
    return -float(shoot(now)[2])


class Ring(NamedTuple):
    """A ring in plane strain: radii, elasticity, and yield stress."""

    inner: float
    outer: float
    young: float
    poisson: float
    yield_stress: float = math.inf


class RingBody:
    """Axisymmetric line elements of a ring, one point each. In principal axes that do not turn, Hencky's law
    is a return map in logarithmic strains: τ = λ tr(ε − εp) 1 + 2 μ (ε − εp), which yields by von Mises in
    Kirchhoff stress τ."""

    def __init__(self, ring: Ring, n: int) -> None:
        self.radii = numpy.linspace(ring.inner, ring.outer, n + 1)
        self.ring, self.plastic = ring, numpy.zeros((n, 3))
        self.shear = ring.young / 2 / (1 + ring.poisson)
        self.lame = 2 * self.shear * ring.poisson / (1 - 2 * ring.poisson)

    def stress(self, u: Array, v: Array) -> tuple[Array, Array]:
        """Returns τ and plastic strains for displacements u, v at the ends of elements."""
        length = numpy.diff(self.radii)
        middle = 0.5 * (self.radii[1:] + self.radii[:-1])
        zero = numpy.zeros(len(length))
        strain = numpy.stack(
            [numpy.log1p((v - u) / length), numpy.log1p(0.5 * (u + v) / middle), zero], axis=1
        )
        elastic = strain - self.plastic
        volume = elastic.sum(axis=1)
        deviator = 2 * self.shear * (elastic - volume[:, None] / 3)
        mises = numpy.sqrt(1.5 * (deviator**2).sum(axis=1))
        share = numpy.minimum(1.0, self.ring.yield_stress / numpy.maximum(mises, 1e-300))
        pressure = (self.lame + 2 * self.shear / 3) * volume
        plastic = self.plastic + deviator * (1 - share)[:, None] / (2 * self.shear)
        return deviator * share[:, None] + pressure[:, None], plastic

    def forces(self, u: Array, v: Array) -> Array:
        """Returns nodal forces of each element, per radian and unit of width, rows of both ends."""
        length = numpy.diff(self.radii)
        middle = 0.5 * (self.radii[1:] + self.radii[:-1])
        stress, _ = self.stress(u, v)
        radial = stress[:, 0] / (length + v - u)
        hoop = 0.5 * stress[:, 1] / (middle + 0.5 * (u + v))
        return (length * middle)[:, None] * numpy.stack([hoop - radial, hoop + radial], axis=1)

    def residual(self, u: Array) -> Array:
        found = self.forces(u[:-1], u[1:])
        result = numpy.zeros(len(u))
        result[:-1] += found[:, 0]
        result[1:] += found[:, 1]
        return result

    def stiffness(self, u: Array) -> Array:
        """Returns the matrix by central differences."""
        n, h = len(u), 1e-7 * self.radii[0]
        matrix = numpy.zeros((n, n))
        rows = numpy.arange(n - 1)
        for k, (a, b) in enumerate(((h, 0.0), (0.0, h))):
            slopes = (self.forces(u[:-1] + a, u[1:] + b) - self.forces(u[:-1] - a, u[1:] - b)) / (2 * h)
            numpy.add.at(matrix, (rows, rows + k), slopes[:, 0])
            numpy.add.at(matrix, (rows + 1, rows + k), slopes[:, 1])
        return matrix


def pressurised_bore(ring: Ring, pressure: float, n: int = 400, steps: int = 200) -> float:
    """Returns the displacement of the bore under a pressure on the deformed face, raised in steps."""
    body, u = RingBody(ring, n), numpy.zeros(n + 1)
    for step in range(1, steps + 1):
        p = pressure * step / steps
        for _ in range(30):
            residual = body.residual(u)
            residual[0] -= p * (ring.inner + u[0])
            matrix = body.stiffness(u)
            matrix[0, 0] -= p
            change = numpy.linalg.solve(matrix, -residual)
            u = u + change
            if abs(change).max() < 1e-11 * ring.inner:
                break
        else:
            raise RuntimeError("the ring finds no equilibrium")
        body.plastic = body.stress(u[:-1], u[1:])[1]
    return float(u[0])


def press_fit_force(inner: Ring, outer: Ring, n: int = 400) -> float:
    """Returns the force between two elastic rings, of which the inner one is larger than the hole of the
    outer one, per radian and unit of width: pressure times deformed radius."""
    bodies = RingBody(inner, n), RingBody(outer, n)
    first, second = numpy.zeros(n + 1), numpy.zeros(n + 1)
    force = 0.0
    for _ in range(30):
        # Unknowns: both displacements and the force; the last row keeps the faces together.
        residual = numpy.concatenate([bodies[0].residual(first), bodies[1].residual(second), [0.0]])
        residual[n] += force
        residual[n + 1] -= force
        residual[-1] = inner.outer + first[-1] - outer.inner - second[0]
        matrix = numpy.zeros((2 * n + 3, 2 * n + 3))
        matrix[: n + 1, : n + 1] = bodies[0].stiffness(first)
        matrix[n + 1 : -1, n + 1 : -1] = bodies[1].stiffness(second)
        matrix[n, -1] = matrix[-1, n] = 1.0
        matrix[n + 1, -1] = matrix[-1, n + 1] = -1.0
        change = numpy.linalg.solve(matrix, -residual)
        first, second = first + change[: n + 1], second + change[n + 1 : -1]
        force += float(change[-1])
        if abs(change[:-1]).max() < 1e-12 * inner.outer:
            return force
    raise RuntimeError("the rings find no equilibrium")
