"""Text of other people's files, made safe to print: no control characters, no escapes, one line."""

from __future__ import annotations

import os
import re

# Controls (C0, DEL, C1), line and paragraph separators, and what turns the direction of text round.
_UNSAFE = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\u200e\u200f\u202a-\u202e\u2066-\u2069\ufeff\ufffe\uffff]+")


def safe(text: str) -> str:
    """`text` on one line, without what could move a cursor, change a colour or hide text."""
    return _UNSAFE.sub(" ", text).encode("utf-8", "replace").decode("utf-8").strip()


def safe_path(path: str) -> str:
    """A path to print: as `safe`, and bytes that are no UTF-8 become "�"."""
    try:
        name = os.fsencode(path)
    except UnicodeEncodeError:  # a name out of a cache that was written where names have more letters
        name = path.encode("utf-8", "surrogateescape")
    return _UNSAFE.sub("?", name.decode("utf-8", "replace"))
