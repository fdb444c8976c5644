"""The abstract bases of rules: one small class per file under `rules/`, its docstring is its documentation."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from dancetutor_cli.lint.model import Finding

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject

FAMILIES = {1: "file", 2: "feet", 3: "playability", 4: "timing", 5: "pack"}


class Rule(ABC):
    """A check with a code ("DT201") and a name ("doublestep").

    The code's first digit is the family (`FAMILIES`). Severity and options come from configs/lint/default.yaml;
    `options` is what holds for the chart in hand. `codes` : warnings of the reader that the rule is about.
    """

    code: ClassVar[str]
    name: ClassVar[str]
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


class MoveRule(ChartRule):
    """A chart rule that reports every row in which a named move, or a kind of it, happens.

    With an option `max_seconds` only those rows count that come at most so long after the step before.
    `said` : what to say about a row; a rule that has more to tell has a `message` of its own
    """

    move: ClassVar[str]
    said: ClassVar[str]

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each row with the move."""
        rows, longest = subject.rows_with_any(self.move), self.options.get("max_seconds", math.inf)
        for row in rows:
            if subject.pause(row) <= longest + 1e-6:
                yield self.finding(self.message(subject, row), subject.at_row(row))

    def message(self, subject: ChartSubject, row: int) -> str:
        """What to say about this row."""
        return self.said
