# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scenes at the extremes of every parameter: what billet makes of them, and whether it is right."""


class ExtremesError(Exception):
    """What the user can mend; the message says how."""
