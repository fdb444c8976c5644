"""The baked motion: joint rotations per frame, the contacts that they must keep, and samples at any times."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.unplayable import DroppedNote


@dataclass(frozen=True, slots=True)
class Contact:
    """A limb that presses a panel: from `start` (the note) to `end`, seconds of the song's music.

    limb, kind, part : values of `feet.limbs.Limb`, `StepKind` and `Part`; column : note column
    row : index of the row in the play; panel : (x, z) of the panel's centre in the world, metres
    """

    start: float
    end: float
    limb: int
    column: int
    kind: int
    part: int
    row: int
    panel: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Bar:
    """The bar behind a pad, which players hold on to; metres in the world.

    height, behind : y and z of the rail's middle line; radius : of the rail
    spans : (x0, x1) of each of its pieces, x0 < x1: one behind every square of nine panels
    """

    height: float
    behind: float
    radius: float
    spans: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class Grip:
    """A hand that rests on the bar from `start` to `end` seconds, its palm over `x`; side 0 left, 1 right.

    across : whether the hand has crossed over in front of the dancer, because her side faces away from the bar
    """

    start: float
    end: float
    side: int
    x: float
    across: bool = False


@dataclass(frozen=True, slots=True)
class Ground:
    """The pad, a rectangle from `low` to `high` (x, z) at height 0, and the floor around it, `drop` metres lower."""

    low: tuple[float, float]
    high: tuple[float, float]
    drop: float

    def level(self, x: float, z: float) -> float:
        """Return the height of the ground at a place, metres."""
        return 0.0 if self.low[0] <= x <= self.high[0] and self.low[1] <= z <= self.high[1] else -self.drop

    def levels(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the height of the ground (...) under points (..., 3)."""
        over = places[..., [0, 2]]
        on = ((over >= np.array(self.low) - 1e-6) & (over <= np.array(self.high) + 1e-6)).all(axis=-1)
        return np.where(on, 0.0, -self.drop)


@dataclass(frozen=True, slots=True)
class Motion:
    """Joint rotations over time. f frames, j joints.

    times : float64 (f,), seconds of the music, strictly increasing; regular at `fps` plus extra keys at contacts
    rotations : float64 (f, j, 4), local unit quaternions (w, x, y, z)
    root : float64 (f, 3), position of joint 0 in the world, metres
    fps : nominal frames per second; contacts : sorted by start
    bar : the bar that the dancer holds, None for no bar; grips : when and where she holds it, sorted by start
    notes : remarks on the bake for the user: where limits of the body were exceeded
    ground : pad and floor, None if the dancer stays on the pad and the ground has the height 0 everywhere
    dropped : notes that the dancer does not play, sorted by second
    """

    skeleton: Skeleton
    fps: float
    times: NDArray[np.float64]
    rotations: NDArray[np.float64]
    root: NDArray[np.float64]
    contacts: tuple[Contact, ...]
    bar: Bar | None = None
    grips: tuple[Grip, ...] = ()
    ground: Ground | None = None
    notes: tuple[str, ...] = ()
    dropped: tuple[DroppedNote, ...] = ()


@dataclass(frozen=True, slots=True)
class Cut:
    """A part of a dance, from `start` to `end`, seconds of the music as it is heard.

    steps_from : the dancer stands still before this second; steps_until : from this second on she comes to rest
    walks_on, walks_off : whether the cut may show her walk onto the pad before the first note, and off it after the
    last;
    otherwise she stands on the pad
    """

    start: float
    end: float
    steps_from: float = -np.inf
    steps_until: float = np.inf
    walks_on: bool = True
    walks_off: bool = True


def shifted(motion: Motion, x: float, z: float) -> Motion:
    """Return the motion, with its contacts, grips, bar and ground, moved along the ground by x and z metres."""
    if x == z == 0.0:
        return motion
    bar, ground = motion.bar, motion.ground
    return replace(
        motion,
        root=motion.root + np.array([x, 0.0, z]),
        contacts=tuple(replace(one, panel=(one.panel[0] + x, one.panel[1] + z)) for one in motion.contacts),
        grips=tuple(replace(one, x=one.x + x) for one in motion.grips),
        bar=bar and replace(bar, behind=bar.behind + z, spans=tuple((a + x, b + x) for a, b in bar.spans)),
        ground=ground and replace(ground, low=_plus(ground.low, x, z), high=_plus(ground.high, x, z)),
    )


def padded_from(motion: Motion, second: float) -> Motion:
    """Return a motion that begins at `second` or earlier; the dancer stands in its first pose until it begins."""
    if second >= motion.times[0]:
        return motion
    return replace(
        motion,
        times=np.insert(motion.times, 0, second),
        rotations=np.concatenate((motion.rotations[:1], motion.rotations)),
        root=np.concatenate((motion.root[:1], motion.root)),
    )


def _plus(place: tuple[float, float], x: float, z: float) -> tuple[float, float]:
    return place[0] + x, place[1] + z


@dataclass(frozen=True, slots=True)
class Distances:
    """The distances of a ragdoll from its input: of p retargeting points, without the extra ones, over f moments.

    names : (p,); times : (f,) seconds; values : (f, p) centimetres between input and ragdoll
    """

    names: tuple[str, ...]
    times: NDArray[np.float64]
    values: NDArray[np.float64]

    def table(self) -> dict[str, tuple[float, float, float, float]]:
        """Return the minimum, maximum, mean and standard deviation of every point, centimetres."""
        v = self.values
        columns = zip(v.min(axis=0), v.max(axis=0), v.mean(axis=0), v.std(axis=0), strict=True)
        return {
            n: (float(a), float(b), float(c), float(d)) for n, (a, b, c, d) in zip(self.names, columns, strict=True)
        }

    @property
    def worst(self) -> tuple[float, float, float]:
        """The largest mean, standard deviation and distance of any point, centimetres; the goals limit them."""
        v = self.values
        return float(v.mean(axis=0).max()), float(v.std(axis=0).max()), float(v.max())


# The motion at any times: between keys, rotations are slerped and the root moves straight, as in every viewer.


def sample(motion: Motion, times: Array) -> tuple[Array, Array]:
    """Return local rotations (f, j, 4) and root (f, 3) at `times` (f,), seconds; constant before and after the keys."""
    at = np.clip(times, motion.times[0], motion.times[-1])
    after = np.clip(np.searchsorted(motion.times, at, side="right"), 1, len(motion.times) - 1)
    before = after - 1
    share = (at - motion.times[before]) / (motion.times[after] - motion.times[before])
    rotations = quat.slerp(motion.rotations[before], motion.rotations[after], share[:, None])
    root = motion.root[before] + share[:, None] * (motion.root[after] - motion.root[before])
    return rotations, root
