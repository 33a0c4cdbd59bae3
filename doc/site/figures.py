# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: figures.py [--write | --self-check]

Checks figures in running text, above all of README.md, against the pages of doc/results that have them and
against doc/scenes/costs.csv, or writes them anew.
"""

from __future__ import annotations

import csv
import re
import sys
from pathlib import Path
from typing import Callable, NamedTuple

from results import cell_of, tables_of

ROOT = Path(__file__).resolve().parents[2]
RESULTS = ROOT / "doc/results"


class Figure(NamedTuple):
    """A sentence of a page: its text, with a group for each figure, and what the groups must be."""

    page: str
    text: str
    values: Callable[[], tuple[str, ...]]


def found(page: str, pattern: str) -> tuple[str, ...]:
    """Returns the figures in the text of a page of results."""
    text = " ".join((RESULTS / page).read_text(encoding="utf-8").split())
    match = re.search(pattern, text)
    if not match:
        raise SystemExit(f"doc/results/{page}: nothing says '{pattern}'")
    return match.groups()


def cheaper_scenes() -> tuple[str, ...]:
    """Returns in how many scenes CalculiX is cheaper, with the start of billet and without."""
    n_scenes, n_wins = found(
        "work-precision.md", r"CPU seconds in [0-9]+ of ([0-9]+) scenes, and CalculiX in ([0-9]+)"
    )
    (n_without,) = found("work-precision.md", r"billet is the cheaper one in ([0-9]+)")
    return n_wins, str(int(n_scenes) - int(n_without))


def iterations_of_billet() -> tuple[str, ...]:
    cell = cell_of(RESULTS / "billet-tangents.md", {"tangent": "exact"}, "5e-3: iterations / steps")
    return tuple(cell.split(" / "))


def gain_of_tube_impact() -> tuple[str, ...]:
    row = {"program": "billet, as the scene is", "contact": "yes"}
    return (cell_of(RESULTS / "tube-impact.md", row, "times cheaper than ccx"),)


def silent_errors() -> tuple[str, ...]:
    table = tables_of(RESULTS / "silent-errors.md")[0]
    n_wrong = sum(int(row[table.head.index("wrong")]) for row in table.rows)
    return (str(n_wrong) if n_wrong else "none",)


def n_extreme_scenes() -> tuple[str, ...]:
    return (f"{int(found('extremes.md', r': ([0-9]+) tiny scenes')[0]):,}",)


def trade_of_billet() -> tuple[str, ...]:
    page = RESULTS / "trade/billet_upsetting.md"
    cell = cell_of(page, {"parameter": "steps"}, "cheapest within the target, at times the cost")
    error, cost = cell.split(": ")[1].split(" at ")
    return error, *found("trade/billet_upsetting.md", r"as it is written has an error of ([0-9.]+ %)"), cost


def runs_within_target() -> tuple[str, ...]:
    return found("target-error.md", r"([0-9]+ of [0-9]+) runs are within their target")


def cost_of(scene: str, *columns: str) -> Callable[[], tuple[str, ...]]:
    """Returns what looks up the cost of a shipped scene."""

    def values() -> tuple[str, ...]:
        with (ROOT / "doc/scenes/costs.csv").open(encoding="utf-8", newline="") as file:
            rows = {row["scene"]: row for row in csv.DictReader(file)}
        return tuple(rows[scene][column] for column in columns)

    return values


def cheap_runs() -> tuple[str, ...]:
    work = found("target-error.md", r"([0-9]+) of [0-9]+ take at most 1.5 times the work")
    seconds = found("target-error.md", r"([0-9]+) of [0-9]+ take at most 1.5 times the CPU")
    without_start = r"start takes ([0-9.]+) of these seconds; without it ([0-9]+) of [0-9]+ take so few"
    return *work, *seconds, *found("target-error.md", without_start)


BESIDE_CALCULIX = r"within 1 %, CalculiX is cheaper in (\d+), and in (\d+) without the start of `billet`"
EXAMPLES = "doc/guide/examples.md"
FIGURES = (
    Figure("README.md", r"(\d+) Newton iterations in (\d+) steps", iterations_of_billet),
    Figure("README.md", r"a step takes 1/(\d+) of CalculiX's time", gain_of_tube_impact),
    Figure("README.md", r"target error, and (\d+ of \d+) runs meet it", runs_within_target),
    Figure("README.md", r"that have a reference, (\w+) was wrong without a warning", silent_errors),
    Figure("README.md", r"([\d,]+) scenes vary every parameter", n_extreme_scenes),
    Figure(
        "README.md",
        r"on the billet, ([\d.]+ %) instead of ([\d.]+ %) for ([\d.]+) of the work",
        trade_of_billet,
    ),
    Figure("README.md", BESIDE_CALCULIX, cheaper_scenes),
    Figure("doc/index.md", BESIDE_CALCULIX, cheaper_scenes),
    Figure("doc/guide/accuracy.md", r"(\d+ of \d+) runs are within their target", runs_within_target),
    Figure(
        "doc/guide/accuracy.md",
        r"element updates \| (\d+) \| \| at most 1.5 times the CPU seconds, set-up included \| (\d+) \|"
        r" \| at most 1.5 times the CPU seconds, without the program's start of ([\d.]+) s \| (\d+) \|",
        cheap_runs,
    ),
    Figure(
        EXAMPLES,
        r"turned back, lifted: (\d+) steps, (\d+) iterations",
        cost_of("twisted_hemisphere", "steps", "iterations"),
    ),
    Figure(
        EXAMPLES, r"with μ = 0.3: (\d+) steps, (\d+) iterations", cost_of("ironing", "steps", "iterations")
    ),
    Figure(
        EXAMPLES,
        r"and opens again: (\d+) iterations in (\d+) steps",
        cost_of("ring_crush", "iterations", "steps"),
    ),
    Figure(
        EXAMPLES,
        r"onto the plates, too: (\d+) iterations in (\d+) steps",
        cost_of("hollow_block", "iterations", "steps"),
    ),
)


def pattern_of(figure: Figure) -> re.Pattern[str]:
    return re.compile(figure.text.replace(" ", r"\s+"))


def fault_of(figure: Figure, text: str) -> str:
    """Returns what is wrong with a figure in the text of its page."""
    match = pattern_of(figure).search(text)
    if not match:
        return f"nothing says '{figure.text}'"
    shown = tuple(" ".join(group.split()) for group in match.groups())
    wanted = figure.values()
    return "" if shown == wanted else f"'{match[0]}' has {shown}; the results have {wanted}"


def written(figure: Figure, text: str) -> str:
    """Returns the text with the figures of the results."""
    match = pattern_of(figure).search(text)
    if not match:
        return text
    for group, value in reversed(list(enumerate(figure.values(), 1))):
        text = text[: match.start(group)] + value + text[match.end(group) :]
    return text


def main() -> int:
    """Returns the exit code."""
    n_errors = 0
    for figure in FIGURES:
        page = ROOT / figure.page
        text = page.read_text(encoding="utf-8")
        if "--write" in sys.argv[1:] and fault_of(figure, text):
            text = written(figure, text)
            page.write_text(text, encoding="utf-8")
        if "--self-check" in sys.argv[1:]:  # a digit or a word that is another
            match = pattern_of(figure).search(text)
            assert match
            wrong = text[: match.start(1)] + "7" + text[match.start(1) :]
            if not fault_of(figure, wrong) or written(figure, wrong) != text:
                print(f"{figure.page}: '{figure.text}' does not see or mend a wrong figure")
                n_errors += 1
        fault = fault_of(figure, text)
        if fault:
            print(f"{figure.page}: {fault}")
            n_errors += 1
    print(f"{len(FIGURES)} sentences with figures, {n_errors} errors")
    return 1 if n_errors else 0


if __name__ == "__main__":
    sys.exit(main())
