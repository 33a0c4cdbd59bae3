# SPDX-License-Identifier: LGPL-2.1-or-later
"""Uniaxial tension of the shipped materials: a scene, and its force from the constants in their files."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Callable

Constants = dict[str, str]


def constants_of(file: Path) -> Constants:
    """Returns the parameters that a file sets."""
    return dict(re.findall(r"^set (.*?) *= *(.*?) *$", file.read_text(encoding="utf-8"), re.MULTILINE))


def bisect(function: Callable[[float], float], low: float, high: float) -> float:
    """Returns where an ascending function is 0."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if function(middle) > 0 else (middle, high)
    return 0.5 * (low + high)


def johnson_cook_stress(constants: Constants, strain: float, rate: float) -> float:
    """Returns Kirchhoff's stress at a logarithmic strain reached at a constant rate, heated by plastic work.

    s = (A + B e^n) (1 + C ln(rate/rate_0)) (1 - T*^m), dT = b s de / (rho c).
    """
    value = {name: float(text) for name, text in constants.items() if re.fullmatch(r"[-+.\de]+", text)}
    lowest = value["Lowest rate"]
    of_rate = 1 + value["Rate coefficient"] * math.log(max(rate / lowest, 1))
    span = value["Melting temperature"] - value["Reference temperature"]
    heat = value["Taylor-Quinney fraction"] / (value["Density"] * value["Specific heat"])

    def stress(plastic: float, rise: float) -> float:
        cold = value["Yield stress"] + value["Hardening coefficient"] * plastic ** value["Hardening exponent"]
        start = value["Temperature"] - value["Reference temperature"]
        return cold * of_rate * (1 - max((start + rise) / span, 0) ** value["Thermal exponent"])

    plastic, rise, elastic = 0.0, 0.0, value["Young modulus"]
    while plastic + stress(plastic, rise) / elastic < strain:
        step = max(1e-7, 1e-3 * plastic)
        step = min(step, strain - plastic - stress(plastic, rise) / elastic + 1e-12)
        middle = rise + 0.5 * step * heat * stress(plastic, rise)
        rise += step * heat * stress(plastic + 0.5 * step, middle)
        plastic += step
    return stress(plastic, rise)


def isothermal_stress(constants: Constants, strain: float) -> float:
    """Returns Kirchhoff's stress of the power law or of Voce's, with a linear elastic part."""
    if constants["Hardening"] == "Voce":
        first, last, rate = (
            float(constants[name]) for name in ("Yield stress", "Saturation stress", "Saturation rate")
        )

        def flow(plastic: float) -> float:
            return last - (last - first) * math.exp(-rate * plastic)

    else:
        strength, prestrain, exponent = (
            float(constants[name]) for name in ("Strength coefficient", "Prestrain", "Hardening exponent")
        )

        def flow(plastic: float) -> float:
            return strength * (prestrain + plastic) ** exponent

    young = float(constants["Young modulus"])
    return flow(bisect(lambda plastic: flow(plastic) / young + plastic - strain, 0, strain))


def rubber_stress(constants: Constants, stretch: float) -> float:
    """Returns Kirchhoff's stress of a rubber with the logarithmic volumetric law."""
    law = constants["Elasticity"]
    if law == "Ogden":
        moduli, exponents = (
            [float(part) for part in constants[name].split(",")]
            for name in ("Ogden moduli", "Ogden exponents")
        )
        shear = sum(m * a for m, a in zip(moduli, exponents)) / 2
    else:
        c10, c01, c20, c30 = (float(constants.get(name, "0")) for name in ("C10", "C01", "C20", "C30"))
        shear = 2 * (c10 + c01)
    poisson = float(constants["Poisson ratio"])
    bulk = 2 * shear * (1 + poisson) / (3 * (1 - 2 * poisson))

    def part(squares: list[float], square: float) -> float:
        if law == "Ogden":
            return sum(m * square ** (a / 2) for m, a in zip(moduli, exponents))
        excess = sum(squares) - 3
        return 2 * ((c10 + 2 * c20 * excess + 3 * c30 * excess**2) * square - c01 / square)

    def stresses(lateral: float) -> tuple[float, float]:
        volume = stretch * lateral**2
        squares = [x**2 * volume ** (-2 / 3) for x in (stretch, lateral, lateral)]
        parts = [part(squares, square) for square in squares]
        mean = sum(parts) / 3
        return parts[1] - mean + bulk * math.log(volume), parts[0] - mean + bulk * math.log(volume)

    return stresses(bisect(lambda lateral: stresses(lateral)[0], 0.2, 1.5))[1]


def tension(constants: Constants, stretch: float, rate: float) -> float:
    """Returns the force on a unit cube at a stretch that it reaches at a constant logarithmic rate."""
    if "Elasticity" in constants:
        stress = rubber_stress(constants, stretch)
    elif "Rate factor" in constants:
        stress = johnson_cook_stress(constants, math.log(stretch), rate)
    else:
        stress = isothermal_stress(constants, math.log(stretch))
    return stress / stretch


def tension_scene(name: str, stretch: float, rate: float, n_steps: int = 100) -> str:
    """Returns the scene of a unit cube of a shipped material, pulled at a constant logarithmic rate."""
    end = math.log(stretch) / rate
    return f"""
subsection Bodies
  subsection cube
    set Symmetry planes = x = 0 ; y = 0 ; z = 0
    subsection Mesh
      set Primitive = hyper_cube
    end
    subsection Material
      include materials/{name}
    end
    subsection Supports
      subsection head
        set Boundary ids = 1
        set Components   = x
        set Displacement = exp({rate!r}*t) - 1
      end
    end
  end
end
subsection Time stepping
  set End time     = {end!r}
  set Step control = fixed
  set Initial step = {end / n_steps!r}
end
subsection Solver
  set Force tolerance = 1e-8
end
subsection Output
  set Format = none
end
"""
