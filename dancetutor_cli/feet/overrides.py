"""What people said about the feet of a chart: limbs they force, findings they do not want, and what was wrong in it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Overrides:
    """Limbs that a person has laid down, for the solver to keep; n entries, sorted by (tick, column), each cell once.

    ticks : int64 (n,), 1/48 beats
    columns : int16 (n,)
    limbs : int8 (n,), `feet.limbs.Limb`
    part : uint8 (n,), `feet.limbs.Part`; WHOLE also where nobody said which part of the foot
    """

    ticks: NDArray[np.int64]
    columns: NDArray[np.int16]
    limbs: NDArray[np.int8]
    part: NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.ticks)

    @staticmethod
    def none() -> Overrides:
        """No override at all."""
        return _NONE

    @staticmethod
    def of(cells: dict[tuple[int, int], tuple[int, int]]) -> Overrides:
        """From {(tick, column): (limb, part)}."""
        keys = sorted(cells)
        values = [cells[key] for key in keys]
        return Overrides(
            np.array([tick for tick, _ in keys], dtype=np.int64),
            np.array([column for _, column in keys], dtype=np.int16),
            np.array([limb for limb, _ in values], dtype=np.int8),
            np.array([part for _, part in values], dtype=np.uint8),
        )

    def cells(self) -> dict[tuple[int, int], tuple[int, int]]:
        """As {(tick, column): (limb, part)}."""
        keys = zip(self.ticks.tolist(), self.columns.tolist(), strict=True)
        return dict(zip(keys, zip(self.limbs.tolist(), self.part.tolist(), strict=True), strict=True))


_NONE = Overrides.of({})


@dataclass(frozen=True, slots=True)
class Ignores:
    """Findings that a person does not want to see at some rows, in SMEditor's words or by rule.

    codes : {tick: of "DS" (doublestep), "FS" (footswitch missed), "AM" (ambiguous) those that are silenced there}
    rules : {tick: codes or names of the linter's rules, or beginnings of codes}
    """

    codes: dict[int, frozenset[str]] = field(default_factory=dict)
    rules: Mapping[int, frozenset[str]] = field(default_factory=dict)

    def silenced(self, tick: int, code: str) -> bool:
        """Whether findings of this kind in the row at `tick` are not wanted."""
        return code in self.codes.get(tick, ())

    def silenced_rule(self, tick: int, code: str, name: str) -> bool:
        """Whether findings of a rule of the linter are not wanted in the row at `tick`."""
        said = self.rules.get(tick, ())
        return any(name == one.lower() or code.startswith(one.upper()) or one.lower() == "all" for one in said)


@dataclass(frozen=True, slots=True)
class FeetProblem:
    """A contradiction in what a person said; the linter makes a finding of it.

    code : short stable name: "pin-count", "pin-syntax", "pin-far", "pin-twice", "pin-unplayable", "sme-unreadable", ...
    line, column : 1-based place in the chart file (None: another file, named in the message)
    """

    code: str
    message: str
    line: int | None = None
    column: int | None = None
