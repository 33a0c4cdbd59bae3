# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: scene_values.py PROGRAM FOLDER [SCENE...]

Runs scenes of prm/, all of the table below or those named, and writes their figures beside closed forms to
doc/scenes/values.csv, which their pages insert. Results go to FOLDER/SCENE.
"""

from __future__ import annotations

import csv
import math
import re
import subprocess
import sys
from pathlib import Path
from typing import Callable, Iterable, NamedTuple

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))  # for theories, which tests compare with, too
from membrane import Membrane  # noqa: E402
from rolling_theory import force_and_torque  # noqa: E402

VALUES = ROOT / "doc/scenes/values.csv"
LOCAL_AXES = {"Axes": "local", "First axis": "1, 0, 0", "Second axis": "0, 1, 0"}
HEAT = {
    "Temperature": "293",
    "Thermal factor": "Johnson-Cook",
    "Melting temperature": "1793",
    "Taylor-Quinney fraction": "0.9",
    "Specific heat": "477e6",
    "Density": "7.85e-9",
}
Row = dict[str, float]


class Value(NamedTuple):
    """A figure of a run and its reference, if there is one, with the format of both."""

    quantity: str
    run: float
    reference: float | None
    digits: str = ".5g"


class Runs:
    """Runs scenes of prm/ by a program."""

    def __init__(self, program: str, folder: Path) -> None:
        self._program = program
        self._folder = folder

    def history(self, scene: Path, name: str, *options: str, exit_code: int = 0) -> list[Row]:
        """Runs a scene; returns the rows of its history."""
        output = self._folder / name
        command = [self._program, "--quiet", str(scene), "--output", str(output), "--force", *options]
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        if ended.returncode != exit_code:
            raise SystemExit(f"{name}: exit code {ended.returncode}\n{ended.stderr[-2000:]}")
        with (output / "history.csv").open(encoding="utf-8", newline="") as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def shipped(self, name: str, *options: str, exit_code: int = 0) -> list[Row]:
        scene = ROOT / f"prm/{name}.prm"
        return self.history(scene, name + "_changed" * bool(options), *options, exit_code=exit_code)

    def edited(self, name: str, *changes: tuple[str, str]) -> list[Row]:
        """Runs a copy of a scene in which pieces of text, by regular expressions, are others."""
        text = (ROOT / f"prm/{name}.prm").read_text(encoding="utf-8")
        for pattern, replacement in changes:
            text, n_places = re.subn(pattern, replacement, text, flags=re.DOTALL)
            if n_places != 1:
                raise SystemExit(f"prm/{name}.prm has '{pattern}' {n_places} times")
        copy = self._folder / f"{name}_edited.prm"
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(text, encoding="utf-8")
        return self.history(copy, copy.stem)


def at(rows: list[Row], time: float) -> Row:
    """Returns the row at a time, which must be there."""
    return next(row for row in rows if abs(row["time"] - time) < 1e-9)


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Returns where a growing function is 0, by bisection."""
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return 0.5 * (low + high)


def work_returned(rows: list[Row]) -> float:
    """Returns the work that the scene gives back after its maximum, over the work put in until then."""
    put_in = max(row["external_work"] for row in rows)
    return 1 - rows[-1]["external_work"] / put_in


def of_calculix(scene: str, method: str) -> float:
    """Returns the first result of CalculiX for a scene on the page implicit-ccx."""
    page = (ROOT / "doc/results/implicit-ccx.md").read_text(encoding="utf-8")
    rows = page.split(f"| `{scene}` |", 1)[1].split("| `", 1)[0].splitlines()
    found = next(row.split("|") for row in rows if f"| ccx, {method} |" in row)
    return float(found[7].split(",")[0])


def balloon(runs: Runs) -> Iterable[Value]:
    last = runs.shipped("balloon")[-1]
    force = Membrane(100.0, 2.0, 1.5 / (2 * 1.499)).force_on_plane(0.0115, 105.0, 1.1523, 0.298)
    yield Value("force on the plate at 11.5 kPa, N", -last["plate.full_circle_force_z"], force, ".4g")


def bracket(runs: Runs) -> Iterable[Value]:
    deck = (ROOT / "prm/bracket/bracket_ccx.inp").read_text(encoding="utf-8")
    total = re.search(r"set BOLTED and time +0\.1000000E\+01: +(\S+)", deck)
    assert total
    last = runs.shipped("bracket")[-1]
    yield Value("reaction of the bolts along x, N", last["bracket.support bolts.force_x"], float(total[1]))


def cyclic_coupon(runs: Runs) -> Iterable[Value]:
    rows = runs.shipped("cyclic_coupon")
    stress = root(lambda tau: tau - 200 - 200 * math.tanh(50 * (0.02 - 2 * tau / 200e3)), 200, 400)
    for name, time, strain in (("tension", 4.25, 0.01), ("compression", 4.75, -0.01)):
        force = abs(at(rows, time)["coupon.support grip.force_z"])
        yield Value(f"{name}, fifth cycle: force of the grip, N", force, stress * math.exp(-strain), ".7g")


def drop(runs: Runs) -> Iterable[Value]:
    rows = runs.shipped("drop")
    gravity, start, gap, radius, modulus = 9810.0, 985.49, 0.5, 20.0, 50.0 / (1 - 0.3**2)
    forces = [2 * row["floor.force_z"] for row in rows]  # half of the ball is modelled
    times = [row["time"] for row in rows]
    mass = -2 * rows[0]["momentum_z"] / (start + gravity * times[0])
    speed = math.sqrt(start**2 + 2 * gravity * gap)  # where it touches
    touching = [time for time, force in zip(times, forces) if force > 0]
    steps = zip(times, times[1:], forces, forces[1:])
    impulse = sum(0.5 * (f0 + f1) * (t1 - t0) for t0, t1, f0, f1 in steps)
    impulse -= mass * gravity * (times[-1] - times[0])
    change = 2 * (rows[-1]["momentum_z"] - rows[0]["momentum_z"])
    depth = (15 * mass * speed**2 / (16 * math.sqrt(radius) * modulus)) ** 0.4
    rebound = 2 * rows[-1]["momentum_z"] / mass + gravity * (times[-1] - touching[-1])
    force = 4 / 3 * modulus * math.sqrt(radius) * depth**1.5
    duration = touching[-1] - touching[0]
    yield Value(
        "impulse of the floor and of gravity, over the change of momentum", impulse / change, 1, ".4g"
    )
    yield Value("largest force, N", max(forces), force, ".4g")
    yield Value("time of contact, ms", 1e3 * duration, 1e3 * 2.9432 * depth / speed, ".4g")
    yield Value("speed of the rebound over that of the impact", rebound / speed, 1, ".4g")


def pressurised_cylinder(runs: Runs) -> Iterable[Value]:
    rows = runs.shipped("pressurised_cylinder")
    a, b, young, nu, flow = 10.0, 20.0, 210e3, 0.3, 240.0
    k = flow / math.sqrt(3)
    bore = (1 + nu) * 76 * a**2 / (young * (b**2 - a**2)) * ((1 - 2 * nu) * a + b**2 / a)
    yield Value("bore at 76 MPa, elastic (Lamé), mm", at(rows, 0.4)["bore.displacement_x"], bore)
    c = root(lambda radius: k * (1 - radius**2 / b**2 + 2 * math.log(radius / a)) - 152, a, b)
    outside = 2 * (1 - nu**2) * k * c**2 / (young * b)
    yield Value(f"outside at 152 MPa, c = {c:.2f}, mm", at(rows, 0.8)["outside.displacement_x"], outside)
    beyond = "Bodies/cylinder/Loads/gas/Pressure=200*t"
    last = runs.shipped("pressurised_cylinder", "--set", beyond, exit_code=3)[-1]
    widened = (b + last["outside.displacement_x"]) / (a + last["bore.displacement_x"])
    pressure = 200 * last["time"]
    yield Value("last pressure in balance, MPa", pressure, 2 * k * math.log(b / a), ".4g")
    yield Value("the same, with the radii by then", pressure, 2 * k * math.log(widened), ".4g")


def o_ring(runs: Runs) -> Iterable[Value]:
    diameter, squeeze, young = 5.33, 0.2, 6 / (1 - 0.499**2)  # 6 (C10 + C01), in plane strain
    lindley = diameter * young * (1.25 * squeeze**1.5 + 50 * squeeze**6)
    for name, options in (("", ()), ("; `Refinements = 2`", ("--set", "Bodies/ring/Mesh/Refinements=2"))):
        rows = runs.shipped("o_ring", *options)
        squeezed, end = at(rows, 1), at(rows, 2)
        pressure = "under lid.largest_contact_pressure"
        yield Value(f"line load at 20 %, N/mm{name}", abs(squeezed["lid.force_per_width_y"]), lindley, ".3g")
        yield Value(f"maximum pressure under the lid at 20 %, MPa{name}", squeezed[pressure], None, ".3g")
        yield Value(f"the same under 3 MPa of oil, MPa{name}", end[pressure], None, ".3g")


def seal(runs: Runs) -> Iterable[Value]:
    # A thick ring under two opposite forces in plane strain (Roark, table 9.2, case 1); half is modelled.
    thickness, radius, shear = 3.0, 4.0, 1.0
    plane = 3 / (1 - 0.499**2)
    offset = radius - thickness / math.log(5.5 / 2.5)
    k2 = 1 - offset / radius
    k1 = k2 + 1.2 * plane * offset / (shear * radius)
    stiffness = plane * thickness * offset / (radius**2 * (math.pi * k1 / 4 - 2 * k2**2 / math.pi)) / 2
    coarse = "Bodies/seal/Mesh/Arguments=3, 1, 24 : 2.5, 0, -90 : 5.5, 1, 90 : true"
    for name, options in (("", ()), ("; 24 × 3 bricks", ("--set", coarse))):
        rows = runs.shipped("seal", *options)
        begin, closed, last = rows[1], at(rows, 1), rows[-1]
        slope = abs(begin["upper plate.force_z"] / begin["upper plate.travel_z"])
        approach = abs(begin["upper plate.travel_z"])
        force = abs(closed["upper plate.force_z"])
        friction = last["friction_dissipation"]
        yield Value(f"force over approach at {approach:.3g} mm, N/mm²{name}", slope, stiffness, ".3g")
        yield Value(f"force at half of the height, N/mm, of half the seal{name}", force, None, ".3g")
        yield Value(f"friction work of squeeze and release, mJ/mm{name}", friction, None, ".3g")
        yield Value(f"stored energy at the end, mJ/mm{name}", last["elastic_energy"], None, ".3g")


def slab_rolling(runs: Runs) -> Iterable[Value]:
    force, torque = force_and_torque()
    for name, scene, end in (("static", "slab_rolling", 1.0), ("explicit", "slab_rolling_explicit", 10.5e-3)):
        rows = [row for row in runs.shipped(scene) if 0.5 * end <= row["time"] <= 0.9 * end]
        spans = [after["time"] - before["time"] for before, after in zip(rows, rows[1:])]

        def mean(column: str) -> float:
            return sum(span * row[column] for span, row in zip(spans, rows[1:])) / sum(spans)

        yield Value(f"{name}: force, N/mm", -mean("roll.force_y"), force, ".4g")
        yield Value(f"{name}: torque, N", mean("roll.moment_z"), torque)


def stack(runs: Runs) -> Iterable[Value]:
    last = runs.shipped("stack")[-1]
    weight = 0.0
    for name, column, volume, density in (
        ("upper block on the middle one", "upper on middle", 30 * 40**2, 1.1e-9),
        ("middle one on the lower one", "middle on lower", 40 * 50**2, 7.85e-9),
        ("lower one on the floor", "floor", 60**3, 1.1e-9),
    ):
        weight += 9810 * volume * density
        yield Value(f"{name}, N", abs(last[f"{column}.force_z"]), weight, ".6g")


def step_punch(runs: Runs) -> Iterable[Value]:
    part = r"set Shape += CAD\n +set File .*\n +set Faces .*\n +set Translation .*\n"
    sphere = "set Shape = sphere\n set Centre = 0, 0, 30\n set Radius = 10\n"
    force = -4 * runs.shipped("step_punch")[-1]["punch.force_z"]
    of_sphere = -4 * runs.edited("step_punch", (part, sphere))[-1]["punch.force_z"]
    hertz = 4 / 3 * 1000 / (1 - 0.3**2) * math.sqrt(10) * 0.1**1.5
    name = "force on the whole punch, N"
    yield Value(f"{name}; reference: `Shape = sphere` on the same mesh", force, of_sphere, ".6g")
    yield Value(f"{name}; reference: Hertz, half-space", force, hertz, ".4g")


def axisymmetric(runs: Runs) -> Iterable[Value]:
    section = (
        "set Primitive = subdivided_hyper_rectangle\n"
        "set Arguments = 8, 12 : 0, 0 : 10, 15 : true\nset Section = axisymmetric\n"
    )
    wedge = runs.edited(
        "billet_upsetting",
        (r"set Source +=.*?set Layers[^\n]*\n", section),
        (r"set Symmetry planes = [^\n]*", "set Symmetry planes = z = 0"),
        (r"set Boundary ids         = 0, 3", "set Boundary ids = 1, 3"),
    )[-1]
    finer = ("--set", "Bodies/billet/Mesh/Refinements=2", "--set", "Bodies/billet/Mesh/Layers=12")
    quarter = runs.shipped("billet_upsetting", *finer)[-1]
    name = "force on the billet at the end, kN, 96 bricks; reference: 576 bricks of the quarter"
    force = -1e-3 * wedge["die.full_circle_force_z"]
    yield Value(name, force, -4e-3 * quarter["die.force_z"], ".4g")


def drop_hammer(runs: Runs) -> Iterable[Value]:
    steps = [f"{name} step=" for name in ("Initial", "Minimum", "Maximum")]
    options = [word for value in ("Scheme=explicit", *steps) for word in ("--set", f"Time stepping/{value}")]
    implicit, explicit = runs.shipped("drop_hammer"), runs.shipped("drop_hammer", *options)
    energy = implicit[0]["kinetic_energy"]

    def largest(rows: list[Row], column: str) -> float:
        return max(abs(row[column]) for row in rows)

    for name, column, factor in (
        ("largest travel of the hammer, mm", "hammer.travel_z", 1),
        ("largest force of the hammer, of a quarter, kN", "hammer.force_z", 1e-3),
    ):
        found, reference = (factor * largest(rows, column) for rows in (implicit, explicit))
        yield Value(f"{name}; reference: `Scheme = explicit`", found, reference)
    yield Value("steps; reference: `Scheme = explicit`", implicit[-1]["step"], explicit[-1]["step"], ".0f")
    first, last = implicit[0], implicit[-1]
    duration = last["time"] - first["time"]
    name = "anvil.force_z"
    pairs = zip(implicit, implicit[1:])
    impulse = sum(0.5 * (a[name] + b[name]) * (b["time"] - a["time"]) for a, b in pairs)
    weight = 981 + 9810 * 7.8e-9 * 30 * math.pi * 10**2 / 4
    change = last["momentum_z"] - first["momentum_z"]
    balance = "impulse of the anvil and of the weight, over the change of momentum"
    yield Value(balance, (impulse - weight * duration) / change, 1)
    terms = ("plastic_work", "friction_dissipation", "elastic_energy", "contact_energy")
    taken = sum(last[name] - first[name] for name in terms)
    given = first["kinetic_energy"] - last["kinetic_energy"] + last["external_work"] - first["external_work"]
    yield Value(
        "dissipated and stored energy, over kinetic energy lost and work of the weight", taken / given, 1
    )
    for name in ("numerical_dissipation", "energy_drift"):
        part = 100 * abs(implicit[-1][name]) / energy
        yield Value(f"`{name}` at the end, % of the energy", part, None, ".1g")


def tube_impact(runs: Runs) -> Iterable[Value]:
    rows = runs.shipped("tube_impact")
    energy, mass = rows[0]["kinetic_energy"], 2 * rows[0]["kinetic_energy"] / 50**2
    momentum = max(abs(row[f"momentum_{axis}"]) for row in rows for axis in "xyz")
    drift = max(abs(row["energy_drift"]) for row in rows)
    depth = max(row["tubes.deepest_penetration"] for row in rows)
    yield Value("largest penetration of a node, % of the wall", 100 * depth / 0.01, None, ".2g")
    yield Value("largest energy drift, % of the energy", 100 * drift / energy, None, ".1g")
    yield Value("largest momentum, of that of one tube", momentum / (mass / 2 * 50), None, ".0e")


def hollow_block(runs: Runs) -> Iterable[Value]:
    rows = runs.shipped("hollow_block")
    reference = of_calculix("hollow_block", "surface to surface")
    yield Value(
        "work of squeezing, N mm; reference: CalculiX", at(rows, 1)["external_work"], reference, ".4g"
    )
    yield Value("work returned over work put in", work_returned(rows), 1)


def passing_spheres(runs: Runs) -> Iterable[Value]:
    def spheres(*settings: str) -> list[Row]:
        return runs.shipped("passing_spheres", *(word for setting in settings for word in ("--set", setting)))

    shorter = tuple(f"Time stepping/{name} step=0.01" for name in ("Initial", "Maximum"))
    for name, settings in (
        ("dissipation by friction over work put in, after parting", ()),
        ("the same with a quarter of the step", shorter),
    ):
        last = spheres(*settings)[-1]
        yield Value(name, last["friction_dissipation"] / last["external_work"], 1, ".4g")
    rows = spheres("Contact pairs/faces/Friction coefficient=0", "Time stepping/Stops=0.5")
    middle = at(rows, 0.5)
    hertz = 4 / 3 * 100 / (2 * (1 - 0.3**2)) * math.sqrt(10 / 2) * 1.5**1.5
    yield Value("without friction: work returned over work put in", work_returned(rows), 1, ".4g")
    ratio = abs(middle["faces.force_x"] / middle["faces.force_z"])
    yield Value("without friction: horizontal over vertical force at half-way", ratio, 0, ".1g")
    name = "without friction: vertical force at half-way, N; reference: Hertz, half-spaces"
    yield Value(name, middle["faces.force_z"], hertz, ".4g")


def ring_crush(runs: Runs) -> Iterable[Value]:
    # A thin ring under two opposite forces in plane strain; half is modelled.
    rows = runs.shipped("ring_crush")
    inertia = 0.5 * 0.5**3 / 12
    stiffness = 100 / (1 - 0.3**2) * inertia / ((math.pi / 4 - 2 / math.pi) * 9.75**3) / 2
    travel = rows[0]["die.travel_z"]
    name = f"force over travel at {-travel:.3g} mm, N/mm; reference: thin ring"
    yield Value(name, rows[0]["die.force_z"] / travel, stiffness, ".3g")
    yield Value("work returned over work put in", work_returned(rows), 1)
    finer = runs.shipped("ring_crush", "--set", "Time stepping/Maximum step=0.0125")
    yield Value("the same with steps of at most 0.0125", work_returned(finer), 1)


def turned_blocks(runs: Runs) -> Iterable[Value]:
    rows = [row for row in runs.shipped("turned_blocks") if 1 <= row["time"] <= 37]
    pressed, turned = rows[0], rows[-1]

    def force(row: Row) -> list[float]:
        """Returns the force in the frame that turns with the blocks."""
        x, y, z = (row[f"blocks.force_{axis}"] for axis in "xyz")
        c, s = (function((row["time"] - 1) * math.pi / 18) for function in (math.cos, math.sin))
        return [x * c - z * s, y, x * s + z * c]

    norm = math.hypot(*force(pressed))
    for method in ("node to surface", "surface to surface"):
        name = f"force after pressing, N; reference: CalculiX, {method}"
        yield Value(name, norm, of_calculix("turned_blocks", method), ".4g")
    change = max(math.dist(force(row), force(pressed)) for row in rows) / norm
    yield Value("largest change of the force while the blocks turn, of the force", change, 0, ".1g")
    work = [row["friction_dissipation"] for row in (pressed, turned)]
    yield Value("friction work of the turn, of that before", work[1] / work[0] - 1, 0, ".1g")


def flow_rules(runs: Runs) -> Iterable[Value]:
    without = runs.shipped("billet_upsetting")[-1]["total_iterations"]
    for name, settings in (
        ("two terms of backstress", {"Backstress moduli": "20000, 2000", "Backstress rates": "200, 0"}),
        ("Hill", {"Anisotropy": "Hill", "r-values": "1.79, 1.51, 2.27", **LOCAL_AXES}),
        ("thermal softening with heat", HEAT),
    ):
        material = [f"Bodies/billet/Material/{key}={value}" for key, value in settings.items()]
        options = [word for setting in material for word in ("--set", setting)]
        last = runs.shipped("billet_upsetting", *options)[-1]
        yield Value(f"iterations: {name}; reference: none", last["total_iterations"], without, ".0f")


def pin_in_lug(runs: Runs) -> Iterable[Value]:
    scene = ROOT / "tests/cli/pin.prm"
    shift = "Contact pairs/fit/Initial penetration=shift"
    corrected = "Contact pairs/fit/Surface correction=cylinder : 0, 0, 0 ; 0, 0, 1"

    def force(n_lug: int, n_pin: int, contact: str) -> float:
        """Returns the force for so many facets around half of the lug and half of the pin."""
        lug = f"Bodies/lug/Mesh/Arguments=3, {n_lug}, 1 : 10, 0, 0 : 20, 180, 1 : true"
        pin = f"Bodies/pin/Mesh/Arguments=3, {n_pin}, 1 : 3, 0, 0 : 10, 180, 1 : true"
        settings = [word for setting in (lug, pin, contact) for word in ("--set", setting)]
        return abs(runs.history(scene, "pin_in_lug", *settings)[-1]["fit.force_x"])

    matching = force(48, 48, shift)
    for name, contact in (("chords, `Initial penetration = shift`", shift), ("corrected", corrected)):
        for n in (20, 24, 48):
            if contact == shift or n < 48:
                around = f"{name}: force with {n} facets around the lug, N"
                yield Value(around, force(n // 2, n // 2 + 1, contact), matching, ".4g")


SCENES: dict[str, Callable[[Runs], Iterable[Value]]] = {
    scene.__name__: scene
    for scene in (
        axisymmetric,
        balloon,
        bracket,
        cyclic_coupon,
        drop,
        drop_hammer,
        flow_rules,
        hollow_block,
        o_ring,
        passing_spheres,
        pin_in_lug,
        pressurised_cylinder,
        ring_crush,
        seal,
        slab_rolling,
        stack,
        step_punch,
        tube_impact,
        turned_blocks,
    )
}


def difference(value: Value) -> str:
    """Returns the relative difference: per cent, or a power of ten where it is small; none from 0."""
    if not value.reference:
        return ""
    ratio = value.run / value.reference - 1
    if abs(ratio) < 1e-8:
        return "< 1e-8"
    text = f"{100 * ratio:+.{3 if abs(ratio) >= 0.95 else 2}g} %" if abs(ratio) >= 1e-4 else f"{ratio:+.0e}"
    return text.replace("-", "−", 1) if ratio < 0 else text


def main() -> None:
    program, folder = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    kept: list[list[str]] = []
    if VALUES.exists():
        with VALUES.open(encoding="utf-8", newline="") as file:
            kept = list(csv.reader(file))[1:]
    for name in sys.argv[3:] or SCENES:
        kept = [row for row in kept if row[0] != name]
        for value in SCENES[name](Runs(program, folder)):
            run, reference = (
                "" if number is None else re.sub(r"\.(?=e|$)", "", f"{number:#{value.digits}}")
                for number in (value.run, value.reference)
            )
            kept.append([name, value.quantity, run, reference, difference(value)])
            print(*kept[-1], sep=", ", flush=True)
    with VALUES.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("scene", "quantity", "run", "reference", "difference"))
        writer.writerows(row for key in SCENES for row in kept if row[0] == key)


if __name__ == "__main__":
    main()
