"""The shape of a chart that an edit must keep: jacks, figures that return, motifs that repeat, two dancers in unison.

An edit keeps the rhythm and the figures of a chart. No note moves to the panel of the note beside it, and no jack is
broken. A phrase that comes three times is corrected three times. Of several edits, the best is the one that players
notice least.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.feet.play import StepKind

if TYPE_CHECKING:
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play

_APART = 1.0  # seconds; rows that are further apart are not neighbours
_MOTIF = 4  # rows before and after a note that make its motif
_NEAR = 32  # rows within which players notice that a figure of four rows returns
_MARGIN = 2  # rows beside a phrase that belong to its motif
_MOST_ALIKE = 12  # places of a motif; a motif with more places is the pattern of the chart
# How much players notice an edit: the worst last. A note that moves alone counts 1.
_NOTE = 1.0
_ACCENTS = (
    (TICKS_PER_MEASURE, 1.5),
    (TICKS_PER_BEAT, 1.0),
    (TICKS_PER_BEAT // 2, 0.5),
)  # on the first beat, a beat ...
_OTHER_KIND = 0.5  # from a side panel to a middle panel, or the other way round
_OF_CHORD = 1.5  # a note in a row with several notes
_RETURN_LOST = 2.0  # a figure A B A is lost
_RETURN_NEW = 1.0  # a new figure A B A
# A phrase that is mirrored left to right, and in addition each of its notes and chords.
_MIRRORED, _MIRRORED_NOTE, _MIRRORED_CHORD = 2.0, 0.25, 1.0
WORST = 5.0  # an edit with a higher cost is not used


class PanelMove(NamedTuple):
    """A tap that moves to another panel. row : row of the play; column, to : the panel before and after the move"""

    row: int
    column: int
    to: int


@dataclass(frozen=True, slots=True)
class Edit:
    """Taps that move together.

    cost : how much players notice the edit; alike : number of places that are corrected in the same way, at least one
    mirrored : whether the taps are a phrase that is mirrored left to right
    """

    moves: tuple[PanelMove, ...]
    cost: float
    alike: int = 1
    mirrored: bool = False


class Shape:
    """The rows with steps of a chart as figures of panels; in a chart for two, also the rows of the other player.

    play : the play of the chart; chart : the chart, or one player's part of a chart for two
    """

    def __init__(self, play: Play, pad: Pad, chart: Chart) -> None:
        self._play, self._pad, self._chart = play, pad, chart
        steps = play.rows.steps
        kinds = (steps != StepKind.NONE) & (steps != StepKind.ROLL_TAP)
        self.rows: list[int] = np.flatnonzero(kinds.any(axis=1)).tolist()
        self._place = {row: at for at, row in enumerate(self.rows)}
        self._pressed = [frozenset(np.flatnonzero(kinds[row]).tolist()) for row in self.rows]
        self._ticks: list[int] = play.rows.tick[self.rows].tolist()
        self._seconds: list[float] = play.rows.second[self.rows].tolist()

    # Single notes and mirrored phrases, as edits that keep the shape.

    def with_repeats(self, moves: Sequence[PanelMove]) -> Edit | None:
        """Return the edit that repeats some moves wherever their motif stands; None if it breaks the chart's shape."""
        at = self._place[moves[0].row]
        away = {*self._repeats(at - _MOTIF, at + _MOTIF), *self._figures(at - 2, at + 1)}
        return self._everywhere(moves, away, self._cost(moves))

    def _everywhere(
        self, moves: Sequence[PanelMove], away: Iterable[int], cost: float, mirrored: bool = False
    ) -> Edit | None:
        """Return the edit of some moves here and at places `away` from here; None if it breaks the shape."""
        found = [tuple(moves), *(tuple(self._moved(move, by) for move in moves) for by in sorted(away))]
        rows = [{move.row for move in one} for one in found]
        overlap = len(set[int]().union(*rows)) < sum(map(len, rows))
        if cost > WORST or len(found) > _MOST_ALIKE or overlap or any(map(self._breaks_unison, found)):
            return None
        together = tuple(move for one in sorted(found) for move in one)
        if not all(move.to in free_panels(self._play, self._chart, move.row) for move in together):
            return None
        if any(self._play.rows.steps[move.row, move.column] != StepKind.TAP for move in together):
            return None
        return Edit(together, cost, len(found), mirrored) if self._keeps_jacks(together) else None

    def mirrored_phrases(self, row: int, most: int, begins: Collection[int]) -> Iterator[Edit]:
        """Yield edits that mirror a phrase which begins or ends beside a row, those with the least cost first.

        most : most rows of a phrase; begins : rows in which the dancer begins again, so a phrase may end before them
        """
        mirror = self._pad.mirror_columns(left_right=True)
        if mirror is None or len(self._pad.squares) > 1 or row not in self._place:
            return
        at, found = self._place[row], list[Edit]()
        for first, last in _phrases(at, len(self.rows), most):
            ends = (
                last + 1 == len(self.rows)
                or self.rows[last + 1] in begins
                or not self._ticks[last + 1] % TICKS_PER_BEAT
            )
            starts = (
                first == 0
                or self.rows[first] in begins
                or first in (at, at + 1)
                or not self._ticks[first] % TICKS_PER_BEAT
            )
            edit = self._mirrored(first, last, mirror.tolist()) if starts and ends else None
            if edit is not None:
                found.append(edit)
        yield from sorted(found, key=lambda edit: edit.cost)

    def _mirrored(self, first: int, last: int, mirror: list[int]) -> Edit | None:
        steps, rows = self._play.rows.steps, range(first, last + 1)
        if any((steps[self.rows[at]] > StepKind.TAP).any() for at in rows) or any(map(self._is_held, rows)):
            return None
        moves = [
            PanelMove(self.rows[at], column, mirror[column])
            for at in rows
            for column in sorted(self._pressed[at])
            if mirror[column] != column and mirror[column] not in self._pressed[at]
        ]
        if len(moves) < 2:  # a single note is not a phrase
            return None
        chords = len({move.row for move in moves if len(self._pressed[self._place[move.row]]) > 1})
        cost = _MIRRORED + _MIRRORED_NOTE * len(moves) + _MIRRORED_CHORD * chords + self._returns(moves)
        return self._everywhere(moves, self._repeats(first - _MARGIN, last + _MARGIN), cost, mirrored=True)

    def _is_held(self, at: int) -> bool:
        """Whether a hold is down in a row, so that mirrored steps beside it would be another figure."""
        notes, tick = self._chart.notes, self._ticks[at]
        return bool(((notes.tick < tick) & (notes.end >= tick)).any())

    # The effect of an edit on figures.

    def _after(self, moves: Sequence[PanelMove]) -> Mapping[int, frozenset[int]]:
        """Return place of the row -> panels after the moves, for the rows that the moves change."""
        rows: dict[int, frozenset[int]] = {}
        for row, column, to in moves:
            at = self._place[row]
            rows[at] = rows.get(at, self._pressed[at]) - {column} | {to}
        return rows

    def _keeps_jacks(self, moves: Sequence[PanelMove]) -> bool:
        """Whether neighbouring rows share as many panels as before, so that no jack is made or broken."""
        after = self._after(moves)
        for at in {near for place in after for near in (place, place + 1)}:
            if not 0 < at < len(self.rows) or self._seconds[at] - self._seconds[at - 1] > _APART:
                continue
            before = len(self._pressed[at - 1] & self._pressed[at])
            if len(after.get(at - 1, self._pressed[at - 1]) & after.get(at, self._pressed[at])) != before:
                return False
        return True

    def _returns(self, moves: Sequence[PanelMove]) -> float:
        """Return the cost of the figures A B A (trills, triangles) that the moves break or make."""
        after, cost = self._after(moves), 0.0
        for at in {near for place in after for near in (place, place + 2)}:
            if 2 <= at < len(self.rows) and self._seconds[at] - self._seconds[at - 2] <= 2 * _APART:
                was = self._pressed[at - 2] == self._pressed[at]
                now = after.get(at - 2, self._pressed[at - 2]) == after.get(at, self._pressed[at])
                cost += _RETURN_LOST * (was and not now) + _RETURN_NEW * (now and not was)
        return cost

    def _cost(self, moves: Sequence[PanelMove]) -> float:
        """Return how much players notice some moves."""
        cost = self._returns(moves)
        for row, column, to in moves:
            at = self._place[row]
            accent = next((worth for unit, worth in _ACCENTS if self._ticks[at] % unit == 0), 0.0)
            other = _OTHER_KIND * (self._is_side(column) != self._is_side(to))
            cost += _NOTE + accent + other + _OF_CHORD * (len(self._pressed[at]) > 1)
        return cost

    def _is_side(self, column: int) -> bool:
        return column in self._sides

    @cached_property
    def _sides(self) -> set[int]:
        """The panels that lie to one side of the middle of their pad."""
        x = self._pad.panels[:, 0]
        half = len(x) // 2 if len(self._pad.squares) > 1 else len(x)
        return {n for n in range(len(x)) if abs(x[n] - x[n // half * half :][:half].mean()) > 0.25}

    # Places where the same motif returns, and rows where two dancers step the same.

    def _moved(self, move: PanelMove, by: int) -> PanelMove:
        """Return the same move, `by` rows with steps later."""
        return move._replace(row=self.rows[self._place[move.row] + by])

    def _repeats(self, first: int, last: int) -> Iterator[int]:
        """Yield how many places away the rows of a motif return with the same rhythm and the same place in the beat."""
        first, last = max(first, 0), min(last, len(self.rows) - 1)
        motif = self._motif(first, last + 1)
        for start in self._starts[self._pressed[first]]:
            end = start + last + 1 - first
            if start != first and end <= len(self.rows) and self._motif(start, end) == motif:
                yield start - first

    def _figures(self, first: int, last: int) -> Iterator[int]:
        """Yield how many places away the same panels return nearby, at most twice as slowly or as quickly."""
        first, last = max(first, 0), min(last, len(self.rows) - 1)
        size, figure = last + 1 - first, self._pressed[first : last + 1]
        pace = np.diff(self._ticks[first : last + 1])
        for start in range(max(first - _NEAR, 0), min(first + _NEAR, len(self.rows) - size) + 1):
            if start != first and self._pressed[start : start + size] == figure:
                other = np.diff(self._ticks[start : start + size])
                if (other <= 2 * pace).all() and (pace <= 2 * other).all():
                    yield start - first

    def _motif(self, first: int, after: int) -> tuple[object, ...]:
        ticks = self._ticks[first:after]
        return self._pressed[first:after], [tick - ticks[0] for tick in ticks], ticks[0] % TICKS_PER_BEAT

    @cached_property
    def _starts(self) -> dict[frozenset[int], list[int]]:
        """Panels -> the places of the rows in which exactly these panels are pressed."""
        found: dict[frozenset[int], list[int]] = {}
        for at, pressed in enumerate(self._pressed):
            found.setdefault(pressed, []).append(at)
        return found

    def _breaks_unison(self, moves: Sequence[PanelMove]) -> bool:
        """Whether the moves change one player's row in which both players step the same panels or mirrored ones."""
        if self._chart.written is None:
            return False
        return any(self._is_unison(self._place[move.row]) for move in moves)

    def _is_unison(self, at: int) -> bool:
        mine, theirs = self._pressed[at], self._others.get(self._ticks[at], frozenset())
        mirror = self._pad.mirror_columns(left_right=True)
        return theirs == mine or (mirror is not None and theirs == {int(mirror[column]) for column in mine})

    @cached_property
    def _others(self) -> dict[int, frozenset[int]]:
        """Tick -> panels of the other player, as columns of this player's pad."""
        assert self._chart.written is not None
        whole, own = self._chart.written.notes, self._chart.notes
        mine = set(zip(own.tick.tolist(), (own.column + self._chart.first_column).tolist(), strict=True))
        found: dict[int, frozenset[int]] = {}
        for tick, column in zip(whole.tick.tolist(), whole.column.tolist(), strict=True):
            if (tick, column) not in mine:
                found[tick] = found.get(tick, frozenset()) | {column % max(self._chart.columns, 1)}
        return found


def free_panels(play: Play, chart: Chart, row: int) -> list[int]:
    """Return the panels of a row without a step or a mine, on which no hold or roll is down or ends."""
    rows, notes = play.rows, chart.notes
    free, tick = (rows.steps[row] == StepKind.NONE) & ~rows.mines[row], int(rows.tick[row])
    free[notes.column[(notes.tick <= tick) & (notes.end >= tick)]] = False
    found: list[int] = np.flatnonzero(free).tolist()
    return found


def _phrases(at: int, rows: int, most: int) -> Iterator[tuple[int, int]]:
    """Yield the first and the last place of phrases that begin at a place or the next one, or end before the place."""
    for first in (at, at + 1):
        yield from ((first, last) for last in range(first, min(first + most, rows)))
    yield from ((first, at - 1) for first in range(max(at - most, 0), at))
