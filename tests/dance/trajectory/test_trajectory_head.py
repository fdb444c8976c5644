"""The head turns on the chest as necks do, and gives the screen up where she is turned too far from it."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.dance.plan import FootTrack, Plan
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.trajectory.facing import chest_and_head, limit_head_yaw
from dancetutor_cli.dance.trajectory.legs import Course

SETTINGS = default_settings()
TIMES = np.arange(0.0, 6.0, 1 / 240)
NONE = Plan((FootTrack((0.0, 0.0), 0.0, ()),) * 2, (), (), (), 0.0, 6.0)


def turned(degrees: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Degrees (n,) that the chest faces, and the head farther, where the pelvis turns so."""
    still = np.zeros((len(TIMES), 2))
    course = Course(TIMES, still, np.zeros((len(TIMES), 3)), np.zeros((len(TIMES), 2, 3)), np.radians(degrees))
    chest, head = chest_and_head(NONE, course, np.zeros(len(TIMES)), SETTINGS)
    return np.degrees(chest), np.degrees(head - chest)


@pytest.mark.parametrize("seconds", [0.35, 0.7, 2.0])
@pytest.mark.parametrize("far", [-360.0, 180.0, 360.0])
def test_a_turn_away_and_back_snaps_no_neck(far: float, seconds: float) -> None:
    yaw = far * (smooth((TIMES - 1.0) / seconds) - smooth((TIMES - 4.0) / seconds))
    _, neck = turned(yaw)
    assert np.abs(neck).max() <= SETTINGS.look.head_limit + 1.0
    # what smooths the path lets it be a little quicker in the middle
    assert np.abs(np.diff(neck)).max() * 240 <= SETTINGS.look.head_rate * 1.1


def test_with_her_back_to_the_screen_she_looks_ahead() -> None:
    _, neck = turned(180.0 * smooth((TIMES - 1.0) / 0.5))
    assert np.abs(neck[TIMES > 2.5]).max() < 2.0


def test_turned_aside_she_looks_at_the_screen() -> None:
    chest, neck = turned(90.0 * smooth((TIMES - 1.0) / 0.5))
    assert np.abs(chest + neck)[TIMES > 2.5].max() < SETTINGS.look.eyes_limit


def test_a_chest_that_turns_against_quick_legs_whips_no_neck() -> None:
    """The head's own turns and the chest's add up; the neck's limit is kept on the chest as it finally is."""
    chest = np.radians(30.0) * np.sin(2 * np.pi * 3.0 * TIMES) * (TIMES > 2.0) * (TIMES < 4.0)
    neck = limit_head_yaw(np.zeros(len(TIMES)), chest, 240.0, SETTINGS) - chest
    assert np.degrees(np.abs(np.diff(chest)).max()) * 240 > 560.0 > SETTINGS.look.head_rate * 1.15
    assert np.degrees(np.abs(np.diff(neck)).max()) * 240 <= SETTINGS.look.head_rate * 1.15
    assert np.degrees(np.abs(neck).max()) <= SETTINGS.look.head_limit


def test_a_neck_that_is_slow_enough_keeps_the_head_still() -> None:
    chest = np.radians(15.0) * np.sin(2 * np.pi * TIMES)
    assert np.abs(limit_head_yaw(np.zeros(len(TIMES)), chest, 240.0, SETTINGS)).max() == 0.0
