"""Jumps: how far feet are pulled up in the air, how long they fly, how far inward they land."""

from __future__ import annotations

import numpy as np
import pytest
from bake_plays import context, play

from dancetutor_cli.dance.context import HALF_PANEL
from dancetutor_cli.dance.footwork.flights import tuck_for
from dancetutor_cli.dance.footwork.planner import plan_footwork
from dancetutor_cli.dance.plan import Jump
from dancetutor_cli.dance.rig.body import GRAVITY
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.limbs import Limb

L, R = Limb.LEFT_FOOT, Limb.RIGHT_FOOT
JUMP = default_settings().jump


@pytest.mark.parametrize("far", [0.0, 0.3, 0.9])
def test_in_short_flights_feet_go_up_with_the_body_and_no_more(far: float) -> None:
    assert tuck_for(far, JUMP.tuck_from, JUMP) == 0.0
    assert tuck_for(far, JUMP.tuck_full, JUMP) >= JUMP.tuck
    assert tuck_for(far, JUMP.tuck_from, JUMP) < tuck_for(far, 0.19, JUMP) < tuck_for(far, JUMP.tuck_full, JUMP)


@pytest.mark.parametrize("seconds", [0.03, 0.05, 0.08])
def test_in_the_shortest_flights_feet_get_off_the_ground(seconds: float) -> None:
    rise = GRAVITY * seconds**2 / 8
    assert rise + tuck_for(0.0, seconds, JUMP) == pytest.approx(JUMP.least)


def jumps_amid(gap: float, pairs: tuple[dict[int, Limb], dict[int, Limb]]) -> list[Jump]:
    """Both feet's moves at the seventh of eight jumps that take two pairs of panels by turns, so many seconds apart."""
    events = [(2.0 + gap * k, pairs[k % 2]) for k in range(8)]
    plan = plan_footwork(play(events), lambda tick: tick / 96, "flat", context())
    found = [next(m for m in track.moves if abs(m.land - events[6][0]) < 1e-6) for track in plan.feet]
    assert all(isinstance(move, Jump) for move in found)
    return [move for move in found if isinstance(move, Jump)]


def test_quick_jumps_land_at_the_inner_edges_and_slow_ones_on_the_panels() -> None:
    panels = context().panels
    pairs: tuple[dict[int, Limb], dict[int, Limb]] = ({0: L, 2: R}, {1: L, 3: R})
    off = {
        gap: float(np.linalg.norm(np.array(jumps_amid(gap, pairs)[0].target) - panels[0]))
        for gap in (0.30, JUMP.inward_quick, 0.44, 0.6)
    }
    assert off[0.30] > HALF_PANEL / 2 and off[JUMP.inward_quick] == pytest.approx(off[0.30], abs=0.01)
    assert off[JUMP.inward_quick] > off[0.44] > off[0.6]


def test_jumps_on_the_spot_fly_a_smaller_part_of_their_time() -> None:
    still = jumps_amid(0.30, ({0: L, 3: R}, {0: L, 3: R}))
    far = jumps_amid(0.30, ({1: L, 2: R}, {2: L, 1: R}))
    assert still[0].land - still[0].lift == pytest.approx(JUMP.flight_near * 0.30, abs=0.01)
    assert far[0].land - far[0].lift > still[0].land - still[0].lift + 0.01
