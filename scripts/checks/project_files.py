#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: project_files.py
       project_files.py --self-check

Checks the files for those who contribute, cite or build in a container: they exist and can be read, have what
their formats require, and name only files, headings, presets and groups of packages that exist.

--self-check tests the test, by texts that break each rule.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).resolve().parents[2]
CITATION = "CITATION.cff"
WORKFLOW = ".github/workflows/ci.yml"
CONTAINER = "Containerfile"
REQUIRED = (
    "README.md",
    "CONTRIBUTING.md",
    "CODE_OF_CONDUCT.md",
    "CHANGELOG.md",
    "LICENSE",
    CITATION,
    CONTAINER,
    WORKFLOW,
    ".ci/run",
    ".github/pull_request_template.md",
    ".github/ISSUE_TEMPLATE/config.yml",
)
IMAGE = "debian:12"  # the release that is verified

LINK = re.compile(r"\]\(([^):#\s]*)(?:#([\w-]+))?\)")
PLACE = re.compile(
    r"(?<![\w/.-])(?:/usr/src/billet/|\$root/|\./)?"
    r"((?:\.ci|\.github|benchmarks|cmake|doc|examples|include|prm|scripts|source|tests|tools)/[\w./-]*\w)"
)
PRESET = re.compile(r"--preset (\w+)")
GROUPS = re.compile(r"packages\.sh((?: \w+)+)")
FOREIGN = re.compile(r"(?<![\w.~-])/(?:home|root|tmp|work|mnt)\b")  # folders of some machine
MADE_BY_BUILD = ("doc/html",)


def anchors_of(text: str) -> set[str]:
    """Returns the names of a page's headings in links."""
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def faults_of_names(name: str, text: str) -> list[str]:
    """Returns what a text names and nobody finds."""
    faults = []
    here = (ROOT / name).parent
    for path, anchor in LINK.findall(text):
        file = here / path if path else ROOT / name
        if not file.exists():
            faults.append(f"no file {path}")
        elif anchor and anchor not in anchors_of(file.read_text(encoding="utf-8")):
            faults.append(f"no heading {anchor} in {path or name}")
    for path in PLACE.findall(text):
        if not (ROOT / path).exists() and path not in MADE_BY_BUILD:
            faults.append(f"no file {path}")
    presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
    for preset in PRESET.findall(text):
        if preset not in [entry["name"] for entry in presets]:
            faults.append(f"no preset {preset}")
    packages = (ROOT / "scripts/packages.sh").read_text(encoding="utf-8")
    for groups in GROUPS.findall(text):
        for group in groups.split():
            if not re.search(rf"^\s*{group}\)", packages, re.MULTILINE):
                faults.append(f"no group of packages {group}")
    return faults + [f"a folder of some machine: {found[0]}" for found in FOREIGN.finditer(text)]


def lacks_of(entry: dict[str, Any], *keys: str) -> list[str]:
    return [f"no {key}" for key in keys if not entry.get(key)]


def faults_of_authors(authors: list[dict[str, Any]]) -> list[str]:
    """Returns authors that are neither entities nor persons."""
    return [
        f"an author without a name: {author}"
        for author in authors
        if not (author.get("name") or author.get("family-names"))
    ]


def faults_of_citation(text: str) -> list[str]:
    """Returns what the Citation File Format 1.2.0 forbids, and a version other than the program's."""
    data = yaml.safe_load(text)
    faults = lacks_of(data, "authors", "cff-version", "message", "title")
    faults += faults_of_authors(data.get("authors", []))
    if data.get("cff-version") != "1.2.0":
        faults.append(f"cff-version {data.get('cff-version')}")
    if data.get("type") not in (None, "software", "dataset"):
        faults.append(f"type {data['type']}")
    for reference in data.get("references", []):
        faults += [f"reference: {lack}" for lack in lacks_of(reference, "authors", "title", "type")]
        faults += faults_of_authors(reference.get("authors", []))
    version = re.search(
        r"project\(billet VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    )
    if not version or str(data.get("version")) != version[1]:
        faults.append(f"version {data.get('version')}")
    return faults


def faults_of_form(text: str) -> list[str]:
    """Returns what makes an issue form unusable."""
    data = yaml.safe_load(text)
    faults = lacks_of(data, "name", "description", "body")
    keys = [entry.get("id") for entry in data.get("body", [])]
    if len(set(keys)) < len(keys):
        faults.append("two fields with one id")
    for entry in data.get("body", []):
        if entry.get("type") not in ("textarea", "input", "dropdown", "checkboxes", "markdown"):
            faults.append(f"type {entry.get('type')}")
        faults += lacks_of(
            entry.get("attributes", {}), "value" if entry.get("type") == "markdown" else "label"
        )
    return faults


def faults_of_workflow(text: str) -> list[str]:
    """Returns what keeps a workflow from running .ci/run in the verified image."""
    data = yaml.safe_load(text)
    faults = lacks_of(data, "name", "jobs")
    if True not in data:  # 'on' is a truth value in YAML 1.1
        faults.append("no on")
    commands = []
    for job in data.get("jobs", {}).values():
        faults += lacks_of(job, "runs-on", "steps")
        if job.get("container") != IMAGE:
            faults.append(f"container {job.get('container')}")
        for step in job.get("steps", []):
            if len({"run", "uses"} & set(step)) != 1:
                faults.append(f"a step has either run or uses: {step}")
            commands.append(step.get("run"))
    return faults if ".ci/run" in commands else [*faults, "no step runs .ci/run"]


def faults_of_container(text: str) -> list[str]:
    """Returns what keeps a recipe from forging the billet in the verified image."""
    faults = []
    if re.findall(r"^FROM (\S+)", text, re.MULTILINE) != [IMAGE]:
        faults.append(f"not from {IMAGE}")
    if not re.search(r"^RUN .*scripts/quickstart prm/billet_upsetting\.prm$", text, re.MULTILINE):
        faults.append("the billet is not forged")
    return faults


def faults_of(name: str, text: str) -> list[str]:
    """Returns what is wrong with a file."""
    faults = faults_of_names(name, text) if name not in ("LICENSE", "CHANGELOG.md") else []
    if name == CITATION:
        faults += faults_of_citation(text)
    elif name == WORKFLOW:
        faults += faults_of_workflow(text)
    elif name == CONTAINER:
        faults += faults_of_container(text)
    elif name.startswith(".github/ISSUE_TEMPLATE/") and not name.endswith("/config.yml"):
        faults += faults_of_form(text)
    elif name.endswith(".yml"):
        yaml.safe_load(text)
    return faults


def check() -> int:
    """Prints what is wrong; returns the number of errors."""
    n_errors = 0
    names = {file.relative_to(ROOT).as_posix() for file in (ROOT / ".github").rglob("*") if file.is_file()}
    for name in sorted(names | set(REQUIRED)):
        file = ROOT / name
        faults = faults_of(name, file.read_text(encoding="utf-8")) if file.exists() else ["missing"]
        for fault in faults:
            print(f"{name}: {fault}")
        n_errors += len(faults)
    print(f"{len(names | set(REQUIRED))} files, {n_errors} errors")
    return n_errors


BROKEN: tuple[
    tuple[str, str, str, str], ...
] = (  # file, what is replaced by what, the beginning of the fault
    ("CONTRIBUTING.md", "](CODE_OF_CONDUCT.md)", "](CONDUCT.md)", "no file CONDUCT.md"),
    ("CONTRIBUTING.md", "#architecture)", "#house)", "no heading house"),
    ("CONTRIBUTING.md", "scripts/test ", "scripts/tests ", "no file scripts/tests"),
    ("CONTRIBUTING.md", "--preset release", "--preset fast", "no preset fast"),
    ("CONTRIBUTING.md", "scripts/test ", "/home/me/billet ", "a folder of some machine"),
    (CITATION, "message:", "note:", "no message"),
    (CITATION, "cff-version: 1.2.0", "cff-version: 1.0.0", "cff-version 1.0.0"),
    (CITATION, "\nversion: 0", "\nversion: 99", "version 99"),
    (CITATION, "- name: The", "- alias: The", "an author without a name"),
    (CITATION, "type: article", "note: article", "reference: no type"),
    (WORKFLOW, IMAGE, "debian:11", "container debian:11"),
    (WORKFLOW, "run: .ci/run", "run: make", "no step runs .ci/run"),
    (CONTAINER, f"FROM {IMAGE}", "FROM fedora", f"not from {IMAGE}"),
    (CONTAINER, "quickstart prm/billet_upsetting.prm", "quickstart", "the billet is not forged"),
    (CONTAINER, "packages.sh build", "packages.sh nowhere", "no group of packages nowhere"),
    (".github/ISSUE_TEMPLATE/failure.yml", "id: log", "id: scene", "two fields with one id"),
    (".github/ISSUE_TEMPLATE/failure.yml", "label: Log", "title: Log", "no label"),
    (".github/ISSUE_TEMPLATE/failure.yml", "doc/messages.md", "doc/message.md", "no file doc/message.md"),
)


def self_check() -> int:
    """Tests the test; returns the number of errors."""
    n_errors = 0
    for name, old, new, expected in BROKEN:
        text = (ROOT / name).read_text(encoding="utf-8")
        faults = faults_of(name, text.replace(old, new))
        if old not in text or not any(fault.startswith(expected) for fault in faults):
            print(f"{name} with {new!r}: found {faults}, expected {expected!r}")
            n_errors += 1
    print(f"{len(BROKEN)} samples, {n_errors} errors")
    return n_errors


if __name__ == "__main__":
    sys.exit(1 if (self_check() if "--self-check" in sys.argv[1:] else check()) else 0)
