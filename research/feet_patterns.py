"""Pattern charts, by seed, whose feet follow from rules that players share: labels besides those that people wrote.

Steps alternate. After a jump, the foot that keeps the run uncrossed begins. While a foot holds, the other one steps,
also in the very moment in which the hold ends. A foot whose hold has just ended waits for the other one. If these rules
allow two ways, there is no pattern.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from feet_data import Labelled
from numpy.typing import NDArray

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.pads import Pad, load_pad
from dancetutor_cli.feet.play import Rows, StepKind

Floats = NDArray[np.float64]
BPM = 170.0  # 48, 24 and 16 ticks are 353, 176 and 118 ms
_LEFT, _DOWN, _UP, _RIGHT = range(4)
_JUMPS = ((_LEFT, _RIGHT), (_LEFT, _DOWN), (_LEFT, _UP), (_DOWN, _RIGHT), (_UP, _RIGHT))
_BRACKETED = 24  # ticks: so close to other rows two neighbouring panels may as well be one foot's


class _NoPatternError(Exception):
    """No rule, or more than one, decides which foot steps."""


@dataclass
class Draft:
    """A chart in the making. feet : foot by panel for each row; where : the panel of each foot; last : foot, or -1"""

    gap: int
    feet: list[dict[int, int]] = field(default_factory=list)
    ends: dict[tuple[int, int], float] = field(default_factory=dict)
    where: list[int] = field(default_factory=lambda: [_LEFT, _RIGHT])
    last: int = -1

    def step(self, foot: int, panel: int) -> None:
        """One foot steps."""
        self.feet.append({panel: foot})
        self.where[foot], self.last = panel, foot

    def jump(self, rng: np.random.Generator) -> None:
        """Both feet step, on some panels."""
        self.land(*_JUMPS[int(rng.integers(1 if self.gap <= _BRACKETED else len(_JUMPS)))])

    def land(self, left: int, right: int) -> None:
        """Both feet step, on these panels."""
        self.feet.append({left: 0, right: 1})
        self.where, self.last = [left, right], -1

    def rows(self, pad: Pad) -> Rows:
        """The rows at `BPM`, a `gap` apart."""
        n, c = len(self.feet), len(pad)
        steps, ends = np.zeros((n, c), dtype=np.uint8), np.full((n, c), -1, dtype=np.int64)
        for row, feet in enumerate(self.feet):
            for panel in feet:
                steps[row, panel] = StepKind.HOLD if (row, panel) in self.ends else StepKind.TAP
        for (row, panel), length in self.ends.items():
            ends[row, panel] = round((row + length) * self.gap)
        tick = np.arange(n, dtype=np.int64) * self.gap
        second = tick / TICKS_PER_BEAT * 60.0 / BPM
        ms = np.zeros(n, dtype=np.int64)
        ms[1:] = np.floor(np.diff(second) * 1000.0 + 0.5)
        line = np.arange(1, n + 1, dtype=np.int32)
        return Rows(tick, second, line, steps, ends, np.zeros((n, c), dtype=bool), ms)


def _crossed(x: Floats, where: Sequence[int]) -> bool:
    """Whether the right foot is further to the left than the left one."""
    return bool(x[where[1]] < x[where[0]] - 1e-6)


def _run(draft: Draft, x: Floats, rng: np.random.Generator, first: int, count: int) -> None:
    """So many steps by turns, uncrossed, each on a panel on which no foot stands."""
    foot = first
    for _ in range(count):
        ways = [p for p in range(len(x)) if p not in draft.where]
        ways = [p for p in ways if not _crossed(x, [p if f == foot else draft.where[f] for f in range(2)])]
        if not ways:
            raise _NoPatternError
        draft.step(foot, int(rng.choice(ways)))
        foot = 1 - foot


def _goes_on(draft: Draft, x: Floats, row: int, first: int, where: Sequence[int]) -> bool:
    """Whether the single steps from a row on stay uncrossed and without a jack if a given foot begins."""
    where, foot = list(where), first
    for feet in draft.feet[row:]:
        (panel,) = feet
        if panel in where:
            return False
        where[foot] = panel
        if _crossed(x, where):
            return False
        foot = 1 - foot
    return True


def _start(draft: Draft, x: Floats, rng: np.random.Generator, count: int) -> None:
    """A run that begins on the panel of a side."""
    first = int(rng.integers(2))
    draft.step(first, (_LEFT, _RIGHT)[first])
    _run(draft, x, rng, 1 - first, count - 1)


def _after_jump(draft: Draft, x: Floats, rng: np.random.Generator) -> None:
    """A run, a jump, a run that only one foot can begin."""
    _start(draft, x, rng, int(rng.integers(3, 6)))
    draft.jump(rng)
    row, where, first = len(draft.feet), list(draft.where), int(rng.integers(2))
    _run(draft, x, rng, first, int(rng.integers(5, 8)))
    if _goes_on(draft, x, row, 1 - first, where):
        raise _NoPatternError


def _jump_with_hold(draft: Draft, x: Floats, rng: np.random.Generator) -> None:
    """A jump of which one step is held for half the wait: the other foot goes on."""
    _start(draft, x, rng, int(rng.integers(2, 5)))
    draft.jump(rng)
    first = int(rng.integers(2))
    draft.ends[len(draft.feet) - 1, draft.where[1 - first]] = 0.5
    _run(draft, x, rng, first, int(rng.integers(4, 7)))


def _out_of_hold(draft: Draft, x: Floats, rng: np.random.Generator) -> None:
    """One foot holds, the other steps, also when the hold ends; then they go on by turns."""
    foot, count = int(rng.integers(2)), int(rng.integers(2, 6))
    side = (_LEFT, _RIGHT)[foot]
    draft.step(1 - foot, (_RIGHT, _LEFT)[foot])
    draft.step(foot, side)
    draft.ends[len(draft.feet) - 1, side] = count
    for _ in range(count):
        draft.step(1 - foot, int(rng.choice([p for p in range(len(x)) if p not in draft.where])))
    _run(draft, x, rng, foot, int(rng.integers(4, 7)))


def _turn(draft: Draft, x: Floats, rng: np.random.Generator) -> None:
    """One foot on the sides, the other in front and behind in turn: crossovers and swings, but no full turn."""
    foot, count = int(rng.integers(2)), int(rng.integers(4, 6))
    home, away = (_LEFT, _RIGHT) if foot == 0 else (_RIGHT, _LEFT)
    sides = [home, *(int(side) for side in rng.choice([home, away], count - 1)), home]
    middles = [int(middle) for middle in rng.choice([_DOWN, _UP], count)]
    across = [side == away for side in sides]
    into = [middles[n - 1] for n in range(1, count) if across[n] and not across[n - 1]]
    out = [middles[n] for n in range(1, count) if across[n] and not across[n + 1]]
    if not 0 < sum(across) <= count // 2 or into != out:
        raise _NoPatternError
    for side, middle in zip(sides, middles, strict=False):
        draft.step(foot, side)
        draft.step(1 - foot, middle)
    draft.step(foot, home)


def _switch(draft: Draft, x: Floats, rng: np.random.Generator) -> None:
    """A run in which the other foot takes over a panel in front or behind, because a jack would cross everything that
    follows.
    """
    _start(draft, x, rng, int(rng.integers(3, 6)))
    foot = draft.last
    panel = draft.where[foot]
    if panel not in (_DOWN, _UP):
        raise _NoPatternError
    draft.step(1 - foot, panel)
    row, where = len(draft.feet), list(draft.where)
    _run(draft, x, rng, foot, int(rng.integers(4, 7)))
    if _goes_on(draft, x, row, 1 - foot, where):
        raise _NoPatternError


def _jumps(draft: Draft, x: Floats, rng: np.random.Generator) -> None:
    """Several jumps in a row, no two alike, each foot on its own side."""
    _start(draft, x, rng, int(rng.integers(1, 4)))
    before: tuple[int, int] | None = None
    for _ in range(int(rng.integers(3, 6))):
        ways = [pair for pair in _JUMPS if pair != before]
        before = ways[int(rng.integers(len(ways)))]
        draft.land(*before)


_FAMILIES: Mapping[str, tuple[Callable[[Draft, Floats, np.random.Generator], None], Sequence[int]]] = {
    "after a jump": (_after_jump, (48, 24)),
    "jumps": (_jumps, (48, 28)),
    "jump with a hold": (_jump_with_hold, (48, 24)),
    "out of a hold": (_out_of_hold, (48, 24)),
    "turn": (_turn, (24, 16)),
    "switch": (_switch, (48, 24, 16)),
}


def load_patterns(seeds: range) -> list[Labelled]:
    """A pattern of each family and gap for each seed."""
    pad = load_pad("dance-single")
    assert pad is not None
    x, out = pad.panels[:, 0], []
    for seed in seeds:
        for number, (name, (make, gaps)) in enumerate(_FAMILIES.items()):
            for gap in gaps:
                draft = _draft(make, gap, x, np.random.default_rng([seed, number, gap]))
                cells = [(row, p, foot) for row, feet in enumerate(draft.feet) for p, foot in feet.items()]
                row, column, foot = np.array(cells, dtype=np.int64).T
                title = f"{name} {gap} {seed}"
                out.append(Labelled(title, "made", title, draft.rows(pad), pad, row, column, foot))
    return out


def _draft(
    make: Callable[[Draft, Floats, np.random.Generator], None], gap: int, x: Floats, rng: np.random.Generator
) -> Draft:
    while True:
        draft = Draft(gap)
        try:
            make(draft, x, rng)
        except _NoPatternError:
            continue
        return draft
