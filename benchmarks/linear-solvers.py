# SPDX-License-Identifier: LGPL-2.1-or-later
"""One linear system of two bodies in contact: iterations, processor seconds and memory of the linear
solvers."""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

from billet_runs import PROGRAM, ROOT, number, table, wrapped

parser = argparse.ArgumentParser(prog="scripts/benchmarks linear-solvers")
parser.add_argument("--quick", action="store_true", help="50 000 dofs only")
parser.add_argument("--large", action="store_true", help="add 500 000 dofs")
parser.add_argument("--ranks", type=int, default=2, help="processes of the parallel runs (2)")
parser.add_argument(
    "--keep", type=Path, help="folder for what each run printed; what is there already does not run again"
)
parser.add_argument(
    "--kept", action="store_true", help="with --keep: nothing runs, what is not there is a dash"
)
options = parser.parse_args()

program = Path(PROGRAM).parent.parent / "benchmarks/bin/linear_solvers"
SIZES = (50_000,) if options.quick else (50_000, 150_000, 500_000) if options.large else (50_000, 150_000)
PENALTIES = ("1", "100", "10000")
TIES = (("sticking", "CG"), ("frictionless", "CG"), ("sliding", "GMRES"))
DIRECT_BYTES = {"sticking": 300, "sliding": 500}  # of n^(4/3), enough to be safe
SEVERAL_RANKS = 1.7  # times that


def available_memory() -> int:
    with open("/proc/meminfo") as file:
        return 1024 * next(int(line.split()[1]) for line in file if line.startswith("MemAvailable"))


def run(
    solver: str, size: int, penalty: str, tie: str, ranks: int, preconditioner: str = "softened"
) -> dict[str, float] | None:
    """Returns the output of the program by name; None if the machine has too little memory, or the run
    failed."""
    name = "-".join([solver, str(size), penalty, tie, str(ranks), preconditioner])
    kept = options.keep / name if options.keep else None
    if kept and kept.exists():
        words = kept.read_text().split()
    elif options.kept:
        return None
    else:
        if (
            solver == "MUMPS"
            and DIRECT_BYTES[tie] * (SEVERAL_RANKS if ranks > 1 else 1) * size ** (4 / 3) > available_memory()
        ):
            print(f"{name}: too little memory", file=sys.stderr, flush=True)
            return None
        command = ([] if ranks == 1 else ["mpirun", "-n", str(ranks)]) + [
            str(program),
            solver,
            str(size),
            penalty,
            tie,
            preconditioner,
        ]
        done = subprocess.run(command, capture_output=True, text=True)
        print(f"{name}: {done.stdout.strip()} {done.stderr.strip()}", file=sys.stderr, flush=True)
        if done.returncode != 0:
            return None
        words = done.stdout.split()
        if kept:
            options.keep.mkdir(parents=True, exist_ok=True)
            kept.write_text(done.stdout)
    return {key: float(value) for key, value in zip(words[::2], words[1::2])}


def cells(result: dict[str, float] | None) -> list[str]:
    if result is None:
        return ["–"] * 5
    iterations = (
        (
            number(int(result["iterations"]))
            if result["success"]
            else "none in " + number(int(result["iterations"]))
        )
        if result["iterations"]
        else "direct"
    )
    return [
        iterations,
        number(result["set_up"]),
        number(result["solve"]),
        number(result["set_up"] + result["solve"]),
        number(round(result["peak"])),
    ]


head = [
    "dofs",
    "contact nodes",
    "contact",
    "k h / E",
    "solver",
    "ranks",
    "iterations",
    "set-up [CPU s]",
    "solve [CPU s]",
    "both [CPU s]",
    "peak memory [MB]",
]
rows, variants = [], []
for size in SIZES:
    for ranks in (1, options.ranks):
        for tie, krylov in TIES:
            for penalty in PENALTIES:
                result = run(krylov, size, penalty, tie, ranks)
                rows.append(
                    [int(result["dofs"]), int(result["pairs"]), tie, penalty, krylov, ranks] + cells(result)
                    if result
                    else [size, "–", tie, penalty, krylov, ranks] + cells(None)
                )
            if tie == "frictionless":  # MUMPS does as for sticking
                continue
            result = run("MUMPS", size, PENALTIES[-1], tie, ranks)
            rows.append(
                [
                    int(result["dofs"]) if result else size,
                    int(result["pairs"]) if result else "–",
                    tie,
                    PENALTIES[-1],
                    "MUMPS symmetric" if tie == "sticking" else "MUMPS",
                    ranks,
                ]
                + cells(result)
            )


def memory() -> str | None:
    """Returns the memory that MUMPS would need where it has not run, by its growth."""
    found = {}
    for size in SIZES:
        for ranks in (1, options.ranks):
            for tie in DIRECT_BYTES:
                result = run("MUMPS", size, PENALTIES[-1], tie, ranks)
                if result:
                    found[size, tie, ranks] = result["peak"]
    largest, middle = SIZES[-1], SIZES[-2] if len(SIZES) > 1 else 0
    if (largest, "sticking", 1) not in found or (middle, "sticking", 1) not in found:
        return None
    growth = found[largest, "sticking", 1] / found[middle, "sticking", 1]
    missing = [
        f"- {'symmetric' if tie == 'sticking' else 'unsymmetric'} on {ranks} rank{'s' if ranks > 1 else ''},"
        f" {number(round(growth * found[middle, tie, ranks], -2))} MB"
        for ranks in (1, options.ranks)
        for tie in DIRECT_BYTES
        if (largest, tie, ranks) not in found and (middle, tie, ranks) in found
    ]
    return (
        "MUMPS did not run everywhere at the largest size. If its memory grows as the symmetric factors on"
        " one rank do, it needs:\n\n" + "\n".join(missing)
        if missing
        else None
    )


for tie, krylov in TIES:
    for penalty in PENALTIES:
        variants.append(
            [tie, penalty, krylov]
            + [
                cells(run(krylov, SIZES[0], penalty, tie, 1, kind))[0]
                for kind in ("plain", "block", "softened")
            ]
        )

page = wrapped(
    "\n\n".join(
        part
        for part in [
            "# Two bodies in contact: linear solvers",
            "Written by `scripts/benchmarks linear-solvers" + (" --large" if options.large else "") + "`.",
            (
                "This page shows which linear solver is cheapest for two bodies in contact, over size,"
                " contact and penalty. Two elastic cubes with meshes that do not fit lie on each other,"
                " tied node to facet by a penalty k.\n\n"
                "- Sticking: k acts in all directions.\n"
                "- Frictionless: k acts along the normal alone.\n"
                "- Sliding: k acts along the normal, with a friction of 0.3 of the pressure, so that the"
                " matrix is unsymmetric.\n\n"
                "Each run solves one linear system to 1e-8, as an exact Newton step would. Newton's forcing"
                " asks for 1e-2 most of the time, in a quarter of the iterations. A step of Newton's method"
                " sets up and solves once. What a direct solver does depends on the pattern of the matrix,"
                " and not on k: one k is enough.\n\n"
                "CPU seconds are those of all ranks, on a busy machine: read them as ratios. Each run is"
                " done once. The peak memory is that of all ranks, mesh, matrix and libraries included. On"
                " several ranks each has a part of both cubes. A dash: not measured, or not enough memory."
            ),
            table(head, rows),
            memory(),
            (
                "## Which parts of multigrid help\n\n"
                f"The table has the iterations at {SIZES[0]} dofs on one rank. Multigrid works alone first."
                " Then the contact dofs are solved directly after each cycle. Last comes the cycle for"
                " softened contact, too, which is what the program does (theory: *Solution*)."
            ),
            table(
                ["contact", "k h / E", "solver", "multigrid", "and contact block", "and softened contact"],
                variants,
            ),
        ]
        if part
    )
    + "\n"
)
print(page)
if options.quick:
    print("A quick run: doc/results/linear-solvers.md stays as it is.")
else:
    (ROOT / "doc/results/linear-solvers.md").write_text(page)
