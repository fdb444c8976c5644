"""Edits of a chart file: replaced bytes, their diff, the check that readers still see the same song; notes as bytes."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.hash import COMMENT, hash_input
from dancetutor_cli.chart.model import Chart, Kind, NoteTable, RowTable, Song
from dancetutor_cli.chart.msd import decode_text, encoding_of
from dancetutor_cli.chart.names import TICKS_PER_MEASURE
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.run.errors import FileError


@dataclass(frozen=True, slots=True, order=True)
class Splice:
    """A replacement of `data[start:end]` by `text`.

    Replacements are sorted by place, and several insertions at one place by their text. So the edited file does not
    depend on the order in which its edits were planned.
    """

    start: int
    end: int
    text: bytes


def apply(data: bytes, splices: Iterable[Splice]) -> bytes:
    """Return `data` with all replacements made. They must not overlap."""
    out: list[bytes] = []
    at = 0
    for splice in sorted(splices):
        if splice.start < at:
            raise ValueError(f"replacements overlap at byte {splice.start}")
        out += (data[at : splice.start], splice.text)
        at = splice.end
    out.append(data[at:])
    return b"".join(out)


# A unified diff of two versions of a file that differ in some lines, and in lines added or removed at one place.
#
# Lines are compared one to one, from the start and, if the numbers of lines differ, also from the end. That is fast.
# It is exact unless lines were added or removed at several places; then it is longer than necessary.

CONTEXT = 3


def unified_diff(name: str, old: bytes | None, new: bytes | None) -> Iterator[str]:
    """Yield the lines of the diff, without line breaks; none if both versions are the same."""
    pairs = _pairs(_lines(old), _lines(new))
    different = [i for i, (a, b) in enumerate(pairs) if a != b]
    if not different:
        return
    encoding = encoding_of(old or new or b"")
    yield f"--- {'/dev/null' if old is None else name}"
    yield f"+++ {'/dev/null' if new is None else name}"
    for start, end in _hunks(different, len(pairs)):
        part = pairs[start:end]
        starts, counts = ([sum(p[side] is not None for p in some) for side in (0, 1)] for some in (pairs[:start], part))
        yield f"@@ -{_range(starts[0], counts[0])} +{_range(starts[1], counts[1])} @@"
        yield from _body(part, encoding)


def _pairs(old: list[bytes], new: list[bytes]) -> list[tuple[bytes | None, bytes | None]]:
    """Return the lines of both versions side by side; None where a version has no such line."""
    same, most = 0, min(len(old), len(new)) * (len(old) != len(new))
    while same < most and old[-1 - same] == new[-1 - same]:
        same += 1
    middle = zip_longest(old[: len(old) - same], new[: len(new) - same])
    return [*middle, *zip(old[len(old) - same :], new[len(new) - same :], strict=True)]


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
            yield " " + _display_line(a, encoding)
        else:
            removed += [] if a is None else ["-" + _display_line(a, encoding)]
            added += [] if b is None else ["+" + _display_line(b, encoding)]
    yield from (*removed, *added)


def _display_line(line: bytes | None, encoding: str) -> str:
    return decode_text((line or b"").removesuffix(b"\r"), encoding).replace("\r", " ")


_BPMS = re.compile(rb"#BPMS:([^;]*)", re.IGNORECASE)


class HarmError(FileError):
    """An edit that is not written, because games would read another song: a bug of the program, or a very odd file."""


def check_edit(
    before: Song, after: bytes, ours: Callable[[Chart], bool] = lambda chart: False, free: Collection[str] = ()
) -> Song:
    """Read `after` and compare it with the song from which it was made.

    Parameters
    ----------
    before : the song as it was read
    after : the bytes that will replace the file
    ours : whether the program has added a chart, which is then not compared
    free : names of the song's tags that may differ

    Returns the song read from `after`. Raises `HarmError` with the first difference.
    """
    try:
        song = parse(after, before.path)
    except FileError as error:
        raise _harm(before.path, error.message) from error
    for what in _differences(before, song, ours, free):
        raise _harm(before.path, f"{what} would change")
    return song


def _harm(path: Path, what: str) -> HarmError:
    return HarmError(path, f"refused, nothing was written: {what}; please report this file")


def _differences(before: Song, after: Song, ours: Callable[[Chart], bool], free: Collection[str]) -> Iterator[str]:
    for name in ("format", "title", "subtitle", "artist", "music", "timing"):
        if getattr(before, name) != getattr(after, name):
            yield f"the song's {name}"
    tags = ({key: value for key, value in song.tags.items() if key not in free} for song in (before, after))
    if next(tags) != next(tags):
        yield "the song's tags"
    old, new = ([c for c in song.charts if not ours(c)] for song in (before, after))
    if len(old) != len(new):
        yield "the number of charts"
    for a, b in zip(old, new, strict=False):
        for name in ("steps_type", "difficulty", "meter", "description", "columns", "timing", "tags"):
            if getattr(a, name) != getattr(b, name):
                yield f"the {name.replace('_', ' ')} of {a.label}"
        if not _same_notes(a.notes, b.notes) or not _same_rows(a.rows, b.rows):
            yield f"the note data of {a.label}"
        if hash_input(before, a) != hash_input(after, b):
            yield f"the score hash of {a.label}"
    if _bpms(before.data) != _bpms(after.data)[: len(_bpms(before.data))]:
        yield "the BPMs"


def _same_notes(a: NoteTable, b: NoteTable) -> bool:
    names = ("tick", "column", "kind", "end", "judged")
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in names)


def _same_rows(a: RowTable, b: RowTable) -> bool:
    return np.array_equal(a.tick, b.tick) and np.array_equal(a.measure, b.measure)


def _bpms(data: bytes) -> list[bytes]:
    return [re.sub(rb"\s+", b"", COMMENT.sub(b"", text)) for text in _BPMS.findall(data)]


# Notes as the note data of a .sm or .ssc file: each measure in as few rows as hold all its notes.

_LETTER = {
    Kind.TAP: b"1", Kind.HOLD: b"2", Kind.ROLL: b"4", Kind.MINE: b"M", Kind.LIFT: b"L", Kind.FAKE: b"F",
    Kind.KEYSOUND: b"K",
}  # fmt: skip
_TAIL = b"3"
_ROW_COUNTS = (4, 8, 12, 16, 24, 32, 48, 64, 96, 192)  # the row counts that the games' editors write


def write_notes(notes: NoteTable, columns: NDArray[Any], width: int, eol: bytes) -> bytes:
    """Return rows and commas, each line with `eol`; no `;` at the end.

    columns : the column of each note, (n,), from 0; width : letters of a row
    """
    cells: dict[int, dict[int, bytes]] = {}

    def put(tick: int, column: int, letter: bytes) -> None:
        cells.setdefault(tick // TICKS_PER_MEASURE, {})[(tick % TICKS_PER_MEASURE) * width + column] = letter

    table = zip(notes.tick.tolist(), columns.tolist(), notes.kind.tolist(), notes.end.tolist(), strict=True)
    for tick, column, kind, end in table:
        put(tick, column, _LETTER[Kind(kind)])
        if kind in (Kind.HOLD, Kind.ROLL):
            put(end, column, _TAIL)
    measures = (_measure(cells.get(m, {}), width, eol) for m in range(max(cells, default=0) + 1))
    return (b"," + eol).join(measures)


def _measure(cells: dict[int, bytes], width: int, eol: bytes) -> bytes:
    """Return the rows of one measure. cells : {tick in the measure * width + column: letter}"""
    count = _rows_needed(place // width for place in cells)
    grid = bytearray(b"0" * (count * width))
    for place, letter in cells.items():
        row = (place // width) * count // TICKS_PER_MEASURE
        grid[row * width + place % width : row * width + place % width + 1] = letter
    return b"".join(bytes(grid[i : i + width]) + eol for i in range(0, len(grid), width))


def _rows_needed(ticks: Iterable[int]) -> int:
    used = set(ticks)
    return next(n for n in _ROW_COUNTS if all(tick * n % TICKS_PER_MEASURE == 0 for tick in used))
