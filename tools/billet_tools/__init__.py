# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools around the program billet, which know it by its command line and its files alone.

scene     the text of a scene: reading, looking up, variants
program   the program, and how it is run and measured
output    what a run writes: history, estimates of errors, fields
records   the messages of a run
kept      files that keep what was computed
text      numbers, tables and sentences of pages
trade     billet-trade: what accuracy costs in a scene
fit       billet-fit: constants of laws of rubber

All but output, trade and fit do with Python's own library.
"""

from __future__ import annotations


class UserError(Exception):
    """Error message for the user, with the exit code: 2 for bad input, 3 if no answer could be reached."""

    def __init__(self, message: str, code: int = 2) -> None:
        super().__init__(message)
        self.code = code
