"""The public face of the solver: rows and a preset in, the cheapest `Play` out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.pads import Pad, load_pad
from dancetutor_cli.play import kernel
from dancetutor_cli.play.geometry import tables
from dancetutor_cli.play.model import Limb, Play, Rows, StepKind
from dancetutor_cli.play.moves import name_moves
from dancetutor_cli.play.preset import TERMS, Preset
from dancetutor_cli.play.rows import prepare


def solve_chart(chart: Chart, preset: Preset) -> Play | None:
    """The cheapest play of a chart, or None if its steps type has no pad."""
    pad = load_pad(chart.steps_type)
    return None if pad is None else solve(prepare(chart, preset.roll_window), pad, preset)


def solve(rows: Rows, pad: Pad, preset: Preset) -> Play:
    """The cheapest way to play rows on a pad: the true minimum, and always the same one of equals (thesis 3.2)."""
    columns = len(pad.panels)
    if rows.steps.shape[1] != columns:
        raise ValueError(f"rows have {rows.steps.shape[1]} columns, the pad {columns}")
    t = tables(pad)
    weights = np.array([preset.costs[term] for term in TERMS], dtype=np.int64)
    steps, holds, active, mines = masks(rows)
    states, actions, events = kernel._solve(
        steps, holds, active, mines, weights, preset.allow_doublestep, t.crossed, t.turn, t.side, t.hand
    )
    limb = np.where(rows.steps > 0, np.int8(Limb.UNPLAYED), np.int8(Limb.NONE))
    for index in range(4):
        panel = (actions >> (5 * index)) & 31
        at = np.flatnonzero(panel)
        limb[at, panel[at] - 1] = index
    feet = np.stack([states & 31, (states >> 5) & 31], axis=1) - 1
    facing = _facing(t.angle, feet, states, columns + 1)
    play = Play(
        rows,
        limb,
        np.zeros_like(rows.steps),
        feet.astype(np.int16),
        facing,
        TERMS,
        events[:, : len(TERMS)] * weights,
        None,
        (),
        preset.name,
    )
    return replace(play, moves=name_moves(play, pad, events))


def _facing(
    angle: NDArray[np.float64], feet: NDArray[np.int64], states: NDArray[np.int64], n: int
) -> NDArray[np.float64]:
    facing = angle[(feet[:, 0] + 1) * n + feet[:, 1] + 1]
    from_right = ((states >> 12) & 3) == 2
    return np.where(from_right & (np.abs(facing - 180) < 1e-6), -180.0, facing)


def masks(
    rows: Rows,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Rows as bit masks for the kernel, each (n,): steps, holds that start, holds held from before, mines."""
    columns = rows.steps.shape[1]
    bit = np.int64(1) << np.arange(columns, dtype=np.int64)
    holds = (rows.steps == StepKind.HOLD) & (rows.hold_end > rows.tick[:, None])
    ends = np.where(holds, rows.hold_end, -1)
    latest = np.full_like(ends, -1)
    latest[1:] = np.maximum.accumulate(ends, axis=0)[:-1]
    active = latest > rows.tick[:, None]
    return tuple((m.astype(np.int64) @ bit) for m in (rows.steps > 0, holds, active, rows.mines))  # type: ignore[return-value]
