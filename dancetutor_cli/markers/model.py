"""What all styles of markers share: the feet of a chart, the files that would change, what `--check` reports."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
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
from dancetutor_cli.run.files import encoded
from dancetutor_cli.run.reading import CHART_LIMIT, parse_json, read_bytes


@dataclass(frozen=True, slots=True)
class ChartFeet:
    """A solved chart. rows : its written rows with steps; letters : of each of them, left to right."""

    chart: Chart
    rows: StepRows
    letters: tuple[str, ...]
    play: Play


@dataclass(frozen=True, slots=True)
class Lack:
    """Something that `--check` reports. line, column : 1-based place in the chart file, None: about another file."""

    message: str
    line: int | None = None
    column: int | None = None

    def at(self, path: Path) -> str:
        """For people: file, place and what is missing."""
        place = "".join(f":{n}" for n in (self.line, self.column) if n is not None)
        return f"{path}{place}: {self.message}"


@dataclass(slots=True)
class NoteChange:
    """What a style changes in the note data of one chart.

    counts : measures or rows by what is done about them; lacks : what `--check` reports; notes : for people
    """

    splices: list[Splice]
    counts: Counter[str] = field(default_factory=Counter)
    lacks: list[Lack] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def add(self, other: NoteChange) -> None:
        """Take the changes of another chart or style in."""
        self.splices += other.splices
        self.counts += other.counts
        self.lacks += other.lacks
        self.notes += other.notes


@dataclass(frozen=True, slots=True)
class FileChange:
    """A file that is to become something else. old : None if it is not there; new : None to remove it."""

    path: Path
    old: bytes | None
    new: bytes | None
    lacks: tuple[Lack, ...] = ()

    @property
    def needed(self) -> bool:
        """Whether there is anything to do."""
        return self.old != self.new


def written(path: Path, old: bytes | None, new: bytes | None, problem: str | None = None) -> FileChange:
    """A file with feet to write. problem : what `--check` says if they are not there, after the file's name."""
    problem = problem or f"is {'missing' if old is None else 'stale'}"
    return FileChange(path, old, new, () if old == new else (Lack(f"{path.name} {problem}"),))


def removed(path: Path, old: bytes | None, new: bytes | None) -> FileChange:
    """A file with feet to take out."""
    return written(path, old, new, "has feet to remove")


def old_content(path: Path, song: Song) -> bytes | None:
    """A file as it is, or for one that goes elsewhere the one that lies by the song; None if there is none."""
    for place in (path, song.path.with_name(path.name)):
        try:
            return read_bytes(place, CHART_LIMIT)
        except MissingFileError:
            continue
    return None


def own_json(path: Path, old: bytes, what: str, fits: Callable[[Any], bool]) -> Any:
    """The parsed JSON of an old file, if this program wrote it; FileError if not.

    what : it should be, for people; fits : whether the parsed file is that; KeyError and TypeError say no
    """
    try:
        data = parse_json(encoded(old.decode("utf-8", "surrogateescape")), path)
        if data["program"] == "dancetutor" and fits(data):
            return data
    except (FileError, KeyError, TypeError, AttributeError):
        pass
    raise not_ours(path, what)


def not_ours(path: Path, what: str) -> FileError:
    """The error about a file of somebody else that lies where one of ours goes. what : it should be, for people."""
    return FileError(path, f"is not {what}; move it away or choose another style")


def json_lines(entries: Iterable[Any]) -> str:
    """Entries of a JSON list, each on a line of its own, so that version control shows which have changed."""
    return ",\n".join("   " + json.dumps(entry, ensure_ascii=False) for entry in entries)


_LOW = min(Limb)
_LETTER = np.array(  # by (limb - _LOW) * len(Part) + part
    [ord(letter(limb, part)) for limb in range(_LOW, max(Limb) + 1) for part in Part], dtype=np.uint8
)


def limbs_of(chart: Chart, rows: StepRows, play: Play) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """`Limb` and `Part` of every cell of `rows`, each (n, c); `Limb.NONE` where there is no step that is judged."""
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
    """The letters of each row of `rows`, left to right; `.` for steps that nobody plays or that are not judged."""
    if not len(rows):
        return []
    limb, part = limbs_of(chart, rows, play)
    letters = _LETTER[(limb - _LOW) * len(Part) + part]
    flat = letters[rows.steps].tobytes().decode("ascii")
    ends = np.cumsum(rows.steps.sum(axis=1)).tolist()
    return [flat[a:b] for a, b in zip([0, *ends[:-1]], ends, strict=True)]


def limbs_of_steps(feet: ChartFeet) -> Iterator[tuple[int, int, int, int]]:
    """Tick, column, `Limb` and `Part` of each written step of a chart."""
    limb, part = limbs_of(feet.chart, feet.rows, feet.play)
    row, column = feet.rows.steps.nonzero()
    ticks = feet.chart.rows.tick[feet.rows.row[row]].tolist()
    yield from zip(ticks, column.tolist(), limb[row, column].tolist(), part[row, column].tolist(), strict=True)
