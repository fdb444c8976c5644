"""The surroundings of the dancer while a song is danced: panels, the bar behind her, settings, her skeleton."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.dance.motion import Bar, Contact, Grip, Ground, Motion
from dancetutor_cli.dance.plan import Plan, chance_of
from dancetutor_cli.dance.rig.body import BALL_AHEAD
from dancetutor_cli.dance.rig.skeleton import Skeleton, dancer_skeleton
from dancetutor_cli.dance.settings import MotionSettings, SettingsCourse, Span
from dancetutor_cli.dance.settings_arms import BarSettings
from dancetutor_cli.dance.settings_feet import StepSettings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import PANEL as PANEL
from dancetutor_cli.dance.units import Array, Flags
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import StepKind

if TYPE_CHECKING:
    from dancetutor_cli.feet.pads import Pad


# Places in the world: panels on the ground, and the places on a panel where a foot lands.

HALF_PANEL = PANEL / 2
PHASE_SEED = 20261130
APART = (0.3, 0.7)  # of a breath: how far the breaths of two dancers are apart
BREATHS = 8  # a phase is shorter than this many breaths, so that blinks and slower waves are apart, too
HOLD_GRACE = 0.25  # seconds that a held note may be let go: StepMania's TimingWindowSecondsHold


def panels_on_ground(pad: Pad) -> Array:
    """Return world (x, z) of every panel's centre, (c, 2); the origin is the pad's centre, the screen is at +Z."""
    centre = np.asarray(pad.centre, dtype=np.float64)
    panels = np.asarray(pad.panels, dtype=np.float64) - centre
    return np.asarray(panels * np.array([-PANEL, PANEL]))


def squares_on_ground(pad: Pad) -> Array:
    """Return world (x, z) of the middle of each square of three by three panels, (s, 2)."""
    return np.asarray((pad.squares - np.asarray(pad.centre, dtype=np.float64)) * np.array([-PANEL, PANEL]))


def direction_of(yaw: float) -> Array:
    """Return the unit vector (x, z) in the direction of a yaw, radians."""
    return np.array([np.sin(yaw), np.cos(yaw)])


def ball_of(middle: Array, yaw: float) -> Array:
    """Return the ball of a foot from the middle of its sole."""
    return np.asarray(middle + BALL_AHEAD * direction_of(yaw))


def middle_of(ball: Array, yaw: float) -> Array:
    """Return the middle of the sole of a foot from its ball."""
    return np.asarray(ball - BALL_AHEAD * direction_of(yaw))


@dataclass(frozen=True, slots=True)
class Spot:
    """The allowed places of a foot: a centre (2,), and the distances (2,) of its ball and of the middle of its sole
    from it along x and z.
    """

    centre: Array
    room: Array
    middle_room: Array | float = np.inf


def room_on(panels: Array, column: int, step: StepSettings) -> Array:
    """Return how far (2,) along x and z the ball of a foot may be from a panel's centre; panels (c, 2)."""
    away = np.abs(panels - panels[column])
    beside = [((np.abs(away[:, k] - PANEL) < 0.01) & (away[:, 1 - k] < HALF_PANEL)).any() for k in (0, 1)]
    return HALF_PANEL - np.where(beside, step.neighbour_margin, step.ball_margin)


def on_panel(ball: Array, toes: float, spot: Spot) -> Array:
    """Return the place nearest to this ball (2,) that keeps ball and middle of the sole in their allowed places."""
    centre, room, ahead = spot.centre, spot.room, BALL_AHEAD * direction_of(toes)
    ball = np.minimum(np.maximum(ball, centre - room), centre + room)  # np.clip takes three times as long
    low, high = centre - spot.middle_room, centre + spot.middle_room
    return np.asarray(np.minimum(np.maximum(ball - ahead, low), high) + ahead)


# The objects that do not change while a song is danced. Every stage gets them as one object.


@dataclass(frozen=True, slots=True)
class Context:
    """The dancer, the settings of her motion, and her surroundings. It can be pickled.

    skeleton : of the dancer; settings : the numbers of her motion
    panels : (c, 2) world x and z of every panel's centre; squares : (s, 2) of the middle of each square of nine panels
    ground : the pad as a rectangle, and the floor around it
    beats : seconds of the song's beats, slow ones divided, in order; bar : the bar that she holds, None for no bar
    stays : whether she does not walk off after the last step; course : settings that change over the song, None:
    constant
    person : 0 for a single dancer, else her number beside the other one: each has her own random choices and phase
    phase : seconds by which her breath, blinks and slow movements are ahead of a single dancer's
    sides : the side from which she comes and the side to which she goes, 0 left or 1 right, None: as the notes decide
    """

    skeleton: Skeleton
    settings: MotionSettings
    panels: Array
    squares: Array
    ground: Ground
    beats: tuple[float, ...] = ()
    bar: Bar | None = None
    sides: tuple[int, int] | None = None
    stays: bool = False
    course: SettingsCourse | None = None
    person: int = 0
    phase: float = 0.0

    def at(self, second: float) -> Context:
        """Return the context with the settings of a second."""
        return self if self.course is None else replace(self, settings=self.course.at(second))

    def states(self, start: float, end: float) -> tuple[tuple[Context, ...], tuple[Span, ...]]:
        """Return the context with the settings of each state between two seconds, and when states change."""
        if self.course is None:
            return (self,), ()
        part = self.course.within(start, end)
        return tuple(replace(self, settings=settings, course=None) for settings in part.states), part.changes

    @property
    def own(self) -> tuple[int, ...]:
        """The numbers that are added to a random seed, so that two dancers with the same notes differ; () for a single
        dancer.
        """
        return (self.person,) if self.person else ()


def phase_of(plan: Plan, context: Context) -> float:
    """Return the phase of a dancer, seconds, as in `Context`: drawn for the song and the dancer, 0 for a single one."""
    chance = chance_of(PHASE_SEED, *plan.song, *context.own)
    breaths = chance.integers(BREATHS) + chance.uniform(*APART)
    return float(breaths) * context.settings.layers.breath_time if context.own else 0.0


def context_of(pad: Pad, settings: MotionSettings, beats: tuple[float, ...] = (), bar: Bar | None = None) -> Context:
    """Return the context of the project's own dancer on a pad."""
    panels = panels_on_ground(pad)
    low, high = panels.min(axis=0) - HALF_PANEL, panels.max(axis=0) + HALF_PANEL
    ground = Ground((float(low[0]), float(low[1])), (float(high[0]), float(high[1])), settings.walk.floor)
    return Context(dancer_skeleton(), settings, panels, squares_on_ground(pad), ground, beats, bar)


# The beats to which she moves.

ON_BEAT = 0.05  # seconds from a beat within which a step is on it


@lru_cache(maxsize=8)
def heard_beats(beats: tuple[float, ...], shortest: float) -> Array:
    """Return the beats (k,) to which the dancer moves, seconds: quick beats only every second one, or fewer.

    The array is shared between calls: do not change it.
    """
    heard: list[float] = []
    for beat in beats:
        if not heard or beat - heard[-1] >= shortest:
            heard.append(beat)
    return np.array(heard)


def distances(seconds: Array, others: Array) -> Array:
    """Return how far (n,) each of the sorted `others` next to each of `seconds` (n,) is, seconds."""
    padded = np.concatenate(([-np.inf], others, [np.inf]))
    k = np.searchsorted(padded, seconds)
    return np.asarray(np.minimum(seconds - padded[k - 1], padded[k] - seconds))


def is_on_beat(context: Context, second: float) -> bool:
    """Whether a step at a second is on a beat that the dancer hears."""
    beats = heard_beats(context.beats, context.settings.layers.beat_shortest)
    return bool(distances(np.array([second]), beats)[0] < ON_BEAT)


# The bar behind the dancer: its place, the stand of a dancer who holds it, and when each hand is on it.

BAR_SEED = 19981121
ACROSS_SLOWER = 1.5  # factor of the time that a hand needs to reach the rail if it crosses over


def bar_of(pad: Pad, settings: BarSettings) -> Bar:
    """Return the bar of a pad: a rail behind each of its squares of nine panels."""
    spans = tuple((float(x - settings.posts), float(x + settings.posts)) for x in np.sort(squares_on_ground(pad)[:, 0]))
    rear = float(panels_on_ground(pad)[:, 1].min()) - HALF_PANEL
    return Bar(settings.height, rear - settings.behind, settings.radius, spans)


def holding(settings: MotionSettings) -> MotionSettings:
    """Return the settings for a dancer who holds the bar: she stands a little lower, because her feet are far ahead of
    her.

    In streams she goes down a little, and her chest faces the screen more, because both hands hold the bar. For jumps
    she goes down half as far, because the bar carries a part of the weight.
    """
    body, jump, look, bar = settings.body, settings.jump, settings.look, settings.bar
    body = replace(body, leg=body.leg - bar.knees, soft_reach=body.soft_reach - bar.knees)
    body = replace(body, stream_crouch=bar.stream_crouch)
    jump = replace(jump, crouch=jump.crouch / 2, follow=jump.follow / 2)
    groove = replace(settings.groove, hands=bar.free_hand, hands_easy=bar.free_hand)
    look, wait = replace(look, torso_weight=bar.square), replace(settings.wait, arms=bar.free_hand)
    carried = settings.arms.carried_bent / 3, settings.arms.carried_upper / 3  # not far from the rail
    arms = replace(settings.arms, carried_bent=carried[0], carried_upper=carried[1], bent_easy=settings.arms.bent)
    return replace(settings, body=body, jump=jump, look=look, groove=groove, arms=arms, wait=wait)


def on_rail(x: Array, bar: Bar, from_end: float) -> Array:
    """Return the nearest place on the rail, at least `from_end` metres from its ends."""
    choices = np.stack([np.clip(x, low + from_end, high - from_end) for low, high in bar.spans])
    nearest = np.argmin(np.abs(choices - x), axis=0)
    return np.asarray(np.take_along_axis(choices, nearest[None], axis=0)[0])


def grip_phrases(plan: Plan, times: Array, yaw: Array, settings: BarSettings) -> tuple[Flags, Array]:
    """Return which hands (n, 2) may be on the rail at even times (n,), and how far (n,) beside the body, metres.

    A song is divided into phrases of some seconds. In each, the dancer holds the bar with both hands, as mostly in
    quick phrases, or with one: when she is turned, with the hand on the rail's side, otherwise with either. The choices
    are random, but always the same for a song.

    yaw : (n,) radians that the chest is turned
    """
    chance = chance_of(BAR_SEED, *plan.song)
    holds, apart = np.ones((len(times), 2), dtype=bool), np.full(len(times), settings.apart)
    notes, start = np.array([touch.start for touch in plan.touches]), float(times[0])
    while start < times[-1]:
        end = start + chance.uniform(settings.phrase_least, settings.phrase_most)
        near = slice(*np.searchsorted(times, (start, end)).tolist())
        quick = float(((notes >= start) & (notes < end)).sum()) / (end - start) > settings.quick
        one, side, nearer = chance.random(), int(chance.integers(2)) ^ plan.lead, chance.uniform(-1.0, 1.0)
        apart[near] += nearer * settings.nearer
        if one < (settings.one_quick if quick else settings.one_slow):
            turned = float(yaw[near].mean())
            if abs(turned) > np.radians(settings.turned):
                side = int(turned < 0.0)  # turned to the left, the dancer has the rail at her left
            holds[near, 1 - side] = False
        start = end
    return holds, apart


def hold_share(grips: tuple[Grip, ...], times: Array, reach: float) -> Array:
    """Return how much each hand is at the rail, (n, 2), 0 to 1: 1 from a grip's start to its end."""
    out = np.zeros((len(times), 2))
    for grip in grips:
        near = grip_slice(grip, times, reach)
        out[near, grip.side] += grip_share(grip, times[near], reach)
    return np.minimum(out, 1.0)


def grip_slice(grip: Grip, times: Array, reach: float) -> slice:
    """Return the slice of the times (n,) at which the hand of a grip is on its way or at the rail."""
    long = way_time(grip, reach)
    return slice(*np.searchsorted(times, (grip.start - long, grip.end + long)).tolist())


def way_time(grip: Grip, reach: float) -> float:
    """Return the seconds of a hand's way to the rail and from it; in front of the body, its way is longer."""
    return ACROSS_SLOWER * reach if grip.across else reach


def grip_share(grip: Grip, times: Array, reach: float) -> Array:
    """Return the share of a grip at each time (n,), 0 to 1; reach : seconds to the rail and from it."""
    long = way_time(grip, reach)
    return smooth((times - grip.start + long) / long) * smooth((grip.end + long - times) / long)


def held_notes(motion: Motion, second: float) -> list[Contact]:
    """Return the notes that feet hold at a second. They stay among the contacts, so a report counts them as missed."""
    feet = (c for c in motion.contacts if c.limb < Limb.LEFT_HAND and c.kind == StepKind.HOLD)
    return [c for c in feet if c.start < second and c.end > second + HOLD_GRACE]
