"""The solver as the other rooms call it: rows and a preset in, a `Play` out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.feet.model import Overrides
from dancetutor_cli.pads import Pad, load_pad
from dancetutor_cli.play.engine import Engine, Path, engine_for
from dancetutor_cli.play.model import Play, Rows
from dancetutor_cli.play.moves import name_moves
from dancetutor_cli.play.preset import Preset
from dancetutor_cli.play.rows import prepare


def solve(rows: Rows, pad: Pad, preset: Preset, overrides: Overrides | None = None) -> Play:
    """The cheapest way to play rows: the true minimum of the preset's costs; of several, always the same one.

    Parameters
    ----------
    rows : n rows of the pad's c columns, as `prepare` makes them
    overrides : limbs that must be kept, even against the rules; those of cells without a step, and those nobody can
        follow (one foot on two panels that are no bracket), are left out of account

    Raises ValueError if rows and pad do not fit.
    """
    if rows.steps.shape[1] != len(pad):
        raise ValueError(f"rows have {rows.steps.shape[1]} columns, {pad.steps_type} has {len(pad)} panels")
    engine = engine_for(pad, preset)
    return _play(rows, engine, engine.path(rows, forced_limbs(rows, overrides)))


def solve_chart(chart: Chart, preset: Preset, overrides: Overrides | None = None) -> Play | None:
    """The cheapest way to play a chart, or None if its steps type has no pad."""
    pad = load_pad(chart.steps_type)
    if pad is None:
        return None
    return solve(prepare(chart, pad, preset.roll_window), pad, preset, overrides)


def forced_limbs(rows: Rows, overrides: Overrides | None) -> NDArray[np.int64] | None:
    """Overrides as the kernel wants them: limb codes 1 to 4 for each row, 3 bits for each column; None without any."""
    if overrides is None or not len(overrides) or not len(rows):
        return None
    row = np.searchsorted(rows.tick, overrides.ticks).clip(max=len(rows) - 1)
    ours = (rows.tick[row] == overrides.ticks) & (overrides.columns < rows.steps.shape[1]) & (overrides.limbs >= 0)
    row, columns, limbs = row[ours], overrides.columns[ours], overrides.limbs[ours]
    stepped = rows.steps[row, columns] > 0
    forced = np.zeros(len(rows), dtype=np.int64)
    codes = (limbs.astype(np.int64) + 1) << (3 * columns.astype(np.int64))
    np.bitwise_or.at(forced, row[stepped], codes[stepped])
    return forced


def _play(rows: Rows, engine: Engine, path: Path) -> Play:
    t, c = engine.tables, len(engine.pad)
    state = t.state_key[t.move_next[path.moves]]
    left, right, side = state & 15, state >> 4 & 15, state >> 8 & 3
    facing = engine.geometry.angle[left, right]
    facing[(side == 2) & (facing > 179.0)] = -180.0  # reached by turning right
    feet = np.stack([left, right], axis=1).astype(np.int16)
    feet[feet == c] = -1
    cost = t.move_terms[path.moves].astype(np.int64)
    return Play(
        rows=rows,
        limb=path.limb,
        part=path.part,
        feet=feet,
        facing=facing,
        terms=engine.terms,
        cost=cost,
        margin=None,
        moves=name_moves(rows, path.limb, engine.pad, t.move_events[path.moves]),
        preset=engine.preset.name,
    )
