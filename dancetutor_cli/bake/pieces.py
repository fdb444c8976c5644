"""Long songs in pieces that meet where the dancer stands, so that an hour needs no more memory at once than minutes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.keys import Keys
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.foot_moves import Walk
from dancetutor_cli.motion.plan import FootTrack, Plan
from dancetutor_cli.rig import quaternion as quat

Array = NDArray[np.float64]
LENGTH = 90.0  # seconds of a piece, about
LONGEST = 135.0  # a song up to so long is one piece
AFTER = 1.0  # seconds; heels rise for swings that begin so soon
WITHIN = 20.0  # seconds around a piece's even end in which the best place to end it is looked for


@dataclass(frozen=True, slots=True)
class Piece:
    """One piece of work; pickles. All pairs are (first, last) seconds.

    plan : what matters of the plan; baked : gets keys; kept : the part of them that goes into the song
    span : the body's path is planned over it
    """

    plan: Plan
    context: Context
    fps: float
    baked: tuple[float, float]
    kept: tuple[float, float]
    span: tuple[float, float]


@dataclass(frozen=True, slots=True)
class BakedPiece:
    """What a piece of work gives: all its keys, also those of its overlap, and what there is to say of it."""

    keys: Keys
    notes: tuple[str, ...]


Each = Callable[[Sequence[tuple[Callable[[Piece], BakedPiece], Piece]]], Iterable[BakedPiece]]


def in_turn(work: Sequence[tuple[Callable[[Piece], BakedPiece], Piece]]) -> Iterable[BakedPiece]:
    """Do one piece after the other in this process."""
    return (function(piece) for function, piece in work)


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
    kept = tuple(m for m in moves[first:] if m.lift <= end + AFTER)
    if first == 0:
        return replace(track, moves=kept)
    before = moves[first - 1]
    return FootTrack(before.target, before.yaw, kept, before.level if isinstance(before, Walk) else 0.0)


def joined(pieces: Sequence[Piece], done: Iterable[BakedPiece]) -> BakedPiece:
    """The kept keys of all pieces in their order, with their notes; rotations never jump to their negative."""
    parts: list[Keys] = []
    notes: list[str] = []
    for k, (piece, one) in enumerate(zip(pieces, done, strict=True)):
        times, rotations, root = one.keys
        notes += one.notes
        keep = (times >= piece.kept[0]) & ((times < piece.kept[1]) | (k + 1 == len(pieces)))
        local = quat.continuous(rotations[keep])
        if parts:
            flipped = np.sum(local[0] * parts[-1][1][-1], axis=-1) < 0
            local[:, flipped] *= -1.0
        parts.append((times[keep], local, root[keep]))
    if len(parts) == 1:
        return BakedPiece(parts[0], tuple(notes))
    times, root = (np.concatenate([p[k] for p in parts]) for k in (0, 2))
    return BakedPiece((times, np.concatenate([p[1] for p in parts]), root), tuple(notes))
