#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: loaded_scenes.py BILLET

Runs the shipped scenes with loads, supports and gravity in an empty current folder, some on coarser meshes
or in fewer steps, and compares them with closed forms and with CalculiX. Each scene has at most 60 lines, and
its forces balance.
"""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path

from checks import (
    SHIPPED,
    Checks,
    Ended,
    enter_folder,
    equal,
    near,
    read_text,
    require,
    run,
    says,
    write_text,
)
from membrane import Membrane
from shipped import Rows, history, require_balance, require_page, require_short

program = sys.argv[1]
check = Checks()
enter_folder()


def run_scene(name: str, *changes: str) -> tuple[Ended, Rows]:
    """Runs a shipped scene with changes to its end, and returns how it ended, and its history."""
    require_short(name, counts_included=True)
    folder = f"{name}.{len(changes)}"
    options = [part for change in ("Output/Format=none", *changes) for part in ("--set", change)]
    ended = run(program, str(SHIPPED / f"{name}.prm"), "--output", folder, *options)
    return ended, history(folder)


def run_to_end(name: str, *changes: str) -> Rows:
    """Runs a shipped scene, which must end without warnings and with forces that balance."""
    ended, rows = run_scene(name, *changes)
    equal("exit code", ended.code, 0)
    require("warning[" not in ended.output + ended.errors, ended.output + ended.errors)
    require("note[stabilised-" not in ended.output, ended.output)  # of the stack, which rests by its weight
    require_balance(rows)
    return rows


@check("the bracket reacts as in CalculiX")
def _() -> None:
    deck = read_text(SHIPPED / "bracket/bracket_ccx.inp")
    total = says(r"set BOLTED and time +0\.1000000E\+01: +(\S+)", deck)
    at_once = "Time stepping/Initial step=1", "Solver/Force tolerance=1e-7"  # it is elastic
    last = run_to_end("bracket", *at_once)[-1]
    near("reaction of the bolts", last["bracket.support bolts.force_x"], float(total[1]), 5e-3)
    pull = last["bracket.support pull.force_x"]
    near("force of the pull", pull, -last["bracket.support bolts.force_x"], 1e-5)
    path = "Bodies/bracket/Supports/pull/Displacement"
    short = run_to_end("bracket", *at_once, f"{path}=0.5*t")[-1]
    equal("force of the pull by its component alone", short["bracket.support pull.force_x"], pull)


@check("the stack weighs what its blocks weigh")
def _() -> None:
    rows = run_to_end(
        "stack",
        "Bodies/lower/Mesh/Arguments=3, 3, 3 : 0, 0, 0 : 60, 60, 60",
        "Bodies/middle/Mesh/Arguments=3, 3, 2 : 0, 0, 60 : 50, 50, 100",
        "Bodies/upper/Mesh/Arguments=2, 2, 2 : 0, 0, 100 : 40, 40, 130",
        "Time stepping/Initial step=0.25",
        "Time stepping/Maximum step=0.25",
        "Solver/Force tolerance=1e-5",
    )
    g = 9810.0
    upper = 40.0 * 40.0 * 30.0 * 1.1e-9 * g
    middle = 50.0 * 50.0 * 40.0 * 7.85e-9 * g
    lower = 60.0 * 60.0 * 60.0 * 1.1e-9 * g
    for row in rows:  # The weight grows with time. The first steps have the larger residuals, within 5e-3.
        t, tolerance = row["time"], 1e-5 if row is rows[-1] else 1e-3
        near("force on the floor", row["floor.force_z"], t * (lower + middle + upper), tolerance)
        near("force on the lower block", row["middle on lower.force_z"], t * (middle + upper), tolerance)
        near("force on the middle block", row["upper on middle.force_z"], t * upper, tolerance)
    require(
        rows[-1]["viscous_dissipation"] < 1e-6 * rows[-1]["elastic_energy"], "viscous forces bear the stack"
    )


@check("the coupon settles in the loop of Armstrong and Frederick")
def _() -> None:
    young, start, modulus, rate, strain = 200e3, 200.0, 20e3, 100.0, 0.01
    stress = start
    for _iteration in range(100):  # a contraction
        stress = start + modulus / rate * math.tanh(rate * (strain - stress / young))
    rows = run_to_end("cyclic_coupon")
    for time, sign in ((4.25, 1), (4.75, -1)):
        peak = next(row for row in rows if abs(row["time"] - time) < 1e-9)
        force = sign * stress * math.exp(-sign * strain)  # tau/lambda, on 1 mm^2
        near("force of the grip", peak["coupon.support grip.force_z"], force, 1e-6)
    first = next(row for row in rows if abs(row["time"] - 0.25) < 1e-9)
    require(first["coupon.support grip.force_z"] < 312, "the first peak is lower")


A, B, E, NU, YIELD = 10.0, 20.0, 210e3, 0.3, 240.0  # of the cylinder


def elastoplastic_radius(pressure: float) -> float:
    """Returns the radius c up to which it yields: p = k (1 - c^2/b^2 + 2 ln c/a), k = yield / sqrt 3."""
    low, high = A, B
    for _ in range(60):
        c = 0.5 * (low + high)
        reached = YIELD / math.sqrt(3) * (1 - (c / B) ** 2 + 2 * math.log(c / A))
        low, high = (c, high) if reached < pressure else (low, c)
    return low


@check("the cylinder widens as Lamé's, then as the partly plastic one")
def _() -> None:
    rows = run_to_end("pressurised_cylinder")
    stop = next(row for row in rows if abs(row["time"] - 0.4) < 1e-9)
    p = 190 * 0.4
    factor = (1 + NU) * p * A * A / (E * (B * B - A * A))
    near("bore", stop["bore.displacement_x"], factor * ((1 - 2 * NU) * A + B * B / A), 2e-3)
    near("outside", stop["outside.displacement_x"], factor * 2 * (1 - NU) * B, 2e-3)
    equal("plastic work", stop["plastic_work"], 0.0)
    # In plane strain the law between the radii holds for nu = 0.5; well before the limit nu hardly matters.
    for row in rows:
        if 0.6 < row["time"] < 0.85:
            c = elastoplastic_radius(190 * row["time"])
            u = 2 * (1 - NU * NU) * YIELD * c * c / (math.sqrt(3) * E * B)
            near("outside, partly plastic", row["outside.displacement_x"], u, 5e-3)


@check("the cylinder bursts at its limit pressure")
def _() -> None:
    ended, rows = run_scene(
        "pressurised_cylinder",
        "Bodies/cylinder/Mesh/Refinements=2",
        "Bodies/cylinder/Loads/gas/Pressure=200*t",
        "Time stepping/Minimum step=1e-3",
    )
    equal("exit code", ended.code, 3)
    says("Above the limit load, no equilibrium exists", ended.errors)
    last = rows[-1]
    limit = 2 / math.sqrt(3) * YIELD * math.log(B / A)
    near("limit pressure", 200 * last["time"], limit, 1e-2)
    # The walls are thinner by then; with these radii the law holds closer.
    a, b = A + last["bore.displacement_x"], B + last["outside.displacement_x"]
    near(
        "limit pressure of the widened tube",
        200 * last["time"],
        limit * math.log(b / a) / math.log(B / A),
        4e-3,
    )


@check("the balloon swells as a thick sphere, then presses as a membrane")
def _() -> None:
    rows = run_to_end("balloon")
    inner, outer, shear = 99.0, 101.0, 1.5 / (2 * 1.499)
    n_free = 0
    for row in rows:
        if row["plate.full_circle_force_z"] == 0.0:
            b = outer + row["equator.displacement_x"]
            a = (inner**3 + b**3 - outer**3) ** (1 / 3)
            of_b, of_a = ((r0 / r) ** 4 + 4 * r0 / r for r0, r in ((outer, b), (inner, a)))
            near("pressure of a neo-Hookean sphere", 0.5 * shear * (of_b - of_a), 0.0115 * row["time"], 8e-3)
            n_free += 1
    require(n_free >= 3, f"{n_free} rows before contact")
    force = Membrane(100.0, 2.0, shear).force_on_plane(0.0115, 105.0, 1.1523, 0.298)
    near("force on the plate", -rows[-1]["plate.full_circle_force_z"], force, 1.5e-2)


@check("the punch from a STEP file presses as a sphere does")
def _() -> None:
    changes = (
        "Bodies/block/Mesh/Arguments=12, 12, 8 : 0, 0, 0 : 10, 10, 10",
        "Time stepping/Initial step=0.5",
        "Time stepping/Maximum step=0.5",
    )
    rows = run_to_end("step_punch", *changes)
    text = read_text(SHIPPED / "step_punch.prm")
    sphere, n = re.subn(
        r"set Shape += CAD\n +set File .*\n +set Faces .*\n +set Translation .*\n",
        "set Shape = sphere\n set Centre = 0, 0, 30\n set Radius = 10\n",
        text,
    )
    equal("tools replaced", n, 1)
    write_text("sphere.prm", sphere)
    options = [part for change in ("Output/Format=none", *changes) for part in ("--set", change)]
    equal("exit code", run(program, "sphere.prm", *options).code, 0)
    of_spheres = history("sphere")
    equal("steps", len(of_spheres), len(rows))
    for row, of_sphere in zip(rows, of_spheres):
        for axis in "xyz":
            near(f"force along {axis}", row[f"punch.force_{axis}"], of_sphere[f"punch.force_{axis}"], 1e-9)
        # Hertz: a half-space, which gives way more than a block of twenty radii of contact on its base.
        force = 4 / 3 * 1000 / (1 - 0.3**2) * math.sqrt(10) * (0.1 * row["time"]) ** 1.5
        near("force of Hertz", -4 * row["punch.force_z"], force, 0.08)


@check("the ball bounces as Hertz and gravity have it")
def _() -> None:
    rows = run_to_end("drop", "Time stepping/End time=2.2e-3")  # it leaves the floor at 1.8e-3
    g, v0, gap, radius, modulus = 9810.0, 985.49, 0.5, 20.0, 50.0 / (1 - 0.3**2)
    forces = [2 * row["floor.force_z"] for row in rows]  # half of the ball is modelled
    times = [row["time"] for row in rows]
    mass = -2 * rows[0]["momentum_z"] / (v0 + g * times[0])
    speed = math.sqrt(v0 * v0 + 2 * g * gap)  # where it touches
    touching = [t for t, f in zip(times, forces) if f > 0]
    require(abs(touching[0] - (speed - v0) / g) < 3e-5, f"it touches at {touching[0]}")
    # Hertz (Johnson, Contact Mechanics, 1985, ch. 11): 8/15 E* R^(1/2) d^(5/2) = m v^2 / 2; 2.94 d / v.
    # Facets are chords of 1 mm for a contact of radius 3 mm.
    depth = (15 * mass * speed**2 / (16 * math.sqrt(radius) * modulus)) ** 0.4
    near("largest force", max(forces), 4 / 3 * modulus * math.sqrt(radius) * depth**1.5, 0.09)
    near("time of contact", touching[-1] - touching[0], 2.9432 * depth / speed, 0.05)
    impulse = sum(0.5 * (f0 + f1) * (t1 - t0) for t0, t1, f0, f1 in zip(times, times[1:], forces, forces[1:]))
    momentum = 2 * (rows[-1]["momentum_z"] - rows[0]["momentum_z"])
    near("momentum", impulse - mass * g * (times[-1] - times[0]), momentum, 2e-3)
    rebound = 2 * rows[-1]["momentum_z"] / mass + g * (times[-1] - touching[-1])
    require(0.99 < rebound / speed < 1, f"it rebounds with {rebound / speed} of its speed")
    require(abs(rows[-1]["energy_drift"]) < 1e-3, f"energy drifts by {rows[-1]['energy_drift']}")


SPRING = """subsection Bodies
  subsection cube
    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = 2, 2, 2 : 0, 0, 0 : 1, 1, 1 : true
    end
    set Symmetry planes = x = 0 ; y = 0
    subsection Material
      set Young modulus = 1000
      set Poisson ratio = 0.3
      set Density       = 1
    end
    subsection Loads
      subsection base
        set Type         = spring
        set Boundary ids = 4
        set Direction    = 0, 0, 1
        set Stiffness    = 100
      end
      subsection push
        set Type         = dead traction
        set Boundary ids = 5
        set Traction     = 0 ; 0 ; -10*t
      end
    end
  end
end
subsection Probes
  subsection all
    set Type = body
  end
end
subsection Time stepping
  set Scheme   = {}
  set End time = 1
end
subsection Output
  subsection Checkpoint
    set Step interval = 1
    set Keep          = 100
  end
end
"""


def run_written(file: str, *options: str) -> dict[str, float]:
    """Runs a scene of the current folder, and returns the last line of its history."""
    equal("exit code", run(program, file, *options).code, 0)
    return history(options[-1])[-1]


@check("loads have their forces and works, and the body its motion and energies")
def _() -> None:
    for scheme in ("quasi-static", "implicit dynamics", "explicit"):
        name = scheme.replace(" ", "_")
        write_text(f"{name}.prm", SPRING.format(scheme))
        row = run_written(f"{name}.prm", "--output", name)
        works = row["cube.load base.work"] + row["cube.load push.work"]
        # In implicit schemes the residual that Newton's method leaves does work, too.
        near(f"{scheme}: sum of works", works, row["external_work"], 1e-9 if scheme == "explicit" else 1e-5)
        near(f"{scheme}: traction", row["cube.load push.force_z"], -10.0, 1e-9)
        if scheme == "quasi-static":  # force and spring, 10 on 100 per area 1
            near("force of the spring", row["cube.load base.force_z"], 10.0, 1e-5)
            near("work of the spring", row["cube.load base.work"], -0.5, 1e-5)
        else:
            near(f"{scheme}: momentum", row["all.momentum_z"], row["momentum_z"], 1e-9)
            near(f"{scheme}: velocity", row["all.velocity_z"], row["momentum_z"], 1e-9)
            near(f"{scheme}: kinetic energy", row["all.kinetic_energy"], row["kinetic_energy"], 1e-3)
        near(f"{scheme}: internal energy", row["all.internal_energy"], row["elastic_energy"], 1e-9)


@check("works of loads continue after a restart")
def _() -> None:
    for scheme in ("quasi-static", "implicit dynamics", "explicit"):
        name = scheme.replace(" ", "_")
        checkpoints = sorted(Path(name).rglob("checkpoint_*.h5"))
        middle = checkpoints[len(checkpoints) // 2]
        row = run_written(f"{name}.prm", "--restart", str(middle), "--output", f"{name}_again")
        first = history(name)[-1]
        for column in ("cube.load base.work", "cube.load push.work", "cube.load base.force_z"):
            near(f"{scheme}: {column}", row[column], first[column], 1e-12)


@check("pages")
def _() -> None:
    for name in ("bracket", "stack", "pressurised_cylinder", "drop"):
        require_page(name, name)


sys.exit(check.finish())
