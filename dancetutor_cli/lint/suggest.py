"""Small edits that would remove a finding and keep a chart's shape, checked by solving the edited chart."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.play import Play, StepKind
from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.feet.solver.engine import engine_for
from dancetutor_cli.feet.solver.solve import forced_limbs, move_tap, solve_rows
from dancetutor_cli.feet.solver.vocabulary import EVENTS
from dancetutor_cli.lint.check import check_rule, rules_of
from dancetutor_cli.lint.edit_shape import Edit, PanelMove, Shape, free_panels
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.other_foot import RESTED
from dancetutor_cli.lint.rule import all_rules
from dancetutor_cli.lint.rule_settings import Layer, Settings
from dancetutor_cli.lint.subject import ChartSubject

_FAMILIES = ("DT2", "DT3")  # the edit must cause no new finding of these families
_AROUND = 4  # rows to either side of the finding's row in which a note may be moved
_PHRASE = 12  # most rows of a phrase that may be mirrored left to right
_MOST_SOLVED = 24  # most edits for a finding with which the whole chart is solved
# Move -> the hard move that it counts as.
_HARD = {
    "doublestep": "doublestep", "crossover-half": "crossover", "crossover-full": "crossover", "spin": "spin",
    "footswitch-up": "switch", "footswitch-down": "switch", "footswitch": "switch", "sideswitch-left": "switch",
    "sideswitch-right": "switch", "jump-footswitch": "switch", "holdswitch": "switch", "bracket": "bracket",
}  # fmt: skip

_Place = tuple[str, float | None]  # rule and beat of a finding


class MovedNote(NamedTuple):
    """A tap that moves to another panel. tick : tick of its row, 1/48 beats; column, to : from 0"""

    tick: int
    column: int
    to: int


@dataclass(frozen=True, slots=True)
class Suggestion:
    """Taps that move to other panels together. words : the edit in words"""

    notes: tuple[MovedNote, ...]
    words: str


def with_suggestions(
    findings: Sequence[Finding], subject: ChartSubject, settings: Settings, preset: Preset
) -> tuple[Finding, ...]:
    """Return the findings; a finding that a good edit would remove has the edit in words. The chart is not changed."""
    if subject.play is None or subject.pad is None:
        return tuple(findings)
    trial = _Trial(subject, _of_families(settings), preset, _places(findings))
    results: list[Finding] = []
    for finding in findings:
        best = next(trial.good_edits(finding), None) if all_rules()[finding.rule].fixed_by_moves else None
        results.append(finding if best is None else replace(finding, suggestion=_in_words(best, subject)))
    return tuple(results)


def move_edits(
    finding: Finding, findings: Sequence[Finding], subject: ChartSubject, settings: Settings, preset: Preset
) -> Iterator[Suggestion]:
    """Yield the edits that would remove one finding, those that players notice least first.

    findings : all findings of the chart
    """
    if subject.play is None or subject.pad is None or not all_rules()[finding.rule].fixed_by_moves:
        return
    ticks = subject.play.rows.tick
    trial = _Trial(subject, _of_families(settings), preset, _places(findings))
    for edit in trial.good_edits(finding):
        notes = tuple(MovedNote(int(ticks[row]), column, to) for row, column, to in edit.moves)
        yield Suggestion(notes, _in_words(edit, subject))


def _of_families(settings: Settings) -> Settings:
    """Return the settings without the rules that do not matter for edits."""
    rules = all_rules().items()
    others = frozenset(code for code, rule in rules if rule.only_worst or not code.startswith(_FAMILIES))
    return settings.with_layer(Layer(ignore=others))


@dataclass
class _Trial:
    """Tries edits of a chart, each once, because findings beside each other need the same edits.

    before : places of the chart's findings before any edit
    """

    subject: ChartSubject
    settings: Settings
    preset: Preset
    before: set[_Place]
    _solved_moves: dict[PanelMove, tuple[int, NDArray[np.int64]]] = field(default_factory=dict)
    _edited: dict[Edit, _Edited] = field(default_factory=dict)

    def good_edits(self, finding: Finding) -> Iterator[Edit]:
        """Yield the edits with a cheaper play that remove the finding and cause no other, the least noticed first.

        For a single note, the new cost is checked first, because it is found quickly. Only a few edits are solved and
        checked by the rules.
        """
        assert self.subject.play is not None
        place, solved = (finding.rule, finding.beat), 0
        for edit in self._candidates(finding):
            if len(edit.moves) == 1:
                move = edit.moves[0]
                if self._after_move(move)[0] >= self.subject.play.total or self._still_happens(move, place):
                    continue
            if edit not in self._edited:
                solved += 1
                if solved > _MOST_SOLVED:
                    return
                self._edited[edit] = _Edited(self._subject_after(edit), self.settings, self.before)
            edited = self._edited[edit]
            if edited.is_easier(self.subject, all_rules()[finding.rule].unwanted_move) and edited.is_improved(place):
                yield edit

    def _candidates(self, finding: Finding) -> Iterator[Edit]:
        """Yield edits that keep the chart's shape: notes near the finding's row, then mirrored phrases."""
        play = self.subject.play
        if play is None or finding.beat is None:
            return
        taps = (self._shape.with_repeats([move]) for move in _taps(finding.beat, play, self.subject.chart))
        yield from sorted((edit for edit in taps if edit is not None), key=lambda edit: edit.cost)
        row = int(play.rows.tick.searchsorted(round(finding.beat * TICKS_PER_BEAT)))
        steps = self.subject.step_rows
        begins = set(steps[self.subject.beginnings.fresh_starts(RESTED)].tolist())
        yield from self._shape.mirrored_phrases(row, _PHRASE, begins)

    @cached_property
    def _shape(self) -> Shape:
        assert self.subject.play is not None and self.subject.pad is not None
        return Shape(self.subject.play, self.subject.pad, self.subject.chart)

    def _after_move(self, move: PanelMove) -> tuple[int, NDArray[np.int64]]:
        """Return the cost of the cheapest way after a move and the events of each row; see `Engine.cost_and_events`."""
        if move not in self._solved_moves:
            play, pad = self.subject.play, self.subject.pad
            assert play is not None and pad is not None
            rows = move_tap(play.rows, *move)
            engine = engine_for(pad, self.preset)
            self._solved_moves[move] = engine.cost_and_events(rows, forced_limbs(rows, self.subject.overrides))
        return self._solved_moves[move]

    def _still_happens(self, move: PanelMove, place: _Place) -> bool:
        rule, beat = place
        move_name = all_rules()[rule].unwanted_move
        if not move_name or beat is None or self.subject.play is None:
            return False
        row = int(self.subject.play.rows.tick.searchsorted(round(beat * TICKS_PER_BEAT)))
        return bool(self._after_move(move)[1][row] >> EVENTS.index(move_name) & 1)

    def _subject_after(self, edit: Edit) -> ChartSubject:
        subject = self.subject
        assert subject.play is not None and subject.pad is not None
        rows = subject.play.rows
        for row, column, to in edit.moves:
            rows = move_tap(rows, row, column, to)
        return replace(subject, play=solve_rows(rows, subject.pad, self.preset, subject.overrides, margins=True))


class _Edited:
    """An edited chart. The rules check it one by one, until one of them has a new finding."""

    def __init__(self, subject: ChartSubject, settings: Settings, before: set[_Place]) -> None:
        self._subject, self._settings, self._before = subject, settings, before
        self._rules = rules_of(subject, settings)
        self._to_ask = list(self._rules)
        self._found: set[_Place] = set()

    def is_easier(self, before: ChartSubject, move: str) -> bool:
        """Whether the play costs less than before the edit, and no hard move happens more often.

        The rules alone are not enough, because they do not report every hard move.
        move : a move that must happen less often, so that it has not only moved to another row; or ""
        """
        play, old = self._subject.play, before.play
        assert play is not None and old is not None
        now, was = _hard_moves(play), _hard_moves(old)
        return play.total < old.total and not now - was and (not move or now[move] < was[move])

    def is_improved(self, place: _Place) -> bool:
        """Whether the finding at a place is gone and no new finding has appeared."""
        self._to_ask.sort(key=lambda code: code != place[0])
        while self._to_ask and place not in self._found and self._found <= self._before:
            self._found |= _places(check_rule(self._to_ask.pop(0), self._rules, self._subject, self._settings))
        return place not in self._found and self._found <= self._before


def _hard_moves(play: Play) -> Counter[str]:
    """Return how many rows have each hard move. Kinds of a move, such as half and full crossovers, count as one."""
    return Counter(kind for moves in play.moves for kind in {_HARD.get(move) for move in moves} if kind is not None)


def _places(findings: Sequence[Finding]) -> set[_Place]:
    ours = (one for one in findings if one.rule.startswith(_FAMILIES) and not all_rules()[one.rule].only_worst)
    return {(one.rule, one.beat) for one in ours}


def _taps(beat: float, play: Play, chart: Chart) -> Iterator[PanelMove]:
    """Yield the moves of every tap in the rows around a beat to every free panel of its row, nearest rows first."""
    rows = play.rows
    at = int(np.searchsorted(rows.tick, round(beat * TICKS_PER_BEAT)))
    for row in sorted(range(max(at - _AROUND, 0), min(at + _AROUND + 1, len(rows))), key=lambda row: abs(row - at)):
        free = free_panels(play, chart, row)
        for column in np.flatnonzero(rows.steps[row] == StepKind.TAP).tolist():
            yield from (PanelMove(row, column, to) for to in free)


def _in_words(edit: Edit, subject: ChartSubject) -> str:
    assert subject.play is not None and subject.pad is not None
    ticks, names = subject.play.rows.tick, subject.pad.names
    beats = [f"{round(int(ticks[move.row]) / TICKS_PER_BEAT, 3):g}" for move in edit.moves]
    each = len(edit.moves) // edit.alike
    others = beats[each::each]
    again = f", and the same from beat {' '.join(others)} on" if others and edit.mirrored else ""
    if edit.mirrored:
        return f"mirror the notes on beats {beats[0]} to {beats[each - 1]} left to right{again}"
    again = f", and the same on beat{'s' if len(others) > 1 else ''} {' '.join(others)}" if others else ""
    move = edit.moves[0]
    return f"move the note on beat {beats[0]} from {names[move.column]} to {names[move.to]}{again}"
