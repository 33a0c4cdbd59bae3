# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deformable bodies in contact in billet and in CalculiX: the shipped scenes on the same meshes, with the
same penalties."""

from __future__ import annotations

import argparse
import json
import math
import re
import subprocess
import tempfile
from pathlib import Path
from typing import Any, Callable, Sequence

import numpy

from billet_runs import ROOT, Changes, number, percent, publish, table
from billet_tools.output import Array
from ccx_decks import FACES_CONTACT, NODAL, NODES, TOTALS, CcxJob, Deck, Motion, blocks, totals
from explicit_runs import ExplicitRun

parser = argparse.ArgumentParser(prog="scripts/benchmarks implicit-ccx")
parser.add_argument("--quick", action="store_true", help="ironing, press fit, Hertz and the dies only")
parser.add_argument("--large", action="store_true", help="nothing more")
parser.add_argument("--ranks", type=int, default=1, help="of no use: CalculiX has one")
parser.add_argument("--scene", action="append", help="only these; the page stays as it is")
parser.add_argument(
    "--keep", type=Path, help="folder for the rows of each scene; what is there already does not run again"
)
options = parser.parse_args()
options.large, options.ranks = False, 1
PRM = ROOT / "prm"
LIMIT = 120  # seconds of a processor for each run of CalculiX
NEAR = 1e-4
SHORTER = ("ironing", "billet_deformable_dies", "passing_spheres")  # also in increments of a tenth


def at(rows: Any, time: float, column: int = 0) -> Any:
    """The row at this time; None where the run has not come so far."""
    row = min(rows, key=lambda r: abs(r[column] - time), default=None)
    return row if row is not None and abs(row[column] - time) < 1e-6 * max(1.0, time) else None


# --- the scenes: a deck, what friction, what it prints, and a result of both programs -------------


class Ironing:
    name, friction, prints = "ironing", 0.3, TOTALS
    result = "vertical force [N], horizontal / vertical, means from 1 to 9 mm"

    def deck(self) -> Deck:
        deck = Deck(PRM / "ironing.prm", [("C3D8", 100, 0.3), ("C3D8", 1000, 0.3)])
        deck.surface("SLAVE", 1, lambda x, y, z: abs(z - 7 + math.sqrt(16 - (x - 4) ** 2)) < NEAR)
        deck.surface("MASTER", 0, lambda x, y, z: abs(z - 3) < NEAR)
        deck.hold("BASE", deck.members(0, lambda x, y, z: z < NEAR), 1, 2, 3)
        deck.hold(
            "SIDES",
            [i for body in (0, 1) for i in deck.members(body, lambda x, y, z: y < NEAR or y > 0.5 - NEAR)],
            2,
        )
        deck.node_set("HELD", deck.members(1, lambda x, y, z: abs(z - 4.5) < NEAR))
        deck.step(1, 0.05, 0.1, {("HELD", 1): 0, ("HELD", 2): 0, ("HELD", 3): -0.6})
        deck.step(2, 0.05, 0.1, {("HELD", 1): 10})
        deck.step(0.5, 0.05, 0.1, {("HELD", 3): 0.4})
        return deck

    def mean(self, rows: list[tuple[float, float, float]]) -> str:  # time, horizontal, vertical
        rows = [row for row in rows if 1.2 - 1e-6 < row[0] < 2.8 + 1e-6]
        if not rows or rows[-1][0] < 2.7:
            return "–"
        return f"{sum(r[2] for r in rows) / len(rows):.2f}, {sum(r[1] / r[2] for r in rows) / len(rows):.3f}"

    def billet(self, run: ExplicitRun) -> str:
        return self.mean([(r["time"], -r["face.force_x"], r["face.force_z"]) for r in run.rows])

    def ccx(self, folder: str | Path, deck: Deck) -> str:
        return self.mean([(t, x, -z) for t, x, _, z in totals(folder)])


class PressFit:
    name, friction, prints = "press_fit", 0.0, TOTALS
    augmented = "Contact pairs/fit/Penetration tolerance"
    result = "pressure [MPa] (Lamé: 25.76)"

    def deck(self) -> Deck:
        deck = Deck(PRM / "press_fit.prm", [("C3D8", 2e5, 0.3), ("C3D8", 2e5, 0.3)])
        deck.surface("SLAVE", 0, lambda x, y, z: abs(math.hypot(x, y) - 20.01) < NEAR)
        deck.surface("MASTER", 1, lambda x, y, z: abs(math.hypot(x, y) - 20) < NEAR)
        for axis, name in enumerate("XY"):
            deck.hold(
                name, [i for body in (0, 1) for i in deck.members(body, lambda *x: x[axis] < NEAR)], axis + 1
            )
        deck.hold("Z", [i for body in (0, 1) for i in deck.members(body, lambda x, y, z: True)], 3)
        deck.node_set("HELD", deck.members(1, lambda x, y, z: x < NEAR))
        deck.step(1, 0.5, 0.5, {})
        return deck

    def billet(self, run: ExplicitRun) -> str:
        return number(abs(run.rows[-1]["fit.force_x"]) / 20, 4)

    def ccx(self, folder: str | Path, deck: Deck) -> str:
        row = at(totals(folder), 1)
        return number(abs(row[1]) / 20, 4) if row else "–"


class Hertz:
    name, friction, prints = "hertz_cylinders", 0.0, TOTALS
    augmented = "Contact pairs/faces/Penetration tolerance"
    result = "force [N]"

    def deck(self) -> Deck:
        deck = Deck(PRM / "hertz_cylinders.prm", [("C3D8", 1e5, 0.3), ("C3D8", 2e5, 0.3)], 6)
        deck.surface("SLAVE", 1, lambda x, y, z: abs(z - 10 + math.sqrt(100 - x * x)) < 1e-5)
        deck.surface("MASTER", 0, lambda x, y, z: abs(z + 20 - math.sqrt(400 - x * x)) < 1e-5)
        deck.hold("BASE", deck.members(0, lambda x, y, z: z < -8 + NEAR), 1, 2, 3)
        both = (0, 1)
        deck.hold(
            "MIDDLE",
            [i for body in both for i in deck.members(body, lambda x, y, z: x < NEAR and -7.9 < z < 7.9)],
            1,
        )
        deck.hold(
            "SIDES", [i for body in both for i in deck.members(body, lambda x, y, z: -7.9 < z < 7.9)], 2
        )
        deck.node_set("HELD", deck.members(1, lambda x, y, z: z > 8 - NEAR))
        deck.step(1, 0.1, 0.1, {("HELD", 1): 0, ("HELD", 2): 0, ("HELD", 3): -0.04})
        return deck

    def billet(self, run: ExplicitRun) -> str:
        return number(abs(run.rows[-1]["faces.force_z"]), 4)

    def ccx(self, folder: str | Path, deck: Deck) -> str:
        row = at(totals(folder), 1)
        return number(abs(row[3]), 4) if row else "–"


class Dies:
    name, friction, prints = "billet_deformable_dies", 0.1, TOTALS
    result = "force on the whole billet at the end of the upsetting [kN]"

    def deck(self) -> Deck:
        deck = Deck(
            PRM / "billet_deformable_dies.prm",
            [("C3D8R", 200e3, 0.3, (700, 0), (2200, 5)), ("C3D8", 20e6, 0.3)],
        )
        deck.surface("SLAVE", 0, lambda x, y, z: z > 15 - NEAR or math.hypot(x, y) > 9.9)
        deck.surface("MASTER", 1, lambda x, y, z: z < 15 + NEAR)
        for axis, name in enumerate("XYZ"):
            bodies = (0, 1) if axis < 2 else (0,)
            deck.hold(
                name,
                [
                    i
                    for body in bodies
                    for i in deck.members(body, lambda *x: x[axis] < NEAR and x[2] < 25 - NEAR)
                ],
                axis + 1,
            )
        deck.node_set("HELD", deck.members(1, lambda x, y, z: z > 25 - NEAR))
        deck.step(1, 0.02, 0.1, {("HELD", 1): 0, ("HELD", 2): 0, ("HELD", 3): -9.6})
        deck.step(0.1, 0.02, 0.1, {("HELD", 3): -8.6})
        return deck

    penalty = 3.5e5

    def billet(self, run: ExplicitRun) -> str:
        row = at([(r["time"], r) for r in run.rows], 1)
        return number(4e-3 * abs(row[1]["billet on die.force_z"]), 4)

    def ccx(self, folder: str | Path, deck: Deck) -> str:
        row = at(totals(folder), 1)
        return number(4e-3 * abs(row[3]), 4) if row else "–"


class Spheres:
    name, friction, prints = "passing_spheres", 0.3, TOTALS
    result = "largest force [N]"

    def deck(self) -> Deck:
        deck = Deck(PRM / "passing_spheres.prm", [("C3D8", 100, 0.3), ("C3D8", 100, 0.3)])

        def sphere(*centre: float) -> Callable[..., bool]:
            return lambda *x: abs(math.dist(x, centre) - 10) < 1e-3

        deck.surface("SLAVE", 1, sphere(-12, 0, 18.5))
        deck.surface("MASTER", 0, sphere(0, 0, 0))
        deck.hold("BASE", deck.members(0, lambda x, y, z: z < NEAR), 1, 2, 3)
        deck.node_set("HELD", deck.members(1, lambda x, y, z: z > 18.5 - NEAR))
        deck.step(1, 0.04, 0.04, {("HELD", 1): 24, ("HELD", 2): 0, ("HELD", 3): 0})
        return deck

    def billet(self, run: ExplicitRun) -> str:
        return number(max(math.hypot(*(r["faces.force_" + i] for i in "xyz")) for r in run.rows), 4)

    def ccx(self, folder: str | Path, deck: Deck) -> str:
        rows = totals(folder)
        return number(max(math.hypot(*row[1:]) for row in rows), 4) if at(rows, 1) else "–"


class Twist:
    name, friction, prints = "twisted_hemisphere", 0.3, NODAL
    result = "force after pressing [N], torque after twisting [N mm]"
    N = 10  # straight parts of the turn

    def deck(self) -> Deck:
        deck = Deck(PRM / "twisted_hemisphere.prm", [("C3D8", 1000, 0.3), ("C3D8", 1000, 0.3)])
        deck.surface("SLAVE", 1, lambda x, y, z: abs(z - 10 + math.sqrt(100 - x * x - y * y)) < NEAR)
        deck.surface("MASTER", 0, lambda x, y, z: z > -NEAR)
        deck.hold("BASE", deck.members(0, lambda x, y, z: z < -6 + NEAR), 1, 2, 3)
        self.held = deck.node_set("HELD", deck.members(1, lambda x, y, z: z > 6 - NEAR))

        def turned(angle: float, down: float) -> Motion:
            motion: Motion = {("HELD", 3): down}
            for i in self.held:
                x, y, _ = deck.nodes[i]
                motion[(i + 1, 1)] = x * (math.cos(angle) - 1) - y * math.sin(angle)
                motion[(i + 1, 2)] = x * math.sin(angle) + y * (math.cos(angle) - 1)
            return motion

        deck.step(1, 0.1, 0.1, turned(0, -0.3))
        for n in range(self.N):
            deck.step(1 / self.N, 1 / self.N, 1 / self.N, turned(0.16 * (n + 1) / self.N, -0.3))
        deck.step(0.5, 0.1, 0.1, turned(0.152, -0.3))
        deck.step(1, 0.1, 0.1, turned(0.152, 0.1))
        return deck

    def billet(self, run: ExplicitRun) -> str:
        rows = {round(r["time"], 6): r for r in run.rows}
        times = sorted(rows)
        before = max(t for t in times if t < 2 - 1e-6)
        torque = (rows[2.0]["external_work"] - rows[before]["external_work"]) / (0.16 * (2 - before))
        return f"{number(abs(rows[1.0]['face.force_z']), 4)}, {number(torque, 4)}"

    def ccx(self, folder: str | Path, deck: Deck) -> str:
        found = blocks(folder, "forces", 1)
        pressed, twisted = at(found, 1), at(found, 2)
        force = number(abs(sum(row[3] for row in pressed[1])), 4) if pressed else "–"
        if not twisted:
            return f"{force}, –"
        c, s, torque = math.cos(0.16), math.sin(0.16), 0.0
        for node, fx, fy, _ in twisted[1]:
            x, y, _ = deck.nodes[node - 1]
            torque += (c * x - s * y) * fy - (s * x + c * y) * fx
        return f"{force}, {number(torque, 4)}"


def deviation(stresses: Sequence[Sequence[float]] | Sequence[Array]) -> str:
    """Largest difference of an element's stress from the mean of all, relative to that."""
    s = numpy.array(stresses)  # xx, yy, zz, xy, xz, yz
    weight = numpy.array([1, 1, 1, 2, 2, 2])
    mean = s.mean(axis=0)
    return percent(math.sqrt(((s - mean) ** 2 @ weight).max() / (mean**2 @ weight)))


class Patch:
    friction, prints = 0.0, ["*EL PRINT, ELSET=BODY0", "S", "*EL PRINT, ELSET=BODY1", "S"]
    result = "largest deviation of an element's stress from the mean"
    name, poisson, travel, cut, penalty = "patch_test", 0.3, -0.2, 0.0, 4e6
    turn: Array | None = numpy.array([[2, 2, -1], [-1, 2, 2], [2, -1, 2]]) / 3  # into the block's own axes

    def deck(self) -> Deck:
        deck = Deck(
            PRM / f"{self.name}.prm", [("C3D8", 2e5, self.poisson), ("C3D8", 2e5, self.poisson)], 6, self.turn
        )

        def in_cut(x: float, y: float, z: float) -> bool:
            return abs(z - self.cut * (x - 1)) < NEAR

        deck.surface("SLAVE", 1, in_cut)
        deck.surface("MASTER", 0, in_cut)
        for axis, name in enumerate("XY"):
            deck.hold(
                name,
                [i for body in (0, 1) for i in deck.members(body, lambda *x: not NEAR < x[axis] < 2 - NEAR)],
                axis + 1,
            )
        deck.hold("BASE", deck.members(0, lambda x, y, z: z < -2 + NEAR), 3)
        deck.node_set("HELD", deck.members(1, lambda x, y, z: z > 2 - NEAR))
        deck.step(1, 0.5, 0.5, {("HELD", 1): 0, ("HELD", 2): 0, ("HELD", 3): self.travel})
        return deck

    def billet(self, run: ExplicitRun) -> str:
        _, fields = run.picture()
        found = deviation(
            numpy.stack(
                [
                    fields["stress_" + i].reshape(-1, 8).mean(axis=1)
                    for i in ("xx", "yy", "zz", "xy", "xz", "yz")
                ],
                axis=1,
            )
        )
        return "< 1e-5 %" if float(found.split()[0]) < 1e-4 and self.friction == 0 else found

    def ccx(self, folder: str | Path, deck: Deck) -> str:
        last = [rows for time, rows in blocks(folder, "stresses", 2) if abs(time - 1) < 1e-6]
        if not last:
            return "–"
        elements: dict[float, list[list[float]]] = {}
        for element, _, *stress in sum(last, []):
            elements.setdefault(element, []).append(stress)
        return deviation([numpy.mean(points, axis=0) for points in elements.values()])


class CutPatch(Patch):
    name, friction, poisson, travel, cut, turn = "patch_test_cut", 0.5, 0.0, -0.004, 0.3, None


class TurnedBlocks:
    name, friction, prints = "turned_blocks", 0.2, TOTALS
    result = "force after pressing [N], its relative change after 360°"

    def deck(self) -> Deck:
        deck = Deck(PRM / "turned_blocks.prm", [("C3D8", 1000, 0.3), ("C3D8", 2000, 0.2)])
        deck.surface("SLAVE", 1, lambda x, y, z: z < NEAR)
        deck.surface("MASTER", 0, lambda x, y, z: z > -NEAR)
        foot = deck.members(0, lambda x, y, z: z < -2 + NEAR)
        head = deck.node_set("HELD", deck.members(1, lambda x, y, z: z > 1.6 - NEAR))

        def motion(press: float, angle: float) -> Motion:
            c, s, result = math.cos(angle), math.sin(angle), {}
            for members, moved in ((foot, 0), (head, press)):
                for i in members:
                    x, y, z = deck.nodes[i]
                    a, b = x + 0.06 * moved, z - 0.1 * moved
                    for k, value in enumerate((a * c + b * s - x, 0.03 * moved, -a * s + b * c - z)):
                        result[(i + 1, k + 1)] = value
            return result

        deck.step(1, 1, 1, motion(1, 0))
        for n in range(36):
            deck.step(1, 1, 1, motion(1, math.pi / 18 * (n + 1)))
        for n in range(10):
            deck.step(1, 1, 1, motion(1 - 0.13 * (n + 1), 0))
        return deck

    def text(self, pressed: tuple[float, ...] | None, turned: tuple[float, ...] | None) -> str:
        if not pressed:
            return "–"
        force = math.hypot(*pressed[1:])
        change = math.hypot(*(a - b for a, b in zip(pressed[1:], turned[1:]))) / force if turned else math.nan
        return f"{number(force, 4)}, {number(change, 2)}"

    def billet(self, run: ExplicitRun) -> str:
        rows = [(r["time"],) + tuple(r["blocks.force_" + i] for i in "xyz") for r in run.rows]
        return self.text(at(rows, 1), at(rows, 37))

    def ccx(self, folder: str | Path, deck: Deck) -> str:
        rows = totals(folder)
        return self.text(at(rows, 1), at(rows, 37))


class HollowBlock:
    name, friction, prints = "hollow_block", 0.0, TOTALS
    result = "work of squeezing [N mm], part of it left after release"

    def deck(self) -> Deck:
        plates = (((-1, -1, 5), (20, 2, 9)), ((-1, -1, -9), (20, 2, -5)))
        deck = Deck(
            PRM / "hollow_block.prm", [("C3D8", 1, 0.4), ("C3D8", 1, 0.4), ("C3D8", 1, 0.4)], plates=plates
        )
        deck.surface("SLAVE", 0, lambda x, y, z: abs(math.hypot(x, z) - 3) < NEAR)
        deck.sizes["MASTER"] = deck.sizes["SLAVE"]
        inside = dict(deck.sizes)
        deck.surface("SIDE", 0, lambda x, y, z: x > 5 - NEAR)
        side = 1 / deck.sizes["SIDE"][1]  # E/h, the scene's
        deck.surface("UPPER", 1, lambda x, y, z: z < 5 + NEAR)
        deck.surface("LOWER", 2, lambda x, y, z: z > -5 - NEAR)
        deck.sizes, deck.pairs = inside, [
            ("SLAVE", "SLAVE", None),
            ("SIDE", "UPPER", side),
            ("SIDE", "LOWER", side),
        ]
        deck.hold("X", deck.members(0, lambda x, y, z: x < NEAR), 1)
        deck.hold("Y", deck.members(0, lambda x, y, z: True), 2)
        deck.hold("Z", deck.members(0, lambda x, y, z: z < -5 + NEAR), 3)
        deck.hold("LOWERPLATE", deck.members(2, lambda x, y, z: True), 1, 2, 3)
        upper = deck.members(1, lambda x, y, z: True)
        deck.hold("UPPERPLATE", upper, 1, 2)
        deck.node_set("HELD", deck.members(0, lambda x, y, z: z > 5 - NEAR) + upper)
        deck.step(1, 0.05, 0.05, {("HELD", 3): -5})
        deck.step(1, 0.05, 0.05, {("HELD", 3): 0})
        return deck

    def text(self, squeezing: float, left: float) -> str:
        return f"{number(squeezing, 4)}, {number(abs(left / squeezing), 2)}"

    def billet(self, run: ExplicitRun) -> str:
        rows = [(r["time"], r["external_work"]) for r in run.rows]
        return self.text(at(rows, 1)[1], at(rows, 2)[1])

    def ccx(self, folder: str | Path, deck: Deck) -> str:
        rows = [(0.0, 0.0, 0.0, 0.0)] + totals(folder)
        if not at(rows, 2):
            return "–"
        work, squeezing = 0.0, None  # trapezoidal, as billet's
        for before, after in zip(rows, rows[1:]):
            work += (
                0.5 * (before[3] + after[3]) * 5 * (after[0] - before[0]) * (-1 if after[0] < 1 + 1e-6 else 1)
            )
            squeezing = work if abs(after[0] - 1) < 1e-6 else squeezing
        assert squeezing is not None
        return self.text(squeezing, work)


SCENES: list[Any] = [
    Ironing(),
    PressFit(),
    Hertz(),
    Dies(),
    Spheres(),
    Twist(),
    Patch(),
    CutPatch(),
    TurnedBlocks(),
    HollowBlock(),
]
if options.quick:
    SCENES = SCENES[:4]
if options.scene:
    SCENES = [scene for scene in SCENES if scene.name in options.scene]


def compare(scene: Any) -> Any:
    """Rows of both tables."""
    kept = options.keep / f"{scene.name}.json" if options.keep else None
    if kept and kept.exists():
        return json.loads(kept.read_text())
    rows: list[list[object]] = []
    augmented = getattr(scene, "augmented", None)
    variants: dict[str, Changes] = (
        {"billet, augmented": {}, "billet, penalty alone": {augmented: 0}} if augmented else {"billet": {}}
    )
    for name, changes in variants.items():
        with tempfile.TemporaryDirectory() as folder:
            run = ExplicitRun(ROOT / f"prm/{scene.name}.prm", changes, folder)
            rows.append(
                [
                    "" if rows else f"`{scene.name}`",
                    name,
                    run.steps,
                    int(run.rows[-1]["total_cuts"]),
                    int(run.rows[-1]["total_iterations"]),
                    number(run.seconds),
                    scene.billet(run),
                    "" if run.finished else run.failure,
                ]
            )
    deck = scene.deck()
    penalty = getattr(scene, "penalty", None) or deck.penalty()
    for contact, shorter in [(NODES, 1), (FACES_CONTACT, 1)] + (
        [(NODES, 10), (FACES_CONTACT, 10)] if scene.name in SHORTER else []
    ):
        with tempfile.TemporaryDirectory() as folder:
            end = deck.write(
                Path(folder, "deck.inp"), contact, scene.friction, penalty, scene.prints, shorter
            )
            job = CcxJob(folder, end, LIMIT)
            rows.append(
                [
                    "",
                    "ccx, " + contact.lower() + (f", steps of a {shorter}th" if shorter > 1 else ""),
                    job.steps,
                    job.cuts,
                    job.iterations,
                    number(job.seconds),
                    scene.ccx(folder, deck),
                    f"stops at {job.time:.3g} of {end:.3g}: {job.failure}" if job.failure else "",
                ]
            )
            print(rows[-1], flush=True)
    found = rows, [f"`{scene.name}`", f"{penalty:.3g}", scene.friction or "none", scene.result]
    if kept:
        options.keep.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(found))
    return found


if __name__ == "__main__":
    compared = [compare(scene) for scene in SCENES]
    said = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
    version = re.findall(r"Version (\S+)", said)[0]
    options.quick = options.quick or bool(options.scene)
    publish(
        "implicit-ccx",
        "Deformable bodies in billet and in CalculiX",
        options,
        (
            f"This page compares billet with CalculiX {version} where deformable bodies touch each other:"
            " results, iterations and CPU seconds. The scenes are those of `prm/`, as they are.\n\n"
            "CalculiX gets the mesh that billet has written. It also gets the same penalty, friction,"
            " motion, and first, smallest and largest steps. Its elements are C3D8 (for the billet C3D8R,"
            " see [billet-ccx](billet-ccx.md)). Its contact is a node-to-surface or surface-to-surface"
            " penalty. All else is as by default: it stops at 0.5 % of the force, as billet does where the"
            " scene sets no tolerance.\n\n"
            "Elastic bodies get a yield stress beyond reach in CalculiX. Its elasticity is one of large"
            " strain with plasticity only. With `*ELASTIC` alone it grows soft in compression: the ironed"
            " slab resists with 28 N instead of 42 N. The logarithmic laws of billet and CalculiX differ at"
            " large strain all the same. The turn of the twisted hemisphere is one of ten straight parts in"
            " CalculiX."
        ),
        (
            f"Each run is done once, on one core of a busy machine; CalculiX gets at most {LIMIT} CPU"
            " seconds. Read CPU seconds (user and system) as ratios; 0.3 to 0.6 of billet's are its start."
            " Iterations count those of failed steps. The table quotes what CalculiX says when it stops."
        ),
        table(
            ["scene", "program", "steps", "cuts", "iterations", "CPU s", "result", "fails"],
            [row for rows, _ in compared for row in rows],
        ),
        "## What is compared",
        table(["scene", "penalty [N/mm³]", "friction", "result"], [row for _, row in compared]),
        (
            "Penalties are billet's own: ten times E/h of both sides in series, unless the scene has a"
            " number. Here h is the root of the faces' mean area. billet augments two scenes, and is shown"
            " with the penalty alone, too."
        ),
        (
            "## Self-contact\n\n"
            "CalculiX knows pairs of a slave and a master surface. It takes one surface as both, as here"
            " the inside of `hollow_block`, whose plates are bricks. With nodes against faces it stops;"
            " with faces against faces it comes through.\n\n"
            "`ring_crush` has a tool with fillets, which CalculiX, without analytical surfaces, would need"
            " as a mesh. It has not been tried (billet: 60 steps, 316 iterations)."
        ),
    )
