#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs a command in a fresh folder and judges what came out.

Usage: run_test.py said FOLDER EXIT_CODE REGEX COMMAND...
       run_test.py compared FOLDER COMPARISON_FILE NUMDIFF COMMAND...

'said': the exit code must be the expected one, and a line that the command prints must match.

'compared': the file `output` that the command writes, or else all that it prints, must be COMPARISON_FILE or
one of its variants (COMPARISON_FILE.*), as deal.II compares: numbers to 1e-8 relative or 1e-6. Of a file
*.run_only nothing is compared. With UPDATE_OUTPUT=1 in the environment the result becomes the new
COMPARISON_FILE.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Sequence

ENVIRONMENT = Path(__file__).resolve().parents[1] / "scripts/environment.sh"

# Output that differs between runs or versions: deal.II's debug output, negative zeros, and times.
VOLATILE = (
    (r"\r$", ""),
    (r"^DEAL.*::_.*\n", ""),
    (r"line <\d+> of file <.*/", "file <"),
    (r"-0\.(0+)(?!\d)", r"0.\1"),
    (r"^Completed in \d+:\d+", "Completed in 0:00"),
    (r"^ +\d+ % in .*\n", ""),
    (
        r" elements in \S+ s: \S+ ns for each element and step, \S+ of",
        " elements in 0 s: 0 ns for each element and step, 0 of",
    ),
)
NUMDIFF_OPTIONS = ("-a", "1e-6", "-r", "1e-8", "-s", " \\t\\r\\n=,:;<>[](){}^")


def run(folder: Path, command: Sequence[str]) -> int:
    """Runs the command in the folder, which is made anew; what it prints goes to the file stdout. Returns the
    exit code."""
    for word in command:
        if "/bin/" in word and not os.access(word, os.X_OK):
            sys.exit(f"{word} is not built: build the target test_programs")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    os.chdir(folder)
    # Open MPI binds ranks to cores from the first one on: two tests at a time would share it and leave others
    # idle.
    # up to Open MPI 5, from 6 on
    variables = {"OMPI_MCA_hwloc_base_binding_policy": "none", "PRTE_MCA_bindto": "none"}
    if not any(Path(word).name.startswith("mpi") for word in command):
        # As the program does by itself: one process needs no network, whose search takes time.
        variables |= {"OMPI_MCA_pml": "ob1", "OMPI_MCA_btl": "self"}
    with open("stdout", "wb") as output:
        return subprocess.run(
            ["bash", "-c", '. "$0" && exec "$@"', str(ENVIRONMENT), *command],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            env={**os.environ, **variables},
        ).returncode


def read(name: str) -> str:
    """Returns the contents of a file in the current folder."""
    return Path(name).read_text(encoding="utf-8", errors="replace")


def said(folder: Path, expected_code: int, regex: str, command: Sequence[str]) -> str:
    """Runs the command and returns what is wrong with what it said."""
    code = run(folder, command)
    text = read("stdout")
    print(" ".join(command), text, sep="\n")
    if code != expected_code:
        return f"exit code {code}, expected {expected_code}"
    return "" if re.search(regex, text, re.MULTILINE) else f"no line matches '{regex}'"


def compared(folder: Path, comparison_file: Path, numdiff: str, command: Sequence[str]) -> str:
    """Runs the command and returns how its output differs."""
    code = run(folder, command)
    if code != 0:
        print(read("stdout"))
        if os.path.exists("output"):
            print("--- output so far:", read("output"), sep="\n")
        return f"exit code {code} from: {' '.join(command)}"
    if comparison_file.suffix == ".run_only":
        return ""
    text = read("output" if os.path.exists("output") else "stdout")
    for pattern, replacement in VOLATILE:
        text = re.sub(pattern, replacement, text, flags=re.MULTILINE)
    Path("output").write_text(text, encoding="utf-8")
    if os.environ.get("UPDATE_OUTPUT", "0") != "0":
        shutil.copy("output", comparison_file)
    variants = sorted(comparison_file.parent.glob(comparison_file.name + "*"))
    differences = []
    for variant in variants:
        done = subprocess.run([numdiff, *NUMDIFF_OPTIONS, variant, "output"], capture_output=True, text=True)
        if done.returncode == 0:
            return ""
        differences.append("\n".join((done.stdout + done.stderr).splitlines()[:20]))
    return (
        f"{folder}/output differs from {comparison_file}:\n{differences[0] if variants else 'there is none'}"
    )


def main() -> int:
    """Returns the exit code."""
    how, folder, first, second, *command = sys.argv[1:]
    if how == "said":
        fault = said(Path(folder), int(first), second, command)
    else:
        fault = compared(Path(folder), Path(first), second, command)
    if fault:
        print(f"FAILED: {fault}")
    return 1 if fault else 0


if __name__ == "__main__":
    sys.exit(main())
