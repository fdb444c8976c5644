"""The dance of a chart in pieces: always the same ones, whichever part of it is wanted, so every cut shows one dance.

A piece knows nothing of other pieces. It is planned and baked beyond both ends by as much as its dancer remembers, and
where two meet the earlier one turns into the later one. Memory and time per second stay as they are in a short song.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Contact, Ground, Motion
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.foot_moves import Walk
from dancetutor_cli.motion.plan import FootTrack, Plan
from dancetutor_cli.motion.sampling import sample
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.physics.distances import Distances
from dancetutor_cli.play.let_go import told
from dancetutor_cli.rig import quaternion as quat

if TYPE_CHECKING:
    from dancetutor_cli.physics.pipeline import Wishes
    from dancetutor_cli.physics.style import Style

Array = NDArray[np.float64]
Span = tuple[float, float]  # first and last second
LENGTH = 90.0  # seconds of a piece, about
LONGEST = 135.0  # a song up to so long is one piece
AFTER = 1.0  # seconds; heels rise for swings that begin so soon
WITHIN = 20.0  # seconds around a piece's even end in which the best place to end it is looked for
MARGIN = 1.0  # seconds planned and smoothed beyond both ends of what is baked
OVERLAP = 5.0  # seconds that a piece is planned and baked beyond its ends: what differs has died away
BLEND = 0.5  # seconds before a piece's end in which it turns into the next one


@dataclass(frozen=True, slots=True)
class RagdollStyle:
    """The style in which a ragdoll follows the dancer, and what befalls her."""

    style: Style
    wishes: Wishes


@dataclass(frozen=True, slots=True)
class Piece:
    """One piece of work; pickles.

    plan : what matters of the plan; contacts : those that begin while it is baked; ground : as in `Motion`
    baked : gets keys; kept : the part of them that goes into the song; span : the body's path is planned over it
    ragdoll : None for the dancer as she is
    """

    plan: Plan
    context: Context
    fps: float
    contacts: tuple[Contact, ...]
    ground: Ground | None
    baked: Span
    kept: Span
    span: Span
    ragdoll: RagdollStyle | None = None


@dataclass(frozen=True, slots=True)
class BakedPiece:
    """What a piece of work gives, also of its overlap; distances : of the ragdoll from what it followed, if any."""

    motion: Motion
    distances: Distances | None = None


Each = Callable[[Callable[[Piece], BakedPiece], Sequence[Piece]], Iterable[BakedPiece]]


def in_turn(function: Callable[[Piece], BakedPiece], pieces: Sequence[Piece]) -> Iterable[BakedPiece]:
    """Do one piece after the other in this process."""
    return map(function, pieces)


def whole_span(plan: Plan, context: Context) -> Span:
    """First and last second of a dance: from the song's beginning, or before the first step, to after the last one."""
    walk = context.settings.walk
    left = max((route.end for route in plan.walks), default=-np.inf) + walk.gone
    return min(0.0, plan.first - walk.lead_in), max(plan.last + walk.lead_out, left)


def pieces_of(plan: Plan, context: Context, fps: float, ragdoll: RagdollStyle | None = None) -> list[Piece]:
    """All pieces of a dance, in order of time."""
    start, end = whole_span(plan, context)
    pieces = []
    for first, last in pairwise(piece_ends(plan, start, end)):
        before, after = (first if first == start else first - OVERLAP), (MARGIN if last == end else OVERLAP)
        pieces.append(piece_of(plan, context, fps, ((before, last), (first, last), after), ragdoll))
    return pieces


def piece_of(
    plan: Plan, context: Context, fps: float, times: tuple[Span, Span, float], ragdoll: RagdollStyle | None = None
) -> Piece:
    """One piece. times : what is baked, what of that is kept, and seconds that are planned beyond its end"""
    (before, last), kept, after = times
    part = trimmed(plan, before - MARGIN, last + after)
    span = (float(np.floor(4 * (before - MARGIN)) / 4), last + after)
    contacts = tuple(one for one in plan.contacts if before <= one.start <= last)
    ground = context.ground if plan.walks else None
    return Piece(part, context, fps, contacts, ground, (before, last), kept, span, ragdoll)


def piece_ends(plan: Plan, start: float, end: float) -> list[float]:
    """Where pieces begin and end, from `start` to `end`: in the middle of the longest stand around every so often."""
    if end - start <= LONGEST:
        return [start, end]
    moving = sorted((m.lift, m.land) for track in plan.feet for m in track.moves)
    moving += [(p.start - p.lead, p.end + p.lead) for p in plan.presses]
    lifts, lands = np.array(sorted(moving)).reshape(-1, 2).T
    lands = np.maximum.accumulate(np.concatenate(([-np.inf], lands)))  # when both feet are down again
    lifts = np.append(lifts, np.inf)
    out = [start]
    while end - out[-1] > LONGEST:
        out.append(_longest_stand(lands, lifts, out[-1] + LENGTH))
    return [*out, end]


def _longest_stand(lands: Array, lifts: Array, around: float) -> float:
    """The middle of the longest stretch within reach of `around` in which nothing moves, seconds."""
    low, high = around - WITHIN, around + WITHIN
    begin, end = np.clip(lands, low, high), np.clip(lifts, low, high)
    k = int(np.argmax(end - begin))
    return float((begin[k] + end[k]) / 2) if end[k] > begin[k] else around


def trimmed(plan: Plan, start: float, end: float) -> Plan:
    """The plan with only what matters between two seconds: there it says the same."""
    turns = plan.turns
    first = max(int(np.searchsorted([t.start for t in turns], start)) - 2, 0)
    return replace(
        plan,
        feet=(_track(plan.feet[0], start, end), _track(plan.feet[1], start, end)),
        turns=tuple(t for t in turns[first:] if t.start <= end),
        presses=tuple(p for p in plan.presses if p.end >= start - 2.0 and p.start <= end + 2.0),
        grips=tuple(g for g in plan.grips if g.end >= start - 2.0 and g.start <= end + 2.0),
        touches=tuple(c for c in plan.contacts if c.end >= start and c.start <= end),
        walks=tuple(w for w in plan.walks if w.end >= start and w.start <= end),
    )


def _track(track: FootTrack, start: float, end: float) -> FootTrack:
    moves = track.moves
    first = max(int(np.searchsorted([m.land for m in moves], start)) - 2, 0)
    return track_from(track, first, tuple(m for m in moves[first:] if m.lift <= end + AFTER))


def track_from(track: FootTrack, first: int, moves: Sequence[object]) -> FootTrack:
    """A track that begins where the foot stands before its move number `first`, with other moves from there on."""
    kept = tuple(moves)
    if first == 0:
        return replace(track, moves=kept)  # type: ignore[arg-type]
    before = track.moves[first - 1]
    level = before.level if isinstance(before, Walk) else 0.0
    return FootTrack(before.target, before.yaw, kept, level)  # type: ignore[arg-type]


def needed(pieces: Sequence[Piece], start: float, end: float) -> slice:
    """Which pieces a cut from `start` to `end` (seconds) is made of."""
    last = len(pieces) - 1
    touched = [
        k
        for k, piece in enumerate(pieces)
        if (k == last or start < piece.kept[1]) and (k == 0 or end > pieces[k - 1].kept[1] - BLEND)
    ]
    return slice(touched[0], touched[-1] + 1)


def joined(pieces: Sequence[Piece], done: Sequence[BakedPiece], start: float, end: float) -> BakedPiece:
    """Neighbouring pieces as one motion from `start` to `end`, seconds; rotations never jump to their negative."""
    parts: list[tuple[Array, Array, Array]] = []
    for k, (piece, one) in enumerate(zip(pieces, done, strict=True)):
        times, last = one.motion.times, k + 1 == len(pieces)
        first = piece.kept[0] if k else -np.inf
        keep = (times >= max(first, start - 1e-9)) & (times <= end + 1e-9) & ((times < piece.kept[1]) | last)
        if not keep.any():
            continue
        at, rotations, root = times[keep], quat.continuous(one.motion.rotations[keep]), one.motion.root[keep]
        if not last:
            share = smooth((at - piece.kept[1]) / BLEND + 1.0)
            later, later_root = sample(done[k + 1].motion, at)
            rotations = np.where((share > 0.0)[:, None, None], quat.slerp(rotations, later, share[:, None]), rotations)
            root = root + share[:, None] * (later_root - root)
        if parts:
            flipped = np.sum(rotations[0] * parts[-1][1][-1], axis=-1) < 0
            rotations[:, flipped] *= -1.0
        parts.append((at, rotations, root))
    motion = _between(pieces, done, start, end)
    distances = _distances(done, start, end)
    if sum(len(at) for at, _, _ in parts) < 2:  # a stretch too short for two keys has its own start and end
        at = np.array([start, end])
        rotations, root = sample(done[-1].motion, at)
        return BakedPiece(replace(motion, times=at, rotations=rotations, root=root), distances)
    times, rotations, root = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    return BakedPiece(replace(motion, times=times, rotations=rotations, root=root), distances)


def _between(pieces: Sequence[Piece], done: Sequence[BakedPiece], start: float, end: float) -> Motion:
    """The first piece's motion with all that lies between two seconds but the keys."""
    gone = tuple(one for one in pieces[0].plan.let_go if start <= one.second <= end)
    notes = dict.fromkeys(note for one in done for note in one.motion.notes)
    grips = dict.fromkeys(g for one in done for g in one.motion.grips if g.end > start and g.start < end)
    return replace(
        done[0].motion,
        contacts=tuple(_contacts(pieces, done, start, end)),
        grips=tuple(grips),
        notes=(*((told(gone),) if gone else ()), *notes),
        let_go=gone,
    )


def _contacts(pieces: Sequence[Piece], done: Sequence[BakedPiece], start: float, end: float) -> Iterator[Contact]:
    for k, (piece, one) in enumerate(zip(pieces, done, strict=True)):
        first = piece.kept[0] if k else -np.inf
        until = piece.kept[1] if k + 1 < len(pieces) else np.inf
        yield from (c for c in one.motion.contacts if start <= c.start <= end and first <= c.start < until)


def _distances(done: Sequence[BakedPiece], start: float, end: float) -> Distances | None:
    parts, since = [], start
    for one in done:
        if one.distances is None:
            return None
        times = one.distances.times
        keep = (times >= since) & (times <= end)
        parts.append((times[keep], one.distances.values[keep]))
        since = float(times[-1])
    times, values = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    assert done[0].distances is not None
    return Distances(done[0].distances.names, times, values)
