"""DT607: a preview outside of the music, or of no length."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class Preview(FileRule):
    """#SAMPLESTART and #SAMPLELENGTH name a part that the music has not, or none: the games play something else.

    `tolerance`: seconds after the end of the music that are no finding. Without the tags the games choose a part.

    Bad: #SAMPLELENGTH:0; Better: #SAMPLELENGTH:15;
    """

    code = "DT607"
    name = "preview"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        from dancetutor_cli.chart.timing_tags import number

        tags = {name: subject.song.tags.get(name, "").strip() for name in ("SAMPLESTART", "SAMPLELENGTH")}
        start, length = (float(number(tags[name])[0]) if tags[name] else None for name in tags)
        end = subject.music.seconds if subject.music else None
        if length is not None and length <= 0:
            yield self.finding(f"the preview lasts {length:g} s", subject.tag_place("SAMPLELENGTH"))
        elif start is not None and start < 0:
            yield self.finding(f"the preview starts at {start:g} s, before the music", subject.tag_place("SAMPLESTART"))
        elif start is not None and end is not None and start + (length or 0) > end + self.options["tolerance"]:
            said = f"the preview goes from {start:g} to {start + (length or 0):g} s, and the music ends at {end:.1f} s"
            yield self.finding(said, subject.tag_place("SAMPLESTART"))
