#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: newcomers.py BILLET

Runs, in an empty current folder, the scenes by first-time users in newcomers/, and compares them with
balances and closed forms. Repeats what stopped these users: each of these traps must have its message.
newcomers/notes.md has the story.
"""

from __future__ import annotations

import math
import sys

import checks
from checks import HERE, Checks, Program, Run, Runner, near, read_text, require, says, write_text
from checks import run as run_command
from edits import edit

checks.TIME_LIMIT = max(checks.TIME_LIMIT, 300)  # one rank waits for no other; busy machines are slow
check, program = Checks(), Program(sys.argv[1:])
runner = Runner(program)

ENERGIES = (
    "elastic_energy plastic_work contact_energy friction_dissipation viscous_dissipation kinetic_energy"
)


def scene(name: str) -> str:
    """Returns the text of a scene, with a subsection for output, and without fields."""
    text = read_text(HERE / f"newcomers/{name}.prm")
    text = text if "\nsubsection Output\n" in text else text + "subsection Output\nend\n"
    return text + "set Output/Format = none\n"


def completed(name: str, edits: str = "") -> Run:
    """Runs a scene, which must end without warnings."""
    ran = runner.run(scene(name), edits)
    require(ran.ended.code == 0, f"exit code {ran.ended.code}: {ran.complained}")
    says("^Completed in .* without warnings", ran.said)
    return ran


def complaints(name: str, edits: str) -> str:
    """Returns what --check prints of a scene with these edits."""
    write_text("checked.prm", edit(scene(name), edits).text)
    ended = run_command(*program.on(1, "--check", "checked.prm"))
    return ended.output + ended.errors


def energy(ran: Run, row: int) -> float:
    """Returns the sum of the energies in a row of the history."""
    return sum(ran.column(column)[row] for column in ENERGIES.split() if column in ran.history)


def row_at(ran: Run, time: float) -> int:
    """Returns the row of the history at this time."""
    return min(range(len(ran.column("time"))), key=lambda row: abs(ran.column("time")[row] - time))


def impulse(ran: Run, column: str) -> float:
    """Returns the integral of a force over time."""
    times, forces = ran.column("time"), ran.column(column)
    rows = range(1, len(times))
    return sum((times[i] - times[i - 1]) * (forces[i] + forces[i - 1]) / 2 for i in rows)


def work(ran: Run, tool: str, axis: str) -> float:
    """Returns the integral of the force on a tool over its travel, without its removal."""
    forces, travels = ran.column(f"{tool}.force_{axis}"), ran.column(f"{tool}.travel_{axis}")
    last = row_at(ran, 1.0) + 1
    forces, travels = [0.0, *forces[:last]], [0.0, *travels[:last]]
    rows = range(1, len(forces))
    return sum((travels[i] - travels[i - 1]) * (forces[i] + forces[i - 1]) / 2 for i in rows)


# --- the strip ------------------------------------------------------------------------------------

YIELD_STRAINS = (0.0, 0.02, 0.05, 0.1, 0.2, 0.5)
YIELD_STRESSES = (300.0, 350.0, 395.0, 440.0, 490.0, 560.0)
PLANE_MODULUS = 206e3 / (1 - 0.3**2)


def yield_stress(strain: float) -> float:
    """Returns the yield stress of the strip at a plastic strain."""
    for i in range(1, len(YIELD_STRAINS)):
        if strain <= YIELD_STRAINS[i]:
            part = (strain - YIELD_STRAINS[i - 1]) / (YIELD_STRAINS[i] - YIELD_STRAINS[i - 1])
            return YIELD_STRESSES[i - 1] + part * (YIELD_STRESSES[i] - YIELD_STRESSES[i - 1])
    return YIELD_STRESSES[-1]


def bending_moment(radius: float, n: int = 200) -> float:
    """Returns the moment of a strip 1 mm thick, bent to this radius of its middle in plane strain."""
    moment = 0.0
    for i in range(n):
        y = (i + 0.5) / (2 * n)
        strain = math.log1p(y / radius)
        stress = min(PLANE_MODULUS * strain, 2 / math.sqrt(3) * yield_stress(2 / math.sqrt(3) * strain))
        moment += 2 * stress * y / (2 * n)
    return moment


def flange_angle(ran: Run, row: int) -> float:
    """Returns the angle of the flange in radians."""
    ends = [[ran.column(f"flange {end}.position_{axis}")[row] for axis in "xy"] for end in ("inner", "end")]
    return math.atan2(ends[1][1] - ends[0][1], ends[1][0] - ends[0][0])


@check("a bent strip: forces balance, energies add up, the flange springs back")
def _() -> None:
    says(r"^Contact pair +pad on strip:", complaints("bent_strip", ""))
    # The work of the punch is that of straight lines between rows.
    ran = completed("bent_strip", "Time stepping: + set Maximum step = 0.03")
    pressed = row_at(ran, 1.0)
    near("time of full travel", ran.column("time")[pressed], 1.0, 1e-9)
    punch, die, pad, foot = (
        ran.column(f"{name}.force_y")[pressed]
        for name in ("punch", "die", "pad on strip", "pad.support foot")
    )
    near("punch against die and pad", abs(punch), abs(die) + abs(pad), 2e-3)
    near("foot of the pad", abs(foot), abs(pad), 5e-3)
    near("work of the punch", abs(work(ran, "punch", "y")), energy(ran, pressed), 5e-3)
    # Augmentation of the soft penalty of sheets leaves 1.3e-3 of the work, and 9e-5 with steps of 0.005.
    near("external work", ran.column("external_work")[pressed], energy(ran, pressed), 2e-3)
    bent, free = flange_angle(ran, pressed), flange_angle(ran, -1)
    # The straight part of the strip is a tangent of both corners: their radius is 3, that of the middle 3.5.
    corners, radius = (13.0 - 5.7, -3.0 - (1.0 - 5.0 + 3.0)), 3.5  # from the punch's centre to the die's
    angle = math.atan2(corners[1], corners[0]) + math.asin(2 * radius / math.hypot(*corners))
    near("angle under load", bent, angle, 0.025)
    # The moment M of the arc at the punch falls to 0 along the straight part. Both spring back by M / (E' I)
    # per length. The part below the punch, 5.7 long, adds as much at most.
    straight = math.sqrt(math.hypot(*corners) ** 2 - (2 * radius) ** 2)
    per_length = bending_moment(radius) * 12 / PLANE_MODULUS
    least = per_length * (radius * angle + straight / 2)
    most = least + per_length * 5.7
    require(least < bent - free < most, f"springback {bent - free}, by hand from {least} to {most}")


@check("a bent strip: traps")
def _() -> None:
    says(
        "penetration of .* in tool 'punch'.*Check whether the tool's normal points towards the body",
        complaints("bent_strip", "punch / Surfaces / profile: Outside = left"),
    )
    wrong = complaints("bent_strip", "pad / Material: Elasticity = Mooney")
    says(r"'Mooney'; did you mean 'Mooney-Rivlin'\?", wrong)
    without = (
        "hold after forming: delete & punch / Motion: Translation = 0 ; -press ; 0"
        " & strip / Mesh: Arguments = 15, 2 : 0, 0 : 25, 1"
    )
    ran = runner.run(scene("bent_strip"), without)
    require(ran.ended.code == 3, f"exit code {ran.ended.code}")
    says(
        "without tool 'die', tool 'punch', which are removed at this time, body 'strip' has no support",
        ran.complained,
    )


TOO_EXACT = (
    "General contact: Penetration tolerance = 1e-3 & + subsection Solver\\nset Force tolerance = 3e-4"
    "\\nset Maximum iterations = 15\\nend"
    " & + subsection Contact pairs\\nsubsection strip on pad\\nset Body = strip\\nset Second body = pad\\n"
    "set Friction coefficient = 0.1\\nset Penetration tolerance = 1e-3\\nend\\nend"
    " & punch / Motion: Translation = 0 ; -10*press ; 0"
    " & Time stepping: + set Initial step = 0.08\\nset Minimum step = 0.06"
)


@check("a bent strip with tolerances that it cannot meet: the last message names the pairs that chatter")
def _() -> None:
    ran = runner.run(scene("bent_strip"), TOO_EXACT)
    require(ran.ended.code == 3, f"exit code {ran.ended.code}")
    # The last attempt itself fails before any node cycles: the message has the attempts before.
    says(
        r"^error\[solution-failed\]: .* contact pair 'strip on \w+': \d+ nodes keep changing.*"
        r" Try smaller bricks where the tool is curved.* If a body snaps or buckles there",
        ran.complained,
    )
    sharp = (
        f"{TOO_EXACT[: TOO_EXACT.rindex(' + set')]} + set Initial step = 0.04\\nset Minimum step = 0.03"
        " & punch / Surfaces / profile: Corners = 0, 0 ; 8.7, 0 ; 8.7, 25"
        " & die / Surfaces / profile: Corners = 10, -25 ; 10, 0 ; 40, 0"
    )
    says(
        r"^(?!.*fillet.*fillet).* Try a fillet at the sharp edge",
        runner.run(scene("bent_strip"), sharp).complained,
    )


# --- the block ------------------------------------------------------------------------------------

REBOUND = (
    34.2e3  # mm/s, of meshes with four times the elements, penalties of 1 and 10 E/h, one and two passes
)


@check("a block hits a plate: energies and impulses add up, it rebounds as on finer meshes")
def _() -> None:
    ran = completed("block_on_plate")
    for row in range(len(ran.column("time"))):
        near("sum of energies", energy(ran, row), energy(ran, 0), 3e-3)
    momentum = ran.column("block.momentum_z")
    near("impulse of the block", impulse(ran, "block on plate.force_z"), momentum[-1] - momentum[0], 2e-3)
    supports = impulse(ran, "ring.force_z") + impulse(ran, "plate.support rim.force_z")
    momentum = ran.column("momentum_z")
    near("impulse of all supports", supports, momentum[-1] - momentum[0], 5e-3)
    near("rebound", ran.last("block.velocity_z"), REBOUND, 0.01)


UPWARDS = "Bodies / block: Initial velocity = 0, 0, 60e3"
GRAVITY = (
    "subsection Loads\\nsubsection g\\nset Type = acceleration\\nset Acceleration = 0 ; 0 ; -1\\nend\\nend"
)


@check("a block that flies away from the plate: a warning, unless loads may bring it back")
def _() -> None:
    warning = (
        r"^warning\[pair-never-touched\]: The initial velocity \(0, 0, 60000\) brings the body to no other"
    )
    says(warning, complaints("block_on_plate", UPWARDS))
    for edits in ("", f"{UPWARDS} & Bodies / block: + {GRAVITY}"):
        said = complaints("block_on_plate", edits)
        says("^Gap +block on plate", said)
        require("pair-never-touched" not in said, said)


@check("a block hits a plate: traps")
def _() -> None:
    for edits, pattern in (
        (
            "Bodies / plate / Material: - Density",
            "'Density' in .* is '0'; allowed is a number > 0, since the scheme is",
        ),
        (
            "Bodies / block / Material: Density = 2.7e-6 & Bodies / plate / Material: Density = 7.85e-6",
            r"^warning\[implausible-speed\]: .*Check that the units of velocity, density and Young's modulus",
        ),
        (
            "Bodies / block: Initial velocity = 0 ; 0 ; 60e3",
            r"^Gap +block on plate: .*\n +never meets by the prescribed",
        ),
        (
            "General contact: Friction = 0.15",
            "no parameter 'Friction' in .*Friction coefficient",
        ),
        ("profile: Corners = 29, 0 ; 18, 0 : 5 ; 18, -10", "Check whether the tool's normal points towards"),
        (
            "profile: Corners = 18, -10 ; 18, 0 : 15 ; 29, 0",
            "the fillet of radius .* does not fit between the",
        ),
        ("Probes / block: - Body", "allowed is the name of a body, since there are several"),
    ):
        says(pattern, complaints("block_on_plate", edits))


# --- the bushing ----------------------------------------------------------------------------------

WEDGE = math.radians(5.0)


@check("a bushing on a cone: balance, work, the force on the cone, the hoop force")
def _() -> None:
    # Residuals of the default tolerance are as large as what is compared.
    ran = completed("bushing", "+ subsection Solver\\n set Force tolerance = 5e-4\\nend")
    end = row_at(ran, 1.0)  # the punch is about to leave
    punch, base, fit = (
        abs(ran.column(f"{name}.full_circle_force_z")[end]) for name in ("punch", "pin.support base", "fit")
    )
    near("punch against the base", punch, base, 1e-4)
    near("punch against the fit", punch, fit, 3e-3)
    near("external work", ran.column("external_work")[end], energy(ran, end), 2e-3)
    near("work of the punch", work(ran, "punch", "z"), ran.column("external_work")[end], 0.01)
    # Full sliding on a cone: axial over normal force, with the tangent of its half angle
    slope, friction = 0.005, 0.1
    radial = math.hypot(*(ran.column(f"fit.force_{axis}")[end] for axis in "xy"))
    normal = radial / (2 * math.sin(WEDGE / 2)) * 2 * math.pi
    near("axial over normal force", fit / normal, (friction + slope) / (1 - friction * slope), 5e-3)
    # When the punch is gone, the sides of the wedge balance the pressure of the cone.
    radial = math.hypot(*(ran.last(f"fit.force_{axis}") for axis in "xy"))
    for side in ("first side", "second side"):
        hoop = math.hypot(
            *(ran.last(f"ring.symmetry plane {side} of the wedge.force_{axis}") for axis in "xy")
        )
        near("hoop force", hoop, radial / (2 * math.sin(WEDGE / 2)), 2e-3)


@check("a bushing on a cone: traps")
def _() -> None:
    for edits, pattern in (
        (
            "ring: Contact stabilisation = none",
            "'Bodies / ring': the body has no support.*contact only pushes",
        ),
        ("funnel: Outside = left", "Check whether the tool's normal points towards the body"),
        ("pin / Mesh: Primitive = hyper_rectangle", r"allowed is 'hyper_rectangle' with '\[first corner\]"),
        ("pin / Mesh: Wedge angle = 10", "body 'pin' is not the same wedge as body 'ring'"),
        ("ring / Material: Hardening = tabel", r"did you mean 'table'\?"),
    ):
        says(pattern, complaints("bushing", edits))
    # of a scene of two layers in plane strain
    slide = read_text(HERE / "trials/pairs/slide.prm") + "subsection Output\nend\n"
    says(
        "'pad' is not the same layer as body 'block'",
        runner.run(slide, "pad / Mesh: + set Height = 2").complained,
    )
    plane = (
        "face: Shape = plane & face: Point = 0, 0, 32 & face: - Centre & face: - Inner radius"
        " & face: - Radius & punch / Motion: - Removal time & punch / Motion: - Release time"
        " & Time stepping: End time = 0.15"
    )
    ran = runner.run(scene("bushing"), plane)
    require(ran.ended.code == 0, f"exit code {ran.ended.code}: {ran.complained}")
    says(r"^warning\[missing-pair\]: Body 'pin' and tool 'punch' .*'Shape = rectangle' or 'disc'", ran.said)


@check("a note tells of penalties that augmentation makes very stiff, once for a pair")
def _() -> None:
    block = read_text(HERE.parent / "scenes/confined_block.prm") + "subsection Output\nend\n"
    static = "Time stepping: - Scheme & Material: - Density"
    note = r"^note\[penalty-raised\]: Augmentation raises the penalty of the pair to \d{4,} E/h.*\(pair 'top'"
    said = runner.run(block, static).said
    says(note, said)
    require(said.count("Augmentation raises the penalty") == 1, said)
    said = runner.run(block, f"{static} & top: Normal penalty = 10").said
    require("Augmentation raises" not in said, said)


# --- words ----------------------------------------------------------------------------------------

WORDS = (
    "ALLKE ALLPD CAX4 CFN COPEN CPE4 CPRESS ENCASTRE RF S33 `*INITIAL `*MODEL `*AMPLITUDE E/h facet"
    " augmentation"
).split()


@check("the manual has the words that first-time users looked for")
def _() -> None:
    pages = "".join(read_text(HERE.parents[1] / "doc" / page) for page in ("glossary.md", "guide/scenes.md"))
    missing = [word for word in WORDS if word not in pages]
    require(not missing, f"neither the glossary nor the guide has {', '.join(missing)}")
    impact = read_text(HERE.parents[1] / "doc/guide/impact.md")
    require("### Forces are samples" in impact, "the guide does not say that forces are samples")


sys.exit(check.finish())
