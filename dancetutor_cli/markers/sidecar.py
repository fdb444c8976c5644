"""The style `sidecar`: `SONG.dancetutor.json` beside the file, which editors do not remove when they save the chart."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.markers.model import (
    ChartFeet,
    CheckLine,
    FileChange,
    json_lines,
    limbs_of_steps,
    old_content,
    own_json,
    removal_of,
)
from dancetutor_cli.run.files import encode_json

SUFFIX = ".dancetutor.json"
_SCHEMA = 1


def write(song: Song, folder: Path, feet: Sequence[ChartFeet]) -> Iterator[FileChange]:
    """Yield the sidecar of a chart file, which the .sm and the .ssc share; entries of other files and charts stay."""
    path = folder / (song.path.stem + SUFFIX)
    old = old_content(path, song)
    files = _files(path, old)
    before = files.get(song.path.name, {}).get("charts", [])
    indices = {one.chart.index for one in feet}
    kept = [entry for entry in before if entry.get("index") not in indices and _has_chart(entry, song)]
    charts = sorted([*kept, *(_entry(one) for one in feet)], key=lambda entry: int(entry["index"]))
    files[song.path.name] = {"charts": charts}
    new = _dump(files)
    why = ((one.chart, check_entry(path, old, song, one.chart, new)) for one in feet)
    yield FileChange(path, old, new, tuple(CheckLine(text, chart.line) for chart, text in why if text))


def strip(song: Song, charts: Sequence[Chart]) -> Iterator[FileChange]:
    """Yield the sidecar without some charts of a file; without the last entry, the sidecar is removed."""
    path = song.path.with_name(song.path.stem + SUFFIX)
    old = old_content(path, song)
    files = _files(path, old)
    gone = {chart.index for chart in charts}
    before = files.pop(song.path.name, {}).get("charts", [])
    if kept := [entry for entry in before if entry.get("index") not in gone]:
        files[song.path.name] = {"charts": kept}
    yield removal_of(path, old, _dump(files) if files else None)


def check_entry(path: Path, old: bytes | None, song: Song, chart: Chart, new: bytes) -> str | None:
    """Return the report of `--check` about a chart's entry; None if it is current."""
    entry, wanted = (_find(_files(path, data), song, chart) for data in (old, new))
    if entry == wanted:
        return None
    if entry is None:
        return f"{chart.label}: {path.name} has no feet for it"
    if entry.get("notes_sha256") != notes_hash(chart):
        return f"{chart.label}: its notes have changed since {path.name} was written"
    return f"{chart.label}: {path.name} has other feet than the solver finds"


def notes_hash(chart: Chart) -> str:
    """SHA-256 of the notes: a line "tick,column,kind,end" for each, ticks of 1/48 beat, `kind` as in `chart.model`."""
    notes = chart.notes
    rows = zip(notes.tick.tolist(), notes.column.tolist(), notes.kind.tolist(), notes.end.tolist(), strict=True)
    text = "".join(f"{tick},{column},{kind},{end}\n" for tick, column, kind, end in rows)
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def _has_chart(entry: Any, song: Song) -> bool:
    index = entry.get("index")
    return isinstance(index, int) and 0 <= index < len(song.charts)


def _entry(one: ChartFeet) -> dict[str, Any]:
    chart = one.chart
    return {
        "index": chart.index,
        "steps_type": chart.steps_type,
        "difficulty": chart.difficulty,
        "meter": chart.meter,
        "description": chart.description,
        "preset": one.play.preset,
        "notes_sha256": notes_hash(chart),
        "steps": list(_steps(one)),
    }


def _steps(one: ChartFeet) -> list[list[Any]]:
    """Return [beat, column, limb] of each step, with the part of the foot in a bracket; limb null: the step is not
    played.
    """
    steps = []
    for tick, at, who, which in limbs_of_steps(one):
        step: list[Any] = [round(tick / TICKS_PER_BEAT, 6), at, None if who < 0 else Limb(who).name.lower()]
        steps.append([*step, Part(which).name.lower()] if which else step)
    return steps


def _files(path: Path, old: bytes | None) -> dict[str, Any]:
    if old is None:
        return {}
    data = own_json(path, old, "a sidecar file of dancetutor", _holds_charts)
    return dict(data["files"])


def _holds_charts(data: Any) -> bool:
    return all(isinstance(entry["index"], int) for file in data["files"].values() for entry in file["charts"])


def _find(files: dict[str, Any], song: Song, chart: Chart) -> Any:
    charts = files.get(song.path.name, {}).get("charts", [])
    return next((entry for entry in charts if entry.get("index") == chart.index), None)


def _dump(files: dict[str, Any]) -> bytes:
    blocks = []
    for name in sorted(files):
        lines = json_lines(files[name]["charts"])
        blocks.append(f'  {json.dumps(name, ensure_ascii=False)}: {{"charts": [\n{lines}]}}')
    head = f'{{"schema": {_SCHEMA}, "program": "dancetutor", "files": {{\n'
    return encode_json(head + ",\n".join(blocks) + "}}\n")
