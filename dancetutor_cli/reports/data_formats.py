"""Formats for other programs: JSON (docs/formats.md), JSON lines, CSV."""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path, PurePath
from typing import IO, Any

import dancetutor_cli
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.lint.findings import TECH_COUNTS, Cause, Estimate, Finding, ScoreEstimate, Sync
from dancetutor_cli.lint.results import ChartResult, FileResult
from dancetutor_cli.reports.analyze_formats import Output, Report, Tally
from dancetutor_cli.run.foreign_text import as_text, json_without_commands, safe, safe_path

# The common part of all formats for programs: one entry per finding, with its file, its chart and a fingerprint.


@dataclass(frozen=True, slots=True)
class Entry:
    """A finding with its place; texts are safe to print. `path` is relative to the working folder if possible."""

    path: str
    finding: Finding
    chart: ChartResult | None
    fingerprint: str

    @property
    def message(self) -> str:
        """The finding's message with the edit that would remove it and the chart it is about."""
        return self._placed(self.finding.message)

    @property
    def sentence(self) -> str:
        """The message after the rule's name, for formats that do not show the name beside it."""
        return self._placed(self.finding.sentence)

    def _placed(self, text: str) -> str:
        better = self.finding.suggestion
        text = safe(text) + (f"; better: {safe(better)}" if better else "")
        return f"{text} [{safe(self.chart.label)}]{self.moment}" if self.chart else text

    @property
    def moment(self) -> str:
        """The text " measure 4 beat 16"; "" if the beat is not known."""
        beat, measure = self.finding.beat, self.finding.measure
        return "" if beat is None else f" measure {measure} beat {round(beat, 3):g}"

    @property
    def place(self) -> str:
        """The place in the chart as a path: "dance-single Hard 8/measure 4/beat 16"; "" for the file itself."""
        if self.chart is None:
            return ""
        steps = [safe(self.chart.label)]
        if self.finding.beat is not None:
            steps += [f"measure {self.finding.measure}", f"beat {round(self.finding.beat, 3):g}"]
        return "/".join(steps)


def entries(result: FileResult) -> Iterator[Entry]:
    """Yield every finding of a file. The fingerprint is a hash of file, chart, beat and rule; other edits keep it."""
    path = relative(result.path)
    seen: dict[str, int] = {}
    for finding, chart in result.all_findings():
        place = (
            "" if chart is None else f"{chart.steps_type}|{chart.difficulty}|{chart.description}{chart.player_suffix}"
        )
        beat = finding.line if finding.beat is None else round(finding.beat * TICKS_PER_BEAT)
        identity = f"{path}|{place}|{beat}|{finding.rule}"
        seen[identity] = seen.get(identity, 0) + 1
        text = f"{identity}|{seen[identity]}" if seen[identity] > 1 else identity
        yield Entry(path, finding, chart, hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()[:32])


def relative(path: str) -> str:
    """Return `path` with forward slashes, relative to the working folder if it is inside."""
    pure = PurePath(path)
    if pure.is_absolute() and pure.is_relative_to(Path.cwd()):
        pure = pure.relative_to(Path.cwd())
    return safe_path(pure.as_posix())


# `--format json`: the object of docs/formats.md, written file by file.

SCHEMA = 1


class JsonReport(Report):
    """One JSON object in UTF-8; every file is a line of its own inside `files`.

    The head names the preset of the first chart with a preset in the first file, else the preset of the run.
    """

    def __init__(self, output: Output) -> None:
        super().__init__(output)
        self._bytes: IO[bytes] = output.stream.buffer  # type: ignore[attr-defined]
        self._preset = output.preset
        self._files = 0

    def add(self, result: FileResult) -> None:
        """Write one file."""
        if not self._files:
            self._head(next((chart.preset for chart in result.charts if chart.preset), self._preset))
        self._write(f"{',' if self._files else ''}\n ", *file_texts(result))
        self._files += 1

    def end(self, tally: Tally) -> None:
        """Close the object."""
        if not self._files:
            self._head(self._preset)
        self._write("\n]}\n")
        self._bytes.flush()

    def _head(self, preset: str) -> None:
        head = {"schema": SCHEMA, "tool": f"dancetutor {dancetutor_cli.__version__}", "preset": preset}
        self._write(json.dumps(head, ensure_ascii=False)[:-1] + ', "files": [')

    def _write(self, *texts: str) -> None:
        for text in texts:  # not writelines: a stream that copies its text, as click's for tests, does not see that
            self._bytes.write(json_without_commands(text).encode("utf-8", "replace"))


def file_texts(result: FileResult) -> Iterator[str]:
    """Yield one entry of `files` in pieces, because it may be long; findings about the file follow its charts."""
    head = _members({"path": result.path, "error": result.error, "warnings": list(result.warnings)})
    sync = {} if result.sync is None else {"sync": sync_object(result.sync)}
    tail = _members({**sync, "findings": [finding_object(finding) for finding in result.findings]})
    yield f'{{{head}, "charts": ['
    for number, chart in enumerate(result.charts):
        yield from _chart_texts(chart, ", " if number else "")
    yield f"], {tail}}}"


def _chart_texts(chart: ChartResult, before: str) -> Iterator[str]:
    """Yield one entry of `charts` in pieces; its rows are JSON already."""
    head = {
        "index": chart.index,
        "steps_type": chart.steps_type,
        **({"player": chart.player} if chart.player else {}),
        "difficulty": chart.difficulty,
        "meter": chart.meter,
        "description": chart.description,
        "cost": chart.cost,
    }
    tail = {
        "findings": [finding_object(finding) for finding in chart.findings],
        "preset": chart.preset,
        "hash": chart.hash,
        **({} if chart.sync is None else {"sync": sync_object(chart.sync)}),
        "doublesteps": [_cause_object(cause) for cause in chart.causes or ()],
        "ambiguous": [{"beat": beat, "kind": kind} for beat, kind in chart.ambiguous or ()],
        "plays_like": None if chart.estimate is None else _estimate_object(chart.estimate),
        "scores_like": None if chart.score is None else _score_object(chart.score),
        **({} if chart.alternatives is None else {"alternatives": [asdict(other) for other in chart.alternatives]}),
    }
    yield f'{before}{{{_members(head)}, "rows": '
    yield chart.rows or "[]"
    yield f", {_members(tail)}}}"


def _cause_object(cause: Cause) -> dict[str, Any]:
    """Return one entry of `doublesteps`, ten times faster than `asdict`, because there are many."""
    return {
        "beat": cause.beat,
        "forced": cause.forced,
        "cause": cause.cause,
        "at_beat": cause.at_beat,
        "column": cause.column,
    }


def _estimate_object(estimate: Estimate) -> dict[str, Any]:
    """Return how hard a chart plays, rounded to hundredths of a meter."""
    return {
        "meter": round(estimate.meter, 2),
        "low": round(estimate.low, 2),
        "high": round(estimate.high, 2),
        "scale": estimate.scale,
        "scale_known": estimate.is_scale_known,
        "rate": estimate.rate,
        "terms": {name: round(meters, 2) for name, meters in estimate.terms},
    }


def _score_object(score: ScoreEstimate) -> dict[str, Any]:
    """Return how hard a chart is to score on, rounded to thousandths of a level; tiers are 0.05 levels apart."""
    return {
        "meter": round(score.meter, 3),
        "low": round(score.low, 3),
        "high": round(score.high, 3),
        "terms": {name: round(levels, 3) for name, levels in score.terms},
    }


def sync_object(sync: Sync) -> dict[str, Any]:
    """Return the sync of music and beats; `reason` is there only if the sync could not be judged."""
    return {
        "bias_ms": sync.bias_ms,
        "confidence": sync.confidence,
        "drift_ms": sync.drift_ms,
        "beat_off": sync.beat_off,
        "kind": sync.kind,
        **({} if sync.reason is None else {"reason": sync.reason}),
    }


def _members(data: dict[str, Any]) -> str:
    """Return the members of an object as JSON, without its braces."""
    return json.dumps(data, ensure_ascii=False)[1:-1]


def finding_object(finding: Finding) -> dict[str, Any]:
    """Return one entry of `findings`."""
    return {
        "rule": finding.rule,
        "name": finding.name,
        "severity": finding.severity,
        "beat": None if finding.beat is None else round(finding.beat, 6),
        "measure": finding.measure,
        "second": None if finding.second is None else round(finding.second, 6),
        "line": finding.line,
        "column": finding.note_column,
        "message": finding.message,
        "margin": finding.margin,
        "suggestion": finding.suggestion,
    }


# `--format jsonl`: one line with a JSON object for each finding.


class JsonLinesReport(Report):
    """One line for each finding, with its file and its chart in front."""

    def add(self, result: FileResult) -> None:
        """Write the findings of one file."""
        for entry in entries(result):
            chart = entry.chart
            named = {
                name: getattr(chart, name, None) for name in ("index", "steps_type", "difficulty", "meter", "preset")
            }
            line = {"path": entry.path, **named, **finding_object(entry.finding), "fingerprint": entry.fingerprint}
            text = json_without_commands(json.dumps(line, ensure_ascii=False))
            self._stream.write(text.encode("utf-8", "replace").decode("utf-8") + "\n")


# `--format csv`: one line for each chart, tech counts under the names of ITGmania and counted as it does.

# Further columns -> moves whose rows they count; ITGmania has none of these columns.
OWN = {
    "Spins": ("spin",),
    "JumpFootswitches": ("jump-footswitch",),
    "Holdswitches": ("holdswitch",),
    "Candles": ("candle",),
    "Gallops": ("gallop",),
}


_COMMAND = ("::", "##[")  # at the start of a line, for the log of a CI job


class CsvReport(Report):
    """A header and one line for each chart; files that could not be read go to standard error.

    Untrusted texts that a spreadsheet would read as a formula begin with an apostrophe; numbers are unchanged.
    """

    def __init__(self, output: Output) -> None:
        super().__init__(output)
        self._names = list(_line("", "", "", None))

    def begin(self) -> None:
        """Write the header."""
        self._stream.write(",".join(self._names) + "\n")

    def add(self, result: FileResult) -> None:
        """Write the charts of one file."""
        if result.error is not None:
            self._errors.write(f"dancetutor: {safe(result.error)}\n")
        file = (relative(result.path), safe(result.title), safe(result.artist)) if result.charts else ("", "", "")
        for chart in result.charts:
            self._stream.write(_csv_line(_line(*file, chart).values()))


def _csv_line(cells: Iterable[Any]) -> str:
    """Return one line of the file."""
    line = io.StringIO()
    csv.writer(line, lineterminator="\n").writerow([as_text(cell) if isinstance(cell, str) else cell for cell in cells])
    text = line.getvalue()
    if text.startswith(_COMMAND):  # the first cell, which is not in quotes yet
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
        "Hands": figures.hands if figures else 0,
        "findings": len(chart.findings) if chart else 0,
        "preset": safe(chart.preset or "") if chart else "",
        **_estimated(chart),
        "player": (chart.player or "") if chart else "",
        "hash": (chart.hash or "") if chart else "",
        **_scored(chart),
    }


def _estimated(chart: ChartResult | None) -> Mapping[str, Any]:
    """Return the columns of the meter estimate; empty if the pad has no model of meters."""
    estimate = chart.estimate if chart else None
    return {
        "plays_like": round(estimate.meter, 2) if estimate else "",
        "plays_low": round(estimate.low, 2) if estimate else "",
        "plays_high": round(estimate.high, 2) if estimate else "",
        "meter_scale": estimate.scale if estimate else "",
        "bill": "; ".join(f"{name} {meters:.2f}" for name, meters in estimate.terms) if estimate else "",
    }


def _scored(chart: ChartResult | None) -> Mapping[str, Any]:
    """Return the columns of the score estimate; empty if nobody has rated charts of the pad."""
    estimate = chart.score if chart else None
    return {
        "scores_like": round(estimate.meter, 3) if estimate else "",
        "scores_low": round(estimate.low, 3) if estimate else "",
        "scores_high": round(estimate.high, 3) if estimate else "",
        "score_bill": "; ".join(f"{name} {levels:.3f}" for name, levels in estimate.terms) if estimate else "",
    }
