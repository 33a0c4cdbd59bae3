#!/usr/bin/env python3
"""Draws the figures of the conventions: gap, frame of a node, facet, return maps.

Usage: figures.py [FOLDER]

Writes gap.svg, frame.svg, facet.svg and return_map.svg to FOLDER, by default `images` beside this program.
The files are the same in every run.
"""
import sys
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

BODY, TOOL, FORCE, DARK = "#3465a4", "#b8b8b8", "#c4460a", "#222222"
FONT = 12


def start(width: float, height: float, panels: int = 1) -> tuple[Any, list[Any]]:
    """Returns a figure of so many panels without axes."""
    figure, axes = plt.subplots(1, panels, figsize=(width, height), squeeze=False)
    for panel in axes[0]:
        panel.set_aspect("equal")
        panel.axis("off")
    return figure, list(axes[0])


def arrow(panel: Any, tail: Any, head: Any, color: str = DARK, style: str = "-|>") -> None:
    """Draws an arrow between two points."""
    panel.annotate(
        "", xy=head, xytext=tail,
        arrowprops={"arrowstyle": style, "color": color, "lw": 1.6, "shrinkA": 0, "shrinkB": 0},
    )  # fmt: skip


def label(panel: Any, place: Any, text: str, color: str = DARK, align: str = "center") -> None:
    """Writes a label."""
    panel.text(*place, text, color=color, fontsize=FONT, ha=align, va="center")


def dot(panel: Any, place: Any, color: str = BODY) -> None:
    """Draws a node."""
    panel.plot(*place, "o", color=color, ms=7, zorder=5)


def save(figure: Any, folder: Path, name: str) -> None:
    """Writes a figure without date and random names."""
    figure.tight_layout(pad=0.2)
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None, "Creator": None}, transparent=False)
    plt.close(figure)


def draw_gap(folder: Path) -> None:
    """An open node and one that has penetrated a convex tool."""
    figure, (panel,) = start(7, 3)
    radius = 6.0
    angles = np.radians(np.linspace(52, 128, 200))
    panel.fill_between(radius * np.cos(angles), radius * np.sin(angles), 4.2, color=TOOL, lw=0)
    panel.plot(radius * np.cos(angles), radius * np.sin(angles), color=DARK, lw=1.5)
    label(panel, (0, 4.9), "tool")
    for angle, gap, name in ((110.0, 1.0, "open"), (70.0, -0.55, "closed")):
        normal = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
        along = np.array([normal[1], -normal[0]])
        foot, node = radius * normal, (radius + gap) * normal
        panel.plot(*zip(foot, node), color=BODY, lw=1.2, ls="--")
        dot(panel, node)
        dot(panel, foot, DARK)
        if name == "open":
            arrow(panel, foot + 0.7 * along, foot + 0.7 * along + 0.8 * normal)
            label(panel, foot + 0.95 * along + 0.75 * normal, "$n$")
            label(panel, node - 0.4 * along + 0.1 * normal, "$x_S$", BODY)
            label(panel, foot - 0.25 * normal - 0.35 * along, "$x_P$")
            label(panel, (foot + node) / 2 - 0.65 * along, "$g > 0$", BODY)
        else:
            arrow(panel, node, node + 1.5 * normal, FORCE)
            arrow(panel, node, node + 0.75 * along, FORCE)
            label(panel, node + 1.55 * normal - 0.5 * along, r"$p\,n$", FORCE)
            label(panel, node + 1.0 * along - 0.05 * normal, "$t_t$", FORCE)
            label(panel, node - 0.4 * along - 0.15 * normal, "$x_S$", BODY)
            label(panel, foot - 0.6 * along + 0.2 * normal, "$g < 0$", BODY)
    panel.set_xlim(-4.2, 4.2)
    panel.set_ylim(4.2, 7.5)
    save(figure, folder, "gap")


def draw_frame(folder: Path) -> None:
    """The frame of a node at the start of the step and in the current iterate."""
    figure, (panel,) = start(7, 3.2)
    x = np.linspace(-4, 4, 200)

    def height(at: Any) -> Any:
        return -0.07 * (at + 0.5) ** 2

    panel.fill_between(x, height(x), -2.2, color=TOOL, lw=0)
    panel.plot(x, height(x), color=DARK, lw=1.5)
    label(panel, (0, -1.6), "tool")
    for at, suffix in ((-2.2, "_n"), (2.0, "")):
        slope = -0.14 * (at + 0.5)
        tangent = np.array([1, slope]) / np.hypot(1, slope)
        normal = np.array([-tangent[1], tangent[0]])
        foot = np.array([at, height(at)])
        arrow(panel, foot, foot + 1.4 * tangent, BODY)
        arrow(panel, foot, foot + 1.3 * normal, BODY)
        arrow(panel, foot, foot + np.array([0.75, 0.6]), BODY)
        label(panel, foot + 1.65 * tangent + 0.1 * normal, f"$q{suffix}$", BODY)
        label(panel, foot + 1.5 * normal, f"$n{suffix}$", BODY)
        label(panel, foot + np.array([0.9, 0.78]), f"$r{suffix}$", BODY)
        dot(panel, foot)
        if not suffix:
            turned = np.array([np.cos(np.radians(12)), np.sin(np.radians(12))])
            arrow(panel, foot, foot + 1.45 * turned, FORCE)
            label(panel, foot + 1.75 * turned + np.array([0.1, 0.1]), r"$q^* = R\,q_n$", FORCE, "left")
    panel.annotate(
        "", xy=(1.2, 1.0), xytext=(-1.0, 1.4),
        arrowprops={"arrowstyle": "-|>", "color": FORCE, "connectionstyle": "arc3,rad=-0.3", "lw": 1.3},
    )  # fmt: skip
    label(panel, (0.15, 1.9), "step: rotation $R$ of the tool", FORCE)
    panel.set_xlim(-4, 5.6)
    panel.set_ylim(-2.2, 2.2)
    save(figure, folder, "frame")


def draw_facet(folder: Path) -> None:
    """A facet with corners, diagonals, normal, and a slave node with its projection."""
    figure, (panel,) = start(6, 3.6)
    corners = np.array([[-2.6, -1.0], [1.6, -1.4], [-1.6, 0.9], [2.8, 0.8]])
    panel.fill(*corners[[0, 1, 3, 2]].T, color=TOOL, lw=0)
    panel.plot(*corners[[0, 1, 3, 2, 0]].T, color=DARK, lw=1.5)
    for first, last, name in ((0, 3, "$d_0$"), (1, 2, "$d_1$")):
        arrow(panel, corners[first], corners[last])
        label(panel, corners[first] + 0.72 * (corners[last] - corners[first]) + np.array([0, 0.22]), name)
    for number, corner in enumerate(corners):
        dot(panel, corner, DARK)
        label(panel, corner + np.array([0.35 if number in (1, 3) else -0.35, -0.1]), f"$x_{number}$")
    middle, foot = corners.mean(axis=0), np.array([-0.85, -0.55])
    arrow(panel, middle, middle + np.array([0, 1.9]), FORCE)
    label(panel, middle + np.array([0.3, 1.8]), r"$\bar n$", FORCE)
    node = foot + np.array([0, 1.9])
    panel.plot(*zip(foot, node), color=BODY, lw=1.2, ls="--")
    dot(panel, node)
    dot(panel, foot, BODY)
    label(panel, node + np.array([-0.35, 0.1]), "$x_S$", BODY)
    label(panel, foot + np.array([0, -0.27]), r"$\sum w_I\,x_I$", BODY)
    label(panel, (foot + node) / 2 + np.array([-0.2, 0.35]), "$g$", BODY)
    panel.set_xlim(-3.2, 3.4)
    panel.set_ylim(-1.8, 2.1)
    save(figure, folder, "facet")


def draw_return_maps(folder: Path) -> None:
    """Radial return to the yield surface, and the return of a traction to Coulomb's limit."""
    figure, (left, right) = start(8, 3.6, 2)
    turn = np.radians(np.linspace(0, 360, 300))
    circle = np.array([np.cos(turn), np.sin(turn)])
    left.plot(*(1.2 * circle), color=DARK, lw=1.2, ls="--")
    left.plot(*(1.5 * circle), color=DARK, lw=1.6)
    direction = np.array([np.cos(np.radians(35)), np.sin(np.radians(35))])
    start_of_step = np.array([0.2, 0.85])
    arrow(left, start_of_step, 2.4 * direction, BODY)
    arrow(left, 2.4 * direction, 1.5 * direction, FORCE)
    left.plot(*zip((0, 0), 1.5 * direction), color=DARK, lw=0.8, ls=":")
    dot(left, start_of_step)
    dot(left, 1.5 * direction, FORCE)
    label(left, start_of_step + np.array([-0.4, -0.05]), r"$\mathrm{dev}\,\tau_n$", BODY, "right")
    label(left, 2.4 * direction + np.array([0.1, 0.2]), r"$\mathrm{dev}\,\tau_\mathrm{trial}$", BODY)
    place = 1.5 * direction + np.array([0.55, -0.2])
    label(left, place, r"$\beta\,\mathrm{dev}\,\tau_\mathrm{trial}$", FORCE, "left")
    label(left, (0, -0.95), r"$\sigma_y(\alpha_n)$")
    label(left, (0, -1.75), r"$\sigma_y(\alpha_n + \Delta\alpha)$")
    left.set_xlim(-2.1, 3.4)
    left.set_ylim(-2.0, 2.0)
    right.fill([0, 3, 3], [0, 1.2, -1.2], color=TOOL, lw=0)
    for sign in (1, -1):
        right.plot([0, 3], [0, sign * 1.2], color=DARK, lw=1.6)
    arrow(right, (-0.2, 0), (3.4, 0))
    arrow(right, (0, -1.6), (0, 1.9))
    label(right, (3.55, -0.15), "$p$")
    label(right, (-0.25, 1.8), "$t_t$")
    arrow(right, (1.4, 0.3), (2.1, 1.7), BODY)
    arrow(right, (2.1, 1.7), (2.1, 0.84), FORCE)
    dot(right, (1.4, 0.3))
    dot(right, (2.1, 0.84), FORCE)
    label(right, (1.1, 0.22), "$t_n$", BODY)
    label(right, (2.3, 1.8), "$t^*$", BODY)
    label(right, (2.45, 0.62), r"$\mu p\,t^*/|t^*|$", FORCE, "left")
    label(right, (2.6, -0.6), "stick")
    label(right, (2.9, -1.42), r"$|t_t| = \mu p$: slip")
    right.set_xlim(-0.6, 3.9)
    right.set_ylim(-1.7, 2.0)
    save(figure, folder, "return_map")


def main() -> None:
    """Draws all figures."""
    plt.rcParams.update({"svg.hashsalt": "billet", "svg.fonttype": "path", "mathtext.fontset": "cm"})
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent / "images"
    folder.mkdir(parents=True, exist_ok=True)
    for draw in (draw_gap, draw_frame, draw_facet, draw_return_maps):
        draw(folder)


if __name__ == "__main__":
    main()
