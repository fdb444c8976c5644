"""How a foot lands: its place on the panel, its turn, the rise of its heel, and its way around the other foot."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from dancetutor_cli.dance.clearance import ANKLE, SHARES, Way, detour, evenness, gaps_at, headings, over
from dancetutor_cli.dance.context import HALF_PANEL, Context, Spot, ball_of, middle_of, on_panel, room_on
from dancetutor_cli.dance.foot_path import shoe_path
from dancetutor_cli.dance.footwork.footing import Footing, FootState
from dancetutor_cli.dance.motion import Ground
from dancetutor_cli.dance.plan import Bulge, chance_of
from dancetutor_cli.dance.rig.body import BALL_AHEAD, HALF_SHOE, SHOE_OUTLINE
from dancetutor_cli.dance.settings_feet import StepSettings
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Part

Pitches = tuple[float, float, float, float]
HALF_BALL = float(SHOE_OUTLINE[:, 1].max())  # metres from the middle of a shoe at the ball to its side
_ACROSS = np.arange(-5, 6) / 5
PLACES = np.stack(np.meshgrid(_ACROSS, _ACROSS), axis=-1).reshape(-1, 2)  # places of a left ball in its room on a panel
TURNS = np.radians([0.0, -10.0, 10.0, -20.0, 20.0, -32.0, 32.0, -45.0, 45.0])
LATEST = 4  # number of the last swings of a foot that are checked to find its place
CROSSED_PRICE = 3e3  # weight of a radian by which the legs cross too far
MIDDLE_PRICE = 1e2  # weight of a metre by which the middle of a shoe is off its panel
SURELY = 1e-9  # metres; the search stops at this accuracy
HEIGHTS = 20180611  # of the seeds of how high feet rise
EDGE_PRICE = 4e2  # weight of a metre by which a shoe reaches over the edge of the pad


@dataclass(frozen=True, slots=True)
class Pose:
    """A standing foot: its ball (2,), and the direction of its toes, radians."""

    ball: Array
    toes: float

    @property
    def middle(self) -> Array:
        """The middle of the sole."""
        return middle_of(self.ball, self.toes)


def pose(footing: Footing, foot: FootState) -> Pose:
    """Return the present pose of a foot."""
    return Pose(foot.ball, footing.toes(foot))


@dataclass(frozen=True, slots=True)
class Goal:
    """The demands of a row on a foot.

    columns : the columns that it presses; parts : (c,) the part of a foot that presses each column
    yaw : wanted, without toe-out; cut : 0 for the panel's centre to 1 for its inner edge
    following : (2,) the panel of the foot's next step, None if that step is far off
    haste : 0 to 1, how much faster than a fast move it is
    """

    columns: list[int]
    parts: Array
    yaw: float
    cut: float
    following: Array | None
    haste: float = 0.0


@dataclass(frozen=True, slots=True)
class Heel:
    """The rise of a heel in a slow move, degrees: as the toes leave, at most, at landing.

    flat : the parts by which the first two are smaller in fast moves; rest : degrees while the foot stands in fast
    moves
    """

    degrees: tuple[float, float, float]
    flat: tuple[float, float]
    rest: float


def heel_of_step(step: StepSettings, leisure: float = 1.0, haste: float = 0.0) -> Heel:
    """Return the heel of a step; leisure, haste : 0 to 1 as in `Row`.

    At leisure it lands lower, because the body sinks as the heel comes down. With haste it rises less, because rocking
    throws the body.
    """
    land = step.land_pitch * (1.0 - leisure**2 * (1.0 - step.land_slow))
    land += haste * (step.land_hasty - step.land_pitch)
    swing = step.swing_flat + haste * (step.swing_flat_hasty - step.swing_flat)
    rest = step.stream_pitch + haste * (step.stream_pitch_hasty - step.stream_pitch)
    return Heel((step.lift_pitch, step.swing_pitch, land), (step.lift_flat, swing), rest)


def landing_place(footing: Footing, foot: FootState, goal: Goal, other: Pose) -> tuple[Array, float]:
    """Return where the ball lands and the yaw of the foot (without toe-out). other : the other foot at the landing"""
    step = footing.settings.step
    if len(goal.columns) > 1:
        return _bracket(footing, foot, goal)
    panels, following = footing.context.panels, goal.following
    panel, room = panels[goal.columns[0]], room_on(panels, goal.columns[0], step)
    # a foot that stays for a while stands on the panel's middle
    hurry = goal.cut * (step.resting if following is None else 1.0)
    far = float(np.linalg.norm(panel - other.middle))
    wide = min(max((far - step.wide) / max(step.wide_most - step.wide, 1e-9), 0.0), 1.0)
    wide *= far < step.leap + HALF_PANEL  # beyond, the other foot follows
    cut = max(hurry, step.edge, wide * step.wide_inward)
    yaw = footing.limit_yaw(goal.yaw + foot.outward * wide * np.radians(step.wide_turn), footing.body_yaw())
    toes = footing.toes(foot, yaw)
    beyond = (far - 2 * HALF_PANEL) / max(step.wide - 2 * HALF_PANEL, 1e-9)
    hard = max(goal.haste, min(beyond, 1.0))
    inside = step.middle_inside + hard * (step.middle_inside_hasty - step.middle_inside)
    spot = Spot(panel, room, np.maximum(room, room + hurry * (HALF_PANEL - inside - room)))
    ball = landing_ball(spot, toes, other.middle, cut, step.edge_margin)
    # in a stream a foot takes the shortest way: it lands on its panel at the place nearest to its last and next panels
    way = (foot.ball + (foot.ball if following is None else following)) / 2
    ball = ball + step.on_the_way * hurry * (on_panel(way, toes, spot) - ball)
    if (np.abs(foot.ball - panel) <= room).all() and following is not None:  # a jack need not move
        ball = on_panel(ball + max(step.staying, wide) * (foot.ball - ball), toes, spot)
    return resolve_overlap(footing, foot, spot, ball, yaw, other)


def landing_ball(spot: Spot, yaw: float, other: Array, cut: float, edge_margin: float) -> Array:
    """Return the preferred landing place of the ball of a foot on a panel.

    Parameters
    ----------
    spot : the panel; yaw : of the toes; other : (2,) middle of the other foot
    cut : 0 for the centre of the panel, 1 for the edge nearest to the other foot (less `edge_margin`)
    """
    panel = spot.centre
    middle = panel.copy()
    away = other - panel
    distance = float(np.linalg.norm(away))
    if distance > 1e-6:
        direction = away / distance
        to_edge = HALF_PANEL / max(abs(direction[0]), abs(direction[1])) - edge_margin
        middle = panel + direction * min(cut * to_edge, distance)
    return on_panel(ball_of(middle, yaw), yaw, spot)


def resolve_overlap(
    footing: Footing, foot: FootState, spot: Spot, ball: Array, yaw: float, other: Pose
) -> tuple[Array, float]:
    """Return the place on the panel nearest to the wanted one, and the yaw, that leave room for the other shoe.

    At this place the legs do not cross farther than necessary.
    """
    step, air = footing.settings.step, footing.settings.mines.keep_off
    apart, still = step.apart, other.toes + foot.outward * footing.toe_out
    body = footing.turned_to((yaw, still) if foot.side == 0 else (still, yaw))
    toes = np.array([footing.toes(foot, yaw)])
    free = gaps_at(ball[None], toes, other.ball, other.toes)[0] >= apart
    crossed = legs_crossed(foot.outward, ball[None], toes, other, body, step)[0]
    if free and crossed <= 0.0 and not over(footing.mined, ball[None], toes, air)[0]:
        return ball, yaw
    balls = spot.centre + spot.room * PLACES * [foot.outward, 1.0]
    turned = np.array([footing.limit_yaw(yaw + foot.outward * turn, footing.body_yaw()) for turn in TURNS])
    grid, yaws = np.repeat(balls, len(turned), axis=0), np.tile(turned, len(balls))
    gaps = gaps_at(grid, yaws + foot.outward * footing.toe_out, other.ball, other.toes)
    price = np.sum((grid - ball) ** 2, axis=1) / step.place_off**2 + ((yaws - yaw) / np.radians(step.turn_off)) ** 2
    price += np.maximum(apart - gaps, 0.0) * 1e6
    price += CROSSED_PRICE * legs_crossed(
        foot.outward, grid, toes, other, body, step
    )  # whichever way the foot is turned
    price += MIDDLE_PRICE * off_the_middle(spot, grid, yaws + foot.outward * footing.toe_out)
    price += EDGE_PRICE * beyond_the_edge(footing.context.ground, grid)
    price += over(footing.mined, grid, yaws + foot.outward * footing.toe_out, air) * 1e4
    best = int(np.argmin(price))
    return grid[best], float(yaws[best])


def beyond_the_edge(ground: Ground, balls: Array) -> Array:
    """Return how much nearer (k,) balls (k, 2) are to the edge of the pad than half a shoe, metres. The part of a shoe
    beyond the edge carries nothing.
    """
    near = np.maximum(np.array(ground.low) + HALF_BALL - balls, balls - np.array(ground.high) + HALF_BALL)
    return np.asarray(np.maximum(near, 0.0).sum(axis=1))


def off_the_middle(spot: Spot, balls: Array, toes: Array) -> Array:
    """Return how far (k,) middles of shoes, balls (k, 2), toes (k,), are outside their allowed places, metres."""
    middles = balls - BALL_AHEAD * headings(toes)
    return np.asarray(np.maximum(np.abs(middles - spot.centre) - spot.middle_room, 0.0).sum(axis=1))


def legs_crossed(outward: float, balls: Array, toes: Array, other: Pose, body: float, step: StepSettings) -> Array:
    """Return by how much (k,) the legs cross too far, radians, if a foot stands at balls (k, 2) with toes (k,).

    outward : as in `FootState`; body : yaw of the hips
    """
    own = balls - (BALL_AHEAD + ANKLE) * headings(toes)
    line = outward * (own - (other.ball - (BALL_AHEAD + ANKLE) * headings(np.array(other.toes))))
    angle = np.arctan2(-line[:, 1], line[:, 0]) - body
    most = np.radians(step.cross - step.stand_cross)
    return np.asarray(np.maximum(np.abs((angle + np.pi) % (2 * np.pi) - np.pi) - most, 0.0))


def _bracket(footing: Footing, foot: FootState, goal: Goal) -> tuple[Array, float]:
    """Return the landing of a bracket: heel on one panel, toes on the other. A foot that lies across the body turns
    back a little, as far as the hips need.
    """
    step, body = footing.settings.step, footing.body_yaw()
    panels, parts, columns = footing.context.panels, goal.parts, goal.columns
    toe = next((c for c in columns if parts[c] == Part.TOE), None)
    heel = next((c for c in columns if parts[c] == Part.HEEL and c != toe), None)
    if heel is None:
        heel = next(c for c in columns if c != toe)
    toe = next(c for c in columns if c != heel)
    along = panels[toe] - panels[heel]
    toes = float(np.arctan2(along[0], along[1]))
    toes += 2 * np.pi * round((goal.yaw - toes) / (2 * np.pi))
    yaw, most = toes - foot.outward * footing.toe_out, np.radians(step.bracket_turn)
    askew = np.radians(step.bracket_askew)
    yaw += float(np.clip(np.clip(yaw, body - most, body + most) - yaw, -askew, askew))
    return ball_of((panels[toe] + panels[heel]) / 2, footing.toes(foot, yaw)), yaw


def step_height(far: float, land: float, context: Context) -> float:
    """Return how high a foot rises that has time, metres: higher if it goes farther, and no two steps are alike.

    far : metres that it goes; land : the second at which it lands, the seed of its own height
    """
    step = context.settings.step
    share = step.jack_height + (1.0 - step.jack_height) * min(far / max(step.height_goes, 1e-3), 1.0)
    own = _draw(round(1000 * land), *context.own)
    return step.height_slow * share * max(1.0 + step.height_varies * own, 0.0)


@lru_cache(maxsize=1024)
def _draw(*seed: int) -> float:
    return float(chance_of(HEIGHTS, *seed).uniform(-1.0, 1.0))


def heel_up(step: StepSettings, cut: float, heel: Heel, columns: list[int]) -> Pitches:
    """Return the pitches of a swing, radians: as toes leave, at most, landing, afterwards; only streams stay flat."""
    lift, most, land = heel.degrees
    rest = heel.rest * cut
    if len(columns) > 1:
        land = rest = 0.0  # heel and toes of a bracket land together
    out = np.radians(
        [
            lift * (1.0 - heel.flat[0] * cut),
            most * (1.0 - heel.flat[1] * cut**2),
            land + step.land_stream * rest,
            rest,
        ]
    )
    return float(out[0]), float(max(out[0], out[1])), float(max(out[2], out[3])), float(out[3])


def is_touching(a: Pose, b: Pose, apart: float) -> bool:
    """Whether the middle lines of two standing shoes are less than `apart` metres apart."""
    away = a.middle - b.middle
    if np.hypot(away[0], away[1]) > 2 * HALF_SHOE + apart + SURELY:
        return False
    return bool(gaps_at(a.ball[None], np.array([a.toes]), b.ball, b.toes)[0] < apart)


def swing_detour(
    footing: Footing, foot: FootState, span: tuple[float, float], target: Array, yaw: float, other: FootState
) -> Bulge:
    """Return the sideways detour of a swing, from lift to landing, around the other foot as planned so far."""
    step = footing.settings.step
    after = footing.turned_to((yaw, other.yaw) if foot.side == 0 else (other.yaw, yaw))
    even = float(evenness(span[1] - span[0], step))
    way = Way(foot.ball, footing.toes(foot), target, footing.toes(foot, yaw), (footing.faced, after), even)
    if max(other.landed, other.turned) <= span[0]:
        return detour(way, other.ball, footing.toes(other), step, foot.outward)
    times = span[0] + SHARES * (span[1] - span[0])
    return detour(way, *shoe_path(other.track(LATEST), times, footing.settings), step, foot.outward)
