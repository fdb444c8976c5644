"""The store of baked pieces of this user, so that a later cut of the same dance needs no bake.

Each piece is a file of numpy arrays. Its name is a hash (`fingerprint`) of the piece of work and of the program. If the
store is too large, the oldest files are deleted.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any
from zipfile import BadZipFile

import numpy as np

from dancetutor_cli.dance.motion import Distances, Motion
from dancetutor_cli.dance.pieces import BakedPiece, Piece, PieceRunner
from dancetutor_cli.run.fingerprint import fingerprint, program_stamp
from dancetutor_cli.run.stored_files import StoredFiles
from dancetutor_cli.run.trust import kept_folder

LARGEST = 512_000_000  # bytes of the store; above it, the oldest files are deleted
_ARRAYS = ("times", "rotations", "root")
Function = Callable[[Piece], BakedPiece]


def with_store(run: PieceRunner) -> PieceRunner:
    """Return a runner that reads the kept pieces, bakes the others with `run` and keeps them."""
    folder = kept_folder("dances")
    return run if folder is None else partial(_run_or_read, StoredFiles(folder, largest=LARGEST), run)


def _run_or_read(
    files: StoredFiles, run: PieceRunner, function: Function, pieces: Sequence[Piece]
) -> Iterator[BakedPiece]:
    names = [f"{fingerprint(piece, program_stamp())}.npz" for piece in pieces]
    found = [_read(files, name, piece) for name, piece in zip(names, pieces, strict=True)]
    missing = [piece for piece, one in zip(pieces, found, strict=True) if one is None]
    made = iter(run(function, missing) if missing else ())
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
