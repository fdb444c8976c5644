"""The pieces of a long song, which meet where the dancer stands, and their store: every cut shows the same dance."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile

import numpy as np

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.motion import Contact, Distances, Ground, Motion, sample
from dancetutor_cli.dance.plan import FootTrack, Plan, WalkStep
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.settings import Span
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.unplayable import dropped_notes_message
from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.pool import in_order
from dancetutor_cli.run.stored_files import StoredFiles, fingerprint, program_stamp
from dancetutor_cli.run.trust import kept_folder

if TYPE_CHECKING:
    from dancetutor_cli.dance.physics.blend import Blend
    from dancetutor_cli.dance.physics.pipeline import RagdollOptions

# A piece does not depend on other pieces. It is planned and baked beyond both ends, as far as the past affects the
# dancer. Where two pieces meet, the earlier one turns into the later one. Memory and time per second stay as low as for
# a short song.

LENGTH = 90.0  # seconds of a piece, approximately
LONGEST = 135.0  # seconds; a song up to this length is one piece
AFTER = 1.0  # seconds; heels rise for swings that begin within this time
WITHIN = 20.0  # seconds around the even end of a piece in which the best end is searched
MORE_PLANNED = 1.0  # seconds beyond both ends of the baked part that are planned and smoothed
OVERLAP = 5.0  # seconds beyond its ends that a piece is planned and baked; differences are gone by then
BLEND = 0.5  # seconds before a piece's end in which it turns into the next one


@dataclass(frozen=True, slots=True)
class RagdollStyle:
    """The styles in which a ragdoll follows the dancer, and the pushes and trips that she gets."""

    blend: Blend
    options: RagdollOptions


@dataclass(frozen=True, slots=True)
class Piece:
    """One piece of work. It can be pickled.

    plan : the relevant part of the plan; contacts : the contacts that begin in the baked part; ground : as in `Motion`
    baked : the part that gets keys; kept_span : the part of it that goes into the song; span : the part in which the
    body's path is planned
    ragdoll : None: the motion stays without a ragdoll
    """

    plan: Plan
    context: Context
    fps: float
    contacts: tuple[Contact, ...]
    ground: Ground | None
    baked: Span
    kept_span: Span
    span: Span
    ragdoll: RagdollStyle | None = None


@dataclass(frozen=True, slots=True)
class BakedPiece:
    """The result of a piece of work, with its overlap. distances : between the ragdoll and the followed motion"""

    motion: Motion
    distances: Distances | None = None


PieceRunner = Callable[[Sequence[Piece]], Iterable[BakedPiece]]


def in_turn(pieces: Sequence[Piece]) -> Iterable[BakedPiece]:
    """Bake one piece after the other in this process."""
    from dancetutor_cli.dance.bake import bake_piece  # kept pieces need none of its modules

    return map(bake_piece, pieces)


def in_processes(jobs: int, pieces: Sequence[Piece]) -> Iterable[BakedPiece]:
    """Bake the pieces in up to `jobs` processes, and return them in their order."""
    from dancetutor_cli.dance.bake import bake_piece

    return in_turn(pieces) if len(pieces) == 1 else in_order(jobs, bake_piece, [(piece,) for piece in pieces])


def whole_span(plan: Plan, context: Context) -> Span:
    """Return the first and last second of a dance. It begins with the song, or earlier, before the first step."""
    walk = context.settings.walk
    left = max((one.end for one in plan.walks), default=-np.inf) + walk.gone
    return min(0.0, plan.first - walk.lead_in), max(plan.last + walk.lead_out, left)


def pieces_of(plan: Plan, context: Context, fps: float, ragdoll: RagdollStyle | None = None) -> list[Piece]:
    """Return all pieces of a dance, in order of time."""
    start, end = whole_span(plan, context)
    pieces = []
    plan = replace(plan, touches=plan.contacts)  # each contact lasts until the foot leaves, in all pieces alike
    for first, last in pairwise(piece_ends(plan, start, end)):
        before, after = (first if first == start else first - OVERLAP), (MORE_PLANNED if last == end else OVERLAP)
        pieces.append(piece_of(plan, context, fps, ((before, last), (first, last), after), ragdoll))
    return pieces


def piece_of(
    plan: Plan, context: Context, fps: float, times: tuple[Span, Span, float], ragdoll: RagdollStyle | None = None
) -> Piece:
    """Return one piece. times : the baked part, the kept part of it, and the seconds that are planned beyond its end"""
    (before, last), kept, after = times
    part = trimmed(plan, before - MORE_PLANNED, last + after)
    span = (float(np.floor(4 * (before - MORE_PLANNED)) / 4), last + after)
    contacts = tuple(one for one in plan.contacts if before <= one.start <= last)
    ground = context.ground if plan.walks else None
    return Piece(part, context, fps, contacts, ground, (before, last), kept, span, ragdoll)


def piece_ends(plan: Plan, start: float, end: float) -> list[float]:
    """Return the ends of the pieces from `start` to `end`: the middle of the longest stand near each regular time."""
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
    """Return the middle of the longest stretch near `around` in which nothing moves, in seconds."""
    low, high = around - WITHIN, around + WITHIN
    begin, end = np.clip(lands, low, high), np.clip(lifts, low, high)
    k = int(np.argmax(end - begin))
    return float((begin[k] + end[k]) / 2) if end[k] > begin[k] else around


def trimmed(plan: Plan, start: float, end: float) -> Plan:
    """Return the part of the plan that matters between two seconds; there it is the same as the whole plan."""
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
    """Return a track that begins where the foot stands before its move `first`, with `moves` from there on."""
    kept = tuple(moves)
    if first == 0:
        return replace(track, moves=kept)  # type: ignore[arg-type]
    before = track.moves[first - 1]
    level = before.level if isinstance(before, WalkStep) else 0.0
    return FootTrack(before.target, before.yaw, kept, level)  # type: ignore[arg-type]


def needed_pieces(pieces: Sequence[Piece], start: float, end: float) -> slice:
    """Return the indices of the pieces that a cut from `start` to `end` (seconds) needs."""
    last = len(pieces) - 1
    touched = [
        k
        for k, piece in enumerate(pieces)
        if (k == last or start < piece.kept_span[1]) and (k == 0 or end > pieces[k - 1].kept_span[1] - BLEND)
    ]
    return slice(touched[0], touched[-1] + 1)


def bake_section(pieces: list[Piece], section: Span, run: PieceRunner = in_turn) -> BakedPiece:
    """Bake a section (seconds) of the dance of all these pieces. Only the pieces that it needs are baked."""
    start, end = section
    if not start < end:
        raise DancetutorError(
            f"the section from {start:.3f} s to {end:.3f} s is empty; its start must come before its end"
        )
    some = pieces[needed_pieces(pieces, start, end)]
    return joined(some, list(run(some)), start, end)


def joined(pieces: Sequence[Piece], done: Sequence[BakedPiece], start: float, end: float) -> BakedPiece:
    """Join neighbouring pieces into one motion from `start` to `end`, seconds. Quaternions never change their sign."""
    parts: list[tuple[Array, Array, Array]] = []
    for k, (piece, one) in enumerate(zip(pieces, done, strict=True)):
        times, last = one.motion.times, k + 1 == len(pieces)
        first = piece.kept_span[0] if k else -np.inf
        keep = (times >= max(first, start - 1e-9)) & (times <= end + 1e-9) & ((times < piece.kept_span[1]) | last)
        if not keep.any():
            continue
        at, rotations, root = times[keep], quat.continuous(one.motion.rotations[keep]), one.motion.root[keep]
        if not last:
            share = smooth((at - piece.kept_span[1]) / BLEND + 1.0)
            turns = share > 0.0  # the last keys alone
            later, later_root = sample(done[k + 1].motion, at[turns])
            rotations[turns] = quat.slerp(rotations[turns], later, share[turns, None])
            root[turns] += share[turns, None] * (later_root - root[turns])
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
    """Return the first piece's motion with contacts, grips and notes between two seconds; its keys are not changed."""
    gone = tuple(one for one in pieces[0].plan.dropped if start <= one.second <= end)
    notes = dict.fromkeys(note for one in done for note in one.motion.notes)
    grips = dict.fromkeys(g for one in done for g in one.motion.grips if g.end > start and g.start < end)
    return replace(
        done[0].motion,
        contacts=tuple(_contacts(pieces, done, start, end)),
        grips=tuple(grips),
        notes=(*((dropped_notes_message(gone),) if gone else ()), *notes),
        dropped=gone,
    )


def _contacts(pieces: Sequence[Piece], done: Sequence[BakedPiece], start: float, end: float) -> Iterator[Contact]:
    for k, (piece, one) in enumerate(zip(pieces, done, strict=True)):
        first = piece.kept_span[0] if k else -np.inf
        until = piece.kept_span[1] if k + 1 < len(pieces) else np.inf
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


# The store of baked pieces of this user, so that a later cut of the same dance needs no bake.
#
# Each piece is a file of numpy arrays. Its name is a hash (`run.stored_files.fingerprint`) of the piece of work and of
# the program. If the store is too large, the oldest files are deleted.

LARGEST = 512_000_000  # bytes of the store; above it, the oldest files are deleted
_ARRAYS = ("times", "rotations", "root")


def with_store(run: PieceRunner) -> PieceRunner:
    """Return a runner that reads the kept pieces, bakes the others with `run` and keeps them."""
    folder = kept_folder("dances")
    return run if folder is None else partial(_run_or_read, StoredFiles(folder, largest=LARGEST), run)


def _run_or_read(files: StoredFiles, run: PieceRunner, pieces: Sequence[Piece]) -> Iterator[BakedPiece]:
    names = [f"{fingerprint(piece, program_stamp())}.npz" for piece in pieces]
    found = [_read(files, name, piece) for name, piece in zip(names, pieces, strict=True)]
    missing = [piece for piece, one in zip(pieces, found, strict=True) if one is None]
    made = iter(run(missing) if missing else ())
    for name, piece, one in zip(names, pieces, found, strict=True):
        if one is None:
            one = next(made)
            _write(files, name, one, piece)
        yield one


def _read(files: StoredFiles, name: str, piece: Piece) -> BakedPiece | None:
    """Read a kept piece; None if the file does not exist or cannot be read."""
    content = files.read(name, LARGEST)
    if content is None:
        return None
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            data = {key: file[key] for key in file.files}
        words = json.loads(bytes(data["words"]))
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None
    contacts = tuple(piece.contacts[k] for k in words["contacts"])
    grips = tuple(g for g in piece.plan.grips if g.end > piece.baked[0] and g.start < piece.baked[1])
    times, rotations, root = (data[name] for name in _ARRAYS)
    context, notes = piece.context, tuple(words["notes"])
    motion = Motion(
        context.skeleton, piece.fps, times, rotations, root, contacts, context.bar, grips, piece.ground, notes
    )
    if "distance_times" not in data:
        return BakedPiece(motion)
    return BakedPiece(motion, Distances(tuple(words["points"]), data["distance_times"], data["distances"]))


def _write(files: StoredFiles, name: str, one: BakedPiece, piece: Piece) -> None:
    """Keep a piece. If that fails, the piece is baked again the next time."""
    motion, distances = one.motion, one.distances
    still = set(motion.contacts)
    words: dict[str, Any] = {
        "contacts": [k for k, contact in enumerate(piece.contacts) if contact in still],
        "notes": motion.notes,
    }
    arrays = {name: getattr(motion, name) for name in _ARRAYS}
    if distances is not None:
        words["points"] = distances.names
        arrays |= {"distance_times": distances.times, "distances": distances.values}
    content = io.BytesIO()
    np.savez(content, words=np.frombuffer(json.dumps(words).encode(), np.uint8), **arrays)
    files.write(name, content.getvalue())
    files.prune()
