"""The dancer hears the music: a give on every beat, and a trunk that turns and leans with jacks and slow steps."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np

from dancetutor_cli.dance.context import ON_BEAT, Context, distances, heard_beats
from dancetutor_cli.dance.plan import Plan, Step, Swing, chance_of
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_body import LayerSettings
from dancetutor_cli.dance.smoothing import smooth, smooth_path
from dancetutor_cli.dance.trajectory.height import LOWEST, step_landings
from dancetutor_cli.dance.trajectory.stance import away_from_jumps, latest_side, leisure
from dancetutor_cli.dance.units import Array

# The dancer hears the music: between slow steps and in waits, knees and chest give a little on every beat.


def beat_bounce(context: Context, times: Array, tempo: Array, busy: Array) -> Array:
    """Return how far (n,) the dancer has given way to the beat, 0 between beats to 1 on each; 0 when feet are quick or
    hands busy.

    tempo : (n,) as in `height`; busy : (n,) 0 to 1
    """
    layers = context.settings.layers
    at = heard_beats(context.beats, layers.beat_shortest)
    if not len(at):
        return np.zeros(len(times))
    after = np.searchsorted(at, times, side="right")
    last, coming = times - np.append(-np.inf, at)[after], np.append(at, np.inf)[after] - times
    half = np.minimum(
        (last + coming) / 2, layers.beat_width
    )  # of the way from beat to beat; alone, a beat has its own width
    near = np.minimum(np.minimum(last, coming) / half, 1.0)
    return np.asarray((1.0 + np.cos(np.pi * near)) / 2 * dancing(tempo, busy, layers))


def dancing(tempo: Array, busy: Array, layers: LayerSettings) -> Array:
    """Return how free (n,) the trunk is to dance to the beat, 0 to 1; arguments as in `beat_bounce`."""
    return np.asarray(smooth(1.0 - tempo / layers.beat_fade) * (1.0 - np.clip(busy, 0.0, 1.0)))


# The trunk in jacks and slow steps: the dancer leans and turns from side to side with the beat, never twice alike.

SEED = 20020716
MOST_LOST = 6.0  # largest factor by which the wanted bob is enlarged, because smoothing the height reduces it
BEAT = (
    0.5  # seconds from pulse to pulse at which the dancer bobs by `groove.bob`, and at slower ones; quicker ones less
)
BEATS = 0.6  # how much hands pump with the beat
PULSE_SHORTEST = 0.27  # seconds from one pulse of the bob to the next at least
FOREARMS_LATE, ARMS_STILL = 0.05, 0.9  # seconds by which forearms follow the bob; part of it that quick steps take
DEEPER = 1.12  # a pulse is lowered by so much more than raised before it, because straight legs end the way up
LEVEL = 0.298  # by this part the bob is smaller in quick streams,
LEVEL_FROM, LEVEL_FULL = 7.0, 8.0  # from so many steps a second on, and fully at so many
CENTRE = 0.57  # by this part of half the bob the middle of it is lower than the height without it
USUAL = 9  # gaps between landings whose median is the pace of a stream
WITHOUT_STEP = 0.45  # a beat without a step is danced this part as deep as one with a step
NEAR_JUMPS = 0.4  # seconds before and after a jump in which the bob is smaller
SLOW_LESS = 0.43  # by this part the bob is smaller in slow steps, where knees also give after landings
CALM = 0.4  # share of the sway that stops where the dancer comes to rest
MOSTLY = 0.6  # share of the time, from `groove.mostly` (0) to always (1), in which the trunk moves as in jacks


@dataclass(frozen=True, slots=True)
class Groove:
    """The dancer's movements to the beat at n times.

    beat : (n,) 0 to 1, how far the body has given way to the beat; sink : (n,) metres that the knees give
    bob : (n,) metres by which the height is lowered on pulses before smoothing, which leaves `groove.bob` of it
    pulses : (k,) seconds at which she goes down; high : (n,) 0 on them to 1 between them
    heels : (n,) 0 to 1, how much heels take part in that, as in streams
    flexed : (n,) 0 to 1, how much elbows bend between pulses: forearms go up as she does, and drop with her
    sway : (n,) about -1 to 1, to which side the shoulders lean and turn, positive left
    weight : (n,) the same for her weight near jumps, where both feet stand: onto which leg it goes on the beat
    pump : (n,) the same for hands in streams, where the shoulders keep still: with the beat and with the steps
    grounded : (n,) 0 near jumps, where both arms go up and down together, to 1
    carried : (n, 2) about -1 to 1, how far ahead and up the left and the right hand are carried, else back
    bow : (n,) about -1 to 1, how much the trunk leans forward
    """

    beat: Array
    sink: Array
    bob: Array
    pulses: Array
    heels: Array
    high: Array
    flexed: Array
    sway: Array
    weight: Array
    pump: Array
    grounded: Array
    carried: Array
    bow: Array


@dataclass(frozen=True, slots=True)
class Occupation:
    """The other activities of the dancer at n times, (n,) each.

    tempo : how quick her steps are, as in `height`; busy, waits : 0 to 1, how busy hands are and how much
    she waits
    """

    tempo: Array
    busy: Array
    waits: Array


def groove_of(plan: Plan, times: Array, occupation: Occupation, context: Context) -> Groove:
    """Return the groove at even `times` (n,): in jacks and slow steps, not in streams; a wait sways as `waits` says."""
    settings = context.settings
    numbers, jacks = settings.groove, repeated(plan, times, settings)
    calmer = occupation.tempo * (1.0 - numbers.jack * jacks)
    beat = beat_bounce(context, times, calmer, occupation.busy)
    beat *= 1.0 - (1.0 - WITHOUT_STEP) * (1.0 - occupation.waits) * _without_step(plan, times, context)
    share = dancing(calmer, occupation.busy, settings.layers) * (1.0 - occupation.waits)
    grounded = away_from_jumps(plan, times, 3.0 * numbers.ease)
    slow = share
    share = share * (numbers.steps + (1.0 - numbers.steps) * jacks) * grounded
    easy = leisure(plan, times, numbers)
    share *= 1.0 + numbers.leisure * easy
    if context.stays:  # at the end of a passage she comes to rest
        landed = max((move.land for track in plan.feet for move in track.moves), default=-np.inf)
        share *= 1.0 - CALM * smooth((times - landed) / settings.wait.ease)
    late = np.interp(times - settings.layers.beat_late, times, beat)
    deeper = np.maximum(numbers.deeper * jacks, numbers.leisure * np.maximum(easy, occupation.waits))
    sink = (1.0 + deeper) * settings.layers.bounce * late
    among = (1.0 - SLOW_LESS * slow) * (1.0 - np.clip(occupation.busy + occupation.waits, 0.0, 1.0))
    among *= away_from_jumps(plan, times, NEAR_JUMPS)
    lows = pulses(plan, heard_beats(context.beats, settings.layers.beat_shortest), PULSE_SHORTEST)
    bob, high = _bob(plan, lows, times, occupation.tempo, context)
    to_side = sway(plan, times, context)
    free = np.clip(1.0 - share - occupation.busy - occupation.waits, 0.0, 1.0)
    loose = np.clip(1.0 - occupation.busy - occupation.waits, 0.0, 1.0) * _among_steps(plan, times)
    carried = loose[:, None] * carriage(plan, times, context)
    pump = free * grounded * (BEATS * to_side + latest_side(plan, times))
    weight = (1.0 - grounded) * np.clip(1.0 - occupation.busy - occupation.waits, 0.0, 1.0) * to_side
    bows = loose * bow(plan, times, context)
    heels = among * occupation.tempo * (1.0 - jacks)
    flexed = among * np.interp(times - FOREARMS_LATE, times, high) * _pulse_room(lows, times)
    flexed *= 1.0 - ARMS_STILL * occupation.tempo
    return Groove(
        beat, sink, among * bob, lows, heels, high, flexed, share * to_side, weight, pump, grounded, carried, bows
    )


def _bob(plan: Plan, at: Array, times: Array, tempo: Array, context: Context) -> tuple[Array, Array]:
    """Return by how much (n,) the height has to be lowered on pulses `at` (k,), metres: on average by `CENTRE` halves
    of what remains of it; and where (n,) between pulses each time is, 0 on one to 1 in the middle.

    Smoothing the height leaves 1 / (1 + (2 pi T / every)^6) of a movement that comes and goes with pulses `every`
    seconds apart. T is the time constant of `height.height_path`. So the movement is enlarged by the inverse, and the
    knees bend no more for that on average. She is lowest `beat_late` after a pulse, in streams, from half of the tempo
    on, `stream_late`. tempo : (n,) as in `height`
    """
    body, slow, stream = context.settings.body, context.settings.layers.beat_late, context.settings.groove.stream_late
    if len(at) < 2:
        return np.zeros(len(times)), np.zeros(len(times))
    gaps, late = np.diff(at), slow + (stream - slow) * np.minimum(2.0 * np.interp(at, times, tempo), 1.0)
    lows = at + np.minimum(late, LOWEST * np.append(gaps, np.inf))
    every = np.diff(lows)
    lands, middles = step_landings(plan), (lows[1:] + lows[:-1]) / 2
    quick = np.interp(middles, times, tempo)
    constant = body.height_calm + (body.height_smooth - body.height_calm) * quick
    lost = np.minimum((2.0 * np.pi * constant / every) ** 6, MOST_LOST)
    pace = _usual_pace(lands, middles)
    far = context.settings.groove.bob * np.minimum(every / BEAT, 1.0) / 2.0
    far *= 1.0 - LEVEL * smooth((pace - LEVEL_FROM) / (LEVEL_FULL - LEVEL_FROM))
    low, high = far * (CENTRE + DEEPER * (1.0 + lost)), far * (CENTRE - 1.0 - lost)
    low = (np.append(low[:1], low) + np.append(low, low[-1:])) / 2.0
    low *= np.where(distances(at, lands) < ON_BEAT, 1.0, WITHOUT_STEP)
    knots, values = np.empty(2 * len(lows) - 1), np.empty(2 * len(lows) - 1)
    knots[::2], knots[1::2] = lows, (lows[1:] + lows[:-1]) / 2
    values[::2], values[1::2] = low, high
    k = np.clip(np.searchsorted(knots, times, side="right") - 1, 0, len(knots) - 2)
    share = (1.0 - np.cos(np.pi * np.clip((times - knots[k]) / (knots[k + 1] - knots[k]), 0.0, 1.0))) / 2.0
    inside = (times > knots[0]) & (times < knots[-1])
    return values[k] + share * (values[k + 1] - values[k]), inside * np.where(k % 2, 1.0 - share, share)


def _usual_pace(lands: Array, times: Array) -> Array:
    """Return the steps a second (n,) around times: of the median of `USUAL` gaps between landings (k,), so that a few
    quicker steps in a stream do not count.
    """
    if len(lands) < 2:
        return np.zeros(len(times))
    gaps = np.pad(np.diff(lands), USUAL // 2, mode="edge")
    usual = np.median(np.lib.stride_tricks.sliding_window_view(gaps, USUAL), axis=1)
    return np.asarray(1.0 / usual[np.clip(np.searchsorted(lands, times) - 1, 0, len(usual) - 1)])


def _pulse_room(at: Array, times: Array) -> Array:
    """Return how far (n,) elbows can bend from one pulse `at` (k,), seconds, to the next, 0 to 1: by the square of the
    time between them, for hands would jerk.
    """
    return np.interp(times, at, np.minimum(np.gradient(at) / BEAT, 1.0) ** 2) if len(at) > 1 else np.zeros(len(times))


def _without_step(plan: Plan, times: Array, context: Context) -> Array:
    """Return whether (n,) the beat next to each time has no step, 0 or 1."""
    at = heard_beats(context.beats, context.settings.layers.beat_shortest)
    if not len(at):
        return np.zeros(len(times))
    near = at[np.searchsorted((at[1:] + at[:-1]) / 2, times)]
    return np.asarray(distances(near, step_landings(plan)) >= ON_BEAT, dtype=np.float64)


def pulses(plan: Plan, beats: Array, shortest: float) -> Array:
    """Return the seconds (k,) at which the dancer goes down: with steps, and with the beat where there are none.

    First come steps after which she stands for `shortest` seconds, those on `beats` before others, then quicker steps
    on beats, then beats; none is nearer to one that is there than that.
    """
    lands = step_landings(plan)
    on = distances(lands, beats) < ON_BEAT
    long = np.append(np.diff(lands), np.inf) >= shortest
    chosen: list[float] = []
    for group in (lands[on & long], lands[~on & long], lands[on & ~long], beats):
        for second in group.tolist():
            k = bisect_left(chosen, second)
            if all(abs(second - other) >= shortest for other in chosen[max(k - 1, 0) : k + 1]):
                chosen.insert(k, second)
    return np.array(chosen)


def repeated(plan: Plan, times: Array, settings: MotionSettings) -> Array:
    """Return how much (n,) one foot taps again and again in its place, at even times, 0 to 1: in jacks.

    It needs several such steps in a row: one in a stream does not count.
    """
    groove, out = settings.groove, np.zeros((len(times), 1))
    places = [np.array(track.start) for track in plan.feet]
    moves = ((m, side) for side, track in enumerate(plan.feet) for m in track.moves if isinstance(m, Swing))
    before, last = -1, -np.inf  # which foot has landed, and when
    for move, side in sorted(moves, key=lambda one: (one[0].land, one[1])):
        target = np.array(move.target)
        near = float(np.linalg.norm(target - places[side])) < settings.step.on_the_spot
        if isinstance(move, Step) and near and before == side:
            out[slice(*np.searchsorted(times, (last - groove.around, move.land + groove.around)).tolist())] = 1.0
        before = side if move.land > last else -1  # after a jump neither foot
        places[side], last = target, move.land
    mostly = smooth_path(out, np.ones(len(times)), 1.0 / float(times[1] - times[0]), groove.ease)[:, 0]
    return smooth((mostly - groove.mostly) / max(1.0 - groove.mostly, 0.05) / MOSTLY)


def sway(plan: Plan, times: Array, context: Context) -> Array:
    """Return where (n,) the dancer sways to, about -1 to 1, positive left: to one side on a beat, to the other on the
    next.

    Some beats are danced farther than others, and sometimes she stays on a side. In the mirror image of a play it is
    the other way round.
    """
    numbers = context.settings.groove
    at = heard_beats(context.beats, max(numbers.shortest, 0.1))
    if len(at) < 2:
        return np.zeros(len(times))
    chance = chance_of(SEED, *plan.song, *context.own)
    far, stays = chance.uniform(0.55, 1.1, len(at)), chance.random(len(at)) < numbers.stays
    stays[1:] &= ~stays[:-1]
    place = far * np.cumprod(np.where(stays, 1.0, -1.0))
    k = np.clip(np.searchsorted(at, times, side="right") - 1, 0, len(at) - 2)
    share = smooth((times - at[k]) / (at[k + 1] - at[k]))
    return np.asarray(plan.hand * (place[k] + share * (place[k + 1] - place[k])))


# In each phrase of the music, arms are carried differently and the trunk leans more or less: slow, large ways.

AMONG = 1.8  # seconds from a step from which on arms are carried
ARMS, TRUNK, HEAD = 2, 3, 4  # of the seeds: other draws than those of `sway`
HEAD_STAYS = 0.35  # share of the phrases in which the head stays where it is carried


def carriage(plan: Plan, times: Array, context: Context) -> Array:
    """Return how far ahead and up (n, 2) the left and the right hand are carried, about -1 to 1; different in each
    phrase.

    A hand is ahead and back in turn, never twice as far, and mostly the other one is elsewhere. In the mirror image of
    a play the hands are exchanged.
    """
    at, numbers = _phrases(context), context.settings.groove
    if len(at) < 2:
        return np.zeros((len(times), 2))
    chance = chance_of(SEED, ARMS, *plan.song, *context.own)
    far, draws = chance.uniform(0.6, 1.0, (len(at), 2)), chance.random((len(at), 2)) < numbers.phrase_stays
    draws[1:] &= ~draws[:-1]
    first = np.cumprod(np.where(draws[:, 0], 1.0, -1.0))
    place = far * first[:, None] * np.column_stack((np.ones(len(at)), np.where(draws[:, 1], 1.0, -1.0)))
    out = _through_phrases(at, place, times, numbers.phrase_ease)
    return out if plan.hand > 0.0 else out[:, ::-1]


def bow(plan: Plan, times: Array, context: Context) -> Array:
    """Return how much (n,) the trunk leans forward, about -1 to 1: more in one phrase, less in the next."""
    at = _phrases(context)
    if len(at) < 2:
        return np.zeros(len(times))
    chance = chance_of(SEED, TRUNK, *plan.song, *context.own)
    place = chance.uniform(0.6, 1.0, (len(at), 1)) * np.where(np.arange(len(at)) % 2, 1.0, -1.0)[:, None]
    return _through_phrases(at, place, times, context.settings.groove.phrase_ease)[:, 0]


def head_carriage(plan: Plan, times: Array, context: Context) -> Array:
    """Return how far (n, 3) the head is carried to the left, up, and leant to the left, about -1 to 1; different in
    each phrase.
    """
    at = _phrases(context)
    if len(at) < 2:
        return np.zeros((len(times), 3))
    chance = chance_of(SEED, HEAD, *plan.song, *context.own)
    far, stays = chance.uniform(0.6, 1.0, (len(at), 3)), chance.random((len(at), 3)) < HEAD_STAYS
    place = far * np.cumprod(np.where(stays, 1.0, -1.0), axis=0) * chance.choice([-1.0, 1.0], 3)
    way = _through_phrases(at, place, times, context.settings.groove.phrase_ease)
    return np.asarray(way * [plan.hand, 1.0, plan.hand])


def _phrases(context: Context) -> Array:
    """Return when phrases begin (k,), seconds: of as many measures of four beats as last `groove.phrase` at least."""
    return np.array(heard_beats(tuple(context.beats[::4]), context.settings.groove.phrase))


def _through_phrases(at: Array, place: Array, times: Array, ease: float) -> Array:
    """Return the way (n, c) through a place (k, c) in each of the phrases that begin `at` (k,), k 2 or more."""
    k = np.clip(np.searchsorted(at, times, side="right") - 1, 0, len(at) - 2)
    since = (times - at[k]) / np.minimum(at[k + 1] - at[k], ease)
    return np.asarray(place[k] + smooth(since)[:, None] * (place[k + 1] - place[k]))


def _among_steps(plan: Plan, times: Array) -> Array:
    """Whether (n,) there are steps before and after, 0 to 1: where there are none for some time, arms hang."""
    lands = np.array([-np.inf, *sorted(touch.start for touch in plan.touches), np.inf])
    k = np.searchsorted(lands, times)
    away = np.minimum(times - lands[k - 1], lands[np.minimum(k, len(lands) - 1)] - times)
    return smooth(1.0 - away / AMONG)
