"""Which way pelvis, chest and head face: with the feet, and to the screen as far as they can (thesis 5.7)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.plan import Plan, Turn
from dancetutor_cli.motion.settings import MotionSettings
from dancetutor_cli.motion.trajectory.course import Course
from dancetutor_cli.motion.trajectory.crossing import crossing_share, turned_across
from dancetutor_cli.motion.trajectory.reach import press_share, turned_for_hands, wrapped
from dancetutor_cli.numerics.controller import Controller, follow
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import no_faster, smooth_path, upper_envelope

Array = NDArray[np.float64]
HELD, AROUND_QUICK = 1e-3, 0.5  # radians that a neck is held back; seconds around it that are softer


def pelvis_yaw(plan: Plan, times: Array, settings: MotionSettings) -> Array:
    """Yaw (n,) of the pelvis at even times, radians, unwrapped: it turns with the steps, and for hands behind it."""
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
    """Yaw (n,) from a place on the ground (n, 2) to the screen."""
    return np.asarray(np.arctan2(-0.5 * ground[:, 0], settings.look.distance - ground[:, 1]))


def chest_and_head(plan: Plan, course: Course, ahead: Array, settings: MotionSettings) -> tuple[Array, Array]:
    """Yaws (n,) of chest and head: they keep to the screen as far as they can; turned farther away, she looks whereto
    she turns.

    ahead (n,) : how much she looks where she walks and not at the screen
    """
    look, ones = settings.look, np.ones(len(course.yaw))
    to_screen = screen_yaw(course.ground, settings)
    gap = wrapped(to_screen - course.yaw)
    torso = np.clip(look.torso_weight * gap, -np.radians(look.torso_limit), np.radians(look.torso_limit))
    torso = torso * smooth(
        (np.pi - np.abs(gap)) / np.radians(look.wrung)
    )  # a spine is not wrung from one side to the other at once
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
    return chest, chest + smooth_path(head[:, None], ones, course.rate, settings.inertia.head_turn)[:, 0]


def head_held(head: Array, chest: Array, rate: float, settings: MotionSettings) -> Array:
    """Yaw (n,) of a head whose neck can follow: it turns from the chest, which has turned against the legs and with the
    beat meanwhile, no faster and no farther than necks do; rate : samples per second."""
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
    """How far (n,) the head would turn from the chest, radians, where the screen is `gap` (n,) from that."""
    look = settings.look
    to_screen = np.clip(look.head_weight * gap, -np.radians(look.head_limit), np.radians(look.head_limit))
    away = away_from_screen(gap, settings)
    coming = np.interp(course.times + look.head_leads, course.times, course.yaw) - course.yaw
    return np.asarray(to_screen + away * (np.radians(look.head_lead) * np.tanh(coming) - to_screen))


def away_from_screen(gap: Array, settings: MotionSettings) -> Array:
    """How far (n,) she has given up looking at a screen that is `gap` (n,) radians from her chest, 0 to 1."""
    first, last = np.radians(settings.look.away_from), np.radians(settings.look.away_to)
    return np.asarray(smooth((np.abs(gap) - first) / (last - first)))
