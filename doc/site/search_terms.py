# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: search_terms.py searchindex.js

Checks that the site's search finds what users of other programs look for. A page counts if it has all words.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

from sphinx.search.en import SearchEnglish

TERMS = (
    "augmented Lagrangian",
    "chatter",
    "convergence",
    "hourglass",
    "penalty",
    "reduced integration",
    "rigid body",
    "springback",
    "warning",
)


def main() -> int:
    """Returns the exit code."""
    text = Path(sys.argv[1]).read_text(encoding="utf-8")
    index = json.loads(re.sub(r"^Search\.setIndex\(|\)$", "", text.strip()))
    language = SearchEnglish({})

    def pages_with(word: str) -> set[int]:
        stem = language.stem(word.lower())
        found: set[int] = set()
        for kind in ("terms", "titleterms"):
            pages = index[kind].get(stem, [])
            found |= set(pages) if isinstance(pages, list) else {pages}
        return found

    lacks = [term for term in TERMS if not set.intersection(*(pages_with(word) for word in term.split()))]
    for term in lacks:
        print(f"search finds no page with '{term}'")
    return 1 if lacks else 0


if __name__ == "__main__":
    sys.exit(main())
