"""DT113: lines that games and tools read differently."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


_ENDED = ("BPMS", "STOPS", "DELAYS", "WARPS", "OFFSET", "DISPLAYBPM")


class TwoReadings(FileRule):
    """A `;` is missing after a tag of the timing, or #DISPLAYBPM is written as #BPMS: not all read it alike.

    The games end a value where a line starts with `#`; other readers go on to the next `;`. Of #DISPLAYBPM:0=120; the
    games show 0.

    Bad: #BPMS:0.000=120.000 without `;`. Better: #BPMS:0.000=120.000;
    """

    code = "DT113"
    name = "two-readings"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each tag."""
        from dancetutor_cli.chart.msd import scan

        data = subject.song.data
        for tag in scan(data):
            if tag.name not in _ENDED or not tag.spans:
                continue
            place = subject.place(data.count(b"\n", 0, tag.start) + 1)
            end = tag.spans[-1][1]
            if data[end : end + 1] != b";":
                yield self.finding(f"no ';' after #{tag.name}", place)
            elif tag.name == "DISPLAYBPM" and any(b"=" in data[a:b] for a, b in tag.spans):
                yield self.finding("#DISPLAYBPM has a '=': it is a BPM, two as 90:180, or *", place)
