"""Charts for two dancers: the pad under both, and where on it each of them stands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.note_data import ONE_PAD, OWN_PADS
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

SIDE_NOTES = 8  # notes at either end that show where a player stands
# Steps type as written -> the pad on which both stand: in couple charts each has half of it. Otherwise its own pad.
_WHOLE = {**ONE_PAD, **{kind: f"{kind.partition('-')[0]}-double" for kind in OWN_PADS}}


def check_alone(request: DanceRequest, chart: Chart) -> None:
    """UsageError if a request cannot be met for all dancers of a chart: each of them can dance alone.

    No picture has a third dancer, and what a request sets for one dancer does not hold for two.
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
    """The pad under both dancers of a chart for two. steps_type : as the chart is written"""
    pad = load_pad(_WHOLE.get(steps_type, steps_type))
    assert pad is not None
    return pad


def place_on(whole: Pad, part: Chart, pad: Pad) -> tuple[float, float]:
    """The place of a player's own pad from the middle of the pad of both: (x, z) in metres of the world.

    Panels' x goes to her right, the world's to her left.
    """
    away = whole.panels[part.first_column] - pad.panels[0] + np.array(pad.centre) - np.array(whole.centre)
    return float(-away[0] * PANEL), float(away[1] * PANEL)


def sides_of(parts: Sequence[Chart]) -> tuple[tuple[int, int], ...]:
    """From which side each dancer comes and to which each goes, 0 left or 1 right: the outer ones.

    On one pad they may change places; then each goes to the other side, so that nobody walks through another.

    parts : the players' parts of a chart, in their order
    """
    whole = pad_of_both(parts[0].written_type)
    return tuple(
        zip(*(_on_the_right(parts, whole, ends) for ends in (slice(SIDE_NOTES), slice(-SIDE_NOTES, None))), strict=True)
    )


def persons_of(plays: Sequence[tuple[Play, Pad]]) -> tuple[int, ...]:
    """The person of each dancer, as `Context.person`: 0 alone, otherwise 0 and 1.

    In the mirror image of a chart each stays who she was. Side and leading foot decide who is who; both change in the
    mirror. If they do not decide, the times of notes and how far ahead they are do; these do not change. Only if two
    plays are each other's mirror image is the left one first, so that the two are not twins.

    plays : of each, from the left, with her own pad
    """
    if len(plays) < 2:
        return (0,)
    leads = [leading_foot(play, panels_on_ground(pad)) for play, pad in plays]
    if leads[0] == leads[1]:
        return leads[0], 1 - leads[0]
    return (1, 0) if _ahead(*plays) > 0 else (0, 1)


def _ahead(one: tuple[Play, Pad], other: tuple[Play, Pad]) -> int:
    """Which of two plays comes first, -1 or 1, by what is the same for mirror images; 0 for mirror images."""
    keys = []
    for play, pad in (one, other):
        row, column = np.nonzero(play.limb >= 0)
        order = np.lexsort((pad.panels[column, 1], row))
        keys.append((play.rows.tick[row][order].tolist(), pad.panels[column, 1][order].tolist()))
    return int(keys[0] > keys[1]) - int(keys[0] < keys[1])


def _on_the_right(parts: Sequence[Chart], whole: Pad, ends: slice) -> list[int]:
    """The player who stands on the right, 1, by some of their notes: the latter half of them, from the left one on."""
    columns = [part.first_column + part.notes.column[ends] for part in parts]
    places = [float(whole.panels[own, 0].mean()) if len(own) else 0.0 for own in columns]
    ranks = np.argsort(np.argsort(places, kind="stable"))
    return [int(2 * rank >= len(parts)) for rank in ranks]


def merge_plays(chart: Chart, plays: Sequence[Play], whole: Pad) -> Play:
    """The steps of both as one play of the chart as it is written: who steps what, and what happens; no costs."""
    rows = prepare(chart, whole)
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
