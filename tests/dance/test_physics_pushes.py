"""Pushed and tripped: she gives way, takes the notes or says which she misses, and stands as before within a second."""

import bake_plays as plays
import numpy as np
import pytest

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.physics.blend import Blend
from dancetutor_cli.dance.physics.pipeline import RagdollOptions, through_ragdoll
from dancetutor_cli.dance.physics.pushes import Push, Stumble, parse_push
from dancetutor_cli.dance.physics.style import load_style
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.run.errors import UsageError

NEUTRAL = Blend.of(load_style("neutral"))
WHEN = 1.72


@pytest.fixture(scope="module")
def plain() -> Motion:
    turns = (0, 3, 1, 2, 0, 3, 2, 1)
    events = [(1.0 + 0.3 * k, {c: (plays.L, plays.R)[k % 2]}) for k, c in enumerate(turns)]
    return bake(plays.chart().timing, plays.play(events), plays.pad(), section=(0.6, 3.6))


@pytest.fixture(scope="module")
def undisturbed(plain: Motion) -> Motion:
    return through_ragdoll(plain, NEUTRAL).motion


def apart(one: Motion, other: Motion, joint: str) -> np.ndarray:
    """Metres (f,) between a joint of two motions."""
    k = one.skeleton.index(joint)
    first, second = (world_transforms(m.skeleton, m.rotations, m.root)[0][:, k] for m in (one, other))
    return np.asarray(np.linalg.norm(first - second, axis=1))


@pytest.mark.parametrize("degrees", [0.0, 90.0, 180.0])
def test_300_newtons_move_her_and_she_takes_every_note(plain: Motion, undisturbed: Motion, degrees: float) -> None:
    made = through_ragdoll(plain, NEUTRAL, RagdollOptions(pushes=(Push(WHEN, 300.0, degrees),))).motion
    away = apart(made, undisturbed, "skullbase")
    assert away.max() >= 0.05, "she gives way"
    assert away[made.times < WHEN - 0.04].max() < 0.005, "not before"
    assert away[made.times > WHEN + 1.0].max() < 0.005, "and stands as before"
    measured = report(made)
    for name in ("contact error", "contacts missed", "plant slide", "penetration", "frames past joint limits"):
        assert measured[name].is_met, measured[name]
    assert len(made.contacts) == len(plain.contacts)
    assert made.notes[-1].startswith("pushed at 1.720 s with 300 N: the hips move by ")
    assert made.notes[-1].endswith("; no note is missed")


def test_a_push_to_her_left_moves_her_to_her_left(plain: Motion, undisturbed: Motion) -> None:
    left, right = (
        through_ragdoll(plain, NEUTRAL, RagdollOptions(pushes=(Push(WHEN, 380.0, d),))).motion.root - undisturbed.root
        for d in (90.0, 270.0)
    )
    assert left[:, 0].max() > 0.04 > left[:, 0].min() + 0.03 and right[:, 0].min() < -0.04


def test_nobody_stands_a_shove_of_1500_newtons_and_the_notes_missed_are_named(plain: Motion) -> None:
    made = through_ragdoll(plain, NEUTRAL, RagdollOptions(pushes=(Push(WHEN, 1500.0, 270.0),))).motion
    missed = [c for c in plain.contacts if WHEN <= c.start < WHEN + 0.8]
    assert len(made.contacts) == len(plain.contacts) - len(missed) < len(plain.contacts)
    for contact in missed:
        assert f"{contact.start:.3f} s column {contact.column} (" in made.notes[-1]
    measured = report(made)
    assert measured["contact error"].is_met and measured["contacts missed"].is_met, "of those that she takes"
    assert measured["frames past joint limits"].is_met


def test_a_held_note_that_a_shove_makes_her_leave_is_missed_and_named() -> None:
    """Her weight is over the foot that holds, so the push goes to the other side than that foot: it has to leave."""
    events = [(1.0, {0: plays.L}), (1.3, {3: plays.R}), (3.2, {1: plays.L})]
    play = plays.play(events, holds={(0, 0): 2.9})
    held = bake(plays.chart().timing, play, plays.pad(), section=(0.6, 3.8))
    made = through_ragdoll(held, NEUTRAL, RagdollOptions(pushes=(Push(WHEN, 1200.0, 90.0),))).motion
    assert "missed: 1.000 s column 0 (left foot, held)" in made.notes[-1]
    assert report(held)["contacts missed"].value == 0 and report(made)["contacts missed"].value == 1
    light = through_ragdoll(held, NEUTRAL, RagdollOptions(pushes=(Push(WHEN, 200.0, 270.0),))).motion
    assert light.notes[-1].endswith("; no note is missed") and report(light)["contacts missed"].value == 0


def test_a_caught_foot_is_late_and_she_pitches_ahead(plain: Motion, undisturbed: Motion) -> None:
    made = through_ragdoll(plain, NEUTRAL, RagdollOptions(stumbles=(Stumble(WHEN),))).motion
    assert apart(made, undisturbed, "skullbase").max() >= 0.05
    feet = [apart(made, undisturbed, f"{s}_talocrural") for s in "lr"]
    assert max(f.max() for f in feet) > 0.03 and min(f.max() for f in feet) < 0.003, "one foot"
    assert max(f[made.times > WHEN + 1.0].max() for f in feet) < 0.001
    assert "foot is caught; missed: " in made.notes[-1]
    assert report(made)["contact error"].is_met and report(made)["penetration"].is_met


def test_two_runs_give_the_same_bytes(plain: Motion) -> None:
    runs = [through_ragdoll(plain, NEUTRAL, RagdollOptions(pushes=(Push(WHEN, 400.0, 45.0),))).motion for _ in range(2)]
    assert runs[0].rotations.tobytes() == runs[1].rotations.tobytes()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("12:300", "write TIME:FORCE:DIRECTION, for example 12.5:300:left"),
        ("x:300:left", "the time 'x' is not a number"),
        ("nan:300:left", "the time 'nan' is not a number"),
        ("12:0:left", "the force must be more than 0 and at most 3000 newtons"),
        ("12:300:lef", r"no direction 'lef' \(did you mean left\?\); choose ahead, left, back, right, or degrees"),
        ("12:300:400", "the direction must be at most 360 degrees"),
        ("12:300:nan", "the direction must be at most 360 degrees"),
    ],
)
def test_a_push_that_is_none_is_reported_in_one_line(text: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        parse_push(text)


def test_pushes_outside_of_the_motion_are_refused(plain: Motion) -> None:
    assert parse_push("12.5:300:Back") == Push(12.5, 300.0, 180.0) and parse_push("1:2:-45").degrees == -45
    with pytest.raises(UsageError, match=r"--push 9: give a time within the motion, 0\.600 s to 3\.600 s"):
        through_ragdoll(plain, NEUTRAL, RagdollOptions(pushes=(Push(9.0, 300.0, 0.0),)))
    with pytest.raises(UsageError, match=r"--trip 3\.59: no foot is in the air after that"):
        through_ragdoll(plain, NEUTRAL, RagdollOptions(stumbles=(Stumble(3.59),)))
