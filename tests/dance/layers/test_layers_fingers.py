"""Hands by situation: curled at rest, a loose fist in effort, flat on the floor, around the bar, loose when shaken."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.layers import HandUse, add_fingers, curls
from dancetutor_cli.dance.rig.body import SIDES, palm_normal, world_transforms
from dancetutor_cli.dance.rig.skeleton import FINGERS, KNUCKLES, dancer_skeleton
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.dance.units import Poses
from tests.dance.bake_plays import LH, Event, L, R, chart, pad, play, stream

NUMBERS = default_settings().fingers
TIMES = np.linspace(0.0, 20.0, 400)
NOTHING = HandUse(np.zeros(400), np.zeros((400, 2)), np.zeros((400, 2)), np.zeros((400, 2)), 0)


def bent(**how: object) -> np.ndarray:
    return np.degrees(curls(TIMES, replace(NOTHING, **how), NUMBERS)).mean(axis=0)  # type: ignore[arg-type]


def test_a_hand_at_rest_is_curled_and_no_hand_is_the_others_image() -> None:
    rest = curls(TIMES, NOTHING, NUMBERS)
    assert (np.degrees(rest) > 10.0).all() and (np.degrees(rest) < 40.0).all()
    assert np.abs(rest[:, 0] - rest[:, 1]).max() > np.radians(3.0)
    image = curls(TIMES, replace(NOTHING, lead=1), NUMBERS)
    np.testing.assert_allclose(image, rest[:, ::-1])


@pytest.mark.parametrize(
    ("how", "least", "most"),
    [
        ({"effort": np.ones(400)}, 40.0, 75.0),
        ({"floor": np.ones((400, 2))}, -25.0, -10.0),
        ({"bar": np.ones((400, 2))}, 15.0, 50.0),
        ({"loose": np.ones((400, 2))}, 0.0, 12.0),
        ({"effort": np.ones(400), "floor": np.ones((400, 2))}, -25.0, -10.0),
    ],
)
def test_hands_are_as_what_they_do(how: dict[str, np.ndarray], least: float, most: float) -> None:
    found = bent(**how)
    assert (found > least).all() and (found < most).all()


@pytest.mark.parametrize("side", [0, 1])
def test_a_bend_takes_the_finger_tips_to_the_palm(side: int) -> None:
    skeleton = dancer_skeleton()
    rotations = np.zeros((1, len(skeleton.names), 4))
    rotations[..., 0] = 1.0
    poses = Poses(rotations, skeleton.offsets[None, 0])
    tip = skeleton.index(f"{SIDES[side]}_{FINGERS}")
    before = world_transforms(skeleton, *poses)[0][0, tip]
    add_fingers(skeleton, poses, np.full((1, 2, 2), np.radians(50.0)))
    moved = world_transforms(skeleton, *poses)[0][0, tip] - before
    assert moved @ palm_normal(skeleton, SIDES[side]) > 0.02


def test_a_dance_has_fists_in_streams_and_flat_hands_on_the_floor() -> None:
    events: list[Event] = [
        (0.0, {0: L}),
        (1.0, {3: R}),
        *stream(2.0, 60, 0.12),
        (11.5, {0: L, 3: R, 1: LH}),
        (14.0, {0: L}),
    ]
    motion = bake(chart().timing, play(events), pad())
    joint = motion.skeleton.index(f"l_{KNUCKLES}")

    along = motion.rotations[:, joint, 1:]
    size = np.degrees(2 * np.arcsin(np.clip(np.linalg.norm(along, axis=1), 0, 1)))
    at = {second: size[np.searchsorted(motion.times, second)] for second in (0.2, 6.0, 11.55)}
    assert at[6.0] > at[0.2] + 8.0
    axis = along[np.searchsorted(motion.times, 6.0)]
    assert along[np.searchsorted(motion.times, 11.55)] @ axis < 0.0, "on the floor they are bent back"
    assert at[6.0] > 25.0
