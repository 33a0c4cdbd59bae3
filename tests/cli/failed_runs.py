#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: failed_runs.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

Scenes that are at the limits of what billet can run, that it must give up, and that it checks. Each is
block.prm, or impact.prm where they are explicit, with an edit (edits.py).
"""

from __future__ import annotations

import functools
import json
import os
import re
import sys
from typing import NamedTuple, Sequence

from checks import (
    HERE,
    Run,
    differences,
    equal,
    near,
    read_text,
    require,
    rows_of,
    run,
    says,
    snapshot,
    write_text,
)
from edited_runs import BLOCK, IMPACT, FIXED, ELASTIC, program, check, billet
from edits import edit

# --- what is too small, too stiff or too flat -----------------------------------------------------

BALL = read_text(HERE / "files/small_ball.prm")


@check("nodes do not go through a thin tool in implicit dynamics, either")
def _() -> None:
    ran = billet(
        "Time stepping: Scheme = implicit dynamics & block: Initial velocity = 0 ; 0 ; -100",
        base=BALL,
        code=3,
    )
    says(
        r"the step from .* failed .*: nodes of contact pair 'foot' go through tool 'ball', which is 0\.002"
        r" thick:"
        r" .* \(time [\d.e-]+\)\. Try a smaller 'Maximum step', a larger 'Normal penalty', or facets as"
        r" small as the tool\."
        r" Results until",
        ran.complained,
    )


@check("nor where they are hit gently; what a stiff penalty makes of steps is told")
def _() -> None:
    ran = billet("block: Initial velocity = 0 ; 0 ; -0.1 & Time stepping: End time = 0.25", base=BALL)
    says(
        r"^warning\[tool-smaller-than-facets\]: The tool has edges, radii or fins too small for the facets"
        r" .* up to 0\.5 long: .*pair 'foot', tool 'ball'",
        ran.said,
    )
    says(
        r"^warning\[penalty-too-high\]: The penalty, 1e\+05 E/h, makes steps \d+ times shorter than the"
        r" elements"
        r" require \(pair 'foot'",
        billet("foot: Normal penalty = 1e5 & Time stepping: End time = 1e-4", base=BALL).said,
    )


@check("a perfectly plastic body that loads press flat")
def _() -> None:
    load = (
        "subsection Loads\nsubsection push\nset Type = pressure\nset Boundary ids = 5\n"
        "set Pressure = 2500*t\nend\nend\nsubsection Mesh"
    )
    scene = BALL.replace("set Law = elastic", "set Yield stress = 10", 1)
    scene = scene.replace("-0.5, 0.02 : 0.5, 0.5, 1.02", "-0.5, 0 : 0.5, 0.5, 1", 1)
    scene = re.sub(r"set Initial velocity.*\n", "", scene, count=1)
    scene = re.sub(r"set (Shape|Centre|Radius).*\n", "", scene)
    scene = scene.replace("subsection Mesh", load, 1).replace("7e-3", "0.04", 1)
    ran = billet(base=scene, code=3)
    says(
        r"(?:the stable step of the elements falls to [\d.e-]+, from [\d.e-]+ at the start, since one element"
        r" is nearly flat|the energies are off balance by).*Body 'block' yields without hardening, and"
        r" loads act on it\."
        " Above the limit load, plastic flow is unbounded",
        ran.complained,
    )
    ran.require_history()


@check("steps by themselves go with the end time")
def _() -> None:
    scene = read_text(HERE / "files/limit_load.prm")
    short = scene.replace("set Initial step = 0.1", "", 1).replace("10*t", "t", 1)
    long = scene.replace("set Initial step = 0.1", "set End time = 1000", 1).replace("10*t", "1e-3*t", 1)
    short_times, long_times = (billet(base=base).column("time") for base in (short, long))
    near("steps", len(long_times), len(short_times))
    near("first", long_times[0], 10)
    near("first", short_times[0], 0.01)


# --- failed solutions -----------------------------------------------------------------------------

WILD = "ramp: Times = 0, 0.5, 1 & ramp: Values = 0, 0.1, 2.5"
for name, ranks, edits in (
    ("a step that is far too large", 1, FIXED),
    ("a step that is far too large", 2, FIXED),
    (
        "a step that is cut too often",
        1,
        "Time stepping: Minimum step = 0.01 & Output: Step interval = 0",
    ),
):

    @check(f"{name}, on {ranks} ranks")
    def _() -> None:
        ran = billet(f"{edits} & {WILD}", ranks=ranks, code=3)
        last = ran.last("time")
        require(0.5 <= last < 1, f"the last accepted time is {last}")
        times = ran.pictured().split(" ")
        if len(times) > 1:
            near("last picture's time", float(times[-1]), last, 1e-9)
        says(
            r"\Aerror\[solution-failed\]: scene\.prm: the step from time [\d.]+ to [\d.]+ failed"
            r" after \d+ accepted steps and \d+ cuts: ..* Results until time [\d.]+"
            rf" are in '{ran.folder}'\.\n\Z",
            ran.complained,
        )


@check("a die that is nowhere for a moment")
def _() -> None:
    ran = billet(
        f"{FIXED} & Motion: Translation = 0 ; 0 ; if(abs(t - 0.3) < 0.01, 1/0, -0.1*t)",
        code=3,
    )
    near("last time", ran.last("time"), 0.2)
    says("'Translation' in 'Tools / die / Motion': .* at time 0.3", ran.complained)


class Broken(NamedTuple):
    """An explicit scene that must be given up; `overflows` where traps of numbers end it before it is
    found."""

    name: str
    edits: str
    message: str
    n_pictures: int = 2
    overflows: bool = False
    ranks: Sequence[int] = (1,)


BROKEN = [
    Broken(
        "an element that is blown inside out",
        "push: Pressure = if(t > 1e-4, 1e6, 0)",
        r"after \d+ steps element \d+ of body 'block', with its initial centre at"
        r" \(0[\d. ]+\), is inverted at \([-\d.e ]+\) \(time 0\.0001\d*\)\. Try ",
        ranks=(1, 2),
    ),
    Broken(
        "a load without bounds",
        "gravity: Acceleration = 0 ; 0 ; if(t > 1e-4, 1e308, 0)",
        r"after \d+ steps element \d+ of body 'block', with its initial centre at"
        r" \(0[\d. ]+\), is not finite in its coordinates \(time 0\.0001\d*\)\. Check ",
        overflows=True,
    ),
    Broken(
        "a support that is not a number",
        "bottom: Displacement = 0 ; 0 ; 1e-9*sqrt(abs(t - 1.19e-4) - 4e-6)",
        r"at time 0\.0001",
        ranks=(1, 2),
    ),
    Broken(
        "a motion without bounds",
        "block: Initial velocity = 0 ; 0 ; 1e200",
        r"after 0 steps the energies are not finite \(time 0\)\. Check ",
        n_pictures=1,
        overflows=True,
    ),
    Broken(
        "a pressure that is not a number", "push: Pressure = if(t > 1e-4, log(-t), 0)", r"at time 0\.0001"
    ),
    Broken(
        "energies that do not balance",
        "Explicit dynamics: Maximum energy drift = 1e-9",
        r"after \d+ steps the energies are off balance by [-\d.e]+ % .* allowed are 1e-07 %"
        r" \('Maximum energy drift'\) \(time [\d.e-]+\)\. .* Try,? ",
    ),
    Broken(
        "a step too short for the clock",
        "block / Material: Density = 1e-50",
        r"after 0 steps the stable step, [\d.e-]+, is below the resolution of the time \(time 0\)\."
        " .*'Mass scaling step' increases it",
        n_pictures=1,
        overflows=True,
    ),
]
has_traps = os.environ.get("BILLET_FLOATING_POINT_TRAPS", "OFF") == "ON"
for broken in BROKEN:
    for ranks in broken.ranks:
        if has_traps and broken.overflows:
            continue

        @check(f"{broken.name}, on {ranks} ranks")
        def _() -> None:
            ran = billet(f"{broken.edits} & Output: Step interval = 0", base=IMPACT, ranks=ranks, code=3)
            times = ran.pictured()
            says(
                rf"(?s)\Aerror\[(?:solution-failed|energy-drift)\]: scene\.prm.* {broken.message}"
                r".*Results until then are in 'r\d+'\.\n\Z",
                ran.complained,
            )
            record = json.loads(ran.text("diagnostics.jsonl").splitlines()[-2])
            require("time" in record and "Results until" in record["advice"], f"says {record}")
            require(len(times.split(" ")) == broken.n_pictures, f"pictures at {times}")
            ran.require_history()


@functools.cache
def impact() -> Run:
    """Returns the run of the impact as it is."""
    return billet(base=IMPACT)


@check("explicit scenes say how many steps there will be")
def _() -> None:
    ran = impact()
    steps = int(ran.history["step"][-1])
    told = int(says(r"^The run takes about (\d+) steps of [\d.e-]+$", ran.said)[1])
    require(abs(told / steps - 1) < 0.5, f"{told} steps, not {steps}")


@check("and that they are absurdly many")
def _() -> None:
    if has_traps:
        return
    ran = billet(
        "block / Material: Density = 1e-20 & block: Initial velocity = 0 ; 0 ; 1e200",
        base=IMPACT,
        code=3,
    )
    says(r"^warning\[many-steps\]: .*'Mass scaling step' makes steps longer", ran.said)


@check("when output is due changes no step and no result")
def _() -> None:
    often = billet("Output: Interval = 1.3e-5 & Output: History interval = 1.7e-5", base=IMPACT)
    ends = [rows_of(f"{ran.folder}/history.csv")[-1] for ran in (impact(), often)]
    equal("last line of the history", ends[1], ends[0])


@check("times of output that nearly coincide do not shorten the steps between")
def _() -> None:
    steps = [
        int(billet(edits, base=IMPACT).history["step"][-1])
        for edits in (
            "Output: Interval = 1e-4",
            "Output: Interval = 1.0000001e-4",
            "Time stepping: Stops = 1.000001e-4, 2e-4",
        )
    ]
    require(max(steps[1:]) < 1.3 * steps[0], f"{steps} steps")


# A roll is dragged over a block: each step some nodes leave it, and others take over. What friction takes is
# that of steps that are short beside the facets. (One account for each node alone gave less than half of it.)
@check("nodes that hand their load over dissipate with default steps what they do in short ones")
def _() -> None:
    roll = (
        "Mesh: Arguments = 16, 1, 2 : 0, 0, -3 : 6, 1, 0 : true & Mesh: - Boundary ids"
        f" & block: Symmetry planes = y = 0 ; y = 1 & block: + set Element = one point & {ELASTIC}"
        " & floor: - Components & floor: - Displacement & Plane: - Normal & Plane: Point = 2, 0, 3"
        " & Plane: + set Shape = cylinder\nset Axis = 0, 1, 0\nset Radius = 3"
        " & Motion: Translation = 2*max(0,t-1) ; 0 ; -0.1*min(t,1) & top on die: Boundary ids = 5"
        " & top on die: Friction coefficient = 0.2 & top on die: Normal penalty = 40"
        " & Time stepping: End time = 2 & Time stepping: - Initial step & Time stepping: - Maximum step"
    )
    found, expected = (
        billet(edits).last("friction_dissipation")
        for edits in (roll, f"{roll} & Time stepping: + set Maximum step = 0.02")
    )
    near("dissipation", found, expected, 0.03)


# A tool that swings five times, in steps of up to a fifth of the time that this takes.
SWING = (
    "Motion: Translation = 0.2*sin(20*pi*max(0,t-0.2)) ; 0 ; -ramp & ramp: Times = 0, 0.2, 1"
    " & ramp: Values = 0, 0.05, 0.05 & top on die: Friction coefficient = 0.3 & Time stepping: End time = 0.7"
)
SHORT = "Time stepping: Initial step = 0.01 & Time stepping: Maximum step = 0.01"


@check("steps see a tool that swings by whole periods, and one spike")
def _() -> None:
    long = billet(f"{SWING} & Time stepping: Maximum step = 0.1").last("friction_dissipation")
    near("dissipation", long, billet(f"{SWING} & {SHORT}").last("friction_dissipation"), 0.05)
    spike = "Motion: Translation = 0 ; 0 ; -0.1*max(0,1-abs(t-0.54)/0.05)"
    long = billet(f"{spike} & Time stepping: Maximum step = 0.2").last("plastic_work")
    near("plastic work", long, billet(f"{spike} & {SHORT}").last("plastic_work"), 0.03)


@check("a ring that its support turns by whole turns meets friction")
def _() -> None:
    turned = (
        "x*(cos(6*pi*max(0,t-0.2))-1)-y*sin(6*pi*max(0,t-0.2)) ;"
        " x*sin(6*pi*max(0,t-0.2))+y*(cos(6*pi*max(0,t-0.2))-1) ; 0"
    )
    turn = (
        f"floor: - Components & floor: Displacement = {turned} & block: - Symmetry planes & Mesh: Arguments ="
        " 2, 2, 1 : -1, -1, 0 : 1, 1, 2 : true & ramp: Times = 0, 0.2, 2 & ramp: Values = 0, 0.02, 0.02 & top"
        " on die: Friction coefficient = 0.3 & Time stepping: End time = 0.54"
    )
    long = billet(f"{turn} & Time stepping: Maximum step = 0.34").last("die.moment_z")
    near("moment", long, billet(f"{turn} & {SHORT}").last("die.moment_z"), 0.03)


@check("fixed steps that do not see a motion are warned of")
def _() -> None:
    says(
        r"^warning\[unseen-motion\]: tool 'die' reverses, or turns fully, within the step",
        billet(f"{SWING} & {FIXED} & Time stepping: Initial step = 0.1").said,
    )


def tool(name: str, surface: str, motion: str) -> str:
    """Returns the lines of a tool."""
    return (
        f"subsection {name}\n subsection Surfaces\n subsection p\n {surface}\n end\n end\n"
        f" subsection Motion\n {motion}\n end\nend"
    )


def pair(partner: str, boundary_id: int) -> str:
    """Returns the lines of the block's contact with a tool."""
    return (
        f"subsection on {partner}\n set Body = block\n set Boundary ids = {boundary_id}\n"
        f" set Tool = {partner}\nend"
    )


# Between bed and die, which both go; a third tool, which may come to touch, does not.
FAR = tool("far", "set Point = 0, 0, 3\n set Normal = 0, 0, -1", "")
LET_GO = (
    "Motion: Removal time = 0.5 & Motion: Release time = 0.2 & floor: delete"
    f" & Tools: + {FAR}\n{tool('bed', '', 'set Removal time = 0.5')}"
    f" & Contact pairs: + {pair('far', 7)}\n{pair('bed', 4)}"
)


@check("a body that removed tools leave free, on 2 ranks")
def _() -> None:
    ran = billet(f"{LET_GO} & Output: Step interval = 0", ranks=2, code=3)
    message = (
        "error[solution-failed]: scene.prm: without tool 'bed', tool 'die', which are"
        " removed at this time, body 'block' has no support: neither supports, nor symmetry planes, nor"
        " tools in contact constrain its rigid-body mode with translation (0, 0, 1) and"
        " rotation (0, 0, 0) (time 0.5)."
        " Add a support or a symmetry plane, or keep a tool. Results until"
        f" then are in '{ran.folder}'.\n"
    )
    # Both directions are free.
    equal("the message", ran.complained.replace("(0, 0, -1)", "(0, 0, 1)", 1), message)
    near("last time", ran.last("time"), 0.5)
    equal("times", ran.pictured(), "0 0.5")


@check("a body that one tool is left to")
def _() -> None:
    ran = billet(
        (
            f"Motion: Removal time = 0.5 & floor: delete & Tools: + {tool('bed', '', '')}"
            f" & Contact pairs: + {pair('bed', 4)}"
        ),
        code=3,
    )
    # The bed pushes, but does not pull.
    says(
        r"without tool 'die', which is removed at this time, body 'block' has no support: .*"
        r" translation \(0, 0, 1\)",
        ran.complained,
    )


@check("a body that its supports hold when the tool goes")
def _() -> None:
    billet("Motion: Removal time = 0.5 & Motion: Release time = 0.2")


# --- --check --------------------------------------------------------------------------------------


def checked(edits: str, ranks: int = 1) -> str:
    """Returns what --check prints of a scene that it passes."""
    write_text("scene.prm", edit(BLOCK, edits).text)
    ended = run(*program.on(ranks, "--check", "scene.prm"))
    equal("exit code", f"{ended.code} {ended.errors}", "0 ")
    return ended.output


@check("--check of half a billion elements, which do not fit in memory")
def _() -> None:
    write_text("scene.prm", edit(BLOCK, "Mesh: Refinements = 9").text)
    before = snapshot()
    ended = run(*program.on(1, "--check", "scene.prm"))
    equal("exit code", f"{ended.code} {ended.errors}", "0 ")
    equal("files written", " ".join(differences(before, snapshot())), "")
    says("block: 536870912 hexahedra", ended.output)


@check("--check tells sizes of bodies and boundaries, gaps, when they close, and what the run will be like")
def _() -> None:
    output = checked("Plane: Point = 0, 0, 2.05")
    for line in (
        r"Geometry       block: x 0 to 2, y 0 to 1, z 0 to 2; volume 4, no mass without 'Density'",
        r"               4 elements, 18 nodes, 1 part; edges 1 to 1, mean 1; least scaled Jacobian 1, at ",
        r"Boundary       block 7: 2 faces, area 2, centre \(1, 0\.5, 2\), normal \(0, 0, 1\)$",
        r"Gap            top on die: least 0\.05 at \(0, 0, 2\), mean 0\.05 over 6 of 6 nodes\n"
        r"               6 nodes meet at time 0\.5 by the prescribed motions, first \(0, 0, 2\)$",
        r"Run            54 dofs, about \d+ MB of memory, at least 2 steps$",
    ):
        says(f"^{line}", output)
    says("6 nodes touch at the start, first", checked(""))
    says(
        "^ +never meets by the prescribed motions, which leave a body at rest that others push$",
        checked("Plane: Point = 0, 0, 3"),
    )


@check("--check on two ranks measures the same")
def _() -> None:
    measured = [
        re.findall(
            r"^(?:Title|Geometry|Boundary|Gap| ) .*",
            checked("Plane: Point = 0, 0, 2.05", ranks),
            re.MULTILINE,
        )
        for ranks in (1, 2)
    ]
    require(len(measured[0]) > 4, "there are no lines to compare")
    equal("what two ranks measure", measured[1], measured[0])
    equal("titles", sum(line.startswith("Title") for line in measured[1]), 1)


@check("--check of an explicit scene tells the element that sets the stable step")
def _() -> None:
    write_text("scene.prm", IMPACT)
    ended = run(*program.on(1, "--check", "scene.prm"))
    equal("exit code", ended.code, 0)
    said = says(
        r"^Stable step    (\S+) of the elements, set by that of '\w+' at \(.*\) with its least edge \S+\n"
        r" +first steps (\S+)$",
        ended.output,
    )
    step = float(said[2])
    require(0.0 < step < float(said[1]), f"steps of {step} are not below the stable one")
    steps = float(says(r"^Run .* memory, about (\S+) steps, more if elements shrink$", ended.output)[1])
    end = float(says(r"^Time +0 to (\S+), ", ended.output)[1])
    require(abs(steps - end / step) <= 1.0, f"{steps} steps of {step} do not end at {end}")


@check("--check of an explicit scene tells how to make steps longer that contact makes short")
def _() -> None:
    touching, shorter = str(HERE.parent.parent / "prm/slab_rolling_explicit.prm"), []
    variants: tuple[tuple[str, ...], ...] = ((), ("--set", "Explicit dynamics/Contact resolution=1"))
    for options in variants:
        ended = run(*program.on(1, "--check", touching, *options))
        shorter.append(says(r" first steps ([^\s;,]+)(.*(?:\n .*)*)", ended.output))
    require("'Contact resolution = 1'" in shorter[0][2], shorter[0][0])
    require(float(shorter[1][1]) > 1.5 * float(shorter[0][1]), shorter[1][0])


@check("--check --json tells the same in numbers")
def _() -> None:
    write_text("scene.prm", edit(BLOCK, "Material: + set Density = 0.25").text)
    report = json.loads(run(*program.on(1, "--check", "--json", "scene.prm")).output)["report"]
    body = report["bodies"][0]
    near("volume", body["volume"], 4.0)
    near("mass", body["mass"], 1.0)
    top = next(boundary for boundary in body["boundaries"] if boundary["id"] == 7)
    near("area", top["area"], 2.0)
    equal("pair", report["pairs"][0]["name"], "top on die")
    near("gap", report["pairs"][0]["gap"]["least"] + 1.0, 1.0)
    equal("time", report["pairs"][0]["meeting"]["time"], 0.0)
    equal("dofs", report["run"]["dofs"], 54)


@check("--check tells what a profile sets, and what the scene requires")
def _() -> None:
    output = checked(
        "Profile = accurate & Time stepping: - Maximum step & top on die: Friction coefficient = 0"
        " & Solver: - Contact tangent"
    )
    for line in (
        "Profile        accurate",
        "               Contact pairs / top on die / Penetration tolerance = automatic",
        "Plasticity     yes: history of 1 of 1 bodies",
        "Augmentation   yes: 1 of 1 pairs",
        "Matrix         yes: symmetric; MUMPS, which factorises half, above 10000 unknowns CG with multigrid",
    ):
        require(line in output.splitlines(), f"no line '{line}' in {output}")
    says("^Not modelled   .*\\bFriction, .*\\bSelf-contact, ", output)
    require("allocated" not in output, output)


@check("--print-parameters explains each")
def _() -> None:
    printed = run(*program.on(1, "--print-parameters"))
    equal("exit code", printed.code, 0)
    n_parameters, silent, comment = 0, [], ""
    for line in printed.output.splitlines():
        if match := re.match(r"\s*set (.*?)\s*=", line):
            n_parameters += 1
            if not re.search(r"\w.* \w", comment):
                silent.append(match[1])
            comment = ""
        else:
            match = re.match(r"\s*# (.*)", line)
            comment = comment + match[1] if match else ""
    equal("without explanation", ", ".join(silent), "")
    require(n_parameters > 60, f"only {n_parameters} parameters")


sys.exit(check.finish())
