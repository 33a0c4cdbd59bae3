# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pictures of the work-precision page: error over CPU seconds, both programs, one scene each."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple, Sequence

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot, ticker  # noqa: E402


class Point(NamedTuple):
    """A run: program, setting, elements, CPU seconds, error; NaN where it failed."""

    program: str
    setting: str
    elements: int
    seconds: float
    error: float


def without_luck(points: Sequence[Point]) -> list[Point]:
    """Returns the points with the largest error of their setting on their mesh and finer ones, since errors
    of a coarse mesh and of a soft penalty may cancel."""
    return [
        point._replace(
            error=max(
                p.error
                for p in points
                if p[:2] == point[:2] and p.elements >= point.elements and p.error == p.error
            )
        )
        for point in points
        if point.error == point.error
    ]


def front_of(points: Sequence[Point], floor: float = 0.0) -> list[Point]:
    """Returns the points that none is both cheaper and better than, cheapest first. Errors below the floor
    are no better than it."""
    best: list[Point] = []
    for point in sorted((p for p in points if p.error == p.error), key=lambda p: (p.seconds, p.error)):
        if not best or max(point.error, floor) < max(best[-1].error, floor):
            best.append(point)
    return best


BLUES = ("#08306b", "#2171b5", "#4292c6", "#6baed6", "#00441b", "#238b45")
REDS = ("#7f0000", "#d7301f", "#fc8d59", "#fdbb84", "#8c510a", "#bf812d", "#dfc27d", "#762a83", "#c51b7d")
MARKERS = "osD^vP"


def draw(path: Path, title: str, points: Sequence[Point], uncertainty: float) -> None:
    """Writes the picture: billet is blue and solid, CalculiX red and dashed; a line joins the meshes of a
    setting, and wide lines are the fronts of both programs, without luck."""
    figure, axes = pyplot.subplots(figsize=(8.4, 4.6), dpi=90)
    for program, colours, style in (("billet", BLUES, "-"), ("CalculiX", REDS, "--")):
        mine = [p for p in points if p.program == program]
        front = front_of(without_luck(mine), uncertainty)
        if front:
            x = [front[0].seconds]
            y = [1e3]
            for p, following in zip(front, [*front[1:], None]):
                x += [p.seconds, following.seconds if following else 1e4]
                y += [max(p.error, uncertainty)] * 2
            axes.plot(x, y, color=colours[1], lw=6, alpha=0.25, zorder=1, solid_joinstyle="miter")
        for i, setting in enumerate(dict.fromkeys(p.setting for p in mine)):
            found = sorted(
                (p for p in mine if p.setting == setting and p.error == p.error), key=lambda p: p.elements
            )
            if found:
                axes.plot(
                    [p.seconds for p in found],
                    [max(p.error, uncertainty / 3) for p in found],
                    style,
                    marker=MARKERS[i % len(MARKERS)],
                    color=colours[i % len(colours)],
                    ms=5,
                    lw=1.2,
                    label=f"{program}, {setting}",
                )
    good = [p for p in points if p.error == p.error]
    low = min(uncertainty, *(max(p.error, uncertainty / 3) for p in good)) / 1.5
    axes.axhspan(low / 10, uncertainty, color="0.5", alpha=0.2, lw=0)
    axes.text(
        0.01,
        uncertainty * 0.93,
        "uncertainty of the reference",
        fontsize=7.5,
        color="0.3",
        va="top",
        transform=axes.get_yaxis_transform(),
    )
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="CPU seconds, user and system",
        ylabel="error",
        xlim=(min(p.seconds for p in good) / 1.5, max(p.seconds for p in good) * 1.5),
        ylim=(low, max(p.error for p in good) * 1.6),
    )
    axes.yaxis.set_major_formatter(ticker.FuncFormatter(lambda y, _: f"{100 * y:g} %"))
    axes.xaxis.set_major_formatter(ticker.FuncFormatter(lambda x, _: f"{x:g}"))
    axes.grid(which="major", alpha=0.35, lw=0.7)
    axes.grid(which="minor", alpha=0.15, lw=0.5)
    axes.set_title(title, fontsize=11, loc="left")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=7.5, frameon=False)
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Software": None})
    pyplot.close(figure)
