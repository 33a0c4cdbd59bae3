#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: doubtful.py TABLE BILLET [I/N]

Runs in an empty current folder; I/N: every N-th case of the table from the I-th on.

Each line of TABLE is a scene that billet must run, check, refuse or stop with these warnings and errors, or
with no warning:

  SCENE: EDIT -> KEYS          SCENE.prm of this folder or of its folders 'doubtful' and 'files', changed by
                               EDIT (edits.py) if there is one, is run
  check SCENE: EDIT -> KEYS    the same, with --check

KEYS are separated by commas. 'key' must be printed; 'key = 10 +- 0.2' must have this measure, the first
number in its text, to this part; 'key ~ words' must have these words; '! key' must not be printed; 'none'
stands for no warning at all (notes may be printed), 'code 6' for the exit code. That is else 2 for
'bad-input', 3 for 'solution-failed', and 0. '#' begins a comment. After NAME := EDIT, NAME stands for EDIT.
"""

from __future__ import annotations

import json
import re
import sys
from typing import NamedTuple

from checks import (
    HERE,
    SHIPPED,
    Checks,
    Fault,
    Program,
    Runner,
    enter_folder,
    read_scene,
    read_text,
    require,
    run,
    write_text,
)


NO_FIELDS = "set Output/Format = none\n"


def scene_text(name: str) -> str:
    """Returns the text of the scene of this name, without field output."""
    for folder in (HERE / "doubtful", HERE, HERE / "files", SHIPPED):
        if (folder / f"{name}.prm").exists():
            text = read_scene(folder / f"{name}.prm")
            return text if re.search(r"^ *set Format ", text, re.MULTILINE) else text + NO_FIELDS
    raise ValueError(f"there is no scene '{name}'")


def require_keys(keys: str, code: int, said: str) -> None:
    """Raises a fault unless these are the messages."""
    warned = re.findall(r"^(?:warning|error)\[([\w-]+)\]", said, re.MULTILINE)
    printed = re.findall(r"^(?:note|warning|error)\[([\w-]+)\]", said, re.MULTILINE)
    match = re.search(r"\bcode (\d+)", keys)
    expected = int(match[1]) if match else 2 if "bad-input" in keys else 3 if "solution-failed" in keys else 0
    require(code == expected, f"exit code {code}, not {expected}")
    for key in re.split(r"\s*,\s*", keys):
        if key.startswith("code "):
            continue
        if key == "none":
            require(not warned, f"warns of {' '.join(warned)}")
        elif key.startswith("! "):
            require(key[2:] not in printed, f"tells of {key[2:]}")
        else:
            require_message(key, printed, said)


def require_message(key: str, printed: list[str], said: str) -> None:
    """Raises a fault unless this message is printed, with its measure or words."""
    match = re.fullmatch(r"([\w-]+)(?: = (\S+) \+- (\S+)| ~ (.+))?", key)
    if match is None:
        raise ValueError(f"'{key}' is no key")
    name, value, part, words = match.groups()
    require(name in printed, f"does not tell of {name}, but of ({' '.join(printed)})")
    if words is not None:
        pattern = rf"^(?:note|warning|error)\[{re.escape(name)}\].*{re.escape(words)}"
        require(re.search(pattern, said, re.MULTILINE), f"{name} does not say '{words}'")
    if value is not None:
        pattern = rf"^warning\[{re.escape(name)}\]: [^\d\n]*?([\d.]+(?:e[-+]?\d+)?)"
        found = re.search(pattern, said, re.MULTILINE)
        if found is None:
            raise Fault(f"{name} says no number, not {value}")
        is_near = abs(float(found[1]) - float(value)) <= float(part) * abs(float(value))
        require(is_near, f"{name} says {found[1]}, not {value}")


class Case(NamedTuple):
    """A line of the table: a scene with its edits, how it is run, and what must be printed."""

    name: str
    scene: str
    edits: str
    is_check: bool
    keys: str

    @property
    def goes_alone(self) -> bool:
        """Whether it is run, or has an exit code that a check of several scenes does not tell."""
        return not self.is_check or "code " in self.keys


def read_cases(table: str) -> list[Case]:
    """Returns the cases of a table."""
    cases: list[Case] = []
    short: dict[str, str] = {}
    for line in read_text(table).split("\n"):
        if re.match(r"\s*(#|$)", line):
            continue
        if match := re.match(r"(\w+) := (.*)", line):
            short[match[1]] = match[2]
            continue
        match = re.match(r"(check )?(\w+):\s*(.*?)\s*-> (.*)$", line)
        if match is None:
            sys.exit(f"{table}: no case: {line}")
        option, scene, edits, keys = match.groups()
        expanded = " & ".join(short.get(one, one) for one in edits.split(" & "))
        cases.append(Case(f"{option or ''}{scene}: {edits}", scene, expanded, bool(option), keys))
    return cases


def printed_message(one: dict[str, str]) -> str:
    """Returns the line that is printed of a message in JSON."""
    places = ", ".join(f"{part} '{one[part]}'" for part in ("pair", "body", "tool") if part in one)
    return f"{one['severity']}[{one['key']}]: {one['message']} ({places}). {one['advice']}\n"


def check_at_once(cases: list[Case], runner: Runner) -> dict[Case, tuple[int, str]]:
    """Checks these in one start of the program, and returns the code and the messages of each."""
    files = {}
    for case in cases:
        folder, text = runner.scene(scene_text(case.scene), case.edits)
        write_text(f"{folder}.prm", text)
        files[case] = f"{folder}.prm"
    ended = run(runner.program.path, "--check", "--json", *files.values())
    reports = {report["file"]: report for report in map(json.loads, ended.output.splitlines())}
    found = {}
    for case, file in files.items():
        said = "".join(map(printed_message, reports[file]["diagnostics"]))
        found[case] = (0 if reports[file]["valid"] else 2, said)
    return found


def main() -> int:
    """Returns the exit code."""
    table, billet, *part = sys.argv[1:]
    first, step = map(int, part[0].split("/")) if part else (1, 1)
    enter_folder()
    check, runner = Checks("cases"), Runner(Program([billet]))
    cases = read_cases(table)[first - 1 :: step]
    checked = check_at_once([case for case in cases if not case.goes_alone], runner)
    for case in cases:

        @check(case.name)
        def _() -> None:
            if not case.goes_alone:
                require_keys(case.keys, *checked[case])
                return
            options = ["--check"] if case.is_check else []
            ran = runner.run(scene_text(case.scene), case.edits, options=options)
            require_keys(case.keys, ran.ended.code, ran.said + ran.complained)

    return check.finish()


if __name__ == "__main__":
    sys.exit(main())
