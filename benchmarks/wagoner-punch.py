# SPDX-License-Identifier: LGPL-2.1-or-later
"""Wagoner's hemispherical punch: tangents, quadratic convergence, elements through the thickness, friction,
strain."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

from matplotlib import pyplot
import numpy

from billet_runs import ROOT, TANGENT, Changes, Run, arguments, number, publish, table
from billet_tools.output import pictures_of, read_grid

options = arguments("wagoner-punch")
TRAVEL = 40.0
MESH = "Bodies/blank/Mesh/"
STEP = "Time stepping/"
coarse = {MESH + "Refinements": 3}
base = coarse if options.quick else {}
LOOSE = {"Solver/Force tolerance": 1e-2, "Solver/Energy tolerance": 1e-4}
PAPER = {"exact": "170 / 83", "consistent": "176 / 87", "continuum": "219 / 95"}
SCENES = {0.3: "wagoner_punch", 0.15: "wagoner_punch_mu_015", 0.0: "wagoner_punch_mu_0"}


def run(changes: Changes | None = None, friction: float = 0.3, folder: str | None = None) -> Run:
    return Run(
        {**base, "Output/Interval": 0, **(changes or {})},
        options.ranks,
        ROOT / "prm" / (SCENES[friction] + ".prm"),
        "punch",
        folder,
    )


def outcome(r: Run) -> str:
    if r.converged:
        return f"{r.iterations} / {r.steps}"
    return f"{TRAVEL * r.times[-1]:.2g} mm: {r.failure}"


def tangents() -> str:
    rows = []
    for tangent in ("exact", "numerical", "consistent", "continuum"):
        # A tangent that needs thousands of steps is no choice: it may give up.
        changes = {**coarse, TANGENT: tangent, STEP + "Minimum step": 1e-4}
        default, loose = run(changes), run({**changes, **LOOSE})
        rows.append(
            [tangent, outcome(default), default.cuts, outcome(loose), loose.cuts, PAPER.get(tangent, "–")]
        )
    return table(
        [
            "tangent",
            "5e-3: iterations / steps",
            "cuts",
            "1e-2: iterations / steps",
            "cuts",
            "paper: iterations / steps",
        ],
        rows,
    )


def residuals() -> str:
    """Returns a table of the residuals in the first step of 1.5 % of the travel that ends past a third of
    it."""
    rows = []
    for tangent in ("exact", "consistent"):
        r = run({**coarse, TANGENT: tangent, STEP + "Maximum step": 0.015, "Output/Verbosity": "iterations"})
        forces, found = [], None
        for line in r.said.splitlines():
            iteration = re.match(r"\s*iteration\s+\d+\s+force (\S+)", line)
            step = re.match(r"\s*\d+\s+(\S+)\s+(\S+)\s+\d+\s+(\S+)", line)
            if iteration:
                forces.append(float(iteration.group(1)))
            elif step:
                if (
                    float(step.group(1)) > 1 / 3
                    and abs(float(step.group(2)) - 0.015) < 1e-6
                    and found is None
                ):
                    found = (
                        [tangent, number(TRAVEL * float(step.group(1)))]
                        + [f"{f:.1e}" for f in forces[1:]]
                        + [f"{float(step.group(3)):.1e}"]
                    )
                forces = []
        rows.append(found or [tangent, "–"])
    rows.append(["paper", "–", "1.7e-01", "2.3e-03", "1.1e-05", "2.4e-10"])
    width = max(len(row) for row in rows)
    return table(
        ["tangent", "travel"] + [f"residual {i}" for i in range(1, width - 1)],
        [row + [""] * (width - len(row)) for row in rows],
    )


class Shape:
    """The blank at the end of a run: `radii` where segments of the meridian y = 0 began, their logarithmic
    strains `meridional`; plastic strain of the elements, the radius of its peak."""

    def __init__(self, folder: str) -> None:
        fields = read_grid(pictures_of(Path(folder, "results"))[-1])
        now, start = fields["points"], fields["points"] - fields["displacement"]
        chains = []
        for surface in (0.0, 1.0):
            on_it = (abs(start[:, 1]) < 1e-3) & (abs(start[:, 2] - surface) < 1e-3)
            places = {round(float(a[0]), 3): b for a, b in zip(start[on_it], now[on_it])}
            chains.append((sorted(places), numpy.array([places[r] for r in sorted(places)])))
        radii = numpy.array(chains[0][0])
        middle = 0.5 * (chains[0][1] + chains[1][1])
        lengths = numpy.linalg.norm(numpy.diff(middle, axis=0), axis=1)
        self.radii = 0.5 * (radii[1:] + radii[:-1])
        self.meridional = numpy.log(lengths / numpy.diff(radii))
        strain = fields["equivalent_plastic_strain"]
        ring = numpy.hypot(start[:, 0], start[:, 1])
        self.centre = float(strain[ring < 1e-3].mean())
        peak = int(strain.argmax())
        # The mean over all elements with a corner at about this radius.
        self.peak, self.peak_radius = float(strain[peak]), float(
            ring[abs(strain - strain[peak]) < 1e-9].mean()
        )


def run_with_shape(changes: Changes, friction: float) -> tuple[Run, Shape]:
    with tempfile.TemporaryDirectory() as folder:
        r = run({"Output/Format": "vtu", "Output/Step interval": 0, **changes}, friction, folder)
        return r, Shape(folder)


def forces_at(r: Run) -> list[str]:
    return [number(r.force(travel / TRAVEL), 4) for travel in (10, 20, 30, 40)]


def row_of(label: object, r: Run, shape: Shape) -> list[object]:
    return (
        [label, f"{r.iterations} / {r.steps}", number(r.seconds)]
        + forces_at(r)
        + [number(shape.peak), number(shape.peak_radius), number(shape.centre)]
    )


HEAD = [
    "iterations / steps",
    "CPU seconds",
    "10 mm",
    "20 mm",
    "30 mm",
    "40 mm",
    "peak strain",
    "at radius",
    "at the centre",
]


def thickness() -> str:
    rows = []
    for layers in (1, 2) if options.quick else (1, 2, 4):
        r, shape = run_with_shape({MESH + "Layers": layers}, 0.3)
        rows.append(row_of(layers, r, shape))
    return table(["elements"] + HEAD, rows)


def friction() -> str:
    rows = []
    figure, axes = pyplot.subplots(figsize=(7, 4.5))
    for mu in SCENES:
        r, shape = run_with_shape({}, mu)
        rows.append(row_of(number(mu), r, shape))
        axes.plot(shape.radii, shape.meridional, marker=".", label=f"µ = {mu:g}")
    axes.set(
        xlabel="initial radius [mm]", ylabel="logarithmic meridional strain", xlim=(0, 66), ylim=(0, None)
    )
    axes.grid(alpha=0.3)
    axes.legend()
    figure.tight_layout()
    if not options.quick:
        figure.savefig(ROOT / "doc/images/wagoner_strain.png", dpi=110)
    return table(["µ"] + HEAD, rows)


def peaks() -> str:
    """Returns a table of the places of the maximum strain over travel and friction, with the strain of the
    centre."""
    rows = []
    for travel in (10, 20, 22.5, 23, 30, 35, 40):
        shapes = [run_with_shape({"Time stepping/End time": repr(travel / TRAVEL)}, mu)[1] for mu in SCENES]
        rows.append(
            [f"{travel} mm"]
            + [f"{number(s.peak)} at {number(s.peak_radius)}" for s in shapes]
            + [number(shapes[0].centre, 4)]
        )
    return table(["travel"] + [f"µ = {mu:g}" for mu in SCENES] + ["at the centre, µ = 0.3"], rows)


publish(
    "wagoner-punch",
    "Wagoner's hemispherical punch",
    options,
    (
        "This page compares billet with example 9.2 of Bittencourt & Creus (1998): iterations with each"
        " tangent, forces and strains. A punch of radius 50.8 mm goes 40 mm into a clamped disc of radius"
        " 66 mm and thickness 1 mm, k = 1e5 N/mm³. Each run is done once. Forces are those on the whole"
        " punch, in kN. Plastic strain is that of the elements; radii are those before forming, in mm."
    ),
    (
        "## Tangents\n\n"
        "Runs have µ = 0.3, 192 bricks and steps of at most half a millimetre. Iterations count those of"
        " cut steps. Beside the default tolerance (5e-3 of the forces) stands a looser one, 1e-2, with 1e-4"
        " of the energy. The looser one is about what the paper's two iterations a step point to."
    ),
    tangents(),
    (
        "## A step of 0.6 mm\n\n"
        "That is 1.5 % of the travel. The table has residuals relative to the forces, after each iteration,"
        " of a step past a third of the travel. The paper's mean residue stands beside them (its table 5)."
    ),
    residuals(),
    (
        f"## Elements through the thickness\n\nµ = 0.3, {'192' if options.quick else '768'} bricks in each"
        " layer."
    ),
    thickness(),
    (
        "## Friction\n\nMeridional strain at the end of the travel:\n\n![Meridional strain over"
        " radius](../images/wagoner_strain.png)"
    ),
    friction(),
    (
        "## The place of the peak\n\n"
        "The table has the largest plastic strain, and the radius where it is; elements are some 2 mm long"
        " there. The last column is the plastic strain at the centre."
    ),
    peaks(),
)
