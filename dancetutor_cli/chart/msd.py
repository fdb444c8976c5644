"""Scanner of the games' file format: bytes -> tags with the byte span of every value (`#TAG:value:value;`)."""

from __future__ import annotations

import re
from dataclasses import dataclass

_TOKEN = re.compile(rb"//[^\n]*|\\.?|[#:;]", re.DOTALL)
_COMMENT = re.compile(rb"//[^\n]*")


@dataclass(frozen=True, slots=True)
class Tag:
    """One `#NAME:...;`. name : upper case; spans : byte span of each value; start : offset of the `#`."""

    name: str
    start: int
    spans: tuple[tuple[int, int], ...]


def scan(data: bytes) -> list[Tag]:
    """All tags of a file in order. A missing `;` is made up for where the games do; text between tags is dropped."""
    tags: list[Tag] = []
    begin = -1  # offset of the '#' of the open tag, -1 between tags
    params: list[tuple[int, int]] = []
    start = 0

    def close(end: int) -> None:
        params.append((start, end))
        (a, b), *values = params
        name = decode(without_comments(data[a:b])).strip().upper()
        tags.append(Tag(name, begin, tuple(values)))
        params.clear()

    for match in _TOKEN.finditer(data):
        at, token = match.start(), data[match.start()]
        if token in b"/\\":
            continue
        if begin < 0:
            if token == 35:  # '#'
                begin, start = at, at + 1
        elif token == 35:
            if _first_on_line(data, start, at):
                close(at)
                begin, start = at, at + 1
        else:
            if token == 59:  # ';'
                close(at)
                begin = -1
            else:
                params.append((start, at))
                start = at + 1
    if begin >= 0:
        close(len(data))
    return tags


def _first_on_line(data: bytes, start: int, at: int) -> bool:
    j = at
    while j > start and data[j - 1] in b" \t":
        j -= 1
    return j == start or data[j - 1] in b"\r\n"


def without_comments(value: bytes) -> bytes:
    """The value with `//` comments dropped (their LF stays) and `\\` escapes resolved."""
    if b"//" in value:
        value = _COMMENT.sub(b"", value)
    return re.sub(rb"\\(.)", rb"\1", value, flags=re.DOTALL) if b"\\" in value else value


def decode(text: bytes) -> str:
    """Text for display: UTF-8 if it is, else the legacy encoding that fits; control characters are left out."""
    for encoding in ("utf-8", "cp932", "cp949", "cp1252"):
        try:
            decoded = text.decode(encoding)
            break
        except UnicodeDecodeError:
            continue
    else:
        decoded = text.decode("latin-1")
    return "".join(c for c in decoded if c.isprintable() or c in "\n\t").strip("\ufeff")
