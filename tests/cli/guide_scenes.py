#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: guide_scenes.py BILLET

Runs in an empty current folder. Parts of scenes in the user guide must set parameters of the program, and
whole ones run. So must the examples of rare settings, from which the parameter reference takes lines. What
Getting started shows is what the program prints.
"""

from __future__ import annotations

import json
import re
import shlex
import sys
from pathlib import Path

from checks import (
    HERE,
    SHIPPED,
    Checks,
    enter_folder,
    equal,
    near,
    read_text,
    require,
    rows_of,
    run,
    says,
    write_text,
)
from shipped import require_steps

program = sys.argv[1]
check = Checks()
enter_folder()


outputs: list[str] = []  # of the first scene


@check("the first scene of the README gives the right force")
def _() -> None:
    section = read_text(SHIPPED.parent / "README.md").split("## Your first scene")[1]
    lines = [
        line[4:] for line in section.split("    billet first.prm")[0].splitlines() if line[:4] == " " * 4
    ]
    require(len(lines) <= 25, f"{len(lines)} lines")
    write_text("first.prm", "\n".join(lines) + "\n")
    ended = run(program, "first.prm")
    outputs.append(ended.output)
    equal("exit code", ended.code, 0)
    says("without warnings", ended.output)
    head, *rows = rows_of("first/history.csv")
    last = dict(zip(head, map(float, rows[-1])))
    near("travel", last["die.travel_z"], 8.0, 1e-12)
    near("force, without volume change", last["die.force_z"], 100 * 100 * 20 / 12, 1e-3)


def scenes_of_guide(*others: str) -> list[tuple[str, str]]:
    """Returns the pages of the user guide, and others of doc/, and the parts of scenes on them."""
    pages = [
        page for glob in ("guide/*.md", *others) for page in sorted((HERE.parents[1] / "doc").glob(glob))
    ]
    return [
        (page.name, part) for page in pages for part in re.findall(r"```prm\n(.*?)```", read_text(page), re.S)
    ]


@check("scenes of the user guide and the tutorials set parameters of the program")
def _() -> None:
    names = set(re.findall(r"^ *set (.*?) *=", run(program, "--print-parameters").output, re.M))
    parts = scenes_of_guide("start.md", "tutorials/*.md")
    require(len(parts) > 20, f"only {len(parts)} parts of scenes")
    for page, part in parts:
        unknown = [name for name in re.findall(r"^ *set (?:.*/)?(.*?) *=", part, re.M) if name not in names]
        equal(f"unknown on {page}", unknown, [])
        equal(f"subsections on {page}", len(re.findall(r"^ *subsection ", part, re.M)), part.count("end\n"))


PARTS_OF_EXAMPLES = ("bar.prm", "pulled.prm", "slid.prm")


@check("the examples of rare settings run without warnings")
def _() -> None:
    files = sorted((HERE.parents[1] / "examples/settings").glob("*.prm"))
    scenes = [file for file in files if file.name not in PARTS_OF_EXAMPLES]
    require(len(scenes) >= 9, f"only {len(scenes)} scenes")
    for scene in scenes:
        checked = run(program, "--check", str(scene))
        equal(f"{scene.name}: exit code of --check", checked.code, 0)
        equal(f"{scene.name}: messages of --check", checked.errors, "")
        ended = run(program, "--output", scene.stem, str(scene))
        equal(f"{scene.name}: exit code", ended.code, 0)
        says("without warnings", ended.output)


@check("whole scenes of the user guide run, the first one as in the README")
def _() -> None:
    whole = [part for _, part in scenes_of_guide() if "set Contact = all" in part and "Young modulus" in part]
    equal("number of whole scenes", len(whole), 2)
    first, pad = whole
    indented = "".join(f"    {line}\n" for line in first.splitlines()[1:])
    require(indented in read_text(SHIPPED.parent / "README.md"), "the README has another first scene")
    require(first in read_text(SHIPPED.parent / "doc/start.md"), "doc/start.md has another first scene")
    write_text("pad.prm", pad)
    ended = run(program, "pad.prm")
    equal("exit code", ended.code, 0)
    says("without warnings", ended.output)
    head, *rows = rows_of("pad/history.csv")
    last = dict(zip(head, map(float, rows[-1])))
    near("force of the punch", last["punch.force_y"], -41.5, 2e-3)
    near("force of the table", last["pad.support table.force_y"], 41.5, 2e-3)


def scene_of(name: str) -> str:
    """Returns the path of a scene that a page names."""
    for path in (SHIPPED / name.removeprefix("prm/"), SHIPPED / "templates" / name):
        if path.exists():
            return str(path)
    return name


def commands_of(text: str) -> list[tuple[str, list[str]]]:
    """Returns the scenes that a page runs, and what it sets in them; lone settings are of the first one."""
    found: list[tuple[str, list[str]]] = []
    for line in re.findall(r"^billet .*\.prm.*$", text, re.M):
        words = shlex.split(line)
        scene = next(word for word in words if word.endswith(".prm"))
        found.append((scene, [word for before, word in zip(words, words[1:]) if before == "--set"]))
    for code in re.findall(r"`(--set [^`]+)`", text):
        found.append((found[0][0], [word for word in shlex.split(" ".join(code.split())) if word != "--set"]))
    return found


@check("what Getting started and the tutorials change in scenes is accepted")
def _() -> None:
    commands: dict[str, str] = {}  # what each file stands for
    for page in (HERE.parents[1] / "doc/start.md", *sorted((HERE.parents[1] / "doc/tutorials").glob("*.md"))):
        text = read_text(page)
        if page.name == "start.md":
            write_text("first.prm", re.findall(r"^```prm\n(.*?)^```$", text, re.S | re.M)[0])
        for scene, settings in commands_of(text):
            if settings:
                file = f"command_{len(commands)}.prm"
                commands[file] = f"{page.name}: {scene} {settings}"
                lines = [f"include {scene_of(scene)}", *(f"set {setting}" for setting in settings)]
                write_text(file, "\n".join(lines) + "\n")
    require(len(commands) > 20, f"only {len(commands)} commands")
    # One start for all: --set is a line after the scene.
    ended = run(program, "--check", "--json", *commands)
    for report in map(json.loads, ended.output.splitlines()):
        require(report["valid"], f"{commands[report['file']]}: {report['diagnostics']}")


@check("the probes of the springback tutorial read what doc/site/tutorials.py computes angle and radius from")
def _() -> None:
    parts = [
        part for page, part in scenes_of_guide("tutorials/*.md") if part.startswith("include bending.prm")
    ]
    equal("scenes with probes", len(parts), 1)
    write_text("springback.prm", parts[0].replace("bending.prm", str(SHIPPED / "templates/bending.prm")))
    # The columns are those of any mesh.
    ended = run(program, "springback.prm", "--set", "Bodies/strip/Mesh/Arguments=15, 1 : 0, 0 : 45, 2")
    equal("exit code", ended.code, 0)
    columns = read_text("springback/history.csv").split("\n")[0].split(",")
    for name in ("flank.1.position_x", "flank.2.position_y", "corner.1.position_x", "corner.3.position_y"):
        require(name in columns, f"no column {name}")


@check("Getting started shows what the program prints")
def _() -> None:
    page = read_text(HERE.parents[1] / "doc/start.md")
    parts = re.findall(r"^```(\w*)\n(.*?)^```$", page, re.S | re.M)
    shown = [part for kind, part in parts if kind != "prm" and re.search("^(Completed|Gap|216 )", part, re.M)]
    equal("parts of output", len(shown), 3)
    write_text("first.prm", next(part for kind, part in parts if kind == "prm"))
    # That of the README, as is checked above, which has run.
    printed = run(program, "--check", "first.prm").output + outputs[0]
    billet = run(
        program, str(SHIPPED / "billet_upsetting.prm"), "--output", "results/billet_upsetting"
    ).output
    says(r"^note\[mesh-error\]", billet)
    printed += billet

    def settled(line: str) -> str:
        """Returns a line without what differs from machine to machine: residual, memory, time."""
        line = re.sub(r"\S*e-\d\d\b", "#", line)
        return " ".join(re.sub(r"\b\d+ MB|\b\d+:\d\d\b", "#", line).split())

    lines = {settled(line) for line in printed.splitlines()}
    for line in "".join(shown).splitlines():
        require(line.split() == ["..."] or settled(line) in lines, f"the program does not print '{line}'")
    n_files = 0
    for names in re.findall(r"^\| (`.*?`) \|", page.split("## What is in the folder")[1], re.M):
        for name in re.findall(r"`([^`]+)`", names):
            n_files += 1
            require(list(Path("first").glob(name)), f"the run wrote no '{name}'")
    require(n_files > 8, f"only {n_files} files")


@check("the tutorial of forging has the steps and iterations of this program")
def _() -> None:
    require_steps("forging", "results/billet_upsetting")


sys.exit(check.finish())
