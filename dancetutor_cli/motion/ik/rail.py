"""The bar behind the dancer: where it stands, and what holding it does to body and arms."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.ik.palms import elbows_on_bar, rest_on_bar
from dancetutor_cli.motion.model import Bar, Grip
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.settings import BarSettings, MotionSettings
from dancetutor_cli.motion.swing.panels import HALF_PANEL, PANEL
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton

if TYPE_CHECKING:
    from dancetutor_cli.pads import Pad

Array = NDArray[np.float64]
CLEAR = (0.34, 0.30)  # metres, half axes, aside and ahead, of what a hand on its way keeps clear of: trunk and forearm
TRUNK = np.array([0.0, -0.30, 0.02])  # its middle as seen from the middle of the shoulders
SOFT, FIRST, LAST = 8.0, 0.2, 2  # how sharply it is pushed out of there; how soon, and how long, as it goes to the rail
PIN = 2  # power of a hand's share in the rail with which it turns to lie on it: later than the elbow, for the wrist
WAY_UP = np.array([0.0, 1.0, 0.0])
LIFT = 0.05  # metres that a hand rises on its way to the rail
REST = 1.2  # seconds; the body leaves the bar only if no hand is on it for longer


def bar_of(pad: Pad, settings: BarSettings) -> Bar:
    """The bar of a pad: a rail behind each of its squares of nine panels."""
    x, y = (np.asarray(pad.panels, dtype=np.float64) - np.asarray(pad.centre, dtype=np.float64)).T
    squares = int(np.floor((np.ptp(x) + 1e-6) / 3)) + 1
    middles = 3 * PANEL * (np.arange(squares) - (squares - 1) / 2) - PANEL * (x.max() + x.min()) / 2
    spans = tuple((float(m - settings.posts), float(m + settings.posts)) for m in middles)
    return Bar(settings.height, float(PANEL * y.min() - HALF_PANEL - settings.behind), settings.radius, spans)


def holding(settings: MotionSettings) -> MotionSettings:
    """The settings for somebody who holds the bar: she stands a little lower, for her feet are far before her.

    Her chest keeps more to the screen, for both hands hold it; and she goes down half as far in streams and for jumps,
    for the bar bears a part of that.
    """
    body, jump, look, bar = settings.body, settings.jump, settings.look, settings.bar
    body = replace(body, stance=body.stance - bar.knees, soft_reach=body.soft_reach - bar.knees)
    body = replace(body, stream_crouch=body.stream_crouch / 2)
    jump = replace(jump, crouch=jump.crouch / 2, follow=jump.follow / 2)
    return replace(settings, body=body, jump=jump, look=replace(look, torso_weight=bar.square))


def on_rail(x: Array, bar: Bar) -> Array:
    """The nearest place on the rail, a hand's width from its ends."""
    choices = np.stack([np.clip(x, low + 0.06, high - 0.06) for low, high in bar.spans])
    nearest = np.argmin(np.abs(choices - x), axis=0)
    return np.asarray(np.take_along_axis(choices, nearest[None], axis=0)[0])


def hold_share(grips: tuple[Grip, ...], times: Array, reach: float) -> Array:
    """How much each hand is at the rail, (n, 2), 0 to 1: all of it from a grip's start to its end."""
    out = np.zeros((len(times), 2))
    for grip in grips:
        near = slice(*np.searchsorted(times, (grip.start - reach, grip.end + reach)).tolist())
        out[near, grip.side] += _share(grip, times[near], reach)
    return np.minimum(out, 1.0)


def leaning_share(grips: tuple[Grip, ...], times: Array) -> Array:
    """How much the body leans on the bar (n,), 0 to 1: wholly while hands hold it, also while one takes it anew."""
    out = np.zeros(len(times))
    spans: list[list[float]] = []
    for grip in grips:
        if spans and grip.start - spans[-1][1] < REST:
            spans[-1][1] = max(spans[-1][1], grip.end)
        else:
            spans.append([grip.start, grip.end])
    for start, end in spans:
        before = smooth((times - start + REST / 2) / (REST / 2))
        out = np.maximum(out, before * smooth((end + REST / 2 - times) / (REST / 2)))
    return out


def kept_back(path: Array, share: Array, bar: Bar, settings: BarSettings) -> Array:
    """A path (n, 2) over the ground that stays within reach of the bar, softly, as far as `share` (n,) says."""
    over = (path[:, 1] - bar.behind - settings.forward) / settings.soft
    # a soft least of the place and the farthest one: -log(exp(-a) + exp(-b))
    near = bar.behind + settings.forward - settings.soft * np.logaddexp(0.0, -over)
    return np.column_stack((path[:, 0], path[:, 1] + share * (near - path[:, 1])))


def hold(
    plan: Plan, at: Array, wrists: Array, turn: Array, pinned: Array, elbows: Array, shoulders: Array,
    chest: Array, skeleton: Skeleton, settings: MotionSettings,
) -> None:  # fmt: skip
    """Lead hands to the bar: change wrists, elbows (f, 2, 3), turn (f, 2, 4) and pinned (f, 2) in place.

    shoulders : (f, 2, 3), for on its way a hand goes around the body; chest : (f, 4), its rotation
    """
    if plan.bar is None:
        return
    reach = settings.bar.reach_time
    goal, weight = np.zeros_like(wrists), np.zeros_like(pinned)
    for grip in plan.grips:
        near = slice(*np.searchsorted(at, (grip.start - reach, grip.end + reach)).tolist())
        wrist, hand = rest_on_bar(plan.bar, grip.side, grip.x, skeleton, settings.bar)
        share = _share(grip, at[near], reach)
        weight[near, grip.side] += share
        goal[near, grip.side] += share[:, None] * (wrist + [0.0, LIFT, 0.0] * (1.0 - share[:, None]))
        turn[near, grip.side] = hand
    weight = np.minimum(weight, 1.0)
    wrists += goal - weight[..., None] * wrists
    wrists += _around(wrists, weight, shoulders, chest)
    pinned[:] = np.maximum(pinned, weight**PIN)
    elbows += weight[..., None] * (elbows_on_bar(chest) - elbows)


def _around(wrists: Array, weight: Array, shoulders: Array, chest: Array) -> Array:
    """By how much wrists (f, 2, 3) on their way to the rail or from it keep clear of the trunk, (f, 2, 3)."""
    upright = quat.swing_twist(chest, WAY_UP)[1][:, None]
    middle = shoulders.mean(axis=1, keepdims=True) + quat.rotate(chest, TRUNK)[:, None]
    off = quat.rotate(quat.conjugate(upright), wrists - middle) * [1.0 / CLEAR[0], 0.0, 1.0 / CLEAR[1]]
    far = np.maximum(np.linalg.norm(off, axis=2, keepdims=True), 0.05)
    beyond = np.logaddexp(0.0, SOFT * (1.0 - far)) / SOFT  # a soft most of 0 and 1 - far
    clear = quat.rotate(upright, off / far * beyond * [CLEAR[0], 0.0, CLEAR[1]])
    return np.asarray((smooth(weight / FIRST) * (1.0 - weight**LAST))[..., None] * clear)


def _share(grip: Grip, times: Array, reach: float) -> Array:
    return smooth((times - grip.start + reach) / reach) * smooth((grip.end + reach - times) / reach)
