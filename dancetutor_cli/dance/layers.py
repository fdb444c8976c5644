"""Small movements on top of the solved body: gaze and glances, breath, wrists, fingers; the face is in `face`."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from dancetutor_cli.dance.context import Context, hold_share
from dancetutor_cli.dance.ik.targets import moving_mean
from dancetutor_cli.dance.plan import Plan, chance_of
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import SIDES, hand_direction, palm_normal, world_transforms
from dancetutor_cli.dance.rig.quaternion import UP, leaning
from dancetutor_cli.dance.rig.skeleton import FINGERS, KNUCKLES, Skeleton
from dancetutor_cli.dance.settings_arms import FingerSettings
from dancetutor_cli.dance.settings_body import GlanceSettings
from dancetutor_cli.dance.smoothing import sample_path, smooth
from dancetutor_cli.dance.trajectory.facing import screen_yaw
from dancetutor_cli.dance.trajectory.groove import head_carriage
from dancetutor_cli.dance.trajectory.height import tempo_factor
from dancetutor_cli.dance.trajectory.posture import Trajectory
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.dance.waits import WaitMotion

# Head and eyes: after all other movements they turn to the screen, as far as a neck can (thesis 5.7).


def look(poses: Poses, body: Trajectory, at: Array, context: Context) -> None:
    """Turn neck, head and eyes at times `at` (f,), in place."""
    skeleton, settings, rotations, root = context.skeleton, context.settings, poses.rotations, poses.root
    _, world = world_transforms(skeleton, rotations, root)
    chest = world[:, skeleton.index("vt4")]
    head_yaw, chest_yaw = (sample_path(yaw, body.times, at) for yaw in (body.head_yaw, body.chest_yaw))
    tilt = sample_path(body.tilt, body.times, at)
    # a head that bends down to a panel looks at it, because no neck turns so far back
    shallow, deep = np.radians(settings.look.bent_from), np.radians(settings.look.bent_to)
    bent = smooth((np.linalg.norm(tilt, axis=1) - shallow) / (deep - shallow))
    most = np.radians(settings.look.head_limit)  # also of a chest that turned against the legs meanwhile
    turned = np.clip(head_yaw - chest_yaw, -most, most)
    head_yaw = chest_yaw + (1.0 + (settings.look.bent_yaw - 1.0) * bent) * turned
    lean = settings.look.head_tilt + (settings.look.bent_tilt - settings.look.head_tilt) * bent
    chin = quat.from_axis_angle(quat.LEFT, -np.radians(settings.look.chin) * (1.0 - bent))
    # in a deep bend, hands pull the chest askew, and the neck of a head that kept its direction in the world would
    # twist
    meant = quat.slerp(chest, leaning(tilt, chest_yaw), bent)
    whole = quat.multiply(quat.conjugate(meant), quat.multiply(leaning(lean[:, None] * tilt, head_yaw), chin))
    neck = quat.slerp(np.broadcast_to(quat.IDENTITY, whole.shape), whole, np.full(len(at), settings.look.neck_share))
    rotations[:, skeleton.index("vc4")] = neck
    rotations[:, skeleton.index("skullbase")] = quat.multiply(quat.conjugate(neck), whole)
    limit = np.radians(np.sqrt(max(settings.look.eyes_limit**2 - settings.look.chin**2, 0.0)))
    gap = (screen_yaw(root[:, [0, 2]], settings) - head_yaw + np.pi) % (2 * np.pi) - np.pi
    beyond = (np.abs(gap) - np.radians(settings.look.eyes_limit)) / np.radians(settings.look.eyes_give_up)
    seen = 1.0 - smooth(2.0 * beyond - 1.0)  # eyes that stay in their corners without reason show their white
    eyes = quat.from_axis_angle(UP, seen * np.clip(settings.look.eyes_weight * gap, -limit, limit))
    for side in "lr":
        rotations[:, skeleton.index(f"{side}_eyeball_joint")] = quat.multiply(quat.conjugate(chin), eyes)


# Glances: where steps are slow, and in waits, the dancer looks about, at different times and to different places.

GLANCE_SEED = 19980926
# parts of yaw, pitch and tilt of each kind: aside, up, with the head leant
_WAYS = np.array([[1.0, 0.25, 0.0], [0.35, 1.0, 0.2], [0.45, -0.3, 1.0]])


@dataclass(frozen=True, slots=True)
class Glances:
    """The turns of the head by glances at f times, radians: yaw to the left, pitch up, tilt to the left; (f,) each.

    eyes : (f,) radians that the eyes are farther to the left, a little before the head
    """

    yaw: Array
    pitch: Array
    tilt: Array
    eyes: Array


def glances_at(plan: Plan, body: Trajectory, times: Array, context: Context) -> Glances:
    """Return the glances at `times` (f,), seconds. Mirror images of a plan have mirror images of its glances.

    Their times and directions are random. A glance needs notes at least `numbers.quick` apart; it is smaller if they
    are less than `numbers.slow` apart. At any speed the head is carried another way in each phrase of the music,
    with eyes on the screen.
    """
    numbers = context.settings.glance
    out = _carried(plan, times, context)
    notes, busy = _notes(plan), [(walk.start, walk.end) for walk in plan.walks]
    busy += [(press.start - press.lead, press.end + numbers.hand) for press in plan.presses]
    busy += [(start - numbers.jump, end + numbers.jump) for start, end in plan.flights]
    first, last = (int(np.floor(t / numbers.every)) for t in (times.min(), times.max()))
    for cell in range(first - 1, last + 1):
        chance = chance_of(GLANCE_SEED, *plan.song, *context.own, cell)
        start = numbers.every * (cell + chance.uniform(0.0, 0.5))
        end = start + numbers.lasts * chance.uniform(0.6, 1.4)
        kind, side, far = int(chance.integers(len(_WAYS))), float(chance.choice([-1.0, 1.0])), chance.uniform(0.6, 1.2)
        near = slice(*np.searchsorted(times, (start - numbers.eyes_ahead, end)).tolist())
        calm = _calm(notes, start, end, numbers)
        if near.start == near.stop or calm <= 0.0 or any(a < end and start < b for a, b in busy):
            continue
        yaw, pitch, tilt = np.radians(_WAYS[kind]) * [numbers.yaw, numbers.pitch, numbers.tilt] * far * calm
        t = times[near]
        there = _there(t, start, end, numbers.turn)
        out.yaw[near] += side * plan.hand * yaw * there
        out.pitch[near] += pitch * there
        out.tilt[near] += side * plan.hand * tilt * there
        eyes = side * plan.hand * calm * far * np.radians(numbers.eyes) * _WAYS[kind, 0]
        out.eyes[near] += eyes * _there(t + numbers.eyes_ahead, start, end, numbers.turn / 2)
    room = _room(body, times, context)
    return Glances(room * out.yaw, room * out.pitch, room * out.tilt, room * out.eyes)


def _carried(plan: Plan, times: Array, context: Context) -> Glances:
    """Return how the head is carried at `times` (f,) from phrase to phrase; the eyes stay where they are."""
    numbers = context.settings.glance
    far = np.radians([numbers.carried_yaw, numbers.carried_pitch, numbers.carried_tilt])
    yaw, pitch, tilt = (head_carriage(plan, times, context) * far).T
    return Glances(yaw, pitch, tilt, -yaw)


def _notes(plan: Plan) -> Array:
    """Return the seconds at which feet land."""
    return np.unique(np.round([swing.land for swing in plan.swings], 3))


def _calm(notes: Array, start: float, end: float, numbers: GlanceSettings) -> float:
    """Return the part of a glance for which there is time, 0 to 1, by the least time between two notes near it."""
    first, last = np.searchsorted(notes, (start - numbers.around, end + numbers.around))
    about = notes[max(first - 1, 0) : last + 1]
    least = min((b - a for a, b in pairwise(about.tolist())), default=np.inf)
    return float(smooth((least - numbers.quick) / (numbers.slow - numbers.quick)))


def _room(body: Trajectory, times: Array, context: Context) -> Array:
    """Return how free (f,) head and eyes are, 0 to 1; they are not free if they must turn far to see the screen."""
    numbers = context.settings.glance
    head, chest = (sample_path(yaw, body.times, times) for yaw in (body.head_yaw, body.chest_yaw))
    screen = screen_yaw(sample_path(body.ground, body.times, times), context.settings)
    gap = np.abs((screen - head + np.pi) % (2 * np.pi) - np.pi)
    neck = 1.0 - np.abs(head - chest) / np.radians(numbers.neck_room)
    return np.asarray(smooth(neck) * smooth(1.0 - gap / np.radians(numbers.eyes_room)))


def _there(times: Array, start: float, end: float, turn: float) -> Array:
    """Return 0 before and after a glance, 1 during it, with turns of `turn` seconds, (f,)."""
    return np.asarray(smooth((times - start) / turn) * smooth((end - times) / turn))


# Small movements on top of all others, multiplied in the space of each joint: breath, wrists, glances.
#
# Additive layers as in P. Massoudi's blog on character animation, 2013: the main rotation first, then the layer. They
# change no joint between the root and a foot, so no contact moves. They are off while a palm is on the floor.


@dataclass(frozen=True, slots=True)
class Activity:
    """The activity of the dancer at f times, for the layers.

    lift_side : (f,) -1 to 1, positive while the left foot is in the air, negative while the right foot is
    free : (f,) 0 while a palm is on the floor or the bar, else 1; lead : as in `Plan`
    relief : (f,) as in `face.Mood`: a deep breath; beat : (f,) as in `Trajectory`; waiting, glances : at the same times
    """

    lift_side: Array
    free: Array
    lead: int
    relief: Array
    beat: Array
    waiting: WaitMotion
    glances: Glances


def add_layers(poses: Poses, times: Array, doing: Activity, context: Context) -> None:
    """Add all layers to the poses at `times` (f,), seconds, in place."""
    skeleton, settings, rotations = context.skeleton, context.settings.layers, poses.rotations
    groove, beat = context.settings.groove, doing.beat
    lift_side, free, lead = doing.lift_side, doing.free, doing.lead
    times = times + context.phase
    breath = np.sin(2 * np.pi * times / settings.breath_time) * (1.0 + settings.breath_deep * doing.relief)
    raised = (np.radians(settings.breath_shoulders) * breath - np.radians(groove.shrug) * beat) * free
    for k, (side, sign) in enumerate((("l", 1.0), ("r", -1.0))):
        shrug = doing.waiting.shrug[:, k] * free
        _shrug(skeleton, rotations, side, sign * (raised + shrug))
    for side, phase, bent in (
        ("lr"[lead], 0.0, 1.0 - settings.wrist_unlike),
        ("rl"[lead], settings.wrist_behind, 1.0 + settings.wrist_unlike),
    ):
        hand = hand_direction(skeleton, side)
        drop = bent + settings.wrist_wave * np.sin(2 * np.pi * (times / settings.wrist_time + phase))
        _turn(
            skeleton,
            rotations,
            f"{side}_radiocarpal",
            np.cross(hand, palm_normal(skeleton, side)),
            (np.radians(settings.wrists) * drop + doing.waiting.flap[:, "lr".index(side)]) * free,
        )
    glance, neck = doing.glances, context.settings.look.neck_share
    bob = np.radians(settings.head_bob) * lift_side * free + doing.waiting.tilt + glance.tilt
    _turn(skeleton, rotations, "skullbase", quat.AHEAD, -bob)
    nod = np.radians(settings.breath_nod) * breath + np.radians(groove.nod) * beat
    _turn(skeleton, rotations, "vc4", quat.LEFT, nod)
    for joint, share in (("vc4", neck), ("skullbase", 1.0 - neck)):
        _turn(skeleton, rotations, joint, UP, share * glance.yaw)
        _turn(skeleton, rotations, joint, quat.LEFT, -share * glance.pitch)
    for side in "lr":
        _turn(skeleton, rotations, f"{side}_eyeball_joint", UP, glance.eyes)


def _shrug(skeleton: Skeleton, rotations: Array, side: str, angle: Array) -> None:
    """Raise a shoulder by turning its collarbone. The arm rises with it and hangs as before, because hands would
    otherwise swing into thighs.
    """
    _turn(skeleton, rotations, f"{side}_sternoclavicular", quat.AHEAD, angle)
    j = skeleton.index(f"{side}_shoulder")
    rotations[:, j] = quat.multiply(quat.from_axis_angle(quat.AHEAD, -angle), rotations[:, j])


def _turn(skeleton: Skeleton, rotations: Array, joint: str, axis: Array, angle: Array) -> None:
    if joint in skeleton.names:
        j = skeleton.index(joint)
        rotations[:, j] = quat.multiply(rotations[:, j], quat.from_axis_angle(axis, angle))


# Hands: curled at rest, a loose fist in effort, flat on the floor, around the bar.

CLOSING = np.array([1.8, 0.8])  # powers for knuckles and middle joints: knuckles close later, or it is a claw
SLANT = 0.14  # of the line of the knuckles: so much nearer to the wrist for each metre across the hand


@dataclass(frozen=True, slots=True)
class HandUse:
    """The use of hands at f times, 0 to 1 each; pairs are left, right.

    effort : (f,) how hard the dancer works; floor : (f, 2) on a panel or on the way to it; bar : (f, 2) at the rail
    loose : (f, 2) shaken out; lead : as in `Plan`
    """

    effort: Array
    floor: Array
    bar: Array
    loose: Array
    lead: int


def hand_use(plan: Plan, body: Trajectory, at: Array, waiting: WaitMotion, context: Context) -> HandUse:
    """Return the use of hands at times `at` (f,); waiting : at the same times."""
    settings, rate = context.settings, 1.0 / float(body.times[1] - body.times[0])
    effort = moving_mean(tempo_factor(plan, body.times, settings), rate, settings.arms.effort)
    return HandUse(
        np.interp(at, body.times, effort),
        sample_path(body.reaching, body.times, at),
        hold_share(plan.grips, at, settings.bar.reach_time),
        waiting.loose,
        plan.lead,
    )


def curls(times: Array, use: HandUse, numbers: FingerSettings) -> Array:
    """Return the bends (f, 2, 2) of the fingers of each hand at the knuckles and at their middle joints, radians.

    Each hand opens and closes a little by itself, slowly. If the right foot leads, left and right hand are exchanged.
    """
    rest, fist = (np.array([numbers.rest, numbers.rest_middle]), np.array([numbers.fist, numbers.fist_middle]))
    bar, flat = (np.array([numbers.bar, numbers.bar_middle]), -np.array([numbers.flat, numbers.flat_middle]))
    out = np.empty((len(times), 2, 2))
    for side in (0, 1):
        behind = numbers.behind * (side != use.lead)
        wave = np.sin(2 * np.pi * (times / numbers.wander_time + behind))
        curl = rest + numbers.wander * wave[:, None] + np.clip(use.effort, 0.0, 1.0)[:, None] ** CLOSING * (fist - rest)
        for share, goal in ((use.loose, 0.3 * rest), (use.bar, bar), (use.floor, flat)):
            curl = curl + share[:, side, None] * (goal - curl)
        out[:, side] = curl
    return np.radians(out)


def add_fingers(skeleton: Skeleton, poses: Poses, bent: Array) -> None:
    """Bend the fingers by (f, 2, 2), as from `curls`, in place; a skeleton without fingers does not change."""
    for k, side in enumerate(SIDES):
        axis = finger_axis(skeleton, side)
        for joint, name in enumerate((KNUCKLES, FINGERS)):
            if f"{side}_{name}" in skeleton.names:
                j = skeleton.index(f"{side}_{name}")
                poses.rotations[:, j] = quat.from_axis_angle(axis, bent[:, k, joint])


def finger_axis(skeleton: Skeleton, side: str) -> Array:
    """Return the unit vector in the rest pose about which fingers bend to the palm.

    It lies along the knuckles. The knuckle of the little finger is nearest to the wrist, so its tip comes to the ball
    of the thumb.
    """
    along = hand_direction(skeleton, side)
    across = np.cross(along, palm_normal(skeleton, side))
    sign = 1.0 if side == "l" else -1.0
    axis = across - sign * SLANT * along
    return np.asarray(axis / np.linalg.norm(axis))
