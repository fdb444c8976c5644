"""Which charts of a file are meant."""

from __future__ import annotations

from collections.abc import Sequence

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.errors import UsageError


def select(
    song: Song, steps_types: Sequence[str] = (), difficulties: Sequence[str] = (), index: int | None = None
) -> list[Chart]:
    """The charts of a song that match; nothing given matches all. Names in any case; several of a kind mean either."""
    types, levels = {t.lower() for t in steps_types}, {d.lower() for d in difficulties}
    return [
        chart
        for chart in song.charts
        if (not types or chart.steps_type in types)
        and (not levels or chart.difficulty.lower() in levels)
        and (index is None or chart.index == index)
    ]


def select_one(
    song: Song, steps_types: Sequence[str] = (), difficulties: Sequence[str] = (), index: int | None = None
) -> Chart:
    """The one chart that matches. Raises `UsageError` with what the file has when none or several do."""
    found = select(song, steps_types, difficulties, index)
    if len(found) == 1:
        return found[0]
    has = "; ".join(f"{chart.index}: {chart.label}" for chart in (found or song.charts))
    if not found:
        raise UsageError(f"{song.path}: no such chart; the file has {has}")
    raise UsageError(f"{song.path}: several charts match; choose with --steps-type, --difficulty or --index: {has}")
