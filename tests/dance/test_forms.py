"""--form: where feet land, how they are turned and how far the body turns; the notes are met all the same."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import module_file
import numpy as np
import pytest
from dance_requests import baked

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.footwork.turning import passing_turn
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.settings import USUAL, default_settings, load_settings
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.reading import charts_path, config_names, config_path
from dancetutor_cli.run.yaml_files import read

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"
tool = module_file.tool("figures_forms")  # the measures of the table in docs/films.md
FORMS = ("usual", "middle", "edge", "heels-in", "heels-out", "screen", "turning")


def danced(form: str) -> Motion:
    return baked(DanceRequest(DEMO, Selection(index=3), form=form), "16:21.3")


@pytest.fixture(scope="module")
def motions() -> dict[str, Motion]:
    return {form: danced(form) for form in FORMS}


def test_the_forms_are_these_and_each_changes_something() -> None:
    assert set(config_names("forms")) == set(FORMS)
    usual = default_settings()
    assert all((load_settings(None, form) == usual) == (form == USUAL) for form in FORMS)


def test_usual_says_what_motion_yaml_says() -> None:
    said, whole = read(config_path("forms/usual.yaml")).data, read(config_path("motion.yaml")).data
    assert all(whole[section][name] == value for section, numbers in said.items() for name, value in numbers.items())
    changed = {
        (section, name)
        for form in FORMS
        for section, numbers in read(config_path(f"forms/{form}.yaml")).data.items()
        for name in numbers
    }
    assert changed == {(section, name) for section, numbers in said.items() for name in numbers}


def test_toes_land_on_the_middle_or_the_edge(motions: dict[str, Motion]) -> None:
    middle, usual, edge = (tool.landed(motions[form])[0] for form in ("middle", "usual", "edge"))
    assert middle < usual - 0.01 and usual < edge - 0.01


def test_heels_are_in_or_out(motions: dict[str, Motion]) -> None:
    out = {form: tool.landed(motions[form])[1] for form in ("heels-out", "usual", "heels-in")}
    assert out["heels-out"] < out["usual"] - 5 and out["usual"] < out["heels-in"] - 8


def test_she_faces_the_screen_or_turns(motions: dict[str, Motion]) -> None:
    screen, usual, turning = (tool.body_turn(motions[form]) for form in ("screen", "usual", "turning"))
    assert screen < usual - 1 and usual < turning - 1


@pytest.mark.parametrize("form", FORMS)
def test_every_note_is_met_whatever_the_form(motions: dict[str, Motion], form: str) -> None:
    measured = report(motions[form])
    assert all(measured[name].is_met for name in ("contact error", "contacts missed", "plant slide"))


def test_a_form_of_ones_own_and_motion_on_top(tmp_path: Path) -> None:
    mine, numbers = tmp_path / "mine.yaml", tmp_path / "numbers.yaml"
    mine.write_text("step: {toe_out: 15, edge: 0.5}\n")
    numbers.write_text("step: {toe_out: 3}\n")
    assert load_settings(None, str(mine)).step.toe_out == 15
    both = load_settings(numbers, str(mine)).step
    assert (both.toe_out, both.edge) == (3, 0.5)
    with pytest.raises(UsageError, match=r"no form 'edgy' \(did you mean edge\?\); choose edge, heels-in"):
        load_settings(None, "edgy")
    mine.write_text("step: {toes: 15}\n")
    with pytest.raises(FileError, match=":1: unknown key 'toes' in 'step'"):
        load_settings(None, str(mine))


# In doubles a foot steps in line over the other one, to the right and to the left: either way is as far.
CROSSWISE = """#TITLE:Crosswise;
#OFFSET:0;
#BPMS:0=140;
#NOTES:dance-double::Hard:5::
10000000\n00010000\n00001000\n00000001\n,
00001000\n00010000\n10000000\n00010000\n,
00001000\n00000001\n00001000\n00010000
;
"""


def passings(motion: Motion) -> list[str]:
    """On which side of the standing foot, as the screen has it, each foot passes it that comes down beyond it."""
    out = []
    for k, press in enumerate(motion.contacts):
        own = [one for one in motion.contacts[:k] if one.limb == press.limb]
        other = [one for one in motion.contacts[:k] if one.limb != press.limb]
        if not own or not other:
            continue
        stands = other[-1].panel[0]
        if (own[-1].panel[0] - stands) * (press.panel[0] - stands) >= 0:
            continue
        since = max(own[-1].start, other[-1].start)  # before, the other foot was under way and passed this one
        rotations, root = sample(motion, np.linspace(since, press.start, 80))
        places, _ = world_transforms(motion.skeleton, rotations, root)
        balls = [places[:, motion.skeleton.index(f"{'lr'[side]}_metatarsal")] for side in (press.limb, 1 - press.limb)]
        beside = int(np.argmin(np.abs(balls[0][:, 0] - balls[1][:, 0])))
        out.append("in front" if balls[0][beside, 2] > balls[1][beside, 2] else "behind")
    return out


def test_a_form_chooses_the_side_on_which_a_foot_passes_the_other(tmp_path: Path) -> None:
    """And no foot changes: every note is met by the foot that has it anyway, where the goals of motion are met, too."""
    path = tmp_path / "crosswise.sm"
    path.write_text(CROSSWISE)
    motions = {}
    for form in ("usual", "screen", "turning"):
        motions[form] = baked(DanceRequest(path, Selection(), form=form))
    assert passings(motions["screen"]) == ["in front"] * 7
    assert passings(motions["turning"]) == ["behind"] * 7
    assert set(passings(motions["usual"])) == {"in front", "behind"}
    steps = [[(c.start, c.limb, c.column) for c in motion.contacts] for motion in motions.values()]
    assert steps[0] == steps[1] == steps[2]
    for motion in motions.values():
        figures = {one.name: one.value for one in report(motion).figures}
        assert figures["contact error"] < 1.0 and figures["foot in foot"] == 0.0 and figures["limb in torso"] < 0.1


@pytest.mark.parametrize(
    ("turn", "normal", "foot", "seconds", "front", "behind"),
    [
        (-180.0, 0.0, 0, 0.3, -180.0, 180.0),  # a left foot in front turns her to the right
        (180.0, 0.0, 1, 0.3, 180.0, -180.0),  # and a right one to the left: as in a mirror
        (180.0, -180.0, 0, 0.3, 180.0, -180.0),  # back the way it came
        (-135.0, 0.0, 0, 0.9, -135.0, 225.0),  # the longer way round takes its time
        (-135.0, 0.0, 0, 0.5, -135.0, -135.0),
        (-90.0, 0.0, 0, 5.0, -90.0, -90.0),  # panels decide: one foot stands in front of the other
    ],
)
def test_where_a_foot_can_pass_either_way(
    turn: float, normal: float, foot: int, seconds: float, front: float, behind: float
) -> None:
    step = default_settings().step
    assert passing_turn(turn, normal, foot, seconds, step) == turn
    assert passing_turn(turn, normal, foot, seconds, replace(step, crossing=1.0)) == front
    assert passing_turn(turn, normal, foot, seconds, replace(step, crossing=2.0)) == behind
