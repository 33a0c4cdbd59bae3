#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: trials.py TABLE BILLET

Runs, in an empty current folder, scenes of people who knew the manual alone. Each line of TABLE is a
scene, and what it must come to:

  SCENE -> RESULTS

SCENE is a file in a folder beside TABLE, such as joints/clamp; files that it names stand beside it.
RESULTS are separated by commas. 'column = 10 +- 0.2' is the last value of this column of the history, to
this part; 'max column', 'min column' and 'mean column' are those over the run. Other results are as in
doubtful.py. '#' begins a comment.
"""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

from checks import Checks, Program, Run, Runner, read_text, require
from doubtful import require_keys

RESULT = re.compile(r"(?:(max|min|mean) )?([^=~]+?) = (\S+) \+- (\S+)")
OF_TRIAL = (".prm", ".md", ".log", ".cases")


def value_of(ran: Run, what: str, column: str) -> float:
    """Returns the last value of a column, or its greatest, least or mean one."""
    values = ran.column(column)
    if what == "mean":
        return sum(values) / len(values)
    return {"max": max(values), "min": min(values), "": values[-1]}[what]


def require_results(results: str, ran: Run) -> None:
    """Raises a fault unless the run came to these results."""
    keys = []
    for result in re.split(r"\s*,\s*", results):
        match = RESULT.fullmatch(result)
        if match is None:
            keys.append(result)
            continue
        what, column, expected, part = match.groups()
        value = value_of(ran, what or "", column)
        is_near = abs(value - float(expected)) <= float(part) * abs(float(expected))
        require(is_near, f"{result.split(' = ')[0]} is {value:.6g}, not {expected}")
    require_keys(", ".join(keys) if keys else "code 0", ran.ended.code, ran.said + ran.complained)


def main() -> int:
    """Returns the exit code."""
    table, billet = sys.argv[1:]
    check, runner = Checks("cases"), Runner(Program([billet]))
    for line in read_text(table).split("\n"):
        if re.match(r"\s*(#|$)", line):
            continue
        match = re.match(r"(\S+) -> (.*)$", line)
        if match is None:
            sys.exit(f"{table}: no trial: {line}")
        scene, results = match.groups()

        @check(scene)
        def _() -> None:
            file = Path(table).parent / f"{scene}.prm"
            for beside in file.parent.iterdir():
                if beside.suffix not in OF_TRIAL:
                    shutil.copy(beside, ".")
            text = read_text(file)
            if not re.search(r"^subsection Output$", text, re.MULTILINE):
                text += "\nsubsection Output\nend\n"
            text += "set Output/Format = none\n"
            require_results(results, runner.run(text))

    return check.finish()


if __name__ == "__main__":
    sys.exit(main())
