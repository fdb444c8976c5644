"""DT105: a BPM, stop or warp that cannot be meant."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ReaderRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject


class OddTiming(ReaderRule):
    """A BPM, stop, delay or warp is negative, not a number, overlaps another or has no BPM to stand on.

    Negative values are an old gimmick; as warps in .ssc they say what they do. They are told as an info, and once in a
    file.

    Bad: #BPMS:0.000;

    Better: #BPMS:0.000=120.000;
    """

    code = "DT105"
    name = "odd-timing"
    codes = frozenset({"odd-timing", "no-bpm", "split-timing-without-bpms", "negative-timing"})
    usual = frozenset({"negative-timing"})

    def check(self, subject: FileSubject | ChartSubject) -> Iterable[Finding]:
        """One finding for each line; gimmicks only where the file has its first."""
        first = self._first(subject)
        return [one for one in super().check(subject) if first or one.severity != "info"]

    def _first(self, subject: FileSubject | ChartSubject) -> bool:
        """Whether neither the song nor a chart before this one has a gimmick."""
        from dancetutor_cli.lint.subject import ChartSubject

        if not isinstance(subject, ChartSubject):
            return True
        before = subject.song.charts[: subject.chart.index]
        warnings = [*subject.song.warnings, *(one for chart in before for one in chart.warnings)]
        return not any(one.code in self.usual for one in warnings)
