"""The abstract bases of rules, and all rules by code and name: one small class each, by theme under `rules/`.

A rule's docstring is its documentation.
"""

from __future__ import annotations

import importlib
import math
import pkgutil
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, TypeVar

from dancetutor_cli.lint import rules
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.run.errors import UsageError, did_you_mean

if TYPE_CHECKING:
    from dancetutor_cli.chart.pack_files import PackIni
    from dancetutor_cli.lint.findings import Estimate, Sync
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject


BY_METER = "by-meter"  # the value of `max_seconds` that means the table of times
EPSILON = 1e-6
Placed = TypeVar("Placed")
_QUOTED = 4  # most things that one message lists
FAMILIES = {1: "file", 2: "feet", 3: "playability", 4: "timing", 5: "pack", 6: "sync and music"}


class Rule(ABC):
    """A check with a code ("DT201") and a name ("doublestep").

    The code's first digit is the family (`FAMILIES`). Severity and options come from configs/lint/default.yaml;
    `options` are those that hold for the chart. `codes` : the warnings of the reader that the rule reports
    `about_feet` : whether a finding depends on the feet of the chart; if they are unsure, the finding is an info
    `about_tags` : whether the rule is about tags of .sm and .ssc that a .ucs does not have
    `editor_code` : the code of such findings in SMEditor, in the `ignores` of data.sme; "" if it has none
    `foot_rank` : rank among rules that may report the same wrong foot (its move, the turn of the body, how unsure it
        is). Of several findings about one row or its neighbours, the lowest rank is reported; 0: not such a rule
    `foot_reach` : how many rows with a step such findings may be apart, because some rules report the step beside it
    `fixed_by_moves` : whether moving a note may remove a finding; `unwanted_move` : the move that must then be gone
    `only_worst` : whether only the worst rows are reported, so that an edit may bring a new finding of the rule
    """

    code: ClassVar[str]
    name: ClassVar[str]
    former_name: ClassVar[str] = ""  # of an earlier version, which configurations and charts may still hold
    about_feet: ClassVar[bool] = False
    about_tags: ClassVar[bool] = False
    editor_code: ClassVar[str] = ""
    foot_rank: ClassVar[int] = 0
    foot_reach: ClassVar[int] = 0
    fixed_by_moves: ClassVar[bool] = False
    unwanted_move: ClassVar[str] = ""
    only_worst: ClassVar[bool] = False
    codes: ClassVar[frozenset[str]] = frozenset()

    def __init__(self, options: Mapping[str, Any]) -> None:
        self.options = options

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """Return what is wrong with the value of an option, besides its type; None if nothing is."""
        return None

    def finding(self, message: str, place: Mapping[str, Any], **more: Any) -> Finding:
        """Return a finding of this rule. `place` : the result of the subject's `at_row`, `at_line` or `place`"""
        return Finding(
            **{"severity": self.options["severity"], **place, **more}, rule=self.code, name=self.name, message=message
        )


class FileRule(Rule):
    """A rule about a file as a whole."""

    @abstractmethod
    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """Return the findings in one file."""


class SyncRule(FileRule):
    """A rule about the sure syncs of a file, whose music is decoded (`--sync`, or `sync: true`).

    `tag` : the tag of the file at which a finding is placed
    """

    tag: ClassVar[str] = "OFFSET"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """Yield a finding for the file, and one for each chart with timing or music of its own."""
        heard = subject.sync
        if heard is None:
            return
        if heard.sync.is_sure and (message := self.message(heard.sync, subject)):
            yield self.finding(message, subject.tag_place(self.tag))
        for index, sync in heard.of_charts.items():
            if sync.is_sure and (message := self.message(sync, subject)):
                chart = subject.song.charts[index]
                yield self.finding(f"in {chart.label} {message}", subject.place(chart.line), chart=index)

    @abstractmethod
    def message(self, sync: Sync, subject: FileSubject) -> str | None:
        """Return what is wrong with a sync, or None."""


class PackSong(NamedTuple):
    """A song as a `PackRule` receives it. folder : name of the song's folder; sync : a sure sync"""

    folder: str
    sync: Sync


class PackRule(Rule):
    """A rule about all songs of a pack whose music was decoded."""

    @abstractmethod
    def check_pack(self, songs: Sequence[PackSong], ini: PackIni | None) -> str | None:
        """Return what is wrong with the pack, or None."""


class ChartRule(Rule):
    """A rule about one chart."""

    @abstractmethod
    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """Return the findings in one chart."""


class RatedChart(NamedTuple):
    """A chart with its estimate, as a `SongRule` receives it. place : the place of the chart, for `Finding`"""

    steps_type: str
    difficulty: str
    meter: int
    label: str
    estimate: Estimate
    place: Mapping[str, Any]


class SongRule(Rule):
    """A rule about how hard the charts of a song play, compared with the other charts for the same pad."""

    @abstractmethod
    def check(self, chart: RatedChart, charts: Sequence[RatedChart]) -> Iterable[Finding]:
        """Return the findings in one chart. charts : all charts of the song for the same pad"""


class ReaderRule(Rule):
    """A rule that reports the reader's warnings with one of its `codes`, about the song or a chart.

    usual : codes that are never more than an info, because some authors do this on purpose
    """

    usual: ClassVar[frozenset[str]] = frozenset()

    def check(self, subject: FileSubject | ChartSubject) -> Iterable[Finding]:
        """Yield one finding for each line with warnings of the rule's codes."""
        kinds: tuple[tuple[frozenset[str], dict[str, str]], ...]
        kinds = (self.codes - self.usual, {}), (self.usual, {"severity": "info"})
        for codes, least in kinds:
            by_line: dict[int | None, tuple[list[str], dict[str, Any]]] = {}
            for message, place in subject.warnings(codes):
                messages, _ = by_line.setdefault(place["line"], ([], place))
                if not any(known in message for known in messages):
                    messages.append(message)
            for messages, place in by_line.values():
                yield self.finding("; also: ".join(_alike(messages)), place, **least)


def _alike(messages: Iterable[str]) -> Iterator[str]:
    """Yield the messages. Messages that differ only in the first quotation become one.

    For example: "entry 'a' is ignored; the same for 'b'".
    """
    kinds: dict[tuple[str, str], list[str]] = {}
    for message in messages:
        before, _, rest = message.partition("'")
        quoted, _, after = rest.partition("'")
        kinds.setdefault((before, after) if after else (message, ""), []).append(f"'{quoted}'" if after else "")
    for (before, after), (first, *others) in kinds.items():
        more = f" and {len(others) - _QUOTED} more" if len(others) > _QUOTED else ""
        yield before + first + after + (f"; the same for {', '.join(others[:_QUOTED])}{more}" if others else "")


class Occurrence(NamedTuple):
    """One occurrence of a rule's move in a row. seconds : time since the step before, or another time that counts"""

    row: int
    seconds: float
    description: str
    column: int | None = None


class TimedRule(ChartRule):
    """A rule about moves that are reported only if they are quick.

    The option `max_seconds` is the longest time that is quick: a number, or "by-meter", the longest time within which
    at most `share` per cent of the charts of this meter have the move (`lint.rule_settings`). It is at most `slowest`.
    `times` : the name of the move in that table
    `passage_beats` : occurrences less than so many beats apart are one finding, at the surest of them; 0: each
    occurrence is one finding; inf: one finding for the chart
    """

    times: ClassVar[str] = ""
    slowest: ClassVar[float] = math.inf
    passage_beats: ClassVar[float] = 0
    about_feet: ClassVar[bool] = True

    def __init__(self, options: Mapping[str, Any]) -> None:
        super().__init__(options)
        self._longest: dict[tuple[str, int], float] = {}  # (steps type, meter) -> seconds

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """Return what is wrong with `max_seconds` (a number, or by-meter) or `share` (a percentage), or None."""
        if option == "max_seconds" and isinstance(value, str) and value != BY_METER:
            return f"must be a number of seconds, or {BY_METER}"
        return "must be a number of per cent, at most 100" if option == "share" and value > 100 else None

    @abstractmethod
    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Return the occurrences of the move; `check` leaves out the slow ones."""

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """Yield one finding for each quick occurrence, or for each passage of quick occurrences."""
        longest = self.longest(subject) + EPSILON
        quick = [one for one in self.occurrences(subject) if one.seconds <= longest]
        for passage in self.passages(quick, subject):
            rows = [one.row for one in passage]
            row, _, message, column = passage[self.representative(subject, rows) if len(rows) > 1 else 0]
            if len(rows) > 1:
                first, last = (round(subject.beat(one), 3) for one in (rows[0], rows[-1]))
                message += f"; {len(rows)} of them from beat {first:g} to {last:g}"
            least = {"severity": "info"} if self.is_expected(subject, rows) else {}
            yield self.finding(message, subject.at_row(row, column), **least)

    def representative(self, subject: ChartSubject, rows: list[int]) -> int:
        """Return the index of the row in a passage at which the finding is placed and whose message it has."""
        return subject.most_confident(rows) if self.about_feet else 0

    def is_expected(self, subject: ChartSubject, rows: list[int]) -> bool:
        """Whether players of this chart expect the move in these rows; then the finding is never more than an info."""
        return False

    def passages(self, found: list[Occurrence], subject: ChartSubject) -> Iterable[list[Occurrence]]:
        """Return the occurrences in groups, with one finding for each group."""
        return passages(found, lambda one: subject.beat(one.row), self.passage_beats)

    def quick(self, subject: ChartSubject, rows: Iterable[int]) -> list[int]:
        """Return the rows that come quickly enough after the step before; a rule need not check the others."""
        longest = self.longest(subject) + EPSILON
        return [row for row in rows if subject.pause(row) <= longest]

    def longest(self, subject: ChartSubject) -> float:
        """Return the longest time (s) that is still quick in this chart; 0 if no time is."""
        kind = subject.chart.steps_type, subject.chart.meter
        if kind not in self._longest:
            self._longest[kind] = self._longest_of(*kind)
        return self._longest[kind]

    def _longest_of(self, steps_type: str, meter: int) -> float:
        longest = self.options.get("max_seconds", math.inf)
        if longest != BY_METER:
            return float(longest)
        from dancetutor_cli.lint.rule_settings import limit

        return min(limit(self.times, self.options["share"], steps_type, meter), self.slowest)


def passages(found: Iterable[Placed], beat_of: Callable[[Placed], float], most_beats: float) -> Iterator[list[Placed]]:
    """Yield runs of items in order of beats, in which each item is less than `most_beats` after the item before."""
    passage: list[Placed] = []
    for one in found:
        if passage and beat_of(one) - beat_of(passage[-1]) > most_beats - EPSILON:
            yield passage
            passage = []
        passage.append(one)
    if passage:
        yield passage


class MoveRule(TimedRule):
    """A rule that reports every row with a named move, or with a kind of it.

    If the rule has an option `max_seconds`, only rows at most so long after the step before count.
    `description` : the message for a row; a rule with several messages overrides `message`
    """

    move: ClassVar[str]
    description: ClassVar[str]

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Yield each quick row with the move, with the time since the step before."""
        for row in self.rows(subject):
            yield Occurrence(row, subject.pause(row), self.message(subject, row))

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Return the quick rows with the move."""
        return self.quick(subject, subject.rows_with(self.move))

    def message(self, subject: ChartSubject, row: int) -> str:
        """Return the message for this row."""
        return self.description


@cache
def all_rules() -> Mapping[str, type[Rule]]:
    """Return code -> class of every rule, sorted by code."""
    found: dict[str, type[Rule]] = {}
    for module in pkgutil.iter_modules(rules.__path__):
        for value in vars(importlib.import_module(f"{rules.__name__}.{module.name}")).values():
            if isinstance(value, type) and issubclass(value, Rule) and "code" in vars(value):
                found[value.code] = value
    return dict(sorted(found.items()))


_DIGITS = str.maketrans("OIL", "011")  # letters that users type instead of a code's digits


def rule_named(name: str) -> type[Rule]:
    """Return the rule with this code or name; UsageError with the nearest name if no rule has it."""
    for code, rule in all_rules().items():
        if name.upper() == code or (name and name.lower() in (rule.name, rule.former_name)):
            return rule
    code = "DT" + name.upper()[2:].translate(_DIGITS)
    near = did_you_mean(name, [code] if code in all_rules() else (rule.name for rule in all_rules().values()))
    raise UsageError(f"there is no rule '{name}'{near}; see --explain all")


def match_codes(selector: str) -> set[str]:
    """Return the codes that a selector means: a code, a name, a beginning of codes such as "DT2", or "all"."""
    if selector.lower() == "all":
        return set(all_rules())
    found = {code for code in all_rules() if code.startswith(selector.upper())} if selector else set()
    return found or {rule_named(selector).code}


def named_singly(selectors: Iterable[str]) -> frozenset[str]:
    """Return the codes of the rules that the selectors name by code or name, not by family."""
    words = {selector.upper() for selector in selectors}
    return frozenset(
        code for code, rule in all_rules().items() if {code, rule.name.upper(), rule.former_name.upper()} & words - {""}
    )
