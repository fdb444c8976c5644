"""The body over the feet: where the weight is, how high, which way pelvis and chest turn, and how far they bend."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.foot_path import Feet
from dancetutor_cli.dance.gait import GaitPose, gaze_ahead, walk_pose
from dancetutor_cli.dance.plan import Plan
from dancetutor_cli.dance.rig.body import GRAVITY
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_body import BodySettings, LookSettings
from dancetutor_cli.dance.smoothing import Controller, follow, low_pass, smooth, smooth_path, upper_envelope
from dancetutor_cli.dance.trajectory.balance import Pendulum, Rail, balanced_path
from dancetutor_cli.dance.trajectory.facing import (
    bent_down,
    chest_and_head,
    crossing_share,
    has_hand_on_bar,
    leaned_across,
    leaning_share,
    leaning_tilt,
    limit_head_yaw,
    pelvis_yaw,
    reaching,
)
from dancetutor_cli.dance.trajectory.groove import Groove, Occupation, groove_of
from dancetutor_cli.dance.trajectory.height import (
    Height,
    HeightGoals,
    height_path,
    jump_crouch,
    jump_drive,
    jump_lean,
    landing_give,
    tempo_factor,
)
from dancetutor_cli.dance.trajectory.legs import Course, above_at_rest, heels_may_rise, leg_room, raised, upright_hips
from dancetutor_cli.dance.trajectory.momentum import counter_motion
from dancetutor_cli.dance.trajectory.stance import pelvis_reach, stance
from dancetutor_cli.dance.units import Array
from dancetutor_cli.dance.waits import WaitMotion, waiting_at

BALANCE, HEIGHT = "the balance", "the height of the body"  # what `softened` may name
STANDING_HEIGHT = 0.93  # metres, of the centre of mass
LEAST_FALL, LEAST_SEEN = 0.4, 0.3  # parts of g that the ground carries at least, as omega goes by it
AIR, LANDED = 0.02, 0.05  # seconds over which heels rise in the air and come down again, and for which they stay up
WIDE = 0.25  # seconds around steps that are wide in which there is less of a bob
LEGS = 1.2  # of who stands on both legs, the hips list with the beat by this part of the list on one leg


@dataclass(frozen=True, slots=True)
class Trajectory:
    """The body at n even times.

    mass : (n, 2), (x, z) of the centre of mass; mass_height : its height
    ground : (n, 2), (x, z) of the root; height : (n,) of the root; yaw, chest_yaw, head_yaw : (n,) radians, unwrapped
    tilt : (n, 2), horizontal (x, z) direction times angle by which the chest leans; reaching : (n, 2), 0 to 1, how far
    the body has bent for the left and right hand; heels : (n, 2), radians that they are raised to spare the ankles
    knees : (n, 2), radians that knees are turned outward to spare the ankles
    beat : (n,) 0 to 1, how far she has given way to the beat; sway : (n,) as in `groove.Groove`
    listed : (n,) radians that the right hip is lower than the left one
    arms : (n, 6) `swing` and `raised` as in `momentum.CounterMotion`, `pump`, `flexed` and `carried` as in
    `groove.Groove`
    softened : the paths that had no solution within the limits of legs and soles, so that these gave way; for people
    """

    times: Array
    mass: Array
    mass_height: Height
    ground: Array
    height: Array
    yaw: Array
    chest_yaw: Array
    head_yaw: Array
    tilt: Array
    reaching: Array
    heels: Array
    knees: Array
    beat: Array
    sway: Array
    listed: Array
    arms: Array
    softened: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class RoughBake:
    """The measures of a rough bake, for the next plan of the body's path.

    trajectory : the one that was baked; None before the first rough bake
    above : (n, 3) metres, centre of mass minus root
    turning : (n, 2) as of `momentum.rotation_zmp_offset`
    hips : (n, 2, 3) metres, from the root to each hip
    push_off : (n, 2) radians, as of `legs.push_off`
    deeper : (p,) metres by which each press of a palm pulled the root down
    keep : leave the path over the ground as it was; tightened : as in `balanced_path`
    """

    trajectory: Trajectory | None
    above: Array
    turning: Array
    hips: Array
    push_off: Array
    deeper: Array
    keep: bool = False
    tightened: int = 0


def bake_at_rest(plan: Plan, times: Array, context: Context) -> RoughBake:
    """Return what is assumed before the first rough bake: an upright body that turns as planned and pushes nothing."""
    none = np.zeros((len(times), 2))
    return RoughBake(
        trajectory=None,
        above=np.tile(above_at_rest(context.skeleton), (len(times), 1)),
        turning=none,
        hips=upright_hips(pelvis_yaw(plan, times, context.settings), context.skeleton),
        push_off=none,
        deeper=np.zeros(len(plan.presses)),
    )


@dataclass(frozen=True, slots=True)
class Situation:
    """What the dancer does at n even times.

    tempo : (n,) as of `height.tempo_factor`; crouch : (n,) metres, as of `height.jump_crouch`
    reaching : (n, 2) as of `facing.reaching`; gait : the movements of her walks, None without a walk
    leaning : (n,) as of `facing.leaning_share`; across : (n,) as of `facing.crossing_share`
    shift : (n,) metres that her weight is towards the left foot, in waits and at leisure
    farthest : (n,) metres, as of `balance.Pendulum`
    give : (n,) metres, as of `height.landing_give`
    """

    times: Array
    tempo: Array
    crouch: Array
    reaching: Array
    gait: GaitPose | None
    leaning: Array
    across: Array
    waiting: WaitMotion
    groove: Groove
    shift: Array
    farthest: Array
    give: Array

    @property
    def walks(self) -> Array:
        """How much (n,) she walks, 0 to 1."""
        return np.zeros(len(self.times)) if self.gait is None else self.gait.own

    @property
    def no_palms(self) -> Array:
        """1 where no hand reaches down to a panel, (n,), 0 where one is there."""
        return np.asarray(1.0 - self.reaching.max(axis=1))


def situation_of(plan: Plan, times: Array, context: Context) -> Situation:
    """Return what the dancer does at even `times` (n,), which no rough bake changes."""
    settings, waiting = context.settings, waiting_at(plan, times, context)
    tempo, palms = tempo_factor(plan, times, settings), reaching(plan.presses, times, settings.hands)
    gait = walk_pose(plan.walks, times, settings.walk)
    leaning = leaning_share(plan.grips, times, settings.bar)
    across = crossing_share(plan.grips, times, settings.across)
    busy = palms.sum(axis=1) + np.maximum(settings.bar.calmer * leaning, np.abs(across))
    busy += 0.0 if gait is None else gait.own
    groove = groove_of(plan, times, Occupation(tempo, busy, waiting.share), context)
    return Situation(
        times, tempo, jump_crouch(plan, times, settings.jump), palms, gait, leaning, across, waiting, groove,
        shift=waiting.shift + (1.0 - waiting.share) * stance(plan, times, context),
        farthest=pelvis_reach(plan, times, context),
        give=landing_give(plan, times, groove.pulses, settings.body),
    )  # fmt: skip


def body_trajectory(plan: Plan, feet: Feet, now: Situation, context: Context, rough: RoughBake) -> Trajectory:
    """Return the body at the even times (n,) of `now`, with feet sampled there.

    rough : first `bake_at_rest`, then measured
    """
    settings, times, groove = context.settings, now.times, now.groove
    course, softened = _course(plan, feet, now, context, rough)
    narrow = 1.0 - upper_envelope(times, _straddled(feet, settings), WIDE)
    groove = replace(groove, bob=narrow * groove.bob, heels=narrow * groove.heels)
    legs = _leg_goals(plan, feet, now, groove, rough.deeper, settings)
    heels = np.radians(settings.groove.heels) * _heels_up(feet, groove, course.rate)
    heels *= heels_may_rise(plan, times, settings.step.press_time)
    height_goals = _height_goals(raised(feet, np.maximum(rough.push_off, heels)), course, context, legs)
    mass_height = height_path(height_goals, plan.flights, settings.body)
    chest, head = chest_and_head(plan, course, gaze_ahead(plan, times, settings.walk), settings)
    upright = now.no_palms * (1.0 - now.walks)
    ahead = np.column_stack((np.sin(chest), np.cos(chest)))  # not to where it turns against each step
    free = (1.0 - now.leaning) * upright * _neck_room(head - chest, settings.look)
    answer = counter_motion(feet, course, mass_height.at(times), free, context.skeleton, settings.arms)
    chest = chest + answer.twist
    tilt = leaning_tilt(plan.presses, course, chest, _lean(now, ahead, course.rate, settings), settings)
    chest += now.waiting.turn
    chest += np.radians(settings.groove.twist) * groove.sway
    head = limit_head_yaw(head, chest, course.rate, settings)
    drop = -np.radians(settings.wait.lean) * now.waiting.shift / max(settings.wait.shift, 1e-6)
    drop += np.radians(settings.groove.lean) * groove.sway
    tilt += drop[:, None] * np.column_stack((np.cos(chest), -np.sin(chest)))
    fold = np.radians(settings.jump.fold) * now.crouch + np.radians(settings.layers.beat_nod) * groove.beat
    fold += np.radians(settings.groove.bow) * groove.bow
    tilt += fold[:, None] * np.column_stack((np.sin(chest), np.cos(chest))) + jump_lean(plan, times, settings.jump)
    controller = Controller.of(settings.inertia.chest_frequency, settings.inertia.chest_damping)
    apart = 1.0 - settings.jump.together * (1.0 - groove.grounded)
    return Trajectory(
        times,
        mass=course.mass,
        mass_height=mass_height,
        ground=course.ground,
        height=mass_height.at(times) - course.above[:, 1],
        yaw=course.yaw,
        chest_yaw=chest,
        head_yaw=head,
        tilt=follow(tilt, course.rate, controller) + answer.tilt,
        reaching=now.reaching,
        heels=heels,
        knees=np.zeros((len(times), 2)),
        beat=groove.beat,
        sway=groove.sway,
        listed=upright * _pelvic_list(feet, now.tempo, groove.weight, course.rate, settings.body),
        arms=np.column_stack((apart * answer.swing, apart * answer.raised, groove.pump, groove.flexed, groove.carried)),
        softened=(*softened, *((HEIGHT,) if mass_height.softened else ())),
    )


def _leg_goals(
    plan: Plan, feet: Feet, now: Situation, groove: Groove, deeper: Array, settings: MotionSettings
) -> LegGoals:
    """Return the wanted stance: lower in streams, around jumps, on beats and for palms. deeper : as of `RoughBake`"""
    body, jump, times = settings.body, settings.jump, now.times
    length = body.leg - body.stream_crouch * now.tempo - now.crouch
    push, catch = (share * now.no_palms for share in jump_drive(plan, times, jump))
    length = length + push * (jump.push - length)
    length = length + catch * (jump.catch - length)
    most = body.soft_reach + push * max(jump.push - body.soft_reach, 0.0)
    narrow = 1.0 - _straddled(feet, settings)
    sink = np.maximum(narrow * groove.sink, now.give)
    return LegGoals(
        length,
        most=np.where(feet[0].down | feet[1].down, most, jump.reach),
        sink=sink + (0.0 if now.gait is None else now.gait.sink),
        bob=groove.bob,
        bent=bent_down(plan.presses, deeper, times, settings.hands),
        firm=jump.drive * np.maximum(push, catch),
        tempo=now.tempo,
    )


def _lean(now: Situation, ahead: Array, rate: float, settings: MotionSettings) -> Array:
    """Return the lean of the chest (n, 2), a horizontal direction times an angle: forward, at the bar back or aside.

    ahead : (n, 2) unit vectors to where the chest faces
    """
    calm = smooth_path(now.tempo[:, None], np.ones(len(now.times)), rate, settings.body.lean_time)[:, 0]
    lean = settings.body.lean + settings.body.stream_lean * calm
    lean = np.radians(lean - now.leaning * (1.0 - np.abs(now.across)) * (lean + settings.bar.lean_back))
    return np.asarray(lean[:, None] * ahead + leaned_across(now.across, settings.across))


def _pelvic_list(feet: Feet, tempo: Array, weight: Array, rate: float, body: BodySettings) -> Array:
    """Return how much lower (n,) the right hip is than the left one, radians: the pelvis sinks on the side of the leg
    without weight (the pelvic list of Saunders, Inman and Eberhart, *The major determinants in normal and pathological
    gait*, 1953).
    """
    bears = np.where(feet[0].down & feet[1].down, LEGS * weight, feet[0].down.astype(np.float64) - feet[1].down)
    over = smooth_path(bears[:, None], np.ones(len(bears)), rate, body.list_time)[:, 0]
    early = np.clip(np.arange(len(over)) + round(body.list_early * rate), 0, len(over) - 1)
    return np.asarray(np.radians(body.list + body.list_stream * tempo) * over[early])


def _heels_up(feet: Feet, groove: Groove, rate: float) -> Array:
    """Return how far (n, 2) heels are up in streams, 0 to 1: between pulses, and in the air, so that the ball lands
    first.
    """
    up = np.column_stack([~foot.down for foot in feet]).astype(np.float64)
    landed = np.maximum(np.arange(len(up)) - round(LANDED * rate), 0)
    up = smooth_path(np.maximum(up, up[landed]), np.ones(len(up)), rate, AIR)
    return np.asarray(groove.heels[:, None] * np.maximum(groove.high[:, None], np.clip(up, 0.0, 1.0)))


def _straddled(feet: Feet, settings: MotionSettings) -> Array:
    """Return how wide (n,) the feet are apart, 0 to 1: 1 at `step.wide_most`, where hips have no room left."""
    apart = np.linalg.norm((feet[0].ball - feet[1].ball)[:, ::2], axis=1)
    return smooth((apart - settings.step.wide) / max(settings.step.wide_most - settings.step.wide, 1e-6))


def _neck_room(turned: Array, look: LookSettings) -> Array:
    """Return how free (n,) the chest is to turn on the hips, 0 to 1: less where the head is turned far from it."""
    return np.asarray(1.0 - smooth((np.abs(turned) - np.radians(look.neck_easy)) / np.radians(look.neck_room)))


def _course(
    plan: Plan, feet: Feet, now: Situation, context: Context, rough: RoughBake
) -> tuple[Course, tuple[str, ...]]:
    """Return where the body goes over the ground, and which limits had to be softened."""
    settings, times, baked = context.settings, now.times, rough.trajectory
    yaw = pelvis_yaw(plan, times, settings) + now.waiting.hips
    if baked is not None and rough.keep:
        softened = tuple(what for what in baked.softened if what == BALANCE)
        return Course(times, baked.mass, rough.above, rough.hips, yaw), softened
    pendulum = _pendulum(now, rough)
    if now.gait is not None:  # who walks has legs that swing slowly, and her weight on the edges of her soles
        pendulum = replace(pendulum, turning=(1.0 - now.walks)[:, None] * pendulum.turning)
    if baked is not None:  # heels that rise to spare their ankles carry nothing; palms do, on their way already
        feet = raised(feet, baked.heels * now.no_palms[:, None])
    if context.bar is not None:
        nearer = settings.across.nearer * np.abs(now.across)
        ahead = context.bar.behind + settings.bar.forward - nearer
        held = has_hand_on_bar(plan.grips, times)
        pendulum = replace(pendulum, rail=Rail(ahead, held, settings.bar.soft))
    mass, swept = balanced_path(feet, pendulum, settings, rough.tightened, plan.hand, now.shift)
    return Course(times, mass, rough.above, rough.hips, yaw), (BALANCE,) if swept else ()


def _pendulum(now: Situation, rough: RoughBake) -> Pendulum:
    """Return the body's inverted pendulum; it stands still until the height of the centre of mass is known."""
    times, offset = now.times, rough.above[:, [0, 2]]
    if rough.trajectory is None:
        still = np.full(len(times), STANDING_HEIGHT / GRAVITY)
        return Pendulum(times, still, still, offset, now.farthest, rough.turning)
    height, step = rough.trajectory.mass_height, 1.0 / 60.0
    y = height.at(times)
    acceleration = (height.at(times + step) - 2 * y + height.at(times - step)) / step**2
    rate = 1.0 / float(times[1] - times[0])
    smooth_slowness = _slowness(low_pass(y, rate), low_pass(acceleration, rate), LEAST_SEEN)
    return Pendulum(times, _slowness(y, acceleration, LEAST_FALL), smooth_slowness, offset, now.farthest, rough.turning)


def _slowness(y: Array, acceleration: Array, least: float) -> Array:
    """Return 1 / omega^2 = y / (y'' + g), seconds squared, of a pendulum of height y. least : part of g"""
    return np.asarray(y / np.maximum(acceleration + GRAVITY, least * GRAVITY))


@dataclass(frozen=True, slots=True)
class LegGoals:
    """The wanted stance at n times.

    length : (n,) hip to ankle; most : (n,) at most; sink : (n,) how far a plant or a beat lets her sink, metres
    bob : (n,) as in `groove.Groove`: a wish that limits nothing
    bent : (n, 2) as in `facing.bent_down`; firm, tempo : (n,) as in `HeightGoals`
    """

    length: Array
    most: Array
    sink: Array
    bob: Array
    bent: Array
    firm: Array
    tempo: Array


def _height_goals(feet: Feet, course: Course, context: Context, legs: LegGoals) -> HeightGoals:
    """Return the wanted and the highest allowed height of the centre of mass."""
    settings, above = context.settings, course.above[:, 1]
    wanted = np.full(len(course.yaw), np.inf)
    highest = np.full(len(course.yaw), np.inf)
    for side in (0, 1):
        most = leg_room(feet, course, context.skeleton, legs.most, side)
        soft = leg_room(feet, course, context.skeleton, legs.length, side)
        highest = np.minimum(highest, most)
        standing = feet[side].down | (legs.firm > 0.0)
        wanted = np.minimum(wanted, np.where(standing, soft, most - 0.004))
    lifted = np.maximum(feet[0].ball[:, 1], feet[1].ball[:, 1]) * (legs.firm == 0.0)
    lifted = np.interp(course.times - settings.body.rise_late, course.times, lifted)
    wanted = np.minimum(wanted + settings.body.step_rise * np.maximum(lifted, 0.0), highest - 0.002)
    wanted -= legs.sink + legs.bob
    share, depth = legs.bent.T
    wanted = wanted + share * (settings.hands.pelvis - depth - wanted)
    return HeightGoals(course.times, wanted + above, highest - legs.sink + above, above, legs.firm, legs.tempo)


def lift_side(feet: Feet, settings: MotionSettings) -> Array:
    """Return which foot is higher (n,): 1 while the left one is at the full height of a step, -1 for the right one."""
    return np.clip((feet[0].ball[:, 1] - feet[1].ball[:, 1]) / settings.step.height_slow, -1.0, 1.0)
