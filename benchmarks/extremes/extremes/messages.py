# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether what billet says of a refusal or a failure helps: where, what and why, and what to do."""

from __future__ import annotations

import re

WHERE = re.compile(r"scene\.prm(:\d+)?:|command line:")
WHEN = re.compile(r"\b(time|step)\b")
TODO = re.compile(
    r"\b(allowed (is|are)|[Tt]ry (a|an|another|the|'|more|less|it|one|some)|[Ll]et"
    r" |(Reduce|Increase|Choose|Use|Set|Check|Add|Support) )"
)
WORTHLESS = re.compile(r"(?<![\w'])-?(nan|inf)\b", re.IGNORECASE)


def reason(stderr: str) -> str:
    said = re.sub(r"-{40,}.*?-{40,}", "", stderr, flags=re.DOTALL)
    return re.sub(r"^error\[[\w-]+\]: ", "", re.sub(r"\s+", " ", said).strip())


def lacks(code: int, said: str) -> list[str]:
    """What a message has not that it should have; nothing, where it is a help."""
    missing = []
    if not said:
        return ["any message"]
    if not WHERE.search(said):
        missing.append("where")
    if code == 3 and not WHEN.search(said):
        missing.append("when")
    if not TODO.search(said):
        missing.append("what to do")
    if WORTHLESS.search(said) and "' is" not in said:
        missing.append("a number")
    return missing
