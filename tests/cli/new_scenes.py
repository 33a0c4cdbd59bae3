#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: new_scenes.py BILLET

Runs in an empty current folder. Each template of prm/templates must be what --new writes, pass --check, and
run to its end; those that take long run over a part of their time. --list must name all registered types.
Parts of scenes in the user guide must set parameters of the program, and whole ones run. So must the examples
of rare settings, from which the parameter reference takes lines.
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
from edits import edit

TEMPLATES = sorted((SHIPPED / "templates").glob("*.prm"))
PARTS = {"drawing": 0.05, "rolling": 0.05, "impact": 0.1}  # of the time
MAX_LINES = 45
LISTS = "primitives materials elements loads surfaces friction integrators probes fields history".split()

program = sys.argv[1]
check = Checks()
enter_folder()


@check("the templates that were asked for")
def _() -> None:
    kinds = [template.stem for template in TEMPLATES]
    equal("kinds", kinds, ["bending", "drawing", "forging", "impact", "press-fit", "rolling"])


for template in TEMPLATES:
    kind = template.stem

    @check(f"{kind} is written, once")
    def _() -> None:
        ended = run(program, "--new", kind)
        equal("exit code", ended.code, 0)
        says(rf"^Wrote {kind}\.prm\.", ended.output)
        equal("scene", read_text(f"{kind}.prm"), read_text(template))
        require(read_text(template).count("\n") <= MAX_LINES, f"more than {MAX_LINES} lines")
        write_text(f"{kind}.prm", "mine")
        ended = run(program, "--new", kind)
        equal("exit code", ended.code, 2)
        says(rf"^error\[bad-input\]: command line: '{kind}\.prm' exists", ended.errors)
        equal("my file", read_text(f"{kind}.prm"), "mine")

    @check(f"{kind} is sound")
    def _() -> None:
        ended = run(program, "--check", str(template))
        equal("exit code", ended.code, 0)
        require(not ended.errors, ended.errors)

    @check(f"{kind} runs")
    def _() -> None:
        end = re.search(r"set End time *= (\S+)", read_text(template))
        part = (float(end[1]) if end else 1.0) * PARTS.get(kind, 1.0)
        options = ["--output", f"run_{kind}", "--set", f"Time stepping/End time={part}"]
        ended = run(program, str(template), *options)
        equal("exit code", ended.code, 0)
        warned = re.findall(r"^warning.*", ended.output, re.MULTILINE)
        require(not warned or kind == "drawing", "\n".join(warned))


@check("to another file")
def _() -> None:
    equal("exit code", run(program, "--new", "forging", "mine.prm").code, 0)
    equal("scene", read_text("mine.prm"), read_text(SHIPPED / "templates/forging.prm"))


@check("the pressure of the fit is Lamé's")
def _() -> None:
    # p = E d / (4 R^3) (R^2 - a^2) (b^2 - R^2) / (b^2 - a^2) / (1 - nu^2) 2 for equal materials, plane strain
    ended = run(program, str(SHIPPED / "templates/press-fit.prm"))
    equal("exit code", ended.code, 0)
    rows = [line.split(",") for line in read_text("press-fit/history.csv").splitlines()]
    column = next(i for i, name in enumerate(rows[0]) if name.endswith(".force_x"))
    a, radius, b = 10.0, 20.0, 30.0
    pressure = (
        200e3
        / (1 - 0.3**2)
        * 0.02
        * (radius**2 - a**2)
        * (b**2 - radius**2)
        / (2 * radius**3 * (b**2 - a**2))
    )
    # On a quarter of a ring of width 1, force_x is p R; chords of 24 elements and strains of 1e-3 make 1.1 %.
    near("force", abs(float(rows[-1][column])), pressure * radius, 0.015)


@check("the planes of plane strain move with the mesh")
def _() -> None:
    text = read_text(SHIPPED / "templates/press-fit.prm")
    moved = "set Rotation axis = 1, 0, 0\nset Rotation angle = 90\nset Translation = 1, 2, 3\nset Refinements"
    text = text.replace("set Refinements", moved).replace("planes = x = 0 ; y = 0", "planes = x = 1 ; z = 3")
    write_text("moved.prm", text)
    equal("exit code", run(program, "moved.prm").code, 0)
    forces = []
    for folder in ("press-fit", "moved"):
        rows = [line.split(",") for line in read_text(f"{folder}/history.csv").splitlines()]
        column = next(i for i, name in enumerate(rows[0]) if name.endswith(".force_x"))
        forces.append(float(rows[-1][column]))
    near("force", forces[1], forces[0], 1e-6)


@check("unknown kinds")
def _() -> None:
    ended = run(program, "--new", "forgng")
    equal("exit code", ended.code, 2)
    says(r"allowed is one of: bending, drawing, .*; did you mean 'forging'\?", ended.errors)
    says("names no kind of scene; allowed is one of: bending", run(program, "--new").errors)


@check("the lists")
def _() -> None:
    listed = json.loads(run(program, "--list", "--json").output)
    equal("lists", [entry["name"] for entry in listed], LISTS)
    for name in LISTS:
        ended = run(program, "--list", name)
        equal("exit code", ended.code, 0)
        entries = json.loads(run(program, "--list", name, "--json").output)
        require(entries, f"{name} is empty")
        for entry in entries:
            says(rf"^{re.escape(entry['name'])}$", ended.output)
        wide = [line for line in ended.output.splitlines() if len(line) > 100]
        equal(f"wide lines of {name}", wide, [])


# Edits by which a scene of block.prm names an entry of each list, KEY = NAME.
USES = {
    "primitives": "Mesh: - Arguments & Mesh: - Boundary ids & Mesh: {}",
    "materials": "Material: - Hardening & Material: {}",
    "elements": "block: {}",
    "loads": "block: + subsection Loads\n subsection x\n set {}\n end\nend",
    "surfaces": "Plane: - Point & Plane: {}",
    "friction": "top on die: - Friction coefficient & top on die: {}",
    "integrators": "+ subsection Implicit dynamics\n set {}\nend & Time stepping: Scheme = implicit dynamics",
    "probes": "+ subsection Probes\n subsection x\n set {}\n end\nend",
}


@check("what the lists say is what scenes may say")
def _() -> None:
    base = read_text(HERE / "block.prm")
    keys: dict[str, str] = {}  # of each scene
    for name, use in USES.items():
        for entry in json.loads(run(program, "--list", name, "--json").output):
            statement = next(
                part
                for part in entry["use"].split("; ")
                if not part.startswith(("set Source", "set Arguments"))
            )
            setting = statement.removeprefix("set ")
            text = edit(base, use.format(setting)).text
            if "Source = extruded" in entry["use"]:
                text = text.replace("= primitive", "= extruded primitive")
            file = f"listed_{len(keys)}.prm"
            write_text(file, text)
            keys[file] = setting.split(" = ")[0]
    errors = run(program, "--check", *keys).errors
    for file, key in keys.items():
        wrong_value = rf"'{key}' in '[^']*' is [^;]*; (allowed is one of|did you)"
        unknown = rf"^error.*{file}.*(no parameter '{key}'|{wrong_value})"
        wrong = re.search(unknown, errors, re.MULTILINE)
        require(wrong is None, wrong[0] if wrong else "")


@check("columns of histories have a meaning")
def _() -> None:
    known = []
    for entry in json.loads(run(program, "--list", "history", "--json").output):
        require(entry["parameters"], f"{entry['name']} has no columns")
        for columns in entry["parameters"]:
            require(columns["meaning"].endswith(("]", ".")), columns["name"])
            known += columns["name"].split(", ")
    patterns = [re.sub(r"\b[A-Z]+\b", ".+", re.escape(name)) for name in known]
    for kind in PARTS:
        header = read_text(f"run_{kind}/history.csv").split("\n")[0]
        for column in header.split(","):
            require(any(re.fullmatch(one, column) for one in patterns), f"{column} has no meaning")


@check("one entry of a list")
def _() -> None:
    ended = run(program, "--list", "primitives", "quarter_hyper_shell")
    says(r"^ +Boundary ids: +0 inner face; 1 outer face; 2 least x; 3 least y; 4 least z$", ended.output)
    says(r"^ +inner radius = necessary +> 0\. Inner radius\. \[length\]$", ended.output)
    require("torus" not in ended.output, ended.output)
    says("; did you mean 'torus'", run(program, "--list", "primitives", "tours").errors)
    says("; did you mean 'primitives'", run(program, "--list", "primitvs").errors)


@check("the first scene of the README gives the right force")
def _() -> None:
    section = read_text(SHIPPED.parent / "README.md").split("## Your first scene")[1]
    lines = [
        line[4:] for line in section.split("    billet first.prm")[0].splitlines() if line[:4] == " " * 4
    ]
    require(len(lines) <= 25, f"{len(lines)} lines")
    write_text("first.prm", "\n".join(lines) + "\n")
    ended = run(program, "first.prm")
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
    n_commands = 0
    for page in (HERE.parents[1] / "doc/start.md", *sorted((HERE.parents[1] / "doc/tutorials").glob("*.md"))):
        text = read_text(page)
        if page.name == "start.md":
            write_text("first.prm", re.findall(r"^```prm\n(.*?)^```$", text, re.S | re.M)[0])
        for scene, settings in commands_of(text):
            if settings:
                n_commands += 1
                options = [word for setting in settings for word in ("--set", setting)]
                ended = run(program, "--check", scene_of(scene), *options)
                require(ended.code == 0, f"{page.name}: {scene} {settings}: {ended.errors}")
    require(n_commands > 20, f"only {n_commands} commands")


@check("the probes of the springback tutorial read what doc/site/tutorials.py computes angle and radius from")
def _() -> None:
    parts = [
        part for page, part in scenes_of_guide("tutorials/*.md") if part.startswith("include bending.prm")
    ]
    equal("scenes with probes", len(parts), 1)
    write_text("springback.prm", parts[0].replace("bending.prm", str(SHIPPED / "templates/bending.prm")))
    ended = run(program, "springback.prm")
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
    printed = run(program, "--check", "first.prm").output + run(program, "first.prm").output
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


@check("tutorials have the steps and iterations of this program")
def _() -> None:
    _, *rows = rows_of(str(HERE.parents[1] / "doc/tutorials/values.csv"))
    kept = {row[0]: row[2] for row in rows if row[1] == "steps and Newton iterations"}
    for name, folder in (("springback", "run_bending"), ("forging", "results/billet_upsetting")):
        head, *rows = rows_of(f"{folder}/history.csv")
        last = dict(zip(head, map(float, rows[-1])))
        n_steps, n_iterations = map(float, kept[name].split(" and "))
        near(f"steps of {name}", last["step"], n_steps, 0.1)  # other machines round otherwise
        near(f"iterations of {name}", last["total_iterations"], n_iterations, 0.1)


sys.exit(check.finish())
