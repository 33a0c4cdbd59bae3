#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: umat.py GFORTRAN BILLET [LAUNCHER...]

Builds a UMAT in Fortran and runs scenes with it in an empty current folder: the billet beside the program's
own law, explicit steps, restarts, two ranks; libraries and subroutines that fail must be named.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from checks import (
    HERE,
    SHIPPED,
    Checks,
    Ended,
    Program,
    enter_folder,
    near,
    read_text,
    require,
    run,
    write_text,
)
from shipped import Rows, history

compiler = sys.argv[1]
program = Program(sys.argv[2:])
check = Checks()
enter_folder()

METAL = "200e3, 0.3, 700, 300"
OWN = """
      set Elasticity        = hypoelastic
      set Young modulus     = 200e3
      set Poisson ratio     = 0.3
      set Yield stress      = 700
      set Hardening modulus = 300
"""


def umat(name: str = "J2", constants: str = METAL, more: str = "") -> str:
    """Returns the parameters of the UMAT."""
    return f"""
      set Law                   = UMAT
      set Library               = ./libumat.so
      set Constants             = {constants}
      set State variables       = 1
      set State variable names  = equivalent plastic strain
      set Material name         = {name}
      {more}
"""


def compile_library(name: str, *sources: str) -> None:
    """Builds a shared library."""
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "-o", name, *sources], check=True)


def billet(material: str, end: float = 0.5) -> str:
    """Returns the shipped scene of the billet with this material and fixed steps."""
    text = read_text(SHIPPED / "billet_upsetting.prm")
    text = re.sub(r"(subsection Material\n).*?(\n    end\n)", rf"\1{material}\2", text, flags=re.DOTALL)
    text = re.sub(r"set End time .*", f"set End time = {end}\n  set Step control = fixed", text)
    text = re.sub(r"subsection Output\n", r"subsection Output\n  set Format = none\n", text)
    return text.replace("set Layers       = 5", "set Layers = 3")


def go(scene: str, folder: str, *options: str, ranks: int = 1) -> Ended:
    """Runs a scene."""
    write_text("scene.prm", scene)
    return run(*program.on(ranks, "scene.prm", "--force", "--output", folder, *options))


def finish(scene: str, folder: str, *options: str, ranks: int = 1) -> Rows:
    """Runs a scene, which must end well."""
    ended = go(scene, folder, *options, ranks=ranks)
    require(ended.code == 0, ended.output[-2000:] + ended.errors)
    return history(folder)


def refusal(scene: str) -> str:
    """Returns what the program says of a scene that it refuses."""
    ended = go(scene, "refused")
    require(ended.code == 2 and not Path("refused").exists(), f"code {ended.code}: {ended.errors}")
    return ended.errors


def refusals(*scenes: str) -> list[str]:
    """Returns what one check says of each of these scenes, which it refuses."""
    files = [f"refused_{i}.prm" for i in range(len(scenes))]
    for file, scene in zip(files, scenes):
        write_text(file, scene)
    ended = run(program.path, "--check", *files)
    require(ended.code == 2, f"code {ended.code}: {ended.errors}")
    pattern = r"^error\[bad-input\]: {}.*(?:\n(?!error\[).*)*"
    return ["".join(re.findall(pattern.format(file), ended.errors, re.MULTILINE)) for file in files]


def says(text: str, *parts: str) -> None:
    """Requires parts of a message."""
    for part in parts:
        require(part in text, f"no '{part}' in: {text}")


compile_library("libumat.so", str(HERE / "umat" / "umat.f90"))
compile_library("libvumat.so", str(HERE / "umat" / "vumat.f90"))


@check("the billet has the forces of the hypoelastic law")
def _() -> None:
    own, rows = finish(billet(OWN), "own"), finish(billet(umat()), "umat")
    require(len(own) == len(rows) == 25, f"{len(own)} and {len(rows)} rows")
    for mine, row in zip(own, rows):
        near("force", row["die.force_z"], mine["die.force_z"], 1e-3)


@check("and, in steps of 1 %, nearly those of Hencky's law")
def _() -> None:
    hencky = finish(billet(OWN.replace("hypoelastic", "Hencky")), "hencky")
    for other, row in zip(hencky, history("umat")):
        near("force", row["die.force_z"], other["die.force_z"], 0.02)


@check("energies balance")
def _() -> None:
    row = history("umat")[-1]
    own = history("own")[-1]
    for name in row:
        if name.endswith("_energy") or name.endswith("_work"):
            if abs(own[name]) > 1:
                near(name, row[name], own[name], 0.01)


@check("two ranks have the forces of one")
def _() -> None:
    rows = finish(billet(umat(), 0.2), "two", ranks=2)
    require(len(rows) > 5, f"{len(rows)} rows")
    for one, two in zip(history("umat"), rows):
        near("force", two["die.force_z"], one["die.force_z"], 1e-6)


@check("a run resumes from a checkpoint")
def _() -> None:
    scene = billet(umat()).replace(
        "subsection Output\n",
        "subsection Output\n  subsection Checkpoint\n    set Step interval = 10\n  end\n",
    )
    finish(scene, "whole")
    finish(scene, "resumed", "--restart", str(sorted(Path("whole").glob("*checkpoint*"))[0]))
    for name in ("die.force_z", "die.force_x"):
        near(name, history("resumed")[-1][name], history("whole")[-1][name], 1e-9)


@check("a run resumes with another element, but not with another law")
def _() -> None:
    file = str(sorted(Path("whole").glob("*checkpoint*"))[0])
    other = finish(
        billet(umat()), "other", "--restart", file, "--set", "Bodies/billet/Element=mean dilatation"
    )
    near("force", other[-1]["die.force_z"], history("whole")[-1]["die.force_z"], 0.05)
    require(other[-1]["die.force_z"] != history("whole")[-1]["die.force_z"], "the same element")
    ended = go(billet(OWN), "refused", "--restart", file)
    require(ended.code == 2, f"code {ended.code}: {ended.errors}")
    says(ended.errors, "its body 'billet' is UMAT, but here it is elastoplastic with linear hardening")


@check("state variables are fields under their names")
def _() -> None:
    scene = billet(umat(), 0.1).replace(
        "set Format = none\n", "set State fields = equivalent plastic strain, clock\n"
    )
    finish(scene, "fields")
    files = sorted(Path("fields").rglob("*.vtu"))
    text = "".join(file.read_bytes().decode("latin-1") for file in files)
    says(text, "state_equivalent_plastic_strain", "state_clock_time", '"equivalent_plastic_strain"')


def pulled_cube(element: str, material: str) -> str:
    """Returns an explicit scene: a cube of eight bricks that is pulled to 1.05 of its length."""
    return f"""
subsection Bodies
  subsection cube
    set Element = {element}
    set Symmetry planes = x = 0 ; y = 0 ; z = 0
    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = 2, 2, 2 : 0, 0, 0 : 1, 1, 1 : true
    end
    subsection Material
{material}
      set Density = 7.8e-9
    end
    subsection Supports
      subsection top
        set Boundary ids = 5
        set Components = z
        set Displacement = 0 ; 0 ; 0.025*(1 - cos(pi*t/1e-4))
      end
    end
  end
end
subsection Time stepping
  set Scheme = explicit
  set End time = 1e-4
end
subsection Output
  set Format = none
end
"""


@check("an explicit pull has the forces of the hypoelastic law")
def _() -> None:
    for element in ("assumed strain", "mean dilatation"):
        mine = finish(pulled_cube(element, OWN), f"own_pull_{element}")
        rows = finish(pulled_cube(element, umat()), "umat_pull")
        name = "cube.support top.force_z"
        largest = max(abs(row[name]) for row in mine)
        require(largest > 650, f"{element}: no plastic force, {largest}")
        near(element, rows[-1][name], mine[-1][name], 0.01)
        near(f"{element}, plastic work", rows[-1]["plastic_work"], mine[-1]["plastic_work"], 0.01)


def vumat(name: str = "J2") -> str:
    """Returns the parameters of the VUMAT."""
    parameters = umat(name).replace("= UMAT", "= VUMAT").replace("libumat", "libvumat")
    return parameters + "      set Density = 7.8e-9\n"


def without_density(scene: str) -> str:
    """Returns a scene without the second of two densities."""
    return scene.replace("\n      set Density = 7.8e-9\n    end", "\n    end")


@check("a VUMAT has them, too, with its energies")
def _() -> None:
    for element in ("assumed strain", "mean dilatation"):
        mine = history(f"own_pull_{element}")[-1]
        row = finish(without_density(pulled_cube(element, vumat())), "vumat_pull")[-1]
        name = "cube.support top.force_z"
        near(element, row[name], mine[name], 0.01)
        near(f"{element}, plastic work", row["plastic_work"], mine["plastic_work"], 0.01)


@check("a VUMAT runs in the static billet, its tangent by differences")
def _() -> None:
    rows = finish(billet(vumat(), 0.2), "vumat")
    for mine, row in zip(history("own"), rows):
        near("force", row["die.force_z"], mine["die.force_z"], 0.005)


def certify(name: str, *options: str) -> Ended:
    """Certifies a UMAT."""
    write_text("material.prm", umat(name))
    return run(program.path, "--certify", *options, "material.prm")


@check("elements with one point are refused: their stabilisation would not yield")
def _() -> None:
    scenes = pulled_cube("one point", umat()), without_density(pulled_cube("one point", vumat()))
    for refused in refusals(*scenes):
        says(
            refused,
            "'Element'",
            "'one point'",
            "'Element = assumed strain' or 'Element = mean dilatation', since the law is a subroutine",
        )


BEAM = """
subsection Bodies
  subsection beam
    set Element = mean dilatation
    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = 8, 2, 2 : 0, 0, 0 : 8, 1, 1 : true
    end
    subsection Material
MATERIAL
    end
    subsection Supports
      subsection root
        set Boundary ids = 0
      end
      subsection tip
        set Boundary ids = 1
        set Components = z
        set Displacement = 0 ; 0 ; 3*t
      end
    end
  end
end
subsection Time stepping
  set Scheme = quasi-static
  set End time = 1
  set Initial step = 0.05
  set Step control = fixed
end
subsection Output
  set Format = none
end
"""


@check("elements of a plastic beam have no lower bound of their stiffness")
def _() -> None:
    ended = go(BEAM.replace("MATERIAL", umat(constants="200e3, 0.3, 250, 500")), "beam")
    require(ended.code == 0, ended.output + ended.errors)
    require("at least this factor" not in ended.output + ended.errors, ended.output + ended.errors)


@check("writing outside of an array is refused, with the material and the array")
def _() -> None:
    umats, vumats = ("BEYOND STATEV", "FAR BEYOND STATEV"), ("BEYOND STATENEW", "FAR BEYOND STATENEW")
    scenes = [*(billet(umat(name)) for name in umats), *(billet(vumat(name)) for name in vumats)]
    refused = refusals(*scenes, billet(umat("BEYOND STRESS")))
    for name, text in zip(umats, refused):
        says(text, f"UMAT '{name}'", "wrote outside of the array STATEV", "NSTATV")
    for name, text in zip(vumats, refused[2:]):
        says(text, f"VUMAT '{name}'", "wrote outside of the array stateNew")
    says(refused[-1], "wrote outside of the array STRESS")


@check("a UMAT that changes PROPS changes them for itself alone")
def _() -> None:
    for one, two in zip(finish(billet(umat(), 0.1), "umat"), finish(billet(umat("PROPS"), 0.1), "props")):
        near("force", two["die.force_z"], one["die.force_z"], 1e-12)


@check("messages of STDB_ABQERR are the program's, on two ranks, too")
def _() -> None:
    for ranks in 1, 2:
        ended = go(billet(umat("WARNS"), 0.1), "warns", ranks=ranks)
        require(ended.code == 0, ended.output + ended.errors)
        says(ended.output + ended.errors, "warning[subroutine-warning]: strain 0.0", "of TEST (time")
        require((ended.output + ended.errors).count("strain 0.0") == 1, ended.output + ended.errors)
        says(read_text("warns/diagnostics.jsonl"), '"subroutine-warning"')
    ended = go(billet(umat("WARNS"), 0.1), "warns", "--set", "Warnings=errors")
    require(ended.code == 6, f"code {ended.code}: {ended.errors}")
    ended = go(billet(umat("ENDS"), 0.1), "ends")
    require(ended.code == 3, f"code {ended.code}: {ended.errors}")
    says(ended.output + ended.errors, "subroutine-error", "is too large", "ended the analysis by XIT")


@check("without energies of its own, the work of its stresses is stored energy")
def _() -> None:
    scene = billet(umat("NO ENERGY"), 0.1)
    ended = go(scene, "no_energy")
    require(ended.code == 0, ended.output + ended.errors)
    says(ended.output + ended.errors, "note[energies-not-separated]", "UMAT 'NO ENERGY'")
    pulled = finish(pulled_cube("assumed strain", umat("NO ENERGY")), "no_energy_pull")
    for row in history("no_energy")[-1], pulled[-1]:
        near("elastic energy", row["elastic_energy"], row["external_work"], 0.01)
        require(row["plastic_work"] == 0 and row["elastic_energy"] > 1, f"energies {row}")
    ended = certify("NO ENERGY")
    require(ended.code == 0, ended.output + ended.errors)
    says(ended.output, "not tried: the subroutine returns no stored energy")


@check("a library's own DDOT is called, and its SDVINI is named as not called")
def _() -> None:
    write_text(
        "ddot.f90",
        """
double precision function ddot(n)
  integer :: n
  ddot = n
end function
subroutine sdvini
end subroutine
""",
    )
    source = read_text(HERE / "umat" / "umat.f90")
    source = source.replace("  implicit none\n", "  implicit none\n  double precision, external :: ddot\n", 1)
    source = source.replace("  bulk = props(1)", "  if (ddot(7) /= 7) call xit\n  bulk = props(1)", 1)
    write_text("with_ddot.f90", source)
    compile_library("libddot.so", "with_ddot.f90", "ddot.f90")
    ended = go(billet(umat(), 0.1).replace("libumat", "libddot"), "ddot")
    require(ended.code == 0, ended.output + ended.errors)
    says(ended.output + ended.errors, "warning[idle-subroutines]", "SDVINI, which the program does not call")


@check("a VUMAT that fails is named")
def _() -> None:
    ended = go(without_density(pulled_cube("assumed strain", vumat("CRASH"))), "failed")
    require(ended.code == 3, f"code {ended.code}: {ended.errors}")
    says(ended.errors, "VUMAT 'CRASH' of library './libvumat.so' crashed by a segmentation fault")
    ended = go(without_density(pulled_cube("assumed strain", vumat("STRESS"))), "failed")
    require(ended.code == 3, f"code {ended.code}: {ended.errors}")
    says(ended.errors, "VUMAT 'STRESS' of library './libvumat.so' returned a stress that is not a number")


@check("a VUMAT without density, and libraries of the other kind, are refused")
def _() -> None:
    for text, part in zip(
        refusals(
            billet(vumat().replace("set Density", "# set Density")),
            billet(vumat().replace("libvumat", "libumat")),
            billet(umat().replace("libumat", "libvumat")),
        ),
        ("'Density'", "symbol 'vumat_'", "symbol 'umat_'"),
    ):
        says(text, part)


@check("the UMAT's shorter step is taken")
def _() -> None:
    scene = billet(umat("CUT"), 0.1).replace("set Step control = fixed", "set Step control = automatic")
    rows = finish(scene, "cut", "--set", "Time stepping/Minimum step=0.001")
    require(len(rows) > 15, f"{len(rows)} rows")


for name, words in {
    "CRASH": "crashed by a segmentation fault",
    "ZERO": "crashed by an arithmetic exception",
    "XIT": "ended the analysis by XIT",
}.items():
    for ranks in (1, 2) if name == "CRASH" else (1,):

        @check(f"{name} on {ranks} ranks is named, and the run keeps its results")
        def _() -> None:
            ended = go(billet(umat(name)), "failed", ranks=ranks)
            require(ended.code == 3, f"code {ended.code}: {ended.errors}")
            says(ended.errors, f"UMAT '{name}' of library './libumat.so' {words}", "billet")
            require(history("failed"), "no history")


for name, what in {"STRESS": "stress", "TANGENT": "tangent"}.items():

    @check(f"{name}: a {what} that is not a number is named")
    def _() -> None:
        ended = go(billet(umat(name)), "failed")
        require(ended.code == 3, f"code {ended.code}: {ended.errors}")
        says(ended.errors, f"UMAT '{name}' of library './libumat.so' returned a {what} that is not a number")


@check("STOP is named")
def _() -> None:
    ended = go(billet(umat("STOP")), "failed")
    require(ended.code == 3, f"code {ended.code}: {ended.errors}")
    says(ended.errors, "UMAT 'STOP' of library './libumat.so' has ended the program")


@check("a crash in an explicit run is named")
def _() -> None:
    ended = go(pulled_cube("assumed strain", umat("CRASH")), "failed")
    require(ended.code == 3, f"code {ended.code}: {ended.errors}")
    says(ended.errors, "UMAT 'CRASH' of library './libumat.so' crashed by a segmentation fault")


@check("a wrong tangent is a warning before the run")
def _() -> None:
    ended = go(billet(umat("WRONG TANGENT")), "failed", "--set", "Time stepping/End time=0.02")
    says(
        ended.output + ended.errors,
        "warning[wrong-tangent]",
        "UMAT 'WRONG TANGENT' of library './libumat.so'",
    )
    nearly_incompressible = umat("SOFT SHEAR", "200e3, 0.4999, 700, 300")
    ended = go(billet(nearly_incompressible), "failed", "--set", "Time stepping/End time=0.02")
    says(ended.output + ended.errors, "warning[wrong-tangent]", "UMAT 'SOFT SHEAR'")
    ended = go(billet(umat("UNSYMMETRIC")), "failed", "--set", "Time stepping/End time=0.02")
    says(ended.output + ended.errors, "it is unsymmetric by", "Set 'Unsymmetric tangent = true'")
    ended = go(billet(umat()), "failed", "--set", "Time stepping/End time=0.02")
    require("wrong-tangent" not in ended.output + ended.errors, ended.output + ended.errors)


@check("a crash in the first call is refused")
def _() -> None:
    says(
        refusal(billet(umat("CRASH AT ONCE"))),
        "'Library'",
        "crashed by a segmentation fault",
        "at the undeformed point",
    )


@check("a library that is not there is refused")
def _() -> None:
    says(
        refusal(billet(umat().replace("libumat", "nowhere"))),
        "'Library'",
        "nowhere.so",
        "a file that can be read",
    )


@check("no library is refused, as is one without umat_, or that lacks a subroutine, by its name")
def _() -> None:
    write_text("other.f90", "subroutine vumat\nend subroutine\n")
    compile_library("libother.so", "other.f90")
    write_text("lacking.f90", "subroutine umat\n call kdamage\nend subroutine\n")
    compile_library("liblacking.so", "lacking.f90")
    names = ("scene.prm", "libother.so", "liblacking.so")
    for text, parts in zip(
        refusals(*(billet(umat().replace("libumat.so", name)) for name in names)),
        (("the system can load", "gfortran -shared"), ("symbol 'umat_'", "nm -D"), ("kdamage_",)),
    ):
        says(text, *parts)


@check("parameters that do not fit are refused")
def _() -> None:
    cases = (
        (umat(more="set Yield stress = 700"), "'Yield stress'", "'Law = UMAT' does not use it"),
        (umat(more="set Young modulus = 7"), "'Young modulus'", "'Law = UMAT' does not use it"),
        (umat(more="set Initial state variables = 0, 1"), "as many numbers as 'State variables' says"),
        (umat(more="set Temperature = 20"), "'Temperature'", "does not depend on it"),
        (umat(constants="200e3, -1.5, 7, 3"), "shear modulus", "both must be above 0"),
        (OWN + "\n set Constants = 1, 2\n", "'Constants'", "does not use it"),
    )
    for text, (_, *parts) in zip(refusals(*(billet(material) for material, *_ in cases)), cases):
        says(text, *parts)


@check("the UMAT passes its certification, on a page of text or Markdown")
def _() -> None:
    ended = certify("J2")
    require(ended.code == 0, ended.output + ended.errors)
    says(ended.output, "UMAT 'J2' of library './libumat.so'", "tangent ", "The law passes", "uniaxial strain")
    says(ended.output, "not tried: 'Constants' has the unit [any unit]")
    ended = certify("J2", "--markdown")
    require(ended.code == 0, ended.output + ended.errors)
    says(ended.output, "# Body 'material'", "| objectivity ", "|---")


for name, words in {
    "WRONG TANGENT": "tangent .* FAIL",
    "ELASTIC BEYOND 5 %": "tangent .* FAIL .*after a strain of 0.1",
    "UNSYMMETRIC": "symmetry of the tangent .* FAIL .*'Unsymmetric tangent = true'",
    "STRESS": "steps of 1e-6 to 0.5 .* FAIL .*refuses a step of 0.1",
    "CRASH": "UMAT 'CRASH' of library './libumat.so' crashed by a segmentation fault",
}.items():

    @check(f"{name} fails its certification")
    def _() -> None:
        ended = certify(name)
        require(ended.code == 3, f"code {ended.code}: {ended.errors}")
        require(re.search(words, ended.output) and "The law FAILS" in ended.output, ended.output)


@check("the VUMAT passes its certification")
def _() -> None:
    write_text("material.prm", vumat())
    ended = run(program.path, "--certify", "material.prm")
    require(ended.code == 0, ended.output + ended.errors)


@check("certification of scenes, and of nothing")
def _() -> None:
    ended = run(program.path, "--certify", str(SHIPPED / "billet_deformable_dies.prm"))
    require(ended.code == 0 and ended.output.count("The law passes") >= 2, ended.output + ended.errors)
    ended = run(program.path, "--certify", "nowhere.prm")
    require(ended.code == 2 and "nowhere.prm" in ended.errors, f"code {ended.code}: {ended.errors}")
    ended = run(program.path, "--markdown", "scene.prm")
    require(ended.code == 2 and "'--markdown' is not allowed here" in ended.errors, ended.errors)


sys.exit(check.finish())
