"""DT110: a chart that the games skip or merge."""

from __future__ import annotations

from dancetutor_cli.lint.rule import ReaderRule


class OddChart(ReaderRule):
    """A chart lacks its steps type, its notes or a field, or its steps type is unknown.

    The games skip it or mix it up with the next.

    Bad: a #NOTEDATA without #NOTES.

    Better: every chart with #STEPSTYPE and #NOTES.
    """

    code = "DT110"
    name = "odd-chart"
    codes = frozenset({"chart-skipped", "notedata-without-notes", "unknown-steps-type"})
