"""Charts for two who dance: the pad under both, and where on it each of them stands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.players import ONE_PAD, OWN_PADS
from dancetutor_cli.errors import UsageError
from dancetutor_cli.pads import load_pad

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.pads import Pad

SEEN = 8  # notes at either end that say where somebody stands
# Steps type as it is written -> the pad on which both stand: of a couple each has half of it. Else it is its own.
_WHOLE = {**ONE_PAD, **{kind: f"{kind.partition('-')[0]}-double" for kind in OWN_PADS}}


def check_for_two(chart: Chart) -> None:
    """UsageError of a chart for more than two: no picture has a third dancer, though each of them can dance alone."""
    count = len(chart.players)
    if count > 2:
        choice = f"at most two dance in one picture: choose with --player 1 to {count}"
        raise UsageError(f"{chart.label} is for {count} players, and {choice}")


def pad_of_both(steps_type: str) -> Pad:
    """The pad under both who dance a chart for two. steps_type : as the chart is written"""
    pad = load_pad(_WHOLE.get(steps_type, steps_type))
    assert pad is not None
    return pad


def place_on(whole: Pad, part: Chart, pad: Pad) -> tuple[float, float]:
    """How far a player's own pad stands from the middle of that of both: (x, z) in metres of the world.

    Panels' x goes to her right, the world's to her left.
    """
    from dancetutor_cli.video.scene.stage import PANEL

    away = whole.panels[part.first_column] - pad.panels[0] + np.array(pad.centre) - np.array(whole.centre)
    return float(-away[0] * PANEL), float(away[1] * PANEL)


def sides_of(parts: Sequence[Chart]) -> tuple[tuple[int, int], ...]:
    """From which side each of those who dance together comes and to which each goes, 0 left or 1 right: the outer ones.

    On one pad they may change places: then each goes to the other side, and nobody through another.
    parts : the players' parts of a chart, in their order
    """
    whole = pad_of_both(parts[0].written_type)
    return tuple(zip(*(_on_the_right(parts, whole, ends) for ends in (slice(SEEN), slice(-SEEN, None))), strict=True))


def _on_the_right(parts: Sequence[Chart], whole: Pad, ends: slice) -> list[int]:
    """Who stands on the right, 1, by some of their notes: the latter half of them, from the left one on."""
    columns = [part.first_column + part.notes.column[ends] for part in parts]
    places = [float(whole.panels[own, 0].mean()) if len(own) else 0.0 for own in columns]
    ranks = np.argsort(np.argsort(places, kind="stable"))
    return [int(2 * rank >= len(parts)) for rank in ranks]
