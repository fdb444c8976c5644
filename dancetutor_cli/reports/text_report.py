"""`--format text`: per chart a table and its findings in lint form, one line each."""

from __future__ import annotations

from typing import IO

from dancetutor_cli.jobs.result import ChartResult, FileResult
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.reports.drawing import draw
from dancetutor_cli.reports.safe import safe, safe_path
from dancetutor_cli.reports.table import chart_table
from dancetutor_cli.reports.tally import Tally
from dancetutor_cli.reports.terminal import can_encode, terminal_of

STYLES = {"error": "bold red", "warning": "bold yellow", "info": "bold cyan"}
_MOST_LETTERS = 16  # rows of another play that are written out
_MOST_FORCED = 12  # doublesteps of a chart whose cause is written out


class TextReport:
    """Writes files as they come: tables and findings to `stream`, files that could not be read to `errors`."""

    def __init__(self, stream: IO[str], errors: IO[str]) -> None:
        self._stream = stream
        self._errors = errors
        self._terminal = terminal_of(stream)
        self._paint = self._terminal.paint
        self._plain = not can_encode(stream, "←↙■●│·")

    def begin(self) -> None:
        """Nothing comes before the first file."""

    def add(self, result: FileResult) -> None:
        """Write one file."""
        if result.error is not None:
            self._stream.flush()
            self._errors.write(f"dancetutor: {safe(result.error)}\n")
            self._errors.flush()
            return
        name = " - ".join(safe(text) for text in (result.artist, result.title) if safe(text))
        self._line(self._paint(safe_path(result.path), "bold"), f"  {name}" if name else "")
        for warning in result.warnings if not (result.charts or result.unselected) else ():
            self._line(f"  {safe(warning)}")
        for finding in result.findings:
            self._finding(result, None, finding)
        for chart in result.charts:
            self._chart(result, chart)

    def end(self, tally: Tally) -> None:
        """Write the last line: what was found in all."""
        for line in ("", *tally.page) if tally.page else ():
            self._line(line)
        self._line(tally.summary())

    def _chart(self, result: FileResult, chart: ChartResult) -> None:
        name = f"  {safe(chart.description)}" if safe(chart.description) else ""
        preset = f"  {safe(chart.mismatch or f'preset {chart.preset}')}" if chart.preset else ""
        self._line("\n", self._paint(safe(chart.label), "bold"), name, self._paint(preset, "dim"))
        if chart.playable:
            self._stream.write(chart_table(chart, self._terminal))
            if chart.estimate is not None:
                self._line(f"plays like {chart.estimate.bill}", self._paint(f"  ({chart.estimate.span})", "dim"))
            self._alternatives(chart)
            self._forced(chart)
        for finding in chart.findings:
            self._finding(result, chart, finding)
        if chart.findings:
            self._line()

    def _alternatives(self, chart: ChartResult) -> None:
        """Other plays: what they cost more and why, and their letters against those of the play above."""
        if chart.alternatives is None:
            return
        self._line("other plays:" if chart.alternatives else "there is no other play")
        for other in chart.alternatives:
            why = ", ".join(f"{name} {cost:+}" for name, cost in other.terms)
            self._line("  ", self._paint(f"{other.extra:+}" if other.extra else "tie", "bold"), f"  {why}".rstrip())
            for run in other.runs:
                beats = f"{round(run.first_beat, 3):g}"
                if run.last_beat > run.first_beat:
                    beats += f" to {round(run.last_beat, 3):g}"
                self._line(
                    f"      beat {beats}: ", _cut(run.other), self._paint(" in place of ", "dim"), _cut(run.best)
                )

    def _forced(self, chart: ChartResult) -> None:
        """Doublesteps that are no fault of the feet, each with what forces it."""
        forced = [cause for cause in chart.causes or () if cause.forced]
        for cause in forced[:_MOST_FORCED]:
            panel = (
                f" {chart.arrows[cause.column]}"
                if cause.column is not None and chart.arrows and not self._plain
                else ""
            )
            since = "" if cause.at_beat is None else f" of beat {round(cause.at_beat, 3):g}"
            self._line(f"forced doublestep on beat {round(cause.beat, 3):g}, by the {cause.cause}{since}{panel}")
        if len(forced) > _MOST_FORCED:
            self._line(f"... and {len(forced) - _MOST_FORCED} more; --format json tells all")

    def _finding(self, result: FileResult, chart: ChartResult | None, finding: Finding) -> None:
        rule = self._paint(f"{finding.rule}", STYLES[finding.severity])
        place = ":".join(str(n) for n in (finding.line, finding.column) if n is not None)
        where = f"{safe_path(result.path)}:{place}" if place else safe_path(result.path)
        label = f" [{safe(chart.label)}]" if chart else ""
        self._line(f"{where} {rule} {safe(finding.message)}", self._paint(label + moment(finding), "dim"))
        if finding.suggestion:
            self._line(f"    better: {safe(finding.suggestion)}")
        for line in draw(finding.excerpt, chart.arrows if chart else "", self._paint, plain=self._plain):
            self._line(line)

    def _line(self, *parts: str) -> None:
        self._stream.write("".join(parts) + "\n")


def _cut(letters: str) -> str:
    rows = letters.split(" ")
    return " ".join(rows[:_MOST_LETTERS]) + (f" ... ({len(rows)} rows)" if len(rows) > _MOST_LETTERS else "")


def moment(finding: Finding) -> str:
    """ " measure 4 beat 16 0:07.512", or as much of it as is known."""
    parts = []
    if finding.measure is not None:
        parts.append(f"measure {finding.measure}")
    if finding.beat is not None:
        parts.append(f"beat {round(finding.beat, 3):g}")
    if finding.second is not None:
        parts.append(clock(finding.second))
    return "".join(f" {part}" for part in parts)


def clock(second: float) -> str:
    """Seconds as players read them: "1:02.500", negative before the music starts."""
    milliseconds = round(abs(second) * 1000)
    minutes, rest = divmod(milliseconds, 60_000)
    return f"{'-' if second < 0 and milliseconds else ''}{minutes}:{rest // 1000:02}.{rest % 1000:03}"
