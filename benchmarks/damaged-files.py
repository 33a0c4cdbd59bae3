# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damaged files of all kinds that the program reads: how each ends, and how long it takes."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from billet_runs import PROGRAM, arguments, number, publish, table

options = arguments("damaged-files")
TESTS = Path(PROGRAM).resolve().parents[1] / "tests"
MAX_SECONDS = 10  # as in tests/fuzz/fuzz.h


class Target(NamedTuple):
    """A fuzz target: the files that it damages, its test, and how many files it makes of each."""

    what: str
    test: str
    n_files: int


TARGETS = (
    Target("meshes: MSH, VTK, UCD, decks", "mesh.mutations", 10000),
    Target("CAD: text of STEP and IGES", "fuzz.cad_text", 10000),
    Target("CAD: STEP and IGES, by OpenCASCADE", "geometry.damaged_cad", 1200),
    Target("STL", "fuzz.stl", 10000),
    Target("files of Coons patches", "fuzz.coons", 1000),
    Target("tables of numbers", "fuzz.table", 10000),
    Target("scenes", "fuzz.scene", 1500),
    Target("checkpoints", "fuzz.checkpoint", 10000),
)
READ = re.compile(r"^(\S+): (\d+) read by OpenCASCADE$", re.MULTILINE)
LINE = re.compile(r"^(\S+): (\d+) files, (\d+) refused, (\d+) unsound, longest (\S+) s$", re.MULTILINE)


class Counts(NamedTuple):
    """Outcomes of the files of a target."""

    n_files: int
    n_refused: int
    n_unsound: int
    longest: float
    end: str  # of the program
    n_read: int  # by OpenCASCADE, of those files that it may read


def damage(target: Target) -> Counts:
    """Runs a target."""
    folder_of_tests, name = target.test.split(".")
    program = TESTS / folder_of_tests / "bin" / f"{folder_of_tests}_tests"
    n_files = target.n_files // (20 if options.quick else 1)
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [str(program), name, str(n_files)],
            cwd=folder,
            capture_output=True,
            text=True,
            env={**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"},
        )
        for kept in [*Path(folder).glob("unsound_*"), *Path(folder).glob("slow_*")]:
            shutil.copy(kept, TESTS / "fuzz")
            print(f"kept: {TESTS / 'fuzz' / kept.name}", file=sys.stderr)
    rows = LINE.findall(done.stdout)
    end = {0: "passes", 1: "fails", 2: "hangs"}.get(done.returncode, f"ends with {done.returncode}")
    print(f"{target.test}: {end}", *re.findall(r".*FAILED", done.stdout), file=sys.stderr, flush=True)
    return Counts(
        sum(int(row[1]) for row in rows),
        sum(int(row[2]) for row in rows),
        sum(int(row[3]) for row in rows),
        max((float(row[4]) for row in rows), default=0.0),
        end,
        sum(int(row[1]) for row in READ.findall(done.stdout)),
    )


counts = [damage(target) for target in TARGETS]
total = sum(one.n_files for one in counts)
publish(
    "damaged-files",
    "Damaged files",
    options,
    (
        "This page shows what the readers make of damaged files. `tests/fuzz/damage.h` damages sound files"
        " in one to three places. It changes bytes, numbers and lines, and cuts files short. The readers"
        " run in the process of the test, except OpenCASCADE, which reads each file in a copy first.\n\n"
        "Most damaged CAD files are refused by a check of their text. Half of the files for OpenCASCADE are"
        " therefore damaged in numbers, references and senses alone, so that this check passes most.\n\n"
        "A file is accepted against itself if the result contradicts its counts, indices, sizes or checksums."
        f" The limit for a file is {MAX_SECONDS} s of processor time. A crash or a hang ends the test."
    ),
    table(
        [
            "files",
            "test",
            "damaged files",
            "refused with a message",
            "accepted, sound",
            "accepted against itself",
            "longest [s]",
            "the test",
        ],
        [
            [
                target.what,
                f"`{target.test}`",
                f"{one.n_files}",
                f"{one.n_refused}",
                f"{one.n_files - one.n_refused - one.n_unsound}",
                f"{one.n_unsound}",
                number(one.longest, 2),
                one.end,
            ]
            for target, one in zip(TARGETS, counts)
        ],
    ),
    (
        f"These are {total} files in all. {sum(one.n_unsound for one in counts)} were accepted against"
        f" themselves, and {sum(one.longest > MAX_SECONDS for one in counts)} tests have a file above the"
        " limit. The text of"
        f" {sum(one.n_read for one in counts)} damaged CAD files was sound, so that OpenCASCADE read them."
    ),
)
sys.exit(0 if all(one.end == "passes" for one in counts) else 1)
