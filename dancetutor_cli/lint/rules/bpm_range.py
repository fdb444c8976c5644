"""DT507: a tempo outside the limits."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class BpmRange(ChartRule):
    """A BPM of the chart's timing is below or above the limits. Off by default; contests switch it on.

    `min_bpm`, `max_bpm`: the limits.

    Bad for a contest of 60 to 200 BPM: #BPMS:0=240; Better: #BPMS:0=120;
    """

    code = "DT507"
    name = "bpm-range"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """At most one finding: the first tempo outside."""
        for bpm in subject.tempos():
            if not self.options["min_bpm"] <= bpm <= self.options["max_bpm"]:
                low, high = self.options["min_bpm"], self.options["max_bpm"]
                yield self.finding(f"a tempo of {bpm:g} BPM, not {low:g} to {high:g}", subject.at_chart())
                break
