"""The abstract bases of rules: one small class per file under `rules/`, its docstring is its documentation."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from dancetutor_cli.lint.finding import Finding

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject

BY_METER = "by-meter"  # what `max_seconds` says where the table of times is to decide
EPSILON = 1e-6
FAMILIES = {1: "file", 2: "feet", 3: "playability", 4: "timing", 5: "pack"}


class Rule(ABC):
    """A check with a code ("DT201") and a name ("doublestep").

    The code's first digit is the family (`FAMILIES`). Severity and options come from configs/lint/default.yaml;
    `options` is what holds for the chart in hand. `codes` : warnings of the reader that the rule is about.
    `about_feet` : whether a finding is true only if the feet are these; where they are unsure it is no warning
    """

    code: ClassVar[str]
    name: ClassVar[str]
    about_feet: ClassVar[bool] = False
    codes: ClassVar[frozenset[str]] = frozenset()

    def __init__(self, options: Mapping[str, Any]) -> None:
        self.options = options

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """What is wrong with the value of an option, beyond its kind; None if nothing."""
        return None

    def finding(self, message: str, place: Mapping[str, Any], **more: Any) -> Finding:
        """A finding of this rule; `place` is what `at_row`, `at_line` or `place` of the subject gave."""
        return Finding(self.code, self.name, self.options["severity"], message, **{**place, **more})


class FileRule(Rule):
    """A rule about a file as a whole."""

    @abstractmethod
    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """Findings in one file."""


class ChartRule(Rule):
    """A rule about one chart."""

    @abstractmethod
    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """Findings in one chart."""


class ReaderRule(Rule):
    """A rule that hands on warnings of the reader, about the song or about a chart: those of its `codes`."""

    def check(self, subject: FileSubject | ChartSubject) -> Iterable[Finding]:
        """One finding for each warning that is claimed."""
        for message, place in subject.warnings(self.codes):
            yield self.finding(message, place)


class Happening(NamedTuple):
    """One time that what a rule is about happens: in a row, so many seconds after the step before (or what counts)."""

    row: int
    seconds: float
    said: str
    column: int | None = None


class TimedRule(ChartRule):
    """A rule about moves that are worth a word only if they are quick.

    Option `max_seconds` says how quick: a number, or "by-meter": what at most `share` per cent of the charts of this
    meter contain, see `lint.times`. `times` : what the move is called there
    """

    times: ClassVar[str] = ""
    about_feet: ClassVar[bool] = True

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """A time is a number or by-meter, a share one of per cent."""
        if option == "max_seconds" and isinstance(value, str) and value != BY_METER:
            return f"is a number of seconds, or {BY_METER}"
        return "is a number of per cent, at most 100" if option == "share" and value > 100 else None

    @abstractmethod
    def happens(self, subject: ChartSubject) -> Iterable[Happening]:
        """Every time it happens, however slow."""

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each that is quick enough."""
        longest = self.longest(subject) + EPSILON
        for row, seconds, said, column in self.happens(subject):
            if seconds <= longest:
                yield self.finding(said, subject.at_row(row, column))

    def longest(self, subject: ChartSubject) -> float:
        """The longest time (s) that is still quick in this chart; 0: nothing is."""
        longest = self.options.get("max_seconds", math.inf)
        if longest != BY_METER:
            return float(longest)
        from dancetutor_cli.lint.times import limit

        return limit(self.times, self.options["share"], subject.chart.steps_type, subject.chart.meter)


class MoveRule(TimedRule):
    """A rule that reports every row in which a named move, or a kind of it, happens.

    With an option `max_seconds` only those rows count that come at most so long after the step before.
    `said` : what to say about a row; a rule that has more to tell has a `message` of its own
    """

    move: ClassVar[str]
    said: ClassVar[str]

    def happens(self, subject: ChartSubject) -> Iterable[Happening]:
        """Each row with the move, with the time since the step before."""
        for row in self.rows(subject):
            yield Happening(row, subject.pause(row), self.message(subject, row))

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Rows with the move."""
        return subject.rows_with_any(self.move)

    def message(self, subject: ChartSubject, row: int) -> str:
        """What to say about this row."""
        return self.said
