# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: language.py

Writes doc/results/language.md: what the rules of tests/prose.py find in the pages of today and of earlier
commits. The history of the repository has to be there.
"""

from __future__ import annotations

import io
import subprocess
import sys
import tarfile
from pathlib import Path
from typing import Iterable, Mapping

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
import prose  # noqa: E402

BEFORE = ("3819ab1e", "d54be32b")  # before the work on language, and the last commit without tests/prose.py
PAGE = ROOT / "doc/results/language.md"
ROWS = (
    "lines of prose over 120 columns",
    "lines of prose over 100 columns",
    "sentences of more than 25 words",
    "words of the longest of them",
    "paragraphs of more than five sentences",
)
TEXT = """# Rules of language, before and after

Written by `python3 doc/site/language.py`.

This page counts what the rules of `tests/prose.py` find in the pages of the repository, those of
figures included, without their tables. The first two columns have commits before the work on
language and before the test of the rules: {commits}.
The last column has the pages as they are, where the test `prose` holds them.

{table}

An earlier count, not by this script, had 935 lines over 120 columns and a sentence of 249 words.

The same test holds the comments of scenes and of C++, and `prose --program` what the program
prints of parameters and messages.
"""


def measured(pages: Mapping[str, str]) -> list[str]:
    """Returns the rows for these pages by name."""
    columns, words, sentences = [], [], 0
    for name, text in pages.items():
        has_prose = not name.startswith("doc/results/")  # in its tables, which have messages else
        for fault in prose.faults_of(text) + (prose.faults_of_tables(text) if has_prose else []):
            number, _, what = fault.what.partition(" ")
            if what == "columns":
                columns.append(int(number))
            elif what.startswith("words"):
                words.append(int(number))
            elif what.startswith("sentences"):
                sentences += 1
    longest = str(max(words)) if words else f"none above {prose.MAX_WORDS}"
    n_wide = sum(1 for number in columns if number > 120)
    return [str(number) for number in (n_wide, len(columns), len(words))] + [longest, str(sentences)]


def is_page(name: str) -> bool:
    return name.endswith(".md") and ("/" not in name or name.startswith(("doc/", ".github/")))


def git(*arguments: str) -> bytes:
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, check=True).stdout


def pages_of(commit: str) -> dict[str, str]:
    """Returns the pages of a commit by name."""
    found = {}
    with tarfile.open(fileobj=io.BytesIO(git("archive", commit))) as archive:
        for member in archive:
            file = archive.extractfile(member) if is_page(member.name) else None
            if file and not member.name.startswith(prose.LEFT_OUT):
                found[member.name] = file.read().decode("utf-8")
    return found


def pages_of_today() -> dict[str, str]:
    return {name: (ROOT / name).read_text(encoding="utf-8") for name in prose.pages() if is_page(name)}


def table(columns: Iterable[list[str]]) -> str:
    rows = [(name, *values) for name, *values in zip(ROWS, *columns)]
    lines = [("counted", *BEFORE, "now"), ("---",) * (len(BEFORE) + 2), *rows]
    return "\n".join(f"| {' | '.join(row)} |" for row in lines)


def main() -> None:
    commits = " and ".join(
        git("log", "-1", "--format=%h of %as", commit).decode().strip() for commit in BEFORE
    )
    columns = [*(measured(pages_of(commit)) for commit in BEFORE), measured(pages_of_today())]
    PAGE.write_text(TEXT.format(commits=commits, table=table(columns)), encoding="utf-8")


if __name__ == "__main__":
    main()
