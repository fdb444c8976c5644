"""`--format csv`: one line for each chart, tech counts under the names of ITGmania and counted as it does."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping
from typing import IO, Any

from dancetutor_cli.csv_cells import as_text
from dancetutor_cli.jobs.result import ChartResult, FileResult
from dancetutor_cli.lint.chart_figures import TECH_COUNTS
from dancetutor_cli.reports.safe import safe
from dancetutor_cli.reports.structured import relative
from dancetutor_cli.reports.tally import Tally

# Further columns -> moves whose rows they count; ITGmania knows none of these.
OWN = {
    "Spins": ("spin",),
    "JumpFootswitches": ("jump-footswitch",),
    "Holdswitches": ("holdswitch",),
    "Candles": ("candle",),
    "Gallops": ("gallop",),
    "Hands": ("hand",),
}


_COMMAND = ("::", "##[")  # at the start of a line, for the log of a CI job


class CsvReport:
    """Writes a header and one line a chart; files that could not be read go to `errors`.

    Texts of other people that a spreadsheet would take for a formula begin with an apostrophe; numbers stay.
    """

    def __init__(self, stream: IO[str], errors: IO[str]) -> None:
        self._stream = stream
        self._errors = errors
        self._names = list(_line("", "", "", None))

    def begin(self) -> None:
        """The header needs no chart."""
        self._stream.write(",".join(self._names) + "\n")

    def add(self, result: FileResult) -> None:
        """Write the charts of one file."""
        if result.error is not None:
            self._errors.write(f"dancetutor: {safe(result.error)}\n")
        file = (relative(result.path), safe(result.title), safe(result.artist)) if result.charts else ("", "", "")
        for chart in result.charts:
            self._stream.write(_written(_line(*file, chart).values()))

    def end(self, tally: Tally) -> None:
        """Nothing comes after the last chart."""


def _written(cells: Iterable[Any]) -> str:
    """One line of the file."""
    line = io.StringIO()
    csv.writer(line, lineterminator="\n").writerow([as_text(cell) if isinstance(cell, str) else cell for cell in cells])
    text = line.getvalue()
    if text.startswith(_COMMAND):  # the first cell, which nothing has made stand in quotes
        first, comma, rest = text.partition(",")
        text = f'"{first}"{comma}{rest}'
    return text


def _line(path: str, title: str, artist: str, chart: ChartResult | None) -> Mapping[str, Any]:
    counts: Mapping[str, int] = chart.counts if chart else {}
    figures = chart.figures if chart else None
    return {
        "file": path,
        "title": title,
        "artist": artist,
        "index": chart.index if chart else 0,
        "steps_type": safe(chart.steps_type) if chart else "",
        "difficulty": chart.difficulty if chart else "",
        "meter": chart.meter if chart else 0,
        "description": safe(chart.description) if chart else "",
        "rows": chart.row_count if chart else 0,
        "cost": chart.cost if chart else 0,
        "nps_mean": round(figures.nps_mean, 3) if figures else 0,
        "nps_peak": round(figures.nps_peak, 3) if figures else 0,
        "stream_measures": figures.stream_measures if figures else 0,
        "breakdown": figures.breakdown if figures else "",
        **{name: figures.tech.get(name, 0) if figures else 0 for name in TECH_COUNTS},
        **{name: sum(counts.get(move, 0) for move in moves) for name, moves in OWN.items()},
        "findings": len(chart.findings) if chart else 0,
        "preset": safe(chart.preset or "") if chart else "",
        **_estimated(chart),
        "player": (chart.player or "") if chart else "",
    }


def _estimated(chart: ChartResult | None) -> Mapping[str, Any]:
    """How hard it plays; empty where the pad has no model of meters."""
    told = chart.estimate if chart else None
    return {
        "plays_like": round(told.meter, 2) if told else "",
        "plays_low": round(told.low, 2) if told else "",
        "plays_high": round(told.high, 2) if told else "",
        "meter_scale": told.scale if told else "",
        "bill": "; ".join(f"{name} {meters:.2f}" for name, meters in told.terms) if told else "",
    }
