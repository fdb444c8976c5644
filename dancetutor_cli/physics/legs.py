"""Legs that do not pop: near the full stretch a leg comes to its end slower and slower, and the body gives the rest.

Popping is a question of millimetres: a leg at 170 degrees is 0.4 % shorter than a straight one. A foot in the air comes
nearer by them; over a foot that stands the pelvis sinks, early and smoothly.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.numerics.smoothing import upper_envelope
from dancetutor_cli.physics.repin import AnkleTracks, Leg
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
FROM, TO = np.radians(22.0), np.radians(7.0)  # bends of a knee: where the stretch grows slower, and where it ends
ROUND = 0.01  # metres over which a foot in the air begins to come nearer
SLOWLY = 0.20  # seconds that the last of a stretch takes to come and to go
SINK = 0.25  # seconds over which the pelvis sinks


def soft_legs(
    skeleton: Skeleton, poses: tuple[Array, Array], feet: AnkleTracks, held: Array, times: Array
) -> tuple[Array, AnkleTracks]:
    """Root (f, 3) and feet with which no knee pops.

    poses : local rotations (f, j, 4), of which the pelvis counts, and root (f, 3); held : (f, 2) how far feet stand
    """
    pelvis, root = poses[0][:, 0], poses[1].copy()
    legs = [Leg(skeleton, s) for s in "lr"]
    hips = [quat.rotate(pelvis, skeleton.offsets[leg.hip]) for leg in legs]
    sink, reach = np.zeros(len(root)), []
    for side, (leg, hip) in enumerate(zip(legs, hips, strict=True)):
        way = feet.places[:, side] - root - hip
        aside = np.minimum(np.hypot(way[:, 0], way[:, 2]), 0.85 * leg.longest)
        wanted = _soft(leg, np.linalg.norm(way, axis=1), times)
        reach.append(wanted)
        drop = -way[:, 1] - np.sqrt(np.maximum(wanted**2 - aside**2, 0.0))
        sink = np.maximum(sink, held[:, side] * drop)
    root[:, 1] -= upper_envelope(times, sink, SINK)
    places = feet.places.copy()
    for side, hip in enumerate(hips):
        start = root + hip
        way = places[:, side] - start
        far = np.linalg.norm(way, axis=1)
        less = (far - reach[side]) / 2
        short = less + np.hypot(less, ROUND * (1.0 - held[:, side]) / 2)  # 0 below the reach, without an edge
        short = np.where(held[:, side] < 1.0, short, np.maximum(2 * less, 0.0))
        places[:, side] -= way * (short / np.maximum(far, 1e-9))[:, None]
    return root, AnkleTracks(places, feet.turns)


def _soft(leg: Leg, distance: Array, times: Array) -> Array:
    """How far (f,) hip and ankle shall be apart that are `distance` (f,) metres apart.

    Never so far as a straight leg; and what is left of the stretch comes and goes slowly, so that a pop is none.
    """
    start, end = leg.length(FROM), leg.length(TO)
    over = np.maximum(distance - start, 0.0)
    near = start + (end - start) * (1 - np.exp(-over / (end - start)))
    stretch = np.where(distance > start, FROM - leg.bent(near), 0.0)
    most = FROM - TO
    slow = most - upper_envelope(times, most - stretch, SLOWLY)
    return np.asarray(np.where(distance > start, leg.lengths(FROM - np.maximum(slow, 0.0)), distance))
