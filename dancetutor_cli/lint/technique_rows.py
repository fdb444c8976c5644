"""Technical steps of several plays, counted as ITGmania counts them, so that the numbers can be compared."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import Part
from dancetutor_cli.lint.plays import ALL_KINDS, Plays

# The game compares each row that has steps with the row before it, so the first row counts as nothing. A footswitch is
# a panel that the other foot pressed in the row before, within 0.3 s. A jack is the same foot on the same panel within
# 0.176 s; a doublestep is the same foot on another panel within 0.235 s. For both, each row has a single step. A
# crossover is one step to the wrong side of the other foot, which stepped in the row before. It is full if the crossing
# foot came from its own side, half if it came from the middle. So a crossed passage of five rows is one crossover or
# two, not five.

_JACK, _DOUBLESTEP, _FOOTSWITCH = 176_000, 235_000, 300_000  # microseconds between two rows, the game's own limits
_NEVER = 10**15
_TOE = int(Part.TOE)
TechniqueRows = dict[str, NDArray[np.int64]]


@dataclass(frozen=True)
class _Steps:
    """The n rows of the plays with steps, for c columns; -1 means no column.

    row : row of the plays; place : (n,) index of the row among the rows with steps of its play
    gap : (n - 1,) whole microseconds to the next row of the same play; count : number of steps in the row
    heel, toe : for each foot, (n,) the column that it presses
    x : for each foot, (n,) its position, between the panels of a bracket, NaN if it does not step; heel_x : of the heel
    cell : the steps of feet in order, as row * c + column; foot : the foot that presses each cell
    """

    row: NDArray[np.int64]
    place: NDArray[np.int64]
    gap: NDArray[np.int64]
    count: NDArray[np.int64]
    heel: list[NDArray[np.int64]]
    toe: list[NDArray[np.int64]]
    x: list[NDArray[np.float64]]
    heel_x: list[NDArray[np.float64]]
    cell: NDArray[np.int64]
    foot: NDArray[np.int8]


def technique_rows(plays: Plays) -> TechniqueRows:
    """Return the rows of the plays that count as each of `TECH_COUNTS`, one row for each occurrence, not in order."""
    steps = _steps_of(plays)
    inner = np.flatnonzero(steps.place > 0)
    both = [steps.row[inner[(steps.heel[foot][inner] >= 0) & (steps.toe[foot][inner] >= 0)]] for foot in (0, 1)]
    return {
        **_switches(steps, plays),
        **_repeats(steps, plays),
        **_crossovers(steps),
        "Brackets": np.concatenate(both),
    }


def _steps_of(plays: Plays) -> _Steps:
    cell = np.flatnonzero(ALL_KINDS[plays.steps.ravel()])
    at, column = np.divmod(cell, len(plays.pad))
    first = np.ones(len(at), dtype=bool)
    first[1:] = at[1:] != at[:-1]
    row, number = at[first], np.cumsum(first) - 1
    limb, toe = plays.limb.ravel()[cell], plays.part.ravel()[cell] == _TOE
    brackets = bool(toe.any())
    places = np.append(plays.pad.panels[:, 0], np.nan)  # column -1: no place
    heels, toes, x, heel_x = [], [], [], []
    for foot in (0, 1):
        mine = limb == foot
        heels.append(_first(number, column, mine & ~toe if brackets else mine, len(row)))
        heel_x.append(places[heels[foot]])
        if brackets:
            toes.append(_first(number, column, mine & toe, len(row)))
            x.append(np.where(toes[foot] >= 0, (heel_x[foot] + places[toes[foot]]) / 2, heel_x[foot]))
        else:
            toes.append(np.full(len(row), -1, dtype=np.int64))
            x.append(heel_x[foot])
    of_play = plays.number[row]
    gap = np.rint((plays.second[row[1:]] - plays.second[row[:-1]]) * 1e6).astype(np.int64)
    gap[of_play[1:] != of_play[:-1]] = _NEVER
    place = np.arange(len(row)) - of_play.searchsorted(of_play)
    feet = (limb == 0) | (limb == 1)
    return _Steps(
        row, place, gap, np.bincount(number, minlength=len(row)), heels, toes, x, heel_x,
        (number * len(plays.pad) + column)[feet], limb[feet],
    )  # fmt: skip


def _first(
    number: NDArray[np.int64], column: NDArray[np.int64], which: NDArray[np.bool_], rows: int
) -> NDArray[np.int64]:
    """Return the column of the first step in each row, of the steps that `which` marks; -1 for a row without one."""
    found = np.full(rows, -1, dtype=np.int64)
    steps = np.flatnonzero(which)[::-1]
    found[number[steps]] = column[steps]  # in reverse order, so that the first column overwrites the others
    return found


def _switches(steps: _Steps, plays: Plays) -> TechniqueRows:
    """Return the rows of footswitches and sideswitches, by the direction of the panel's arrow."""
    c, pad = len(plays.pad), plays.pad
    before = np.full((len(steps.row) + 1) * c, -1, dtype=np.int8)
    before[steps.cell + c] = steps.foot
    before = before[steps.cell]
    other = np.flatnonzero((before >= 0) & (before != steps.foot))
    number, column = np.divmod(steps.cell[other], c)
    near = steps.gap[number - 1] < _FOOTSWITCH
    row, column = steps.row[number[near]], column[near]
    across, along = pad.arrows.T
    up, down = row[along[column] > 0], row[along[column] < 0]
    left, right = (row[(along[column] == 0) & side[column]] for side in (across < 0, across > 0))
    middle = row[(along[column] == 0) & (across[column] == 0)]
    return {
        "Footswitches": np.concatenate([up, down, middle]), "UpFootswitches": up, "DownFootswitches": down,
        "Sideswitches": np.concatenate([left, right]), "LeftSideswitches": left, "RightSideswitches": right,
    }  # fmt: skip


def _repeats(steps: _Steps, plays: Plays) -> TechniqueRows:
    """Return the rows of jacks and doublesteps: the same foot steps in two single rows, one after the other."""
    single = steps.count == 1
    near = single[1:] & single[:-1] & (steps.gap < _DOUBLESTEP)
    jacks, doublesteps = [], []
    for heel in steps.heel:
        now, before = heel[1:], heel[:-1]
        again = near & (now >= 0) & (before >= 0)
        same = now == before
        jacks.append(steps.row[1:][again & same & (steps.gap < _JACK)])
        doublesteps.append(steps.row[1:][again & ~same])
    stepped = np.concatenate(doublesteps)
    forced = np.isin(stepped, plays.rows_with("forced-doublestep"))
    return {
        "Jacks": np.concatenate(jacks),
        "Doublesteps": stepped,
        "ForcedDoublesteps": stepped[forced],
        "UnforcedDoublesteps": stepped[~forced],
    }


def _crossovers(steps: _Steps) -> TechniqueRows:
    """Return the rows of half and full crossovers: one foot steps to the wrong side of the foot that stepped before."""
    half, full = [], []
    for foot, outward in ((0, -1.0), (1, 1.0)):
        x, other = steps.x[foot], steps.x[1 - foot]
        stepped, others = steps.heel[foot], steps.heel[1 - foot]
        beyond = x[1:] > other[:-1] if foot == 0 else x[1:] < other[:-1]
        follows = (steps.place[1:] > 0) & (stepped[1:] >= 0) & (stepped[:-1] < 0) & (others[:-1] >= 0)
        at = np.flatnonzero(follows & beyond) + 1
        third = steps.place[at] > 1
        earlier = np.where(third, stepped[at - 2], -1)
        moved = ~third | ((earlier >= 0) & (earlier != stepped[at]))
        came_from = steps.heel_x[foot][at - 2] * outward
        outside = third & (earlier >= 0) & (came_from > other[at - 1] * outward)
        full.append(steps.row[at[moved & outside]])
        half.append(steps.row[at[moved & ~outside]])
    halves, fulls = np.concatenate(half), np.concatenate(full)
    return {"Crossovers": np.concatenate([halves, fulls]), "HalfCrossovers": halves, "FullCrossovers": fulls}
