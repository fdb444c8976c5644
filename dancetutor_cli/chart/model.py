"""The contents of a chart file: frozen data classes, made by the reader and used by every other package.

The position of every row is kept, for findings and for markers. Beats are counted in ticks of 1/48 beat
(`names.TICKS_PER_BEAT`), the grid of the games.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from dancetutor_cli.chart.timing import Timing


class Kind(IntEnum):
    """The kind of note in a cell of the note grid."""

    EMPTY = 0
    TAP = 1
    HOLD = 2  # head
    ROLL = 3  # head
    MINE = 4
    LIFT = 5
    FAKE = 6
    KEYSOUND = 7


STEP_KINDS = (Kind.TAP, Kind.HOLD, Kind.ROLL, Kind.LIFT)  # the kinds that a foot or hand steps on


@dataclass(frozen=True, slots=True)
class NoteTable:
    """All notes of a chart as arrays of one length n, sorted by (tick, column); tails are in `end`.

    tick : int64, 1/48 beats from beat 0
    column : int16, from 0
    kind : uint8, `Kind`, never EMPTY
    end : int64, tick of the tail for HOLD and ROLL, else -1
    line : int32, 1-based line of the note's row in the file
    judged : bool, False for fakes, keysounds and notes in a warp or a fake segment
    """

    tick: NDArray[np.int64]
    column: NDArray[np.int16]
    kind: NDArray[np.uint8]
    end: NDArray[np.int64]
    line: NDArray[np.int32]
    judged: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.tick)

    @property
    def last_tick(self) -> int:
        """Tick of the last note or tail; 0 without notes."""
        return max(int(self.tick.max(initial=0)), int(self.end.max(initial=0)))


@dataclass(frozen=True, slots=True)
class RowTable:
    """Every row of the note data as written, also the empty ones, in file order; arrays of one length.

    For routine charts (`&`), these are the rows of the first player; `Chart.players` has the rows of both.

    start, end : int64, byte span of the trimmed row text in `Song.data` (comment not included)
    line : int32, 1-based
    tick : int64, 1/48 beats
    measure : int32, from 0
    """

    start: NDArray[np.int64]
    end: NDArray[np.int64]
    line: NDArray[np.int32]
    tick: NDArray[np.int64]
    measure: NDArray[np.int32]


@dataclass(frozen=True, slots=True)
class MeasureTable:
    """Every measure of the note data; arrays of one length, index = measure number.

    anchor : int64, byte offset directly after the `:` or `,` that opens the measure
    line : int32, 1-based line of that `:` or `,`
    """

    anchor: NDArray[np.int64]
    line: NDArray[np.int32]


@dataclass(frozen=True, slots=True)
class ReadWarning:
    """An oddity that the reader ignored or corrected. `code` is a short stable name such as "short-row"."""

    code: str
    message: str
    line: int | None = None


@dataclass(frozen=True, slots=True)
class Chart:
    """One chart of a song.

    index : place among all charts of the file, from 0
    steps_type : lower case, e.g. "dance-single"
    difficulty : "Beginner", "Easy", "Medium", "Hard", "Challenge" or "Edit" as the games name it; but a second chart
        of one steps type and difficulty keeps its name (the games show one of them as an Edit)
    meter : never negative
    columns : number of columns of the steps type; 0 if the type is unknown
    notes_span : byte span of the note data value in `Song.data`, after `:` up to before `;`
    tags : the chart's own tags, upper-case name -> decoded value (the first value only)
    players : the part of each player of a chart for several players, see `chart.note_data`; else empty
    player : for a player's part, the number of the player, from 1, else 0
    written : for a player's part, the whole chart, without `players`, else None
    first_column : for a player's part, the first column of the part in the whole chart
    marked : whether the rows use other letters than the plain notation: those of players (StepF2) or of a .ucs file
    """

    index: int
    steps_type: str
    difficulty: str
    meter: int
    description: str
    columns: int
    notes: NoteTable
    rows: RowTable
    measures: MeasureTable
    timing: Timing
    notes_span: tuple[int, int]
    line: int
    tags: dict[str, str]
    warnings: tuple[ReadWarning, ...]
    players: tuple[Chart, ...] = ()
    player: int = 0
    written: Chart | None = None
    first_column: int = 0
    marked: bool = False

    @property
    def written_type(self) -> str:
        """The steps type in the file; for a player of a couple chart "dance-couple", although the pad is single."""
        return self.steps_type if self.written is None else self.written.steps_type

    @property
    def label(self) -> str:
        """The chart's name in messages: "dance-single Hard 8", or for one of two players "dance-couple Hard 8 P2"."""
        whose = f" P{self.player}" if self.player else ""
        return f"{self.written_type} {self.difficulty} {self.meter}{whose}"


@dataclass(frozen=True, slots=True)
class Song:
    """One .sm, .ssc or .ucs file. `data` has its bytes, from which everything else is read.

    encoding : "ascii", "utf-8", "utf-8-sig", or a guess: "cp932", "cp949", "cp1252"
    title, subtitle, artist, music : on one line and safe to print (no control characters, no terminal escapes)
    tags : upper-case name -> first value, decoded, safe to print apart from line breaks; of several tags with the same
    name, the last
    """

    path: Path
    format: str  # "sm", "ssc" or "ucs"
    data: bytes
    encoding: str
    title: str
    subtitle: str
    artist: str
    music: str
    tags: dict[str, str]
    timing: Timing  # the timing of the song, without split timing
    charts: tuple[Chart, ...]
    warnings: tuple[ReadWarning, ...]
