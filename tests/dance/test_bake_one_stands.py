"""One foot stands as long as it can: around mines, in fast streams, after walks. Swings never overlap."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from bake_plays import Event, L, R, chart, pad, plan_of, play, stream

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.foot_path import foot_path
from dancetutor_cli.dance.plan import LEAST_FLIGHT, Hover, Pivot, Plan, airborne
from dancetutor_cli.dance.quality.contact import mines_of
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.limbs import Part
from dancetutor_cli.feet.play import Play

CLEAR = ("feet on mines", "penetration", "flight gravity off by", "flight residual", "foot in foot", "contacts missed")
ROWS: list[Event] = [(1.0, {0: L}), (1.5, {3: R})]


def danced(events: list[Event], mines: dict[int, list[int]], double: bool = False, **more) -> Play:  # type: ignore[no-untyped-def]
    return play(events, double, mines=mines, **more)


def planned(steps: Play, double: bool = False) -> Plan:
    plan = plan_of(chart().timing, steps, pad(double))
    for track in plan.feet:
        for before, after in pairwise(track.moves):
            assert before.lift < before.land <= after.lift + 1e-9
    return plan


def flights(plan: Plan) -> np.ndarray:
    air = airborne(plan.feet)
    return air[air[:, 1] - air[:, 0] > LEAST_FLIGHT]


def meets(steps: Play, double: bool = False) -> None:
    measured = report(bake(chart().timing, steps, pad(double)), mines_of(steps, pad(double)))
    assert [f for f in measured.figures if f.name in CLEAR and f.is_met is False] == []
    assert np.abs(measured.contact_errors).max() < 1.0


@pytest.mark.parametrize("after", [0.16, 0.2, 0.3, 0.45])
def test_a_step_waits_until_the_other_foot_is_down_from_its_mine(after: float) -> None:
    """A mine under the right foot, and soon after it a step of the left one."""
    steps = danced([*ROWS, (2.5, {}), (2.5 + after, {2: L}), (3.5, {3: R})], {2: [3]})
    plan = planned(steps)
    assert len(flights(plan)) == 0
    over = foot_path(plan.feet[1], np.linspace(2.431, 2.569, 30), default_settings())
    assert over.ball[:, 1].min() >= 0.03
    meets(steps)


def test_a_mine_at_the_moment_of_the_other_foots_step_is_a_short_flight() -> None:
    steps = danced([*ROWS, (2.5, {2: L}), (2.9, {3: R}), (3.5, {0: L})], {2: [3]})
    air = flights(planned(steps))
    assert len(air) == 1 and air[0, 1] == 2.5 and air[0, 1] - air[0, 0] < 0.1
    meets(steps)


def test_a_foot_comes_down_from_a_mine_if_the_other_one_steps_before_it() -> None:
    """Not in the air from the mine until its own next step, with the other foot's step in between."""
    steps = danced([*ROWS, (2.5, {}), (2.7, {2: L}), (2.95, {1: R}), (3.5, {0: L})], {2: [3]})
    assert len(flights(planned(steps))) == 0
    meets(steps)


@pytest.mark.parametrize("gap", [0.06, 0.11, 0.19, 0.3])
def test_mines_under_both_feet_again_and_again_are_one_hop_to_the_middle(gap: float) -> None:
    rows = [*ROWS, *((2.5 + gap * k, {}) for k in range(6)), (5.0, {0: L}), (5.5, {3: R})]
    steps = danced(rows, {2 + k: [0, 3] for k in range(6)})
    assert len(flights(planned(steps))) == 1
    meets(steps)


@pytest.mark.parametrize("gap", [0.06, 0.11, 0.19, 0.3])
def test_mines_under_one_foot_again_and_again_send_it_to_the_middle(gap: float) -> None:
    rows = [*ROWS, *((2.5 + gap * k, {}) for k in range(6)), (5.0, {0: L}), (5.5, {3: R})]
    steps = danced(rows, {2 + k: [0] for k in range(6)})
    plan = planned(steps)
    assert len(flights(plan)) == 0
    assert len([s for s in plan.feet[0].moves if isinstance(s, Hover)]) <= 2
    meets(steps)


@pytest.mark.parametrize("apart", [0.05, 0.1, 0.15])
def test_mines_under_one_foot_and_then_the_other(apart: float) -> None:
    steps = danced([*ROWS, (2.5, {}), (2.5 + apart, {}), (4.0, {0: L}), (4.5, {3: R})], {2: [0], 3: [3]})
    air = flights(planned(steps))
    assert len(air) <= 1 and (air[:, 1] - air[:, 0] < 0.15).all()
    meets(steps)


@pytest.mark.parametrize("after", [0.08, 0.13, 0.18, 0.24, 0.3])
def test_a_jump_soon_after_a_mine(after: float) -> None:
    steps = danced([*ROWS, (2.5, {}), (2.5 + after, {1: L, 2: R}), (3.5, {0: L})], {2: [0]})
    planned(steps)
    meets(steps)


@pytest.mark.parametrize("after", [0.08, 0.13, 0.19])
def test_a_jump_right_after_mines_under_both_feet_is_one_flight_over_them(after: float) -> None:
    """A hop to the middle of the pad, and from there to the notes in the time that is left, nobody does."""
    steps = danced([*ROWS, (2.5, {}), (2.5 + after, {1: L, 2: R}), (3.5, {0: L})], {2: [0, 3]})
    air = flights(planned(steps))
    assert len(air) == 1
    assert air[0, 0] <= 2.5 - default_settings().mines.before + 1e-6
    assert air[0, 1] == pytest.approx(2.5 + after)
    meets(steps)


def test_with_time_to_push_off_a_jump_after_such_mines_is_a_second_flight() -> None:
    steps = danced([*ROWS, (2.5, {}), (2.9, {1: L, 2: R}), (3.5, {0: L})], {2: [0, 3]})
    assert len(flights(planned(steps))) == 2
    meets(steps)


def test_a_step_right_after_mines_under_both_feet_comes_from_the_hop() -> None:
    steps = danced([*ROWS, (2.5, {}), (2.75, {1: L}), (3.5, {3: R})], {2: [0, 3]})
    assert len(flights(planned(steps))) == 1
    meets(steps)


@pytest.mark.parametrize("after", [0.08, 0.11, 0.13])
def test_a_step_before_a_hop_is_over_is_a_part_of_it(after: float) -> None:
    """One foot goes from the hop to its note, the other one lands where the hop goes."""
    steps = danced([*ROWS, (2.5, {}), (2.5 + after, {1: R}), (3.5, {0: L})], {2: [0, 3]})
    assert len(flights(planned(steps))) == 1
    meets(steps)


def test_a_hop_right_after_a_jump_is_over_its_mines() -> None:
    """It has no time to go up before they pass: feet are pulled up."""
    meets(danced([*ROWS, (2.0, {0: L, 3: R}), (2.083, {}), (3.5, {0: L})], {3: [0, 3]}))


def test_a_foot_that_holds_does_not_leave_for_a_mine() -> None:
    events = [*ROWS, (2.0, {0: L}), (2.5, {}), (3.5, {3: R})]
    plan = planned(danced(events, {3: [0]}, holds={(2, 0): 3.0}))
    lifts = [s for s in plan.feet[0].moves if s.lift > 2.0 and s.land < 3.0 and not isinstance(s, Pivot)]
    assert lifts == []


def test_mines_before_the_first_step_find_her_standing_on_no_panel() -> None:
    steps = danced([(2.0, {}), (2.1, {}), (5.0, {0: L}), (5.5, {3: R})], {0: [0, 3], 1: [1, 2]})
    assert not planned(steps).walks[:1] or planned(steps).walks[0].start > 5.0
    meets(steps)


@pytest.mark.parametrize("gap", [0.06, 0.068, 0.08, 0.1, 0.125])
def test_in_the_fastest_streams_one_foot_is_on_the_ground(gap: float) -> None:
    air = flights(planned(play(stream(1.0, 24, gap))))
    assert (air[:, 0] < 1.0).all()  # but its first two notes, after a wait, are a gallop


def test_notes_of_one_foot_a_few_milliseconds_apart_are_two_swings() -> None:
    steps = play([*ROWS, (2.0, {2: L}), (2.0 + 1 / 96, {0: L}), (2.5, {3: R})])
    planned(steps)
    assert np.abs(report(bake(chart().timing, steps, pad())).contact_errors).max() < 1.0


def test_a_foot_that_has_just_landed_taps_where_it_is() -> None:
    """Two notes 21 ms apart on one panel: no shoe is shifted on it in that time, and the second tap is seen."""
    steps = play([*ROWS, (2.0, {2: L}), (2.0 + 2 / 96, {2: L}), (2.3, {1: R}), (3.0, {0: L})])
    first, again = [move for move in planned(steps).feet[0].moves if 1.9 < move.land < 2.1]
    assert (again.target, again.yaw) == (first.target, first.yaw)
    meets(steps)
    measured = report(bake(chart().timing, steps, pad()))
    assert measured["plant slide"].is_met


def test_jumps_after_long_holds_leave_the_ground_a_time_to_push() -> None:
    """Holds that end after the next jump's take-off are let go early, but not at the moment of landing."""
    rows: list[Event] = [(1.0, {0: L, 3: R}), (1.13, {1: L, 2: R}), (1.26, {0: L, 3: R}), (2.5, {0: L})]
    steps = play(rows, holds={(0, 0): 1.1, (0, 3): 1.1, (1, 1): 1.24, (1, 2): 1.24})
    air = airborne(planned(steps).feet)
    assert (air[1:, 0] - air[:-1, 1] >= 0.03).all()
    meets(steps)


def test_the_first_step_after_a_walk_goes_around_the_other_foot() -> None:
    """She walks on to the middle of the left pad; from there her left foot's first step goes past the right one."""
    steps = play([(4.0, {3: L}), (5.0, {0: R}), (6.0, {3: L})], double=True)
    assert any(w.end < 4.0 for w in planned(steps, True).walks)
    meets(steps, True)


@pytest.mark.parametrize("gap", [0.3, 0.4, 0.5])
def test_ankles_stand_a_jump_with_half_a_turn(gap: float) -> None:
    rows: list[Event] = [(1.0, {0: L, 3: R}), (2.0, {0: L, 3: R}), (2.0 + gap, {3: L, 0: R}), (4.0, {0: L, 3: R})]
    measured = report(bake(chart().timing, play(rows), pad()))
    assert measured["frames past joint limits"].value == 0, measured.notes


def test_both_feet_of_a_gallop_go_around_each_other() -> None:
    """From a crossover: the right foot from the left panel to the right one, the left one from up to down."""
    meets(play([(1.0, {0: L}), (1.5, {3: R}), (2.0, {2: L}), (2.5, {0: R}), (3.5, {3: R}), (3.59, {1: L})]))


def test_a_leg_that_trails_behind_lets_the_body_fly() -> None:
    """A turning jump from the right pad to the two panels in the middle: the leg behind must not hold her back."""
    meets(play([(1.0, {4: R}), (1.5, {5: L}), (1.83, {3: L, 4: R}), (3.0, {3: L})], double=True), True)


def test_a_foot_makes_room_for_a_bracket_over_its_panel() -> None:
    parts = {(3, 1): Part.HEEL, (3, 3): Part.TOE}
    meets(play([(1.0, {0: L}), (1.5, {3: R}), (1.7, {1: L}), (2.1, {1: R, 3: R}), (3.5, {0: L})], brackets=parts))


def test_all_steps_after_a_walk_go_around_until_both_feet_have_stepped() -> None:
    """Her left foot passes the right one, which still stands where she has walked to, and passes it back."""
    steps = play([(4.0, {3: L}), (4.6, {0: L}), (5.4, {1: R}), (6.0, {3: L})], double=True)
    assert any(w.end < 4.0 for w in planned(steps, True).walks)
    meets(steps, True)


def test_a_jump_does_not_leave_before_a_foot_has_landed() -> None:
    """The other foot's hold ends so late that it is let go early, but not so early."""
    rows: list[Event] = [(1.0, {0: L}), (1.5, {2: L}), (1.85, {1: R}), (1.975, {0: L, 3: R}), (3.0, {2: L})]
    steps = play(rows, holds={(1, 2): 1.96})
    planned(steps)
    meets(steps)


def test_a_heel_stays_as_it_is_between_a_landing_and_the_next_moment() -> None:
    meets(play([(1.0, {3: L, 4: R}), (2.0, {0: L, 3: R}), (2.065, {6: R}), (3.0, {3: L})], double=True), True)


@pytest.mark.parametrize("gap", [0.25, 0.31])
def test_ankles_stand_a_step_with_half_a_turn(gap: float) -> None:
    events: list[Event] = [(1.0, {5: L}), (1.5, {7: R}), (1.66, {4: R}), (1.66 + gap, {6: L}), (3.0, {7: R})]
    measured = report(bake(chart().timing, play(events, double=True), pad(True)))
    assert measured["frames past joint limits"].value == 0, measured.notes


def test_feet_that_hold_stand_off_panels_whose_mines_come_much_later() -> None:
    """In a stream feet land near the next panels; the mines there pass long after, while both feet still hold."""
    rows = [*stream(1.0, 12, 0.125), (2.5, {0: L}), (2.625, {3: R}), (4.0, {}), (4.3, {}), (5.5, {0: L})]
    steps = danced(rows, {14: [1], 15: [2]}, holds={(12, 0): 5.0, (13, 3): 5.0})
    assert (
        len([s for t in planned(steps).feet for s in t.moves if 2.7 < s.lift < 5.0 and not isinstance(s, Pivot)]) == 0
    )
    meets(steps)
