"""Rows and tempi that the games do not play as they are written, and notes that are not allowed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule, ReaderRule

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


class OffGrid(ChartRule):
    """A note stands where none of the usual quantisations has one, mostly after a conversion or a slip of the mouse.

    `grid`: the quantisations that are usual, as players name them (16 for 16ths). Rows in a run count once.

    Bad (grid = [3]):

        1000  L
        0001  R
        0000
        0000

    Better (grid = [4]):

        1000  L
        0001  R
        0000
        0000
    """

    code = "DT401"
    name = "off-grid"

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """A list of quantisations a measure of 192 ticks can be cut into."""
        fits = option != "grid" or (
            value and all(isinstance(name, int) and name > 0 and 192 % name == 0 for name in value)
        )
        return None if fits else f"a list of divisors of 192, for example [4, 8, 16], not {value}"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run of such rows, at its first."""
        for tick, line, count in subject.notes.off_grid([int(name) for name in self.options["grid"]]):
            more = f" and {count - 1} more after it" if count > 1 else ""
            yield self.finding(f"this note{more} stands on no {self._names()}", subject.at_tick(tick, line))

    def _names(self) -> str:
        names = [f"{name}{'nd' if name % 10 == 2 and name != 12 else 'th'}" for name in self.options["grid"]]
        return f"{', '.join(names[:-1])} or {names[-1]}"


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
