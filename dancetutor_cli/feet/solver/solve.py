"""The solver as other packages call it: rows and a preset in, a `Play` out."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.pads import Pad, load_pad
from dancetutor_cli.feet.play import Play, Rows, StepKind, prepare_rows
from dancetutor_cli.feet.preset import Curve, Preset
from dancetutor_cli.feet.solver.engine import Engine, engine_for, whole_curve
from dancetutor_cli.feet.solver.tables import SolverPath
from dancetutor_cli.feet.solver.techniques import EventNames


def solve_rows(
    rows: Rows, pad: Pad, preset: Preset, overrides: Overrides | None = None, *, margins: bool = True
) -> Play:
    """Return the play of the rows with the lowest cost by the preset; of several such plays, always the same one.

    Parameters
    ----------
    rows : n rows of the pad's c columns, as `prepare_rows` makes them
    overrides : limbs that the play must keep, even against the rules; overrides of cells without a step, and overrides
    that nobody can follow (one foot on two panels that are no bracket), are ignored
    margins : whether to compute `Play.margin` and `Play.ambiguity`, which about doubles the time

    Raises ValueError if the rows and the pad do not have the same number of columns.
    """
    if rows.steps.shape[1] != len(pad):
        raise ValueError(f"rows have {rows.steps.shape[1]} columns, {pad.steps_type} has {len(pad)} panels")
    engine = engine_for(pad, preset)
    return play_of(rows, engine, engine.cheapest(rows, forced_limbs(rows, overrides), margins, details=True))


def solve_chart(
    chart: Chart, preset: Preset, overrides: Overrides | None = None, *, margins: bool = True
) -> Play | None:
    """Return the cheapest play of a chart, or None if its steps type has no pad."""
    pad = load_pad(chart.steps_type)
    if pad is None:
        return None
    return solve_rows(prepare_rows(chart, pad, preset.roll_window), pad, preset, overrides, margins=margins)


def forced_limbs(rows: Rows, overrides: Overrides | None) -> NDArray[np.int64] | None:
    """Return overrides for the kernel: limb codes 1 to 4, 3 bits for each column of a row; None without overrides."""
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


def play_of(rows: Rows, engine: Engine, found: SolverPath) -> Play:
    """Return the play of a way through the rows; the way must have its details."""
    return Play(
        rows=rows,
        limb=found.limb,
        part=found.part,
        feet=found.feet,
        facing=found.facing,
        terms=engine.terms,
        cost=found.cost[: len(rows)],
        margin=found.margin if len(found.margin) or not len(rows) else None,
        ambiguity=found.ambiguity if len(found.margin) or not len(rows) else None,
        moves=EventNames(found.events),
        preset=engine.preset.name,
        confidence=_confidence(rows, engine.preset, found.margin) if len(found.margin) else None,
        events=found.events,
    )


def _confidence(rows: Rows, preset: Preset, margin: NDArray[np.int64]) -> NDArray[np.float64] | None:
    """Return how likely the limbs of each row are right, (n,); None if it is not measured for the preset."""
    if not preset.confidence:
        return None
    curve = _shares(preset.confidence)
    sure: NDArray[np.float64] = curve[np.minimum(margin, len(curve) - 2)]
    if rows.mines.any():  # else every row has a step
        sure[~rows.steps.any(axis=1)] = np.nan
    return sure


@lru_cache(maxsize=16)
def _shares(confidence: Curve) -> NDArray[np.float64]:
    """Return a curve of confidence as shares of 1.

    Its last value, which index -1 finds, is 1: there is no other way.
    """
    return np.append(whole_curve(confidence) / 1000, 1.0)


def move_tap(rows: Rows, row: int, column: int, to: int) -> Rows:
    """Return the rows with the tap of a row and column moved to another column."""
    steps = rows.steps.copy()
    steps[row, to], steps[row, column] = steps[row, column], StepKind.NONE
    return replace(rows, steps=steps)
