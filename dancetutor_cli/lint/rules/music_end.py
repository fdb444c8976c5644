"""DT606: notes after the music has ended."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class MusicEnd(FileRule):
    """The last note of a chart, or the end of its last hold, comes after the end of the music.

    `tolerance`: seconds after it that are no finding.

    Bad: a chart of two minutes with the cut music of one. Better: the whole music, or a shorter chart.
    """

    code = "DT606"
    name = "music-end"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding, at the chart that goes on longest."""
        import numpy as np

        music = subject.music
        if music is None or music.seconds is None:
            return
        ends = [
            (float(one.timing.seconds(np.array([max(one.notes.tick.max(), one.notes.end.max())]))[0]), one)
            for one in subject.dance_charts
            if not one.tags.get("MUSIC")
        ]
        last, chart = max(ends, key=lambda end: end[0], default=(0.0, None))
        if chart is not None and last > music.seconds + self.options["tolerance"]:
            said = f"{chart.label} goes on to {last:.1f} s, and the music ends at {music.seconds:.1f} s"
            yield self.finding(said, subject.place(chart.line), chart=chart.index)
