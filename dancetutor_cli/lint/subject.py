"""The subjects that rules check: a file, or one chart with its play; charts that are checked together."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
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
from dancetutor_cli.feet.play import Ambiguity, StepKind
from dancetutor_cli.feet.preset import LEAP, DropReason, Preset
from dancetutor_cli.feet.solved import Solved, solve_song
from dancetutor_cli.feet.unplayable import SAME_TIME, too_quick_notes
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


# Charts that are checked together, so that the facts for rules are found for all of them at once.


def share_plays(subjects: Iterable[ChartSubject]) -> None:
    """Let charts for the same pad share their candidates, so that facts are found for all of them at once."""
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
    """One readable chart file. sync : the sync of its music and charts, None if it was not judged"""

    song: Song
    sync: SongSync | None = None

    @cached_property
    def music(self) -> AudioHead | None:
        """The head of the song's music; None if the music is missing or damaged, which other rules report."""
        from dancetutor_cli.chart.audio import read_head

        try:
            return read_head(music_file(self.song))
        except FileError:
            return None

    @cached_property
    def dance_charts(self) -> tuple[Chart, ...]:
        """The charts that have notes, without lights."""
        return tuple(one for one in self.song.charts if len(one.notes) and not is_lights(one.steps_type))

    def warnings(self, codes: Collection[str]) -> list[tuple[str, dict[str, Any]]]:
        """Return message and place of the reader's warnings about the song that have one of these codes."""
        return [(one.message, self.place(one.line)) for one in self.song.warnings if one.code in codes]

    def tag_place(self, name: str) -> dict[str, Any]:
        """Return the place of a tag of the song; the whole file if the tag is not found as written."""
        at = self.song.data.upper().find(f"#{name}:".encode())
        return self.place(None if at < 0 else self.song.data.count(b"\n", 0, at) + 1)

    def place(self, line: int | None = None) -> dict[str, Any]:
        """Return the place of a finding about the file, as keyword arguments of `Finding`."""
        return {"line": line, "column": None if line is None else 1}


@dataclass(frozen=True)
class ChartSubject(PlacedChart):
    """One chart; `play` and `pad` are None if the steps type has no pad.

    overrides : feet that the author has set; ignores : findings that the author has silenced
    problems : faults in these settings of the author
    """

    pad: Pad | None = None
    overrides: Overrides | None = None
    ignores: Ignores = field(default_factory=Ignores)
    problems: tuple[FeetProblem, ...] = ()

    @cached_property
    def facts(self) -> PlayFacts | None:
        """Facts about the play, None without one; for this chart alone, unless `share_plays` has set them."""
        if self.play is None or self.pad is None:
            return None
        return PlayFacts(Candidates((self.play,), self.pad), 0, self.chart.timing)

    @cached_property
    def notes(self) -> NoteFacts:
        """Facts about the notes of the chart."""
        return NoteFacts(self.chart)

    @cached_property
    def counts(self) -> Mapping[str, int]:
        """Name of the move -> number of rows of the play in which it happens."""
        return {} if self.facts is None else self.facts.candidates.plays.counts[self.facts.number]

    def metered_chart(self, rate: float = 1.0) -> MeteredChart | None:
        """Return the chart's meters on every scale, at a rate of the music; None without a play or a model."""
        if self.facts is None:
            return None
        ask = partial(self.facts.candidates.features, self.facts.number)
        return size(self.chart.steps_type, (self.chart.meter, self.chart.difficulty), ask, rate)

    def oddities(self) -> Oddities:
        """Return the oddities from which the score is estimated; only for charts with a play."""
        assert self.play is not None
        assert self.facts is not None
        timing = timing_oddities(self.chart.timing, self.play.rows.tick[self.step_rows])
        return Oddities((*self.facts.own(self.facts.candidates.oddities), *timing.numbers), timing)

    @property
    def row_count(self) -> int:
        """The number of rows of the play; 0 without one."""
        return len(self.play.rows) if self.play else 0

    def warnings(self, codes: Collection[str]) -> list[tuple[str, dict[str, Any]]]:
        """Return message and place of the reader's warnings about the chart that have one of these codes."""
        return [(one.message, self.at_line(one.line)) for one in self.chart.warnings if one.code in codes]

    def has(self, move: str) -> bool:
        """Whether a move of this name or of a kind of it happens in the play."""
        return self.facts is not None and self.facts.candidates.plays.has_move(move)[self.facts.number]

    def rows_with(self, move: str) -> list[int]:
        """Return the rows with a move of this name or of a kind of it: "crossover" also finds "crossover-half"."""
        if self.facts is None or not self.has(move):
            return []
        plays = self.facts.candidates.plays
        rows: list[int] = plays.own(plays.rows_with(move), self.facts.number).tolist()
        return rows

    @cached_property
    def too_quick(self) -> tuple[tuple[int, int, DropReason], ...]:
        """Row, column and reason of each note that the dancer does not play, because the limb cannot come in time."""
        if self.play is None or self.pad is None or self.facts is None:
            return ()
        if self.facts.own(self.facts.candidates.least_foot_seconds) > LEAP + SAME_TIME and not self.has("hand"):
            return ()
        return tuple(too_quick_notes(self.play, self.pad))

    @cached_property
    def step_rows(self) -> NDArray[np.int64]:
        """The rows of the play with at least one step."""
        return np.zeros(0, dtype=np.int64) if self.facts is None else self.facts.step_rows

    @cached_property
    def angles(self) -> list[list[float]]:
        """Degrees that the body is turned, by the panel of the left foot, then the panel of the right foot."""
        assert self.pad is not None
        x, y = np.moveaxis(self.pad.panels[None] - self.pad.panels[:, None], -1, 0)
        angles: list[list[float]] = np.degrees(np.arctan2(y, x)).tolist()
        return angles

    @cached_property
    def beginnings(self) -> Beginnings:
        """The steps at which the dancer may begin again; only for charts with a play."""
        assert self.play is not None
        assert self.facts is not None
        return Beginnings(self.play, self.step_rows, self.facts.pauses[self.step_rows])

    def pause(self, row: int) -> float:
        """Return the seconds since the row with a step before this row; inf for the first."""
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
        """Return every BPM of the chart's timing between its first and its last note."""
        ticks = self.chart.notes.tick
        if not len(ticks):
            return []
        first, last = int(ticks[0]), int(ticks[-1])
        within = [float(bpm) for tick, bpm in self.chart.timing.bpms if first < tick <= last]
        return [self.chart.timing.bpm_at(first), *within]

    def confidence(self, beat: float) -> tuple[int | None, float | None]:
        """Return margin and confidence of the feet on a beat; None if not known.

        Of the row on the beat and the row with a step before it, the lesser value counts.
        """
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
        """Return the index of the first of the rows whose feet have the highest confidence."""
        known = [self.confidence(self.beat(row))[1] for row in rows]
        sure = [1.0 if one is None else one for one in known]
        return sure.index(max(sure))

    def ties(self) -> Iterator[tuple[int, bool]]:
        """Yield the first row of every run of rows that cost the same with other limbs, and whether it is resolved.

        If it is resolved, the feet of the rows after the run do not depend on the choice.
        """
        if self.play is None or self.facts is None:
            return
        known = self.play.ambiguity
        for first in self.facts.own(self.facts.candidates.ties):
            yield first, known is not None and int(known[first]) == Ambiguity.RESOLVED

    def seconds_played(self) -> float:
        """Return the seconds from the first to the last row with a step."""
        rows = self.step_rows
        if self.play is None or not len(rows):
            return 0.0
        return abs(float(self.play.rows.second[rows[-1]] - self.play.rows.second[rows[0]]))

    def foot_name(self, row: int) -> str:
        """Return "left" if the left foot steps in a row, else "right"; for rows that one foot steps."""
        assert self.play is not None
        limbs = self.play.limb[row][self.play.rows.steps[row] != StepKind.ROLL_TAP]
        return "left" if (limbs == Limb.LEFT_FOOT).any() else "right"

    def count_unplayed(self, row: int) -> int:
        """Return the number of steps of a row for which no limb is free."""
        assert self.play is not None
        return int((self.play.limb[row] == Limb.UNPLAYED).sum())


# Solved charts as subjects for rules.


def subject_of(solved: Solved) -> ChartSubject:
    """Return the subject of a solved chart."""
    one = solved
    return ChartSubject(one.song, one.chart, one.play, one.pad, one.overrides, one.ignores, one.problems)


def solved_chart(song: Song, chart: Chart, preset: Preset) -> ChartSubject:
    """Return the subject of one chart, solved by `feet.solved.solve_song`."""
    return subject_of(next(solve_song(song, [(chart, preset)])))
