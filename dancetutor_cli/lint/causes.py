"""What forces the doublesteps of a chart, as plain data and in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.lint.chart_figures import Cause
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.play import blame
from dancetutor_cli.play.preset import Preset

_DOUBLESTEP = "DT201"


def causes_of(subject: ChartSubject, preset: Preset) -> tuple[Cause, ...]:
    """The cause of every doublestep of a chart, forced or not, in order of rows."""
    play = subject.play
    if play is None or subject.pad is None:
        return ()
    beats = (play.rows.tick / TICKS_PER_BEAT).tolist()
    return tuple(
        Cause(
            round(beats[one.row], 6),
            one.forced,
            one.cause,
            round(beats[one.cause_row], 6) if one.cause_row >= 0 else None,
            one.cause_column if one.cause_column >= 0 else None,
        )
        for one in blame(play, subject.pad, preset)
    )


def with_causes(findings: Sequence[Finding], causes: Sequence[Cause], panels: Sequence[str]) -> tuple[Finding, ...]:
    """The findings, those about a doublestep with what makes it, where that is not the pattern itself."""
    by_beat = {cause.beat: cause for cause in causes if cause.at_beat is not None and cause.column is not None}
    told = []
    for finding in findings:
        cause = by_beat.get(round(finding.beat, 6)) if finding.beat is not None else None
        if finding.rule == _DOUBLESTEP and cause is not None and cause.column is not None:
            where = f"on beat {round(cause.at_beat or 0.0, 3):g}"
            where += f" ({panels[cause.column]})" if cause.cause != "jump" else ""
            finding = replace(finding, message=f"{finding.message}, because of the {cause.cause} {where}")
        told.append(finding)
    return tuple(told)
