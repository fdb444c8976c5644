"""Small edits that would mend a finding: one note moved to another panel, proven by solving the edited chart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Chart
from dancetutor_cli.lint.check import check_chart
from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.settings import Settings
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.play import Play, Rows, StepKind, solve
from dancetutor_cli.play.preset import Preset

# What can be mended by moving a note: doublestep, spin, jump-spin, ambiguous start, triple step.
MENDABLE = ("DT201", "DT202", "DT203", "DT207", "DT209")
_FAMILIES = ("DT2", "DT3")  # the edit must bring no new finding of these
_AROUND = (0, -1, 1)  # rows in which a note may be moved, nearest first


@dataclass(frozen=True, slots=True)
class _Edit:
    row: int
    column: int
    to: int


def with_suggestions(
    findings: Sequence[Finding], subject: ChartSubject, settings: Settings, preset: Preset
) -> tuple[Finding, ...]:
    """The findings, those that one moved note would remove with the edit in words. The chart is not changed."""
    if subject.play is None or subject.pad is None:
        return tuple(findings)
    before = _places(findings)
    told: list[Finding] = []
    for finding in findings:
        best: tuple[int, str] | None = None
        for edit in _edits(finding, subject.play, subject.chart) if finding.rule in MENDABLE else ():
            play = solve(_edited(subject.play.rows, edit), subject.pad, preset, subject.overrides, margins=True)
            found = _places(check_chart(replace(subject, play=play), settings))
            mended = (finding.rule, finding.beat) not in found and found <= before
            if mended and (best is None or play.total < best[0]):
                best = play.total, _in_words(edit, subject)
        told.append(finding if best is None else replace(finding, suggestion=best[1]))
    return tuple(told)


def _places(findings: Sequence[Finding]) -> set[tuple[str, float | None]]:
    return {(finding.rule, finding.beat) for finding in findings if finding.rule.startswith(_FAMILIES)}


def _edits(finding: Finding, play: Play, chart: Chart) -> Iterator[_Edit]:
    """Every tap in and around the finding's row, to every panel that is free there."""
    if finding.beat is None:
        return
    rows = play.rows
    at = int(np.searchsorted(rows.tick, round(finding.beat * TICKS_PER_BEAT)))
    for row in (at + offset for offset in _AROUND):
        if not 0 <= row < len(rows):
            continue
        free = (rows.steps[row] == StepKind.NONE) & ~rows.mines[row]
        notes, tick = chart.notes, int(rows.tick[row])
        free[notes.column[(notes.tick <= tick) & (notes.end >= tick)]] = False  # nor where a hold or roll is or ends
        for column in np.flatnonzero(rows.steps[row] == StepKind.TAP).tolist():
            for to in np.flatnonzero(free).tolist():
                yield _Edit(row, column, to)


def _edited(rows: Rows, edit: _Edit) -> Rows:
    steps = rows.steps.copy()
    steps[edit.row, edit.to], steps[edit.row, edit.column] = steps[edit.row, edit.column], StepKind.NONE
    return replace(rows, steps=steps)


def _in_words(edit: _Edit, subject: ChartSubject) -> str:
    assert subject.play is not None and subject.pad is not None
    beat = int(subject.play.rows.tick[edit.row]) / TICKS_PER_BEAT
    names = subject.pad.names
    return f"move the note on beat {round(beat, 3):g} from {names[edit.column]} to {names[edit.to]}"
