"""Music at other speeds: notes come at the rate's times, but she falls as fast as everybody falls."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from bake_plays import chart, pad, play

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.rig.body import centre_of_mass, points_in_world, sole_points, world_transforms
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play

L, R = Limb.LEFT_FOOT, Limb.RIGHT_FOOT
JUMPS = [(2.0 + 1.0 * k, {(0, 1)[k % 2]: L, (3, 2)[k % 2]: R}) for k in range(6)]


def at_rate(rate: float) -> tuple[Motion, Play]:
    """As `animate --rate` does: the rows' seconds are those of the music as it is played."""
    fast = play(JUMPS)
    fast = replace(fast, rows=replace(fast.rows, second=fast.rows.second / rate))
    timing: Any = SimpleNamespace(seconds=lambda ticks: chart().timing.seconds(ticks) / rate)
    return bake(timing, fast, pad()), fast


@pytest.mark.parametrize("rate", [0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0])
def test_jumps_are_parabolas_of_real_gravity(rate: float) -> None:
    motion, fast = at_rate(rate)
    for time in fast.rows.second[1:]:
        times = np.arange(time - 0.4, time + 0.05, 1 / 500)
        rotations, root = sample(motion, times)
        soles = [
            points_in_world(motion.skeleton, p, rotations, root)[..., 1].min(axis=1)
            for p in sole_points(motion.skeleton)
        ]
        up = np.flatnonzero(np.minimum(*soles) > 0.002)
        assert len(up) > 50, "she is in the air for a tenth of a second at least"
        assert (np.diff(up) == 1).all()
        mass = centre_of_mass(motion.skeleton, *world_transforms(motion.skeleton, rotations[up], root[up]))
        fit = np.polyfit(times[up], mass[:, 1], 2)
        assert -2 * fit[0] == pytest.approx(9.81, rel=0.02)
        assert np.abs(np.polyval(fit, times[up]) - mass[:, 1]).max() < 0.003


@pytest.mark.parametrize("rate", [0.25, 0.5, 1.5, 2.0])
def test_notes_are_pressed_at_the_times_of_the_rate(rate: float) -> None:
    motion, fast = at_rate(rate)
    times = sorted({c.start for c in motion.contacts})
    np.testing.assert_allclose(times, fast.rows.second)
    np.testing.assert_allclose(times, [time / rate for time, _ in JUMPS])
