# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files that keep what was computed, under names that say of what."""

from __future__ import annotations

import hashlib
import json
import os
import threading
from pathlib import Path
from typing import Any


def hash_of(*parts: str | bytes) -> str:
    """Returns the hash of these parts, in hexadecimal digits."""
    whole = b"\0".join(part.encode() if isinstance(part, str) else part for part in parts)
    return hashlib.sha256(whole).hexdigest()


def hash_of_file(file: Path) -> str:
    """Returns the hash of the contents, in hexadecimal digits."""
    return hash_of(file.read_bytes())


def read_json(file: Path) -> Any:
    """Returns what the file keeps, None if there is no such file or it is not whole."""
    try:
        return json.loads(file.read_text())
    except (OSError, ValueError):
        return None


def write_json(file: Path, value: Any) -> None:
    """Writes the file whole, or not at all."""
    unfinished = file.with_suffix(f".{os.getpid()}.{threading.get_ident()}")
    unfinished.write_text(json.dumps(value, indent=1))
    os.replace(unfinished, file)
