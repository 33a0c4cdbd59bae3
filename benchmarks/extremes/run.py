#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scenes at the extremes; --help says how. Wants numpy, matplotlib and VTK for Python."""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[2] / "tools")]

from extremes.command import run  # noqa: E402

if __name__ == "__main__":
    sys.exit(run(sys.argv[1:]))
