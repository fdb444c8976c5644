"""Charts for two dancers: the pad under both, and the place of each dancer on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.players import ONE_PAD, OWN_PADS
from dancetutor_cli.dance.context import PANEL, panels_on_ground
from dancetutor_cli.dance.footwork.turning import leading_foot
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.play import Play, prepare
from dancetutor_cli.run.errors import UsageError

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.dance.request import DanceRequest
    from dancetutor_cli.feet.pads import Pad

SIDE_NOTES = 8  # notes at either end that decide where a player stands
# Steps type as written -> the pad under both dancers. In couple charts each has half of it; otherwise her own pad.
_WHOLE = {**ONE_PAD, **{kind: f"{kind.partition('-')[0]}-double" for kind in OWN_PADS}}


def check_alone(request: DanceRequest, chart: Chart) -> None:
    """Raise UsageError if a request cannot be met for all dancers of a chart. Each of them can dance alone.

    A picture has room for two dancers, and some options of a request are only for one dancer.
    """
    count = len(chart.players)
    if count > 2:
        choice = f"at most two dancers fit in one picture: choose with --player 1 to {count}"
        raise UsageError(f"{chart.label} is for {count} players, and {choice}")
    alone = {"--bar": request.bar, "--play": request.play, "--push": request.push, "--trip": request.trip}
    option = next((name for name, given in alone.items() if given), None)
    if option is not None:
        raise UsageError(f"{option} is for one dancer, and {chart.label} is for two: choose with --player 1 or 2")


def pad_of_both(steps_type: str) -> Pad:
    """Return the pad under both dancers of a chart for two. steps_type : as the chart is written"""
    pad = load_pad(_WHOLE.get(steps_type, steps_type))
    assert pad is not None
    return pad


def place_on(whole: Pad, part: Chart, pad: Pad) -> tuple[float, float]:
    """Return the place of a player's own pad from the middle of the pad of both: (x, z) in metres of the world.

    The x of panels goes to the player's right, the x of the world to her left.
    """
    away = whole.panels[part.first_column] - pad.panels[0] + np.array(pad.centre) - np.array(whole.centre)
    return float(-away[0] * PANEL), float(away[1] * PANEL)


def sides_of(parts: Sequence[Chart]) -> tuple[tuple[int, int], ...]:
    """Return the side from which each dancer comes and the side to which she goes, 0 left or 1 right: the outer sides.

    On one pad the dancers may change places. Then each goes to the other side, so that their ways do not cross.

    parts : the players' parts of a chart, in their order
    """
    whole = pad_of_both(parts[0].written_type)
    return tuple(
        zip(*(_on_the_right(parts, whole, ends) for ends in (slice(SIDE_NOTES), slice(-SIDE_NOTES, None))), strict=True)
    )


def persons_of(plays: Sequence[tuple[Play, Pad]]) -> tuple[int, ...]:
    """Return the person of each dancer, as `Context.person`: 0 for a single dancer, otherwise 0 and 1.

    In the mirror image of a chart, each dancer stays the same person. Side and leading foot decide the persons; both
    change in the mirror image. If they do not decide, the times of notes and their distance ahead decide; these do not
    change. Only if two plays are each other's mirror image, the left dancer comes first, so that the two are not twins.

    plays : of each dancer, from the left, with her own pad
    """
    if len(plays) < 2:
        return (0,)
    leads = [leading_foot(play, panels_on_ground(pad)) for play, pad in plays]
    if leads[0] == leads[1]:
        return leads[0], 1 - leads[0]
    return (1, 0) if _ahead(*plays) > 0 else (0, 1)


def _ahead(one: tuple[Play, Pad], other: tuple[Play, Pad]) -> int:
    """Return which of two plays comes first, -1 or 1, by properties that mirror images share; 0 for mirror images."""
    keys = []
    for play, pad in (one, other):
        row, column = np.nonzero(play.limb >= 0)
        order = np.lexsort((pad.panels[column, 1], row))
        keys.append((play.rows.tick[row][order].tolist(), pad.panels[column, 1][order].tolist()))
    return int(keys[0] > keys[1]) - int(keys[0] < keys[1])


def _on_the_right(parts: Sequence[Chart], whole: Pad, ends: slice) -> list[int]:
    """Return 1 for each player on the right, otherwise 0. Some of the notes decide, and the right half of the players
    gets 1.
    """
    columns = [part.first_column + part.notes.column[ends] for part in parts]
    places = [float(whole.panels[own, 0].mean()) if len(own) else 0.0 for own in columns]
    ranks = np.argsort(np.argsort(places, kind="stable"))
    return [int(2 * rank >= len(parts)) for rank in ranks]


def merge_plays(chart: Chart, plays: Sequence[Play], whole: Pad, roll_window: float) -> Play:
    """Return the steps of both dancers as one play of the chart as it is written: limbs and moves, without costs.

    roll_window : of the preset with which the plays were found
    """
    rows = prepare(chart, whole, roll_window)
    limb = np.full(rows.steps.shape, int(Limb.NONE), dtype=np.int8)
    part = np.zeros(rows.steps.shape, dtype=np.uint8)
    moves: list[set[str]] = [set() for _ in range(len(rows))]
    for player, play in zip(chart.players, plays, strict=True):
        here = np.minimum(np.searchsorted(rows.tick, play.rows.tick), len(rows) - 1)
        at, column = np.nonzero((play.rows.steps > 0) & (rows.tick[here] == play.rows.tick)[:, None])
        limb[here[at], column + player.first_column] = play.limb[at, column]
        part[here[at], column + player.first_column] = play.part[at, column]
        for row, names in zip(here.tolist(), play.moves, strict=True):
            moves[row] |= set(names)
    return Play(
        rows=rows,
        limb=limb,
        part=part,
        feet=np.full((len(rows), 2), -1, dtype=np.int16),
        facing=np.zeros(len(rows)),
        terms=(),
        cost=np.zeros((len(rows), 0), dtype=np.int32),
        margin=None,
        moves=tuple(tuple(sorted(names)) for names in moves),
        preset=plays[0].preset,
    )
