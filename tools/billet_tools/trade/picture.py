# SPDX-License-Identifier: LGPL-2.1-or-later
"""Error over cost, log-log: one curve a parameter, what failed in a band of its own, the Pareto front, the
choice."""

from __future__ import annotations

import math
import textwrap
from pathlib import Path
from typing import Callable, Sequence

from matplotlib import pyplot, ticker
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from ..text import percent
from .measure import pareto_front
from .report import WORK, Point, Sweep

Measure = Callable[[Point], float]  # cost or error of a point

MARKERS = "osD^v<>pPhHX*d8"
COLOURS = [
    "#0072b2",
    "#d55e00",
    "#009e73",
    "#cc79a7",
    "#b8860b",
    "#56b4e9",
    "#7f3c8d",
    "#e24a33",
    "#3a7d44",
    "#5b5b8c",
    "#a65628",
    "#11a579",
    "#e7298a",
    "#666666",
    "#1b4f72",
]
COSTS: tuple[Measure, Measure] = (lambda p: p.seconds, lambda p: p.work)


def draw(sweep: Sweep, file: Path, title: str) -> None:
    figure = picture_of(sweep, title)
    figure.savefig(file, dpi=110)
    pyplot.close(figure)


def picture_of(sweep: Sweep, title: str) -> Figure:
    """Points whose errors cancel stand at the error that they are ranked by, their values in brackets."""
    curves = sweep.curves()
    figure, panels = pyplot.subplots(1, 2, figsize=(12.0, 5.6), sharey=True)
    good = [p for p in sweep.points if p.is_good]
    u = sweep.uncertainty
    error = sweep.ranked
    top, bottom = limits([max(error(p), u) for p in good] + ([sweep.target] if sweep.target else []), u)
    failed = [p for p in sweep.points if not p.is_good]
    band = top * (top / bottom) ** 0.05 if failed else top
    ceiling = top * (top / bottom) ** 0.10 if failed else top
    for axes, cost, label in zip(
        panels, COSTS, ("core-seconds (user and system, all ranks)", WORK[sweep.scene.is_explicit])
    ):
        if failed:
            axes.axhspan(top, ceiling, color="#b02020", alpha=0.09, lw=0)
        axes.axhspan(bottom, u, color="0.5", alpha=0.16, lw=0)
        if sweep.target:
            axes.axhline(sweep.target, color="0.25", lw=0.9, ls=(0, (5, 3)))
        if not sweep.is_blind:
            draw_front(axes, good, cost, error, u, ceiling)
        for i, (name, points) in enumerate(curves.items()):
            draw_curve(
                axes, points, cost, error, u, COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)], name
            )
            bad = [p for p in points if not p.is_good and cost(p) > 0]
            axes.plot(
                [cost(p) for p in bad],
                [band] * len(bad),
                "x",
                color=COLOURS[i % len(COLOURS)],
                ms=8,
                mew=2.2,
                zorder=5,
            )
        base = sweep.base
        if base.is_good:
            axes.plot(
                cost(base),
                max(error(base), u),
                "*",
                color="black",
                ms=15,
                mec="white",
                mew=0.8,
                zorder=8,
                label="as written",
            )
        elif cost(base) > 0:
            axes.plot(cost(base), band, "x", color="black", ms=10, mew=2.6, zorder=8, label="as written")
        if sweep.chosen:
            axes.plot(
                cost(sweep.chosen),
                max(error(sweep.chosen), u),
                "o",
                ms=19,
                mfc="none",
                mec="#c00000",
                mew=2.0,
                zorder=9,
            )
            axes.plot(
                [], [], "o", ms=10, mfc="none", mec="#c00000", mew=1.6, label=f"chosen: {sweep.chosen.label}"
            )
        axes.set(xscale="log", yscale="log", xlabel=label, ylim=(bottom, ceiling))
        wide(axes, [cost(p) for p in sweep.points if cost(p) > 0])
        axes.grid(which="major", alpha=0.35, lw=0.7)
        axes.grid(which="minor", alpha=0.15, lw=0.5)
        low, high = axes.get_xlim()
        axes.xaxis.set_major_locator(
            ticker.LogLocator(base=10, subs=[1, 2, 5] if high / low < 100 else [1], numticks=30)
        )
        axes.xaxis.set_major_formatter(ticker.FuncFormatter(cost_text))
        axes.xaxis.set_minor_formatter(ticker.NullFormatter())
    panels[0].set_ylabel("error of " + ", ".join(o.name for o in sweep.outputs))
    panels[0].yaxis.set_major_formatter(ticker.FuncFormatter(lambda y, _: f"{100 * y:g} %"))
    subs = [1, 2, 5] if top / bottom < 300 else [1]
    panels[0].yaxis.set_major_locator(ticker.LogLocator(base=10, subs=subs, numticks=30))
    panels[0].yaxis.set_minor_formatter(ticker.NullFormatter())
    notes = [
        panels[0].text(
            0.012,
            u * (bottom / u) ** 0.06,
            f"reference's uncertainty, {percent(u)}",
            transform=panels[0].get_yaxis_transform(),
            fontsize=8,
            color="0.35",
            va="top",
        )
    ]
    if failed:
        notes.append(
            panels[0].text(
                0.012,
                band,
                "failed",
                transform=panels[0].get_yaxis_transform(),
                fontsize=8,
                color="#901010",
                va="center",
            )
        )
    if sweep.target:
        notes.append(
            panels[1].text(
                0.99,
                sweep.target,
                f"target {percent(sweep.target)}",
                transform=panels[1].get_yaxis_transform(),
                fontsize=8,
                color="0.25",
                va="bottom",
                ha="right",
            )
        )
    figure.suptitle(title, fontsize=12, x=0.01, ha="left")
    handles, labels = panels[0].get_legend_handles_labels()
    labels = ["\n".join(textwrap.wrap(label, 26)) for label in labels]
    legend = figure.legend(
        handles,
        labels,
        loc="center right",
        bbox_to_anchor=(0.995, 0.52),
        fontsize=8.5,
        frameon=False,
        labelspacing=0.55,
    )
    # The panels get what the legend leaves, whatever its words.
    box = legend.get_window_extent(figure.canvas.get_renderer())
    figure.tight_layout(rect=(0, 0, box.x0 / figure.bbox.width, 1.0), w_pad=1.0)
    for axes, cost in zip(panels, COSTS):
        name_points(axes, sweep, cost, u, band, notes)
    return figure


def cost_text(cost: float, _: object) -> str:
    power = math.floor(math.log10(cost) + 1e-9)
    leading = round(cost / 10.0**power)
    return f"{cost:g}" if -3 < power < 4 else (f"{leading}·" if leading > 1 else "") + f"$10^{{{power}}}$"


def limits(errors: list[float], u: float) -> tuple[float, float]:
    low, high = min(errors + [u]), max(errors + [2 * u])
    return high * 1.35 * (high / low) ** 0.04, low / 1.6


def wide(axes: Axes, costs: Sequence[float]) -> None:
    """Points off the frame, and no axis shorter than a factor of four."""
    low, high = min(costs), max(costs)
    middle = math.sqrt(low * high)
    reach = max(2.0, high / middle * (high / low) ** 0.04 * 1.15)
    axes.set_xlim(middle / reach, middle * reach)


def draw_front(
    axes: Axes, points: Sequence[Point], cost: Measure, error: Measure, u: float, ceiling: float
) -> None:
    front = [points[i] for i in pareto_front([cost(p) for p in points], [error(p) for p in points], u)]
    if not front:
        return
    # Dominated points lie to the right of and above this staircase.
    x, y = [cost(front[0])], [ceiling]
    for p, following in zip(front, front[1:] + [None]):
        x += [cost(p), cost(following) if following else 1e30]
        y += [max(error(p), u)] * 2
    axes.plot(x, y, color="0.72", lw=5, solid_joinstyle="miter", zorder=1, label="Pareto front")


def draw_curve(
    axes: Axes,
    points: Sequence[Point],
    cost: Measure,
    error: Measure,
    u: float,
    colour: str,
    marker: str,
    name: str,
) -> None:
    good = [p for p in points if p.is_good]
    are_numbers = all(is_number(p.value) for p in points)
    if are_numbers:  # words have no order to follow
        axes.plot(
            [cost(p) for p in good],
            [max(error(p), u) for p in good],
            "-",
            color=colour,
            lw=1.3,
            alpha=0.85,
            zorder=3,
        )
    for told in (True, False):
        some = [p for p in good if (error(p) >= u) == told]
        axes.plot(
            [cost(p) for p in some],
            [max(error(p), u) for p in some],
            marker,
            ls="none",
            color=colour,
            ms=6,
            zorder=4,
            mfc=colour if told else "white",
            mew=1.3,
        )
    axes.plot([], [], marker + ("-" if are_numbers else ""), color=colour, ms=6, label=name)


def is_number(text: str) -> bool:
    try:
        float(text)
        return True
    except ValueError:
        return False


def name_points(
    axes: Axes, sweep: Sweep, cost: Measure, u: float, band: float, notes: Sequence[Text]
) -> None:
    """Labels points with their values, those on the front first, if there is room beside points, notes and
    each other."""
    pixels = axes.transData.transform
    frame = axes.get_window_extent()
    taken = [note.get_window_extent().extents for note in notes if note.axes is axes]
    front = set(map(id, sweep.front))
    points = sorted(
        (p for p in sweep.points if p.is_good and not p.is_base), key=lambda p: id(p) not in front
    )
    colours = {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(sweep.curves())}
    spots = [pixels((cost(p), max(sweep.ranked(p), u))) for p in sweep.points if p.is_good]
    scale = axes.figure.dpi / 72
    failed = [p for p in sweep.points if not p.is_good and not p.is_base and cost(p) > 0]
    spots += [pixels((cost(p), band)) for p in failed]
    for p in points + failed:
        value = f"({p.value})" if id(p) in sweep.cancelled else p.value
        text, at = (value, max(sweep.ranked(p), u)) if p.is_good else (f"{p.value}: {p.status}", band)
        x, y = pixels((cost(p), at))
        width, height = 4.3 * scale * len(text), 8.0 * scale
        for dx, dy in (
            ((-6 - width, -4), (6, -4))
            if not p.is_good
            else (
                (6, 4),
                (6, -11),
                (-6 - width, 4),
                (-6 - width, -11),
                (-0.5 * width, 8),
                (-0.5 * width, -15),
            )
        ):
            box = (x + dx, y + dy, x + dx + width, y + dy + height)
            if box[0] < frame.x0 or box[2] > frame.x1 or box[1] < frame.y0 or box[3] > frame.y1:
                continue
            if any(box[0] < b[2] and b[0] < box[2] and box[1] < b[3] and b[1] < box[3] for b in taken) or any(
                box[0] - 4 < sx < box[2] + 4 and box[1] - 4 < sy < box[3] + 4 for sx, sy in spots
            ):
                continue
            taken.append(box)
            axes.annotate(
                text,
                (cost(p), at),
                xytext=(dx / scale, dy / scale),
                textcoords="offset points",
                fontsize=7.5,
                color=colours[p.curve],
                zorder=6,
            )
            break
