"""The formats of `animate`: from the suffix of a file to what writes it.

A new format is a function here that imports its module, and a line in `FORMATS`; options and help follow.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dancetutor_cli.dance.motion import Motion
    from dancetutor_cli.formats.animation import AnimatedDancer


@dataclass(frozen=True, slots=True)
class MotionFormat:
    """write : writes the file, FileError if that fails; returns how much is in it, for people

    has_motion : whether it holds a motion, so that it matters who dances
    """

    write: Callable[[Path, AnimatedDancer], str]
    has_motion: bool = True


def _glb(path: Path, dance: AnimatedDancer) -> str:
    from dancetutor_cli.formats.glb import write_glb

    write_glb(path, dance.character, dance.motion)
    return _keys(dance.motion)


def _npz(path: Path, dance: AnimatedDancer) -> str:
    from dancetutor_cli.formats.npz import write_npz

    write_npz(path, dance.motion)
    return _keys(dance.motion)


def _bvh(path: Path, dance: AnimatedDancer) -> str:
    from dancetutor_cli.formats.bvh import frame_count, write_bvh

    motion = dance.motion
    write_bvh(path, motion)
    start, end = _span(motion)  # the file itself cannot say when it begins
    return f"{frame_count(motion, motion.fps)} frames, {end - start:.1f} s from second {start:.3f} of the music"


def _moves(path: Path, dance: AnimatedDancer) -> str:
    from dancetutor_cli.formats.moves_json import moves_data, write_moves

    plan, bar = dance.moves
    data = moves_data(plan, dance.title, dance.label, dance.section, bar)
    write_moves(path, data if dance.place == (0.0, 0.0) else {**data, "pad_at": [round(x, 6) for x in dance.place]})
    return "the moves"


def _keys(motion: Motion) -> str:
    start, end = _span(motion)
    return f"{len(motion.times)} keys, {end - start:.1f} s"


def _span(motion: Motion) -> tuple[float, float]:
    return float(motion.times[0]), float(motion.times[-1])


FORMATS = {
    ".glb": MotionFormat(_glb),
    ".npz": MotionFormat(_npz),
    ".bvh": MotionFormat(_bvh),
    ".json": MotionFormat(_moves, has_motion=False),
}
