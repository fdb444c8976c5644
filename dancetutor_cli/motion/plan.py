"""From a play to moves: when each foot leaves and lands, where, and how far it turns (thesis 5.5 and 5.6)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.motion import stage
from dancetutor_cli.motion.clear import detour, shoes_apart
from dancetutor_cli.motion.ease import reduction
from dancetutor_cli.motion.feet import GRAVITY
from dancetutor_cli.motion.model import Contact
from dancetutor_cli.motion.settings import MotionSettings
from dancetutor_cli.motion.track import FootTrack, Plan, Press, Swing, Turn
from dancetutor_cli.play.model import Limb, Part, Play, StepKind

Array = NDArray[np.float64]
LEAST_SWING = 0.09  # seconds; a foot is given so long where it is free
SHORTEST = 0.02  # and at least this part of a second in any case
HOME_OUT = 0.098  # metres; a waiting foot stands so far beside the middle of the pad
FREE_WINDOW = 0.001


@dataclass
class _Foot:
    """Where a foot is while the plan is made."""

    side: int
    ball: Array
    yaw: float  # without toe-out
    free: float  # the foot may not leave before
    landed: float = -np.inf  # when it came down
    swings: list[Swing] = field(default_factory=list)
    evading: tuple[float, tuple[Array, float]] | None = None  # time of a mine, and where the foot stood before it

    @property
    def outward(self) -> float:
        return 1.0 if self.side == 0 else -1.0


class Planner:
    """Walks through the rows of a play once. `second(tick)` gives the time of a tick in seconds of the music."""

    def __init__(self, play: Play, panels: Array, second: Callable[[int], float], settings: MotionSettings) -> None:
        self.play, self.panels, self.second, self.settings = play, panels, second, settings
        toe_out = np.radians(settings.step.toe_out)
        self.feet = []
        for side, x in ((0, 1.0), (1, -1.0)):
            middle = np.array([x * HOME_OUT, 0.0])
            self.feet.append(_Foot(side, stage.ball_of(middle, x * toe_out), 0.0, -np.inf))
        self.start = tuple((tuple(f.ball), f.outward * toe_out) for f in self.feet)
        self.normal = 0.0  # unwrapped feet normal, degrees
        self.previous: float | None = None
        self.turns: list[Turn] = []
        self.presses: list[Press] = []
        self.take_off: dict[int, tuple[int, float]] = {}  # in a gallop: foot -> its row, and when it leaves the ground
        self.contacts: list[Contact] = []

    def run(self) -> Plan:
        rows = self.play.rows
        for i in range(len(rows)):
            self._row(i)
        if not self.contacts:
            raise DancetutorError("the chart has no steps: there is nothing to dance")
        feet = tuple(
            FootTrack(place, yaw, tuple(f.swings)) for (place, yaw), f in zip(self.start, self.feet, strict=True)
        )
        self.contacts.sort(key=lambda c: (c.start, c.limb, c.column))
        contacts = tuple(self._ended(c) for c in self.contacts)
        return Plan(
            (feet[0], feet[1]), tuple(self.turns), tuple(self.presses), contacts, (0.0, 0.0),
            contacts[0].start, max(max(c.end for c in contacts if c.end < np.inf), contacts[-1].start),
        )  # fmt: skip

    def _row(self, i: int) -> None:
        time = float(self.play.rows.second[i])
        pressed: dict[int, list[int]] = {}
        for column in np.flatnonzero(self.play.limb[i] >= 0):
            pressed.setdefault(int(self.play.limb[i, column]), []).append(int(column))
        self._mines(i, time, pressed)
        if not pressed:
            return
        turn = (self.play.facing[i] - self.normal + 180.0) % 360.0 - 180.0
        feet = [side for side in (0, 1) if side in pressed]
        before = self.normal
        if feet:
            self.normal += turn
        longest = self.settings.step.longest
        duration = longest if self.previous is None else min(longest, max(time - self.previous, SHORTEST))
        if len(feet) == 2:
            self._jump(i, time, duration, pressed, self.normal - before)
        elif feet:
            self._gallop(i, time, duration, feet[0])
            self._step(i, time, duration, feet[0], pressed[feet[0]])
        if feet:
            self._turn(time, duration)
            self.previous = time
        for limb, columns in pressed.items():
            for pressed_column in columns:
                self._contact(i, time, limb, pressed_column)

    # steps and jumps

    def _step(self, i: int, time: float, duration: float, side: int, columns: list[int]) -> None:
        step, foot, other = self.settings.step, self.feet[side], self.feet[1 - side]
        cut = float(reduction(duration, step.fast, step.longest))
        up = self._resumed(foot, time)
        body = self._body_yaw()
        yaw = self._limited(other.yaw + step.yaw_to_normal * (body - other.yaw), body)
        target, yaw = self._target(i, columns, foot, yaw, stage.middle_of(other.ball, other.yaw), other.yaw, cut)
        lift = min(time - duration * (1.0 - step.double_support), time - LEAST_SWING)
        galloping = self.take_off.get(side, (-1, 0.0))
        if galloping[0] == i:
            lift = galloping[1]
        lift = min(max(lift, foot.free), self._latest(foot, time)) if up is None else up
        height = step.height_slow + cut * (step.height_fast - step.height_slow)
        if np.linalg.norm(target - foot.ball) < 0.05:
            height = max(height * step.jack_height, step.height_fast)
        pitches = self._pitches(cut, step.lift_pitch, step.swing_pitch, step.land_pitch, columns)
        bulge = self._bulge(foot, target, yaw, other)
        kind = "step"
        if up is not None:
            kind, height = "evade", max(height, self.settings.mines.height)
        tuck, middles = 0.0, ((0.0, 0.0), (0.0, 0.0))
        if galloping[0] == i:
            kind, height = "gallop", max(height, self.settings.mines.height)
            if other.side in self.take_off and self.take_off[other.side][0] > i:  # the first of the two
                kind, height, tuck = "jump", GRAVITY * (time - lift) ** 2 / 8, self.settings.jump.tuck
                middles = (_pair(foot.ball), _pair(target))
        toes = self._toes(foot, yaw)
        swing = Swing(lift, time, _pair(target), toes, height, pitches, bulge, kind, tuck, 0.0, *middles)
        self._move(foot, swing, target, yaw)
        if kind == "step":
            self._pivot(other, lift, time)

    def _gallop(self, i: int, time: float, duration: float, side: int) -> None:
        """A step after a wait, and soon after it one of the other foot: one jump whose second foot lands later."""
        jump, rows = self.settings.jump, self.play.rows
        if i + 1 >= len(rows) or duration < jump.gallop_wait:
            return
        gap = float(rows.second[i + 1]) - time
        following = self.play.limb[i + 1]
        steps = np.flatnonzero(following >= 0)
        if not (0.0 < gap <= jump.gallop and len(steps) == 1 and following[steps[0]] == 1 - side):
            return
        flight = min(float(np.sqrt(8 * jump.apex_near / GRAVITY)), jump.flight_share * duration)
        take_off = max(time - flight, *(f.free for f in self.feet))
        self.take_off = {side: (i, take_off), 1 - side: (i + 1, take_off)}

    def _jump(self, i: int, time: float, duration: float, pressed: dict[int, list[int]], turned: float) -> None:
        jump, step = self.settings.jump, self.settings.step
        for foot in self.feet:
            self._land_early(foot, time)
        cut = float(reduction(duration, step.fast, step.longest))
        body = self._body_yaw()
        old = [f.ball for f in self.feet]
        ends = [self.panels[pressed[s]].mean(axis=0) for s in (0, 1)]
        goals = []
        for foot in self.feet:
            yaw = self._limited(foot.yaw + jump.yaw_to_normal * (body - foot.yaw), body)
            goals.append(self._target(i, pressed[foot.side], foot, yaw, ends[1 - foot.side], yaw, cut))
        far = max(float(np.linalg.norm(g - o)) for (g, _), o in zip(goals, old, strict=True))
        apex = jump.apex_near + min(far / jump.far, 1.0) * (jump.apex_far - jump.apex_near)
        if len(pressed) > 2:  # bending down to a panel: feet only just leave the ground
            apex = jump.apex_hands
        flight = min(float(np.sqrt(8 * apex / GRAVITY)), jump.flight_share * duration)
        take_off = min(max(time - flight, *(f.free for f in self.feet)), *(self._latest(f, time) for f in self.feet))
        height = GRAVITY * (time - take_off) ** 2 / 8
        tuck = jump.tuck * (1.0 + 1.5 * min(far / jump.far, 1.5) ** 2)  # legs that reach far must not lock
        middles = _pair((old[0] + old[1]) / 2), _pair((goals[0][0] + goals[1][0]) / 2)
        for foot, (target, yaw) in zip(self.feet, goals, strict=True):
            pitches = self._pitches(cut, jump.lift_pitch, jump.lift_pitch, jump.land_pitch, pressed[foot.side])
            toes = self._toes(foot, yaw)
            swing = Swing(
                take_off,
                time,
                _pair(target),
                toes,
                height,
                pitches,
                (0.0, 0.0),
                "jump",
                tuck,
                np.radians(turned),
                *middles,
            )
            self._move(foot, swing, target, yaw)

    def _move(self, foot: _Foot, swing: Swing, target: Array, yaw: float) -> None:
        foot.swings.append(swing)
        foot.ball, foot.yaw, foot.free = target, yaw, swing.land + FREE_WINDOW
        foot.landed = swing.land

    def _latest(self, foot: _Foot, time: float) -> float:
        """When a foot leaves at the latest for a note: a hold that ends too late is let go a little early."""
        early = max(time - self.settings.step.let_go, foot.landed + FREE_WINDOW)
        return min(early, time - SHORTEST) if foot.free > early else time - SHORTEST

    def _target(
        self, i: int, columns: list[int], foot: _Foot, yaw: float, other: Array, other_yaw: float, cut: float
    ) -> tuple[Array, float]:
        """Where the ball lands and how the foot is turned (without toe-out)."""
        step = self.settings.step
        if len(columns) > 1:  # a bracket: heel on one panel, toes on the other
            parts = self.play.part[i]
            heel = next((c for c in columns if parts[c] == Part.HEEL), columns[0])
            toe = next(c for c in columns if c != heel)
            along = self.panels[toe] - self.panels[heel]
            toes = float(np.arctan2(along[0], along[1]))
            toes += 2 * np.pi * round((yaw - toes) / (2 * np.pi))
            middle = (self.panels[toe] + self.panels[heel]) / 2
            return stage.ball_of(middle, toes), toes - foot.outward * np.radians(step.toe_out)
        panel, toes = self.panels[columns[0]], self._toes(foot, yaw)
        for share in (1.0, 0.75, 0.5, 0.25, 0.0):  # the nearest to the other foot that leaves it room
            ball = stage.landing_ball(panel, toes, other, cut * share, step.edge_margin, step.clearance)
            if shoes_apart(stage.middle_of(ball, toes), toes, other, other_yaw) >= step.apart:
                break
        return ball, yaw

    def _pitches(
        self, cut: float, lift: float, most: float, land: float, columns: list[int]
    ) -> tuple[float, float, float, float]:
        rest = self.settings.step.stream_pitch * cut
        if len(columns) > 1:
            land = rest = 0.0  # heel and toes of a bracket come down together
        out = np.radians([lift * (1.0 - 0.4 * cut), most * (1.0 - 0.6 * cut), land + 0.3 * rest, rest])
        return float(out[0]), float(max(out[0], out[1])), float(max(out[2], out[3])), float(out[3])

    def _bulge(self, foot: _Foot, target: Array, yaw: float, other: _Foot) -> tuple[float, float]:
        """Sideways detour that keeps the swinging foot clear of the standing one."""
        a, b, c = self._toes(foot, foot.yaw), self._toes(foot, yaw), self._toes(other, other.yaw)
        middles = (stage.middle_of(foot.ball, a), stage.middle_of(target, b), stage.middle_of(other.ball, c))
        return detour(middles[0], a, middles[1], b, middles[2], c, self.settings.step.apart)

    def _land_early(self, foot: _Foot, time: float) -> None:
        """Before a jump a foot that hovers over a mine comes down in time to push off."""
        evading, foot.evading = foot.evading, None
        if evading is not None and foot.free > time - 0.1:
            foot.swings.pop()
            (foot.ball, foot.yaw), foot.free = evading[1], evading[0]

    # turning

    def _body_yaw(self) -> float:
        """The yaw that the body aims at for the current feet normal, radians: crossed feet turn it less."""
        whole = 360.0 * round(self.normal / 360.0)
        rest = abs(self.normal - whole)
        k = self.settings.step.crossover_turn
        if rest > 135.0:
            at_135 = 90.0 + 45.0 * k
            rest = at_135 + (rest - 135.0) / 45.0 * (180.0 - at_135)
        elif rest > 90.0:
            rest = 90.0 + (rest - 90.0) * k
        return float(np.radians(whole + np.copysign(rest, self.normal - whole)))

    def _pivot(self, foot: _Foot, start: float, time: float) -> None:
        """The standing foot turns on its ball when the body turns too far from it."""
        step = self.settings.step
        body, limit = self._turned_to(), np.radians(step.pivot_from)
        if abs(foot.yaw - body) <= limit:
            return
        yaw = float(np.clip(foot.yaw, body - np.radians(step.pivot_to), body + np.radians(step.pivot_to)))
        begin = max(start, foot.swings[-1].land + FREE_WINDOW if foot.swings else start)
        if begin > time - 0.04:
            return
        up = float(np.radians(step.pivot_pitch))
        rest = foot.swings[-1].pitches[3] if foot.swings else 0.0
        swing = Swing(
            begin, time, _pair(foot.ball), self._toes(foot, yaw), 0.0, (rest, max(up, rest), rest, rest), kind="pivot"
        )
        free = foot.free
        self._move(foot, swing, foot.ball, yaw)
        foot.free = max(free, foot.free)

    def _turned_to(self) -> float:
        """The yaw that the body turns to for the feet as they are now, radians."""
        mean = (self.feet[0].yaw + self.feet[1].yaw) / 2
        return mean + self.settings.body.turn_to_feet * (self._body_yaw() - mean)

    def _limited(self, yaw: float, body: float) -> float:
        limit = np.radians(self.settings.step.foot_turn)
        return float(np.clip(yaw, body - limit, body + limit))

    def _toes(self, foot: _Foot, yaw: float) -> float:
        return float(yaw + foot.outward * np.radians(self.settings.step.toe_out))

    def _turn(self, time: float, duration: float) -> None:
        self.turns.append(Turn(time - duration, time, self._turned_to()))

    # mines, hands, contacts

    def _mines(self, i: int, time: float, pressed: dict[int, list[int]]) -> None:
        """Feet on a mine go up, and down again behind it: thesis sends them home, itg lifts them where they are."""
        if i == 0:
            return
        now, before, mines = self.play.feet[i], self.play.feet[i - 1], self.play.rows.mines[i]
        threatened = [
            f
            for f in self.feet
            if f.side not in pressed and before[f.side] >= 0 and (now[f.side] < 0 or mines[before[f.side]])
        ]
        for foot in threatened:
            self._evade(foot, time, self.panels[before[foot.side]], hop=len(threatened) == 2)

    def _evade(self, foot: _Foot, time: float, panel: Array, hop: bool) -> None:
        """Lift a foot over a mine; both at once are a hop to the middle of the pad."""
        mines, other = self.settings.mines, self.feet[1 - foot.side]
        if hop:
            half = mines.hop / 2
            target = stage.ball_of(np.array([foot.outward * HOME_OUT, 0.0]), foot.yaw)
            height, tuck, kind = GRAVITY * mines.hop**2 / 8, self.settings.jump.tuck, "jump"
        else:
            half = mines.before + mines.rise
            middle = stage.middle_of(other.ball, other.yaw)
            step = self.settings.step
            target = stage.landing_ball(
                panel, self._toes(foot, foot.yaw), middle, 1.0, step.edge_margin, step.clearance
            )
            height, tuck, kind = mines.height, 0.0, "evade"
        lift = min(max(time - half, foot.free), time - SHORTEST)
        back = (foot.ball, foot.yaw)
        swing = Swing(
            lift, time + half, _pair(target), self._toes(foot, foot.yaw), height, (0.1, 0.2, 0.05, 0.0),
            kind=kind, tuck=tuck, middle0=_pair(foot.ball), middle1=_pair(target),
        )  # fmt: skip
        self._move(foot, swing, target, foot.yaw)
        if not hop:
            foot.evading = (time, back)

    def _resumed(self, foot: _Foot, time: float) -> float | None:
        """A step soon after a mine: the foot stays up and goes straight to it. Returns when it left the ground."""
        evading, foot.evading = foot.evading, None
        if evading is None or time - evading[0] > self.settings.step.longest:
            return None
        swing = foot.swings.pop()
        foot.ball, foot.yaw = evading[1]
        return swing.lift

    def _contact(self, i: int, time: float, limb: int, column: int) -> None:
        kind = int(self.play.rows.steps[i, column])
        end = np.inf
        if kind == StepKind.HOLD:
            end = self.second(int(self.play.rows.hold_end[i, column]))
            if limb in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
                self.feet[limb].free = max(self.feet[limb].free, end)
        panel = _pair(self.panels[column])
        if limb in (Limb.LEFT_HAND, Limb.RIGHT_HAND):
            end = max(time + self.settings.hands.press, end if end < np.inf else 0.0)
            side = limb - Limb.LEFT_HAND
            before = [p.end for p in self.presses if p.side == side]
            lead = min(self.settings.hands.reach_down, max(time - before[-1], SHORTEST) if before else np.inf)
            self.presses.append(Press(time, end, side, panel, self._turn_to_panel(side, panel), lead))
        self.contacts.append(Contact(time, end, limb, column, kind, int(self.play.part[i, column]), i, panel))

    def _turn_to_panel(self, side: int, panel: tuple[float, float]) -> float:
        """How far the body turns to the hand's side, radians, for a panel that is not before it."""
        hands = self.settings.hands
        away = np.array(panel) - (self.feet[0].ball + self.feet[1].ball) / 2
        off = (np.arctan2(away[0], away[1]) - self._turned_to() + np.pi) % (2 * np.pi) - np.pi
        beyond = np.clip(abs(np.degrees(off)) - hands.turn_from, 0.0, hands.turn_most)
        return float(np.radians(beyond) * (1.0 if side == 0 else -1.0))

    def _ended(self, contact: Contact) -> Contact:
        """A contact ends when its foot leaves the panel, also if that is before the end of a hold."""
        if contact.limb >= Limb.LEFT_HAND:
            return contact
        lifts = [s.lift for s in self.feet[contact.limb].swings if s.kind != "pivot"]
        k = int(np.searchsorted(lifts, contact.start))
        last = contact.end if contact.end < np.inf else contact.start + self.settings.step.longest
        end = lifts[k] if k < len(lifts) else last
        if contact.end < np.inf:
            end = min(end, contact.end)
        return Contact(
            contact.start, end, contact.limb, contact.column, contact.kind, contact.part, contact.row, contact.panel
        )


def _pair(v: Array) -> tuple[float, float]:
    return float(v[0]), float(v[1])
