# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cartridge in the chamber of a revolver: where contact comes to at which pressure, contact pressure along
the axis, hoop strain of the case, penetration."""

from __future__ import annotations

import tempfile

import matplotlib
import numpy
from numpy.typing import NDArray

from billet_runs import ROOT, arguments, number, percent, publish, table
from explicit_runs import ExplicitRun
from billet_tools.output import Array, Fields

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

options = arguments("cartridge")
SCENE = ROOT / "prm/cartridge.prm"
END, LOAD, AXIS, RADIUS = 2e-3, 265.0, 11.2, 4.8
PAIR = "case in chamber"
NAME = "cartridge"


def wall(z: Array) -> Array:
    """Thickness of the case; where its bottom is, that of the wall beside it."""
    return 0.9 - 0.62 * numpy.clip((z - 3) / 29, 0, 1)


class Picture:
    """Sides of the case and the chamber that face each other, in a picture: mean values over rings at the
    same height."""

    def __init__(self, points: Array, fields: Fields) -> None:
        start = points - fields["displacement"]
        radius = numpy.hypot(start[:, 0] - AXIS, start[:, 1])
        is_case = fields["body"] == 1
        self.case = self.rings(start, fields, is_case & (abs(radius - RADIUS) < 1e-3))
        deep = numpy.maximum(-fields["contact_gap"], 0) / wall(start[:, 2])
        deep[fields["contact_status"] == 0] = 0
        self.penetration = float(deep.max())
        self.strain = float(fields["equivalent_plastic_strain"][is_case].max())

    @staticmethod
    def rings(start: Array, fields: Fields, chosen: NDArray[numpy.bool_]) -> dict[str, Array]:
        z, index = numpy.unique(start[chosen, 2].round(4), return_inverse=True)

        def mean(values: Array) -> Array:
            return numpy.bincount(index, values) / numpy.bincount(index)

        # Normal to the wall of the ring as it was.
        outward = (start[chosen][:, :2] - [AXIS, 0]) / RADIUS
        radial = (fields["displacement"][chosen][:, :2] * outward).sum(axis=1)
        touched = mean((fields["contact_pressure"][chosen] > 0).astype(float))
        return {
            "z": z,
            "pressure": mean(fields["contact_pressure"][chosen]),
            "touched": touched,
            "hoop": mean(radial) / RADIUS,
        }

    def hoop(self, z: float) -> float:
        return float(numpy.interp(z, self.case["z"], self.case["hoop"]))

    def contact_from(self) -> float | None:
        """Lowest ring most of which touches."""
        touched = self.case["z"][self.case["touched"] > 0.5]
        return float(touched.min()) if len(touched) else None

    def contact_to(self) -> float | None:
        touched = self.case["z"][self.case["touched"] > 0.5]
        return float(touched.max()) if len(touched) else None


PLACES = {"mouth, z = 31 mm": 31.0, "middle, z = 17.5 mm": 17.5, "bottom, z = 4 mm": 4.0}
with tempfile.TemporaryDirectory() as folder:
    r = ExplicitRun(SCENE, {"Output/Interval": 0.05e-3}, folder, options.ranks)
    n = len(list((r.folder / "results").glob("fields_*.vtm")))
    times = numpy.linspace(0, END, n)
    pictures = [Picture(*r.picture(i)) for i in range(n)]
loads = LOAD * times / END

figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4.2))
for load in (40, 80, 120, 160, 200, 265):
    i = int(numpy.argmin(abs(loads - load)))
    left.plot(pictures[i].case["z"], pictures[i].case["pressure"], label=f"{loads[i]:.0f} MPa in the case")
left.set_xlabel("z, from the bottom to the mouth [mm]")
left.set_ylabel("contact pressure, mean around [MPa]")
left.set_ylim(0, 1.4 * max(p.case["pressure"].max() for p in pictures))
left.legend(ncol=2, loc="upper left")
for label, z in PLACES.items():
    right.plot(loads, [100 * p.hoop(z) for p in pictures], label=label)
right.set_xlabel("pressure in the case [MPa]")
right.set_ylabel("hoop strain of the outside [%]")
right.legend()
path = ROOT / f"doc/images/{NAME}.png"
path.parent.mkdir(parents=True, exist_ok=True)
figure.savefig(path, dpi=110, bbox_inches="tight")

rows = []
for i in range(2, n, 2):
    p = pictures[i]
    row = min(r.rows, key=lambda row: abs(row["time"] - times[i]))
    rows.append(
        [
            number(float(loads[i])),
            "–" if p.contact_from() is None else f"{number(p.contact_from())} to {number(p.contact_to())}",
            number(p.case["pressure"].max()),
        ]
        + [percent(p.hoop(z)) for z in PLACES.values()]
        + [percent(p.strain), percent(p.penetration), number(1e3 * row[PAIR + ".deepest_penetration"])]
    )
publish(
    NAME,
    "Cartridge in the chamber of a revolver",
    options,
    (
        "This page shows how the case of a cartridge comes to lie against the chamber as the pressure"
        " rises. The scene is [`prm/cartridge.prm`](../../prm/cartridge.prm), after Bittencourt & Creus"
        " (1998), example 9.4. The case touches at its thin mouth first, and from there the contact goes to"
        " the bottom.\n\n"
        f"The run takes {r.steps} steps and {number(r.seconds)} s of CPU time. The largest drift of energy"
        f" is {percent(r.max_drift())}. The largest penetration is"
        f" {percent(max((p.penetration for p in pictures)))} of the wall there, 0.9 − 0.62 (z − 3)/29 mm."
    ),
    f"![Contact pressure along the axis, hoop strain over the pressure](../images/{NAME}.png)",
    table(
        ["pressure [MPa]", "contact in z [mm]", "largest contact pressure, mean around [MPa]"]
        + [f"hoop strain, {label}" for label in PLACES]
        + ["largest plastic strain of the case", "penetration / wall", "deepest [µm]"],
        rows,
    ),
    "Contact: rings of nodes of the case most of which touch.",
)
