"""Run the rules over a file, a chart, or the syncs of a pack."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.chart.names import TICKS_PER_BEAT, is_lights
from dancetutor_cli.chart.pack_files import find_settings_file, pack_folder, read_pack_ini
from dancetutor_cli.chart.selection import is_preferred
from dancetutor_cli.lint.findings import RANKS, Finding
from dancetutor_cli.lint.results import FileResult
from dancetutor_cli.lint.rule import ChartRule, FileRule, PackRule, PackSong, ReaderRule, Rule, all_rules
from dancetutor_cli.lint.rule_settings import Options, Settings

if TYPE_CHECKING:
    from dancetutor_cli.lint.findings import Sync
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject

_AMBIGUITY = "DT207"
_MAX_CACHED = 256
Rules = Mapping[str, ChartRule | ReaderRule]


def check_file(subject: FileSubject, settings: Settings) -> tuple[Finding, ...]:
    """Return the findings about the file as a whole, in order of line and rule."""
    findings: list[Finding] = []
    for code, options in settings.for_file(subject.song.path).items():
        if code in _rules_of_files():
            rule = _rules_of_files()[code](options)
            findings += () if _is_about_others(rule, subject) else rule.check(subject)
    return _in_order(findings)


def check_chart(subject: ChartSubject, settings: Settings) -> tuple[Finding, ...]:
    """Return the findings about one chart, in order of line and rule; a chart of a cabinet's lights has none."""
    if is_lights(subject.chart.steps_type):
        return ()
    rules = rules_of(subject, settings)
    findings = [finding for rule in rules.values() for finding in _run_rule(rule, subject)]
    results = _with_unsure_as_info(findings, subject, settings, rules.get(_AMBIGUITY))
    if subject.play is None and subject.chart.written_type.startswith(_FINGERS) and _NO_PAD in rules:
        results = (one for one in results if one.rule == _NO_PAD or one.severity == "error")
    return _in_order(finding for finding in results if not _is_silenced(finding, subject))


# Steps types that are played with fingers. For such charts, only DT103 and errors are reported.
_FINGERS = ("kb", "bm-", "iidx-", "pnm-", "popn-", "gh-", "gddm-")
_NO_PAD = "DT103"


def rules_of(subject: ChartSubject, settings: Settings) -> Rules:
    """Return the rules that run on a chart, by their codes. Charts with the same options share the rules."""
    chart = subject.chart
    options = settings.for_chart(subject.song.path, chart.written_type, chart.difficulty, chart.meter)
    known = _rules_cache.get(id(options))
    if known is None:
        if len(_rules_cache) >= _MAX_CACHED:
            _rules_cache.clear()
        rules = {code: rule(options[code]) for code, rule in _rules_of_charts().items() if code in options}
        known = _rules_cache[id(options)] = options, {code: rules[code] for code in options if code in rules}
    return known[1]


# The key is the `id` of the options. The value keeps the options alive, so that no other object gets this `id`.
_rules_cache: dict[int, tuple[Mapping[str, Options], Rules]] = {}


def check_rule(code: str, rules: Rules, subject: ChartSubject, settings: Settings) -> tuple[Finding, ...]:
    """Return the findings that one rule adds to `check_chart`; an ambiguity of other rules is reported again."""
    results = _with_unsure_as_info(_run_rule(rules[code], subject), subject, settings, rules.get(_AMBIGUITY))
    return tuple(finding for finding in results if not _is_silenced(finding, subject))


def _run_rule(rule: ChartRule | ReaderRule, subject: ChartSubject) -> list[Finding]:
    """Return the findings of a rule; findings about a whole chart for two are reported with the first player's part.

    Findings that the author has silenced are left out here, before they may become an ambiguity, and again after that.
    """
    if _is_about_others(rule, subject):
        return []
    found = rule.check(subject)
    about_all = subject.chart.player <= 1
    return [one for one in found if (about_all or one.beat is not None) and not _is_silenced(one, subject)]


def _is_about_others(rule: Rule, subject: FileSubject | ChartSubject) -> bool:
    """Whether the rule is about tags and the file is a .ucs, which has none."""
    return rule.about_tags and subject.song.format == "ucs"


def findings_of(subject: ChartSubject) -> tuple[Finding, ...]:
    """Return the findings in a chart, with the configuration that holds for its file."""
    from dancetutor_cli.lint.configuration import load_configuration

    settings = load_configuration(find_settings_file(subject.song.path.absolute().parent), found=True).settings
    return merged_by_foot(check_chart(subject, settings), subject)


@cache
def _rules_of_files() -> Mapping[str, type[FileRule] | type[ReaderRule]]:
    return {code: rule for code, rule in all_rules().items() if issubclass(rule, FileRule | ReaderRule)}


@cache
def _rules_of_charts() -> Mapping[str, type[ChartRule] | type[ReaderRule]]:
    return {code: rule for code, rule in all_rules().items() if issubclass(rule, ChartRule | ReaderRule)}


def _with_unsure_as_info(
    findings: list[Finding], subject: ChartSubject, settings: Settings, ambiguity: ChartRule | ReaderRule | None
) -> Iterator[Finding]:
    """Yield the findings; a finding that is true only with unsure feet becomes an info.

    If other feet cost hardly more, the finding becomes DT207 either-foot, one for each row. It gets the options of
    DT207 if that rule runs.
    """
    known = {finding.beat for finding in findings if finding.rule == _AMBIGUITY}
    for finding in findings:
        if finding.beat is None or not _rules_of_charts()[finding.rule].about_feet:
            yield finding
            continue
        margin, confidence = subject.confidence(finding.beat)
        if margin is not None and margin <= settings.coin_toss:
            qualified = f"both feet are equally good here; with the feet shown, {finding.message}"
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


def merged_by_foot(findings: tuple[Finding, ...], subject: ChartSubject) -> tuple[Finding, ...]:
    """Return the findings without repeats: if several rules report the same foot, the most severe finding stays.

    Of equally severe findings, the one whose rule has the lowest `foot_rank` stays.
    """
    if subject.play is None:
        return findings
    ticks, rows = subject.play.rows.tick, subject.step_rows
    rules = all_rules()
    of_feet = [
        (place, int(rows.searchsorted(ticks.searchsorted(round(one.beat * TICKS_PER_BEAT)))), one)
        for place, one in enumerate(findings)
        if one.beat is not None and rules[one.rule].foot_rank
    ]
    of_feet.sort(key=lambda entry: (-RANKS[entry[2].severity], rules[entry[2].rule].foot_rank))
    kept: dict[int, list[str]] = {}  # index of the row -> rules that are reported there
    dropped: set[int] = set()
    for place, at, one in of_feet:
        reach = rules[one.rule].foot_reach
        if any(
            other != one.rule and (near == at or abs(near - at) <= max(reach, rules[other].foot_reach))
            for near in range(at - 2, at + 3)
            for other in kept.get(near, ())
        ):
            dropped.add(place)
        else:
            kept.setdefault(at, []).append(one.rule)
    return tuple(one for place, one in enumerate(findings) if place not in dropped)


def _is_silenced(finding: Finding, subject: ChartSubject) -> bool:
    """Whether the author has silenced this finding in this row, in an editor or in dancetutor.yaml."""
    if finding.beat is None or not (subject.ignores.codes or subject.ignores.rules):
        return False
    tick, code = round(finding.beat * TICKS_PER_BEAT), all_rules()[finding.rule].editor_code
    known = subject.ignores
    names = {finding.name, all_rules()[finding.rule].former_name} - {""}
    return bool(code and known.is_silenced(tick, code)) or any(
        known.silenced_rule(tick, finding.rule, name) for name in names
    )


def _in_order(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    return tuple(sorted(findings, key=lambda f: (f.line or 0, f.beat or 0.0, f.rule, f.column or 0)))


# The rules about the syncs of all songs of a pack, which need the results of all its files.

_FEWEST = 2  # the least number of songs in a pack
_STEADY = 6.0  # ms; a song with more drift is neither null nor ITG


class PackSyncs:
    """Collects the syncs of songs, pack by pack. A song with a .sm and a .ssc counts once, by its .ssc."""

    def __init__(self) -> None:
        self._songs: dict[Path, dict[str, tuple[str, Sync]]] = {}
        self._names: dict[Path, str] = {}  # names of the folders, relative if their files were named so

    def add(self, result: FileResult) -> None:
        """Add a file, if its sync is sure and steady."""
        sync = result.sync
        if sync is None or not sync.is_sure or abs(sync.drift_ms or 0.0) > _STEADY:
            return
        path = Path(result.path)
        folder = pack_folder(path.absolute())
        self._names.setdefault(folder, os.fspath(folder) if path.is_absolute() else os.path.relpath(folder))
        songs = self._songs.setdefault(folder, {})
        key = os.fspath(path.absolute().with_suffix(""))
        if key not in songs or is_preferred(path):
            songs[key] = path.absolute().parent.name, sync

    @property
    def folders(self) -> Iterator[Path]:
        """The folders with enough songs for a pack."""
        return (folder for folder in sorted(self._songs) if len(self._songs[folder]) >= _FEWEST)

    def result(self, folder: Path, settings: Settings) -> FileResult | None:
        """Return the findings for the pack in a folder, as the result of that folder; None if it has none."""
        songs = [PackSong(*song) for _, song in sorted(self._songs[folder].items())]
        ini = read_pack_ini(folder)
        findings: list[Finding] = []
        for code, options in settings.for_file(folder).items():
            kind = all_rules()[code]
            if issubclass(kind, PackRule):
                rule = kind(options)
                if message := rule.check_pack(songs, ini):
                    findings.append(rule.finding(message, {}))
        if not findings:
            return None
        return FileResult(self._names[folder], folder.name, "", None, (), tuple(findings), ())
