#!/usr/bin/env python3
"""Checks the numbers of the equations in doc/theory.md, and that what refers to them finds them.

Usage: equations.py [--renumber] [ROOT]

Each chapter has at most one letter, no letter serves two, and a chapter's equations count from 1 in the order
of the text. An equation that goes between (T4) and (T5) is written with a number such as (T4a); then
--renumber gives all equations their numbers and rewrites the references in the folders below.
"""
import os
import re
import sys
from pathlib import Path

THEORY = Path("doc/theory.md")
FOLDERS = ("doc", "include", "source", "tests", "tools", "prm", "scripts", "cmake")
KINDS = {".md", ".h", ".cc", ".py", ".prm", ".in", ".txt", ".output", ".cases"}

LABEL = re.compile(r"\(([A-Z])(\d{1,2})([a-z]?)\)")
DEFINITION = re.compile(r" {4,}.*\s" + LABEL.pattern + "$")


def chapters(text: str) -> dict[str, list[tuple[int, str]]]:
    """The equations of each chapter, as pairs of line number and label, in the order of the text."""
    found: dict[str, list[tuple[int, str]]] = {}
    chapter = ""
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("## "):
            chapter = line[3:]
        elif match := DEFINITION.match(line):
            found.setdefault(chapter, []).append((number, "".join(match.groups())))
    return found


def check_numbers(equations: dict[str, list[tuple[int, str]]]) -> list[str]:
    """Errors of the definitions alone."""
    errors: list[str] = []
    owner: dict[str, str] = {}
    for chapter, labels in equations.items():
        letter = labels[0][1][0]
        if owner.setdefault(letter, chapter) != chapter:
            errors.append(f"{THEORY}:{labels[0][0]}: '{owner[letter]}' has the letter {letter}, too")
        for position, (line, label) in enumerate(labels, 1):
            if label != f"{letter}{position}":
                errors.append(
                    f"{THEORY}:{line}: ({label}) stands where ({letter}{position}) should (--renumber)"
                )
    return errors


def files() -> list[Path]:
    """What may refer to equations."""
    found = [
        path
        for folder in FOLDERS
        for path in Path(folder).rglob("*")
        if path.suffix in KINDS and path.is_file()
    ]
    return sorted(found) + [Path("README.md")]


def check_references(defined: set[str]) -> tuple[int, list[str]]:
    """How many references there are, definitions included, and errors of those to no equation."""
    count = 0
    errors: list[str] = []
    for path in files():
        if path == Path("tests/equations.py"):
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
            for match in LABEL.finditer(line):
                count += 1
                if "".join(match.groups()) not in defined:
                    errors.append(f"{path}:{number}: {match[0]} is no equation of {THEORY}")
    return count, errors


def renumber(equations: dict[str, list[tuple[int, str]]]) -> None:
    """Counts each chapter's equations anew and rewrites what refers to them."""
    labels = [label for chapter in equations.values() for _, label in chapter]
    if len(labels) != len(set(labels)):
        sys.exit("equations.py: a number stands twice, so that references to it have two meanings")
    new = {
        label: f"{chapter[0][1][0]}{position}"
        for chapter in equations.values()
        for position, (_, label) in enumerate(chapter, 1)
    }
    for path in files():
        text = path.read_bytes().decode("utf-8", errors="surrogateescape")
        changed = LABEL.sub(lambda match: f"({new.get(match[0][1:-1], match[0][1:-1])})", text)
        if changed != text and path != Path("tests/equations.py"):
            path.write_bytes(changed.encode("utf-8", errors="surrogateescape"))


def main() -> int:
    """Returns the exit code."""
    arguments = sys.argv[1:]
    wants_renumbering = "--renumber" in arguments
    roots = [argument for argument in arguments if argument != "--renumber"]
    if roots:
        os.chdir(roots[0])
    equations = chapters(THEORY.read_text(encoding="utf-8"))
    if wants_renumbering:
        renumber(equations)
        equations = chapters(THEORY.read_text(encoding="utf-8"))
    errors = check_numbers(equations)
    defined = {label for labels in equations.values() for _, label in labels}
    count, unknown = check_references(defined)
    errors += unknown
    print("\n".join(errors + [f"{len(defined)} equations, {count} references, {len(errors)} errors"]))
    return 1 if errors or not defined else 0


if __name__ == "__main__":
    sys.exit(main())
