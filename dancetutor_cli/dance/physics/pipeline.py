"""Input skeleton -> ragdoll -> output skeleton; springs and densities searched for a body not seen before."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from dancetutor_cli.chart.timing import heard
from dancetutor_cli.dance.motion import Distances, Motion
from dancetutor_cli.dance.physics.ankles import eased_ankles
from dancetutor_cli.dance.physics.arms import clear_arms, push_arms_out
from dancetutor_cli.dance.physics.blend import Blend, mean_distances, mean_poses
from dancetutor_cli.dance.physics.legs import mass_of, restore_mass_path, risen, soft_legs
from dancetutor_cli.dance.physics.plants import Plants, flatten_toes, let_go, planted, tidied
from dancetutor_cli.dance.physics.pushes import (
    Actor,
    Blow,
    BreakableSoles,
    Push,
    StiffKnees,
    Struck,
    Stumble,
    disturbed,
    parse_push,
    recovered,
    with_push_notes,
)
from dancetutor_cli.dance.physics.ragdoll import NOMINAL, bones_of, place_points, points_of
from dancetutor_cli.dance.physics.repin import AnkleTracks, feet_of, pin_hands, repinned, restrained
from dancetutor_cli.dance.physics.simulation import DEVIATION, LARGEST, MEAN, Ragdoll, follow_all, simulate
from dancetutor_cli.dance.physics.stands import keep_feet_still
from dancetutor_cli.dance.physics.style import PARTS, Spring, Style
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import PARTS as MASSES
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton, beyond
from dancetutor_cli.dance.smoothing import cubic, smooth, upper_envelope
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.run.errors import DancetutorError

# Input skeleton -> ragdoll -> output skeleton: a motion goes in, and the motion that the ragdoll makes of it comes out.

CORRECTIONS = ("knees", "feet", "limits")
GIVING_BACK = 8  # rounds of giving way less where hips or ankles are at their limits
AFTERMATH = 0.3  # seconds over which a push or a trip begins to count; it ceases to count 0.7 s later
BEFORE = 1.0  # seconds of standing still before the first frame, in which springs come to rest
PALM_EXACT = 0.06  # seconds around a pressing palm in which the body is as in the input
PALM_FADE = 0.45  # seconds around a pressing palm over which the input takes over: a palm is where its panel is


@dataclass(frozen=True, slots=True)
class RagdollResult:
    """A motion behind the ragdoll, with feet as in the input; distances : of the ragdoll from the input, before that

    plants : where feet were held to the floor, at the motion's keys; None where they were not to be
    """

    motion: Motion
    distances: Distances
    plants: Plants | None = None


@dataclass(frozen=True, slots=True)
class Wishes:
    """What is to happen to a motion besides its style.

    corrections : of `CORRECTIONS`, for captured motion: knees that pop, feet that skate
    pushes, trips : what befalls her
    own_legs : legs stay as the ragdoll has them, but where feet are corrected or something befalls her
    """

    corrections: tuple[str, ...] = ()
    pushes: tuple[Push, ...] = ()
    trips: tuple[Stumble, ...] = ()
    own_legs: bool = False

    def within(self, start: float, end: float) -> Wishes:
        """The same with only the pushes and trips between two seconds."""
        pushes = tuple(push for push in self.pushes if start <= push.second <= end)
        return replace(self, pushes=pushes, trips=tuple(trip for trip in self.trips if start <= trip.second <= end))


def wishes_of(push: Sequence[str], trip: Sequence[float], rate: float = 1.0) -> Wishes:
    """Pushes and trips from the command line, in seconds of the song, as pushes and trips in music at a rate.

    UsageError for a push that is none.
    """
    pushes = map(parse_push, push)
    return Wishes(
        pushes=tuple(replace(one, second=heard(one.second, rate)) for one in pushes),
        trips=tuple(Stumble(heard(second, rate)) for second in trip),
    )


def through_ragdoll(motion: Motion, blend: Blend, wishes: Wishes = Wishes()) -> RagdollResult:
    """Let the ragdolls of the styles of a blend follow a motion of a skeleton with the dancer's joints.

    Joints without a body keep their turns, feet their places in the world, unless corrected; times stay, and contacts,
    unless she is pushed or caught so that she misses them: then the motion's notes say which.
    Raises DancetutorError with time and joint where the simulation fails, UsageError for points that there are not or
    a push outside of the motion.
    """
    skeleton, corrections = motion.skeleton, wishes.corrections
    motion, blows = disturbed(motion, wishes.pushes, wishes.trips)
    styles, shares = blend.within(motion.times)
    runs = [_followed(motion, one, wishes, blows) for one in styles]
    first, limits = runs[0], any(one.limits for one in styles)
    rotations, root = mean_poses([_read(run.at, *run.made, motion.times) for run in runs], shares)
    distances = mean_distances([run.distances for run in runs], motion.times, shares)
    share = 1.0 - _pressing(motion)
    rotations = quat.slerp(motion.rotations, rotations, share[:, None])
    root = motion.root + share[:, None] * (root - motion.root)
    if limits:
        rotations = restrained(skeleton, rotations, motion.times, share * _undisturbed(motion, wishes))
    if wishes.own_legs and not (wishes.pushes or wishes.trips or "feet" in corrections):
        done = replace(motion, rotations=quat.continuous(rotations), root=root)
        return RagdollResult(done, distances)
    feet, held, plants = feet_of(skeleton, motion.rotations, motion.root), np.ones((len(root), 2)), None
    motion, feet, missed = recovered(motion, feet, root, wishes.pushes)
    if first.soles is not None:
        plants = let_go(skeleton, feet, _at_keys(first.soles.plants(), first.at, motion.times))
        feet, _ = planted(skeleton, feet, plants)
        hips = world_transforms(skeleton, rotations, root)[0][:, [skeleton.index(f"{s}_hip") for s in "lr"]]
        feet, plants, held = keep_feet_still(skeleton, feet, plants, motion.times, hips)
        feet = flatten_toes(skeleton, rotations, feet, plants, held)
    free = root
    if "knees" in corrections:
        root, feet = soft_legs(skeleton, (rotations, free), feet, held, motion.times)
    if wishes.corrections:
        poses = repinned(skeleton, (rotations, root), feet)
    else:
        rotations = clear_arms(skeleton, motion.rotations, (rotations, root), feet, motion.times)
        path = (motion.times, mass_of(skeleton, (motion.rotations, motion.root)))
        calm = _undisturbed(motion, wishes)
        poses = restore_mass_path(skeleton, (rotations, root), feet, path, calm, share)
        if motion.grips:  # arms that are moved there have mass
            poses = restore_mass_path(skeleton, pin_hands(motion, poses, feet), feet, path, calm, share)
    if plants is not None:
        up = risen(skeleton, poses, feet, plants, motion.times) - poses[1]
        poses = repinned(skeleton, (rotations, poses[1] + up), feet)
        poses, feet, plants = eased_ankles(skeleton, poses, feet, plants, held, motion.times)
        if "knees" in corrections:  # feet that were turned need other lengths of their legs
            root, feet = soft_legs(skeleton, (poses[0], free + up), feet, held, motion.times)
            poses = repinned(skeleton, (poses[0], root), feet)
            poses, feet, plants = eased_ankles(skeleton, poses, feet, plants, held, motion.times)
    if not wishes.corrections:
        poses = _possible(motion, poses, feet)
    rotations, root = pin_hands(motion, poses, feet)
    if "limits" in corrections:
        rotations = push_arms_out(skeleton, (rotations, root), motion.times)
    if plants is not None:
        flatten_toes(skeleton, rotations, feet, plants, held)
        if limits:
            rotations = restrained(skeleton, rotations, motion.times)
    done = replace(motion, rotations=quat.continuous(rotations), root=root)
    return RagdollResult(with_push_notes(done, motion.root, wishes.pushes, missed), distances, plants)


def _undisturbed(motion: Motion, wishes: Wishes) -> Array:
    """How undisturbed (f,) the motion is, 0 to 1: less during a push or trip, and for a while after it."""
    out = np.ones(len(motion.times))
    for second in (*(p.second for p in wishes.pushes), *(t.second for t in wishes.trips)):
        since = motion.times - second
        out *= 1.0 - smooth(since / AFTERMATH + 1.0) * smooth((AFTERMATH + 0.7 - since) / AFTERMATH)
    return out


def _possible(motion: Motion, poses: Poses, feet: AnkleTracks) -> Poses:
    """Poses that give way only as far as hips and ankles of feet which stay are within their limits."""
    for _ in range(GIVING_BACK):
        past = np.zeros(len(motion.times))
        for name in (f"{s}_{n}" for s in "lr" for n in ("hip", "talocrural")):
            past = np.maximum(past, beyond(motion.skeleton, name, poses[0][:, motion.skeleton.index(name)]) > 0.5)
        if not past.any():
            break
        share = 0.3 * np.minimum(upper_envelope(motion.times, past, 0.2), 1.0)
        rotations = quat.slerp(poses[0], motion.rotations, share[:, None])
        poses = repinned(motion.skeleton, (rotations, poses[1] + share[:, None] * (motion.root - poses[1])), feet)
    return poses


class _Run(NamedTuple):
    """The result of a ragdoll, its distance from the input, the seconds (f,) of its steps, and its soles then."""

    made: Poses
    distances: Distances
    at: Array
    soles: BreakableSoles | None


def _followed(motion: Motion, style: Style, wishes: Wishes, blows: Sequence[Blow]) -> _Run:
    """What the ragdoll of one style makes of a motion."""
    skeleton, rate = motion.skeleton, style.body.update_rate
    bones = bones_of(skeleton)
    points = points_of(skeleton, bones, style)
    start, length = float(motion.times[0]), float(motion.times[-1] - motion.times[0])
    at = start + np.arange(-int(BEFORE * rate), int(np.ceil(length * rate)) + 1) / rate
    given = _resampled(motion, at, style.body.sample_rate)
    ragdoll = Ragdoll(skeleton, bones, points, style)
    aimed = follow_all(skeleton, *given, style)
    soles = BreakableSoles(ragdoll, *aimed) if "feet" in wishes.corrections else None
    actors: list[Actor] = [StiffKnees(ragdoll)] if "knees" in wishes.corrections else []
    if blows:
        actors.append(Struck(ragdoll, len(at), float(at[0]), blows))
    made = simulate(ragdoll, *aimed, float(at[0]), actors + ([soles] if soles else []))
    first = int(BEFORE * rate)
    shown = tuple(p for p in points if not p.extra)
    apart = place_points(skeleton, bones, shown, *given) - place_points(skeleton, bones, shown, *made)
    distances = Distances(tuple(p.name for p in shown), at[first:], 100.0 * np.linalg.norm(apart[first:], axis=2))
    return _Run(made, distances, at, soles)


def _at_keys(plants: Plants, at: Array, times: Array) -> Plants:
    """Plants of the simulation's steps at a motion's keys."""
    nearest = np.clip(np.round((times - at[0]) / (at[1] - at[0])).astype(np.int64), 0, len(at) - 1)
    rate = (len(times) - 1) / float(times[-1] - times[0])
    return tidied(Plants(plants.heel[nearest], plants.ball[nearest]), rate)


def _read(at: Array, rotations: Array, root: Array, times: Array) -> tuple[Array, Array]:
    """Simulated frames at the keys' times: cubics, for straight lines between steps would jerk."""
    flat = quat.continuous(rotations).reshape(len(at), -1)
    values = cubic(at, np.concatenate((flat, root), axis=1), times)
    return quat.normalize(values[:, :-3].reshape(len(times), -1, 4)), np.ascontiguousarray(values[:, -3:])


def _resampled(motion: Motion, at: Array, sample_rate: float) -> tuple[Array, Array]:
    """The input at `at`: cubics through its keys at the sample rate, straight lines between those samples."""
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
    """How much (f,) each key must be as in the input because a palm presses a panel then: 0 to 1."""
    out = np.zeros(len(motion.times))
    for contact in motion.contacts:
        if contact.limb >= Limb.LEFT_HAND:
            away = np.maximum(np.maximum(contact.start - motion.times, motion.times - contact.end), 0.0)
            out = np.maximum(out, smooth((PALM_FADE - away) / (PALM_FADE - PALM_EXACT)))
    return out


# Springs and densities for a body not seen before: a short search on a standard clip.
#
# Densities give each part the share of the body's mass that it has in a person. Then the search finds the frequency and
# the damping of all springs with which the ragdoll follows the clip most closely, by the goals of one-on-one
# simulation.

FREQUENCIES, DAMPINGS = (24.0, 28.0, 32.0, 36.0, 40.0), (0.4, 0.5, 0.65)
STURDY = 22.0  # kg/m^2: a body's mass is this times the square of its height
DENSITIES = (400.0, 3000.0)  # kg/m^3 that a part may have
OVER_SKULL = 0.17  # metres from the joint of the skull to the crown
_ROUND = 0.6  # seconds of one swing of the standard clip


@dataclass(frozen=True, slots=True)
class Tuning:
    """What a body changes of a style. stretch : factor of all frequencies; damping : of all dampings

    density : by part, kg/m^3 where the style has 1000
    """

    stretch: float
    damping: float
    density: Mapping[str, float]

    def of(self, style: Style) -> Style:
        """The style for this body."""
        springs, points = (
            {
                name: Spring(
                    (s.frequency[0] * self.stretch, s.frequency[1] * self.stretch, s.frequency[2] * self.stretch),
                    (s.damping[0] * self.damping, s.damping[1] * self.damping, s.damping[2] * self.damping),
                )
                for name, s in given.items()
            }
            for given in (style.springs, style.points)
        )
        density = {part: value * self.density[part] / NOMINAL for part, value in style.density.items()}
        return replace(style, springs=springs, points=points, density=density)

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: Any) -> Tuning | None:
        """The tuning in plain data; None if it is none."""
        try:
            density = {part: float(data["density"][part]) for part in PARTS}
            values = (float(data["stretch"]), float(data["damping"]), *density.values())
        except (KeyError, TypeError, ValueError):
            return None
        return cls(values[0], values[1], density) if all(0 < v < 1e5 for v in values) else None


def tuned(body: Skeleton, neutral: Style) -> Tuning:
    """Search. body : named as the rig's; raises DancetutorError if the ragdoll follows with no springs at all."""
    density, clip = _densities(body), standard_clip(body)
    base = neutral.springs["chest"]
    best: tuple[float, Tuning] | None = None
    for damping in (base.damping[0], *(d for d in DAMPINGS if d != base.damping[0])):
        stretches = FREQUENCIES if best is None else (best[1].stretch * base.frequency[0],)
        for frequency in stretches:
            tuning = Tuning(frequency / base.frequency[0], damping / base.damping[0], density)
            score = _score(clip, tuning.of(neutral))
            if best is None or score < best[0]:
                best = score, tuning
    assert best is not None
    if not np.isfinite(best[0]):
        raise DancetutorError("no ragdoll of this body can follow the motion; use another character")
    return best[1]


def _score(clip: Motion, style: Style) -> float:
    """The worst of the three figures in parts of its goal; infinite where the simulation fails."""
    try:
        mean, deviation, largest = through_ragdoll(clip, Blend.of(style)).distances.worst
    except DancetutorError:
        return float("inf")
    return max(mean / MEAN, deviation / DEVIATION, largest / LARGEST)


def _densities(body: Skeleton) -> dict[str, float]:
    """Kilograms per cubic metre with which each part weighs its share (de Leva's) of a sturdy person of this height."""
    height = float(body.rest[body.index("skullbase")][1]) + OVER_SKULL
    own: dict[str, float] = dict.fromkeys(PARTS, 0.0)
    for bone in bones_of(body):
        own[bone.part] += bone.mass
    part_of = {bone.name: bone.part for bone in bones_of(body)}
    wanted: dict[str, float] = dict.fromkeys(PARTS, 0.0)
    total = 0.0
    for name, share, _ in MASSES:
        times = 2 if name.startswith("l_") else 1
        wanted[part_of[name]] += share * times
        total += share * times
    mass = STURDY * height**2
    wanted["clavicles"], wanted["spine"] = 0.05 * total, wanted["spine"] - 0.05 * total  # de Leva has them in the trunk
    return {p: float(np.clip(NOMINAL * mass * wanted[p] / total / own[p], *DENSITIES)) for p in PARTS}


def standard_clip(body: Skeleton) -> Motion:
    """Treading on the spot just over the floor: knees, arms, forearms, trunk and head swing at their own paces."""
    fps, seconds = 60, 2.4
    t = np.arange(round(seconds * fps) + 1) / fps
    w = 2 * np.pi * t / (2 * _ROUND)
    rotations = np.zeros((len(t), len(body.names), 4))
    rotations[..., 0] = 1
    x, y, z = np.eye(3)

    def turn(name: str, axis: Any, degrees: Any) -> None:
        j = body.index(name)
        rotations[:, j] = quat.multiply(rotations[:, j], quat.from_axis_angle(axis, np.radians(degrees)))

    for s, sign in (("l", 1), ("r", -1)):
        bend = 45 + 40 * np.sin(w) * sign
        turn(f"{s}_hip", x, -bend / 2)
        turn(f"{s}_knee", x, bend)
        turn(f"{s}_talocrural", x, -bend / 2)
        turn(f"{s}_shoulder", x, 25 * sign * np.sin(w))
        turn(f"{s}_elbow", np.cross(body.offsets[body.index(f"{s}_elbow")], z), 40 + 25 * np.sin(1.3 * w))
    turn("vl5", y, 12 * np.sin(w))
    turn("vt10", x, 8 + 6 * np.sin(2 * w))
    turn("skullbase", y, 25 * np.sin(0.7 * w))
    root = body.rest[0] + np.column_stack((0.05 * np.sin(w / 2), 0.02 * np.sin(2 * w) + 0.025, 0.03 * np.cos(w / 2)))
    return Motion(body, float(fps), t, rotations, root, ())
