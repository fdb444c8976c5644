"""Joints come back from beyond their limits early and slowly, and never stop dead there."""

import numpy as np

from dancetutor_cli.dance.physics.repin import feet_of, repinned, restrained
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import LIMITS, beyond, dancer_skeleton
from dancetutor_cli.dance.units import Poses

SKELETON = dancer_skeleton()
TIMES = np.arange(241) / 60


def swung(degrees: np.ndarray, name: str) -> np.ndarray:
    """All joints at rest but one, which swings about X."""
    rotations = np.tile(quat.IDENTITY, (len(TIMES), len(SKELETON.names), 1))
    rotations[:, SKELETON.index(name)] = quat.from_axis_angle((1.0, 0.0, 0.0), np.radians(degrees))
    return rotations


def test_a_joint_that_goes_too_far_slows_down_before_its_limit() -> None:
    name = "vt10"
    high = LIMITS[name].x[1]
    wanted = high * (0.4 + 0.8 * np.sin(2 * np.pi * TIMES))  # up to a fifth too far
    made = restrained(SKELETON, swung(wanted, name), TIMES)[:, SKELETON.index(name)]
    assert beyond(SKELETON, name, made).max() <= 0.0
    angle = np.degrees(2 * np.arcsin(made[:, 1]))
    hard = np.clip(wanted, LIMITS[name].x[0] + 0.5, high - 0.5)
    stops = [np.abs(np.diff(values, n=2)).max() for values in (angle, hard)]
    assert stops[0] < 0.6 * stops[1], "a clipped angle has a corner"
    assert np.abs(angle - hard).max() < 12.0


def test_what_is_within_its_limits_stays_to_the_bit() -> None:
    given = swung(10 * np.sin(2 * np.pi * TIMES), "vt10")
    np.testing.assert_array_equal(restrained(SKELETON, given, TIMES), given)


def test_a_leg_that_a_rising_hip_stretches_does_not_snap_straight() -> None:
    """The root goes up at 1 m/s from where knees are bent by 40 degrees to beyond what legs reach; feet stay."""
    skeleton, frames = SKELETON, 120
    still = np.tile(quat.IDENTITY, (frames, len(skeleton.names), 1))
    low = np.tile(skeleton.rest[0], (frames, 1))
    feet = feet_of(skeleton, still, low - [0.0, 0.05, 0.0])  # of a body 5 cm lower: their legs are straight
    rises = low - [0.0, 0.10, 0.0] + np.linspace(0.0, 0.12, frames)[:, None] * [0.0, 1.0, 0.0]
    rotations, root = repinned(skeleton, Poses(still, rises), feet)
    ankles = feet_of(skeleton, rotations, root).places
    np.testing.assert_allclose(ankles, feet.places, atol=1e-4)
    knee = np.degrees(quat.angle_between(rotations[:, skeleton.index("l_knee")], quat.IDENTITY))
    assert np.ptp(knee) > 20.0
    assert np.abs(np.diff(knee)).max() < 1.5  # 0.8 as measured; 2.2 with a stop
