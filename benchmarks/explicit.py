# SPDX-License-Identifier: LGPL-2.1-or-later
"""Explicit dynamics in the program as a user runs it: nanoseconds per element and step."""

from __future__ import annotations

import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Mapping

from billet_runs import PROGRAM, arguments, number, publish, table

options = arguments("explicit")
REPEAT = 1 if options.quick else 3
PROBE = Path(PROGRAM).resolve().parent.parent / "benchmarks/bin/explicit_kernels"
END = 3.2e-5

BODY = """
  subsection {name}
    set Element = {element}
    set Initial velocity = 400*x ; 400*y ; -800*z
    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = {mesh} : true
    end
    subsection Material
      set Law               = elastoplastic
      set Elasticity        = {kinematics}
      set Density           = 7800
      set Young modulus     = 200e9
      set Poisson ratio     = 0.3
      set Hardening         = linear
      set Yield stress      = 100e6
      set Hardening modulus = 1e9
    end
  end
"""
REST = f"""
subsection Time stepping
  set Scheme   = explicit
  set End time = {END}
end
subsection Output
  set Format = none
  set Folder = results
  set History interval = {END}
end
"""
CONTACT = """
subsection Contact pairs
  subsection face
    set Body                = lower
    set Boundary ids        = 5
    set Second body         = upper
    set Second boundary ids = 4
    set Normal penalty      = 1
  end
end
"""
ONE = {"block": "47, 47, 46 : -0.235, -0.235, -0.23 : 0.235, 0.235, 0.23"}
TWO = {
    "lower": "50, 50, 20 : -0.25, -0.25, -0.2 : 0.25, 0.25, 0",
    "upper": "50, 50, 20 : -0.25, -0.25, 0 : 0.25, 0.25, 0.2",
}
SHIFTED = dict(TWO, upper="50, 50, 20 : -0.247, -0.246, 0 : 0.253, 0.254, 0.2")
BODIES = {"one": ONE, "apart": TWO, "fitting": TWO, "not fitting": SHIFTED}
KERNELS = {
    "one point, hypoelastic": ("one point", "hypoelastic"),
    "8 points, hypoelastic": ("assumed strain", "hypoelastic"),
    "8 points, neo-Hookean": ("assumed strain", "neo-Hookean"),
    "8 points, Hencky": ("assumed strain", "Hencky"),
}
GOALS = {"AVX-512": (65, 170, 190, 260), "AVX2": (85, 220, 260, 370)}


def measure(
    kernel: str, instructions: str, number_type: str, bodies: Mapping[str, str], more: str = ""
) -> tuple[float, float] | None:
    """(by the clock, of the process) ns per element and step, or nothing if the machine has no such
    instructions."""
    element, kinematics = KERNELS[kernel]
    text = (
        "subsection Bodies"
        + "".join(
            BODY.format(name=name, element=element, mesh=mesh, kinematics=kinematics)
            for name, mesh in bodies.items()
        )
        + "end\n"
    )
    text += (
        f"subsection Explicit dynamics\n  set Instruction set = {instructions}\n  set Number type ="
        f" {number_type}\nend\n" + REST + more
    )
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "scene.prm").write_text(text)
        done = subprocess.run([PROGRAM, "scene.prm"], cwd=folder, capture_output=True, text=True)
    if "instruction set is not available" in done.stderr:
        return None
    found = re.search(
        r"(\d+) steps of (\d+) elements in \S+ s: (\S+) ns for each element and step, (\S+) of", done.stdout
    )
    if done.returncode or not found:
        sys.exit(f"billet ended with {done.returncode}: {done.stderr}")
    print(
        f"[{kernel}, {instructions}, {number_type}, {len(bodies)} bodies] {found.group(0)} this process",
        file=sys.stderr,
        flush=True,
    )
    return float(found.group(3)), float(found.group(4))


def probe() -> tuple[list[float], dict[str, float]]:
    said = subprocess.run([str(PROBE), "0"], capture_output=True, text=True, check=True).stdout
    triad = [float(value) for value in re.findall(r"triad (\S+) GB/s", said)]
    names = {"scalar": "scalar", "sse2": "SSE2", "avx2": "AVX2", "avx512": "AVX-512"}
    peaks = {
        names[name]: float(value)
        for name, value in re.findall(r"^(scalar|sse2|avx2|avx512)\s+double\s+(\S+)", said, re.M)
    }
    return triad, peaks


SETS = ("AVX-512",) if options.quick else ("scalar", "SSE2", "AVX2", "AVX-512")
SLOW = ("scalar", "SSE2")
TYPES = ("double", "float")
CONTACT_KERNELS = ("one point, hypoelastic", "8 points, Hencky")
cases: dict[tuple[str, str, str, str], list[tuple[float, float]]] = {
    (kernel, instructions, number_type, "one"): []
    for instructions in SETS
    for kernel in KERNELS
    for number_type in TYPES
}
cases.update(
    {
        (kernel, "automatic", "double", name): []
        for kernel in CONTACT_KERNELS
        for name in ("apart", "not fitting", "fitting")
    }
)
triads: list[float] = []
peaks: dict[str, list[float]] = {}
loads: list[float] = []
for repetition in range(REPEAT):  # alternately, so that what else the machine does hits all alike
    triad, peak = probe()
    triads += triad
    for name, value in peak.items():
        peaks.setdefault(name, []).append(value)
    loads.append(os.getloadavg()[0])
    for (kernel, instructions, number_type, name), times in cases.items():
        if repetition > 0 and instructions in SLOW:
            continue
        got = measure(kernel, instructions, number_type, BODIES[name], CONTACT if "fitting" in name else "")
        times += [got] if got else []


def middle(times: list[tuple[float, float]], which: int = 1) -> float:
    return statistics.median(t[which] for t in times)


def show(times: list[tuple[float, float]]) -> str:
    if not times:
        return "–"
    return f"{middle(times, 0):.0f} / {middle(times):.0f} ({min(t[1] for t in times):.0f})"


rows = []
for instructions in SETS:
    if instructions not in peaks:
        continue
    for number_type in TYPES:
        rows.append(
            [
                f"{instructions}, {number_type}",
                number(statistics.median(peaks[instructions]), 3) if number_type == "double" else "",
            ]
            + [show(cases[kernel, instructions, number_type, "one"]) for kernel in KERNELS]
        )
    rows.append(
        [f"{instructions}, float/double", ""]
        + [
            f"{middle(single) / middle(double):.2f}"
            f" ({min(t[1] for t in single) / min(t[1] for t in double):.2f})"
            for single, double in (
                [cases[kernel, instructions, number_type, "one"] for number_type in ("float", "double")]
                for kernel in KERNELS
            )
        ]
    )
    if instructions in GOALS:
        rows.append([f"goal, {instructions}, double", ""] + [str(goal) for goal in GOALS[instructions]])
flops = []
for instructions in SETS:
    if instructions in peaks:
        most, bandwidth = statistics.median(peaks[instructions]), statistics.median(triads)
        flops.append(
            [instructions]
            + [
                f"{middle(cases[k, instructions, 'double', 'one']) * most:.0f} / "
                f"{middle(cases[k, instructions, 'double', 'one']) * bandwidth:.0f}"
                for k in KERNELS
            ]
        )
contact = []
for kernel in CONTACT_KERNELS:
    apart = cases[kernel, "automatic", "double", "apart"]
    for name in ("not fitting", "fitting"):
        touching = cases[kernel, "automatic", "double", name]
        contact.append(
            [
                kernel,
                name,
                show(apart),
                show(touching),
                f"{middle(touching) / middle(apart):.2f}",
                f"{min(t[1] for t in touching) / min(t[1] for t in apart):.2f}",
            ]
        )

publish(
    "explicit",
    "Explicit dynamics, per element and step",
    options,
    (
        "This page shows what an explicit step costs per element, for each instruction set, element and"
        " law. Use it to estimate the time of a run: cost times elements times steps.\n\n"
        "A block of 101,614 bricks (47 × 47 × 46, edges of 1 cm) of steel yields at 100 MPa. Its initial"
        " velocities press it along one axis, so that nearly all of it yields from the second step on. Runs"
        " take 40 to 50 steps on one core, with output off.\n\n"
        "The time is that of the stepping loop alone, as the program prints it at its end. The loop has"
        " forces, contact, energies, velocities, displacements and the choice of the step.\n\n"
        "The table has nanoseconds per element and step: by the clock / of processor time. Each is the"
        f" median of {REPEAT} (scalar and SSE2: one run). The least processor time stands in brackets.\n\n"
        f"Scenes alternate, and the machine was probed before each round. The triad had {min(triads):.1f} to"
        f" {max(triads):.1f} GB/s, median {statistics.median(triads):.1f}. The load average was"
        f" {min(loads):.1f} to {max(loads):.1f} on {os.cpu_count()} cores, so that other work shared core"
        " and cache."
    ),
    table(["instructions", "peak GF/s"] + list(KERNELS), rows),
    (
        "Kernels in float (`Number type = float`) have the history in float, too. The next table has"
        " kernels in double as ratios to what the machine gave (medians). Ratios are floating-point"
        " operations at peak / bytes at triad in that time."
    ),
    table(["instructions"] + list(KERNELS), flops),
    (
        "## Contact\n\n"
        "Two blocks of 50 × 50 × 20 bricks lie on each other, with 5 % of the nodes on the faces that"
        " touch. The table compares runs without and with contact (planed facets, two passes), with the"
        " best instruction set. Wanted: at most 1.5 times.\n\n"
        "The meshes do not fit if the upper block is 3 and 4 mm aside. Otherwise all nodes lie on nodes and"
        " are shared by four facets each, which is the dearest case."
    ),
    table(["kernel", "meshes", "without", "with", "ratio of medians", "of the least"], contact),
)
