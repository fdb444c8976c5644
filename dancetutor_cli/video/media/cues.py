"""What the subtitles of a film name: the moves of a play with the foot that does them, from begin to end."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.play.played import Limb
from dancetutor_cli.play.turned import HALF_TURNS, moves_and_turns
from dancetutor_cli.video.move_words import HOLD, SAID_BY_A_BRACKET, WHO, filled
from dancetutor_cli.video.notes import Cue

if TYPE_CHECKING:
    from dancetutor_cli.chart.timing import Timing
    from dancetutor_cli.pads import Pad
    from dancetutor_cli.play.played import Play

_CROSSED = ("crossover-half", "crossover-full")
_WAYS = ("crossover-front", "crossover-back")  # say more than crossover-half, which they come with
_RUNS = ("stream", "drill")


def cues_of(play: Play, timing: Timing, words: Mapping[str, str], pad: Pad, turned: bool = False) -> tuple[Cue, ...]:
    """Every move that has a word, sorted by time.

    words : name of a move (`play.vocabulary.EVENTS`), or "hold" -> what it is called; moves that are not in it are not.
    turned : she faces who looks on, and panels are named as they are seen then.
    Crossed feet are told once, where they cross, until they are back, unless a half turn there is told; a stream or
    drill once, where it begins.
    """
    found = [*_crossovers(play, words), *_moments(play, words, pad, turned), *_holds(play, timing, words)]
    for name in _RUNS:
        if name in words:
            found += (
                Cue(float(play.rows.second[first]), float(play.rows.second[last]), words[name], (), name)
                for first, last in _stretches(play, (name,))
            )
    return tuple(sorted(found, key=lambda cue: (cue.second, cue.text)))


def _crossovers(play: Play, words: Mapping[str, str]) -> Iterator[Cue]:
    """Until the row in which the feet are uncrossed; one that turns full on its way is told again."""
    second, last_row = play.rows.second, len(play.rows) - 1
    turns = moves_and_turns(play)
    for first, last in _stretches(play, _CROSSED):
        end = float(second[min(last + 1, last_row)])
        before: set[str] = set()
        for row in range(first, last + 1):
            full = {"crossover-full"} & set(play.moves[row])
            now = full or {"crossover-half"}
            if new := now - before:
                way = [name for name in _WAYS if name in play.moves[row] and name in words and not full]
                name = way[0] if way else new.pop()
                if (word := words.get(name)) and not {*HALF_TURNS}.intersection(turns[row]):
                    yield Cue(float(second[row]), end, word, _who(play, row), name)
            before |= {*now, "crossover-half"}


def _moments(play: Play, words: Mapping[str, str], pad: Pad, turned: bool) -> Iterator[Cue]:
    """Moves of one row, each time they come."""
    named = set(words) - {*_CROSSED, *_WAYS, *_RUNS, HOLD}
    for row, names in enumerate(moves_and_turns(play)):
        for name in named.intersection(names) - (SAID_BY_A_BRACKET if "bracket" in names else set()):
            second = float(play.rows.second[row])
            who = () if "{" in words[name] else _who(play, row)
            for said in filled(words[name], name, (play, row), pad, turned):
                yield Cue(second, second, said, who, name)


def _holds(play: Play, timing: Timing, words: Mapping[str, str]) -> Iterator[Cue]:
    if HOLD not in words:
        return
    row, column = np.nonzero(play.rows.hold_end >= 0)
    ends = timing.seconds(play.rows.hold_end[row, column])
    for r, c, end in zip(row.tolist(), column.tolist(), ends.tolist(), strict=True):
        limb = int(play.limb[r, c])
        who = (WHO[limb],) if 0 <= limb < len(WHO) else ()
        yield Cue(float(play.rows.second[r]), end, words[HOLD], who, HOLD)


def _who(play: Play, row: int) -> tuple[str, ...]:
    """Who does a move of a row: everybody who steps in it, but of both feet it is no foot's move."""
    limbs = {limb for limb in play.limb[row].tolist() if 0 <= limb < len(WHO)}
    return () if {Limb.LEFT_FOOT, Limb.RIGHT_FOOT} <= limbs else tuple(WHO[limb] for limb in sorted(limbs))


def _stretches(play: Play, names: tuple[str, ...]) -> list[tuple[int, int]]:
    """First and last row of each run of rows that have one of these names."""
    inside = np.array([False, *(any(name in moves for name in names) for moves in play.moves), False])
    edges = np.diff(inside.astype(np.int8))
    return list(zip(np.flatnonzero(edges == 1).tolist(), (np.flatnonzero(edges == -1) - 1).tolist(), strict=True))
