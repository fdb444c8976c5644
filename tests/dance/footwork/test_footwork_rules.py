"""A rule proposes, only the planner applies: no rule changes a footing or a plan, and the planner asks each."""

from __future__ import annotations

import ast
from dataclasses import FrozenInstanceError, fields, is_dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from bake_plays import context, play

import dancetutor_cli.dance.footwork as room
from dancetutor_cli.dance.context import HALF_PANEL
from dancetutor_cli.dance.footwork import footing as footing_module
from dancetutor_cli.dance.footwork.footing import Evading, Footing, FootState, Proposal, Row, hold, pair, pressed_by
from dancetutor_cli.dance.footwork.mines import avoid_mines
from dancetutor_cli.dance.footwork.planner import NEWEST, Planner
from dancetutor_cli.dance.footwork.steps import jump, step
from dancetutor_cli.dance.plan import Gallop, Hover, Jump, Pivot, Step
from dancetutor_cli.dance.rig.body import SHOE_OUTLINE
from dancetutor_cli.feet.limbs import Limb

L, R = Limb.LEFT_FOOT, Limb.RIGHT_FOOT
FOLDER = Path(room.__file__).parent
APPLIES = {"planner.py", "insertion.py", "__init__.py"}
EVENTS = [(1.0, {0: L}), (1.4, {3: R}), (2.4, {0: L}), (2.5, {3: R}), (3.2, {1: L, 2: R}), (3.7, {3: R})]


def test_what_rules_are_given_cannot_be_changed() -> None:
    footing = Footing.at_home(context(), 0)
    for thing in (footing, footing.feet[0], Proposal(footing)):
        assert is_dataclass(thing)
        with pytest.raises(FrozenInstanceError):
            setattr(thing, fields(thing)[0].name, None)
    assert isinstance(footing.feet, tuple) and isinstance(footing.feet[0].moves, tuple)


def rule_files() -> list[Path]:
    return [path for path in sorted(FOLDER.glob("*.py")) if path.name not in APPLIES]


@pytest.mark.parametrize("path", rule_files(), ids=lambda path: path.stem)
def test_no_rule_changes_a_plan_or_what_belongs_to_others(path: Path) -> None:
    """No attribute but of its own memory is set, and no plan is made of another one."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        for target in targets:
            if isinstance(target, ast.Attribute):
                assert isinstance(target.value, ast.Name) and target.value.id == "self", ast.unparse(node)
        if isinstance(node, ast.Call):
            called = ast.unparse(node.func)
            assert called != "Plan" and not (called == "replace" and ast.unparse(node.args[0]) == "plan"), called


def test_the_same_footing_gets_the_same_proposal_again() -> None:
    danced = play(EVENTS)
    footing, own = Footing.at_home(context(), 0), context()
    for i in range(len(danced.rows)):
        row = Row(danced, own, i, float(danced.rows.second[i]), pressed_by(danced, i), 0.4)
        before = repr(footing)
        rule = jump if len(row.feet) == 2 else lambda row, on: step(row, row.feet[0], on)
        first, again = rule(row, footing), rule(row, footing)
        avoid_mines(row, footing)
        hold(footing, row.feet[0], 0, row.time, row.time + 1.0)
        assert repr(footing) == before
        assert repr(first) == repr(again)
        footing = first.footing


def test_a_foot_that_lies_across_a_panel_turns_to_make_room_for_one_that_stays_there() -> None:
    """Both on the left panel, whose outer edge is the pad's: all of the second shoe stands on the pad."""
    danced, own = play([(1.0, {0: R}), (3.0, {0: L})]), context()
    footing = Footing.at_home(own, 0)
    across = replace(footing.feet[1], ball=own.panels[0] + np.array([-0.041, 0.020]), yaw=np.radians(-55.0))
    footing = footing.with_foot(across)
    row = Row(danced, own, 1, 3.0, pressed_by(danced, 1), 0.5)
    left, right = step(row, 0, footing).footing.feet
    assert [type(move) for move in right.moves] == [Pivot]
    assert right.moves[0].land == 3.0
    assert np.degrees(abs(right.yaw)) <= own.settings.step.pivot_to + 1e-6
    toes = footing.toes(left)
    ahead, aside = np.array([np.sin(toes), np.cos(toes)]), np.array([np.cos(toes), -np.sin(toes)])
    outline = left.ball + SHOE_OUTLINE @ np.array([ahead, aside])
    assert (outline.max(axis=0) <= np.array(own.ground.high) + 0.005).all()
    assert (np.abs(left.ball - own.panels[0]) <= HALF_PANEL).all()


def test_a_foot_stays_as_it_is_for_one_that_goes_on_soon() -> None:
    danced, own = play([(1.0, {0: R}), (3.0, {0: L}), (3.25, {1: L})]), context()
    footing = Footing.at_home(own, 0)
    across = replace(footing.feet[1], ball=own.panels[0] + np.array([-0.041, 0.020]), yaw=np.radians(-55.0))
    row = Row(danced, own, 1, 3.0, pressed_by(danced, 1), 0.5)
    assert step(row, 0, footing.with_foot(across)).footing.feet[1].yaw == across.yaw


def test_a_foot_stays_up_from_its_mines_to_a_jump_where_the_other_one_was_up_between() -> None:
    """Mines under the right foot at 2.5 and 2.69, under the left one between: both cannot take off before 2.5."""
    danced, own = play([(1.0, {0: L}), (1.5, {3: R}), (2.78, {1: L, 2: R})]), context()
    left, right = Footing.at_home(own, 0).feet
    over = Hover(2.50, 2.69, pair(left.ball), 0.0, (0.1, 0.2, 0.0, 0.0), 0.06)
    left = left.with_move(over, left.ball, left.yaw)
    up = replace(over, lift=2.33, land=2.86, target=pair(right.ball))
    right = replace(right.with_move(up, right.ball, 0.0), evading=Evading(2.5, 2.69, right.ball, 0.0))
    footing = replace(Footing.at_home(own, 0), feet=(left, right))
    row = Row(danced, own, 2, 2.78, pressed_by(danced, 2), 0.5)
    stepped, stayed = (foot.moves[-1] for foot in jump(row, footing).footing.feet)
    assert isinstance(stepped, Jump) and stepped.lift > 2.69
    assert isinstance(stayed, Hover) and stayed.lift <= 2.5 - own.settings.mines.before
    assert (stayed.land, stayed.height) == (2.78, own.settings.mines.height)


@pytest.mark.parametrize(("after", "stood"), [(0.05, 0.02), (0.075, 0.045), (0.1, 0.045), (0.15, 0.045), (0.3, 0.18)])
def test_a_hop_over_mines_waits_until_legs_have_landed(after: float, stood: float) -> None:
    """Mines under both feet so many seconds after a jump: pushing off at once would take five times the weight."""
    danced = play([(1.0, {0: L, 3: R}), (1.0 + after, {})], mines={1: [0, 3]})
    plan = Planner(danced, lambda tick: tick / 48.0, context()).run()
    for track in plan.feet:
        landed, hop = track.moves[-2:]
        assert isinstance(hop, Jump) and landed.land == 1.0
        assert hop.lift - 1.0 == pytest.approx(stood, abs=1e-6)
        assert hop.lift <= 1.0 + after - context().settings.mines.push < hop.land


def test_each_rule_is_asked() -> None:
    """Steps, a gallop and a jump of one play are each there, from the planner that applied them."""
    danced = play(EVENTS)
    plan = Planner(danced, lambda tick: tick / 48.0, context()).run()
    kinds = {type(move) for track in plan.feet for move in track.moves}
    assert {Step, Gallop, Jump} <= kinds
    assert Hover not in kinds


def test_moves_that_are_put_aside_are_in_the_plan() -> None:
    """A long stream: rules see only the newest moves of a foot, the plan has all of them in order."""
    count = 12 * NEWEST
    danced = play([(1.0 + 0.3 * k, {(0, 3)[k % 2]: (L, R)[k % 2]}) for k in range(count)])
    planner = Planner(danced, lambda tick: tick / 48.0, context())
    plan = planner.run()
    assert all(len(foot.moves) <= 2 * NEWEST for foot in planner.footing.feet)
    for track in plan.feet:
        steps = [move.land for move in track.moves if isinstance(move, Step)]
        assert len(steps) == count // 2
        assert (np.diff(steps) > 0.5).all()
    whole = FootState.track(replace(planner.begin.feet[0], moves=plan.feet[0].moves))
    assert whole == plan.feet[0]
    assert footing_module.FREE_WINDOW > 0
