"""What a rule looks at: a file, or one chart with its play, and where things stand in them."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT, TICKS_PER_MEASURE, Chart, Song
from dancetutor_cli.feet import FeetProblem, Ignores, Overrides
from dancetutor_cli.lint.beginnings import Beginnings
from dancetutor_cli.lint.candidates import Candidates
from dancetutor_cli.lint.foot_questions import Feet
from dancetutor_cli.lint.note_questions import Notes
from dancetutor_cli.lint.together import Shared
from dancetutor_cli.pads import Pad
from dancetutor_cli.play.played import Ambiguity, Limb, Play, StepKind

if TYPE_CHECKING:
    from dancetutor_cli.meter.estimate import Sized

_LEFT, _RIGHT = int(Limb.LEFT_FOOT), int(Limb.RIGHT_FOOT)


@dataclass(frozen=True)
class FileSubject:
    """One readable chart file."""

    song: Song

    @property
    def is_warned_of(self) -> bool:
        """Whether the reader warned of anything about the song."""
        return bool(self.song.warnings)

    def warnings(self, codes: Collection[str]) -> Iterator[tuple[str, dict[str, Any]]]:
        """Message and place of what the reader warned of about the song, if the warning has one of these codes."""
        for warning in self.song.warnings:
            if warning.code in codes:
                yield warning.message, self.place(warning.line)

    def tag_place(self, name: str) -> dict[str, Any]:
        """Where a tag of the song stands, if it is found as written."""
        at = self.song.data.upper().find(f"#{name}:".encode())
        return self.place(None if at < 0 else self.song.data.count(b"\n", 0, at) + 1)

    def place(self, line: int | None = None) -> dict[str, Any]:
        """Where a finding about the file stands, as keyword arguments of `Finding`."""
        return {"line": line, "column": None if line is None else 1}


@dataclass(frozen=True)
class ChartSubject:
    """One chart; `play` and `pad` are None where the steps type has no pad.

    overrides : feet that people laid down; ignores, problems : findings they do not want to see, and what is wrong in
    what they said
    """

    song: Song
    chart: Chart
    play: Play | None
    pad: Pad | None = None
    overrides: Overrides | None = None
    ignores: Ignores = field(default_factory=Ignores)
    problems: tuple[FeetProblem, ...] = ()

    @cached_property
    def feet(self) -> Feet | None:
        """Questions about the play, where there is one."""
        return None if self.play is None or self.pad is None else Feet(*self.shared, self.chart.timing)

    @cached_property
    def shared(self) -> Shared:
        """Plays that are looked at together, and which of them is this one; for charts with a play.

        Only this one, unless `look_at_together` has been told of others.
        """
        assert self.play is not None and self.pad is not None
        return Shared(Candidates((self.play,), self.pad), 0)

    @cached_property
    def notes(self) -> Notes:
        """Questions about the notes."""
        return Notes(self.chart)

    @cached_property
    def counts(self) -> Mapping[str, int]:
        """Name of the move -> rows of the play in which it happens."""
        return {} if self.play is None else self.shared.candidates.plays.counts[self.shared.number]

    def sized(self, rate: float = 1.0) -> Sized | None:
        """The chart's meters on every scale, for music that plays so fast; None without a play or a model."""
        from dancetutor_cli.meter.estimate import size

        if self.play is None:
            return None
        candidates, number = self.shared
        ask = partial(candidates.features, number)
        return size(self.chart.steps_type, (self.chart.meter, self.chart.difficulty), ask, rate)

    @property
    def row_count(self) -> int:
        """Rows of the play; 0 without one."""
        return len(self.play.rows) if self.play else 0

    @property
    def is_warned_of(self) -> bool:
        """Whether the reader warned of anything about the chart."""
        return bool(self.chart.warnings)

    def warnings(self, codes: Collection[str]) -> Iterator[tuple[str, dict[str, Any]]]:
        """Message and place of what the reader warned of about the chart, if the warning has one of these codes."""
        for warning in self.chart.warnings:
            if warning.code in codes:
                yield warning.message, self.at_line(warning.line)

    def has(self, move: str) -> bool:
        """Whether a move of this name or of a kind of it happens in the play."""
        return self.play is not None and self.shared.candidates.plays.having(move)[self.shared.number]

    def soonest(self, move: str) -> float:
        """The least time (s) from a step to a row with such a move; endless where there is none."""
        return math.inf if self.play is None else self.shared.candidates.plays.soonest(move)[self.shared.number]

    def rows_with(self, move: str) -> list[int]:
        """Rows with a move of this name or of a kind of it: "crossover" finds "crossover-half" too."""
        if not self.has(move):
            return []
        plays, number = self.shared.candidates.plays, self.shared.number
        rows: list[int] = plays.own(plays.rows_with(move), number).tolist()
        return rows

    @cached_property
    def step_rows(self) -> NDArray[np.int64]:
        """Rows of the play with at least one step."""
        return np.zeros(0, dtype=np.int64) if self.feet is None else self.feet.stepped

    @cached_property
    def angles(self) -> list[list[float]]:
        """Degrees that the body is turned with the left foot on one panel and the right foot on another."""
        assert self.pad is not None
        x, y = np.moveaxis(self.pad.panels[None] - self.pad.panels[:, None], -1, 0)
        angles: list[list[float]] = np.degrees(np.arctan2(y, x)).tolist()
        return angles

    @cached_property
    def beginnings(self) -> Beginnings:
        """Where the dancer may begin anew; for charts with a play."""
        assert self.play is not None
        assert self.feet is not None
        return Beginnings(self.play, self.step_rows, self.feet.pauses[self.step_rows])

    def pause(self, row: int) -> float:
        """Seconds since the row with a step before this one; endless for the first."""
        return self._pauses[row]

    @cached_property
    def _pauses(self) -> list[float]:
        assert self.feet is not None
        pauses: list[float] = self.feet.pauses.tolist()
        return pauses

    def is_jump(self, row: int) -> bool:
        """Whether both feet press in this row."""
        assert self.play is not None
        limbs = self.play.limb[row].tolist()
        return _LEFT in limbs and _RIGHT in limbs

    def brackets(self, row: int) -> bool:
        """Whether one foot presses two panels in this row."""
        return self.play is not None and "bracket" in self.play.moves[row]

    def tempos(self) -> list[float]:
        """Every BPM of the chart's timing between its first and its last note."""
        ticks = self.chart.notes.tick
        if not len(ticks):
            return []
        first, last = int(ticks[0]), int(ticks[-1])
        within = [float(bpm) for tick, bpm in self.chart.timing.bpms if first < tick <= last]
        return [self.chart.timing.bpm_at(first), *within]

    def margin(self, row: int) -> int | None:
        """How much more the best play with other limbs in this row costs; None if there is none, or nobody asked."""
        margin = -1 if self.play is None or self.play.margin is None else int(self.play.margin[row])
        return None if margin < 0 else margin

    def sureness(self, beat: float) -> tuple[int | None, float | None]:
        """Margin and confidence of the feet in a row and in that with a step before it, the lesser; None: not known."""
        play = self.play
        if play is None or play.margin is None:
            return None, None
        row = int(play.rows.tick.searchsorted(round(beat * TICKS_PER_BEAT)))
        at = int(self.step_rows.searchsorted(row))
        rows = [one for one in (row, *self.step_rows[max(at - 1, 0) : at].tolist()) if one < len(play.rows)]
        margins = [int(play.margin[one]) for one in rows if play.margin[one] >= 0]
        sure = [] if play.confidence is None else [float(play.confidence[one]) for one in rows]
        return min(margins, default=None), min((one for one in sure if one == one), default=None)

    def surest(self, rows: list[int]) -> int:
        """Place in some rows of the one whose feet are surest, of several the first."""
        known = [self.sureness(self.beat(row))[1] for row in rows]
        sure = [1.0 if one is None else one for one in known]
        return sure.index(max(sure))

    def beat(self, row: int) -> float:
        """Beat of a row of the play."""
        assert self.play is not None
        return round(int(self.play.rows.tick[row]) / TICKS_PER_BEAT, 6)

    def ties(self) -> Iterator[tuple[int, bool]]:
        """First row of every run of rows that cost the same with other limbs; whether the rows after it do not care."""
        if self.play is None or self.feet is None:
            return
        known = self.play.ambiguity
        for first in self.feet.ties():
            yield first, known is not None and int(known[first]) == Ambiguity.RESOLVED

    def seconds_played(self) -> float:
        """Time from the first to the last row with a step."""
        rows = self.step_rows
        if self.play is None or not len(rows):
            return 0.0
        return abs(float(self.play.rows.second[rows[-1]] - self.play.rows.second[rows[0]]))

    def pressed(self, row: int) -> list[int]:
        """Note columns that have a step in a row of the play."""
        assert self.play is not None
        return [column for column, kind in enumerate(self.play.rows.steps[row].tolist()) if kind]

    def foot_name(self, row: int) -> str:
        """ "left" or "right": the foot that presses the first panel of a row which only one foot steps."""
        assert self.play is not None
        limbs = self.play.limb[row][self.play.rows.steps[row] != StepKind.ROLL_TAP]
        return "left" if (limbs == Limb.LEFT_FOOT).any() else "right"

    def unplayed(self, row: int) -> int:
        """How many steps of a row no limb is left for."""
        assert self.play is not None
        return int((self.play.limb[row] == Limb.UNPLAYED).sum())

    def file_line(self, row: int) -> int:
        """Line in the file of a row of the play; where only a roll made it, of the row written before."""
        return int(self.file_lines[row])

    @cached_property
    def file_lines(self) -> NDArray[np.int32]:
        """The same of every row."""
        assert self.play is not None
        lines, written = self.play.rows.line, self.chart.rows
        if not len(written.tick) or (lines > 0).all():
            return np.maximum(lines, self.chart.line)
        before = written.tick.searchsorted(self.play.rows.tick, side="right") - 1
        return np.where(lines > 0, np.maximum(lines, self.chart.line), written.line[np.maximum(before, 0)])

    def at_row(self, row: int, note_column: int | None = None) -> dict[str, Any]:
        """Where a row of the play stands, as keyword arguments of `Finding`; without `note_column`: its first step."""
        assert self.play is not None
        if note_column is None:
            note_column = next(iter(self.pressed(row)), None)
        line = self.file_line(row)
        return {
            "line": line,
            "column": self._text_column(line, note_column or 0),
            "note_column": note_column,
            "margin": self.margin(row),
            **self._time(int(self.play.rows.tick[row]), float(self.play.rows.second[row])),
        }

    def at_line(self, line: int | None) -> dict[str, Any]:
        """Where a line of the chart stands; with a beat if it is a row of the note data."""
        line = self.chart.line if line is None else line
        place: dict[str, Any] = {"line": line, "column": 1, "chart": self.chart.index}
        rows = self.chart.rows
        found = int(rows.line.searchsorted(line))
        if found < len(rows.line) and rows.line[found] == line:
            tick = int(rows.tick[found])
            place |= {"beat": tick / TICKS_PER_BEAT, "measure": int(rows.measure[found])}
        return place

    def at_tick(self, tick: int, line: int) -> dict[str, Any]:
        """Where a note of the chart stands that may be in no row of the play."""
        second = float(self.chart.timing.seconds(np.array([tick]))[0])
        return {"line": line, "column": self._text_column(line, 0), **self._time(tick, second)}

    def at_chart(self) -> dict[str, Any]:
        """Where the chart itself starts."""
        return {"line": self.chart.line, "column": 1, "chart": self.chart.index}

    def _time(self, tick: int, second: float) -> dict[str, Any]:
        return {
            "beat": tick / TICKS_PER_BEAT,
            "measure": tick // TICKS_PER_MEASURE,
            "second": second,
            "chart": self.chart.index,
        }

    def _text_column(self, line: int, note_column: int) -> int:
        """1-based column of a note's character on its line; keysounds and blanks before it are counted."""
        rows = self.chart.rows
        found = int(rows.line.searchsorted(line))
        if found >= len(rows.line) or rows.line[found] != line:
            return 1
        start, end = int(rows.start[found]), int(rows.end[found])
        line_start = self.song.data.rfind(b"\n", 0, start) + 1
        text = self.song.data[start:end]
        if b"[" in text:
            places = list(_note_offsets(text))
            inside = places[note_column] if note_column < len(places) else 0
        else:
            inside = note_column if note_column < len(text) else 0
        return start - line_start + inside + 1


def _note_offsets(row: bytes) -> Iterator[int]:
    """Offsets of the note characters of a row; ``[...]`` keysounds stand between them."""
    inside_keysound = False
    for offset, byte in enumerate(row):
        if inside_keysound:
            inside_keysound = byte != ord("]")
        elif byte == ord("["):
            inside_keysound = True
        else:
            yield offset
