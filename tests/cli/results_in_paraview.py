#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: results_in_paraview.py BILLET LAUNCHER...

Runs in an empty current folder; LAUNCHER and a number start BILLET on so many ranks. ParaView opens
every kind of result without a display: blocks by the names of the scene, fields at nodes and in
elements, tensors, and a picture.
"""

from __future__ import annotations

import os
import subprocess
import sys

from checks import HERE, Checks, Program, enter_folder, equal, read_text, require, run, write_text
from edits import edit

program = Program(sys.argv[1:])
check = Checks()
enter_folder()

Fields = dict[tuple[str, str, str], tuple[int, int]]  # block, kind and name: components and tuples
TENSORS = ["stress", "logarithmic_strain"]
NUMBERS = ["element_id", "body", "material"]


def pvbatch(*arguments: str, display: bool = False) -> str:
    """Runs a script by ParaView, once more where the display was not there in time."""
    for attempt in range(3):
        number = 100 + (os.getpid() + 7 * attempt) % 900  # others may start a display now, too
        server = ["xvfb-run", "-a", "-n", str(number)] if display else []
        ended = subprocess.run(
            [*server, "pvbatch", *arguments], capture_output=True, text=True, timeout=300, check=False
        )
        if "bad X server connection" not in ended.stderr + ended.stdout:
            break
    require(ended.returncode == 0, ended.stdout + ended.stderr)
    return ended.stdout


def contents(file: str) -> Fields:
    """Returns the fields that ParaView finds at the last time."""
    fields: Fields = {}
    for line in pvbatch(str(HERE / "contents_in_paraview.py"), file).splitlines():
        parts = line.split("\t")
        if len(parts) == 6:
            fields[parts[1], parts[2], parts[3]] = int(parts[4]), int(parts[5])
    return fields


def write_scene(name: str, base: str, edits: str) -> None:
    write_text(name, edit(read_text(HERE / base), edits).text)


def billet(scene: str, folder: str, *options: str, ranks: int = 1) -> None:
    ended = run(*program.on(ranks, *options, "--output", folder, scene))
    require(ended.code == 0, f"exit code {ended.code}\n{ended.output}{ended.errors}")


def require_body(fields: Fields, body: str, n_nodes: int, n_elements: int) -> None:
    """Checks what the block of a body must have."""
    block = f"Bodies/{body}"
    for tensor in TENSORS:
        equal(tensor, fields[block, "cell", tensor], (6, n_elements))
    for number in NUMBERS:
        equal(number, fields[block, "cell", number], (1, n_elements))
    equal("displacement", fields[block, "point", "displacement"], (3, n_nodes))
    equal("coordinates", fields[block, "point", "undeformed_coordinates"], (3, n_nodes))
    equal("boundary ids", fields[f"Boundaries/{body}", "cell", "boundary_id"][0], 1)


@check("static results with a tool, averaged")
def _() -> None:
    write_scene("static.prm", "block.prm", "Output: + set Nodal averages = true")
    billet("static.prm", "static")
    fields = contents("static/scene.pvd")
    require_body(fields, "block", 18, 4)
    equal("averaged stress", fields["Bodies/block", "point", "averaged_stress"], (6, 18))
    equal("pairs", fields["Contact surfaces/top on die", "cell", "pair"], (1, 2))
    require(("Tools/die", "cell", "tool") in fields, "no tool")


@check("two ranks give the same blocks")
def _() -> None:
    write_scene("ranks.prm", "block.prm", "")
    billet("ranks.prm", "ranks", ranks=2)
    billet("ranks.prm", "alone")
    equal("fields", contents("ranks/scene.pvd"), contents("alone/scene.pvd"))


@check("HDF5 gives the same fields")
def _() -> None:
    write_scene("hdf5.prm", "block.prm", "Output: + set Format = hdf5")
    billet("hdf5.prm", "hdf5")
    of_hdf5 = contents("hdf5/fields.xdmf")
    bodies = {(kind, name): size for (block, kind, name), size in of_hdf5.items() if "block" in block}
    for kind, name, size in (("cell", "stress", 4), ("point", "displacement", 18)):
        equal(name, bodies[kind, name][1], size)


@check("explicit results of two bodies")
def _() -> None:
    write_scene("impact.prm", "impact.prm", "")
    billet("impact.prm", "impact")
    fields = contents("impact/scene.pvd")
    require_body(fields, "slab", 18, 4)
    require(("Bodies/block", "point", "velocity") in fields, "no velocity")
    require(("Tools/hammer", "cell", "tool") in fields, "no tool")


@check("a preview has what the run will begin with")
def _() -> None:
    write_scene("seen.prm", "block.prm", "")
    ended = run(*program.on(1, "--preview", "--output", "seen", "seen.prm"))
    equal("exit code", ended.code, 0)
    blocks = {block for block, _kind, _name in contents("seen/preview/scene.pvd")}
    for block in ("Bodies/block", "Tools/die"):
        require(block in blocks, f"no {block} in {blocks}")


@check("a picture is drawn")
def _() -> None:
    pvbatch("static/show_in_paraview.py", "static.png", display=True)
    colours = int(pvbatch(str(HERE / "contents_in_paraview.py"), "static.png").split("\t")[-1])
    require(colours > 50, f"{colours} colours")


def shown(script: str, *arguments: str) -> list[list[str]]:
    """Returns what a script shows, each a list of words."""
    output = pvbatch(str(HERE / "shown_in_paraview.py"), script, *arguments, display=True)
    return [line.split("\t") for line in output.splitlines() if "\t" in line]


def named(lines: list[list[str]], *words: str) -> list[float]:
    """Returns the numbers of the line that begins with these words."""
    (numbers,) = [line[len(words) :] for line in lines if line[: len(words)] == list(words)]
    return [float(number) for number in numbers]


ELASTIC = (
    "Material: Law = elastic & Material: - Hardening & Material: - Yield stress"
    " & Material: - Hardening modulus & die / Motion: Translation = 0 ; 0 ; -0.1*sin(pi*t)"
)


@check("an elastic body that is unloaded is shown under its largest load, from zero")
def _() -> None:
    write_scene("unloaded.prm", "block.prm", f"{ELASTIC} & Output: Interval = 0.25")
    billet("unloaded.prm", "unloaded")
    lines = shown("unloaded/show_in_paraview.py", "unloaded.png")
    equal("time", named(lines, "time"), [0.5])
    low, high = named(lines, "colours", "von_mises_stress")
    require(low == 0 and 10 < high < 1000, f"colours from {low} to {high}")
    lines = shown("unloaded/show_in_paraview.py", "unloaded.png", "0.3")
    equal("the time nearest to that which is asked for", named(lines, "time"), [0.25])
    equal("colours of the run", named(lines, "colours", "von_mises_stress"), [low, high])


@check("a plastic one at the end, and its infinite tool no farther than it")
def _() -> None:
    lines = shown("static/show_in_paraview.py", "static.png")
    equal("time", named(lines, "time"), [1.0])
    bounds = named(lines, "part", "die")
    require(-0.5 < bounds[0] and bounds[1] < 2.5, f"a die from {bounds[0]} to {bounds[1]}")


@check("a preview names faces, loads and tools, and shows a tool that stands apart")
def _() -> None:
    edits = (
        "block: + subsection Loads\n subsection push\n set Type = pressure\n set Boundary ids = 1\n"
        " set Pressure = t\n end\n end"
        " & Plane: + set Shape = sphere\n set Centre = 9, 0, 6\n set Radius = 1"
        " & Plane: - Point & Plane: - Normal"
    )
    write_scene("apart.prm", "block.prm", edits)
    equal("exit code", run(*program.on(1, "--preview", "--output", "apart", "apart.prm")).code, 0)
    lines = shown("apart/preview/show_in_paraview.py", "apart.png")
    texts = {line[1] for line in lines if line[0] == "text"}
    for text in ("push of block", "die", "7", "1"):
        require(text in texts, f"no {text} in {texts}")
    require(named(lines, "part", "die")[1] > 9.9, "the tool is cut")


sys.exit(check.finish())
