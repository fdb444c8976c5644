"""Small plays written by hand, for the tests of motion and bake: no solver, no files."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from dancetutor_cli.dance.context import Context, context_of
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.plan import Plan
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.pads import Pad, load_pad
from dancetutor_cli.feet.play import Play, Rows, StepKind

L, R, LH, RH = Limb.LEFT_FOOT, Limb.RIGHT_FOOT, Limb.LEFT_HAND, Limb.RIGHT_HAND
TICKS_PER_SECOND = 96  # 120 beats per minute

Event = tuple[float, dict[int, Limb]]


def pad(double: bool = False) -> Pad:
    """Panels of dance-single or dance-double, as the spec gives them."""
    found = load_pad("dance-double" if double else "dance-single")
    assert found is not None
    return found


def context(double: bool = False) -> Context:
    """The dancer on such a pad, with the usual settings."""
    return context_of(pad(double), default_settings())


def chart() -> Any:
    """A chart of which only the clock is asked."""
    return SimpleNamespace(timing=SimpleNamespace(seconds=lambda ticks: ticks / TICKS_PER_SECOND))


def play(
    events: list[Event],
    double: bool = False,
    holds: dict[tuple[int, int], float] | None = None,
    mines: dict[int, list[int]] | None = None,
    brackets: dict[tuple[int, int], Part] | None = None,
) -> Play:
    """A play of (second, {column: limb}) rows.

    holds : (row, column) -> second of the tail; mines : row -> columns; brackets : (row, column) -> part
    """
    panels, centre = pad(double).panels, np.array(pad(double).centre)
    n, c = len(events), len(panels)
    limb, steps = np.full((n, c), Limb.NONE, np.int8), np.zeros((n, c), np.uint8)
    hold_end, mine, part = np.full((n, c), -1, np.int64), np.zeros((n, c), bool), np.zeros((n, c), np.uint8)
    feet, facing, standing, angle = np.full((n, 2), -1, np.int16), np.zeros(n), [-1, -1], 0.0
    for i, (_, pressed) in enumerate(events):
        for column in (mines or {}).get(i, []):
            mine[i, column] = True
            standing = [-1 if s == column else s for s in standing]
        for column, who in pressed.items():
            limb[i, column], steps[i, column] = who, StepKind.TAP
            part[i, column] = (brackets or {}).get((i, column), Part.WHOLE)
            if (i, column) in (holds or {}):
                steps[i, column] = StepKind.HOLD
                hold_end[i, column] = round((holds or {})[i, column] * TICKS_PER_SECOND)
            if who in (L, R) and part[i, column] != Part.TOE:
                standing[who] = column
        places = [panels[s] if s >= 0 else centre + (-0.25, 0.25)[k] * np.array([1, 0]) for k, s in enumerate(standing)]
        across = places[1] - places[0]
        if np.linalg.norm(across) > 1e-9:
            angle = float(np.degrees(np.arctan2(across[1], across[0])))
        feet[i], facing[i] = standing, angle
    second = np.array([t for t, _ in events])
    tick = np.round(second * TICKS_PER_SECOND).astype(np.int64)
    rows = Rows(tick, second, np.zeros(n, np.int32), steps, hold_end, mine, np.zeros(n, np.int64))
    return Play(rows, limb, part, feet, facing, (), np.zeros((n, 0), np.int64), None, ((),) * n, "by hand")


def stream(start: float, count: int, gap: float) -> list[Event]:
    """Alternating feet on left, up, down, right."""
    return [(start + gap * k, {(0, 2, 1, 3)[k % 4]: (L, R)[k % 2]}) for k in range(count)]


MEDLEY: list[Event] = [
    (2.0, {0: L}), (2.5, {2: R}), (3.0, {0: L}), (3.5, {3: R}),  # steps
    (4.0, {0: L, 3: R}), (4.5, {1: L, 2: R}), (5.0, {0: L, 3: R}),  # jumps
    (5.4, {1: R}), (5.8, {3: L}), (6.2, {1: R}), (6.6, {0: L}), (7.0, {3: R}),  # a crossover behind
    (7.25, {3: R}), (7.5, {3: R}),  # a jack
    *stream(8.0, 24, 0.125),
    (12.0, {0: L, 3: R, 2: RH}), (13.5, {0: L}), (14.0, {3: R}),  # a hand
]  # fmt: skip


def plan_of(timing: Any, danced: Play, panels: Pad, **manner: Any) -> Plan:
    """Only the moves of a play, without its context. Arguments as in `planned`."""
    return plan_dance(timing, danced, panels, **manner)[0]
