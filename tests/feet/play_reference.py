"""A slow solver in plain Python, written from the cost-model page alone: what the fast one is tested against.

It reads a chart's notes itself (rows, rolls, holds), keeps every reachable state of a row in a dictionary, and shares
no code with `dancetutor_cli.feet`. Names follow the page; a state is a tuple
(left foot, right foot, last leg, facing side of an exact 180, {limb: column} of held holds).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction

EPS = 1e-6
SINGLE = [(-1, 0), (0, -1), (0, 1), (1, 0)]
DOUBLE = [*SINGLE, (2, 0), (3, -1), (3, 1), (4, 0)]
PADS = {"dance-single": (SINGLE, (0.0, 0.0)), "dance-double": (DOUBLE, (1.5, 0.0))}
HOME = -1
LEGS, HANDS = ("L", "R"), ("l", "r")  # feet and hands
GAPS = [Fraction(1, n) for n in (1, 2, 3, 4, 6, 8, 12, 16)]


@dataclass
class Row:
    """One beat: column -> end beat of the hold that starts there, or None for what is not held; and the mines."""

    beat: Fraction
    steps: dict[int, Fraction | None] = field(default_factory=dict)
    mines: set[int] = field(default_factory=set)


def rows_of(notes: list[tuple[Fraction, int, str, Fraction | None]], bpm_at, window: float = 0.35) -> list[Row]:  # type: ignore[no-untyped-def]
    """Judged notes (beat, column, kind of 1 2 4 M L, end) to rows, rolls as virtual taps."""
    rows: dict[Fraction, Row] = {}

    def row(beat: Fraction) -> Row:
        return rows.setdefault(beat, Row(beat))

    for beat, column, kind, end in notes:
        if kind == "M":
            row(beat).mines.add(column)
        else:
            row(beat).steps[column] = end if kind == "2" else None
    for beat, column, kind, end in notes:
        if kind == "4":
            assert end is not None
            seconds = 60 / bpm_at(beat)
            gap = next((g for g in GAPS if float(g) * seconds <= window + EPS), GAPS[-1])
            tap = beat + gap
            while tap < end:
                row(tap).steps.setdefault(column, None)
                tap += gap
    return [rows[beat] for beat in sorted(rows)]


class Reference:
    """Cost model of one steps type with the weights of the page."""

    def __init__(self, steps_type: str, allow_doublestep: bool = True) -> None:
        self.panels, (self.cx, self.cy) = PADS[steps_type]
        self.allow_doublestep = allow_doublestep

    def place(self, leg: str, panel: int) -> tuple[float, float]:
        if panel == HOME:
            return (self.cx - 0.25 if leg == "L" else self.cx + 0.25, self.cy)
        return self.panels[panel]

    def angle(self, left: int, right: int) -> float:
        (lx, ly), (rx, ry) = self.place("L", left), self.place("R", right)
        degrees = math.degrees(math.atan2(ry - ly, rx - lx))
        return 180.0 if abs(abs(degrees) - 180) < EPS else degrees

    def turn(self, before: float, side: int, after: float) -> tuple[float, bool, int]:
        """Size of the turn, whether it is a spin, and the side of a 180 after it (+1, -1, 0 none)."""
        start = before if before != 180.0 or side >= 0 else -180.0
        delta = (after - start + 180.0) % 360.0 - 180.0
        if abs(abs(delta) - 180.0) < EPS:
            return 180.0, False, 0
        if abs(delta) < EPS:
            return 0.0, False, side if after == 180.0 else 0
        end = start + delta
        no_side = before == 180.0 and side == 0
        spin = abs(end) > 180.0 + EPS and not no_side
        if after == 180.0:
            return abs(delta), spin, 1 if end > 0 else -1
        return abs(delta), spin, 0

    def hand_cost(self, hand: str, column: int, left: int, right: int) -> int:
        (lx, ly), (rx, ry) = self.place("L", left), self.place("R", right)
        px, py = self.panels[column]
        vx, vy = px - (lx + rx) / 2, py - (ly + ry) / 2
        if math.hypot(vx, vy) < EPS:
            return 0
        facing = math.radians(self.angle(left, right))
        lateral = vx * math.cos(facing) + vy * math.sin(facing)
        ahead = -vx * math.sin(facing) + vy * math.cos(facing)
        off = math.degrees(math.atan2(abs(lateral), ahead))
        cost = 5 if (lateral > EPS if hand == "l" else lateral < -EPS) else 0
        return cost + (2 if off > 90 + EPS else 1 if off > 45 + EPS else 0)

    def ways(
        self, steps: list[int], free: list[str], hands: list[str], feet: dict[str, int], last: str
    ) -> Iterator[dict[int, str]]:
        """Every way to play a row: column -> limb."""
        if len(steps) == 1:
            panel = steps[0]
            standing = [leg for leg in free if feet[leg] == panel]
            if standing:
                yield {panel: standing[0]}
            elif len(free) == 2:
                for leg in free:
                    if leg != last or self.allow_doublestep:
                        yield {panel: leg}
            elif free:
                yield {panel: free[0]}
            elif hands:
                for hand in hands:
                    yield {panel: hand}
            else:
                yield {}
            return
        for panels in itertools.permutations(steps, len(free)):
            by_leg = dict(zip(panels, free, strict=True))
            rest = [s for s in steps if s not in by_leg]
            used = min(len(hands), len(rest))
            for limbs in itertools.permutations(hands, used):
                for chosen in itertools.combinations(rest, used):
                    yield {**by_leg, **dict(zip(chosen, limbs, strict=True))}

    def prepared(self, state, row: Row):  # type: ignore[no-untyped-def]
        """The state before the steps of a row: ended holds released, feet off the mines."""
        left, right, last, side, held = state
        held = tuple((limb, column, end) for limb, column, end in held if end > row.beat)
        reserved = {limb for limb, _, _ in held}
        new_left = HOME if left in row.mines and "L" not in reserved else left
        new_right = HOME if right in row.mines and "R" not in reserved else right
        if (new_left, new_right) != (left, right):
            _, _, side = self.turn(self.angle(left, right), side, self.angle(new_left, new_right))
        return new_left, new_right, last, side, held

    def played(self, state, row: Row, way: dict[int, str]):  # type: ignore[no-untyped-def]
        """State after playing a row in a way, and what it costs. `state` is prepared."""
        left, right, last, side, held = state
        reserved = {limb for limb, _, _ in held}
        free = [leg for leg in LEGS if leg not in reserved]
        pressed = {limb: column for column, limb in way.items()}
        feet = {"L": left, "R": right}
        after = {leg: pressed.get(leg, feet[leg]) for leg in LEGS}
        angle = self.angle(after["L"], after["R"])
        size, spin, new_side = self.turn(self.angle(left, right), side, angle)
        cost = 1000 * (len(row.steps) - len(way))
        cost += 3 if spin else 0
        cost += 15 if size >= 180 - EPS else 5 if size >= 135 - EPS else 0
        cost += 1 if self.place("R", after["R"])[0] < self.place("L", after["L"])[0] - EPS else 0
        if len(row.steps) == 1:
            leg = next((limb for limb in way.values() if limb in LEGS), "")
            if leg and leg == last and len(free) == 2 and feet[leg] != pressed[leg]:
                cost += 12
        elif any(feet[leg] in row.steps and leg in pressed and pressed[leg] != feet[leg] for leg in free):
            cost += 10
        new_held = list(held)
        for limb, column in pressed.items():
            end = row.steps[column]
            if limb in HANDS:
                cost += self.hand_cost(limb, column, after["L"], after["R"])
            if end is not None and end > row.beat:
                new_held.append((limb, column, end))
        cost += sum(1 for limb, _, _ in new_held if limb in HANDS)
        stepped = [leg for leg in LEGS if leg in pressed]
        new_last = "" if len(stepped) == 2 else stepped[0] if stepped else last
        return (after["L"], after["R"], new_last, new_side, tuple(sorted(new_held))), cost

    def solve(self, rows: list[Row]) -> int:
        """The least total cost."""
        states = {(HOME, HOME, "", 0, ()): 0}
        for row in rows:
            following: dict[tuple, int] = {}  # type: ignore[type-arg]
            for state, total in states.items():
                before = self.prepared(state, row)
                options = self.options(before, row) if row.steps else [None]
                for way in options:
                    new, cost = (before, 0) if way is None else self.played(before, row, way)
                    if total + cost < following.get(new, math.inf):
                        following[new] = total + cost
            states = following
        return min(states.values())

    def options(self, before, row: Row) -> Iterator[dict[int, str]]:  # type: ignore[no-untyped-def]
        left, right, last, _, held = before
        reserved = {limb for limb, _, _ in held}
        legs = [leg for leg in LEGS if leg not in reserved]
        hands = [hand for hand in HANDS if hand not in reserved]
        feet = {"L": left, "R": right}
        return self.ways(sorted(row.steps), legs, hands, feet, last)

    def cost_of(self, rows: list[Row], ways: list[dict[int, str]]) -> list[int]:
        """Cost of each row of a given play; AssertionError if a row is played in a way the rules do not offer."""
        state = (HOME, HOME, "", 0, ())
        costs = []
        for row, way in zip(rows, ways, strict=True):
            state = self.prepared(state, row)
            if not row.steps:
                costs.append(0)
                continue
            assert way in list(self.options(state, row)), f"beat {row.beat}: {way} is not offered from {state}"
            state, cost = self.played(state, row, way)
            costs.append(cost)
        return costs
