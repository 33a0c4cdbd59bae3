#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: refinement.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

Runs of refined.prm, refined_impact.prm, refined_stack.prm and other scenes whose meshes become finer on the
way. They are judged by runs on meshes that are fine from the start, by fields that a finer mesh must carry
over exactly, and by each other on other numbers of ranks and after restarts.
"""

from __future__ import annotations

import functools
import re
import sys
from glob import glob

from checks import (
    HERE,
    Checks,
    Program,
    Run,
    Runner,
    enter_folder,
    near,
    read_text,
    require,
    run,
    says,
    write_text,
)
from edits import edit
from shipped import history

BLOCK, IMPACT, STACK = (
    read_text(HERE / f"{name}.prm") for name in ("refined", "refined_impact", "refined_stack")
)
program = Program(sys.argv[1:])
runner = Runner(program)
check = Checks()
enter_folder()

HALF = "block: + set Refinement times = 0.5"
FINE = "Bodies / block / Mesh: Refinements = 1"
ROUGH = "top on die: + set Friction coefficient = 0.3"
LAYERS = ("mean dilatation", "assumed strain", "one point")


@functools.cache
def runs(base: str, edits: str, ranks: int = 1) -> Run:
    """Returns a run that must succeed; what several checks look at is run once."""
    result = runner.run(base, edits, ranks=ranks)
    require(result.ended.code == 0, f"exit code {result.ended.code}: {result.complained}{result.said[-500:]}")
    return result


def combined(*edits: str) -> str:
    """Returns all edits as one."""
    return " & ".join(text for text in edits if text)


def worst(a: Run, b: Run, column: str) -> float:
    """Returns the largest difference of a column, relative to its largest number."""
    x, y = a.column(column), b.column(column)
    require(len(x) == len(y), f"{len(x)} rows, not {len(y)}")
    return max(abs(p - q) for p, q in zip(x, y)) / max(1e-300, *(abs(p) for p in x))


def note(result: Run) -> re.Match[str]:
    """Returns the message about the refinement: its energy."""
    return says(r"Each element is divided into eight: .*?The energy changes by (\S+)", result.said)


# --- fields that a finer mesh has, too ------------------------------------------------------------

STATIC = ("die.force_z", "elastic_energy", "plastic_work", "external_work")
for element in LAYERS:

    @check(f"uniform upsetting, {element}")
    def _() -> None:
        shape = f"block: + set Element = {element}"
        coarse, refined = runs(BLOCK, shape), runs(BLOCK, combined(shape, HALF))
        for column in STATIC:
            difference = worst(coarse, refined, column)
            require(difference < 1e-8, f"{column} differs by {difference}")
        note(refined)
        says("4 elements become 32", refined.said)


@check("uniform upsetting, refined twice")
def _() -> None:
    coarse = runs(BLOCK, "block: + set Element = assumed strain")
    refined = runs(BLOCK, "block: + set Element = assumed strain\nset Refinement times = 0.3, 0.7")
    for column in STATIC:
        difference = worst(coarse, refined, column)
        require(difference < 1e-8, f"{column} differs by {difference}")
    says("32 elements become 256", refined.said)


# --- against the mesh that is fine from the start -------------------------------------------------


# Bent, a single row of elements is much too stiff.
BENT = (
    "Tools / die: delete & Contact pairs / top on die: delete & block: Symmetry planes = y = 0"
    " & Mesh: Arguments = 6, 1, 2 : 0, 0, 0 : 6, 1, 1 : true & block: + subsection Supports\\n"
    " subsection clamp\\n set Boundary ids = 0\\n end\\n"
    " subsection end\\n set Boundary ids = 1\\n set Components = z\\n"
    " set Displacement = 0 ; 0 ; -1.5*t\\n end\\nend"
)
for element in ("mean dilatation", "assumed strain"):

    @check(f"a bent beam, {element}: as on the fine mesh")
    def _() -> None:
        shape = combined(BENT, f"block: + set Element = {element}")
        coarse, refined, fine = (runs(BLOCK, combined(shape, edits)) for edits in ("", HALF, FINE))
        force, work = "block.support end.force_z", "plastic_work"
        for column, wrong, right in ((force, 0.15, 0.005), (work, 0.1, 0.1)):
            target = fine.last(column)
            before, after = (abs(of.last(column) / target - 1) for of in (coarse, refined))
            require(before > wrong, f"{column}: the coarse mesh is as good: {before}")
            require(after < right, f"{column}: error {after}, of the coarse mesh {before}")
        drift = abs(refined.last("energy_drift")) / refined.last("external_work")
        require(drift < 0.02, f"drift {drift}")


@check("a rough die: the run continues")
def _() -> None:
    coarse, refined, fine = (runs(BLOCK, combined(ROUGH, edits)) for edits in ("", HALF, FINE))
    for axis in "xy":
        target = fine.last(f"die.force_{axis}")
        before, after = (abs(of.last(f"die.force_{axis}") / target - 1) for of in (coarse, refined))
        require(after < 0.4 * before, f"friction along {axis}: error {after}, of the coarse mesh {before}")


IMPACTS = {
    "assumed strain": "",
    "one point": "block: + set Element = one point",
    "mean dilatation": "block: + set Element = mean dilatation",
    "hypoelastic": "Material: + set Elasticity = hypoelastic",
    "elastic": "Material: - Yield stress & Material: - Hardening modulus",
    "float": "+ subsection Explicit dynamics\\n set Number type = float\\nend",
    "implicit": "Time stepping: Scheme = implicit dynamics & Time stepping: End time = 3.5e-6",
}
MOTION = ("wall.force_z", "kinetic_energy", "plastic_work", "momentum_z")
EARLY = "block: + set Refinement times = 1e-6"
for name, shape in IMPACTS.items():

    @check(f"an impact that is refined before contact, {name}")
    def _() -> None:
        refined = runs(IMPACT, combined(shape, EARLY))
        fine = runs(IMPACT, combined(shape, FINE, "Time stepping: + set Stops = 1e-6"))
        for column in MOTION:
            near(column, refined.last(column), fine.last(column), 1e-6 if name == "float" else 1e-7)
        require(abs(float(note(refined)[1])) < 1e-9 * refined.column("kinetic_energy")[0], "energy is made")


for body in ("upper", "lower", "both"):

    @check(f"friction sticks while a mesh is refined: {body}")
    def _() -> None:
        bodies = ("upper", "lower") if body == "both" else (body,)
        coarse = runs(STACK, "")
        refined = runs(STACK, combined(*(f"{name}: + set Refinement times = 0.5" for name in bodies)))
        fine = runs(STACK, combined(*(f"Bodies / {name} / Mesh: + set Refinements = 1" for name in bodies)))
        force = "upper.support ram.force_x"
        before, after = (abs(of.last(force) / fine.last(force) - 1) for of in (coarse, refined))
        require(after < 0.015 and after < before, f"error {after}, of the coarse mesh {before}")
        require(refined.last("friction_dissipation") < 1e-12, "it slips")


PLANED = str(HERE.parents[1] / "examples/settings/refined.prm")


@check("nodes on planed facets of a body stay in contact while their mesh is refined")
def _() -> None:
    ended = run(*program.on(1, PLANED, "--output", "planed"))
    require(ended.code == 0, ended.errors)
    # Nodes that lose contact leave their forces without balance, which a later part of the run makes up for.
    told = says(r"^note\[mesh-refined\]: .*Each element is divided into eight.*", ended.output)[0]
    require("nbalanced forces" not in told, told)
    change = float(says(r"The energy changes by (\S+)", told)[1])
    last = history("planed")[-1]
    require(abs(change) < 1e-9 * last["external_work"], f"the refinement makes {change}")
    fine = ("--set", "Bodies/upper/Refinement times=", "--set", "Bodies/upper/Mesh/Refinements=1")
    ended = run(*program.on(1, PLANED, "--output", "planed_fine", *fine))
    require(ended.code == 0, ended.errors)
    head = "upper.support head.force_z"
    near("force", last[head], history("planed_fine")[-1][head], 1e-3)


@check("so they do while the mesh of the facets is refined")
def _() -> None:
    of_upper = ("--set", "Bodies/upper/Refinement times=")
    late, early = (
        (*of_upper, "--set", f"Bodies/lower/{change}")
        for change in ("Refinement times=0.5", "Mesh/Refinements=1")
    )
    forces = []
    for name, changes in (("facets", late), ("facets_fine", early)):
        ended = run(*program.on(1, PLANED, "--output", name, *changes))
        require(ended.code == 0, ended.errors)
        forces.append(history(name)[-1]["upper.support head.force_z"])
    near("force", forces[0], forces[1], 1e-3)


@check("an impact that is refined in contact")
def _() -> None:
    refined = runs(IMPACT, "block: + set Refinement times = 4e-6")
    fine = runs(IMPACT, FINE)
    energy = refined.column("kinetic_energy")[0]
    require(abs(float(note(refined)[1])) < 0.15 * energy, f"energy: {note(refined)[1]} of {energy}")
    near("plastic work", refined.last("plastic_work"), fine.last("plastic_work"), 0.15)


@check("two refinements at once in an impact, each with its energy")
def _() -> None:
    refined = runs(IMPACT, "block: + set Refinement times = 5e-6, 5.0000000001e-6")
    first, second = (float(found) for found in re.findall(r"The energy changes by (\S+)", refined.said))
    energy = refined.column("kinetic_energy")[0]
    require(0.1 * energy < first < 0.2 * energy, f"the first makes {first} of {energy}")
    require(abs(second) < 0.02 * energy, f"the second makes {second} of {energy}")
    drift = abs(refined.last("energy_drift"))
    require(drift < 0.05 * energy, f"drift {drift} of {energy}")


# --- ranks and restarts ---------------------------------------------------------------------------

if program.launcher:
    for name, base, edits in (("block", BLOCK, combined(ROUGH, HALF)), ("impact", IMPACT, EARLY)):

        @check(f"{name} on two ranks")
        def _() -> None:
            one, two = (runs(base, edits, ranks) for ranks in (1, 2))
            for column in STATIC if base is BLOCK else MOTION:
                near(column, two.last(column), one.last(column), 1e-6)


def resume(base: str, edits: str, checkpoint: str, folder: str, ranks: int = 1) -> Run:
    """Returns a run that resumes from a checkpoint and writes into this folder."""
    write_text("resumed.prm", edit(base, f"Output: Folder = {folder} & {edits}").text)
    ended = run(*program.on(ranks, "--restart", checkpoint, "resumed.prm"))
    return Run(folder, ended)


EVERY = "Output: + subsection Checkpoint\\n set Step interval = 1\\n set Keep = 100\\nend"
OFTEN = EVERY.replace("Step interval = 1", "Interval = 0.5e-6")
# A slow elastic impact, refined when most of its energy is elastic.
ELASTIC = combined(
    "block: Initial velocity = 0 ; 0 ; -2e3",
    "block / Mesh: Arguments = 2, 2, 2 : 0, 0, 0.0005 : 1, 1, 1.0005 : true",
    "block: + set Refinement times = 5e-7",
    "Time stepping: End time = 1e-6",
)
for name, base, edits, at in (
    ("block", BLOCK, combined(ROUGH, HALF, EVERY), 4),
    ("impact", IMPACT, combined(EARLY, OFTEN, "Time stepping: End time = 4e-6"), 1),
    ("elastic impact", IMPACT, combined(ELASTIC, OFTEN.replace("0.5e-6", "1e-7")), 4),
):

    @check(f"{name} resumes bitwise before, at and after the refinement")
    def _() -> None:
        whole = runs(base, edits)
        history = whole.text("history.csv")
        checkpoints = sorted(glob(f"{whole.folder}/checkpoint_*.h5"))
        for checkpoint in (checkpoints[at - 1], checkpoints[at], checkpoints[at + 1], checkpoints[-2]):
            resumed = resume(base, edits, checkpoint, whole.folder)
            require(resumed.ended.code == 0, resumed.complained)
            require(resumed.text("history.csv") == history, f"another history from {checkpoint}")


@check("a restart may refine at once, but not join elements")
def _() -> None:
    coarse = runs(BLOCK, EVERY)
    resumed = resume(
        BLOCK, "block: + set Refinement times = 0.35", f"{coarse.folder}/checkpoint_00005.h5", "once"
    )
    require(resumed.ended.code == 0, resumed.complained)
    says("4 elements become 32", resumed.said)
    fine = runs(BLOCK, combined(HALF, EVERY))
    refused = resume(BLOCK, "", f"{fine.folder}/checkpoint_00008.h5", "never")
    require(refused.ended.code == 2, f"exit code {refused.ended.code}")
    says("the elements of its body 'block' have been divided 1 times", refused.complained)


QUICKLY = {
    "Bodies/strip/Refinement times": "3e-4",
    "Tools/punch/Motion/Translation": "0 ; 0 ; -3e3*t",
    "Time stepping/End time": "1e-3",
}


@check("finer elements on a curved tool, whose new nodes would lie inside it")
def _() -> None:
    early = ("--set", "Bodies/strip/Refinement times=0.1")
    ended = run(*program.on(1, "refined_on_cylinder.prm", "--output", "refined", *early))
    require(ended.code == 0, ended.output + ended.errors)
    last = history("refined")[-1]
    # of a mesh fine from the start; the coarse one is off by 3.6e-2 and 3.2e-2
    near("force", last["punch.force_z"], -10.910, 3.6e-3)
    near("plastic work", last["plastic_work"], 24.674, 1.06e-2)
    drift = abs(last["energy_drift"]) / last["external_work"]
    require(drift < 1e-3, f"energy drift of {drift}")


PRESS = "refined_press.prm"
STORED = ("--set", "Output/Checkpoint/Interval=1e-4", "--set", "Output/Checkpoint/Keep=50")


@check("so in an explicit press")
def _() -> None:
    ended = run(*program.on(1, PRESS, "--output", "moving", *STORED))
    require(ended.code == 0, ended.errors)
    last = history("moving")[-1]
    energy = float(says(r"The energy changes by (\S+)", ended.output)[1])
    require(abs(energy) < 0.03 * last["external_work"], f"the refinement makes {energy}")
    near("force", last["punch.force_z"], -297.3, 4e-3)  # of a mesh fine from the start; coarse: 8e-3
    drift = abs(last["energy_drift"]) / last["external_work"]
    require(drift < 1e-3, f"energy drift of {drift}")


@check("at the first touch, when springs gain most of their energy within a step")
def _() -> None:
    at_once = ("--set", "Bodies/block/Refinement times=1e-7", "--set", "Time stepping/End time=1.01e-7")
    ended = run(*program.on(1, "refined_press.prm", "--output", "touch", *at_once))
    require(ended.code == 0, ended.errors)
    energy = float(says(r"The energy changes by (\S+)", ended.output)[1])
    work = history("touch")[-1]["external_work"]
    require(abs(energy) < 0.5 * work, f"the refinement makes {energy} of {work}")


FINE_FORCE = -297.8  # static, of a mesh fine from the start
NEVER = ("--set", "Bodies/block/Refinement times=")
STATIC_PRESS = ("--set", "Time stepping/Scheme=static")


@check("depths have faded at the end of a static press, however late its refinement")
def _() -> None:
    for time in ("6e-4", "9.7e-4"):
        late = ("--set", f"Bodies/block/Refinement times={time}")
        ended = run(*program.on(1, PRESS, "--output", f"late_{time}", *STATIC_PRESS, *late))
        require(ended.code == 0, ended.errors)
        near("force", history(f"late_{time}")[-1]["punch.force_z"], FINE_FORCE, 4e-3)  # coarse: 6e-3


@check("a press goes on in the other scheme after its refinement")
def _() -> None:
    ended = run(*program.on(1, PRESS, "--output", "resting", *STORED, *STATIC_PRESS))
    require(ended.code == 0, ended.errors)
    for name, second in (("moving", STATIC_PRESS), ("resting", ())):
        checkpoint = sorted(glob(f"{name}/checkpoint_*.h5"))[6]
        ended = run(*program.on(1, PRESS, "--restart", checkpoint, "--output", f"after_{name}", *second))
        require(ended.code == 0, ended.errors)
        rows = history(f"after_{name}")
        first_row = next(row for row in rows if row["punch.force_z"] != 0)
        before = [row for row in history(name) if row["time"] <= first_row["time"] * (1 + 1e-9)][-1]
        near(f"force of {name}, then the other", first_row["punch.force_z"], before["punch.force_z"], 0.1)
        # A body that starts at rest in explicit steps vibrates about the static force, whose curve has the
        # slope 1.4e3 of its end value.
        late = [row for row in rows if row["time"] > (9.99e-4 if second else 9.5e-4)]
        force, time = (sum(row[key] for row in late) / len(late) for key in ("punch.force_z", "time"))
        near("force at the end", force, FINE_FORCE * (1 + 1.4e3 * (time - 1e-3)), 0.03)


@check("finer elements at once after a change of scheme have the energy that they have in statics")
def _() -> None:
    stored = ("--set", "Output/Checkpoint/Interval=1e-4", "--set", "Time stepping/End time=3e-4")
    ended = run(*program.on(1, PRESS, "--output", "whole", *stored, *STATIC_PRESS, *NEVER))
    require(ended.code == 0, ended.errors)
    checkpoint, energies = sorted(glob("whole/checkpoint_*.h5"))[0], []
    for scheme in (STATIC_PRESS, ()):
        settings = ("--set", "Bodies/block/Refinement times=5e-5", "--set", "Time stepping/End time=2.2e-4")
        ended = run(*program.on(1, PRESS, "--restart", checkpoint, "--output", "on", *settings, *scheme))
        require(ended.code == 0, ended.errors)
        energies.append(float(says(r"The energy changes by (\S+)", ended.output)[1]))
    near("energy", energies[1], energies[0], 0.05)


for scheme in ("static", "explicit"):

    @check(f"finer elements that resist bending are refused, {scheme}")
    def _() -> None:
        changes = {"Time stepping/Scheme": scheme, **(QUICKLY if scheme == "explicit" else {})}
        settings = [part for path, value in changes.items() for part in ("--set", f"{path}={value}")]
        ended = run(*program.on(1, "refined_on_cylinder.prm", "--output", f"on_{scheme}", *settings))
        require(ended.code == 3, f"exit code {ended.code}")
        says("The energy would change by ", ended.errors)


@check("so are those that would penetrate a curved body in one pass, but not in two")
def _() -> None:
    early = ("--set", "Bodies/block/Refinement times=2e-4")
    scene = ("refined_on_body.prm", "--output", "on_body", *early)
    ended = run(*program.on(1, *scene))
    require(ended.code == 3, f"exit code {ended.code}")
    says("Contact springs would gain an energy of .* 'Passes = two', or finer elements", ended.errors)
    until = ("--set", "Time stepping/End time=2.5e-4")  # soon after the refinement
    ended = run(*program.on(1, *scene, "--set", "Contact pairs/top/Passes=two", *until))
    require(ended.code == 0, ended.errors)


# --- what users see -------------------------------------------------------------------------------


@check("--check counts the elements")
def _() -> None:
    write_text("checked.prm", edit(BLOCK, "block: + set Refinement times = 0.5, 0.8").text)
    ended = run(*program.on(1, "--check", "checked.prm"))
    says("block: 4 hexahedra, 32 from time 0.5, 256 from time 0.8", ended.output)


for form, index in (("vtu", "scene.pvd"), ("hdf5", "fields.xdmf")):

    @check(f"field output as {form} has both meshes")
    def _() -> None:
        result = runs(BLOCK, combined(HALF, f"Output: Format = {form}"))
        text = result.text(index)
        if form == "vtu":
            require(len(result.pictured().split()) == 11, text)
            sizes = [
                int(says(r'NumberOfCells="(\d+)"', result.text(f"fields_{n:05}.0.vtu"))[1]) for n in (5, 6)
            ]
            require(sizes == [4, 32], f"{sizes} elements")
        else:
            require(len(re.findall('NumberOfElements="4"', text)) > 0, "no coarse mesh")
            require(len(re.findall('NumberOfElements="32"', text)) > 0, "no fine mesh")


sys.exit(check.finish())
