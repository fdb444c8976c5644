"""Technical steps of a chart, counted as ITGmania counts them, so that the numbers can be laid beside the game's.

The game looks at rows with steps, each with the row before it. A footswitch is a panel pressed by another foot than in
the row before, within 0.3 s; a jack the same foot on the same panel (0.176 s) and a doublestep on another (0.235 s),
both rows single. A crossover is one step after which the foot stands on the wrong side of the other, which stepped in
the row before: full where that foot came from its own side, half where it came from the middle. So a crossed passage of
five rows is one crossover or two, not five.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.jobs.result import TECH_COUNTS
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.play.model import Limb, Part, StepKind

_JACK, _DOUBLESTEP, _FOOTSWITCH = 176, 235, 300  # milliseconds between two rows, the game's own limits
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class _Steps:
    """Rows with steps that a foot presses, n; columns c. -1: none.

    row : of the play; gap : (n - 1,) milliseconds from one to the next, free of float noise; count : steps in the row
    foot : (n, c) 0 left, 1 right; heel, toe : (n, 2) column that a foot presses
    x : (n, 2) place of the foot, NaN without; of a bracket between its panels; heel_x : that of the heel
    """

    row: NDArray[np.int64]
    gap: NDArray[np.int64]
    count: NDArray[np.int64]
    foot: NDArray[np.int8]
    heel: NDArray[np.int64]
    toe: NDArray[np.int64]
    x: NDArray[np.float64]
    heel_x: NDArray[np.float64]


def tech_counts(subject: ChartSubject) -> dict[str, int]:
    """How often each of `TECH_COUNTS` happens; all 0 for a chart without a play."""
    found = dict.fromkeys(TECH_COUNTS, 0)
    if subject.play is None or subject.pad is None:
        return found
    steps = _steps_of(subject)
    if len(steps.row):
        found |= _switches(steps, subject.pad.arrows) | _repeats(steps, subject) | _crossovers(steps)
        found["Brackets"] = int(((steps.heel >= 0) & (steps.toe >= 0)).sum())
    return found


def _steps_of(subject: ChartSubject) -> _Steps:
    play, pad = subject.play, subject.pad
    assert play is not None and pad is not None
    written = (play.rows.steps != StepKind.NONE) & (play.rows.steps != StepKind.ROLL_TAP)
    row = np.flatnonzero(written.any(axis=1))
    written = written[row]
    limb = np.where(written, play.limb[row], -1)
    foot = np.where(limb <= Limb.RIGHT_FOOT, limb, -1).astype(np.int8)
    toe = play.part[row] == Part.TOE
    heels = np.stack([_first((foot == f) & ~toe) for f in (0, 1)], axis=1)
    toes = np.stack([_first((foot == f) & toe) for f in (0, 1)], axis=1)
    places = np.append(pad.panels[:, 0], np.nan)  # column -1: no place
    x = np.where(toes >= 0, (places[heels] + places[toes]) / 2, places[heels])
    return _Steps(
        row, np.diff(np.cumsum(play.rows.milliseconds)[row]), written.sum(axis=1), foot, heels, toes, x, places[heels]
    )


def _first(flags: Flags) -> NDArray[np.int64]:
    """The first column with a flag in each row, or -1."""
    return np.where(flags.any(axis=1), flags.argmax(axis=1), -1)


def _switches(steps: _Steps, arrows: NDArray[np.float64]) -> dict[str, int]:
    """Panels taken over, by where their arrows point."""
    soon = steps.gap < _FOOTSWITCH
    now, before = steps.foot[1:], steps.foot[:-1]
    per_panel = ((now >= 0) & (before >= 0) & (now != before) & soon[:, None]).sum(axis=0)
    across, along = arrows[: len(per_panel)].T
    up, down = int(per_panel[along > 0].sum()), int(per_panel[along < 0].sum())
    left, right = (int(per_panel[(along == 0) & side].sum()) for side in (across < 0, across > 0))
    middle = int(per_panel[(along == 0) & (across == 0)].sum())
    return {
        "Footswitches": up + down + middle, "UpFootswitches": up, "DownFootswitches": down,
        "Sideswitches": left + right, "LeftSideswitches": left, "RightSideswitches": right,
    }  # fmt: skip


def _repeats(steps: _Steps, subject: ChartSubject) -> dict[str, int]:
    """The same foot in two single rows one after the other: on its panel, or on another."""
    assert subject.play is not None
    gap = steps.gap[:, None]
    now, before = steps.heel[1:], steps.heel[:-1]
    again = (now >= 0) & (before >= 0) & ((steps.count[1:] == 1) & (steps.count[:-1] == 1))[:, None]
    moved = (again & (now != before) & (gap < _DOUBLESTEP)).any(axis=1)
    forced = sum("forced-doublestep" in subject.play.moves[row] for row in steps.row[1:][moved].tolist())
    return {
        "Jacks": int((again & (now == before) & (gap < _JACK)).sum()),
        "Doublesteps": int(moved.sum()),
        "ForcedDoublesteps": forced,
        "UnforcedDoublesteps": int(moved.sum()) - forced,
    }


def _crossovers(steps: _Steps) -> dict[str, int]:
    """Steps of one foot to the wrong side of the other, which stepped in the row before; half or full."""
    half = full = 0
    for foot, outward in ((0, -1.0), (1, 1.0)):
        x, other = steps.x[:, foot] * outward, steps.x[:, 1 - foot] * outward
        stepped, others = steps.heel[:, foot], steps.heel[:, 1 - foot]
        crossed = (stepped[1:] >= 0) & (stepped[:-1] < 0) & (others[:-1] >= 0) & (x[1:] < other[:-1])
        at = np.flatnonzero(crossed) + 1
        earlier = np.where(at > 1, stepped[at - 2], -1)
        moved = (at == 1) | ((earlier >= 0) & (earlier != stepped[at]))
        outside = (at > 1) & (earlier >= 0) & (steps.heel_x[at - 2, foot] * outward > other[at - 1])
        full += int((moved & outside).sum())
        half += int((moved & ~outside).sum())
    return {"Crossovers": half + full, "HalfCrossovers": half, "FullCrossovers": full}
