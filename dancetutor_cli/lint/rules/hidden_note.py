"""DT402: a note that the game does not judge."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class HiddenNote(ChartRule):
    """A note stands inside a warp or a fake segment: it is drawn, or skipped, but it never counts.

    That may be a gimmick. Notes in a run count once.

    Bad: taps inside #WARPS or #FAKES.

    Better: fake notes (F), or none.
    """

    code = "DT402"
    name = "hidden-note"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run of such notes, at its first."""
        for tick, line, count in subject.notes.unjudged():
            what = "a note lies" if count == 1 else f"{count} notes lie"
            yield self.finding(f"{what} inside a warp or a fake segment and never count", subject.at_tick(tick, line))
