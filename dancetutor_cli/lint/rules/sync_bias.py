"""DT601: the music is neither on the beats nor 9 ms after them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import ITG, NULL, Finding
from dancetutor_cli.lint.rule import SyncRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.findings import Sync
    from dancetutor_cli.lint.subject import FileSubject


class SyncBias(SyncRule):
    """The music is neither on the beats (null) nor 9 ms after them (ITG): players hear that it is off.

    `tolerance`: differences of at most this many ms from both are not reported. Needs `--sync`. A song that is half a
    beat off is reported by DT603. A file without #OFFSET is reported too: the games take 0.

    Bad: #OFFSET:0.025; with music that is at the beats. Better: #OFFSET:0.000;
    """

    code = "DT601"
    name = "sync-bias"
    about_tags = True

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """Those of its syncs, and one for a file without #OFFSET."""
        if subject.sync is not None and "OFFSET" not in subject.song.tags:
            yield self.finding("there is no #OFFSET; the games take 0 s", subject.place())
        yield from super().check(subject)

    def message(self, sync: Sync, subject: FileSubject) -> str | None:
        """What to change, to the one and to the other."""
        bias = sync.bias_ms
        if bias is None or sync.beat_off or min(abs(bias - NULL), abs(bias - ITG)) <= self.options["tolerance"]:
            return None
        side = "after" if bias > 0 else "before"
        to = [f"{(one - bias) / 1000:+.3f} for {name}" for one, name in ((NULL, "null"), (ITG, "ITG"))]
        return f"the music is {abs(bias):.1f} ms {side} the beats; change #OFFSET by {' or '.join(to)}"
