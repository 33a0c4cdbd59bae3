#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: new_scenes.py BILLET

Runs in an empty current folder. Each template of prm/templates must be what --new writes, pass --check, and
run to its end; those that take long run over a part of their time. --list must name all registered types.
"""

from __future__ import annotations

import json
import re
import sys

from checks import (
    HERE,
    SHIPPED,
    Checks,
    enter_folder,
    equal,
    near,
    read_text,
    require,
    run,
    says,
    write_text,
)
from edits import edit
from shipped import require_steps

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
    rows = [line.split(",") for line in read_text("run_press-fit/history.csv").splitlines()]
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
    for folder in ("run_press-fit", "moved"):
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


@check("the tutorial of springback has the steps and iterations of this program")
def _() -> None:
    require_steps("springback", "run_bending")


sys.exit(check.finish())
