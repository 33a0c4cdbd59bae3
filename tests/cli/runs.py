#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: runs.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

Scenes that billet must run. Each is block.prm, or impact.prm where they are explicit, with an edit
(edits.py). 'Same' ones must come out as block.prm does, whatever way they say it.
"""

from __future__ import annotations

import bisect
import json
import math
import os
import re
import shutil
import sys
from pathlib import Path
from typing import Callable, Sequence

from checks import HERE, Run, equal, near, read_text, require, rows_of, run, says, write_text
from edited_runs import BLOCK, ELASTIC, FIXED, IMPACT, billet, check, program

CAVITY, STRIP = (read_text(HERE / f"{name}.prm") for name in ("cavity", "held_strip"))
NO_MESH = "Mesh: - Primitive & Mesh: - Arguments & Mesh: - Boundary ids & Mesh: Source = file & Mesh: File = "
NO_LAW = "Material: - Yield stress & Material: - Hardening modulus & Material: Hardening = "

reference = billet()
COLUMNS = (
    "time",
    "die.force_x",
    "die.force_y",
    "die.force_z",
    "die.contact_area",
    "elastic_energy",
    "plastic_work",
    "friction_dissipation",
)


def require_same(ran: Run, other: Run, tolerance: float) -> None:
    """Compares all rows of the history with those of another run."""
    for name in COLUMNS:
        found, expected = ran.column(name), other.column(name)
        require(len(found) == len(expected), f"{len(found)} steps, not {len(expected)}")
        size = max(abs(value) for value in expected)
        for row, (x, y) in enumerate(zip(found, expected)):
            require(abs(x - y) <= tolerance * size + 1e-9, f"{name} in row {row} is {x}, not {y}")


def same(
    name: str,
    edits: str,
    *,
    ranks: int = 1,
    rewrite: Callable[[str], str] | None = None,
    as_run: Run = reference,
    tolerance: float = 1e-6,
) -> None:
    """Checks that a scene comes out as another one."""

    @check(name)
    def _() -> None:
        require_same(billet(edits, ranks=ranks, rewrite=rewrite), as_run, tolerance)


# --- one scene, many ways to say it ---------------------------------------------------------------


@check("the copy is the input")
def _() -> None:
    equal("scene.prm", reference.text("scene.prm"), read_text("scene.prm"))


@check("the copy runs and gives the same")
def _() -> None:
    before, scene = reference.text("history.csv"), reference.text("scene.prm")
    equal("exit code", run(*program.on(1, "--force", f"{reference.folder}/scene.prm")).code, 0)
    equal("history", reference.text("history.csv"), before)
    equal("scene.prm", reference.text("scene.prm"), scene)


@check("a picture of every step")
def _() -> None:
    equal("number of times", len(reference.pictured().split(" ")), 1 + len(reference.history["time"]))


@check("the history is finite")
def _() -> None:
    bad = [
        name
        for name, values in reference.history.items()
        if not all(re.fullmatch(r"[-+.\de]+", value) for value in values)
    ]
    require(not bad, " ".join(bad))


same("3 ranks", "", ranks=3)
same("a mesh file .msh", NO_MESH + "block.msh & block: Symmetry planes = x = 0 ; y = 0")
same(
    "a mesh file with names",
    NO_MESH + "named.msh & floor: Boundary ids = bottom & top on die: Boundary ids = Top",
)
same(
    "a deck of Abaqus with names, on 2 ranks",
    NO_MESH + "named.inp & floor: Boundary ids = bottom & top on die: Boundary ids = top",
    ranks=2,
)
same(
    "names of boundaries by conditions",
    "Mesh: Boundary ids = top : abs(z - 2) < 1e-6 ; bottom : abs(z) < 1e-6"
    " & floor: Boundary ids = bottom & top on die: Boundary ids = top",
)
same("a mesh file .vtk", NO_MESH + "block.vtk")
same("a mesh file .ucd", NO_MESH + "block.ucd")
same(
    "an extruded mesh",
    (
        "Mesh: Source = extruded primitive & Mesh: Arguments = 2, 1 : 0, 0 : 4, 2 : true"
        " & Mesh: Section area = 2 & Mesh: Height = 2 & Mesh: Layers = 2"
    ),
)
same("a scaled mesh", "Mesh: Arguments = 2, 1, 2 : 0, 0, 0 : 4, 2, 4 : true & Mesh: Scale = 0.5")
same(
    "supports for symmetry planes",
    (
        "block: - Symmetry planes & Supports: + subsection left\n set Boundary ids = 0\n set Components ="
        " x\nend\nsubsection front\n set Boundary ids = 2\n set Components = y\nend"
    ),
)
same("a symmetry plane for a support", "block: Symmetry planes = x = 0 ; y = 0 ; z = 0")
same("an expression for an amplitude", "Motion: Translation = 0 ; 0 ; -0.1*t")
same(
    "the die turned over",
    (
        "Plane: Normal = 0, 0, 1 & Motion: Rotation axis = 1, 0, 0 & Motion: Rotation angle = pi"
        " & Motion: Centre = 0, 0, 2"
    ),
)
same(
    "the die as Coons patches",
    "Plane: - Point & Plane: - Normal & Plane: Shape = coons patches & Plane: File = patches.txt",
)
same(
    "the penalty in stress per length",
    "top on die: Penalty unit = absolute & top on die: Normal penalty = 10e3",
)
same("the same tangential penalty", "top on die: Tangential penalty = 10")
same("linear hardening as a table", NO_LAW + "table & Material: Table = 0 : 10, 0.5 : 35, 1 : 60")
same(
    "linear hardening from a file",
    NO_LAW + "table & Material: Table file = hardening.csv",
)
same(
    "an amplitude from a file",
    "ramp: - Times & ramp: - Values & ramp: File = ramp.csv & ramp: File columns = 1, 2",
)
same(
    "linear hardening as a power law",
    NO_LAW + "power law & Material: Strength coefficient = 50 & Material: Prestrain = 0.2"
    " & Material: Hardening exponent = 1",
)
same(
    "linear hardening as Voce's",
    "Material: Hardening = Voce & Material: Saturation stress = 10 & Material: Saturation rate = 3",
)
write_text("title.prm", "set Title = Included\n")
PRESSURE_DEPENDENT = "top on die: Friction law = pressure dependent & top on die: Reference pressure = 5"
same("friction that depends on pressure, with exponent 1", PRESSURE_DEPENDENT)


@check("friction that depends on pressure")
def _() -> None:
    ran = billet(f"{PRESSURE_DEPENDENT} & top on die: Pressure exponent = 0.7")
    require(ran.last("friction_dissipation") > 0, "no friction")


same("an included file", "- Title & + include title.prm")
same("continued lines", "", rewrite=lambda s: s.replace(" : 0, 0, 0 : ", " : \\\n  0, 0, 0 \\  \n : ", 1))
same("line ends of Windows", "", rewrite=lambda s: s.replace("\n", "\r\n"))

# --- solvers --------------------------------------------------------------------------------------

FIXED_SOFT = f"{FIXED} & top on die: Normal penalty = 1"  # soft enough for each
steady = billet(FIXED_SOFT)


@check("fixed steps")
def _() -> None:
    equal("number of steps", len(steady.history["time"]), 10)


for setting, ranks in (
    ("Solver: Linear solver = KLU", 2),
    ("Solver: Linear solver = MUMPS", 1),
    ("Solver: Predictor = tangent", 1),
    ("Solver: Contact tangent = consistent", 1),
    ("Solver: Contact tangent = continuum", 1),
):
    same(setting, f"{FIXED_SOFT} & {setting}", as_run=steady, tolerance=1e-4, ranks=ranks)
same(
    "no line search",
    f"{FIXED_SOFT} & {ELASTIC} & Solver: Line search = none",
    as_run=billet(f"{FIXED_SOFT} & {ELASTIC}"),
    tolerance=1e-4,
)
for part in ("upper", "lower", "mean"):
    same(
        f"symmetrised {part}",
        (
            f"{FIXED_SOFT} & Solver: Contact tangent = symmetrised {part}"
            " & Solver: Linear solver = MUMPS symmetric & Solver: Maximum iterations = 100"
        ),
        as_run=steady,
        tolerance=1e-4,
        ranks=2 if part == "mean" else 1,
    )


@check("a symmetric matrix is seen")
def _() -> None:
    ran = billet(f"{FIXED} & Solver: Contact tangent = consistent & top on die: Friction coefficient = 0")
    says(r"MUMPS \(symmetric\)", ran.said)


# --- profiles and target errors -------------------------------------------------------------------

TOLERANCES = "Solver: - Force tolerance & Solver: - Energy tolerance"
OPEN = f"Time stepping: - Initial step & Time stepping: - Maximum step & {TOLERANCES}"
SMALL_STEPS = f"{FIXED} & Time stepping: Initial step = 0.005"
EXACT = f"{SMALL_STEPS} & top on die: Penetration tolerance = 1e-4"
same("the balanced profile", "Profile = balanced")
for profile, sets in (
    ("fast", r"Time stepping / Maximum step = 0\.1, .*Solver / Linear tolerance = 1e-4"),
    (
        "accurate",
        r"Time stepping / Maximum step = 0\.1, Time stepping / Error tolerance = 1e-3,"
        r" .*Solver / Force tolerance = 1e-8, .*Contact pairs / top on die / Penetration tolerance ="
        r" automatic",
    ),
):

    @check(f"the profile {profile} is told, and what the scene sets stays")
    def _() -> None:
        ran = billet(f"Profile = {profile} & Time stepping: - Maximum step & {TOLERANCES}")
        says(f"^Profile {profile}: .*{sets}", ran.said)
        require("Initial step =" not in ran.said, f"says {ran.said}")
        near("force", ran.force("die"), reference.force("die"), 0.05)


def estimates_of(ran: Run) -> dict[str, str]:
    """Returns what is in error_estimate.csv."""
    return {row[0]: row[1] for row in rows_of(f"{ran.folder}/error_estimate.csv")}


@check("a target error is kept and told on 2 ranks")
def _() -> None:
    ran = billet(f"Target error = 3 percent & {OPEN}", ranks=2)
    exact = billet(EXACT)
    says(
        r"^note\[error-estimate\]: Estimated error [-\d.e]+ % of the forces, target 3 %: steps"
        r" [-\d.e]+ %,"
        r" penetrations [-\d.e]+ %, iterations [-\d.e]+ %; cost: \d+ steps taken, \d+ Newton iterations,"
        r" \d+ of them for estimates, [\d.e-]+ CPU seconds\. ",
        ran.said,
    )
    told = estimates_of(ran)
    error, target = float(told["error"]), float(told["target"])
    require(target == 0.03 and error > 0, f"believes {error} of {target}")
    near("error", error, sum(float(told[part]) for part in ("steps", "penetrations", "iterations")), 1e-4)
    near("force", ran.force("die"), exact.force("die"), 0.03)


@check("a target error that is missed is told")
def _() -> None:
    ran = billet(
        (
            "Target error = 0.01 % & Time stepping: Initial step = 0.5 & Time stepping: Minimum step = 0.5"
            " & Time stepping: Maximum step = 0.5 & top on die: Penetration tolerance = 1e-6"
        ),
        code=7,
    )
    says(
        r"^warning\[target-error-missed\]: .*; most of it is due to steps\. Reduce 'Maximum step'",
        ran.said,
    )


# An amplitude that turns back at 0.7371, with a straight point at 0.3.
TURNING = "ramp: Times = 0, 0.3, 0.7371, 1 & ramp: Values = 0, 0.0407, 0.1, 0.05"


@check("steps end where an amplitude turns, and nowhere else")
def _() -> None:
    for steps in (OPEN, f"Target error = 1 % & {OPEN}", FIXED):
        times = billet(f"{TURNING} & {steps}").column("time")
        require(any(abs(time - 0.7371) < 1e-9 for time in times), f"{steps}: steps end at {times}")
    ran = billet(f"{TURNING} & Time stepping: Initial step = 0.4 & Time stepping: Maximum step = 0.4")
    times = ran.column("time")
    require(not any(abs(time - 0.3) < 1e-3 for time in times), f"steps end at {times}")


# Comparisons of steps would cut the corner, and believe to have found 2 to 4 %.
@check("steps are not compared over a corner")
def _() -> None:
    for corner in (0.44, 0.5, 0.54):
        ran = billet(
            f"ramp: Times = 0, {corner}, 1 & ramp: Values = 0, 0.1, 0.095 & Target error = 1 % & {OPEN}"
            " & top on die: Friction coefficient = 0"
        )
        error = says(r"Estimated error ([-\d.e]+) % of the forces", ran.said)[1]
        require(float(error) < 0.5, f"at {corner} says {ran.said}")


@check("a target error knows of amplitudes that turn")
def _() -> None:
    ran = billet(f"{TURNING} & Target error = 0.5 % & {OPEN}")
    exact = billet(f"{TURNING} & {EXACT}")
    near("plastic work", ran.last("plastic_work"), exact.last("plastic_work"), 0.005)


DRIVEN = "Motion: Translation = 0 ; 0 ; 0 & Motion: Force = 40*t & Motion: Force direction = 0, 0, -1"


@check("of a tool that a force drives the travel is what errors are parts of")
def _() -> None:
    exact = billet(f"{DRIVEN} & {EXACT}")
    for target in (3, 0.5):
        ran = billet(f"{DRIVEN} & Target error = {target} % & {OPEN}")
        told = says(rf"Estimated error ([-\d.e]+) % of the travel of 'die', target {target} %:", ran.said)
        require(float(told[1]) <= target, f"believes {told[1]} %")
        near(f"{target} %: travel", ran.last("die.travel_z"), exact.last("die.travel_z"), target / 100)


def error_at_steps(ran: Run, exact: Run, tools: Sequence[str]) -> float:
    """Returns the error of the forces of the tools by the trapezoidal rule over the steps of the run."""
    times, of = exact.column("time"), [f"{tool}.force_{axis}" for tool in tools for axis in "xyz"]
    errors, forces = [0.0], [0.0]
    for t, *found in zip(ran.column("time"), *(ran.column(name) for name in of)):
        i = min(bisect.bisect(times, t), len(times) - 1)
        part = (t - times[i - 1]) / (times[i] - times[i - 1])
        true = [
            (1 - part) * column[i - 1] + part * column[i] for column in (exact.column(name) for name in of)
        ]
        ends = [range(n, n + 3) for n in range(0, len(of), 3)]
        errors.append(sum(math.dist([found[n] for n in end], [true[n] for n in end]) for end in ends))
        forces.append(sum(math.hypot(*(true[n] for n in end)) for end in ends))
    steps = [b - a for a, b in zip([0.0, *ran.column("time")], ran.column("time"))]
    return sum(h * (a + b) for h, a, b in zip(steps, errors, errors[1:])) / sum(
        h * (a + b) for h, a, b in zip(steps, forces, forces[1:])
    )


# It travels by 1e-3, and the punch by 4: an error of the small travel is none of the forces. Above the strip
# at first, the holder has no contact that could tell what its travel means.
@check("the travel of a holder counts by the work that it does")
def _() -> None:
    ran = billet(base=STRIP)
    told = float(says(r"Estimated error ([-\d.e]+) % of the forces, target 3 %:", ran.said)[1]) / 100
    exact = billet(
        "- Target error & Time stepping: Step control = fixed & Time stepping: Initial step = 0.01",
        base=STRIP,
    )
    error = error_at_steps(ran, exact, ("punch", "die", "holder"))
    require(0.3 < told / error < 3, f"believes {told} where it is {error}")
    apart = billet("face: Centre = 65, 1, 1.5", base=STRIP)
    says(r"Estimated error [-\d.e]+ % of the forces, target 3 %:", apart.said)
    near("force of the punch", apart.force("punch"), exact.force("punch"), 0.01)


@check("penalties alone are measured, too")
def _() -> None:
    exact = billet(f"{SMALL_STEPS} & top on die: Penetration tolerance = 1e-5")
    for penalty in (1, 10):
        ran = billet(
            (
                f"Target error = 0.1 % & {OPEN} & top on die: Penetration tolerance = 0"
                f" & top on die: Normal penalty = {penalty}"
            ),
            code=7,
        )
        error = abs(ran.force("die") / exact.force("die") - 1.0)
        believed = float(estimates_of(ran)["penetrations"])
        require(believed > error / 2, f"believes {believed} at {penalty} E/h where it is {error}")
        says(r"^warning\[target-error-missed\]: ", ran.said)


@check("an explicit target error")
def _() -> None:
    says(
        "Estimated error .* of the energies, target 3 %: steps .* %, penetrations .* %;"
        r" cost: \d+ steps taken, ",
        billet("Target error = 3 %", base=IMPACT).said,
    )


# --- messages -------------------------------------------------------------------------------------

SOFT = "top on die: Normal penalty = 1e-3"


@check("warnings may be errors, and the run is computed to its end all the same")
def _() -> None:
    ran = billet(f"Warnings = errors & {SOFT}", code=6)
    quiet = billet("Warnings = errors")
    near("last time", ran.last("time"), 1)
    says(r"^Completed in \S+ without warnings\.", quiet.said)


@check("messages are records, on 2 ranks")
def _() -> None:
    written = billet(SOFT, ranks=2).text("diagnostics.jsonl").splitlines()
    # A note on time may stand between them: a busy machine takes seconds to write fields.
    lines = [line for line in written if '"key":"unneeded-cost","severity"' not in line]
    require(len(lines) == 3, "lines: " + "\n".join(written))
    first = (
        r'\{"key":"penalty-too-low","severity":"warning","message":"Nodes penetrate .*","pair":"top on'
        r' die",'
        r'"time":[\d.]+,"values":\{"penetration \[facet sizes\]":[\d.e-]+\},"advice":"Increase .*"\}'
    )
    require(re.fullmatch(first, lines[0]), f"first: {lines[0]}")
    last = (
        r'\{"summary":\{"exit code":0,"errors":0,"warnings":2,"notes":[01],"messages":\['
        r'\{"key":"penalty-too-low","pair":"top on die","count":\d+,"largest":[\d.]+,"at time":1(\.0)?\},'
        r'\{"key":"contact-too-soft","pair":"top on die","count":1,"largest":[\d.]+\}'
        r'(,\{"key":"unneeded-cost","count":1,"largest":[\d.]+\})?\]\}\}'
    )
    require(re.fullmatch(last, lines[2]), f"last: {lines[2]}")


@check("the list of messages in the manual is that of the program")
def _() -> None:
    listed = run(*program.on(1, "--print-diagnostics"))
    equal("exit code", listed.code, 0)
    is_same = listed.output == read_text(HERE.parents[1] / "doc/messages.md")
    require(is_same, "write doc/messages.md anew: billet --print-diagnostics > doc/messages.md")


@check("so are errors")
def _() -> None:
    lines = billet("Motion: Moment = 10*t^2", code=3).text("diagnostics.jsonl").splitlines()
    says(
        r'\A\{"key":"solution-failed","severity":"error","message":"scene.prm: tool '
        r"'die' finds no resistance to its moment",
        lines[-2],
    )
    record = json.loads(lines[-2])
    require(record["time"] >= 0 and "Try " not in record["message"], f"says {record}")
    says("^Use 'Rotation angle' of the tool .* Results until then", record["advice"])
    says('"exit code":3,"errors":1', lines[-1])


@check("warnings are printed where the console is quiet otherwise")
def _() -> None:
    says(
        r"\Awarning\[penalty-too-low\]: [^\n]*\nwarning\[contact-too-soft\]: [^\n]*\n"
        r"warning\[penalty-too-low\] pair 'top on die': [^\n]*\nCompleted in \S+ with 2 warnings\.[^\n]*\n\Z",
        billet(f"Output: Verbosity = quiet & {SOFT}").said,
    )


# --- penalties that do not fit --------------------------------------------------------------------


@check("a penalty that leaves nothing but round-off of the forces ends the run, at once")
def _() -> None:
    ran = billet("Motion: Translation = 0 ; 0 ; -2e-7*t & top on die: Normal penalty = 1e8", code=3)
    says(
        r"round-off limits the residual to [\d.e-]+ of the forces; allowed is 0\.02\."
        " The penalty of contact pair 'top on die' is too high",
        ran.complained,
    )
    says(r"after \d accepted steps and 1 cuts", ran.complained)
    says("Try a lower penalty", ran.complained)
    ran.require_history()


@check("one that leaves a ten-thousandth is accepted, and told")
def _() -> None:
    exact = billet("top on die: Normal penalty = 1e4")
    ran = billet("top on die: Normal penalty = 1e9")
    says(r"^warning\[round-off-limits-forces\]: .* residuals up to 0\.02 are accepted", ran.said)
    near("force", ran.force("die"), exact.force("die"), 1e-3)


@check("where nothing touches there is no round-off to tell of")
def _() -> None:
    ran = billet("Motion: Translation = 0 ; 0 ; ramp & top on die: Normal penalty = 1e8")
    require("Round-off" not in ran.said, f"says {ran.said}")


@check("a penalty that takes the die's motion gives a warning, and the summary says how bad it became")
def _() -> None:
    ran = billet(SOFT)
    first = says(
        r"^warning\[penalty-too-low\]: Nodes penetrate by ([\d.e-]+) facet sizes, \d+ % of the maximum"
        r" displacement so far \(pair 'top on die', time",
        ran.said,
    )
    worst = says(
        r"^warning\[penalty-too-low\] pair 'top on die': \d+ times, penetration \[facet sizes\] up to"
        r" ([\d.e-]+) at time 1$",
        ran.said,
    )
    is_worse = float(first[1]) < 0.02 and float(worst[1]) >= 9.9 * float(first[1])
    require(is_worse, f"says {ran.said}")
    says(r"^Completed in \S+ with 2 warnings\.", ran.said)


@check("and what it makes of the force, too")
def _() -> None:
    says(
        r"^warning\[contact-too-soft\]: Penetration takes more than 99 % of the deformation along the load"
        r" path"
        " of 'top on die'",
        billet(SOFT).said,
    )


@check("so in explicit scenes")
def _() -> None:
    says(
        r"^warning\[penalty-too-low\]: Nodes penetrate by [\d.e-]+ facet sizes.*"
        r" \(pair 'hammer on block', time",
        billet("hammer on block: Normal penalty = 1e-6", base=IMPACT).said,
    )


@check("a tool's edge may lie on nodes: pressure fades beyond it, which takes a part of the force")
def _() -> None:
    edge = (
        "Plane: Shape = rectangle & Plane: - Point & Plane: Centre = 0, 0, 2 & Plane: Direction = 1, 0, 0"
        " & Plane: Width = 2"
    )
    on_nodes = billet(f"{edge} & Plane: Length = 4").force("die")
    half = billet(f"{edge} & Plane: Length = 2").force("die")
    whole = reference.force("die")
    require(0.4 * whole < half < on_nodes < whole, f"forces {half}, {on_nodes}, {whole}")


@check("a moment that friction cannot bear is named")
def _() -> None:
    says(
        r"tool 'die' finds no resistance to its moment of [\d.]+ .* it jumps, while contact pair 'top on die'"
        r" bears a friction force of [\d.]+ of at most [\d.]+.* \(time [\d.e-]+\)\."
        r" Use 'Rotation angle' of the tool",
        billet("Motion: Moment = 10*t^2", code=3).complained,
    )


# --- motions, bodies, tools -----------------------------------------------------------------------


@check("a checkerboard of pressures is told")
def _() -> None:
    says(
        (
            r"^warning\[pressure-checkerboard\]: Pressures alternate from element to element by 47 % of"
            r" their size"
        ),
        billet(base=CAVITY).said,
    )
    ran = billet("Material: Poisson ratio = 0.3", base=CAVITY)
    require("pressure-checkerboard" not in ran.said, f"says {ran.said}")


@check("a smooth amplitude")
def _() -> None:
    ran = billet("ramp: Interpolation = smooth & Output: Interval = 0.25")
    travel = dict(zip(ran.history["time"], ran.column("die.travel_z")))
    near("travel at 0.25", travel["0.25"], -0.1 * 0.103515625)


@check("a prescribed displacement, without contact")
def _() -> None:
    ran = billet(
        (
            "top on die: delete & die: delete & Supports: + subsection top\n set Boundary ids = 7\n"
            f" set Components = z\n set Displacement = 0 ; 0 ; -ramp\nend & {ELASTIC}"
        )
    )
    # Hencky's law in uniaxial stress: E/2 (ln 0.95)^2 for each unit of volume
    near("elastic energy", ran.last("elastic_energy"), 4 * 500 * math.log(0.95) ** 2)


@check("a die that turns")
def _() -> None:
    ran = billet("Motion: Rotation angle = 0.05*t")
    near("turn", ran.last("die.turn"), 0.05)
    require(abs(ran.last("die.moment_z")) > 1e-3, "no moment")


def other(name: str) -> str:
    """Returns the subsection of this name for another body, tool or pair, which refers to others, too."""
    section = says(rf"(?s)^(  subsection {name}\n.*?^  end\n)", BLOCK)[1]
    section = section.replace(f"subsection {name}\n", f"subsection other {name}\n", 1)
    return re.sub(r"(Body +=|Tool +=) ", r"\1 other ", section)


OTHER_BODY = (
    other("block")
    .replace("x = 0", "x = 10", 1)
    .replace("subsection Mesh\n", "subsection Mesh\n      set Translation = 10, 0, 0\n", 1)
)


@check("two bodies and two tools")
def _() -> None:
    ran = billet(f"Bodies: + {OTHER_BODY} & Tools: + {other('die')} & Contact pairs: + {other('top on die')}")
    near("force", ran.force("die"), reference.force("die"), 1e-3)
    near("other force", ran.force("other die"), ran.force("die"), 1e-6)
    near("plastic work", ran.last("plastic_work"), 2 * reference.last("plastic_work"), 1e-3)


@check("turned and moved, symmetry planes askew, on 2 ranks")
def _() -> None:
    ran = billet(
        (
            "Mesh: Rotation angle = 36.86989764584402 & Mesh: Translation = 5, 0, 0"
            " & block: Symmetry planes = 0.8, 0.6, 0 = 4 ; -0.6, 0.8, 0 = -3"
        ),
        ranks=2,
    )
    x, y, z = (reference.last(f"die.force_{axis}") for axis in "xyz")
    near("force_x", ran.last("die.force_x"), 0.8 * x - 0.6 * y)
    near("force_y", ran.last("die.force_y"), 0.6 * x + 0.8 * y)
    near("force_z", ran.last("die.force_z"), z)


@check("a tool whose name has a comma")
def _() -> None:
    ran = billet(
        "top on die: Tool = upper, die",
        rewrite=lambda s: s.replace("subsection die\n", "subsection upper, die\n", 1),
    )
    equal("number of columns", len(ran.history), len(reference.history))


# --- output ---------------------------------------------------------------------------------------

for edits, times in (
    ("Output: Interval = 0.25", "0 0.25 0.5 0.75 1"),
    (f"{FIXED} & Output: Interval = 0.25", "0 0.25 0.5 0.75 1"),
    (f"{FIXED} & Output: Interval = 0.2", "0 0.2 0.4 0.6 0.8 1"),
    (f"{FIXED} & Output: Step interval = 3", "0 0.3 0.6 0.9 1"),
    ("Output: Step interval = 0", "0 1"),
):

    @check(edits)
    def _() -> None:
        equal("times", billet(edits).pictured(), times)


END = 0.5e-3  # of impact.prm


@check("explicit runs write a row of the history in each of its intervals, and one at the end")
def _() -> None:
    interval = 0.04e-3
    times = billet(f"Output: History interval = {interval}", base=IMPACT).column("time")
    numbers = [math.floor(time / interval * (1 + 1e-9)) for time in times]
    equal("intervals", [*numbers[:-1], round(times[-1] / END, 9)], [*range(13), 1.0])


for edits, expected in (
    ("", [END * i / 20 for i in range(21)]),
    ("Output: Interval = 2e-4", [0.0, 2e-4, 4e-4, END]),
    ("Output: Interval = 0", [0.0, END]),
    ("Output: Step interval = 0", [0.0, END]),
):

    @check(f"explicit field output, {edits or 'by default'}")
    def _() -> None:
        ran = billet(edits, base=IMPACT)
        found = [float(time) for time in ran.pictured().split(" ")]
        equal("number of times", len(found), len(expected))
        longest = max(ran.column("step_length"))
        for time, due in zip(found, expected):
            require(due * (1 - 1e-6) <= time <= due + longest, f"output at {time}, due at {due}")


@check("the console shows the largest loads, whatever their order")
def _() -> None:
    bodies = "".join(
        f"""
subsection Bodies
  subsection b{i}
    subsection Mesh
      set Arguments = {3 * i}, 0, 0 : {3 * i + 1}, 1, {1 if i < 6 else 1.05}
    end
    set Symmetry planes = x = {3 * i} ; y = 0 ; z = 0
    subsection Material
      set Law           = elastic
      set Young modulus = 100
    end
  end
end"""
        for i in range(7)
    )
    write_text(
        "many.prm",
        bodies
        + """
subsection Tools
  subsection die
    subsection Surfaces
      subsection p
        set Point = 0, 0, 1.05
        set Normal = 0, 0, -1
      end
    end
    subsection Motion
      set Translation = 0 ; 0 ; -0.04*t
    end
  end
end
set Contact = all
subsection Time stepping
  set End time = 1
end
""",
    )
    ended = run(*program.on(1, "--output", "many", "many.prm"))
    equal("exit code", ended.code, 0)
    headers = [line for line in ended.output.splitlines() if "residual" in line]
    require("|F| b6 on die" in headers[-1], f"columns: {headers[-1]}")
    equal("number of columns, without those of no force", headers[-1].count("|F|"), 2)


@check("a load that is too large for one step, and acts in full at once, is named")
def _() -> None:
    cantilever = """subsection Bodies
  subsection beam
    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = 20, 1, 1 : 0, 0, 0 : 100, 1, 1
    end
    subsection Material
      set Young modulus = 1e5
    end
    subsection Supports
      subsection wall
        set Boundary ids = 0
      end
    end
    subsection Loads
      subsection tip
        set Type         = force
        set Boundary ids = 1
        set Force        = 0 ; 0 ; FORCE
        START
      end
    end
  end
end
"""
    advice = r"Load 'tip' of body 'beam' acts in full from time %s on, .* multiply it by 'min\(1, %s\)'"
    for start, time, factor in (("", "0", "t/0.5"), ("set From = 0.5", "0.5", r"\(t - 0.5\)/0.25")):
        for force in ("3", f"3*min(1, {factor})".replace("\\", "")):
            write_text("sudden.prm", cantilever.replace("START", start).replace("FORCE", force))
            ended = run(*program.on(1, "--force", "--output", "sudden", "sudden.prm"))
            equal(f"exit code with {force} {start}", ended.code, 3 if force == "3" else 0)
            if force == "3":
                says(advice % (time, factor), ended.errors)


@check("and a couple by its moment")
def _() -> None:
    write_text(
        "couple.prm",
        """
subsection Bodies
  subsection strip
    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = 10, 1, 1 : 0, 0, 0 : 10, 1, 1
    end
    subsection Supports
      subsection root
        set Boundary ids = 0
      end
    end
    subsection Material
      set Law           = elastic
      set Young modulus = 1000
      set Poisson ratio = 0
    end
    subsection Loads
      subsection bend
        set Type         = moment
        set Boundary ids = 1
        set Moment       = 0 ; 0 ; t
      end
    end
  end
end
subsection Time stepping
  set End time = 1
end
""",
    )
    ended = run(*program.on(1, "--output", "couple", "couple.prm"))
    equal("exit code", ended.code, 0)
    lines = [line for line in ended.output.splitlines() if re.match(r" +\d+ +[\d.]+ ", line)]
    require("|M| root" in ended.output, f"says {ended.output}")
    near("the moment", float(lines[-1].split()[5]), 1.0)


@check("no fields")
def _() -> None:
    files = sorted(os.listdir(billet("Output: Format = none").folder))
    equal("files", " ".join(files), "billet.log capabilities.csv diagnostics.jsonl history.csv scene.prm")


@check("HDF5 on 2 ranks")
def _() -> None:
    ran = billet("Output: Format = hdf5 & Output: Step interval = 0", ranks=2)
    index = ran.text("fields.xdmf")
    files = set(re.findall(r"([\w.]+\.h5):", index))
    require(len(files) == 2, f"{len(files)} files in fields.xdmf, not 2")
    for name in sorted(files):
        start = Path(ran.folder, name).read_bytes()[:8]
        require(start == b"\x89HDF\r\n\x1a\n", f"{name} is no HDF5 file")
    require('"stress"' in index and 'NumberOfElements="4"' in index, f"fields.xdmf:\n{index}")
    for name in ("Bodies", "block", "Contact surfaces", "Tools"):
        require(f'<Grid Name="{name}"' in index, f"no block {name} in fields.xdmf:\n{index}")


def tags_of_body(ran: Run) -> str:
    """Returns the XML elements of the last fields of the first body, without their numbers."""
    text = Path(ran.folder, "fields_00001.0.vtu").read_text("ascii")
    return "\n".join(line for line in text.split("\n") if line.startswith("<"))


@check("blocks by name, and one point for each node")
def _() -> None:
    index = reference.text("fields_00001.vtm")
    for name in ("Bodies", "Boundaries", "Contact surfaces", "Tools", "block"):
        require(f'name="{name}"' in index, f"no block {name}:\n{index}")
    head = tags_of_body(reference)
    cells = int(says(r'NumberOfCells="(\d+)"', head)[1])
    points = int(says(r'NumberOfPoints="(\d+)"', head)[1])
    require(points < 8 * cells, f"{points} points of {cells} elements")
    for field, n in (("stress", 6), ("logarithmic_strain", 6), ("undeformed_coordinates", 3)):
        says(f'Name="{field}" NumberOfComponents="{n}"', head)
    for number in ("node_id", "element_id", "body", "material"):
        says(f'type="Int(32|64)" Name="{number}"', head)
    says('Name="boundary_id"', Path(reference.folder, "fields_00001.1.vtu").read_text("ascii"))
    require("averaged_" not in head, "averages that nobody asked for")


@check("averages at the nodes")
def _() -> None:
    head = tags_of_body(billet("Output: Step interval = 0 & Output: Nodal averages = true"))
    says('Name="averaged_stress" NumberOfComponents="6"', head)
    require("averaged_body" not in head, "the mean of numbers of bodies")


@check("layers of points through the thickness")
def _() -> None:
    ran = billet(
        "block: Points through thickness = 3 & block: Thickness direction = 0 ; 0 ; 1 & Output: Step"
        " interval = 0"
    )
    two, three = (tags_of_body(each) for each in (reference, ran))
    for layer in ("inner", "membrane", "outer"):
        for field in ("stress", "von_mises_stress", "pressure", "equivalent_plastic_strain"):
            require(f'"{layer}_{field}"' in three, f"no {layer}_{field}")
        require(f'"{layer}_' not in two, f"{layer} layer with two points")


for key, field in (
    ("Stress", "von_mises_stress"),
    ("Strain", "logarithmic_strain"),
    ("Plastic strain", "equivalent_plastic_strain"),
    ("Contact", "contact_pressure"),
):

    @check(f"without {key}")
    def _() -> None:
        ran = billet(f"Output: Step interval = 0 & Output: {key} = false")
        require(f'"{field}"' in tags_of_body(reference), f"{field} was never there")
        require(f'"{field}"' not in tags_of_body(ran), f"{field} is there")


@check("a field of the material's state by name")
def _() -> None:
    ran = billet("Output: Step interval = 0 & Output: State fields = inverse plastic metric")
    require('"state_inverse_plastic_metric"' in tags_of_body(ran), "the field is not there")
    require('"state_' not in tags_of_body(reference), "a state that nobody asked for")


@check("a quiet run")
def _() -> None:
    equal("output", billet("Output: Verbosity = quiet").said, "")


@check("iterations are shown")
def _() -> None:
    says("iteration +1  force", billet("Output: Verbosity = iterations").said)


@check("a scene and its mesh in another folder")
def _() -> None:
    os.mkdir("elsewhere")
    shutil.copy("block.msh", "elsewhere/beside.msh")
    require_same(billet(NO_MESH + "beside.msh", file="elsewhere/scene.prm"), reference, 1e-6)


@check("a folder in a folder that is not there")
def _() -> None:
    billet("Output: Folder = deep/er/results")
    require(os.path.getsize("deep/er/results/history.csv") > 0, "nothing is in it")


sys.exit(check.finish())
