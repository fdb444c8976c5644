"""Grips are checked against the settled body: what its arms do not reach is cut off, or the hand comes later."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest
from bake_plays import L, R, chart, pad, play, stream

from dancetutor_cli.dance import grips, rail_reach
from dancetutor_cli.dance.bake import bake_plan
from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.grips import KEPT_EASE, join_grips, reached_parts
from dancetutor_cli.dance.motion import Grip, sample
from dancetutor_cli.dance.plan import Plan
from dancetutor_cli.dance.rail_reach import RATE, Arm, BarTrunk, RoughTrunks, SettledTrunks
from dancetutor_cli.dance.rig.body import world_transforms

WIDE = [(1.0 + 0.5 * k, {(0, 2, 3, 2)[k % 4]: (L, R, R, L)[k % 4]}) for k in range(12)]
TURN = [(7.2 + 0.7 * k, {(2, 1)[k % 2]: (L, R)[k % 2]}) for k in range(5)]
EVENTS = [*WIDE, *TURN, *((11.0 + t, e) for t, e in stream(0.0, 12, 0.2))]
STILL = np.arange(0.0, 8.0, 1.0 / RATE)
GRIP = Grip(2.0, 6.0, 0, 0.24)


@pytest.fixture(scope="module")
def planned() -> tuple[Plan, Context]:
    return plan_dance(chart().timing, play(EVENTS), pad(), bar=True)


def still(planned: tuple[Plan, Context]) -> BarTrunk:
    """A body that stands before the rail and does not move."""
    grid = np.arange(-2.0, 0.0, 1.0 / RATE)
    trunk = RoughTrunks(planned[0], grid, planned[1]).trunk_for((Grip(-5.0, 1.0, 0, 0.24),))
    return BarTrunk(*(np.repeat(getattr(trunk, f.name)[-1:], len(STILL), axis=0) for f in fields(BarTrunk)))


def part_of(planned: tuple[Plan, Context], trunk: BarTrunk, ease: float = KEPT_EASE[0]) -> Grip | None:
    parts = reached_parts(GRIP, (STILL, trunk, np.zeros(len(STILL), dtype=bool), planned[1]), ease)
    assert len(parts) <= 1
    return parts[0] if parts else None


def test_the_settled_body_is_where_the_final_one_is(planned: tuple[Plan, Context]) -> None:
    plan, context = planned
    times = np.arange(0.0, 13.0, 1.0 / RATE)
    settled = SettledTrunks(plan, times, context).trunk_for(plan.grips)
    rough = RoughTrunks(plan, times, context).trunk_for(plan.grips)
    motion = bake_plan(plan, context, 60.0, (0.0, 13.0))
    inner = (times > motion.times[0]) & (times < motion.times[-1])
    places, _ = world_transforms(motion.skeleton, *sample(motion, times[inner]))
    off = []
    for trunk in (settled, rough):
        away = [
            np.linalg.norm(trunk.shoulders[inner, side] - places[:, motion.skeleton.index(f"{name}_shoulder")], axis=1)
            for side, name in enumerate("lr")
        ]
        off.append(float(np.percentile(np.concatenate(away), 99)))
    assert off[0] < 0.015 and off[0] < 0.6 * off[1], off


def test_every_grip_is_reached_from_the_settled_body(planned: tuple[Plan, Context]) -> None:
    plan, context = planned
    times = np.arange(-1.0, 14.5, 1.0 / RATE)
    trunk = SettledTrunks(plan, times, context).trunk_for(plan.grips)
    grips = [grip for grip in plan.grips if grip.start > 0.0 and grip.end < 13.5]
    assert len(grips) >= 3
    for grip in grips:
        arm = Arm(grip.side, trunk, np.zeros(len(times), dtype=bool), context, None if grip.across else times)
        a, b = np.searchsorted(times, (grip.start, grip.end + 0.5 / RATE)).tolist()
        assert arm.fits(np.full(b - a, grip.x), slice(a, b), KEPT_EASE[-1]).all()


def test_a_grip_that_is_reached_stays(planned: tuple[Plan, Context]) -> None:
    trunk = still(planned)
    assert part_of(planned, trunk) == GRIP


def test_where_the_shoulder_is_too_far_away_the_hand_has_left(planned: tuple[Plan, Context]) -> None:
    trunk = still(planned)
    gone = STILL > 4.5
    trunk.shoulders[gone, 0, 2] += 0.3
    found = part_of(planned, trunk)
    assert found is not None and found.start == GRIP.start and 3.5 < found.end < 4.5


@pytest.mark.parametrize(("wrong", "start", "end"), [(1.8, 0.2, 0.0), (6.3, 0.0, -0.2)])
def test_a_hand_comes_later_or_leaves_sooner_if_its_way_is_wrong(
    planned: tuple[Plan, Context], wrong: float, start: float, end: float
) -> None:
    trunk = still(planned)
    trunk.faulty[np.argmin(np.abs(STILL - wrong)), 0] = True
    found = part_of(planned, trunk)
    assert found is not None
    assert found.start - GRIP.start == pytest.approx(start, abs=0.2) and (found.start > GRIP.start) == (start > 0.0)
    assert found.end - GRIP.end == pytest.approx(end, abs=0.2) and (found.end < GRIP.end) == (end < 0.0)
    trunk.faulty[:] = False
    trunk.faulty[:, 1] = True
    assert part_of(planned, trunk) == GRIP, "the other arm's fault"


def test_an_arm_on_its_way_keeps_air_to_the_trunk(
    planned: tuple[Plan, Context], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The check's body is up to 2 cm off the final one: a forearm 1 cm beside the trunk there was 1 cm in it here."""
    rest, count = planned[1].skeleton, 5
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (count, len(rest.names), 1))
    places = np.tile(rest.rest, (count, 1, 1))
    held = np.array([True, True, False, False, False])
    monkeypatch.setattr(rail_reach, "arm_in_torso", lambda *_: np.array([-0.01, 0.006, -0.01, -0.02, 0.006]))
    for side in (0, 1):
        found = rail_reach._faulty(rest, turns, places, side, held)
        np.testing.assert_array_equal(found, [False, True, True, False, True])


def test_parts_without_changes_are_not_baked_again(
    planned: tuple[Plan, Context], monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, context = planned
    trunks = SettledTrunks(plan, np.arange(0.0, 13.0, 1.0 / RATE), context)
    first = trunks.trunk_for(plan.grips)
    monkeypatch.setattr("dancetutor_cli.dance.rail_reach.settle", None)
    assert np.array_equal(trunks.trunk_for(plan.grips).shoulders, first.shoulders)


@pytest.mark.parametrize("start", [-1.0, -0.7530159, -0.35508187121005497, 0.01469842000779975])
def test_each_time_is_in_one_part(start: float, planned: tuple[Plan, Context], monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the rounding of their bounds."""
    parts: list[np.ndarray] = []  # type: ignore[type-arg]
    times, empty = np.arange(start, start + 300.0, 1.0 / RATE), BarTrunk(*(np.zeros((0, 2)) for _ in fields(BarTrunk)))
    monkeypatch.setattr(RoughTrunks, "_bake", lambda self, plan, at: (parts.append(at), empty)[1])
    RoughTrunks(planned[0], times, planned[1]).trunk_for(())
    assert len(parts) in (10, 11) and np.array_equal(np.concatenate(parts), times)


def test_a_changed_part_settles_from_where_it_was(planned: tuple[Plan, Context]) -> None:
    """One round from there leads to where all rounds from an upright body lead."""
    plan, context = planned
    times = np.arange(0.0, 13.0, 1.0 / RATE)
    fewer = tuple(grip for grip in plan.grips if grip != max(plan.grips, key=lambda grip: grip.end - grip.start))
    trunks = SettledTrunks(plan, times, context)
    before, after = trunks.trunk_for(plan.grips).shoulders, trunks.trunk_for(fewer).shoulders
    fresh = SettledTrunks(plan, times, context).trunk_for(fewer).shoulders
    moved, off = (np.linalg.norm(path - fresh, axis=-1).max() for path in (before, after))
    assert moved > 0.02 and off < 0.25 * moved, (moved, off)


def test_a_hand_holds_the_rail_elsewhere_where_it_stays_longer(planned: tuple[Plan, Context]) -> None:
    trunk, outward = still(planned), replace(GRIP, x=0.30)
    away = np.where(STILL > 3.5, -0.21, 0.0)
    trunk.shoulders[..., 0] += away[:, None]  # she moves away from that place, and not from one 5 cm nearer
    trunk.pelvis[:, 0] += away
    found = reached_parts(outward, (STILL, trunk, np.zeros(len(STILL), dtype=bool), planned[1]), KEPT_EASE[0])
    assert found == [replace(outward, x=pytest.approx(0.25))]


def test_two_grips_of_a_hand_become_one_where_it_need_not_let_go(planned: tuple[Plan, Context]) -> None:
    trunk, free = still(planned), np.zeros(len(STILL), dtype=bool)
    both = [replace(GRIP, end=3.6), replace(GRIP, start=4.3, x=0.22)]
    assert join_grips(both, (STILL, trunk, free, planned[1])) == [GRIP]
    trunk.shoulders[(STILL > 3.7) & (STILL < 4.1), 0, 2] += 0.3
    assert join_grips(both, (STILL, trunk, free, planned[1])) == both, "there it does not reach"


def test_a_long_grip_that_is_not_reached_for_a_moment_is_two(planned: tuple[Plan, Context]) -> None:
    """With time between them to let go and come back."""
    trunk = still(planned)
    trunk.shoulders[(STILL > 3.8) & (STILL < 4.0), 0, 2] += 0.3
    found = reached_parts(GRIP, (STILL, trunk, np.zeros(len(STILL), dtype=bool), planned[1]), KEPT_EASE[0])
    assert len(found) == 2 and found[0].start == GRIP.start and found[1].end == pytest.approx(GRIP.end, abs=0.05)
    assert found[1].start - found[0].end > 2.0 * planned[1].settings.bar.reach_time - 0.05


class Fleeing:
    """A body that is out of reach half a second before the last hand leaves, however soon that is."""

    def __init__(self, plan: Plan, times: np.ndarray, context: Context) -> None:  # type: ignore[type-arg]
        self.trunk = RoughTrunks(plan, times, context).trunk_for((Grip(-5.0, 20.0, 0, 0.24),))
        self.times = times

    def trunk_for(self, grips: tuple[Grip, ...]) -> BarTrunk:
        shoulders = self.trunk.shoulders.copy()
        shoulders[self.times > max((grip.end for grip in grips), default=np.inf) - 0.5, :, 2] += 0.3
        return replace(self.trunk, shoulders=shoulders)


def test_a_grip_that_no_round_mends_is_left_out(planned: tuple[Plan, Context], monkeypatch: pytest.MonkeyPatch) -> None:
    """Each cut of the last grip moves the body away from what is left of it."""
    monkeypatch.setattr(grips, "SettledTrunks", Fleeing)
    plan, context = planned
    assert not grips.grips_of(replace(plan, grips=()), (-1.0, 13.5), context).grips


class Leaning(Fleeing):
    """A body that is out of reach from 2 seconds before the last hand leaves on, but until 5 seconds always there."""

    def trunk_for(self, grips: tuple[Grip, ...]) -> BarTrunk:
        shoulders = self.trunk.shoulders.copy()
        last = max((grip.end for grip in grips), default=0.0)
        shoulders[self.times > max(last - 2.0, 5.0), :, 2] += 0.3
        return replace(self.trunk, shoulders=shoulders)


def test_grips_are_checked_again_after_others_are_left_out(
    planned: tuple[Plan, Context], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(grips, "SettledTrunks", Leaning)
    monkeypatch.setattr(grips, "KEPT_EASE", (0.3,))
    plan, context = planned
    found = grips.grips_of(replace(plan, grips=()), (-1.0, 13.5), context).grips
    assert found and all(grip.end <= 5.0 + 1.0 / RATE for grip in found), found
