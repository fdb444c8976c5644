"""Charts for several: what each player steps, as a chart of the pad that this player stands on.

In a couple chart each has a pad of one's own, and half of the columns. In a routine both dance on one double pad, and
`&` parts the notes of the first from those of the second. So they do where letters mark whose a note is (StepF2's
co-op, in pump-double, and in a pump-routine without `&`): there the notes of all, two or more, stand in the same rows.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dancetutor_cli.chart.model import Chart, NoteTable, RowTable
from dancetutor_cli.chart.names import is_routine
from dancetutor_cli.chart.note_data import NoteData

# Steps type of a chart for two -> that of the pad on which each of them stands.
OWN_PADS = {"dance-couple": "dance-single", "pump-couple": "pump-single"}
ONE_PAD = {"dance-routine": "dance-double", "pump-routine": "pump-double"}


def parts(chart: Chart, player: int | None = None) -> tuple[Chart, ...]:
    """What feet are found for: the chart itself, or of one for several each player's part, or that of one player."""
    if not chart.players:
        return (chart,)
    return tuple(one for one in chart.players if player in (None, one.player))


def written_parts(chart: Chart) -> tuple[Chart, ...]:
    """What has rows of its own in the file: of a routine each player's part, else the chart."""
    return chart.players if chart.steps_type in ONE_PAD and not chart.marked else (chart,)


def shares_rows(part: Chart) -> bool:
    """Whether another player's notes stand in the rows of a part: of a couple, or where letters mark whose they are."""
    return part.written is not None and (part.marked or part.written.steps_type not in ONE_PAD)


def with_players(chart: Chart, read: NoteData, data: bytes) -> Chart:
    """The chart with the parts of its players, if it is for several. read : its note data; data : bytes of its file"""
    if chart.steps_type in OWN_PADS:
        half = chart.columns // 2
        tables = [_columns(chart, data, first, half) for first in (0, half)]
        columns = half
        pad = OWN_PADS[chart.steps_type]
    elif read.players and (chart.steps_type in ONE_PAD or not is_routine(chart.steps_type)):
        tables = [(own.notes, own.rows) for own in read.players]
        columns = chart.columns
        pad = ONE_PAD.get(chart.steps_type, chart.steps_type)
        chart = replace(chart, marked=read.marked)
    else:
        return chart
    on_one_pad = chart.steps_type not in OWN_PADS
    players = tuple(
        replace(
            chart,
            steps_type=pad,
            columns=columns,
            notes=notes,
            rows=rows,
            measures=read.players[n].measures if on_one_pad else chart.measures,
            warnings=chart.warnings if n == 0 else (),  # told once
            player=n + 1,
            written=chart,
            first_column=0 if on_one_pad else n * columns,
        )
        for n, (notes, rows) in enumerate(tables)
    )
    return replace(chart, players=players)


def _columns(chart: Chart, data: bytes, first: int, count: int) -> tuple[NoteTable, RowTable]:
    """The notes in some columns, and the part of each row that they stand in."""
    notes, rows = chart.notes, chart.rows
    ours = (notes.column >= first) & (notes.column < first + count)
    table = NoteTable(
        notes.tick[ours],
        (notes.column[ours] - first).astype(np.int16),
        notes.kind[ours],
        notes.end[ours],
        notes.line[ours],
        notes.judged[ours],
    )
    start, end = np.minimum(rows.start + first, rows.end), np.minimum(rows.start + first + count, rows.end)
    for row in np.flatnonzero(rows.end - rows.start != chart.columns).tolist():
        places = [*_places(data[int(rows.start[row]) : int(rows.end[row])]), int(rows.end[row] - rows.start[row])]
        start[row] = rows.start[row] + places[min(first, len(places) - 1)]
        end[row] = rows.start[row] + places[min(first + count, len(places) - 1)]
    return table, RowTable(start, end, rows.line, rows.tick, rows.measure)


def _places(row: bytes) -> list[int]:
    """Offsets of the letters of a row; keysounds, `[...]`, stand between them."""
    found, keysound = [], False
    for offset, letter in enumerate(row):
        if letter == ord("["):
            keysound = True
        elif not keysound:
            found.append(offset)
        if letter == ord("]"):
            keysound = False
    return found
