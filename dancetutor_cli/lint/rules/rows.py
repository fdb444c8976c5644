"""Rules about rows and tempos that the games do not play as written, and about notes that are not allowed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule, ReaderRule
from dancetutor_cli.run.errors import choose_text

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject


class OddTiming(ReaderRule):
    """A BPM, stop, delay or warp is negative, is not a number, overlaps another one or has no BPM before it.

    Negative values are an old gimmick, for which .ssc files have #WARPS. They are an info, once for each file.

    Bad: #BPMS:0.000;

    Better: #BPMS:0.000=120.000;
    """

    code = "DT105"
    name = "odd-timing"
    codes = frozenset({"odd-timing", "no-bpm", "split-timing-without-bpms", "negative-timing"})
    usual = frozenset({"negative-timing"})

    def check(self, subject: FileSubject | ChartSubject) -> Iterable[Finding]:
        """One finding for each line; gimmicks only in the song or in the first chart that has them."""
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
    """A note is not on a usual quantisation (4th to 64th), usually because of a conversion or a slip of the mouse.

    `grid`: the usual quantisations, as players name them (16 for 16ths). Several such rows in a row are one finding.

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
        """Return what is wrong with a list of quantisations: each must divide a measure of 192 ticks."""
        fits = option != "grid" or (
            value and all(isinstance(name, int) and name > 0 and 192 % name == 0 for name in value)
        )
        return None if fits else f"a list of divisors of 192, for example [4, 8, 16], not {value}"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run of rows off the grid, at its first row."""
        for tick, line, count in subject.notes.off_grid([int(name) for name in self.options["grid"]]):
            notes = "this note is" if count == 1 else f"this note and {count - 1} more after it are"
            yield self.finding(f"{notes} not on a {self._names()}", subject.at_tick(tick, line))

    def _names(self) -> str:
        names = [f"{name}{'nd' if name % 10 == 2 and name != 12 else 'th'}" for name in self.options["grid"]]
        return f"{', '.join(names[:-1])} or {names[-1]}"


class HiddenNote(ChartRule):
    """A note is inside a warp or a fake segment: the games draw it or skip it, but never count it.

    That may be a gimmick. Several such notes in a row are one finding.

    Bad: taps inside #WARPS or #FAKES.

    Better: fake notes (F), or none.
    """

    code = "DT402"
    name = "hidden-note"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run of notes in a warp or a fake segment, at its first note."""
        for tick, line, count in subject.notes.unjudged():
            what = "this note is inside" if count == 1 else f"{count} notes are inside"
            yield self.finding(f"{what} a warp or a fake segment, where nothing counts", subject.at_tick(tick, line))


# The kinds of notes in a file, and the rows with several notes at once.
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
        """Return the message for an unknown kind, or None."""
        unknown = [kind for kind in value if kind not in KINDS] if option == "kinds" else []
        return f"there is no kind '{unknown[0]}'{choose_text(str(unknown[0]), KINDS)}" if unknown else None

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each kind, at its first note, with the number of its notes."""
        for kind in self.options["kinds"]:
            ticks_lines = subject.notes.of_kind(kind)
            if ticks_lines:
                tick, line = ticks_lines[0]
                count = len(ticks_lines)
                what = f"1 {kind} is" if count == 1 else f"{count} {kind}s are"
                yield self.finding(f"{what} not allowed", subject.at_tick(tick, line))
