#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: update.py BILLET

Runs in an empty current folder. Scenes under old names of parameters (old/*.prm, which use all of them) must
run with one warning for each, and as the same scenes under the new ones, into which --update-scene turns
them. Scenes of prm/ as they were before the renames (old/shipped/*.prm) must be accepted with warnings, and
be turned into those of prm/; a change of values there is one here, too.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import NamedTuple

from checks import HERE, Checks, Ended, enter_folder, equal, read_text, require, run, says, write_text

RENAMES = HERE.parents[1] / "source/parameters/renames.cc"
OLD = sorted((HERE / "old").glob("*.prm"))
SHIPPED = sorted((HERE / "old/shipped").glob("*.prm"))
STEPS = "subsection Solver\n"


class Rename(NamedTuple):
    """A line of the table of renamed parameters."""

    path: str
    old: str
    new: str
    values: list[tuple[str, str]]


def read_renames() -> list[Rename]:
    """Returns the table."""
    entry = r'\{\{("[^{}]*")\},\s*"([^"]*)",\s*"([^"]*)",\s*\{((?:\s*\{"[^{}]*"\},?)*)\}\},'
    found = []
    for match in re.finditer(entry, read_text(RENAMES)):
        names = re.findall(r'"(.*?)"', match[4])
        path = "/".join(re.findall(r'"(.*?)"', match[1]))
        found.append(Rename(path, match[2], match[3], list(zip(names[::2], names[1::2]))))
    return found


program = sys.argv[1]
check = Checks()
enter_folder()
table = read_renames()


def update(*files: str, code: int = 0) -> Ended:
    """Updates a scene."""
    ended = run(program, "--update-scene", *files)
    equal("exit code", ended.code, code)
    return ended


def updated(text: str) -> str:
    """Returns the text of an updated scene."""
    write_text("short.prm", text)
    return update("short.prm").output


def without_warnings(text: str) -> str:
    """Returns what was printed, but for warnings of old names and their count."""
    return re.sub(r"^warning\[old-name\].*\n", "", text, flags=re.MULTILINE)


def by_new_names(text: str) -> str:
    """Returns the scene with names replaced by the table, and one blank for several."""
    for rename in table:
        words = r"\s+".join(rename.old.split())
        text = re.sub(rf"(?m)^(\s*set\s+){words}(?=\s*=)", rf"\g<1>{rename.new}", text)
        for old, new in rename.values:
            text = re.sub(rf"(?m)^(\s*set\s+{rename.new}\s*=\s*){old}(?=\s*$)", rf"\g<1>{new}", text)
    return re.sub(r"[ \t]+", " ", text)


@check("the scenes use every old name")
def _() -> None:
    equal("number of renames", len(table), read_text(RENAMES).count("\n      {{"))
    text = "".join(map(read_text, OLD))
    for rename in table:
        says(rf"^\s*set {rename.old}\s*=", text)
        for old, _new in rename.values:
            says(rf"^\s*set {rename.old}\s*= {old}$", text)


for scene in OLD:
    scene_text = read_text(scene)

    @check(f"{scene.stem}: old and new names are one scene")
    def _(text: str = scene_text) -> None:
        n_old = sum(
            len(re.findall(rf"(?m)^\s*set {rename.old}\s*=", text))
            for rename in {rename.old: rename for rename in table}.values()
        )
        write_text("scene.prm", text)
        before = run(program, "--check", "scene.prm")
        equal("exit code", before.code, 0)
        equal("number of warnings", before.output.count("warning[old-name]"), n_old)
        ran = run(program, "scene.prm")
        equal("exit code of the run", ran.code, 0)
        equal("number of warnings of the run", ran.output.count("warning[old-name]"), n_old)
        history = read_text("results/history.csv")

        ended = update("scene.prm", "scene.prm")
        equal("number of changes", ended.output.count(" is now "), n_old)
        new = read_text("scene.prm")
        require(by_new_names(text) == re.sub(r"[ \t]+", " ", new), f"becomes:\n{new}")
        after = run(program, "--check", "scene.prm")
        equal("exit code", after.code, 0)
        equal("the check", after.output, without_warnings(before.output))
        ran = run(program, "scene.prm")
        require("old-name" not in ran.output, ran.output)
        equal("history", read_text("results/history.csv"), history)

        again = update("scene.prm")
        equal("the update of what is updated", again.output, new)
        equal("its report", again.errors, "scene.prm: all names are current\n")


@check("an old name is a warning that is no error where warnings are errors, beside others that are")
def _() -> None:
    text = read_text(HERE / "block.prm").replace(STEPS, STEPS + "  set Most iterations = 40\n")
    for penalty, code, counted in (("10", 0, "1 warning"), ("1e-3", 6, "3 warnings")):
        write_text("block.prm", re.sub(r"(Normal penalty +=) 10", rf"\1 {penalty}", text))
        ran = run(program, "block.prm", "--set", "Warnings=errors")
        equal("exit code", ran.code, code)
        says(rf"^Completed in \S+ with {counted}\.", ran.output)
        says(r"^warning\[old-name\]", ran.output)


@check("there are shipped scenes with old names")
def _() -> None:
    require(len(SHIPPED) >= 3, f"{len(SHIPPED)} of them")


for shipped in SHIPPED:
    scene_text = read_text(shipped)
    now = HERE.parents[1] / "prm" / shipped.name

    @check(f"{shipped.stem}: as it was shipped, it is the scene of today")
    def _(text: str = scene_text, today: Path = now) -> None:
        write_text("shipped.prm", text)
        before = run(program, "--check", "shipped.prm")
        equal("exit code", before.code, 0)
        n_old = before.output.count("warning[old-name]")
        require(n_old > 0, f"no warning:\n{before.output}")
        ended = update("shipped.prm", "shipped.prm")
        equal("number of changes", ended.output.count(" is now "), n_old)
        after = run(program, "--check", "shipped.prm")
        equal("exit code", after.code, 0)
        equal("the check", after.output, without_warnings(before.output))
        of_today = run(program, "--check", str(today))
        equal(
            "the report, but for its first line",
            of_today.output.split("\n")[1:],
            after.output.split("\n")[1:],
        )


@check("a new scene stays as it is")
def _() -> None:
    text = read_text(HERE / "block.prm")
    equal("block.prm", updated(text), text)


@check("layout stays")
def _() -> None:
    equal(
        "one blank",
        updated(STEPS + "set Most iterations = 9\nend"),
        STEPS + "set Maximum iterations = 9\nend",
    )
    equal(
        "a column",
        updated(STEPS + "  set Force tolerance    = 1e-3\n  set Most iterations    = 9  # few\nend\n"),
        STEPS + "  set Force tolerance    = 1e-3\n  set Maximum iterations = 9  # few\nend\n",
    )
    equal(
        "no blank", updated(STEPS + "set Most iterations=9\nend\n"), STEPS + "set Maximum iterations=9\nend\n"
    )
    equal(
        "tabs, lines that continue, and ends of lines",
        updated("subsection\tSolver \r\n\tset\tMost \\\r\n iterations\t=\t\\\r\n9\r\nend\r\n"),
        "subsection\tSolver \r\n\tset\tMaximum iterations\t=\t\\\r\n9\r\nend\r\n",
    )
    equal(
        "a comment",
        updated("# set Most iterations = 9\n" + STEPS + "end"),
        "# set Most iterations = 9\n" + STEPS + "end",
    )


@check("included files are named and left")
def _() -> None:
    part = STEPS + "  set Most iterations = 9\nend\n"
    write_text("part.prm", part)
    text = "include part.prm   # the rules\n" + read_text(HERE / "block.prm").replace(
        STEPS, "subsection Solver \n"
    )
    write_text("whole.prm", text)
    ended = update("whole.prm")
    equal("the scene", ended.output, text)
    equal(
        "the report",
        ended.errors,
        "part.prm:2: 'Most iterations' is now 'Maximum iterations'; this included file does not change,"
        " so update it too\n",
    )
    ended = run(program, "--check", "whole.prm")
    says(
        r"^warning\[old-name\]: 'Most iterations' in 'Solver' is the old name of 'Maximum iterations'"
        r" \(part.prm:2\). Write 'Maximum iterations', or convert the scene by 'billet --update-scene'.$",
        ended.output,
    )
    equal("the report", update("part.prm", "part.prm").output.count("\n"), 1)
    require("old-name" not in run(program, "--check", "whole.prm").output, "there is still an old name")
    require(Path("part.prm").read_text() == part.replace("Most", "Maximum"), "the part is not updated")


@check("a target that cannot be written")
def _() -> None:
    write_text("short.prm", STEPS + "end\n")
    says(
        "'nowhere/new.prm' cannot be written; allowed is the name of a writable file",
        update("short.prm", "nowhere/new.prm", code=2).errors,
    )


sys.exit(check.finish())
