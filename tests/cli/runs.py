#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: runs.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

Scenes that billet must run, and some that it must give up. Each is block.prm, or impact.prm where they are
explicit, with an edit (edits.py); 'same' ones must come out as block.prm does, whatever way they say it.
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
from typing import Callable, NamedTuple, Sequence

from checks import (
    HERE,
    Checks,
    Program,
    Run,
    Runner,
    differences,
    enter_folder,
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
from edits import edit

BLOCK, IMPACT, CAVITY, STRIP = (
    read_text(HERE / f"{name}.prm") for name in ("block", "impact", "cavity", "held_strip")
)
NO_MESH = "Mesh: - Primitive & Mesh: - Arguments & Mesh: - Boundary ids & Mesh: Source = file & Mesh: File = "
FIXED = "Time stepping: Step control = fixed & Time stepping: - Maximum step"
NO_LAW = "Material: - Yield stress & Material: - Hardening modulus & Material: Hardening = "
ELASTIC = (
    "Material: Law = elastic & Material: - Hardening & Material: - Yield stress"
    " & Material: - Hardening modulus"
)

program = Program(sys.argv[1:])
runner = Runner(program)
check = Checks()
enter_folder()


def billet(
    edits: str = "",
    *,
    base: str = BLOCK,
    rewrite: Callable[[str], str] | None = None,
    file: str = "scene.prm",
    ranks: int = 1,
    code: int | None = None,
) -> Run:
    """Runs a scene, edited, into a folder of its own; a fault unless the exit code is the expected one.
    Whether a target is missed is the business of the checks that give a code."""
    folder, text = runner.scene(base, edits)
    write_text(file, rewrite(text) if rewrite else text)
    ran = Run(folder, run(*program.on(ranks, file)))
    expected = code if code is not None else 7 if ran.ended.code == 7 and "Target error" in edits else 0
    said = ran.said + ran.complained
    require(ran.ended.code == expected, f"exit code {ran.ended.code}, not {expected}\n{said}")
    require(expected not in (0, 7) or not ran.complained, ran.complained)
    return ran


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


for ranks in (2, 3, 4):
    same(f"{ranks} ranks", "", ranks=ranks)
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
same("a mesh file .ucd on 2 ranks", NO_MESH + "block.ucd", ranks=2)
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
    "the die as Coons patches on 2 ranks",
    "Plane: - Point & Plane: - Normal & Plane: Shape = coons patches & Plane: File = patches.txt",
    ranks=2,
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
    "an amplitude from a file on 2 ranks",
    "ramp: - Times & ramp: - Values & ramp: File = ramp.csv & ramp: File columns = 1, 2",
    ranks=2,
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
        ranks=2,
    )


@check("a symmetric matrix is seen")
def _() -> None:
    ran = billet(f"{FIXED} & Solver: Contact tangent = consistent & top on die: Friction coefficient = 0")
    says(r"MUMPS \(symmetric\)", ran.said)


# --- profiles and target errors -------------------------------------------------------------------

TOLERANCES = "Solver: - Force tolerance & Solver: - Energy tolerance"
OPEN = f"Time stepping: - Initial step & Time stepping: - Maximum step & {TOLERANCES}"
SMALL_STEPS = f"{FIXED} & Time stepping: Initial step = 0.002"
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


for ranks in (1, 2):

    @check(f"a target error is kept and told on {ranks} ranks")
    def _() -> None:
        ran = billet(f"Target error = 3 percent & {OPEN}", ranks=ranks)
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


for ranks in (1, 2):

    @check(f"messages are records, on {ranks} ranks")
    def _() -> None:
        written = billet(SOFT, ranks=ranks).text("diagnostics.jsonl").splitlines()
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

for ranks in (1, 2):

    @check(f"a checkerboard of pressures is told, on {ranks} ranks")
    def _() -> None:
        says(
            (
                r"^warning\[pressure-checkerboard\]: Pressures alternate from element to element by 47 % of"
                r" their size"
            ),
            billet(base=CAVITY, ranks=ranks).said,
        )
        ran = billet("Material: Poisson ratio = 0.3", base=CAVITY, ranks=ranks)
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
        ),
        ranks=2,
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
for ranks in (1, 3):

    @check(f"two bodies and two tools on {ranks} ranks")
    def _() -> None:
        ran = billet(
            f"Bodies: + {OTHER_BODY} & Tools: + {other('die')} & Contact pairs: + {other('top on die')}",
            ranks=ranks,
        )
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


for ranks in (1, 2):

    @check(f"HDF5 on {ranks} ranks")
    def _() -> None:
        ran = billet("Output: Format = hdf5 & Output: Step interval = 0", ranks=ranks)
        index = ran.text("fields.xdmf")
        files = set(re.findall(r"([\w.]+\.h5):", index))
        require(len(files) == 2, f"{len(files)} files in fields.xdmf, not 2")
        for name in sorted(files):
            start = Path(ran.folder, name).read_bytes()[:8]
            require(start == b"\x89HDF\r\n\x1a\n", f"{name} is no HDF5 file")
        require('"stress"' in index and 'NumberOfElements="4"' in index, f"fields.xdmf:\n{index}")
        for name in ("Bodies", "block", "Contact surfaces", "Tools"):
            require(f'<Grid Name="{name}"' in index, f"no block {name} in fields.xdmf:\n{index}")


def head_of_body(ran: Run) -> str:
    """Returns the XML of the last fields of the first body, which binary numbers follow."""
    text = Path(ran.folder, "fields_00001.0.vtu").read_bytes()
    return text[: text.index(b"<AppendedData")].decode()


@check("blocks by name, and one point for each node")
def _() -> None:
    index = reference.text("fields_00001.vtm")
    for name in ("Bodies", "Boundaries", "Contact surfaces", "Tools", "block"):
        require(f'name="{name}"' in index, f"no block {name}:\n{index}")
    head = head_of_body(reference)
    cells = int(says(r'NumberOfCells="(\d+)"', head)[1])
    points = int(says(r'NumberOfPoints="(\d+)"', head)[1])
    require(points < 8 * cells, f"{points} points of {cells} elements")
    for field, n in (("stress", 6), ("logarithmic_strain", 6), ("undeformed_coordinates", 3)):
        says(f'Name="{field}" NumberOfComponents="{n}"', head)
    for number in ("node_id", "element_id", "body", "material"):
        says(f'type="Int(32|64)" Name="{number}"', head)
    says('Name="boundary_id"', Path(reference.folder, "fields_00001.1.vtu").read_bytes().decode("latin-1"))
    require("averaged_" not in head, "averages that nobody asked for")


@check("averages at the nodes")
def _() -> None:
    head = head_of_body(billet("Output: Step interval = 0 & Output: Nodal averages = true"))
    says('Name="averaged_stress" NumberOfComponents="6"', head)
    require("averaged_body" not in head, "the mean of numbers of bodies")


@check("layers of points through the thickness")
def _() -> None:
    ran = billet(
        "block: Points through thickness = 3 & block: Thickness direction = 0 ; 0 ; 1 & Output: Step"
        " interval = 0"
    )
    two, three = (head_of_body(each) for each in (reference, ran))
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
        require(f'"{field}"' in head_of_body(reference), f"{field} was never there")
        require(f'"{field}"' not in head_of_body(ran), f"{field} is there")


@check("a field of the material's state by name")
def _() -> None:
    ran = billet("Output: Step interval = 0 & Output: State fields = inverse plastic metric")
    require('"state_inverse_plastic_metric"' in head_of_body(ran), "the field is not there")
    require('"state_' not in head_of_body(reference), "a state that nobody asked for")


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
        billet("foot: Normal penalty = 1e5", base=BALL).said,
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
    ranks: Sequence[int] = (1, 2)


BROKEN = [
    Broken(
        "an element that is blown inside out",
        "push: Pressure = if(t > 1e-4, 1e6, 0)",
        r"after \d+ steps element \d+ of body 'block', with its initial centre at"
        r" \(0[\d. ]+\), is inverted at \([-\d.e ]+\) \(time 0\.0001\d*\)\. Try ",
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
        ranks=(1,),
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


@check("explicit scenes say how many steps there will be")
def _() -> None:
    ran = billet(base=IMPACT)
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
    ends = [
        rows_of(f"{billet(edits, base=IMPACT).folder}/history.csv")[-1]
        for edits in ("", "Output: Interval = 1.3e-5 & Output: History interval = 1.7e-5")
    ]
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
# that of steps that are short beside the facets. (One account for each node alone gave 43 % of it.)
@check("nodes that hand their load over dissipate with default steps what they do in short ones")
def _() -> None:
    roll = (
        "Mesh: Arguments = 16, 1, 3 : 0, 0, -3 : 6, 1, 0 : true & Mesh: - Boundary ids"
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


# A tool that swings ten times, in steps of up to a tenth of the run.
SWING = (
    "Motion: Translation = 0.2*sin(20*pi*max(0,t-1)) ; 0 ; -ramp & ramp: Times = 0, 1, 2"
    " & ramp: Values = 0, 0.05, 0.05 & top on die: Friction coefficient = 0.3 & Time stepping: End time = 2"
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
        "x*(cos(6*pi*max(0,t-1))-1)-y*sin(6*pi*max(0,t-1)) ;"
        " x*sin(6*pi*max(0,t-1))+y*(cos(6*pi*max(0,t-1))-1) ; 0"
    )
    turn = (
        f"floor: - Components & floor: Displacement = {turned} & block: - Symmetry planes & Mesh: Arguments ="
        " 2, 2, 2 : -1, -1, 0 : 1, 1, 2 : true & ramp: Times = 0, 1, 2 & ramp: Values = 0, 0.02, 0.02 & top"
        " on die: Friction coefficient = 0.3 & Time stepping: End time = 2"
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
for ranks in (1, 2):

    @check(f"a body that removed tools leave free, on {ranks} ranks")
    def _() -> None:
        ran = billet(f"{LET_GO} & Output: Step interval = 0", ranks=ranks, code=3)
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
            r"^(?:Geometry|Boundary|Gap| ) .*", checked("Plane: Point = 0, 0, 2.05", ranks), re.MULTILINE
        )
        for ranks in (1, 2)
    ]
    require(len(measured[0]) > 4, "there are no lines to compare")
    equal("what two ranks measure", measured[1], measured[0])


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


@check("--check on 2 ranks")
def _() -> None:
    equal("titles", re.findall("^Title", checked("", 2), re.MULTILINE), ["Title"])


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
