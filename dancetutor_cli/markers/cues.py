"""What a theme can tell a player before it comes: crossovers, brackets and turns, from when and for how long."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.play.played import Limb, Play

CROSSOVER, BRACKET, TURN = "crossover", "bracket", "turn"
KINDS = (CROSSOVER, BRACKET, TURN)
LEAST_TURN = 135.0  # degrees between two rows with steps from which on it is a turn
_NEAR = TICKS_PER_BEAT  # brackets at most a beat apart are one passage
_EPSILON = 1e-6
_FEET = {Limb.LEFT_FOOT: "left", Limb.RIGHT_FOOT: "right"}


@dataclass(frozen=True, slots=True)
class ThemeCue:
    """One passage.

    kind : of `KINDS`; tick, second : of its first row; ticks, seconds : to its end, 0 for a single row
    foot : "left", "right" or "both"; count : rows that do it; way : "front", "back", "full" of a crossover, "left" or
    "right" of a turn, "" of a bracket
    """

    kind: str
    tick: int
    second: float
    ticks: int
    seconds: float
    foot: str
    count: int
    way: str = ""


def cues_of(play: Play) -> tuple[ThemeCue, ...]:
    """All passages of a play, by time. A crossover ends with the row in which the feet are uncrossed."""
    return tuple(sorted((*_crossovers(play), *_brackets(play), *_turns(play)), key=lambda cue: (cue.tick, cue.kind)))


def _crossovers(play: Play) -> Iterator[ThemeCue]:
    crossed = [any(name.startswith("crossover-") for name in moves) for moves in play.moves]
    for first, last in _stretches(crossed):
        moves = {name.removeprefix("crossover-") for row in range(first, last + 1) for name in play.moves[row]}
        way = next((name for name in ("full", "front", "back") if name in moves), "")
        end = min(last + 1, len(play.rows) - 1)
        yield _cue(play, CROSSOVER, (first, end), range(first, last + 1), way=way, who=_who(play, first))


def _brackets(play: Play) -> Iterator[ThemeCue]:
    rows = [row for row, moves in enumerate(play.moves) if "bracket" in moves]
    for passage in _near(rows, play.rows.tick.tolist()):
        feet = {foot for row in passage for foot in _who(play, row, bracketing=True)}
        yield _cue(play, BRACKET, (passage[0], passage[-1]), passage, who=feet)


def _turns(play: Play) -> Iterator[ThemeCue]:
    """Rows to which the body turns far at once, or on past 180 degrees. Before the first row she may stand anyhow."""
    if len(play.rows) < 2:
        return
    steps = np.diff(play.facing)
    around = np.array(["spin" in moves for moves in play.moves])[1:]
    turn = np.where(around, steps, (steps + 180.0) % 360.0 - 180.0)
    for row in (np.flatnonzero(around | (np.abs(turn) >= LEAST_TURN - _EPSILON)) + 1).tolist():
        way = "left" if turn[row - 1] > 0 else "right"
        yield _cue(play, TURN, (row, row), (row,), way=way, who=_who(play, row))


def _cue(
    play: Play, kind: str, span: tuple[int, int], rows: Sequence[int], *, way: str = "", who: set[str]
) -> ThemeCue:
    first, end = span
    ticks, seconds = play.rows.tick, play.rows.second
    foot = who.pop() if len(who) == 1 else "both"
    return ThemeCue(
        kind,
        int(ticks[first]),
        float(seconds[first]),
        int(ticks[end] - ticks[first]),
        float(seconds[end] - seconds[first]),
        foot,
        len(rows),
        way,
    )


def _who(play: Play, row: int, bracketing: bool = False) -> set[str]:
    limbs = [Limb(one) for one in play.limb[row].tolist() if one in _FEET]
    wanted: Callable[[Limb], bool] = (lambda one: limbs.count(one) > 1) if bracketing else (lambda one: True)
    return {_FEET[one] for one in limbs if wanted(one)}


def _stretches(flags: Sequence[bool]) -> Iterator[tuple[int, int]]:
    """First and last row of each run."""
    edges = np.diff(np.array([False, *flags, False]).astype(np.int8))
    yield from zip(np.flatnonzero(edges == 1).tolist(), (np.flatnonzero(edges == -1) - 1).tolist(), strict=True)


def _near(rows: Sequence[int], ticks: Sequence[int]) -> Iterator[list[int]]:
    passage: list[int] = []
    for row in rows:
        if passage and ticks[row] - ticks[passage[-1]] > _NEAR:
            yield passage
            passage = []
        passage.append(row)
    if passage:
        yield passage
