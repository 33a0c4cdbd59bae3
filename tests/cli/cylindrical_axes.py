#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: cylindrical_axes.py BILLET

Runs in an empty current folder.

A thin ring of Hill's material with cylindrical axes is widened. All around it the stress is that of
tension along the circumference, R22 times the flow stress, in each element, statically and explicitly,
and after a restart with another element. With axes of space it would not be the same all around.
"""

from __future__ import annotations

import math
import sys

from checks import Checks, Program, Run, Runner, enter_folder, near, require, says

runner = Runner(Program(sys.argv[1:]))
check = Checks()
enter_folder()

RADIUS, THICKNESS, GROWTH, END = 10.0, 0.5, 0.3, 2e-4
YIELD, SLOPE, YOUNG, RATIO = 200.0, 2000.0, 200e3, 1.3  # RATIO: along the circumference
CYLINDRICAL = "      set Axes = cylindrical\n      set Axis direction = 0, 0, 1\n"


def scene(choices: str = "", is_explicit: bool = False, axes: str = CYLINDRICAL, end: float = END) -> str:
    steps = "" if is_explicit else f"  set Step control = fixed\n  set Initial step = {END / 20!r}\n"
    return f"""subsection Bodies
  subsection ring
    set Symmetry planes = x = 0 ; y = 0 ; z = 0
{choices}    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = 1, 6, 1 : {RADIUS}, 0, 0 : {RADIUS + THICKNESS}, 90, 1 : true
      set Positions = x*cos(pi/180*y) ; x*sin(pi/180*y) ; z
    end
    subsection Material
      set Young modulus     = {YOUNG}
      set Poisson ratio     = 0.3
      set Density           = 7.8e-9
      set Yield stress      = {YIELD}
      set Hardening modulus = {SLOPE}
      set Anisotropy        = Hill
      set Stress ratios     = 1, {RATIO}, 0.9, 1, 1, 1
{axes}    end
    subsection Supports
      subsection bore
        set Boundary ids   = 0
        set Components     = x
        set Axes           = cylindrical
        set Axis direction = 0, 0, 1
        set Displacement   = {GROWTH}*0.5*(1 - cos(pi*t/{END!r}))
      end
    end
  end
end
subsection Probes
  subsection outside
    set Type           = set
    set Boundary ids   = 1
    set Quantities     = stress
    set Axes           = cylindrical
    set Axis direction = 0, 0, 1
  end
end
subsection Time stepping
  set Scheme   = {"explicit" if is_explicit else "quasi-static"}
  set End time = {end!r}
{steps}end
subsection Output
  set Format = none
  subsection Checkpoint
    set Interval = {END / 2!r}
  end
end
"""


def closed_form() -> float:
    """Returns Cauchy's stress of a bar in tension with this logarithmic strain: tau = R (sigma_y + h alpha),
    alpha = R times plastic strain."""
    strain = math.log1p(GROWTH / (RADIUS + 0.5 * THICKNESS))
    alpha = (RATIO * strain - RATIO**2 * YIELD / YOUNG) / (1 + RATIO**2 * SLOPE / YOUNG)
    tau = RATIO * (YIELD + SLOPE * alpha)
    return tau / math.exp((1 - 2 * 0.3) * tau / YOUNG)


def uniform(ended: Run) -> None:
    """The stress is that of the bar, but for the ring's thickness and waves of the explicit scheme, and the
    same all around."""
    least, largest = ended.last("outside.least_stress_yy"), ended.last("outside.largest_stress_yy")
    near("the stress", least, closed_form(), 0.03)
    near("the largest stress", largest, least, 1e-5)


def element(name: str) -> str:
    return f"    set Element = {name}\n"


for name in ("assumed strain", "mean dilatation", "one point"):

    @check(f"{name}, static")
    def _() -> None:
        uniform(runner.finish(scene(element(name))))


for name in ("mean dilatation", "one point"):

    @check(f"{name}, explicit")
    def _() -> None:
        uniform(runner.finish(scene(element(name), is_explicit=True)))


half_way = runner.finish(scene(end=END / 2)).last_checkpoint()


@check("half-way on with another element")
def _() -> None:
    uniform(runner.finish(scene(element("mean dilatation")), "--restart", half_way))


@check("axes of space are not the same all around")
def _() -> None:
    turned = runner.finish(scene(axes=""))
    least, largest = turned.last("outside.least_stress_yy"), turned.last("outside.largest_stress_yy")
    require(largest > 1.05 * least, f"the stress is {least} to {largest}")


@check("--check names the axes")
def _() -> None:
    said = runner.finish(scene(), "--check").said
    says("Hencky plasticity, in cylindrical axes about the line", said)


@check("a checkpoint with other axes is refused")
def _() -> None:
    other = runner.run(scene(axes=""), options=("--restart", half_way))
    says("cylindrical axes about the line", other.complained)
    require(other.ended.code != 0, "it runs")


@check("an axis that is not along a symmetry plane is named")
def _() -> None:
    askew = scene(axes=CYLINDRICAL.replace("0, 0, 1", "0, 1, 1"))
    says("material-not-mirrored.*'y = 0'", runner.run(askew, options=["--check"]).said)


sys.exit(check.finish())
