# SPDX-License-Identifier: LGPL-2.1-or-later
"""The picture of an explanation: a bar for each source of error, its range, and what its run costs."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib import pyplot
from matplotlib.figure import Figure

from ..text import number, percent

if TYPE_CHECKING:
    from .explanation import Explanation


def draw(explanation: Explanation, file: Path, title: str) -> None:
    figure = picture_of(explanation, title)
    figure.savefig(file, dpi=110)
    pyplot.close(figure)


def picture_of(explanation: Explanation, title: str) -> Figure:
    """Part of a bar that the reducing run takes away is dark, what it leaves light; hatched: in the mesh's
    bar already; a line is the range, with an arrow where it is open."""
    shown = [bar for bar in explanation.bars if bar.is_known]
    figure, axes = pyplot.subplots(figsize=(9.0, 1.6 + 0.5 * (len(shown) + 1)))
    rows = list(range(len(shown), 0, -1))
    finite = [v for bar in shown for v in (bar.error, bar.high) if math.isfinite(v)]
    reach = 100.0 * max(finite + [explanation.sum, 1e-12])
    for y, bar in zip(rows, shown):
        left = bar.error if bar.left is None else min(bar.left, bar.error)
        hatch = "///" if bar.source.is_of_mesh else None
        axes.barh(y, 100.0 * (bar.error - left), color="#0072b2", hatch=hatch, edgecolor="white", height=0.62)
        axes.barh(
            y,
            100.0 * left,
            left=100.0 * (bar.error - left),
            color="#9fcbe6",
            hatch=hatch,
            edgecolor="white",
            height=0.62,
        )
        high = 100.0 * bar.high if math.isfinite(bar.high) else 1.05 * reach
        axes.plot([100.0 * bar.low, high], [y, y], color="0.25", lw=1.4, zorder=4)
        axes.plot(high, y, "|" if math.isfinite(bar.high) else ">", color="0.25", ms=7, zorder=4)
        price = "" if math.isnan(bar.price) else f", × {number(bar.price, 2)} cost to reduce"
        axes.text(
            max(high, 100.0 * bar.error) + 0.015 * reach,
            y,
            percent(bar.error) + price,
            va="center",
            fontsize=8.5,
        )
    axes.barh(0, 100.0 * explanation.sum, color="0.55", height=0.62)
    own = explanation.base.estimates
    if own:
        axes.plot([100.0 * sum(own.values())] * 2, [-0.4, 0.4], color="#d55e00", lw=2.2, zorder=5)
        told = f", the run's own estimate (red) {percent(sum(own.values()))}"
    else:
        told = ""
    axes.text(
        100.0 * explanation.sum + 0.015 * reach, 0, percent(explanation.sum) + told, va="center", fontsize=8.5
    )
    axes.set_yticks([*rows, 0], [*(bar.source.name for bar in shown), "sum"])
    axes.set_xlim(0.0, 1.75 * reach)
    axes.set_ylim(-0.6, len(shown) + 0.6)
    axes.set_xlabel("error of " + ", ".join(o.name for o in explanation.outputs) + " in %")
    axes.grid(axis="x", alpha=0.3, lw=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.suptitle(title, fontsize=12, x=0.01, ha="left")
    figure.tight_layout()
    return figure
