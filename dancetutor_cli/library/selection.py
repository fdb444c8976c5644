"""Which charts of a file are meant."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from dancetutor_cli.chart import names
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.errors import UsageError


def select(
    song: Song, steps_types: Sequence[str] = (), difficulties: Sequence[str] = (), index: int | None = None
) -> list[Chart]:
    """The charts of a song that match, in file order; nothing given matches all.

    Names in any case, old ones too ("Heavy", "Oni"); several of a kind mean either. Raises `UsageError` for a
    difficulty that no game has.
    """
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
    name, known = names.difficulty(text, "", 0, old=True)
    if not known:
        raise UsageError(f"difficulty '{text}' is none; there are {', '.join(names.DIFFICULTIES)}")
    return name


def _listed(charts: Iterable[Chart]) -> str:
    return "; ".join(f"{chart.index}: {chart.label}" for chart in charts)
