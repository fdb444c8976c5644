"""The body over its legs: its course, its height within their reach, heels at take-off."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.foot_path import Feet, FootPath
from dancetutor_cli.dance.plan import Jump, Plan
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import centre_of_mass, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.trajectory.height import time_for_jumps
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb, Part

# The path and direction of the body over the ground; its height, chest and arms follow from them.


@dataclass(frozen=True, slots=True)
class Course:
    """The body over the ground at n even times.

    times : (n,) seconds; mass : (n, 2), x and z of the centre of mass; above : (n, 3), from the root to the centre of
    mass, as far as known; hips : (n, 2, 3), from the root to each hip; yaw : (n,) of the pelvis, radians, unwrapped
    """

    times: Array
    mass: Array
    above: Array
    hips: Array
    yaw: Array

    @property
    def rate(self) -> float:
        """Samples per second."""
        return 1.0 / float(self.times[1] - self.times[0])

    @property
    def ground(self) -> Array:
        """The place (n, 2) of the root, x and z."""
        return np.asarray(self.mass - self.above[:, [0, 2]])


# The height of the root at which legs reach their feet.


def leg_room(feet: Feet, course: Course, skeleton: Skeleton, reach: Array | float, side: int) -> Array:
    """Return the highest root (n,) from which one leg reaches its foot, with hip and ankle at most `reach` apart."""
    hip, ankle = hip_over(course, side), ankle_of(feet[side], skeleton, side)
    aside = np.hypot(hip[:, 0] - ankle[:, 0], hip[:, 1] - ankle[:, 2])
    down = course.hips[:, side, 1]
    return np.asarray(ankle[:, 1] + np.sqrt(np.maximum(np.square(reach) - aside**2, 0.05)) - down)


def hip_over(course: Course, side: int) -> Array:
    """Return the place (n, 2) of a hip over the ground, x and z."""
    return np.asarray(course.ground + course.hips[:, side, ::2])


def upright_hips(yaw: Array, skeleton: Skeleton) -> Array:
    """Return the vectors (n, 2, 3) from the root to each hip of an upright pelvis with yaw (n,)."""
    turned = quat.from_axis_angle(quat.UP, yaw)
    return np.stack([quat.rotate(turned, skeleton.offsets[skeleton.index(f"{s}_hip")]) for s in "lr"], axis=1)


def ankle_of(foot: FootPath, skeleton: Skeleton, side: int) -> Array:
    """Return the world position (f, 3) of the ankle joint of a foot."""
    meta = skeleton.offsets[skeleton.index(f"{'lr'[side]}_metatarsal")]
    up = skeleton.rest[skeleton.index(f"{'lr'[side]}_metatarsal")][1]
    sine, cosine = np.sin(foot.pitch), np.cos(foot.pitch)
    y = -meta[1] * cosine + meta[2] * sine  # the ankle from the joint of the ball, heel up by pitch
    z = -meta[1] * sine - meta[2] * cosine
    x = -meta[0]
    out = foot.ball.copy()
    out[:, 0] += x * np.cos(foot.yaw) + z * np.sin(foot.yaw)
    out[:, 1] += up + y
    out[:, 2] += -x * np.sin(foot.yaw) + z * np.cos(foot.yaw)
    return out


# Heels that rise unevenly at take-off: the leg with the longer way to its foot gets the missing length from its heel.
#
# Over feet that stand apart, one hip is farther from its ankle than the other. The reach of one leg holds the body
# down, and the other leg would leave the ground on a bent knee. So the heel of the farther foot rises farther, until
# both legs are equally long as the toes leave.

STEP = np.radians(0.25)  # radians between pitches that are tried
JUMP_WINDOW = 0.05  # seconds between the feet; if one leaves earlier, the other one pushes alone


def raised(feet: Feet, up: Array) -> Feet:
    """Return the same feet with their heels higher by (n, 2) radians."""
    left, right = (replace(foot, pitch=foot.pitch + up[:, side]) for side, foot in enumerate(feet))
    return left, right


def heels_may_rise(plan: Plan, times: Array, down: float) -> Array:
    """Return how much (n, 2) each heel may rise for the ankle, 0 to 1; 0 while the heel presses a panel.

    down : seconds in which the heel comes down before a press
    """
    out = np.ones((len(times), 2))
    for contact in (c for c in plan.contacts if c.limb < Limb.LEFT_HAND and c.part == Part.HEEL):
        away = np.maximum(contact.start - times, times - contact.end)
        out[:, contact.limb] = np.minimum(out[:, contact.limb], smooth(away / down))
    return out


def push_off(plan: Plan, times: Array, feet: Feet, hips: Array, context: Context) -> Array:
    """Return how much farther (n, 2) heels rise at take-off, radians.

    times : (n,) even; feet : at these times, with heels already raised for their ankles
    hips : (n, 2, 3) places of both hips in a rough bake
    """
    jump, out = context.settings.jump, np.zeros((len(times), 2))
    flights = plan.flights
    for (start, end), share in zip(flights, time_for_jumps(flights, jump)[0], strict=True):
        lifts = _lifts(plan, start)
        if share <= 0.0 or lifts is None:
            continue
        k = int(np.clip(np.searchsorted(times, start), 1, len(times) - 1)) - 1
        side, pitch = _more(_at(feet, k), hips[k], np.radians(jump.heel_most), context.skeleton)
        rising = max(jump.heel_up, 1e-6)
        near = slice(*np.searchsorted(times, (lifts[side] - rising, end)))
        shape = smooth((times[near] - lifts[side] + rising) / rising)
        shape *= smooth((end - times[near]) / (end - start))
        out[near, side] = np.maximum(out[near, side], share * pitch * shape)
    up = np.column_stack([foot.pitch for foot in feet])
    return np.asarray(np.minimum(out, np.maximum(np.radians(jump.heel_most) - up, 0.0)))


def _lifts(plan: Plan, start: float) -> tuple[float, float] | None:
    """Return when each foot leaves the ground for the jump whose flight begins at `start`; None if not both push."""
    out = []
    for track in plan.feet:
        lifts = [m.lift for m in track.moves if isinstance(m, Jump) and m.lift <= start + 1e-6 < m.land]
        if not lifts or start - lifts[-1] > JUMP_WINDOW:
            return None
        out.append(lifts[-1])
    return out[0], out[1]


def _at(feet: Feet, k: int) -> Feet:
    """Return both feet at one of their times only."""
    left, right = (_taken(foot, [k]) for foot in feet)
    return left, right


def _taken(foot: FootPath, at: list[int]) -> FootPath:
    return FootPath(foot.ball[at], foot.yaw[at], foot.pitch[at], foot.down[at], foot.progress[at])


def _more(feet: Feet, hips: Array, most: float, skeleton: Skeleton) -> tuple[int, float]:
    """Return the foot whose heel rises farther, and the radians. hips : (2, 3); most : largest pitch of a heel"""
    far = [float(np.linalg.norm(hips[s] - ankle_of(feet[s], skeleton, s)[0])) for s in (0, 1)]
    side = int(far[1] > far[0])
    tried = np.arange(0.0, max(most - float(feet[side].pitch[0]), STEP), STEP)
    foot = _taken(feet[side], [0] * len(tried))
    legs = np.linalg.norm(hips[side] - ankle_of(replace(foot, pitch=foot.pitch + tried), skeleton, side), axis=1)
    return side, float(tried[int(np.argmin(np.abs(legs - far[1 - side])))])


def above_at_rest(skeleton: Skeleton) -> Array:
    """Return the vector (3,) from the root up to the height of the centre of mass in the rest pose, metres."""
    rest = np.tile(quat.IDENTITY, (1, len(skeleton.names), 1))
    mass = centre_of_mass(skeleton, *world_transforms(skeleton, rest, skeleton.offsets[None, 0]))
    return np.asarray((mass[0] - skeleton.offsets[0]) * [0.0, 1.0, 0.0])
