#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: layers.py [ROOT]
       layers.py --self-check

Keeps the layers of the code apart: a file in include/billet/LAYER or source/LAYER includes only files of its
own layer and of layers before it in the list below. doc/ tells what lives on each. Solver packages are named
in algebra/ alone, in tests, too. Pure layers know neither meshes nor MPI.

--self-check tests the test, by files that break each rule.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
from pathlib import Path

LAYERS = (
    "mesh geometry material friction integration mechanics loads probes algebra parameters scene"
    " discretization forces contact solve output run"
).split()
# Layers without meshes, and those without MPI: algebra/ distributes vectors.
WITHOUT_MESH = set("mesh geometry material friction integration mechanics loads probes algebra".split())
WITHOUT_MPI = WITHOUT_MESH - {"algebra"}
APART = ({"forces", "contact"},)  # neighbours that must not know each other
# billet/NAME.h, for every layer
FOR_ALL = set(
    "compatibility diagnostic_kinds diagnostics disjoint_sets error_notes errors fail_together nearest_name"
    " plugin printable registered_type scene_fault shipped spent_time state times trial usage vector_text"
    " version without_traps".split()
)
ABOVE_ALL = {"main"}  # files that may include everything
LEVELS = {layer: level for level, layer in enumerate(LAYERS)}

PLACE = re.compile(r"(?:include/billet|source)/(?:(\w+)/)?(?:.*/)?(\w+)[^/]*")
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)')
HEADER = re.compile(r"billet/(?:(\w+)/)?(?:.*/)?(\w+)\.h")
# Packages of Trilinos and direct solvers, whose headers and names only algebra/ may use.
TRILINOS = (
    "Amesos Anasazi Aztec AZOO Belos Epetra FROSch Galeri Ifpack Intrepid Isorropia Kokkos Komplex LOCA MLAPI"
    " Moertel MueLu NOX Pamgen Phalanx Pike Piro Pliris ROL RTOp Rythmos Sacado Shards ShyLU Stokhos"
    " Stratimikos Tacho Teko Teuchos Thyra Tpetra Trilinos Tsqr Xpetra Zoltan"
).split()
# Names in code: of packages, of deal.II's wrappers, of MUMPS' C interface; ML and KLU have short ones.
PACKAGES = re.compile(
    rf"(?<![A-Za-z])(?:{'|'.join(name for name in TRILINOS if name not in ('ROL', 'AZOO', 'LOCA'))}"
    r"|[Ee]petra|[Tt]rilinos|ML_|ml_M|Mumps|[sdcz]mumps|[SDCZ]MUMPS|MUMPS_|klu_|KLU_)\w*"
)
HEADERS = re.compile(rf"(?:.*/)?(?:{'|'.join(TRILINOS)}|az_|ml_|klu|[sdcz]?mumps|.*[Tt]rilinos)[^/]*")
ALLOWED = {("geometry/derivative.h", "Sacado")}  # automatic differentiation, which is no linear algebra
METHODS = re.compile(r"(?:Direct|Iterative)Method::\w+")  # tests may choose one
MESH = re.compile(r"deal\.II/(?:grid|dofs|distributed|fe)/.*")
MPI = re.compile(r"(?:.*/)?mpi\.(?:h|templates\.h)|billet/fail_together\.h")
STRING = re.compile(r'"(?:\\.|[^"\\])*"')
COMMENT = re.compile(r'("(?:\\.|[^"\\\n])*")|//[^\n]*|/\*.*?\*/', re.DOTALL)


def without_comments(text: str) -> str:
    """Comments may name anything; their line ends stay, and what is in quotes."""
    return COMMENT.sub(lambda match: match[1] or "\n" * match[0].count("\n"), text)


def fault_of_include(layer: str | None, name: str, quote: str, path: str) -> str:
    """Returns what is wrong with an include of a file on this layer; nothing, where it is allowed."""
    if layer in WITHOUT_MESH and MESH.fullmatch(path):
        return f"{layer}/ is pure, so it must not include {path}, which knows meshes"
    if layer in WITHOUT_MPI and MPI.fullmatch(path):
        return f"{layer}/ is pure, so it must not include {path}, which knows other ranks"
    if not path.startswith("billet/"):
        return f'write "billet/..." instead of "{path}"' if quote == '"' and "/" in path else ""
    if layer is None and name in ABOVE_ALL:
        return ""
    match = HEADER.fullmatch(path)
    other, header = match.groups() if match else (None, None)
    if other is None:
        return "" if header in FOR_ALL else f"{path} is above the layers"
    if other not in LEVELS:
        return f"{path} is on no layer"
    if layer is None:
        return f"what every layer includes must not include {path}"
    if LEVELS[other] > LEVELS[layer]:
        return f"{layer}/ comes before {other}/, so it must not include {path}"
    if {layer, other} in APART:
        return f"{layer}/ and {other}/ must not know each other: {path}"
    return ""


def package_in(line: str, is_test: bool) -> str:
    """Returns the package for linear algebra, or the method of a linear solver, that a line names."""
    if include := INCLUDE.match(line):
        return include[2] if HEADERS.fullmatch(include[2]) else ""
    found = PACKAGES.search(STRING.sub('""', line)) or (None if is_test else METHODS.search(line))
    return found[0] if found else ""


def faults_of_packages(file: str) -> list[str]:
    """Returns where a file outside algebra/ names a package for linear algebra."""
    if Path(file).parent.name == "algebra":
        return []
    text = without_comments(Path(file).read_text(encoding="utf-8"))
    is_test = Path(file).parts[0] == "tests"
    return [
        f"{file}:{number}: only algebra/ names {name}"
        for number, line in enumerate(text.split("\n"), 1)
        if (name := package_in(line, is_test))
        and not any(file.endswith(place) and name.startswith(package) for place, package in ALLOWED)
    ]


def faults_of(file: str) -> list[str]:
    """Returns what is wrong with a file."""
    match = PLACE.fullmatch(file)
    layer, name = (match[1], match[2]) if match else (None, "")
    if layer not in LEVELS if layer is not None else name not in ABOVE_ALL | FOR_ALL:
        return [f"{file}: on no layer of the list in scripts/checks/layers.py"]
    faults = []
    for number, line in enumerate(without_comments(Path(file).read_text(encoding="utf-8")).split("\n"), 1):
        if re.search(r"\bParameterHandler\b", line) and layer != "parameters":
            faults.append(f"{file}:{number}: only parameters/ knows ParameterHandler")
        if include := INCLUDE.match(line):
            if fault := fault_of_include(layer, name, *include.groups()):
                faults.append(f"{file}:{number}: {fault}")
    return faults


def find_code(*folders: str) -> list[str]:
    """Returns the C++ files below these folders."""
    return sorted(
        str(path) for folder in folders for path in Path(folder).rglob("*") if path.suffix in (".h", ".cc")
    )


def self_check() -> list[str]:
    """Returns what the test does not notice, or notices where nothing is wrong."""
    code = {
        "source/geometry/mesh.cc": ("#include <deal.II/grid/tria.h>", "geometry/ is pure"),
        "source/material/elements.cc": ("#include <deal.II/fe/fe_q.h>", "material/ is pure"),
        "include/billet/algebra/dofs.h": ("#include <deal.II/dofs/dof_handler.h>", "algebra/ is pure"),
        "include/billet/loads/forest.h": ("#include <deal.II/distributed/tria.h>", "loads/ is pure"),
        "source/friction/ranks.cc": ("#include <mpi.h>", "friction/ is pure"),
        "source/loads/ranks.cc": ('#include "billet/fail_together.h"', "loads/ is pure"),
        "source/mechanics/explicit/ranks.cc": ("#include <deal.II/base/mpi.h>", "mechanics/ is pure"),
        "source/integration/parsed.cc": ("class ParameterHandler;", "only parameters/ knows"),
        "source/material/mesh.cc": ('#include "billet/forces/inertia.h"', "material/ comes before"),
        "source/contact/loads.cc": ('#include "billet/forces/inertia.h"', "must not know each other"),
        "source/solve/packages.cc": ("class Epetra_Map;", "only algebra/ names Epetra_Map"),
        "source/solve/tpetra.cc": ("using Map = Tpetra::Map<>;", "only algebra/ names Tpetra"),
        "source/solve/belos.cc": ("#include <BelosLinearProblem.hpp>", "only algebra/ names Belos"),
        "source/solve/muelu.cc": ('#include "MueLu.hpp"', "only algebra/ names MueLu"),
        "source/solve/ml.cc": ("#include <ml_include.h>", "only algebra/ names ml_include.h"),
        "source/solve/mumps.cc": ("Mumps solver;", "only algebra/ names Mumps"),
        "source/solve/wrappers.cc": ("#include <deal.II/lac/trilinos_vector.h>", "only algebra/ names deal"),
        "source/solve/sacado.cc": ("#include <Sacado.hpp>", "only algebra/ names Sacado"),
        "source/solve/method.cc": ("auto m = DirectMethod::klu;", "only algebra/ names DirectMethod::klu"),
        # Allowed code:
        "include/billet/geometry/derivative.h": ("#include <Sacado.hpp>\nusing F = Sacado::Fad::Exp;", ""),
        "source/solve/text.cc": ('const char *a = "Linear solver = MUMPS, MUMPS_x";\nint control_, ml_;', ""),
        "source/solve/local.cc": ('#include "billet/discretization/local_nodes.h"', ""),
        "tests/solve/chosen.cc": ("auto m = DirectMethod::klu;", ""),
        "source/algebra/ranks.cc": ("#include <mpi.h>\nclass Epetra_Map;", ""),
        "source/discretization/mesh.cc": ("#include <deal.II/grid/tria.h>\n#include <mpi.h>", ""),
        "source/parameters/parsed.cc": ("class ParameterHandler;", ""),
        "source/geometry/comment.cc": ("// not #include <mpi.h>, nor ParameterHandler", ""),
    }
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for file, (text, _fault) in code.items():
            Path(file).parent.mkdir(parents=True, exist_ok=True)
            Path(file).write_text(text + "\n", encoding="utf-8")
        for file, (_text, fault) in code.items():
            of_layer = [] if file.startswith("tests/") else faults_of(file)
            found = of_layer + faults_of_packages(file)
            if len(found) != (1 if fault else 0) or not all(fault in one for one in found):
                faults.append(f"{file}: expected '{fault}', found {found}")
        os.chdir("/")
    return faults


def main() -> int:
    """Returns the exit code."""
    if sys.argv[1:] == ["--self-check"]:
        faults = self_check()
        print("\n".join(faults + [f"self-check, {len(faults)} errors"]))
        return 1 if faults else 0
    if len(sys.argv) > 1:
        os.chdir(sys.argv[1])
    files = find_code("include/billet", "source")
    if not files:
        sys.exit("layers.py: no code below include/billet and source")
    faults = [fault for file in files for fault in faults_of(file)]
    files += find_code("tests")
    faults += [fault for file in files for fault in faults_of_packages(file)]
    print("\n".join(faults + [f"{len(files)} files, {len(faults)} errors"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
