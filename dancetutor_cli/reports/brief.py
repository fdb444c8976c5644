"""The brief report of `analyze` for a terminal: at most a screen for a song, a page for a pack."""

from __future__ import annotations

import os
import shutil
import textwrap
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from dancetutor_cli.lint.findings import RANKS, Finding
from dancetutor_cli.lint.results import ChartResult, FileResult
from dancetutor_cli.reports.analyze_formats import Output, Report, Tally, measures_text
from dancetutor_cli.reports.terminal import FIXED_BLANK, cut, terminal_of
from dancetutor_cli.reports.text_report import STYLES
from dancetutor_cli.run.errors import plural
from dancetutor_cli.run.foreign_text import safe, safe_path

_SONG = 2  # limit of the files of one song: its .sm and its .ssc
_MOST_UNREADABLE = 8
_PAGE = 60  # limit of lines for a pack
_LEAST = 28  # least characters of a path that are shown
_ALIKE = 3  # from this many charts on, the findings of a rule share one line


@dataclass(frozen=True, slots=True)
class _Entry:
    """All findings of one rule in one chart (None: in the file itself)."""

    path: str
    chart: ChartResult | None
    findings: tuple[Finding, ...]

    @property
    def first(self) -> Finding:
        return self.findings[0]

    @property
    def order(self) -> tuple[int, int, int]:
        """The sort key: errors first, then the surest and most frequent findings."""
        return -RANKS[self.first.severity], -max(f.margin or 0 for f in self.findings), -len(self.findings)


class BriefReport(Report):
    """A report that is written at the end of the run; files that could not be read go to standard error."""

    ENCODING = None

    def __init__(self, output: Output) -> None:
        super().__init__(output)
        self._is_song = output.files <= _SONG
        terminal = terminal_of(output.stream)
        self._paint, self._width = terminal.paint, terminal.width
        self._entries: list[_Entry] = []
        self._charts: list[tuple[FileResult, ChartResult]] = []
        self._unreadable: list[str] = []
        self._found: dict[str, tuple[int, int]] = {}  # by file: errors, warnings
        self._below = ""

    def add(self, result: FileResult) -> None:
        """Add one file."""
        if result.error is not None:
            self._unreadable.append(safe(result.error))
            return
        by_rule: dict[tuple[str, int | None], list[Finding]] = defaultdict(list)
        charts: dict[int | None, ChartResult | None] = {chart.index: chart for chart in result.charts}
        charts[None] = None
        for finding, chart in result.all_findings():
            by_rule[finding.rule, None if chart is None else chart.index].append(finding)
            errors, warnings = self._found.get(result.path, (0, 0))
            self._found[result.path] = (
                errors + (finding.severity == "error"), warnings + (finding.severity == "warning"),
            )  # fmt: skip
        self._entries += [_Entry(result.path, charts[index], tuple(f)) for (_, index), f in by_rule.items()]
        if self._is_song:
            self._charts += [(result, chart) for chart in result.charts if chart.findings]

    def end(self, tally: Tally) -> None:
        """Write the whole report; its last line is the summary."""
        for line in self._unreadable[:_MOST_UNREADABLE]:
            self._errors.write(f"dancetutor: {line}\n")
        if len(self._unreadable) > _MOST_UNREADABLE:
            more = len(self._unreadable) - _MOST_UNREADABLE
            self._errors.write(f"dancetutor: {more} more files could not be read; --full names them\n")
        self._errors.flush()
        lines: list[str] = []
        if self._entries:
            lines = self._song() if self._is_song else self._pack(_PAGE - len(tally.page))
        for line in (*lines, *tally.closing_lines()):
            self._stream.write(line + "\n")

    def _song(self) -> list[str]:
        """Return a line for each chart, then a line for each rule in each chart, as many as fit on the screen."""
        room = max(12, shutil.get_terminal_size().lines - 4)
        by_file: dict[str, list[str]] = {}
        widest = max((len(safe(chart.label)) for _, chart in self._charts), default=0)
        for result, chart in self._charts:
            by_file.setdefault(result.path, []).append(self._cut(f"  {_counts(chart, widest)}"))
        files: dict[tuple[str, ...], list[str]] = {}  # the .sm and the .ssc of a song mostly have the same lines
        for path, charts in by_file.items():
            files.setdefault(tuple(charts), []).append(safe_path(path))
        lines: list[str] = []
        for charts_of, paths in files.items():
            lines += [self._paint(self._cut(", ".join(paths)), "bold"), *charts_of]
        if lines:
            lines.insert(0, self._paint(self._cut(_head(widest, [chart for _, chart in self._charts])), "dim"))
        shown = lines[: room // 2]
        return [*shown, *_more(len(lines) - len(shown), "charts"), *self._listed(room - len(shown))]

    def _pack(self, page: int) -> list[str]:
        """Return the worst files, and then the surest findings of each rule; at most `page` lines."""
        worst = sorted(self._found.items(), key=lambda item: (-item[1][0], -item[1][1], item[0]))
        worst = [item for item in worst if any(item[1])]
        shown = worst[: page // 3]
        self._below = os.path.commonpath([os.path.dirname(path) for path in self._found])  # noqa: PTH120
        head = self._cut(f"errors warnings  file below {safe_path(self._below or '.')}")
        lines = [self._paint(head, "dim")] if shown else []
        lines += [self._cut(f"{errors:6} {warnings:8}  {self._name(path)}") for path, (errors, warnings) in shown]
        lines += _more(len(worst) - len(shown), "files with errors or warnings")
        lines.append("")
        rules: dict[str, list[_Entry]] = defaultdict(list)
        for entry in self._entries:
            rules[entry.first.rule].append(entry)
        ranked = sorted(rules.values(), key=lambda all_: (min(one.order[0] for one in all_), -_sum(all_)))
        shown_of_rules: list[tuple[str, tuple[str, ...]]] = []
        each = 2 if len(ranked) * 3 <= page - len(lines) else 1
        for found in ranked[: max(1, (page - len(lines) - 2) // (each + 1))]:
            first = min(found, key=lambda one: one.order)
            rule = self._paint(f"{first.first.rule} {first.first.name}", STYLES[first.first.severity])
            charts = len({(one.path, one.chart and one.chart.index) for one in found})
            what = "file" if first.chart is None else "chart"
            such = ", such as" if len(found) > each else ":"
            found_in = f"{plural(_sum(found), 'finding')} in {plural(charts, what)}"
            shown_of_rules.append((f"{rule}: {found_in}{such}", ()))
            for one in sorted(found, key=lambda x: x.order)[:each]:
                shown_of_rules.append((f"  {self._place(one)}", self._message(one) if one.chart else ()))
        return [*lines, *self._with_messages(shown_of_rules, page - len(lines) - 2), "", _HINT]

    def _listed(self, room: int) -> list[str]:
        kinds: dict[tuple[str, str], list[_Entry]] = defaultdict(list)
        for entry in sorted(self._entries, key=lambda one: one.order):
            kinds[entry.first.rule, entry.first.severity].append(entry)
        found = [one for of_kind in kinds.values() for one in self._kind_lines(of_kind)]
        if not found:
            return []
        shown = found[: max(4, room - 3)]
        lines = self._with_messages(shown, room - 3)
        return ["", *lines, *_more(len(found) - len(shown), "such lines"), _HINT]

    def _with_messages(self, found: Sequence[tuple[str, tuple[str, ...]]], room: int) -> list[str]:
        """Return each line, and below it the lines of its message if there is room for them."""
        lines: list[str] = []
        free = room - len(found)
        for line, message in found:
            lines.append(self._cut(line))
            if len(message) <= free:
                lines += message
                free -= len(message)
        return lines

    def _kind_lines(self, entries: Sequence[_Entry]) -> list[tuple[str, tuple[str, ...]]]:
        """Return a line with its message for each chart with findings of a rule; three or more lines become one."""
        lines = list(dict.fromkeys((f"{self._rule(one)}: {_where(one)}", self._message(one)) for one in entries))
        if len(lines) < _ALIKE:
            return lines
        # The .sm and the .ssc of a song mostly have the same findings, which are counted once.
        own = {(e.chart and e.chart.label, tuple(f.beat for f in e.findings)): len(e.findings) for e in entries}
        labels = list(dict.fromkeys(entry.chart.label if entry.chart else "" for entry in entries))
        first = entries[0].first
        where = "" if first.measure is None else f", first: measure {first.measure} of {safe(labels[0])}"
        return [(f"{self._rule(entries[0])}: {sum(own.values())} in {plural(len(labels), 'chart')}{where}", ())]

    def _name(self, path: str) -> str:
        """Return a file's path below the folder that contains all files."""
        return safe_path(os.path.relpath(path, self._below or "."))

    def _rule(self, entry: _Entry) -> str:
        return self._paint(f"{entry.first.rule} {entry.first.name}", STYLES[entry.first.severity])

    def _message(self, entry: _Entry) -> tuple[str, ...]:
        """Return the message of a single finding in full, on lines as wide as the terminal; none for several."""
        if len(entry.findings) > 1:
            return ()
        indent = " " * 4
        width = max(self._width, 40)
        text = safe(entry.first.message)
        return tuple(
            textwrap.wrap(text, width, initial_indent=indent, subsequent_indent=indent, break_on_hyphens=False)
        )

    def _place(self, entry: _Entry) -> str:
        """Return "Pack/Song/song.ssc:12: 2 in dance-single Hard 9, measures 4 and 18"; a long path is cut at its start.

        For a single finding about a file, the line ends with its message.
        """
        alone = entry.chart is None and len(entry.findings) == 1
        where = f":{entry.first.line or 1}: {safe(entry.first.message) if alone else _where(entry)}"
        path, room = self._name(entry.path), max(self._width - len(where) - 2, _LEAST)
        return (path if len(path) <= room else f"…{path[1 - room :]}") + where

    def _cut(self, line: str) -> str:
        return cut(line, self._width)


_HINT = "--full: findings with rows; --statistics: count by rule; --format json: all data"


_MOVES = {  # moves that the line of a chart counts, and their names
    "doublestep": "doublestep",
    "crossover-full": "180° crossover",
    "spin": "spin",
    "bracket": "bracket",
}


def _head(widest: int, charts: Sequence[ChartResult]) -> str:
    """Return the names of the columns of `_counts`, and the meaning of a "?" in them."""
    guess = any(chart.estimate and not chart.estimate.is_scale_known for chart in charts)
    names = f"{'':{widest + 2}}  plays like  scores like   rows"
    return f"{names}  (? = guessed scale)" if guess else names


def _counts(chart: ChartResult, widest: int) -> str:
    """Return the line of a chart in a table whose names are `widest` characters wide."""
    found = [sum(f.severity == severity for f in chart.findings) for severity in ("error", "warning")]
    words = [plural(n, name) for n, name in zip(found, ("error", "warning"), strict=True) if n]
    counted = [
        plural(n, name).replace(" ", FIXED_BLANK) for move, name in _MOVES.items() if (n := chart.counts.get(move))
    ]
    plays, scores = chart.estimate.short if chart.estimate else "", chart.score.short if chart.score else ""
    plays += "" if plays.endswith("?") else " "  # to align the digits
    rows = str(chart.row_count) if chart.playable else "no pad"
    more = "; ".join(filter(None, (", ".join(words), ", ".join(counted))))
    line = f"{safe(chart.label):{widest}}  {plays:>11} {scores:>11} {rows:>6}  {more}"
    return line.rstrip()


def _where(entry: _Entry) -> str:
    """Return "2 in dance-single Medium 5, measures 4 and 18"."""
    where = safe(entry.chart.label) if entry.chart else "the file"
    return f"{len(entry.findings)} in {where}{measures_text(entry.findings)}"


def _sum(entries: Sequence[_Entry]) -> int:
    return sum(len(one.findings) for one in entries)


def _more(count: int, what: str) -> list[str]:
    return [f"... and {count} more {what}"] if count > 0 else []
