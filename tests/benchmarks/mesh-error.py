# SPDX-License-Identifier: LGPL-2.1-or-later
"""The estimated error of the mesh beside the differences from finer meshes."""

from __future__ import annotations

import math
from typing import NamedTuple

from billet_runs import ROOT, Changes, arguments, number, percent, publish, table
from curve_runs import CurveRun, error, with_curves

options = arguments("mesh-error")


class Case(NamedTuple):
    """A scene, what is compared (columns of the history before .force_x; none: the work), and what its meshes
    change, each twice as fine as the one before."""

    scene: str
    compared: tuple[str, ...]
    meshes: list[Changes]


def arguments_of(body: str, texts: list[str]) -> list[Changes]:
    return [{f"Bodies/{body}/Mesh/Arguments": text} for text in texts]


def merged(*parts: list[Changes]) -> list[Changes]:
    return [{key: value for part in level for key, value in part.items()} for level in zip(*parts)]


def refined(body: str, levels: tuple[int, ...], layers: tuple[int, ...] = ()) -> list[Changes]:
    changes: list[Changes] = [{f"Bodies/{body}/Mesh/Refinements": level} for level in levels]
    return merged(changes, [{f"Bodies/{body}/Mesh/Layers": n} for n in layers]) if layers else changes


CASES = [
    Case("billet_upsetting", ("die",), refined("billet", (0, 1, 2, 3), (3, 6, 12, 24))),
    Case(
        "hertz_cylinders",
        ("upper.support top",),
        merged(
            arguments_of(
                "lower", [f"{n}, 1, {n // 2} : 0, 0, -1 : 1, 0.1, 0 : true" for n in (10, 20, 40, 80)]
            ),
            arguments_of(
                "upper", [f"{n - n // 8}, 1, {n // 2} : 0, 0, 0 : 1, 0.1, 1 : true" for n in (10, 20, 40, 80)]
            ),
        ),
    ),
    Case(
        "press_fit",
        ("fit",),
        merged(
            arguments_of("inner", [f"{n}, {3 * n}, 1 : 10, 0, 0 : 20.01, 90, 1 : true" for n in (2, 4, 8)]),
            arguments_of("outer", [f"{n}, {3 * n}, 1 : 20, 0, 0 : 30, 90, 1 : true" for n in (2, 4, 8)]),
        ),
    ),
    Case(
        "ring_crush",
        ("die",),
        arguments_of("ring", [f"{n}, 1, {24 * n} : 9.5, 0, -90 : 10, 0.5, 90 : true" for n in (2, 4, 8)]),
    ),
    Case(
        "slab_rolling",
        ("roll",),
        arguments_of("slab", [f"{9 * n}, {n} : -66.16, 0 : -21.16, 5" for n in (2, 4, 8)]),
    ),
    Case("pressurised_cylinder", (), refined("cylinder", (1, 2, 4))),
    Case(
        "snap_fit",
        ("catch",),
        arguments_of("clip", [f"{41 * n}, {2 * n} : 0, 0 : 20.5, 1" for n in (1, 2, 4)]),
    ),
    Case(
        "step_punch",
        ("punch",),
        arguments_of("block", [f"{n}, {n}, {n // 2 + 1} : 0, 0, 0 : 10, 10, 10" for n in (4, 8, 16)]),
    ),
    Case("bracket", ("bracket.support pull",), refined("bracket", (0, 1))),
    Case("wagoner_punch_mu_0", ("punch",), refined("blank", (2, 3, 4))),
    Case(
        "tube_crush",
        ("plane",),
        arguments_of("tube", [f"{8 * n}, {n}, {25 * n} : 0, 0, 0 : 2, 1, 150 : true" for n in (1, 2)]),
    ),
]


def compared(run: CurveRun, names: tuple[str, ...]) -> CurveRun:
    forces = {name: run.forces[name] for name in names}
    return with_curves(run, forces or {"work": run.energies["stored or dissipated"]})


def observed_order(errors: list[float]) -> float:
    """Order of the last two differences from the finest mesh; NaN where they do not fall."""
    if len(errors) < 2 or not errors[-1] < errors[-2]:
        return math.nan
    return math.log2(errors[-2] / errors[-1])


def extrapolated(differences: list[float]) -> float:
    """Error of the finest of some meshes from the differences between each and the next, as billet's
    run/target_mesh.h has it; NaN for a single mesh."""
    if not differences:
        return math.nan
    if len(differences) < 2:
        return differences[-1]
    before, last = differences[-2:]
    if not before > last:
        return max(before, last)
    return float(last / (2 ** min(2.0, math.log2(before / last)) - 1)) if last > 0 else 0.0


def lines_of(case: Case) -> list[list[object]]:
    scene = ROOT / f"prm/{case.scene}.prm"
    meshes = case.meshes[:-1] if options.quick and len(case.meshes) > 2 else case.meshes
    runs = [CurveRun(scene, changes, options.ranks) for changes in meshes]
    *coarse, finest = [compared(run, case.compared) for run in runs]
    lines: list[list[object]] = []
    errors: list[float] = []
    differences: list[float] = []
    for place, (run, curves) in enumerate(zip(runs, coarse)):
        errors.append(error(curves, finest))
        ratio = run.mesh_error / errors[-1] if errors[-1] > 0 else math.nan
        if place > 0:
            differences.append(error(coarse[place - 1], curves))
        by_levels = extrapolated(differences)
        lines.append(
            [
                case.scene,
                run.elements,
                percent(errors[-1]),
                percent(run.mesh_error),
                number(ratio, 2),
                "" if math.isnan(by_levels) else percent(by_levels),
                "" if math.isnan(by_levels) else number(by_levels / errors[-1], 2),
                number(run.seconds, 3),
            ]
        )
    last = runs[-1]
    order = observed_order(errors)
    lines.append(
        [
            case.scene,
            last.elements,
            f"reference (order {number(order, 2)})",
            percent(last.mesh_error),
            "",
            "",
            "",
            number(last.seconds, 3),
        ]
    )
    return lines


rows = [line for case in CASES for line in lines_of(case)]
ratios = [float(str(row[4])) for row in rows if row[4] not in ("", "–")]
n_within = sum(0.5 <= ratio <= 3.0 for ratio in ratios)
n_below = sum(ratio < 1.0 for ratio in ratios)
by_levels = [float(str(row[6])) for row in rows if row[6] not in ("", "–")]
n_levels_within = sum(0.5 <= ratio <= 3.0 for ratio in by_levels)
n_levels_below = sum(ratio < 1.0 for ratio in by_levels)
publish(
    "mesh-error",
    "The error of the mesh, estimated and found",
    options,
    (
        "This page compares the error that the program estimates for a mesh with the difference from a"
        " finer mesh. Shipped scenes run on coarser and finer meshes; the scenes set the rest.\n\n"
        "- Difference: ∫|F − F*| dt over ∫|F*| dt of the forces of a tool or support, against those of the"
        " finest mesh of the scene. Where loads drive it, the work of deformation is compared.\n"
        "- Estimated: the last value of `mesh_error`.\n"
        "- Ratio: estimated over difference.\n"
        "- By levels: the error that `Target error of = everything` extrapolates from the differences"
        " between this mesh and those before it; its ratio likewise.\n\n"
        "The finest mesh has an error of its own, so that the last difference of each scene is too small."
        " It is too small by a third if errors fall fourfold, by half if they fall to a half."
    ),
    f"{n_within} of {len(ratios)} ratios are from 0.5 to 3; {n_below} estimates are below the difference. By"
    f" levels it is {n_levels_within} of {len(by_levels)}, and {n_levels_below} below.",
    table(
        ["scene", "elements", "difference", "estimated", "ratio", "by levels", "ratio", "CPU seconds"], rows
    ),
)
