#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: installed_pages.py BILLET BUILD CMAKE
       installed_pages.py FOLDER

Installs the build tree BUILD into an empty current folder. Each link of its pages must lead to a file and to
a heading that are installed: of the site if it was built, and of its pages in Markdown, which an installation
has without the site. With FOLDER alone it looks for dead links in what is installed there.
"""

from __future__ import annotations

import html
import re
import shutil
import subprocess
import sys
from functools import lru_cache
from pathlib import Path
from urllib.parse import unquote

from checks import HERE, Checks, require

sys.path.insert(0, str(HERE.parents[1] / "doc/site"))
from plain import anchors_of  # type: ignore[import]  # noqa: E402

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


def require_links(folder: Path) -> None:
    """Fails with the first dead links of a folder."""
    dead = dead_links(folder)
    n_pages = sum(path.suffix in (".html", ".md") for path in folder.rglob("*"))
    require(n_pages > 50, f"{n_pages} pages")
    require(not dead, f"{len(dead)} dead links:\n" + "\n".join(dead[:20]))


def call(*command: str) -> None:
    """Runs a command, which must succeed."""
    ended = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8")
    require(ended.returncode == 0, f"{' '.join(command)}:\n{ended.stdout[-3000:]}")


if len(sys.argv) == 2:
    found = dead_links(Path(sys.argv[1]))
    print("\n".join([*found, f"{len(found)} dead links"]))
    sys.exit(1 if found else 0)

program, build, cmake = sys.argv[1:]
check = Checks()
here = Path.cwd()
documents = here / "installed/share/doc/billet"
call(cmake, "--install", build, "--prefix", str(here / "installed"))


@check("links of what is installed resolve")
def _() -> None:
    require_links(documents)


@check("the site is installed alone, or else Markdown")
def _() -> None:
    has_site = (documents / "html/index.html").exists()
    require(has_site != (documents / "index.md").exists(), "both or none")


@check("links of the pages in Markdown resolve")
def _() -> None:
    assemble = str(HERE.parents[1] / "doc/site/assemble.py")
    call(sys.executable, "-B", assemble, str(here / "pages"), "--program", program, "--plain")
    shutil.rmtree(documents / "html", ignore_errors=True)
    shutil.copytree(here / "pages/doc", documents, dirs_exist_ok=True)
    require_links(documents)


@check("a dead link is found")
def _() -> None:
    page = documents / "index.md"
    text = page.read_text(encoding="utf-8")
    page.write_text(
        text + "\n[One](nowhere.md), [two](start.md#nowhere), [three](start.md).\n", encoding="utf-8"
    )
    require(len(dead_links(documents)) == 2, str(dead_links(documents)))
    page.write_text(text, encoding="utf-8")


sys.exit(check.finish())
