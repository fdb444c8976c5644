"""Where the zero-moment point may be: the hull of the soles that stand, against scipy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from dancetutor_cli.dance.foot_path import FootPath
from dancetutor_cli.dance.rig.body import SOLE_BACK_HEEL, SOLE_FRONT, SOLE_HALF_WIDTH
from dancetutor_cli.dance.trajectory.balance import SUPPORT_BEHIND, Rail, along_sides, support_of

HEEL = np.radians(1.2)


def feet_of(rng: np.random.Generator, count: int, down: tuple[bool, bool]) -> tuple[FootPath, FootPath]:
    """Flat feet anywhere on a pad, turned anyhow."""
    zeros = np.zeros(count)
    out = []
    for side in (0, 1):
        ball = np.column_stack((rng.uniform(0.1, 0.5, count) * (1 - 2 * side), zeros, rng.uniform(-0.4, 0.4, count)))
        out.append(FootPath(ball, rng.uniform(-1.5, 1.5, count), zeros, np.full(count, down[side]), zeros))
    return out[0], out[1]


def corners(foot: FootPath, k: int) -> np.ndarray:
    ahead = np.array([np.sin(foot.yaw[k]), np.cos(foot.yaw[k])])
    aside = SOLE_HALF_WIDTH * np.array([ahead[1], -ahead[0]])
    ends = (foot.ball[k, [0, 2]] + far * ahead for far in (SOLE_FRONT, SOLE_BACK_HEEL))
    return np.array([end + sign * aside for end in ends for sign in (1, -1)])


@pytest.mark.parametrize(
    ("down", "slack"),
    [((True, False), 1e-9), ((False, True), 1e-9), ((True, True), 0.04)],
    ids=["left", "right", "both"],
)
def test_the_limits_are_the_soles_however_they_are_turned(down: tuple[bool, bool], slack: float) -> None:
    """One sole exactly; of two at most the corners at the ends of the line between them stick out by 4 cm."""
    rng = np.random.default_rng(3)
    feet = feet_of(rng, 60, down)
    support = support_of(feet, HEEL)
    for k in range(60):
        soles = np.concatenate([corners(foot, k) for foot in feet if foot.down[k]])
        hull = ConvexHull(soles).equations
        points = soles.mean(axis=0) + rng.uniform(-0.6, 0.6, (4000, 2))
        along = points @ support.across[k].T
        allowed = ((along >= support.low[k]) & (along <= support.high[k])).all(axis=1)
        beyond = (points @ hull[:, :2].T + hull[:, 2]).max(axis=1)
        assert allowed[beyond < 0.0].all()  # nothing that carries is forbidden
        assert beyond[allowed].max(initial=0.0) <= slack


def test_hands_on_a_bar_support_her_behind_her_soles_and_keep_her_near() -> None:
    """The zero-moment point may be a little behind the farthest place of the mass, only while a hand holds the bar."""
    support = support_of(feet_of(np.random.default_rng(4), 60, (True, True)), HEEL)
    ahead, held = np.full(60, -0.6), np.arange(60) % 2 == 0
    rail = Rail(ahead, held, 0.05)
    more = rail.supported(support)
    place = np.column_stack((support.middle[:, 0], ahead - SUPPORT_BEHIND))
    along = along_sides(support.across, place)
    carried = ((along >= more.low - 1e-9) & (along <= more.high + 1e-9)).all(axis=1)
    assert carried.tolist() == held.tolist(), "no sole reaches so far back"
    assert (more.low <= support.low).all() and (more.high >= support.high).all()
    near = rail.within_reach(support.middle)
    assert (near[held, 1] < -0.6).all() and np.array_equal(near[~held], support.middle[~held])
