#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: all_errors.py TABLE... BILLET

All errors of a scene are found at once. Runs in an empty current folder.

Takes edits of block.prm, each with one error, from TABLE... of bad_input.py, and makes scenes with two of
them, in different parts. One check must find both errors, unless one depends on the other. Then scenes with
more errors, in as many parts.
"""

from __future__ import annotations

import random
import re
import sys
from pathlib import Path
from typing import NamedTuple

from checks import HERE, Checks, enter_folder, equal, read_text, require, run, says, write_text
from edits import Edited, edit

BLOCK = read_text(HERE / "block.prm")
PROGRAM = sys.argv[-1]
N_PAIRS = 60
MIN_PART = 0.85  # of pairs of which both errors are found; others depend on a mesh, a support or a pair

check = Checks()


class Faulty(NamedTuple):
    """An edit with an error, where its last change is, and the message without its place."""

    edit: str
    part: str
    message: str


def part_of(edited: Edited) -> str:
    """Returns the part of the scene that an edit changes: 'Bodies / block / Mesh'."""
    names = edited.path.split(" / ")
    return " / ".join(names[: 4 if len(names) > 2 and names[2] in ("Supports", "Loads") else 3])


def messages_of(errors: str) -> list[str]:
    """Returns messages without their places and the names of files."""
    found = re.findall(r"^error\[bad-input\]: (.*(?:\n(?!error\[|note\[).*)*)", errors, re.MULTILINE)
    return [re.sub(r"\w+\.prm(:\d+)?( \(default\))?(: )?", "", message).strip() for message in found]


def read_edits(tables: list[str]) -> list[str]:
    """Returns the edits of tables of block.prm that are written in full."""
    edits = []
    for table in tables:
        text = read_text(Path(table))
        if re.search(r"^scene ", text, re.MULTILINE):
            continue
        short = set(re.findall(r"^(\w+) :=", text, re.MULTILINE))
        for line in text.split("\n"):
            match = re.match(r"([A-Za-z][^#]*?)\s*-> ", line)
            if match and "\\n" not in match[1] and re.split(r"\W", match[1])[0] not in short:
                edits.append(match[1])
    return edits


def single_errors(edits: list[str]) -> list[Faulty]:
    """Returns the edits that make one error, with it."""
    faulty = []
    for start in range(0, len(edits), 50):
        files = {}
        for number, one in enumerate(edits[start : start + 50]):
            files[f"case_{number:03d}.prm"] = edit(BLOCK, one)
        for name, edited in files.items():
            write_text(name, edited.text)
        errors = run(PROGRAM, "--check", *files).errors
        for number, (name, edited) in enumerate(files.items()):
            of_file = "".join(re.findall(rf"^error\[bad-input\]: {name}.*\n", errors, re.MULTILINE))
            messages = messages_of(of_file)
            if len(messages) == 1 and edited.path:
                faulty.append(Faulty(edits[start + number], part_of(edited), messages[0]))
    return faulty


class Pair(NamedTuple):
    """Two edits of one scene."""

    first: Faulty
    second: Faulty
    file: str


def make_pairs(faulty: list[Faulty]) -> list[Pair]:
    """Writes scenes with two errors in different parts."""
    chance = random.Random(1)
    pairs: list[Pair] = []
    while len(pairs) < N_PAIRS:
        first, second = chance.sample(faulty, 2)
        if first.part == second.part or first.message == second.message:
            continue
        try:
            text = edit(BLOCK, f"{first.edit} & {second.edit}").text
        except ValueError:  # the first one takes away what the second one changes
            continue
        pairs.append(Pair(first, second, f"pair_{len(pairs):03d}.prm"))
        write_text(pairs[-1].file, text)
    return pairs


enter_folder()
faulty = single_errors(read_edits(sys.argv[1:-1])[::4])


@check("both errors of two parts are found at once")
def _() -> None:
    require(len(faulty) > 50, f"{len(faulty)} edits are too few")
    pairs = make_pairs(faulty)
    n_found = 0
    for start in range(0, len(pairs), 50):
        errors = run(PROGRAM, "--check", *(pair.file for pair in pairs[start : start + 50])).errors
        for pair in pairs[start : start + 50]:
            of_file = "".join(re.findall(rf"^error\[bad-input\]: {pair.file}.*\n", errors, re.MULTILINE))
            messages = messages_of(of_file)
            if pair.first.message in messages and pair.second.message in messages:
                n_found += 1
            else:
                print(f"not both: {pair.first.edit} & {pair.second.edit}")
    print(f"{n_found} of {len(pairs)} pairs")
    require(n_found >= MIN_PART * len(pairs), f"{n_found} of {len(pairs)} pairs")


def errors_of(edits: str) -> str:
    """Returns what a check of an edited block says."""
    write_text("scene.prm", edit(BLOCK, edits).text)
    ended = run(PROGRAM, "--check", "scene.prm")
    equal("exit code", ended.code, 2)
    return ended.errors


INDEPENDENT = (
    "Output: Step interval = 0.5 & block / Material: Young modulus = -1 & Motion: Translation = 0 ; 0 ; 3*tt"
    " & floor: Boundary ids = 99 & top on die: Normal penalty = 0 & Solver: Maximum iteration = 2"
    " & + subsection Probes\\n subsection far\\n  set Point = 9, 9, 99\\n end\\nend"
)


@check("seven errors of text, numbers, expressions, meshes and probes")
def _() -> None:
    errors = errors_of(INDEPENDENT)
    for text in (
        "'Step interval' in 'Output' is '0.5'",
        "'Young modulus' in 'Bodies / block / Material' is '-1'",
        r"'Translation' in 'Tools / die / Motion' contains '3\*tt'",
        "names boundary id 99",
        "'Normal penalty' in 'Contact pairs / top on die' is '0'",
        "there is no parameter 'Maximum iteration' in 'Solver'",
        r"'Probes / far': the point \(9 9 99\)",
    ):
        says(rf"^error\[bad-input\]: scene\.prm:\d+: .*({text})", errors)
    equal("number of errors", len(messages_of(errors)), 7)


def with_faulty_ends(text: str) -> dict[str, str]:
    """Returns the text without one of its `end`s, and with one twice, each of them, by names of files."""
    lines = text.rstrip("\n").split("\n")
    ends = [i for i, line in enumerate(lines) if line.strip() == "end"]
    return {
        f"{name}_{i + 1:03d}.prm": "\n".join(lines[:i] + [lines[i]] * times + lines[i + 1 :]) + "\n"
        for name, times in (("missing", 0), ("doubled", 2))
        for i in ends
    }


def begin_of(end: int) -> int:
    """Returns the line number of the subsection of the block that ends in this line."""
    lines = BLOCK.split("\n")
    indent = len(lines[end - 1]) - len(lines[end - 1].lstrip())
    return max(i for i in range(end) if re.match(rf" {{{indent}}}subsection ", lines[i])) + 1


@check(
    "an 'end' that is missing or one too many is told where it belongs, hides no other error, and makes none"
)
def _() -> None:
    flat = "\n".join(line.strip() for line in BLOCK.split("\n"))
    wrong = edit(BLOCK, INDEPENDENT).text
    for text, n_others, every in ((BLOCK, 0, 1), (flat, 0, 3), (wrong, 7, 3)):
        files = dict(list(with_faulty_ends(text).items())[::every])
        for name, faulty_text in files.items():
            write_text(name, faulty_text)
        errors = run(PROGRAM, "--check", *files).errors
        for name in files:
            of_file = "".join(re.findall(rf"^error\[bad-input\]: {name}.*\n", errors, re.MULTILINE))
            equal(f"number of errors of {name}:\n{of_file}", len(messages_of(of_file)), n_others + 1)
            said = "has no 'end'" if name.startswith("missing") else "'end' (closes no|is probably one too)"
            says(rf"^error.*{said}", of_file)
            if text is BLOCK and name.startswith("missing"):
                begin = begin_of(int(name[len("missing_") : -len(".prm")]))
                says(rf"^error\[bad-input\]: {name}:{begin}: subsection '.*' has no 'end'", of_file)


@check("several 'end's that are missing or too many")
def _() -> None:
    errors = errors_of(
        "Material: + end & floor: + subsection lost & Plane: + subsection lost"
        " & Solver: Maximum iteration = 2"
    )
    for text in (
        r"scene\.prm:\d+: 'end' is probably one too many; it would close 'Bodies / block / Material'",
        r"subsection 'Bodies / block / Supports / floor / lost' has no 'end'; .* before line \d+",
        r"subsection 'Tools / die / Surfaces / Plane / lost' has no 'end'; .* before line \d+",
        "there is no parameter 'Maximum iteration' in 'Solver'",
    ):
        says(rf"^error\[bad-input\]: .*{text}", errors)


@check("a variant changes no body, tool or pair that the included file does not have")
def _() -> None:
    write_text("base.prm", BLOCK)
    new_tool = "subsection roll\nsubsection Surfaces\nsubsection face\nend\nend\nend\n"
    for section, lines, said in (
        (
            "Bodies",
            "subsection blok\nsubsection Material\nset Yield stress = 20\nend\nend\n",
            "no included file has the body 'blok'; did you mean 'block'? Allowed are: block, and a new body",
        ),
        (
            "Bodies",
            "subsection sheet\nsubsection Mesh\nset Refinements = 1\nend\nend\n",
            "no included file has the body 'sheet'; allowed are: block, and a new body with 'Mesh' and",
        ),
        (
            "Tools",
            "subsection dye\nsubsection Motion\nset Translation = 0 ; 0 ; -t\nend\nend\n",
            "no included file has the tool 'dye'; did you mean 'die'? Allowed are: die, and a new tool",
        ),
        (
            "Contact pairs",
            "subsection top on dye\nset Friction coefficient = 0.2\nend\n",
            "no included file has the pair 'top on dye'; did you mean 'top on die'? Allowed are: top on die,",
        ),
        ("Tools", new_tool, ""),
    ):
        variant = f"include base.prm\nsubsection {section}\n{lines}end\nset Time stepping/End tim = 2\n"
        write_text("variant.prm", variant)
        errors = run(PROGRAM, "--check", "variant.prm").errors
        equal(f"number of errors:\n{errors}", len(messages_of(errors)), 2 if said else 1)
        says(re.escape("'End tim' in 'Time stepping'; did you mean 'End time'?"), errors)
        says(rf"^error\[bad-input\]: variant\.prm:3: {re.escape(said)}" if said else "", errors)


@check("one wrong number of a material does not hide another")
def _() -> None:
    for young in ("abc", "-4"):
        errors = errors_of(
            f"block / Material: Young modulus = {young} & block / Material: Poisson ratio = -1.2"
        )
        says(rf"'Young modulus' in 'Bodies / block / Material' is '{young}'", errors)
        says(r"'Poisson ratio' in 'Bodies / block / Material' is '-1\.2'", errors)
        equal("number of errors", len(messages_of(errors)), 2)


@check("an advised word is taken for the wrong one, so that other errors of its part are found")
def _() -> None:
    errors = errors_of(
        "Time stepping: Scheme = implicit dynamic & Output: Step interval = 0.5"
        " & block: + subsection Loads\\n subsection p\\n  set Type = presure\\n  set Boundary ids = 77"
        "\\n  set Pressure = 1\\n end"
        "\\n subsection q\\n  set Boundary ids = 78\\n  set Pressure = 3*tt\\n end\\nend"
    )
    for text in (
        "'Scheme' in 'Time stepping' is 'implicit dynamic'; did you mean 'implicit dynamics'",
        "'Step interval' in 'Output' is '0.5'",
        "'Type' in 'Bodies / block / Loads / p' is 'presure'; did you mean 'pressure'",
        "'Boundary ids' in 'Bodies / block / Loads / p' names boundary id 77",
        "'Boundary ids' in 'Bodies / block / Loads / q' names boundary id 78",
        r"'Pressure' in 'Bodies / block / Loads / q' contains '3\*tt'",
    ):
        says(rf"^error\[bad-input\]: scene\.prm:\d+: .*({text})", errors)
    equal("number of errors", len(messages_of(errors)), 6)


@check("what follows from the word that is taken for a wrong scheme is left out, and named")
def _() -> None:
    # Without a density, and with parameters of static scenes.
    for scheme in ("implicit dynamic", "explicitx"):
        errors = errors_of(f"Time stepping: Scheme = {scheme} & block / Material: Young modulus = -1")
        says(rf"'Scheme' in 'Time stepping' is '{scheme}'; did you mean", errors)
        says("'Young modulus' in 'Bodies / block / Material' is '-1'", errors)
        equal("number of errors", len(messages_of(errors)), 2)
        says(r"^note\[unchecked-parts\]: .*", errors)


@check("a load without its size does not hide another error of it")
def _() -> None:
    errors = errors_of(
        "block: + subsection Loads\\n subsection p\\n  set Boundary ids = 77\\n end"
        "\\n subsection q\\n  set Type = force\\n  set Boundary ids = 78\\n end\\nend"
    )
    for name, key, ids in (("p", "Pressure", 77), ("q", "Force", 78)):
        says(rf"\(default\): '{key}' in 'Bodies / block / Loads / {name}' is .* the size of a load", errors)
        says(rf"'Boundary ids' in 'Bodies / block / Loads / {name}' names boundary id {ids}", errors)
    equal("number of errors", len(messages_of(errors)), 4)


@check("the rest of a scene that depends on a wrong word is named")
def _() -> None:
    errors = errors_of("Time stepping: Scheme = whatever & block / Material: Young modulus = -1")
    equal("number of errors", len(messages_of(errors)), 1)
    says(r"^note\[unchecked-parts\]: .*the rest of the scene", errors)


@check("all wrong names of exclusions")
def _() -> None:
    errors = errors_of(
        "+ set Contact = all\\nsubsection General contact\\n set Exclusions = block : z ; d\\nend"
    )
    for name in ("z", "d"):
        says(rf"'Exclusions' in 'General contact' names '{name}'", errors)
    equal("number of errors", len(messages_of(errors)), 2)


@check("what depends on a mesh with errors is named, and not checked")
def _() -> None:
    errors = errors_of("block / Mesh: Primitive = brick & floor: Boundary ids = 99")
    equal("number of errors", len(messages_of(errors)), 1)
    says(r"^note\[unchecked-parts\]: .*'Bodies / block' \(supports, loads, contact, probes\)", errors)
    says(r"^note\[unchecked-parts\]: .*'Contact pairs / top on die'", errors)


def two_cubes(mesh: str) -> str:
    """Returns a scene of two cubes with contact of everything, the first with these lines in its mesh."""
    lines = (
        "set Primitive = subdivided_hyper_rectangle",
        "set Arguments = 3, 3, 3 : {0}, 0, 0 : {1}, 10, 10",
    )
    other = "\n".join(lines).format(20, 30)
    return (
        "set Contact = all\nsubsection Bodies\n"
        + "".join(
            f"subsection {name}\nsubsection Mesh\n{of_mesh}\nend\n"
            "subsection Material\nset Young modulus = 1000\nend\n"
            f"set Symmetry planes = x = {x} ; y = 0 ; z = 0\nend\n"
            for name, of_mesh, x in (("a", mesh or "\n".join(lines).format(0, 10), 0), ("b", other, 20))
        )
        + "end\n"
    )


@check("what is wrong with a body's mesh is found first, and told once")
def _() -> None:
    flat = "set Primitive = hyper_rectangle\nset Arguments = 0, 0, 0 : 10, 10, 0"
    cube = "set Primitive = subdivided_hyper_rectangle\nset Arguments = 3, 3, 3 : 0, 0, 0 : 10, 10, 10\n"
    thin = cube.replace("10, 10, 10", "10, 10, 1e-70")
    for mesh, said in (
        ("", ""),
        (flat, "'Primitive' in 'Bodies / a / Mesh' is 'hyper_rectangle' .* no extent along z"),
        (thin, "'Primitive' in 'Bodies / a / Mesh' is .* no extent along z"),
        (cube + "set Positions = x ; y ; 0*z", "'Positions' .* leave the body no extent along z"),
        (cube + "set Positions = x ; y ; -z", "'Bodies / a': the element .* is degenerate or inverted"),
    ):
        write_text("cubes.prm", two_cubes(mesh))
        ended = run(PROGRAM, "--check", "cubes.prm")
        equal("exit code", ended.code, 2 if said else 0)
        equal(f"number of errors with {mesh}", len(messages_of(ended.errors)), 1 if said else 0)
        says(said, ended.errors)


@check("subsections without an end, far deeper than any scene")
def _() -> None:
    write_text("deep.prm", "subsection a\n" * 20000)
    ended = run(PROGRAM, "--check", "deep.prm")
    equal("exit code", ended.code, 2)
    says(r"deep\.prm:51: subsections are nested more than 50 deep", ended.errors)


@check("a run says the same, and writes nothing")
def _() -> None:
    write_text("scene.prm", edit(BLOCK, INDEPENDENT).text)
    ended = run(PROGRAM, "scene.prm")
    equal("exit code", ended.code, 2)
    equal("number of errors", len(messages_of(ended.errors)), 7)
    require(not Path("scene").exists() and not Path("results").exists(), "it writes")


sys.exit(check.finish())
