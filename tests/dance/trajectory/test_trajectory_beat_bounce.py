"""The beat in knees and chest: on every beat that people nod to, never in streams, never a tremble."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import context

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.trajectory.groove import beat_bounce

TIMES = np.arange(0.0, 10.0, 1.0 / 240.0)
STILL = np.zeros(len(TIMES))


def heard(beats: tuple[float, ...]) -> Context:
    """The dancer with these beats in her ears."""
    return replace(context(), beats=beats)


def dips(beats: np.ndarray) -> np.ndarray:
    """Seconds at which she is lowest."""
    given = beat_bounce(heard(tuple(beats)), TIMES, STILL, STILL)
    inner = (given[1:-1] > given[:-2]) & (given[1:-1] >= given[2:]) & (given[1:-1] > 0.9)
    return TIMES[1:-1][inner]


def test_she_gives_way_on_each_beat() -> None:
    beats = np.arange(0.0, 10.0, 0.5)
    np.testing.assert_allclose(dips(beats), beats[1:], atol=0.005)


def test_of_quick_beats_she_takes_every_second_one() -> None:
    np.testing.assert_allclose(np.diff(dips(np.arange(0.0, 10.0, 0.3))), 0.6, atol=0.005)


def test_between_slow_beats_she_stands_up_and_without_any_she_stands() -> None:
    given = beat_bounce(heard((1.0, 4.0, 7.0)), TIMES, STILL, STILL)
    assert given[(TIMES > 1.5) & (TIMES < 3.5)].max() == 0.0
    np.testing.assert_allclose(dips(np.array([1.0, 4.0, 7.0])), [1.0, 4.0, 7.0], atol=0.005)
    assert not beat_bounce(heard(()), TIMES, STILL, STILL).any()


def test_hundreds_of_beats_in_a_moment_do_not_make_her_tremble() -> None:
    """Gimmicks of the timing put many beats into a few milliseconds."""
    beats = np.sort(np.concatenate((np.arange(0.0, 10.0, 0.5), 4.1 + np.arange(300) * 1e-4)))
    given = beat_bounce(heard(tuple(beats)), TIMES, STILL, STILL)
    assert np.abs(np.diff(given)).max() < 0.05


@pytest.mark.parametrize("which", ["tempo", "busy"])
def test_there_is_none_of_it_in_streams_or_with_busy_hands(which: str) -> None:
    full = {"tempo": STILL, "busy": STILL, which: np.ones(len(TIMES))}
    assert not beat_bounce(heard(tuple(np.arange(0.0, 10.0, 0.5))), TIMES, full["tempo"], full["busy"]).any()
