#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: sizes.py CTAGS [ROOT]
       sizes.py CTAGS --self-check

Keeps classes and functions in include/ and source/ small, as Universal Ctags (the program CTAGS) finds them.

A class has at most MAX_MEMBERS data members and MAX_FUNCTIONS member functions of its own, a function at most
MAX_LINES lines. Static constants, constructors, destructors and assignments do not count. Data members count
where one of them is not public: a struct that hides nothing, such as that of a parameter subsection, guards
no invariant, so that its fields may be many.

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

Sizes = dict[str, dict[str, int]]  # by name of a class or function, and by limit

ANONYMOUS = re.compile(r"__anon[0-9a-f]+")
# Classes, data members, functions and their declarations, with lines, scopes, access and signatures.
OPTIONS = (
    "--recurse --languages=C++ --langmap=C++:+.h.cc --kinds-C++=cfmps --fields=+neKsazZS"
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


def sizes_of_classes(tags: list[dict]) -> Sizes:
    """Returns how many members and functions each class has."""
    classes = {(tag["path"], full_name(tag)): tag for tag in tags if tag["kind"] in ("class", "struct")}
    members: dict[str, list[dict]] = defaultdict(list)
    functions: dict[str, int] = defaultdict(int)
    for tag in tags:
        if tag.get("scopeKind") not in ("class", "struct"):
            continue
        owner = full_name({"name": tag["scope"]})
        declaration = classes.get((tag["path"], owner))
        if not declaration or not declaration["line"] <= tag["line"] <= declaration["end"]:
            continue  # the definition of a function whose declaration stands in its class
        if tag["kind"] == "member" and not has_property(tag, "static"):
            members[owner].append(tag)
        elif tag["kind"] in ("function", "prototype") and not is_special(tag):
            functions[owner] += 1
    sizes: Sizes = defaultdict(dict)
    for owner, own in members.items():
        if any(tag.get("access") != "public" for tag in own):
            sizes[owner]["data members"] = len(own)
    for owner, number in functions.items():
        sizes[owner]["functions"] = number
    return sizes


def sizes_of_functions(tags: list[dict]) -> Sizes:
    """Returns the lines of each function; of those with the same name, of the longest."""
    sizes: Sizes = defaultdict(lambda: {"lines": 0})
    for tag in tags:
        if tag["kind"] == "function" and "end" in tag:
            name = full_name(tag)
            sizes[name]["lines"] = max(sizes[name]["lines"], tag["end"] - tag["line"] + 1)
    return sizes


def faults_of(sizes: Sizes) -> list[str]:
    """Returns what is larger than it may be."""
    return [
        f"{name}: {number} {what}, allowed are {LIMITS[what]}"
        for name in sorted(sizes)
        for what, number in sorted(sizes[name].items())
        if number > LIMITS[what]
    ]


def measure(ctags: str, root: Path) -> Sizes:
    """Returns the sizes of all classes and functions below the root."""
    tags = read_tags(ctags, root)
    return {**sizes_of_functions(tags), **sizes_of_classes(tags)}


def write_class(name: str, n_members: int, n_functions: int, access: str = "private") -> str:
    """Returns a class with so many members, declared in all the ways that are usual."""
    members = [f"Held m{i}_{{Kind::a}}, n{i}_{{Kind::b}};" for i in range(n_members // 2)]
    members += ["std::vector<std::pair<int, double>> last_;"] * (n_members % 2)
    functions = [
        f"virtual double f{i}(const std::array<int, 3> &x = {{}}) const = 0;" for i in range(n_functions)
    ]
    return "\n".join(
        [f"class {name} final : public Base<int> {{", "public:", f"explicit {name}(int i);", f"~{name}();"]
        + [f"{name} &operator=(const {name} &) = delete;"]
        + functions
        + ["static constexpr int constant_ = 3;", f"{access}:"]
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
            write_class("Data", MAX_MEMBERS + 5, 0, "public"),
            "namespace {\n",
            write_function("of_full_length", MAX_LINES),
            write_function("too_long", MAX_LINES + 1),
            "}\n",
        ]
    )
    expected = [
        f"billet::ManyFunctions: {MAX_FUNCTIONS + 1} functions, allowed are {MAX_FUNCTIONS}",
        f"billet::ManyMembers: {MAX_MEMBERS + 1} data members, allowed are {MAX_MEMBERS}",
        f"billet::too_long: {MAX_LINES + 1} lines, allowed are {MAX_LINES}",
    ]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "source").mkdir()
        (Path(folder) / "source" / "doctored.h").write_text(code + "}\n", encoding="utf-8")
        found = faults_of(measure(ctags, Path(folder)))
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
    faults = faults_of(sizes)
    print("\n".join(faults + [f"{len(sizes)} classes and functions, {len(faults)} errors"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
