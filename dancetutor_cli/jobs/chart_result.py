"""What is told of one chart of `analyze`: findings, and what else is wanted."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from dancetutor_cli.jobs.result import ChartResult
from dancetutor_cli.lint.chart_figures import AlternativeResult, Cause, Figures
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.lint.presets import mismatch, preset_for

if TYPE_CHECKING:
    from dancetutor_cli.jobs.analyze import AnalyzeTask
    from dancetutor_cli.lint.subject import ChartSubject
    from dancetutor_cli.play.preset import Preset


def chart_result(subject: ChartSubject, task: AnalyzeTask) -> ChartResult:
    """What a task wants to know of a chart."""
    from dancetutor_cli.lint.excerpt import arrows, with_excerpts

    chart, play = subject.chart, subject.play
    preset = preset_for(chart, task.path, task.presets)
    findings, causes = _findings(subject, task, preset)
    return ChartResult(
        index=chart.index,
        steps_type=chart.written_type,
        player=chart.player,
        difficulty=chart.difficulty,
        meter=chart.meter,
        description=chart.description,
        playable=play is not None,
        row_count=len(subject.step_rows),
        cost=0 if play is None else play.total,
        counts=subject.counts,
        findings=with_excerpts(findings, play) if play is not None and task.want_excerpts else findings,
        rows=_rows(subject) if task.want_rows else None,
        arrows="" if subject.pad is None else arrows(subject.pad),
        figures=_figures(subject, task) if task.want_figures else None,
        alternatives=_alternatives(subject, preset, task.alternatives) if task.alternatives else None,
        causes=causes,
        ambiguous=tuple(_ambiguous(subject)) if task.want_rows else None,
        preset=None if play is None else play.preset,
        mismatch=None if play is None else mismatch(preset, chart.steps_type),
    )


def _rows(subject: ChartSubject) -> str:
    from dancetutor_cli.formats.play_rows import json_rows

    return "[]" if subject.play is None else json_rows(subject.play, subject.file_lines)


def _findings(
    subject: ChartSubject, task: AnalyzeTask, preset: Preset
) -> tuple[tuple[Finding, ...], tuple[Cause, ...] | None]:
    """What the linter finds; causes of doublesteps and suggestions where somebody wants them: they take long."""
    from dancetutor_cli.lint.check import check_chart

    findings, causes = check_chart(subject, task.settings), None
    if task.want_rows or task.suggest:
        from dancetutor_cli.lint.causes import causes_of, with_causes

        causes = causes_of(subject, preset)
        findings = with_causes(findings, causes, subject.pad.names if subject.pad else ())
    if task.suggest:
        from dancetutor_cli.lint.suggest import with_suggestions

        findings = with_suggestions(findings, subject, task.settings, preset)
    return findings, causes


def _alternatives(subject: ChartSubject, preset: Preset, count: int) -> tuple[AlternativeResult, ...]:
    from dancetutor_cli.lint.alternatives import alternatives_of

    return alternatives_of(subject, preset, count)


def _figures(subject: ChartSubject, task: AnalyzeTask) -> Figures:
    from dancetutor_cli.chart.density import density
    from dancetutor_cli.lint.tech_counts import facing_counts, tech_counts

    dense = density(subject.chart, task.settings.stream_rows)
    return Figures(
        dense.mean, dense.peak, dense.breakdown, dense.stream_measures, tech_counts(subject),
        subject.seconds_played(), facing_counts(subject),
    )  # fmt: skip


def _ambiguous(subject: ChartSubject) -> Iterator[tuple[float, str]]:
    from dancetutor_cli.chart.model import TICKS_PER_BEAT
    from dancetutor_cli.play import Ambiguity

    play = subject.play
    if play is not None and play.ambiguity is not None:
        for row in play.ambiguity.nonzero()[0].tolist():
            kind = Ambiguity(int(play.ambiguity[row])).name.lower()
            yield round(int(play.rows.tick[row]) / TICKS_PER_BEAT, 6), kind
