"""Rules about notes: rows and tempos that games do not play as written, notes that are not allowed, holds and mines."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import EPSILON, ChartRule, Occurrence, ReaderRule, TimedRule
from dancetutor_cli.lint.rules.files import OddNotes
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
        for tick, line, count in subject.notes.unjudged_runs():
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


_NEAR = 2  # measures


class BrokenHold(ReaderRule):
    """A hold has no end, an end has no head, or a note stands inside a hold: the games drop one of the two.

    Nothing is reported near a misread row (DT102), because the missing head or end may be in that row.

    Bad:

        2000
        0000
        1000
        3000

    Better:

        2000  L
        3000
        1000  L
        0001  R
    """

    code = "DT106"
    name = "broken-hold"
    codes = frozenset({"unmatched-head", "unmatched-tail"})

    def check(self, subject: FileSubject | ChartSubject) -> Iterable[Finding]:
        """One finding for each line, except lines within two measures of a misread row."""
        from dancetutor_cli.lint.subject import ChartSubject

        found = list(super().check(subject))
        if not found or not isinstance(subject, ChartSubject):
            return found
        misread = [
            place["measure"] for _, place in subject.warnings(OddNotes.codes - OddNotes.usual) if "measure" in place
        ]
        return [
            one for one in found if not any(abs(one.measure - at) <= _NEAR for at in misread if one.measure is not None)
        ]


class MineUnderHold(TimedRule):
    """A mine comes under a foot that can hardly step aside, because a hold keeps the weight on it.

    Either this foot is on the hold, or the other foot is and this foot has just stepped. Nothing is reported before a
    wall of three or more mines, because everybody waits between the panels there.

    `max_seconds`: the longest time between the step and the mine. A foot has left a tap after about a tenth of a
    second.

    Bad (max_seconds = 1.5):

        0001  R
        2000  L
        000M
        3000

    Better (max_seconds = 1.5):

        0001  R
        2000  L
        00M0
        3000
    """

    code = "DT303"
    name = "mine-under-hold"
    times = "mine-under-hold"

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Yield each row with a mine under a foot that cannot step aside, with the time since the foot's step."""
        reported: set[int] = set()
        for row, column, foot, seconds in subject.facts.mines_under_pinned_feet() if subject.facts else ():
            message = f"the {('left', 'right')[foot]} foot cannot step aside from the mine because of a hold"
            if row not in reported and seconds <= self.longest(subject) + EPSILON:  # once for a row, not for each foot
                reported.add(row)
                yield Occurrence(row, seconds, message, column)


class StuckHold(ChartRule):
    """There is no way to release a hold: a mine waits on its panel, or the limb is needed elsewhere at once.

    `mine_seconds`: a mine on the same panel is reported if it comes at most this long after the end of the hold.
    `min_seconds`: the least time between the end of the hold and the limb's next step on another panel. 0 allows any
    time, because the games still count a hold that is released shortly before its end.

    Bad (mine_seconds = 0.6):

        2000  L
        3000
        M001  R
        0000

    Better (mine_seconds = 0.6):

        2000  L
        3000
        0001  R
        M000
    """

    code = "DT306"
    name = "stuck-hold"
    about_feet = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each mine that comes too soon after a hold, and for each step that comes too soon."""
        feet = subject.facts
        for row, column, seconds in feet.mines_after_holds(self.options["mine_seconds"]) if feet else ():
            message = f"a mine is on this panel {seconds * 1000:.0f} ms after the end of its hold"
            yield self.finding(message, subject.at_row(row, column))
        for row, column, seconds in feet.releases(self.options["min_seconds"]) if feet else ():
            late = f"{max(seconds, 0) * 1000:.0f} ms"
            name = feet.limb_name(row, column) if feet else ""
            message = f"the {name} holds another panel until {late} before this step"
            yield self.finding(message, subject.at_row(row, column))


class MineInTheWay(ChartRule):
    """A mine is on the panel of the next step, so shortly before it that the foot may hit the mine.

    `max_seconds`: mines at most this long before the step count; the games' mine window is about 0.07 s.

    Bad (max_seconds = 0.6):

        1000  L
        000M
        0001  R
        0000

    Better (max_seconds = 0.6):

        1000  L
        00M0
        0001  R
        0000
    """

    code = "DT307"
    name = "mine-in-the-way"
    about_feet = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each row with a step too soon after a mine on its panel."""
        limit = self.options["max_seconds"]
        reported: set[int] = set()
        for row, column, seconds in sorted(subject.facts.mines_before_steps(limit)) if subject.facts else ():
            if row in reported:  # once for a row, not for each foot
                continue
            reported.add(row)
            message = f"a mine is on this panel {seconds * 1000:.0f} ms before the foot arrives"
            yield self.finding(message, subject.at_row(row, column))
