# SPDX-License-Identifier: LGPL-2.1-or-later
"""billet-trade: what accuracy costs in a scene of billet, knob by knob. doc/manual.md tells how to use it.

scene     the text of a scene: reading, looking up, variants
knobs     what can be turned, and what the reference turns
runs      running billet, and keeping what came out
results   what a run gave: history, fields, and the outputs whose errors count
measure   pure: norms, Richardson extrapolation, Pareto front, the choice
report    table, CSV and words; picture draws
command   the command line, and the order of things
"""


class TradeError(Exception):
    """What the user is told, and the exit code: 2 for bad input, 3 where no answer could be reached."""

    def __init__(self, message, code=2):
        super().__init__(message)
        self.code = code
