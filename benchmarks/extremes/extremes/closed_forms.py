# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the laws say of one brick, computed here without the program. Stresses are Kirchhoff stresses of
logarithmic strains (doc/theory.md, 'The law'); all numbers in any consistent unit."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Callable, Sequence

if TYPE_CHECKING:
    from .scenes import Knobs


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Of a function with one change of sign between low and high, by bisection."""
    at_low = function(low)
    for _ in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        at_middle = function(middle)
        if (at_middle > 0) == (at_low > 0):
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def bulk(young: float, poisson: float) -> float:
    return young / (3 * (1 - 2 * poisson))


def shear(young: float, poisson: float) -> float:
    return young / (2 * (1 + poisson))


def uniaxial_hencky(
    young: float, strain: float, yield_stress: float = math.inf, modulus: float = 0.0
) -> tuple[float, float]:
    """(Kirchhoff stress, plastic strain) of a bar stretched monotonically to the logarithmic strain
    `strain`."""
    trial = young * abs(strain)
    if trial <= yield_stress:
        return young * strain, 0.0
    plastic = (trial - yield_stress) / (young + modulus)
    return math.copysign(young * (abs(strain) - plastic), strain), plastic


def lateral_hencky(young: float, poisson: float, strain: float, stress: float) -> float:
    """Logarithmic strain across: plastic flow keeps the volume, elasticity contracts by Poisson's ratio."""
    elastic = stress / young
    return -poisson * elastic - 0.5 * (strain - elastic)


def uniaxial_neo_hookean(young: float, poisson: float, strain: float) -> tuple[float, float]:
    """(Kirchhoff stress, logarithmic strain across) of energy ½ κ ln²J + ½ G (tr b̄ − 3), elastic."""
    kappa, g = bulk(young, poisson), shear(young, poisson)

    def stresses(across: float) -> tuple[float, float]:
        volume = strain + 2 * across
        b_along, b_across = math.exp(2 * (strain - volume / 3)), math.exp(2 * (across - volume / 3))
        mean = (b_along + 2 * b_across) / 3
        return kappa * volume + g * (b_along - mean), kappa * volume + g * (b_across - mean)

    bound = 3 * abs(strain) + 1e-12
    across = root(lambda a: stresses(a)[1], -bound, bound)
    return stresses(across)[0], across


def uniaxial_hypoelastic(
    young: float,
    poisson: float,
    strains: Sequence[float],
    yield_stress: Callable[[float], float] | None = None,
) -> tuple[float, float]:
    """(Kirchhoff stress, logarithmic strain across) of a bar at the last of the logarithmic strains, reached
    step by step: the deviator grows by 2 G times that of 2 Δλ/(λ_n + λ_n+1) in all three directions, the
    pressure is κ ln J; returned radially to yield_stress(plastic strain)."""
    kappa, g = bulk(young, poisson), shear(young, poisson)

    def midpoint(a: float, b: float) -> float:
        return 2 * math.tanh(0.5 * (b - a))

    limit = yield_stress or (lambda plastic: math.inf)
    across = stress = plastic = 0.0
    for before, after in zip(strains, strains[1:]):

        def returned(side: float) -> tuple[float, float]:
            """(stress along if there is none across, plastic strain)"""
            trial = stress + 2 * g * (midpoint(before, after) - midpoint(across, side))
            if yield_stress is None or abs(trial) <= limit(plastic):
                return trial, plastic
            flow = root(lambda p: abs(trial) - 3 * g * p - limit(plastic + p), 0.0, abs(trial) / (3 * g))
            return math.copysign(abs(trial) - 3 * g * flow, trial), plastic + flow

        bound = 5 * abs(after - before)
        side = root(lambda a: kappa * (after + 2 * a) - returned(a)[0] / 3, across - bound, across + bound)
        stress, plastic = returned(side)
        across = side
    return stress, across


def confined_modulus(young: float, poisson: float) -> float:
    return young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))


def confined_hencky(young: float, poisson: float, strain: float) -> float:
    """Kirchhoff stress along; nothing moves across."""
    return confined_modulus(young, poisson) * strain


def bar_speed(young: float, density: float) -> float:
    return math.sqrt(young / density)


def impact_stress(young_a: float, density_a: float, young_b: float, density_b: float, speed: float) -> float:
    """Of two bars that meet at this relative speed: z_a z_b/(z_a + z_b) v, z = ρ c."""
    a, b = math.sqrt(young_a * density_a), math.sqrt(young_b * density_b)
    return a * b / (a + b) * speed


def friction_limit(
    law: str,
    pressure: float,
    slip_rate: float,
    mu: float,
    largest: float = math.inf,
    kinetic: float = 0.0,
    decay: float = 0.0,
    reference: float = 1.0,
    exponent: float = 1.0,
) -> float:
    if law == "shear limited":
        return min(mu * pressure, largest)
    if law == "static-kinetic":
        return (kinetic + (mu - kinetic) * math.exp(-decay * slip_rate)) * pressure
    if law == "pressure dependent":
        return mu * (pressure / reference) ** (exponent - 1) * pressure if pressure > 0 else 0.0
    return mu * pressure


def yield_stress_of(k: Knobs, plastic: float, young: float | None = None) -> float:
    """At this plastic strain of tension along z, of the law that these knobs make."""
    if k.flow_rule == "thermal":
        return 0.75 * hardened_stress_of(k, plastic, young)
    if k.flow_rule == "backstress":
        y = k.all["yield"] * (young or k.young)
        saturated = -math.expm1(-k.recovery * plastic) / k.recovery if k.recovery else plastic
        return hardened_stress_of(k, plastic, young) + y * (k.backstress * saturated + 0.5 * plastic)
    return hardened_stress_of(k, plastic, young)


def hardened_stress_of(k: Knobs, plastic: float, young: float | None = None) -> float:
    """The same of isotropic hardening."""
    e = young or k.young
    y, h = k.all["yield"] * e, k.hardening_modulus * e
    if k.hardening == "linear":
        return y + h * plastic
    if k.hardening == "Voce":
        return y - (k.saturation - 1) * y * math.expm1(-k.saturation_rate * plastic) + h * plastic
    if k.hardening == "power law":
        return 3 * y * (1e-3 + plastic) ** k.exponent
    if k.hardening == "Ludwik":
        first = 1e-6
        return y + h * (plastic**k.exponent if plastic > first else first ** (k.exponent - 1) * plastic)
    return y + h * min(plastic, 5)
