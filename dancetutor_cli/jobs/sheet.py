"""Charts to be drawn as a sheet: solved, linted and counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from dancetutor_cli.chart.density import Density, density
from dancetutor_cli.jobs.analyze import AnalyzeTask, load_song, solved
from dancetutor_cli.lint.check import check_chart
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.lint.subject import ChartSubject


@dataclass(frozen=True)
class Drawable:
    """A chart with all that a sheet shows of it. `counts` : name of a move -> rows."""

    subject: ChartSubject
    findings: tuple[Finding, ...]
    density: Density
    counts: dict[str, int]


def drawable_charts(task: AnalyzeTask) -> Iterator[Drawable]:
    """The selected charts of a file that have notes; FileError if the file cannot be read."""
    song = load_song(task)
    for subject in solved(song, task.selection.charts(song), task):
        if len(subject.chart.notes):
            findings = check_chart(subject, task.settings)
            moves = subject.play.moves if subject.play else ()
            counts = Counter(name for names in moves for name in names)
            yield Drawable(subject, findings, density(subject.chart, task.settings.stream_rows), dict(counts))
