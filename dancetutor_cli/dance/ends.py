"""The ends of a cut, in which the dancer does not play: she waits for its first step, and comes to rest after its last.

Each end is a small dance of its own. The feet step as in the dance itself, but without the steps before the first one
or after the last one; instead they step home if there is time. One motion turns into the other within a second. The
feet are the same in both motions and stay in place during the blend.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.footwork.homing import homeward
from dancetutor_cli.dance.motion import Cut, Motion, sample
from dancetutor_cli.dance.physics.repin import AnkleTracks, feet_of, repinned
from dancetutor_cli.dance.pieces import MORE_PLANNED, OVERLAP, Piece, RagdollStyle, piece_of, track_from
from dancetutor_cli.dance.plan import FootTrack, Plan
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.settings import Span
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array, Flags, Poses

if TYPE_CHECKING:
    from dancetutor_cli.dance.keys import Keys

CROSSING = 1.0  # seconds of the blend between an end and the dance
OWN_FEET = 0.8  # below this share of the dance, the feet are the feet of the end
SAME_PLACE = 0.002  # metres
LONG_AGO = 60.0  # seconds before a cut to which earlier events are moved
NOW = 1e-6  # seconds
SOON = 0.001  # seconds after a walk, when it is over


def on_the_pad(plan: Plan, cut: Cut) -> Cut:
    """Return the cut. If it does not show the dancer's walk onto the pad, she stands there until her first step."""
    arrivals = [walk.end for walk in plan.walks if walk.end <= plan.first and not cut.walks_on]
    return replace(cut, steps_from=max([cut.steps_from, *(second + SOON for second in arrivals)]))


def entrance_of(plan: Plan, cut: Cut) -> Plan | None:
    """Return the plan of a dancer who stands until a cut's first step; None if the dance itself begins that way."""
    begin = cut.steps_from
    spans = [(one.start, one.end) for one in plan.touches]
    spans += [(walk.start, walk.end) for walk in plan.walks if not cut.walks_on]
    if not any(cut.start < end and start < begin - NOW for start, end in spans):
        return None
    tracks = [_from(track, begin) for track in plan.feet]
    before = [turn for turn in plan.turns if turn.end < begin]
    turns = [replace(turn, start=begin - LONG_AGO - 1.0, end=begin - LONG_AGO) for turn in before[-1:]]
    touches = tuple(one for one in plan.touches if one.start >= begin - NOW)
    return replace(
        plan,
        feet=(tracks[0], tracks[1]),
        turns=(*turns, *(turn for turn in plan.turns if turn.end >= begin)),
        presses=tuple(one for one in plan.presses if one.start >= begin - NOW),
        touches=touches,
        first=min((one.start for one in touches), default=plan.last),
        walks=tuple(walk for walk in plan.walks if walk.end >= begin),
        grips=tuple(
            replace(grip, start=begin - LONG_AGO) if grip.start < begin else grip
            for grip in plan.grips
            if grip.end > begin
        ),
        dropped=(),
    )


def _from(track: FootTrack, second: float) -> FootTrack:
    first = sum(move.land < second - NOW for move in track.moves)
    return track_from(track, first, track.moves[first:])


def rest_from(plan: Plan, cut: Cut) -> float | None:
    """Return the second at which the dancer comes to rest at the end of a cut; None if she dances until its end."""
    walks = [walk.start for walk in plan.walks if walk.start > plan.last and not cut.walks_off]
    until = min([cut.steps_until, *walks])
    starts = [*(touch.start for touch in plan.touches), *(walk.start for walk in plan.walks)]
    return until if any(until - NOW <= start < cut.end for start in starts) else None


def exit_of(plan: Plan, span: Span, context: Context) -> Plan:
    """Return the plan of a dancer who makes no step in a span (seconds), but steps home if there is time."""
    until = span[0]
    touches = tuple(one for one in plan.touches if one.start < until - NOW)
    left, right = (
        replace(track, moves=tuple(move for move in track.moves if move.land <= until + NOW)) for track in plan.feet
    )
    rest = replace(
        plan,
        feet=(left, right),
        turns=tuple(turn for turn in plan.turns if turn.end <= until + NOW),
        presses=tuple(one for one in plan.presses if one.start < until - NOW),
        touches=touches,
        last=max((min(one.end, until) for one in touches), default=until),
        walks=tuple(walk for walk in plan.walks if walk.start < until - NOW),
        grips=tuple(grip for grip in plan.grips if grip.start < until),
        dropped=(),
    )
    home = homeward(rest, span, context)
    if home is None:
        return rest
    left, right = (replace(track, moves=(*track.moves, *own)) for track, own in zip(rest.feet, home[0], strict=True))
    return replace(rest, feet=(left, right), turns=(*rest.turns, home[1]))


def entrance_piece(plan: Plan, context: Context, fps: float, cut: Cut, ragdoll: RagdollStyle | None) -> Piece:
    """Return the piece of an entrance: the dancer stands before the cut, and then the piece turns into the dance."""
    baked = (cut.start - MORE_PLANNED, min(cut.steps_from + CROSSING, cut.end) + MORE_PLANNED)
    return piece_of(plan, context, fps, (baked, baked, OVERLAP), ragdoll)


def exit_piece(plan: Plan, context: Context, fps: float, span: Span, ragdoll: RagdollStyle | None = None) -> Piece:
    """Return the piece of an exit. span : from the beginning of the exit to the end of the cut, seconds"""
    baked = (span[0] - CROSSING - OVERLAP, span[1])
    return piece_of(plan, replace(context, stays=True), fps, (baked, baked, MORE_PLANNED), ragdoll)


def with_entrance(dance: Motion, entrance: Motion, cut: Cut) -> Motion:
    """Return the dance with an entrance before its first step."""
    begin, end = cut.steps_from, min(cut.steps_from + CROSSING, cut.end)
    after, before = dance.times >= begin, (entrance.times >= cut.start - NOW) & (entrance.times < begin)
    share = smooth((dance.times[after] - begin) / max(end - begin, NOW))
    contacts = tuple(one for one in dance.contacts if one.start >= begin - NOW)
    return _merge_keys(
        _keys(entrance, before), _crossing(dance, after, entrance, share), replace(dance, contacts=contacts)
    )


def with_exit(dance: Motion, rest: Motion, until: float, cut: Cut) -> Motion:
    """Return the dance with an exit from second `until` on; its last step is before that second."""
    begin = max(until - CROSSING, cut.start)
    before, after = dance.times < until, (rest.times >= until) & (rest.times <= cut.end + NOW)
    share = 1.0 - smooth((dance.times[before] - begin) / max(until - begin, NOW))
    contacts = tuple(one for one in dance.contacts if one.start < until - NOW)
    return _merge_keys(_crossing(dance, before, rest, share), _keys(rest, after), replace(dance, contacts=contacts))


def _keys(motion: Motion, which: Flags) -> Keys:
    return motion.times[which], motion.rotations[which], motion.root[which]


def _merge_keys(first: Keys, second: Keys, motion: Motion) -> Motion:
    times, rotations, root = (np.concatenate(arrays) for arrays in zip(first, second, strict=True))
    return replace(motion, times=times, rotations=quat.continuous(rotations), root=root)


def _crossing(dance: Motion, which: Flags, other: Motion, share: Array) -> Keys:
    """Return some keys of the dance, each mixed by its share (f,) of the dance with another motion of the same feet."""
    times, rotations, root = _keys(dance, which)
    mixed = share < 1.0
    if mixed.any():
        poses = rotations[mixed], root[mixed]
        rotations[mixed], root[mixed] = _mixed(dance, poses, sample(other, times[mixed]), share[mixed])
    return times, rotations, root


def _mixed(dance: Motion, poses: Sequence[Array], others: Sequence[Array], share: Array) -> Poses:
    """Mix poses of the dance, by its share, with other poses. The feet are the feet of the other poses. The two motions
    differ only where a foot is on its way to a step that is left out; such a foot turns back.
    """
    skeleton = dance.skeleton
    mine, theirs = feet_of(skeleton, poses[0], poses[1]), feet_of(skeleton, others[0], others[1])
    own = smooth((share - OWN_FEET) / (1.0 - OWN_FEET))
    beside = int(np.argmax(share))  # the key next to the dance: its feet differ only where a foot is on a long way
    away = np.linalg.norm(mine.places[beside] - theirs.places[beside], axis=1) > SAME_PLACE
    own = own[:, None] * away
    feet = AnkleTracks(
        theirs.places + own[..., None] * (mine.places - theirs.places), quat.slerp(theirs.turns, mine.turns, own)
    )
    rotations = quat.slerp(others[0], poses[0], share[:, None])
    toes = [skeleton.index(f"{side}_metatarsal") for side in "lr"]
    rotations[:, toes] = quat.slerp(others[0][:, toes], poses[0][:, toes], own)
    return repinned(skeleton, Poses(rotations, others[1] + share[:, None] * (poses[1] - others[1])), feet)
