# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limits a study in runs or in elapsed seconds."""

from __future__ import annotations

import math
import re
import threading
import time

from .. import UserError

UNITS = {"s": 1.0, "second": 1.0, "min": 60.0, "minute": 60.0, "h": 3600.0, "hour": 3600.0}


class Budget:
    """Grants runs until they, or the seconds, are used up. Without a text it grants all."""

    def __init__(self, text: str | None = None) -> None:
        self.text = text
        self.runs = self.seconds = math.inf
        self._lock = threading.Lock()
        self._begin = time.monotonic()
        if text is not None:
            self._read(text)

    def _read(self, text: str) -> None:
        match = re.fullmatch(r"\s*(\d+(?:\.\d*)?|\.\d+)\s*([a-z]+)\s*", text)
        value = float(match[1]) if match else 0.0
        unit = match[2] if match else ""
        if unit in ("run", "runs") and value >= 1 and value == int(value):
            self.runs = value
            return
        factor = UNITS.get(unit) or UNITS.get(unit.rstrip("s"))
        if not value > 0 or factor is None:
            raise UserError(
                f"--budget is '{text}'; allowed are times and runs: 20 minutes, 90 s, 2 h, 30 runs"
            )
        self.seconds = value * factor

    @property
    def is_of_runs(self) -> bool:
        """Returns whether all runs cost the same."""
        return math.isfinite(self.runs)

    @property
    def is_limited(self) -> bool:
        return self.text is not None

    def seconds_left(self) -> float:
        return self.seconds - (time.monotonic() - self._begin)

    def take(self, expected: float, runs: int = 1) -> bool:
        """Returns whether runs of `expected` seconds together fit into the budget; if they do, counts
        them."""
        with self._lock:
            if runs > self.runs or expected > self.seconds_left():
                return False
            self.runs -= runs
            return True
