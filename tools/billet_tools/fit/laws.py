# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nominal stresses of incompressible rubber, (H3) and (H4) of doc/theory/rubber.md, and lines for a scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence

import numpy

from .data import MODES, Array

# Principal logarithmic strains of a mode over ln of its stretch. The first one is along the stress.
DIRECTIONS = {"uniaxial": (1.0, -0.5, -0.5), "equibiaxial": (1.0, 1.0, -2.0), "planar": (1.0, 0.0, -1.0)}
FREE = {"uniaxial": 1, "equibiaxial": 2, "planar": 2}  # a direction without stress

CHAIN_FACTORS = (1 / 2, 1 / 20, 11 / 1050, 19 / 7000, 519 / 673750)


@dataclass
class Law:
    """W = Σ μ/α (Σ λ^α − 3) + Σ c_i (I1 − 3)^i and its name and lines in a scene."""

    name: str
    lines: list[tuple[str, str]]
    moduli: tuple[float, ...] = ()
    exponents: tuple[float, ...] = ()
    powers: tuple[float, ...] = ()

    def shear_modulus(self) -> float:
        """Returns the initial shear modulus."""
        return sum(m * a for m, a in zip(self.moduli, self.exponents)) / 2 + 2 * sum(self.powers[:1])

    def principal(self, strains: Array) -> Array:
        """Returns ∂W/∂e_A, one row for each direction."""
        result = numpy.zeros_like(strains)
        for modulus, exponent in zip(self.moduli, self.exponents):
            result += modulus * numpy.expm1(exponent * strains)
        if self.powers:
            squares = numpy.exp(2 * strains)
            x = squares.sum(axis=0) - 3
            result += 2 * squares * sum(i * c * x ** (i - 1) for i, c in enumerate(self.powers, 1))
        return result

    def stress(self, mode: str, stretches: Array) -> Array:
        """Returns nominal stresses."""
        t = self.principal(numpy.outer(DIRECTIONS[mode], numpy.log(stretches)))
        return numpy.asarray((t[0] - t[FREE[mode]]) / stretches)

    def stable_range(self, mode: str, least: float = 0.1, greatest: float = 10.0) -> tuple[float, float]:
        """Returns the stretches between which Drucker's condition (H6) holds, as the program does."""
        limits = []
        for end in (least, greatest):
            logs = numpy.log(end) * numpy.arange(1, 2001) / 2000
            eigenvalues = self.least_slope(numpy.outer(DIRECTIONS[mode], logs))
            bad = numpy.flatnonzero(~(eigenvalues > 0))
            limits.append(end if len(bad) == 0 else float(numpy.exp(logs[bad[0] - 1]) if bad[0] else 1.0))
        return limits[0], limits[1]

    def least_slope(self, strains: Array) -> Array:
        """Returns the least eigenvalue of ∂²W/∂e∂e among isochoric changes."""
        squares = numpy.exp(2 * strains)
        x = squares.sum(axis=0) - 3
        first = sum(i * c * x ** (i - 1) for i, c in enumerate(self.powers, 1))
        second = sum(i * (i - 1) * c * x ** max(i - 2, 0) for i, c in enumerate(self.powers, 1))
        slopes = 4 * second * squares[:, None] * squares[None] + numpy.zeros((3, 3, strains.shape[1]))
        for a in range(3):
            slopes[a, a] += 4 * first * squares[a]
            for modulus, exponent in zip(self.moduli, self.exponents):
                slopes[a, a] += modulus * exponent * numpy.exp(exponent * strains[a])
        u, v = numpy.array([1, -1, 0]) / numpy.sqrt(2), numpy.array([1, 1, -2]) / numpy.sqrt(6)
        uu, uv, vv = (numpy.einsum("a,b,abn->n", p, q, slopes) for p, q in ((u, u), (u, v), (v, v)))
        return numpy.asarray((uu + vv) / 2 - numpy.hypot((uu - vv) / 2, uv))

    def paste(self, poisson: float) -> str:
        """Returns the lines of a scene."""
        lines = [("Elasticity", self.name), *self.lines, ("Poisson ratio", f"{poisson:g}")]
        width = max(len(key) for key, _ in lines)
        return "\n".join(f"set {key:<{width}} = {value}" for key, value in lines)

    def warn(self) -> list[str]:
        """Returns what to know of its stability."""
        return [
            f"unstable (Drucker) in {mode} tension beyond stretches of {low:.3g} to {high:.3g}"
            for mode in MODES
            for low, high in [self.stable_range(mode)]
            if low > 0.1 or high < 10
        ]


def number(value: float) -> str:
    """Returns six digits."""
    return f"{value:.6g}"


def listed(values: Sequence[float]) -> str:
    """Returns numbers as a scene has a list."""
    return ", ".join(number(value) for value in values)


def mooney_rivlin(c10: float, c01: float) -> Law:
    """Returns Mooney and Rivlin's law."""
    lines = [("C10", number(c10)), ("C01", number(c01))]
    return Law("Mooney-Rivlin", lines, (2 * c10, -2 * c01), (2.0, -2.0))


def yeoh(c10: float, c20: float, c30: float) -> Law:
    """Returns Yeoh's law."""
    lines = [("C10", number(c10)), ("C20", number(c20)), ("C30", number(c30))]
    return Law("Yeoh", lines, powers=(c10, c20, c30))


def ogden(moduli: Sequence[float], exponents: Sequence[float]) -> Law:
    """Returns Ogden's law."""
    lines = [("Ogden moduli", listed(moduli)), ("Ogden exponents", listed(exponents))]
    return Law("Ogden", lines, tuple(moduli), tuple(exponents))


def arruda_boyce(modulus: float, stretch: float) -> Law:
    """Returns Arruda and Boyce's law, as powers of I1 − 3."""
    powers = numpy.zeros(5)
    for i, factor in enumerate(CHAIN_FACTORS, 1):
        binomial = 1.0
        for k in range(1, i + 1):
            binomial *= (i - k + 1) / k
            powers[k - 1] += modulus * factor * stretch ** (2 - 2 * i) * binomial * 3.0 ** (i - k)
    lines = [("Chain modulus", number(modulus)), ("Locking stretch", number(stretch))]
    return Law("Arruda-Boyce", lines, powers=tuple(powers))
