# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the profiles fast, balanced and accurate cost, and how far they are off, on every shipped scene."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from billet_runs import ROOT, Changes, arguments, number, percent, publish, table  # finds billet_tools, too
from billet_tools.scene import read_entries
from billet_tools.text import first_sentence
from curve_runs import CurveRun, error, run_all, write_csv
from profile_words import no_better, with_looser, without_errors

options = arguments("profiles")
PROFILES = ("fast", "balanced", "accurate")

# What profiles set, in any scheme: scenes are run without it, so that it is the profile's.
PROFILED = {
    "Time stepping": (
        "Initial step",
        "Minimum step",
        "Maximum step",
        "Error tolerance",
        "Growth iterations",
        "Shrink iterations",
        "Growth factor",
    ),
    "Implicit dynamics": ("Error tolerance",),
    "Solver": ("Force tolerance", "Energy tolerance", "Displacement tolerance", "Linear tolerance"),
    "Contact pairs": ("Penetration tolerance",),
    "Explicit dynamics": ("Contact resolution", "Safety factor"),
    "Bodies": ("Element", "Elasticity"),
}

# Scenes that take long are cut: these are the ends that they get, and other changes.
CUT: dict[str, Changes] = {
    "wagoner_punch": {"Bodies/blank/Mesh/Refinements": 3, "Time stepping/End time": 0.25},
    "wagoner_punch_mu_0": {"Bodies/blank/Mesh/Refinements": 3, "Time stepping/End time": 0.25},
    "wagoner_punch_mu_015": {"Bodies/blank/Mesh/Refinements": 3, "Time stepping/End time": 0.25},
    "passing_spheres": {"Bodies/upper/Mesh/Refinements": 1, "Bodies/lower/Mesh/Refinements": 1},
    "twisted_hemisphere": {
        "Bodies/block/Mesh/Arguments": "8, 8, 3 : -1, -1, -1 : 1, 1, 0 : true",
        "Bodies/punch/Mesh/Arguments": "7, 7, 3 : -1, -1, 0 : 1, 1, 1 : true",
    },
    "tube_crush": {"Time stepping/End time": 5e-5},
    "cartridge": {"Time stepping/End time": 4e-5},
    "drop_hammer": {"Time stepping/End time": 2e-3},
    "hertz_cylinders": {
        "Bodies/lower/Mesh/Arguments": "20, 1, 10 : 0, 0, -1 : 1, 0.1, 0 : true",
        "Bodies/upper/Mesh/Arguments": "17, 1, 10 : 0, 0, 0 : 1, 0.1, 1 : true",
    },
    "press_fit": {
        "Bodies/inner/Mesh/Arguments": "4, 12, 1 : 10, 0, 0 : 20.01, 90, 1 : true",
        "Bodies/outer/Mesh/Arguments": "4, 12, 1 : 20, 0, 0 : 30, 90, 1 : true",
    },
    "turned_blocks": {"Time stepping/End time": 5},
    "tube_impact": {"Time stepping/End time": 1e-4},
    "taylor_bar": {"Bodies/bar/Mesh/Refinements": 1, "Bodies/bar/Mesh/Layers": 24, "Output/Interval": 0},
    "billet_deformable_dies": {
        "Time stepping/End time": 0.5,
        "Time stepping/Stops": None,
        "Bodies/die/Mesh/Arguments": "5, 5, 2 : 0, 0, 15 : 20, 20, 25 : true",
    },
    "ring_crush": {"Time stepping/End time": 1, "Time stepping/Stops": None},
    "hollow_block": {"Time stepping/End time": 1, "Time stepping/Stops": None},
    "ironing": {"Time stepping/End time": 1.6, "Time stepping/Stops": 1},
}


def left_to_profiles(path: Path) -> dict[str, object]:
    """{key: None} for all that the scene sets and a profile would."""
    entries = read_entries(path)
    scheme = entries.get("Time stepping/Scheme", "quasi-static")
    found: dict[str, object] = {}
    for key in entries:
        section, name = key.split("/")[0], key.split("/")[-1]
        if name in PROFILED.get(section, ()) and not (
            scheme == "implicit dynamics" and section == "Time stepping"
        ):
            found[key] = None
        if (
            scheme == "explicit"
            and name == "Normal penalty"
            and entries.get(key.replace(name, "Penalty unit"), "factor") == "factor"
        ):
            found[key] = None
    return found


def without_time(changes: Changes, path: Path) -> dict[str, object]:
    """A run that has hardly begun, but has (shorter first steps fail on Wagoner's punch): what setting up
    costs."""
    entries = {
        **read_entries(path),
        **{key: str(value) for key, value in changes.items() if value is not None},
    }
    end = float(entries.get("Time stepping/End time", 1))
    steps = (
        {}
        if entries.get("Time stepping/Scheme") == "explicit"
        else {
            f"Time stepping/{name} step": repr(1e-5 * end)
            for name in (
                ("Initial",)
                if entries.get("Time stepping/Step control") == "fixed"
                else ("Initial", "Smallest", "Largest")
            )
        }
    )
    return {**changes, **steps, "Time stepping/End time": repr(1e-5 * end), "Time stepping/Stops": None}


# Of static and implicit scenes: penetration tolerance, residual, and error tolerance of dynamics, tightest
# first; where contacts come and go the tightest may find no end.
TIGHT = (
    (1e-6, 1e-10, 1e-6),
    (1e-5, 1e-10, 1e-6),
    (1e-4, 1e-10, 1e-6),
    (3e-4, 1e-9, 3e-6),
    (1e-3, 1e-8, 1e-5),
)


def reference(
    path: Path, changes: Changes, depth: float, residual: float, dynamic: float
) -> dict[str, object]:
    """Tighter settings than any profile's, on the same mesh."""
    all_entries: dict[str, object] = {**read_entries(path), **changes}
    entries = {key: str(value) for key, value in all_entries.items() if value is not None}
    end = float(entries.get("Time stepping/End time", 1))
    names = sorted({key.split("/")[1] for key in entries if key.startswith("Contact pairs/")})
    if entries.get("Time stepping/Scheme") == "explicit":
        return {
            "Explicit dynamics/Safety factor": 0.3,
            "Explicit dynamics/Contact resolution": 4,
            **{
                f"Contact pairs/{name}/Normal penalty": 100
                for name in names
                if entries.get(f"Contact pairs/{name}/Penalty unit", "factor") == "factor"
            },
            **{
                f"Bodies/{key.split('/')[1]}/Element": entries.get(
                    f"Bodies/{key.split('/')[1]}/Element", "assumed strain"
                )
                for key in entries
                if key.startswith("Bodies/")
            },
        }
    # nodes that come in cannot stop within a step
    if entries.get("Time stepping/Scheme") == "implicit dynamics":
        return {"Solver/Force tolerance": max(residual, 1e-9), "Implicit dynamics/Error tolerance": dynamic}
    result: dict[str, object] = {
        "Solver/Force tolerance": residual,
        "Solver/Maximum augmentations": 60,
        **{f"Contact pairs/{name}/Penetration tolerance": depth for name in names},
    }
    result["Time stepping/Initial step"] = repr(end / 400)
    if entries.get("Time stepping/Step control") != "fixed":
        result["Time stepping/Maximum step"] = repr(end / 400)
    return result


rows: list[list[Any]] = []
csv_rows: list[list[object]] = []
errors: dict[str, dict[str, float]] = {}
failures: dict[str, str] = {}
looser: dict[str, float] = {}
for path in sorted((ROOT / "prm").glob("*.prm")):
    cut: dict[str, object] = {**left_to_profiles(path), **CUT.get(path.stem, {})}
    variants: list[Changes] = [{**cut, **reference(path, cut, *TIGHT[0])}]
    variants += [{**cut, **{"Profile": profile}} for profile in PROFILES]
    exact, *others = run_all(path, variants, options.ranks, at_once=2)
    for tight in TIGHT[1:] if not exact.finished and not exact.is_explicit else ():
        exact = CurveRun(path, {**cut, **reference(path, cut, *tight)}, options.ranks)
        if exact.finished:
            looser[path.stem] = tight[0]
            break
    if not exact.finished:
        failures[path.stem] = first_sentence(exact.failure)
    runs = dict(zip(PROFILES, others))
    empty = run_all(path, [without_time(cut, path)] * 2, options.ranks, at_once=1)
    set_up = min(run.seconds for run in empty) if all(run.finished for run in empty) else 0.0
    for profile, run in runs.items():
        off = error(run, exact) if exact.finished and run.finished else math.nan
        errors.setdefault(path.stem, {})[profile] = off
        unit = "element updates" if run.is_explicit else "iterations"
        csv_rows.append(
            [path.stem, profile, run.finished, run.steps, run.work, unit, f"{run.seconds:.4g}", f"{off:.4g}"]
        )
        done = (
            [run.steps, run.work, number(run.seconds), percent(off)]
            if run.finished
            else [f"stops at {run.times[-1] if run.times else 0:.2g}", run.work, number(run.seconds), "–"]
        )
        ratio = ""
        if profile == "fast" and run.finished and runs["accurate"].finished:
            spent = [max(one.seconds - set_up, 0.01) for one in (runs["accurate"], run)]
            ratio = f"{spent[0] / spent[1]:.1f} / {runs['accurate'].work / run.work:.1f}"
        rows.append([path.stem + (" (cut)" if path.stem in CUT else ""), profile] + done + [ratio])
    csv_rows.append(
        [path.stem, "reference", exact.finished, exact.steps, exact.work, unit, f"{exact.seconds:.4g}", ""]
    )

cheaper = sum(1 for row in rows if row[-1] and float(row[-1].split("/")[0]) >= 4.0)
shown = sum(1 for row in rows if row[-1])
publish(
    "profiles",
    "Cost and error of the profiles",
    options,
    (
        "This page shows what `Profile` = fast, balanced and accurate cost, and what errors they make. Each"
        " shipped scene runs without what the scene itself sets of it (in absolute units penalties stay)."
        " Scenes marked cut have less time or a coarser mesh, as in the script. Each run is done once.\n\n"
        "- Work: Newton iterations with those of failed steps and of estimates; of explicit scenes element"
        " updates.\n"
        "- Error: ∫Σ|F − F*| dt over ∫Σ|F*| dt of the forces of all tools and pairs. For explicit scenes it"
        " is that of kinetic energy and of what is stored or dissipated. The error of the mesh is not in"
        " it.\n"
        "- Accurate / fast: CPU seconds / work of accurate over fast.\n\n"
        "The reference F* is a run on the same mesh.\n\n"
        "- Statics: 400 steps, augmented to 1e-6 of a facet, residuals below 1e-10.\n"
        "- Implicit dynamics: an error tolerance of 1e-6 instead, and the penalties of the scene, whose"
        " error is not included.\n"
        "- Explicit: assumed strains, the scene's law, a safety factor of 0.3 and a contact resolution of"
        " 4. Where penalties are factors, the penalty factor is 100.\n\n"
        "The seconds in the last column are without those of setting up. Setting up takes what a run of"
        " 1e-5 of the time takes (the less of two; none where that fails). At least 0.01 s are left of"
        " each, so that the largest ratios are rough."
    ),
    f"fast takes a quarter of accurate's CPU seconds or less in {cheaper} of {shown} scenes in which both"
    " end.",
    no_better(errors),
    without_errors(failures),
    with_looser(looser),
    table(["scene", "profile", "steps", "work", "CPU seconds", "error", "accurate / fast"], rows),
)
if not options.quick:
    write_csv(
        "profiles",
        ["scene", "profile", "finished", "steps", "work", "unit", "cpu_seconds", "error"],
        csv_rows,
    )
