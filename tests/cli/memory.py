#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: memory.py BILLET

Runs in an empty current folder.

A cube with backstress, or one that plastic work heats, is pulled to a strain of 0.26 and pushed back.
Half-way it resumes with another element, with more points through the thickness, or in another scheme.
It ends with the force of the run that is not interrupted, for the strain is uniform. Without the memory
of the law, forces would be off by 70 %.
"""

from __future__ import annotations

import sys

from checks import Checks, Program, Runner, enter_folder, near

runner = Runner(Program(sys.argv[1:]))
check = Checks()
enter_folder()

STEEL = """      set Young modulus     = 200e3
      set Poisson ratio     = 0.3
      set Density           = 7.8e-9
      set Yield stress      = 200
      set Hardening modulus = 300
"""
MATERIALS = {
    "backstress": STEEL + "      set Backstress moduli = 1000\n",
    "heat": STEEL + "      set Thermal factor = Johnson-Cook\n      set Temperature = 293\n"
    "      set Melting temperature = 893\n      set Taylor-Quinney fraction = 0.9\n"
    "      set Specific heat = 20e6\n",
}
TURN, STEPS = 4e-4, 20  # time at which the cube is pushed back, and steps until then
FORCE = "cube.support head.force_x"


def scene(material: str, end: float, choices: str = "", is_explicit: bool = False) -> str:
    """Returns the scene; the last state becomes a checkpoint."""
    steps = "" if is_explicit else f"  set Step control = fixed\n  set Initial step = {TURN / STEPS!r}\n"
    solver = "" if is_explicit else "subsection Solver\n  set Force tolerance = 1e-9\nend\n"
    return f"""subsection Bodies
  subsection cube
    set Symmetry planes = x = 0 ; y = 0 ; z = 0
{choices}    subsection Mesh
      set Primitive = hyper_cube
    end
    subsection Material
{MATERIALS[material]}    end
    subsection Supports
      subsection head
        set Boundary ids = 1
        set Components   = x
        set Displacement = 0.15*(1 - cos(pi*t/{TURN!r}))
      end
    end
  end
end
subsection Time stepping
  set Scheme   = {"explicit" if is_explicit else "quasi-static"}
  set End time = {end!r}
{steps}end
{solver}subsection Output
  set Format = none
  subsection Checkpoint
    set Interval = {TURN!r}
  end
end
"""


LAYERS = "    set Points through thickness = 5\n    set Thickness direction = 0 ; 0 ; 1\n"
for material in MATERIALS:
    whole = runner.finish(scene(material, 2 * TURN))
    force = whole.last(FORCE)
    until = {
        scheme: runner.finish(scene(material, TURN, is_explicit=scheme == "explicit")).last_checkpoint()
        for scheme in ("static", "explicit")
    }

    for name, choices in (
        ("mean dilatation", "    set Element = mean dilatation\n"),
        ("one point", "    set Element = one point\n"),
        ("5 points through the thickness", LAYERS),
    ):

        @check(f"{material}, resumed with {name}")
        def _() -> None:
            resumed = runner.finish(scene(material, 2 * TURN, choices), "--restart", until["static"])
            near("force", resumed.last(FORCE), force, 1e-5)
            near("plastic work", resumed.last("plastic_work"), whole.last("plastic_work"), 1e-5)

    for before, after in (("explicit", "static"), ("static", "explicit")):

        @check(f"{material}, {before}, then {after}")
        def _() -> None:
            resumed = runner.finish(
                scene(material, 2 * TURN, is_explicit=after == "explicit"), "--restart", until[before]
            )
            near("force", resumed.last(FORCE), force, 0.03)


sys.exit(check.finish())
