"""Contacts: each limb on its panel in time, feet that neither slide nor sink, palms on the bar."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.context import HALF_PANEL, HOLD_GRACE, panels_on_ground
from dancetutor_cli.dance.motion import Contact, Motion, sample
from dancetutor_cli.dance.quality.figures import GROUND, SKATE_HEIGHT, SKATE_SPEED, Body, Figure, over_ground
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import (
    BALL_AHEAD,
    SOLE_NAMES,
    BodyPoint,
    palm_points,
    place,
    points_in_world,
    sole_points,
    world_transforms,
)
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.play import StepKind, runs

if TYPE_CHECKING:
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play

# The contact error: when each limb reaches its panel, compared with the time of the note.

TOUCH = 0.0002  # metres over the surface that count as touching
INSIDE = 0.02  # metres inside the edge of a panel at which the middle of a sole has a good foothold
HOLD_STEP, OFF_PANEL = 0.01, 0.002  # seconds between checks of a held note; metres over the panel that count as off it
OFFSETS = np.arange(-50, 51) / 1000.0  # seconds around a note: 1 kHz


def contact_figures(motion: Motion) -> tuple[tuple[Figure, ...], Array]:
    """Return the figures, and the error of every contact in milliseconds (c,), nan for a miss."""
    errors = contact_errors(motion)
    missed = np.isnan(errors)
    worst = float(np.abs(errors[~missed]).max()) if (~missed).any() else float("nan")
    inside = soles_inside(motion)
    on, well = ((100.0 * float((inside > least).mean()) if len(inside) else float("nan")) for least in (-1e-3, INSIDE))
    figures = (
        Figure("contacts", float(len(errors)), ""),
        Figure("contact error", worst, "ms", 1.0),
        Figure("contacts missed", float(missed.sum()), "", 0.0),
        Figure("notes not played", float(len(motion.dropped)), ""),
        Figure("soles with the middle on the panel", on, "%"),
        Figure(f"soles with the middle at least {100 * INSIDE:g} cm inside the panel", well, "%"),
    )
    return figures, errors


def soles_inside(motion: Motion) -> Array:
    """Return how far (k,) the middle of a whole foot's sole lands inside its panel, metres; below 0 outside."""
    whole = [c for c in motion.contacts if c.limb < Limb.LEFT_HAND and c.part == Part.WHOLE]
    if not whole:
        return np.zeros(0)
    positions, world = world_transforms(motion.skeleton, *sample(motion, np.array([c.start for c in whole])))
    balls = np.array([motion.skeleton.index(f"{side}_metatarsal") for side in "lr"])[[c.limb for c in whole]]
    row = np.arange(len(whole))
    ahead = quat.rotate(world[row, balls], np.array([0.0, 0.0, 1.0]))[:, [0, 2]]
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    middle = positions[row, balls][:, [0, 2]] - BALL_AHEAD * ahead
    return np.asarray(HALF_PANEL - np.abs(middle - np.array([c.panel for c in whole])).max(axis=1))


def contact_errors(motion: Motion) -> Array:
    """Return when sole or palm reaches the panel minus the note's time, milliseconds (c,); nan for a miss.

    A limb misses if it is not on the panel at the note, or leaves it while the note is held. The motion is resampled at
    1 kHz within 50 ms of the note. A contact begins when the lowest point comes within 0.2 mm of the surface, after it
    was higher. A limb that has stood there all the time is on time if it is down at the note. At the note the touching
    point must be inside the panel.
    """
    out = np.full(len(motion.contacts), np.nan)
    for start in range(0, len(motion.contacts), 100):  # in pieces: a long chart has thousands of contacts
        part = motion.contacts[start : start + 100]
        times = (np.array([c.start for c in part])[:, None] + OFFSETS).ravel()
        positions, world = world_transforms(motion.skeleton, *sample(motion, times))
        for k, contact in enumerate(part):
            rows = slice(k * len(OFFSETS), (k + 1) * len(OFFSETS))
            out[start + k] = _error(place(_points(motion, contact), positions[rows], world[rows]), contact)
            if contact.kind == StepKind.HOLD and away_from_hold(motion, contact) > HOLD_GRACE:
                out[start + k] = np.nan
    return out


def away_from_hold(motion: Motion, contact: Contact) -> float:
    """Return the longest time in seconds that a limb is off the panel between a held note's head and its end."""
    end = min(contact.end, float(motion.times[-1]))
    times = np.arange(contact.start, end, HOLD_STEP)
    if len(times) < 2:
        return 0.0
    positions, world = world_transforms(motion.skeleton, *sample(motion, times))
    points = place(_points(motion, contact), positions, world)
    inside = np.abs(points[..., [0, 2]] - np.array(contact.panel)).max(axis=2) <= HALF_PANEL + 1e-6
    off = ~((points[..., 1] <= OFF_PANEL) & inside).any(axis=1)
    return HOLD_STEP * max((end - first for first, end in runs(off)), default=0)


def _points(motion: Motion, contact: Contact) -> tuple[BodyPoint, ...]:
    """Return the body points that can press: the palm, the whole sole, or its heel or toes in a bracket."""
    if contact.limb >= Limb.LEFT_HAND:
        return (palm_points(motion.skeleton)[contact.limb - Limb.LEFT_HAND],)
    points = sole_points(motion.skeleton)[contact.limb]
    if contact.part == Part.WHOLE:
        return points
    wanted = "heel" if contact.part == Part.HEEL else ("toe", "ball")
    return tuple(p for name, p in zip(SOLE_NAMES, points, strict=True) if name.startswith(wanted))


def _error(points: Array, contact: Contact) -> float:
    """Return the error of one contact, milliseconds; points : (times, p, 3) around the note."""
    low = points[..., 1].min(axis=1)
    note = len(OFFSETS) // 2
    inside = np.abs(points[..., [0, 2]] - np.array(contact.panel)).max(axis=2) <= HALF_PANEL + 1e-6
    touching = (points[..., 1] <= TOUCH + low[:, None]) & inside
    if not touching[note - 5 : note + 6].any():
        return float("nan")
    down = np.flatnonzero(low <= TOUCH)
    begins = np.array([i for i in down if i == 0 or low[i - 1] > TOUCH])
    if not len(begins):
        return float("nan")
    if len(begins) == 1 and begins[0] == 0:
        return 0.0  # it stood there all the time
    begins = begins[begins > 0]
    best = begins[np.argmin(np.abs(OFFSETS[begins]))]
    # between two samples: the time at which the height crosses the threshold
    share = (low[best - 1] - TOUCH) / max(low[best - 1] - low[best], 1e-12)
    return float(1000 * (OFFSETS[best - 1] + share * (OFFSETS[best] - OFFSETS[best - 1])))


# Feet on the ground: slides while planted, depth below the pad, feet that rest where a mine passes.

PIVOT = np.radians(2.0)  # a planted foot that turns more pivots on purpose: on its ball, which must not slide
CUT_PIVOT = np.radians(0.2)  # the same at the edge of a section, where only a part of the turn is visible
BALL = slice(2, 4)  # the indices of the ball's points in a sole
MINE_CLEARANCE = 0.03  # metres; a foot over a mine must be higher
MAX_LISTED_MINES = 6  # largest number of moments on mines that a note lists


def ground_figures(motion: Motion, body: Body, mines: Array | None) -> tuple[tuple[Figure, ...], tuple[str, ...]]:
    """Return figures and notes. mines : (m, 3) of second, x, z; None if not known."""
    slide, pivots = longest_slide(body, motion.skeleton)
    under = np.zeros(0, np.int8) if mines is None else feet_on_mines(motion, mines)
    figures = (
        Figure("plant slide", 1000 * slide, "mm", 1.0),
        Figure("penetration", 1000 * deepest(motion), "mm", 1.0),
        Figure("feet on mines", float("nan") if mines is None else float((under >= 0).sum()), "", 0.0),
    )
    notes = (
        (f"only the slide of the ball counts in {pivots} intended pivot{'s' * (pivots > 1)} on a planted foot",)
        if pivots
        else ()
    )
    return figures, (*notes, *(() if mines is None else mine_messages(mines[under >= 0, 0])))


def longest_slide(body: Body, skeleton: Skeleton) -> tuple[float, int]:
    """Return the longest path (metres) of a sole point in a plant (of the ball's joint in a pivot), and the number of
    pivots.
    """
    worst, pivots = 0.0, 0
    balls = [body.joints[:, skeleton.index(f"{side}_metatarsal")] for side in "lr"]
    for side in (0, 1):
        soles = body.soles[:, side]
        for first, end in runs(body.is_standing[:, side]):
            if end - first < 3:
                continue
            piece = soles[first:end]
            across = piece[:, 2] - piece[:, 3]  # ball_in to ball_out
            yaw = np.unwrap(np.arctan2(across[:, 0], across[:, 2]))
            cut, down = first == 0 or end == len(soles), piece[..., 1] <= GROUND
            if np.ptp(yaw) > (CUT_PIVOT if cut else PIVOT):
                pivots += 1
                down, piece = np.asarray(down[:, BALL].any(axis=1, keepdims=True)), balls[side][first:end, None]
            both = (down[1:] & down[:-1])[..., None]
            path = np.linalg.norm(np.where(both, np.diff(piece[..., [0, 2]], axis=0), 0.0), axis=2).sum(axis=0)
            worst = max(worst, float(path.max()))
    return worst, pivots


def deepest(motion: Motion) -> float:
    """Return how far any sole point is below the pad, metres, at every key and half-way between keys."""
    times = np.sort(np.concatenate((motion.times, (motion.times[1:] + motion.times[:-1]) / 2)))
    low = 0.0
    for start in range(0, len(times), 4000):
        positions, world = world_transforms(motion.skeleton, *sample(motion, times[start : start + 4000]))
        for points in sole_points(motion.skeleton):
            over = over_ground(place(points, positions, world), motion.ground)
            low = min(low, float(over[..., 1].min()))
    return -low


def mines_of(play: Play, pad: Pad) -> Array:
    """Return the second and the place (x, z) in the world of every mine of a play, (m, 3), for the quality report."""
    row, column = np.nonzero(play.rows.mines)
    return np.column_stack((play.rows.second[row], panels_on_ground(pad)[column]))


def feet_on_mines(motion: Motion, mines: Array) -> NDArray[np.int8]:
    """Return the foot (m,), 0 left or 1 right, that is on each mine as it passes; -1 if none is.

    A foot is on a mine if a sole point inside its panel is lower than 3 cm. A mine outside the motion's time gets -1.
    """
    out = np.full(len(mines), -1, dtype=np.int8)
    here = np.flatnonzero((mines[:, 0] >= motion.times[0]) & (mines[:, 0] <= motion.times[-1]))
    if not len(here):
        return out
    positions, world = world_transforms(motion.skeleton, *sample(motion, mines[here, 0]))
    for foot, points in enumerate(sole_points(motion.skeleton)):
        places = place(points, positions, world)
        inside = np.abs(places[..., [0, 2]] - mines[here, None, 1:]).max(axis=2) <= HALF_PANEL
        out[here[(inside & (places[..., 1] < MINE_CLEARANCE)).any(axis=1)]] = foot
    return out


def mine_messages(seconds: Array) -> tuple[str, ...]:
    """Return one line for the user that lists the mines on which a foot is as they pass, or nothing. seconds : of these
    mines
    """
    if not len(seconds):
        return ()
    at = [f"{second:.2f} s" for second in np.unique(seconds.round(2)).tolist()]
    when = ", ".join([*at[:MAX_LISTED_MINES], *(["..."] if len(at) > MAX_LISTED_MINES else [])])
    what = "a mine as it passes" if len(seconds) == 1 else f"{len(seconds)} mines as they pass"
    return (f"a foot is on {what}, or less than {100 * MINE_CLEARANCE:g} cm over: {when}",)


# Hands on the bar: the distance of the palms from the rail while they hold it.

PIECE = 2000  # samples in memory at once
RATE = 120.0  # samples per second


def bar_figures(motion: Motion) -> tuple[Figure, ...]:
    """Return the largest distance of a palm from its place on the rail while it holds it; nothing without a bar."""
    if motion.bar is None:
        return ()
    worst = 0.0
    for grip in motion.grips:
        start, end = max(grip.start, motion.times[0]), min(grip.end, motion.times[-1])
        if start < end:
            worst = max(worst, _farthest(motion, grip.side, grip.x, np.arange(start, end, 1.0 / RATE)))
    return (
        Figure("hands on the bar", float(len(motion.grips)), ""),
        Figure("palm off the bar", 1000.0 * worst, "mm", 1.0),
    )


def _farthest(motion: Motion, side: int, x: float, times: np.ndarray[tuple[int], np.dtype[np.float64]]) -> float:
    assert motion.bar is not None
    out = 0.0
    palm = palm_points(motion.skeleton)[side]
    for first in range(0, len(times), PIECE):
        at = points_in_world(motion.skeleton, (palm,), *sample(motion, times[first : first + PIECE]))[:, 0]
        off = np.abs(np.hypot(at[:, 1] - motion.bar.height, at[:, 2] - motion.bar.behind) - motion.bar.radius)
        out = max(out, float(np.hypot(off, at[:, 0] - x).max()))
    return out


# The slide of standing feet, as seen from outside: by height and speed of ankles and balls only.
#
# Sources: J. Lee and others, *Interactive control of avatars animated with human motion data*, SIGGRAPH 2002, whose
# contacts are where a joint is low and slow; limits as in the skating ratio (K. Karunratanakul and others, *Guided
# motion diffusion*, 2023). The program's own plants do not count, so this measure fits any motion.

RATE = 60.0  # frames per second of the measurement
SHORTEST_STAND = 0.10  # seconds; least duration of a stand
MEDIAN, WORST = 5.0, 25.0  # goals, millimetres
JOINTS = ("l_talocrural", "l_metatarsal", "r_talocrural", "r_metatarsal")


@dataclass(frozen=True, slots=True)
class StandingSpan:
    """A stand of a joint: name, from `start` to `end` in seconds, and how far the joint slides, metres."""

    joint: str
    start: float
    end: float
    slide: float


def stands_of(times: Array, name: str, path: Array) -> list[StandingSpan]:
    """Return when a joint of a foot stands, and how far it slides.

    Parameters
    ----------
    times : (f,) seconds, even; path : (f, 3) of the joint in the world, metres, +Y up

    Returns
    -------
    stands, in time. A stand is all frames in which the joint is less than 5 cm over its own lowest twentieth and slower
    than 0.5 m/s, for 0.1 s or longer. The slide is the longest distance along the floor between two places of one
    stand.
    """
    return [
        StandingSpan(name, float(times[first]), float(times[end - 1]), _extent(path[first:end][:, [0, 2]]))
        for first, end in stand_frames(times, path).tolist()
    ]


def stand_frames(times: Array, path: Array, margin: float = 1.0) -> NDArray[np.int64]:
    """Return the first and one past the last frame of each stand of a joint, (n, 2); times and path as for `stands_of`.

    margin : factor by which a stand may be higher, faster and shorter than the limits
    """
    if len(times) < 3:
        return np.empty((0, 2), dtype=np.int64)
    step = float(times[1] - times[0])
    low = path[:, 1] < np.percentile(path[:, 1], 5) + margin * SKATE_HEIGHT
    slow = np.linalg.norm(np.gradient(path, step, axis=0), axis=1) < margin * SKATE_SPEED
    spans = runs(low & slow)
    return np.asarray(spans[(spans[:, 1] - spans[:, 0]) * step >= SHORTEST_STAND / margin])


def _extent(places: Array) -> float:
    """Return the longest distance between two of many places (n, 2), to a hundredth: widths along 24 directions."""
    angles = np.arange(24) * np.pi / 24
    return float(np.ptp(places @ np.stack([np.cos(angles), np.sin(angles)]), axis=0).max())


def stands(motion: Motion) -> list[StandingSpan]:
    """Return the stands of all four joints of the feet of a motion of the rig."""
    length = float(motion.times[-1] - motion.times[0])
    times = motion.times[0] + np.arange(int(length * RATE + 1e-6) + 1) / RATE
    places, _ = world_transforms(motion.skeleton, *sample(motion, times))
    names = [name for name in JOINTS if name in motion.skeleton.names]
    return [one for name in names for one in stands_of(times, name, places[:, motion.skeleton.index(name)])]


def slide_figures(motion: Motion, words: str, goals: bool) -> tuple[Figure, ...]:
    """Return the median and worst slide, millimetres. words : added to names; goals : whether figures have goals"""
    slides = [1000.0 * one.slide for one in stands(motion)]
    median, worst = (float(np.median(slides)), max(slides)) if slides else (float("nan"), float("nan"))
    return (
        Figure(f"slide by height and speed, median{words}", median, "mm", MEDIAN if goals else None),
        Figure(f"slide by height and speed, worst{words}", worst, "mm", WORST if goals else None),
    )
