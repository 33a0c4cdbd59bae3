# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scenes at the extremes of every parameter: what billet makes of them, and whether it is right."""
