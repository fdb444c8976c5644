"""The directions of pelvis, chest and head; bends for palms, turns for the bar, and leaning on it."""

from __future__ import annotations

import numpy as np

from dancetutor_cli.dance.motion import Grip
from dancetutor_cli.dance.plan import Plan, Press, Turn
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_arms import AcrossSettings, BarSettings, HandSettings
from dancetutor_cli.dance.smoothing import (
    Controller,
    follow,
    no_faster,
    smooth,
    smooth_path,
    upper_envelope,
)
from dancetutor_cli.dance.trajectory.legs import Course
from dancetutor_cli.dance.units import Array, Flags

# The bends and turns of the body for palms that go down to panels.

Presses = tuple[Press, ...]


def press_share(press: Press, times: Array, down: float) -> Array:
    """Return the share of a press at each time, 0 to 1; it is 1 from the start to the end of the press."""
    return smooth((times - press.start + down) / down) * smooth((press.end + down - times) / down)


def reaching(presses: Presses, times: Array, hands: HandSettings) -> Array:
    """Return how far (n, 2) the body has bent for each hand, 0 to 1."""
    out = np.zeros((len(times), 2))
    for press in presses:
        out[:, press.side] = np.maximum(out[:, press.side], press_share(press, times, hands.reach_down))
    return out


def bent_down(presses: Presses, deeper: Array, times: Array, hands: HandSettings) -> Array:
    """Return (n, 2): how far the body has gone down to the floor, 0 to 1, and how much deeper than usual, metres.

    deeper : (p,) metres for each press
    """
    out = np.zeros((len(times), 2))
    for k, press in enumerate(presses):
        share = press_share(press, times, hands.reach_down)
        more = share > out[:, 0]
        out[more, 0] = share[more]
        out[:, 1] = np.maximum(out[:, 1], share * float(deeper[k]))
    return out


def turned_for_hands(presses: Presses, times: Array, hands: HandSettings) -> Array:
    """Return how far (n,) the body turns to the side of a hand that reaches behind it, radians."""
    out = np.zeros(len(times))
    for press in presses:
        if press.turn != 0.0:
            out += press.turn * press_share(press, times, hands.reach_down)
    return out


def leaning_tilt(presses: Presses, course: Course, chest: Array, lean: Array, settings: MotionSettings) -> Array:
    """Return the lean of the chest (n, 2), a horizontal direction times an angle: towards each panel that a hand
    presses.

    chest : (n,) yaw of the chest; lean : (n, 2) the lean where no hand reaches, in the same form
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
    """Return the same angles between half a turn to the right and half a turn to the left, radians."""
    return np.asarray((angle + np.pi) % (2 * np.pi) - np.pi)


# Turns in which the far hand crosses over to the bar. During a turn, trunk and chest turn and lean towards the bar.


def crossing_share(grips: tuple[Grip, ...], times: Array, numbers: AcrossSettings) -> Array:
    """Return how far (n,) the body has turned and leaned for a hand that crosses over, -1 to 1.

    It is 1 or -1 from a little before the hand is at the bar until a little after. It is positive if the dancer is
    turned to the left, so that the right hand is the far one.
    """
    out, ease = np.zeros(len(times)), max(numbers.ease, 1e-6)
    for grip in grips:
        if grip.across:
            first, last = grip.start - numbers.early, grip.end + numbers.early
            share = smooth((times - first + ease) / ease) * smooth((last + ease - times) / ease)
            out = np.where(share > np.abs(out), (1.0 if grip.side == 1 else -1.0) * share, out)
    return out


def turned_across(torso: Array, yaw: Array, share: Array, numbers: AcrossSettings) -> Array:
    """Return how far (n,) the chest turns from a pelvis of yaw (n,), radians; `torso` (n,) is the turn without
    crossing.

    The chest turns until it faces along the rail and a little towards it, as far as a trunk turns.
    """
    most = np.radians(numbers.twist)
    goal = np.clip(wrapped(np.copysign(np.radians(numbers.facing), share) - yaw), -most, most)
    return np.asarray(torso + np.abs(share) * (goal - torso))


def leaned_across(share: Array, numbers: AcrossSettings) -> Array:
    """Return the lean of the chest to the bar (n, 2), a horizontal direction times an angle."""
    return np.outer(np.abs(share) * np.radians(numbers.lean), [0.0, -1.0])


# The directions of pelvis, chest and head: with the feet, and to the screen as far as they can (thesis 5.7).

HELD, AROUND_QUICK = 1e-3, 0.5  # radians by which a neck is held back; seconds around such moments that are smoothed


def pelvis_yaw(plan: Plan, times: Array, settings: MotionSettings) -> Array:
    """Return the yaw (n,) of the pelvis at even times, radians, unwrapped. It turns with the steps, and for hands
    behind it.
    """
    turned = _turned(plan.turns, times) + turned_for_hands(plan.presses, times, settings.hands)
    rate = 1.0 / float(times[1] - times[0])
    return np.asarray(smooth_path(turned[:, None], np.ones(len(times)), rate, settings.inertia.pelvis_turn)[:, 0])


def _turned(turns: tuple[Turn, ...], times: Array) -> Array:
    if not turns:
        return np.zeros_like(times)
    start = np.array([t.start for t in turns])
    end = np.array([t.end for t in turns])
    yaw = np.array([0.0, *(t.yaw for t in turns)])
    i = np.maximum(np.searchsorted(start, times, side="right") - 1, 0)
    s = (times - start[i]) / (end[i] - start[i])
    return np.asarray(yaw[i] + smooth(s) * (yaw[i + 1] - yaw[i]))


def screen_yaw(ground: Array, settings: MotionSettings) -> Array:
    """Return the yaw (n,) from a place on the ground (n, 2) to the screen."""
    return np.asarray(np.arctan2(-0.5 * ground[:, 0], settings.look.distance - ground[:, 1]))


def chest_and_head(plan: Plan, course: Course, ahead: Array, settings: MotionSettings) -> tuple[Array, Array]:
    """Return the yaws (n,) of chest and head. They face the screen as far as they can; beyond that, they face the turn.

    ahead : (n,) how much the dancer looks where she walks, instead of at the screen
    """
    look, ones = settings.look, np.ones(len(course.yaw))
    to_screen = screen_yaw(course.ground, settings)
    gap = wrapped(to_screen - course.yaw)
    torso = np.clip(look.torso_weight * gap, -np.radians(look.torso_limit), np.radians(look.torso_limit))
    torso = torso * smooth(
        (np.pi - np.abs(gap)) / np.radians(look.wrung)
    )  # a spine does not turn from one side to the other at once
    torso = torso * (1.0 - ahead)
    for press in (p for p in plan.presses if p.turn != 0.0):  # the chest turns to the hand, not to the screen
        share = press_share(press, course.times, settings.hands.reach_down)
        torso = torso + share * (np.copysign(np.radians(look.torso_limit), press.turn) - torso)
    share = crossing_share(plan.grips, course.times, settings.across)
    torso = turned_across(torso, course.yaw, share, settings.across)
    controller = Controller.of(settings.inertia.chest_frequency, settings.inertia.chest_damping)
    smoothed = smooth_path(torso[:, None], ones, course.rate, settings.inertia.chest_turn)
    chest = course.yaw + follow(smoothed, course.rate, controller)[:, 0]
    head = _head(wrapped(to_screen - chest), course, settings) * (1.0 - settings.walk.ahead * ahead)
    head = no_faster(head, course.rate, np.radians(look.head_rate))
    neck, most = smooth_path(head[:, None], ones, course.rate, settings.inertia.head_turn)[:, 0], look.head_limit
    return chest, chest + np.clip(neck, -np.radians(most), np.radians(most))


def limit_head_yaw(head: Array, chest: Array, rate: float, settings: MotionSettings) -> Array:
    """Return the yaw (n,) of a head that the neck can follow. rate : samples per second

    The head turns from the chest, which has turned against the legs and with the beat. It turns no faster and no
    farther than necks do.
    """
    look, neck = settings.look, head - chest
    most = np.radians(look.head_limit)
    held = no_faster(np.clip(neck, -most, most), rate, np.radians(look.head_rate))
    quick = (np.abs(held - neck) > HELD).astype(np.float64)
    if not quick.any():
        return head
    soft = smooth_path(held[:, None], np.ones(len(head)), rate, settings.inertia.head_turn)[:, 0]
    share = upper_envelope(np.arange(len(head)) / rate, quick, AROUND_QUICK)
    return np.asarray(head + share * (soft - neck))


def _head(gap: Array, course: Course, settings: MotionSettings) -> Array:
    """Return how far (n,) the head would turn from the chest, radians, if the screen is `gap` (n,) from the chest."""
    look = settings.look
    to_screen = np.clip(look.head_weight * gap, -np.radians(look.head_limit), np.radians(look.head_limit))
    away = away_from_screen(gap, settings)
    coming = np.interp(course.times + look.head_leads, course.times, course.yaw) - course.yaw
    return np.asarray(to_screen + away * (np.radians(look.head_lead) * np.tanh(coming) - to_screen))


def away_from_screen(gap: Array, settings: MotionSettings) -> Array:
    """Return how far (n,) the dancer looks away from a screen `gap` (n,) radians from her chest, 0 to 1."""
    first, last = np.radians(settings.look.away_from), np.radians(settings.look.away_to)
    return np.asarray(smooth((np.abs(gap) - first) / (last - first)))


# The body leans on the bar: it stays within reach of the bar while hands hold it.


def leaning_share(grips: tuple[Grip, ...], times: Array, settings: BarSettings) -> Array:
    """Return how much the body leans on the bar (n,), 0 to 1: 1 while hands hold it or take it again."""
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


def has_hand_on_bar(grips: tuple[Grip, ...], times: Array) -> Flags:
    """Return whether a hand holds the bar at the times (n,)."""
    out = np.zeros(len(times), dtype=bool)
    for grip in grips:
        out |= (times >= grip.start) & (times <= grip.end)
    return out
