"""What nobody can dance: one foot on two far panels, one limb twice in a row, a foot that is needed in two places."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations, groupby

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Chart, Kind
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.overrides import FeetProblem

_NAMES = {
    Limb.LEFT_FOOT: "the left foot",
    Limb.RIGHT_FOOT: "the right foot",
    Limb.LEFT_HAND: "the left hand",
    Limb.RIGHT_HAND: "the right hand",
}
_Near = NDArray[np.bool_] | None  # (c, c): which panels one foot can press together


@dataclass(frozen=True, slots=True)
class Said:
    """One cell that a person has given a limb. source : for messages; line, place : where, 1-based, None if unknown."""

    tick: int
    column: int
    limb: int
    part: int
    source: str
    line: int | None = None
    place: int | None = None


def contradictions(chart: Chart, said: Iterable[Said]) -> tuple[list[Said], list[FeetProblem]]:
    """Split what was said into what can be danced and what contradicts itself.

    A row that contradicts itself is dropped as a whole; a step that contradicts a hold which its foot is said to keep
    pressing is dropped alone.
    """
    from dancetutor_cli.pads import load_pad

    ordered = sorted(said, key=lambda s: (s.tick, s.column))
    if not ordered:
        return [], []
    pad = load_pad(chart.steps_type)
    near = None if pad is None else pad.neighbours
    ends = _hold_ends(chart)
    held: dict[int, tuple[Said, int]] = {}
    good: list[Said] = []
    problems: list[FeetProblem] = []
    for tick, group in groupby(ordered, key=lambda s: s.tick):
        row = list(group)
        held = {limb: (s, end) for limb, (s, end) in held.items() if end > tick}
        if wrong := _row_problem(row, near):
            problems.append(wrong)
            continue
        for s in row:
            if s.limb in held and (wrong := _hold_problem(s, held[s.limb][0], near)):
                problems.append(wrong)
                continue
            good.append(s)
            if (end := ends.get((s.tick, s.column))) is not None:
                held[s.limb] = (s, end)
    return good, problems


def _hold_ends(chart: Chart) -> dict[tuple[int, int], int]:
    notes = chart.notes
    at = (notes.kind == Kind.HOLD).nonzero()[0]
    places = zip(notes.tick[at].tolist(), notes.column[at].tolist(), strict=True)
    return dict(zip(places, notes.end[at].tolist(), strict=True))


def _row_problem(row: Sequence[Said], near: _Near) -> FeetProblem | None:
    for a, b in combinations(row, 2):
        if a.limb != b.limb:
            continue
        name = _NAMES[Limb(a.limb)]
        if _far(a.column, b.column, near):
            return _problem("feet-far", f"{name} cannot be on columns {a.column} and {b.column} at once", b)
        if Part.TOE not in (a.part, b.part) or a.part == b.part:
            return _problem("feet-twice", f"{name} is named twice; write a bracket with its toe, like (Ll)", b)
    return None


def _hold_problem(step: Said, hold: Said, near: _Near) -> FeetProblem | None:
    """A step by a limb that holds another panel; a foot may reach a panel that is near with its other part."""
    name = _NAMES[Limb(step.limb)]
    if step.limb in (Limb.LEFT_HAND, Limb.RIGHT_HAND) or _far(step.column, hold.column, near):
        return _problem("feet-far", f"{name} cannot step on column {step.column} while it holds {hold.column}", step)
    return None


def _far(a: int, b: int, near: _Near) -> bool:
    return near is not None and max(a, b) < len(near) and not near[a, b]


def _problem(code: str, what: str, at: Said) -> FeetProblem:
    beat = at.tick / TICKS_PER_BEAT
    return FeetProblem(code, f"beat {beat:g}: {what} ({at.source}); not used", at.line, at.place)
