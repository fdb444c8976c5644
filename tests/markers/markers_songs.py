"""Songs and feet for the tests of markers: a small chart as text, letters that need no solver."""

from __future__ import annotations

import random
from collections.abc import Sequence
from pathlib import Path
from typing import cast

import numpy as np

from dancetutor_cli.chart.edits import apply
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.annotations import StepRows, step_rows
from dancetutor_cli.feet.limbs import LETTERS
from dancetutor_cli.feet.play import Play
from dancetutor_cli.markers import measure, rows
from dancetutor_cli.markers.model import ChartFeet
from dancetutor_cli.run.errors import FileError

HEADER = b"#TITLE:Song;\n#OFFSET:0;\n#BPMS:0=120;\n"
SM_CHART = b"#NOTES:\n     dance-single:\n     :\n     Hard:\n     8:\n     0,0,0,0,0:"


def sm(measures: bytes, header: bytes = HEADER) -> bytes:
    """A .sm file with one chart; `measures` is what follows the last `:`, up to the `;`."""
    return header + SM_CHART + measures


def song_of(data: bytes, name: str = "song.sm") -> Song:
    return parse(data, Path(name))


def random_letters(chart: Chart, found: StepRows, seed: int) -> list[str]:
    dice = random.Random(seed * 1000 + chart.index)
    ends = np.cumsum(found.steps.sum(axis=1)).tolist()
    text = "".join(dice.choices(sorted(LETTERS), k=ends[-1])) if ends else ""
    return [text[a:b] for a, b in zip([0, *ends[:-1]], ends, strict=True)] if ends else []


def letters_as_feet(chart: Chart, found: StepRows, letters: Sequence[str]) -> ChartFeet:
    """Feet without a play, which the styles in note data do not need."""
    return ChartFeet(chart, found, tuple(letters), cast(Play, None))


def annotated(song: Song, seed: int = 1, styles: Sequence[str] = ("measure",), force: bool = False) -> bytes:
    """The file with random feet in it; the same seed gives the same feet."""
    splices = []
    for chart in song.charts:
        found = step_rows(song.data, chart)
        letters = random_letters(chart, found, seed)
        if "measure" in styles:
            splices += measure.write(song, letters_as_feet(chart, found, letters), force).splices
        if "rows" in styles:
            splices += rows.write(song, letters_as_feet(chart, found, letters), force).splices
    return apply(song.data, splices)


def stripped(song: Song, styles: Sequence[str] = ("measure",), force: bool = False) -> bytes:
    splices = []
    for chart in song.charts:
        if "measure" in styles:
            splices += measure.strip(song, chart, force).splices
        if "rows" in styles:
            splices += rows.strip(song, chart, force).splices
    return apply(song.data, splices)


def readable(path: Path) -> Song | None:
    """The song, or None for a file without charts."""
    try:
        return parse(path.read_bytes(), path)
    except FileError:
        return None


def chart_files(folder: Path) -> list[Path]:
    return sorted(path for path in folder.rglob("*") if path.suffix.lower() in (".sm", ".ssc"))
