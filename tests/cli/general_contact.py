#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: general_contact.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

'Contact = all' has the history of the same pairs written by hand, in statics and in explicit dynamics,
there on two ranks, too. Pairs of the scene replace those of the same two, 'General contact' gives values and
excludes. Faces on symmetry planes do not touch, and pairs that never touch add little to the matrix. Tables
from files have the history of tables in the scene.
"""

from __future__ import annotations

import functools
import re
import sys

from checks import (
    HERE,
    Checks,
    Program,
    Run,
    Runner,
    enter_folder,
    equal,
    near,
    read_text,
    require,
    says,
    write_text,
)

BLOCK, IMPACT, BOLT = (read_text(HERE / f"{name}.prm") for name in ("block", "impact", "bolt"))
program = Program(sys.argv[1:])
runner = Runner(program)
check = Checks()
enter_folder()


@functools.cache
def billet(base: str, edits: str, ranks: int = 1) -> Run:
    """Runs a scene with these edits; what several checks look at is run once."""
    ran = runner.run(base, edits, ranks=ranks)
    require(ran.ended.code == 0, f"exit code {ran.ended.code}\n{ran.said}{ran.complained}")
    return ran


def described(base: str, edits: str) -> dict[str, str]:
    """Returns what --check says of each contact pair."""
    ran = runner.run(base, edits, options=["--check"])
    require(ran.ended.code == 0, f"exit code {ran.ended.code}\n{ran.said}{ran.complained}")
    return dict(re.findall(r"^Contact pair   (.*?): (.*)$", ran.said, re.MULTILINE))


def general(*values: str) -> str:
    """Returns the edit for contact of everything, with values of 'General contact'."""
    subsection = "".join(f" set {value}\n" for value in values)
    return f"+ set Contact = all\nsubsection General contact\n{subsection}end"


def pair(name: str, *values: str) -> str:
    """Returns a contact pair."""
    return f" subsection {name}\n" + "".join(f"  set {value}\n" for value in values) + " end\n"


def pairs(*by_hand: str) -> str:
    """Returns the edit for these pairs alone."""
    return "Contact pairs: delete & + subsection Contact pairs\n" + "".join(by_hand) + "end"


def same_history(ran: Run, expected: Run, tolerance: float = 1e-8) -> None:
    """Compares all columns; numbers that are round-off beside the largest of their column count as equal."""
    equal("the columns", list(ran.history), list(expected.history))
    for name in expected.history:
        found, wanted = ran.column(name), expected.column(name)
        equal(f"the number of lines of {name}", len(found), len(wanted))
        size = max(abs(number) for number in wanted)
        for one, other in zip(found, wanted):
            require(abs(one - other) <= tolerance * size, f"{name} is {one}, not {other}")


# --- the same pairs by hand -----------------------------------------------------------------------

VALUES = ("Friction coefficient = 0.1", "Normal penalty = 10")
SIDES = "Boundary ids = 1, 3, 4, 7"  # those of the block that are not on its symmetry planes
STATIC = pairs(
    pair("block on die", "Body = block", SIDES, "Tool = die", *VALUES),
    pair("block on itself", "Body = block", SIDES, "Second body = block", *VALUES),
)
ALL = "Boundary ids = 0, 1, 2, 3, 4, 5"
ALL_OF_SECOND = f"Second {ALL}".replace("B", "b")
SOFT = "Normal penalty = 1"
EXPLICIT = pairs(
    pair("slab on hammer", "Body = slab", ALL, "Tool = hammer", SOFT),
    pair("slab on itself", "Body = slab", ALL, "Second body = slab", SOFT),
    pair("slab on block", "Body = slab", ALL, "Second body = block", ALL_OF_SECOND, SOFT),
    pair("block on hammer", "Body = block", ALL, "Tool = hammer", SOFT),
    pair("block on itself", "Body = block", ALL, "Second body = block", SOFT),
)
NO_PAIRS = "Contact pairs: delete & "


@check("a block under a die")
def _() -> None:
    by_hand = billet(BLOCK, STATIC)
    require(abs(by_hand.last("die.force_z")) > 1, "the die does not press")
    same_history(billet(BLOCK, NO_PAIRS + general(*VALUES)), by_hand)


for ranks in (1, 2):

    @check(f"a block falls on a slab, {ranks} ranks")
    def _() -> None:
        # Ranks wait for each other where others use the processors, too.
        until = "Time stepping: End time = 0.08e-3 & " if ranks > 1 else ""
        by_hand = billet(IMPACT, until + EXPLICIT, ranks)
        require(max(by_hand.column("slab on block.contact_area")) > 0, "the block does not touch the slab")
        ran = billet(IMPACT, until + NO_PAIRS + general(SOFT), ranks)
        same_history(ran, by_hand)
        require("pair-never-touched" not in ran.said, f"warns of a pair that nobody wrote: {ran.said}")


@check("'Boundary ids = all' of a pair is what its ids are")
def _() -> None:
    same_history(billet(BLOCK, STATIC.replace(SIDES, "Boundary ids = all")), billet(BLOCK, STATIC))


@check("faces of a mesh file, in groups")
def _() -> None:
    mesh = (
        "Mesh: - Primitive & Mesh: - Arguments & Mesh: - Boundary ids & Mesh: Source = file"
        " & Mesh: File = named.msh & floor: Boundary ids = bottom & "
    )
    same_history(billet(BLOCK, mesh + NO_PAIRS + general(*VALUES)), billet(BLOCK, mesh + STATIC))


@check("--check names all pairs")
def _() -> None:
    found = described(BOLT, NO_PAIRS + general("Exclusions = bolt : press"))
    expected = "bolt on itself, bolt on plate, plate on press, plate on itself"
    equal("the pairs", sorted(found), sorted(expected.split(", ")))


# --- pairs of the scene, values and exclusions ----------------------------------------------------


@check("a pair of the scene replaces the one of the same two, and takes the values that it does not set")
def _() -> None:
    found = described(
        IMPACT,
        pairs(pair("slow", "Body = block", "Second body = slab", "Friction coefficient = 0.3"))
        + " & "
        + general("Friction coefficient = 0.1", "Normal penalty = 2", "Self-contact = false"),
    )
    equal("the pairs", sorted(found), ["block on hammer", "slab on hammer", "slow"])
    require("mu = 0.3, penalties 2, 2 E/h" in found["slow"], found["slow"])
    require("mu = 0.1, penalties 2, 2 E/h" in found["block on hammer"], found["block on hammer"])


@check("a pair with a penalty of its own takes neither unit nor tangential penalty of others")
def _() -> None:
    found = described(
        IMPACT,
        pairs(pair("own", "Body = block", "Second body = slab", "Normal penalty = 3"))
        + " & "
        + general(
            "Friction coefficient = 0.1",
            "Penalty unit = absolute",
            "Normal penalty = 200",
            "Tangential penalty = 100",
        ),
    )
    require("mu = 0.1, penalties 3, 3 E/h" in found["own"], found["own"])
    require("penalties 200, 100 (absolute)" in found["block on itself"], found["block on itself"])


@check("values for bodies do not reach pairs with tools, nor one pass self-contact")
def _() -> None:
    found = described(IMPACT, NO_PAIRS + general("Facets = bilinear", "Passes = one"))
    require("bilinear facets, one pass" in found["slab on block"], found["slab on block"])
    require("bilinear facets, two passes" in found["slab on itself"], found["slab on itself"])


for exclusion, left in {
    "slab : hammer ; block : block": "slab on itself, slab on block, block on hammer",
    "hammer": "slab on itself, slab on block, block on itself",
    "block : slab ; hammer : block": "slab on hammer, slab on itself, block on itself",
}.items():

    @check(f"without {exclusion}")
    def _() -> None:
        found = described(IMPACT, NO_PAIRS + general(f"Exclusions = {exclusion}"))
        equal("the pairs", sorted(found), sorted(left.split(", ")))


@check("an excluded pair leaves the history of the others")
def _() -> None:
    left = EXPLICIT.replace(pair("slab on hammer", "Body = slab", ALL, "Tool = hammer", SOFT), "")
    require(left != EXPLICIT, "nothing is left out")
    same_history(billet(IMPACT, NO_PAIRS + general(SOFT, "Exclusions = slab : hammer")), billet(IMPACT, left))


# --- symmetry planes ------------------------------------------------------------------------------


def nodes_under_die(mesh: str) -> str:
    """Returns how many nodes of the block --check finds in the pair with the die."""
    ran = runner.run(BLOCK, NO_PAIRS + mesh + general(*VALUES), options=["--check"])
    require(ran.ended.code == 0, f"exit code {ran.ended.code}\n{ran.said}{ran.complained}")
    return says(r"^Gap +block on die: .* over \d+ of (\d+) nodes", ran.said)[1]


def ids(condition: str) -> str:
    """Returns the edit that gives faces of the block the id 9, too."""
    return f"Mesh: Boundary ids = 7 : abs(z - 2) < 1e-6 ; 9 : {condition} & "


@check("faces on a symmetry plane do not touch, whatever their id")
def _() -> None:
    # 18 nodes, of which 2 are on no other faces than those of the planes
    equal("the nodes", nodes_under_die(""), 16)
    equal("the nodes with an id for one plane", nodes_under_die(ids("abs(x) < 1e-6")), 16)
    equal("the nodes with an id for both planes", nodes_under_die(ids("abs(x*y) < 1e-6")), 16)


@check("nor do faces on a plane that only the refined mesh has")
def _() -> None:
    fine = "Mesh: + set Refinements = 1 & "
    part = ids("abs(x) < 1e-6 && z < 0.5")
    equal("the nodes", nodes_under_die(fine + part), nodes_under_die(fine))


@check("faces on a plane touch if others beside it have their id")
def _() -> None:
    equal("the nodes", nodes_under_die(ids("abs(x*(x - 2)) < 1e-6")), 17)


# --- cost -----------------------------------------------------------------------------------------


def items_of_matrix(ran: Run) -> float:
    """Returns the entries of the matrix that the run filled."""
    head, *rows = [line.split(",") for line in ran.text("capabilities.csv").strip().split("\n")]
    column = [name.strip() for name in head].index("items")
    return next(float(row[column]) for row in rows if row[0].strip().lower() == "matrix")


@check("self-contact that a block does not have adds little to the matrix, and nothing to the forces")
def _() -> None:
    fine = "Mesh: Arguments = 4, 4, 4 : 0, 0, 0 : 2, 1, 2 : true & "
    needed = billet(BLOCK, fine + pairs(pair("block on die", "Body = block", SIDES, "Tool = die", *VALUES)))
    everything = billet(BLOCK, fine + NO_PAIRS + general(*VALUES))
    cost = items_of_matrix(everything) / items_of_matrix(needed)
    require(cost < 1.05, f"{cost} times the entries")
    near("the force", everything.last("die.force_z"), needed.last("die.force_z"), 1e-8)


# --- tables from files ----------------------------------------------------------------------------


@check("an amplitude from a file moves as the same in the scene does, to the last bit")
def _() -> None:
    write_text("press.csv", "time; travel\n0; 0\n0.3; 0.0123456789\n1; 0.1\n")
    inside = billet(BLOCK, "ramp: Times = 0, 0.3, 1 & ramp: Values = 0, 0.0123456789, 0.1")
    outside = billet(BLOCK, "ramp: - Times & ramp: - Values & ramp: File = press.csv")
    equal("the history", outside.text("history.csv"), inside.text("history.csv"))


@check("a load and a support by an amplitude from a file, to the last bit")
def _() -> None:
    write_text("impact.csv", "# s, -\n0,0\n0.3e-3,0.123456789\n1e-3,1\n")
    floor = "bottom: Displacement = 0 ; 0 ; 0.001*ramp & "  # loads have the amplitude anyway
    inside = billet(IMPACT, floor + "ramp: Times = 0, 0.3e-3, 1e-3 & ramp: Values = 0, 0.123456789, 1")
    outside = billet(IMPACT, floor + "ramp: - Times & ramp: - Values & ramp: File = impact.csv")
    equal("the history", outside.text("history.csv"), inside.text("history.csv"))


@check("hardening from a file hardens as the same in the scene does, to the last bit")
def _() -> None:
    write_text("curve.csv", "strain,stress\n0,10\n0.0123,12.3456789\n0.5,35\n")
    table = "Material: - Yield stress & Material: - Hardening modulus & Material: Hardening = table & "
    inside = billet(BLOCK, table + "Material: Table = 0 : 10, 0.0123 : 12.3456789, 0.5 : 35")
    outside = billet(BLOCK, table + "Material: Table file = curve.csv")
    equal("the history", outside.text("history.csv"), inside.text("history.csv"))
    require(billet(BLOCK, "").last("die.force_z") != inside.last("die.force_z"), "the table does nothing")


@check("above the rates of measured curves, the last one is the hardening")
def _() -> None:
    write_text("curves.csv", "strain,slow,fast\n0,8,10\n0.0123,9,12.3456789\n0.5,20,35\n")
    table = "Material: - Yield stress & Material: - Hardening modulus & Material: Hardening = table & "
    table += "Material: Table file = curves.csv & "
    last = billet(BLOCK, table + "Material: Table columns = 1, 3")
    curves = billet(
        BLOCK,
        table
        + "Material: + set Rate factor = curves\nset Curve rates = 1e-9, 1e-8\nset Curves file = curves.csv",
    )
    near("the force", curves.last("die.force_z"), last.last("die.force_z"), 1e-9)


sys.exit(check.finish())
