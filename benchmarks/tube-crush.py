# SPDX-License-Identifier: LGPL-2.1-or-later
"""A square tube crushed along its axis: folds, force, energies, and a geometric check that its wall does not
pass through itself."""

from __future__ import annotations

import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Callable, Iterable, Sequence

import matplotlib
import numpy
from matplotlib.collections import PolyCollection
from scipy.spatial import cKDTree

from billet_runs import ROOT, Changes, arguments, number, percent, publish, table
from explicit_runs import ExplicitRun
from billet_tools.output import Array, Fields

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

options = arguments("tube-crush")
SCENE = ROOT / "prm/tube_crush.prm"
WALL, LENGTH, SPEED, INTERVAL = 2.0, 150.0, 25e3, 0.25e-3
# Corners of a brick's faces, in the order of the vtu file's points, outward normal.
FACES = numpy.array([[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]])


class Tube:
    """Nodes and bricks of a picture, and the boundary's facets."""

    def __init__(self, points: Array, fields: Fields) -> None:
        start = points - fields["displacement"]
        _, first, index = numpy.unique(start.round(4), axis=0, return_index=True, return_inverse=True)
        self.start, self.now = start[first], points[first]
        self.bricks = index.reshape(-1, 8)
        self.strain = fields["equivalent_plastic_strain"].reshape(-1, 8)[:, 0]
        faces = self.bricks[:, FACES].reshape(-1, 4)
        self.brick_of_face = numpy.repeat(numpy.arange(len(self.bricks)), 6)
        _, back, count = numpy.unique(
            numpy.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True
        )
        outer = count[back.reshape(-1)] == 1
        self.all_facets, self.brick_of_facet = faces[outer], self.brick_of_face[outer]
        on_plane = [(abs(self.start[self.all_facets, axis]) < 1e-4).all(axis=1) for axis in (0, 1)]
        self.sections = [self.all_facets[on] for on in on_plane]
        self.section_strains = [self.strain[self.brick_of_facet[on]] for on in on_plane]
        self.facets = self.all_facets[~on_plane[0] & ~on_plane[1]]

    def middle_line(self, axis: int) -> Array:
        """Outward displacement of the middle of the side with this normal, by the length along the wall from
        the foot."""
        across = 1 - axis
        line = numpy.flatnonzero((abs(self.start[:, across]) < 1e-4) & (abs(self.start[:, axis] - 25) < 0.5))
        line = line[numpy.argsort(self.start[line, 2])]
        return self.now[line, axis] - 25


def lobes(line: Array, least: float = 2 * WALL) -> tuple[int, int]:
    """Turning points of a line that stand out by at least `least` on both sides: outward, inward."""
    count, extreme, direction = {1: 0, -1: 0}, line[0], 0
    for value in line[1:]:
        if direction == 0:
            if abs(value - extreme) >= least:
                direction, extreme = (1 if value > extreme else -1), value
        elif (value - extreme) * direction > 0:
            extreme = value
        elif (extreme - value) * direction >= least:
            count[direction] += 1
            direction, extreme = -direction, value
    return count[1], count[-1]


def apart_by(p: Array, q: Array, r: Array, s: Array) -> Array:
    """Distances of the segments pq from the segments rs."""
    u, v, w = q - p, s - r, p - r
    uu, uv, vv, uw, vw = ((a * b).sum(axis=1) for a, b in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    determinant = uu * vv - uv**2
    first = numpy.where(
        determinant > 1e-12 * uu * vv, (uv * vw - vv * uw) / numpy.maximum(determinant, 1e-300), 0
    )
    second = numpy.clip((uv * numpy.clip(first, 0, 1) + vw) / vv, 0, 1)
    first = numpy.clip((uv * second - uw) / uu, 0, 1)
    return numpy.linalg.norm(w + first[:, None] * u - second[:, None] * v, axis=1)


def crossings(tube: Tube, tolerances: Sequence[float] = (0.05 * WALL, 0.5 * WALL)) -> list[float]:
    """Counts the edges of boundary facets that go through other facets: all, those deeper than the
    tolerances, and the maximum depth. The depth is the distance that would separate them: of the nearer end
    of the edge from the facet's plane, or of the edge from one of the facet's edges. Penalty contact allows a
    little."""
    quads = tube.facets
    edges = numpy.unique(
        numpy.sort(numpy.concatenate([quads[:, [i, (i + 1) % 4]] for i in range(4)]), axis=1), axis=0
    )
    triangles = numpy.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    x = tube.now
    reach = max(
        numpy.linalg.norm(x[edges[:, 0]] - x[edges[:, 1]], axis=1).max() / 2,
        max(
            numpy.linalg.norm(x[triangles[:, i]] - x[triangles].mean(axis=1), axis=1).max() for i in range(3)
        ),
    )
    near = cKDTree(x[edges].mean(axis=1)).query_ball_tree(cKDTree(x[triangles].mean(axis=1)), 2 * reach)
    e = numpy.repeat(numpy.arange(len(edges)), [len(row) for row in near])
    t = numpy.concatenate([numpy.array(row, dtype=int) for row in near])
    apart = ~(edges[e][:, :, None] == triangles[t][:, None, :]).any(axis=(1, 2))
    e, t = e[apart], t[apart]
    p, q = x[edges[e, 0]], x[edges[e, 1]]
    a, b, c = (x[triangles[t, i]] for i in range(3))
    normal = numpy.cross(b - a, c - a)
    normal /= numpy.linalg.norm(normal, axis=1)[:, None]
    before, behind = ((p - a) * normal).sum(axis=1), ((q - a) * normal).sum(axis=1)
    through = before * behind < 0
    e, t, p, q, a, b, c, normal, before, behind = (
        v[through] for v in (e, t, p, q, a, b, c, normal, before, behind)
    )
    hit = p + (before / (before - behind))[:, None] * (q - p)
    inside = numpy.ones(len(hit), dtype=bool)
    for u, v in ((a, b), (b, c), (c, a)):
        inside &= (numpy.cross(v - u, hit - u) * normal).sum(axis=1) > 0
    depth = numpy.minimum(abs(before), abs(behind))[inside]
    quad = quads[t[inside] % len(quads)]
    for i in range(4):
        depth = numpy.minimum(depth, apart_by(p[inside], q[inside], x[quad[:, i]], x[quad[:, (i + 1) % 4]]))
    return [len(depth)] + [int((depth > t).sum()) for t in tolerances] + [float(depth.max(initial=0))]


def deepest_inside(tube: Tube) -> tuple[int, float]:
    """Boundary nodes that lie inside a brick of another place, one that has no node in common with the bricks
    around them, and the largest distance of one from the nearest facet that does not have it."""
    x = tube.now
    nodes = numpy.unique(tube.facets)
    facet_bricks = numpy.unique(tube.brick_of_facet)
    corners = x[tube.bricks]
    tree = cKDTree(x[nodes])
    radius = numpy.linalg.norm(corners - corners.mean(axis=1)[:, None], axis=2).max(axis=1)
    around: list[set[int]] = [set() for _ in x]  # nodes of the bricks around each node
    for brick in tube.bricks:
        for node in brick:
            around[node].update(brick)
    count, deepest = 0, 0.0
    for brick in facet_bricks:
        own = set(tube.bricks[brick])
        near = [nodes[i] for i in tree.query_ball_point(corners[brick].mean(axis=0), radius[brick])]
        for node in near:
            if not own.isdisjoint(around[node]):
                continue
            depth = inside_brick(corners[brick], x[node])
            if depth is None:
                continue
            others = tube.facets[~(tube.facets == node).any(axis=1)]
            count += 1
            deepest = max(
                deepest,
                min(
                    distance_from_triangle(x[node], x[others[:, corners]]).min()
                    for corners in ([0, 1, 2], [0, 2, 3])
                ),
            )
    return count, deepest


def distance_from_triangle(point: Array, triangles: Array) -> Array:
    """Distances of a point from triangles [n, 3, 3]."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = numpy.cross(b - a, c - a)
    normal /= numpy.maximum(numpy.linalg.norm(normal, axis=1), 1e-300)[:, None]
    height = ((point - a) * normal).sum(axis=1)
    distance = numpy.full(len(a), numpy.inf)
    above = numpy.ones(len(a), dtype=bool)
    for u, v in ((a, b), (b, c), (c, a)):
        above &= (numpy.cross(v - u, point - u) * normal).sum(axis=1) >= 0
        along = numpy.clip(((point - u) * (v - u)).sum(axis=1) / ((v - u) ** 2).sum(axis=1), 0, 1)
        distance = numpy.minimum(distance, numpy.linalg.norm(point - u - along[:, None] * (v - u), axis=1))
    return numpy.where(above, abs(height), distance)


def inside_brick(corners: Array, x: Array) -> Array | None:
    """Returns the parameters of x in the trilinear map of the brick, by Newton's method; None if x is
    outside."""
    xi = numpy.full(3, 0.5)
    signs = numpy.array([[a & 1, (a >> 1) & 1, (a >> 2) & 1] for a in range(8)])
    for _ in range(12):
        factors = numpy.where(signs == 1, xi, 1 - xi)
        shape = factors.prod(axis=1)
        residual = x - shape @ corners
        if numpy.abs(residual).max() < 1e-9:
            break
        slope = numpy.array(
            [(2 * signs[:, i] - 1) * numpy.delete(factors, i, axis=1).prod(axis=1) for i in range(3)]
        )
        try:
            xi = xi + numpy.linalg.solve((slope @ corners).T, residual)
        except numpy.linalg.LinAlgError:
            return None
        if numpy.abs(xi).max() > 3:
            return None
    return xi if (xi > 0).all() and (xi < 1).all() else None


def draw(tubes: Sequence[tuple[float, Tube]], path: Path) -> None:
    """Sections through the middles of the sides, the inward folding one on the right."""
    figure, axes = pyplot.subplots(1, len(tubes), figsize=(3.1 * len(tubes), 6.2), sharey=True)
    for axis, (time, tube) in zip(axes, tubes):
        for plane, side in ((0, -1), (1, 1)):
            other = 1 - plane
            shape = tube.now[tube.sections[plane]][:, :, [other, 2]] * [side, 1]
            patches = PolyCollection(
                shape, array=tube.section_strains[plane], cmap="viridis", edgecolors="black", linewidths=0.2
            )
            patches.set_clim(0, 0.6)
            axis.add_collection(patches)
        axis.axvline(0, color="grey", linewidth=0.5, linestyle="--")
        axis.set_xlim(-50, 50)
        axis.set_ylim(-2, LENGTH + 2)
        axis.set_aspect("equal")
        axis.set_title(f"{1e3 * time:.3g} ms")
        axis.set_xlabel("mm")
    figure.colorbar(patches, ax=axes, label="equivalent plastic strain", shrink=0.6)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110, bbox_inches="tight")


def run(
    changes: Changes, pictures: Callable[[ExplicitRun], Iterable[int]]
) -> tuple[ExplicitRun, list[tuple[float, Tube]]]:
    with tempfile.TemporaryDirectory() as folder:
        r = ExplicitRun(SCENE, changes, folder, options.ranks)
        return r, [(i * INTERVAL, Tube(*r.picture(i))) for i in pictures(r)]


def geometry_rows(name: str, tubes: Sequence[tuple[float, Tube]]) -> list[list[Any]]:
    rows = []
    for time, tube in tubes:
        *counts, depth = crossings(tube)
        inside, deepest = deepest_inside(tube)
        rows.append(
            [
                name,
                f"{1e3 * time:.3g}",
                *counts,
                number(depth),
                inside,
                number(deepest),
                number(float(tube.now[:, :2].min())),
            ]
        )
    return rows


def every_picture(r: ExplicitRun) -> Iterable[int]:
    return range(1, len(list((r.folder / "results").glob("fields_*.vtm"))))


control: Changes = {"Contact pairs/folds/Boundary ids": "5", "Explicit dynamics/Maximum energy drift": 1}
nodes: Changes = {"Contact pairs/folds/Edge contact": "false"}
with ThreadPoolExecutor() as pool:
    variants: list[Changes] = [{}] if options.quick else [{}, nodes, control]
    runs = [pool.submit(run, changes, every_picture) for changes in variants]
r, tubes = runs[0].result()
last = tubes[-1][1]
drawn = [tubes[i] for i in numpy.linspace(0, len(tubes) - 1, 4).round().astype(int)]
draw(drawn, ROOT / "doc/images/tube_crush.png")

fold_rows = []
for time, tube in tubes:
    out_y, in_y = lobes(tube.middle_line(1))
    out_x, in_x = lobes(tube.middle_line(0))
    row = min(r.rows, key=lambda row: abs(row["time"] - time))
    window = [q for q in r.rows if 0 < q["time"] <= time]
    mean = -4 * sum(q["plane.force_z"] for q in window) / len(window) / 1e3
    fold_rows.append(
        [
            f"{1e3 * time:.3g}",
            number(SPEED * time),
            f"{out_y} + {in_y}",
            f"{out_x} + {in_x}",
            number(mean),
            number(1e2 * row["folds.deepest_penetration"] / WALL) + " %",
            percent(
                abs(row["energy_drift"])
                / sum(
                    row[k]
                    for k in row
                    if k.endswith(("_energy", "_work", "_dissipation")) and k != "external_work"
                )
            ),
        ]
    )
geometry = geometry_rows("with", tubes[2::2])
if not options.quick:
    geometry += geometry_rows("nodes only", runs[1].result()[1][8::4])
    geometry += geometry_rows("without", runs[2].result()[1][8::4])

worst_edge, worst_node = (
    max((row for row in geometry if row[0] == "with"), key=lambda row: float(row[column]))
    for column in (5, 7)
)

publish(
    "tube-crush",
    "A square tube crushed along its axis",
    options,
    (
        "This page shows how a square tube folds, and whether its wall passes through itself. The scene is"
        " [`prm/tube_crush.prm`](../../prm/tube_crush.prm). A quarter of a tube of 50 x 50 x 150 mm with 2"
        f" mm wall has {len(last.bricks)} bricks. A plane comes down on it at 25 m/s. The run takes"
        f" {r.steps} steps; the largest drift of energy is {percent(r.max_drift())} of the largest sum of"
        " energies."
    ),
    "![Sections through the middles of the sides](../images/tube_crush.png)",
    (
        "## Folds\n\n"
        "The table has the lobes, outward + inward, of the middle of a side. They are turning points of its"
        " line that stand out by two wall thicknesses on both sides. The mean force is that of the whole"
        " tube so far. The penetration of self-contact is relative to the wall."
    ),
    table(
        [
            "time [ms]",
            "way [mm]",
            "lobes of the side y",
            "lobes of the side x",
            "mean force [kN]",
            "penetration",
            "drift of energy",
        ],
        fold_rows,
    ),
    (
        "## Does the wall pass through itself?\n\n"
        "The check looks for edges of boundary facets that go through another facet, which penalty contact"
        " lets them by a little. Without self-contact it finds a wall that passes through itself. With"
        " nodes against facets alone (`Edge contact = false`), ridges of folds cross each other.\n\n"
        "The table has the number of such edges, of those deeper than 5 and 50 % of the wall, and the"
        " deepest. Depth is what would part edge and facet. It is the distance of the nearer end from the"
        " facet's plane or of the edge from one of the facet's.\n\n"
        "Nodes inside lie inside a brick of another place of the wall; their depth is the distance from the"
        " nearest facet. The last column is the least coordinate across: symmetry planes are at 0."
    ),
    (
        f"With self-contact the deepest edge is {worst_edge[5]} mm,"
        f" {number(100 * float(worst_edge[5]) / WALL, 2)} % of the wall, in, at {worst_edge[1]} ms. The"
        f" deepest node is {worst_node[7]} mm, {number(100 * float(worst_node[7]) / WALL, 2)} %, in, at"
        f" {worst_node[1]} ms."
    ),
    table(
        [
            "self-contact",
            "time [ms]",
            "edges in facets",
            "by more than 5 %",
            "by more than 50 %",
            "deepest [mm]",
            "nodes inside",
            "deepest [mm]",
            "least x, y [mm]",
        ],
        geometry,
    ),
)
