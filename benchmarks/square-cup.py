# SPDX-License-Identifier: LGPL-2.1-or-later
"""Square cup of NUMISHEET'93: draw-in at 15 and 40 mm of travel on two meshes, beside measured means."""

from __future__ import annotations

import math
import tempfile

from billet_runs import ROOT, arguments, number, percent, publish, table
from explicit_runs import ExplicitRun

options = arguments("square-cup")
# Mild steel, means of the laboratories, in mm: quoted at second hand. The proceedings
# (Makinouchi et al., eds., NUMISHEET'93, Isehara 1993) were not at hand.
MEASURED = {15: (6.2, 3.2), 40: (27.96, 15.36)}


def draw_ins(row: dict[str, float]) -> tuple[float, float]:
    """Returns the draw-in at the middle of an edge, DX, and along the diagonal, DD."""
    return -row["dx.displacement_x"], math.hypot(row["corner.displacement_x"], row["corner.displacement_y"])


def line(n: int) -> list[object]:
    mesh = {"Bodies/blank/Mesh/Arguments": f"{n}, {n}, 1 : 0, 0, 0 : 75, 75, 0.78", "Output/Format": "none"}
    with tempfile.TemporaryDirectory() as folder:
        run = ExplicitRun(ROOT / "prm/square_cup.prm", mesh, folder, options.ranks)
        drift = run.max_drift()
    found: list[object] = [f"{n} × {n}"]
    for travel, measured in MEASURED.items():
        row = min(run.rows, key=lambda row: abs(-row["punch.travel_z"] - travel))
        for length, mean in zip(draw_ins(row), measured):
            found += [number(length, 4), f"{100 * (length / mean - 1):+.2g} %"]
    last = run.rows[-1]
    inertia = max(row["kinetic_energy"] / row["plastic_work"] for row in run.rows if row["time"] > 1e-3)
    asymmetry = abs(last["corner.displacement_x"] / last["corner.displacement_y"] - 1)
    return [*found, percent(inertia), percent(asymmetry), percent(drift), run.steps, number(run.seconds, 3)]


HEAD = ["bricks of the quarter"]
for depth in MEASURED:
    HEAD += [f"{depth} mm: DX, mm", "beside measured", f"{depth} mm: DD, mm", "beside measured"]
HEAD += ["kinetic energy, of plastic work", "asymmetry", "energy drift", "steps", "seconds"]
publish(
    "square-cup",
    "Square cup of NUMISHEET'93",
    options,
    (
        "This page compares how far the flange of a drawn cup comes in with what was measured. The scene is"
        " `prm/square_cup.prm`: mild steel, without anisotropy, one layer of bricks.\n\n"
        "Measured means, which were not checked in the proceedings:\n\n"
        + "\n".join(f"- {t} mm: DX {dx} and DD {dd} mm" for t, (dx, dd) in MEASURED.items())
        + "\n\nAsymmetry is that of the corner's travel along x and y. Kinetic energy is the maximum after"
        " 1 ms."
    ),
    table(HEAD, [line(n) for n in ((24,) if options.quick else (24, 30))]),
)
