"""From a play to a plan: rules get each row, walks and shakes are inserted. Only this module applies proposals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, TypedDict, Unpack

import numpy as np

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.dance.clearance import SHARES, Way, detour, evenness
from dancetutor_cli.dance.context import Context, bar_of, context_of, holding, phase_of
from dancetutor_cli.dance.foot_path import shoe_path
from dancetutor_cli.dance.footwork.footfalls import Stand, current_stand
from dancetutor_cli.dance.footwork.footing import SHORTEST_SWING, Footing, Proposal, Row, hold, pair, press, pressed_by
from dancetutor_cli.dance.footwork.homing import HomeSteps, ease_feet, faces_as_at_home, leg_shakes
from dancetutor_cli.dance.footwork.mines import avoid_mines
from dancetutor_cli.dance.footwork.steps import jump, step
from dancetutor_cli.dance.footwork.turning import Facing, leading_foot, turn_start
from dancetutor_cli.dance.footwork.walks import (
    SideSteps,
    WalkProposal,
    first_place,
    next_step,
    waits,
    walk_off,
    walk_on,
    walk_over,
)
from dancetutor_cli.dance.motion import Contact
from dancetutor_cli.dance.plan import STRAIGHT, Bulge, FootTrack, Jump, Move, Plan, Press, Shake, Step, Swing, Turn
from dancetutor_cli.dance.settings import MotionSettings, SettingsCourse, default_settings
from dancetutor_cli.dance.settings_feet import WalkSettings
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.play import Play, StepKind
from dancetutor_cli.feet.unplayable import DroppedNote, without_unplayable
from dancetutor_cli.run.errors import DancetutorError

if TYPE_CHECKING:
    from dancetutor_cli.chart.timing import Timing
    from dancetutor_cli.feet.pads import Pad

# From a play to moves, row by row. The planner calls the rules for proposals, and only the planner applies them.

MOST_COLUMNS = 16  # newest touches among which the last one of each foot is looked for
NEWEST = 8  # moves of a foot that rules may still read or change


class Planner:
    """The planner of one play, row by row. `second(tick)` gives the time of a tick in seconds of the music."""

    def __init__(self, play: Play, second: Callable[[int], float], context: Context) -> None:
        self.play, self.second, self.context, self.settings = play, second, context, context.settings
        lead = leading_foot(play, context.panels)
        self.footing = Footing.at_home(context, lead, first_place(play, context, lead))
        self.begin = self.footing
        self.asides = SideSteps(play, context, self.footing.lead)
        self.homes = HomeSteps(play, context, self.footing.lead)
        self.facing = Facing(play, self.settings)
        self.previous: float | None = None
        self.moves: tuple[list[Move], list[Move]] = ([], [])  # moves that no rule changes any more
        self.turns: list[Turn] = []
        self.presses: list[Press] = []
        self.touches: list[Contact] = []

    def run(self) -> Plan:
        """Return the plan of the whole song. Raises DancetutorError if the play has no steps."""
        for i in range(len(self.play.rows)):
            self._row(i)
        if not self.touches:
            raise DancetutorError("the chart has no steps: there is nothing to dance")
        tracks = []
        for begin, old, foot in zip(self.begin.feet, self.moves, self.footing.feet, strict=True):
            tracks.append(replace(begin.track(), moves=(*old, *foot.moves)))
        touches = self._ended((tracks[0].moves, tracks[1].moves))
        turns, presses, first = tuple(self.turns), tuple(self.presses), touches[0].start
        plan = Plan((tracks[0], tracks[1]), turns, presses, touches, first, first, lead=self.footing.lead)
        return replace(plan, last=max(contact.end for contact in plan.contacts))

    def _row(self, i: int) -> None:
        time = float(self.play.rows.second[i])
        if self.context.course is not None:
            self.context = self.context.at(time)
            self.settings, self.footing = self.context.settings, self.footing.in_context(self.context)
            for rule in (self.asides, self.homes, self.facing):
                rule.settings = self.settings
        row = Row(self.play, self.context, i, time, pressed_by(self.play, i))
        soon = slice(int(np.searchsorted(self.play.rows.second, self._stays(i, time))))
        panels, mines = self.context.panels, self.play.rows.mines[soon]
        self.footing = replace(self.footing, mined=panels[mines[i + 1 :].any(axis=0)])
        self._apply(avoid_mines(row, self.footing))
        self.footing = replace(self.footing, mined=panels[mines[i:].any(axis=0) & (self.play.limb[i] < 0)])
        if row.feet:
            self._feet(row)
        for limb, columns in row.pressed.items():
            for column in columns:
                self._touch(row, limb, column)

    def _stays(self, i: int, time: float) -> float:
        """Return until when mines matter to the feet that land at row i: for a while, and as long as the feet hold."""
        held = self.play.rows.hold_end[i][self.play.limb[i] >= 0]
        return max([time + self.settings.mines.ahead, *(self.second(int(tick)) for tick in held if tick >= 0)])

    def _feet(self, row: Row) -> None:
        """Plan a step or a jump, with the turn of the body; before it the dancer may step aside, or home."""
        time, longest = row.time, self.settings.step.longest
        aside = None
        if self.previous is not None:
            eases = ease_feet(row, self.footing, self._whole())
            if eases is not None:
                self._apply(eases)
            asked = row, self.presses, self.footing
            aside = self.asides.before(*asked) or self.homes.before(*asked)
        if aside is not None:
            self._apply(aside)
            self.facing.begin_anew()
            self.previous = max(foot.landed for foot in self.footing.feet)
        turned = 0.0 if faces_as_at_home(row, self.footing) else self.facing.turn(row, self.footing)
        left, right = self.footing.resting
        self.footing = replace(self.footing, resting=(left and 0 not in row.feet, right and 1 not in row.feet))
        # the turn is added to the normal and subtracted again, so the rest is exactly how far the foot has turned
        before = self.footing.normal
        aim = float(np.radians(self.facing.aim(row, before + turned, self.footing.lead)))
        self.footing = replace(self.footing, normal=before + turned, aim=aim)
        duration = longest if self.previous is None else min(longest, max(time - self.previous, SHORTEST_SWING))
        row = replace(row, duration=duration, turned=self.footing.normal - before)
        found = jump(row, self.footing) if len(row.feet) == 2 else step(row, row.feet[0], self.footing)
        yaw = found.footing.turned_to()
        far = abs(yaw - self.turns[-1].yaw) if self.turns else abs(yaw)
        turn = Turn(turn_start((time, duration), found.leaves, float(np.degrees(far)), self.settings.step), time, yaw)
        self._apply(replace(found, footing=replace(found.footing, faced=yaw), turn=turn))
        self.previous = time

    def _whole(self) -> tuple[bool, bool]:
        """Whether each foot has its whole sole on the panel that it stepped on last."""
        parts = {touch.limb: touch.part for touch in self.touches[-MOST_COLUMNS:]}
        return parts.get(Limb.LEFT_FOOT) == Part.WHOLE, parts.get(Limb.RIGHT_FOOT) == Part.WHOLE

    def _touch(self, row: Row, limb: int, column: int) -> None:
        """Add the contact of a limb with a column."""
        kind, panel = int(self.play.rows.steps[row.index, column]), pair(self.context.panels[column])
        end = np.inf
        if kind == StepKind.HOLD:
            end = self.second(int(self.play.rows.hold_end[row.index, column]))
            self._apply(hold(self.footing, limb, column, row.time, end))
        if limb in (Limb.LEFT_HAND, Limb.RIGHT_HAND):
            palm = press(self.footing, limb - Limb.LEFT_HAND, panel, (row.time, end), self.presses)
            self.presses.append(palm)
            end = palm.end
        part = int(self.play.part[row.index, column])
        self.touches.append(Contact(row.time, end, limb, column, kind, part, row.index, panel))

    def _apply(self, proposal: Proposal) -> None:
        """Apply a proposal of a rule. Moves that are too old for the rules are put aside."""
        for done, foot in zip(self.moves, proposal.footing.feet, strict=True):
            if len(foot.moves) > 2 * NEWEST:
                old, foot = foot.split_moves(NEWEST)
                done += old
                proposal = replace(proposal, footing=proposal.footing.with_foot(foot))
        self.footing = proposal.footing
        if proposal.turn is not None:
            self.turns.append(proposal.turn)

    def _ended(self, moves: tuple[tuple[Move, ...], tuple[Move, ...]]) -> tuple[Contact, ...]:
        """Return all touches, in order, each with its latest end. A foot that is not needed stays for a while."""
        self.touches.sort(key=lambda c: (c.start, c.limb, c.column))
        lifts = [[m.lift for m in of_foot if isinstance(m, Swing)][-1:] for of_foot in moves]
        stays = self.settings.step.longest

        def ended(touch: Contact) -> Contact:
            left = touch.end < np.inf or any(lift >= touch.start for lift in lifts[touch.limb])
            return touch if left else replace(touch, end=touch.start + stays)

        return tuple(ended(touch) for touch in self.touches)


# Walks in a plan: the moves after a walk start from the place where it ended, around the present place of the other
# foot.


def with_walks(plan: Plan, mines: Array, gait: str, context: Context) -> Plan:
    """Return the plan with walks where there is time. mines : (m,) seconds at which mines pass; gait : its name"""
    for wait in waits(plan, mines, context.settings.walk.wait):
        plan = inserted(plan, walk_over(plan, wait, gait, context), context)
    plan = inserted(plan, walk_on(plan, mines, gait, context), context)
    return inserted(plan, walk_off(plan, mines, gait, context), context)


def with_shakes(plan: Plan, shakes: list[tuple[int, Shake]]) -> Plan:
    """Return the plan with feet (0 left) that are shaken out where they stand."""
    if not shakes:
        return plan
    both = ([shake for foot, shake in shakes if foot == side] for side in (0, 1))
    left, right = (
        replace(track, moves=tuple(sorted([*track.moves, *own], key=lambda move: move.lift)))
        for track, own in zip(plan.feet, both, strict=True)
    )
    return replace(plan, feet=(left, right))


def inserted(plan: Plan, walk: WalkProposal | None, context: Context) -> Plan:
    """Return the plan with a walk in it, if one was proposed.

    Until both feet have stepped after the walk, one foot is not where the play has it. So the dancer keeps the
    direction in which she arrived.
    """
    if walk is None:
        return plan
    steps, goal, begin = walk.steps, walk.goal, walk.begin
    start, end = steps.walk.start, steps.walk.end
    both = [next_step(track, end) for track in plan.feet]
    until = max((step.land for step in both if step is not None), default=end)
    tracks = []
    for side, track in enumerate(plan.feet):
        after = [s for s in track.moves if s.land > start or begin is not None]
        before = track.moves[: len(track.moves) - len(after)]
        moved = _from_there(tuple(after), goal, side, context)
        tracks.append(replace(track, moves=(*before, *steps.swings[side], *moved)))
    turns = plan.turns
    if begin is not None:
        level = context.ground.level(*begin.middle)
        tracks = [_begun(track, begin, side, level) for side, track in enumerate(tracks)]
        first = Turn(start - 1.0, start - 0.5, begin.heading)
        turns = (first, *steps.turns, *turns)
    else:
        kept = [replace(t, yaw=goal.heading) if end < t.end < until - 1e-9 else t for t in turns]
        turns = tuple(sorted([*kept, *steps.turns], key=lambda t: t.start))
    walks = tuple(sorted([*plan.walks, steps.walk], key=lambda w: w.start))
    feet = _gone_around((tracks[0], tracks[1]), end, context)
    return replace(plan, feet=feet, turns=turns, walks=walks)


def _begun(track: FootTrack, begin: Stand, side: int, level: float) -> FootTrack:
    """Return a foot's track with another beginning."""
    x, z = begin.balls[side]
    return replace(track, start=(float(x), float(z)), start_yaw=float(begin.yaws[side]), start_level=level)


def _from_there(moves: tuple[Move, ...], goal: Stand, side: int, context: Context) -> tuple[Move, ...]:
    """Return the moves of a foot after a walk, planned from its new place: its pivots and its first step are new."""
    step = context.settings.step
    most = np.radians(step.foot_turn + step.toe_out)
    here = (float(goal.balls[side][0]), float(goal.balls[side][1]))
    middle = goal.balls.mean(axis=0)

    def turned(move: Move) -> float:
        return float(np.clip(move.yaw, goal.heading - most, goal.heading + most))

    for k, move in enumerate(moves):
        if not isinstance(move, Swing):
            continue
        first = replace(move, bulge=STRAIGHT, yaw=turned(move))
        if isinstance(move, Jump):
            first = replace(move, line_turn=0.0, middles=((float(middle[0]), float(middle[1])), move.middles[1]))
        return (*(replace(m, target=here, yaw=turned(m)) for m in moves[:k]), first, *moves[k + 1 :])
    return tuple(replace(m, target=here, yaw=turned(m)) for m in moves)


def _gone_around(feet: tuple[FootTrack, FootTrack], walked: float, context: Context) -> tuple[FootTrack, FootTrack]:
    """Return both feet after a walk, which ends at another place. Until both have stepped, their steps go around the
    present place of the other foot.
    """
    firsts = [next_step(track, walked) for track in feet]
    until = max((s.land for s in firsts if s is not None), default=walked)
    out = []
    for side, track in enumerate(feet):
        moves = list(track.moves)
        for k, swing in enumerate(moves):
            if isinstance(swing, Step) and walked - 1e-9 <= swing.lift <= until:
                moves[k] = replace(swing, bulge=_bulge(feet, side, swing, context))
        out.append(replace(track, moves=tuple(moves)))
    return out[0], out[1]


def _bulge(feet: tuple[FootTrack, FootTrack], side: int, step: Swing, context: Context) -> Bulge:
    start = current_stand(feet, step.lift)
    there = shoe_path(feet[1 - side], step.lift + SHARES * (step.land - step.lift), context.settings)
    even = float(evenness(step.land - step.lift, context.settings.step))
    way = Way(start.balls[side], float(start.yaws[side]), np.array(step.target), step.yaw, even=even)
    return detour(way, *there, context.settings.step, 1.0 - 2.0 * side)


# From a play to a plan: when each foot leaves and lands, where, and how it is turned. Each rule has its module.
#
# A rule takes a row (or a wait) and the footing, changes neither, and returns its proposal: another footing
# (`footing.Proposal`) or a walk (`walks.WalkProposal`). Only `planner` applies proposals.


def plan_footwork(play: Play, second: Callable[[int], float], gait: str, context: Context) -> Plan:
    """Return the plan of both feet and hands in a song.

    second : seconds of the music at a tick; gait : the walk of the dancer, a name or file as for `gait.load_gait`
    Raises DancetutorError if the play has no steps.
    """
    plan = Planner(play, second, context).run()
    mines = play.rows.second[play.rows.mines.any(axis=1)]
    plan = with_walks(plan, mines, gait, context)
    return with_shakes(plan, leg_shakes(plan, mines, context))


# The plan of a whole dance, and its context.

BEATS_AFTER = 16  # beats after the last row for which the dancer still moves with the music


class Manner(TypedDict, total=False):
    """How a play is danced.

    settings : the numbers of the motion, or how they change over the song; by default the numbers of
    `configs/motion.yaml`
    bar : whether the dancer holds the bar behind the pad; gait : the way she walks on and off, as for `load_gait`
    sides : the side from which she comes and the side to which she goes, 0 left or 1 right, if another dancer is beside
    her
    person : as in `Context`
    dropped : the notes that are not played because no limb is free, with reasons, if the caller has decided it
    """

    settings: MotionSettings | SettingsCourse | None
    bar: bool
    gait: str
    sides: tuple[int, int] | None
    person: int
    dropped: tuple[DroppedNote, ...]


def plan_dance(timing: Timing, play: Play, pad: Pad, **manner: Unpack[Manner]) -> tuple[Plan, Context]:
    """Return the plan of a play, and the context in which it is danced. Arguments as in `dance.bake.bake`."""
    given, bar = manner.get("settings") or default_settings(), manner.get("bar", False)
    course = given if isinstance(given, SettingsCourse) else SettingsCourse((given,), ())
    rail = bar_of(pad, course.states[0].bar) if bar else None
    if bar:
        course = replace(course, states=tuple(map(holding, course.states)))
    context = context_of(pad, course.states[0], _beats(timing, play, course.states[0].layers.beat_longest), rail)
    changes = course if course.changes else None
    context = replace(context, sides=manner.get("sides"), person=manner.get("person", 0), course=changes)

    def second(tick: int) -> float:
        return float(timing.seconds(np.array([tick], dtype=np.int64))[0])

    play, dropped = without_unplayable(play, pad, manner.get("dropped", ()))
    plan = replace(plan_footwork(play, second, manner.get("gait", "flat"), context), dropped=dropped)
    context = replace(context, phase=phase_of(plan, context))
    if rail is None:
        return plan, context
    from dancetutor_cli.dance.grips import grips_of

    return grips_of(plan, _standing(plan, context.settings.walk), context), context


def _standing(plan: Plan, walk: WalkSettings) -> tuple[float, float]:
    """Return the second at which the dancer has arrived and the second at which she leaves."""
    arrived = max((w.end for w in plan.walks if w.end < plan.first), default=plan.first - walk.lead_in)
    return arrived, min((w.start for w in plan.walks if w.start > plan.last), default=plan.last + walk.lead_out)


def _beats(timing: Timing, play: Play, longest: float) -> tuple[float, ...]:
    """Return the seconds of all beats from the first measure until `BEATS_AFTER` beats after the last row.

    Beats that are more than `longest` seconds apart are divided in two, four or more: a chart at 40 BPM is mostly one
    of a song at 80 or 160, and a listener feels that pulse (Parncutt, *A perceptual model of pulse salience and
    metrical accent in musical rhythms*, 1994: pulses near 0.6 s are the clearest).
    """
    if not len(play.rows):
        return ()
    ticks = np.arange(0, int(play.rows.tick[-1]) + BEATS_AFTER * TICKS_PER_BEAT, TICKS_PER_BEAT, dtype=np.int64)
    beats = timing.seconds(ticks)
    parts = 2 ** np.ceil(np.log2(np.maximum(np.diff(beats) / longest, 1.0))).astype(np.int64)
    within = [np.linspace(beats[k], beats[k + 1], n, endpoint=False) for k, n in enumerate(parts.tolist())]
    return tuple(np.concatenate((*within, beats[-1:])).tolist())
