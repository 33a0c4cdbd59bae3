# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measured points: nominal stress over stretch in three modes."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy
from numpy.typing import NDArray

from .. import UserError

Array = NDArray[numpy.float64]

MODES = ("uniaxial", "equibiaxial", "planar")
HELP = "columns MODE_stretch (or MODE_strain, nominal) and MODE_stress (nominal), MODE one of " + ", ".join(
    MODES
)


@dataclass
class Points:
    """Stretches and nominal stresses of one mode."""

    stretches: Array
    stresses: Array


Data = dict[str, Points]


def parse_cell(cell: str, place: str) -> float:
    """Returns the finite number in a cell."""
    try:
        number = float(cell)
    except ValueError:
        number = float("nan")
    if not numpy.isfinite(number):
        raise UserError(f"{place}: '{cell}' is no number")
    return number


def read_data(file: Path) -> Data:
    """Reads a CSV file. Empty cells end no row; comments begin with '#'."""
    try:
        lines = [line for line in file.read_text().splitlines() if line.strip() and line.strip()[0] != "#"]
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"{file}: cannot be read: {error}") from None
    if lines and ";" in lines[0]:
        raise UserError(f"{file}: its cells are separated by ';'; use commas, and points in numbers")
    reader = csv.DictReader(lines, skipinitialspace=True)
    rows = list(reader)
    columns = [name.strip() for name in reader.fieldnames or ()]
    for number, row in enumerate(rows, 1):
        if None in row:
            raise UserError(f"{file}: row {number} has more cells than there are columns")
    unknown = [
        name
        for name in columns
        if name not in {f"{mode}_{what}" for mode in MODES for what in ("stretch", "strain", "stress")}
    ]
    if unknown or not rows:
        raise UserError(f"{file}: " + (f"unknown column '{unknown[0]}'; " if unknown else "no rows; ") + HELP)
    data: Data = {}
    for mode in MODES:
        kinds = [kind for kind in ("stretch", "strain") if f"{mode}_{kind}" in columns]
        if not kinds and f"{mode}_stress" not in columns:
            continue
        if len(kinds) != 1 or f"{mode}_stress" not in columns:
            raise UserError(f"{file}: {mode} has not one stretch and one stress; " + HELP)
        pairs = []
        for number, row in enumerate(rows, 1):
            cells = {name.strip(): (cell or "").strip() for name, cell in row.items()}
            first, second = cells[f"{mode}_{kinds[0]}"], cells[f"{mode}_stress"]
            if not first and not second:
                continue
            place = f"{file}: row {number}, {mode}"
            stretch = parse_cell(first, place) + (1 if kinds[0] == "strain" else 0)
            if not stretch > 0:
                raise UserError(f"{place}: a stretch must be > 0")
            stress = parse_cell(second, place)
            if stress * (stretch - 1) < 0 or (stretch == 1 and stress != 0):
                raise UserError(
                    f"{place}: the stress {stress:g} at a stretch of {stretch:g}; tension has stretches above"
                    " 1, and without stress the stretch is 1. Check columns, signs and the zero of the strain"
                )
            pairs.append((stretch, stress))
        points = numpy.array(sorted(pair for pair in pairs if pair[0] != 1.0))
        if len(points) > 0:
            data[mode] = Points(points[:, 0], points[:, 1])
    if not data:
        raise UserError(f"{file}: no points; " + HELP)
    return data
