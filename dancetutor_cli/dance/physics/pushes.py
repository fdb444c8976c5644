"""Forces on a ragdoll besides its springs: soles that hold and break loose, shoves, obstacles that catch a foot."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from dancetutor_cli.dance.context import held_notes
from dancetutor_cli.dance.physics.plants import Plants, cleared
from dancetutor_cli.dance.physics.repin import AnkleTracks, feet_of, repinned
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import sole_points, world_transforms
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.feet.limbs import NAMES
from dancetutor_cli.run.errors import UsageError, choose_text

if TYPE_CHECKING:
    from dancetutor_cli.dance.motion import Contact, Motion
    from dancetutor_cli.dance.physics.simulation import Ragdoll


NEAR = 0.008  # metres over the floor at which a corner of a sole gets a joint with the floor
SLOW, AIMED = 0.6, 0.03  # m/s and metres: largest speed and height of a corner in the input for such a joint
HOLD, LIFT = 600.0, 60.0  # newtons along the floor and off it at which the joint of a corner breaks
KNEE = 10.0  # degrees of bend below which a knee is damped: an inner angle of 170 degrees
DAMPING = 8.0  # N m s/rad at a straight knee


class Actor(ABC):
    """A participant in a simulation. `constraints` : XML of the engine's equality section"""

    constraints = ""

    @abstractmethod
    def before(self, model: Any, data: Any, step: int) -> None:
        """Act before each step of the engine."""

    def springs(self, step: int) -> tuple[Array, Array] | None:
        """Return the parts of kp and kd (a,) that the actuators have in a step; None: all of them."""
        return None


class StiffKnees(Actor):
    """Knees that are damped from 170 degrees on, so that they do not pop: larger angles are possible, but slow."""

    def __init__(self, ragdoll: Ragdoll) -> None:
        self.names = [f"{s}_knee" for s in "lr"]
        style = ragdoll.style
        self.base = [style.stiffness.get(name, style.body.stiffness) for name in self.names]
        self.places: list[tuple[int, int]] = []

    def before(self, model: Any, data: Any, step: int) -> None:
        """Set the damping of the bends of both knees."""
        if not self.places:
            for name in self.names:
                joint = int(model.body(name).jntadr[0])
                self.places.append((int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])))
        for base, (angle, speed) in zip(self.base, self.places, strict=True):
            bend = np.degrees(data.qpos[angle])
            model.dof_damping[speed] = base + DAMPING * min(max(1.0 - bend / KNEE, 0.0), 1.0)


class BreakableSoles(Actor):
    """Four joints between each foot's corners and the floor: made where the sole touches it, broken by too much force.

    `plants` returns the joints that held, step by step.
    """

    def __init__(self, ragdoll: Ragdoll, rotations: Array, root: Array) -> None:
        skeleton = ragdoll.skeleton
        rest = skeleton.rest
        positions, world = world_transforms(skeleton, rotations, root)
        bodies = [bone.name for bone in ragdoll.bones]
        self.bodies: list[int] = []
        self.offsets, targets, lines = [], [], []
        for side, points in zip("lr", sole_points(skeleton), strict=True):
            ankle = skeleton.index(f"{side}_talocrural")
            for point in points[:4]:  # heel in, heel out, ball in, ball out
                offset = rest[point.joint] + point.offset - rest[ankle]
                self.bodies.append(bodies.index(f"{side}_talocrural") + 1)  # body 0 is the world
                self.offsets.append(offset)
                targets.append(positions[:, ankle] + quat.rotate(world[:, ankle], offset))
                anchor = " ".join(f"{x:.9g}" for x in offset)
                lines.append(
                    f'<connect body1="{side}_talocrural" anchor="{anchor}" active="false" solref="0.012 1" '
                    'solimp="0.95 0.99 0.001"/>'
                )
        self.constraints = "".join(lines)
        self.aimed = np.stack(targets, axis=1)
        speed = np.gradient(self.aimed, 1.0 / ragdoll.style.body.update_rate, axis=0)
        self.slow = (np.linalg.norm(speed[..., [0, 2]], axis=2) < SLOW) & (self.aimed[..., 1] < AIMED)
        self.held = np.zeros(self.slow.shape, dtype=bool)

    def before(self, model: Any, data: Any, step: int) -> None:
        """Break the joints under too much force, and make joints for corners that touch the floor."""
        active = np.flatnonzero(data.eq_active)
        for place, corner in enumerate(active.tolist()):
            x, y, z = data.efc_force[3 * place : 3 * place + 3] if data.nefc >= 3 * place + 3 else (0.0, 0.0, 0.0)
            leaves = not self.slow[step, corner] and self.aimed[step, corner, 1] > AIMED
            if leaves or np.hypot(x, z) > HOLD or -y > LIFT:
                data.eq_active[corner] = 0
        for corner in np.flatnonzero(self.slow[step] & (data.eq_active == 0)).tolist():
            body = self.bodies[corner]
            matrix = data.xmat[body].reshape(3, 3)
            place = data.xpos[body] + matrix @ self.offsets[corner]
            if place[1] < NEAR:
                model.eq_data[corner, 3:6] = place
                data.eq_active[corner] = 1
        self.held[step] = data.eq_active != 0

    def plants(self) -> Plants:
        """Return the ends of both feet that were held in each step."""
        held = self.held.reshape(-1, 2, 2, 2)  # step, foot, heel or ball, in or out
        either = held[..., 0] | held[..., 1]
        return Plants(either[:, :, 0], either[:, :, 1])


# Pushes and trips: a shove against the chest, or an obstacle that catches a foot. Springs soften while they act.
#
# The dancer gives way as a body does, and the springs bring her back within a second. Feet step as planned, unless the
# push is too strong: then she staggers, and misses the notes of that time. A caught foot is late, and misses the notes
# that it cannot reach in time.

Impulse = tuple[float, Array]  # second, and force (3,) in newtons, world
LASTS = 0.15  # seconds that a push acts, and that an obstacle holds a foot
CHEST = 0.10  # metres over vt4 at which a push strikes
SOFT = 1e-4  # least share of its stiffness that a spring keeps: 32 Hz become 0.32
LOOSE = 1.4  # factor of the damping ratio of a spring when it is softest
UPRIGHT = 0.35  # exponent of the share that upward springs keep: the dancer bends aside more than she sags
FIRM = ("shanks", "feet")  # parts whose springs do not change
BACK = 0.75  # seconds after the push until springs are as stiff as before
STRONGEST = 3000.0  # newtons
TRIP_FORCE = 350.0  # newtons that throw the dancer ahead when a foot is caught
MOVES = 0.05  # m/s from which on a caught foot is off the floor
CATCH_UP = 0.30  # seconds in which a caught foot returns to its own path
FALL = 0.22  # metres of giving way beyond which the dancer cannot stay on her feet
STAGGER, STAGGER_LIFT = 0.80, 0.07  # seconds that the dancer staggers, and metres by which her feet rise meanwhile
_WAYS = {"ahead": 0.0, "left": 90.0, "back": 180.0, "right": 270.0}


@dataclass(frozen=True, slots=True)
class Push:
    """A push at `second` with `newtons` towards `degrees` from the dancer's front, to her left; 0 pushes her ahead."""

    second: float
    newtons: float
    degrees: float


@dataclass(frozen=True, slots=True)
class Stumble:
    """A trip: an obstacle catches the foot that is in the air at `second`, or the next one in the air."""

    second: float


def parse_push(text: str) -> Push:
    """Read a push as on the command line, TIME:FORCE:DIRECTION. Raises a UsageError of one line if it is not one."""
    parts = text.split(":")
    if len(parts) != 3:
        raise UsageError(f"--push {text}: write TIME:FORCE:DIRECTION, for example 12.5:300:left")
    second, newtons = (_number(text, word, what) for word, what in zip(parts[:2], ("time", "force"), strict=True))
    if not 0 < newtons <= STRONGEST:
        raise UsageError(f"--push {text}: the force must be more than 0 and at most {STRONGEST:g} newtons")
    way = parts[2].strip().lower()
    if way in _WAYS:
        return Push(second, newtons, _WAYS[way])
    try:
        degrees = float(way)
    except ValueError:
        ways = choose_text(way, _WAYS, "degrees")
        raise UsageError(f"--push {text}: there is no direction '{way}'{ways}") from None
    if not abs(degrees) <= 360:
        raise UsageError(f"--push {text}: the direction must be at most 360 degrees")
    return Push(second, newtons, degrees)


def _number(text: str, word: str, what: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = float("nan")
    if not abs(value) < 1e6:
        raise UsageError(f"--push {text}: the {what} '{word}' is not a number")
    return value


class ChestForces(Actor):
    """Forces on the chest, and the softer springs while they act."""

    def __init__(self, ragdoll: Ragdoll, steps: int, start: float, impulses: Sequence[Impulse]) -> None:
        """steps : of the simulation, the first at second `start`"""
        times = start + np.arange(steps) / ragdoll.style.body.update_rate
        self.chest = next(k for k, bone in enumerate(ragdoll.bones) if bone.name == "vt4") + 1
        self.force = np.zeros((len(times), 3))
        soft = np.zeros(len(times))
        for second, force in impulses:
            since = times - second
            self.force[(since >= 0) & (since < LASTS)] += force
            soft = np.maximum(soft, smooth(since / 0.03 + 1) * smooth((BACK - since) / (BACK - LASTS)))
        self.stiff = SOFT**soft  # falls to SOFT, and rises again by equal factors in equal times
        self.share = np.array([0.0 if p.part in FIRM else s for p in ragdoll.points for s in (1.0, UPRIGHT, 1.0)])
        gains = [p.gains(ragdoll.style) for p in ragdoll.points]
        self.kp, self.kd = (np.concatenate([g[k] for g in gains]) for k in (0, 1))

    def springs(self, step: int) -> tuple[Array, Array]:
        """Return the parts of kp and kd (a,) that all actuators have in a step; softer springs swing less."""
        kp = self.stiff[step] ** self.share
        return kp, np.sqrt(kp) * (LOOSE + (1.0 - LOOSE) * kp)

    def before(self, model: Any, data: Any, step: int) -> None:
        """Set the force and the springs; the forces of the style become weaker with the springs."""
        kp, kd = self.springs(step)
        model.actuator_biasprm[:, 1] = -self.kp * kp
        model.actuator_biasprm[:, 2] = -self.kd * kd
        data.xfrc_applied[1:, :3] *= self.stiff[step]
        body = self.chest
        lever = data.xmat[body].reshape(3, 3) @ np.array([0.0, CHEST, 0.0])
        data.xfrc_applied[body, 3:] = np.cross(lever + data.xpos[body] - data.xipos[body], self.force[step])
        data.xfrc_applied[body, :3] += self.force[step]


def heading(motion: Motion, second: float) -> float:
    """Return the direction of the dancer at a moment: radians from +Z to +X."""
    k = int(np.argmin(np.abs(motion.times - second)))
    ahead = quat.rotate(motion.rotations[k, 0], np.array([0.0, 0.0, 1.0]))
    return float(np.arctan2(ahead[0], ahead[2]))


def force_of(push: Push, motion: Motion) -> Array:
    """Return the force (3,) of a push in the world."""
    angle = heading(motion, push.second) + np.radians(push.degrees)
    return push.newtons * np.array([np.sin(angle), 0.0, np.cos(angle)])


def catch_foot(motion: Motion, feet: AnkleTracks, stumble: Stumble) -> tuple[AnkleTracks, Array, float, int]:
    """Return the feet, one of them caught; the force (3,) that throws the dancer; the second; and the caught foot.

    The toes in the motion's rotations are late, too; they are changed in place. Raises UsageError if no foot is in the
    air after the trip.
    """
    down = float(feet.places[..., 1].min())
    high = feet.places[..., 1] > down + 0.02
    late = np.flatnonzero(high.any(axis=1) & (motion.times >= stumble.second))
    if not len(late):
        raise UsageError(f"--trip {stumble.second:g}: no foot is in the air after that")
    first = int(late[0])
    side = int(np.argmax(feet.places[first, :, 1]))
    start = float(motion.times[first])
    since = motion.times - start
    behind = np.where(since < 0, 0.0, np.where(since < LASTS, since, LASTS * smooth(1 - (since - LASTS) / CATCH_UP)))
    at = motion.times - behind
    places, turns = feet.places.copy(), feet.turns.copy()
    for axis in range(3):
        places[:, side, axis] = np.interp(at, motion.times, feet.places[:, side, axis])
    turns[:, side] = _late(feet.turns[:, side], motion.times, at)
    toes = motion.skeleton.index(f"{'lr'[side]}_metatarsal")
    motion.rotations[:, toes] = _late(motion.rotations[:, toes], motion.times, at)
    ahead = max(first - 1, 0)
    way = feet.places[min(first + 3, len(at) - 1), side] - feet.places[ahead, side]
    way[1] = 0.0
    size = float(np.linalg.norm(way))
    angle = heading(motion, start)
    way = way / size if size > 1e-3 else np.array([np.sin(angle), 0.0, np.cos(angle)])
    speed = np.linalg.norm(np.gradient(places[:, side], motion.times, axis=0), axis=1)
    rests = np.ones(places.shape[:2])
    rests[:, side] = np.where((behind > 0) & (speed > MOVES), 0.0, 1.0)
    return cleared(motion.skeleton, AnkleTracks(places, turns), rests), TRIP_FORCE * way, start, side


def _late(turns: Array, times: Array, at: Array) -> Array:
    """Return turns (f, 4), given at `times` (f,), at other times `at` (f,)."""
    before = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(at) - 2)
    share = (at - times[before]) / np.diff(times)[before]
    return quat.slerp(turns[before], turns[before + 1], np.clip(share, 0, 1))


def missed_by_trip(motion: Motion, second: float, side: int) -> list[Contact]:
    """Return the notes that a foot which is caught at a second cannot reach in time."""
    return [c for c in motion.contacts if c.limb == side and second <= c.start < second + LASTS + CATCH_UP]


def staggering(motion: Motion, feet: AnkleTracks, second: float, gave: Array) -> AnkleTracks:
    """Return the feet of a dancer who cannot stay in place: both step after the body, one after the other, and come
    back.

    gave : (3,) metres of the body from its place in the motion
    """
    places, turns = feet.places.copy(), feet.turns.copy()
    gave = gave * np.array([1.0, 0.0, 1.0])
    since = motion.times - second
    inside = (since >= 0) & (since <= STAGGER)
    if not inside.any():
        return feet
    start = int(np.flatnonzero(inside)[0])
    down = feet.places[start]
    first = int(np.argmax(down[:, [0, 2]] @ gave[[0, 2]]))  # the foot on the side to which she falls
    for order, side in enumerate((first, 1 - first)):
        out, home = 0.05 + 0.18 * order, STAGGER - 0.18 * (2 - order)
        away = smooth((since - out) / 0.18)
        back = smooth((since - home) / 0.18)
        still = np.where(inside, smooth(since / 0.05), 0.0)[:, None]
        stands = np.array([down[side, 0], feet.places[:, side, 1].min(), down[side, 2]])
        lift = STAGGER_LIFT * (_hop((since - out) / 0.18) + _hop((since - home) / 0.18))
        own = stands + (away * (1 - back))[:, None] * gave + lift[:, None] * [0, 1, 0]
        own += back[:, None] * (feet.places[:, side] - stands)
        ahead = quat.rotate(feet.turns[start, side], np.array([0.0, 0.0, 1.0]))
        level = quat.from_axis_angle(quat.UP, np.arctan2(ahead[0], ahead[2]))
        turns[:, side] = quat.slerp(feet.turns[:, side], level, still[:, 0] * (1 - back))
        gone = (1 - still) * feet.places[:, side] + still * own
        places[:, side] = np.where(inside[:, None], gone, feet.places[:, side])
    return cleared(motion.skeleton, AnkleTracks(places, turns), np.where(inside, 0.0, 1.0)[:, None] * np.ones(2))


def _hop(share: Array) -> Array:
    """Return a value that rises from 0 to 1 and falls to 0 as a share of a step goes from 0 to 1."""
    return np.asarray(np.sin(np.pi * np.clip(share, 0.0, 1.0)))


def without(motion: Motion, missed: Sequence[Contact], note: str, at: float) -> Motion:
    """Return the motion without the missed contacts, but with those held at second `at`; a note lists the missed."""
    started = {id(c) for c in missed if c.start < at}
    gone = {id(c) for c in missed} - started
    kept = tuple(c for c in motion.contacts if id(c) not in gone)
    which = ", ".join(
        f"{c.start:.3f} s column {c.column} ({NAMES[c.limb]}{', held' if id(c) in started else ''})" for c in missed
    )
    tail = f"; missed: {which}" if missed else "; no note is missed"
    return replace(motion, contacts=kept, notes=(*motion.notes, note + tail))


def disturbed(motion: Motion, pushes: Sequence[Push], stumbles: Sequence[Stumble]) -> tuple[Motion, list[Impulse]]:
    """Return the motion with feet that trips catch, and the forces on the dancer.

    Raises UsageError for a push or trip outside of the motion, or without a foot in the air.
    """
    start, end = float(motion.times[0]), float(motion.times[-1])
    asked = [("--push", push.second) for push in pushes] + [("--trip", stumble.second) for stumble in stumbles]
    for name, second in asked:
        if not start <= second <= end:
            raise UsageError(f"{name} {second:g}: give a time within the motion, {start:.3f} s to {end:.3f} s")
    impulses = [(push.second, force_of(push, motion)) for push in pushes]
    for stumble in stumbles:
        motion = replace(motion, rotations=motion.rotations.copy())
        feet = feet_of(motion.skeleton, motion.rotations, motion.root)
        feet, force, at, side = catch_foot(motion, feet, stumble)
        impulses.append((at, force))
        missed = missed_by_trip(motion, at, side)
        rotations, root = repinned(motion.skeleton, Poses(motion.rotations, motion.root), feet)
        name = ("left", "right")[side]
        note = f"tripped at {at:.3f} s: the {name} foot is caught"
        motion = without(replace(motion, rotations=rotations, root=root), missed, note, at)
    return motion, impulses


def recovered(
    motion: Motion, feet: AnkleTracks, root: Array, pushes: Sequence[Push]
) -> tuple[Motion, AnkleTracks, list[list[Contact]]]:
    """Return the motion without the notes that pushes make the dancer miss, her feet, and the notes missed by each
    push.

    root : (f, 3) of the ragdoll
    """
    out = []
    for push in pushes:
        apart = root - motion.root
        most = _farthest(motion, apart, push)
        missed: list[Contact] = []
        if np.hypot(*apart[most, [0, 2]]) > FALL:
            missed = [c for c in motion.contacts if push.second <= c.start < push.second + STAGGER]
            feet = staggering(motion, feet, push.second, apart[most])
            gone = {id(c) for c in missed}
            motion = replace(motion, contacts=tuple(c for c in motion.contacts if id(c) not in gone))
            missed = [*held_notes(motion, push.second), *missed]
        out.append(missed)
    return motion, feet, out


def _farthest(motion: Motion, apart: Array, push: Push) -> int:
    """Return the frame in which the body is farthest along the floor from its planned place, by `apart` (f, 3)."""
    after = (motion.times >= push.second) & (motion.times <= push.second + BACK)
    return int(np.argmax(np.hypot(apart[:, 0], apart[:, 2]) * after))


def with_push_notes(motion: Motion, root: Array, pushes: Sequence[Push], missed: Sequence[Sequence[Contact]]) -> Motion:
    """Return the motion with a note on each push: how far the dancer gave way, the missed notes. root : (f, 3), of the
    input
    """
    for push, gone in zip(pushes, missed, strict=True):
        apart = motion.root - root
        gave = 100 * float(np.hypot(*apart[_farthest(motion, apart, push), [0, 2]]))
        note = f"pushed at {push.second:.3f} s with {push.newtons:g} N: the hips move by {gave:.0f} cm"
        motion = without(motion, gone, note, push.second)
    return motion
