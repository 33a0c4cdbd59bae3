# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adds the folder of billet-trade's modules to the path."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
TRADE = ROOT / "tools/billet-trade"
sys.path.insert(0, str(ROOT / "tools"))
