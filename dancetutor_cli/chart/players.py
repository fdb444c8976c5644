"""Charts for several players: the steps of each player, as a chart for the pad on which the player stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.cells import Cells
from dancetutor_cli.chart.model import STEP_KINDS, Chart, Kind, NoteTable, RowTable
from dancetutor_cli.chart.names import is_routine

if TYPE_CHECKING:
    from dancetutor_cli.chart.note_data import NoteData

# In a couple chart, each player has a pad and half of the columns. In a routine, both players dance on one double pad,
# and `&` separates their notes. Two or more players also share a double pad if letters mark the player of each note.
# Such charts are StepF2's co-op, a pump-double, and a pump-routine without `&`. In them, all players' notes share rows.

# Steps type of a chart for several players -> steps type of the pad on which each player stands.
OWN_PADS = {"dance-couple": "dance-single", "pump-couple": "pump-single"}
ONE_PAD = {"dance-routine": "dance-double", "pump-routine": "pump-double", "smx-team": "smx-double10"}
PLAIN_COLOUR = 4  # the colour of plain notes in a chart with three letters
FOURTH_PLAYER_SHARE = 0.5  # share of the rarest letter's notes from which plain notes belong to a fourth player


def several_players_message(players: int, separator: str) -> str:
    """Return the message that a chart is for several players. separator : what tells their notes apart, with a verb"""
    return f"the chart is for {'two' if players == 2 else players} players ({separator}); each has feet of their own"


def letters_message(players: int, letters: bytes) -> str:
    """Return the message that letters mark the notes of several players."""
    marks = "X and Y" if len(letters) == 2 else "X, Y and Z"
    return several_players_message(players, f"{marks} mark their notes, as in StepF2")


def player_charts(chart: Chart, player: int | None = None) -> tuple[Chart, ...]:
    """Return the charts to find feet for: the chart itself or, for several players, the part of each or of one."""
    if not chart.players:
        return (chart,)
    return tuple(one for one in chart.players if player in (None, one.player))


def written_parts(chart: Chart) -> tuple[Chart, ...]:
    """Return the parts with their own rows in the file: the players' parts of a routine, otherwise the chart."""
    return chart.players if chart.steps_type in ONE_PAD and not chart.marked else (chart,)


def shares_rows(part: Chart) -> bool:
    """Whether the rows of a part also hold another player's notes: in a couple chart, or if letters mark players."""
    return part.written is not None and (part.marked or part.written.steps_type not in ONE_PAD)


def with_players(chart: Chart, read: NoteData, data: bytes) -> Chart:
    """Return a chart with its players' parts, if it is for several. read : its note data; data : bytes of the file"""
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
            warnings=chart.warnings if n == 0 else (),  # reported once
            player=n + 1,
            written=chart,
            first_column=0 if on_one_pad else n * columns,
        )
        for n, (notes, rows) in enumerate(tables)
    )
    return replace(chart, players=players)


def _columns(chart: Chart, data: bytes, first: int, count: int) -> tuple[NoteTable, RowTable]:
    """Return the notes in some columns, and the span of these columns in each row."""
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
    """Return the offsets of the letters of a row, without keysounds, `[...]`."""
    found, keysound = [], False
    for offset, letter in enumerate(row):
        if letter == ord("["):
            keysound = True
        elif not keysound:
            found.append(offset)
        if letter == ord("]"):
            keysound = False
    return found


# The parts of players whose notes are in the same rows and are marked by letters.


def notes_by_player(cells: Cells, marks: Mapping[tuple[int, int], int], columns: int, letters: bytes) -> list[Cells]:
    """Return the notes of each player, in the order of letters, left before right; mines are in all parts.

    Each of two players has the notes with their own letter, and the notes without a letter on their half of the pads.
    With a third letter, enough plain notes belong to a fourth player, as StepF2 colours them. Fewer plain notes go to
    the player who mostly steps that panel. A colour that is mostly on both pads at once belongs to two players, one on
    each pad. A player with only fakes has no part.

    marks : (tick, column) -> player whose letter is in that cell
    """
    places = zip(cells.tick.tolist(), cells.column.tolist(), strict=True)
    owner = np.array([marks.get(place, 0) for place in places], dtype=np.int64)
    right = (cells.column >= columns // 2).astype(np.int64)
    mine = cells.kind == Kind.MINE
    if len(letters) == 2:
        whose = np.where((owner == 1) | (owner == 2), owner, 1 + right)
        return [cells[(whose == player) | mine] for player in (1, 2)]
    step, plain = np.isin(cells.kind, STEP_KINDS), owner == 0
    colour = np.where(plain, PLAIN_COLOUR, owner)
    whose = 2 * colour + right * np.isin(colour, _of_two(colour[step], cells.tick[step], right[step]))
    counts = np.bincount(owner[step & ~plain], minlength=1)
    if (step & plain).sum() < FOURTH_PLAYER_SHARE * counts[counts > 0].min(initial=len(owner)) and counts.any():
        players = np.unique(whose[step & ~plain])
        steps = np.array([np.bincount(cells.column[step & (whose == one)], minlength=columns) for one in players])
        whose[plain] = players[steps.argmax(axis=0)][cells.column[plain]]
    everybodys = mine | (~step & plain)
    return [cells[(whose == player) | everybodys] for player in np.unique(whose[step]).tolist()]


def _of_two(colour: NDArray[np.int64], tick: NDArray[np.int64], right: NDArray[np.int64]) -> list[int]:
    """Return the colours of two players: those with steps on both pads in most of their rows."""
    found = []
    for one in np.unique(colour).tolist():
        left_rows, right_rows = (np.unique(tick[(colour == one) & (right == side)]) for side in (0, 1))
        both = len(np.intersect1d(left_rows, right_rows))
        if 2 * both > len(left_rows) + len(right_rows) - both:
            found.append(one)
    return found
