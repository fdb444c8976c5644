"""What the other foot would cost."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.chart.reader import load
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.play import StepKind, prepare_rows
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_rows
from dancetutor_cli.page.facts import flips_of
from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"


def test_a_flip_costs_what_the_solver_s_margin_says() -> None:
    """A row of one step has one other way: its margin, which the solver finds by another way, is the flip's cost."""
    chart, preset = load(DEMO).charts[3], load_preset("itg")
    pad = load_pad(chart.steps_type)
    assert pad is not None
    play = solve_rows(prepare_rows(chart, pad, preset.roll_window), pad, preset)
    assert play.margin is not None
    flips = flips_of(play, pad, preset, Overrides.none())
    seen = np.isin(play.limb, (0, 1)) & (play.rows.steps != StepKind.ROLL_TAP)
    assert len(flips) == int(seen.any(axis=1).sum())
    compared = 0
    for flip in flips:
        row = flip["row"]
        stepped = (play.limb[row] >= 0).sum()
        if flip["extra"] >= 0:
            assert flip["extra"] >= play.margin[row] >= 0
            assert any(r == row for r, _, _ in flip["changes"])
            compared += stepped == 1 and flip["extra"] == play.margin[row]
    assert compared > 80


def test_what_changes_with_it_is_the_cheapest_play_with_those_feet() -> None:
    chart, preset = load(DEMO).charts[3], load_preset("itg")
    pad = load_pad(chart.steps_type)
    assert pad is not None
    play = solve_rows(prepare_rows(chart, pad, preset.roll_window), pad, preset)
    flip = next(f for f in flips_of(play, pad, preset, Overrides.none()) if len(f["changes"]) > 1)
    cells = {(int(play.rows.tick[r]), c): (limb, 0) for r, c, limb in flip["changes"]}
    again = solve_rows(play.rows, pad, preset, Overrides.of(cells))
    assert again.total - play.total == pytest.approx(flip["extra"])
