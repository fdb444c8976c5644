"""Palms on panels before, beside and behind her: arms, back and neck bend as people's do, the touch is on time."""

from __future__ import annotations

import numpy as np
import pytest
from bake_plays import LH, RH, Event, L, R, chart, pad, play

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import excess

UPPER = ("vl5", "vt10", "vt4", "vc4", "skullbase")
PLACES: dict[str, list[Event]] = {
    "before": [(2.0, {0: L, 3: R}), (4.0, {0: L, 3: R, 2: RH}), (6.0, {0: L})],
    "beside": [(2.0, {1: L, 3: R}), (4.0, {1: L, 3: R, 0: LH}), (6.0, {1: L})],
    "behind": [(2.0, {0: L, 3: R}), (4.0, {0: L, 3: R, 1: RH}), (6.0, {0: L})],
    "both": [(2.0, {1: L, 3: R}), (4.0, {1: L, 3: R, 0: LH, 2: RH}), (6.0, {1: L})],
}


@pytest.fixture(scope="module", params=list(PLACES))
def down(request: pytest.FixtureRequest) -> Motion:
    return bake(chart().timing, play(PLACES[request.param]), pad())


def test_arms_and_back_stay_within_their_limits(down: Motion) -> None:
    body = body_of(down)
    past = excess(down.skeleton, body.rotations)
    arms = [f"{side}_{joint}" for side in "lr" for joint in ("shoulder", "elbow", "radiocarpal")]
    assert {name: past[name].max().round(1) for name in (*UPPER, *arms) if past[name].max() > 1.0} == {}


def test_the_palm_is_on_time_and_nothing_is_in_the_torso(down: Motion) -> None:
    measured = report(down)
    assert measured["contact error"].is_met and measured["contacts missed"].is_met and measured["limb in torso"].is_met


def test_she_looks_at_a_panel_that_her_hand_is_on() -> None:
    """Down and ahead, not at the screen."""
    motion = bake(chart().timing, play(PLACES["before"]), pad())
    _, world = world_transforms(motion.skeleton, *sample(motion, np.array([4.0])))
    face = quat.rotate(world[0, motion.skeleton.index("skullbase")], np.array([0.0, 0.0, 1.0]))
    assert -85.0 < np.degrees(np.arcsin(face[1])) < -50.0 and face[2] > 0.0
