#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs a command in a fresh folder and judges what came out.

Usage: run_test.py said FOLDER EXIT_CODE REGEX COMMAND...
       run_test.py numbers FOLDER NUMBERS_FILE NUMDIFF RANKS COMMAND...
       run_test.py compared FOLDER COMPARISON_FILE NUMDIFF COMMAND...

'said': the exit code must be the expected one, and a line that the command prints must match.

'numbers': the command's last word is the name of a test. What it prints as `number NAME = VALUE` must be
the numbers of its line in NUMBERS_FILE, 'TEST[ on RANKS]: NAME = VALUE[ +- TOLERANCE]; ...': counts exactly,
others to 1e-8 relative, unless the line says otherwise. If the test has a file TEST.output, the file `output`
that the command writes is compared with it.

'compared': the file `output` that the command writes, or else all that it prints, must be COMPARISON_FILE, as
deal.II compares: numbers to 1e-8 relative or 1e-6.

With UPDATE_OUTPUT=1 in the environment the result becomes the new line or file. With UPDATE_OUTPUT=wider,
counts that are off, as with another kernel of OpenBLAS, get a tolerance of twice that; those that are off by
more than a quarter leave the line.
"""

from __future__ import annotations

import fcntl
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Sequence

from rank import IS_SANITIZED, RANK, starter_of

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
UPDATES = os.environ.get("UPDATE_OUTPUT", "0") not in ("0", "wider")
WIDENS = os.environ.get("UPDATE_OUTPUT") == "wider"
MOST_APART = 0.25  # of a count that is held
NUMDIFF_OPTIONS = ("-a", "1e-6", "-r", "1e-8", "-s", " \\t\\r\\n=,:;<>[](){}^")


def set_environment(uses_mpirun: bool) -> None:
    """Sets what MPI and threads need."""
    if "BILLET_JOBS" not in os.environ:  # which scripts/test has done already
        lines = subprocess.run(
            ["bash", "-c", '. "$0" && env -0', ENVIRONMENT], check=True, capture_output=True, text=True
        ).stdout.split("\0")
        os.environ.update(line.partition("=")[::2] for line in lines if line)
    # Open MPI binds ranks to cores from the first one on: two tests at a time would share it and leave others
    # idle. The second name is that from Open MPI 6 on. Ranks that wait let others compute.
    os.environ |= {
        "OMPI_MCA_hwloc_base_binding_policy": "none",
        "PRTE_MCA_bindto": "none",
        "OMPI_MCA_mpi_yield_when_idle": "1",
    }
    if not uses_mpirun:
        # As the program does by itself: one process needs no network, whose search takes time.
        os.environ |= {"OMPI_MCA_pml": "ob1", "OMPI_MCA_btl": "self"}


def serves(word: Path) -> bool:
    """Returns whether a word of a command is a program that serves."""
    return not IS_SANITIZED and word.is_absolute() and (word.name == "billet" or word.name.endswith("_tests"))


def run(folder: Path, command: Sequence[str]) -> int:
    """Runs the command in the folder, which is made anew; what it prints goes to the file stdout. Returns the
    exit code."""
    for word in command:
        if "/bin/" in word and not os.access(word, os.X_OK):
            sys.exit(f"{word} is not built: build the target test_programs")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    os.chdir(folder)
    set_environment(uses_mpirun=any(Path(word).name.startswith("mpi") for word in command))
    with open("stdout", "wb") as output:
        if serves(Path(command[0])):
            starter = starter_of(command[:1], is_shared=True)
            starter.start(command[1:], folder, output, output)
            return starter.wait()[0]
        if Path(command[0]).name.startswith("mpi"):  # with its option, and the number of ranks
            command = [*command[:3], *RANK, *command[3:]]
        return subprocess.run(
            command, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT
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


def differences(comparison_file: Path, numdiff: str, text: str) -> str:
    """Returns how a text differs from a file."""
    for pattern, replacement in VOLATILE:
        text = re.sub(pattern, replacement, text, flags=re.MULTILINE)
    Path("output").write_text(text, encoding="utf-8")
    if UPDATES:
        shutil.copy("output", comparison_file)
    done = subprocess.run(
        [numdiff, *NUMDIFF_OPTIONS, comparison_file, "output"], capture_output=True, text=True
    )
    if done.returncode == 0:
        return ""
    lines = (done.stdout + done.stderr).splitlines()[:20]
    return "\n".join([f"{Path.cwd()}/output differs from {comparison_file}:", *lines])


def compared(folder: Path, comparison_file: Path, numdiff: str, command: Sequence[str]) -> str:
    """Runs the command and returns how its output differs."""
    code = run(folder, command)
    if code != 0:
        print(read("stdout"))
        return f"exit code {code} from: {' '.join(command)}"
    return differences(comparison_file, numdiff, read("output" if os.path.exists("output") else "stdout"))


def parse_numbers(text: str) -> dict[str, tuple[float, float]]:
    """Returns the numbers of a line by their names, with their tolerances."""
    numbers = {}
    for part in text.split("; "):
        name, value = part.split(" = ")
        number, _, tolerance = value.partition(" +- ")
        exact = float(number)
        numbers[name] = (
            exact,
            float(tolerance) if tolerance else 0 if exact.is_integer() else 1e-8 * abs(exact),
        )
    return numbers


def replace_line(file: Path, key: str, numbers: Sequence[str]) -> None:
    """Gives a line of a table other numbers."""
    with open(file, "r+", encoding="utf-8") as table:
        fcntl.flock(table, fcntl.LOCK_EX)
        lines = table.read().splitlines()
        for i, line in enumerate(lines):
            if line.startswith(f"{key}: "):
                lines[i] = f"{key}: {'; '.join(numbers)}"
        table.seek(0)
        table.truncate()
        table.write("\n".join(lines) + "\n")


def updated(line: str, printed: dict[str, str], old: dict[str, tuple[float, float]]) -> list[str]:
    """Returns the numbers that a test printed: those that are in its line, or all if it has none. Tolerances
    stay."""
    found = dict(re.findall(r"([^;:]+?) = \S+( \+- [^;\s]+)", line.partition(": ")[2]))
    tolerances = {name.strip(): tolerance for name, tolerance in found.items()}
    return [
        f"{name} = {value}{tolerances.get(name, '')}"
        for name, value in printed.items()
        if name in old or set(old) == {"checks"} and old["checks"][0] == 0
    ]


def widened(printed: dict[str, str], old: dict[str, tuple[float, float]]) -> list[str]:
    """Returns the numbers of a line with tolerances that allow what a test printed."""
    numbers = []
    for name, (value, tolerance) in old.items():
        apart = abs(float(printed[name]) - value)
        is_count = value.is_integer() and name != "checks"
        if apart > tolerance and is_count and apart > MOST_APART * value:
            continue
        if apart > tolerance and is_count:
            tolerance = 2 * apart
        numbers.append(f"{name} = {value:.12g}" + (f" +- {tolerance:g}" if is_count and tolerance else ""))
    return numbers


def numbers_of(folder: Path, file: Path, numdiff: str, ranks: int, command: Sequence[str]) -> str:
    """Runs the command and returns which of its numbers are off."""
    code = run(folder, command)
    text = read("stdout")
    print(text)
    if code != 0:
        return f"exit code {code} from: {' '.join(command)}"
    test = command[-1]
    key = test if ranks == 1 else f"{test} on {ranks}"
    with open(file, encoding="utf-8") as table:
        fcntl.flock(table, fcntl.LOCK_SH)  # another test may write its line
        line = next(one for one in table.read().splitlines() if one.startswith(f"{key}: "))
    expected = parse_numbers(line.partition(": ")[2])
    printed = dict(re.findall(r"^number (.*) = (\S+)$", text, re.MULTILINE))
    if UPDATES:
        replace_line(file, key, updated(line, printed, expected))
        return ""
    if WIDENS:
        numbers = widened(printed, expected)
        replace_line(file, key, numbers)
        expected = parse_numbers("; ".join(numbers))
    faults = [
        f"{name} = {printed.get(name, 'missing')}, expected {value:.12g} +- {tolerance:g}"
        for name, (value, tolerance) in expected.items()
        if not abs(float(printed.get(name, "nan")) - value) <= tolerance
    ]
    output = file.parent / f"{test}.output"
    if output.exists():
        faults += filter(None, [differences(output, numdiff, read("output"))])
    return "\n".join(faults)


def main() -> int:
    """Returns the exit code."""
    how, folder, first, second, *command = sys.argv[1:]
    if how == "said":
        fault = said(Path(folder), int(first), second, command)
    elif how == "numbers":
        fault = numbers_of(Path(folder), Path(first), second, int(command[0]), command[1:])
    else:
        fault = compared(Path(folder), Path(first), second, command)
    if fault:
        print(f"FAILED: {fault}")
    return 1 if fault else 0


if __name__ == "__main__":
    sys.exit(main())
