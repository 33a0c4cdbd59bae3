# SPDX-License-Identifier: LGPL-2.1-or-later
"""The billet in billet and in CalculiX, on the same meshes, alternately."""

import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from billet_runs import (PAIR, PENALTY, PROGRAM, SCENE, Run, arguments, children_seconds, fixed_steps,
                         frictionless_force, interpolate, mesh, n_elements, number, publish, table, variant)
from ccx_decks import FACES, CcxJob, read_bricks

options = arguments("billet-ccx")
REPEAT = 3


def read_mesh(refinements):
    """Nodes and bricks (in VTK's order, which is Abaqus', too) of billet's mesh, from its fields at time 0."""
    changes = {**mesh(refinements), "Time stepping/End time": 1e-3, "Time stepping/Initial step": 1e-3,
               "Output/Folder": "results", "Output/Verbosity": "quiet"}
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "scene.prm").write_text(variant(SCENE.read_text(), changes))
        subprocess.run([PROGRAM, "scene.prm"], cwd=folder, check=True)
        text = Path(folder, "results/fields_00000.0.vtu").read_text()
    return read_bricks(text, 4)


def write_deck(path, nodes, bricks, element, contact, friction, increment):
    """The deck of one eighth of the billet under a die that is one brick with all nodes prescribed."""
    count = {}
    for brick in bricks:
        for face in FACES:
            key = tuple(sorted(brick[i] for i in face))
            count[key] = count.get(key, 0) + 1
    slave = []  # faces on the top and on the mantle, as in billet's scene
    for number_, brick in enumerate(bricks):
        for side, face in enumerate(FACES):
            corners = [brick[i] for i in face]
            outer = count[tuple(sorted(corners))] == 1
            if outer and not any(all(nodes[c][axis] < 1e-6 for c in corners) for axis in range(3)):
                slave.append(f"{number_ + 1}, S{side + 1}")

    def node_set(name, members):
        lines = [", ".join(str(m + 1) for m in members[i:i + 12]) for i in range(0, len(members), 12)]
        return [f"*NSET, NSET={name}"] + lines

    first, wide, high = len(nodes), 40.0, 55.0
    die = [(x, y, z) for z in (15.0, high) for x, y in ((-5.0, -5.0), (wide, -5.0), (wide, wide), (-5.0, wide))]
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i + 1}, {x:.6f}, {y:.6f}, {z:.6f}" for i, (x, y, z) in enumerate(nodes + die)]
    lines += [f"*ELEMENT, TYPE={element}, ELSET=BILLET"]
    lines += [", ".join(str(v) for v in [i + 1] + [c + 1 for c in brick]) for i, brick in enumerate(bricks)]
    lines += ["*ELEMENT, TYPE=C3D8, ELSET=DIE",
              ", ".join(str(v) for v in [len(bricks) + 1] + [first + 1 + i for i in range(8)])]
    for axis, name in enumerate("XYZ"):
        lines += node_set(name + "0", [i for i, node in enumerate(nodes) if node[axis] < 1e-6])
    lines += node_set("DIENODES", [first + i for i in range(8)])
    lines += ["*SURFACE, NAME=SLAVE"] + slave + ["*SURFACE, NAME=MASTER", f"{len(bricks) + 1}, S1"]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "200e3, 0.3", "*PLASTIC", "700, 0", "2200, 5",
              "*SOLID SECTION, ELSET=BILLET, MATERIAL=STEEL",
              "*MATERIAL, NAME=TOOL", "*ELASTIC", "200e3, 0.3", "*SOLID SECTION, ELSET=DIE, MATERIAL=TOOL",
              "*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{PENALTY}"]
    lines += ["*FRICTION", f"{friction}, {PENALTY}"] if friction else []
    lines += [f"*CONTACT PAIR, INTERACTION=TOUCH, TYPE={contact}", "SLAVE, MASTER",
              "*BOUNDARY", "X0, 1, 1", "Y0, 2, 2", "Z0, 3, 3", "DIENODES, 1, 2",
              "*STEP, NLGEOM, INC=10000", "*STATIC", f"{increment}, 1, 1e-6, {increment}",
              "*BOUNDARY", "DIENODES, 3, 3, -9.6",
              "*NODE PRINT, NSET=DIENODES, TOTALS=ONLY", "RF", "*END STEP"]
    path.write_text("\n".join(lines) + "\n")


class CcxRun:
    """A run of CalculiX: `seconds`, `megabytes`, `iterations` (with those of cut increments), `steps`, `cuts`, `converged`,
    `times` and `forces` (on the whole billet, in kN, from time 0 on), as a run of billet has them."""

    def __init__(self, nodes, bricks, element, contact, friction=0.1, increment=0.02):
        with tempfile.TemporaryDirectory() as folder:
            write_deck(Path(folder, "deck.inp"), nodes, bricks, element, contact, friction, increment)
            job = CcxJob(folder, 1.0)
            forces = re.findall(r"total force.*?time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)",
                                Path(folder, "deck.dat").read_text(), re.S)
        self.seconds, self.megabytes, self.iterations, self.cuts = job.seconds, job.megabytes, job.iterations, job.cuts
        self.steps = len(forces)
        self.times = [0.0] + [float(time) for time, _, _, _ in forces]
        self.forces = [0.0] + [-4e-3 * float(force) for _, _, _, force in forces]
        self.converged = not job.failure
        print(f"[ccx {element} {contact}, {len(bricks)} bricks] {self.iterations} iterations, {self.seconds:.3g} s",
              file=sys.stderr, flush=True)


NODES, FACES_CONTACT = "NODE TO SURFACE", "SURFACE TO SURFACE"
BILLET = {"billet, default": {}, "billet, tolerance 5e-3": {"Solver/Force tolerance": 5e-3,
                                                            "Solver/Energy tolerance": 5e-3},
          "billet, steps of 2 %": fixed_steps(50)}
CCX = {"ccx C3D8R, node to surface": ("C3D8R", NODES), "ccx C3D8R, surface to surface": ("C3D8R", FACES_CONTACT),
       "ccx C3D8R, node to surface, 10 %": ("C3D8R", NODES, 0.1, 0.1),
       "ccx C3D8, node to surface, 10 %": ("C3D8", NODES, 0.1, 0.1),
       "ccx C3D8, node to surface": ("C3D8", NODES), "ccx C3D8I, node to surface": ("C3D8I", NODES)}

rows = []
for level in (1,) if options.quick else (1, 2, 3) if options.large else (1, 2):
    grid = read_mesh(level)
    entries = {**BILLET, **CCX}
    if level == 3:  # ccx takes minutes
        entries = {name: entry for name, entry in entries.items() if "C3D8," not in name and "C3D8I" not in name}
    runs = {name: [] for name in entries}
    for _ in range(1 if level == 3 else REPEAT):
        for name, entry in entries.items():
            if "C3D8I" in name and level > 1 and runs[name]:  # half a minute, for an answer of no use
                continue
            runs[name].append(CcxRun(*grid, *entry) if name in CCX else Run({**mesh(level), **entry}))
    for name, repeated in runs.items():
        run = repeated[0]
        rows.append([n_elements(level), name, run.steps, run.cuts, run.iterations,
                     number(statistics.median(r.seconds for r in repeated), 3),
                     number(statistics.median(r.seconds for r in repeated) / run.iterations, 2),
                     number(round(run.megabytes)),
                     number(interpolate(run.times, run.forces, 0.8), 4),
                     number(run.forces[-1], 4) if run.converged else f"stops at {run.times[-1]:.2g}"])

def ends(run):
    """At 60 and at 64 % reduction."""
    return " / ".join(f"{interpolate(run.times, run.forces, time):.2f}" for time in (0.9375, 1.0))


STEPS = (48, 192, 768)  # of which one ends at 60 %
grid = read_mesh(1)
frictionless = [["billet"] + [ends(Run({**fixed_steps(n), PAIR + "Friction coefficient": 0})) for n in STEPS]]
for name in ("ccx C3D8R, node to surface", "ccx C3D8R, surface to surface"):
    frictionless += [[name] + [ends(CcxRun(*grid, *CCX[name], friction=0, increment=1.0 / n)) for n in STEPS]]
exact = " / ".join(f"{frictionless_force(time, PENALTY):.2f}" for time in (0.9375, 1.0))
frictionless += [["closed form"] + [exact] * len(STEPS)]

before = children_seconds()
subprocess.run([PROGRAM, "--version"], stdout=subprocess.DEVNULL, check=True)
start = children_seconds() - before
version = re.search(r"Version (\S+)", subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout)

publish(
    "billet-ccx", "The billet in billet and in CalculiX", options,
    "Upsetting by 64 %, µ = 0.1, penalties 3.5e5 N/mm³, the same nodes and bricks; CalculiX "
    f"{version.group(1)} with its own direct solver (SPOOLES), increments of 2 % of the travel at most, or of 10 % where it is said, as billet may take them by default; its default "
    "tolerances (0.5 % of the force). "
    f"Alternately on one core without other threads: CPU seconds (user and system) are the median of {REPEAT} runs"
    f"{'' if options.quick else ' (one of C3D8I on 480 bricks)'}"
    f"{' (one each on 3840 bricks)' if options.large else ''}. "
    f"{start:.2g} of billet's seconds are its start: MPI and the loading of libraries. Iterations count those of cut "
    "steps. Forces on the whole billet in kN, at 80 % and at the end of the travel.",
    table(["bricks", "program", "steps", "cuts", "iterations", "CPU seconds", "for each iteration", "peak memory [MB]", "force at 80 %", "force at the end"],
          rows),
    "C3D8R: one point and hourglass control; C3D8: full integration, which locks; C3D8I: incompatible modes, which "
    "collapse. In both programs the force depends on the step with friction (see "
    "[billet-work-precision](billet-work-precision.md)), in CalculiX also without:",
    "## Without friction\n\nForces in kN at 60 / 64 % reduction with so many steps, 60 bricks, each run once; the "
    "closed form is that of yield in Kirchhoff stress, the penalty's penetration taken into account.",
    table(["program"] + [f"{n} steps" for n in STEPS], frictionless))
