#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: rubber_scenes.py BILLET

Runs coarser variants of the shipped scenes of a seal and of an O-ring in an empty current folder. Compares
them with a curved bar, with Lindley's formula, and with what a seal must do.
"""

from __future__ import annotations

import math
import sys

from checks import SHIPPED, Checks, enter_folder, near, require, run
from shipped import Rows, history, require_balance, require_page, require_short

program = sys.argv[1]
check = Checks()
enter_folder()


def run_variant(name: str, *changes: str) -> Rows:
    """Runs a shipped scene with changes to its end, and returns its history, in which forces balance."""
    options = [part for change in changes for part in ("--set", change)]
    scene = str(SHIPPED / f"{name}.prm")
    ended = run(program, scene, "--output", name, "--force", "--set", "Output/Format=none", *options)
    require(ended.code == 0, ended.output + ended.errors)
    rows = history(name)
    require_balance(rows)
    return rows


def row_at(rows: Rows, time: float) -> dict[str, float]:
    """Returns the row of a step that ends at this time."""
    return next(row for row in rows if abs(row["time"] - time) < 1e-9)


def ring_stiffness(inner: float, outer: float, young: float, shear: float, poisson: float) -> float:
    """Returns force over approach of a thick ring, per width, under two opposite forces (Roark, table 9.2,
    case 1, for thick rings), in plane strain."""
    plane, thickness, radius = young / (1 - poisson**2), outer - inner, (outer + inner) / 2
    offset = radius - thickness / math.log(outer / inner)
    alpha, beta = offset / radius, 1.2 * plane * offset / (shear * radius)
    k1, k2 = 1 - alpha + beta, 1 - alpha
    return plane * thickness * offset / (radius**2 * (math.pi * k1 / 4 - 2 * k2**2 / math.pi))


@check("a seal begins as a curved bar, closes, and gives its work back but for friction")
def _() -> None:
    rows = run_variant("seal", "Bodies/seal/Mesh/Arguments=3, 1, 24 : 2.5, 0, -90 : 5.5, 1, 90 : true")
    second = rows[1]
    half = ring_stiffness(2.5, 5.5, 3.0, 1.0, 0.499) / 2
    near("stiffness", abs(second["upper plate.force_z"] / second["upper plate.travel_z"]), half, 0.1)
    closed = row_at(rows, 1)
    require(rows[5]["seal on itself.contact_area"] == 0, "the hole is closed too early")
    require(closed["seal on itself.contact_area"] > 3, "the hole does not close")
    last = rows[-1]
    require(last["friction_dissipation"] > 0.1, "the plates are not rough")
    kept = last["elastic_energy"] + last["contact_energy"] + last["friction_dissipation"]
    near("energy", kept, last["external_work"], 0.02)


@check("the line load of an O-ring is Lindley's, and its pressure rises with that of the oil")
def _() -> None:
    rows = run_variant("o_ring", "Bodies/ring/Mesh/Refinements=2")
    diameter, squeeze = 5.33, 0.2
    young = 6 / (1 - 0.499**2)  # of plane strain: 6 (C10 + C01)
    lindley = diameter * young * (1.25 * squeeze**1.5 + 50 * squeeze**6)
    squeezed, end = row_at(rows, 1), row_at(rows, 2)
    near("line load", abs(squeezed["lid.force_per_width_y"]), lindley, 0.1)
    for row in rows:
        oil = 3 * max(row["time"] - 1, 0)
        require(row["time"] < 1 or row["under lid.largest_contact_pressure"] > oil + 1, "the oil leaks")
    rise = end["under lid.largest_contact_pressure"] - squeezed["under lid.largest_contact_pressure"]
    require(2 < rise < 3, f"the sealing pressure rises by {rise} at an oil pressure of 3")
    require(0 < squeezed["plastic_work"] < 0.05 * squeezed["elastic_energy"], "no viscosity")


@check("the check names viscosity, and where a law is stable")
def _() -> None:
    ended = run(program, "--check", str(SHIPPED / "seal.prm"), "--set", "Bodies/seal/Material/C20=-0.2")
    require("Yeoh elasticity, stable (Drucker) at stretches of " in ended.output, ended.output)
    ended = run(program, "--check", str(SHIPPED / "o_ring.prm"))
    require("Mooney-Rivlin elasticity with viscosity, 3 symmetry planes" in ended.output, ended.output)


@check("pages")
def _() -> None:
    for scene in ("seal", "o_ring"):
        require_page(scene, scene)
    require_short("seal")


sys.exit(check.finish())
