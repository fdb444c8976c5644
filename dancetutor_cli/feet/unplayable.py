"""Notes that nobody can play. The dancer does not play them, and the linter reports them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.play import Play, StepKind
from dancetutor_cli.feet.preset import HAND, LEAP, DropReason

UNPLAYABLE = "unplayable"  # the move name of a row with an unplayed note
SAME_TIME = 1e-6  # seconds
_NOT_WITHOUT = ("hand", "jump", "bracket")  # beginnings of the moves that a row loses with an unplayed note
_BECAUSE = {
    DropReason.LIMBS: "there are more panels at once than limbs",
    DropReason.LEAP: "a foot would have to leap",
    DropReason.HAND: "a hand would have to come down again at once",
}


@dataclass(frozen=True, slots=True)
class DroppedNote:
    """A note that the dancer does not play. second : time in the music; row, column : place in the play"""

    second: float
    row: int
    column: int
    reason: DropReason


def without_unplayable(
    play: Play, pad: Pad, before: Sequence[DroppedNote] = ()
) -> tuple[Play, tuple[DroppedNote, ...]]:
    """Return the play without the notes that nobody can play, and these notes in order of time.

    Notes for which the solver found no limb stay `Limb.UNPLAYED`, and the notes that `too_quick_notes` finds become
    `Limb.UNPLAYED`. A foot without its note stays where it is.

    play : a play whose seconds are those of the audible music; before : known reasons for notes that are already
    unplayed
    """
    found = list(too_quick_notes(play, pad))
    if not found and not (play.limb == Limb.UNPLAYED).any():
        return play, ()
    if found:
        play = _without(play, pad, found)
    rows, columns = np.nonzero(play.limb == Limb.UNPLAYED)
    why = {(one.row, one.column): one.reason for one in before}
    why |= {(row, column): reason for row, column, reason in found}
    return play, tuple(
        DroppedNote(float(play.rows.second[row]), row, column, why.get((row, column), DropReason.LIMBS))
        for row, column in zip(rows.tolist(), columns.tolist(), strict=True)
    )


def too_quick_notes(play: Play, pad: Pad) -> Iterator[tuple[int, int, DropReason]]:
    """Yield the row, the column and the reason of each note that its limb cannot reach in time.

    A foot leaps if it steps within `LEAP` seconds of its last step, and no panel of the one step touches a panel of the
    other. A hand does not play a note within `HAND` seconds of its previous note, whether that note was played or not.
    Virtual taps of a roll do not count, except in rows in which both feet step.
    """
    yield from _leaps(play, pad)
    yield from _hands(play)


def dropped_notes_message(gone: Sequence[DroppedNote]) -> str:
    """Return one line for people about how many notes are not played, and why; "" if all notes are played."""
    if not gone:
        return ""
    counts = Counter(one.reason for one in gone)
    many = f"{len(gone)} note{'s' if len(gone) > 1 else ''} not played"
    if len(counts) == 1:
        return f"{many}, because {_BECAUSE[gone[0].reason]}"
    return f"{many}: {', '.join(f'{counts[why]} because {_BECAUSE[why]}' for why in DropReason if counts[why])}"


def _leaps(play: Play, pad: Pad) -> Iterator[tuple[int, int, DropReason]]:
    """Yield the row, the column and the reason of each note to which its foot would have to leap."""
    touching = pad.neighbours | np.eye(len(pad), dtype=bool)
    for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
        mine: NDArray[np.bool_] = play.limb == side
        rows = np.flatnonzero(mine.any(axis=1))
        last, on = -np.inf, 0
        for row, second in zip(rows.tolist(), play.rows.second[rows].tolist(), strict=True):
            if second - last <= LEAP + SAME_TIME and not touching[np.ix_(mine[on], mine[row])].any():
                yield from ((row, column, DropReason.LEAP) for column in np.flatnonzero(mine[row]).tolist())
            else:
                last, on = second, row


def _hands(play: Play) -> Iterator[tuple[int, int, DropReason]]:
    """Yield the row, the column and the reason of each note for which a hand would have to press again too soon."""
    both = (play.limb == Limb.LEFT_FOOT).any(axis=1) & (play.limb == Limb.RIGHT_FOOT).any(axis=1)
    fresh = (play.rows.steps != StepKind.ROLL_TAP) | both[:, None]
    for side in (Limb.LEFT_HAND, Limb.RIGHT_HAND):
        mine = (play.limb == side) & fresh
        last = -np.inf
        for row in np.flatnonzero(mine.any(axis=1)).tolist():
            second = float(play.rows.second[row])
            if second - last <= HAND + SAME_TIME:
                yield from ((row, column, DropReason.HAND) for column in np.flatnonzero(mine[row]).tolist())
            last = second


def _without(play: Play, pad: Pad, found: Sequence[tuple[int, int, DropReason]]) -> Play:
    """Return the play in which no limb presses these notes, with its feet, its facing and its moves adapted."""
    limb, part, moves = play.limb.copy(), play.part.copy(), list(play.moves)
    for row, column, _ in found:
        limb[row, column], part[row, column] = Limb.UNPLAYED, 0
    for row in {row for row, _, _ in found}:
        kept = moves[row] if (limb[row] >= 0).any() else ()
        moves[row] = tuple(sorted({UNPLAYABLE, *(name for name in kept if not name.startswith(_NOT_WITHOUT))}))
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
    """Compute the facing of the rows from `first` to before `end` again, from the places of the feet; in place."""
    places = []
    for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
        before = np.flatnonzero((play.limb[:end] == side).any(axis=1))
        at = np.searchsorted(before, np.arange(first, end), side="right") - 1
        if not len(before) or at.min() < 0:
            return  # one foot has not stepped yet
        stands = np.array([pad.panels[play.limb[row] == side].mean(axis=0) for row in before[at.min() :]])
        places.append(stands[at - at.min()])
    across = places[1] - places[0]
    apart = np.abs(across).max(axis=1) > 0
    yaw = np.degrees(np.arctan2(across[:, 1], across[:, 0]))
    play.facing[first:end] = np.where(apart, yaw, play.facing[first:end])
