# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shared parts of the benchmarks: runs of billet, errors of force curves, tables."""

from __future__ import annotations

import argparse
import math
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Sequence

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tools"))
from billet_tools.kept import hash_of_file  # noqa: E402
from billet_tools.output import read_rows  # noqa: E402
from billet_tools.program import Measured, command_of  # noqa: E402
from billet_tools.records import read_records  # noqa: E402
from billet_tools.scene import Changes, read_scene, variant  # noqa: E402
from billet_tools.text import number, percent, quoted, table, wrapped  # noqa: E402, F401  for the benchmarks

PROGRAM = os.environ.get("BILLET", str(ROOT / "build/release/bin/billet"))
SCENE = ROOT / "prm/billet_upsetting.prm"
TANGENTS = ("exact", "consistent", "continuum", "symmetrised upper", "symmetrised lower", "symmetrised mean")

PENALTY = 3.5e5  # N/mm³, the scene's

# Parameters that more than one benchmark changes.
MESH = "Bodies/billet/Mesh/"
PAIR = "Contact pairs/billet on die/"
TANGENT = "Solver/Contact tangent"


def mesh(refinements: int) -> dict[str, object]:
    """60, 480, 3840, ... bricks for 1, 2, 3, ...: each brick is cut into eight."""
    return {MESH + "Refinements": refinements, MESH + "Layers": 5 * 2 ** (refinements - 1)}


def n_elements(refinements: int) -> int:
    return 60 * 8 ** (refinements - 1)


def fixed_steps(n: int) -> dict[str, object]:
    return {"Time stepping/Step control": "fixed", "Time stepping/Initial step": repr(1.0 / n)}


class Run:
    """A finished run: `converged`, `failure` (why not, in short), `times` and `forces` (on the whole body, in
    kN, from time 0 on), `steps`, `iterations` (with those of cut steps), `cuts`, `seconds` (user and system,
    of all ranks), `megabytes` (of the largest rank), `rows` of the history, what was `said` on the console.
    Results stay in `folder`, if there is one."""

    def __init__(
        self,
        changes: Changes | None = None,
        ranks: int = 1,
        scene: Path = SCENE,
        tool: str = "die",
        folder: str | Path | None = None,
    ) -> None:
        text = variant(
            read_scene(scene),
            {
                "Output/Format": "none",
                "Output/Verbosity": "quiet",
                "Output/Folder": "results",
                **(changes or {}),
            },
        )
        with tempfile.TemporaryDirectory() as temporary:
            place = Path(folder or temporary)
            place.mkdir(parents=True, exist_ok=True)
            (place / "scene.prm").write_text(text)
            done = Measured(command_of(PROGRAM, ranks, "scene.prm"), place)
            done.require_end()
            self.seconds, self.megabytes = done.seconds, done.megabytes
            rows = read_rows(place / "results/history.csv")
            self.records = read_records(place / "results/diagnostics.jsonl")
        self.converged = done.code != 3
        self.failure = (
            ""
            if self.converged
            else (
                "inside out"
                if "inadmissible" in done.stderr
                else (
                    "no convergence"
                    if re.search("does not converge|solver stops", done.stderr)
                    else done.stderr.strip()
                )
            )
        )
        self.times = [0.0] + [float(row["time"]) for row in rows]
        self.forces = [0.0] + [-4e-3 * float(row[tool + ".force_z"]) for row in rows]
        self.rows, self.said = rows, done.stdout
        self.steps = len(rows)
        self.iterations = int(rows[-1]["total_iterations"]) if rows else 0
        self.cuts = int(rows[-1]["total_cuts"]) if rows else 0
        said = ", ".join(f"{key.split('/')[-1]} = {value}" for key, value in (changes or {}).items())
        print(
            (
                f"[{said}] {self.iterations} iterations,"
                f" {self.seconds:.3g} s{'' if self.converged else ', failed'}"
            ),
            file=sys.stderr,
            flush=True,
        )

    def force(self, time: float) -> float:
        return interpolate(self.times, self.forces, time)


def count_instructions(
    folder: str | Path, function: str = "billet::run_simulation(*", program: str = PROGRAM
) -> int:
    """Returns the instructions of a function in a run of scene.prm in this folder by callgrind; by default
    those of the run, without those of libraries before it."""
    done = subprocess.run(
        [
            "valgrind",
            "--tool=callgrind",
            f"--toggle-collect={function}",
            "--callgrind-out-file=/dev/null",
            program,
            "scene.prm",
        ],
        cwd=folder,
        capture_output=True,
        text=True,
        env={**os.environ, "OPENBLAS_CORETYPE": "Haswell"},
    )
    if done.returncode != 0:
        sys.exit(f"under valgrind billet ended with {done.returncode}: {done.stderr}")
    return int(re.findall(r"Collected : (\d+)", done.stderr)[0])


def interpolate(times: Sequence[float], values: Sequence[float], time: float) -> float:
    """The value at this time, straight lines between; NaN beyond the last."""
    for t0, t1, v0, v1 in zip(times, times[1:], values, values[1:]):
        if t0 <= time <= t1:
            return v0 + (v1 - v0) * (time - t0) / (t1 - t0)
    return math.nan


def frictionless_force(time: float, penalty: float = math.inf) -> float:
    """Closed form of the force on the whole billet in kN without friction, for a law that yields in Kirchhoff
    stress τ: along the axis ln λ = −τ/E − ε_p with τ = σ_y + H ε_p; force = τ A_0 / λ; force over current
    area = penalty times penetration, by which the billet is less upset."""
    radius, half_length, travel = 10.0, 15.0, 9.6
    E, nu, yield_stress, H = 200e3, 0.3, 700.0, 300.0
    penetration = 0.0
    for _ in range(50):  # a contraction
        stretch = 1.0 - (travel * time - penetration) / half_length
        plastic = (-math.log(stretch) - yield_stress / E) / (1.0 + H / E)
        stress = yield_stress + H * plastic
        force = stress * math.pi * radius**2 / stretch
        area = math.pi * radius**2 * math.exp(2.0 * nu * stress / E + plastic)
        penetration = force / area / penalty
    return force / 1e3


def curve_error(run: Run, reference: Run) -> float:
    """Integral of |F - F*| over that of |F*| by the trapezoidal rule over the ends of the run's steps: what
    lies between them was not computed, and the jump to first yield within the first step is nobody's
    fault."""
    if not run.converged:
        return math.nan
    times, forces = run.times[1:], run.forces[1:]
    exact = [reference.force(time) for time in times]

    def integral(values: Sequence[float]) -> float:
        return sum(0.5 * (a + b) * (t - s) for a, b, s, t in zip(values, values[1:], times, times[1:]))

    return integral([abs(f - g) for f, g in zip(forces, exact)]) / integral([abs(g) for g in exact])


def arguments(name: str, has_scenes: bool = False) -> argparse.Namespace:
    """Command line of a benchmark; the same for all, so that `all` can pass it on. Those that run scenes by
    themselves take some of them, too."""
    parser = argparse.ArgumentParser(prog=f"scripts/benchmarks {name}")
    parser.add_argument(
        "--quick", action="store_true", help="leave out what takes long, where something does"
    )
    parser.add_argument("--large", action="store_true", help="add a larger mesh, where there is one")
    parser.add_argument("--ranks", type=int, default=1, help="processes to run billet on (1)")
    if has_scenes:
        parser.add_argument(
            "--only",
            nargs="+",
            metavar="SCENE",
            help="measure these scenes anew, and keep the rows of others",
        )
    return parser.parse_args()


def program_hash() -> str:
    """Names the program that is measured by the start of its hash."""
    return hash_of_file(Path(PROGRAM))[:8]


def publish(name: str, title: str, options: argparse.Namespace, *parts: str | None) -> None:
    """Prints the page and writes it to doc/results/NAME.md."""
    flags = [f"--{key}" for key in ("quick", "large") if getattr(options, key)]
    flags += [f"--ranks {options.ranks}"] if options.ranks > 1 else []
    command = " ".join(["scripts/benchmarks", name] + flags)
    ranks = "one rank" if options.ranks == 1 else f"{options.ranks} ranks"
    head = [f"# {title}", f"Written by `{command}`, on {ranks}."]
    page = wrapped("\n\n".join(head + [part for part in parts if part])) + "\n"
    print(page)
    if options.quick:
        print(f"A quick run: doc/results/{name}.md stays as it is.")
        return
    path = ROOT / "doc/results" / f"{name}.md"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(page)
