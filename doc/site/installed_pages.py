#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: installed_pages.py BUILD

Installs the build tree BUILD into a folder that is removed again. Each link of its pages must lead to a file
and to a heading that are installed: of the site if it was built, and of its pages in Markdown, which an
installation has without the site. Exit code 1: there are dead links.
"""

from __future__ import annotations

import html
import re
import shutil
import subprocess
import sys
import tempfile
from functools import lru_cache
from pathlib import Path
from urllib.parse import unquote

from plain import anchors_of

ASSEMBLE = Path(__file__).resolve().parent / "assemble.py"

IN_MARKDOWN = re.compile(r"!?\[(?:[^\[\]]|!?\[[^\[\]]*\](?:\([^()]*\))?)*\]\(([^()\s]+)\)")
INNER = re.compile(r"!\[[^\]]*\]\(([^()\s]+)\)")
IN_HTML = re.compile(r"<(?:a|img|link|script)\s[^>]*?(?:href|src)=\"([^\"]+)\"")
NAMED = re.compile(r"\b(?:id|name)=\"([^\"]+)\"")
NOT_OURS = "#nested-classes"  # Doxygen 1.9.4 links to the list of nested classes where all are private
CODE = re.compile(r"^\s*(`{3,}|~{3,}|\$\$).*?^\s*\1\s*$|(`+)[^`].*?\2", re.MULTILINE | re.DOTALL)


@lru_cache(maxsize=None)
def anchors(page: Path) -> frozenset[str]:
    """Returns what links to a page may end with."""
    text = page.read_text(encoding="utf-8")
    if page.suffix == ".md":
        return frozenset(anchors_of(text))
    return frozenset(html.unescape(name) for name in NAMED.findall(text)) | {"top"}


def links_of(page: Path) -> list[str]:
    """Returns the links of a page."""
    text = page.read_text(encoding="utf-8")
    if page.suffix == ".html":
        return [html.unescape(link) for link in IN_HTML.findall(text)]
    text = CODE.sub("", text)
    return IN_MARKDOWN.findall(text) + INNER.findall(text)


def dead_links(folder: Path) -> list[str]:
    """Returns the links of all pages in a folder that lead nowhere, with their pages."""
    dead = []
    for page in sorted(path for path in folder.rglob("*") if path.suffix in (".html", ".md")):
        for link in sorted(set(links_of(page))):
            place, _, anchor = link.partition("#")
            if re.match(r"\w+:|//", link) or link == NOT_OURS:
                continue
            file = page.parent / unquote(place.partition("?")[0]) if place else page
            if not file.exists() or (file.is_dir() and page.suffix == ".html"):
                dead.append(f"{page.relative_to(folder)}: {link}")
            elif anchor and file.suffix in (".html", ".md") and unquote(anchor) not in anchors(file):
                dead.append(f"{page.relative_to(folder)}: {link}, which has no such heading")
    return dead


def report(folder: Path, of: str) -> bool:
    """Prints how many links of a folder are dead, and the first of them. Returns whether none is."""
    dead = dead_links(folder)
    n_pages = sum(path.suffix in (".html", ".md") for path in folder.rglob("*"))
    print("\n".join([f"{len(dead)} dead links in {n_pages} pages {of}", *dead[:20]]))
    return not dead and n_pages > 50


def finds_dead_links(page: Path) -> bool:
    """Returns whether two dead links on a page are found."""
    text = page.read_text(encoding="utf-8")
    links = "[One](nowhere.md), [two](start.md#nowhere), [three](start.md)."
    page.write_text(f"{text}\n{links}\n", encoding="utf-8")
    n_found = len(dead_links(page.parent))
    page.write_text(text, encoding="utf-8")
    return n_found == 2


def main() -> int:
    """Returns the exit code."""
    build = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        place, pages = Path(folder, "installed"), Path(folder, "pages")
        install = ["cmake", "--install", str(build), "--prefix", str(place)]
        subprocess.run(install, check=True, stdout=subprocess.DEVNULL)
        documents = place / "share/doc/billet"
        is_sound = report(documents, "that are installed")
        if (documents / "html/index.html").exists() == (documents / "index.md").exists():
            print("the site and its pages in Markdown are installed, or neither")
            is_sound = False
        assemble = [sys.executable, "-B", str(ASSEMBLE), str(pages), "--program", str(build / "bin/billet")]
        subprocess.run([*assemble, "--plain"], check=True, stdout=subprocess.DEVNULL)
        shutil.rmtree(documents / "html", ignore_errors=True)
        shutil.copytree(pages / "doc", documents, dirs_exist_ok=True)
        is_sound = report(documents, "in Markdown") and is_sound
        if not finds_dead_links(documents / "index.md"):
            print("this script finds no dead links")
            is_sound = False
    return 0 if is_sound else 1


if __name__ == "__main__":
    sys.exit(main())
