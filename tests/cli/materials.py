#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: materials.py BILLET

Pulls a cube of each shipped material in an empty current folder, and compares its force with theory. Of those
that set the same parameters one is certified.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

from checks import SHIPPED, Checks, enter_folder, near, read_text, require, run, says, write_text
from material_theory import Constants, constants_of, tension, tension_scene
from shipped import history

FOLDER = SHIPPED.parent / "materials"

program = sys.argv[1]
check = Checks()
enter_folder()


def pull(file: Path, constants: Constants, stretch: float, rate: float, tolerance: float) -> None:
    """Compares the last force with theory."""
    n_steps = 100 if "Rate factor" in constants else 20  # without rates, steps make no error
    write_text("cube.prm", tension_scene(file.name, stretch, rate, n_steps))
    ended = run(program, "cube.prm", "--output", "pulled", "--force")
    require(ended.code == 0, ended.output + ended.errors)
    row = history("pulled")[-1]
    near("force", row["cube.support head.force_x"], tension(constants, stretch, rate), tolerance)


files = sorted(FOLDER.glob("*.prm"))


@check("fourteen materials or more, each with its units and its source")
def _() -> None:
    require(len(files) >= 14, f"{len(files)} files")
    for file in files:
        text = read_text(file)
        for word in ("# Units: ", "# Source: ", f"include materials/{file.name}"):
            require(word in text, f"{file.name} lacks '{word}'")


certified: set[tuple[str, ...]] = set()  # the parameters that they set

for file in files:
    constants = constants_of(file)
    is_rubber = "Elasticity" in constants

    if tuple(constants) not in certified:
        certified.add(tuple(constants))

        @check(f"{file.stem} is certified")
        def _() -> None:
            ended = run(program, "--certify", str(file))
            require(ended.code == 0 and "The law passes" in ended.output, ended.output + ended.errors)
            says(r"units +pass", ended.output)

    @check(file.stem)
    def _() -> None:
        if is_rubber:
            pull(file, constants, 2.5, 1.0, 1e-6)
        elif "Rate factor" in constants:
            # Backward Euler's heating is of first order in the step.
            pull(file, constants, 1.3, 1.0, 2e-3)
            pull(file, constants, 1.3, 1e4, 2e-3)
        else:
            pull(file, constants, 1.2, 1.0, 1e-6)


@check("a material of the scene's own folder comes first")
def _() -> None:
    Path("materials").mkdir()
    write_text("materials/OFHC_copper.prm", "set Young modulus = 7\nset Poisson ratio = 0.3\n")
    write_text("cube.prm", tension_scene("OFHC_copper.prm", 1.01, 1.0))
    ended = run(program, "cube.prm", "--output", "own", "--force")
    require(ended.code == 0, ended.output + ended.errors)
    force = history("own")[-1]["cube.support head.force_x"]
    near("force", force, 7 * math.log(1.01) / 1.01, 1e-2)


sys.exit(check.finish())
