"""The feet that people have set in a chart, and the contradictions in them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations, groupby

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart, Kind
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.pads import load_pad


@dataclass(frozen=True, slots=True)
class Overrides:
    """The limbs that a person has set and the solver keeps: n entries, sorted by (tick, column), each cell once.

    ticks : int64 (n,), 1/48 beats
    columns : int16 (n,)
    limbs : int8 (n,), `feet.limbs.Limb`
    part : uint8 (n,), `feet.limbs.Part`; WHOLE also where the part of the foot is not specified
    """

    ticks: NDArray[np.int64]
    columns: NDArray[np.int16]
    limbs: NDArray[np.int8]
    part: NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.ticks)

    @staticmethod
    def none() -> Overrides:
        """Return an empty set of overrides."""
        return _NONE

    @staticmethod
    def of(cells: dict[tuple[int, int], tuple[int, int]]) -> Overrides:
        """Return the overrides of {(tick, column): (limb, part)}."""
        keys = sorted(cells)
        values = [cells[key] for key in keys]
        return Overrides(
            np.array([tick for tick, _ in keys], dtype=np.int64),
            np.array([column for _, column in keys], dtype=np.int16),
            np.array([limb for limb, _ in values], dtype=np.int8),
            np.array([part for _, part in values], dtype=np.uint8),
        )

    def cells(self) -> dict[tuple[int, int], tuple[int, int]]:
        """Return the overrides as {(tick, column): (limb, part)}."""
        keys = zip(self.ticks.tolist(), self.columns.tolist(), strict=True)
        return dict(zip(keys, zip(self.limbs.tolist(), self.part.tolist(), strict=True), strict=True))


_NONE = Overrides.of({})


@dataclass(frozen=True, slots=True)
class Ignores:
    """The findings that a person has silenced at some rows, by SMEditor's codes or by the linter's rules.

    codes : {tick: the silenced codes: "DS" (doublestep), "FS" (footswitch missed), "AM" (ambiguous)}
    rules : {tick: codes or names of the linter's rules, or beginnings of codes}
    """

    codes: dict[int, frozenset[str]] = field(default_factory=dict)
    rules: Mapping[int, frozenset[str]] = field(default_factory=dict)

    def is_silenced(self, tick: int, code: str) -> bool:
        """Whether findings with this code are silenced in the row at `tick`."""
        return code in self.codes.get(tick, ())

    def silenced_rule(self, tick: int, code: str, name: str) -> bool:
        """Whether findings of a rule of the linter are silenced in the row at `tick`."""
        cells = self.rules.get(tick, ())
        return any(name == one.lower() or code.startswith(one.upper()) or one.lower() == "all" for one in cells)


@dataclass(frozen=True, slots=True)
class FeetProblem:
    """A contradiction in the feet that a person has set; the linter reports it as a finding.

    code : short stable name: "pin-count", "pin-syntax", "pin-far", "pin-twice", "pin-unplayable", "sme-unreadable", ...
    line, column : 1-based place in the chart file (None: the place is in another file, which the message names)
    """

    code: str
    message: str
    line: int | None = None
    column: int | None = None


# Contradictory overrides: one foot on two panels that are far apart, one limb twice in a row, or a step by a foot that
# holds another panel.

_NAMES = {
    Limb.LEFT_FOOT: "the left foot",
    Limb.RIGHT_FOOT: "the right foot",
    Limb.LEFT_HAND: "the left hand",
    Limb.RIGHT_HAND: "the right hand",
}
_Near = NDArray[np.bool_] | None  # (c, c): which panels one foot can press together


@dataclass(frozen=True, slots=True)
class CellOverride:
    """One cell whose limb a person has set. source : its name in messages; line, place : 1-based, None if unknown"""

    tick: int
    column: int
    limb: int
    part: int
    source: str
    line: int | None = None
    place: int | None = None


def split_contradictions(chart: Chart, cells: Iterable[CellOverride]) -> tuple[list[CellOverride], list[FeetProblem]]:
    """Divide the overrides into those that can be danced and the problems of those that cannot.

    A row that contradicts itself is dropped as a whole. Of a step that contradicts a hold of the same foot, only the
    step is dropped.
    """
    ordered = sorted(cells, key=lambda s: (s.tick, s.column))
    if not ordered:
        return [], []
    pad = load_pad(chart.steps_type)
    near = None if pad is None else pad.neighbours
    ends = _hold_ends(chart)
    held: dict[int, tuple[CellOverride, int]] = {}
    good: list[CellOverride] = []
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


def _row_problem(row: Sequence[CellOverride], near: _Near) -> FeetProblem | None:
    for a, b in combinations(row, 2):
        if a.limb != b.limb:
            continue
        name = _NAMES[Limb(a.limb)]
        if _far(a.column, b.column, near):
            return _problem("feet-far", f"{name} cannot be on columns {a.column + 1} and {b.column + 1} at once", b)
        if Part.TOE not in (a.part, b.part) or a.part == b.part:
            return _problem("feet-twice", f"{name} is named twice; write a bracket with its toe, like (Ll)", b)
    return None


def _hold_problem(step: CellOverride, hold: CellOverride, near: _Near) -> FeetProblem | None:
    """Return the problem of a step by a limb that holds another panel; a foot may bracket a neighbouring panel."""
    name = _NAMES[Limb(step.limb)]
    if step.limb in (Limb.LEFT_HAND, Limb.RIGHT_HAND) or _far(step.column, hold.column, near):
        columns = f"column {step.column + 1} while it is on a hold in column {hold.column + 1}"
        return _problem("feet-far", f"{name} cannot step on {columns}", step, _STEP_IGNORED)
    return None


def _far(a: int, b: int, near: _Near) -> bool:
    return near is not None and max(a, b) < len(near) and not near[a, b]


_ROW_IGNORED = "the feet that are set in this row are ignored: correct them"
_STEP_IGNORED = "this foot is ignored: correct it"


def _problem(code: str, what: str, at: CellOverride, outcome: str = _ROW_IGNORED) -> FeetProblem:
    beat = at.tick / TICKS_PER_BEAT
    return FeetProblem(code, f"beat {beat:g}: {what} ({at.source}); {outcome}", at.line, at.place)
