"""How the body leans on the bar: it stays within reach of it while hands hold it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Bar, Grip
from dancetutor_cli.motion.settings import BarSettings
from dancetutor_cli.numerics.ease import smooth

Array = NDArray[np.float64]


def leaning_share(grips: tuple[Grip, ...], times: Array, settings: BarSettings) -> Array:
    """How much the body leans on the bar (n,), 0 to 1: wholly while hands hold it, also while one takes it anew."""
    out, rest = np.zeros(len(times)), settings.leave
    spans: list[list[float]] = []
    for grip in grips:
        if spans and grip.start - spans[-1][1] < rest:
            spans[-1][1] = max(spans[-1][1], grip.end)
        else:
            spans.append([grip.start, grip.end])
    for start, end in spans:
        before = smooth((times - start + rest / 2) / (rest / 2))
        out = np.maximum(out, before * smooth((end + rest / 2 - times) / (rest / 2)))
    return out


def kept_back(path: Array, share: Array, bar: Bar, settings: BarSettings, nearer: Array) -> Array:
    """A path (n, 2) over the ground that stays within reach of the bar, softly, as far as `share` (n,) says.

    nearer : (n,) metres that it must be nearer than usual
    """
    most = settings.forward - nearer
    over = (path[:, 1] - bar.behind - most) / settings.soft
    # a soft least of the place and the farthest one: -log(exp(-a) + exp(-b))
    near = bar.behind + most - settings.soft * np.logaddexp(0.0, -over)
    return np.column_stack((path[:, 0], path[:, 1] + share * (near - path[:, 1])))
