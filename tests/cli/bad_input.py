#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: bad_input.py TABLE [LAUNCHER... RANKS] BILLET

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

Each line of TABLE is a scene that billet must refuse:    EDIT -> MESSAGE

EDIT of block.prm, or of the file that a line 'scene FILE' names: see edits.py. MESSAGE: all that is printed,
where '...' stands for anything, '@' for the file and the line of the last edit, '@{name}' for those of that
subsection. 'allowed ...' or 'did you mean ...' alone stands for "@: 'Key' in 'Path' is 'value'; allowed ...".
Several messages are separated by ' || '. After NAME :=
EDIT, NAME at the start of a line stands for EDIT. '#' begins a comment. The note about what is unchecked does
not count.

One start of the program with --check reads the whole table: it must say the messages and nothing else. Every
thirtieth scene, and every one of a table run_*.cases (of what --check may pass), is also run. Each must end
with exit code 2 and leave every file as it was, results of a run before included. Tables *_ranks*.cases, of
what ranks might take for different, run on two ranks; all others on one.
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import NamedTuple, Sequence

from checks import HERE, Program, differences, enter_folder, read_text, run, snapshot, write_text
from edits import edit, line_of


class Case(NamedTuple):
    """A scene that must be refused."""

    name: str
    file: str
    expected: str

    @property
    def n_messages(self) -> int:
        """Number of messages that are expected."""
        return len(self.expected.split(" || "))

    def matches(self, messages: Sequence[str]) -> bool:
        """Tells whether these are the messages."""
        patterns = [
            ".*".join(re.escape(part) for part in one.split("...")) for one in self.expected.split(" || ")
        ]
        return len(messages) == len(patterns) and all(
            re.fullmatch(rf"error\[bad-input\]: {pattern}\.?\n", message)
            for pattern, message in zip(patterns, messages)
        )


def read_cases(table: Path, base: str) -> list[Case]:
    """Writes the scenes of a table."""
    cases: list[Case] = []
    short: dict[str, str] = {}
    for line in read_text(table).split("\n"):
        if re.match(r"\s*(#|$)|scene \S+$", line):
            continue
        if match := re.match(r"(\w+) := (.*)", line):
            short[match[1]] = match[2]
            continue
        match = re.match(r"(.*?)\s*-> (.*)$", line)
        if match is None:
            sys.exit(f"{table}: no '->' in: {line}")
        name, expected = match.groups()
        edited = edit(base, re.sub(r"^(\w+)(?= &|$)", lambda word: short.get(word[1], word[1]), name))
        file = f"case_{len(cases) + 1:03d}.prm"
        write_text(file, edited.text)
        if expected.startswith(("allowed ", "did you mean ")):
            place = f" in '{edited.path}'" if edited.path else ""
            verb = "contains" if "muParser" in expected else "is"  # an expression may be a part of a value
            expected = f"@: '{edited.key}'{place} {verb} '{edited.value}'; {expected}"
        expected = re.sub(r"@\{(.*?)\}", lambda word: f"{file}:{line_of(edited.text, word[1])}", expected)
        expected = re.sub(r"\bscene\.prm\b(?=:)", file, expected.replace("@", f"{file}:{edited.line}"))
        cases.append(Case(name, file, expected))
    return cases


class Refusals:
    """Runs cases and notes their faults."""

    def __init__(self, program: Program, ranks: int) -> None:
        self.program, self.ranks = program, ranks
        self.faults: dict[str, str] = {}
        self._before = snapshot()

    def run(self, cases: Sequence[Case], *options: str) -> None:
        """Runs these at once."""
        code, output, errors = run(*self.program.on(self.ranks, *options, *(case.file for case in cases)))
        errors = re.sub(r"^note\[unchecked-parts\].*\n", "", errors, flags=re.MULTILINE)
        messages = [part for part in re.split(r"^(?=error\[)", errors, flags=re.MULTILINE) if part]
        for case in cases:
            named = re.match(r"error\[bad-input\]: (case_\d+\.prm)", messages[0]) if messages else None
            is_of_another = named is not None and named[1] != case.file
            found = [] if is_of_another else messages[: case.n_messages]
            messages = messages[len(found) :]
            if not case.matches(found):
                said = "".join(found) or "nothing\n"
                self._note(case, f"says:\n{said}instead of:\nerror[bad-input]: {case.expected}\n")
        last = cases[-1]
        if output:
            self._note(last, "prints:\n" + "".join(output.splitlines(keepends=True)[:8]))
        if messages:
            self._note(last, "says besides:\n" + " ".join(messages))
        if code != 2:
            self._note(last, "hangs\n" if code in (124, 137) else f"exit code {code}\n")
        after = snapshot()
        if changed := differences(self._before, after):
            self._note(last, f"writes over {len(changed)} files, such as {changed[0]}\n")
        self._before = after

    def _note(self, case: Case, fault: str) -> None:
        self.faults[case.name] = self.faults.get(case.name, "") + fault


def main() -> int:
    """Returns the exit code."""
    table = Path(sys.argv[1])
    *launcher, billet = sys.argv[2:]
    ranks = int(launcher.pop()) if launcher else 1
    enter_folder()
    os.makedirs("no_history/history.csv")  # a folder where a file should be
    match = re.search(r"^scene (\S+)$", read_text(table), re.MULTILINE)
    base_name = match[1] if match else "block.prm"
    base = read_text(HERE / base_name)
    write_text("scene.prm", base)
    # Few fields: each check looks at all files of the results.
    code, _, errors = run(billet, "scene.prm", "--set", "Output/Step interval=1000000")
    if code:
        sys.exit(f"{base_name} itself fails ({code}): {errors}")

    cases = read_cases(table, base)
    refusals = Refusals(Program([billet, *launcher]), ranks)
    runs_all = table.name.startswith("run_")
    if not runs_all:
        refusals.run(cases, "--check")
    for case in cases[:: 1 if runs_all else 30]:
        refusals.run([case])

    for case in cases:
        print(
            f"{case.name}:"
            f" {'FAILED: ' + refusals.faults[case.name] if case.name in refusals.faults else 'ok'}"
        )
    print(f"{len(cases)} cases, {len(refusals.faults)} failed")
    return 0 if cases and not refusals.faults else 1


if __name__ == "__main__":
    sys.exit(main())
