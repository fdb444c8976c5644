"""The style `rows`: letters behind every row with a step, `1000//dtL`; the most readable, but not for Etterna."""

from __future__ import annotations

import re
from collections import Counter

from dancetutor_cli.chart.edits import Splice
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.markers.model import ChartFeet, CheckLine, NoteChange

WARNING = (
    "Etterna misreads rows with a comment: it joins them with the next row; "
    "use --markers rows only for other games and editors"
)
# This program's letters, directly after the row; older blanks or the mark of an added chart may follow.
_OURS = re.compile(rb"//dt[LRlr<>.]+(?=[ \t]*(?:\r?\n|\Z)|//\{dt1 edit\})")
_FREE = re.compile(rb"(?=[ \t]*(?:\r?\n|\Z))")


def write(song: Song, feet: ChartFeet, force: bool) -> NoteChange:
    """Write the letters after the rows of a chart; `force` has no effect, because rows cannot be pinned."""
    data, chart = song.data, feet.chart
    wanted = dict(zip(feet.rows.row.tolist(), feet.letters, strict=True))
    splices = []
    for row, end in enumerate(chart.rows.end.tolist()):
        ours = _OURS.match(data, end) if data[end : end + 4] == b"//dt" else None
        text = wanted.get(row)
        if ours is None and (text is None or not _FREE.match(data, end) or _has_cr(data, chart, row)):
            continue
        new = b"" if text is None else b"//dt" + text.encode("ascii")
        if ours is None or ours[0] != new:
            splices.append(Splice(end, ours.end() if ours else end, new))
    lacks = [CheckLine(f"{chart.label}: {len(splices)} rows have no letters", chart.line)] if splices else []
    return NoteChange(splices, Counter(rows=len(feet.rows)), lacks)


def strip(song: Song, chart: Chart, force: bool) -> NoteChange:
    """Remove the letters of a chart."""
    data = song.data
    ends = (end for end in chart.rows.end.tolist() if data[end : end + 4] == b"//dt")
    return NoteChange([Splice(*match.span(), b"") for end in ends if (match := _OURS.match(data, end))])


def _has_cr(data: bytes, chart: Chart, row: int) -> bool:
    """Whether the row contains a CR, at which some readers end the line."""
    return b"\r" in data[chart.rows.start[row] : chart.rows.end[row]]
