"""A unified diff of two versions of a file that differ in some lines and in what is added at the end.

Markers never add a line in the middle of a file, so lines are compared one to one: exact and quick on any size.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest

from dancetutor_cli.chart.decoding import decode, encoding_of

CONTEXT = 3


def unified(name: str, old: bytes | None, new: bytes | None) -> Iterator[str]:
    """The lines of the diff, without line ends; nothing if both are the same."""
    pairs = list(zip_longest(_lines(old), _lines(new)))
    different = [i for i, (a, b) in enumerate(pairs) if a != b]
    if not different:
        return
    encoding = encoding_of(old or new or b"")
    yield f"--- {'/dev/null' if old is None else name}"
    yield f"+++ {'/dev/null' if new is None else name}"
    for start, end in _hunks(different, len(pairs)):
        part = pairs[start:end]
        counts = [sum(1 for pair in part if pair[side] is not None) for side in (0, 1)]
        yield f"@@ -{_range(start, counts[0])} +{_range(start, counts[1])} @@"
        yield from _body(part, encoding)


def _lines(data: bytes | None) -> list[bytes]:
    lines = (data or b"").split(b"\n")
    return lines[:-1] if not lines[-1] else lines


def _hunks(different: list[int], total: int) -> Iterator[tuple[int, int]]:
    start, end = different[0], different[0] + 1
    for i in different[1:]:
        if i - end > 2 * CONTEXT:
            yield max(start - CONTEXT, 0), min(end + CONTEXT, total)
            start = i
        end = i + 1
    yield max(start - CONTEXT, 0), min(end + CONTEXT, total)


def _range(start: int, count: int) -> str:
    return f"{start + 1 if count else start},{count}"


def _body(pairs: list[tuple[bytes | None, bytes | None]], encoding: str) -> Iterator[str]:
    removed: list[str] = []
    added: list[str] = []
    for a, b in pairs:
        if a == b:
            yield from (*removed, *added)
            removed, added = [], []
            yield " " + _shown(a, encoding)
        else:
            removed += [] if a is None else ["-" + _shown(a, encoding)]
            added += [] if b is None else ["+" + _shown(b, encoding)]
    yield from (*removed, *added)


def _shown(line: bytes | None, encoding: str) -> str:
    return decode((line or b"").removesuffix(b"\r"), encoding).replace("\r", " ")
