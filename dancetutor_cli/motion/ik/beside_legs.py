"""Hands that hang keep off thighs and knees: in a wide stand these come up and aside to where hands hang."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.ik.knees import Legs, middle_joint, square_to
from dancetutor_cli.rig.capsules import KNEE, THIGH
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
HAND = 0.10  # metres from the wrist to the end of the hand
HALF_HAND = 0.026  # metres, half of how thick it is
SOFT = 0.012  # metres over which a hand comes to its least distance
ROUNDS, LEAST = 2, 1e-4  # of giving way; who gave way by fewer metres is left alone then


def beside_legs(wrists: Array, shoulders: Array, elbows: Array, legs: Legs, skeleton: Skeleton, room: float) -> Array:
    """How wrists (f, 2, 3) give way, (f, 2, 3), so that hands come off thighs, softly and with some room.

    shoulders : (f, 2, 3); elbows : (f, 2, 3) where they point
    """
    near, out = np.arange(len(wrists)), np.zeros_like(wrists)
    hips, thighs = legs.hips, legs.knees() - legs.hips
    for _ in range(ROUNDS):  # a forearm that was raised points another way
        place = (wrists + out)[near]
        given = np.zeros_like(place)
        for points in (_hand_ends(place, shoulders[near], elbows[near], skeleton), place):
            for side in (0, 1):
                given += _off_the_thigh(points + given, hips[near, None, side], thighs[near, None, side], room)
        out[near] += given
        near = near[np.abs(given).max(axis=(1, 2)) > LEAST]
    return out


def _hand_ends(wrists: Array, shoulders: Array, elbows: Array, skeleton: Skeleton) -> Array:
    """Where hands end (f, 2, 3) that go on as their forearms do; elbows : (f, 2, 3) where they point."""
    upper, lower = (float(np.linalg.norm(skeleton.offsets[skeleton.index(f"l_{n}")])) for n in ("elbow", "radiocarpal"))
    reach = wrists - shoulders
    forearm = reach - middle_joint(reach, square_to(reach, elbows), (upper, lower))
    return np.asarray(wrists + HAND * forearm / np.linalg.norm(forearm, axis=2, keepdims=True))


def _off_the_thigh(points: Array, hip: Array, thigh: Array, room: float) -> Array:
    """Ways (f, 2, 3) by which points (f, 2, 3) of hands come so far off a thigh that begins at a hip, (f, 1, 3)."""
    away = points - hip
    part = np.clip(np.sum(away * thigh, axis=2) / np.sum(thigh * thigh, axis=2), 0.0, 1.0)[..., None]
    way = away - part * thigh
    far = np.linalg.norm(way, axis=2, keepdims=True)
    least = THIGH + part * (KNEE - THIGH) + HALF_HAND + room
    missing = SOFT * np.logaddexp(0.0, (least - far) / SOFT)
    return np.asarray(way * (missing / np.maximum(far, 1e-3)))
