# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads the tables of doc/results and the figures of doc/scenes, so that no page copies a number."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Iterable, Mapping


class Table:
    """One table of a page."""

    def __init__(self, heading: str, head: list[str]) -> None:
        self.heading = heading
        self.head = head
        self.rows: list[list[str]] = []

    def has(self, columns: Iterable[str]) -> bool:
        return all(self.places(column) for column in columns)

    def places(self, column: str) -> list[int]:
        """Returns where columns of this name are; of 'NAME after OTHER' the first NAME behind OTHER."""
        if column in self.head or " after " not in column:
            return [place for place, name in enumerate(self.head) if name == column]
        name, _, other = column.rpartition(" after ")
        behind = self.head.index(other) if other in self.head else len(self.head)
        return [place for place, found in enumerate(self.head) if found == name and place > behind][:1]

    def place(self, column: str) -> int:
        """Returns where the column is; raises SystemExit where there are several."""
        places = self.places(column)
        if len(places) != 1:
            raise SystemExit(f"below '{self.heading}' {len(places)} columns are called '{column}'")
        return places[0]

    def fits(self, row: list[str], wanted: Mapping[str, str]) -> bool:
        return all(row[self.place(name)].strip("`") == value for name, value in wanted.items())


def tables_of(page: Path) -> list[Table]:
    """Returns the tables of a page."""
    tables: list[Table] = []
    heading = ""
    inside = False
    for line in page.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            heading = line.lstrip("# ")
        if not line.startswith("|"):
            inside = False
            continue
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if not inside:
            tables.append(Table(heading, cells))
            inside = True
        elif not all(set(cell) <= set(":- ") for cell in cells):
            tables[-1].rows.append(cells + [""] * (len(tables[-1].head) - len(cells)))
    return tables


def cell_of(page: Path, wanted: Mapping[str, str], column: str, heading: str = "") -> str:
    """Returns the cell of the only row with the wanted values; raises SystemExit where it is not there.

    Columns are named as in Table.place().
    """
    found = [
        row[table.place(column)]
        for table in tables_of(page)
        if (not heading or table.heading == heading) and table.has([column, *wanted])
        for row in table.rows
        if table.fits(row, wanted)
    ]
    if len(found) != 1:
        raise SystemExit(f"{page}: {len(found)} rows with {dict(wanted)} and '{column}' below '{heading}'")
    return found[0]


def selected(root: Path, words: str) -> Table:
    """Returns a part of a table by 'PATH [HEADING] [| COLUMN; ... [| COLUMN = VALUE / VALUE...; ...]]'.

    PATH is that of a page in doc/, without .md. Without columns all are taken, without values all rows.
    Columns are named as in Table.place(). Raises SystemExit if there is no such table, column or value.
    """
    where, columns, values = (*(part.strip() for part in words.split(" | ")), "", "")[:3]
    path, _, heading = where.partition(" ")
    wanted = {
        name.strip(): [value.strip() for value in choices.split(" / ")]
        for name, _, choices in (choice.rpartition(" = ") for choice in values.split(";") if choice.strip())
    }
    names = [name.strip() for name in columns.split(";") if name.strip()]
    for table in tables_of(root / f"doc/{path}.md"):
        if (heading and table.heading != heading) or not table.has([*names, *wanted]):
            continue
        places = [table.place(name) for name in names] or list(range(len(table.head)))
        kept = Table(table.heading, [table.head[place] for place in places])
        for name, choices in wanted.items():
            found = {row[table.place(name)].strip("`") for row in table.rows}
            if not set(choices) <= found:
                raise SystemExit(f"doc/{path}.md: no row with {name} = {sorted(set(choices) - found)}")
        kept.rows = [
            [row[place] for place in places]
            for row in table.rows
            if all(row[table.place(name)].strip("`") in choices for name, choices in wanted.items())
        ]
        if kept.rows:
            return kept
    raise SystemExit(f"doc/{path}.md: no table for '{words}'")


def values_of(root: Path, scene: str) -> list[dict[str, str]]:
    """Returns the figures of a shipped scene; raises SystemExit where there are none."""
    with (root / "doc/scenes/values.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["scene"] == scene]
    if not rows:
        raise SystemExit(f"doc/scenes/values.csv has no figures of '{scene}'")
    return rows
