"""Feet in comments of the chart file: the letters of written rows, the styles `measure` and `rows`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.edits import Splice
from dancetutor_cli.chart.model import Chart
from dancetutor_cli.feet.annotations import StepRows, markers_in, measure_lines
from dancetutor_cli.feet.limbs import Limb, NotationError, Part, letter, marker, parse
from dancetutor_cli.feet.play import Play

# The common part of the styles of annotation: the request, the feet of a chart, and the files that would change.

MEASURE, ROWS, SIDECAR, SMEDITOR, EDIT, THEME = "measure", "rows", "sidecar", "smeditor", "edit", "theme"
TEXT = "text"  # what `measure` and `rows` are for a file that takes no comments
BACKGROUND = "background"  # no style of feet: what `render --background --into-file` has entered, to be taken out
FILE_STYLES = (SIDECAR, SMEDITOR, EDIT, THEME)  # styles that write files beside the chart file
UCS_STYLES = (TEXT, SIDECAR)  # those of a .ucs, into which nothing is written
STYLES = (MEASURE, ROWS, SIDECAR, SMEDITOR, EDIT, THEME)
STRIPPED = (*STYLES, BACKGROUND)


@dataclass(frozen=True, slots=True)
class ChartFeet:
    """A solved chart. rows : its written rows with steps; letters : of each of them, left to right."""

    chart: Chart
    rows: StepRows
    letters: tuple[str, ...]
    play: Play


@dataclass(frozen=True, slots=True)
class FileChange:
    """A file that is to become something else. old : None if it is not there; new : None to remove it."""

    path: Path
    old: bytes | None
    new: bytes | None

    @property
    def needed(self) -> bool:
        """Whether there is anything to do."""
        return self.old != self.new


@dataclass(frozen=True, slots=True)
class Lack:
    """Something that `--check` reports. line, column : 1-based place in the chart file, None: about another file."""

    message: str
    line: int | None = None
    column: int | None = None

    def at(self, path: Path) -> str:
        """For people: file, place and what is missing."""
        place = "".join(f":{n}" for n in (self.line, self.column) if n is not None)
        return f"{path}{place}: {self.message}"


# From a play to who presses each written step, and to the letters of every written row.

_LOW = min(Limb)
_LETTER = np.array(  # by (limb - _LOW) * len(Part) + part
    [ord(letter(limb, part)) for limb in range(_LOW, max(Limb) + 1) for part in Part], dtype=np.uint8
)


def limbs_of(chart: Chart, rows: StepRows, play: Play) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """`Limb` and `Part` of every cell of `rows`, each (n, c); `Limb.NONE` where there is no step that is judged."""
    limb = np.full(rows.steps.shape, int(Limb.NONE), dtype=np.int64)
    part = np.zeros(rows.steps.shape, dtype=np.int64)
    if not len(rows) or not len(play.rows):
        return limb, part
    tick = chart.rows.tick[rows.row]
    found = np.minimum(np.searchsorted(play.rows.tick, tick), len(play.rows) - 1)
    known = play.rows.tick[found] == tick
    columns = min(rows.steps.shape[1], play.limb.shape[1])
    limb[known, :columns] = play.limb[found[known], :columns]
    part[known, :columns] = play.part[found[known], :columns]
    limb[~rows.steps] = int(Limb.NONE)
    return limb, part


def row_letters(chart: Chart, rows: StepRows, play: Play) -> list[str]:
    """The letters of each row of `rows`, left to right; `.` for steps that nobody plays or that are not judged."""
    if not len(rows):
        return []
    limb, part = limbs_of(chart, rows, play)
    letters = _LETTER[(limb - _LOW) * len(Part) + part]
    flat = letters[rows.steps].tobytes().decode("ascii")
    ends = np.cumsum(rows.steps.sum(axis=1)).tolist()
    return [flat[a:b] for a, b in zip([0, *ends[:-1]], ends, strict=True)]


# The default style: one `{dt1 ...}` in a comment on the line that opens a measure.


class State(Enum):
    """The content of a file compared with what it should be."""

    CURRENT = "current"
    MISSING = "missing"
    STALE = "stale"  # tokens do not fit the rows
    DIFFERENT = "different"  # they fit, but say other feet
    PINNED = "pinned"
    IMPOSSIBLE = "impossible"  # rows stand on the line of the comma


@dataclass(frozen=True, slots=True)
class MeasureState:
    """One measure that has a marker or should have one. line : 1-based line of the comment."""

    measure: int
    line: int
    state: State


def write_measures(
    data: bytes, chart: Chart, rows: StepRows, letters: Sequence[str], force: bool = False
) -> tuple[list[Splice], list[MeasureState]]:
    """Replacements that bring the markers of a chart up to date, and how they were before.

    Parameters
    ----------
    data : the bytes of the chart's file
    rows, letters : its rows with steps, and the letters of each
    force : overwrite pinned measures too
    """
    wanted = _by_measure(chart, rows, letters)
    splices, states = [], []
    for line in measure_lines(data, chart):
        comment = data[line.start : line.end]
        tokens = wanted.pop(line.measure, None)
        if not comment and tokens is None:
            continue
        state = _state(comment, tokens, force)
        if state is not None:
            states.append(MeasureState(line.measure, int(chart.measures.line[line.measure]), state))
        if state in (State.PINNED, None):
            continue
        new = _with(comment, marker(tokens), force) if tokens else _without(comment, force)
        if new != comment:
            splices.append(Splice(line.start, line.end, new))
    states += (MeasureState(m, int(chart.measures.line[m]), State.IMPOSSIBLE) for m in wanted)
    return splices, states


def strip_measures(data: bytes, chart: Chart, force: bool = False) -> list[Splice]:
    """Replacements that take the markers of a chart out; pinned ones only with `force`."""
    splices = []
    for line in measure_lines(data, chart):
        comment = data[line.start : line.end]
        new = _without(comment, force)
        if new != comment:
            splices.append(Splice(line.start, line.end, new))
    return splices


def pinned(data: bytes, chart: Chart) -> int:
    """How many measures of a chart somebody has pinned."""
    comments = (data[line.start : line.end] for line in measure_lines(data, chart))
    return sum(any(match["pin"] for match in markers_in(comment)) for comment in comments)


def _by_measure(chart: Chart, rows: StepRows, letters: Sequence[str]) -> dict[int, list[str]]:
    wanted: dict[int, list[str]] = {}
    for measure, text in zip(chart.rows.measure[rows.row].tolist(), letters, strict=True):
        wanted.setdefault(measure, []).append(text)
    return wanted


def _state(comment: bytes, tokens: list[str] | None, force: bool) -> State | None:
    """None: no marker, and none is needed."""
    found = markers_in(comment)
    if not found:
        return State.MISSING if tokens else None
    if not force and any(m["pin"] for m in found):
        return State.PINNED
    if tokens and len(found) == 1 and found[0][0] == marker(tokens):
        return State.CURRENT
    try:
        shape = [len(token.letters) for token in parse(found[0]["text"])]
    except NotationError:
        return State.STALE
    return State.DIFFERENT if tokens and shape == [len(text) for text in tokens] else State.STALE


def _with(comment: bytes, text: bytes, force: bool) -> bytes:
    """The comment with its first marker replaced and no other; a marker added where there is none."""
    found = markers_in(comment)
    if not found:
        return comment + b" " + text if comment else b"//" + text
    first = found[0]
    rest = comment[first.end() :]
    if len(found) > 1:
        rest = _without(b"//" + rest, force)[2:]
    return comment[: first.start()] + text + rest


def _without(comment: bytes, force: bool) -> bytes:
    """The comment without markers; nothing of it is left if a marker was all there was."""
    while ours := [match for match in markers_in(comment) if force or not match["pin"]]:
        comment = _cut(comment, *ours[-1].span())  # what is left may make a marker of two halves, hence the loop
    return comment


def _cut(comment: bytes, start: int, end: int) -> bytes:
    """Take one marker and the one blank that joined it to other text out of a comment."""
    before, after = comment[:start], comment[end:]
    if before == b"//" and not after.strip(b" \t"):
        return after
    if before.endswith(b" "):
        return before[:-1] + after
    return before + after.removeprefix(b" ")


# The style `rows`: letters behind every row with a step, `1000//dtL`; the most readable, but not for Etterna.

WARNING = "Etterna joins rows that carry a comment with the next one; the style 'rows' is for other games and editors"
# Ours, directly behind the row; blanks that were there before, or the mark of an added chart, may follow.
_OURS = re.compile(rb"//dt[LRlr<>.]+(?=[ \t]*(?:\r?\n|\Z)|//\{dt1 edit\})")
_FREE = re.compile(rb"(?=[ \t]*(?:\r?\n|\Z))")


def write_rows(data: bytes, chart: Chart, rows: StepRows, letters: Sequence[str]) -> tuple[list[Splice], int]:
    """Replacements that put the letters behind the rows of a chart, and how many rows lack theirs now."""
    wanted = dict(zip(rows.row.tolist(), letters, strict=True))
    splices = []
    for row, end in enumerate(chart.rows.end.tolist()):
        ours = _OURS.match(data, end) if data[end : end + 4] == b"//dt" else None
        text = wanted.get(row)
        if ours is None and (text is None or not _FREE.match(data, end) or _own_line_end(data, chart, row)):
            continue
        new = b"" if text is None else b"//dt" + text.encode("ascii")
        if ours is None or ours[0] != new:
            splices.append(Splice(end, ours.end() if ours else end, new))
    return splices, len(splices)


def strip_rows(data: bytes, chart: Chart) -> list[Splice]:
    """Replacements that take the letters of a chart out."""
    return [Splice(start, end, b"") for start, end in _marker_spans(data, chart)]


def _marker_spans(data: bytes, chart: Chart) -> Iterator[tuple[int, int]]:
    for end in chart.rows.end.tolist():
        if data[end : end + 4] == b"//dt" and (match := _OURS.match(data, end)):
            yield match.span()


def _own_line_end(data: bytes, chart: Chart, row: int) -> bool:
    """Whether the row has a CR inside, which some readers take for the end of a line."""
    return b"\r" in data[chart.rows.start[row] : chart.rows.end[row]]
