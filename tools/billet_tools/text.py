# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers, tables and sentences of the pages that the tools write."""

from __future__ import annotations

import math
import re
import textwrap
from typing import Iterable, Sequence


def number(value: object, digits: int = 3) -> str:
    """Returns it in plain or scientific form, to so many significant digits; a dash for what is not there."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "–"
    if isinstance(value, float):
        return f"{value:.{digits}g}" if value == 0 or abs(value) < 10**digits else f"{value:.0f}"
    return str(value)


def big(value: float) -> str:
    """Returns a whole number, its thousands apart."""
    return "–" if math.isnan(value) else f"{value:,.0f}"


def percent(value: float | None, digits: int = 2) -> str:
    """Returns a part in percent."""
    return "–" if value is None or math.isnan(value) else number(100.0 * value, digits) + " %"


def table(head: Sequence[object], rows: Iterable[Sequence[object]]) -> str:
    """Returns a table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell).replace("|", "/") for cell in line) + " |" for line in lines)


# A word; code, formulas and links are one.
_WORD = re.compile(r"(?:`[^`]*`|\$[^$]+\$|!?\[[^\]]*\]\([^)]*\)|\S)+")
# Words that Markdown takes for a mark at the start of a line.
_NEVER_FIRST = re.compile(r"[-*+]$|\d+[.)]$|[#|>]|={3}|-{3}|`{3}|~{3}|:::")
_ITEM = re.compile(r"\s*(?:[-*+]|\d+[.)])\s+")
_FENCE = re.compile(r"\s*(?:`{3}|~{3}|\${2}$)")
_NO_PROSE = re.compile(r"\s*(?:$|[#|]|<!--|:::|\(\S+\)=$|\[\S+\]: |-{3,}$)")


def wrapped(page: str, columns: int = 100) -> str:
    """Returns Markdown whose paragraphs and lists have at most so many columns in a line, unless a word is
    longer. Headings, tables, code in fences and formulas stay as they are."""
    lines: list[str] = []
    words: list[str] = []  # of the paragraph
    begin = rest = ""  # of its first line, of the others

    def close() -> None:
        line = ""
        for i, word in enumerate(words):
            if i and len(line) + 1 + len(word) > columns:
                lines.append(line)
                line = rest + word
            else:
                line = f"{line} {word}" if i else begin + word
        if words:
            lines.append(line)
        words.clear()

    is_fenced = False
    for text in page.split("\n"):
        is_fence = bool(_FENCE.match(text))
        if is_fenced or is_fence or _NO_PROSE.match(text):
            close()
            lines.append(text)
            is_fenced ^= is_fence
            continue
        item = _ITEM.match(text)
        if item:
            close()
            begin, rest = item[0], " " * len(item[0])
            text = text[len(item[0]) :]
        elif not words:
            begin = rest = " " * (len(text) - len(text.lstrip()))
        for word in _WORD.findall(text):
            if words and _NEVER_FIRST.match(word):
                words[-1] += f" {word}"
            else:
                words.append(word)
    close()
    return "\n".join(lines)


def items(sentences: Iterable[str]) -> str:
    """Returns a list in Markdown."""
    return "\n".join(f"- {sentence}" for sentence in sentences)


def quoted(messages: Iterable[tuple[str, str]], columns: int = 100) -> str:
    """Returns a list of messages of a program as it printed them, each below the words that introduce it."""
    return "\n\n".join(
        f"- {words}:\n\n  ```text\n"
        + textwrap.fill(
            message,
            columns,
            initial_indent="  ",
            subsequent_indent="  ",
            break_long_words=False,
            break_on_hyphens=False,
        )
        + "\n  ```"
        for words, message in messages
    )


def shortened(text: str, words: int = 24) -> str:
    """Returns a text with so many words at most, if possible up to a comma or the like."""
    first = text.split()[:words]
    if len(text.split()) <= words:
        return text
    ends = [i for i, word in enumerate(first) if word[-1] in ",;:" and 2 * i >= words]
    return " ".join(first[: ends[-1] + 1] if ends else first).rstrip(",;:") + " ..."


def written_by(command: str) -> str:
    """Returns the part of a page that says which command writes it."""
    return f"Written by:\n\n```sh\n{command}\n```"


def first_sentence(text: str) -> str:
    """Returns it, or what stands before a list of details."""
    text = " ".join(text.split())
    match = re.match(r"(.+?)(?:\.(?= [A-Z])|\.?$)", text)
    first = match[1] if match else ""
    return first if len(first) <= 400 else first[: first.rindex(" ", 0, 397)].rstrip(",;:") + " ..."
