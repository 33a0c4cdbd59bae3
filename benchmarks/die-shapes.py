# SPDX-License-Identifier: LGPL-2.1-or-later
"""The die of Wagoner's punch, its fillet drawn in many ways: force curves, and what a projection costs."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Iterator

from billet_runs import (
    PROGRAM,
    ROOT,
    Run,
    arguments,
    curve_error,
    number,
    percent,
    publish,
    read_scene,
    table,
    variant,
)

options = arguments("die-shapes")
RING, TUBE, HEIGHT, TRAVEL = 59.18, 6.35, -6.35, 40.0
FILLET = "Tools/die/Surfaces/fillet/"
HERE = Path(__file__).resolve().parent
COST = str(Path(PROGRAM).resolve().parents[1] / "benchmarks/bin/projection_cost")
SCENE = ROOT / "prm/wagoner_punch.prm"


def without_fillet(text: str) -> str:
    """The scene without its torus."""
    lines, inside = [], False
    for line in text.splitlines():
        inside = inside or line.split("#")[0].split() == ["subsection", "fillet"]
        if not inside:
            lines.append(line)
        elif line.strip() == "end":
            inside = False
    return "\n".join(lines)


def made(generator: str, path: Path, *flags: str) -> str:
    """Writes a file by one of the generators beside this script."""
    command = [
        sys.executable,
        str(HERE / generator),
        "--centre",
        "0",
        "0",
        repr(HEIGHT),
        "--ring",
        repr(RING),
        "--tube",
        repr(TUBE),
        *flags,
    ]
    with open(path, "wb") as out:
        subprocess.run(command, stdout=out, check=True)
    return str(path)


def shapes(folder: Path) -> Iterator[tuple[str, dict[str, str] | None]]:
    """Name and parameters of each way to draw the fillet."""
    yield "torus", None
    yield "revolved profile", {
        "Shape": "revolved profile",
        "Origin": f"0, 0, {HEIGHT}",
        "Corners": f"{RING - TUBE}, 0 ; via {RING - TUBE * 0.5**0.5}, {TUBE * 0.5**0.5} to {RING}, {TUBE}",
    }
    for around, along in ((2, 2), (4, 4), (8, 8)):
        path = made(
            "coons_torus.py", folder / f"coons_{around}.txt", "--around", str(around), "--along", str(along)
        )
        yield f"{around * along} Coons patches", {"Shape": "coons patches", "File": path}
    # Triangles go on beyond the symmetry planes and the ends of the arc: at a border their normals are
    # one-sided.
    for name, around, along in (("coarse", 20, 5), ("fine", 80, 20)):
        path = made(
            "stl_torus.py",
            folder / f"{name}.stl",
            "--around",
            str(around),
            "--along",
            str(along),
            "--sector",
            "-11.25",
            "101.25",
            "--tube-angle",
            "90",
            "202.5",
        )
        for smoothing in ("true", "false"):
            yield (
                f"STL, {2 * around * along} triangles, {'smoothed' if smoothing == 'true' else 'flat'}",
                {"Shape": "STL", "File": path, "Closed": "false", "Smoothing": smoothing},
            )


def scene_with(fillet: dict[str, str] | None, folder: Path) -> Path:
    text = read_scene(SCENE)
    if fillet is not None:
        text = variant(without_fillet(text), {FILLET + key: value for key, value in fillet.items()})
    path = folder / "die.prm"
    path.write_text(text)
    return path


rows, reference = [], None
with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    for label, fillet in shapes(folder):
        scene = scene_with(fillet, folder)
        changes = {
            "Bodies/blank/Mesh/Refinements": 3,
            "Output/Interval": 0,
            "Time stepping/Stops": "0.25, 0.5, 0.75",
        }
        if not options.quick:
            changes["Bodies/blank/Mesh/Refinements"] = 4
        r = Run(changes, options.ranks, scene, "punch")
        reference = reference or r
        cost = subprocess.run(
            [COST, repr(RING), repr(TUBE), repr(HEIGHT), str(scene), "die"],
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        done = f"{r.iterations} / {r.steps}" if r.converged else f"{TRAVEL * r.times[-1]:.3g} mm: {r.failure}"
        rows.append(
            [label, number(float(cost[0])), f"{float(cost[1]):.1e}", f"{float(cost[2]):.1e}", done]
            + [number(r.force(t), 5) for t in (0.25, 0.5, 0.75, 1.0)]
            + ["(reference)" if r is reference else percent(curve_error(r, reference))]
        )

publish(
    "die-shapes",
    "A die drawn in many ways",
    options,
    (
        "This page shows what each way to describe the same die costs, and how exact it is. The scene is"
        " Wagoner's punch, 40 mm, µ = 0.3, with default settings. The fillet of the die is a torus, a"
        " profile, Coons patches or triangles; the flat face is a disc. The sheet has"
        f" {'192' if options.quick else '768'} bricks. Each run is done once.\n\n"
        "- Cost: nanoseconds of one projection onto the whole die (fillet and face) of a point near the"
        " fillet. It is the best of fifty passes over 10,000 points. Compare the numbers with each other.\n"
        "- Errors: those of gap (mm) and normal at these points.\n"
        "- Forces: those on the whole punch in kN at 10, 20, 30 and 40 mm.\n"
        "- Curve: the difference of the whole curve, ∫|F − F*| / ∫|F*|.\n\n"
        "Sheets that are drawn over facets take other steps, and other paths in contact. Differences of"
        " some hundredths of a percent come from the steps."
    ),
    table(
        [
            "fillet",
            "ns",
            "gap error",
            "normal error",
            "iterations / steps",
            "10 mm",
            "20 mm",
            "30 mm",
            "40 mm",
            "curve",
        ],
        rows,
    ),
)
