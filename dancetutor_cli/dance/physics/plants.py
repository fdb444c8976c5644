"""Feet that do not skate: held soles stay in their places, toes lie flat."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.physics.repin import AnkleTracks
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import sole_points
from dancetutor_cli.dance.rig.skeleton import Skeleton, within
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array, Flags
from dancetutor_cli.feet.play import runs

# Feet that do not skate: a held sole stays exactly in its place, and the way between holds is fitted to it.
#
# A foot is held at its heel, at its ball, or at both; then it lies flat. While it is held its heading does not change,
# unless it pivots on its ball. Between two holds, the changes of the first fade smoothly into the changes of the
# second.

SHORTEST_CONTACT = 0.05  # seconds; a shorter contact of a sole is not a hold
GAP = 0.07  # seconds; two holds of one point with a shorter gap become one
PIVOT = np.radians(25.0)  # a foot that turns more than this while it lies flat pivots on purpose, on its ball
SURELY = 1.15  # factor of `PIVOT`; uncertain turns stay
STEEPEST = np.radians(58.0)  # pitch of a foot on its ball at which its toes bend no further
FADE = 14.0  # frames within which a foot returns to the pace of its own path
NEARLY = 0.999  # how far a foot is held in the frames before and after a hold
ROLLED = 0.015  # metres that the end of a foot which stands on it alone may be away from its place in the flat stand
CLEAR = 0.003  # metres over the floor of a foot that is not held


@dataclass(frozen=True, slots=True)
class Plants:
    """The held feet. heel, ball : bool (f, 2), whether that end of the left and of the right foot is on the floor."""

    heel: Flags
    ball: Flags

    def spans(self, side: int) -> NDArray[np.int64]:
        """Return the first and one past the last frame of each plant of a foot, (n, 2)."""
        return runs(self.heel[:, side] | self.ball[:, side])


def tidied(plants: Plants, rate: float) -> Plants:
    """Return the holds without short holds, and without gaps that are too short to be steps."""
    out = []
    for flags in (plants.heel, plants.ball):
        new = flags.copy()
        for side in (0, 1):
            for first, end in runs(~new[:, side]):
                if first > 0 and end < len(new) and end - first < GAP * rate:
                    new[first:end, side] = True
            for first, end in runs(new[:, side]):
                if end - first < SHORTEST_CONTACT * rate:
                    new[first:end, side] = False
        out.append(new)
    return Plants(*out)


def release_rolling_feet(skeleton: Skeleton, feet: AnkleTracks, plants: Plants) -> Plants:
    """Return the holds without beginnings and ends in which a foot rolls: on one end alone, far from the flat stand.

    Feet land and leave over heel and toe tips, and roll on: longer holds would drag the body after them.
    """
    heel, ball = plants.heel.copy(), plants.ball.copy()
    flat = plants.heel & plants.ball
    for side in (0, 1):
        sole = Sole(skeleton, side)
        for flags, anchor in ((plants.heel, sole.heel), (plants.ball, sole.ball)):
            point = feet.places[:, side] + quat.rotate(feet.turns[:, side], anchor)
            for first, end in plants.spans(side).tolist():
                lies = first + np.flatnonzero(flat[first:end, side])
                if not len(lies):
                    continue
                off = np.linalg.norm(point[first:end] - np.median(point[lies], axis=0), axis=1) > ROLLED
                rolled = first + np.flatnonzero(off & flags[first:end, side] & ~flat[first:end, side])
                start = rolled[rolled < lies[0]].max(initial=first - 1) + 1
                stop = rolled[rolled > lies[-1]].min(initial=end)
                for made in (heel, ball):
                    made[first:start, side], made[stop:end, side] = False, False
    return Plants(heel, ball)


def planted(skeleton: Skeleton, feet: AnkleTracks, plants: Plants) -> tuple[AnkleTracks, Array]:
    """Return feet that stand still where they are held.

    Returns
    -------
    the feet, and how far (f, 2) each foot is held, 0 to 1
    """
    places, turns, held = feet.places.copy(), feet.turns.copy(), np.zeros(plants.heel.shape)
    for side in (0, 1):
        spans: list[tuple[int, int]] = []
        sole = Sole(skeleton, side)
        for first, end in plants.spans(side).tolist():
            low, high = max(first - 1, 0), min(end + 1, len(places))
            inner = np.clip(np.arange(low, high), first, end - 1)
            part = slice(low, high)
            where = (feet.places[part, side], feet.turns[part, side])
            ends = (plants.heel[inner, side], plants.ball[inner, side])
            places[part, side], turns[part, side] = sole.stand(*where, *ends)
            held[part, side] = NEARLY
            held[first:end, side] = 1.0
            spans.append((low, high))
        _between(spans, feet, (places, turns, held), side)
    return cleared(skeleton, AnkleTracks(places, turns), held), held


def cleared(skeleton: Skeleton, feet: AnkleTracks, held: Array) -> AnkleTracks:
    """Return the feet, raised off the floor where they are not held."""
    places = feet.places.copy()
    places[..., 1] += np.where(held < 1.0, np.maximum(CLEAR - lowest(skeleton, feet), 0.0), 0.0)
    return AnkleTracks(places, feet.turns)


def lowest(skeleton: Skeleton, feet: AnkleTracks) -> Array:
    """Return the height (f, 2) of the lowest point between heel and ball of each foot."""
    out = []
    for k, points in enumerate(sole_points(skeleton)):
        ankle = skeleton.index(f"{'lr'[k]}_talocrural")
        rest = skeleton.rest
        offsets = [rest[p.joint] + p.offset - rest[ankle] for p in points[:4]]
        out.append(np.min([quat.rotate(feet.turns[:, k], o)[:, 1] for o in offsets], axis=0) + feet.places[:, k, 1])
    return np.stack(out, axis=1)


def _between(spans: list[tuple[int, int]], feet: AnkleTracks, made: tuple[Array, Array, Array], side: int) -> None:
    """Let the changes at both ends of each way through the air fade into each other."""
    places, turns, held = made
    frames = len(places)
    for (_, left), (right, _) in pairwise([(0, 0), *spans, (frames, frames)]):
        if right <= left:
            continue
        part = slice(left, right)
        share = (np.arange(left, right) - left + 1.0) / (right - left + 1.0)
        ends = []
        for at in (left - 1, right):
            inside = 0 <= at < frames and (at != left - 1 or left > 0)
            moved = places[at, side] - feet.places[at, side] if inside else np.zeros(3)
            turned = quat.multiply(turns[at, side], quat.conjugate(feet.turns[at, side])) if inside else quat.IDENTITY
            ends.append((moved, turned, 1.0 if inside else 0.0))
        (a, p, one), (b, q, other) = ends
        blend = smooth(share)
        places[part, side] = feet.places[part, side] + a + blend[:, None] * (b - a)
        for at, way, on in ((left, -1, one), (right, 1, other)):  # the foot continues as fast as it went
            if on and 0 <= at + 2 * way < frames and at + way < frames:
                pair = [places[k, side] - feet.places[k, side] for k in ((at - 1, at - 2) if way < 0 else (at, at + 1))]
                u = np.clip((np.arange(left, right) - at + 1 if way < 0 else at - np.arange(left, right)) / FADE, 0, 1)
                places[part, side] += (FADE * u * (1 - u) ** 2)[:, None] * (pair[0] - pair[1])
        turns[part, side] = quat.multiply(quat.slerp(p, q, blend), feet.turns[part, side])
        held[part, side] = NEARLY * np.maximum(one * smooth(1 - 3 * share), other * smooth(3 * share - 2))


class Sole:
    """The points of a foot in the axes of its ankle."""

    def __init__(self, skeleton: Skeleton, side: int) -> None:
        rest, ankle = skeleton.rest, skeleton.index(f"{'lr'[side]}_talocrural")
        points = sole_points(skeleton)[side]
        corners = [rest[p.joint] + p.offset - rest[ankle] for p in points[:2]]
        self.heel = (corners[0] + corners[1]) / 2
        self.ball = skeleton.offsets[skeleton.index(f"{'lr'[side]}_metatarsal")]  # the toes turn about it
        self.height, self.ball_height = rest[ankle][1], rest[ankle][1] + self.ball[1]

    def stand(self, places: Array, turns: Array, heel: Flags, ball: Flags) -> tuple[Array, Array]:
        """Return ankle (n, 3) and turn (n, 4) over one plant, with the held end exactly in its place."""
        ahead = quat.rotate(turns, quat.AHEAD)
        heading = np.unwrap(np.arctan2(ahead[:, 0], ahead[:, 2]))
        pitch = np.arcsin(np.clip(-ahead[:, 1], -1.0, 1.0))  # above 0 the heel is up
        flat = heel & ball
        most = heading[flat] if flat.any() else heading[1:-1] if len(heading) > 2 else heading  # without its neighbours
        if np.ptp(most) <= SURELY * PIVOT:
            heading = np.full(len(heading), float(np.median(most)))
        pitch = np.where(flat, 0.0, np.where(ball, np.clip(pitch, 0.0, STEEPEST), np.minimum(pitch, 0.0)))
        level = quat.from_axis_angle(quat.UP, heading)
        anchor = np.where(ball[:, None], self.ball, self.heel)
        point = places + quat.rotate(turns, anchor)
        out, turn = np.empty_like(places), np.empty_like(turns)
        at: Array | None = None
        for first, end in _same(ball):
            part = slice(first, end)
            lies = flat[part] if flat[part].any() else np.ones(end - first, dtype=bool)
            own = np.median(point[part][lies], axis=0)
            if at is not None:  # the end that was held before determines the place of this end
                own = at + quat.rotate(level[first], anchor[first])
            own[1] = self.ball_height if ball[first] else 0.0
            if ball[first]:
                pitch[part] = np.where(flat[part], 0.0, self._raised(places[part] - own, heading[part]))
            eased = _eased(pitch[part], flat[part])
            eased = np.maximum(eased, 0.0) if ball[first] else np.minimum(eased, 0.0)
            turn[part] = quat.multiply(level[part], quat.from_axis_angle(quat.LEFT, eased))
            out[part] = own - quat.rotate(turn[part], anchor[part])
            at = own - quat.rotate(level[end - 1], anchor[end - 1])
        return out, turn

    def _raised(self, ankle: Array, heading: Array) -> Array:
        """Return the pitch (n,) that brings the ankle nearest to `ankle` (n, 3), as seen from the held ball."""
        ahead = ankle[:, 0] * np.sin(heading) + ankle[:, 2] * np.cos(heading)
        rest = np.arctan2(-self.ball[1], self.ball[2])
        return np.asarray(np.clip(np.arctan2(ankle[:, 1], -ahead) - rest, 0.0, STEEPEST))


def _same(flags: Flags) -> list[tuple[int, int]]:
    """Return the stretches of equal flags."""
    edges = [0, *(np.flatnonzero(np.diff(flags.astype(np.int8))) + 1).tolist(), len(flags)]
    return list(pairwise(edges))


def _eased(pitch: Array, flat: Flags) -> Array:
    """Return a pitch (n,) that leaves 0, and returns to it, without a jump."""
    out = pitch.copy()
    for first, end in _same(flat):
        if flat[first]:
            continue
        length = end - first
        steps = np.arange(length)
        if first > 0:
            out[first:end] -= pitch[first] * smooth(1 - steps / min(length, 8))
        if end < len(pitch):
            out[first:end] -= pitch[end - 1] * smooth(1 - steps[::-1] / min(length, 8))
    return out


# The joints that bend where feet are held: toes stay flat on the floor.

FRAMES = 8.0  # frames in which toes become flat, and in which they return


def flatten_toes(skeleton: Skeleton, rotations: Array, feet: AnkleTracks, plants: Plants, held: Array) -> AnkleTracks:
    """Turn toes of local rotations (f, j, 4) in place: flat on the floor where balls are held, never below it.

    Returns the feet, higher where toes can bend no further.
    """
    places = feet.places.copy()
    for side, points in enumerate(sole_points(skeleton)):
        toes = skeleton.index(f"{'lr'[side]}_metatarsal")
        ahead = quat.rotate(feet.turns[:, side], quat.AHEAD)
        level = quat.from_axis_angle(quat.UP, np.arctan2(ahead[:, 0], ahead[:, 2]))
        flat = quat.multiply(quat.conjugate(feet.turns[:, side]), level)
        away = _frames_to(plants.ball[:, side])
        heels = (plants.heel & ~plants.ball)[:, side]
        flat = np.where(heels[:, None], quat.IDENTITY, flat)  # on the heel, toes point up
        turns = quat.slerp(rotations[:, toes], flat, np.maximum(smooth(1 - away / FRAMES), held[:, side] >= 1))
        least = np.where(held[:, side] < 1, CLEAR, 0.0)
        ball = feet.places[:, side] + quat.rotate(feet.turns[:, side], skeleton.offsets[toes])
        for _ in range(3):
            world = quat.multiply(feet.turns[:, side], turns)
            tips = np.stack([(ball + quat.rotate(world, p.offset))[:, 1] for p in points[4:]]).min(axis=0)
            reach = float(points[4].offset[2])
            up = np.where(tips < least - 1e-5, np.arcsin(np.clip((least - tips) / reach, 0.0, 0.5)), 0.0)
            turns = quat.multiply(turns, quat.from_axis_angle(-quat.LEFT, up))
        name = skeleton.names[toes]
        rotations[:, toes] = within(skeleton, name, turns, 0.5)
        world = quat.multiply(feet.turns[:, side], rotations[:, toes])
        tips = np.stack([(ball + quat.rotate(world, p.offset))[:, 1] for p in points[2:]]).min(axis=0)
        places[:, side, 1] += np.where(held[:, side] < 1, np.maximum(least - tips, 0.0), 0.0)
    return AnkleTracks(places, feet.turns)


def _frames_to(flags: Flags) -> Array:
    """Return the number of frames (f,) to the nearest flag."""
    at = np.flatnonzero(flags)
    if not len(at):
        return np.full(len(flags), np.inf)
    frames = np.arange(len(flags))
    k = np.clip(np.searchsorted(at, frames), 1, len(at) - 1) if len(at) > 1 else np.zeros(len(flags), dtype=np.int64)
    return np.asarray(np.minimum(np.abs(frames - at[k]), np.abs(frames - at[np.maximum(k - 1, 0)])), dtype=np.float64)
