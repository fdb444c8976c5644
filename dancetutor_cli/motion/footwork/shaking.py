"""Legs shaken out in waits: a foot hangs loosely in the air behind her for a moment, the weight on the other one. Ahead
of her it would look like a step."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.foot_moves import Bulge, Shake
from dancetutor_cli.motion.footwork.footfalls import Stand, standing
from dancetutor_cli.motion.footwork.walks import waits
from dancetutor_cli.motion.plan import Plan

Array = NDArray[np.float64]
SEED = 20210423
LEAST = 0.3  # seconds of a shake, and from one to the next


def leg_shakes(plan: Plan, mines: Array, context: Context) -> list[tuple[int, Shake]]:
    """Which foot, 0 left, is shaken when and how, in all waits that are long enough; mines : (m,) seconds.

    Chance decides, always in the same way for the same song; in its mirror image it is the other foot.
    """
    loose, found = context.settings.loose, []
    for number, (free, lift) in enumerate(waits(plan, mines, loose.least)):
        chance = np.random.default_rng([SEED, round(1000 * plan.first), round(1000 * plan.last) & 0xFFFFFFFF, number])
        time, side = free + loose.pause * chance.uniform(1.0, 2.0), int(chance.integers(2))
        while True:
            legs = 2 if chance.random() < loose.both else 1
            wanted = chance.random() < loose.share
            for leg in range(legs):
                foot = (side + leg) % 2 ^ plan.lead
                shake = _shake(foot, time, standing(plan.feet, time), chance, context)
                if shake.land > lift - loose.ready:
                    break
                if wanted and not _moves(plan, shake.lift - loose.between, shake.land + loose.between):
                    found.append((foot, shake))
                time = shake.land + loose.between
            else:
                side ^= legs % 2
                time += max(loose.every, LEAST) * chance.uniform(0.7, 1.3)
                continue
            break
    return found


def _shake(foot: int, lift: float, stand: Stand, chance: np.random.Generator, context: Context) -> Shake:
    """One leg's, from `lift` on: never twice as long, as high or as quick."""
    loose, step = context.settings.loose, context.settings.step
    long = max(loose.up + chance.uniform(loose.shortest, loose.longest), LEAST)
    ball, yaw = stand.balls[foot], float(stand.yaws[foot])
    inward = (-1.0, 1.0)[foot] * np.array([np.cos(stand.heading), -np.sin(stand.heading)])
    away, behind = loose.inward * inward, loose.behind * chance.uniform(0.85, 1.0)
    lifted, hangs = np.radians(step.lift_pitch), np.radians(loose.hangs * chance.uniform(0.9, 1.1))
    return Shake(
        lift,
        lift + long,
        (float(ball[0]), float(ball[1])),
        yaw,
        (float(lifted), float(lifted), float(np.radians(step.land_pitch)), 0.0),
        loose.height * chance.uniform(0.8, 1.25),
        Bulge(float(away[0]), float(away[1])),
        behind=behind,
        hangs=float(hangs),
        rate=loose.rate * chance.uniform(0.85, 1.15),
        far=loose.far * chance.uniform(0.75, 1.25),
        flap=float(np.radians(loose.flap * chance.uniform(0.75, 1.25))),
        heading=stand.heading,
    )


def _moves(plan: Plan, start: float, end: float) -> bool:
    """Whether a foot moves at all between two seconds, if it only turns."""
    return any(move.lift < end and move.land > start for track in plan.feet for move in track.moves)
