# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points and curves of a fit."""

from __future__ import annotations

from pathlib import Path
from typing import Sequence

import matplotlib
import numpy

matplotlib.use("Agg")

from matplotlib import pyplot  # noqa: E402  after the choice of a back end without a display

from .data import Data  # noqa: E402
from .fitting import Fit  # noqa: E402


def draw(data: Data, fits: Sequence[Fit], file: Path) -> None:
    """Draws nominal stress over stretch, one panel for each mode."""
    figure, panels = pyplot.subplots(1, len(data), figsize=(4.5 * len(data), 4), squeeze=False)
    for panel, (mode, points) in zip(panels[0], data.items()):
        panel.plot(points.stretches, points.stresses, "ko", markersize=4, label="measured")
        low, high = min(points.stretches.min(), 1.0), max(points.stretches.max(), 1.0)
        stretches = numpy.linspace(low, high, 200)
        for fit in fits:
            label = f"{fit.law.name}, {100 * fit.error:.2g} %"
            panel.plot(stretches, fit.law.stress(mode, stretches), label=label)
        panel.set_title(mode)
        panel.set_xlabel("stretch")
        panel.grid(alpha=0.3)
    panels[0][0].set_ylabel("nominal stress")
    panels[0][0].legend(fontsize="small")
    figure.tight_layout()
    figure.savefig(file, dpi=120)
    pyplot.close(figure)
