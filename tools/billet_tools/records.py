# SPDX-License-Identifier: LGPL-2.1-or-later
"""Messages of a run, as billet writes them: one JSON object a line, the last one a summary."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Sequence

Record = dict[str, Any]


def read_records(file: Path) -> list[Record]:
    """Returns all messages of a run, without the summary; none if there is no file. A line that was cut off
    is left out."""
    try:
        lines = file.read_text(errors="replace").splitlines()
    except OSError:
        return []
    records = []
    for line in lines:
        try:
            record = json.loads(line)
        except ValueError:
            continue
        if isinstance(record, dict) and "key" in record:
            records.append(record)
    return records


def failure_of(records: Sequence[Record]) -> Record:
    """Returns the message that ended the run, or an empty one."""
    return next((r for r in reversed(records) if r.get("severity") == "error"), {})


def warnings_of(records: Sequence[Record]) -> list[str]:
    """Returns the keys of the warnings, in the order of the alphabet."""
    return sorted({r["key"] for r in records if r.get("severity") == "warning"})


def value_of(record: Record, name: str, otherwise: float = 0.0) -> float:
    """Returns a number that belongs to the message."""
    value = record.get("values", {}).get(name)
    return otherwise if value is None else float(value)
