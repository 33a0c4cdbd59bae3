#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: old_names.py

Only the table of renamed parameters and its tests may use an old name of a parameter. News keep the names of
their time.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TABLE = "source/parameters/renames.cc"
FOLDERS = ("benchmarks", "doc", "include", "prm", "scripts", "source", "tests", "tools")
SUFFIXES = (".cases", ".cc", ".csv", ".h", ".md", ".output", ".prm", ".py", ".txt")
ALLOWED = (
    TABLE,
    "CHANGELOG.md",
    "doc/news/",
    "tests/cli/old/",
    "tests/cli/update.py",
    "tests/cli/input_syntax.cases",
)
BETWEEN_WORDS = r'(?:\s|"\s*")+'  # also where a line or a string ends
CAPABILITIES = ("Edges",)  # names of something else, too, which stand in double quotes


def pattern_of(name: str) -> str:
    """Returns what finds a name; of one word, which may be any word, only where it is a parameter."""
    if " " in name:
        return r"\b" + BETWEEN_WORDS.join(name.split()) + r"\b"
    quotes = "'`/" if name in CAPABILITIES else "'\"`/"
    return rf"[{quotes}]{name}(?=['\"`])|(?:['\"`/]|\bset |\\nset |[:&] ){name}\s*="


def main() -> int:
    """Returns the exit code."""
    table = (ROOT / TABLE).read_text(encoding="utf-8")
    names = set(re.findall(r'\{\{"[^{}]*"\},\s*"([^"]*)",\s*"', table))
    pattern = re.compile("|".join(pattern_of(name) for name in sorted(names)))
    n_faults = 0
    files = [ROOT / "README.md", *(file for folder in FOLDERS for file in sorted((ROOT / folder).rglob("*")))]
    for file in files:
        name = file.relative_to(ROOT).as_posix()
        if file.suffix not in SUFFIXES or name.startswith(ALLOWED):
            continue
        text = file.read_text(encoding="utf-8")
        for match in pattern.finditer(text):
            number = text.count("\n", 0, match.start()) + 1
            print(f"{name}:{number}: old name of a parameter: {match[0]}")
            n_faults += 1
    print(f"{len(names)} old names, {n_faults} errors")
    return 0 if names and not n_faults else 1


if __name__ == "__main__":
    sys.exit(main())
