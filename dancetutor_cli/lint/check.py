"""Run the rules over a file or a chart, and leave out what the baseline knows."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dancetutor_cli.chart.names import TICKS_PER_BEAT, is_lights
from dancetutor_cli.chart.pack_files import find_settings_file
from dancetutor_cli.lint.findings import RANKS, Finding
from dancetutor_cli.lint.rule import ChartRule, FileRule, ReaderRule, Rule, all_rules
from dancetutor_cli.lint.rule_settings import Options, Settings
from dancetutor_cli.run.errors import FileError, MissingFileError
from dancetutor_cli.run.files import encoded, write_atomic
from dancetutor_cli.run.reading import read_json

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject


# Run the rules over a file or a chart.

_AMBIGUITY = "DT207"
_MAX_CACHED = 256
Rules = Mapping[str, ChartRule | ReaderRule]
# Rule -> what SMEditor calls such findings in the `ignores` of data.sme.
_EDITOR_CODES = {
    "DT201": "DS", "DT209": "DS", "DT206": "FS", "DT208": "FS", "DT211": "FS", "DT212": "FS", "DT207": "AM",
}  # fmt: skip


def check_file(subject: FileSubject, settings: Settings) -> tuple[Finding, ...]:
    """Findings about the file as a whole, in order of line and rule."""
    findings: list[Finding] = []
    for code, options in settings.for_file(subject.song.path).items():
        if code in _rules_of_files():
            rule = _rules_of_files()[code](options)
            findings += () if _is_about_others(rule, subject) else rule.check(subject)
    return _in_order(findings)


def check_chart(subject: ChartSubject, settings: Settings) -> tuple[Finding, ...]:
    """Findings about one chart, in order of line and rule; none about the lights of a cabinet, which nobody dances."""
    if is_lights(subject.chart.steps_type):
        return ()
    rules = rules_of(subject, settings)
    findings = [finding for rule in rules.values() for finding in _run_rule(rule, subject)]
    results = _as_sure_as_they_are(findings, subject, settings, rules.get(_AMBIGUITY))
    if subject.play is None and subject.chart.written_type.startswith(_FINGERS) and _NO_PAD in rules:
        results = (one for one in results if one.rule == _NO_PAD or one.severity == "error")
    return _in_order(finding for finding in results if not _silenced(finding, subject))


# Steps types that fingers play, of a chart of which one line says enough: what makes a dance is nothing to them.
_FINGERS = ("kb", "bm-", "iidx-", "pnm-", "popn-", "gh-", "gddm-")
_NO_PAD = "DT103"


def rules_of(subject: ChartSubject, settings: Settings) -> Rules:
    """The rules that run on a chart, by their codes; the same again for the same options, as from chart to chart."""
    chart = subject.chart
    options = settings.for_chart(subject.song.path, chart.written_type, chart.difficulty, chart.meter)
    known = _rules_cache.get(id(options))
    if known is None:
        if len(_rules_cache) >= _MAX_CACHED:
            _rules_cache.clear()
        rules = {code: rule(options[code]) for code, rule in _rules_of_charts().items() if code in options}
        known = _rules_cache[id(options)] = options, {code: rules[code] for code in options if code in rules}
    return known[1]


# By the object that the options are, which is kept here so that no other takes its place.
_rules_cache: dict[int, tuple[Mapping[str, Options], Rules]] = {}


def check_rule(code: str, rules: Rules, subject: ChartSubject, settings: Settings) -> tuple[Finding, ...]:
    """The findings that one rule adds to `check_chart`; an ambiguity of other rules is reported again."""
    results = _as_sure_as_they_are(_run_rule(rules[code], subject), subject, settings, rules.get(_AMBIGUITY))
    return tuple(finding for finding in results if not _silenced(finding, subject))


def _run_rule(rule: ChartRule | ReaderRule, subject: ChartSubject) -> list[Finding]:
    """The findings of a rule; in a chart for two, those about the whole chart are reported with the first player's."""
    if _is_about_others(rule, subject):
        return []
    found = rule.check(subject)
    about_all = subject.chart.player <= 1
    return [one for one in found if (about_all or one.beat is not None) and not _silenced(one, subject)]


def _is_about_others(rule: Rule, subject: FileSubject | ChartSubject) -> bool:
    """Whether the rule is about tags, of which a .ucs says nothing."""
    return rule.about_tags and subject.song.format == "ucs"


def findings_of(subject: ChartSubject) -> tuple[Finding, ...]:
    """The findings in a chart, with the configuration that holds for its file."""
    from dancetutor_cli.lint.configuration import load_configuration

    settings = load_configuration(find_settings_file(subject.song.path.absolute().parent), found=True).settings
    return merged_by_foot(check_chart(subject, settings), subject)


@cache
def _rules_of_files() -> Mapping[str, type[FileRule] | type[ReaderRule]]:
    return {code: rule for code, rule in all_rules().items() if issubclass(rule, FileRule | ReaderRule)}


@cache
def _rules_of_charts() -> Mapping[str, type[ChartRule] | type[ReaderRule]]:
    return {code: rule for code, rule in all_rules().items() if issubclass(rule, ChartRule | ReaderRule)}


def _as_sure_as_they_are(
    findings: list[Finding], subject: ChartSubject, settings: Settings, ambiguity: ChartRule | ReaderRule | None
) -> Iterator[Finding]:
    """The findings; those that are true only with feet that players may not use are no warnings.

    If other feet cost next to nothing more, the finding becomes DT207 either-foot (with its options if it runs), one
    for a row.
    """
    known = {finding.beat for finding in findings if finding.rule == _AMBIGUITY}
    for finding in findings:
        if finding.beat is None or not _rules_of_charts()[finding.rule].about_feet:
            yield finding
            continue
        margin, confidence = subject.confidence(finding.beat)
        if margin is not None and margin <= settings.coin_toss:
            qualified = f"either foot: both feet are equally good here; with the feet shown, {finding.message}"
            if ambiguity is None:
                yield replace(finding, severity="info", message=qualified)
            elif finding.beat not in known:
                known.add(finding.beat)
                tossed = replace(finding, rule=_AMBIGUITY, name=_rules_of_charts()[_AMBIGUITY].name)
                yield replace(tossed, severity=ambiguity.options["severity"], message=qualified)
        elif confidence is not None and 100 * confidence < settings.sure_feet:
            qualified = f"{finding.message} (with these feet; the solver is {confidence:.0%} sure of them)".replace(
                "%", " %"
            )
            yield replace(finding, severity="info", message=qualified)
        else:
            yield finding


# Rules that see one wrong foot from several sides: what it does, where the body turns for it, how unsure it is. Of
# several about one row, or about neighbours, that of the rule named first is reported.
_OF_ONE_FOOT = (
    "DT201", "DT209", "DT202", "DT203", "DT215", "DT205", "DT204", "DT212", "DT208", "DT211", "DT206", "DT214", "DT304",
    "DT207", "DT213",
)  # fmt: skip
# How many rows with a step apart they may be; these speak of a step and of the one beside it, the last of a passage.
_REACH = {"DT201": 1, "DT202": 1, "DT204": 1, "DT207": 1, "DT209": 1, "DT215": 1, "DT304": 1, "DT213": 2, "DT214": 2}


def merged_by_foot(findings: tuple[Finding, ...], subject: ChartSubject) -> tuple[Finding, ...]:
    """The findings without those that repeat another rule's report on a foot: the most severe and simplest stays."""
    if subject.play is None:
        return findings
    ticks, rows = subject.play.rows.tick, subject.step_rows
    of_feet = [
        (place, int(rows.searchsorted(ticks.searchsorted(round(one.beat * TICKS_PER_BEAT)))), one)
        for place, one in enumerate(findings)
        if one.beat is not None and one.rule in _OF_ONE_FOOT
    ]
    of_feet.sort(key=lambda entry: (-RANKS[entry[2].severity], _OF_ONE_FOOT.index(entry[2].rule)))
    kept: dict[int, list[str]] = {}  # by place of the row: rules that are reported there
    dropped: set[int] = set()
    for place, at, one in of_feet:
        reach = _REACH.get(one.rule, 0)
        if any(
            other != one.rule and (near == at or abs(near - at) <= max(reach, _REACH.get(other, 0)))
            for near in range(at - 2, at + 3)
            for other in kept.get(near, ())
        ):
            dropped.add(place)
        else:
            kept.setdefault(at, []).append(one.rule)
    return tuple(one for place, one in enumerate(findings) if place not in dropped)


def _silenced(finding: Finding, subject: ChartSubject) -> bool:
    """Whether the author said, in an editor or in dancetutor.yaml, that this finding is not wanted in this row."""
    if finding.beat is None or not (subject.ignores.codes or subject.ignores.rules):
        return False
    tick, code = round(finding.beat * TICKS_PER_BEAT), _EDITOR_CODES.get(finding.rule)
    known = subject.ignores
    names = {finding.name, all_rules()[finding.rule].former_name} - {""}
    return bool(code and known.silenced(tick, code)) or any(
        known.silenced_rule(tick, finding.rule, name) for name in names
    )


def _in_order(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    return tuple(sorted(findings, key=lambda f: (f.line or 0, f.beat or 0.0, f.rule, f.column or 0)))


# The baseline: findings that were there before and are not reported again, known by chart, beat and rule.

SCHEMA = 1
# path of the chart file relative to the baseline's folder, chart, rule, beat in 1/48 (the line, for a file's finding)
Key = tuple[str, str, str, int]


@dataclass
class Baseline:
    """Known findings with how often each may occur; counts down as findings are matched."""

    path: Path
    allowed: Counter[Key] = field(default_factory=Counter)
    _remaining: Counter[Key] = field(default_factory=Counter)
    _ran: dict[tuple[str, str], set[str]] = field(default_factory=dict)
    _whole: dict[str, set[str]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._remaining = Counter(self.allowed)

    def key(self, file: str, chart: str, finding: Finding) -> Key:
        """What identifies a finding: file, chart, rule and beat."""
        place = (finding.line or 0) if finding.beat is None else round(finding.beat * TICKS_PER_BEAT)
        return self._relative(file), chart, finding.rule, place

    def absorbs(self, key: Key) -> bool:
        """Whether a finding is known; each entry absorbs one finding."""
        if self._remaining[key] <= 0:
            return False
        self._remaining[key] -= 1
        return True

    def mark_seen(self, file: str, chart: str, rules: Iterable[str]) -> None:
        """Remember which rules ran on a chart, or with chart "" on the file as a whole: theirs can be unused."""
        self._ran.setdefault((self._relative(file), chart), set()).update(rules)

    def mark_all_seen(self, file: str) -> None:
        """Remember that every chart of a file was analysed: entries of any other chart are of one that is gone."""
        name = self._relative(file)
        self._whole[name] = set().union(*(rules for (of, _), rules in self._ran.items() if of == name))

    def unused(self) -> list[Key]:
        """Entries that no finding matched though their rule ran: the finding is gone, the entry can go too."""
        return sorted(key for key, count in self._remaining.items() if count > 0 and self._could_match(key))

    def replaced(self, keys: Iterable[Key]) -> Baseline:
        """A baseline with these findings, and the old entries of all charts and rules that were not looked at."""
        kept = Counter({key: count for key, count in self.allowed.items() if not self._could_match(key)})
        return Baseline(self.path, kept + Counter(keys))

    def _could_match(self, key: Key) -> bool:
        file, chart, rule, _ = key
        ran = self._ran.get((file, chart))
        return rule in (self._whole.get(file, set()) if ran is None else ran)

    def write(self) -> None:
        """Write the file, sorted, one entry a line."""
        entries = [json.dumps(_entry(key, count), ensure_ascii=False) for key, count in sorted(self.allowed.items())]
        body = ",\n  ".join(entries)
        text = f'{{"schema": {SCHEMA}, "entries": [\n  {body}\n]}}\n'
        write_atomic(self.path, encoded(text))

    def _relative(self, file: str) -> str:
        return Path(os.path.relpath(Path(file).absolute(), self.path.absolute().parent)).as_posix()


def _entry(key: Key, count: int) -> dict[str, Any]:
    file, chart, rule, place = key
    where = {"beat": round(place / TICKS_PER_BEAT, 6)} if chart else {"line": place}
    return {"file": file, "chart": chart, "rule": rule, **where, **({"count": count} if count > 1 else {})}


def load_baseline(path: Path) -> Baseline:
    """Read a baseline; FileError says what is wrong with it."""
    try:
        data = read_json(path)
    except MissingFileError:
        raise FileError(path, "there is no such baseline; add --update-baseline to make it") from None
    if not isinstance(data, Mapping) or data.get("schema") != SCHEMA or not isinstance(data.get("entries"), list):
        raise FileError(path, f'is not a baseline: it needs "schema": {SCHEMA} and "entries"')
    known: Counter[Key] = Counter()
    for number, entry in enumerate(data["entries"]):
        try:
            place = round(float(entry["beat"]) * TICKS_PER_BEAT) if entry["chart"] else int(entry["line"])
            known[str(entry["file"]), str(entry["chart"]), str(entry["rule"]), place] += int(entry.get("count", 1))
        except (KeyError, TypeError, ValueError, AttributeError, OverflowError):
            raise FileError(path, f"entry {number} is not a finding with file, chart, rule and beat") from None
    return Baseline(path, known)
