# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of a scene. A parameter is known by its path, such as 'Bodies/billet/Mesh/Layers'."""

import re
from pathlib import Path


def read_scene(path):
    """The text of a scene file, with what it includes in place."""
    path = Path(path)
    lines = []
    for line in path.read_text().splitlines():
        included = re.match(r"\s*include\s+(\S+)", line)
        lines.append(read_scene(path.parent / included.group(1)) if included else line)
    return "\n".join(lines)


def _words(name):
    return " ".join(name.split())


def statements(text):
    """(first line, line after the last, path of the subsections, kind, rest) of each statement; kind is
    'subsection', 'end', 'set' or ''. Lines that end in a backslash go on in the next one."""
    lines, stack, number = text.splitlines(), [], 0
    while number < len(lines):
        first, statement = number, lines[number].split("#")[0].strip()
        while statement.endswith("\\") and number + 1 < len(lines):
            number += 1
            following = lines[number].split("#")[0].strip()
            statement = statement[:-1].rstrip() + (" " + following if following else " \\")
        number += 1
        if statement.startswith("subsection "):
            stack.append(_words(statement.split(None, 1)[1]))
            yield first, number, list(stack), "subsection", stack[-1]
        elif statement == "end":
            yield first, number, list(stack), "end", ""
            if stack:
                stack.pop()
        elif statement.startswith("set "):
            yield first, number, list(stack), "set", statement[4:]
        else:
            yield first, number, list(stack), "", ""


def entries(text):
    """{path: value} of what a scene sets; the last one holds."""
    found = {}
    for _, _, path, kind, rest in statements(text):
        if kind == "set":
            key, _, value = rest.partition("=")
            found["/".join(path + [_words(key)])] = value.strip()
    return found


def variant(text, changes):
    """The scene `text` with the entries {path: value} set anew wherever they stand, or added at the end; None
    takes an entry away."""
    changes = {path: None if value is None else str(value) for path, value in changes.items()}
    old, lines, left = text.splitlines(), [], dict(changes)
    for first, after, path, kind, rest in statements(text):
        key = "/".join(path + [_words(rest.partition("=")[0])]) if kind == "set" else None
        if key not in changes:
            lines += old[first:after]
        else:
            left.pop(key, None)
            if changes[key] is not None:
                lines.append(old[first].split("set ")[0] + f"set {key.split('/')[-1]} = {changes[key]}")
    for key, value in left.items():
        if value is not None:
            *path, name = key.split("/")
            lines += ["subsection " + part for part in path] + [f"set {name} = {value}"] + ["end"] * len(path)
    return "\n".join(lines) + "\n"


class Scene:
    """A scene's `text` and `entries`; `defaults` is the text that `billet --print-parameters` prints,
    `presets` are what its profile or target error makes of entries that it does not set, {path: value}."""

    def __init__(self, text, defaults="", presets=None):
        self.presets = presets or {}
        self.text, self.entries = text, entries(text)
        self.sections = []
        for _, _, path, kind, _ in statements(text):
            if kind == "subsection" and path not in self.sections:
                self.sections.append(path)
        self._default_text, self._defaults = defaults, entries(defaults)

    def changed(self, changes):
        chooses_others = any(path in ("Profile", "Target error") for path in changes)
        return Scene(variant(self.text, changes), self._default_text, {} if chooses_others else self.presets)

    def names(self, *path):
        """Of the subsections in this one."""
        return [section[-1] for section in self.sections if section[:-1] == list(path)]

    def knows(self, path):
        """Whether the program has such a parameter."""
        return self._printed(path) is not None

    def default(self, path):
        """As printed by the program; '' if it has no such parameter."""
        return self._printed(path) or ""

    def _printed(self, path):
        """A user's name stands there as '(name of ...)'."""
        wanted = path.split("/")
        for key, value in self._defaults.items():
            parts = key.split("/")
            if len(parts) == len(wanted) and all(
                a == b or a.startswith("(name of") for a, b in zip(parts, wanted)
            ):
                return value
        return None

    def get(self, path):
        return self.entries.get(path, self.presets.get(path, self.default(path)))

    def number(self, path):
        return float(self.get(path) or 0)

    @property
    def scheme(self):
        return self.get("Time stepping/Scheme") or "quasi-static"

    @property
    def is_explicit(self):
        return self.scheme == "explicit"

    @property
    def is_dynamic(self):
        return self.scheme != "quasi-static"

    @property
    def end_time(self):
        return float(self.get("Time stepping/End time") or 1)

    def step(self, name):
        """'Initial step' or 'Largest step' of an implicit scene, with what `automatic` makes of it."""

        def given(key, otherwise):
            value = self.get("Time stepping/" + key)
            return otherwise if value in ("automatic", "") else float(value)

        largest = given("Largest step", 0.1 * self.end_time)
        initial = given("Initial step", min(0.01 * self.end_time, largest))
        return initial if name == "Initial step" else max(largest, initial)

    def files(self, folder):
        """{path: absolute file} of the files that the scene names, seen from the folder of its file."""
        named = {
            path: (Path(folder) / value).resolve()
            for path, value in self.entries.items()
            if path.split("/")[-1] == "File" and value
        }
        return {path: file for path, file in named.items() if file.is_file()}
