# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the benchmarks share: runs of billet, errors of force curves, tables."""

import argparse
import csv
import math
import os
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "trade"))
from billet_trade.records import read_records  # noqa: E402
from billet_trade.scene import read_scene, variant  # noqa: E402  what the program billet-trade has

PROGRAM = os.environ.get("BILLET", str(ROOT / "build/release/bin/billet"))
SCENE = ROOT / "prm/billet_upsetting.prm"
TANGENTS = ("exact", "consistent", "continuum", "symmetrised upper", "symmetrised lower", "symmetrised mean")

PENALTY = 3.5e5  # N/mm³, the scene's

# Parameters that more than one benchmark changes.
MESH = "Bodies/billet/Mesh/"
PAIR = "Contact pairs/billet on die/"
TANGENT = "Solver/Contact tangent"


def mesh(refinements):
    """60, 480, 3840, ... bricks for 1, 2, 3, ...: each brick is cut into eight."""
    return {MESH + "Refinements": refinements, MESH + "Layers": 5 * 2 ** (refinements - 1)}


def n_elements(refinements):
    return 60 * 8 ** (refinements - 1)


def fixed_steps(n):
    return {"Time stepping/Step control": "fixed", "Time stepping/Initial step": repr(1.0 / n)}


def children_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Measured:
    """A program that has run in `folder`: `code`, `stdout`, `stderr`, `seconds` (user and system, of all its
    processes) and `megabytes` (at most at a time, of the largest one). After `limit` seconds of a processor
    the system ends it."""

    def __init__(self, command, folder, limit=None, **options):
        def restrict():
            if limit:
                resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))

        with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
            process = subprocess.Popen(
                command, cwd=folder, stdout=out, stderr=err, preexec_fn=restrict, **options
            )
            _, status, usage = os.wait4(process.pid, 0)
            self.code = process.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0), err.seek(0)
            self.stdout, self.stderr = out.read(), err.read()
        self.seconds = usage.ru_utime + usage.ru_stime
        self.megabytes = usage.ru_maxrss / 1024


class Run:
    """A finished run: `converged`, `failure` (why not, in short), `times` and `forces` (on the whole body, in
    kN, from time 0 on), `steps`, `iterations` (with those of cut steps), `cuts`, `seconds` (user and system,
    of all ranks), `megabytes` (of the largest rank), `rows` of the history, what was `said` on the console.
    Results stay in `folder`, if there is one."""

    def __init__(self, changes=None, ranks=1, scene=SCENE, tool="die", folder=None):
        text = variant(
            read_scene(scene),
            {
                "Output/Format": "none",
                "Output/Verbosity": "quiet",
                "Output/Folder": "results",
                **(changes or {}),
            },
        )
        command = ([] if ranks == 1 else ["mpirun", "-n", str(ranks)]) + [PROGRAM, "scene.prm"]
        with tempfile.TemporaryDirectory() as temporary:
            place = Path(folder or temporary)
            place.mkdir(parents=True, exist_ok=True)
            (place / "scene.prm").write_text(text)
            done = Measured(command, place)
            self.seconds, self.megabytes = done.seconds, done.megabytes
            if done.code not in (0, 3, 6, 7):
                sys.exit(f"billet ended with {done.code}: {done.stderr}")
            with open(place / "results/history.csv", newline="") as file:
                rows = list(csv.DictReader(file))
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
                    if re.search("no convergence|given up", done.stderr)
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

    def force(self, time):
        return interpolate(self.times, self.forces, time)


def count_instructions(folder):
    """Of a run of scene.prm in this folder by callgrind, without what libraries do before it."""
    done = subprocess.run(
        [
            "valgrind",
            "--tool=callgrind",
            "--toggle-collect=billet::run_simulation(*",
            "--callgrind-out-file=/dev/null",
            PROGRAM,
            "scene.prm",
        ],
        cwd=folder,
        capture_output=True,
        text=True,
        env={**os.environ, "OPENBLAS_CORETYPE": "Haswell"},
    )
    if done.returncode != 0:
        sys.exit(f"under valgrind billet ended with {done.returncode}: {done.stderr}")
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1))


def interpolate(times, values, time):
    """The value at this time, straight lines between; NaN beyond the last."""
    for t0, t1, v0, v1 in zip(times, times[1:], values, values[1:]):
        if t0 <= time <= t1:
            return v0 + (v1 - v0) * (time - t0) / (t1 - t0)
    return math.nan


def frictionless_force(time, penalty=math.inf):
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


def curve_error(run, reference):
    """Integral of |F - F*| over that of |F*| by the trapezoidal rule over the ends of the run's steps: what
    lies between them was not computed, and the jump to first yield within the first step is nobody's
    fault."""
    if not run.converged:
        return math.nan
    times, forces = run.times[1:], run.forces[1:]
    exact = [reference.force(time) for time in times]

    def integral(values):
        return sum(0.5 * (a + b) * (t - s) for a, b, s, t in zip(values, values[1:], times, times[1:]))

    return integral([abs(f - g) for f, g in zip(forces, exact)]) / integral([abs(g) for g in exact])


def number(value, digits=3):
    """In plain or scientific form, to so many significant digits; a dash for what is not there."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "–"
    if isinstance(value, float):
        return f"{value:.{digits}g}" if value == 0 or abs(value) < 10**digits else f"{value:.0f}"
    return str(value)


def percent(value, digits=2):
    return "–" if value is None or math.isnan(value) else number(100.0 * value, digits) + " %"


def table(head, rows):
    lines = [head, ["---"] * len(head)] + rows
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def arguments(name):
    """Command line of a benchmark; the same for all, so that `all` can pass it on."""
    parser = argparse.ArgumentParser(prog=f"scripts/benchmarks {name}")
    parser.add_argument(
        "--quick", action="store_true", help="leave out what takes long, where something does"
    )
    parser.add_argument("--large", action="store_true", help="add a larger mesh, where there is one")
    parser.add_argument("--ranks", type=int, default=1, help="processes to run billet on (1)")
    return parser.parse_args()


def publish(name, title, options, *parts):
    """Prints the page and writes it to doc/results/NAME.md."""
    flags = [f"--{key}" for key in ("quick", "large") if getattr(options, key)]
    flags += [f"--ranks {options.ranks}"] if options.ranks > 1 else []
    command = " ".join(["scripts/benchmarks", name] + flags)
    ranks = "one rank" if options.ranks == 1 else f"{options.ranks} ranks"
    page = (
        "\n\n".join([f"# {title}", f"Written by `{command}`, on {ranks}."] + [part for part in parts if part])
        + "\n"
    )
    print(page)
    if options.quick:
        print(f"A quick run: doc/results/{name}.md stays as it is.")
        return
    path = ROOT / "doc/results" / f"{name}.md"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(page)
