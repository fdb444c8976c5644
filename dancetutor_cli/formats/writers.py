"""The writers of motions by the suffix of the file, for `animate` and `retarget`.

A new format is a function here that imports its module, and a line in `FORMATS`; the options of `animate` and their
help follow.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dancetutor_cli.character.animation import AnimatedDancer
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.motion import Motion

MOVES = ".json"  # only the moves of feet and hands, which do not depend on the character


def _glb(path: Path, character: Character, motion: Motion) -> str:
    from dancetutor_cli.formats.glb import write_glb

    write_glb(path, character, motion)
    return describe_keys(motion)


def _npz(path: Path, character: Character, motion: Motion) -> str:
    from dancetutor_cli.formats.npz import write_npz

    write_npz(path, motion)
    return describe_keys(motion)


def _bvh(path: Path, character: Character, motion: Motion) -> str:
    from dancetutor_cli.formats.bvh import frame_count, write_bvh

    write_bvh(path, motion)
    start, end = motion.times[[0, -1]].tolist()  # the file itself cannot say when it begins
    return f"{frame_count(motion)} frames, {end - start:.1f} s from second {start:.3f} of the music"


# Each function writes the motion and returns a summary for people. Raises FileError.
FORMATS: dict[str, Callable[[Path, Character, Motion], str]] = {".glb": _glb, ".npz": _npz, ".bvh": _bvh}


def describe_keys(motion: Motion) -> str:
    """Return a summary of a motion for people: "312 keys, 5.2 s"."""
    start, end = motion.times[[0, -1]].tolist()
    return f"{len(motion.times)} keys, {end - start:.1f} s"


def write_dancer(path: Path, dance: AnimatedDancer) -> str:
    """Write a dancer of `animate`, as a motion or as moves; return a summary for people."""
    if path.suffix.lower() != MOVES:
        return FORMATS[path.suffix.lower()](path, dance.character, dance.motion)
    from dancetutor_cli.formats.moves_json import moves_data, write_moves

    plan, bar = dance.moves
    data = moves_data(plan, dance.title, dance.label, dance.section, bar)
    write_moves(path, data if dance.place == (0.0, 0.0) else {**data, "pad_at": [round(x, 6) for x in dance.place]})
    return "the moves"
