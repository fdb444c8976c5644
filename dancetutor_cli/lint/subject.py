"""What a rule looks at: a file, or one chart with its play; charts that are looked at together."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.music import music_file
from dancetutor_cli.chart.names import TICKS_PER_BEAT, is_lights
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.overrides import FeetProblem, Ignores, Overrides
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.play import SAME_TIME, Ambiguity, StepKind, too_quick
from dancetutor_cli.feet.preset import LEAP, DropReason, Preset
from dancetutor_cli.feet.solved import Solved, solve_song
from dancetutor_cli.lint.candidates import Candidates
from dancetutor_cli.lint.meter.estimate import size
from dancetutor_cli.lint.meter.score import Oddities, timing_oddities
from dancetutor_cli.lint.note_facts import NoteFacts, PlacedChart
from dancetutor_cli.lint.other_foot import Beginnings
from dancetutor_cli.lint.play_facts import PlayFacts
from dancetutor_cli.run.errors import FileError

if TYPE_CHECKING:
    from dancetutor_cli.chart.audio import AudioHead
    from dancetutor_cli.lint.meter.estimate import MeteredChart
    from dancetutor_cli.lint.song_sync import SongSync


# Charts that are looked at together, so that what rules ask of one is answered for all of them at once.


def share_plays(subjects: Iterable[ChartSubject]) -> None:
    """Let charts share their work: what is asked of one is answered for those on the same pad at once."""
    of_pads: dict[str, list[ChartSubject]] = defaultdict(list)
    for subject in subjects:
        if subject.play is not None and subject.pad is not None:
            of_pads[subject.pad.steps_type].append(subject)
    for alike in of_pads.values():
        assert alike[0].pad is not None
        candidates = Candidates([subject.play for subject in alike if subject.play is not None], alike[0].pad)
        for number, subject in enumerate(alike):
            vars(subject)["facts"] = PlayFacts(candidates, number, subject.chart.timing)


_LEFT, _RIGHT = int(Limb.LEFT_FOOT), int(Limb.RIGHT_FOOT)


@dataclass(frozen=True)
class FileSubject:
    """One readable chart file. sync : its music against its charts, None where nobody asked for it"""

    song: Song
    sync: SongSync | None = None

    @cached_property
    def music(self) -> AudioHead | None:
        """What the head of the song's music says; None where it is missing or damaged, which has rules of its own."""
        from dancetutor_cli.chart.audio import read_head

        try:
            return read_head(music_file(self.song))
        except FileError:
            return None

    @cached_property
    def dance_charts(self) -> tuple[Chart, ...]:
        """The charts that have notes and are no lights."""
        return tuple(one for one in self.song.charts if len(one.notes) and not is_lights(one.steps_type))

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
class ChartSubject(PlacedChart):
    """One chart; `play` and `pad` are None where the steps type has no pad.

    overrides : feet that people laid down; ignores, problems : findings they do not want to see, and what is wrong in
    what they said
    """

    pad: Pad | None = None
    overrides: Overrides | None = None
    ignores: Ignores = field(default_factory=Ignores)
    problems: tuple[FeetProblem, ...] = ()

    @cached_property
    def facts(self) -> PlayFacts | None:
        """Facts about the play, where there is one; of this chart alone, unless `share_plays` has put them here."""
        if self.play is None or self.pad is None:
            return None
        return PlayFacts(Candidates((self.play,), self.pad), 0, self.chart.timing)

    @cached_property
    def notes(self) -> NoteFacts:
        """Facts about the notes."""
        return NoteFacts(self.chart)

    @cached_property
    def counts(self) -> Mapping[str, int]:
        """Name of the move -> rows of the play in which it happens."""
        return {} if self.facts is None else self.facts.candidates.plays.counts[self.facts.number]

    def sized(self, rate: float = 1.0) -> MeteredChart | None:
        """The chart's meters on every scale, for music that plays so fast; None without a play or a model."""
        if self.facts is None:
            return None
        ask = partial(self.facts.candidates.features, self.facts.number)
        return size(self.chart.steps_type, (self.chart.meter, self.chart.difficulty), ask, rate)

    def oddities(self) -> Oddities:
        """What the chart is scored by; for charts with a play."""
        assert self.play is not None
        assert self.facts is not None
        timing = timing_oddities(self.chart.timing, self.play.rows.tick[self.step_rows])
        return Oddities((*self.facts.candidates.oddities[self.facts.number], *timing.numbers), timing)

    @property
    def row_count(self) -> int:
        """Rows of the play; 0 without one."""
        return len(self.play.rows) if self.play else 0

    def warnings(self, codes: Collection[str]) -> Iterator[tuple[str, dict[str, Any]]]:
        """Message and place of what the reader warned of about the chart, if the warning has one of these codes."""
        for warning in self.chart.warnings:
            if warning.code in codes:
                yield warning.message, self.at_line(warning.line)

    def has(self, move: str) -> bool:
        """Whether a move of this name or of a kind of it happens in the play."""
        return self.facts is not None and self.facts.candidates.plays.has_move(move)[self.facts.number]

    def rows_with(self, move: str) -> list[int]:
        """Rows with a move of this name or of a kind of it: "crossover" finds "crossover-half" too."""
        if self.facts is None or not self.has(move):
            return []
        plays = self.facts.candidates.plays
        rows: list[int] = plays.own(plays.rows_with(move), self.facts.number).tolist()
        return rows

    @cached_property
    def too_quick(self) -> tuple[tuple[int, int, DropReason], ...]:
        """Row, column and reason of each note whose limb cannot be there in time: the dancer lets it go."""
        if self.play is None or self.pad is None or self.facts is None:
            return ()
        if self.facts.candidates.least_foot_seconds[self.facts.number] > LEAP + SAME_TIME and not self.has("hand"):
            return ()
        return tuple(too_quick(self.play, self.pad))

    @cached_property
    def step_rows(self) -> NDArray[np.int64]:
        """Rows of the play with at least one step."""
        return np.zeros(0, dtype=np.int64) if self.facts is None else self.facts.stepped

    @cached_property
    def angles(self) -> list[list[float]]:
        """Degrees that the body is turned with the left foot on one panel and the right foot on another."""
        assert self.pad is not None
        x, y = np.moveaxis(self.pad.panels[None] - self.pad.panels[:, None], -1, 0)
        angles: list[list[float]] = np.degrees(np.arctan2(y, x)).tolist()
        return angles

    @cached_property
    def beginnings(self) -> Beginnings:
        """Where the dancer may begin again; for charts with a play."""
        assert self.play is not None
        assert self.facts is not None
        return Beginnings(self.play, self.step_rows, self.facts.pauses[self.step_rows])

    def pause(self, row: int) -> float:
        """Seconds since the row with a step before this one; endless for the first."""
        return self._pauses[row]

    @cached_property
    def _pauses(self) -> list[float]:
        assert self.facts is not None
        pauses: list[float] = self.facts.pauses.tolist()
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

    def confidence(self, beat: float) -> tuple[int | None, float | None]:
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

    def most_confident(self, rows: list[int]) -> int:
        """Place in some rows of the one whose feet are surest, of several the first."""
        known = [self.confidence(self.beat(row))[1] for row in rows]
        sure = [1.0 if one is None else one for one in known]
        return sure.index(max(sure))

    def ties(self) -> Iterator[tuple[int, bool]]:
        """First row of every run of rows that cost the same with other limbs; whether the rows after it do not care."""
        if self.play is None or self.facts is None:
            return
        known = self.play.ambiguity
        for first in self.facts.ties():
            yield first, known is not None and int(known[first]) == Ambiguity.RESOLVED

    def seconds_played(self) -> float:
        """Time from the first to the last row with a step."""
        rows = self.step_rows
        if self.play is None or not len(rows):
            return 0.0
        return abs(float(self.play.rows.second[rows[-1]] - self.play.rows.second[rows[0]]))

    def foot_name(self, row: int) -> str:
        """ "left" or "right": the foot that presses the first panel of a row which only one foot steps."""
        assert self.play is not None
        limbs = self.play.limb[row][self.play.rows.steps[row] != StepKind.ROLL_TAP]
        return "left" if (limbs == Limb.LEFT_FOOT).any() else "right"

    def unplayed(self, row: int) -> int:
        """How many steps of a row no limb is left for."""
        assert self.play is not None
        return int((self.play.limb[row] == Limb.UNPLAYED).sum())


# Charts with their feet as the rules look at them.


def subject_of(solved: Solved) -> ChartSubject:
    """What rules look at of a solved chart."""
    one = solved
    return ChartSubject(one.song, one.chart, one.play, one.pad, one.overrides, one.ignores, one.problems)


def solved_chart(song: Song, chart: Chart, preset: Preset) -> ChartSubject:
    """One chart, see `solved_charts`."""
    return next(solved_charts(song, [chart], lambda _: preset))


def solved_charts(song: Song, charts: Sequence[Chart], preset_of: Callable[[Chart], Preset]) -> Iterator[ChartSubject]:
    """Charts of a song, solved as `feet.solved.solve_song` does."""
    return map(subject_of, solve_song(song, charts, preset_of))
