# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scenes that differ from a base by edits.

An edit is one or more of these, joined by ' & ':

  Section: Key = value    sets the parameter in the subsection of that (last) name; without 'Section:' at the
                          top level. Where the last name is not the only one of its kind: Body / Section
  Section: - Key          takes its line away
  Section: + text         adds lines (newlines or \\n between them) at the subsection's start, at the top
                          level at the file's end
  Section: delete         takes the subsection away
"""

from __future__ import annotations

import re
from typing import NamedTuple


class Edited(NamedTuple):
    """A scene, and of its last edit the line number, the path of the subsection, the key and the value."""

    text: str
    line: int
    path: str
    key: str
    value: str


def lines_of(text: str) -> list[str]:
    """Returns the lines, without empty ones at the end."""
    return text.rstrip("\n").split("\n") if text.rstrip("\n") else []


def paths(lines: list[str]) -> list[str]:
    """Returns for each line the names of the subsections that it stands in; a line that opens one stands in
    it."""
    stack: list[str] = []
    found = []
    for line in lines:
        if match := re.match(r"\s*subsection\s+(.*?)\s*(?:#.*)?$", line):
            stack.append(match[1])
        found.append(" / ".join(stack))
        if stack and re.match(r"\s*end\b", line):
            stack.pop()
    return found


def line_of(text: str, section: str) -> int:
    """Returns the line number (from 1) where the subsection of this name opens."""
    lines = lines_of(text)
    found = [
        number
        for number, (line, path) in enumerate(zip(lines, paths(lines)), 1)
        if re.match(r"\s*subsection\s", line) and ("/ " + path).endswith("/ " + section)
    ]
    if len(found) != 1:
        raise ValueError(f"the scene has not one, but {len(found)} subsections '{section}'")
    return found[0]


def edit(text: str, edits: str) -> Edited:
    """Returns the scene with these edits."""
    edited = Edited(text, 0, "", "", "")
    for one in edits.split(" & "):
        if one:
            edited = edit_once(edited.text, one)
    return edited


def edit_once(text: str, change: str) -> Edited:
    """Returns the scene with one edit."""
    section = ""
    if match := re.fullmatch(r"([\w /]+): (.*)", change, re.DOTALL):
        section, change = match.groups()
    lines = lines_of(text)
    places = paths(lines)
    begin = line_of(text, section) if section else 0  # index of the first line in the section
    path = places[begin - 1] if section else ""
    key = value = ""
    if change == "delete":
        index = begin - 1
        length = sum((place + " / ").startswith(path + " / ") for place in places)
        lines[index : index + length] = []
    elif change.startswith("+ "):
        index = begin if section else len(lines)
        lines[index:index] = re.split(r"\\n|\n", change[2:].rstrip("\n"))
    else:
        deletes = change.startswith("- ")
        key, equals, value = (part.strip() for part in change[2 * deletes :].partition("="))
        if not deletes and not equals:
            raise ValueError(f"'{change}' is no edit")
        sets_key = re.compile(r"\s*set\s+" + re.escape(key) + r"\s*=")
        found = [i for i, line in enumerate(lines) if places[i] == path and sets_key.match(line)]
        if deletes and not found:
            raise ValueError(f"'{change}': there is nothing to take away")
        index = found[0] if found else begin
        lines[index : index + len(found[:1])] = [] if deletes else [f"set {key} = {value}"]
    return Edited("\n".join(lines) + "\n", index + 1, path, key, value)
