# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table of closed forms and benchmarks: each entry names where its figure stands in doc/results."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple, Sequence

from pages import table
from results import cell_of, values_of


class Case(NamedTuple):
    """A result beside its reference."""

    what: str
    reference: str
    page: str  # in doc/, without .md; its benchmark has the same name
    row: dict[str, str]  # of a table; of a scene with a quantity, of doc/scenes/values.csv
    column: str
    heading: str = ""
    unit: str = ""
    command: str = ""  # if it is no benchmark


CLOSED_FORMS = (
    Case(
        "Billet upset by 64 % without friction: force, 60 bricks",
        "homogeneous upsetting",
        "results/billet-frictionless",
        {"bricks": "60", "steps": "48", "penalty / 3.5e5": "1"},
        "64 %: error [%]",
        "Meshes and steps: no influence",
        " %",
    ),
    Case(
        "The same, less the penetration p/k",
        "homogeneous upsetting",
        "results/billet-frictionless",
        {"bricks": "60", "steps": "48", "penalty / 3.5e5": "1"},
        "64 %: error [%], penetration taken off",
        "Meshes and steps: no influence",
        " %",
    ),
    Case(
        "Rigid sphere on an elastic half-space: force, boundary far away",
        "Hertz",
        "results/hertz-contact",
        {"elements over the radius": "6", "largest pressure / E [%]": "0.7"},
        "force, limit [%]",
        "Without the far boundary",
        " %",
    ),
    Case(
        "Two elastic cylinders, 80 elements: pressure at a node",
        "Hertz",
        "results/elastic-contact",
        {"elements": "80", "facets": "overlap", "augmented to": "–"},
        "a node's pressure",
        "Two cylinders",
    ),
    Case(
        "Press fit of matching rings, 64 elements around: force",
        "Lamé",
        "results/press-fit",
        {"elements around": "64 in 64"},
        "force",
        "The same, augmented to 1e-5 facet sizes",
    ),
    Case(
        "Contact patch test, explicit, overlapping facets, 8 elements on 5",
        "uniform stress",
        "results/contact-patch",
        {"facets": "overlap", "passes": "one", "slaves": "lower"},
        "largest error at the interface",
        "Two cubes, 8 elements across on 5",
    ),
    Case(
        "Block patch test with distorted meshes, overlapping facets",
        "uniform stress",
        "results/implicit-ccx",
        {"scene": "patch_test", "program": "billet"},
        "result",
    ),
    Case(
        "Block with an inclined cut held by friction",
        "uniform stress",
        "results/implicit-ccx",
        {"scene": "patch_test_cut", "program": "billet"},
        "result",
    ),
    Case(
        "Snap-fit on the way in: axial over transverse force, 82 × 4 bricks",
        "wedge with friction",
        "results/snap-fit",
        {"elements": "82 × 4", "largest step": "0.02"},
        "in: force ratio",
    ),
    Case(
        "Snap-fit on the way in: transverse force, 82 × 4 bricks",
        "beam with both forces",
        "results/snap-fit",
        {"elements": "82 × 4", "largest step": "0.02"},
        "in: beam",
    ),
    Case(
        "Slab rolling, static: force per width",
        "slab theory (von Kármán)",
        "scenes/slab_rolling",
        {"quantity": "static: force, N/mm"},
        "difference",
        command="ctest -R contact_scenes",
    ),
    Case(
        "Cylinder under internal pressure: outside at 152 MPa",
        "Hill",
        "scenes/pressurised_cylinder",
        {"quantity": "outside at 152 MPa, c = 12.94, mm"},
        "difference",
        command="ctest -R loaded_scenes",
    ),
    Case(
        "Coupon under cyclic strain: force at the peak in tension",
        "Armstrong and Frederick's loop",
        "scenes/cyclic_coupon",
        {"quantity": "tension, fifth cycle: force of the grip, N"},
        "difference",
        command="ctest -R loaded_scenes",
    ),
    Case(
        "Sheet bent to 20 mm, 2 bricks with 5 points through it: moment",
        "fibres in plane strain",
        "results/sheet-springback",
        {"radius": "20", "bricks through": "2", "points through each": "5"},
        "error",
        "Pure bending",
        " %",
    ),
    Case(
        "The same: part of the curvature that springs back",
        "fibres in plane strain",
        "results/sheet-springback",
        {"radius": "20", "bricks through": "2", "points through each": "5"},
        "its error",
        "Pure bending",
        " %",
    ),
    Case(
        "Drop of a ball: speed of the rebound over that of the impact",
        "elastic impact",
        "scenes/drop",
        {"quantity": "speed of the rebound over that of the impact"},
        "difference",
        command="ctest -R loaded_scenes",
    ),
)

BENCHMARKS = (
    Case(
        "Taylor's bar, 2304 bricks: length in mm",
        "21.4 to 21.7 (usual values)",
        "results/taylor-bar",
        {"bricks": "2304"},
        "length [mm]",
        "Meshes, eight points with assumed strains",
    ),
    Case(
        "Taylor's bar, 2304 bricks: radius of the end in mm",
        "6.9 to 7.2 (usual values)",
        "results/taylor-bar",
        {"bricks": "2304"},
        "radius of the end [mm]",
        "Meshes, eight points with assumed strains",
    ),
    Case(
        "Taylor's impact with Johnson and Cook's law, 42CrMo4 at 287 m/s: length in mm",
        "26.53 (two programs)",
        "results/taylor-johnson-cook",
        {"material": "42CrMo4", "bricks in the section": "48"},
        "length [mm]",
        "Beside other programs",
    ),
    Case(
        "The same, 4340 steel at 208 m/s: length in mm",
        "22.48 (measured)",
        "results/taylor-johnson-cook",
        {"material": "4340 steel", "velocity [m/s]": "208", "bricks in the section": "48"},
        "length [mm]",
        "Beside experiments",
    ),
    Case(
        "The same, OFHC copper at 190 m/s: length in mm",
        "16.2 (measured)",
        "results/taylor-johnson-cook",
        {"material": "OFHC copper", "velocity [m/s]": "190", "bricks in the section": "48"},
        "length [mm]",
        "Beside experiments",
    ),
    *(
        Case(
            f"{what}: draw-in {measure} at {depth} mm",
            "measured mean, at second hand",
            "results/square-cup",
            {"bricks of the quarter": "24 × 24"},
            f"beside measured after {depth} mm: {measure.split()[0]}, mm",
        )
        for what, measure, depth in (
            ("Square cup of NUMISHEET'93, 24 × 24 bricks", "DX (middle of an edge)", 15),
            ("The same", "DD (diagonal)", 15),
            ("The same", "DX (middle of an edge)", 40),
            ("The same", "DD (diagonal)", 40),
        )
    ),
    Case(
        "Cylindrical cup with Hill's anisotropy, 34 × 18 bricks: height of the ears over the reference's",
        "closed form, rings of the same stress",
        "results/cup-ears",
        {"rim": "Hill, 34 × 18 bricks"},
        "over same stress",
    ),
    Case(
        "Free bend of NUMISHEET 2002, aluminium: angle after springback in degrees",
        "50 to 55 (at second hand)",
        "results/sheet-springback",
        {"variant": "as shipped: aluminium"},
        "after springback [°]",
        "Free bend of NUMISHEET 2002",
    ),
    Case(
        "Billet with friction, 60 bricks: force curve",
        "30,720 bricks",
        "results/billet-mesh",
        {"bricks": "60"},
        "curve",
    ),
    Case(
        "Billet with friction, 3840 bricks: force curve",
        "30,720 bricks",
        "results/billet-mesh",
        {"bricks": "3840"},
        "curve",
    ),
    Case(
        "Ironing: horizontal over vertical force, overlapping facets",
        "µ = 0.3, elastic slab",
        "results/ironing",
        {"facets": "overlap", "passes": "one"},
        "horizontal / vertical force, from 1 to 9 mm",
        "All of the scene, steps as they come",
    ),
    Case(
        "A hundred thousand cycles of friction: sideways force, cycle 100 and the last",
        "the same force",
        "results/endurance",
        {"quantity": "largest sideways force [N]"},
        "difference",
        "Cycles of friction",
    ),
)


def unified(value: str) -> str:
    """Returns a value with the minus sign of the pages of results, and small parts of one as per cent."""
    value = value.replace("−", "-")
    if not re.fullmatch(r"[-+]?[\d.]+e[-+]\d+", value):
        return value
    sign = "+" if value[0] in "+-" else ""
    return f"{100 * float(value):{sign}.2g} %"


def make_table(root: Path, at: str, cases: Sequence[Case]) -> str:
    """Returns the table of some cases, for a page of doc/."""
    up = "../" * at.count("/")
    rows = []
    for case in cases:
        page = root / "doc" / f"{case.page}.md"
        if case.page.startswith("scenes/") and "quantity" in case.row:
            values = {row["quantity"]: row for row in values_of(root, page.stem)}
            value = values[case.row["quantity"]][case.column]
        else:
            value = cell_of(page, case.row, case.column, case.heading) + case.unit
        command = case.command or f"scripts/benchmarks {page.stem}"
        rows.append((case.what, case.reference, f"[{unified(value)}]({up}{case.page}.md)", f"`{command}`"))
    return table(("case", "reference", "error or value", "command"), rows)
