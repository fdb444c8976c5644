"""The bar behind the dancer: where it stands, when her hands rest on it, and what that does to body and arms."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.ease import smooth
from dancetutor_cli.motion.feet import foot_path
from dancetutor_cli.motion.model import Bar, Grip
from dancetutor_cli.motion.settings import BarSettings, MotionSettings
from dancetutor_cli.motion.stage import HALF_PANEL, PANEL
from dancetutor_cli.motion.track import Plan
from dancetutor_cli.rig import quaternion as quat

if TYPE_CHECKING:
    from dancetutor_cli.pads import Pad

Array = NDArray[np.float64]
RATE = 30.0  # looks per second at whether the rail is within reach
AHEAD = 1.0  # seconds over which the place of a grip is a mean
ASIDE, UP, BACK = 0.160, 1.29, 0.05  # of a shoulder, roughly: beside the body, over the pad, behind the pelvis
EARLY = 0.12  # seconds that a hand leaves before its shoulder gets out of reach
AROUND = 0.18  # metres by which a hand goes around the body on its way
LATE = 0.2  # seconds that a body may be behind where its feet are
LIFT = 0.05  # metres that a hand rises on its way to the rail
ELBOWS = np.array([[0.0, 0.4, -1.0], [0.0, 0.4, -1.0]])  # where they point while the hands are on the bar
REST = 1.2  # seconds; the body leaves the bar only if no hand is on it for longer


def bar_of(pad: Pad, settings: BarSettings) -> Bar:
    """The bar of a pad: a rail behind each of its squares of nine panels."""
    x, y = (np.asarray(pad.panels, dtype=np.float64) - np.asarray(pad.centre, dtype=np.float64)).T
    squares = int(np.floor((np.ptp(x) + 1e-6) / 3)) + 1
    middles = 3 * PANEL * (np.arange(squares) - (squares - 1) / 2) - PANEL * (x.max() + x.min()) / 2
    spans = tuple((float(m - settings.posts), float(m + settings.posts)) for m in middles)
    return Bar(settings.height, float(PANEL * y.min() - HALF_PANEL - settings.behind), settings.radius, spans)


def holding(settings: MotionSettings) -> MotionSettings:
    """The settings for somebody who holds the bar: she stands a little lower, for her feet are far before her."""
    body, lower = settings.body, settings.bar.knees
    return replace(settings, body=replace(body, stance=body.stance - lower, soft_reach=body.soft_reach - lower))


def grips_of(plan: Plan, bar: Bar, span: tuple[float, float], settings: MotionSettings) -> tuple[Grip, ...]:
    """When each hand rests on the bar between the seconds of `span`, in order of start.

    A hand lets go when the body turns or goes so far that its shoulder gets out of reach, and whenever a hand goes to
    a panel; it takes the rail anew, farther on, when the body has travelled along.
    """
    times = np.arange(span[0], span[1], 1.0 / RATE)
    if len(times) < 2:
        return ()
    root, turns = _body(plan, bar, times, settings)
    busy = _busy(plan, times, settings)
    found: list[Grip] = []
    held = np.full(len(times), bar.behind)
    for side, out in ((0, 1.0), (1, -1.0)):
        place = _on_rail(root[:, 0] + out * settings.bar.apart, bar)
        free = ~busy
        for turned in turns:
            # the chest keeps to the screen as far as it can, so only what is left turns the shoulder away
            shoulder = root + np.column_stack((out * ASIDE * np.cos(turned), -out * ASIDE * np.sin(turned) - BACK))
            for body in (shoulder, _shifted(shoulder, LATE)):  # bodies come later than their feet
                far = np.hypot(np.hypot(*(body - np.column_stack((place, held))).T), UP - bar.height)
                free &= (far <= settings.bar.let_go) & (np.abs(turned) < np.pi / 3)
        found += list(_pieces(times, _firm(free), place, side, settings.bar))
    return tuple(sorted(found, key=lambda g: (g.start, g.side)))


def _shifted(path: Array, seconds: float) -> Array:
    """A path (n, 2) so much later."""
    count = round(seconds * RATE)
    return np.concatenate((np.repeat(path[:1], count, axis=0), path[:-count]))[: len(path)]


def _firm(free: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Free also shortly before and after: hands leave early, for bodies turn before their feet land."""
    width = max(1, round(EARLY * RATE))
    return np.asarray(np.convolve(~free, np.ones(2 * width + 1), "same") < 0.5)


def _body(plan: Plan, bar: Bar, times: Array, settings: MotionSettings) -> tuple[Array, tuple[Array, Array]]:
    """Where the root will be, (n, 2), and how far the chest is turned from the screen, radians; roughly.

    The latter twice: as if turns were done at once when they begin, and not before they end.
    """
    feet = [foot_path(track, times, settings.step.heel_drop).ball[:, [0, 2]] for track in plan.feet]
    width = max(1, round(0.3 * RATE))
    kernel = np.ones(2 * width + 1) / (2 * width + 1)
    middle = (feet[0] + feet[1]) / 2
    held = np.concatenate((np.repeat(middle[:1], width, 0), middle, np.repeat(middle[-1:], width, 0)))
    root = np.column_stack([np.convolve(held[:, k], kernel, "valid") for k in (0, 1)])
    root = kept_back(root, np.ones(len(times)), bar, settings.bar)
    yaws = np.array([0.0, *(t.yaw for t in plan.turns)])
    limit = np.radians(settings.look.torso_limit)
    left = []
    for moments in ([t.start for t in plan.turns], [t.end for t in plan.turns]):
        yaw = yaws[np.searchsorted(np.array(moments), times, side="right")]
        yaw = (yaw + np.pi) % (2 * np.pi) - np.pi
        left.append(yaw - np.clip(yaw, -limit, limit))
    return root, (left[0], left[1])


def _busy(plan: Plan, times: Array, settings: MotionSettings) -> NDArray[np.bool_]:
    """Whether a hand is at a panel or on its way to or from it, or she walks; then both are off the bar."""
    out = np.zeros(len(times), dtype=bool)
    down, reach = settings.hands.reach_down, settings.bar.reach_time
    for press in plan.presses:
        first, last = press.start - down - reach, press.end + down + reach
        out[np.searchsorted(times, first) : np.searchsorted(times, last)] = True
    for walk in plan.walks:
        out[np.searchsorted(times, walk.start - reach) : np.searchsorted(times, walk.end + reach)] = True
    return out


def _pieces(times: Array, free: NDArray[np.bool_], place: Array, side: int, bar: BarSettings) -> Iterator[Grip]:
    """Grips in the stretches in which the rail is within reach, divided where the body has gone on along it."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], free, [False])).astype(np.int8))).reshape(-1, 2)
    least = max(1, round(bar.shortest * RATE))
    pause, ahead = max(1, round(bar.reach_time * RATE)), round(AHEAD * RATE)
    for first, end in _merged(edges, pause):
        start = first
        while end - start >= least:
            x = float(place[start : min(start + ahead, end)].mean())
            gone = np.flatnonzero(np.abs(place[start:end] - x) > bar.slack)
            stop = start + int(gone[0]) if len(gone) else end - 1
            if stop - start >= least:
                yield Grip(float(times[start]), float(times[stop]), side, x)
            start = stop + (pause if len(gone) else end)


def _merged(edges: NDArray[np.int64], pause: int) -> Iterator[tuple[int, int]]:
    """Stretches (first, end), each beginning late enough after the one before for a hand to go and come back."""
    last = -(10**9)
    for first, end in edges.tolist():
        first = max(first, last + pause)
        if first < end:
            yield first, end
            last = end


def _on_rail(x: Array, bar: Bar) -> Array:
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
    plan: Plan, at: Array, palms: Sequence[Array], down: Sequence[Array], wrists: Array, turn: Array,
    pinned: Array, elbows: Array, shoulders: Array, settings: MotionSettings,
) -> None:  # fmt: skip
    """Lead hands to the bar: change wrists (f, 2, 3), turn (f, 2, 4), pinned (f, 2) and elbows (f, 2, 3) in place.

    palms : (3,) of each hand, from the wrist to its palm in the hand's axes
    shoulders : (f, 2, 3), for on its way a hand goes around the body
    down : (4,) of each hand, the rotation of a hand whose palm faces the ground and whose fingers point back
    """
    if plan.bar is None:
        return
    bar, reach = plan.bar, settings.bar.reach_time
    goal, weight = np.zeros_like(wrists), np.zeros_like(pinned)
    dip = quat.from_axis_angle(np.array([1.0, 0.0, 0.0]), -np.radians(settings.bar.dip))
    for grip in plan.grips:
        near = slice(*np.searchsorted(at, (grip.start - reach, grip.end + reach)).tolist())
        hand = quat.multiply(dip, down[grip.side])
        out = quat.rotate(dip, np.array([0.0, bar.radius, 0.0]))  # from the rail's middle to where the palm lies on it
        wrist = np.array([grip.x, bar.height, bar.behind]) + out - quat.rotate(hand, palms[grip.side])
        share = _share(grip, at[near], reach)
        weight[near, grip.side] += share
        goal[near, grip.side] += share[:, None] * (wrist + [0.0, LIFT, 0.0] * (1.0 - share[:, None]))
        turn[near, grip.side] = hand
    weight = np.minimum(weight, 1.0)
    wrists += goal - weight[..., None] * wrists
    aside = shoulders[:, 0] - shoulders[:, 1]
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    around = AROUND * 4.0 * weight * (1.0 - weight)
    wrists += np.stack((around[:, :1] * aside, -around[:, 1:] * aside), axis=1)
    pinned[:] = np.maximum(pinned, weight)
    elbows += weight[..., None] * (ELBOWS - elbows)


def _share(grip: Grip, times: Array, reach: float) -> Array:
    return smooth((times - grip.start + reach) / reach) * smooth((grip.end + reach - times) / reach)
