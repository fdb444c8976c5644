"""How the .ssc of a song differs from the .sm beside it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import numpy as np

from dancetutor_cli.chart import Chart, Song, load
from dancetutor_cli.chart.names import is_lights
from dancetutor_cli.errors import FileError

Key = tuple[str, str, int]


def differences(song: Song) -> Iterator[tuple[str, int | None, int | None]]:
    """Message, line and chart of everything that the .sm beside a .ssc has otherwise; nothing for a .sm."""
    from dancetutor_cli.library import twin

    other_path = twin(song.path) if song.format == "ssc" else None
    if other_path is None:
        return
    name = other_path.name
    try:
        other = load(other_path)
    except FileError as error:
        yield f"{name} cannot be read: {error.message}", None, None
        return
    here, there = _by_key(song), _by_key(other)
    for key, chart in here.items():
        if key in there and (what := _difference(chart, there[key])):
            yield f"{chart.label} has other {what} in {name}", chart.line, chart.index
    if added := [chart for key, chart in here.items() if key not in there]:
        yield f"{_labels(added)} not in {name}", added[0].line, added[0].index
    if lost := [chart for key, chart in there.items() if key not in here]:
        yield f"{_labels(lost)} only in {name}, missing here", None, None


def _labels(charts: list[Chart]) -> str:
    """ "dance-single Hard 9 and dance-single Easy 3 are"."""
    names = [chart.label for chart in charts]
    return f"{', '.join(names[:-1])} and {names[-1]} are" if len(names) > 1 else f"{names[0]} is"


def _by_key(song: Song) -> dict[Key, Chart]:
    """Charts, but of lights, by type and difficulty, and by their place among those that share both."""
    found: dict[Key, Chart] = {}
    places: Counter[tuple[str, str]] = Counter()
    for chart in song.charts:
        if is_lights(chart.steps_type):
            continue
        kind = (chart.steps_type, chart.difficulty)
        found[*kind, places[kind]] = chart
        places[kind] += 1
    return found


def _difference(a: Chart, b: Chart) -> str:
    """What is not the same in two charts: "notes", "a meter" or "times"; "" if nothing."""
    fields = ("tick", "column", "kind", "end")
    if any(not np.array_equal(getattr(a.notes, name), getattr(b.notes, name)) for name in fields):
        return "notes"
    if a.meter != b.meter:
        return "a meter"
    if np.abs(a.timing.seconds(a.notes.tick) - b.timing.seconds(b.notes.tick)).max(initial=0.0) > 0.001:
        return "times"
    return ""
