# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adds the folder of the modules to the path."""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[2] / "tools")]
