"""The dancer's movements while she waits: her weight goes from foot to foot with the beat, she shakes out her arms,
rolls her shoulders, taps a heel. The movements are random, but always the same for the same song.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import NamedTuple

import numpy as np

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.plan import Pivot, Plan, chance_of
from dancetutor_cli.dance.settings_body import WaitSettings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array

SEED = 20190607
EARLIEST = 0.3  # part of its time in which an act begins, so that no act runs into the next
ENDS = 30.0  # seconds of beats before the first and after the last beat that the dancer still follows


@dataclass(frozen=True, slots=True)
class WaitMotion:
    """The movements that a wait adds at n times; all are 0 outside of waits.

    share : (n,) 0 to 1, how much the dancer waits; shift : (n,) metres that her hips must be on the left of the middle
    between the feet
    turn : (n,) radians that her chest is turned to the left; hips : (n,) the same of her pelvis, with her chest
    swing : (n, 2) metres ahead that the left and the right hand swing beside the hips
    hands : (n, 2, 3) metres by which the left and the right hand move, in the chest's upright axes
    flap : (n, 2) radians that hands are bent at the wrist; loose : (n, 2) 0 to 1, how much fingers hang
    shrug : (n, 2) radians that shoulders are raised
    tilt : (n,) radians that the head leans to the left; heels : (n, 2) radians that heels are raised
    """

    share: Array
    shift: Array
    turn: Array
    hips: Array
    swing: Array
    hands: Array
    flap: Array
    loose: Array
    shrug: Array
    tilt: Array
    heels: Array

    @classmethod
    def none(cls, count: int) -> WaitMotion:
        """Return no movements, for `count` times."""
        one, two = partial(np.zeros, count), partial(np.zeros, (count, 2))
        return cls(one(), one(), one(), one(), two(), np.zeros((count, 2, 3)), two(), two(), two(), one(), two())


def waiting_at(plan: Plan, times: Array, context: Context) -> WaitMotion:
    """Return the movements of waits at `times` (n,) seconds. Mirror images of a plan wait as mirror images."""
    numbers, out = context.settings.wait, WaitMotion.none(len(times))
    spans = list(_waits(plan, context))
    for start, end in spans:
        near = slice(*np.searchsorted(times, (start, end)).tolist())
        t = times[near]
        out.share[near] = smooth((t - start) / numbers.ease) * smooth((end - t) / numbers.ease)
    busy = np.flatnonzero(out.share > 0.0)
    if not len(busy):
        return out
    first, last = float(times[busy[0]]), float(times[busy[-1]])
    out.shift[:] = plan.hand * out.share * _shift(times, context)
    over = out.shift / max(numbers.shift, 1e-6)
    out.swing[:], out.hips[:] = numbers.arms * np.outer(over, (-1.0, 1.0)), np.radians(numbers.hips) * over
    song = song_of(plan, context)
    slow = [slowly(song, times, numbers.turn_time, salt) for salt in range(3)]
    out.turn[:] = plan.hand * out.share * np.radians(numbers.turn) * slow[0] + np.radians(numbers.chest) * over
    for hand in (0, 1):  # now and then one hand is held in front of the body for a while
        up = out.share * smooth((slow[1 + (hand ^ plan.lead)] - numbers.held_from) / (1.0 - numbers.held_from))
        out.hands[:, hand] += up[:, None] * [0.0, numbers.held_up, numbers.held_ahead]
    for number in range(int(np.floor(first / numbers.every)) - 1, int(np.floor(last / numbers.every)) + 1):
        act = _draw(song, number)
        long = numbers.stretch_long if _KINDS[act.kind] is _stretch else 1.0
        start = numbers.every * (number + act.late / long)
        end = min(start + numbers.lasts * act.long * long, numbers.every * (number + 1))
        if any(a <= start and end <= b for a, b in spans):
            near = slice(*np.searchsorted(times, (start, end)).tolist())
            side = act.side ^ plan.lead
            _KINDS[act.kind](out, near, _Act(times[near] - start, end - start, side), numbers)
    if plan.lead:
        out.tilt[:] *= -1.0
    return out


Song = tuple[int, ...]


def song_of(plan: Plan, context: Context) -> Song:
    """Return the seed of random choices for a song and a dancer, the same for the mirror image and each piece."""
    return *plan.song, *context.own


def _chance(song: Song, *numbers: int) -> np.random.Generator:
    """Return a random generator for one choice in this song."""
    return chance_of(SEED, *song, *numbers)


class _Draw(NamedTuple):
    """The random choices for one act: its beginning and duration, as parts of their times; side; kind."""

    late: float
    long: float
    side: int
    kind: int


@lru_cache(maxsize=1024)
def _draw(song: Song, number: int) -> _Draw:
    """Return the act of this number, which each round of a bake needs; all kinds come in turn, in changing orders."""
    chance = _chance(song, number)
    turn, place = divmod(number, len(_KINDS))
    kind = int(_chance(song, turn, 1).permutation(len(_KINDS))[place])
    return _Draw(chance.uniform(0.0, EARLIEST), chance.uniform(0.8, 1.2), int(chance.integers(2)), kind)


def _waits(plan: Plan, context: Context) -> Iterator[tuple[float, float]]:
    """Return first and last second of each stand that is long enough, without its ends."""
    numbers, down = context.settings.wait, context.settings.hands.reach_down
    busy = [(move.lift, move.land) for track in plan.feet for move in track.moves if not isinstance(move, Pivot)]
    busy += [(press.start - press.lead, press.end + down) for press in plan.presses]
    busy += [(walk.start, walk.end) for walk in plan.walks]
    free = -np.inf
    after = [] if context.stays else [(np.inf, np.inf)]  # at the end of a passage the dancer only stands
    for start, end in [*sorted(busy), *after]:
        if start - free >= numbers.after:
            yield free + numbers.begin, start - numbers.ready
        free = max(free, end)


def _shift(times: Array, context: Context) -> Array:
    """Return the place of the weight (n,), metres, positive over the left foot: over one foot on a beat, then on its
    way.

    Some beats are danced farther than others, and sometimes the dancer stays on one foot.
    """
    numbers, beats = context.settings.wait, np.asarray(context.beats)
    if len(beats) < 2:
        beats = np.array([0.0, numbers.shift_time])
    first, last = beats[1] - beats[0], beats[-1] - beats[-2]
    before = beats[0] - max(first, 0.1) * np.arange(np.ceil(ENDS / max(first, 0.1)), 0, -1)
    after = beats[-1] + max(last, 0.1) * np.arange(1, np.ceil(ENDS / max(last, 0.1)) + 1)
    heard: list[float] = []
    for beat in (*before, *beats, *after):
        if not heard or beat - heard[-1] >= numbers.shift_time - 1e-6:
            heard.append(float(beat))
    at, chance = np.array(heard), chance_of(SEED, *context.own)
    far, stays = chance.uniform(0.7, 1.3, len(at)), chance.random(len(at)) < numbers.stays
    stays[1:] &= ~stays[:-1]
    place = numbers.shift * far * np.cumprod(np.where(stays, 1.0, -1.0))
    k = np.clip(np.searchsorted(at, times, side="right") - 1, 0, len(at) - 2)
    share = smooth((times - at[k]) / (at[k + 1] - at[k]))
    return np.asarray(place[k] + share * (place[k + 1] - place[k]))


def slowly(song: Song, times: Array, every: float, salt: int) -> Array:
    """Return a value (n,) from -1 to 1 that stays for a while and then changes; each `salt` gives another value."""
    cell = times / every + salt / 3
    knots = np.arange(np.floor(cell.min()), np.floor(cell.max()) + 2)
    place = np.array([_knot(song, int(knot), salt) for knot in knots])
    k = np.floor(cell).astype(np.int64) - int(knots[0])
    share = smooth(2.0 * (cell - np.floor(cell)))
    return np.asarray(place[k] + share * (place[k + 1] - place[k]))


@lru_cache(maxsize=1024)
def _knot(song: Song, number: int, salt: int) -> float:
    """Return the value of `slowly` at a knot; each round of a bake asks again."""
    return float(_chance(song, number, 2 + salt).uniform(-1.0, 1.0))


@dataclass(frozen=True, slots=True)
class _Act:
    """One act of the dancer. times : (m,) seconds since its beginning; long : its seconds; side : 0 left"""

    times: Array
    long: float
    side: int

    @property
    def fade(self) -> Array:
        """The weight (m,) of the act: 0 at both ends, 1 between."""
        quarter = self.long / 4
        return np.asarray(smooth(self.times / quarter) * smooth((self.long - self.times) / quarter))


def _shake(out: WaitMotion, near: slice, act: _Act, numbers: WaitSettings) -> None:
    """Let both arms hang and shake the hands, one a little after the other."""
    for hand, sign in ((0, 1.0), (1, -1.0)):
        turn = 2 * np.pi * numbers.shakes * act.times - 0.9 * (hand != act.side)
        out.flap[near, hand] += np.radians(numbers.flap) * np.sin(turn) * act.fade
        out.loose[near, hand] = act.fade
        out.hands[near, hand] += act.fade[:, None] * [sign * numbers.aside, -numbers.lower, 0.0]
        out.hands[near, hand, 0] += sign * numbers.trembling * np.sin(turn - 0.5) * act.fade


def _swing(out: WaitMotion, near: slice, act: _Act, numbers: WaitSettings) -> None:
    """Swing the arms, one ahead and the other back."""
    way = np.sin(2 * np.pi * act.times / numbers.swing_time) * act.fade
    for hand in (0, 1):
        sign = 1.0 if hand == act.side else -0.8
        out.hands[near, hand, 2] += sign * numbers.swing * way
        out.hands[near, hand, 1] += 0.3 * numbers.swing * way**2


def _shrug(out: WaitMotion, near: slice, act: _Act, numbers: WaitSettings) -> None:
    """Raise the shoulders and let them fall, one more than the other."""
    up = np.sin(np.pi * act.times / act.long) ** 2
    for hand in (0, 1):
        out.shrug[near, hand] += np.radians(numbers.shrug) * (1.0 if hand == act.side else 0.6) * up


def _loosen(out: WaitMotion, near: slice, act: _Act, numbers: WaitSettings) -> None:
    """Lean the head to one side and then to the other."""
    way = np.sin(2 * np.pi * act.times / act.long) * act.fade
    out.tilt[near] += np.radians(numbers.neck) * way


def _tap(out: WaitMotion, near: slice, act: _Act, numbers: WaitSettings) -> None:
    """Raise the heel of the foot without weight."""
    for side, sign in ((0, -1.0), (1, 1.0)):
        light = smooth(sign * out.shift[near] / numbers.shift - 0.2)
        out.heels[near, side] += np.radians(numbers.heel) * light * act.fade


def _stretch(out: WaitMotion, near: slice, act: _Act, numbers: WaitSettings) -> None:
    """Stretch the arms up aside, one over the head and the other not as far, and lower them again."""
    third = act.long / 3
    up = smooth(act.times / third) * smooth((act.long - act.times) / third)
    for hand, sign in ((0, 1.0), (1, -1.0)):
        turn = np.radians(numbers.stretch) * up * (1.0 if hand == act.side else numbers.stretch_other)
        out.hands[near, hand, 0] += sign * numbers.stretch_out * np.sin(turn)
        out.hands[near, hand, 1] += numbers.stretch_up * (1.0 - np.cos(turn))
        out.loose[near, hand] = np.maximum(out.loose[near, hand], 0.5 * up)


def _pump(out: WaitMotion, near: slice, act: _Act, numbers: WaitSettings) -> None:
    """Raise the forearms in front of the dancer; one goes up as the other goes down."""
    way = np.sin(2 * np.pi * act.times / numbers.pump_time)
    for hand, sign in ((0, 1.0), (1, -1.0)):
        turn = way if hand == act.side else -way
        out.hands[near, hand, 1] += act.fade * (numbers.pump_up + numbers.pump * turn)
        out.hands[near, hand, 2] += act.fade * (numbers.pump_ahead + 0.5 * numbers.pump * turn)
        out.hands[near, hand, 0] += act.fade * sign * numbers.aside


_KINDS: tuple[Callable[[WaitMotion, slice, _Act, WaitSettings], None], ...] = (
    _shake, _swing, _shrug, _loosen, _tap, _stretch, _pump,
)  # fmt: skip
