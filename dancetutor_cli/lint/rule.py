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


BY_METER = "by-meter"  # what `max_seconds` says where the table of times is to decide
EPSILON = 1e-6
Placed = TypeVar("Placed")
_QUOTED = 4  # things that a message about several lists
FAMILIES = {1: "file", 2: "feet", 3: "playability", 4: "timing", 5: "pack", 6: "sync and music"}


class Rule(ABC):
    """A check with a code ("DT201") and a name ("doublestep").

    The code's first digit is the family (`FAMILIES`). Severity and options come from configs/lint/default.yaml;
    `options` is what holds for the chart in hand. `codes` : warnings of the reader that the rule is about.
    `about_feet` : whether a finding is true only if the feet are these; where they are unsure it is no warning
    `about_tags` : whether it is about what .sm and .ssc say of a song; a .ucs says nothing of it
    `editor_code` : what SMEditor calls such findings in the `ignores` of data.sme; "" if nothing
    `foot_rank` : of rules that see one wrong foot from several sides (what it does, where the body turns for it, how
        unsure it is): of several about one row, or about neighbours, the lowest is reported; 0: none of these rules
    `foot_reach` : how many rows with a step apart these may be; some speak of a step and of the one beside it
    `fixed_by_moves` : whether a note on another panel may remove a finding; `unwanted_move` : what must be gone then
    `only_worst` : whether only the worst rows are reported, so that a new finding in place of an old one is no harm
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
        """What is wrong with the value of an option, beyond its kind; None if nothing."""
        return None

    def finding(self, message: str, place: Mapping[str, Any], **more: Any) -> Finding:
        """A finding of this rule; `place` is what `at_row`, `at_line` or `place` of the subject gave."""
        return Finding(
            **{"severity": self.options["severity"], **place, **more}, rule=self.code, name=self.name, message=message
        )


class FileRule(Rule):
    """A rule about a file as a whole."""

    @abstractmethod
    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """Findings in one file."""


class SyncRule(FileRule):
    """A rule about music that was decoded (`--sync`, or `sync: true`): about each sync of a file that is sure.

    `tag` : of the file's tags the one that a finding stands at
    """

    tag: ClassVar[str] = "OFFSET"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """A finding for the file, and one for each chart with timing or music of its own."""
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
        """What is wrong with a sync, or None."""


class PackSong(NamedTuple):
    """A song as a `PackRule` sees it. folder : its own, for people; sync : sure"""

    folder: str
    sync: Sync


class PackRule(Rule):
    """A rule about the songs of a pack together, whose music was heard."""

    @abstractmethod
    def check_pack(self, songs: Sequence[PackSong], ini: PackIni | None) -> str | None:
        """What is wrong with the pack, or None."""


class ChartRule(Rule):
    """A rule about one chart."""

    @abstractmethod
    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """Findings in one chart."""


class RatedChart(NamedTuple):
    """A chart with how hard it plays, as a `SongRule` sees it; place : where it starts, for `Finding`."""

    steps_type: str
    difficulty: str
    meter: int
    label: str
    estimate: Estimate
    place: Mapping[str, Any]


class SongRule(Rule):
    """A rule about how hard the charts of a song play; those of one pad come together."""

    @abstractmethod
    def check(self, chart: RatedChart, charts: Sequence[RatedChart]) -> Iterable[Finding]:
        """Findings in one chart, beside all charts of its pad."""


class ReaderRule(Rule):
    """A rule that hands on warnings of the reader, about the song or about a chart: those of its `codes`.

    usual : codes of what some authors do on purpose: never more than an info
    """

    usual: ClassVar[frozenset[str]] = frozenset()

    def check(self, subject: FileSubject | ChartSubject) -> Iterable[Finding]:
        """One finding for each line with warnings that are claimed."""
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
    """Messages; those that differ only in what they quote first are one: "entry 'a' is ignored; the same for 'b'"."""
    kinds: dict[tuple[str, str], list[str]] = {}
    for message in messages:
        before, _, rest = message.partition("'")
        quoted, _, after = rest.partition("'")
        kinds.setdefault((before, after) if after else (message, ""), []).append(f"'{quoted}'" if after else "")
    for (before, after), (first, *others) in kinds.items():
        more = f" and {len(others) - _QUOTED} more" if len(others) > _QUOTED else ""
        yield before + first + after + (f"; the same for {', '.join(others[:_QUOTED])}{more}" if others else "")


class Occurrence(NamedTuple):
    """One occurrence of what a rule is about: in a row, so many seconds after the step before (or what counts)."""

    row: int
    seconds: float
    description: str
    column: int | None = None


class TimedRule(ChartRule):
    """A rule about moves that are reported only if they are quick.

    Option `max_seconds` says how quick: a number, or "by-meter": what at most `share` per cent of the charts of this
    meter contain, see `lint.rule_settings`, but not more than `slowest`. `times` : what the move is called there.
    `passage_beats` : those at most so many beats apart are one finding, at the surest of them; 0: each is one,
    endless: one for a chart
    """

    times: ClassVar[str] = ""
    slowest: ClassVar[float] = math.inf
    passage_beats: ClassVar[float] = 0
    about_feet: ClassVar[bool] = True

    def __init__(self, options: Mapping[str, Any]) -> None:
        super().__init__(options)
        self._longest: dict[tuple[str, int], float] = {}  # by steps type and meter

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """What is wrong with `max_seconds` (a number, or by-meter) or `share` (a percentage)."""
        if option == "max_seconds" and isinstance(value, str) and value != BY_METER:
            return f"must be a number of seconds, or {BY_METER}"
        return "must be a number of per cent, at most 100" if option == "share" and value > 100 else None

    @abstractmethod
    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Every time it happens, however slow."""

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each that is quick enough, or for each passage of them."""
        longest = self.longest(subject) + EPSILON
        quick = [one for one in self.occurrences(subject) if one.seconds <= longest]
        for passage in self.passages(quick, subject):
            rows = [one.row for one in passage]
            row, _, message, column = passage[self.representative(subject, rows) if len(rows) > 1 else 0]
            if len(rows) > 1:
                first, last = (round(subject.beat(one), 3) for one in (rows[0], rows[-1]))
                message += f"; {len(rows)} of them from beat {first:g} to {last:g}"
            least = {"severity": "info"} if self.no_surprise(subject, rows) else {}
            yield self.finding(message, subject.at_row(row, column), **least)

    def representative(self, subject: ChartSubject, rows: list[int]) -> int:
        """Place in the rows of a passage of the one that its finding stands at and speaks of."""
        return subject.most_confident(rows) if self.about_feet else 0

    def no_surprise(self, subject: ChartSubject, rows: list[int]) -> bool:
        """Whether players of this chart expect what happens in these rows; then it is never more than an info."""
        return False

    def passages(self, found: list[Occurrence], subject: ChartSubject) -> Iterable[list[Occurrence]]:
        """What is reported in one finding each."""
        return passages(found, lambda one: subject.beat(one.row), self.passage_beats)

    def quick(self, subject: ChartSubject, rows: Iterable[int]) -> list[int]:
        """Those of some rows that come quickly enough after the step before: others need not be looked at."""
        longest = self.longest(subject) + EPSILON
        return [row for row in rows if subject.pause(row) <= longest]

    def longest(self, subject: ChartSubject) -> float:
        """The longest time (s) that is still quick in this chart; 0: nothing is."""
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
    """What is found in the order of its beats, in runs of which each is less than so many beats after the last."""
    passage: list[Placed] = []
    for one in found:
        if passage and beat_of(one) - beat_of(passage[-1]) > most_beats - EPSILON:
            yield passage
            passage = []
        passage.append(one)
    if passage:
        yield passage


class MoveRule(TimedRule):
    """A rule that reports every row in which a named move, or a kind of it, happens.

    With an option `max_seconds` only those rows count that come at most so long after the step before.
    `description` : what to say about a row; a rule that has more to say has a `message` of its own
    """

    move: ClassVar[str]
    description: ClassVar[str]

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Each quick row with the move, with the time since the step before."""
        for row in self.rows(subject):
            yield Occurrence(row, subject.pause(row), self.message(subject, row))

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Quick rows with the move."""
        return self.quick(subject, subject.rows_with(self.move))

    def message(self, subject: ChartSubject, row: int) -> str:
        """What to say about this row."""
        return self.description


@cache
def all_rules() -> Mapping[str, type[Rule]]:
    """Code -> class of every rule, sorted by code."""
    found: dict[str, type[Rule]] = {}
    for module in pkgutil.iter_modules(rules.__path__):
        for value in vars(importlib.import_module(f"{rules.__name__}.{module.name}")).values():
            if isinstance(value, type) and issubclass(value, Rule) and "code" in vars(value):
                found[value.code] = value
    return dict(sorted(found.items()))


_DIGITS = str.maketrans("OIL", "011")  # letters that are typed for digits of a code


def rule_named(name: str) -> type[Rule]:
    """The rule with this code or name; UsageError with the nearest name."""
    for code, rule in all_rules().items():
        if name.upper() == code or (name and name.lower() in (rule.name, rule.former_name)):
            return rule
    code = "DT" + name.upper()[2:].translate(_DIGITS)
    near = did_you_mean(name, [code] if code in all_rules() else (rule.name for rule in all_rules().values()))
    raise UsageError(f"there is no rule '{name}'{near}; see --explain all")


def matching(selector: str) -> set[str]:
    """Codes that a selector means: a code, a name, a beginning of codes such as "DT2", or "all"."""
    if selector.lower() == "all":
        return set(all_rules())
    found = {code for code in all_rules() if code.startswith(selector.upper())} if selector else set()
    return found or {rule_named(selector).code}


def named_singly(selectors: Iterable[str]) -> frozenset[str]:
    """Codes of the selectors that are the code or the name of one rule, not of a family."""
    words = {selector.upper() for selector in selectors}
    return frozenset(
        code for code, rule in all_rules().items() if {code, rule.name.upper(), rule.former_name.upper()} & words - {""}
    )
