"""Notes that no person plays: which ones, and why. The dancer lets them go, and the linter tells of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.play.played import Limb, Play, StepKind
from dancetutor_cli.play.unplayable import HAND, LEAP, Why

if TYPE_CHECKING:
    from dancetutor_cli.pads import Pad

MOVE = "unplayable"  # what a row with such a note is called, as where the solver has no limb left
SAME_TIME = 1e-6  # seconds
_NOT_WITHOUT = ("hand", "jump", "bracket")  # moves that a row has no more if what makes them is let go begin so


WORDS = {
    Why.LIMBS: "more panels at once than limbs",
    Why.LEAP: "a foot would have to leap at once",
    Why.HAND: "a hand would have to be down again at once",
}


@dataclass(frozen=True, slots=True)
class LetGo:
    """A note that she does not play. second : of the music; row, column : of the play"""

    second: float
    row: int
    column: int
    why: Why


def without_unplayable(play: Play, pad: Pad, before: Sequence[LetGo] = ()) -> tuple[Play, tuple[LetGo, ...]]:
    """The play in which no limb has those notes that no person plays, and these notes in order of time.

    What is left over by the solver stays `Limb.UNPLAYED`, and what `too_quick` finds becomes so: the foot stays where
    it is, the hand is up, and feet go on alone.

    play : its seconds are those of the music as it is heard; before : why notes are left over in it already
    """
    found = list(too_quick(play, pad))
    if not found and not (play.limb == Limb.UNPLAYED).any():
        return play, ()
    if found:
        play = _without(play, pad, found)
    rows, columns = np.nonzero(play.limb == Limb.UNPLAYED)
    why = {(one.row, one.column): one.why for one in before}
    why |= {(row, column): reason for row, column, reason in found}
    return play, tuple(
        LetGo(float(play.rows.second[row]), row, column, why.get((row, column), Why.LIMBS))
        for row, column in zip(rows.tolist(), columns.tolist(), strict=True)
    )


def too_quick(play: Play, pad: Pad) -> Iterator[tuple[int, int, Why]]:
    """Row and column of each note that has a limb, but one which cannot be there in time, and why.

    A foot leaps if it steps within `LEAP` seconds of its last step, to no panel that touches one of that. A hand is let
    go if it comes down within `HAND` seconds of the last note for it, played or not: of many the first is played. One
    that stays there drums a roll, if she stands on a foot.
    """
    yield from _leaps(play, pad)
    yield from _hands(play)


def told(gone: Sequence[LetGo]) -> str:
    """How many notes are let go and why, in one line for people; nothing if none is."""
    if not gone:
        return ""
    counts = Counter(one.why for one in gone)
    reasons = ", ".join(f"{counts[why]} {WORDS[why]}" for why in Why if counts[why])
    return f"{len(gone)} note{'s' if len(gone) > 1 else ''} let go, for nobody plays them: {reasons}"


def _leaps(play: Play, pad: Pad) -> Iterator[tuple[int, int, Why]]:
    """Row and column of each note that its foot would have to leap to."""
    touching = pad.neighbours | np.eye(len(pad), dtype=bool)
    for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
        mine: NDArray[np.bool_] = play.limb == side
        rows = np.flatnonzero(mine.any(axis=1))
        last, on = -np.inf, 0
        for row, second in zip(rows.tolist(), play.rows.second[rows].tolist(), strict=True):
            if second - last <= LEAP + SAME_TIME and not touching[np.ix_(mine[on], mine[row])].any():
                yield from ((row, column, Why.LEAP) for column in np.flatnonzero(mine[row]).tolist())
            else:
                last, on = second, row


def _hands(play: Play) -> Iterator[tuple[int, int, Why]]:
    """Row and column of each note for which a hand would have to hop."""
    both = (play.limb == Limb.LEFT_FOOT).any(axis=1) & (play.limb == Limb.RIGHT_FOOT).any(axis=1)
    fresh = (play.rows.steps != StepKind.ROLL_TAP) | both[:, None]
    for side in (Limb.LEFT_HAND, Limb.RIGHT_HAND):
        mine = (play.limb == side) & fresh
        last = -np.inf
        for row in np.flatnonzero(mine.any(axis=1)).tolist():
            second = float(play.rows.second[row])
            if second - last <= HAND + SAME_TIME:
                yield from ((row, column, Why.HAND) for column in np.flatnonzero(mine[row]).tolist())
            last = second


def _without(play: Play, pad: Pad, found: Sequence[tuple[int, int, Why]]) -> Play:
    """The play in which no limb has these notes; feet, facing and the names of moves are what is left then."""
    limb, part, moves = play.limb.copy(), play.part.copy(), list(play.moves)
    for row, column, _ in found:
        limb[row, column], part[row, column] = Limb.UNPLAYED, 0
    for row in {row for row, _, _ in found}:
        kept = moves[row] if (limb[row] >= 0).any() else ()
        moves[row] = tuple(sorted({MOVE, *(name for name in kept if not name.startswith(_NOT_WITHOUT))}))
    out = replace(
        play, limb=limb, part=part, moves=tuple(moves), events=None, feet=play.feet.copy(), facing=play.facing.copy()
    )
    for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
        stepped = (limb == side).any(axis=1)
        lost = ((play.limb == side).any(axis=1)) & ~stepped
        for row in np.flatnonzero(lost).tolist():
            later = np.flatnonzero(stepped[row:])
            until = row + int(later[0]) if len(later) else len(stepped)
            out.feet[row:until, side] = out.feet[row - 1, side] if row else -1
            _face_anew(out, pad, row, until)
    return out


def _face_anew(play: Play, pad: Pad, first: int, end: int) -> None:
    """Turn rows from `first` to before `end` with both feet as they stand there, in place."""
    places = []
    for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
        before = np.flatnonzero((play.limb[:end] == side).any(axis=1))
        at = np.searchsorted(before, np.arange(first, end), side="right") - 1
        if not len(before) or at.min() < 0:
            return  # one is still where she began
        stands = np.array([pad.panels[play.limb[row] == side].mean(axis=0) for row in before[at.min() :]])
        places.append(stands[at - at.min()])
    across = places[1] - places[0]
    apart = np.abs(across).max(axis=1) > 0
    yaw = np.degrees(np.arctan2(across[:, 1], across[:, 0]))
    play.facing[first:end] = np.where(apart, yaw, play.facing[first:end])
