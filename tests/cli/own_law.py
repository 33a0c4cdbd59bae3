#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: own_law.py BILLET BUILD CMAKE

Installs the build tree BUILD into an empty current folder, builds the example of a law of one's own with the
installed files alone, and runs its scene beside closed forms. Libraries that do not fit must be refused.
"""

from __future__ import annotations

import math
import shutil
import subprocess
import sys
from pathlib import Path

from checks import HERE, Checks, near, read_text, require, run, write_text
from shipped import history

build, cmake = sys.argv[2:]
check = Checks()
here = Path.cwd()


def call(*command: str) -> None:
    """Runs a command, which must succeed."""
    ended = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8")
    require(ended.returncode == 0, f"{' '.join(command)}:\n{ended.stdout[-3000:]}")


def bisect(function, low: float, high: float) -> float:  # type: ignore[no-untyped-def]
    """Returns where an ascending function is 0."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if function(middle) > 0.0 else (middle, high)
    return 0.5 * (low + high)


def soft_force(stretch: float) -> float:
    """Returns the force of a unit cube with ψ = ½ κ (J − 1)² + ½ G (tr b̄ − 3), E = 10, ν = 0.4."""
    young, poisson = 10.0, 0.4
    bulk, shear = young / (3 * (1 - 2 * poisson)), young / (2 * (1 + poisson))

    def stresses(lateral: float) -> tuple[float, float]:
        volume = stretch * lateral * lateral
        mean = (stretch**2 + 2 * lateral**2) / 3
        factor = shear * volume ** (-2 / 3)
        pressure = bulk * volume * (volume - 1)
        return factor * (lateral**2 - mean) + pressure, factor * (stretch**2 - mean) + pressure

    return stresses(bisect(lambda lateral: stresses(lateral)[0], 0.3, 1.0))[1] / stretch


def metal_force(stretch: float) -> float:
    """Returns the force of a unit cube with Hencky's law and Hockett and Sherby's flow stress."""
    young = 70e3

    def flow(strain: float) -> float:
        return 250 - 150 * math.exp(-8 * strain)

    strain = bisect(lambda a: flow(a) / young + a - math.log(stretch), 0.0, 1.0)
    return flow(strain) / stretch


def compile_library(name: str, text: str) -> None:
    """Builds a small shared library beside the scene."""
    write_text("library.cc", text)
    call("g++", "-shared", "-fPIC", "-o", name, "library.cc")


def refusal(library: str) -> str:
    """Returns what the program says of a scene that names this library."""
    ended = run(program, "pull.prm", "--set", f"Libraries={library}", "--output", "refused")
    require(ended.code == 2, f"code {ended.code}")
    require(not Path("refused").exists(), "a refused scene leaves a folder")
    return ended.errors


def refuses(library: str, words: str) -> None:
    """Requires these words of the refusal of a library."""
    said = refusal(library)
    require(words in said, said)


call(cmake, "--install", build, "--prefix", str(here / "installed"))
program = str(here / "installed/bin/billet")
shutil.copytree(here / "installed/share/billet/examples/own_law", here / "own_law")


@check("the installed example is that of the sources")
def _() -> None:
    for file in sorted((HERE.parents[1] / "examples/own_law").iterdir()):
        require(read_text(file) == read_text(here / "own_law" / file.name), file.name)


@check("the example builds with the installed files")
def _() -> None:
    prefix = f"CMAKE_PREFIX_PATH={here / 'installed'}"
    call(cmake, "-G", "Ninja", "-S", "own_law", "-B", "own_law/build", "-D", prefix)
    call(cmake, "--build", "own_law/build")


@check("its scene runs, with the forces of closed forms")
def _() -> None:
    ended = run(program, "own_law/pull.prm", "--output", "pull", "--set", "Solver/Force tolerance=1e-9")
    require(ended.code == 0, ended.output + ended.errors)
    rows = history("pull")
    for row in rows:
        near("soft", row["soft.support head.force_z"], soft_force(1 + 0.8 * row["time"]), 1e-8)
        near("metal", row["metal.support head.force_z"], metal_force(1 + 0.2 * row["time"]), 1e-8)
    require(len(rows) == 20, f"{len(rows)} rows")


@check("its laws are certified")
def _() -> None:
    ended = run(program, "--certify", "own_law/pull.prm")
    require(ended.code == 0 and ended.output.count("The law passes") == 2, ended.output + ended.errors)


@check("without the library its names are unknown")
def _() -> None:
    shutil.copy(here / "own_law/pull.prm", ".")
    ended = run(program, "pull.prm", "--set", "Libraries=")
    require(ended.code == 2 and "quadratic volume" in ended.errors, ended.errors)


@check("a library that is not there is refused")
def _() -> None:
    refuses("nowhere.so", "there is no such file")


@check("a file that is no library is refused")
def _() -> None:
    refuses("pull.prm", "the system cannot load")


@check("a library without BILLET_PLUGIN is refused")
def _() -> None:
    compile_library("other.so", "int nothing() { return 0; }")
    refuses("other.so", "has no BILLET_PLUGIN")


@check("a library of another version is refused")
def _() -> None:
    compile_library(
        "old.so",
        'extern "C" const char *billet_plugin_version() { return "0.0.1"; }\n'
        'extern "C" void billet_plugin_register() {}\n',
    )
    refuses("old.so", "was built for billet 0.0.1")


@check("a library that fails to register is refused")
def _() -> None:
    version = subprocess.run(
        ["grep", "-a", "-o", r"0[.][0-9.]* ([^)]*), deal.II [0-9.]*", "own_law/build/libown_law.so"],
        stdout=subprocess.PIPE,
        encoding="utf-8",
        check=True,
    ).stdout.split("\n", 1)[0]
    compile_library(
        "thrower.so",
        "#include <stdexcept>\n"
        f'extern "C" const char *billet_plugin_version() {{ return "{version}"; }}\n'
        'extern "C" void billet_plugin_register() { throw std::logic_error("taken twice"); }\n',
    )
    refuses("thrower.so", "cannot register its types: taken twice")


sys.exit(check.finish())
