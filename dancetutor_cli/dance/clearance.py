"""The path of a foot in the air: its pace, and its detour around the standing foot, which is as small as possible."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dancetutor_cli.dance.context import HALF_PANEL
from dancetutor_cli.dance.plan import STRAIGHT, Bulge
from dancetutor_cli.dance.rig.body import BALL_AHEAD, HALF_SHOE, SHOE_OUTLINE, ball_to_ankle
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.settings_feet import StepSettings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.kernels.compiling import njit, njit_inner

# How far a swing has come at each part of its time, and how much it is reduced if time is short.


def reduction(duration: ArrayLike, fast: float, longest: float) -> Array:
    """Return how much lack of time reduces a move: 0 at `longest`, 1 at `fast` or less, as a cube (thesis 5.6.1)."""
    s = np.clip((longest - np.asarray(duration, dtype=np.float64)) / max(longest - fast, 1e-9), 0.0, 1.0)
    return np.asarray(s**3)


def evenness(duration: ArrayLike, step: StepSettings) -> Array:
    """Return how evenly a foot moves in a step of `duration` seconds: 0 slow at both ends, 1 at one speed."""
    missing = step.even_slow - np.asarray(duration, dtype=np.float64)
    return np.asarray(np.clip(missing / max(step.even_slow - step.even_quick, 1e-9), 0.0, 1.0))


def travel_share(s: ArrayLike, step: StepSettings, even: ArrayLike = 0.0, low: ArrayLike = 0.0) -> Array:
    """Return how far over the ground a swing has come at each part of its time.

    A cubic, slow at both ends: of the curves from rest to rest that were tried, its quick parts throw the body aside
    least. That holds for steps longer than a tenth of a second. Shorter ones go at one speed: the heavy body does not
    react to what their ends do.

    even : as of `evenness`; low : the last part of the time, in which the foot comes straight down, if that part is
    longer than in an even step
    """
    share = np.asarray(even, dtype=np.float64)
    late = np.maximum(step.on_ground * share, low)
    free = np.clip((np.asarray(s, dtype=np.float64) - step.off_ground) / (1.0 - step.off_ground - late), 0.0, 1.0)
    slow = free * free * (3.0 - 2.0 * free)
    return np.asarray(slow + share * (_at_one_speed(free, step.even_ends) - slow))


def _at_one_speed(s: Array, ends: float) -> Array:
    """Return a way from rest to rest that gains and loses its speed in a part `ends` of the time at both ends."""
    speed = 1.0 / (1.0 - ends)
    first, last = np.minimum(s, ends), np.maximum(s - (1.0 - ends), 0.0)
    return np.asarray(speed * (s - ends / 2 + ((ends - first) ** 2 - last**2) / (2.0 * ends)))


def rise_share(s: Array, step: StepSettings, even: ArrayLike = 0.0) -> Array:
    """Return how high a foot is in a step, 0 to 1, at each part of its time; it meets the ground at a definite speed.

    It is up a little late and comes down quickly: a foot that sinks onto its panel is not seen to step on it.

    The more evenly it moves, the sooner it is up and the later it is down, because a foot near the ground must not
    slide.
    """
    shape = np.sin(np.pi * s**step.rising * (1.0 - step.falling * (1.0 - s)))
    return np.asarray(shape + step.even_up * np.asarray(even, dtype=np.float64) * (hovering(s) - shape))


def hovering(s: Array) -> Array:
    """Return how high a foot is, 0 to 1, that rises at once and lands late."""
    return np.asarray(1.0 - (2.0 * s - 1.0) ** 4)


def turn_share(s: ArrayLike, step: StepSettings) -> Array:
    """Return how far a foot has turned at each part of its swing; it ends its turn a little before it lands."""
    return smooth(np.asarray(s, dtype=np.float64) / step.turned)


# A swinging foot goes around the standing one: shoes are capsules, and the path bends as little as necessary.

LATE_PRICE = 1.0  # metres of detour with the same weight as a foot that is late by the whole way


def _ways(sides: ArrayLike, ahead: int, late: tuple[float, ...]) -> Array:
    """Return detours (k, 3), smallest first: metres aside and ahead at the middle, and lateness as in `Bulge`."""
    grid = np.meshgrid(sides, np.arange(-ahead, ahead + 1) * 0.06, late)
    ways = np.column_stack([axis.ravel() for axis in grid])
    return np.asarray(ways[np.argsort(np.abs(ways) @ [1.0, 1.0, LATE_PRICE], kind="stable")])


_WAYS = (  # far detours, and late ones, which are quick in between, are tried only if no other one fits
    _ways(np.arange(-12, 13) * 0.03, 2, (0.0,)),
    _ways(np.arange(-16, 17) * 0.03, 5, (0.0,)),
    _ways(np.arange(-8, 9) * 0.06, 4, (0.08, 0.16, 0.24, 0.36)),
)
SHARES = np.linspace(0.05, 0.95, 37)  # parts of a swing's time at which shoes are compared
ANKLE = ball_to_ankle(dancer_skeleton()) - BALL_AHEAD  # metres by which the ankle lies behind the middle of the shoe
WRONG = 0.10  # metres of missing room with the same weight as a radian by which the legs cross too far
FARTHER = 0.02  # metres of missing room with the same weight as a metre of detour, where none gives all the room
TOLERATED = 0.004, 0.006, 0.0  # metres of room that may be missing before farther or later detours are tried
SHORT = 0.03  # metres; a shorter way has no direction, but a foot may turn on it


@dataclass(frozen=True, slots=True)
class Way:
    """A swing from one place of the ball (2,) to another, with the yaws of the foot at both, radians.

    hips : yaw of the body at both, None if legs are not checked; even : as from `evenness`
    """

    start: Array
    start_yaw: float
    end: Array
    end_yaw: float
    hips: tuple[float, float] | None = None
    even: float = 0.0


def detour(way: Way, other: Array, other_yaw: Array | float, step: StepSettings, outward: float) -> Bulge:
    """Return the detour to add to a straight path, so that the middle lines of the shoes stay `step.apart` apart.

    Legs must not go through each other either: the detour leads around the other foot on the side to which the hips
    turn.

    Parameters
    ----------
    way : of the swinging foot
    other, other_yaw : ball of the other foot and its yaw, (2,) and one number, or (k, 2) and (k,) at the `SHARES`
    step : how feet step; where no detour is enough, the best one is taken
    outward : 1 for the left foot, -1 for the right one: of equal detours each takes the other's mirror image
    """
    start, start_yaw, path = way.start, way.start_yaw, way.end - way.start
    length = float(np.linalg.norm(path))
    axes = np.eye(2) if length < SHORT else np.array([[path[1], -path[0]], path]) / length
    axes = axes * [[outward], [1.0]]
    e, turned = _by_share(step, way.even)
    ahead = headings(start_yaw + turned * (way.end_yaw - start_yaw))
    straight = start + e[:, None] * path - BALL_AHEAD * ahead
    aim = headings(np.broadcast_to(np.asarray(other_yaw), e.shape))
    still = shoe_line(other - BALL_AHEAD * aim, aim)
    gaps = segment_gaps(*shoe_line(straight, ahead), *still)
    need = enough(gaps, e, step.apart) - 1e-3
    ankle = outward * (other - BALL_AHEAD * aim - ANKLE * aim)
    free = wrung(way, outward * (straight - ANKLE * ahead) - ankle, step)
    if (gaps >= need).all() and free <= 0.0:
        return STRAIGHT
    most, missing, chosen = -np.inf, np.inf, STRAIGHT
    for ways, tolerated in zip(_WAYS, TOLERATED, strict=True):
        aside = ways[:, :2] @ axes
        places = straight + bend(e)[:, None] * aside[:, None] - lag(e)[:, None] * (ways[:, 2:] * path)[:, None]
        room = (segment_gaps(*shoe_line(places, ahead), *still) - need).min(axis=1)
        room = np.minimum(room, 0.0) - WRONG * wrung(way, outward * (places - ANKLE * ahead) - ankle, step)
        worth = np.where(room < 0.0, room - FARTHER * np.abs(ways).sum(axis=1), 0.0)
        if worth.max() > most:
            k = int(np.argmax(worth))
            most, missing = float(worth[k]), float(-room[k])
            chosen = Bulge(float(aside[k, 0]), float(aside[k, 1]), float(ways[k, 2]))
        if missing <= tolerated:
            break
    return chosen


@lru_cache(maxsize=256)
def _by_share(step: StepSettings, even: float) -> tuple[Array, Array]:
    """Return how far a swing has come and turned at the `SHARES`; callers must not change the arrays."""
    return travel_share(SHARES, step, even), turn_share(SHARES, step)


def wrung(way: Way, line: Array, step: StepSettings) -> Array:
    """Return by how much (...) the legs cross too far on the way, radians; 0 if they do not.

    line : (..., k, 2) from the right ankle to the left one at the `SHARES`. Its angle is followed from the start. If a
    leg goes around the wrong side of the other foot, it has gone through the other leg, and the angle grows.
    """
    if way.hips is None:
        return np.zeros(line.shape[:-2])
    hips = way.hips[0] + _by_share(step, way.even)[1] * (way.hips[1] - way.hips[0])
    angle = np.arctan2(-line[..., 1], line[..., 0]) - hips
    angle[..., 0] = (angle[..., 0] + np.pi) % (2 * np.pi) - np.pi
    if (np.abs(np.diff(angle)) >= np.pi).any():
        angle = np.unwrap(angle)
    most = np.abs(angle).max(axis=-1)
    allowed = max(np.radians(step.cross), abs(float(angle.reshape(-1, len(hips))[0, 0])))
    return np.asarray(np.maximum(most - allowed, 0.0))


def enough(gaps: Array, e: Array, apart: float) -> Array:
    """Return the least allowed gap (k,) along a swing, metres: `apart`, or less if the gaps at its ends are smaller.

    gaps : (k,) metres; e : (k,) share of the swing that is done, 0 to 1
    """
    return np.asarray(np.minimum(apart, gaps[0] + e * (gaps[-1] - gaps[0])))


def shoe_line(middle: Array, ahead: Array) -> tuple[Array, Array]:
    """Return both ends (..., 2) of a shoe's middle line; ahead (..., 2) : unit vectors along it."""
    return middle - HALF_SHOE * ahead, middle + HALF_SHOE * ahead


def bend(share: Array) -> Array:
    """Return the part of a detour (...) at each share (...) of the way: it starts at once, because shoes are long."""
    return np.asarray(np.sin(np.pi * share))


def lag(share: Array) -> Array:
    """Return how late a way is (...) at each share (...) of it."""
    return np.asarray(np.sin(2.0 * np.pi * share))


def headings(yaw: Array) -> Array:
    """Return unit vectors (..., 2), x and z, of yaws (...)."""
    out = np.empty((*np.shape(yaw), 2))
    np.sin(yaw, out=out[..., 0])
    np.cos(yaw, out=out[..., 1])
    return out


def gaps_at(balls: Array, yaws: Array, other: Array, other_yaw: float) -> Array:
    """Return the least distances (k,), metres, of middle lines of shoes, balls (k, 2), yaws (k,), to another shoe."""
    ahead = headings(yaws)
    middle, still = balls - BALL_AHEAD * ahead, headings(np.array(other_yaw))
    rest = other - BALL_AHEAD * still
    return segment_gaps(*shoe_line(middle, ahead), *shoe_line(rest, still))


def over(panels: Array, balls: Array, toes: Array, air: float) -> NDArray[np.bool_]:
    """Return whether shoes, balls (k, 2) and toes (k,) in radians, are nearer than `air`, metres, to panels (p, 2)."""
    if not len(panels):
        return np.zeros(len(balls), dtype=bool)
    ahead = headings(toes)
    across = np.column_stack((ahead[:, 1], -ahead[:, 0]))
    points = balls[:, None] + SHOE_OUTLINE[:, :1] * ahead[:, None] + SHOE_OUTLINE[:, 1:] * across[:, None]
    inside = np.abs(points[:, :, None] - panels).max(axis=3) <= HALF_PANEL + air
    return np.asarray(inside.any(axis=(1, 2)))


def segment_gaps(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Return the least distance (...) of segments a-b and c-d in the plane, (..., 2); c-d may be one for all."""
    same = (x if x.shape == a.shape else np.broadcast_to(x, a.shape) for x in (a, b, c, d))
    p, q, r, t = (np.ascontiguousarray(x).reshape(-1, 2) for x in same)
    out = np.empty(a.size // 2)
    _segment_gaps(p, q, r, t, out)
    return out.reshape(a.shape[:-1])


@njit(cache=True)
def _segment_gaps(a: Array, b: Array, c: Array, d: Array, out: Array) -> None:
    for k in range(len(out)):
        ax, ay, bx, by, cx, cy, dx, dy = a[k, 0], a[k, 1], b[k, 0], b[k, 1], c[k, 0], c[k, 1], d[k, 0], d[k, 1]
        here = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax), (bx - ax) * (dy - ay) - (by - ay) * (dx - ax)
        there = (dx - cx) * (ay - cy) - (dy - cy) * (ax - cx), (dx - cx) * (by - cy) - (dy - cy) * (bx - cx)
        if here[0] * here[1] < 0.0 and there[0] * there[1] < 0.0:
            out[k] = 0.0
            continue
        first = min(_point_gap(ax, ay, (cx, cy, dx, dy)), _point_gap(bx, by, (cx, cy, dx, dy)))
        out[k] = min(first, _point_gap(cx, cy, (ax, ay, bx, by)), _point_gap(dx, dy, (ax, ay, bx, by)))


@njit_inner
def _point_gap(x: float, y: float, line: tuple[float, float, float, float]) -> float:
    """Return the distance from a point to a segment, given as the places of its ends."""
    px, py = x - line[0], y - line[1]
    ux, uy = line[2] - line[0], line[3] - line[1]
    s = min(max((px * ux + py * uy) / (ux * ux + uy * uy), 0.0), 1.0)
    return math.hypot(px - s * ux, py - s * uy)
