# SPDX-License-Identifier: LGPL-2.1-or-later
"""The six scenes of the work-precision page: meshes, settings, decks for CalculiX, what is compared, and with
what."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import NamedTuple, Sequence

from billet_runs import ROOT, Changes, fixed_steps
from ccx_decks import FACES_CONTACT, NODES, TOTALS, Deck, Node, blocks, straight, totals
from explicit_runs import ExplicitRun
from precision_references import Ring, beam_deflection, press_fit_force, pressurised_bore

HERE = Path(__file__).resolve().parent
NEAR = 1e-4
QUADRATIC = "C3D20R"
Curve = list[tuple[float, float]]  # times and values


class Reference(NamedTuple):
    """The answer: a curve over time, or one value at the end of the run; and how well it is known."""

    curve: Curve
    uncertainty: float


class Job(NamedTuple):
    """Run of CalculiX: a name, the element, the contact, factors of the penalty, and of the number of
    increments."""

    name: str
    element: str
    contact: str = ""
    penalty: float = 1.0
    shorter: int = 1


def difference(curve: Curve, exact: Curve) -> float:
    """Returns |f − f*| / |f*| at the end, if the end alone is known, else ∫|f − f*| / ∫|f*| at the times of
    the curve, by the trapezoidal rule."""
    if len(exact) == 1:
        return abs(curve[-1][1] / exact[0][1] - 1)

    def at(time: float) -> float:
        for (t0, v0), (t1, v1) in zip([(0.0, 0.0)] + exact, exact):
            if t0 <= time <= t1 * (1 + 1e-9):
                return v0 + (v1 - v0) * (time - t0) / (t1 - t0)
        raise ValueError(f"the reference does not reach {time}")

    def integral(values: Sequence[float]) -> float:
        times = [time for time, _ in curve]
        return sum(0.5 * (a + b) * (t - s) for a, b, s, t in zip(values, values[1:], times, times[1:]))

    right = [at(time) for time, _ in curve]
    return integral([abs(v - r) for (_, v), r in zip(curve, right)]) / integral([abs(r) for r in right])


PROFILES: dict[str, Changes] = {name: {"Profile": name} for name in ("fast", "balanced", "accurate")}
WITHOUT_CONTACT = [Job(element, element) for element in ("C3D8", "C3D8R", "C3D8I", QUADRATIC)]


def with_contact(*elements: str) -> list[Job]:
    """Returns jobs with nodes against surfaces, surfaces against surfaces, and larger penalties."""
    jobs = []
    for element in elements:
        if element != QUADRATIC:
            jobs.append(Job(f"{element}, node to surface", element, NODES))
        jobs.append(Job(f"{element}, surface to surface", element, FACES_CONTACT))
        for factor in (10, 100):
            name = f"{element}, surface to surface, penalty × {factor}"
            jobs.append(Job(name, element, FACES_CONTACT, float(factor)))
    return jobs


class Scene:
    """A scene of the page. `levels` are its meshes, `settings` those of billet, `jobs` those of CalculiX."""

    name, title, unit, quantity = "", "", "", ""
    source = ""  # of the reference
    file = Path()
    levels: Sequence[Changes] = ()
    settings: dict[str, Changes] = PROFILES
    jobs: Sequence[Job] = WITHOUT_CONTACT
    friction = 0.0
    penalty = 0.0  # of CalculiX; 0: the one that billet would choose
    n_bodies = 1
    n_levels = 4  # that are measured
    over_time = False  # whether the whole curve is compared, or its end
    prints: Sequence[str] = TOTALS
    always: Changes = {}  # what the scene says and is left to the settings here

    def reference(self) -> Reference:
        raise NotImplementedError

    def deck(self, changes: Changes, element: str) -> Deck:
        raise NotImplementedError

    def value(self, row: dict[str, float]) -> float:
        """Returns what is compared, from a row of billet's history."""
        raise NotImplementedError

    def printed(self, folder: Path, deck: Deck) -> Curve:
        """Returns the same of CalculiX."""
        raise NotImplementedError

    def curve(self, run: ExplicitRun) -> Curve:
        return [(row["time"], self.value(row)) for row in run.rows]

    def run(self, changes: Changes, folder: str | Path) -> ExplicitRun:
        return ExplicitRun(self.file, {"Output/Format": "none", **self.always, **changes}, folder)

    def converged(self, meshes: Sequence[Changes], settings: Changes) -> Reference:
        """Returns the reference that the last of these meshes makes. If errors fall at least to a half from
        mesh to mesh, the difference of the last two bounds that of the last."""
        curves = []
        for mesh in meshes:
            with tempfile.TemporaryDirectory() as folder:
                run = self.run({**mesh, **settings}, folder)
                if not run.finished:
                    raise SystemExit(f"the reference of {self.name} fails: {run.failure}")
                curves.append(self.curve(run))
        exact = curves[-1] if self.over_time else curves[-1][-1:]
        return Reference(exact, difference(curves[-2], exact))


class Billet(Scene):
    name, title, unit = "billet", "Billet, upset by 64 % with friction", "kN"
    quantity = "force of the die over the travel"
    n_levels = 3  # the fourth is the reference's
    over_time = True
    source = (
        "billet with 4608 bricks and 150 steps, which is none of the points; beside it 576 bricks with as"
        " many steps"
    )
    file = ROOT / "prm/billet_upsetting.prm"
    friction = 0.1
    penalty = 3.5e5  # the scene's, also of the reference
    levels = [
        {"Bodies/billet/Mesh/Refinements": n, "Bodies/billet/Mesh/Layers": 3 * 2**n} for n in (0, 1, 2, 3)
    ]
    always = {"Time stepping/Initial step": None}
    settings = {**PROFILES, "steps of 2 %": fixed_steps(50)}
    jobs = [
        Job(f"{element}, {contact.lower()}{more}", element, contact, 1.0, shorter)
        for element, contact, more, shorter in (
            ("C3D8", NODES, "", 1),
            ("C3D8R", NODES, "", 1),
            ("C3D8R", FACES_CONTACT, "", 1),
            ("C3D8R", NODES, ", steps of 1 %", 10),
            ("C3D8I", NODES, "", 1),
            (QUADRATIC, FACES_CONTACT, "", 1),
        )
    ]

    def reference(self) -> Reference:
        return self.converged(self.levels[2:], fixed_steps(150))

    def deck(self, changes: Changes, element: str) -> Deck:
        deck = Deck(
            self.file,
            [(element, 200e3, 0.3, (700, 0), (2200, 5)), ("C3D8", 200e3, 0.3)],
            plates=[((-5, -5, 15), (40, 40, 55))],
            changes=changes,
        )
        deck.surface("SLAVE", 0, lambda x, y, z: z > 15 - NEAR or math.hypot(x, y) > 9.0)
        deck.surface("MASTER", 1, lambda x, y, z: z < 15 + NEAR)
        for axis, name in enumerate("XYZ"):
            deck.hold(name, deck.members(0, lambda *x: x[axis] < NEAR), axis + 1)
        deck.node_set("HELD", deck.members(1, lambda x, y, z: True))
        deck.step(1, 0.02, 0.1, {("HELD", 1): 0, ("HELD", 2): 0, ("HELD", 3): -9.6})
        return deck

    def value(self, row: dict[str, float]) -> float:
        return 4e-3 * abs(row["die.force_z"])

    def printed(self, folder: Path, deck: Deck) -> Curve:
        return [(row[0], 4e-3 * abs(row[3])) for row in totals(folder)]


PENALTIES: dict[str, Changes] = {
    "penalty alone": {"Contact pairs/{}/Penetration tolerance": 0},
    "penalty alone, × 10": {
        "Contact pairs/{}/Penetration tolerance": 0,
        "Contact pairs/{}/Normal penalty": 100,
    },
}


def with_penalties(pair: str) -> dict[str, Changes]:
    """The profiles, which augment, and without that two penalties."""
    return PROFILES | {
        name: {key.format(pair): value for key, value in changes.items()}
        for name, changes in PENALTIES.items()
    }


def blocks_mesh(n: int) -> Changes:
    return {
        "Bodies/lower/Mesh/Arguments": f"{5 * n}, {3 * n} : 0, -6 : 10, 0 : true",
        "Bodies/upper/Mesh/Arguments": f"{3 * n}, {3 * n} : 0, 0 : 4, 4 : true",
    }


class TwoBlocks(Scene):
    name, title, unit = "two_blocks", "Two blocks, pressed with friction", "N"
    quantity = "force at the end"
    n_bodies = 2
    source = "billet, augmented, with meshes six times as fine as any point; beside it half as fine"
    file = HERE / "two_blocks.prm"
    friction = 0.2
    settings = with_penalties("faces")
    jobs = with_contact("C3D8", "C3D8I", QUADRATIC)

    levels = [blocks_mesh(n) for n in (1, 2, 4)]

    def reference(self) -> Reference:
        return self.converged([blocks_mesh(12), blocks_mesh(24)], {**fixed_steps(2), "Profile": "accurate"})

    def deck(self, changes: Changes, element: str) -> Deck:
        deck = Deck(self.file, [(element, 1e5, 0.3), (element, 2e5, 0.3)], 6, changes=changes)
        deck.surface("SLAVE", 1, lambda x, y, z: y < NEAR)
        deck.surface("MASTER", 0, lambda x, y, z: y > -NEAR)
        deck.hold("BASE", deck.members(0, lambda x, y, z: y < -6 + NEAR), 1, 2)
        both = (0, 1)
        deck.hold("MIDDLE", [i for b in both for i in deck.members(b, lambda x, y, z: x < NEAR)], 1)
        deck.hold("SIDES", [i for b in both for i in deck.members(b, lambda *x: True)], 3)
        deck.node_set("HELD", deck.members(1, lambda x, y, z: y > 4 - NEAR))
        deck.step(1, 0.1, 0.1, {("HELD", 1): 0, ("HELD", 2): -0.04})
        return deck

    def value(self, row: dict[str, float]) -> float:
        return abs(row["upper.support top.force_y"])

    def printed(self, folder: Path, deck: Deck) -> Curve:
        return [(row[0], abs(row[2])) for row in totals(folder)]


def hertz_mesh(n: int) -> Changes:
    return {
        "Bodies/lower/Mesh/Arguments": f"{n}, 1, {n // 2} : 0, 0, -1 : 1, 0.1, 0 : true",
        "Bodies/upper/Mesh/Arguments": f"{n - n // 8}, 1, {n // 2} : 0, 0, 0 : 1, 0.1, 1 : true",
    }


class Hertz(Scene):
    name, title, unit = "hertz", "Two cylinders, pressed together (Hertz)", "N"
    quantity = "force at the end"
    n_bodies = 2
    source = (
        "billet, augmented, with meshes 2.4 times as fine as any point; beside it 1.2 times as fine."
        " Hertz's own formula has no approach of cylinders"
    )
    file = ROOT / "prm/hertz_cylinders.prm"
    always = {"Contact pairs/faces/Penetration tolerance": None, "Time stepping/Initial step": None}
    settings = with_penalties("faces")
    jobs = [
        Job("C3D8, node to surface", "C3D8", NODES),
        Job("C3D8, surface to surface", "C3D8", FACES_CONTACT),
        *(
            Job(f"{element}, surface to surface, penalty × 10", element, FACES_CONTACT, 10.0)
            for element in ("C3D8", "C3D8I", "C3D20R")
        ),
    ]

    levels = [hertz_mesh(n) for n in (10, 20, 40)]

    def reference(self) -> Reference:
        settings: Changes = {
            "Contact pairs/faces/Penetration tolerance": 1e-3,
            "Time stepping/Initial step": 0.1,
        }
        found = self.converged([hertz_mesh(48), hertz_mesh(96)], settings)
        # Augmentation to a thousandth of a facet leaves 0.1 % with 40 elements across.
        return found._replace(uncertainty=max(found.uncertainty, 1e-3))

    def deck(self, changes: Changes, element: str) -> Deck:
        def upper(x: float) -> float:
            return 10 - math.sqrt(100 - x * x)

        def lower(x: float) -> float:
            return math.sqrt(400 - x * x) - 20

        def midpoint(a: Node, b: Node) -> Node:
            x, y, z = straight(a, b)
            for circle in (upper, lower):
                if abs(a[2] - circle(a[0])) < 1e-5 and abs(b[2] - circle(b[0])) < 1e-5:
                    return x, y, circle(x)
            return x, y, z

        deck = Deck(
            self.file, [(element, 1e5, 0.3), (element, 2e5, 0.3)], 6, changes=changes, midpoint=midpoint
        )
        deck.surface("SLAVE", 1, lambda x, y, z: abs(z - upper(x)) < 1e-5)
        deck.surface("MASTER", 0, lambda x, y, z: abs(z - lower(x)) < 1e-5)
        deck.hold("BASE", deck.members(0, lambda x, y, z: z < -8 + NEAR), 1, 2, 3)
        both = (0, 1)
        deck.hold(
            "MIDDLE",
            [i for b in both for i in deck.members(b, lambda x, y, z: x < NEAR and -7.9 < z < 7.9)],
            1,
        )
        deck.hold("SIDES", [i for b in both for i in deck.members(b, lambda x, y, z: -7.9 < z < 7.9)], 2)
        deck.node_set("HELD", deck.members(1, lambda x, y, z: z > 8 - NEAR))
        deck.step(1, 0.1, 0.1, {("HELD", 1): 0, ("HELD", 2): 0, ("HELD", 3): -0.04})
        return deck

    def value(self, row: dict[str, float]) -> float:
        return abs(row["upper.support top.force_z"])

    def printed(self, folder: Path, deck: Deck) -> Curve:
        return [(row[0], abs(row[3])) for row in totals(folder)]


class Beam(Scene):
    name, title, unit = "beam", "Beam, bent by 60 % of its length", "mm"
    quantity = "deflection of the tip at the end"
    source = "Reissner's beam, solved in one dimension by a program of its own"
    file = HERE / "bent_beam.prm"
    prints = ["*NODE PRINT, NSET=TIP", "U"]
    levels = [
        {"Bodies/beam/Mesh/Arguments": f"{10 * n}, 1, {n} : 0, 0, 0 : 100, 1, 1 : true"} for n in (1, 2, 4, 8)
    ]
    # Both ends of the tip's edge: the turn of the section cancels.

    def reference(self) -> Reference:
        # (h/L)^2 of what the clamp and the end do beyond a beam, and strains of 1.5 % in the law.
        return Reference([(1.0, beam_deflection(100, 1, 1, 1e5, 2.5))], 2e-4)

    def deck(self, changes: Changes, element: str) -> Deck:
        deck = Deck(self.file, [(element, 1e5, 0.0)], 6, changes=changes)
        deck.pairs = []
        deck.hold("CLAMP", deck.members(0, lambda x, y, z: x < NEAR), 1, 2, 3)
        deck.node_set(
            "TIP", deck.members(0, lambda x, y, z: x > 100 - NEAR and y < NEAR and abs(z - 0.5) > 0.5 - NEAR)
        )
        deck.step(1, 0.1, 0.1, {}, deck.traction(0, lambda x, y, z: x > 100 - NEAR, 3, -2.5))
        return deck

    def value(self, row: dict[str, float]) -> float:
        return -0.5 * (row["lower.displacement_z"] + row["upper.displacement_z"])

    def printed(self, folder: Path, deck: Deck) -> Curve:
        return [
            (t, -sum(row[3] for row in rows) / len(rows)) for t, rows in blocks(folder, "displacements", 1)
        ]


def on_arc(a: Node, b: Node) -> Node:
    """Returns the middle by radius and angle."""
    x, y, z = straight(a, b)
    radius = 0.5 * (math.hypot(a[0], a[1]) + math.hypot(b[0], b[1]))
    scale = radius / math.hypot(x, y)
    return x * scale, y * scale, z


class Cylinder(Scene):
    name, title, unit = "cylinder", "Cylinder under 94 % of its limit pressure", "mm"
    quantity = "displacement of the bore at the end"
    source = "the ring, solved in one dimension with 100 elements and 100 steps by a program of its own"
    file = ROOT / "prm/pressurised_cylinder.prm"
    prints = ["*NODE PRINT, NSET=BORE", "U"]
    always = {"Bodies/cylinder/Loads/gas/Pressure": "180*t", "Time stepping/Stops": None}
    levels = [{"Bodies/cylinder/Mesh/Refinements": n} for n in (1, 2, 3, 4)]

    def reference(self) -> Reference:
        # Yield in Kirchhoff's or in Cauchy's stress: 0.04 % of the stress, five times that of the bore.
        return Reference([(1.0, pressurised_bore(Ring(10, 20, 210e3, 0.3, 240), 180, 100, 100))], 2e-3)

    def deck(self, changes: Changes, element: str) -> Deck:
        deck = Deck(
            self.file,
            [(element, 210e3, 0.3, (240, 0))],
            6,
            changes={**self.always, **changes},
            midpoint=on_arc,
        )
        deck.pairs = []
        for axis, name in enumerate("XY"):
            deck.hold(name, deck.members(0, lambda *x: x[axis] < NEAR), axis + 1)
        deck.hold("Z", deck.members(0, lambda *x: True), 3)
        deck.node_set("BORE", deck.members(0, lambda x, y, z: abs(x - 10) < NEAR and y < NEAR))
        deck.step(1, 0.1, 0.1, {}, deck.pressure(0, lambda x, y, z: math.hypot(x, y) < 10 + NEAR, 180))
        return deck

    def value(self, row: dict[str, float]) -> float:
        return row["bore.displacement_x"]

    def printed(self, folder: Path, deck: Deck) -> Curve:
        return [
            (t, sum(row[1] for row in rows) / len(rows)) for t, rows in blocks(folder, "displacements", 1)
        ]


class PressFit(Scene):
    name, title, unit = "press_fit", "Press fit of two rings", "N"
    quantity = "force between the halves at the end"
    n_bodies = 2
    source = "both rings, solved in one dimension with 400 elements each by a program of its own"
    file = ROOT / "prm/press_fit.prm"
    always = {
        "Contact pairs/fit/Penetration tolerance": None,
        "Time stepping/Step control": None,
        "Time stepping/Initial step": None,
    }
    settings = {**with_penalties("fit"), "two steps": fixed_steps(2)}
    jobs = with_contact("C3D8", "C3D8I", QUADRATIC)
    levels = [
        {
            "Bodies/inner/Mesh/Arguments": f"{n}, {3 * n}, 1 : 10, 0, 0 : 20.01, 90, 1 : true",
            "Bodies/outer/Mesh/Arguments": f"{n}, {3 * n}, 1 : 20, 0, 0 : 30, 90, 1 : true",
        }
        for n in (2, 4, 8, 16)
    ]

    def reference(self) -> Reference:
        # Interference of 0.05 % of the radius: what laws of elasticity may differ by.
        force = press_fit_force(Ring(10, 20.01, 2e5, 0.3), Ring(20, 30, 2e5, 0.3))
        return Reference([(1.0, force)], 5e-4)

    def deck(self, changes: Changes, element: str) -> Deck:
        deck = Deck(
            self.file, [(element, 2e5, 0.3), (element, 2e5, 0.3)], 6, changes=changes, midpoint=on_arc
        )
        deck.surface("SLAVE", 0, lambda x, y, z: abs(math.hypot(x, y) - 20.01) < NEAR)
        deck.surface("MASTER", 1, lambda x, y, z: abs(math.hypot(x, y) - 20) < NEAR)
        both = (0, 1)
        for axis, name in enumerate("XY"):
            deck.hold(name, [i for b in both for i in deck.members(b, lambda *x: x[axis] < NEAR)], axis + 1)
        deck.hold("Z", [i for b in both for i in deck.members(b, lambda *x: True)], 3)
        deck.node_set("HELD", deck.members(1, lambda x, y, z: x < NEAR))
        deck.step(1, 0.5, 0.5, {})
        return deck

    def value(self, row: dict[str, float]) -> float:
        return abs(row["fit.force_x"])

    def printed(self, folder: Path, deck: Deck) -> Curve:
        return [(row[0], abs(row[1])) for row in totals(folder)]


SCENES: tuple[Scene, ...] = (Billet(), TwoBlocks(), Hertz(), Beam(), Cylinder(), PressFit())
