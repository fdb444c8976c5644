"""DT508: a kind of note that is not allowed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


# Kinds of the file, and what several notes at once make.
KINDS = ("mine", "roll", "hold", "lift", "fake", "keysound", "jump", "hand")


class ForbiddenNotes(ChartRule):
    """The chart has notes of a kind that is not allowed. Off by default; contests switch it on.

    `kinds`: any of mine, roll, hold, lift, fake, jump, hand (three or more steps at once), keysound.

    Bad (kinds = [mine]):

        1000  L
        00M0
        0001  R
        0000

    Better (kinds = [mine]):

        1000  L
        0000
        0001  R
        0000
    """

    code = "DT508"
    name = "forbidden-notes"

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """Names of kinds that there are not."""
        unknown = [kind for kind in value if kind not in KINDS] if option == "kinds" else []
        return f"there is no kind '{unknown[0]}'; there are {', '.join(KINDS)}" if unknown else None

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each kind, at its first note, with their number."""
        for kind in self.options["kinds"]:
            ticks_lines = subject.notes.of_kind(kind)
            if ticks_lines:
                tick, line = ticks_lines[0]
                count = len(ticks_lines)
                what = kind if count == 1 else f"{kind}s ({count})"
                yield self.finding(f"{what} not allowed", subject.at_tick(tick, line))
