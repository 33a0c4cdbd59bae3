#!/usr/bin/env python3
"""Checks the numbers of the equations in doc/theory, and that what refers to them finds them.

Usage: equations.py [--renumber] [ROOT]

Each chapter, a file doc/theory/*.md, has at most one letter, no letter serves two, and a chapter's equations
count from 1 in the order of the text. An equation has its number twice, as the label eq-T4 and as \\tag{T4}.
One that goes between (T4) and (T5) is written with a number such as T4a; then --renumber gives all equations
their numbers and rewrites the references in the folders below.
"""
import os
import re
import sys
from pathlib import Path

THEORY = Path("doc/theory")
CONTENTS = Path("doc/theory.md")
FOLDERS = ("doc", "include", "source", "tests", "benchmarks", "tools", "prm", "scripts", "cmake")
KINDS = {".md", ".h", ".cc", ".py", ".prm", ".in", ".txt", ".output", ".cases"}

NUMBER = r"([A-Z])(\d{1,2})([a-z]?)"
REFERENCE = re.compile(r"\(" + NUMBER + r"\)|\beq-" + NUMBER + r"\b|\\tag\{" + NUMBER + r"\}")
BLOCK = re.compile(r"^ *```\{math\}\n(.*?)^ *```", re.MULTILINE | re.DOTALL)
LABEL = re.compile(r"^ *:label: eq-" + NUMBER + "$", re.MULTILINE)
TAG = re.compile(r"\\tag\{" + NUMBER + r"\}")
RANGE = re.compile(r"^Equations? \(" + NUMBER + r"\)(?: (?:to|and) \(" + NUMBER + r"\))?\.", re.MULTILINE)

Equations = dict[Path, list[tuple[int, str]]]


def number_of(match: re.Match[str]) -> str:
    """Returns the number of the equation in a match of one of the patterns above."""
    return "".join(group for group in match.groups() if group)


def line_of(text: str, position: int) -> int:
    """Returns the number of the line at a position of a text."""
    return text.count("\n", 0, position) + 1


def read_chapters() -> tuple[Equations, list[str]]:
    """Returns the equations of each chapter, as pairs of line and number, and errors of single equations."""
    found: Equations = {}
    errors: list[str] = []
    for path in sorted(THEORY.glob("*.md")):
        text = path.read_text(encoding="utf-8")
        for block in BLOCK.finditer(text):
            labels = [number_of(match) for match in LABEL.finditer(block[1])]
            tags = [number_of(match) for match in TAG.finditer(block[1])]
            line = line_of(text, block.start())
            if labels != tags or len(labels) > 1:
                errors.append(f"{path}:{line}: the label {labels} and the tag {tags} differ")
            if labels:
                found.setdefault(path, []).append((line, labels[0]))
    return found, errors


def check_numbers(equations: Equations) -> list[str]:
    """Returns errors of the order of the equations."""
    errors: list[str] = []
    owner: dict[str, Path] = {}
    for path, labels in equations.items():
        letter = labels[0][1][0]
        if owner.setdefault(letter, path) != path:
            errors.append(f"{path}:{labels[0][0]}: {owner[letter]} has the letter {letter}, too")
        for position, (line, label) in enumerate(labels, 1):
            if label != f"{letter}{position}":
                wanted = f"({letter}{position})"
                errors.append(f"{path}:{line}: ({label}) stands where {wanted} should (--renumber)")
    return errors


def check_contents(equations: Equations) -> list[str]:
    """Returns errors of what chapters say about their equations, and chapters that the contents lack."""
    errors: list[str] = []
    contents = CONTENTS.read_text(encoding="utf-8")
    for path, labels in equations.items():
        stated = RANGE.search(path.read_text(encoding="utf-8"))
        if not stated or not number_of(stated) in (labels[0][1] + labels[-1][1], labels[0][1]):
            errors.append(f"{path}: lacks a line 'Equations ({labels[0][1]}) to ({labels[-1][1]}).'")
        row = f"({THEORY.name}/{path.name}) | ({labels[0][1]}) to ({labels[-1][1]}) |"
        if row not in contents:
            errors.append(f"{CONTENTS}: the table of chapters lacks '{row}'")
    return errors


def files() -> list[Path]:
    """Returns the files that may refer to equations."""
    found = [
        path
        for folder in FOLDERS
        for path in Path(folder).rglob("*")
        if path.suffix in KINDS and path.is_file() and path != Path("scripts/checks/equations.py")
    ]
    return sorted(found) + [Path("README.md")]


def check_references(defined: set[str]) -> tuple[int, list[str]]:
    """Returns how many references there are, definitions included, and errors of those to no equation."""
    count = 0
    errors: list[str] = []
    for path in files():
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
            for match in REFERENCE.finditer(line):
                count += 1
                if number_of(match) not in defined:
                    errors.append(f"{path}:{number}: {match[0]} is no equation of {THEORY}")
    return count, errors


def renumber(equations: Equations) -> None:
    """Counts each chapter's equations anew and rewrites what refers to them."""
    labels = [label for chapter in equations.values() for _, label in chapter]
    if len(labels) != len(set(labels)):
        sys.exit("equations.py: a number stands twice, so that references to it have two meanings")
    new = {
        label: f"{chapter[0][1][0]}{position}"
        for chapter in equations.values()
        for position, (_, label) in enumerate(chapter, 1)
    }

    def rewritten(match: re.Match[str]) -> str:
        number = number_of(match)
        return match[0].replace(number, new.get(number, number))

    for path in files():
        text = path.read_bytes().decode("utf-8", errors="surrogateescape")
        changed = REFERENCE.sub(rewritten, text)
        if changed != text:
            path.write_bytes(changed.encode("utf-8", errors="surrogateescape"))


def main() -> int:
    """Returns the exit code."""
    arguments = sys.argv[1:]
    roots = [argument for argument in arguments if argument != "--renumber"]
    if roots:
        os.chdir(roots[0])
    equations, errors = read_chapters()
    if "--renumber" in arguments and not errors:
        renumber(equations)
        equations, errors = read_chapters()
    errors += check_numbers(equations) + check_contents(equations)
    defined = {label for labels in equations.values() for _, label in labels}
    count, unknown = check_references(defined)
    errors += unknown
    print("\n".join(errors + [f"{len(defined)} equations, {count} references, {len(errors)} errors"]))
    return 1 if errors or not defined else 0


if __name__ == "__main__":
    sys.exit(main())
