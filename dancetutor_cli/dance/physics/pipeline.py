"""Input skeleton -> ragdoll -> output skeleton: the way of a motion through a ragdoll."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from dancetutor_cli.chart.timing import heard_second
from dancetutor_cli.dance.motion import Distances, Motion
from dancetutor_cli.dance.physics.arms import clear_arms, push_arms_out
from dancetutor_cli.dance.physics.blend import Blend, mean_distances, mean_poses
from dancetutor_cli.dance.physics.legs import eased_ankles, raised_root, restore_mass_path, soft_legs
from dancetutor_cli.dance.physics.plants import Plants, flatten_toes, planted, release_rolling_feet, tidied
from dancetutor_cli.dance.physics.pushes import (
    Actor,
    BreakableSoles,
    ChestForces,
    Impulse,
    Push,
    StiffKnees,
    Stumble,
    disturbed,
    parse_push,
    recovered,
    with_push_notes,
)
from dancetutor_cli.dance.physics.ragdoll import bones_of, place_points, points_of
from dancetutor_cli.dance.physics.repin import AnkleTracks, feet_of, pin_hands, repinned, restrained
from dancetutor_cli.dance.physics.simulation import Ragdoll, follow_all, simulate
from dancetutor_cli.dance.physics.stands import keep_feet_still
from dancetutor_cli.dance.physics.style import Style
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import mass_of, world_transforms
from dancetutor_cli.dance.rig.skeleton import beyond
from dancetutor_cli.dance.smoothing import cubic, smooth, upper_envelope
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.feet.limbs import Limb

CORRECTIONS = ("knees", "feet", "limits")
GIVING_BACK = 8  # rounds of giving way less if hips or ankles are at their limits
AFTERMATH = 0.3  # seconds over which the effect of a push or a trip begins; it ends 0.7 s later
BEFORE = 1.0  # seconds of standing still before the first frame, in which springs come to rest
PALM_EXACT = 0.06  # seconds around a pressing palm in which the body is as in the input
PALM_FADE = 0.45  # seconds around a pressing palm over which the input takes over, because a palm must be on its panel


@dataclass(frozen=True, slots=True)
class RagdollResult:
    """A motion behind the ragdoll, with feet as in the input; distances : of the ragdoll from the input, before that

    plants : the held feet, at the motion's keys; None if feet are not corrected
    """

    motion: Motion
    distances: Distances
    plants: Plants | None = None


@dataclass(frozen=True, slots=True)
class RagdollOptions:
    """The changes of a motion besides its style.

    corrections : of `CORRECTIONS`, for captured motion: knees that pop, feet that skate
    pushes, stumbles : disturbances of the dancer
    own_legs : legs stay as the ragdoll has them, unless feet are corrected or the dancer is disturbed
    """

    corrections: tuple[str, ...] = ()
    pushes: tuple[Push, ...] = ()
    stumbles: tuple[Stumble, ...] = ()
    own_legs: bool = False

    def within(self, start: float, end: float) -> RagdollOptions:
        """Return the same with only the pushes and trips between two seconds."""
        pushes = tuple(one for one in self.pushes if start <= one.second <= end)
        return replace(self, pushes=pushes, stumbles=tuple(one for one in self.stumbles if start <= one.second <= end))


def parse_ragdoll_options(push: Sequence[str], trip: Sequence[float], rate: float = 1.0) -> RagdollOptions:
    """Return pushes and trips from the command line (seconds of the song) as pushes and trips in music at a rate.

    Raises UsageError for a text that is not a push.
    """
    pushes = map(parse_push, push)
    return RagdollOptions(
        pushes=tuple(replace(one, second=heard_second(one.second, rate)) for one in pushes),
        stumbles=tuple(Stumble(heard_second(second, rate)) for second in trip),
    )


def through_ragdoll(motion: Motion, blend: Blend, options: RagdollOptions = RagdollOptions()) -> RagdollResult:
    """Let the ragdolls of the styles of a blend follow a motion of a skeleton with the dancer's joints.

    Joints without a body keep their turns. Feet keep their places in the world, unless corrected. Times stay, and
    contacts, unless a push or trip makes the dancer miss them: then the motion's notes list them.
    Raises DancetutorError with time and joint where the simulation fails, UsageError for unknown points or a push
    outside of the motion.

    The order of work (docs/physics.md):

    1. Pushes and trips change the input; the ragdoll of each style follows it, and the mean of all is taken.
    2. Near a palm that presses a panel the input replaces it. Joints are brought within their limits if a style wants
    that.
    3. With `own_legs` this is all, unless feet are corrected or the dancer is disturbed.
    4. Feet get the places of the input, unless a push makes the dancer stagger.
    5. In a dance, arms, weight and palms are put back (`_put_back`); captured motion is corrected (`_corrected`).
    """
    given, impulses = disturbed(motion, options.pushes, options.stumbles)
    styles, shares = blend.within(given.times)
    limits = any(style.limits for style in styles)
    runs = [_followed(given, style, options, impulses) for style in styles]
    distances = mean_distances([run.distances for run in runs], given.times, shares)
    free, calm = 1.0 - _pressing(given), _undisturbed(given, options)
    rotations, root = mean_poses([_read(run.at, *run.made, given.times) for run in runs], shares)
    rotations = quat.slerp(given.rotations, rotations, free[:, None])
    root = given.root + free[:, None] * (root - given.root)
    if limits:
        rotations = restrained(given.skeleton, rotations, given.times, free * calm)
    if options.own_legs and not (options.pushes or options.stumbles or "feet" in options.corrections):
        return RagdollResult(_with_poses(given, Poses(rotations, root)), distances)
    feet = feet_of(given.skeleton, given.rotations, given.root)
    goal, feet, missed = recovered(given, feet, root, options.pushes)
    if options.corrections:
        poses, plants = _corrected(goal, Poses(rotations, root), feet, runs[0], options.corrections, limits)
    else:
        poses, plants = _put_back(goal, Poses(rotations, root), feet, calm, free), None
    noted = with_push_notes(_with_poses(goal, poses), goal.root, options.pushes, missed)
    return RagdollResult(noted, distances, plants)


def _with_poses(motion: Motion, poses: Poses) -> Motion:
    return replace(motion, rotations=quat.continuous(poses.rotations), root=poses.root)


def _put_back(goal: Motion, poses: Poses, feet: AnkleTracks, calm: Array, free: Array) -> Poses:
    """Return poses of a dance with arms clear of the body, the mass on its path, joints in limits, palms on the bar.

    goal : the input; feet : the ends of the legs; calm, free : (f,) 0 to 1, how undisturbed the dancer is, and how far
    she may differ from the input
    """
    skeleton = goal.skeleton
    rotations = clear_arms(skeleton, goal.rotations, poses, feet, goal.times)
    path = (goal.times, mass_of(skeleton, Poses(goal.rotations, goal.root)))
    poses = restore_mass_path(skeleton, Poses(rotations, poses.root), feet, path, calm, free)
    if goal.grips:  # arms that move to the bar have mass
        poses = restore_mass_path(skeleton, pin_hands(goal, poses, feet), feet, path, calm, free)
    return pin_hands(goal, _possible(goal, poses, feet), feet)


def _corrected(
    goal: Motion, poses: Poses, feet: AnkleTracks, run: _Run, corrections: Sequence[str], limits: bool
) -> tuple[Poses, Plants | None]:
    """Return captured motion with the requested corrections, and its held feet: None if feet are not corrected.

    Feet stand still first, because knees, the height of the root and ankles follow from them. Then come palms on the
    bar, arms out of the trunk, and flat toes. goal : the input; run : of the ragdoll; limits : whether a style has
    limits
    """
    skeleton, times = goal.skeleton, goal.times
    rotations, root = poses  # the turns of toes are changed in place
    held, plants = np.ones((len(root), 2)), None
    if run.soles is not None:
        plants = release_rolling_feet(skeleton, feet, _at_keys(run.soles.plants(), run.at, times))
        feet, _ = planted(skeleton, feet, plants)
        hips = world_transforms(skeleton, rotations, root)[0][:, [skeleton.index(f"{s}_hip") for s in "lr"]]
        feet, plants, held = keep_feet_still(skeleton, feet, plants, times, hips)
        feet = flatten_toes(skeleton, rotations, feet, plants, held)
    sunk = root
    if "knees" in corrections:
        sunk, feet = soft_legs(skeleton, Poses(rotations, root), feet, held, times)
    poses = repinned(skeleton, Poses(rotations, sunk), feet)
    if plants is not None:
        up = raised_root(skeleton, poses, feet, plants, times) - poses.root
        poses = repinned(skeleton, Poses(rotations, poses.root + up), feet)
        poses, feet, plants = eased_ankles(skeleton, poses, feet, plants, held, times)
        if "knees" in corrections:  # turned feet need other lengths of their legs
            sunk, feet = soft_legs(skeleton, Poses(poses.rotations, root + up), feet, held, times)
            poses = repinned(skeleton, Poses(poses.rotations, sunk), feet)
            poses, feet, plants = eased_ankles(skeleton, poses, feet, plants, held, times)
    turned, place = pin_hands(goal, poses, feet)
    if "limits" in corrections:
        turned = push_arms_out(skeleton, Poses(turned, place), times)
    if plants is not None:
        flatten_toes(skeleton, turned, feet, plants, held)
        if limits:
            turned = restrained(skeleton, turned, times)
    return Poses(turned, place), plants


def _undisturbed(motion: Motion, options: RagdollOptions) -> Array:
    """Return how undisturbed (f,) the motion is, 0 to 1: less during a push or trip, and for a while after it."""
    out = np.ones(len(motion.times))
    for second in (*(p.second for p in options.pushes), *(t.second for t in options.stumbles)):
        since = motion.times - second
        out *= 1.0 - smooth(since / AFTERMATH + 1.0) * smooth((AFTERMATH + 0.7 - since) / AFTERMATH)
    return out


def _possible(motion: Motion, poses: Poses, feet: AnkleTracks) -> Poses:
    """Return poses that give way only as far as hips and ankles are within their limits; feet keep their places."""
    for _ in range(GIVING_BACK):
        past = np.zeros(len(motion.times))
        for name in (f"{s}_{n}" for s in "lr" for n in ("hip", "talocrural")):
            turns = poses.rotations[:, motion.skeleton.index(name)]
            past = np.maximum(past, beyond(motion.skeleton, name, turns) > 0.5)
        if not past.any():
            break
        share = 0.3 * np.minimum(upper_envelope(motion.times, past, 0.2), 1.0)
        rotations = quat.slerp(poses.rotations, motion.rotations, share[:, None])
        root = poses.root + share[:, None] * (motion.root - poses.root)
        poses = repinned(motion.skeleton, Poses(rotations, root), feet)
    return poses


class _Run(NamedTuple):
    """The result of a ragdoll, its distances from the input, the seconds (f,) of its steps, and its soles."""

    made: Poses
    distances: Distances
    at: Array
    soles: BreakableSoles | None


def _followed(motion: Motion, style: Style, options: RagdollOptions, impulses: Sequence[Impulse]) -> _Run:
    """Let the ragdoll of one style follow a motion."""
    skeleton, rate = motion.skeleton, style.body.update_rate
    bones = bones_of(skeleton)
    points = points_of(skeleton, bones, style)
    start, length = float(motion.times[0]), float(motion.times[-1] - motion.times[0])
    at = start + np.arange(-int(BEFORE * rate), int(np.ceil(length * rate)) + 1) / rate
    given = _resampled(motion, at, style.body.sample_rate)
    ragdoll = Ragdoll(skeleton, bones, points, style)
    aimed = follow_all(skeleton, *given, style)
    soles = BreakableSoles(ragdoll, *aimed) if "feet" in options.corrections else None
    actors: list[Actor] = [StiffKnees(ragdoll)] if "knees" in options.corrections else []
    if impulses:
        actors.append(ChestForces(ragdoll, len(at), float(at[0]), impulses))
    made = simulate(ragdoll, *aimed, float(at[0]), actors + ([soles] if soles else []))
    first = int(BEFORE * rate)
    shown = tuple(p for p in points if not p.extra)
    apart = place_points(skeleton, bones, shown, *given) - place_points(skeleton, bones, shown, *made)
    distances = Distances(tuple(p.name for p in shown), at[first:], 100.0 * np.linalg.norm(apart[first:], axis=2))
    return _Run(Poses(*made), distances, at, soles)


def _at_keys(plants: Plants, at: Array, times: Array) -> Plants:
    """Return the plants of the simulation's steps at a motion's keys."""
    nearest = np.clip(np.round((times - at[0]) / (at[1] - at[0])).astype(np.int64), 0, len(at) - 1)
    rate = (len(times) - 1) / float(times[-1] - times[0])
    return tidied(Plants(plants.heel[nearest], plants.ball[nearest]), rate)


def _read(at: Array, rotations: Array, root: Array, times: Array) -> Poses:
    """Return simulated frames at the keys' times: cubics, because straight lines between steps would jerk."""
    flat = quat.continuous(rotations).reshape(len(at), -1)
    values = cubic(at, np.concatenate((flat, root), axis=1), times)
    return Poses(quat.normalize(values[:, :-3].reshape(len(times), -1, 4)), np.ascontiguousarray(values[:, -3:]))


def _resampled(motion: Motion, at: Array, sample_rate: float) -> tuple[Array, Array]:
    """Return the input at `at`: cubics through its keys at the sample rate, straight lines between these samples."""
    turns = quat.continuous(motion.rotations)
    flat = turns.reshape(len(turns), -1)
    grid = at[0] + np.arange(int(np.ceil((at[-1] - at[0]) * sample_rate - 1e-9)) + 1) / sample_rate
    both = cubic(motion.times, np.concatenate((flat, motion.root), axis=1), grid)
    place = np.clip((at - at[0]) * sample_rate, 0.0, len(grid) - 1.0)
    before = np.minimum(np.round(place, 9).astype(np.int64), len(grid) - 2)
    share = (place - before)[:, None]
    values = (1.0 - share) * both[before] + share * both[before + 1]
    return quat.normalize(values[:, :-3].reshape(len(at), -1, 4)), np.ascontiguousarray(values[:, -3:])


def _pressing(motion: Motion) -> Array:
    """Return how much (f,) each key must be as in the input because a palm presses a panel, 0 to 1."""
    out = np.zeros(len(motion.times))
    for contact in motion.contacts:
        if contact.limb >= Limb.LEFT_HAND:
            away = np.maximum(np.maximum(contact.start - motion.times, motion.times - contact.end), 0.0)
            out = np.maximum(out, smooth((PALM_FADE - away) / (PALM_FADE - PALM_EXACT)))
    return out
