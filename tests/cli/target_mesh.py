#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: target_mesh.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

'Target error of = everything' on a cantilever: the error of the mesh that levels of it show is that beside a
mesh four times finer, the results of the last level are in the folder, and what is not met is said with what
it would take.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

from checks import (
    HERE,
    Checks,
    Program,
    Run,
    Runner,
    enter_folder,
    equal,
    read_text,
    require,
    run,
    says,
    write_text,
)
from edits import edit

BEAM = read_text(HERE / "cantilever.prm")
FIT = read_text(HERE.parents[1] / "prm/press_fit.prm")
# An elastic bar hits a floor.
HITS = """subsection Bodies
  subsection bar
    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = 4, 4, 16 : 0, 0, 0.02 : 4, 4, 16.02 : true
    end
    set Symmetry planes = x = 0 ; y = 0
    set Initial velocity = 0 ; 0 ; -20
    subsection Material
      set Young modulus = 1000
      set Poisson ratio = 0.3
      set Density = 1e-6
    end
  end
end
subsection Tools
  subsection floor
    subsection Surfaces
      subsection face
        set Shape = plane
      end
    end
  end
end
subsection Contact pairs
  subsection bar on floor
    set Body = bar
    set Boundary ids = 4
    set Tool = floor
  end
end
subsection Time stepping
  set Scheme = explicit
  set End time = 2e-3
end
subsection Output
  set Format = none
end
"""
runner = Runner(Program(sys.argv[1:]))
check = Checks()
enter_folder()


def billet(edits: str, ranks: int = 1, code: int = 0) -> Run:
    """Runs the cantilever with these edits."""
    ran = runner.run(BEAM, edits, ranks=ranks)
    equal("the exit code", ran.ended.code, code)
    return ran


def everything(target: str, *others: str) -> str:
    """Returns the edit for this target of everything."""
    settings = (f"Target error = {target}", "Target error of = everything", *others)
    return "+ " + "\\n".join(f"set {setting}" for setting in settings)


def levels(ran: Run) -> list[list[str]]:
    """Returns the rows of mesh_levels.csv."""
    return [line.split(",") for line in ran.text("mesh_levels.csv").split()[1:]]


FINE = "Mesh: Arguments = 32, 1, 16 : 0, 0, 0 : 20, 1, 10 & "
FORCE = "beam.support wall.force_z"
exact = 38.29618  # of FINE with another refinement

for ranks in (1, 2):

    @check(f"the error that levels of the mesh show is the true one, {ranks} ranks")
    def _() -> None:
        ran = billet(everything("3 percent"), ranks)
        rows = levels(ran)
        estimate, true = float(rows[-1][4]), abs(ran.last(FORCE) / exact - 1)
        require(len(rows) >= 3, f"{len(rows)} levels")
        require(estimate <= 0.02, f"an error of {estimate} is left")
        require(0.5 <= estimate / true <= 3.0, f"estimated {estimate}, true {true}")
        says(r"^note\[mesh-levels\]: .*of order", ran.said)
        says(r"^Mesh level -\d, coarser than given", ran.said)
        says(r"^Target error 3 % \(2 % for the mesh\):", ran.said)


@check("the results are those of the last level, and earlier levels are beside them")
def _() -> None:
    ran = billet(FINE + everything("20 percent"))
    last = int(levels(ran)[-1][0])
    require(last < 0, f"level {last} where a coarser one is good enough")
    counts = ", ".join(str(max(1, n >> -last)) for n in (32, 1, 16))
    alone = billet(f"Mesh: Arguments = {counts} : 0, 0, 0 : 20, 1, 10 & + set Target error = 0.0666667")
    equal("the force", ran.last(FORCE), alone.last(FORCE))
    ran.text(f"mesh_level_{last - 1}/history.csv")


@check("folders and files of the user stay")
def _() -> None:
    write_text("kept.prm", edit(BEAM, FINE + everything("20 percent")).text)
    mine = ("mesh_level_notes/mine", "mesh_level_-2/mine", "mesh_level_-1/mine", "scene.prm")
    for file in mine:
        Path("kept", file).parent.mkdir(parents=True, exist_ok=True)
        write_text(f"kept/{file}", "mine")
    program = Program(sys.argv[1:])
    none: list[str] = []
    for options in (none, ["--force"]):
        equal("the exit code", run(*program.on(1, *options, "--output", "kept", "kept.prm")).code, 0)
        for file in mine:
            equal(file, read_text(f"kept/{file}"), "mine")
        says("Target error of = everything", read_text("kept/scene_as_run.prm"))


@check("a beam of one element across has levels from the given mesh on, and misses 2 percent")
def _() -> None:
    free = "beam: - Symmetry planes & Mesh: Arguments = {} : 0, 0, 0 : 100, 5, 5 & "
    finest = billet(free.format("48, 4, 4") + "+ set Profile = balanced")
    ran = runner.run(BEAM, free.format("4, 1, 1") + everything("2 percent", "Finest mesh level = 1"))
    equal("the first level", levels(ran)[0][0], "0")
    true = abs(ran.last(FORCE) / finest.last(FORCE) - 1)
    require(true <= 0.02 or ran.ended.code == 7, f"{true} off, and the exit code is {ran.ended.code}")


@check("the error of a wall of one element is unknown if it bends, and known if it is pulled")
def _() -> None:
    wall = "beam: - Symmetry planes & Mesh: Arguments = 4, 1, 1 : 0, 0, 0 : 100, 5, 5"
    unknown = r"^note\[mesh-error\]: .*unknown, since parts with a single element across bend"
    said = billet(wall + " & + set Target error = 2 percent").said
    says(unknown, said)
    says("error of the mesh, about .* or far more", said)
    for edits in ("end: Displacement = 0.5*t ; 0 ; 0 & " + wall, ""):
        said = billet(edits).said
        require("single element across" not in said, said)


@check("the last line names files that exist")
def _() -> None:
    ran = billet("Output: Format = vtu & " + everything("20 percent"))
    file = says(r"Open in ParaView: (\S+)", ran.said)[1]
    require(Path(file).exists(), f"there is no {file}")


@check("a body whose part of the error is small stays behind, and the error shown is the true one")
def _() -> None:
    base = read_text(HERE / "stiff_base.prm")
    ran = runner.run(base, everything("0.5 percent"))
    equal("the exit code", ran.ended.code, 0)
    header, *_, last = (line.split(",") for line in ran.text("mesh_levels.csv").split())
    equal("the last columns", header[-2:], ["block.level", "base.level"])
    require(int(last[-2]) > int(last[-1]), f"levels {last[-2:]}")
    says(rf"^Mesh level {last[-2]}, .*, 'base' at {last[-1]}$", ran.said)
    force = "block.support top.force_z"
    fine = -1325.950  # with bricks of a quarter of the edges
    estimate, true = float(last[4]), abs(ran.last(force) / fine - 1)
    require(0.5 <= estimate / true <= 4.0, f"estimated {estimate}, true {true}")


@check("a level that is too coarse for a boundary id is left out")
def _() -> None:
    ran = billet(
        "Mesh: + set Boundary ids = 6 : x < 0.1 && z > 0.1 && z < 1.3"
        " & wall: Boundary ids = 0, 6 & " + everything("20 percent")
    )
    equal("the first level", levels(ran)[0][0], "0")
    says(r"^note\[mesh-level-failed\]: Mesh level -2 is left out: .*boundary id 6", ran.said)


@check("a target that is out of reach is told, with what it would take")
def _() -> None:
    ran = billet(everything("1e-4", "Finest mesh level = 0"), code=7)
    equal("the last level", levels(ran)[-1][0], "0")
    says(
        r"^warning\[mesh-target-missed\]: .*0\.0097 %.*'Finest mesh level' is 0\. "
        r"At this order it would take level \d",
        ran.said,
    )
    before = ran.said.rsplit("Completed in", 1)[0]
    says(r"^warning\[mesh-target-missed\]", before)
    for key in ("mesh-levels", "mesh-target-missed"):
        says(f'"key":"{key}"', ran.text("diagnostics.jsonl"))
    says(r"^Completed in .* with \d warnings?\.", ran.said)


@check("errors of penetration may take what the mesh leaves of the target, and miss it beyond")
def _() -> None:
    free = (
        "Time stepping: - Step control & Time stepping: - Initial step & fit: - Penetration tolerance"
        " & + set Target error = {} percent\\nset Target error of = everything"
    )
    for target, code in ((0.4, 0), (0.25, 7)):
        ran = runner.run(FIT, free.format(target))
        equal(f"the exit code for {target} %", ran.ended.code, code)
        estimated = dict(line.split(",") for line in ran.text("error_estimate.csv").splitlines()[1:])
        others, of_mesh = float(estimated["error"]), float(levels(ran)[-1][4])
        require(others > 0.01 * target / 3, f"the other errors are {others}, no more than a third")
        equal(f"the sum is within {target} %", others + of_mesh <= 0.01 * target, code == 0)
        equal("the warning", "warning[target-error-missed]" in ran.said, code == 7)
    says(
        r"missed\]: .* with the [0-9.]+ % of the mesh, exceeds the target, 0\.25 %; .* penetrations", ran.said
    )


@check("no coarser level is accepted that lacks a groove of the given mesh")
def _() -> None:
    grooved = (
        "Mesh: Arguments = 64, 1, 8 : 0, 0, 0 : 64, 1, 8 : true & Time stepping: Maximum step = 1 &"
        " Mesh: + set Positions = x ; y ; z*(1 - 0.5*if(abs(x - 29) < 0.9, 1, 0)) &"
        " end: Displacement = 0.064*t ; 0 ; 0 & "
    )
    alone = billet(grooved + "+ set Target error = 1 percent").last("beam.support end.force_x")
    ran = runner.run(BEAM, grooved + everything("3 percent"))
    require(int(levels(ran)[-1][0]) >= 0, "a level without the groove")
    near = abs(ran.last("beam.support end.force_x") / alone - 1)
    require(near <= 0.1, f"{near} off the given mesh")


@check("a target error of torsion goes by moments")
def _() -> None:
    twisted = read_text(HERE / "doubtful/twisted.prm")
    finer = "Mesh: Arguments = 4, 4, 8 : -1, -1, 0 : 1, 1, 8 : true & "
    ran = runner.run(twisted, finer + everything("10 %"))
    says("(moments of supports|energies) differ", ran.said)
    exact = 0.1406 * 2e5 / 2.6 * 2**4 * 0.01 / 8  # of Saint-Venant
    off = abs(ran.last("bar.support head.moment_z") / exact - 1)
    require(off <= 0.1 and ran.ended.code == 0, f"{off} off, and the exit code is {ran.ended.code}")


@check("levels of an explicit scene raise a penalty that they show to be too low")
def _() -> None:
    write_text("hits.prm", HITS + "set Target error = 4 percent\nset Target error of = everything\n")
    ended = run(*Program(sys.argv[1:]).on(1, "--output", "hits", "hits.prm"))
    equal("the exit code", ended.code, 0)
    estimates = [float(e) for e in re.findall(r"penetrations ([0-9.e-]+) %", " ".join(ended.output.split()))]
    require(len(estimates) > 1 and estimates[0] > 4.0 / 3 > estimates[-1], f"penetrations {estimates}")


@check("an error that shows on the mesh is told once, before there is a folder")
def _() -> None:
    write_text("wrong.prm", edit(BEAM, "end: Boundary ids = 9 & " + everything("3 percent")).text)
    wrong = run(*Program(sys.argv[1:]).on(1, "--output", "wrong", "wrong.prm"))
    equal("the exit code", wrong.code, 2)
    equal("the number of errors", wrong.errors.count("error["), 1)
    require(not Path("wrong").exists(), "there is a folder")


@check("what makes no sense is refused")
def _() -> None:
    for edits, said in (
        ("+ set Target error of = everything", "without a 'Target error'"),
        ("+ set Finest mesh level = 2", "without 'Target error of = everything'"),
        (everything("0.01", "Finest mesh level = 11"), "from 0 to 10"),
    ):
        says(said, billet(edits, code=2).complained)


sys.exit(check.finish())
