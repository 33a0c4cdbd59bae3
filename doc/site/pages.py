# SPDX-License-Identifier: LGPL-2.1-or-later
"""Markdown of generated pages: escapes, tables, names of targets."""

from __future__ import annotations

import re
from typing import Iterable, Sequence

QUOTED = re.compile(r"(?<!\w)'([^'\n]+?)'(?!\w)")
SPECIAL = re.compile(r"([\\`*_{}\[\]<>$|#~])")


def escaped(text: str) -> str:
    """Returns text that Markdown shows as it is."""
    return SPECIAL.sub(r"\\\1", text)


def code(text: str) -> str:
    """Returns text as code; in tables, too."""
    if not text:
        return "*empty*"
    return f"`` {text} ``" if "`" in text else "`" + text.replace("|", "\\|") + "`"


def prose(text: str) -> str:
    """Returns text of the program, with what it quotes as code."""
    parts = []
    last = 0
    for match in QUOTED.finditer(text):
        parts += [escaped(text[last : match.start()]), code(match[1])]
        last = match.end()
    return "".join(parts) + escaped(text[last:])


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Returns a table."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines) + "\n"


def target(*words: str) -> str:
    """Returns the name of a link's target."""
    return re.sub(r"[^a-z0-9]+", "-", "-".join(words).lower()).strip("-")
