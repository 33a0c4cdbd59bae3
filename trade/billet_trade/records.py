# SPDX-License-Identifier: LGPL-2.1-or-later
"""Messages of a run, as billet writes them: one JSON object a line, the last one a summary."""

import json


def read_records(file):
    """All messages of a run, without the summary; none if there is no file. A line that was cut off is left
    out."""
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


def failure_of(records):
    """The message that ended the run, or an empty one."""
    return next((r for r in reversed(records) if r.get("severity") == "error"), {})


def value_of(record, name, otherwise=0.0):
    """A number that belongs to the message."""
    value = record.get("values", {}).get(name)
    return otherwise if value is None else value
