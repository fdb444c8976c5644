"""The lane-split chart, left foot on the left pad: as a `.edit` file for an unmodified game, or in the chart file."""

from __future__ import annotations

import glob
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.edits import Splice, write_notes
from dancetutor_cli.chart.model import STEP_KINDS, Chart, Song
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play
from dancetutor_cli.markers.model import ChartFeet, FileChange, change_of, old_content, removal_of
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import CHART_LIMIT, read_bytes

SOURCE, TARGET = "dance-single", "dance-double"
_COLUMNS = 4
_SIDE = {Limb.LEFT_FOOT: 0, Limb.LEFT_HAND: 0, Limb.RIGHT_FOOT: 1, Limb.RIGHT_HAND: 1}


def sides(chart: Chart, play: Play) -> NDArray[np.int64]:
    """Return the pad of each note of a single chart, (n,): 0 left, 1 right.

    A step goes to the pad of the limb that plays it. A note without a step (a mine, a fake, a step that is not judged)
    goes to the pad of the last step on its panel, so that a mine stays under the foot that it threatens. Before the
    first step, only the right arrow is on the right pad. A step for which no limb is free goes to the pad with fewer
    steps in its row.
    """
    limbs = _limbs(chart, play)
    last = [0, 0, 0, 1]
    out = np.zeros(len(chart.notes), dtype=np.int64)
    places = zip(chart.notes.tick.tolist(), chart.notes.column.tolist(), strict=True)
    for i, (tick, column) in enumerate(places):
        limb = limbs.get((tick, column))
        if limb is None:
            out[i] = last[column]
            continue
        if limb in _SIDE:
            side = _SIDE[Limb(limb)]
        else:
            row = [_SIDE[Limb(other)] for c in range(_COLUMNS) if (other := limbs.get((tick, c), -1)) in _SIDE]
            side = int(row.count(1) < row.count(0))
        out[i] = last[column] = side
    return out


def note_data(chart: Chart, play: Play, eol: bytes) -> bytes:
    """Return the note data of the lane-split chart, by `chart.edits.write_notes`."""
    columns = chart.notes.column + _COLUMNS * sides(chart, play)
    return write_notes(chart.notes, columns, 2 * _COLUMNS, eol)


def _limbs(chart: Chart, play: Play) -> dict[tuple[int, int], int]:
    """Return {(tick, column): `Limb`} of all written steps, without virtual taps of rolls."""
    row, column = (play.rows.steps > 0).nonzero()
    ticks = play.rows.tick[row].tolist()
    every = dict(zip(zip(ticks, column.tolist(), strict=True), play.limb[row, column].tolist(), strict=True))
    notes = chart.notes
    steps = notes.judged & np.isin(notes.kind, STEP_KINDS)
    written = zip(notes.tick[steps].tolist(), notes.column[steps].tolist(), strict=True)
    return {place: every[place] for place in written if place in every}


# The style: the lane-split chart in a .edit file, or added to the chart file.

LIMIT = 60 * 1024  # bytes of a .edit file that the games still read
MARK = b"//{dt1 edit}"
_NAME = "dancetutor feet"
_SPECIAL = re.compile(r"([\\:;#/])")
_TIMING = ("OFFSET", "BPMS", "STOPS", "DELAYS", "WARPS", "FAKES", "SCROLLS", "SPEEDS")


class EditError(FileError):
    """A lane-split chart cannot be made in this form; other styles are not affected."""


def is_ours(chart: Chart) -> bool:
    """Whether this style has added a chart."""
    made = chart.steps_type == TARGET and chart.difficulty == "Edit"
    return made and chart.description.startswith(_NAME)


def write(song: Song, folder: Path, feet: Sequence[ChartFeet]) -> Iterator[FileChange]:
    """Yield the .edit file of each single chart of a song; a file that is not possible has an `error`."""
    names = _names(song)
    for one in feet:
        if one.chart.steps_type != SOURCE:
            continue
        path = folder / _path(song, names[one.chart.index]).name
        try:
            data = _edit_file(song, one, names[one.chart.index])
        except EditError as error:
            yield FileChange(path, None, None, error=error)
        else:
            yield change_of(path, old_content(path, song), data)


def strip(song: Song, charts: Sequence[Chart]) -> Iterator[FileChange]:
    """Yield the removal of the .edit files."""
    for path in edit_paths(song, charts):
        yield removal_of(path, read_bytes(path, CHART_LIMIT), None)


def _path(song: Song, name: str) -> Path:
    return song.path.with_name(f"{song.path.stem} {name}.edit")


def _edit_file(song: Song, one: ChartFeet, name: str) -> bytes:
    """Return the content of a chart's .edit file. Raises EditError if it is not possible."""
    chart = one.chart
    if chart.timing != song.timing:
        raise EditError(
            song.path, f"{chart.label}: has its own timing, which an .edit file cannot have; use --into-file"
        )
    folder = song.path.resolve().parent
    head = f"#SONG:{_value(folder.parent.name)}/{_value(folder.name)};\n".encode("utf-8", "surrogateescape")
    data = head + _sm_chart(chart, name, note_data(chart, one.play, b"\n"), b"\n")
    if len(data) > LIMIT:
        text = f"{chart.label}: as .edit it would have {len(data):,} bytes; games read {LIMIT:,}; use --into-file"
        raise EditError(song.path, text)
    if len(parse(data, song.path.with_suffix(".sm")).charts[0].notes) != len(chart.notes):
        raise EditError(song.path, f"{chart.label}: the .edit file would lose notes; nothing was written")
    return data


def edit_paths(song: Song, charts: Sequence[Chart]) -> list[Path]:
    """Return this program's .edit files for charts of a song, and those whose chart no longer exists."""
    names = _names(song)
    meant = {chart.index for chart in charts}
    others = {_path(song, name) for index, name in names.items() if index not in meant}
    mark = f"{_NAME} ".encode()
    found = sorted(song.path.parent.glob(f"{glob.escape(song.path.stem)} {_NAME}*.edit"))
    return [path for path in found if path not in others and mark in read_bytes(path, CHART_LIMIT)[:4096]]


def added_charts(song: Song, feet: Sequence[ChartFeet]) -> bytes:
    """Return the text to append to a chart file: a block for each single chart, starting on the file's last line."""
    eol = b"\r\n" if b"\r\n" in song.data else b"\n"
    names = _names(song)
    if any(song.data[c.notes_span[1] : c.notes_span[1] + 1] != b";" for c in song.charts[-1:]):
        raise EditError(song.path, "the last chart has no ';' at its end, so no chart can be added after it")
    if song.data.endswith(b"\\"):
        raise EditError(song.path, "ends with a lone '\\', so no chart can be added after it")
    blocks = []
    for one in feet:
        if one.chart.steps_type != SOURCE:
            continue
        notes = note_data(one.chart, one.play, eol)
        name = names[one.chart.index]
        ssc = song.format == "ssc"
        made = _ssc_chart(song, one.chart, name, notes, eol) if ssc else _sm_chart(one.chart, name, notes, eol)
        blocks.append(MARK + eol + made)
    return b"".join(blocks)


def without_added(song: Song, charts: Sequence[Chart]) -> list[Splice]:
    """Return the replacements that remove charts added for these charts, or for charts that no longer exist."""
    names = _names(song)
    meant = {chart.index for chart in charts}
    kept = {name for index, name in names.items() if index not in meant}
    return [_block(song, chart) for chart in song.charts if is_ours(chart) and chart.description not in kept]


def _block(song: Song, chart: Chart) -> Splice:
    tag = rb"#NOTES\b" if song.format == "sm" else rb"#NOTEDATA\b"
    before = song.data[: chart.notes_span[0]]
    start = [match.start() for match in re.finditer(tag, before, re.IGNORECASE)][-1]
    mark = re.compile(re.escape(MARK) + rb"\r?\n\Z")
    if match := mark.search(song.data, max(start - len(MARK) - 2, 0), start):
        start = match.start()
    end = re.compile(rb";?(?:\r?\n)?").match(song.data, chart.notes_span[1])
    assert end is not None
    return Splice(start, end.end(), b"")


def _names(song: Song) -> dict[int, str]:
    """Return a unique name for each single chart, even with the same difficulty and meter."""
    names: dict[int, str] = {}
    for chart in song.charts:
        if chart.steps_type == SOURCE:
            name = f"{_NAME} {chart.difficulty} {chart.meter}"
            twins = sum(1 for other in names.values() if other == name or other.startswith(f"{name} ("))
            names[chart.index] = f"{name} ({twins + 1})" if twins else name
    return names


def _value(text: str) -> str:
    """Return text for a tag's value, with special characters escaped."""
    return _SPECIAL.sub(r"\\\1", text)


def _sm_chart(chart: Chart, name: str, notes: bytes, eol: bytes) -> bytes:
    fields = (TARGET, name, "Edit", str(chart.meter), "0,0,0,0,0")
    head = b"#NOTES:" + eol + b"".join(f"     {field}:".encode() + eol for field in fields)
    return head + notes + b";" + eol


def _ssc_chart(song: Song, chart: Chart, name: str, notes: bytes, eol: bytes) -> bytes:
    tags = {
        "NOTEDATA": "", "CHARTNAME": name, "STEPSTYPE": TARGET, "DESCRIPTION": name, "CHARTSTYLE": "",
        "DIFFICULTY": "Edit", "METER": str(chart.meter), "RADARVALUES": "0,0,0,0,0", "CREDIT": "dancetutor",
    }  # fmt: skip
    if chart.timing != song.timing:  # one timing tag of its own switches a chart to its own timing: all or none
        tags |= {key: " ".join(chart.tags[key].split()) for key in _TIMING if key in chart.tags}
        tags.setdefault("BPMS", f"0.000={float(chart.timing.bpms[0][1]):.3f}")
    head = b"".join(f"#{key}:{value};".encode("ascii", "ignore") + eol for key, value in tags.items())
    return head + b"#NOTES:" + eol + notes + b";" + eol
