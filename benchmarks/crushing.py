# SPDX-License-Identifier: LGPL-2.1-or-later
"""Crushed bodies with each element: perturbed meshes, closed forms, finer meshes, billet, Taylor's bar,
necking, a closed die."""

from __future__ import annotations

import math
import os
import tempfile
from pathlib import Path
from typing import Any, Iterable, Mapping

import matplotlib
import numpy
from scipy.spatial import cKDTree

from billet_runs import ROOT, Changes, Run, arguments, fixed_steps, mesh, n_elements, number, publish, table
from brick_runs import AS, E, ELEMENTS, MD, OP, Bricks, Picture, Solution, held, planes, plastic, signed
from explicit_runs import ExplicitRun, norm
from billet_tools.output import Array

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402
from matplotlib.collections import PolyCollection  # noqa: E402

NAME = "crushing"
options = arguments(NAME)
KEEP = os.environ.get("KEEP")  # a folder in which all scenes, meshes and results stay
PENALTY = 400 * E  # the edges of the blocks are 1
HEIGHTS = {0.5: 2.0, 0.4: 2.4, 0.3: 2.8, 0.25: 3.0}  # of a unit block: at these times
TIMES = {
    "Time stepping/End time": 3,
    "Time stepping/Initial step": 0.03,
    "Time stepping/Maximum step": 0.1,
    "Output/Step interval": None,
    "Output/Interval": 0.2,
}
HARDENING, PERFECT = "plastic, hardening", "perfectly plastic"
HEIGHTS_OF_GAPS = {0.65: 1.4, 0.6: 1.6, 0.55: 1.8}
LAWS: dict[str, tuple[str, float, Mapping[str, str]]] = {
    "neo-Hookean, ν = 0.3": ("neo-Hookean", 0.3, {}),
    "neo-Hookean, ν = 0.4999": ("neo-Hookean", 0.4999, {}),
    "Hencky, ν = 0.3": ("Hencky", 0.3, {}),
    "Hencky, ν = 0.4999": ("Hencky", 0.4999, {}),
    HARDENING: ("Hencky", 0.3, plastic(100.0, 200.0)),
    PERFECT: ("Hencky", 0.3, plastic(100.0)),
}
SOFT_LAW = "neo-Hookean, ν = 0.3"


def kept(label: str) -> Path | None:
    return Path(KEEP, "".join(c if c.isalnum() or c in ".-" else "_" for c in label)) if KEEP else None


def solve(
    label: str, bricks: Bricks, element: str, changes: Changes, law: str = HARDENING, **settings: Any
) -> Solution:
    kinematics, nu, material = LAWS[law]
    run_settings: dict[str, Any] = {"nu": nu, "steps": None, "pictures": True, "limit": 280, **settings}
    return Solution(
        f"{label}, {law}",
        bricks,
        element,
        {**TIMES, **material, **changes},
        law=kinematics,
        keep=kept(f"{label}-{law}-{element}"),
        **run_settings,
    )


def tool(
    name: str, shape: Mapping[str, object], way: str, faces: object, friction: float = 0.0, **pairing: object
) -> dict[str, object]:
    """Changes for a rigid tool and its contact with these faces of the body."""
    path, pair = f"Tools/{name}/", f"Contact pairs/{name}/"
    return {
        **{f"{path}Surfaces/face/{key}": value for key, value in shape.items()},
        path + "Motion/Translation": way,
        pair + "Body": "body",
        pair + "Boundary ids": faces,
        pair + "Tool": name,
        pair + "Penalty unit": "absolute",
        pair + "Normal penalty": repr(PENALTY),
        pair + "Friction coefficient": friction,
        **{pair + key: value for key, value in pairing.items()},
    }


def plane(point: str, normal: str) -> dict[str, object]:
    return {"Shape": "plane", "Point": point, "Normal": normal}


TOP = plane("0, 0, 1", "0, 0, -1")


def reached(run: Solution, time: float) -> bool:
    return bool(run.rows) and run.rows[-1]["time"] > time - 1e-6


def history(run: Solution, key: str, time: float) -> float:
    """NaN if the run has not come so far."""
    return min(run.rows, key=lambda row: abs(row["time"] - time))[key] if reached(run, time) else math.nan


def height_reached(run: Solution) -> float:
    return 1 - 0.25 * run.rows[-1]["time"] if run.rows else 1.0


def shown(error: float) -> str:
    return "–" if math.isnan(error) else signed(error)


def small(value: float) -> str:
    return number(float(value), 2)


def beside(finest: Iterable[float]) -> tuple[float, str]:
    """Mean of values that two elements give on a finer mesh, and half their difference over it, shown."""
    there = [value for value in finest if not math.isnan(value)]
    right = sum(there) / len(there) if there else math.nan
    spread = (max(there) - min(there)) / 2 / abs(right) if len(there) > 1 else math.nan
    return right, "–" if math.isnan(spread) else f"± {100 * spread:.2g}"


claims: dict[str, tuple[float, float]] = {}  # of assumed strains: the worst of what was found, its limit


def claim(text: str, found: float, limit: float) -> None:
    worst, _ = claims.get(text, (0.0, limit))
    claims[text] = (math.nan if math.isnan(found) or math.isnan(worst) else max(abs(found), worst)), limit


def what_is_wanted() -> str:
    return table(
        ["of assumed strains", "limit", "found", "holds"],
        [
            [text, small(limit), small(found), "yes" if found <= limit else "no"]
            for text, (found, limit) in claims.items()
        ],
    )


def notes(runs: Mapping[str, Solution]) -> str:
    """Returns warnings and failures of runs in short."""
    return (
        "; ".join(f"{element}: {', '.join(run.keys)}" for element, run in runs.items() if run.keys) or "none"
    )


# Meshes, and what a deformation of them looks like.


def block(n: int, moved: float, seed: int = 1) -> Bricks:
    """A unit cube of n x n x n bricks; its nodes are moved at random by up to so much of an edge, those of
    the surface within it."""
    along = numpy.linspace(0, 1, n + 1)
    bricks, generator = Bricks(along, along, along), numpy.random.RandomState(seed)
    for axis in range(3):
        inner = abs(bricks.points[:, axis] - 0.5) < 0.5 - 1e-9
        bricks.points[inner, axis] += moved / n * generator.uniform(-1, 1, inner.sum())
    return bricks


def flat_block(n: int, moved: float) -> Bricks:
    """The same for plane strain: n x 1 x n bricks, in which both layers of nodes move alike."""
    bricks, moves = Bricks(
        numpy.linspace(0, 1, n + 1), [0, 1], numpy.linspace(0, 1, n + 1)
    ), numpy.random.RandomState(1).uniform(-1, 1, (2, n + 1, n + 1))
    index = numpy.round(bricks.points * n).astype(int)
    for move, axis in zip(moves, (0, 2)):
        inner = (index[:, axis] > 0) & (index[:, axis] < n)
        bricks.points[inner, axis] += moved / n * move[index[inner, 0], index[inner, 2]]
    return bricks


class Waves:
    """Deviation of a picture of a cube from an affine deformation, in edges: the `largest` one, and root mean
    squares of the hourglass amplitudes of the bricks. These have a part that alternates from each brick to
    its neighbours, and the rest."""

    def __init__(self, bricks: Bricks, n: int, picture: Picture) -> None:
        moved, start, _ = picture
        _, where = cKDTree(start).query(bricks.points)
        u, X = (moved - start)[where], bricks.points
        linear = numpy.column_stack([X, numpy.ones(len(X))])
        affine, *_ = numpy.linalg.lstsq(linear, u, rcond=None)
        self.deviation = (u - linear @ affine) * n
        self.size = numpy.linalg.norm(self.deviation, axis=1)
        self.largest, self.height = self.size.max(), (X + u)[:, 2].max()
        x, y, z = numpy.array([(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]).T
        patterns = numpy.array([y * z, x * z, x * y, x * y * z]) / 8
        amplitudes = []
        for cell in bricks.cells:
            own = numpy.column_stack([X[cell], numpy.ones(8)])
            deviation = self.deviation[cell]
            # nothing of linear fields
            amplitudes.append(patterns @ (deviation - own @ (numpy.linalg.pinv(own) @ deviation)))
        grid = numpy.array(amplitudes).reshape(n, n, n, 12)
        pairs = [
            (numpy.take(grid, range(1, n), axis), numpy.take(grid, range(n - 1), axis)) for axis in range(3)
        ]
        self.alternating, self.even = (
            math.sqrt(
                sum((((a + sign * b) / 2) ** 2).sum() for a, b in pairs) / sum(a.size / 12 for a, _ in pairs)
            )
            for sign in (-1, 1)
        )


# Frictionless between plates.


def bar(law: str, stretch: float) -> float:
    """Returns the Kirchhoff stress along a bar pressed without friction, over the closed forms of the
    laws."""
    kinematics, nu, material = LAWS[law]
    strain = math.log(stretch)
    if material:
        modulus = float(material["Bodies/body/Material/Hardening modulus"])
        return -100.0 - modulus * (-strain - 100.0 / E) / (1 + modulus / E)
    if kinematics == "Hencky":
        return E * strain
    G, K, low, high = E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu)), 0.0, -strain
    for _ in range(100):  # no stress across
        across = (low + high) / 2
        J, along, other = math.exp(strain + 2 * across), math.exp(2 * strain), math.exp(2 * across)
        mean = (along + 2 * other) / 3
        low, high = (
            (low, across) if G * J ** (-2 / 3) * (other - mean) + K * math.log(J) > 0 else (across, high)
        )
    return G * J ** (-2 / 3) * (along - mean) + K * math.log(J)


def between_plates(
    n: int, moved: float, law: str, element: str, pairing: Mapping[str, Any]
) -> tuple[Solution, dict[float, tuple[float, Waves]]]:
    bricks = block(n, moved)
    run = solve(
        f"plates {n} {moved}{' uneven' if pairing else ''}",
        bricks,
        element,
        {**planes("x = 0 ; y = 0 ; z = 0"), **tool("press", TOP, "0 ; 0 ; -0.25*t", 6, **pairing)},
        law,
    )
    found = {}
    for height, time in HEIGHTS.items():
        if reached(run, time):
            waves = Waves(bricks, n, run.pictures[round(5 * time)])
            force = -history(run, "press.force_z", time) / (-bar(law, waves.height) / waves.height) - 1
            found[height] = force, waves
    return run, found


def plates() -> str:
    cases = [(4, moved) for moved in (1e-6, 0.05, 0.2)] + ([] if options.quick else [(8, 0.2)])
    rows = []
    for law in LAWS:
        for n in sorted({n for n, _ in cases}):
            cells = []
            for element in ELEMENTS:
                runs = [between_plates(n, moved, law, element, {}) for k, moved in cases if k == n]
                if any(run.failure for run, _ in runs):
                    cells += [f"to {max(height_reached(run) for run, _ in runs):.3f}", "–"]
                    continue
                waves = [found[height] for _, found in runs for height in (0.5, 0.25)]
                if element == AS:
                    claim(
                        "Plates without friction: error of the force",
                        max(abs(force) for force, _ in waves),
                        1e-5,
                    )
                    claim(
                        "Plates without friction: distance of a node from its place, in edges",
                        max(w.largest for _, w in waves),
                        1e-5,
                    )
                cells += [
                    small(max(abs(force) for force, _ in waves)),
                    small(max(w.largest for _, w in waves)),
                ]
            rows.append([law, f"{n}³", *cells])
    return (
        "A cube, an eighth of a block, is pressed by a rigid plane without friction to half and a quarter"
        " of its height. Its nodes are moved at random by up to 1e-6, 0.05 and 0.2 of an edge (8³ bricks:"
        " 0.2). The exact solution is affine on each of these meshes.\n\n"
        "The table has the largest values of all such runs and both heights for each element. *Force* is"
        " the error of the force, over the closed form of the law at that height. *Node* is the distance of"
        " a node from its place in the best affine deformation, in edges. Field output holds seven"
        " digits.\n\n"
        + table(
            ["law", "bricks"] + [f"{element}: {what}" for element in ELEMENTS for what in ("force", "node")],
            rows,
        )
    )


def uneven() -> str:
    rows = []
    for law in LAWS:
        runs = {
            element: between_plates(4, 0.2, law, element, {"Penalty unit": "factor", "Normal penalty": 100})
            for element in ELEMENTS
        }
        row = [law]
        for run, found in runs.values():
            row += ["yes" if not run.failure else f"to {height_reached(run):.3f}"]
            row += [small(found[height][1].largest) if height in found else "–" for height in (0.5, 0.25)]
            row += [small(found[0.25][1].alternating) if 0.25 in found else "–"]
        rows.append([*row, notes({element: run for element, (run, _) in runs.items()})])
        claim(
            "Disturbed plates without friction: height at which a run ends",
            height_reached(runs[AS][0]),
            0.2501,
        )
    return (
        "This is the same block, 4³ bricks moved by 0.2, but with the penalty as a factor, 100 E/h of each"
        " facet. Facets of other sizes go deeper, by some 1e-3 of an edge. That disturbs the affine"
        " solution.\n\n"
        "Elastic blocks with free sides have true instabilities at such strains. Biot's wrinkles of a free"
        " surface appear at a stretch of 0.44 where the neo-Hookean law does not compress. A small"
        " disturbance may grow there in the exact solution, too.\n\n"
        "The table says whether the run ends. It has the largest deviation at half and a quarter of the"
        " height. It also has the part of hourglass patterns that alternates from brick to brick at the"
        " end, in edges.\n\n"
        + table(
            ["law"]
            + [
                f"{element}: {what}"
                for element in ELEMENTS
                for what in ("ends", "at 1/2", "at 1/4", "alternates")
            ]
            + ["warnings"],
            rows,
        )
    )


# Between walls, one of which is rippled.

RIPPLE = 0.02


def walled(n: int, waves: float, moved: float, law: str, element: str) -> tuple[Solution, list[float]]:
    """Runs a cube with all normal displacements prescribed, as in plane strain without change of volume. The
    wall x = 1 has a ripple of so many half waves, straight between its crests."""
    bricks = block(n, moved)
    triangle = [f"(1 - 2*acos(cos({waves}*pi*{v}))/pi)" for v in "yz"]
    wall = f"1/(1 - 0.25*t) - 1 + {RIPPLE / waves!r}*min(1, 20*t)*" + "*".join(triangle)
    run = solve(
        f"walls {n} {waves} {moved}",
        bricks,
        element,
        {
            **planes("x = 0 ; y = 0 ; y = 1 ; z = 0"),
            **held("wall", 2, "x", f"{wall} ; 0 ; 0"),
            **held("top", 6, "z", "0 ; 0 ; -0.25*t"),
        },
        law,
    )
    found = []
    for time in (0.2, 2.0, 3.0):
        if not reached(run, time):
            found.append(math.nan)
            continue
        w = Waves(bricks, n, run.pictures[round(5 * time)])
        grid = numpy.round(bricks.points * waves)  # the nodes of the coarse mesh alone
        where = (
            (abs(bricks.points * waves - grid).max(axis=1) < 0.3 * waves / n + 1e-9)
            & (grid[:, 0] > 0)
            & (grid[:, 0] < waves)
        )
        found.append(math.sqrt((w.size[where] ** 2).mean()) / n * waves / RIPPLE)
    return run, found


def walls() -> str:
    rows = []
    for law in LAWS:
        runs = [walled(4, 4, 0.2, law, element) for element in ELEMENTS]
        fine = [] if options.quick else [walled(8, 4, 0, law, element) for element in (AS, MD)]
        for value in runs[0][1] + (fine[0][1] if fine else []):
            claim("Walls: ripple inside over the ripple of the wall", value, 1.0)
        cells = [
            " / ".join(small(value) for value in found)
            + (f" (to {height_reached(run):.3f})" if run.failure else "")
            for run, found in runs + fine
        ]
        rows.append([law, *cells[:3], *(cells[3:] or ["–", "–"])])
    return (
        "All six sides of the cube are held. They move as plane strain without change of volume wants, and"
        " nodes slide along them, 4³ bricks moved by 0.2. One wall has a ripple with an amplitude of 0.02"
        " edges. It alternates from node to node, which is the shortest wave that the mesh has.\n\n"
        "The table has the root mean square of the deviation of inner nodes from an affine deformation,"
        " over that amplitude. Heights are 0.95, 0.5 and 0.25. In a stable solution it stays of the order"
        " of one or less.\n\n"
        "Beside it stand 8³ bricks with the same ripple (two bricks a half wave), at the same places. There"
        " assumed strains answer more than mean dilatation, since they resist such waves less. They do so"
        " most at a quarter of the height.\n\n" + table(["law", *ELEMENTS, f"8³, {AS}", f"8³, {MD}"], rows)
    )


# Rough plates.


def rough(
    n: int, moved: float, law: str, element: str, flat: bool = True, until: float = 3, sides: bool = True
) -> tuple[Solution, Bricks]:
    """`sides`: they touch the plane, too, as soon as they reach it."""
    bricks = flat_block(n, moved) if flat else block(n, moved)
    faces = "6" if not sides else "2, 6" if flat else "2, 4, 6"
    run = solve(
        f"rough {'flat' if flat else 'solid'} {n} {moved}{'' if sides else ' no sides'}",
        bricks,
        element,
        {
            **planes("x = 0 ; y = 0 ; z = 0" + (" ; y = 1" if flat else "")),
            "Time stepping/End time": until,
            **tool("press", TOP, "0 ; 0 ; -0.25*t", faces, 0.5),
        },
        law,
        limit=1500 if n > 8 else 280,
    )
    return run, bricks


def curve(run: Solution, times: Array) -> tuple[Array, Array]:
    """Force and contact area at these times, NaN where the run did not come; forces grow exponentially
    between steps."""
    own = [row["time"] for row in run.rows]
    force = numpy.exp(
        numpy.interp(times, own, [math.log(-row["press.force_z"]) for row in run.rows], right=math.nan)
    )
    return force, numpy.interp(times, own, [row["press.contact_area"] for row in run.rows], right=math.nan)


class Curves:
    """Errors along the curve between two times, over the mean of the finest runs: the mean size of the
    force's error, and the mean errors of the contact area and of the force per contact area, with their
    signs."""

    def __init__(self, run: Solution, fine: Iterable[Solution], first: float, last: float) -> None:
        times = numpy.linspace(first, last, round((last - first) / 0.05) + 1)
        right, area = numpy.nanmean([curve(f, times) for f in fine], axis=0)
        own, own_area = curve(run, times)
        known = ~numpy.isnan(own)
        self.force = abs(own / right - 1)[known].mean() if known.any() else math.nan
        self.area = (own_area / area - 1)[known].mean() if known.any() else math.nan
        self.pressure = (own / own_area / (right / area) - 1)[known].mean() if known.any() else math.nan

    def __str__(self) -> str:
        return (
            "–"
            if math.isnan(self.force)
            else f"{100 * self.force:.1f} ({signed(self.area)} / {signed(self.pressure)})"
        )


CURVES = (
    "The table has the mean error of the force along the curve in %. Brackets have the mean errors, with"
    " their signs, of the contact area and of the force per contact area"
)


def rough_flat() -> str:
    rows, along, pictures = [], [], {}
    for law in (SOFT_LAW, HARDENING, PERFECT):
        finest = 8 if options.quick else 16 if law == PERFECT else 32
        fine = [rough(finest, 1e-6, law, element)[0] for element in (AS, MD)]
        for n, moved in ((4, 1e-6), (4, 0.2), (8, 1e-6), (8, 0.2), (16, 1e-6)):
            if n >= finest:
                continue
            runs = {element: rough(n, moved, law, element)[0] for element in ELEMENTS}
            if law == HARDENING and (n, moved) == (8, 0.2):
                pictures.update(runs)
            claim(
                "Rough plates, plane strain: height at which a run ends",
                max(height_reached(run) for run in (runs[AS], fine[0])),
                0.2501,
            )
            parts = [
                {element: Curves(run, fine, *part) for element, run in runs.items()}
                for part in ((0.2, 2), (2, 3))
            ]
            if n == 8:
                claim(
                    f"Rough plates, 8², until half of the height, {law}: mean error of the force",
                    parts[0][AS].force,
                    0.03,
                )
                claim(
                    f"Rough plates, 8², from a half to a quarter, {law}: mean error of the force",
                    parts[1][AS].force,
                    0.05,
                )
            errors = [
                " / ".join(
                    shown(
                        history(run, "press.force_z", time)
                        / beside([history(f, "press.force_z", time) for f in fine])[0]
                        - 1
                    )
                    for time in HEIGHTS.values()
                )
                for run in runs.values()
            ]
            rows.append(
                [
                    law,
                    f"{n}²",
                    moved,
                    *errors,
                    " / ".join(
                        beside([history(f, "press.force_z", time) for f in fine])[1]
                        for time in HEIGHTS.values()
                    ),
                    notes({element: run for element, run in runs.items()}),
                ]
            )
            along.append([law, f"{n}²", moved, *[part[element] for part in parts for element in ELEMENTS]])
    draw(pictures)
    return (
        "Half of a block of 2 × 2 in plane strain is pressed by a plane with a friction coefficient of 0.5."
        " Its side folds onto the plane. At a quarter of the height the block is 16 times as long as high,"
        " and most of it sticks. Forces there follow from how thin it is.\n\n"
        "The table has the error of the force in % at 1/2, 0.4, 0.3 and 1/4 of the height. The reference is"
        " the mean of assumed strains and mean dilatation on 32² regular bricks, with perfect plasticity"
        " 16². Half of the difference of these two is in the column before the last. A dash: the run ended"
        " before. Where the finest have one, mean dilatation stands alone.\n\n"
        + table(["law", "bricks", "moved by", *ELEMENTS, "finest differ by", "warnings"], rows)
        + "\n\n"
        "As a row of bricks folds onto the plane the contact area jumps by its length, with any"
        " element, and the force with it. Single heights thus show when that happens on a mesh, and"
        f" whole curves how good it is. {CURVES}. Curves go until half of the height, and from there to"
        " a quarter, as far as a run comes.\n\n"
        "Mean dilatation opens voids under the plane where bricks would have to bend round the fold"
        " (the white triangles below). They shrink as the mesh is refined. Its area is too small, its"
        " pressure too high, and the errors of the force cancel. Assumed strains have no such voids."
        " Their area is right, and the pressure is too high on coarse meshes.\n\n"
        + table(
            [
                "law",
                "bricks",
                "moved by",
                *[f"{element}: {part}" for part in ("to 1/2", "1/2 to 1/4") for element in ELEMENTS],
            ],
            along,
        )
        + "\n\n"
        f"![Deformed meshes](../images/{NAME}.png)\n\n"
        "The picture has hardening, 8² bricks moved by 0.2, at 1/2 and 0.3 of the height."
    )


def in_turn(points: Array, face: list[int]) -> list[int]:
    """The corners of a face in the x-z plane, one after the other around its centre."""
    centre = points[face].mean(axis=0)
    return sorted(face, key=lambda p: math.atan2(points[p, 2] - centre[2], points[p, 0] - centre[0]))


def draw(runs: Mapping[str, Solution]) -> None:
    figure, axes = pyplot.subplots(
        2, len(runs), figsize=(12, 4.5), squeeze=False, sharex="row", sharey="row", constrained_layout=True
    )
    for column, (element, run) in enumerate(runs.items()):
        for row, time in enumerate((2.0, 2.8)):
            axis = axes[row][column]
            axis.set_title(f"{element}, height {1 - 0.25 * time:g}", fontsize=9)
            if reached(run, time):
                moved, start, fields = run.pictures[round(5 * time)]
                cells = [range(i, i + 8) for i in range(0, len(moved), 8)]
                faces = [[p for p in cell if abs(start[p, 1]) < 1e-6] for cell in cells]
                around = [in_turn(moved, face) for face in faces]
                strain = numpy.array([fields["equivalent_plastic_strain"][face].mean() for face in faces])
                collection = PolyCollection(
                    [moved[face][:, (0, 2)] for face in around],
                    array=strain,
                    edgecolor="black",
                    linewidth=0.4,
                )
                axis.add_collection(collection)
                axis.autoscale()
                collection.set_clim(0, (2.2, 5.5)[row])
                figure.colorbar(collection, ax=axis, pad=0.02).ax.tick_params(labelsize=7)
    figure.suptitle("Equivalent plastic strain", fontsize=10)
    figure.savefig(ROOT / f"doc/images/{NAME}.png", dpi=80, metadata={"Software": None})
    pyplot.close(figure)


def rough_solid() -> str:
    rows, along, gaps, n = [], [], [], 4
    for law, until, low in (
        ((SOFT_LAW, 3, 0.25),) if options.quick else ((SOFT_LAW, 3, 0.25), (HARDENING, 2.4, 0.4))
    ):
        finest = 3 * n if options.large and law == HARDENING else 2 * n
        fine = {element: rough(finest, 1e-6, law, element, False, until)[0] for element in (AS, MD)}
        for moved in (1e-6, 0.2):
            runs = {element: rough(n, moved, law, element, False, until) for element in ELEMENTS}
            for height in (0.5, low):
                time = HEIGHTS[height]
                right, spread = beside([history(f, "press.force_z", time) for f in fine.values()])
                row = [law, moved, height]
                for run, bricks in runs.values():
                    w = Waves(bricks, n, run.pictures[round(5 * time)]) if reached(run, time) else None
                    row += [
                        shown(history(run, "press.force_z", time) / right - 1),
                        f"{w.alternating:.3f} / {w.even:.3f}" if w else "–",
                    ]
                rows.append([*row, spread])
            parts = [
                {element: Curves(run, fine.values(), *part) for element, (run, _) in runs.items()}
                for part in ((0.2, 2), (2, until))
            ]
            for what, part in zip(("until half of the height", f"from a half to {low}"), parts):
                claim(f"Rough plates, {n}³, {what}, {law}: mean error of the force", part[AS].force, 0.05)
            along.append([law, moved, f"{low}", *[part[element] for part in parts for element in ELEMENTS]])
            if law == HARDENING and moved == 1e-6:
                for m, element, run in [(n, element, run) for element, (run, _) in runs.items()] + [
                    (finest, element, run) for element, run in fine.items()
                ]:
                    places = [
                        run.where((1, 0, 0.75), round(5 * HEIGHTS_OF_GAPS[height]))
                        for height in HEIGHTS_OF_GAPS
                    ]
                    gaps.append(
                        [
                            f"{m}³",
                            element,
                            *[
                                small(max(0.0, height - place[2]))
                                for height, place in zip(HEIGHTS_OF_GAPS, places)
                            ],
                            f"{places[1][0]:.3f}",
                        ]
                    )
    text = (
        f"An eighth of a cube is under the same rough plane, {n}³ bricks. The table has the error of the"
        f" force in %. The reference is the mean of assumed strains and mean dilatation on {2 * n}³ regular"
        " bricks.\n\n"
        "The table also has hourglass patterns of the bricks in edges: what alternates from brick to brick,"
        " and what does not. Corners of the block, where it folds, make such patterns with any element.\n\n"
        + table(
            ["law", "moved by", "height"]
            + [f"{element}: {what}" for element in ELEMENTS for what in ("force", "patterns")]
            + ["finest differ by"],
            rows,
        )
        + "\n\n"
        f"{CURVES}. Curves go until half of the height, and from there on.\n\n"
        + table(
            [
                "law",
                "moved by",
                "ends at",
                *[f"{element}: {part}" for part in ("to 1/2", "from 1/2") for element in ELEMENTS],
            ],
            along,
        )
    )
    if gaps:
        text += (
            "\n\n"
            "When does the side fold? The table follows the node (1, 0, 3/4), with hardening. On the coarse"
            " mesh it is in the middle of a side and a brick below the plane. The table has the distance"
            " from the plane at three heights, and from the axis at the second one.\n\n"
            "At half of the height the coarse mesh has folded all of a ring whose outer part the fine"
            " meshes have just laid down. The ring is also too wide: coarse meshes bulge too much.\n\n"
            + table(
                [
                    "bricks",
                    "element",
                    *[f"gap at {height}" for height in HEIGHTS_OF_GAPS],
                    "distance from the axis",
                ],
                gaps,
            )
        )
    return text


def rough_free() -> str:
    rows = []
    fine = [rough(16, 1e-6, HARDENING, element, until=2, sides=False)[0] for element in (AS, OP)]
    right, spread = beside([history(f, "press.force_z", 2) for f in fine])
    for n in (4, 8):
        runs = {element: rough(n, 1e-6, HARDENING, element, until=2, sides=False)[0] for element in ELEMENTS}
        along = {element: Curves(run, fine, 0.2, 2) for element, run in runs.items()}
        claim(
            f"Rough plates, sides free, {n}², until half of the height: mean error of the force",
            along[AS].force,
            0.05 if n == 4 else 0.03,
        )
        rows.append(
            [
                f"{n}²",
                *[
                    f"{100 * along[element].force:.1f} /"
                    f" {shown(history(run, 'press.force_z', 2) / right - 1)}"
                    for element, run in runs.items()
                ],
            ]
        )
    return (
        "This is the block in plane strain again, plastic with hardening, but only its upper side touches"
        " the plane. The sides pass the plane, nothing folds, and the force has no jumps. The edges of the"
        " block open to more than 180°, as round the edge of a punch.\n\n"
        "The table has the error of the force in %: mean size until half of the height, and at half of it."
        f" The reference is the mean of assumed strains and one point on 16² bricks ({spread} %). Mean"
        " dilatation cannot open its bricks so far: its edges lock.\n\n"
        "A force that kept assumed strains from turning corners of bricks inside out was tried. It reduced"
        " the errors of the folding cube below half of its height from 10 and 12 % to 4 and 8 %. It locked"
        " here, by 24 % on 8² bricks, so that the element has none.\n\n" + table(["bricks", *ELEMENTS], rows)
    )


# Known scenes.


def billet() -> str:
    finest = 2 if options.quick else 3
    runs = {
        (element, r): Run(
            {**mesh(r), **fixed_steps(50), "Bodies/billet/Element": element},
            options.ranks,
            folder=kept(f"billet-{r}-{element}"),
        )
        for element in ELEMENTS
        for r in range(1, finest + 1)
        if element != OP or r < 3
    }
    forces = {key: run.force(1.0) for key, run in runs.items()}
    right, spread = beside([forces[AS, finest], forces[MD, finest]])
    for r in range(1, finest + 1):
        claim(f"Billet, {n_elements(r)} bricks: error of the force", forces[AS, r] / right - 1, 0.01)
    rows = [
        [n_elements(r)]
        + [
            (
                f"{forces[element, r]:.1f} ({shown(forces[element, r] / right - 1)})"
                if (element, r) in forces
                else "–"
            )
            for element in ELEMENTS
        ]
        for r in range(1, finest + 1)
    ]
    return (
        "[`prm/billet_upsetting.prm`](../../prm/billet_upsetting.prm) is upset by 64 % in 50 equal steps"
        " with µ = 0.1. The table has the force on the whole billet at the end in kN, in brackets its error"
        f" in %. The reference is the mean of both elements on {n_elements(finest)} bricks ({spread} %).\n\n"
        + table(["bricks", *ELEMENTS], rows)
    )


def taylor() -> str:
    rows, beyond = [], []
    for refinements in (1, 2, 3) if options.large else (1, 2):
        for element in ELEMENTS:
            with tempfile.TemporaryDirectory() as folder:
                path = "Bodies/bar/"
                run = ExplicitRun(
                    ROOT / "prm/taylor_bar.prm",
                    {
                        path + "Mesh/Refinements": refinements,
                        path + "Mesh/Layers": 24 * 2 ** (refinements - 1),
                        "Output/Interval": 0,
                        path + "Element": element,
                    },
                    Path(folder),
                    options.ranks,
                )
                points, fields = run.picture()
            n = 12 * 4 ** (refinements - 1) * 24 * 2 ** (refinements - 1)
            if element == AS:
                claim(f"Taylor's bar, {n} bricks: radius less 7.2 mm", norm(points, (0, 1)).max() - 7.2, 0.15)
                beyond.append(norm(points, (0, 1)).max() - 7.22)
                claim(f"Taylor's bar, {n} bricks: length less 21.42 mm", points[:, 2].max() - 21.42, 0.15)
            rows.append(
                [
                    n,
                    element,
                    f"{points[:, 2].max():.2f}",
                    f"{norm(points, (0, 1)).max():.2f}",
                    f"{fields['equivalent_plastic_strain'].max():.2f}",
                ]
            )
    claim(
        "Taylor's bar: by how much its radius leaves 7.22 mm from 288 to 2304 bricks",
        max(0.0, abs(beyond[1]) - abs(beyond[0])),
        0.0,
    )
    return (
        "The table has [`prm/taylor_bar.prm`](../../prm/taylor_bar.prm) after 80 µs; more meshes and laws"
        " are on [its page](taylor-bar.md). Usual values are a length of 21.4 to 21.7 mm and a radius of"
        " 6.9 to 7.2 mm.\n\n"
        + table(
            ["bricks", "element", "length [mm]", "radius of the end [mm]", "largest plastic strain"], rows
        )
    )


def neck_run(
    refinements: int, layers: int, element: str
) -> tuple[Solution, dict[int, float], dict[int, float]]:
    """Simo's bar, an eighth of it: radius 6.413, half length 26.667, in kN and mm; layers are finer towards
    the neck."""
    radius, half, material = 6.413, 26.667, "Bodies/body/Material/"
    shrink = f"(1 - 0.018*max(0, 1 - z/{half}))"
    source = {
        "Source": "extruded primitive",
        "File": None,
        "Primitive": "quarter_hyper_ball",
        "Arguments": f"0, 0 : {radius}",
        "Refinements": refinements,
        "Section area": repr(math.pi * radius**2 / 4),
        "Height": half,
        "Layers": layers,
        "Positions": " ; ".join((f"x*{shrink}", f"y*{shrink}", f"z*(0.35 + 0.65*z/{half})")),
    }
    law = {
        "Law": "elastoplastic",
        "Hardening": "Voce",
        "Yield stress": 0.45,
        "Saturation stress": 0.715,
        "Saturation rate": 16.93,
        "Hardening modulus": 0.12924,
    }
    run = solve(
        f"neck {refinements} {layers}",
        Bricks([0, 1], [0, 1], [0, 1]),
        element,
        {
            **{"Bodies/body/Mesh/" + key: value for key, value in source.items()},
            **planes("x = 0 ; y = 0 ; z = 0"),
            "Bodies/body/Mesh/Boundary ids": f"9 : abs(z - {half}) < 1e-6",
            **held("grip", 9, "x, y, z", "0 ; 0 ; t"),
            "Time stepping/End time": 7,
            "Time stepping/Initial step": 0.05,
            "Time stepping/Maximum step": 0.35,
            "Output/Interval": 1,
            **{material + key: value for key, value in law.items()},
        },
        modulus=206.9,
        nu=0.29,
    )
    found = {}
    for way in (4, 5, 6, 7):
        if reached(run, way):
            moved, start, _ = run.pictures[way]
            outside = (abs(start[:, 2]) < 1e-4) & (abs(start[:, 1]) < 1e-4)
            found[way] = moved[outside, 0].max() / radius
    forces = {}
    for way in found:
        last = min(range(len(run.rows)), key=lambda i: abs(run.rows[i]["time"] - way))
        (s, f), (t, g) = (
            ((b["time"] - a["time"]), (b["external_work"] - a["external_work"]) / (b["time"] - a["time"]))
            for a, b in zip(run.rows[last - 2 : last], run.rows[last - 1 : last + 1])
        )
        forces[way] = 4 * (g + (g - f) * t / (s + t))  # at the end of the step
    return run, found, forces


def neck() -> str:
    meshes, finest = ((1, 10), (2, 20)), (2, 20) if options.quick else (3, 24)
    _, radii, forces = neck_run(*finest, AS)
    rows = []
    for mesh_of in meshes:
        for element in ELEMENTS:
            run, found, loads = neck_run(*mesh_of, element)
            if element == AS and mesh_of == (2, 20):
                claim(
                    "Necking, 960 bricks, 6 mm: radius over that of the finest mesh, less one",
                    found.get(6, math.nan) / radii.get(6, math.nan) - 1,
                    0.02,
                )
            rows.append(
                [
                    12 * 4 ** (mesh_of[0] - 1) * mesh_of[1],
                    element,
                    *[
                        f"{found[way]:.3f} / {loads[way]:.1f}" if way in found else "–"
                        for way in (4, 5, 6, 7)
                    ],
                    "yes" if not run.failure else f"to {run.rows[-1]['time']:.2f}",
                ]
            )
    rows.append(
        [
            12 * 4 ** (finest[0] - 1) * finest[1],
            AS,
            *[f"{radii[way]:.3f} / {forces[way]:.1f}" if way in radii else "–" for way in (4, 5, 6, 7)],
            "yes",
        ]
    )
    return (
        "An eighth of Simo's round bar (radius 6.413, length 53.334 mm) is stretched, 1.8 % thinner in the"
        " middle, with its ends held. The material has E = 206.9, ν = 0.29 and σ = 0.45 + 0.265 (1 −"
        " exp(−16.93 ε)) + 0.12924 ε, in kN and mm.\n\n"
        "The table has the radius of the neck over the first one, and the force in kN, from the work of the"
        " last steps. Each end is displaced by 4 to 7 mm. The last row is the finest mesh.\n\n"
        + table(["bricks", "element", "4 mm", "5 mm", "6 mm", "7 mm", "ends"], rows)
    )


# A closed die.


def die(n: int, law: str, element: str) -> tuple[Solution, list[float]]:
    """A unit cube in a box of 1.25 x 1.25: a ram goes down until the box has 1.001 times the volume of the
    cube."""
    last = 1.001 / 1.25**2
    bricks = block(n, 0.1)
    run = solve(
        f"die {n}",
        bricks,
        element,
        {
            **planes("x = 0 ; y = 0 ; z = 0"),
            **tool("ram", TOP, f"0 ; 0 ; {last - 1!r}*t", "2, 4, 6", 0.1),
            **tool("right", plane("1.25, 0, 0", "-1, 0, 0"), "0 ; 0 ; 0", "2, 4, 6", 0.1),
            **tool("back", plane("0, 1.25, 0", "0, -1, 0"), "0 ; 0 ; 0", "2, 4, 6", 0.1),
            "Time stepping/End time": 1,
            "Time stepping/Initial step": 0.01,
            "Time stepping/Maximum step": 0.02,
            "Output/Interval": 0.1,
        },
        law,
    )
    ratios = []
    if not run.failure:
        moved, start, _ = run.pictures[-1]
        _, where = cKDTree(start).query(bricks.points)
        for cell in bricks.cells:
            ratios.append(volume(moved[where][cell]) / volume(bricks.points[cell]))
    return run, ratios


def volume(corners: Array) -> float:
    """Returns the volume of a trilinear brick, by eight points."""
    x, y, z = numpy.array([(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]).T
    total = 0.0
    for a, b, c in numpy.ndindex(2, 2, 2):
        p, q, r = ((2 * numpy.array((a, b, c)) - 1) / math.sqrt(3)).tolist()
        gradient = (
            numpy.array(
                [x * (1 + q * y) * (1 + r * z), y * (1 + p * x) * (1 + r * z), z * (1 + p * x) * (1 + q * y)]
            )
            / 8
        )
        total += numpy.linalg.det(gradient @ corners)
    return total


def closed_die() -> str:
    rows = []
    for law in (HARDENING, PERFECT):
        fine = [] if options.quick else [die(8, law, element) for element in (AS, MD)]
        right = {time: beside([history(run, "ram.force_z", time) for run, _ in fine]) for time in (0.6, 0.9)}
        for n, element, (run, ratios) in [(4, element, die(4, law, element)) for element in ELEMENTS] + [
            (8, e, f) for e, f in zip((AS, MD), fine)
        ]:
            if element == AS:
                claim(
                    "Closed die: largest difference of a brick's volume from the first one",
                    max((abs(r - 1) for r in ratios), default=math.nan),
                    0.02,
                )
                if n == 4:
                    claim(
                        "Closed die, 4³, at 90 %: error of the force",
                        history(run, "ram.force_z", 0.9) / right[0.9][0] - 1,
                        0.03,
                    )
            rows.append(
                [
                    law,
                    f"{n}³",
                    element,
                    "yes" if not run.failure else f"to {100 * run.rows[-1]['time']:.1f} %",
                    *[
                        f"{-history(run, 'ram.force_z', time):.0f}"
                        + (
                            f" ({shown(history(run, 'ram.force_z', time) / right[time][0] - 1)})"
                            if n == 4
                            else ""
                        )
                        for time in (0.6, 0.9)
                    ],
                    number(-history(run, "ram.force_z", 1.0), 3),
                    f"{min(ratios):.3f} to {max(ratios):.3f}" if ratios else "–",
                    ", ".join(run.keys) or "none",
                ]
            )
    return (
        "A unit cube (an eighth; nodes moved by 0.1) lies in a rigid box of 1.25 × 1.25, with a friction"
        " coefficient of 0.1. A ram goes down until the box holds 1.001 times the volume of the cube.\n\n"
        "The table has the force at 60, 90 and 100 % of its way, in brackets the error in %. The reference"
        " is the mean of both elements on 8³ bricks. Volumes of the bricks at the end are divided by those"
        " at the start. The last force depends on the penalty and on the corners.\n\n"
        + table(["law", "bricks", "element", "ends", "60 %", "90 %", "100 %", "volumes", "warnings"], rows)
    )


# Contact at a point, an edge and a corner.

LOCAL = {
    "ball of radius 0.6, at a node": (
        {"Shape": "sphere", "Centre": "0, 0, 1.6", "Radius": 0.6},
        (0, 0, -1),
        0.3,
        "6",
    ),
    "plane on an edge": (plane("1, 0, 1", "-1, 0, -1"), (-1, 0, -1), 0.5, "2, 4, 6"),
    "plane on a corner, tilted twice": (plane("1, 1, 1", "-1, -0.5, -2"), (-1, -0.5, -2), 0.6, "2, 4, 6"),
}


def local(kind: str, n: int, law: str, element: str) -> tuple[Solution, dict[float, float]]:
    shape, direction, way, faces = LOCAL[kind]
    unit = numpy.array(direction) / numpy.linalg.norm(direction)
    motion = " ; ".join(f"{way * c!r}*t" for c in unit.tolist())
    run = solve(
        f"{kind} {n}",
        block(n, 0.1),
        element,
        {
            **planes("x = 0 ; y = 0 ; z = 0"),
            **tool("press", shape, motion, faces, 0.1),
            "Time stepping/End time": 1,
            "Time stepping/Initial step": 0.01,
            "Time stepping/Maximum step": 0.04,
            "Output/Interval": 0.5,
        },
        law,
    )
    return run, {
        time: math.hypot(*(history(run, f"press.force_{c}", time) for c in "xyz")) for time in (0.5, 1.0)
    }


def locally() -> str:
    rows = []
    for kind in LOCAL:
        for law in (HARDENING,):
            fine = [local(kind, 8, law, element)[1] for element in ((AS,) if options.quick else (AS, MD))]
            right = {time: beside([f[time] for f in fine]) for time in (0.5, 1.0)}
            runs = {element: local(kind, 4, law, element) for element in ELEMENTS}
            rows.append(
                [
                    kind,
                    law,
                    *[
                        " / ".join(shown(forces[time] / right[time][0] - 1) for time in (0.5, 1.0))
                        + (f" (to {100 * run.rows[-1]['time']:.0f} %)" if run.failure else "")
                        for run, forces in runs.values()
                    ],
                    " / ".join(right[time][1] for time in (0.5, 1.0)),
                    notes({element: run for element, (run, _) in runs.items()}),
                ]
            )
    return (
        "An eighth of a cube, 4³ bricks moved by 0.1, is pressed. A ball presses it at a node (by 0.3), a"
        " plane at an edge (0.5). At a corner a plane that is tilted twice presses it (0.6).\n\n"
        "The table has the error of the force in % at half and all of the way. The reference is the mean of"
        " both elements on 8³ bricks. A tool that first touches one node meets facets one by one: such"
        " errors are of the mesh.\n\n"
        + table(["tool", "law", *ELEMENTS, "finest differ by", "warnings"], rows)
    )


SECTIONS = (
    ("Between plates, no friction", plates),
    ("The same, disturbed", uneven),
    ("Between walls, one rippled", walls),
    ("Rough plates, plane strain", rough_flat),
    ("Rough plates, a cube", rough_solid),
    ("Rough plates, sides free", rough_free),
    ("Billet", billet),
    ("Taylor's bar", taylor),
    ("Necking", neck),
    ("A closed die", closed_die),
    ("At a node, an edge and a corner", locally),
)

if __name__ == "__main__":
    only = os.environ.get("ONLY")
    parts = [
        f"## {title}\n\n" + build()
        for title, build in SECTIONS
        if not only or build.__name__ in only.split(",")
    ]
    if only:
        print("\n\n".join([what_is_wanted(), *parts]))
    else:
        publish(
            NAME,
            "Crushed bodies",
            options,
            (
                "This page shows whether the elements are stable and accurate where a body is crushed. Each"
                " run is judged by a closed form or by finer meshes of two elements, not by the same"
                " element on the same mesh.\n\n"
                "The modulus is E = 1e5; plastic laws yield at 100 and harden by 200 or not at all. Steps"
                " are automatic unless the section says otherwise. Each run is done once. With"
                " `KEEP=FOLDER` in the environment the scenes of this page stay in that folder.\n\n"
                "Other tests look for negative eigenvalues of single bricks, and of blocks beside the"
                " continuum's first instability. They are `tests/mechanics/element_stability.cc` and"
                " `block_stability.cc`."
            ),
            "## What is wanted\n\n" + what_is_wanted(),
            *parts,
        )
