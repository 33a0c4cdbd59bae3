#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: assemble.py TARGET [--program BILLET] [--katex FOLDER | --plain]

Writes the sources of the site to TARGET/doc: the pages of doc/, those that the program makes, and insertions.
doc/site/insertions.py replaces lines '<!-- insert: NAME ARGUMENT... -->' of pages. Without a program
the pages of parameters and types are those of doc/, which say how to print them. With --plain the pages are
for people that read them as they are, in an installation without the site.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

from insertions import Insertions
from plain import PlainPages
from reference import Reference
from results import tables_of

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from billet_tools.scene import read_scene  # noqa: E402
from billet_tools.text import wrapped  # noqa: E402

IN_NO_MENU = ("manual.md", "theory.md")  # lists of chapters, which old links lead to
LEFT_OUT = {"site", "news"}  # folders of doc/ that are no pages
BESIDE = (
    "cmake",
    "examples",
    "include",
    "scripts",
    "source",
    "tests",
    "tools",
    "CMakeLists.txt",
    "LICENSE",
    "README.md",
)


def write(path: Path, text: str) -> None:
    """Writes a file unless it is there already, so that Sphinx reads again what changed only."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def copy_files(site: Path, kept: set[Path]) -> dict[str, str]:
    """Copies what is no page; returns the pages by path."""
    pages = {}
    for file in sorted((ROOT / "doc").rglob("*")):
        name = file.relative_to(ROOT / "doc")
        if file.is_dir() or name.parts[0] in LEFT_OUT or "__pycache__" in name.parts:
            continue
        if file.suffix == ".md":
            pages[name.as_posix()] = file.read_text(encoding="utf-8")
            continue
        copy = site / name
        kept.add(copy)
        copy.parent.mkdir(parents=True, exist_ok=True)
        if not copy.exists() or copy.stat().st_mtime != file.stat().st_mtime:
            shutil.copy2(file, copy)
    return pages


def copy_scenes(folder: Path) -> None:
    """Writes the shipped scenes with what they include in place, since a reader loads a single file."""
    if folder.is_symlink():
        folder.unlink()
    for file in sorted((ROOT / "prm").iterdir()):
        if file.suffix == ".prm":
            write(folder / file.name, read_scene(file))
        elif not (folder / file.name).exists():
            (folder / file.name).symlink_to(file)


def copy_katex(folder: Path, site: Path, kept: set[Path]) -> None:
    """Copies what sets formulas beside the pages."""
    to = site / "_static/katex"
    for name in ("katex.min.js", "katex.min.css", "contrib/auto-render.js"):
        copy = to / Path(name).name
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(folder / name, copy)
        kept.add(copy)
    for font in sorted((folder / "fonts").iterdir()):
        copy = to / "fonts" / font.name
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(font, copy)
        kept.add(copy)


def messages_with_headings(page: Path) -> str:
    """Returns the page of messages with a heading for each, as links to them need."""
    text = "# Messages\n\n"
    for found in tables_of(page):
        for key, severity, meaning, remedy in found.rows:
            text += f"## {key.strip('`')}\n\n*{severity.capitalize()}.* {meaning}\n\n"
            text += f"*Remedy.* {remedy}.\n\n" if remedy else ""
    return text


def main() -> None:
    parser = argparse.ArgumentParser(description="Writes the sources of the site.")
    parser.add_argument("target", type=Path)
    parser.add_argument("--program", type=Path)
    parser.add_argument("--katex", type=Path, default=Path("/usr/share/javascript/katex"))
    parser.add_argument("--plain", action="store_true", help="for people that read the pages as they are")
    options = parser.parse_args()
    target = options.target.resolve()
    site = target / "doc"
    site.mkdir(parents=True, exist_ok=True)
    for name in BESIDE:  # pages link to these
        if not (target / name).exists():
            (target / name).symlink_to(ROOT / name)

    copy_scenes(target / "prm")

    kept: set[Path] = set()
    pages = copy_files(site, kept)
    if not options.plain:
        if not (options.katex / "katex.min.js").exists():
            raise SystemExit(f"no KaTeX in {options.katex}: scripts/packages.sh documentation")
        copy_katex(options.katex, site, kept)

    reference = Reference(options.program, ROOT, pages) if options.program else None
    if reference:
        pages.update({name: wrapped(text) for name, text in reference.write().items()})
    else:
        pages["messages.md"] = wrapped(messages_with_headings(ROOT / "doc/messages.md"))
    insertions = Insertions(ROOT, pages, reference)
    made = {}
    for name, text in pages.items():
        if name in IN_NO_MENU and not text.startswith("---"):
            text = "---\norphan: true\n---\n" + text
        if "<!-- insert: " in text:
            text = insertions.replace(name, text)
        made[name] = text
    plain = PlainPages(made, {file.relative_to(site).as_posix() for file in kept}) if options.plain else None
    for name, text in made.items():
        write(site / name, plain.write(name) if plain else text)
        kept.add(site / name)

    for file in sorted(site.rglob("*"), reverse=True):  # pages that are no more
        if file.is_file() and file not in kept:
            file.unlink()


if __name__ == "__main__":
    main()
