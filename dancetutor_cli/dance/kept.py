"""The store of baked pieces of this user, so that a later cut of the same dance needs no bake.

Each piece is a file of numpy arrays. Its name is a hash (`fingerprint`) of the piece of work and of the program. If the
store is too large, the oldest files are deleted.
"""

from __future__ import annotations

import io
import json
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from dancetutor_cli.dance.motion import Distances, Motion
from dancetutor_cli.dance.pieces import BakedPiece, Piece, PieceRunner
from dancetutor_cli.run.fingerprint import fingerprint, program_stamp
from dancetutor_cli.run.trust import kept_folder, write_file

LARGEST = 512_000_000  # bytes of the store; above it, the oldest files are deleted
_ARRAYS = ("times", "rotations", "root")
Function = Callable[[Piece], BakedPiece]


def with_store(run: PieceRunner) -> PieceRunner:
    """Return a runner that reads the kept pieces, bakes the others with `run` and keeps them."""
    folder = kept_folder("dances")
    return run if folder is None else partial(_run_or_read, folder, run)


def _run_or_read(folder: Path, run: PieceRunner, function: Function, pieces: Sequence[Piece]) -> Iterator[BakedPiece]:
    paths = [folder / f"{fingerprint(piece, program_stamp())}.npz" for piece in pieces]
    found = [_read(path, piece) for path, piece in zip(paths, pieces, strict=True)]
    missing = [piece for piece, one in zip(pieces, found, strict=True) if one is None]
    made = iter(run(function, missing) if missing else ())
    for path, piece, one in zip(paths, pieces, found, strict=True):
        if one is None:
            one = next(made)
            _write(path, one, piece)
        yield one


def _read(path: Path, piece: Piece) -> BakedPiece | None:
    """Read a kept piece; None if the file does not exist or cannot be read."""
    try:
        with np.load(path, allow_pickle=False) as file:
            data = {name: file[name] for name in file.files}
        words = json.loads(bytes(data["words"]))
        path.touch()
    except (OSError, ValueError, KeyError, EOFError):
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


def _write(path: Path, one: BakedPiece, piece: Piece) -> None:
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
    with suppress(OSError):  # a full disk
        write_file(path, content.getvalue())
        _prune(path.parent)


def _prune(folder: Path) -> None:
    """Delete the oldest files until the store is at most `LARGEST` bytes."""
    files = sorted(((entry.stat(), entry.path) for entry in os.scandir(folder)), key=lambda one: -one[0].st_mtime)
    size = 0
    for status, path in files:
        size += status.st_size
        if size > LARGEST:
            Path(path).unlink(missing_ok=True)
