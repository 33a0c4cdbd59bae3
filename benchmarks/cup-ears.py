# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ears of a cylindrical cup from an anisotropic sheet: the height of its rim beside the closed form, and the
draw-in of its flange beside laboratories."""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple, Sequence

from matplotlib import pyplot
import numpy

from billet_runs import (
    PROGRAM,
    ROOT,
    Changes,
    Run,
    arguments,
    number,
    percent,
    publish,
    read_scene,
    table,
    variant,
)

from billet_tools.kept import hash_of, hash_of_file, read_json, write_json
from billet_tools.output import Array, max_drift, pictures_of, read_grid, read_history

sys.path.insert(0, str(ROOT / "tests/cli"))
from earing_theory import QUARTER, Cup  # noqa: E402

options = arguments("cup-ears")
SCENE = ROOT / "prm/cylindrical_cup.prm"
KEPT = ROOT / "results/cup-ears"
PICTURE = ROOT / "doc/images/cup_ears.png"
BODY = "Bodies/blank/"
STEEL = Cup(blank=100, wall=50.5, r_values=(1.73, 1.34, 2.24))
ANGLES = range(0, 91, 15)
# Mean of three laboratories and a run with bricks (DX, DD, DY), mm: quoted at second hand.
MEASURED, PUBLISHED = (29.0, 32.0, 27.5), (27.0, 35.0, 25.0)
MEAN = sum(MEASURED) / 3


class Result(NamedTuple):
    """Result of a run: `heights` of the rim above the bottom at `angles` to the rolling direction [mm,
    degrees]. Draw-in (DX, DD, DY) and depth when their mean is that of the laboratories [mm]. Maximum `force`
    of the punch on the whole cup [kN]; `drift` of the energies over the largest sum; `steps`, `iterations`,
    CPU `seconds`."""

    angles: list[float]
    heights: list[float]
    draw_in: list[float]
    depth: float
    force: float
    drift: float
    steps: int
    iterations: int
    seconds: float

    def height(self, angle: float) -> float:
        return float(numpy.interp(angle, self.angles, self.heights))

    def mean(self) -> float:
        return float(numpy.mean([self.height(angle) for angle in numpy.linspace(0, 90, 181)]))

    def ears(self) -> int:
        """Returns the number of pieces of the whole rim above the mean."""
        above = [self.height(abs((angle + 90) % 180 - 90)) > self.mean() for angle in numpy.arange(0.25, 360)]
        return sum(a and not b for a, b in zip(above, above[-1:] + above[:-1]))


def run(changes: Changes) -> Result:
    """Runs the scene, or finds the same run of the same program."""
    text = variant(read_scene(SCENE), changes)
    kept = KEPT / f"{hash_of(hash_of_file(Path(PROGRAM)), text)[:24]}.json"
    found = read_json(kept)
    if found is None:
        found = measure(changes)
        KEPT.mkdir(parents=True, exist_ok=True)
        write_json(kept, found)
    return Result(*found)


def rim_of(folder: Path) -> tuple[list[float], list[float]]:
    """Angles of the nodes on the rim, and the mean height of both of its edges above the bottom's."""
    fields = read_grid(pictures_of(folder)[-1])
    heights = fields["points"][:, 2]
    x, y, _ = (fields["points"] - fields["displacement"]).T
    radii, angles = numpy.hypot(x, y), numpy.round(numpy.degrees(numpy.arctan2(y, x)), 2)
    rim = radii > STEEL.blank - 1e-3
    bottom = float(numpy.mean(heights[radii < radii.min() + 1e-3]))
    places: Array = numpy.unique(angles[rim])
    return places.tolist(), [float(heights[rim & (angles == place)].mean()) - bottom for place in places]


def draw_ins(row: dict[str, float]) -> list[float]:
    """DX, DD and DY."""
    diagonal = math.hypot(row["rim_45.displacement_x"], row["rim_45.displacement_y"])
    return [-row["rim_0.displacement_x"], diagonal, -row["rim_90.displacement_y"]]


def measure(changes: Changes) -> list[object]:
    pictures = {"Output/Format": "vtu", "Output/Interval": 0, "Output/Step interval": 0}
    with tempfile.TemporaryDirectory() as folder:
        done = Run({**pictures, **changes}, options.ranks, SCENE, "punch", folder)
        if not done.converged:
            raise SystemExit(f"cup-ears: {done.failure}")
        results = Path(folder, "results")
        rim, drift = rim_of(results), max_drift(read_history(results / "history.csv"))
    rows = [{name: float(cell) for name, cell in row.items()} for row in done.rows]
    means = [sum(draw_ins(row)) / 3 for row in rows]
    end = means.index(max(means)) + 1

    def then(values: list[float]) -> float:
        return float(numpy.interp(MEAN, means[:end], values[:end]))

    return [
        *rim,
        [then([draw_ins(row)[i] for row in rows]) for i in range(3)],
        then([-row["punch.travel_z"] for row in rows]),
        4e-3 * max(abs(row["punch.force_z"]) for row in rows),
        drift,
        done.steps,
        done.iterations,
        done.seconds,
    ]


def ear(heights: Sequence[float] | Array) -> float:
    """Mean of the ears at 0 and 90 degrees above the valley at 45."""
    return float((heights[0] + heights[2]) / 2 - heights[1])


# Heights at whole degrees, of rings with the same strain or with the same stress.
THEORY: dict[str, Array] = {
    "same strain": numpy.array([STEEL.height(angle) for angle in QUARTER]),
    "same stress": STEEL.heights_of_same_stress(),
}
LIMITS = [ear(heights[::45]) for heights in THEORY.values()]


def row_of_ears(name: str, r: Result) -> list[object]:
    found = [r.height(angle) for angle in (0, 45, 90)]
    return [
        name,
        r.ears() if abs(ear(found)) > 0.1 * LIMITS[0] else 0,
        *(number(height, 4) for height in found),
        *(
            f"{round(value, 2) + 0.0:.2f}"
            for value in (ear(found), *(ear(found) / limit for limit in LIMITS))
        ),
    ]


def row_of_draw_in(name: str, lengths: list[float], depth: str = "") -> list[object]:
    dx, dd, dy = lengths
    return [name, *(f"{length:.1f}" for length in lengths), f"{dd - (dx + dy) / 2:.1f}", depth]


def draw(results: dict[str, Result]) -> None:
    figure, axes = pyplot.subplots(figsize=(7, 4.2), layout="constrained")
    for (name, heights), style in zip(THEORY.items(), ("k--", "k:")):
        axes.plot(numpy.degrees(QUARTER), heights - heights.mean(), style, label=f"closed form, {name}")
    for name, r in results.items():
        axes.plot(r.angles, numpy.array(r.heights) - r.mean(), marker=".", label=name)
    axes.set(xlabel="angle to the rolling direction [°]", ylabel="height of the rim less its mean [mm]")
    axes.set_xticks(list(ANGLES))
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(PICTURE, dpi=100, metadata={"Software": None})
    pyplot.close(figure)


def mesh(n_rings: int, n_around: int) -> Changes:
    """Rings of this number outside of the punch's face, and bricks around the quarter."""
    radius = f"(10 + 7.5*min(x, 4) + {60 / n_rings:g}*max(0, x - 4))"
    n = n_rings + 4
    return {
        BODY + "Mesh/Arguments": f"{n}, {n_around}, 1 : 0, 0, 0 : {n}, 1, 1",
        BODY + "Mesh/Positions": f"{radius}*cos(pi/2*y) ; {radius}*sin(pi/2*y) ; z",
    }


ISOTROPIC: Changes = {BODY + "Material/r-values": "1, 1, 1"}
FINE = mesh(30, 18)
RUNS: list[tuple[str, Changes]] = [
    ("Hill, 24 × 12 bricks", {}),
    ("isotropic, 24 × 12 bricks", ISOTROPIC),
    ("Hill, 34 × 18 bricks", FINE),
]
if options.large:
    RUNS += [
        ("isotropic, 34 × 18 bricks", {**FINE, **ISOTROPIC}),
        ("Hill, 44 × 24 bricks", mesh(40, 24)),
        ("Hill, 24 × 12 bricks, penalty 0.1 E/h", {"General contact/Normal penalty": 0.1}),
    ]
results = {name: run(changes) for name, changes in RUNS[: 1 if options.quick else None]}
if not options.quick:
    draw(results)
publish(
    "cup-ears",
    "Ears of a cylindrical cup",
    options,
    (
        "The scene is `prm/cylindrical_cup.prm`: a disc of 200 mm is drawn into a cup of 100 mm, by a static"
        " run of a quarter. Its r-values are those of the deep-drawing steel of NUMISHEET'99, 1.73, 1.34"
        " and 2.24 at 0, 45 and 90° to the rolling direction x. One row has r-values of 1, which is von"
        " Mises' yield function."
    ),
    "## Height of the rim",
    (
        "Heights are those of the middle of the thickness above the bottom. In the closed forms"
        " (`tests/cli/earing_theory.py`) each ring of the flange is compressed along its circumference"
        " alone, and the wall has a radius of 50.5 mm. A ring has the same strain all around, or the same"
        " stress. The sheet is stronger along the diagonals, which are then compressed less. Bending,"
        " friction and the stretch of the wall are left out.\n\n"
        "The ear is the mean of the heights at 0 and 90° above that at 45°."
    ),
    table(
        [
            "rim",
            "ears",
            "0° [mm]",
            "45° [mm]",
            "90° [mm]",
            "ear [mm]",
            "over same strain",
            "over same stress",
        ],
        [
            *(
                [
                    f"closed form, {name}",
                    4,
                    *(number(float(h), 4) for h in heights[::45]),
                    f"{limit:.2f}",
                    "",
                    "",
                ]
                for (name, heights), limit in zip(THEORY.items(), LIMITS)
            ),
            *(row_of_ears(name, r) for name, r in results.items()),
        ],
    ),
    "## Profile",
    "Heights less their mean around the rim, in mm.",
    "![Height of the rim over the angle](../images/cup_ears.png)",
    table(
        ["angle [°]", *THEORY, *results],
        [
            [angle]
            + [f"{heights[angle] - heights.mean():+.2f}" for heights in THEORY.values()]
            + [f"{round(r.height(angle) - r.mean(), 2) + 0.0:+.2f}" for r in results.values()]
            for angle in ANGLES
        ],
    ),
    "## Draw-in",
    (
        "Three laboratories measured the draw-in of this steel at a draw ratio of 2, with 80 kN on the"
        " holder, in the benchmark of NUMISHEET'99. Their mean, and a run with bricks in DEFORM, are quoted"
        " at second hand. The drawing of the tools was not found. At the depth of 85 mm that is quoted with"
        " the draw-in, all of the flange is drawn in here.\n\n"
        "Runs are therefore compared at the depth at which the mean of DX, DD and DY is that of the"
        " laboratories. DD is along the diagonal."
    ),
    table(
        ["draw-in", "DX [mm]", "DD [mm]", "DY [mm]", "DD less the mean of DX and DY [mm]", "depth [mm]"],
        [
            row_of_draw_in("laboratories", list(MEASURED)),
            row_of_draw_in("DEFORM", list(PUBLISHED)),
            row_of_draw_in("closed form, same strain", list(STEEL.draw_ins(MEAN))),
            row_of_draw_in("closed form, same stress", list(STEEL.draw_ins_of_same_stress(MEAN))),
            *(row_of_draw_in(name, r.draw_in, number(r.depth)) for name, r in results.items()),
        ],
    ),
    "## Cost",
    table(
        ["run", "maximum punch force [kN]", "energy drift", "steps", "iterations", "CPU seconds"],
        [
            [name, number(r.force), percent(r.drift), r.steps, r.iterations, number(r.seconds, 2)]
            for name, r in results.items()
        ],
    ),
)
