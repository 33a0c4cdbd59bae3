#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: layers.py [ROOT]

Keeps the layers of the code apart: a file in include/billet/LAYER or source/LAYER includes only files of its
own layer and of layers before it in the list below. doc/ tells what lives on each. Solver packages are named
in algebra/ alone, in tests, too.
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

LAYERS = (
    "geometry material friction integration mechanics loads algebra parameters scene discretization forces"
    " contact solve output run"
).split()
APART = ({"forces", "contact"},)  # neighbours that must not know each other
# billet/NAME.h, for every layer
FOR_ALL = set(
    "compatibility diagnostic_kinds diagnostics errors registered_type state usage version"
    " without_traps".split()
)
ABOVE_ALL = {"main"}  # files that may include everything
LEVELS = {layer: level for level, layer in enumerate(LAYERS)}

PLACE = re.compile(r"(?:include/billet|source)/(?:(\w+)/)?(?:.*/)?(\w+)[^/]*")
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)')
HEADER = re.compile(r"billet/(?:(\w+)/)?(?:.*/)?(\w+)\.h")
# Packages of Trilinos, MUMPS' C interface, deal.II's wrappers, and headers, functions and members named so
PACKAGES = re.compile(
    r"(?:[Ee]petra|NOX|Amesos|Aztec|ML_|ml_M|Teuchos|Thyra|Ifpack|dmumps|DMUMPS|MUMPS_|[Tt]rilinos)\w*"
)
COMMENT = re.compile(r'("(?:\\.|[^"\\\n])*")|//[^\n]*|/\*.*?\*/', re.DOTALL)


def without_comments(text: str) -> str:
    """Comments may name anything; their line ends stay, and what is in quotes."""
    return COMMENT.sub(lambda match: match[1] or "\n" * match[0].count("\n"), text)


def fault_of_include(layer: str | None, name: str, quote: str, path: str) -> str:
    """Returns what is wrong with an include of a file on this layer; nothing, where it is allowed."""
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


def faults_of_packages(file: str) -> list[str]:
    """Returns where a file outside algebra/ names a package for linear algebra."""
    if Path(file).parent.name == "algebra":
        return []
    text = without_comments(Path(file).read_text(encoding="utf-8"))
    return [
        f"{file}:{number}: only algebra/ names {found[0]}"
        for number, line in enumerate(text.split("\n"), 1)
        if (found := PACKAGES.search(line))
    ]


def faults_of(file: str) -> list[str]:
    """Returns what is wrong with a file."""
    match = PLACE.fullmatch(file)
    layer, name = match.groups() if match else (None, "")
    if layer not in LEVELS if layer is not None else name not in ABOVE_ALL | FOR_ALL:
        return [f"{file}: on no layer of the list in tests/layers.py"]
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


def main() -> int:
    """Returns the exit code."""
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
