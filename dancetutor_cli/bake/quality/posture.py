"""How she stands, jumps and waits, in the numbers that an eye judges by; most of them have no goal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import Body, intervals
from dancetutor_cli.bake.quality.smoothness import knee_angles
from dancetutor_cli.motion.baked import Contact
from dancetutor_cli.play.played import StepKind
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
WRIST, TURN = 4.0, 650.0  # metres per second that a wrist goes at most; degrees per second that the pelvis turns
NECK = 80.0  # degrees that a neck turns the head from the chest
JUMP, BEFORE = 0.15, 0.35  # seconds in the air, and on the ground before it, of a jump that legs have time for
FOLD, GIVE = 0.5, 0.16  # the middle half of a flight; seconds after landing in which knees give
WAIT = 4.5  # seconds without a note that are a wait
HOME, READY = 2.5, 1.0  # seconds of its beginning and its end in which she steps


def posture_figures(body: Body, skeleton: Skeleton, contacts: tuple[Contact, ...]) -> tuple[Figure, ...]:
    """Flexion of the knees and lean of the trunk, the legs' part in jumps, speeds of wrists and pelvis, weight in
    waits."""
    knees = 180.0 - knee_angles(body, skeleton)
    off, fold, give = _medians(jump_knees(body, knees))
    shift = weight_shifts(body, contacts)
    wrists = np.maximum.reduce([speeds(body, skeleton.index(f"{s}_radiocarpal")) for s in "lr"])
    turning = np.abs(np.diff(pelvis_yaw(body, skeleton))) * body.rate
    neck = neck_yaw(body, skeleton)
    whipped = np.abs(np.diff(np.unwrap(neck))) * body.rate
    return (
        Figure("knee flexion, median", float(np.median(knees)), "degrees"),
        Figure("trunk lean, median", float(np.median(trunk_lean(body, skeleton))), "degrees"),
        Figure("knee flexion at take-off", off, "degrees"),
        Figure("knee flexion in the air", fold, "degrees"),
        Figure("knee flexion after landing", give, "degrees"),
        Figure("wrist speed", float(wrists.max(initial=0.0)), "m/s", WRIST),
        Figure("pelvis turns at", float(np.degrees(turning.max(initial=0.0))), "degrees/s", TURN),
        Figure("head from the chest", float(np.degrees(np.abs(neck).max(initial=0.0))), "degrees", NECK),
        Figure("head turns on the chest at", float(np.degrees(whipped.max(initial=0.0))), "degrees/s"),
        Figure("weight shift in waits", 100.0 * float(np.median(shift)) if len(shift) else float("nan"), "cm"),
    )


def _medians(jumps: Array) -> tuple[float, float, float]:
    if not len(jumps):
        return float("nan"), float("nan"), float("nan")
    off, fold, give = np.median(jumps, axis=0)
    return float(off), float(fold), float(give)


def jump_knees(body: Body, knees: Array) -> Array:
    """Flexion (k, 3) in degrees, mean of both knees, of jumps with time.

    The least as the toes leave, the most in the middle of the flight, and the most as they give after it.
    """
    flying = intervals(np.asarray(~body.standing.any(axis=1)))
    mean, frames, out, landed = knees.mean(axis=1), body.rate, [], 0
    for first, end in flying:
        rested, landed = first - landed, end
        if first == 0 or end == len(mean) or (end - first) / frames < JUMP or rested / frames < BEFORE:
            continue
        quarter = int((end - first) * (1.0 - FOLD) / 2)
        out.append(
            (
                mean[first - 1 : first + 1].min(),
                mean[first + quarter : end - quarter].max(),
                mean[end : end + int(GIVE * frames)].max(),
            )
        )
    return np.array(out).reshape(-1, 3)


def trunk_lean(body: Body, skeleton: Skeleton) -> Array:
    """Angle (f,) in degrees between upright and the line from the hips' middle to the shoulders' middle."""
    hips, shoulders = (
        (body.joints[:, skeleton.index(f"l_{n}")] + body.joints[:, skeleton.index(f"r_{n}")]) / 2
        for n in ("hip", "shoulder")
    )
    up = shoulders - hips
    return np.asarray(np.degrees(np.arctan2(np.hypot(up[:, 0], up[:, 2]), up[:, 1])))


def speeds(body: Body, joint: int) -> Array:
    """Speed (f - 1,) of a joint, metres per second."""
    return np.asarray(np.linalg.norm(np.diff(body.joints[:, joint], axis=0), axis=1) * body.rate)


def pelvis_yaw(body: Body, skeleton: Skeleton) -> Array:
    """Which way (f,) the pelvis faces, radians, unwrapped: square to the line between the hips."""
    across = body.joints[:, skeleton.index("l_hip")] - body.joints[:, skeleton.index("r_hip")]
    return np.unwrap(np.arctan2(-across[:, 2], across[:, 0]))


def neck_yaw(body: Body, skeleton: Skeleton) -> Array:
    """How far (f,) the face is turned from where the chest faces, radians, positive left."""
    neck, skull = (body.rotations[:, skeleton.index(name)] for name in ("vc4", "skullbase"))
    face = quat.rotate(quat.multiply(neck, skull), np.array([0.0, 0.0, 1.0]))
    return np.asarray(np.arctan2(face[:, 0], face[:, 2]))


def weight_shifts(body: Body, contacts: tuple[Contact, ...]) -> Array:
    """How far (w,) in metres the pelvis goes to and fro over the ground in each wait between notes, its ends left
    out."""
    ends = [c.end if c.kind == StepKind.HOLD else c.start for c in contacts]  # a foot may stay after a tap
    busy = sorted({(c.start, float(min(end, body.times[-1]))) for c, end in zip(contacts, ends, strict=True)})
    out, free = [], -np.inf
    for start, end in busy:
        if WAIT <= start - free < np.inf:  # before the first note she walks on
            inner = (body.times > free + HOME) & (body.times < start - READY)
            if inner.any():
                place = body.joints[inner, 0][:, [0, 2]]
                out.append(float(np.ptp((place - place.mean(axis=0)) @ _main_way(place))))
        free = max(free, end)
    return np.array(out)


def _main_way(places: Array) -> Array:
    """Unit vector (2,) along which places (n, 2) differ most."""
    return np.asarray(np.linalg.svd(places - places.mean(axis=0), full_matrices=False)[2][0])
