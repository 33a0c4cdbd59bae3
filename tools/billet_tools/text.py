# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers, tables and sentences of the pages that the tools write."""

from __future__ import annotations

import math
import re
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


def first_sentence(text: str) -> str:
    """Returns it, or what stands before a list of details."""
    text = " ".join(text.split())
    match = re.match(r"(.+?)(?:\.(?= [A-Z])|\.?$)", text)
    first = match[1] if match else ""
    return first if len(first) <= 400 else first[: first.rindex(" ", 0, 397)].rstrip(",;:") + " ..."
