# SPDX-License-Identifier: LGPL-2.1-or-later
"""A rigid sphere on an elastic half-space: force, contact radius and pressure against Hertz, over mesh and
penalty."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Iterable, Sequence

import numpy

from billet_runs import ROOT, Run, arguments, number, publish, table
from billet_tools.output import pictures_of, read_grid

options = arguments("hertz-contact")
E, NU, RADIUS, A = 1000.0, 0.3, 10.0, 0.1
EFFECTIVE = E / (1 - NU**2)


def grid(n: int, far: float) -> list[float]:
    """n elements over the contact radius and a half, then each longer than the last, `far` contact radii in
    all at least."""
    x, step, growth = [0.0], A / n, 1.45 ** (6 / n)
    while x[-1] < 1.49 * A:
        x.append(x[-1] + step)
    while x[-1] < far * A:
        step *= growth
        x.append(x[-1] + step)
    return x


def write_mesh(path: Path, x: Sequence[float]) -> None:
    """A quarter of the half-space as a Gmsh file; boundary 1: x = 0, 2: y = 0, 3: top, 4: far away."""
    n, m = len(x), len(x) - 1

    def node(i: int, j: int, k: int) -> int:
        return 1 + i + n * (j + n * k)

    with open(path, "w") as out:
        out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{n**3}\n")
        for k in range(n):
            for j in range(n):
                for i in range(n):
                    out.write(f"{node(i, j, k)} {x[i]!r} {x[j]!r} {-x[k]!r}\n")
        elements = []
        for p in range(m):
            for q in range(m):
                for kind, at in (
                    (1, lambda a, b: node(0, a, b)),
                    (4, lambda a, b: node(m, a, b)),
                    (2, lambda a, b: node(a, 0, b)),
                    (4, lambda a, b: node(a, m, b)),
                    (3, lambda a, b: node(a, b, 0)),
                    (4, lambda a, b: node(a, b, m)),
                ):
                    corners = at(p, q), at(p + 1, q), at(p + 1, q + 1), at(p, q + 1)
                    elements.append(f"3 2 {kind} {kind} " + " ".join(map(str, corners)))
        for k in range(m):
            for j in range(m):
                for i in range(m):
                    nodes = [
                        node(i + a, j + b, k + c) for c in (1, 0) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))
                    ]
                    elements.append("5 2 0 0 " + " ".join(map(str, nodes)))
        out.write(f"$EndNodes\n$Elements\n{len(elements)}\n")
        out.writelines(f"{i + 1} {text}\n" for i, text in enumerate(elements))
        out.write("$EndElements\n")


def contact(folder: str | Path) -> tuple[float, float]:
    """Radius and largest pressure, from p² = p_0² (1 − r²/a²) over the nodes well inside."""
    fields = read_grid(pictures_of(Path(folder, "results"))[-1])
    start, pressure = fields["points"] - fields["displacement"], fields["contact_pressure"]
    square = start[:, 0] ** 2 + start[:, 1] ** 2
    inside = (pressure > 0) & (square < 0.7 * A**2)
    places = dict(
        zip(
            zip(start[inside, 0].round(6), start[inside, 1].round(6)),
            zip(square[inside], pressure[inside] ** 2),
        )
    )
    r2, p2 = numpy.array(list(places.values())).T
    slope, top = numpy.polyfit(r2, p2, 1)
    return math.sqrt(top / -slope), math.sqrt(top)


def solve(n: int, far: float, penalty: float, sphere: float = RADIUS) -> tuple[float, int, Run, list[float]]:
    """Extent over A, bricks, the run, and the errors in percent of force, contact radius and largest
    pressure."""
    x = grid(n, far)
    with tempfile.TemporaryDirectory() as folder:
        write_mesh(Path(folder, "half_space.msh"), x)
        r = Run(
            {
                "Output/Format": "vtu",
                "Output/Step interval": 0,
                "Contact pairs/pair/Normal penalty": penalty,
                "Tools/sphere/Surfaces/all/Centre": f"0, 0, {sphere!r}",
                "Tools/sphere/Surfaces/all/Radius": repr(sphere),
                "Tools/sphere/Motion/Translation": f"0 ; 0 ; {-A**2 / sphere:.12g}*t",
            },
            options.ranks,
            ROOT / "tests/scenes/hertz.prm",
            "sphere",
            folder,
        )
        radius, pressure = contact(folder)
    force = 1e3 * r.forces[-1]  # four quarters, in units of the scene
    exact = 4 / 3 * EFFECTIVE * A**3 / sphere, A, 2 * EFFECTIVE * A / (math.pi * sphere)
    errors = [100 * (value / right - 1) for value, right in zip((force, radius, pressure), exact)]
    return x[-1] / A, (len(x) - 1) ** 3, r, errors


def signed(values: Iterable[float]) -> list[str]:
    return [f"{value:+.2f}" for value in values]


def row(n: int, far: float, penalty: float) -> list[object]:
    extent, bricks, r, errors = solve(n, far, penalty)
    return [n, f"{extent:.0f}", penalty, bricks, r.iterations, number(r.seconds)] + signed(errors)


def to_infinity(n: int, sphere: float) -> list[object]:
    """The force's error at two extents, and where it goes, as one over the extent."""
    (x, _, _, (near, *_)), (y, _, _, (far, *_)) = solve(n, 120, 1000, sphere), solve(n, 480, 1000, sphere)
    pressure = 200 * A / (math.pi * sphere) / (1 - NU**2)  # % of E
    return [
        n,
        number(pressure),
        f"{x:.0f} and {y:.0f}",
        *signed([near, far, far + (far - near) * x / (y - x)]),
    ]


HEAD = [
    "elements over the radius",
    "extent / radius",
    "penalty factor",
    "bricks",
    "iterations",
    "CPU seconds",
    "force [%]",
    "contact radius [%]",
    "largest pressure [%]",
]
meshes = (4, 6, 8) if options.quick else (4, 6, 8, 10)
publish(
    "hertz-contact",
    "Hertz: a rigid sphere on an elastic half-space",
    options,
    (
        "This page compares force, contact radius and pressure with Hertz's closed form, without friction,"
        " at a travel of a²/R. Refine mesh, extent and penalty together: the penalty lets the half-space in"
        " by p/k, and the far boundary, which is held, stiffens it. The largest pressure is 0.7 % of E unless"
        " the table says otherwise. Each run is done once."
    ),
    "## Mesh, with a hundred times the default penalty factor\n\n"
    + table(HEAD, [row(n, 120, 1000) for n in meshes]),
    "## Penalty factor; 10 is the default\n\n" + table(HEAD, [row(6, 120, k) for k in (1, 10, 100, 1000)]),
    "## Extent\n\n"
    "The held boundary takes away a displacement that falls with one over its distance. The force's error"
    " falls in the same way:\n\n"
    + table(
        HEAD[:5] + HEAD[6:],
        [r[:5] + r[6:] for r in (row(6, far, 1000) for far in (15, 30, 60, 120, 240, 480))],
    ),
    "## Without the far boundary\n\n"
    "The limit is what the force's error goes to as one over the extent goes to zero. The table has it over"
    " mesh and load, with a hundred times the default penalty factor.\n\n"
    "The error that is left at 0.7 % of E goes with the load. Hertz has a linear law, small slopes, and a"
    " parabola in place of the sphere. The mesh changes it by a tenth of a percent, up and down, as the rim"
    " of the contact falls between its nodes.\n\n"
    + table(
        [
            "elements over the radius",
            "largest pressure / E [%]",
            "extents / radius",
            "force, near [%]",
            "force, far [%]",
            "force, limit [%]",
        ],
        [to_infinity(n, sphere) for n, sphere in ((4, RADIUS), (6, RADIUS), (6, 1.0), (6, 100.0))],
    ),
)
