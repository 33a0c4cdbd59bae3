# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a run wrote, read back into base units and the upright frame."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy
from numpy.typing import NDArray
from billet_tools.output import Array, Fields, History, pictures_of, read_estimates, read_grid, read_history

if TYPE_CHECKING:
    from .frame import Frame
    from .scenes import Setup

VECTORS = ("displacement", "contact_traction", "velocity")


def upright(fields: Fields, frame: Frame) -> Fields:
    """From the numbers in the file. Stress components are not turned back: their scalars do."""
    f = dict(fields)
    unit = {
        "displacement": frame.length,
        "contact_traction": frame.stress,
        "contact_pressure": frame.stress,
        "contact_gap": frame.length,
        "contact_slip": frame.length,
        "contact_area": frame.length**2,
        "von_mises_stress": frame.stress,
        "pressure": frame.stress,
        "velocity": frame.speed,
    }
    for name, values in f.items():
        if name.startswith("stress_"):
            f[name] = values / frame.stress
        elif name in unit:
            f[name] = values / unit[name]
    f["points"] = f["points"] / frame.length
    if frame.degrees:
        for name in VECTORS:
            if name in f:
                f[name] = f[name] @ frame.turn
        f["points"] = f["points"] @ frame.turn
    f["places"] = f["points"] - f["displacement"]
    if "state_equivalent_plastic_strain" in f:  # of a UMAT
        f["equivalent_plastic_strain"] = f["state_equivalent_plastic_strain"]
    if "body" in f:
        f["body"] = f["body"] - f["body"].min()
    return f


def in_base_units(history: History, frame: Frame) -> History:
    h = dict(history)
    turned = {}
    for name, values in h.items():
        last = name.rsplit(".", 1)[-1]
        if last.startswith(("force_x", "force_y", "force_z", "free_residual", "inertia_", "auxiliary_force")):
            unit = frame.force
        elif last.startswith("moment_of_momentum"):
            unit = frame.momentum * frame.length
        elif last.startswith("momentum"):
            unit = frame.momentum
        elif last.startswith("moment_"):
            unit = frame.force * frame.length
        elif last == "contact_area":
            unit = frame.length**2
        elif last.startswith(("deepest_penetration", "travel")):
            unit = frame.length
        elif last in ("time", "step_length"):
            unit = frame.time
        elif last.endswith(("_energy", "_work", "_dissipation", "_drift")):
            unit = frame.energy
        else:
            unit = 1.0
        turned[name] = values / unit
    if frame.degrees:
        for name in list(turned):
            if name.endswith("_x") and name[:-1] + "z" in turned:
                three = numpy.stack([turned[name[:-1] + i] for i in "xyz"], axis=1) @ frame.turn
                for i, axis in enumerate("xyz"):
                    turned[name[:-1] + axis] = three[:, i]
    return turned


class Result:
    """Of one run; `setup` says what it was."""

    def __init__(
        self, setup: Setup, history: History, fields: Fields, believed: dict[str, float] | None = None
    ) -> None:
        """`believed`: {quantity: value} of error_estimate.csv."""
        self.setup, self.knobs, self.believed = setup, setup.knobs, believed or {}
        self.history, self.fields = in_base_units(history, setup.frame), (
            upright(fields, setup.frame) if fields else {}
        )
        self.before: Fields = {}

    @classmethod
    def read(cls, setup: Setup, folder: Path) -> Result:
        pictures = pictures_of(folder)
        result = cls(
            setup,
            read_history(folder / "history.csv"),
            read_grid(pictures[-1]) if pictures else {},
            read_estimates(folder),
        )
        if setup.sections["Output"].get("Step interval") == 1 and len(pictures) > 1:
            result.before = upright(read_grid(pictures[-2]), setup.frame)
        return result

    @cached_property
    def named(self) -> list[str]:
        """Tools and pairs with forces."""
        return [
            name[: -len(".force_x")]
            for name in self.history
            if name.endswith(".force_x")
            and not name.startswith("pair ")
            and ".support " not in name
            and ".symmetry plane " not in name
        ]

    def force(self, name: str) -> Array:
        return numpy.stack([self.history[f"{name}.force_{i}"] for i in "xyz"], axis=1)

    @property
    def is_explicit(self) -> bool:
        return self.setup.sections["Time stepping"].get("Scheme") == "explicit"

    @property
    def between_bodies(self) -> bool:
        return any("Second body" in pair for pair in self.setup.sections.get("Contact pairs", {}).values())

    @property
    def in_contact(self) -> NDArray[numpy.bool_]:
        return self.fields["contact_status"] > 0
