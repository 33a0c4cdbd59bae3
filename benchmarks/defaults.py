# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures the error of the defaults: every shipped scene without any numerical parameter, beside a mesh
twice as fine with small steps and tight contact."""

from __future__ import annotations

import csv
import math
import re
import subprocess
from pathlib import Path
from typing import Mapping

# finds billet_tools, too
from billet_runs import PROGRAM, ROOT, arguments, number, percent, program_hash, publish, read_scene, table
from billet_tools.scene import read_entries
from billet_tools.trade.parameters import make_mesh
from billet_tools.text import first_sentence
from billet_tools.scene import Scene
from curve_runs import CurveRun, error, impulses, with_curves, write_csv

options = arguments("defaults", has_scenes=True)
LIMIT = 0.03  # of the force

# Physics and output in sections whose other parameters are numerical.
KEPT = {
    "Time stepping": ("Scheme", "End time", "Stops"),
    "Contact pairs": (
        "Body",
        "Boundary ids",
        "Tool",
        "Second body",
        "Second boundary ids",
        "Friction law",
        "Friction coefficient",
        "Maximum shear stress",
        "Kinetic friction coefficient",
        "Decay coefficient",
        "Reference pressure",
        "Pressure exponent",
        "Initial penetration",
        "Allowed initial penetration",
        "Ramp time",
        "Initial gap",
        "Surface correction",
        "Edge contact",
    ),
}
DROPPED = ("Element", "Elasticity")  # of bodies

# Those that take long end earlier, in both runs.
ENDS = {
    "cartridge": 2e-4,
    "tube_crush": 5e-4,
    "drop_hammer": 1e-3,
    "tube_impact": 1e-3,
    "turned_blocks": 5,
    "wagoner_punch": 0.5,
    "wagoner_punch_mu_0": 0.5,
    "wagoner_punch_mu_015": 0.5,
    "billet_deformable_dies": 0.5,
    "twisted_hemisphere": 1.5,
}
# Their finer meshes take longer than the rest together: the scene's own is the reference, and a coarser one
# runs.
COARSER = {
    "twisted_hemisphere": {
        "Bodies/block/Mesh/Arguments": "8, 8, 3 : -1, -1, -1 : 1, 1, 0 : true",
        "Bodies/punch/Mesh/Arguments": "7, 7, 3 : -1, -1, 0 : 1, 1, 1 : true",
    }
}

# Supports move beside a plate: how they share the force depends on the size of the facet between them.
OF_ENERGY = ("hollow_block",)
SAME = ("patch_test", "patch_test_cut")  # a uniform stress, which any mesh has


def numerical(entries: Mapping[str, str]) -> dict[str, object]:
    """Returns the numerical settings of the scene, which it can do without: {key: None}."""

    def is_numerical(key: str) -> bool:
        section, name = key.split("/")[0], key.split("/")[-1]
        if section == "Bodies":
            return name in DROPPED
        if section in KEPT:
            return name not in KEPT[section]
        return section in ("Solver", "Explicit dynamics", "Implicit dynamics")

    return {key: None for key in entries if is_numerical(key)}


def tight(entries: Mapping[str, object], depth: float | None) -> dict[str, object]:
    """Small steps, and contact that hardly gives way: augmented to this `depth`, in facet sizes, or, without
    one, as it is by itself."""
    names = sorted({key.split("/")[1] for key in entries if key.startswith("Contact pairs/")})
    end = float(str(entries.get("Time stepping/End time", 1)))
    scheme = entries.get("Time stepping/Scheme", "quasi-static")
    if scheme != "quasi-static":
        in_place_of: dict[str, object] = (
            {}
            if scheme == "explicit"
            else {
                "Time stepping/Scheme": "explicit",
                "Output/History interval": repr(end / 500),
                **{key: None for key in entries if key.split("/")[0] in ("Implicit dynamics", "Solver")},
            }
        )
        return {
            "Explicit dynamics/Safety factor": 0.5,
            "Explicit dynamics/Contact resolution": 4,
            **{f"Contact pairs/{name}/Normal penalty": 40 for name in names},
            **in_place_of,
        }
    return {
        "Time stepping/Error tolerance": 1e-3,
        "Time stepping/Maximum step": repr(end / 50),
        "Time stepping/Initial step": repr(end / 400),
        "Solver/Maximum augmentations": 60,
        **({f"Contact pairs/{name}/Penetration tolerance": depth for name in names} if depth else {}),
    }


HEAD = [
    "scene",
    "finished",
    "elements",
    "reference_finished",
    "reference_elements",
    "work",
    "cpu_seconds",
    "reference_cpu_seconds",
    "error",
    "warnings",
    "stopped",
    "program",
]


def measure(path: Path, parameters: str) -> dict[str, str]:
    """Runs a scene by its defaults and beside its reference: a row of defaults.csv."""
    entries = read_entries(path)
    bare = numerical(entries)
    if path.stem in ENDS:
        bare |= {"Time stepping/End time": ENDS[path.stem], "Time stepping/Stops": None}
    shortened: dict[str, object] = {
        **entries,
        **{key: value for key, value in bare.items() if value is not None},
    }
    coarser = COARSER.get(path.stem)
    finer = {} if coarser or path.stem in SAME else make_mesh(Scene(read_scene(path), parameters), "2")
    run = CurveRun(path, {**bare, **(coarser or {})}, options.ranks)
    # Where stiff blocks move by little, a thousandth of a facet is much of that.
    for depth in (1e-7 if path.stem in SAME else 1e-3, None):
        exact = CurveRun(path, {**bare, **finer, **tight(shortened, depth)}, options.ranks)
        if exact.finished or exact.is_explicit:
            break
    seen, right = run, exact
    if path.stem in OF_ENERGY:
        seen, right = (with_curves(of, of.energies) for of in (run, exact))
    elif run.is_explicit != exact.is_explicit:  # forces of different schemes vibrate differently
        seen, right = (with_curves(of, impulses(of)) for of in (run, exact))
    off = error(seen, right) if run.finished and exact.finished else math.nan
    warnings = sorted(set(re.findall(r"warning\[([a-z-]+)\]", run.said + run.failure)))
    values = (
        path.stem,
        run.finished,
        run.elements,
        exact.finished,
        exact.elements,
        run.work,
        f"{run.seconds:.4g}",
        f"{exact.seconds:.4g}",
        f"{off:.4g}",
        " ".join(warnings),
        "" if run.finished else first_sentence(run.failure),
        program_hash(),
    )
    return dict(zip(HEAD, map(str, values)))


def verdict(row: dict[str, str]) -> str:
    """Judges a row: within the limit, warned of, or missed."""
    if row["finished"] != "True":
        return "stops: " + row["stopped"]
    if row["reference_finished"] != "True":
        return "no reference"
    if float(row["error"]) <= LIMIT:
        return "within"
    return "warned" if row["warnings"] else "missed"


def table_row(row: dict[str, str]) -> list[object]:
    """Returns the cells of the page's table."""
    scene = row["scene"]
    changed = [f"until {ENDS[scene]:g}"] if scene in ENDS else []
    changed += ["coarser"] if scene in COARSER else ["same mesh"] if scene in SAME else []
    return [
        scene + (f" ({', '.join(changed)})" if changed else ""),
        row["elements"],
        row["reference_elements"],
        row["work"],
        number(float(row["cpu_seconds"])),
        number(float(row["reference_cpu_seconds"])),
        percent(float(row["error"])),
        verdict(row),
        ", ".join(f"`{w}`" for w in row["warnings"].split()),
        f"`{row['program']}`",
    ]


parameters = subprocess.run(
    [PROGRAM, "--print-parameters"], check=True, capture_output=True, text=True
).stdout
with open(ROOT / "doc/results/defaults.csv", newline="") as file:
    kept = {row["scene"]: row for row in csv.DictReader(file)}
paths = sorted((ROOT / "prm").glob("*.prm"))
unknown = set(options.only or ()) - {path.stem for path in paths}
if unknown:
    raise SystemExit(f"defaults: no scene in prm/ is named {', '.join(sorted(unknown))}")
chosen = ("billet_upsetting", "ring_crush", "patch_test") if options.quick else options.only
rows = []
for path in paths:
    if not chosen or path.stem in chosen:
        rows.append(measure(path, parameters))
    elif options.only:
        rows.append(kept[path.stem])
    else:
        continue
    print(*table_row(rows[-1]), sep=" | ", flush=True)
verdicts = {row["scene"]: verdict(row) for row in rows}
within, warned = ([scene for scene, of in verdicts.items() if of == what] for what in ("within", "warned"))
missed = [scene for scene in verdicts if scene not in within + warned]

publish(
    "defaults",
    "How far the defaults are off",
    options,
    (
        "This page shows the error that a user gets from the defaults alone. Each shipped scene runs"
        " without any numerical parameter: no element, law of rates, penalty, tolerance, step or solver is"
        " set. Geometry, mesh, material, friction and motion are set. Some scenes end earlier.\n\n"
        "Error is ∫Σ|F − F*| dt over ∫Σ|F*| dt of the forces of all tools and pairs. For explicit scenes it"
        " is that of kinetic energy and of what is stored or dissipated.\n\n"
        "The reference F* has elements of half the size along each edge.\n\n"
        "- Statics: F* has an error tolerance of 1e-3, at least 50 steps, and contact augmented to 1e-3 of"
        " a facet (1e-7 for a uniform stress). Where that finds no end, contact is augmented as by"
        " default.\n"
        "- Explicit: F* has 40 E/h, a contact resolution of 4, and half the stable step.\n"
        "- Implicit dynamics has the explicit reference, too. Impulses are compared, since forces"
        " vibrate.\n"
        "- For the hollow block energy is compared. Its supports share the force with the plates, by the"
        " size of the facet between them.\n\n"
        "The error does not include what the finer mesh leaves. That is a third more where the order is"
        " two, and as much again where it is one.\n\n"
        "A run counts as warned if it warns of anything, whether or not that is the reason. *coarser* means"
        " a coarser mesh beside the scene's own. *same mesh* means a uniform stress, which any mesh has."
        " *program* is the start of the program's hash. Each run is done once."
    ),
    f"{len(within)} of {len(rows)} are within {100 * LIMIT:g} %. Of the others {len(warned)} warn"
    + (f" ({', '.join(warned)})." if warned else ".")
    + (f" {len(missed)} do not warn ({', '.join(missed)})." if missed else ""),
    table(
        [
            "scene",
            "elements",
            "of the reference",
            "work",
            "CPU seconds",
            "of the reference",
            "error",
            "",
            "warnings",
            "program",
        ],
        list(map(table_row, rows)),
    ),
)
if not options.quick:
    write_csv("defaults", HEAD, [row.values() for row in rows])
