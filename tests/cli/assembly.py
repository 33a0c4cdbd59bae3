#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: assembly.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

Bodies that fit each other. slider.prm, drawn with a gap or an overlap that counts as none, has the force
of faces in contact wherever it slides. bolt.prm, drawn with play that 'Initial gap' closes, has the
forces of the scene without play. pin.prm, a pin in a lug whose facets miss each other, has the force of a
fine mesh with 'Surface correction', and a warning without; --check warns of the same as the run.
"""

from __future__ import annotations

import functools
import re
import sys
from pathlib import Path

from checks import HERE, Checks, Program, Run, Runner, enter_folder, near, read_text, require, says

BOLT, PIN, SLIDER = (read_text(HERE / f"{name}.prm") for name in ("bolt", "pin", "slider"))
runner = Runner(Program(sys.argv[1:]))
check = Checks()
enter_folder()


@functools.cache
def billet(base: str, edits: str = "", ranks: int = 1, *options: str) -> Run:
    """Runs a scene with these edits; what several checks look at is run once."""
    ran = runner.run(base, edits, ranks=ranks, options=options)
    require(ran.ended.code == 0, f"exit code {ran.ended.code}\n{ran.said}{ran.complained}")
    return ran


def warns(ran: Run) -> bool:
    """Tells whether chords are warned of."""
    return re.search(r"^warning\[faceted-curvature\]", ran.said, re.MULTILINE) is not None


# --- play -----------------------------------------------------------------------------------------

CLOSED = (
    "plate / Mesh: Translation = 0, 0, 0.01 & face: Point = 0, 0, 1.515"
    " & seat: Initial gap = close within 0.011 & top: Initial gap = close within 0.011"
)
for facets in ("overlap", "bilinear", "planed"):
    exact = billet(BOLT, f"seat: Facets = {facets}").last("press.force_z")
    for ranks in (1, 2) if facets == "planed" else (1,):

        @check(f"play is closed, {facets}, {ranks} ranks")
        def _() -> None:
            ran = billet(BOLT, f"{CLOSED} & seat: Facets = {facets}", ranks)
            near("the force", ran.last("press.force_z"), exact, 1e-4)


@check("play is closed in a first step without force")
def _() -> None:
    force = billet(BOLT, f"{CLOSED} & Motion: Translation = 0 ; 0 ; 0").last("press.force_z")
    require(abs(force) < 1e-9, f"the force is {force}")


# --- gaps and overlaps on the way of a slider ------------------------------------------------------

UP, DOWN = (
    f"slider / Mesh: Arguments = 4, 2 : 1, {low} : 4, {low + 3} : true & slide: {change}"
    for low, change in (
        (2.01, "+ set Initial gap = close within 0.02"),
        (1.98, "+ set Initial penetration = shift"),
    )
)
TOOL = (
    "slider: delete & slide: - Second body & slide: - Second boundary ids & slide: Tool = shoe"
    " & + subsection Tools\nsubsection shoe\nsubsection Surfaces\nsubsection face\nset Shape = rectangle"
    "\nset Centre = 2.5, 2, 0.5\nset Direction = 1, 0, 0\nset Normal = 0, -1, 0\nset Length = 3"
    "\nset Width = 2\nend\nend\nsubsection Motion"
    "\nset Translation = 3*max(0, t - 1) ; -0.03*min(1, t) ; 0\nend\nend\nend"
)
CHECKPOINT = " & Output: + subsection Checkpoint\nset Step interval = 6\nend"
UP_TOOL = f"{TOOL} & face: Centre = 2.5, 2.01, 0.5 & slide: + set Initial gap = close within 0.02"
DOWN_TOOL = f"{TOOL} & face: Centre = 2.5, 1.98, 0.5 & slide: + set Initial penetration = shift"
for name, drawn, changed in (
    ("slider", "", (UP + CHECKPOINT, DOWN)),
    ("slider, nodes and facets", "slide: + set Facets = bilinear", (UP, DOWN)),
    ("tool", TOOL, (UP_TOOL, DOWN_TOOL)),
):
    touching = billet(SLIDER, drawn).last("base.support foot.force_y")
    for edits, what in zip(changed, ("gap", "overlap")):
        both = edits if name != "slider, nodes and facets" else f"{drawn} & {edits}"

        @check(f"{name} on a base, {what}: the force after a slide")
        def _() -> None:
            ran = billet(SLIDER, both)
            near("the force", ran.last("base.support foot.force_y"), touching, 0.01)
            require("uneven-start-gaps" not in ran.said, "uneven gaps")


@check("the gaps at the start hold after a restart")
def _() -> None:
    whole = billet(SLIDER, UP + CHECKPOINT)
    first = sorted(Path(whole.folder).glob("checkpoint_*.h5"))[0]
    resumed = billet(SLIDER, UP, 1, "--restart", str(first))
    near(
        "the force", resumed.last("base.support foot.force_y"), whole.last("base.support foot.force_y"), 1e-6
    )


@check("the console tells supports of one name apart")
def _() -> None:
    one = "Time stepping: End time = 0.1 & Time stepping: Initial step = 0.1"
    ran = billet(SLIDER.replace("subsection top", "subsection foot"), one)
    says(r"^ +step .* \|F\| base\.foot +\|F\| slider\.foot", ran.said)
    says(r"^ +step .* \|F\| foot +\|F\| top", billet(SLIDER, one).said)


UNEVEN = "slider / Mesh: Positions = x ; y + 0.006*(y < 2.1)*(1 + cos(2*pi*x)) ; z"


@check("uneven gaps are warned of after a slide")
def _() -> None:
    says(
        r"^warning\[uneven-start-gaps\]: .* the partner has slid by", billet(SLIDER, f"{UP} & {UNEVEN}").said
    )
    still = billet(SLIDER, f"{UP} & {UNEVEN} & Time stepping: End time = 1")
    require("uneven-start-gaps" not in still.said, "warns without a slide")


# --- curved faces of one radius -------------------------------------------------------------------


def half_circles(n_lug: int, n_pin: int) -> str:
    """Returns the edit for half circles of so many bricks."""
    return (
        f"lug / Mesh: Arguments = 3, {n_lug}, 1 : 10, 0, 0 : 20, 180, 1 : true"
        f" & pin / Mesh: Arguments = 3, {n_pin}, 1 : 3, 0, 0 : 10, 180, 1 : true"
    )


SHIFT = " & fit: Initial penetration = shift"
TRUE_SURFACE = " & fit: Surface correction = cylinder : 0, 0, 0 ; 0, 0, 1"
fine = billet(PIN, half_circles(48, 48) + SHIFT)
matching = fine.last("fit.force_x")


@check("faces whose chords match do not warn")
def _() -> None:
    require(not warns(fine), "it warns")


for n in (10, 12):
    circles = half_circles(n, n + 1)

    @check(f"{2 * n} facets: chords make it soft, with a warning")
    def _() -> None:
        ran = billet(PIN, circles + SHIFT)
        force = ran.last("fit.force_x")
        require(warns(ran), "no warning")
        require(abs(force) <= 0.95 * abs(matching), f"the force is {force}, beside {matching}")

    @check(f"{2 * n} facets: --check warns, too")
    def _() -> None:
        ran = billet(PIN, circles + SHIFT, 2 if n == 10 else 1, "--check")
        require(warns(ran), ran.said)

    for ranks in (1, 2) if n == 10 else (1,):

        @check(f"{2 * n} facets: the true surface, {ranks} ranks")
        def _() -> None:
            ran = billet(PIN, circles + TRUE_SURFACE, ranks)
            require(not warns(ran), "it warns")
            near("the force", ran.last("fit.force_x"), matching, 0.03)


# --- meshes ---------------------------------------------------------------------------------------


@check("elements inside out at a corner are warned about")
def _() -> None:
    at = "(abs(x-13.3333)<0.01 && abs(y-90)<0.01)"  # one row of nodes goes beyond a diagonal
    r, a = f"(x+2*{at})", f"(pi/180*(y+9*{at}))"
    ran = billet(PIN, f"lug / Mesh: Positions = {r}*cos({a}) ; {r}*sin({a}) ; z{SHIFT}", 1, "--check")
    says(r"^warning\[inverted-corners\]: 1 element is inverted at a corner.*\(body 'lug'", ran.said)


sys.exit(check.finish())
