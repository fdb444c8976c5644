"""Scanner of the games' file format: bytes -> tags with the byte span of every value (`#TAG:value:value;`)."""

from __future__ import annotations

import re
from dataclasses import dataclass

# Each branch begins with a letter of its own, so that the search for the next one skips the rest quickly.
_TOKEN = re.compile(rb"//[^\n]*|\\.?|##*|:|;", re.DOTALL)
_MOST_VALUES = 4096  # of one tag; games read the first few; of more only the last is kept
_COMMENT_OR_ESCAPE = re.compile(rb"//[^\n]*|\\(.?)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Tag:
    """One `#NAME:...;`. name : upper case; spans : byte span of each value; start : offset of the `#`."""

    name: str
    start: int
    spans: tuple[tuple[int, int], ...]


def scan(data: bytes) -> list[Tag]:
    """All tags of a file in order. A missing `;` is made up for where the games do; text between tags is dropped.

    So is a tag with neither name nor value: a file may hold millions of them.
    """
    tags: list[Tag] = []
    params: list[tuple[int, int]] = []
    begin = -1  # offset of the '#' of the open tag, -1 between tags
    start = 0  # where the open value starts
    for match in _TOKEN.finditer(data):
        at = match.start()
        token = data[at]
        if token == 35:  # '#'
            # Of several in a row each ends the tag of the one before, which has no name; where none counts, none does.
            if begin < 0:
                begin, start = match.end() - 1, match.end()
            elif _first_on_line(data, start, at):
                _end(tags, data, begin, params, (start, at))
                params, begin, start = [], match.end() - 1, match.end()
        elif begin >= 0 and token in b":;":
            if token == 59:  # ';'
                _end(tags, data, begin, params, (start, at))
                params, begin = [], -1
            elif len(params) < _MOST_VALUES:
                params.append((start, at))
            start = at + 1
    if begin >= 0:
        _end(tags, data, begin, params, (start, len(data)))
    return tags


def _end(tags: list[Tag], data: bytes, begin: int, params: list[tuple[int, int]], last: tuple[int, int]) -> None:
    """Add the tag that ends with the value `last`, if there is anything in it."""
    (a, b), *values = (*params, last)
    name = plain(data[a:b]).decode("latin-1").upper()
    if values or name.strip():
        tags.append(Tag(name, begin, tuple(values)))


def _first_on_line(data: bytes, start: int, at: int) -> bool:
    """Whether only blanks stand between the `#` at an offset and the start of its line or of the open value."""
    j = at
    while j > start and data[j - 1] in b" \t":
        j -= 1
    return j == start or data[j - 1] in b"\r\n"


def plain(value: bytes) -> bytes:
    """The value as the games see it: `//` comments dropped (their LF stays), `\\` escapes resolved."""
    if b"//" in value or b"\\" in value:
        return _COMMENT_OR_ESCAPE.sub(lambda match: match[1] or b"", value)
    return value


def blanked(value: bytes) -> tuple[bytes, frozenset[int]]:
    """The value at its length: comments and escaping `\\` as blanks; and the offsets of those `\\`.

    A `\\` is no character of its row: whoever looks at single characters must leave out these offsets.
    """
    if b"//" not in value and b"\\" not in value:
        return value, frozenset()
    escapes: list[int] = []

    def blank(match: re.Match[bytes]) -> bytes:
        if match[0][:1] == b"/":
            return b" " * len(match[0])
        escapes.append(match.start())
        return b" " + match[1]

    return _COMMENT_OR_ESCAPE.sub(blank, value), frozenset(escapes)
