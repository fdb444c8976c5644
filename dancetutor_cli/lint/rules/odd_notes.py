"""DT102: note data that games read differently."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ReaderRule

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject

_LISTED = 5  # lines


class OddNotes(ReaderRule):
    """Rows are too short or too long, characters are unknown, or rows are so close that one overwrites the other.

    Each game reads such notes in its own way; this program reads them as ITGmania does. StepF2's own notation,
    StepManiaX notes in charts of other games, and charts for several players are an info. The same problem in several
    rows of a chart is one finding, and so is a file without line breaks.

    Bad:

        1000  L
        001
        0x00
        0001  R

    Better:

        1000  L
        0010  R
        0100  L
        0001  R
    """

    code = "DT102"
    name = "odd-notes"
    codes = frozenset(
        {
            "compound-note",
            "odd-keysound",
            "long-row",
            "short-row",
            "unknown-note",
            "row-collision",
            "several-players",
            "stepf2-note",
            "stepmaniax-note",
        }
    )
    usual = frozenset({"several-players", "stepf2-note", "stepmaniax-note"})

    def check(self, subject: FileSubject | ChartSubject) -> Iterable[Finding]:
        """One finding for each that is odd, with its lines; of charts without line breaks one in the file's first."""
        from dancetutor_cli.lint.subject import ChartSubject

        found = list(super().check(subject))
        if not found or not isinstance(subject, ChartSubject):
            return found
        if _flattened(subject.song, subject.chart):
            before = subject.song.charts[: subject.chart.index]
            if any(_flattened(subject.song, chart) for chart in before):
                return []
            said = "the line breaks are missing: the rows of a measure are read as one long row"
            return [replace(found[0], message=said)]
        alike: dict[tuple[str, str], list[Finding]] = {}
        for one in found:
            alike.setdefault((one.message, one.severity), []).append(one)
        return [_with_lines(same) for same in alike.values()]


def _with_lines(same: list[Finding]) -> Finding:
    """The first of findings that say the same, with the lines of the others."""
    lines = [str(one.line) for one in same[1:]]
    if not lines:
        return same[0]
    more = f"{', '.join(lines[:_LISTED])}{' ...' if len(lines) > _LISTED else ''}"
    return replace(same[0], message=f"{same[0].message}; {len(same)} rows are like this, also on line {more}")


def _flattened(song: Song, chart: Chart) -> bool:
    """Whether a chart of several measures stands on one line, a measure a row."""
    start, end = chart.notes_span
    text = song.data[start:end].strip()
    return b"\n" not in text and b"\r" not in text and text.count(b",") > 0
