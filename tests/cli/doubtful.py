#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: doubtful.py TABLE BILLET

Runs in an empty current folder.

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

import re
import sys

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
)


def scene_text(name: str) -> str:
    """Returns the text of the scene of this name."""
    for folder in (HERE / "doubtful", HERE, HERE / "files", SHIPPED):
        if (folder / f"{name}.prm").exists():
            return read_scene(folder / f"{name}.prm")
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


def main() -> int:
    """Returns the exit code."""
    table, billet = sys.argv[1:]
    lines = read_text(table).split("\n")
    enter_folder()
    check, runner = Checks("cases"), Runner(Program([billet]))
    short: dict[str, str] = {}
    for line in lines:
        if re.match(r"\s*(#|$)", line):
            continue
        if match := re.match(r"(\w+) := (.*)", line):
            short[match[1]] = match[2]
            continue
        match = re.match(r"(check )?(\w+):\s*(.*?)\s*-> (.*)$", line)
        if match is None:
            sys.exit(f"{table}: no case: {line}")
        option, scene, edits, keys = match.groups()
        text = scene_text(scene)
        expanded = " & ".join(short.get(one, one) for one in edits.split(" & "))
        options = ["--check"] if option else []

        @check(f"{option or ''}{scene}: {edits}")
        def _() -> None:
            ran = runner.run(text, expanded, options=options)
            require_keys(keys, ran.ended.code, ran.said + ran.complained)

    return check.finish()


if __name__ == "__main__":
    sys.exit(main())
