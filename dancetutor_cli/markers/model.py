"""Data that all styles of markers share: the feet of a chart, changes of files, and the reports of `--check`."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.edits import Splice
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.feet.annotations import StepRows
from dancetutor_cli.feet.limbs import Limb, Part, letter
from dancetutor_cli.feet.play import Play
from dancetutor_cli.run.errors import FileError, MissingFileError
from dancetutor_cli.run.files import encode_json
from dancetutor_cli.run.reading import CHART_LIMIT, parse_json, read_bytes


@dataclass(frozen=True, slots=True)
class ChartFeet:
    """A solved chart. rows : its written rows with steps; letters : the letters of each row, left to right"""

    chart: Chart
    rows: StepRows
    letters: tuple[str, ...]
    play: Play


@dataclass(frozen=True, slots=True)
class CheckLine:
    """A line about a file, mostly of `--check`.

    line, column : 1-based place in the chart file, None: the line is about another file
    """

    message: str
    line: int | None = None
    column: int | None = None

    def at(self, path: Path) -> str:
        """Return the message with the file and the place."""
        place = "".join(f":{n}" for n in (self.line, self.column) if n is not None)
        return f"{path}{place}: {self.message}"


@dataclass(slots=True)
class NoteChange:
    """The changes of a style in the note data of one chart.

    counts : number of measures or rows by state; lacks : reports of `--check`; notes : lines for people
    """

    splices: list[Splice]
    counts: Counter[str] = field(default_factory=Counter)
    lacks: list[CheckLine] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def add(self, other: NoteChange) -> None:
        """Add the changes of another chart or style."""
        self.splices += other.splices
        self.counts += other.counts
        self.lacks += other.lacks
        self.notes += other.notes


@dataclass(frozen=True, slots=True)
class FileChange:
    """A change of a file. old : its content, None if it does not exist; new : None to remove it

    error : why the file cannot be written; then it stays as it is, and other files are written
    """

    path: Path
    old: bytes | None
    new: bytes | None
    lacks: tuple[CheckLine, ...] = ()
    error: FileError | None = None

    @property
    def is_change(self) -> bool:
        """Whether the file changes."""
        return self.old != self.new


def change_of(path: Path, old: bytes | None, new: bytes | None, problem: str | None = None) -> FileChange:
    """Return the change of a file with feet. problem : the report of `--check` after the file's name"""
    problem = problem or f"is {'missing' if old is None else 'stale'}"
    return FileChange(path, old, new, () if old == new else (CheckLine(f"{path.name} {problem}"),))


def removal_of(path: Path, old: bytes | None, new: bytes | None) -> FileChange:
    """Return the change that removes feet from a file."""
    return change_of(path, old, new, "has feet to remove")


def old_content(path: Path, song: Song) -> bytes | None:
    """Return the content of a file, else of the file with this name beside the song; None if neither exists."""
    for place in (path, song.path.with_name(path.name)):
        try:
            return read_bytes(place, CHART_LIMIT)
        except MissingFileError:
            continue
    return None


def own_json(path: Path, old: bytes, what: str, fits: Callable[[Any], bool]) -> Any:
    """Parse the JSON of an old file. Raises FileError if this program did not write it.

    what : name of the expected file in messages; fits : whether the parsed file has the form; KeyError and TypeError
    mean no
    """
    data, is_ours = None, False
    with suppress(FileError, KeyError, TypeError, AttributeError):
        data = parse_json(encode_json(old.decode("utf-8", "surrogateescape")), path)
        is_ours = data["program"] == "dancetutor" and fits(data)
    check_is_ours(path, is_ours, what)
    return data


def check_is_ours(path: Path, is_ours: bool, what: str) -> None:
    """Raise FileError unless this program wrote a file. what : the expected file, for people"""
    if not is_ours:
        raise FileError(path, f"is not {what}; move it away or choose another style")


def json_lines(entries: Iterable[Any]) -> str:
    """Return the entries of a JSON list, one per line, so that version control shows the changed ones."""
    return ",\n".join("   " + json.dumps(entry, ensure_ascii=False) for entry in entries)


_LOW = min(Limb)
_LETTER = np.array(  # by (limb - _LOW) * len(Part) + part
    [ord(letter(limb, part)) for limb in range(_LOW, max(Limb) + 1) for part in Part], dtype=np.uint8
)


def limbs_of(chart: Chart, rows: StepRows, play: Play) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return `Limb` and `Part` of every cell of `rows`, each (n, c); `Limb.NONE` for cells without a judged step."""
    limb = np.full(rows.steps.shape, int(Limb.NONE), dtype=np.int64)
    part = np.zeros(rows.steps.shape, dtype=np.int64)
    if not len(rows) or not len(play.rows):
        return limb, part
    tick = chart.rows.tick[rows.row]
    found = np.minimum(np.searchsorted(play.rows.tick, tick), len(play.rows) - 1)
    known = play.rows.tick[found] == tick
    columns = min(rows.steps.shape[1], play.limb.shape[1])
    limb[known, :columns] = play.limb[found[known], :columns]
    part[known, :columns] = play.part[found[known], :columns]
    limb[~rows.steps] = int(Limb.NONE)
    return limb, part


def row_letters(chart: Chart, rows: StepRows, play: Play) -> list[str]:
    """Return the letters of each row of `rows`, left to right; `.` for steps that are not played or not judged."""
    if not len(rows):
        return []
    limb, part = limbs_of(chart, rows, play)
    letters = _LETTER[(limb - _LOW) * len(Part) + part]
    flat = letters[rows.steps].tobytes().decode("ascii")
    ends = np.cumsum(rows.steps.sum(axis=1)).tolist()
    return [flat[a:b] for a, b in zip([0, *ends[:-1]], ends, strict=True)]


def limbs_of_steps(feet: ChartFeet) -> Iterator[tuple[int, int, int, int]]:
    """Yield the tick, the column, the `Limb` and the `Part` of each written step of a chart."""
    limb, part = limbs_of(feet.chart, feet.rows, feet.play)
    row, column = feet.rows.steps.nonzero()
    ticks = feet.chart.rows.tick[feet.rows.row[row]].tolist()
    yield from zip(ticks, column.tolist(), limb[row, column].tolist(), part[row, column].tolist(), strict=True)
