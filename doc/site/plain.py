# SPDX-License-Identifier: LGPL-2.1-or-later
"""Turns pages of the site into pages that people read as they are: links resolve without Sphinx."""

from __future__ import annotations

import posixpath
import re
import sys
from fnmatch import fnmatch
from pathlib import Path
from typing import Iterator, Mapping

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from billet_tools.text import wrapped  # noqa: E402

LABEL = re.compile(r"^\(([\w-]+)\)=$")
HEADING = re.compile(r"^#+ (.+)$")
LINK = re.compile(r"\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^()\s]+)\)")
FENCE = re.compile(r"^\s*(`{3,}|~{3,})")
BLOCK = re.compile(
    r"^```\{(argparse|bibliography|doxygen\w+|figure|toctree)\} *(.*?)\n(.*?)^```\n", re.MULTILINE | re.DOTALL
)
FRAME = re.compile(r"^:::.*\n", re.MULTILINE)
ROLE = re.compile(r"\{[a-z]+\}`([^`]*)`")
# Folders beside doc/, and their places in an installation, relative to its own pages.
INSTALLED = {
    "prm": "../../billet/prm",
    "materials": "../../billet/materials",
    "examples": "../../billet/examples",
    "LICENSE": "LICENSE",
}


def anchor_of(heading: str) -> str:
    """Returns what links to a heading end with, as forges and MyST have it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("\\", "")
    return re.sub(r"[^\w -]", "", text.lower().strip()).replace(" ", "-")


def anchors_of(text: str) -> list[str]:
    """Returns the anchors of a page's headings, in their order; the second one of a name ends with -1."""
    found: list[str] = []
    counts: dict[str, int] = {}
    fence = ""
    for line in text.splitlines():
        opened = FENCE.match(line)
        if opened and (not fence or opened[1].startswith(fence)):
            fence = "" if fence else opened[1]
        heading = None if fence else HEADING.match(line)
        if heading:
            anchor = anchor_of(heading[1])
            n_before = counts.get(anchor, 0)
            counts[anchor] = n_before + 1
            found.append(f"{anchor}-{n_before}" if n_before else anchor)
    return found


def labels_of(pages: Mapping[str, str]) -> dict[str, str]:
    """Returns where the labels of all pages are: PAGE, or PAGE#ANCHOR where a heading follows."""
    found = {}
    for page, text in pages.items():
        anchors = iter(anchors_of(text))
        waiting: list[str] = []
        for line in text.splitlines():
            label = LABEL.match(line)
            if label:
                waiting.append(label[1])
            elif HEADING.match(line):
                anchor = next(anchors, "")
                found.update({name: f"{page}#{anchor}" if anchor else page for name in waiting})
                waiting = []
            elif line.strip():
                found.update({name: page for name in waiting})
                waiting = []
    return found


class PlainPages:
    """Pages without what Sphinx alone understands, for an installation without the site."""

    def __init__(self, pages: Mapping[str, str], files: set[str]) -> None:
        """Takes pages by path, and the paths of the other files that are installed beside them."""
        self._pages = pages
        self._known = set(pages) | files
        self._labels = labels_of(pages)

    def write(self, page: str) -> str:
        """Returns a page."""
        text = re.sub(r"^---\norphan: true\n---\n", "", self._pages[page])
        text = FRAME.sub("", BLOCK.sub(lambda block: self._without_sphinx(page, *block.groups()), text))
        text = re.sub(r"\n{3,}", "\n\n", "".join(self._parts(page, text)))
        return text if "\\begin{" in text else wrapped(text)  # whose lines are no prose

    def _parts(self, page: str, text: str) -> Iterator[str]:
        """Returns a text in parts: what is code as it is, and the rest with its links."""
        prose: list[str] = []
        fence = ""
        for line in text.splitlines(keepends=True):
            opened = FENCE.match(line)
            if opened and (not fence or opened[1].startswith(fence)):
                fence = "" if fence else opened[1]
            if fence or opened:
                yield self._linked(page, "".join(prose))
                prose = []
                yield line
            elif not LABEL.match(line.rstrip()):
                prose.append(line)
        yield self._linked(page, "".join(prose))

    def _entries(self, page: str, line: str) -> str:
        """Returns a list of links to the pages that a line of a list of contents names."""
        title, _, path = line.strip().rstrip(">").rpartition(" <")
        here = posixpath.dirname(page)
        pattern = posixpath.normpath(posixpath.join(here, path + ".md"))
        found = [
            name
            for name in sorted(self._pages)
            if fnmatch(name, pattern) and name != page and name.count("/") == pattern.count("/")
        ]
        lines = ""
        for name in found:
            heading = re.search(r"^# (.+)$", self._pages[name], re.MULTILINE)
            words = title or (heading[1] if heading else Path(name).stem)
            lines += f"- [{words}]({posixpath.relpath(name, here)})\n"
        return lines

    def _without_sphinx(self, page: str, name: str, argument: str, content: str) -> str:
        """Returns what stands for a block that Sphinx fills."""
        lines = [line for line in content.splitlines() if not re.match(r":\w+:", line)]
        if name == "figure":
            return f"![]({argument})\n" + "\n".join(lines) + "\n"
        if name == "toctree" and ":hidden:" not in content:
            return "".join(self._entries(page, line) for line in lines)
        if name.startswith("doxygen"):
            return f"`{argument}`\n"
        return f"`{Path(page).stem} --help` prints the options.\n" if name == "argparse" else ""

    def _linked(self, page: str, text: str) -> str:
        """Returns a text whose links lead to what is installed; of others only the words remain."""
        text = ROLE.sub(r"[\1]", text)
        text = re.sub(r'<a href="([^"]*)">(.*?)</a>', r"[\2](\1)", text)

        def plain(link: re.Match[str]) -> str:
            words, target = LINK.sub(plain, link[1]), self._target(page, link[2])
            return f"[{words}]({target})" if target else words

        return LINK.sub(plain, text)

    def _target(self, page: str, target: str) -> str:
        """Returns where a link of a page leads in an installation; nothing if there is no such place."""
        if re.match(r"\w+:|#", target):
            return target
        up = "../" * page.count("/")
        if target in self._labels:
            return up + self._labels[target]
        path = posixpath.normpath(posixpath.join(posixpath.dirname(page), target.partition("#")[0]))
        if path in self._known:
            return target
        first, slash, rest = path.removeprefix("../").partition("/")
        return up + INSTALLED[first] + slash + rest if path.startswith("../") and first in INSTALLED else ""
