"""Residuals of inverse dynamics and published measures, on motions whose answer is known."""

from dataclasses import replace

import numpy as np
import pytest

from dancetutor_cli.dance.motion import Contact, Motion
from dancetutor_cli.dance.quality.dynamics import LEAST, dynamics_figures, residuals
from dancetutor_cli.dance.quality.figures import body_of, penetration, physical_foot_contact, skating_ratio
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import GRAVITY
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton

SKELETON = dancer_skeleton()


def stiff(path: np.ndarray, fps: float = 60.0) -> Motion:
    """The rest pose, moved along a path (f, 3)."""
    rotations = np.tile(quat.IDENTITY, (len(path), len(SKELETON.names), 1))
    return Motion(SKELETON, fps, np.arange(len(path)) / fps, rotations, SKELETON.offsets[0] + path, ())


def still(seconds: float = 2.0) -> Motion:
    return stiff(np.zeros((round(seconds * 60) + 1, 3)))


def test_the_floor_holds_a_standing_dancer() -> None:
    assert residuals(still(), body_of(still())).max() < 1e-9


def test_a_hovering_body_lacks_a_body_weight() -> None:
    hovering = replace(still(), root=still().root + np.array([0, 0.1, 0]))
    values = residuals(hovering, body_of(hovering))
    assert np.allclose(values[:, 0], 1.0) and np.allclose(values[:, 1], 0.0)


def test_a_freely_falling_body_lacks_nothing() -> None:
    t = np.arange(61) / 60
    falling = stiff(np.column_stack((0.5 * t, 5 - GRAVITY / 2 * t**2, 0 * t)))
    inner = residuals(falling, body_of(falling))[15:-15]  # filters see the ends of the fall
    assert inner.max() < 0.02


def test_friction_carries_only_so_much_and_a_turning_body_needs_a_moment() -> None:
    t = np.arange(241) / 60
    shaken = stiff(np.column_stack((0.05 * np.sin(2 * np.pi * 2 * t), 0 * t, 0 * t)))  # 0.8 body weights at most
    pushed = stiff(np.column_stack((0.2 * np.sin(2 * np.pi * 2 * t), 0 * t, 0 * t)))  # 3.2: no sole can hold that
    assert residuals(shaken, body_of(shaken))[30:-30, 0].max() < 0.4
    assert residuals(pushed, body_of(pushed))[30:-30, 0].max() > 1.0
    spinning = still(4.0)
    turn = quat.from_axis_angle((0, 1, 0), 0.5 * np.sin(2 * np.pi * t))
    spinning.rotations[:, 0] = turn
    in_air = replace(spinning, root=spinning.root + np.array([0, 0.3, 0]))
    inertia = residuals(in_air, body_of(in_air))[30:-30, 1].max() / (0.5 * (2 * np.pi) ** 2 / GRAVITY)
    assert 0.01 < inertia < 0.06, "kg m^2 per kg of a person about her long axis, arms in an A"


def test_a_moment_without_a_hand_on_the_bar_is_no_percentile() -> None:
    """Of 6 frames of a quick jump, between two grips, the median was a goal missed."""
    for count, measured in ((LEAST - 1, False), (LEAST, True)):
        motion = stiff(np.zeros((count + 6, 3)))  # three frames at each end are left out
        figures = dynamics_figures(motion, body_of(motion))
        assert len(residuals(motion, body_of(motion))) == count
        assert all(np.isnan(figure.value) != measured for figure in figures)


def test_moments_in_which_hands_push_are_left_out() -> None:
    hand = Contact(0.9, 1.1, 2, 0, 1, 0, 0, (0.0, 0.0))
    assert len(residuals(replace(still(), contacts=(hand,)), body_of(still()))) < 121 - 6 - 25


def test_skating_ratio_is_the_part_of_frames_in_which_a_low_foot_is_fast() -> None:
    assert skating_ratio(still()) == 0.0
    t = np.arange(121) / 60
    for speed, ratio in ((0.4, 0.0), (1.0, 1.0)):
        assert skating_ratio(stiff(np.column_stack((speed * t, 0 * t, 0 * t)))) == ratio
    half = np.where(t < 1, 0.0, t - 1)
    assert skating_ratio(stiff(np.column_stack((half, 0 * t, 0 * t)))) == pytest.approx(0.5, abs=0.08)


def test_pfc_is_the_product_of_both_feet_and_the_root() -> None:
    assert physical_foot_contact(still()) == 0.0
    rate = 30
    v, a = 0.02, 0.004  # metres per frame, and per frame squared
    k = np.arange(3 * rate)
    path = np.column_stack((v * k + a * k**2 / 2, 0 * k, 0 * k))
    motion = stiff(path, rate)
    speeds = v + a * (k[1:-1] + 0.5)  # of frame 1 to 2, ...; the root's acceleration is the same throughout
    assert physical_foot_contact(motion) == pytest.approx(10000 * (speeds**2).mean(), rel=1e-6)
    down = replace(motion, root=motion.root * [0, 1, 0])
    assert physical_foot_contact(down) == 0.0


def test_penetration_is_the_mean_depth_beyond_five_millimetres() -> None:
    for depth, mean in ((0.004, 0.0), (0.02, 0.02)):
        sunk = replace(still(), root=still().root - np.array([0, depth, 0]))
        assert penetration(body_of(sunk)) == pytest.approx(mean, abs=1e-9)
