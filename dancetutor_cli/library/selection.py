"""Which charts of a file are meant, and how much there is to solve in them; imports no reader of charts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.errors import DancetutorError, UsageError

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song

_LARGE = 200_000  # bytes


@dataclass(frozen=True, slots=True)
class Selection:
    """Which charts are meant: values as the user typed them, several with commas; None stands for all.

    player : of charts for several, whose part is meant
    """

    steps_type: str | None = None
    difficulty: str | None = None
    index: int | None = None
    player: int | None = None

    @property
    def is_all(self) -> bool:
        """Whether every chart is meant."""
        return self == Selection()

    def charts(self, song: Song) -> tuple[Chart, ...]:
        """The charts of `song` that match, in file order; may be empty."""
        return tuple(select(song, _parts(self.steps_type), _parts(self.difficulty), self.index))

    def one(self, song: Song) -> Chart:
        """The one chart of `song` that matches; UsageError lists the charts there are if none or several do.

        Of a chart for several the part of the player that is meant, else of the first.
        """
        chart = select_one(song, _parts(self.steps_type), _parts(self.difficulty), self.index)
        found = self.parts(chart)
        if not found:
            raise UsageError(f"{song.path}: {chart.label} has no notes for player {self.player}")
        return found[0]

    def parts(self, chart: Chart) -> tuple[Chart, ...]:
        """What feet are found for in a chart: itself, or of one for several each player's part that is meant."""
        from dancetutor_cli.chart.players import parts

        return parts(chart, self.player)


def note_bytes(path: Path, selection: Selection, data: bytes | None = None) -> int:
    """How much there is to solve in a chart file: bytes of the note data that is meant; 0 where it cannot be read.

    data : what to read in place of the file. A large file that is meant in part is not read only for this.
    """
    from dancetutor_cli import chart

    try:
        size = path.stat().st_size if data is None else len(data)
        if selection.is_all or size > _LARGE:
            return size
        song = chart.load(path) if data is None else chart.parse(data, path)
        return sum(end - start for start, end in (one.notes_span for one in selection.charts(song)))
    except (OSError, DancetutorError):
        return 0


def _parts(text: str | None) -> list[str]:
    return [part.strip() for part in text.split(",")] if text else []


def select(
    song: Song, steps_types: Sequence[str] = (), difficulties: Sequence[str] = (), index: int | None = None
) -> list[Chart]:
    """The charts of a song that match, in file order; nothing given matches all.

    Names in any case, old ones too ("Heavy", "Oni"); several of a kind mean either. Raises `UsageError` for a
    difficulty that no game has.
    """
    from dancetutor_cli.chart import names

    types = {names.steps_type(text) for text in steps_types}
    levels = {_difficulty(text) for text in difficulties}
    return [
        chart
        for chart in song.charts
        if (not types or chart.steps_type in types)
        and (not levels or chart.difficulty in levels)
        and (index is None or chart.index == index)
    ]


def select_one(
    song: Song, steps_types: Sequence[str] = (), difficulties: Sequence[str] = (), index: int | None = None
) -> Chart:
    """The one chart that matches. Raises `UsageError` with what the file has when none or several do."""
    found = select(song, steps_types, difficulties, index)
    if len(found) == 1:
        return found[0]
    if not found:
        raise UsageError(f"{song.path}: no such chart; the file has {_listed(song.charts)}")
    how = "--index" if len({(c.steps_type, c.difficulty) for c in found}) < len(found) else "--steps-type, --difficulty"
    raise UsageError(f"{song.path}: several charts match; choose one with {how}: {_listed(found)}")


def _difficulty(text: str) -> str:
    from dancetutor_cli.chart import names

    name, known = names.difficulty(text, "", 0, old=True)
    if not known:
        raise UsageError(f"difficulty '{text}' is none; there are {', '.join(names.DIFFICULTIES)}")
    return name


def _listed(charts: Iterable[Chart]) -> str:
    return "; ".join(f"{chart.index}: {chart.label}" for chart in charts)
