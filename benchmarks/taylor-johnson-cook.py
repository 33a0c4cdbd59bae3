# SPDX-License-Identifier: LGPL-2.1-or-later
"""Taylor's impacts with Johnson and Cook's law, beside experiments and two other programs."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Mapping, NamedTuple

import numpy

from billet_runs import ROOT, arguments, number, publish, table
from billet_tools.scene import read_entries
from explicit_runs import ExplicitRun, norm

options = arguments("taylor-johnson-cook")

COPPER, STEEL = (read_entries(ROOT / "materials" / name) for name in ("OFHC_copper.prm", "steel_4340.prm"))
# 42CrMo4 as in the samples of DynELA, with E = 206.9 GPa and 20 degrees at first.
CHROMIUM: dict[str, object] = {
    **STEEL,
    "Young modulus": 206900,
    "Poisson ratio": 0.3,
    "Yield stress": 806,
    "Hardening coefficient": 614,
    "Hardening exponent": 0.168,
    "Rate coefficient": 0.0089,
    "Thermal exponent": 1.1,
    "Melting temperature": 1813,
    "Specific heat": 4.6e8,
}


class Impact(NamedTuple):
    """An impact: length and diameter [mm], velocity [m/s]; published length, diameter of the end, and
    diameter at 0.2 of the first length [mm] (None: not published)."""

    material: str
    constants: Mapping[str, object]
    length: float
    diameter: float
    velocity: float
    published: tuple[float, float, float | None]
    micros: float


class Result(NamedTuple):
    length: float
    end: float
    above: float
    strain: float
    rise: float


EXPERIMENTS = [
    Impact("OFHC copper", COPPER, 25.4, 7.62, 130, (19.56, 9.9, 8.9), 90),
    Impact("OFHC copper", COPPER, 25.4, 7.62, 146, (18.69, 10.7, 9.3), 90),
    Impact("OFHC copper", COPPER, 25.4, 7.62, 190, (16.2, 13.5, 10.1), 90),
    Impact("OFHC copper", COPPER, 23.47, 7.62, 210, (0.643 * 23.47, 16.6, 9.9), 90),
    Impact("4340 steel", STEEL, 25.4, 7.62, 208, (22.48, 11.1, 8.3), 60),
    Impact("4340 steel", STEEL, 12.7, 7.62, 282, (10.71, 10.4, 8.7), 40),
    Impact("4340 steel", STEEL, 8.1, 7.62, 343, (6.545, 12.0, 9.5), 30),
]
CODES = Impact("42CrMo4", CHROMIUM, 32.4, 6.4, 287, (26.53, 11.18, None), 80)


def run(impact: Impact, refinements: int) -> Result:
    """Runs an impact. The mantle's radius at a height is that between the nodes next to it."""
    bar, radius = "Bodies/bar/", impact.diameter / 2
    layers = round(10 * 2 ** (refinements - 1) * impact.length / impact.diameter / 1.67)
    with tempfile.TemporaryDirectory() as folder:
        done = ExplicitRun(
            Path(__file__).with_name("taylor_johnson_cook.prm"),
            {
                **{bar + "Material/" + key: value for key, value in impact.constants.items()},
                bar + "Mesh/Refinements": refinements,
                bar + "Mesh/Arguments": f"0, 0 : {radius}",
                bar + "Mesh/Section area": numpy.pi * radius**2 / 4,
                bar + "Mesh/Height": impact.length,
                bar + "Mesh/Layers": layers,
                bar + "Initial velocity": f"0 ; 0 ; {-1e3 * impact.velocity}",
                "Time stepping/End time": impact.micros * 1e-6,
                "Output/Interval": 0,
            },
            Path(folder),
            options.ranks,
        )
        points, fields = done.picture()
    r = norm(points, (0, 1))
    heights = points[:, 2] - points[:, 2].min()
    mantle = norm(fields["undeformed_coordinates"], (0, 1)) > (1 - 1e-6) * radius
    order = numpy.argsort(heights[mantle])
    above = numpy.interp(0.2 * impact.length, heights[mantle][order], r[mantle][order])
    return Result(
        float(heights.max()),
        2 * float(r.max()),
        2 * float(above),
        float(fields["equivalent_plastic_strain"].max()),
        float(fields["state_temperature_rise"].max()),
    )


def beside(value: float, published: float | None) -> str:
    return number(value, 4) + ("" if published is None else f" ({100 * (value / published - 1):+.1f} %)")


def rows(impact: Impact, refinements: int) -> list[object]:
    r = run(impact, refinements)
    said = [beside(value, known) for value, known in zip((r.length, r.end, r.above), impact.published)]
    return [
        impact.material,
        f"{impact.length:g}",
        f"{impact.velocity:g}",
        12 * 4 ** (refinements - 1),
        *said,
        number(r.strain, 3),
        number(r.rise, 3),
    ]


HEAD = [
    "material",
    "first length [mm]",
    "velocity [m/s]",
    "bricks in the section",
    "length [mm]",
    "diameter of the end [mm]",
    "diameter at 0.2 of the first length [mm]",
    "largest plastic strain",
    "largest rise of temperature [K]",
]
meshes = (1,) if options.quick else (1, 2)
finer = [] if options.quick else [rows(EXPERIMENTS[i], 2) for i in (2, 4)]
publish(
    "taylor-johnson-cook",
    "Taylor's impacts with Johnson and Cook's law",
    options,
    (
        "Bars hit a rigid wall without friction. Their material has Johnson and Cook's flow stress, and is"
        " heated by plastic work. Constants are those of `materials`, with nothing fitted.\n\n"
        "Elements have one point. Each run is done once. Deviations from the published values stand in"
        " brackets."
    ),
    "## Beside experiments",
    (
        "Copper bars are 7.62 mm thick, and so are those of steel. Experiments: Johnson & Cook (1983) and"
        " Wilkins & Guinan (1973), as collected in the public set HighRateExptData. Repeated shots differ by"
        " 2 to 3 % in length and 3 to 6 % in diameter. The diameter of the end depends on friction, which the"
        " model leaves out. End diameters of steel are read from pictures."
    ),
    table(HEAD, [rows(impact, 1) for impact in EXPERIMENTS] + finer),
    "## Beside other programs",
    (
        "A bar of 42CrMo4 steel is 6.4 mm thick. Published values are means of two programs in three"
        " dimensions: DynELA and Abaqus, as the manual of DynELA has them. They differ by 0.4 % from each"
        " other. The middle of the end has a plastic strain of 1.84 there, and is 577 K warmer."
    ),
    table(HEAD, [rows(CODES, mesh) for mesh in meshes]),
)
