"""Charts with their feet, for every command: the solver keeps the feet that people have set."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.feet.overrides import FeetProblem, Ignores, Overrides
from dancetutor_cli.feet.pads import Pad, load_pad
from dancetutor_cli.feet.play import Play, Rows, prepare_all_rows
from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.feet.solver import solve
from dancetutor_cli.feet.song_feet import SongFeet

_AT_ONCE = 16  # number of charts whose rows are prepared together


@dataclass(frozen=True, slots=True)
class Solved:
    """A chart with its feet; a chart for several players is one `Solved` for each player.

    play, pad : None if the steps type has no pad; preset : the costs with which the feet were found
    overrides : the feet that people have set; ignores : the findings that they silenced; problems : the contradictions
    in the feet that they have set
    """

    song: Song
    chart: Chart
    preset: Preset
    play: Play | None
    pad: Pad | None
    overrides: Overrides | None = None
    ignores: Ignores = field(default_factory=Ignores)
    problems: tuple[FeetProblem, ...] = ()


def solve_song(song: Song, charts: Sequence[tuple[Chart, Preset]]) -> Iterator[Solved]:
    """Yield the charts of a song with the cheapest plays that keep the feet that people have set.

    charts : each with the costs of its solver

    Contradictory feet are not kept: they are in `problems`, and the linter reports them.
    """
    feet = SongFeet(song)
    for first in range(0, len(charts), _AT_ONCE):
        some = charts[first : first + _AT_ONCE]
        for (chart, preset), rows in zip(some, _rows(some), strict=True):
            overrides, ignores, problems = feet.author_feet(chart)
            pad = load_pad(chart.steps_type)
            play = None if pad is None or rows is None else solve.solve_rows(rows, pad, preset, overrides)
            yield Solved(song, chart, preset, play, pad, overrides, ignores, problems)


def _rows(charts: Sequence[tuple[Chart, Preset]]) -> list[Rows | None]:
    """Return the rows of each chart, None without a pad; charts with the same pad, timing and roll window are
    prepared together.
    """
    alike: dict[tuple[str, int, float], list[int]] = defaultdict(list)
    for place, (chart, preset) in enumerate(charts):
        alike[chart.steps_type, id(chart.timing), preset.roll_window].append(place)
    found: list[Rows | None] = [None] * len(charts)
    for (steps_type, _, window), places in alike.items():
        pad = load_pad(steps_type)
        if pad is not None:
            rows = prepare_all_rows([charts[place][0] for place in places], pad, window)
            for place, one in zip(places, rows, strict=True):
                found[place] = one
    return found
