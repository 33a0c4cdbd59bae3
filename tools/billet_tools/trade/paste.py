# SPDX-License-Identifier: LGPL-2.1-or-later
"""Changes of a scene as lines to paste into it. Billet refuses a value that is set twice, so lines that the
scene has already are marked: they replace those."""

from __future__ import annotations

from typing import Any

from ..scene import Changes, Scene, scene_text


HOW = "To paste into the scene; lines with 'in place of' replace those that it has"


def lines_to_paste(changes: Changes, scene: Scene) -> str:
    """Returns the lines; entries that must go are named in a comment. Values that the scene has already are
    left out."""
    sections: dict[str, Any] = {}
    gone = []
    for path, value in changes.items():
        if value is None:
            gone += [path] if path in scene.entries else []
        elif scene.entries.get(path) != str(value):
            *names, key = path.split("/")
            place = sections
            for name in names:
                place = place.setdefault(name, {})
            old = scene.entries.get(path)
            place[key] = str(value) if old is None else f"{value}  # in place of {old or 'nothing'}"
    told = [f"# remove '{path.replace('/', ' / ')}' from the scene\n" for path in gone]
    return "".join(told) + (scene_text(sections) if sections else "")
