"""`--format text`: a line for each finding; with `--full`, a table for each chart and the rows around findings."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from dancetutor_cli.feet.limbs import hex_colour, limb_colours
from dancetutor_cli.lint.findings import ExcerptRow, Finding
from dancetutor_cli.lint.results import ChartResult, FileResult
from dancetutor_cli.reports.analyze_formats import Output, Report, Tally, moment
from dancetutor_cli.reports.terminal import Terminal, can_encode, terminal_of
from dancetutor_cli.run.foreign_text import safe, safe_path

# The rows around a finding as arrows with L and R, in characters.

_ASCII = str.maketrans("←↓↑→↙↖■↗↘│·●", "<v^>/\\o/\\|.*")
_LIMB_OF = {"L": 0, "l": 0, "R": 1, "r": 1, "<": 2, ">": 3}
Paint = Callable[[str, str], str]


def draw(rows: Sequence[ExcerptRow], arrows: str, paint: Paint, *, plain: bool) -> Iterator[str]:
    """Yield a line for each row. arrows : a sign for each column; paint : colours a text; plain : only ASCII"""
    measure = -1
    for row in rows:
        shown = f"measure {int(row.beat // 4):<4}" if row.beat // 4 != measure else ""
        measure = int(row.beat // 4)
        mark = paint(">", "bold red") if row.here else " "
        beat = f"beat {row.beat:<8.8g}"
        cells = "".join(_cell(note, limb, sign, paint) for note, limb, sign in _columns(row, arrows))
        line = f"    {mark} {paint(f'{shown:12} {beat}', 'dim')}{cells}"
        yield line.translate(_ASCII) if plain else line


def _columns(row: ExcerptRow, arrows: str) -> Iterator[tuple[str, str, str]]:
    yield from zip(row.notes, row.limbs, arrows.ljust(len(row.notes), "■"), strict=False)


def _cell(note: str, limb: str, sign: str, paint: Paint) -> str:
    """Return three characters: a blank, the sign, and the limb that presses it."""
    if note == " ":
        return paint(" · ", "dim")
    if note == "|":
        return paint(" │ ", "dim")
    if note == "M":
        return paint(" ● ", "red")
    if limb in _LIMB_OF:
        return " " + paint(f"{sign}{limb}", f"bold {hex_colour(limb_colours().by_limb[_LIMB_OF[limb]])}")
    return " " + paint(f"{sign}?", "bold red")


# The table of a chart: rows, cost and how often each move happens.


class Column(NamedTuple):
    """A column of the table. moves : the moves that it counts; always : whether it is shown even if all are 0"""

    header: str
    width: int
    moves: tuple[str, ...]
    always: bool = True


MOVE_COLUMNS = (
    Column("DS", 4, ("doublestep",)),
    Column("forced\nDS", 6, ("forced-doublestep",)),
    Column("XO 135°", 7, ("crossover-half",)),
    Column("XO 180°", 7, ("crossover-full",)),
    Column("spins", 5, ("spin",)),
    Column("jump\nFS", 4, ("jump-footswitch",)),
    Column("FS", 4, ("footswitch-up", "footswitch-down"), always=False),
    Column("SS", 4, ("sideswitch-left", "sideswitch-right"), always=False),
    Column("hold\nFS", 4, ("holdswitch",), always=False),
    Column("brackets", 8, ("bracket",), always=False),
    Column("jacks", 5, ("jack",)),
    Column("candles", 7, ("candle",)),
    Column("gallops", 7, ("gallop",)),
    Column("hand\npress", 5, ("hand",)),
)
_ROWS, _COST = Column("rows", 5, ()), Column("cost\nunits", 6, ())
_ONE = {"rows": "row", "cost units": "cost unit", "spins": "spin", "brackets": "bracket", "jacks": "jack",
        "candles": "candle", "gallops": "gallop"}  # fmt: skip


def chart_table(chart: ChartResult, terminal: Terminal, charts: Sequence[ChartResult] = ()) -> str:
    """Return the table as text for a terminal, with a final newline.

    charts : the charts of the file; all their tables have the same columns of the same width
    """
    every = [_column_counts(one) for one in charts or (chart,)]
    shown = tuple(column for column in MOVE_COLUMNS if column.always or any(counts[column] for counts in every))
    if _width(shown) > terminal.width:  # columns without numbers are left out
        shown = tuple(column for column in shown if any(counts[column] for counts in every))
    if _width(shown) > terminal.width:
        return _listed(chart, _column_counts(chart), terminal.width)
    columns = (_ROWS, _COST, *shown)
    cells = _cells(chart, shown)
    lines = zip(*(_cells(one, shown) for one in charts or (chart,)), strict=True)
    widths = tuple(max(column.width, *map(len, line)) for column, line in zip(columns, lines, strict=True))
    numbers = " ".join(cell.rjust(width) for cell, width in zip(cells, widths, strict=True))
    return f"{_header(terminal, columns, widths)}{numbers}\n"


def _width(shown: Sequence[Column]) -> int:
    """Return the number of characters that the columns need, with those of rows and cost."""
    return sum(column.width + 1 for column in (_ROWS, _COST, *shown)) - 1


def _column_counts(chart: ChartResult) -> dict[Column, int]:
    return {column: sum(chart.counts.get(move, 0) for move in column.moves) for column in MOVE_COLUMNS}


def _cells(chart: ChartResult, shown: Sequence[Column]) -> list[str]:
    counts = _column_counts(chart)
    return [str(chart.row_count), str(chart.cost), *(str(counts[column] or "·") for column in shown)]


def _listed(chart: ChartResult, counts: dict[Column, int], width: int) -> str:
    """Return the numbers of the table as words, without zeros, for a terminal that is too narrow for the table."""
    numbers = [(chart.row_count, "rows"), (chart.cost, "cost units")]
    named = ((count, column.header.replace("\n", " ")) for column, count in counts.items() if count)
    numbers += [(count, "hand presses" if name == "hand press" and count > 1 else name) for count, name in named]
    words = (f"{count} {_ONE.get(name, name) if count == 1 else name}".replace(" ", "\0") for count, name in numbers)
    return textwrap.fill(", ".join(words), max(width, 20)).replace("\0", " ") + "\n"


@lru_cache(maxsize=64)
def _header(terminal: Terminal, columns: Sequence[Column], widths: Sequence[int]) -> str:
    """Return the names of the columns, aligned right above the numbers, and a line below."""
    names = [column.header.split("\n") for column in columns]
    height = max(map(len, names))
    lines = zip(*([""] * (height - len(name)) + name for name in names), strict=True)
    rule = ("-" if terminal.plain else "─") * (sum(widths) + len(widths) - 1)
    return (
        "".join(
            " ".join(terminal.paint(word.rjust(width), "dim") for word, width in zip(line, widths, strict=True)) + "\n"
            for line in lines
        )
        + f"{rule}\n"
    )


# `--format text` into files and pipes: a line for each finding, and a summary. With `--full`, also a table for each
# chart, and the rows around findings.

STYLES = {"error": "bold red", "warning": "bold yellow", "info": "bold cyan"}
_MOST_LETTERS = 16  # limit of the rows of other feet that are written out
_MOST_FORCED = 12  # limit of the doublesteps of a chart whose cause is written out


class LineReport(Report):
    """One line for each finding; files that could not be read go to standard error."""

    ENCODING = None

    def __init__(self, output: Output) -> None:
        super().__init__(output)
        self._terminal = terminal_of(output.stream)
        self._paint = self._terminal.paint
        self._plain = not can_encode(output.stream, "←↙■●│·")

    def add(self, result: FileResult) -> None:
        """Write one file."""
        if result.error is not None:
            self._stream.flush()
            self._errors.write(f"dancetutor: {safe(result.error)}\n")
            self._errors.flush()
            return
        self._file(result)

    def end(self, tally: Tally) -> None:
        """Write the closing lines; the last one is the summary."""
        for line in tally.closing_lines():
            self._line(line)

    def _file(self, result: FileResult) -> None:
        for finding, chart in result.all_findings():
            better = f"; better: {safe(finding.suggestion)}" if finding.suggestion else ""
            self._finding(result, chart, finding, better)

    def _finding(self, result: FileResult, chart: ChartResult | None, finding: Finding, more: str = "") -> None:
        rule = self._paint(f"{finding.rule}", STYLES[finding.severity])
        place = ":".join(str(n) for n in (finding.line, finding.column) if n is not None)
        where = f"{safe_path(result.path)}:{place}" if place else safe_path(result.path)
        label = f" [{safe(chart.label)}]" if chart else ""
        self._line(f"{where} {rule} {safe(finding.sentence)}{more}", self._paint(label + moment(finding), "dim"))

    def _line(self, *parts: str) -> None:
        self._stream.write("".join(parts) + "\n")


class SummaryReport(LineReport):
    """Only the files that could not be read, and the closing lines."""

    def _file(self, result: FileResult) -> None:
        """Write nothing about a file that could be read."""


class TextReport(LineReport):
    """All findings, with a table for each chart and the rows around its findings."""

    def _file(self, result: FileResult) -> None:
        name = " - ".join(safe(text) for text in (result.artist, result.title) if safe(text))
        self._line(self._paint(safe_path(result.path), "bold"), f"  {name}" if name else "")
        if result.sync is not None:
            self._line(f"  sync: {safe(result.sync.description)}")
        for warning in result.warnings if not (result.charts or result.unselected) else ():
            self._line(f"  {safe(warning)}")
        for finding in result.findings:
            self._drawn(result, None, finding)
        for chart in result.charts:
            self._chart(result, chart)

    def end(self, tally: Tally) -> None:
        """Write the closing lines, after a blank line if they are more than the summary."""
        if tally.page and not tally.quiet:
            self._line()
        super().end(tally)

    def _chart(self, result: FileResult, chart: ChartResult) -> None:
        name = f"  {safe(chart.description)}" if safe(chart.description) else ""
        preset = f"  {safe(chart.mismatch or f'preset {chart.preset}')}" if chart.preset else ""
        known_by = f"  hash {chart.hash}" if chart.hash else ""
        self._line("\n", self._paint(safe(chart.label), "bold"), name, self._paint(preset + known_by, "dim"))
        if chart.playable:
            self._stream.write(chart_table(chart, self._terminal, [one for one in result.charts if one.playable]))
            if chart.estimate is not None:
                self._line(f"plays like meter {chart.estimate.terms_text}")
            if chart.score is not None:
                self._line(f"as hard to score on as meter {chart.score.terms_text}")
            self._alternatives(chart)
            self._forced(chart)
        for finding in chart.findings:
            self._drawn(result, chart, finding)
        if chart.findings:
            self._line()

    def _alternatives(self, chart: ChartResult) -> None:
        """Write the next best feet: their extra cost and its reasons, and their letters instead of the best feet's."""
        if chart.alternatives is None:
            return
        self._line("the next best feet:" if chart.alternatives else "no other feet are possible")
        for other in chart.alternatives:
            why = "".join(f", {name} {cost:+}" for name, cost in other.terms).replace(",", ":", 1)
            self._line("  ", self._paint(f"{other.extra:+} cost units" if other.extra else "same cost", "bold"), why)
            for run in other.runs:
                beats = f"{round(run.first_beat, 3):g}"
                if run.last_beat > run.first_beat:
                    beats += f" to {round(run.last_beat, 3):g}"
                self._line(f"      beat {beats}: ", _cut(run.other), self._paint(" instead of ", "dim"), _cut(run.best))

    def _forced(self, chart: ChartResult) -> None:
        """Write the forced doublesteps, each with its cause."""
        forced = [cause for cause in chart.causes or () if cause.forced]
        for cause in forced[:_MOST_FORCED]:
            panel = (
                f" {chart.arrows[cause.column]}"
                if cause.column is not None and chart.arrows and not self._plain
                else ""
            )
            why = "the other foot is not free"
            if cause.at_beat is not None:
                why = f"the other foot is on the {cause.cause} from beat {round(cause.at_beat, 3):g}{panel}"
            self._line(f"forced doublestep on beat {round(cause.beat, 3):g}: {why}")
        if len(forced) > _MOST_FORCED:
            self._line(f"... and {len(forced) - _MOST_FORCED} more; --format json has all")

    def _drawn(self, result: FileResult, chart: ChartResult | None, finding: Finding) -> None:
        """Write a finding, the edit that would remove it, and its rows."""
        self._finding(result, chart, finding)
        if finding.suggestion:
            self._line(f"    better: {safe(finding.suggestion)}")
        for line in draw(finding.excerpt, chart.arrows if chart else "", self._paint, plain=self._plain):
            self._line(line)


def _cut(letters: str) -> str:
    rows = letters.split(" ")
    return " ".join(rows[:_MOST_LETTERS]) + (f" ... ({len(rows)} rows)" if len(rows) > _MOST_LETTERS else "")
