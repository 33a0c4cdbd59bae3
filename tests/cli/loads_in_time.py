#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: loads_in_time.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

Loads, springs and supports that begin and end in implicit dynamics. Loads that are constant in between give a
free block exactly their impulse, in every method and with fixed and automatic steps. Runs that resume at such
a time end as those that went on. The force of inertia is the rate of the momentum.
"""

from __future__ import annotations

import math
import sys

from checks import (
    HERE,
    Checks,
    Program,
    enter_folder,
    equal,
    near,
    read_text,
    require,
    rows_of,
    run,
    write_text,
)
from edits import edit
from shipped import Rows, history

program = Program(sys.argv[1:])
check = Checks()
enter_folder()

BLOCK = """subsection Bodies
  subsection block
    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = 1, 1, 1 : 0, 0, 0 : 1, 1, 1 : true
    end
    subsection Material
      set Law           = elastic
      set Young modulus = 1e4
      set Poisson ratio = 0.3
      set Density       = 1
    end
    PARTS
  end
end
subsection Time stepping
  set Scheme   = implicit dynamics
  set End time = 2
  STEPS
end
subsection Implicit dynamics
  METHOD
end
subsection Output
  set Format = none
  CHECKPOINTS
end
"""
METHODS = {
    "Newmark": "set Method = Newmark",
    "HHT": "set Method = HHT-alpha",
    "generalised": "",
}
STEPS = {"fixed": "set Step control = fixed\n  set Initial step = 0.1", "automatic": ""}
PULSES = {  # load, impulse along x
    "end": ("set Until = 0.2", 0.2),
    "begin": ("set From = 0.3", 1.7),
    "pulse": ("set From = 0.5\nset Until = 0.7", 0.2),
}
FORCES = {
    "force": "set Type = force\nset Boundary ids = 0\nset Force = 1 ; 0 ; 0",
    "acceleration": "set Type = acceleration\nset Acceleration = 1 ; 0 ; 0",
}


def load(parts: str) -> str:
    return f"subsection Loads\nsubsection load\n{parts}\nend\nend"


def scene(name: str, parts: str, method: str = "", steps: str = "", checkpoints: str = "") -> str:
    """Writes a scene of the block and returns its file."""
    text = BLOCK.replace("PARTS", parts).replace("METHOD", method).replace("STEPS", steps)
    write_text(f"{name}.prm", text.replace("CHECKPOINTS", checkpoints))
    return f"{name}.prm"


def run_to_end(name: str, file: str, ranks: int = 1, *options: str) -> Rows:
    """Runs a scene to its end."""
    ended = run(*program.on(ranks, "--quiet", "--output", name, *options, file))
    require(ended.code == 0, ended.output + ended.errors)
    return history(name)


for method, how in METHODS.items():
    for step, control in STEPS.items():

        @check(f"{method}, {step} steps: loads give a free block their impulse")
        def _() -> None:
            for pulse, (times, impulse) in PULSES.items():
                if step == "automatic" and pulse != "pulse":
                    continue
                for kind, force in FORCES.items():
                    name = f"{method}_{step}_{pulse}_{kind}"
                    rows = run_to_end(name, scene(name, load(f"{force}\n{times}"), how, control))
                    last = rows[-1]
                    near(f"momentum of {name}", last["momentum_x"], impulse, 1e-9)
                    if kind == "acceleration":  # which does not strain the block
                        near(f"energy of {name}", last["kinetic_energy"], 0.5 * impulse**2, 1e-6)
                        near(f"work of {name}", last["external_work"], 0.5 * impulse**2, 1e-6)
                        near("work of the load", last["block.load load.work"], last["external_work"], 1e-9)


@check("a support that ends lets the load act from then on")
def _() -> None:
    parts = load(FORCES["acceleration"]) + (
        "\nsubsection Supports\nsubsection clamp\nset Boundary ids = 0\nset Until = 0.5\nend\nend"
    )
    for method, how in METHODS.items():
        name = f"{method}_let_go"
        rows = run_to_end(name, scene(name, parts, how, STEPS["fixed"]))
        let_go = next(row for row in rows if row["time"] > 0.5 - 1e-6)
        near(f"momentum with {method}", rows[-1]["momentum_x"] - let_go["momentum_x"], 1.5, 1e-9)


@check("a spring that begins catches a block as the closed form says")
def _() -> None:
    spring = load(
        "set Type = spring\nset Boundary ids = 0\nset Stiffness = 1\nset Direction = 1, 0, 0\nset From = 0.5"
    )
    parts = spring + "\nset Initial velocity = 1, 0, 0"
    rows = run_to_end(
        "spring", scene("spring", parts, METHODS["Newmark"], STEPS["fixed"].replace("0.1", "0.02"))
    )
    # x'' + x = 0 with x(0.5) = 0.5, x'(0.5) = 1: the spring pulls towards the undeformed place.
    phase = math.atan2(0.5, 1.0) + 1.5
    near("momentum", rows[-1]["momentum_x"], math.hypot(0.5, 1.0) * math.cos(phase), 1e-3)
    require(max(abs(row["energy_drift"]) for row in rows) < 1e-6, "energy drifts")


@check("runs that resume where loads begin and end go on alike")
def _() -> None:
    both = load(FORCES["force"] + "\nset From = 0.5\nset Until = 0.7")
    for ranks, method in ((1, "Newmark"), (1, "HHT"), (2 if program.launcher else 1, "generalised")):
        name = f"{method}_whole"
        checkpoints = "subsection Checkpoint\nset Step interval = 1\nset Keep = 100\nend"
        file = scene(name, both, METHODS[method], STEPS["fixed"], checkpoints)
        write_text(file, read_text(file).replace("1, 1, 1 : 0", "2, 1, 1 : 0"))
        run_to_end(name, file, ranks)
        whole = rows_of(f"{name}/history.csv")
        for number in (5, 7):
            again = f"{name}_from_{number}"
            checkpoint = f"{name}/checkpoint_{number:05}.h5"
            run_to_end(again, file, ranks, "--restart", checkpoint)
            rows = rows_of(f"{again}/history.csv")
            require(len(rows) > 10, f"{len(rows)} rows")
            equal(f"history from {number}", rows[-10:], whole[-10:])


@check("the columns of a run that resumes while forces fade are the same")
def _() -> None:
    base = read_text(HERE / "switched.prm")
    for scheme in ("static", "implicit dynamics", "explicit"):
        name = scheme.replace(" ", "_")
        edits = "Output: + subsection Checkpoint\\nset Interval = 0.05\\nset Keep = 100\\nend"
        if scheme != "static":
            edits += f" & Time stepping: Scheme = {scheme} & Time stepping: - Maximum step"
        if scheme == "implicit dynamics":
            edits += " & Time stepping: Step control = fixed & Time stepping: Initial step = 0.05"
        if scheme == "explicit":
            edits += " & Output: History interval = 0.01"
        write_text(f"{name}.prm", edit(base, edits).text)
        run_to_end(name, f"{name}.prm")
        whole = {row[0]: row for row in rows_of(f"{name}/history.csv")}
        # At the end of the support, while its forces fade, at the removal of the tool, and while its forces
        # fade.
        for number in (8, 9, 18, 19):
            again = f"{name}_{number}"
            run_to_end(again, f"{name}.prm", 1, "--restart", f"{name}/checkpoint_{number - 1:05}.h5")
            rows = rows_of(f"{again}/history.csv")
            require(len(rows) > 1, "no rows")
            # Explicit steps after a restart have other lengths.
            for row in rows[:2] if scheme == "explicit" else rows:
                equal(f"row of {again}", row, whole[row[0]])


@check("the force of inertia is the rate of the momentum")
def _() -> None:
    parts = load("set Type = force\nset Boundary ids = 1\nset Force = 2 ; 0 ; t") + (
        "\nsubsection Supports\nsubsection guide\nset Boundary ids = 4, 5\nset Components = y, z\nend\nend"
    )
    for method, how in METHODS.items():
        name = f"{method}_guided"
        rows = run_to_end(name, scene(name, parts, how, STEPS["fixed"]))
        for before, row in zip(rows, rows[1:]):
            # Loads and reactions are those of the same time.
            near("reaction", row["block.support guide.force_z"], -row["block.load load.force_z"], 1e-4)
            near("inertia", row["inertia_x"], -2.0, 1e-4)
            if method == "Newmark":
                mean = 0.5 * (row["inertia_x"] + before["inertia_x"])
                change = row["momentum_x"] - before["momentum_x"]
                near("rate", change, -mean * (row["time"] - before["time"]), 1e-9)


sys.exit(check.finish())
