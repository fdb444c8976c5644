"""Feet that stand still in each stand that an independent measure finds.

The joints of the soles hold the parts that touch the floor. Viewers also see ankles that roll slowly, toes that leave
slowly, and feet that creep a centimetre over the floor. So stands are found by height and speed, in the same way as in
the report, in rounds. In each stand the foot keeps one place and, while its ankle stands, one turn. Between stands the
changes fade. The movement between stands is faster afterwards, so each round finds the stands shorter and more still.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dancetutor_cli.dance.physics.plants import NEARLY, STEEPEST, Plants, Sole, cleared
from dancetutor_cli.dance.physics.repin import AnkleTracks
from dancetutor_cli.dance.quality.contact import SHORTEST_STAND, stand_frames
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.limbs import TwoBones
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array, Flags
from dancetutor_cli.feet.play import runs

STAND_ROUNDS = 4
# factor of the visible limits within which feet are held: later, legs that give move the feet across these limits
LIMITS_FACTOR = 1.05
ON_FLOOR = 0.015  # metres over the floor up to which the end of a standing foot is put on the floor
FLAT = np.radians(8.0)  # pitch up to which a standing foot lies flat
TURNS = np.radians(45.0)  # a standing foot that turns more pivots on purpose
SHUFFLE = 0.03  # metres between two places of one stand, from which on it becomes two stands with a quick step between
STEP = 1.2  # m/s of that quick step
FROM = np.radians(15.0)  # bend of a knee that is nearly straight
SINKS = 0.04  # metres that a pelvis may sink for a heel that stays on the floor
FADE = 0.10  # seconds in which a foot returns to its own path


@dataclass(frozen=True, slots=True)
class _Stand:
    """Frames from `first` to before `end` in which a foot stands; ankle : stands of its ankle, counted from `first`."""

    first: int
    end: int
    ankle: list[tuple[int, int]]

    @property
    def in_ankle(self) -> Flags:
        """Whether each frame (n,) is in a stand of the ankle."""
        out = np.zeros(self.end - self.first, dtype=bool)
        for first, end in self.ankle:
            out[first:end] = True
        return out

    @property
    def rests(self) -> Flags:
        """Whether each frame (n,) decides where the foot stands: the frames of the ankle's stands, or all frames."""
        return self.in_ankle if self.ankle else np.ones(self.end - self.first, dtype=bool)


def keep_feet_still(
    skeleton: Skeleton, feet: AnkleTracks, plants: Plants, times: Array, hips: Array
) -> tuple[AnkleTracks, Plants, Array]:
    """Return feet that are still while they stand, with heels on the floor as long as legs reach.

    Parameters
    ----------
    plants : the held parts of feet so far; hips : (f, 2, 3) places of the hips, metres

    Returns
    -------
    the feet, their held parts, and how far (f, 2) each foot is held, 0 to 1
    """
    places, turns = feet.places.copy(), feet.turns.copy()
    heel, ball = plants.heel.copy(), plants.ball.copy()
    held = np.zeros(heel.shape)
    for side in (0, 1):
        foot = _Foot(skeleton, side, times, hips[:, side], feet.turns[:, side])
        for _ in range(STAND_ROUNDS):
            stands = foot.stands(places[:, side], turns[:, side])
            if not stands:
                break
            track = foot.held(places[:, side], turns[:, side], stands)
            places[:, side], turns[:, side], heel[:, side], ball[:, side], held[:, side] = track
    return cleared(skeleton, AnkleTracks(places, turns), held), Plants(heel, ball), held


class _Foot:
    """One foot over f times (f,). hips : (f, 3); free : (f, 4) turns of the foot without a hold"""

    def __init__(self, skeleton: Skeleton, side: int, times: Array, hips: Array, free: Array) -> None:
        self.sole, self.times, self.hips, self.free = Sole(skeleton, side), times, hips, free
        self.reach = TwoBones(skeleton, "lr"[side]).distance(FROM) + SINKS

    def stands(self, place: Array, turn: Array) -> list[_Stand]:
        """Return the stands of ankle (f, 3) and ball in order, joined where they overlap, with shuffles split."""
        ankles, balls = (_unshuffled(self.times, path) for path in (place, place + quat.rotate(turn, self.sole.ball)))
        joined: list[list[int]] = []
        for first, end in sorted((*ankles, *balls)):
            if joined and first < joined[-1][1]:
                joined[-1][1] = max(joined[-1][1], end)
            else:
                joined.append([first, end])
        return [
            _Stand(first, end, [(a - first, b - first) for a, b in ankles if first <= a < end]) for first, end in joined
        ]

    def held(self, place: Array, turn: Array, stands: list[_Stand]) -> tuple[Array, Array, Flags, Flags, Array]:
        """Return ankle (f, 3) and turn (f, 4) of a foot, still in its stands; if heel and ball are held; how far."""
        frames, ball = len(place), place + quat.rotate(turn, self.sole.ball)
        heel_down, on_floor, fixed = (np.zeros(frames, dtype=bool) for _ in range(3))
        moved, turned = np.zeros((frames, 3)), np.zeros((frames, 3))
        for stand in stands:
            part = slice(stand.first, stand.end)
            rests = stand.rests
            own = np.median(ball[part][rests], axis=0)
            low = own[1] < self.sole.ball_height + ON_FLOOR
            own[1] = self.sole.ball_height
            moved[part] = (own - ball[part]) * (1.0, float(low), 1.0)
            new, flat = self._turns(turn, stand, ball[part] + moved[part], bool(low))
            turned[part] = quat.to_vector(quat.multiply(new, quat.conjugate(turn[part])))
            fixed[part], on_floor[part], heel_down[part] = True, low, low & flat
        ball = ball + _faded(self.times, moved, fixed)
        turn = quat.multiply(quat.from_vector(_faded(self.times, turned, fixed)), turn)
        share = NEARLY * _faded(self.times, fixed[:, None].astype(np.float64), fixed)[:, 0]
        share[on_floor] = 1.0
        return ball - quat.rotate(turn, self.sole.ball), turn, heel_down, on_floor, share

    def _turns(self, turn: Array, stand: _Stand, ball: Array, low: bool) -> tuple[Array, Flags]:
        """Return turns (n, 4) of the foot in a stand, level across, and whether (n,) it lies flat; ball : (n, 3), held.

        The foot keeps its heading and, in each stand of the ankle, its pitch. If the leg is too short, the heel rises
        as without a hold.
        """
        part = slice(stand.first, stand.end)
        heading, own = _heading_and_pitch(turn[part])
        if np.ptp(heading[stand.rests]) < TURNS:
            heading = np.full(len(heading), float(np.median(heading[stand.rests])))
        else:
            heading = self._pivoted(heading, stand)
        pitch = own.copy()
        for first, end in stand.ankle:
            median = float(np.median(own[first:end]))
            pitch[first:end] = 0.0 if abs(median) < FLAT or (low and median < 0.0) else median
        free = _heading_and_pitch(self.free[part])[1]
        lengths = [self._stretch(part, ball, _level_turns(heading, x)) for x in (pitch, free)]
        rigid = stand.in_ankle & ((lengths[0] < self.reach) | (lengths[0] < lengths[1]))
        pitch = own + _faded(self.times[part], (pitch - own)[:, None], rigid)[:, 0]
        if low:
            pitch = np.where(rigid, pitch, np.clip(pitch, 0.0, STEEPEST))
        return _level_turns(heading, pitch), rigid & (pitch == 0.0)

    def _pivoted(self, heading: Array, stand: _Stand) -> Array:
        """Return headings (n,) of a foot that pivots: one in each stand of the ankle, unless it turns far from it."""
        wanted, near = heading.copy(), np.zeros(len(heading), dtype=bool)
        for first, end in stand.ankle:
            wanted[first:end] = np.median(heading[first:end])
            near[first:end] = np.abs(heading[first:end] - wanted[first:end]) < TURNS / 2
        times = self.times[stand.first : stand.end]
        return np.asarray(heading + _faded(times, (wanted - heading)[:, None], near)[:, 0])

    def _stretch(self, part: slice, ball: Array, turn: Array) -> Array:
        """Return the metres (n,) from the hip to the ankle of a foot whose ball is in places (n, 3)."""
        return np.asarray(np.linalg.norm(ball - quat.rotate(turn, self.sole.ball) - self.hips[part], axis=1))


def _heading_and_pitch(turns: Array) -> tuple[Array, Array]:
    """Return the heading of feet, radians (n,) from +Z to +X, and their pitch, radians (n,) with the heel up."""
    ahead = quat.rotate(turns, quat.AHEAD)
    return np.unwrap(np.arctan2(ahead[:, 0], ahead[:, 2])), np.arcsin(np.clip(-ahead[:, 1], -1.0, 1.0))


def _level_turns(heading: Array, pitch: Array) -> Array:
    """Return turns (n, 4) of feet that are level across."""
    return quat.multiply(quat.from_axis_angle(quat.UP, heading), quat.from_axis_angle(quat.LEFT, pitch))


def _unshuffled(times: Array, path: Array) -> list[tuple[int, int]]:
    """Return the stands of a joint; if the joint goes from one place to another within a stand, there are two."""
    out: list[tuple[int, int]] = []
    rate = (len(times) - 1) / float(times[-1] - times[0])
    rest = [(int(first), int(end)) for first, end in stand_frames(times, path, LIMITS_FACTOR)]
    while rest:
        first, end = rest.pop()
        flat = path[first:end][:, [0, 2]]
        away = np.linalg.norm(flat[-1] - flat[0])
        if away < SHUFFLE:
            out.append((first, end))
            continue
        half = max(1, round(float(away) / STEP * rate / 2))
        fast = first + int(np.argmax(np.linalg.norm(np.diff(flat, axis=0), axis=1)))
        fast = min(max(fast, first + half + 1), end - half - 1)
        parts = ((first, fast - half), (fast + half, end))
        if all(b - a >= SHORTEST_STAND * rate for a, b in parts):
            rest += parts
        else:
            out.append((first, end))
    return sorted(out)


def _faded(times: Array, values: Array, fixed: Flags) -> Array:
    """Return values (f, d), unchanged in `fixed` frames; in between, the values before and after fade."""
    out = values.copy()
    last = len(times) - 1
    for first, end in runs(~fixed).tolist():
        before, after = max(first - 1, 0), min(end, last)
        at, span = times[first:end], min(FADE, float(times[after] - times[before]))
        left = smooth(1 - (at - times[before]) / span) * (first > 0)
        right = smooth(1 - (times[after] - at) / span) * (end <= last)
        total = np.maximum(left + right, 1.0)[:, None]
        out[first:end] = (left[:, None] * values[before] + right[:, None] * values[after]) / total
    return out
