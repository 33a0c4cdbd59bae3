#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: sizes.py CTAGS [ROOT]
       sizes.py CTAGS --self-check

Keeps classes and functions in include/ and source/ small, as Universal Ctags (the program CTAGS) finds them.

A class or struct has at most MAX_MEMBERS data members and MAX_FUNCTIONS member functions, those of its base
classes among them, a function at most MAX_LINES lines. A function that overrides another counts once. Static
constants, constructors, destructors and assignments do not count. EXCEPTIONS lists what may be larger, by its
number and a reason; where it has become smaller, the test asks for the new number.

--self-check tests the test, by code that is too large.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

MAX_MEMBERS, MAX_FUNCTIONS, MAX_LINES = 20, 40, 90
LIMITS = {"data members": MAX_MEMBERS, "functions": MAX_FUNCTIONS, "lines": MAX_LINES}

# Larger ones: name, limit, number, reason.
EXCEPTIONS: list[tuple[str, str, int, str]] = []

Sizes = dict[str, dict[str, int]]  # by name of a class or function, and by limit

ANONYMOUS = re.compile(r"__anon[0-9a-f]+")
# Classes, data members, functions and their declarations, with lines, scopes, access, signatures and bases.
OPTIONS = (
    "--recurse --languages=C++ --langmap=C++:+.h.cc --kinds-C++=cfmps --fields=+neKsazZSi"
    " --fields-C++=+{properties} --output-format=json -f -"
).split()


def read_tags(ctags: str, root: Path) -> list[dict]:
    """Returns the tags of all code below the root."""
    folders = [folder for folder in ("include", "source") if (root / folder).is_dir()]
    if not folders:
        sys.exit(f"sizes.py: neither include nor source in {root}")
    run = subprocess.run(
        [ctags, *OPTIONS, *folders], cwd=root, stdout=subprocess.PIPE, check=True, encoding="utf-8"
    )
    return [json.loads(line) for line in run.stdout.splitlines()]


def full_name(tag: dict) -> str:
    """Returns a name that holds no number of ctags' own: unnamed namespaces are left out."""
    parts = (tag.get("scope", "") + "::" + tag["name"]).split("::")
    return "::".join(part for part in parts if part and not ANONYMOUS.fullmatch(part))


def has_property(tag: dict, name: str) -> bool:
    """Returns whether a declaration has this property, such as static."""
    return name in tag.get("properties", "").split(",")


def is_special(tag: dict) -> bool:
    """Returns whether a function makes, ends or assigns objects."""
    owner = tag["scope"].split("::")[-1]
    return tag["name"] in (owner, "~" + owner, "operator =")


Key = tuple[str, str]  # file and full name of a class


class Classes:
    """Classes and structs with their own members and functions, and their bases."""

    def __init__(self, tags: list[dict]) -> None:
        self.declarations = {
            (tag["path"], full_name(tag)): tag for tag in tags if tag["kind"] in ("class", "struct")
        }
        self.members: dict[Key, list[str]] = defaultdict(list)
        self.functions: dict[Key, set[str]] = defaultdict(set)
        self.by_name: dict[str, list[Key]] = defaultdict(list)
        for key in self.declarations:
            self.by_name[key[1]].append(key)
        for tag in tags:
            if tag.get("scopeKind") in ("class", "struct"):
                self._add(tag)

    def _add(self, tag: dict) -> None:
        """Adds a member or a function to its class."""
        owner = (tag["path"], full_name({"name": tag["scope"]}))
        declaration = self.declarations.get(owner)
        if not declaration or not declaration["line"] <= tag["line"] <= declaration["end"]:
            return  # the definition of a function whose declaration stands in its class
        if tag["kind"] == "member" and not has_property(tag, "static"):
            self.members[owner].append(tag["name"])
        elif tag["kind"] in ("function", "prototype") and not is_special(tag):
            self.functions[owner].add(tag["name"] + tag.get("signature", ""))

    def with_bases(self, key: Key) -> list[Key]:
        """Returns a class and all of its bases in the repository."""
        found = [key]
        for name in without_arguments(self.declarations[key].get("inherits", "")).split(","):
            scope = key[1].split("::")[:-1]
            while name and "::".join([*scope, name]) not in self.by_name and scope:
                scope.pop()
            candidates = self.by_name.get("::".join([*scope, name]), [])
            own_file = [base for base in candidates if base[0] == key[0]]
            for base in own_file or candidates[:1]:
                found += [other for other in self.with_bases(base) if other not in found]
        return found


def without_arguments(text: str) -> str:
    """Returns names of types without template arguments."""
    while (shorter := re.sub(r"<[^<>]*>", "", text)) != text:
        text = shorter
    return text.replace(" ", "")


def sizes_of_classes(tags: list[dict]) -> Sizes:
    """Returns how many members and functions each class has, with those of its bases."""
    classes = Classes(tags)
    sizes: Sizes = defaultdict(lambda: {"data members": 0, "functions": 0})
    for key in classes.declarations:
        family = classes.with_bases(key)
        functions = set().union(*(classes.functions[one] for one in family))
        of_class = sizes[key[1]]  # of those with the same name, of the largest
        n_members = sum(len(classes.members[one]) for one in family)
        of_class["data members"] = max(of_class["data members"], n_members)
        of_class["functions"] = max(of_class["functions"], len(functions))
    return sizes


def sizes_of_functions(tags: list[dict]) -> Sizes:
    """Returns the lines of each function; of those with the same name, of the longest."""
    sizes: Sizes = defaultdict(lambda: {"lines": 0})
    for tag in tags:
        if tag["kind"] == "function" and "end" in tag:
            name = full_name(tag)
            sizes[name]["lines"] = max(sizes[name]["lines"], tag["end"] - tag["line"] + 1)
    return sizes


def faults_of(sizes: Sizes, exceptions: list[tuple[str, str, int, str]]) -> list[str]:
    """Returns what is larger than it may be, and exceptions that allow too much."""
    allowed = {(name, what): number for name, what, number, _reason in exceptions}
    faults = [
        f"{name}: {number} {what}, allowed are {allowed.get((name, what), LIMITS[what])}"
        for name in sorted(sizes)
        for what, number in sorted(sizes[name].items())
        if number > allowed.get((name, what), LIMITS[what])
    ]
    return faults + [
        f"{name}: {sizes.get(name, {}).get(what, 0)} {what}, but the list of exceptions says {number}"
        for (name, what), number in allowed.items()
        if sizes.get(name, {}).get(what, 0) < number
    ]


def measure(ctags: str, root: Path) -> Sizes:
    """Returns the sizes of all classes and functions below the root."""
    tags = read_tags(ctags, root)
    return {**sizes_of_functions(tags), **sizes_of_classes(tags)}


def write_class(name: str, n_members: int, n_functions: int, base: str = "public Unknown<int>") -> str:
    """Returns a class with so many members, declared in all the ways that are usual."""
    members = [f"Held m{i}_{{Kind::a}}, n{i}_{{Kind::b}};" for i in range(n_members // 2)]
    members += ["std::vector<std::pair<int, double>> last_;"] * (n_members % 2)
    functions = [
        f"virtual double f{i}(const std::array<int, 3> &x = {{}}) const = 0;" for i in range(n_functions)
    ]
    return "\n".join(
        [f"class {name} final : {base} {{", "public:", f"explicit {name}(int i);", f"~{name}();"]
        + [f"{name} &operator=(const {name} &) = delete;"]
        + functions
        + ["static constexpr int constant_ = 3;", "private:"]
        + members
        + ["};\n"]
    )


def write_function(name: str, n_lines: int) -> str:
    """Returns a function of so many lines."""
    return "\n".join([f"double {name}(const int i) {{"] + ["  work([&] { ++i; });"] * (n_lines - 2) + ["}\n"])


def self_check(ctags: str) -> list[str]:
    """Returns what the test does not notice, or notices where nothing is wrong."""
    code = "namespace billet {\n" + "".join(
        [
            write_class("Full", MAX_MEMBERS, MAX_FUNCTIONS),
            write_class("ManyMembers", MAX_MEMBERS + 1, 1),
            write_class("ManyFunctions", 1, MAX_FUNCTIONS + 1),
            "struct Data {\n" + "int i;\n" * (MAX_MEMBERS + 5) + "};\n",
            "struct Listed {\n" + "int i;\n" * (MAX_MEMBERS + 2) + "};\n",
            "struct Shrunk {\n" + "int i;\n" * MAX_MEMBERS + "};\n",
            "template <class T> " + write_class("Half", MAX_MEMBERS - 5, 1),
            write_class("Inherits", 6, 1, "private Other, public Half<std::vector<int>>"),
            write_class("Overrides", 5, MAX_FUNCTIONS, "public Half<int>"),
            "namespace {\n",
            write_function("of_full_length", MAX_LINES),
            write_function("too_long", MAX_LINES + 1),
            "}\n",
        ]
    )
    exceptions = [
        ("billet::Listed", "data members", MAX_MEMBERS + 2, ""),
        ("billet::Shrunk", "data members", MAX_MEMBERS + 2, ""),
    ]
    expected = [
        f"billet::Data: {MAX_MEMBERS + 5} data members, allowed are {MAX_MEMBERS}",
        f"billet::Inherits: {MAX_MEMBERS + 1} data members, allowed are {MAX_MEMBERS}",
        f"billet::ManyFunctions: {MAX_FUNCTIONS + 1} functions, allowed are {MAX_FUNCTIONS}",
        f"billet::ManyMembers: {MAX_MEMBERS + 1} data members, allowed are {MAX_MEMBERS}",
        f"billet::Shrunk: {MAX_MEMBERS} data members, but the list of exceptions says {MAX_MEMBERS + 2}",
        f"billet::too_long: {MAX_LINES + 1} lines, allowed are {MAX_LINES}",
    ]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "source").mkdir()
        (Path(folder) / "source" / "doctored.h").write_text(code + "}\n", encoding="utf-8")
        found = faults_of(measure(ctags, Path(folder)), exceptions)
    return [f"not found: {fault}" for fault in expected if fault not in found] + [
        f"found in error: {fault}" for fault in found if fault not in expected
    ]


def main() -> int:
    """Returns the exit code."""
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    ctags, arguments = sys.argv[1], sys.argv[2:]
    if arguments == ["--self-check"]:
        faults = self_check(ctags)
        print("\n".join(faults + [f"self-check: {len(faults)} errors"]))
        return 1 if faults else 0
    sizes = measure(ctags, Path(arguments[0] if arguments else "."))
    faults = faults_of(sizes, EXCEPTIONS)
    print("\n".join(faults + [f"{len(sizes)} classes and functions, {len(faults)} errors"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
