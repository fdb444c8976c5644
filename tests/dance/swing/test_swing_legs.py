"""Legs do not go through each other: a swinging foot goes around the standing one where the hips turn."""

from __future__ import annotations

import numpy as np
import pytest
from bake_plays import Event, L, R, chart, pad, play, stream

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.clearance import SHARES, Way, detour, travel_share, wrung
from dancetutor_cli.dance.ik.knees import Hung, part_knees
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.quality.posture import limb_depths
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.settings import default_settings

SETTINGS = default_settings()
SCENES: dict[str, tuple[list[Event], bool]] = {
    # the right foot goes from behind the left one to before it, while the hips turn to the left
    "around in front": (
        [(2.0, {0: L}), (2.5, {1: R}), (3.0, {1: L}), (3.2, {3: R}), (3.4, {3: L}), (3.6, {2: R})],
        False,
    ),
    "footswitches": (
        [(2.0, {0: L}), *((2.3 + 0.3 * k, {(1, 2)[k // 2 % 2]: (R, L)[k % 2]}) for k in range(12))],
        False,
    ),
    "doubles": ([(2.0 + 0.16 * k, {(1, 3, 4, 6, 4, 3, 2, 3, 4)[k % 9]: (R, L)[k % 2]}) for k in range(18)], True),
    "a spin": ([(2.0 + 0.3 * k, {(0, 1, 3, 2)[k % 4]: (L, R)[k % 2]}) for k in range(10)], False),
    "a stream": (stream(2.0, 24, 0.14), False),
}


@pytest.mark.parametrize("scene", SCENES)
def test_no_leg_is_deeper_than_a_centimetre_in_the_other(scene: str) -> None:
    events, double = SCENES[scene]
    motion = bake(chart().timing, play(events, double), pad(double))
    deep = limb_depths(body_of(motion), motion.skeleton)["leg in leg"]
    assert deep.max() < 0.010, f"{100 * deep.max():.1f} cm at {body_of(motion).times[deep.argmax()]:.2f} s"


def test_a_way_leads_around_on_the_side_of_the_hips() -> None:
    """From the left of the left foot's place to its right, straight over it: hips that turn left lead round behind it,
    hips that turn right round before it."""
    start, end, other = np.array([-0.2, 0.0]), np.array([0.2, 0.0]), np.zeros(2)
    for turn in (-170.0, 170.0):
        way = Way(start, 0.0, end, np.radians(turn), (0.0, np.radians(turn)))
        aside = np.array(detour(way, other, 0.0, SETTINGS.step, -1.0)[:2])
        share = travel_share(SHARES, SETTINGS.step)
        line = -(start + share[:, None] * (end - start) + np.sin(np.pi * share)[:, None] * aside - other)
        angle = np.degrees(np.unwrap(np.arctan2(-line[:, 1], line[:, 0])))
        assert np.sign(angle[-1] - angle[0]) == np.sign(turn) and abs(angle[-1] - angle[0]) > 100.0


def test_where_legs_cross_whatever_the_way_is_the_foot_makes_no_far_detour() -> None:
    """A quick step to behind the other foot, from a chart of doubles: 60 cm aside for 3 degrees less took her hips
    down by 40 cm."""
    way = Way(np.array([0.1454, 0.1018]), -1.1122, np.array([-0.044, -0.116]), -0.5463, (-0.7632, -0.4122), 0.3513)
    aside = detour(way, np.array([-0.058, 0.058]), -1.0649, SETTINGS.step, 1.0)
    assert 0.05 < np.hypot(aside.x, aside.z) < 0.2


def test_feet_crossed_at_the_start_may_uncross() -> None:
    way = Way(np.zeros(2), 0.0, np.ones(2), 0.0, (0.0, 0.0))
    angles = np.linspace(np.radians(SETTINGS.step.cross) + 0.3, 0.0, len(SHARES))
    line = np.column_stack((np.cos(angles), -np.sin(angles)))
    assert wrung(way, line, SETTINGS.step) == 0.0
    assert wrung(way, line[::-1], SETTINGS.step) > 0.2


def test_knees_that_meet_give_way_and_others_stay() -> None:
    skeleton = dancer_skeleton()
    pelvis = np.tile(skeleton.offsets[0] - [0.0, 0.06, 0.0], (3, 1))
    ankles = np.array([[[x, 0.085, 0.0], [-x, 0.085, 0.0]] for x in (0.09, 0.04, 0.09)])
    inward = np.array([[-0.45, 0.0, 1.0], [0.45, 0.0, 1.0]])
    poles = np.stack([np.tile([0.0, 0.0, 1.0], (2, 1)), inward, inward])
    turned = np.tile([1.0, 0.0, 0.0, 0.0], (3, 1))
    given = part_knees(skeleton, Hung(pelvis, turned, ankles), poles, SETTINGS.knees)
    np.testing.assert_array_equal(given[0], poles[0])
    for frame in (1, 2):
        assert given[frame, 0, 0] > poles[frame, 0, 0] + 0.02 and given[frame, 1, 0] < poles[frame, 1, 0] - 0.02
