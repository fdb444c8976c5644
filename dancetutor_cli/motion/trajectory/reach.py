"""How the body bends and turns for palms that go down to panels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.plan import Press
from dancetutor_cli.motion.settings import HandSettings, MotionSettings
from dancetutor_cli.motion.trajectory.course import Course
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import smooth_path

Array = NDArray[np.float64]
Presses = tuple[Press, ...]


def press_share(press: Press, times: Array, down: float) -> Array:
    """How much of a press there is at each time, 0 to 1: all of it from its start to its end."""
    return smooth((times - press.start + down) / down) * smooth((press.end + down - times) / down)


def reaching(presses: Presses, times: Array, hands: HandSettings) -> Array:
    """How far (n, 2) the body has bent for each hand, 0 to 1."""
    out = np.zeros((len(times), 2))
    for press in presses:
        out[:, press.side] = np.maximum(out[:, press.side], press_share(press, times, hands.reach_down))
    return out


def bent_down(presses: Presses, deeper: Array | None, times: Array, hands: HandSettings) -> Array:
    """(n, 2): how far the body has gone down to the floor, 0 to 1, and how much deeper than usual, metres.

    deeper : (p,) metres for each press, None for none
    """
    out = np.zeros((len(times), 2))
    for k, press in enumerate(presses):
        share = press_share(press, times, hands.reach_down)
        more = share > out[:, 0]
        out[more, 0] = share[more]
        out[:, 1] = np.maximum(out[:, 1], share * (0.0 if deeper is None else float(deeper[k])))
    return out


def turned_for_hands(presses: Presses, times: Array, hands: HandSettings) -> Array:
    """How far (n,) the body turns to the side of a hand that reaches behind it, radians."""
    out = np.zeros(len(times))
    for press in presses:
        if press.turn != 0.0:
            out += press.turn * press_share(press, times, hands.reach_down)
    return out


def leaning_tilt(presses: Presses, course: Course, chest: Array, lean: Array, settings: MotionSettings) -> Array:
    """How the chest leans (n, 2), a horizontal direction times an angle: a little forward, and down to each panel.

    chest : (n,) its yaw; lean : (n, 2) how it leans where no hand reaches, in the same form
    """
    times, hands = course.times, settings.hands
    forward = np.column_stack((np.sin(chest), np.cos(chest)))
    tilt = lean.copy()
    for press in sorted(presses, key=lambda p: p.side):
        down = hands.reach_down
        near = (times > press.start - down) & (times < press.end + down)
        to = np.array(press.target) - course.ground[near] + hands.look_from * forward[near]
        off = wrapped(np.arctan2(to[:, 0], to[:, 1]) - chest[near])
        most = np.radians(hands.bend_aside)
        way = chest[near] + np.clip(off, -most, most)
        to = np.column_stack((np.sin(way), np.cos(way)))
        share = press_share(press, times[near], down)
        tilt[near] = tilt[near] + share[:, None] * (np.radians(hands.bend) * to - tilt[near])
    return smooth_path(tilt, np.ones(len(times)), course.rate, hands.bend_time)


def wrapped(angle: Array) -> Array:
    """The same angles between half a turn to the right and half a turn to the left, radians."""
    return np.asarray((angle + np.pi) % (2 * np.pi) - np.pi)
