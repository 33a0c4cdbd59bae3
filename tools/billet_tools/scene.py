# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of a scene. A parameter is known by its path, such as 'Bodies/billet/Mesh/Layers'."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any, Iterator, Mapping, NamedTuple

Changes = Mapping[str, object]  # {path: value}; None takes an entry away


def read_scene(path: Path) -> str:
    """Returns the text of a scene file, with what it includes in place. Lines that include materials of the
    program stay: any billet finds them."""
    lines = []
    for line in path.read_text().splitlines():
        included = re.match(r"\s*include\s+(\S+)", line)
        file = path.parent / included[1] if included else None
        if file and included and included[1].startswith("materials/") and not file.exists():
            file = None
        lines.append(read_scene(file) if file else line)
    return "\n".join(lines)


def scene_text(sections: Mapping[str, Any], depth: int = 0) -> str:
    """Returns a scene given as nested dictionaries: these are subsections; what is None is left out."""
    lines, margin = [], "  " * depth
    for name, value in sections.items():
        if isinstance(value, dict):
            inside = scene_text(value, depth + 1).rstrip("\n")
            lines += [f"{margin}subsection {name}", inside, f"{margin}end"]
        elif value is not None:
            lines.append(f"{margin}set {name} = {value}")
    return "\n".join(line for line in lines if line) + "\n"


def _words(name: str) -> str:
    return " ".join(name.split())


class Statement(NamedTuple):
    """A statement of a scene: its first line and that after its last, the path of the subsections, its kind
    ('subsection', 'end', 'set' or '') and the rest."""

    first: int
    after: int
    path: list[str]
    kind: str
    rest: str


def statements(text: str) -> Iterator[Statement]:
    """Yields each statement. Lines that end in a backslash go on in the next one."""
    lines = text.splitlines()
    stack: list[str] = []
    number = 0
    while number < len(lines):
        first, statement = number, lines[number].split("#")[0].strip()
        while statement.endswith("\\") and number + 1 < len(lines):
            number += 1
            following = lines[number].split("#")[0].strip()
            statement = statement[:-1].rstrip() + (" " + following if following else " \\")
        number += 1
        if statement.startswith("subsection "):
            stack.append(_words(statement.split(None, 1)[1]))
            yield Statement(first, number, list(stack), "subsection", stack[-1])
        elif statement == "end":
            yield Statement(first, number, list(stack), "end", "")
            if stack:
                stack.pop()
        elif statement.startswith("set "):
            yield Statement(first, number, list(stack), "set", statement[4:])
        else:
            yield Statement(first, number, list(stack), "", "")


def entries(text: str) -> dict[str, str]:
    """Returns {path: value} of what a scene sets; the last one holds."""
    found = {}
    for statement in statements(text):
        if statement.kind == "set":
            key, _, value = statement.rest.partition("=")
            found["/".join(statement.path + [_words(key)])] = value.strip()
    return found


def read_entries(path: Path) -> dict[str, str]:
    """Returns {path: value} of what a scene file sets, with what it includes."""
    return entries(read_scene(path))


def variant(text: str, changes: Changes) -> str:
    """Returns the scene with these entries set anew wherever they stand, or added at the end."""
    wanted = {path: None if value is None else str(value) for path, value in changes.items()}
    old, lines, left = text.splitlines(), [], dict(wanted)
    for first, after, path, kind, rest in statements(text):
        key = "/".join(path + [_words(rest.partition("=")[0])]) if kind == "set" else ""
        if key not in wanted:
            lines += old[first:after]
        else:
            left.pop(key, None)
            if wanted[key] is not None:
                name = _words(rest.partition("=")[0])  # may be a path itself
                lines.append(old[first].split("set ")[0] + f"set {name} = {wanted[key]}")
    for key, value in left.items():
        if value is not None:
            *sections, name = key.split("/")
            lines += ["subsection " + section for section in sections]
            lines += [f"set {name} = {value}"] + ["end"] * len(sections)
    return "\n".join(lines) + "\n"


def files_of(found: Mapping[str, str], folder: Path) -> dict[str, Path]:
    """Returns {path: absolute file} of the files that entries of a scene name, seen from the folder of its
    file."""
    named = {
        path: (folder / value).resolve()
        for path, value in found.items()
        if path.split("/")[-1] == "File" and value
    }
    return {path: file for path, file in named.items() if file.is_file()}


def with_absolute_files(text: str, folder: Path) -> str:
    """Returns the scene with the files that it names found from anywhere."""
    return variant(text, files_of(entries(text), folder))


class Scene:
    """A scene's `text` and `entries`; `defaults` is the text that `billet --print-parameters` prints,
    `presets` are what its profile or target error makes of entries that it does not set, {path: value}."""

    def __init__(self, text: str, defaults: str = "", presets: Mapping[str, str] | None = None) -> None:
        self.presets: Mapping[str, str] = presets or {}
        self.text, self.entries = text, entries(text)
        self.sections: list[list[str]] = []
        for statement in statements(text):
            if statement.kind == "subsection" and statement.path not in self.sections:
                self.sections.append(statement.path)
        self._default_text, self._defaults = defaults, entries(defaults)
        self.first_step: float | None = None  # of an explicit scene that has run

    def changed(self, changes: Changes) -> Scene:
        """Returns the scene with these entries."""
        chooses_others = any(path in ("Profile", "Target error", "Target error of") for path in changes)
        presets = {} if chooses_others else self.presets
        return Scene(variant(self.text, changes), self._default_text, presets)

    def names(self, *path: str) -> list[str]:
        """Returns the names of the subsections in this one."""
        return [section[-1] for section in self.sections if section[:-1] == list(path)]

    def knows(self, path: str) -> bool:
        """Tells whether the program has such a parameter."""
        return self._printed(path) is not None

    def default(self, path: str) -> str:
        """Returns the value that the program prints; '' if it has no such parameter."""
        return self._printed(path) or ""

    def _printed(self, path: str) -> str | None:
        """A user's name stands there as '(name of ...)'."""
        wanted = path.split("/")
        for key, value in self._defaults.items():
            parts = key.split("/")
            if len(parts) == len(wanted) and all(
                a == b or a.startswith("(name of") for a, b in zip(parts, wanted)
            ):
                return value
        return None

    def _inherited(self, path: str) -> str | None:
        """Returns the value that a pair takes from 'General contact'."""
        section, _, key = path.rpartition("/")
        is_of_all = section.startswith("Contact pairs/") and self.has_general_contact
        return self._of_all.get(key) if is_of_all else None

    def get(self, path: str) -> str:
        """Returns the value that holds."""
        inherited = self._inherited(path)
        otherwise = self.presets.get(path, self.default(path)) if inherited is None else inherited
        return self.entries.get(path, otherwise)

    def is_set(self, path: str) -> bool:
        """Tells whether the scene, its profile or its target error sets a value: it is no default."""
        return path in self.entries or path in self.presets or self._inherited(path) is not None

    def penetration_tolerance(self, pair: str) -> float:
        """Returns the tolerance of a pair in facet sizes: 0 for penalties alone, infinite for an automatic
        one, which limits no depth. Without a penalty or a tolerance, statics augments by itself."""
        tolerance = self.get(pair + "Penetration tolerance")
        if tolerance == "":
            return 0.0 if self.is_dynamic or self.is_set(pair + "Normal penalty") else math.inf
        return math.inf if tolerance == "automatic" else float(tolerance)

    @property
    def has_general_contact(self) -> bool:
        """Returns whether general contact is on: all surfaces may touch each other."""
        return self.entries.get("Contact") == "all"

    @property
    def _of_all(self) -> dict[str, str]:
        """Values of 'General contact', which pairs take."""
        parts = {tuple(path.split("/")): value for path, value in self.entries.items()}
        return {path[1]: value for path, value in parts.items() if path[0] == "General contact"}

    @property
    def pairs(self) -> list[str]:
        """Beginnings of the paths of contact pairs; of all that 'Contact = all' makes there is one."""
        named = [f"Contact pairs/{name}/" for name in self.names("Contact pairs")]
        return named + (["General contact/"] if self.has_general_contact else [])

    def number(self, path: str) -> float:
        """Returns the number that holds, 0 without one."""
        return float(self.get(path) or 0)

    @property
    def scheme(self) -> str:
        """The time integration."""
        return self.get("Time stepping/Scheme") or "quasi-static"

    @property
    def is_explicit(self) -> bool:
        """Returns whether steps are explicit."""
        return self.scheme == "explicit"

    @property
    def is_dynamic(self) -> bool:
        """Returns whether bodies have inertia."""
        return self.scheme != "quasi-static"

    @property
    def end_time(self) -> float:
        """The time at which the scene ends."""
        return float(self.get("Time stepping/End time") or 1)

    def step(self, name: str) -> float:
        """Returns 'Initial step' or 'Maximum step' of an implicit scene, with what `automatic` makes of
        it."""

        def given(key: str, otherwise: float) -> float:
            value = self.get("Time stepping/" + key)
            return otherwise if value in ("automatic", "") else float(value)

        largest = given("Maximum step", 0.1 * self.end_time)
        initial = given("Initial step", min(0.01 * self.end_time, largest))
        return initial if name == "Initial step" else max(largest, initial)

    def files(self, folder: Path) -> dict[str, Path]:
        """Returns {path: absolute file} of the files that the scene names."""
        return files_of(self.entries, folder)
