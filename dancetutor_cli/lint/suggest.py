"""Small edits that would mend a finding: one note moved to another panel, proven by solving the edited chart."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Chart
from dancetutor_cli.feet import Play, StepKind, solve
from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.feet.solver.engine import engine_for
from dancetutor_cli.feet.solver.solve import OneTap, Outline, forced_limbs, move_tap
from dancetutor_cli.feet.solver.vocabulary import EVENTS
from dancetutor_cli.lint.check import check_rule, rules_of
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import all_rules
from dancetutor_cli.lint.rule_settings import Layer, Settings
from dancetutor_cli.lint.subject import ChartSubject

# What can be mended by moving a note: doublestep, spin, jump-spin, ambiguous start, triple step.
MENDABLE = ("DT201", "DT202", "DT203", "DT207", "DT209")
_FAMILIES = ("DT2", "DT3")  # the edit must bring no new finding of these
_AROUND = (0, -1, 1)  # rows in which a note may be moved, nearest first
_FARTHER = (-2, 2, -3, 3, -4, 4)  # and where none of these does, if a fix is asked for
# What must not happen any more in the row of a finding: that is seen before the rules are asked.
_MOVES = {"DT201": "doublestep", "DT202": "spin", "DT203": "spin", "DT209": "doublestep"}
_RANKED = frozenset({"DT213"})  # findings that take the place of others are not new

_Place = tuple[str, float | None]  # rule and beat of a finding


@dataclass(frozen=True, slots=True)
class _Edit:
    row: int
    column: int
    to: int


@dataclass(frozen=True, slots=True)
class MovedNote:
    """A tap that goes to another panel. tick : its row, 1/48 beats; column, to : from 0; words : the same for people"""

    tick: int
    column: int
    to: int
    words: str


def with_suggestions(
    findings: Sequence[Finding], subject: ChartSubject, settings: Settings, preset: Preset
) -> tuple[Finding, ...]:
    """The findings, those that one moved note would remove with the edit in words. The chart is not changed."""
    if subject.play is None or subject.pad is None:
        return tuple(findings)
    trial = _Trial(subject, _of_families(settings), preset, _places(findings))
    told: list[Finding] = []
    for finding in findings:
        edits = _edits(finding, subject.play, subject.chart) if finding.rule in MENDABLE else ()
        best = next(trial.good(edits, (finding.rule, finding.beat)), None)
        told.append(finding if best is None else replace(finding, suggestion=_in_words(best, subject)))
    return tuple(told)


def mending_moves(
    finding: Finding, findings: Sequence[Finding], subject: ChartSubject, settings: Settings, preset: Preset
) -> Iterator[MovedNote]:
    """The edits that would remove one finding, the suggested one first, then those in rows farther away.

    findings : all of the chart
    """
    if subject.play is None or subject.pad is None or finding.rule not in MENDABLE:
        return
    trial = _Trial(subject, _of_families(settings), preset, _places(findings))
    for rows in (_AROUND, _FARTHER):
        edits = _edits(finding, subject.play, subject.chart, rows)
        for edit in trial.good(edits, (finding.rule, finding.beat)):
            tick = int(subject.play.rows.tick[edit.row])
            yield MovedNote(tick, edit.column, edit.to, _in_words(edit, subject))


def _of_families(settings: Settings) -> Settings:
    """The settings without the rules that no edit is asked about."""
    others = _RANKED | {code for code in all_rules() if not code.startswith(_FAMILIES)}
    return settings.with_layer(Layer(ignore=others))


@dataclass
class _Trial:
    """Tries edits of a chart, each once: findings beside each other ask for the same ones. before : what was found"""

    subject: ChartSubject
    settings: Settings
    preset: Preset
    before: set[_Place]
    _outlines: dict[_Edit, Outline] = field(default_factory=dict)
    _edited: dict[_Edit, _Edited] = field(default_factory=dict)

    def good(self, edits: Iterable[_Edit], place: _Place) -> Iterator[_Edit]:
        """The edits with plays cheaper than now that lack the finding at a place and bring no other, cheapest first.

        The cost of all comes first, which is quickly found; the rules look at the cheapest only, until one will do.
        """
        assert self.subject.play is not None
        for edit in sorted(edits, key=self._total):
            if self._total(edit) >= self.subject.play.total:
                return
            if self._still_happens(edit, place):
                continue
            if edit not in self._edited:
                self._edited[edit] = _Edited(self._subject_after(edit), self.settings, self.before)
            if self._edited[edit].lacks(place):
                yield edit

    def _total(self, edit: _Edit) -> int:
        return self._outline(edit).total

    def _outline(self, edit: _Edit) -> Outline:
        if edit not in self._outlines:
            self._outlines[edit] = self._one_tap.outline_with(edit.row, edit.column, edit.to)
        return self._outlines[edit]

    @cached_property
    def _one_tap(self) -> OneTap:
        play, pad, overrides = self.subject.play, self.subject.pad, self.subject.overrides
        assert play is not None and pad is not None
        return OneTap(engine_for(pad, self.preset), play.rows, lambda rows: forced_limbs(rows, overrides))

    def _still_happens(self, edit: _Edit, place: _Place) -> bool:
        rule, beat = place
        if rule not in _MOVES or beat is None or self.subject.play is None:
            return False
        row = int(self.subject.play.rows.tick.searchsorted(round(beat * TICKS_PER_BEAT)))
        new, bit = self._outline(edit), EVENTS.index(_MOVES[rule])
        if new.first <= row < new.first + len(new.events):
            return bool(new.events[row - new.first] >> bit & 1)
        return _MOVES[rule] in self.subject.play.moves[row]

    def _subject_after(self, edit: _Edit) -> ChartSubject:
        subject = self.subject
        assert subject.play is not None and subject.pad is not None
        rows = move_tap(subject.play.rows, edit.row, edit.column, edit.to)
        return replace(subject, play=solve(rows, subject.pad, self.preset, subject.overrides, margins=True))


class _Edited:
    """An edited chart, of which the rules are asked one by one, until one tells what was not found before."""

    def __init__(self, subject: ChartSubject, settings: Settings, before: set[_Place]) -> None:
        self._subject, self._settings, self._before = subject, settings, before
        self._rules = rules_of(subject, settings)
        self._to_ask = list(self._rules)
        self._found: set[_Place] = set()

    def lacks(self, place: _Place) -> bool:
        """Whether nothing is found at a place any more, nor anything at places where nothing was found before."""
        self._to_ask.sort(key=lambda code: code != place[0])
        while self._to_ask and place not in self._found and self._found <= self._before:
            self._found |= _places(check_rule(self._to_ask.pop(0), self._rules, self._subject, self._settings))
        return place not in self._found and self._found <= self._before


def _places(findings: Sequence[Finding]) -> set[_Place]:
    ours = (one for one in findings if one.rule.startswith(_FAMILIES) and one.rule not in _RANKED)
    return {(one.rule, one.beat) for one in ours}


def _edits(finding: Finding, play: Play, chart: Chart, around: tuple[int, ...] = _AROUND) -> Iterator[_Edit]:
    """Every tap in rows around the finding's, to every panel that is free there. around : how far they are from it"""
    if finding.beat is None:
        return
    rows = play.rows
    at = int(np.searchsorted(rows.tick, round(finding.beat * TICKS_PER_BEAT)))
    for row in (at + offset for offset in around):
        if not 0 <= row < len(rows):
            continue
        free = (rows.steps[row] == StepKind.NONE) & ~rows.mines[row]
        notes, tick = chart.notes, int(rows.tick[row])
        free[notes.column[(notes.tick <= tick) & (notes.end >= tick)]] = False  # nor where a hold or roll is or ends
        for column in np.flatnonzero(rows.steps[row] == StepKind.TAP).tolist():
            for to in np.flatnonzero(free).tolist():
                yield _Edit(row, column, to)


def _in_words(edit: _Edit, subject: ChartSubject) -> str:
    assert subject.play is not None and subject.pad is not None
    beat = int(subject.play.rows.tick[edit.row]) / TICKS_PER_BEAT
    names = subject.pad.names
    return f"move the note on beat {round(beat, 3):g} from {names[edit.column]} to {names[edit.to]}"
