# SPDX-License-Identifier: LGPL-2.1-or-later
"""Laws beyond linear hardening: their parameters in a scene, and what they say of one brick, computed here
without the program. Stresses are Kirchhoff stresses, strains logarithmic ones, all in base units."""

from __future__ import annotations

import math
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Sequence, Union

import numpy
from billet_tools.output import Array

from . import closed_forms
from .frame import Frame, number

if TYPE_CHECKING:
    from .scenes import Knobs

Three = tuple[float, float, float]
Steps = Union[Sequence[float], Array]
RUBBER = ("Mooney-Rivlin", "Yeoh", "Ogden", "Arruda-Boyce")
VOLUMETRIC = ("logarithmic", "quadratic", "Ogden")
RATE_FACTORS = ("Cowper-Symonds", "Johnson-Cook", "table")
THERMAL_FACTORS = ("Johnson-Cook", "table")
# What turns the constants of a rubber, and is used where nothing is turned.
CONSTANT = {"Mooney-Rivlin": 0.2, "Yeoh": 0.01, "Arruda-Boyce": 3.0}
TRELOAR = ((0.63, 1.3), (0.0012, 5.0), (-0.01, -2.0))
COLD, MELTING = 300.0, 1300.0
HEATS = 0.9  # the part of plastic work that does
UMAT = Path(__file__).resolve().parents[3] / "tests/cli/umat/umat.f90"
LIBRARY = "libumat.so"


def compiler() -> str | None:
    """Of the library with the UMAT."""
    return shutil.which("gfortran")


def is_plastic(k: Knobs) -> bool:
    return k.law in ("elastoplastic", "UMAT")


def loaded(k: Knobs, times: Array) -> Array:
    """The load over the time of a scene, both as parts of the whole."""
    if k.cycles:
        return numpy.asarray(numpy.sin(2 * math.pi * (k.cycles + 0.25) * times))
    return numpy.minimum(times / k.ramp, 1.0)


def solve(function: Callable[[float], float], low: float, high: float) -> float:
    """The root of a function with one change of sign between low and high, by the rule of Illinois; by
    bisection where that is slow."""
    f_low, f_high, side = function(low), function(high), 0
    if (f_low > 0) == (f_high > 0):
        return closed_forms.root(function, low, high)
    for count in range(200):
        x = 0.5 * (low + high) if count % 8 == 7 else (low * f_high - high * f_low) / (f_high - f_low)
        if not low < x < high:
            x = 0.5 * (low + high)
        f = function(x)
        if f == 0 or x in (low, high) or high - low <= 1e-15 * max(abs(low), abs(high)):
            return x
        if (f > 0) == (f_low > 0):
            low, f_low = x, f
            f_high *= 0.5 if side < 0 else 1.0
            side = -1
        else:
            high, f_high = x, f
            f_low *= 0.5 if side > 0 else 1.0
            side = 1
    return x


# --- elasticity -----------------------------------------------------------------------------------

CHAINS = (1 / 2, 1 / 20, 11 / 1050, 19 / 7000, 519 / 673750)


@dataclass
class Elastic:
    """Energies of principal strains: Ogden's terms (µ, α), and coefficients of powers of I1 - 3 or of I1; a
    `volumetric` law with its bulk modulus."""

    bulk: float
    volumetric: str = "logarithmic"
    hencky: float = 0.0  # shear modulus
    terms: Sequence[tuple[float, float]] = ()
    excess: Sequence[float] = ()  # of (I1 - 3), (I1 - 3)², ...
    powers: Sequence[float] = ()  # of I1 - 3, I1² - 9, ...

    @classmethod
    def of(cls, k: Knobs, young: float | None = None) -> Elastic:
        e = young or k.young
        bulk, shear = closed_forms.bulk(e, k.nu), closed_forms.shear(e, k.nu)
        law, c = k.kinematics, k.constant or CONSTANT.get(k.kinematics, 0.0)
        if law == "Hencky":
            return cls(bulk, hencky=shear)
        if law == "neo-Hookean":
            return cls(bulk, excess=(0.5 * shear,))
        if law == "Mooney-Rivlin":
            return cls(bulk, k.volumetric, terms=((shear * (1 - c), 2.0), (-shear * c, -2.0)))
        if law == "Yeoh":
            return cls(bulk, k.volumetric, excess=[0.5 * shear * part for part in (1.0, c, 0.1 * c)])
        if law == "Ogden" and c:
            return cls(bulk, k.volumetric, terms=((2 * shear / c, c),))
        if law == "Ogden":
            unit = 2 * shear / sum(m * a for m, a in TRELOAR)
            return cls(bulk, k.volumetric, terms=[(m * unit, a) for m, a in TRELOAR])
        if law == "Arruda-Boyce":
            return cls(
                bulk,
                k.volumetric,
                powers=[chain_modulus(shear, c) * a * c ** (-2 * i) for i, a in enumerate(CHAINS)],
            )
        raise ValueError(f"{law} has no energy")

    def _isochoric(self, e: Three) -> tuple[float, Three, float]:
        mean = sum(e) / 3
        x, y, z = (value - mean for value in e)
        return math.expm1(2 * x) + math.expm1(2 * y) + math.expm1(2 * z), (x, y, z), 3 * mean

    def deviator(self, e: Three) -> Three:
        """Of the stress."""
        over, strains, _ = self._isochoric(e)
        slope = sum(i * c * over ** (i - 1) for i, c in enumerate(self.excess, 1))
        slope += sum(i * c * (over + 3) ** (i - 1) for i, c in enumerate(self.powers, 1))
        t = [
            2 * self.hencky * x
            + sum(m * math.expm1(a * x) for m, a in self.terms)
            + 2 * slope * math.expm1(2 * x)
            for x in strains
        ]
        mean = sum(t) / 3
        return t[0] - mean, t[1] - mean, t[2] - mean

    def pressure(self, e: Three) -> float:
        """The mean stress; tension is positive."""
        volume = sum(e)
        if self.volumetric == "quadratic":
            return self.bulk * math.exp(volume) * math.expm1(volume)
        if self.volumetric == "Ogden":
            return -self.bulk / 9 * math.expm1(-9 * volume)
        return self.bulk * volume

    def stresses(self, e: Three) -> Three:
        p, t = self.pressure(e), self.deviator(e)
        return p + t[0], p + t[1], p + t[2]

    def energy(self, e: Three) -> float:
        """Per volume of the undeformed body."""
        over, strains, volume = self._isochoric(e)
        w = self.hencky * sum(x * x for x in strains)
        w += sum(m / a * sum(math.expm1(a * x) for x in strains) for m, a in self.terms)
        w += sum(c * over**i for i, c in enumerate(self.excess, 1))
        w += sum(c * ((over + 3) ** i - 3.0**i) for i, c in enumerate(self.powers, 1))
        if self.volumetric == "quadratic":
            return w + 0.5 * self.bulk * math.expm1(volume) ** 2
        if self.volumetric == "Ogden":
            return w + self.bulk / 81 * (9 * volume + math.expm1(-9 * volume))
        return w + 0.5 * self.bulk * volume**2


def chain_modulus(shear: float, locking: float) -> float:
    """Of Arruda and Boyce, for this shear modulus at small strains."""
    return shear / (2 * sum(i * c * 3.0 ** (i - 1) * locking ** (2 - 2 * i) for i, c in enumerate(CHAINS, 1)))


def uniaxial(strain: float, side: float) -> Three:
    return side, side, strain


def equibiaxial(strain: float, side: float) -> Three:
    return strain, strain, side


Mode = Callable[[float, float], Three]


def free_of(mode: Mode) -> int:
    """The direction without a stress."""
    return 0 if mode is uniaxial else 2


def relaxing(
    law: Elastic,
    mode: Mode,
    strains: Steps,
    times: Steps,
    terms: Sequence[tuple[float, float]] = (),
) -> tuple[Three, float]:
    """(stresses, strain of the free direction) at the last of the strains, which are reached at these times
    from 0 on. Of the deviator shares relax, `terms` (share, time); within a step it is linear in time."""
    free, rest = free_of(mode), 1 - sum(g for g, _ in terms)
    before: Three = (0.0, 0.0, 0.0)
    held = [before for _ in terms]
    side = 0.0
    total = before
    for last, strain, step in zip((0.0, *strains), strains, numpy.diff((0.0, *times))):
        y = [float(step) / time for _, time in terms]
        keeps = [math.exp(-x) for x in y]
        gains = [g * (-math.expm1(-x) / x if x else 1.0) for (g, _), x in zip(terms, y)]

        def made(a: float) -> tuple[Three, Three, list[Three]]:
            e = mode(strain, a)
            t, p = law.deviator(e), law.pressure(e)
            h = [
                tuple(keep * old + gain * (new - was) for old, new, was in zip(hold, t, before))
                for keep, gain, hold in zip(keeps, gains, held)
            ]
            whole = tuple(p + rest * t[i] + sum(one[i] for one in h) for i in range(3))
            return whole, t, h  # type: ignore[return-value]

        bound = 4 * abs(strain - last) + abs(strain)
        side = solve(lambda a: made(a)[0][free], side - bound, side + bound)
        total, before, held = made(side)
    return total, side


def terms_of(k: Knobs, end: float) -> list[tuple[float, float]]:
    """Shares that relax, and their times; of a scene that lasts until `end`."""
    if not k.prony:
        return []
    return [(0.6 * k.prony, k.relaxation * end), (0.4 * k.prony, 10 * k.relaxation * end)]


# --- plasticity -----------------------------------------------------------------------------------


def rate_factor(k: Knobs, rate: float, reference: float) -> float:
    """`rate` of the plastic strain; `reference`: that of the factor."""
    x = rate / reference
    if k.rate_factor == "Cowper-Symonds":
        return 1 + max(x, 0.0) ** (1 / k.rate_exponent)
    if k.rate_factor == "Johnson-Cook":
        return 1 + k.rate_coefficient * math.log(x) if x > 1 else 1.0
    if k.rate_factor == "table":
        return float(numpy.interp(x, (0, 0.01, 1, 100), (1, 1.2, 2, 5)))
    return 1.0


def thermal_factor(k: Knobs, temperature: float) -> float:
    part = (temperature - COLD) / (MELTING - COLD)
    if k.thermal_factor == "Johnson-Cook":
        return 1 - min(part, 1 - 1e-6) ** k.thermal_exponent if part > 0 else 1.0
    if k.thermal_factor == "table":
        return float(numpy.interp(part, (0, 0.5, 1), (1, 0.5, 0.05)))
    return 1.0


def temperature_of(k: Knobs) -> float:
    return COLD + k.temperature * (MELTING - COLD)


def capacity(k: Knobs, young: float | None = None) -> float:
    """ρc: work at the first yield stress heats by `heat` times the way to melting, per plastic strain."""
    return float(HEATS * k.all["yield"] * (young or k.young) / (k.heat * (MELTING - COLD)))


def hill(k: Knobs) -> tuple[float, float, float, float, float, float]:
    """F, G, H, L, M, N of Hill's function, in the material axes."""
    r = k.r_value
    g = 1 / (1 + r)
    return g, g, r * g, 1.5, 1.5, 2 * g * (r + 0.5)


# The material axes 1, 2, 3 along z if it is pulled along the `first`, `second` or third of them.
AXES = {
    "first": ((0, 0, 1), (1, 0, 0)),
    "second": ((0, 1, 0), (0, 0, 1)),
    "third": ((1, 0, 0), (0, 1, 0)),
}


def hill_of_stress(k: Knobs) -> Array:
    """Q² as a quadratic form of the stresses xx, yy, zz, xy, yz, xz, at rest."""
    f, g, h, l, m, n = hill(k)
    of_axes = numpy.zeros((6, 6))
    of_axes[:3, :3] = [[g + h, -h, -g], [-h, f + h, -f], [-g, -f, f + g]]
    of_axes[3, 3], of_axes[4, 4], of_axes[5, 5] = 2 * n, 2 * l, 2 * m  # 12, 23, 13
    first, second = (list(axis).index(1) for axis in AXES[k.pulled])
    axes = (first, second, 3 - first - second)  # the direction of each axis
    pairs = [{0}, {1}, {2}, {0, 1}, {1, 2}, {0, 2}]
    to = [pairs.index({axes[i] for i in pair}) for pair in pairs]
    form = numpy.zeros((6, 6))
    form[numpy.ix_(to, to)] = of_axes
    return form


def mises_over_hill(k: Knobs) -> float:
    """The largest that von Mises' stress may be over Hill's."""
    mises = numpy.zeros((6, 6))
    mises[:3, :3] = 1.5 * numpy.eye(3) - 0.5
    mises[3:, 3:] = 3 * numpy.eye(3)
    # on deviators: two of the normal stresses are free
    basis = numpy.zeros((6, 5))
    basis[:3, 0], basis[:3, 1] = (1, -1, 0), (1, 1, -2)
    basis[3:, 2:] = numpy.eye(3)
    ratio = numpy.linalg.solve(basis.T @ hill_of_stress(k) @ basis, basis.T @ mises @ basis)
    return math.sqrt(max(numpy.linalg.eigvals(ratio).real))


@dataclass
class Flow:
    """Of a bar along z. `strength`: its stress over the flow stress, of `sides` its plastic strains across
    over that along; backstress terms (modulus, recovery)."""

    k: Knobs
    reference: float = 1.0
    young: float = 0.0

    def __post_init__(self) -> None:
        self.young = self.young or self.k.young
        self.strength, self.sides = 1.0, (-0.5, -0.5)
        if self.k.r_value is not None:
            form = hill_of_stress(self.k)
            self.strength = 1 / math.sqrt(form[2, 2])
            self.sides = (form[0, 2] / form[2, 2], form[1, 2] / form[2, 2])
        y = self.k.all["yield"] * self.young
        self.terms = (
            [(self.k.backstress * y, self.k.recovery), (0.5 * y, 0.0)]
            if self.k.flow_rule == "backstress"
            else []
        )

    def cold(self, plastic: float) -> float:
        stress = closed_forms.hardened_stress_of(self.k, plastic, self.young)
        return 0.75 * stress if self.k.flow_rule == "thermal" else stress

    def work(self, before: float, after: float) -> float:
        """Of the curve of hardening, by Gauss' rule."""
        nodes, weights = numpy.polynomial.legendre.leggauss(6)
        half = 0.5 * (after - before)
        return half * sum(w * self.cold(before + half * (1 + x)) for x, w in zip(nodes, weights))

    def heated(self, before: float, after: float, factor: float, temperature: float) -> float:
        """The temperature after a step from plastic strain `before` to `after`."""
        if not self.k.heat or after <= before:
            return temperature
        rise = HEATS / capacity(self.k, self.young) * factor * self.work(before, after)
        return solve(
            lambda t: t - temperature - rise * thermal_factor(self.k, t), temperature, temperature + rise
        )

    def work_of_backstress(self, backs: list[float], gain: float, da: float) -> float:
        """Work on a plastic strain `gain` along, while the equivalent one grows by `da`: ∫ x dε of
        dx = C dε - g x dα."""
        rate, work = gain / da, 0.0
        for (c, g), x in zip(self.terms, backs):
            if g > 0:
                lost = -math.expm1(-g * da) / g
                work += rate * (x * lost + c * rate / g * (da - lost))
            else:
                work += rate * (x * da + 0.5 * c * rate * da * da)
        return work

    def bar(self, strains: Steps, times: Steps) -> tuple[float, Three, float, float]:
        """(stress, strains, equivalent plastic strain, temperature) at the last of the strains, reached at
        these times from 0 on; each step is monotone."""
        k, e = self.k, self.young
        plastic, alpha, stress = 0.0, 0.0, 0.0
        backs = [0.0 for _ in self.terms]
        temperature = temperature_of(k)
        for strain, step in zip(strains, numpy.diff((0.0, *times))):
            sign = math.copysign(1.0, e * (strain - plastic) - sum(backs))

            def after(da: float) -> tuple[float, float, list[float], float]:
                """(yield function, plastic strain, backstresses, temperature)"""
                gain = sign * da / self.strength
                new = []
                for (c, g), x in zip(self.terms, backs):
                    decay = g * da
                    new.append(
                        x * math.exp(-decay) + c * gain * (-math.expm1(-decay) / decay if decay else 1.0)
                    )
                factor = rate_factor(k, da / float(step), self.reference)
                warm = self.heated(alpha, alpha + da, factor, temperature)
                limit = self.cold(alpha + da) * factor * thermal_factor(k, warm)
                q = sign * (e * (strain - plastic - gain) - sum(new)) / self.strength
                return q - limit, plastic + gain, new, warm

            da = 0.0
            if after(0.0)[0] > 0:
                most = abs(e * (strain - plastic) - sum(backs)) * self.strength / e
                da = solve(lambda x: after(x)[0], 0.0, most)
            old = plastic
            _, plastic, new, temperature = after(da)
            if k.heat and da > 0:  # heats at the end of the step
                temperature += HEATS / capacity(k, e) * self.work_of_backstress(backs, plastic - old, da)
            backs = new
            alpha += da
            stress = e * (strain - plastic)
        elastic = stress / e
        x, y = (-k.nu * elastic + side * plastic for side in self.sides)
        return stress, (x, y, strains[-1] if len(strains) else 0.0), alpha, temperature


def is_special(k: Knobs) -> bool:
    """Whether a bar needs `Flow.bar`: its stress depends on the path, or it is not von Mises' one."""
    return bool(
        k.rate_factor != "none" or k.thermal_factor != "none" or k.r_value is not None or k.cycles
    ) and (k.law == "elastoplastic")


def yield_limit(
    k: Knobs,
    plastic: float,
    young: float | None = None,
    rate: float = 0.0,
    reference: float = 1.0,
    temperature: float = COLD,
) -> float:
    """The largest that von Mises' stress may be, whatever the path."""
    e = young or k.young
    limit = Flow(k, young=e).cold(plastic) * rate_factor(k, rate, reference) * thermal_factor(k, temperature)
    return (limit + largest_backstress(k, plastic, e)) * (mises_over_hill(k) if k.r_value is not None else 1)


def largest_backstress(k: Knobs, plastic: float, young: float | None = None) -> float:
    """What a backstress may have grown to on any path, as part of von Mises' stress."""
    if k.flow_rule != "backstress":
        return 0.0
    terms = Flow(k, young=young or k.young).terms
    return sum(-c / g * math.expm1(-g * plastic) if g else c * plastic for c, g in terms)


# --- in a scene -----------------------------------------------------------------------------------


def parameters(
    k: Knobs, f: Frame, material: dict[str, Any], young: float, end: float, rate: float
) -> dict[str, Any]:
    """The `material` with what its law has beyond what scenes.material gives. `end` of the scene, `rate` of
    its strains."""
    m = dict(material)
    if k.law == "UMAT":
        y, h = k.all["yield"] * young * f.stress, k.hardening_modulus * young * f.stress
        return {
            "Law": "UMAT",
            "Library": f"./{LIBRARY}",
            "Constants": ", ".join(map(number, (young * f.stress, k.nu, y, h))),
            "State variables": 1,
            "State variable names": "equivalent plastic strain",
            **{name: value for name, value in m.items() if name == "Density"},
        }
    if k.kinematics in RUBBER:
        m.pop("Young modulus")
        m.update(rubber(k, f, young))
    terms = terms_of(k, end)
    if terms:
        m["Prony moduli"] = ", ".join(number(g) for g, _ in terms)
        m["Prony times"] = ", ".join(number(t * f.time) for _, t in terms)
    reference = rate / k.rate / f.time
    if k.rate_factor == "Cowper-Symonds":
        m.update({"Reference rate": number(reference), "Rate exponent": number(k.rate_exponent)})
    elif k.rate_factor == "Johnson-Cook":
        m.update({"Lowest rate": number(reference), "Rate coefficient": number(k.rate_coefficient)})
    elif k.rate_factor == "table":
        m["Rate table"] = ", ".join(
            f"{number(x * reference)} : {number(y)}" for x, y in ((0.01, 1.2), (1, 2), (100, 5))
        )
    if k.rate_factor != "none":
        m["Rate factor"] = k.rate_factor
    if k.thermal_factor != "none":
        m.update(thermal(k, f, young, m))
    if k.r_value is not None:
        first, second = AXES[k.pulled]
        m.update(
            {
                "Anisotropy": "Hill",
                "r-values": ", ".join([number(k.r_value)] * 3),
                "Axes": "local",
                "First axis": f.vector(first),
                "Second axis": f.vector(second),
            }
        )
    return m


def rubber(k: Knobs, f: Frame, young: float) -> dict[str, Any]:
    law, constant = Elastic.of(k, young), k.constant or CONSTANT.get(k.kinematics, 0.0)
    m: dict[str, Any] = {"Elasticity": k.kinematics}
    if k.volumetric != "logarithmic":
        m["Volumetric law"] = k.volumetric
    if k.kinematics == "Mooney-Rivlin":
        m["C10"], m["C01"] = (number(abs(t) * 0.5 * f.stress) for t, _ in law.terms)
    elif k.kinematics == "Yeoh":
        m.update({f"C{i}0": number(c * f.stress) for i, c in enumerate(law.excess, 1)})
    elif k.kinematics == "Ogden":
        m["Ogden moduli"] = ", ".join(number(t * f.stress) for t, _ in law.terms)
        m["Ogden exponents"] = ", ".join(number(a) for _, a in law.terms)
    else:
        shear = closed_forms.shear(young, k.nu)
        m["Chain modulus"] = number(chain_modulus(shear, constant) * f.stress)
        m["Locking stretch"] = number(constant)
    return m


def thermal(k: Knobs, f: Frame, young: float, material: dict[str, Any]) -> dict[str, Any]:
    m: dict[str, Any] = {"Thermal factor": k.thermal_factor, "Temperature": number(temperature_of(k))}
    if k.thermal_factor == "Johnson-Cook":
        m.update(
            {
                "Reference temperature": number(COLD),
                "Melting temperature": number(MELTING),
                "Thermal exponent": number(k.thermal_exponent),
            }
        )
    else:
        points = ((0.0, 1.0), (0.5, 0.5), (1.0, 0.05))
        m["Thermal table"] = ", ".join(
            f"{number(COLD + x * (MELTING - COLD))} : {number(y)}" for x, y in points
        )
    if k.heat:
        density = float(material.get("Density", k.density * f.density))
        m.update(
            {
                "Density": number(density),
                "Taylor-Quinney fraction": number(HEATS),
                "Specific heat": number(capacity(k, young) * f.stress / density),
            }
        )
    return m
