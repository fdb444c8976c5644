"""Where each foot is at any time, from its swings. In jumps the feet go half around each other, never through each
other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.clearance import (
    SHARES,
    bend,
    enough,
    evenness,
    headings,
    hovering,
    lag,
    rise_share,
    segment_gaps,
    shoe_line,
    travel_share,
    turn_share,
)
from dancetutor_cli.dance.plan import (
    STRAIGHT,
    FootTrack,
    Gallop,
    Hover,
    Jump,
    Move,
    Pivot,
    Shake,
    Step,
    Swing,
    WalkStep,
)
from dancetutor_cli.dance.rig.body import BALL_AHEAD, dancer_foot
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_feet import WalkSettings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array

# The paths of both feet over the ground in a jump: half straight, half around each other, never through each other.

_ROUND = (0.75, 1.0)  # how much more of a way goes round, if `jump.round` brings the shoes together
_SPREAD = np.arange(0.0, 0.15, 0.02)  # metres that each foot goes outward


def turning(start: Array, end: Array, middles: tuple[Array, Array], turn: Array, e: Array) -> Array:
    """Return places (..., 2) on the way round a middle that moves (thesis 5.6.2.2); arrays are (..., 2) or (...).

    middles : before and after; turn : radians, the side on which the way goes round; e : 0 to 1, how far it has come
    """
    a, b = start - middles[0], end - middles[1]
    radius = (1 - e) * np.linalg.norm(a, axis=-1) + e * np.linalg.norm(b, axis=-1)
    # yaw turns +Z towards +X, so an angle in the ground plane is atan2(x, z)
    first = np.arctan2(a[..., 0], a[..., 1])
    gap = np.arctan2(b[..., 0], b[..., 1]) - first
    gap = turn + (gap - turn + np.pi) % (2 * np.pi) - np.pi  # end exactly where the foot lands, turning as the feet do
    moved = middles[0] + e[..., None] * (middles[1] - middles[0])
    return np.asarray(moved + radius[..., None] * headings(first + e * gap))


def jump_ways(
    starts: Array, start_yaws: Array, ends: Array, end_yaws: Array, turn: float, settings: MotionSettings
) -> tuple[float, Array]:
    """Return how much of a jump's path goes around the middle, and (2, 2) how far each foot goes aside along x and z to
    keep the shoes apart.

    Parameters
    ----------
    starts, ends : (2, 2) balls of the left and the right foot before and after; yaws : (2,) of their toes, radians
    turn : radians that the line between the feet turns
    settings : `step.apart` is used; where it is not possible, the largest distance that is
    """
    step, least = settings.step, settings.jump.round
    e, turned = travel_share(SHARES, step, settings.jump.even), turn_share(SHARES, step)
    aim = headings(start_yaws[:, None] + turned * (end_yaws - start_yaws)[:, None])
    straight = starts[:, None] + e[:, None] * (ends - starts)[:, None]
    middles = starts.mean(axis=0), ends.mean(axis=0)
    round_ = np.stack([turning(a, b, middles, np.array(turn), e) for a, b in zip(starts, ends, strict=True)])
    need = enough(_gaps(straight, aim), e, step.apart)
    across = round_[0, len(e) // 2] - round_[1, len(e) // 2]
    across = across / max(float(np.linalg.norm(across)), 1e-9)
    best, found = -np.inf, (least, np.zeros((2, 2)))
    for spread in _SPREAD:
        aside = np.outer((spread, -spread), across)
        for share in (least, *(more for more in _ROUND if more > least)):
            places = (1.0 - share) * straight + share * round_ + bend(e)[:, None] * aside[:, None]
            room = float((_gaps(places, aim) - need).min())
            if room > best + 1e-6:
                best, found = room, (share, aside)
            if room >= -1e-3:
                return found
    return found


def _gaps(balls: Array, aim: Array) -> Array:
    """Return the least distances (k,) between the middle lines of both shoes; balls and headings (2, k, 2)."""
    shoes = [shoe_line(b - BALL_AHEAD * a, a) for b, a in zip(balls, aim, strict=True)]
    return segment_gaps(*shoes[0], *shoes[1])


# Foot paths: where each foot is at any time, from its swings. Nothing here knows joints above the ankle.

HEEL_BACK, BALL_UP = dancer_foot()
SHAKE_RAMPS = 2.8  # a leg that is shaken out goes back, and comes again, in one part of so many
FLAPS_LATE = 1.2  # radians that a loose foot's flapping is behind the way of its leg
LOW = 0.0015  # metres over the ground at which a foot that comes down from a jump is on it, and must not slide
SLOW = 0.02  # the last part of a way's time, in which a foot hardly moves
MOST_LOW = 0.15  # part of the time of a jump in which the feet are hardly off the ground
NO_JUMP = Jump(0.0, 0.0, (0.0, 0.0), 0.0, (0.0, 0.0, 0.0, 0.0), 0.0, round=0.0)  # a way that goes round nothing


@dataclass(frozen=True, slots=True)
class FootPath:
    """One foot at f times.

    ball : (f, 3), the ball of the foot over the ground (y = 0: standing)
    yaw, pitch : (f,) radians; pitch is heel up, the toes stay level with the ground
    down : (f,) bool, the ball stands on the ground; progress : (f,) 0 to 1 of the swing, 0 while standing
    """

    ball: Array
    yaw: Array
    pitch: Array
    down: NDArray[np.bool_]
    progress: Array


Feet = tuple[FootPath, FootPath]  # left and right


def both_feet(tracks: tuple[FootTrack, FootTrack], times: Array, settings: MotionSettings) -> Feet:
    """Sample both feet at `times` (f,), seconds."""
    return foot_path(tracks[0], times, settings), foot_path(tracks[1], times, settings)


def foot_path(track: FootTrack, times: Array, settings: MotionSettings) -> FootPath:
    """Sample a foot at `times` (f,), seconds."""
    moves, step = track.moves, settings.step
    if not moves:
        still = np.zeros_like(times)
        ball = np.column_stack((np.full_like(times, track.start[0]), still, np.full_like(times, track.start[1])))
        ball[:, 1] = track.start_level
        return FootPath(ball, np.full_like(times, track.start_yaw), still, np.ones(len(times), dtype=bool), still)
    done, i, swinging, s, even, ground, turned = _over_ground(track, times, settings)
    level = np.array([track.start_level, *(m.level if isinstance(m, WalkStep) else 0.0 for m in moves)])
    climb = _climb(level[i], level[np.minimum(i + 1, len(level) - 1)], s, settings.walk)
    up = np.where(swinging, _height(track, i, s, rise_share(s, step, even)) + climb, 0.0)
    ball = np.column_stack((ground[:, 0], np.where(swinging, up, level[done]), ground[:, 1]))
    pitch = np.where(swinging, _swing_pitch(track, i, s, step.pitch_top), _stand_pitch(track, times, done, settings))
    for k in np.flatnonzero(_are(track, Shake)):
        near = swinging & (i == k)
        if near.any():
            ball[near], pitch[near] = _shaken(moves[k], times[near], ball[near], pitch[near])
    pivoting = swinging & _are(track, Pivot)[i]
    return FootPath(_rocked(ball, turned, pitch), turned, pitch, ~swinging | pivoting, s)


def shoe_path(track: FootTrack, times: Array, settings: MotionSettings) -> tuple[Array, Array]:
    """Return a foot's ball (f, 2) on the ground plane and yaw (f,), radians, as `foot_path` does but in less time."""
    moves = track.moves
    if not moves or any(isinstance(move, Shake) or min(move.pitches) < 0.0 for move in moves):
        path = foot_path(track, times, settings)
        return path.ball[:, [0, 2]], path.yaw
    over = _over_ground(track, times, settings)
    return over.place, over.yaw


class _OverGround(NamedTuple):
    """A foot over the ground at f times.

    done : (f,) placements 0 to this one are known; move : (f,) that has begun last; swinging : (f,) bool
    s : (f,) 0 to 1 of the swing; even : (f,) as of `evenness`; place : (f, 2) of the ball; yaw : (f,) radians
    """

    done: NDArray[np.int64]
    move: NDArray[np.int64]
    swinging: NDArray[np.bool_]
    s: Array
    even: Array
    place: Array
    yaw: Array


def _over_ground(track: FootTrack, times: Array, settings: MotionSettings) -> _OverGround:
    """Return where a foot with at least one move is over the ground at f times."""
    moves, step = track.moves, settings.step
    lift = np.array([m.lift for m in moves])
    land = np.array([m.land for m in moves])
    place = np.array([track.start, *(m.target for m in moves)])
    yaw = np.array([track.start_yaw, *(m.yaw for m in moves)])
    done = np.searchsorted(lift, times, side="right")  # placements 0..done are known; move done - 1 has begun
    i = np.maximum(done - 1, 0)
    swinging = (done > 0) & (times < land[i])
    s = np.where(swinging, (times - lift[i]) / (land[i] - lift[i]), 0.0)
    even = np.where(_are(track, Step, Hover)[i], evenness(land - lift, step)[i], 0.0)
    even = np.where(_are(track, Jump)[i], settings.jump.even, even)
    gone = travel_share(s, step, even, _low(track, settings.jump.even)[i])
    ground = np.where(swinging[:, None], _ground(track, place, i, gone), place[done])
    turned = yaw[i] + turn_share(s, step) * (yaw[np.minimum(i + 1, len(yaw) - 1)] - yaw[i])
    return _OverGround(done, i, swinging, s, even, ground, np.where(swinging, turned, yaw[done]))


def _shaken(move: Move, times: Array, ball: Array, pitch: Array) -> tuple[Array, Array]:
    """Return the ball (m, 3), metres, and the pitch (m,), radians, of a shaken foot at times (m,) in its move."""
    assert isinstance(move, Shake)
    s = (times - move.lift) / (move.land - move.lift)
    fade = smooth(SHAKE_RAMPS * s) * smooth(SHAKE_RAMPS * (1.0 - s))
    turn = 2 * np.pi * move.rate * (times - move.lift)
    way = move.far * np.sin(turn) - move.behind
    out = ball + fade[:, None] * np.column_stack((
        np.sin(move.heading) * way, move.far / 2 * np.cos(turn), np.cos(move.heading) * way,
    ))  # fmt: skip
    return out, pitch + fade * (move.hangs + move.flap * np.sin(turn - FLAPS_LATE))


def _climb(before: Array, after: Array, s: Array, walk: WalkSettings) -> Array:
    """Return the height (f,) of the ground under a swing, metres: a foot rises at once and comes down late over an edge
    between two levels.
    """
    up, down = smooth(s / walk.edge_up), smooth((s - 1.0 + walk.edge_down) / walk.edge_down)
    return np.asarray(before + np.where(after > before, up, down) * (after - before))


def _rocked(ball: Array, yaw: Array, pitch: Array) -> Array:
    """Return the ball (f, 3) of a foot whose toes are up (pitch below 0). The edge of its heel is where it would be if
    the foot were flat.
    """
    up = -np.minimum(pitch, 0.0)
    back = HEEL_BACK * (1.0 - np.cos(up)) + BALL_UP * np.sin(up)
    out = ball.copy()
    out[:, 0] -= back * np.sin(yaw)
    out[:, 2] -= back * np.cos(yaw)
    out[:, 1] += HEEL_BACK * np.sin(up) - BALL_UP * (1.0 - np.cos(up))
    return out


def _are(track: FootTrack, *kinds: type[Move]) -> NDArray[np.bool_]:
    """Return which of a foot's moves are of some kinds."""
    return np.array([isinstance(move, kinds) for move in track.moves])


def _low(track: FootTrack, even: float) -> Array:
    """Return the last part of each move's time, in which a foot that jumps comes straight down; otherwise it would
    slide.

    even : as of `evenness`, of jumps
    """
    heights = np.array([m.height if isinstance(m, Jump) else np.inf for m in track.moves])
    return np.asarray(np.clip(LOW / np.maximum(4.0 * heights, 1e-9) - (1.0 - even) * SLOW, 0.0, MOST_LOW))


def _ground(track: FootTrack, place: Array, i: NDArray[np.int64], e: Array) -> Array:
    """Return places (f, 2) over the ground: straight and past the other foot, or in jumps partly round the middle.

    e : as of `travel_share`
    """
    start, end = place[i], place[i + 1]
    bulge = np.array([m.bulge if isinstance(m, Swing) else STRAIGHT for m in track.moves])[i]
    way = start + (e - bulge[:, 2] * lag(e))[:, None] * (end - start)
    if (jumping := _are(track, Jump)[i]).any():
        jumps, k = [m if isinstance(m, Jump) else NO_JUMP for m in track.moves], i[jumping]
        share = np.array([jump.round for jump in jumps])[k][:, None]
        middles = np.array([jump.middles for jump in jumps])[k]
        line_turn = np.array([jump.line_turn for jump in jumps])[k]
        round_ = turning(start[jumping], end[jumping], (middles[:, 0], middles[:, 1]), line_turn, e[jumping])
        way[jumping] = (1 - share) * way[jumping] + share * round_
    return np.asarray(way + bulge[:, :2] * bend(e)[:, None])


def _height(track: FootTrack, i: NDArray[np.int64], s: Array, step: Array) -> Array:
    """Return the height (f,) of the sole, metres. step : (f,) as of `rise_share`"""
    height = np.array([m.height if isinstance(m, Swing) else 0.0 for m in track.moves])[i]
    tuck = np.array([m.tuck if isinstance(m, Jump) else 0.0 for m in track.moves])[i]
    # pulled up at once, because a leg that trails behind is stretched as the body leaves the ground
    pulled = np.where(s < 0.5, np.sin(np.pi * s), np.sin(np.pi * s) ** 2)
    jump = height * 4.0 * s * (1.0 - s) + tuck * pulled
    shape = np.where(_are(track, Hover, Gallop, Shake)[i], hovering(s), step)
    return np.asarray(np.where(_are(track, Jump)[i], jump, height * shape))


def _swing_pitch(track: FootTrack, i: NDArray[np.int64], s: Array, top: float) -> Array:
    lift, most, land, _ = np.array([m.pitches for m in track.moves])[i].T
    up = lift + smooth(s / top) * (most - lift)
    return np.asarray(up + smooth((s - top) / (1.0 - top)) * (land - most))


def _stand_pitch(track: FootTrack, times: Array, done: NDArray[np.int64], settings: MotionSettings) -> Array:
    """Return the pitch (f,) of a standing foot, radians: its heel sinks after landing, rises before a swing."""
    step, moves = settings.step, track.moves
    pitches = np.array([m.pitches for m in moves])
    landed = np.array([-1e9, *(m.land for m in moves)])[done]
    rest = np.concatenate(([0.0], pitches[:, 3]))[done]
    touch = np.concatenate(([0.0], pitches[:, 2]))[done]
    leaves = np.array([*(m.lift for m in moves), 1e9])[done]
    leave = np.concatenate((pitches[:, 0], [0.0]))[done]
    stood = np.maximum(leaves - landed, 1e-9)  # a foot may leave as it lands
    rest = np.where(stood < step.heel_stays, touch, rest)
    drop = np.minimum(step.heel_drop, step.heel_drop_share * stood)
    early = [settings.walk.heel_rise if isinstance(m, WalkStep) else step.heel_rise for m in moves]
    rise = np.minimum(np.array([*early, step.heel_rise])[done], step.heel_rise_share * stood)
    falling = rest + (touch - rest) * (1.0 - smooth((times - landed) / drop))
    return np.asarray(falling + (leave - rest) * smooth(1.0 - (leaves - times) / rise))
