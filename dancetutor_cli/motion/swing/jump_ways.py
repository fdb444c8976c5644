"""The ways of both feet over the ground in a jump: half straight, half round each other, never through each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.settings import MotionSettings
from dancetutor_cli.motion.swing.clearance import SHARES, bend, enough, headings, segment_gaps, shoe_line
from dancetutor_cli.motion.swing.pace import swung, travelled
from dancetutor_cli.rig.dimensions import BALL_AHEAD

Array = NDArray[np.float64]
_ROUND = (0.75, 1.0)  # more of a way that goes round, where `jump.round` brings shoes together
_SPREAD = np.arange(0.0, 0.15, 0.02)  # metres that each foot goes outward


def turning(start: Array, end: Array, middles: tuple[Array, Array], turn: Array, e: Array) -> Array:
    """Places (..., 2) on the way round a middle that moves (thesis 5.6.2.2), all arrays of one shape (..., 2) or (...).

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
    """How much of a jump's way goes round, and (2, 2) x and z that each foot goes aside, so that shoes stay apart.

    Parameters
    ----------
    starts, ends : (2, 2) balls of the left and the right foot before and after; yaws : (2,) of their toes, radians
    turn : radians that the line between the feet turns
    settings : of them `step.apart`; where it cannot be had, the most that can
    """
    step, least = settings.step, settings.jump.round
    e, turned = travelled(SHARES, step), swung(SHARES, step)
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
    """Least distances (k,) between the middle lines of both shoes; balls and headings (2, k, 2)."""
    shoes = [shoe_line(b - BALL_AHEAD * a, a) for b, a in zip(balls, aim, strict=True)]
    return segment_gaps(*shoes[0], *shoes[1])
