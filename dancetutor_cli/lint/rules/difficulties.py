"""Rules that compare the charts of a song: difficulties, meters, lengths, and charts that a pack must have."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule, FileRule, RatedChart, ReaderRule, SongRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject


class DuplicateDifficulty(ReaderRule):
    """Two charts of the same steps type have the same difficulty: the games show the second one as an Edit.

    Bad: dance-single Hard twice.

    Better: one Hard, one Challenge, and an Edit with a name.
    """

    code = "DT108"
    name = "duplicate-difficulty"
    codes = frozenset({"duplicate-difficulty"})


class SameNotes(FileRule):
    """Two charts of the same steps type have the same notes at the same times: one of them should differ.

    Bad: a Challenge that is an unchanged copy of the Hard. Better: only one of them.
    """

    code = "DT114"
    name = "same-notes"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each chart that has the notes of a chart before it."""
        first: dict[tuple[object, ...], str] = {}
        for chart in subject.dance_charts:
            notes = chart.notes
            parts = (notes.tick, notes.column, notes.kind, notes.end, notes.judged)
            key = (chart.steps_type, chart.timing, *(part.tobytes() for part in parts))
            if key in first:
                message = f"{chart.label} has the notes of {first[key]}"
                yield self.finding(message, subject.place(chart.line), chart=chart.index)
            first.setdefault(key, chart.label)


class MeterOrder(FileRule):
    """The meters of a steps type do not rise with its difficulties.

    `strictly`: whether two difficulties with the same meter are reported too.

    Bad: Medium 7, Hard 6. Better: Medium 6, Hard 8.
    """

    code = "DT503"
    name = "meter-order"

    _ORDER = ("Beginner", "Easy", "Medium", "Hard", "Challenge")

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each chart whose meter is not above the meter of the chart before it."""
        song = subject.song
        for steps_type in dict.fromkeys(chart.steps_type for chart in song.charts):
            charts = [c for c in song.charts if c.steps_type == steps_type and c.difficulty in self._ORDER]
            charts.sort(key=lambda chart: self._ORDER.index(chart.difficulty))
            for easier, harder in pairwise(charts):
                rises = harder.meter > easier.meter or (harder.meter == easier.meter and not self.options["strictly"])
                if easier.difficulty != harder.difficulty and not rises:
                    than = "no higher than" if harder.meter == easier.meter else "lower than"
                    message = f"{steps_type} {harder.difficulty} has meter {harder.meter}, {than} "
                    message += f"{easier.difficulty} with meter {easier.meter}"
                    yield self.finding(message, subject.place(harder.line), chart=harder.index)


class Length(ChartRule):
    """The time from the first to the last step of the chart is outside the limits.

    `min_seconds`, `max_seconds`: the limits.

    Bad for a contest of two minutes: a chart of three. Better: cut the song.
    """

    code = "DT506"
    name = "length"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """At most one finding."""
        seconds = subject.seconds_played()
        if subject.row_count and not self.options["min_seconds"] <= seconds <= self.options["max_seconds"]:
            low, high = self.options["min_seconds"], self.options["max_seconds"]
            yield self.finding(f"the chart lasts {seconds:.1f} s, not {low:g} to {high:g} s", subject.at_chart())


class MeterOff(SongRule):
    """The meter is at least two levels too high or too low for how hard the chart plays.

    The estimate is on the scale of the song's other charts.

    `by`: the least difference that is reported, in levels. The meter also has to be outside the range of 80 of 100
    charts that play like this one. Nothing is reported if the scale is unknown. Two other charts of the
    pad in the file, the tag #METERTYPE or --meter-scale set the scale. docs/meter.md explains the estimate.

    Bad: Easy 3, Medium 9 (plays like 6), Hard 8. Better: Easy 3, Medium 6, Hard 8.
    """

    code = "DT509"
    name = "meter-off"

    def check(self, chart: RatedChart, charts: Sequence[RatedChart]) -> Iterable[Finding]:
        """One finding if the meter is too high or too low."""
        estimate = chart.estimate
        off = estimate.meter - chart.meter
        if chart.meter > 0 and abs(off) >= self.options["by"] and not estimate.low <= chart.meter <= estimate.high:
            how = "harder" if off > 0 else "easier"
            message = f"plays {abs(off):.1f} levels {how} than its meter {chart.meter}, like {estimate.most(4)}"
            yield self.finding(message, chart.place)


class OrderOfPlay(SongRule):
    """A chart plays easier than another chart of a lower difficulty, whatever their meters are (DT503 compares meters).

    `by`: the least difference that is reported, in levels.

    Bad: a Medium that plays like 7, a Hard that plays like 5. Better: the two exchanged.
    """

    code = "DT510"
    name = "order-of-play"

    _ORDER = ("Beginner", "Easy", "Medium", "Hard", "Challenge")

    def check(self, chart: RatedChart, charts: Sequence[RatedChart]) -> Iterable[Finding]:
        """One finding for the hardest of the easier difficulties that plays harder."""
        if chart.difficulty not in self._ORDER:
            return
        rank = self._ORDER.index(chart.difficulty)
        below = [one for one in charts if one.difficulty in self._ORDER[:rank]]
        hardest = max(below, key=lambda one: one.estimate.meter, default=None)
        if hardest is not None and hardest.estimate.meter - chart.estimate.meter >= self.options["by"]:
            here, there = f"{chart.estimate.meter:.1f}", f"{hardest.estimate.meter:.1f}"
            scale = chart.estimate.scale_name
            message = f"plays like {scale} {here}, easier than {hardest.label}, which plays like {scale} {there}"
            yield self.finding(message, chart.place)


class Slots(FileRule):
    """The song lacks a chart that every song of the pack must have. Off by default.

    `charts`: steps type and difficulty of each, such as "dance-single Hard".

    Bad for a pack with an Easy of every song: a song without. Better: a dance-single Easy.
    """

    code = "DT512"
    name = "slots"
    about_tags = True

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding that names all missing charts."""
        there = {f"{chart.steps_type} {chart.difficulty}".lower() for chart in subject.dance_charts}
        missing = [str(slot) for slot in self.options["charts"] if str(slot).lower() not in there]
        if missing:
            yield self.finding(f"there is no {' and no '.join(missing)}; the pack requires it", subject.place())
