#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stands for billet: a bar of Layers elements, whose force and shape are off by 0.3 h² ± 0.2 Δt + 0.05 / k
from F = 1 + t, so that limit and errors are known. Some values fail, each in its own way, and scenes with
$FAKE_FAILS elements. Each run adds a line to the file $FAKE_LOG; where that has $FAKE_INTERRUPT lines the
sweep is interrupted as by Ctrl-C."""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from pathlib import Path
from typing import Any, Iterable, Mapping

from modules import ROOT  # noqa: F401  finds the next one
from billet_tools.scene import entries

DEFAULTS = """set Target error =
set Target error of = mesh given
subsection Bodies
  subsection (name of a body)
    set Element = assumed strain
    subsection Mesh
      set Source = extruded primitive
      set Layers = 4
      set Refinements = 0
    end
  end
end
subsection Contact pairs
  subsection (name of a contact pair)
    set Normal penalty = 10
    set Facets = automatic
    set Penetration tolerance = 0
    set Friction coefficient = 0.1
  end
end
subsection Time stepping
  set End time = 1
  set Initial step = 0.1
  set Maximum step = 0.1
  set Growth iterations = 5
  set Shrink iterations = 9
  set Step control = automatic
  set Stops =
end
subsection Solver
  set Force tolerance = 1e-6
  set Energy tolerance = 1e-10
  set Contact tangent = automatic
  set Predictor = extrapolation
  set Line search = energy
  set Linear solver = automatic
end
subsection Output
  set Folder = results
  set Format = vtu
  set Step interval = 1
  set Verbosity = steps
  set Stress = true
end
"""
WORDS = {
    "Contact tangent": ("automatic", "exact", "consistent", "continuum", "symmetrised lower"),
    "Predictor": ("extrapolation", "tangent"),
    "Line search": ("energy", "none"),
    "Linear solver": ("automatic", "MUMPS"),
    "Element": ("assumed strain", "mean dilatation", "newest"),
    "Facets": ("automatic", "overlap", "planed"),
}


def known(path: str) -> bool:
    return any(path.split("/")[-1] == default.split("/")[-1] for default in entries(DEFAULTS)) or path.split(
        "/"
    )[0] in ("Tools", "Contact pairs")


def schema() -> dict[str, Any]:
    """Returns the JSON Schema of scenes: of the parameters that are words, what they allow."""
    root: dict[str, Any] = {"properties": {}}
    for path in entries(DEFAULTS):
        *sections, key = path.split("/")
        at = root
        for name in sections:
            inside: dict[str, Any] = {"properties": {}, "additionalProperties": False}
            if name.startswith("(name of"):
                at["additionalProperties"] = at["additionalProperties"] or inside
                at = at["additionalProperties"]
            else:
                at = at["properties"].setdefault(name, inside)
        entry: dict[str, Any] = {"enum": WORDS[key]} if key in WORDS else {"type": "string"}
        at["properties"][key] = entry
    return root


def check(file: str) -> tuple[dict[str, str], str]:
    try:
        scene = entries(Path(file).read_text())
    except OSError:
        return {}, f"{file}: the scene file cannot be read"
    for path, value in scene.items():
        key = path.split("/")[-1]
        if not known(path) and key not in ("Title", "Old name"):
            return scene, f"{file}:1: '{key}': there is no such parameter"
        if key in WORDS and value not in WORDS[key]:
            return scene, f"{file}:1: '{key}' is '{value}'; allowed is one of: {', '.join(WORDS[key])}"
    return scene, ""


def write_fields(file: Path, n: int, stretch: float) -> None:
    places, moved = [], []
    for i in range(n):
        for z in (i / n, (i + 1) / n):
            for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)):
                places.append((x, y, z * (1 + stretch)))
                moved.append((0, 0, z * stretch))

    def array(name: str, values: Iterable[Any], size: int, kind: str = "Float64") -> str:
        return (
            f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{size}" format="ascii">'
            + " ".join(f"{v}" for value in values for v in (value if size > 1 else (value,)))
            + "</DataArray>"
        )

    data = array("displacement", moved, 3) + array(
        "contact_pair", [0.0 if p[2] > 1 + stretch - 1e-9 else -1.0 for p in places], 1
    )
    file.with_suffix(".0.vtu").write_text(
        '<VTKFile type="UnstructuredGrid" version="0.1"><UnstructuredGrid><Piece'
        f' NumberOfPoints="{len(places)}" NumberOfCells="{n}">'
        f'<Points>{array("Points", places, 3)}</Points><PointData>{data}</PointData>'
        f'<CellData>{array("body", [0] * n, 1, "Int32")}</CellData><Cells>'
        f'{array("connectivity", range(8 * n), 1, "Int64")}'
        f'{array("offsets", range(8, 8 * n + 1, 8), 1, "Int64")}'
        f'{array("types", [12] * n, 1, "UInt8")}</Cells></Piece></UnstructuredGrid></VTKFile>'
    )
    file.with_suffix(".vtm").write_text(
        '<VTKFile type="vtkMultiBlockDataSet" version="1.0"><vtkMultiBlockDataSet>'
        '<Block index="0" name="Bodies"><DataSet index="0" name="bar"'
        f' file="{file.name}.0.vtu"/></Block></vtkMultiBlockDataSet></VTKFile>'
    )


def run(scene: Mapping[str, str]) -> int:
    log = Path(os.environ["FAKE_LOG"])
    with log.open("a") as out:
        out.write("run\n")
    if len(log.read_text().splitlines()) == int(os.environ.get("FAKE_INTERRUPT", -1)):
        os.kill(os.getppid(), signal.SIGINT)
        time.sleep(60)  # it will be ended

    def get(key: str, default: Any) -> Any:
        return next((v for path, v in scene.items() if path.split("/")[-1] == key), default)

    n, step, penalty = (
        int(get("Layers", 4)),
        float(get("Maximum step", 0.1)),
        float(get("Normal penalty", 10)),
    )
    is_ladder = get("Target error of", "") == "everything"  # of two levels of the mesh
    n *= 2 if is_ladder else 1
    tangent = get("Contact tangent", "automatic")
    # Long steps make forces larger, or with one of the solvers smaller.
    error = (
        0.3 / n**2 + (-0.2 if get("Linear solver", "automatic") == "MUMPS" else 0.2) * step + 0.05 / penalty
    )
    if tangent == "symmetrised lower":
        error += 0.5  # converges, to forces that are half as large again
    # Locks: forces more than twice as large, and the shape is right.
    force = (
        0.0
        if get("Shape", "plane") == "far"
        else 1 + error + (1.39 if get("Element", "assumed strain") == "mean dilatation" else 0.0)
    )
    fails = tangent == "continuum" or os.environ.get("FAKE_FAILS") == str(n)
    end = 0.4 if fails else 1.0
    if get("Line search", "energy") == "none":
        time.sleep(60)
    depth = 10.0 / penalty**2 / n  # ten facets at a penalty of one

    results = Path(get("Folder", "results"))
    results.mkdir(parents=True)
    rows = [
        "step,time,step_length,iterations,residual,total_iterations,total_cuts,linear_iterations,"
        "die.force_z,die.deepest_penetration,elastic_energy,energy_drift,mesh_error"
    ]
    times = [step * i for i in range(1, round(end / step) + 1)]
    rows += [
        f"{i},{t:.15g},{step},3,1e-9,{3 * i},0,2,{(1 + t) * force:.15g},{depth},{t},0,{0.3 / n**2}"
        for i, t in enumerate(times, 1)
    ]
    (results / "history.csv").write_text("\n".join(rows) + "\n")
    if end < 1:
        message = "scene.prm: at time 0.4 Newton's method does not converge: no convergence"
        # Three in each accepted step, and twenty more.
        (results / "diagnostics.jsonl").write_text(
            json.dumps(
                {
                    "key": "solution-failed",
                    "severity": "error",
                    "message": message,
                    "values": {"steps": len(times), "Newton iterations": 3 * len(times) + 20},
                }
            )
            + "\n"
        )
        print(f"error[solution-failed]: {message}", file=sys.stderr)
        return 3
    write_fields(results / "fields_00001", n, 0.1 * (1 + error))
    if is_ladder:
        coarse = results / "mesh_level_0"
        coarse.mkdir()
        (coarse / "history.csv").write_text("\n".join(rows) + "\n")
        write_fields(coarse / "fields_00001", n // 2, 0.1)
    return 0


def main() -> int:
    if sys.argv[1] == "--version":
        print("billet 0 (fake)")
        return 0
    if sys.argv[1] == "--print-parameters":
        print(json.dumps(schema()) if "--json" in sys.argv else DEFAULTS)
        return 0
    file = sys.argv[-1]
    scene, against = check(file)
    if sys.argv[1] == "--check":
        layers = next((v for path, v in scene.items() if path.endswith("/Layers")), 4)
        messages = [{"key": "bad-input", "severity": "error", "message": against}] if against else []
        if "Old name" in scene:
            messages.append({"key": "old-name", "severity": "warning", "message": "'Old name' is one"})
        print(
            json.dumps({"file": file, "valid": not against, "elements": int(layers), "diagnostics": messages})
        )
        return 2 if against else 0
    if against:
        print(f"error[bad-input]: {against}", file=sys.stderr)
        return 2
    return run(scene)


sys.exit(main())
