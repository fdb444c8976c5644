"""What is neither danced nor shown: what comes before the step that a film counts to, and what follows a passage."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.play.played import Play
from dancetutor_cli.video.clock import Pass
from dancetutor_cli.video.notes import NoteTrack

SETTLED = 0.7  # seconds of the film before it begins from which on she makes no step: she stands when it does


class Quiet(NamedTuple):
    """Seconds of the music in which nobody steps: from `since` on, before `until`."""

    since: float
    until: float

    def has(self, second: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which of these seconds are among them."""
        return np.asarray((second >= self.since) & (second < self.until - 1e-6))


def quiet_in(passes: Sequence[Pass]) -> Quiet | None:
    """While the runs of a film are counted in, which all begin at the same second; None without a count-in."""
    one = passes[0]
    return Quiet(one.start - SETTLED * max(p.rate for p in passes), one.sound_from) if one.count else None


def quiet_after(passes: Sequence[Pass]) -> Quiet | None:
    """From the end of a passage on, after which she comes to rest; None if the film ends with it."""
    return Quiet(passes[-1].until, math.inf) if passes[-1].rest else None


def play_without(play: Play, quiet: Quiet | None) -> Play:
    """The play without the rows of that time; where no row is left, as it is."""
    if quiet is None:
        return play
    keep = ~quiet.has(play.rows.second)
    if keep.all() or not (play.limb[keep] >= 0).any():
        return play
    rows = replace(play.rows, **_chosen(play.rows, keep))
    moves = tuple(names for names, kept in zip(play.moves, keep.tolist(), strict=True) if kept)
    return replace(play, rows=rows, moves=moves, **_chosen(play, keep))


def notes_without(track: NoteTrack, quiet: Quiet | None) -> NoteTrack:
    """The notes without those of that time."""
    return track if quiet is None else replace(track, **_chosen(track, ~quiet.has(track.second)))


def _chosen(arrays: Any, keep: NDArray[np.bool_]) -> dict[str, Any]:
    """Of each array of a dataclass the entries to keep."""
    found = {field.name: getattr(arrays, field.name) for field in fields(arrays)}
    return {name: value[keep] for name, value in found.items() if isinstance(value, np.ndarray)}
