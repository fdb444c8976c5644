"""The styles on a baked dance: apart from each other, and as exact as neutral where a dance game looks."""

from dataclasses import dataclass, replace
from itertools import combinations

import bake_plays as plays
import numpy as np
import pytest
from bake_mirror import mirrored_motion

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.bake import bake_piece
from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.physics.blend import Blend
from dancetutor_cli.dance.physics.pipeline import RagdollOptions, through_ragdoll
from dancetutor_cli.dance.physics.style import load_style
from dancetutor_cli.dance.pieces import MORE_PLANNED, RagdollStyle, Span, piece_of
from dancetutor_cli.dance.plan import Plan
from dancetutor_cli.dance.quality.figures import MotionReport
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.run.reading import charts_path, config_names

APART = 0.02  # metres of mean joint distance between any two
FACE = (
    "braid",
    "l_eye",
    "r_eye",
    "temporo",
    *(f"{s}_{n}" for s in "lr" for n in ("metacarpo", "carpal")),
)  # and fingers


@dataclass(frozen=True)
class Passage:
    """Some seconds of a dance, which can be danced in any style."""

    plan: Plan
    context: Context
    span: Span

    def motion(self, style: str | None = None) -> Motion:
        """Baked as a piece of its own: the ragdoll need not follow her through the whole song."""
        ragdoll = None if style is None else RagdollStyle(Blend.of(load_style(style)), RagdollOptions())
        return bake_piece(piece_of(self.plan, self.context, 60.0, (self.span, self.span, MORE_PLANNED), ragdoll)).motion


def by_hand(events: list[plays.Event]) -> Passage:
    plan, context = plan_dance(plays.chart().timing, plays.play(events), plays.pad())
    return Passage(plan, context, (0.6, 4.0))


def of_the_demo(difficulty: str, start: float, end: float, bar: bool = False) -> Passage:
    path = charts_path() / "two_left_feet" / "two_left_feet.ssc"
    request = DanceRequest(path, Selection("dance-single", difficulty), bar=bar)
    (dancer,) = perform(solve(request), request).dancers
    return Passage(dancer.plan, dancer.context, (start, end))


@pytest.fixture(scope="module")
def danced() -> dict[str, Motion]:
    turns = (0, 3, 1, 2, 0, 3, 2, 1, 0, 3)
    events = [(1.0 + 0.3 * k, {c: (plays.L, plays.R)[k % 2]}) for k, c in enumerate(turns)]
    return {name: by_hand(events).motion(name) for name in config_names("styles")}


@pytest.fixture(scope="module")
def hard() -> Passage:
    """Two and a half of the demo's hardest seconds: a step every eighth of a second, with half turns."""
    return of_the_demo("challenge", 17.0, 19.5)


@pytest.fixture(scope="module")
def reports(danced: dict[str, Motion]) -> dict[str, MotionReport]:
    return {name: report(motion) for name, motion in danced.items()}


def test_there_are_the_five_of_the_thesis_and_its_input() -> None:
    assert config_names("styles") == ["feminine", "fierce", "heavy", "lazy", "neutral"]


def test_any_two_styles_are_apart(danced: dict[str, Motion]) -> None:
    places = {}
    for name, motion in danced.items():
        shown = [k for k, n in enumerate(motion.skeleton.names) if not n.startswith(FACE)]
        places[name] = world_transforms(motion.skeleton, motion.rotations, motion.root)[0][:, shown]
    apart = {(a, b): np.linalg.norm(places[a] - places[b], axis=2).mean() for a, b in combinations(places, 2)}
    assert min(apart.values()) >= APART, apart


@pytest.mark.parametrize("name", config_names("styles"))
def test_contacts_feet_limits_and_limbs_are_as_good_as_without(reports: dict[str, MotionReport], name: str) -> None:
    figures = ("contact error", "contacts missed", "plant slide", "penetration", "frames past joint limits")
    overlaps = ("limb in torso", "foot in foot", "leg in leg", "arm in arm", "arm in leg", "hair in back")
    for figure in (*figures, *overlaps):
        assert reports[name][figure].is_met, (name, reports[name][figure])


@pytest.mark.parametrize("name", config_names("styles"))
def test_she_neither_falls_nor_jerks_nor_floats_in_any_style(reports: dict[str, MotionReport], name: str) -> None:
    jerks = tuple(f"jerk of the {part}" for part in ("root", "left hand", "right hand", "head"))
    for figure in ("balance", "knee angle", "residual force, median", *jerks):
        assert reports[name][figure].is_met, (name, reports[name][figure])


@pytest.mark.parametrize("name", config_names("styles"))
def test_in_the_hardest_passage_arms_neither_whip_nor_go_through_her(hard: Passage, name: str) -> None:
    plain, made = report(hard.motion()), report(hard.motion(name))
    for figure in ("contact error", "contacts missed", "plant slide", "penetration", "frames past joint limits"):
        assert made[figure].is_met, made[figure]
    for figure in ("limb in torso", "arm in arm", "arm in leg", "leg in leg"):
        assert made[figure].value <= plain[figure].value, made[figure]
    for side in ("left", "right"):  # it was 2.6 times the jerk: arms no longer made up for what the trunk did
        assert made[f"jerk of the {side} hand"].value < 1.7 * plain[f"jerk of the {side} hand"].value
    assert made["wrist speed"].value < 1.4 * plain["wrist speed"].value


def test_arms_that_a_style_sends_through_her_go_back(hard: Passage) -> None:
    """A style whose forces press both arms into the trunk."""
    style = load_style("lazy")
    pressing = replace(style, force={**style.force, "arms": (-120.0, 0.0, -60.0), "hands": (-60.0, 0.0, -30.0)})
    made = report(through_ragdoll(hard.motion(), Blend.of(pressing)).motion)
    assert made["limb in torso"].is_met and made["arm in arm"].is_met and made["arm in leg"].is_met


@pytest.mark.parametrize("name", ["fierce", "lazy"])
def test_hands_stay_on_the_bar(name: str) -> None:
    passage = of_the_demo("hard", 8.0, 11.0, bar=True)
    plain, motion = passage.motion(), passage.motion(name)
    assert plain.grips and max(g.end for g in plain.grips) > 9.0
    made, head = report(motion), motion.skeleton.index("skullbase")
    for figure in ("palm off the bar", "frames past joint limits", "limb in torso", "contact error", "plant slide"):
        assert made[figure].is_met, made[figure]
    places = [world_transforms(m.skeleton, m.rotations, m.root)[0][:, head] for m in (plain, motion)]
    assert np.linalg.norm(places[0] - places[1], axis=1).mean() > 0.01, "and the style is seen"


def test_palms_press_their_panels_on_time_in_every_style() -> None:
    events = [
        (1.0, {0: plays.L}),
        (1.5, {3: plays.R}),
        (2.5, {0: plays.L, 3: plays.R, 1: plays.LH}),
        (3.5, {0: plays.L}),
    ]
    for name in config_names("styles"):
        measured = report(by_hand(events).motion(name))
        assert measured["contact error"].is_met and measured["contacts missed"].is_met, name


@pytest.mark.parametrize("name", ["fierce", "feminine"])
def test_the_mirror_image_of_a_motion_is_styled_to_the_mirror_image(danced: dict[str, Motion], name: str) -> None:
    """Forces outward, springs and limits have no side."""
    plain, style = danced["neutral"], load_style(name)
    here, there = (through_ragdoll(m, Blend.of(style)).motion for m in (plain, mirrored_motion(plain)))
    shown = [k for k, n in enumerate(plain.skeleton.names) if not n.startswith(FACE)]
    a, b = (world_transforms(m.skeleton, m.rotations, m.root)[0] for m in (here, mirrored_motion(there)))
    assert 1000 * np.abs(a - b)[:, shown].max() < 1.0, "millimetres"
