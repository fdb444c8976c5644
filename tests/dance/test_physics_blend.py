"""Blends of styles and styles that change by measures: what is read, and what is danced."""

from dataclasses import replace
from functools import cache
from itertools import combinations
from pathlib import Path

import bake_plays as plays
import numpy as np
import pytest

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.bake import bake_plan
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.motion import Distances, Motion, sample
from dancetutor_cli.dance.physics.blend import Blend, load_choice, mean_distances
from dancetutor_cli.dance.physics.pipeline import RagdollOptions, through_ragdoll
from dancetutor_cli.dance.physics.style import load_style
from dancetutor_cli.dance.pieces import Piece, RagdollStyle, bake_section, in_turn, pieces_of
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import place, sole_points, world_transforms
from dancetutor_cli.dance.settings import SettingsCourse, default_settings, load_settings, state_weights
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.reading import charts_path, config_names
from dancetutor_cli.run.stored_files import fingerprint

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"
LEGS = tuple(f"{s}_{n}" for s in "lr" for n in ("knee", "talocrural", "metatarsal"))


def written(folder: Path, text: str, name: str = "song.yaml") -> str:
    path = folder / name
    path.write_text(text)
    return str(path)


# What is read.


def test_what_weights_leave_is_neutral() -> None:
    choice = load_choice("fierce:0.5,heavy:0.25")
    assert [style.name for style in choice.styles] == ["fierce", "heavy", "neutral"]
    assert choice.states == ((0.5, 0.25, 0.25),) and load_choice("fierce:1").states == ((1.0,),)
    assert [style.name for style in load_choice("lazy").styles] == ["lazy"]
    assert sum(load_choice("fierce:0.333333,heavy:0.333333,lazy:0.333334").states[0]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("fierce,heavy", r"style 'fierce,heavy': give each style a weight, such as fierce:0\.6,heavy:0\.4"),
        ("fierce:0.9,heavy:0.4", r"the weights sum to 1\.3; they may sum to 1 at most, and what is missing is neutral"),
        ("fierce:0,heavy:1", r"a weight must be a number above 0, at most 1, not '0'"),
        ("fierce:nan", r"a weight must be a number above 0, at most 1, not 'nan'"),
        ("fierce:much,heavy:0.4", r"a weight must be a number above 0, at most 1, not 'much'"),
        ("fierce:0.5,fierce:0.5", r"names one style twice"),
        ("fierse:0.5,heavy:0.5", r"there is no style 'fierse' \(did you mean fierce\?\)"),
    ],
)
def test_a_wrong_blend_is_reported_in_a_line(text: str, said: str) -> None:
    with pytest.raises(UsageError, match=said) as error:
        load_choice(text)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("measures: {4: fierce,\n  8: fierse}\n", r"song\.yaml:2: measures\.8: there is no style 'fierse'"),
        ("measures:\n  4: fierce:2\n", r":2: measures\.4: style 'fierce:2': a weight must be a number above 0"),
        ("measures:\n  four: fierce\n", r":2: measures\.four must be a whole number from 0 to 100000, not 'four'"),
        ("measures:\n  -1: fierce\n", r":2: measures\.-1 must be a whole number from 0"),
        ("measures: [fierce]\n", r":1: measures must be a mapping of names to values"),
        ("motion: {step: {height_slo: 0.1}}\n", r":1: unknown key 'height_slo' in 'motion\.step'"),
        ("motion:\n  step:\n    toe_out: 999\n", r":3: motion\.step\.toe_out must be a number from 0 to 360 degrees"),
    ],
)
def test_a_wrong_style_file_is_reported_with_its_line(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(FileError, match=said) as error:
        load_choice(written(tmp_path, text))
    assert "\n" not in str(error.value)


def test_a_file_that_changes_is_neither_blended_nor_named_in_another_one(tmp_path: Path) -> None:
    changing = written(tmp_path, "measures: {4: fierce}\n")
    with pytest.raises(UsageError, match="song changes by measures and cannot be blended"):
        load_choice(f"{changing}:0.5,heavy:0.5")
    with pytest.raises(FileError, match=r"two\.yaml:1: measures\.8: style song changes by measures itself"):
        load_choice(written(tmp_path, "measures: {8: song.yaml}\n", "two.yaml"))
    with pytest.raises(UsageError, match="captured motion has none"):
        load_choice(changing).blend()


def test_measures_name_files_beside_theirs_and_begin_with_the_file_itself(tmp_path: Path) -> None:
    written(tmp_path, "body: {gravity: 1}\n", "mine.yaml")
    choice = load_choice(written(tmp_path, "body: {gravity: 3}\nmeasures: {2: mine.yaml, 5: 'lazy:0.5'}\n"))
    assert [style.name for style in choice.styles] == ["song", "mine", "lazy", "neutral"]
    assert choice.states == ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 0.5, 0.5)) and choice.measures == (2, 5)
    changes = choice.blend(plays.chart().timing).changes
    assert changes == ((2.0, 4.0), (8.0, 10.0)), "a measure of two seconds each, complete where the file says"


@pytest.mark.parametrize("other", ["../mine.yaml", "{outside}/mine.yaml", "lazy:0.5,../mine.yaml:0.5"])
def test_measures_name_no_file_outside_the_folder_of_theirs(tmp_path: Path, other: str) -> None:
    """A style file may be a stranger's: what lies elsewhere is not opened, so nothing of it is in a message."""
    written(tmp_path, "secret: 1\n", "mine.yaml")
    inside = tmp_path / "inside"
    inside.mkdir()
    text = written(inside, f"measures: {{2: '{other.format(outside=tmp_path)}'}}\n")
    with pytest.raises(FileError, match=r"is outside the folder of the style file; put it beside it") as error:
        load_choice(text)
    assert error.value.line == 1 and "secret" not in str(error.value)


def test_measures_name_no_file_of_the_working_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written(tmp_path, "body: {gravity: 1}\n", "mine.yaml")
    (tmp_path / "styles").mkdir()
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileError, match=r"mine\.yaml"):
        load_choice(written(tmp_path / "styles", "measures: {2: mine.yaml}\n"))


def test_signs_of_a_blend_in_the_name_of_a_file(tmp_path: Path) -> None:
    written(tmp_path, "body: {gravity: 1}\n", "a,b.yaml")
    path = written(tmp_path, "measures: {2: 'a,b.yaml'}\n")
    assert [style.name for style in load_choice(path).styles] == ["song", "a,b"]
    assert load_choice(f"{path}:1").measures == (2,)


def test_a_result_is_kept_by_what_the_files_say(tmp_path: Path) -> None:
    request = DanceRequest(DEMO, Selection())
    other = written(tmp_path, "body: {gravity: 1}\n", "mine.yaml")
    texts = ["lazy", "fierce:0.6,heavy:0.4", "fierce:0.4,heavy:0.6", other, f"{other}:0.5,lazy:0.5"]
    texts.append(written(tmp_path, "measures: {2: mine.yaml}\n"))
    before = [fingerprint(replace(request, style=text)) for text in texts]
    assert len(set(before)) == len(texts)
    load_style.cache_clear(), load_choice.cache_clear()
    written(tmp_path, "body: {gravity: 2}\n", "mine.yaml")
    after = [fingerprint(replace(request, style=text)) for text in texts]
    assert [a == b for a, b in zip(before, after, strict=True)] == [True, True, True, False, False, False]


# What is danced.


def test_numbers_of_a_style_come_between_the_form_and_the_users_file(tmp_path: Path) -> None:
    numbers = tmp_path / "numbers.yaml"
    numbers.write_text("step: {height_slow: 0.12}\n")
    heavy, usual = load_style("heavy").motion.step, default_settings().step
    of_form = load_settings(None, "heels-out").step
    assert of_form.toe_out != heavy.toe_out != usual.toe_out
    blend = Blend.of(load_style("heavy"))
    both = blend.settings(numbers, "heels-out")
    assert both.step.toe_out == heavy.toe_out and both.step.height_slow == 0.12  # type: ignore[union-attr]
    half = load_choice("heavy:0.5").blend().settings(None, "usual")
    assert half.step.toe_out == pytest.approx((heavy.toe_out + usual.toe_out) / 2)  # type: ignore[union-attr]
    assert blend.settings(None, "edge").step.edge == 1.0, "what it leaves out is the form's"  # type: ignore[union-attr]


def test_a_blend_is_between_its_styles() -> None:
    turns = (0, 3, 1, 2, 0, 3, 2, 1)
    events = [(1.0 + 0.4 * k, {c: (plays.L, plays.R)[k % 2]}) for k, c in enumerate(turns)]
    plan, context = plan_dance(plays.chart().timing, plays.play(events), plays.pad())
    given = bake_plan(plan, context, 60.0)
    lazy, fierce = load_style("lazy"), load_style("fierce")
    both = Blend((lazy, fierce), ((0.5, 0.5),))
    made = [through_ragdoll(given, one).motion for one in (Blend.of(lazy), both, Blend.of(fierce))]
    hand = given.skeleton.index("l_radiocarpal")
    places = [world_transforms(m.skeleton, m.rotations, m.root)[0][:, hand] - m.root for m in made]
    apart = [float(np.linalg.norm(a - b, axis=1).mean()) for a, b in combinations(places, 2)]
    assert apart[0] < 0.75 * apart[1] > apart[2] and min(apart) > 0.01
    assert report(made[1])["contact error"].is_met and report(made[1])["limb in torso"].is_met


def _soles(motion: Motion, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    placed = world_transforms(motion.skeleton, *sample(motion, times))
    legs = placed[0][:, [motion.skeleton.index(name) for name in LEGS]]
    return np.stack([place(points, *placed) for points in sole_points(motion.skeleton)], axis=1), legs


def of(style: str) -> Motion:
    """Twelve seconds, six measures of the chart by hand: steps at several paces, and a jump in each measure."""
    return danced(style, (0.0, 13.0))


@cache
def danced(style: str, span: tuple[float, float]) -> Motion:
    return bake_section(pieces_in(style), span, in_turn).motion


def pieces_in(style: str) -> list[Piece]:
    timing = plays.chart().timing
    turns, seconds = (0, 3, 1, 2), [0.5, 1.0, 1.4, 1.7]
    events = [
        (2 * m + at, {turns[(k + m) % 4]: (plays.L, plays.R)[k % 2]}) for m in range(6) for k, at in enumerate(seconds)
    ]
    events += [(2 * m + 2.1, {0: plays.L, 3: plays.R}) for m in range(6)]
    blend = load_choice(style).blend(timing)
    manner = {"settings": blend.settings(None, "usual")}
    plan, context = plan_dance(timing, plays.play(sorted(events, key=lambda e: e[0])), plays.pad(), **manner)  # type: ignore[arg-type]
    return list(pieces_of(plan, context, 60.0, RagdollStyle(blend, RagdollOptions())))


@pytest.fixture(scope="module")
def changing(tmp_path_factory: pytest.TempPathFactory) -> str:
    return written(tmp_path_factory.mktemp("styles"), "measures: {0: lazy, 3: fierce, 5: 'fierce:0.5,heavy:0.5'}\n")


def test_a_song_begins_in_one_style_and_goes_on_in_another(changing: str) -> None:
    """Before and after a change she dances as in the style alone, to a centimetre or two: she has come otherwise."""
    for style, (start, end) in (("lazy", (1.0, 3.8)), ("fierce", (6.2, 7.8))):
        times = np.arange(start, end, 1 / 60)
        (soles, legs), (others, other_legs) = (_soles(of(text), times) for text in (changing, style))
        assert np.abs(soles - others).mean() < 0.02 and np.abs(legs - other_legs).mean() < 0.02, style
        lifts = [s[..., 1].min(axis=2).max() for s in (soles, others)]
        assert lifts[0] == pytest.approx(lifts[1], abs=0.01), "feet are lifted as in the style alone"


def test_nothing_jumps_where_styles_change(changing: str) -> None:
    measured, plain = report(of(changing)), [report(of(name)) for name in ("lazy", "fierce", "heavy")]
    for figure in ("contact error", "contacts missed", "plant slide", "penetration", "frames past joint limits",
                   "flight residual", "leg in leg", "foot in foot", "limb in torso"):  # fmt: skip
        assert measured[figure].is_met, (figure, measured[figure])
    for part in ("root", "left hand", "right hand", "head"):
        worst = max(one[f"jerk of the {part}"].value for one in plain)
        assert measured[f"jerk of the {part}"].value < 1.2 * worst, part


def test_a_cut_is_a_part_of_the_whole_dance_that_changes(changing: str) -> None:
    times = np.arange(5.0, 8.0, 0.01)
    whole, part = (_soles(m, times) for m in (of(changing), danced(changing, (4.5, 8.5))))
    assert np.abs(whole[0] - part[0]).max() < 1e-6 and np.abs(whole[1] - part[1]).max() < 1e-6


def test_a_change_in_a_later_piece_is_danced_as_in_one(changing: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces of a few seconds, with changes at their joints: within a millimetre of one piece."""
    times = np.arange(0.5, 12.5, 0.01)
    whole = _soles(of(changing), times)
    for name, seconds in (("LONGEST", 6.0), ("LENGTH", 5.0), ("WITHIN", 1.0)):
        monkeypatch.setattr(f"dancetutor_cli.dance.pieces.{name}", seconds)
    assert len(pieces_in(changing)) > 1
    again = _soles(bake_section(pieces_in(changing), (0.0, 13.0), in_turn).motion, times)
    assert np.abs(whole[0] - again[0]).max() < 1e-3 and np.abs(whole[1] - again[1]).max() < 1e-3


def test_weights_of_states_sum_to_one_and_are_whole_outside_of_changes() -> None:
    usual, edge = default_settings(), load_settings(None, "edge")
    course = SettingsCourse((usual, edge, usual), ((1.0, 2.0), (2.0, 4.0)))
    assert course.at(0.5) is usual and course.at(2.0) is edge and course.at(9.0) is usual
    assert course.at(1.5).step.edge == pytest.approx(0.5)
    weights = state_weights(course.changes, np.arange(0.0, 5.0, 0.01))
    assert weights.sum(axis=1) == pytest.approx(1.0) and weights.min() >= 0.0
    assert course.within(0.0, 0.9).states == (usual,) and len(course.within(1.5, 3.0).states) == 3
    assert course.within(4.5, 9.0).states == (usual,) and course.within(1.5, 1.8).changes == ((1.0, 2.0),)


def test_distances_are_those_of_the_style_of_their_time() -> None:
    """A ragdoll 1 cm away until the change, then another one 11 cm away."""
    times = np.arange(0.0, 10.0, 0.1)
    runs = [Distances(("hand",), times, np.full((100, 1), far)) for far in (1.0, 11.0)]
    late = (times > 5.0).astype(float)
    mean = mean_distances(runs, times, np.column_stack((1.0 - late, late)))
    np.testing.assert_allclose(mean.values[:, 0], np.where(times > 5.0, 11.0, 1.0))


def test_steps_home_are_those_of_the_style_of_their_time() -> None:
    usual = default_settings()
    out = replace(usual, step=replace(usual.step, toe_out=40.0))
    events = [(0.5, {0: plays.L}), (1.0, {3: plays.R}), (1.5, {0: plays.L}), (9.0, {3: plays.R})]
    course = SettingsCourse((usual, out), ((2.0, 2.5),))
    timing, play, pad = plays.chart().timing, plays.play(events), plays.pad()
    plans = [plan_dance(timing, play, pad, settings=settings)[0] for settings in (course, out)]
    yaws = [[round(m.yaw, 6) for track in plan.feet for m in track.moves if 2.5 < m.land < 8.9] for plan in plans]
    assert yaws[0] == yaws[1] and len(yaws[0]) >= 2


# Legs.


def test_legs_of_any_two_styles_are_apart() -> None:
    """Knees, ankles and toes seen from the hips: it was 0.1 to 1 cm."""
    legs, times = {}, np.arange(1.0, 12.0, 1 / 60)
    for name in config_names("styles"):
        placed = world_transforms(of(name).skeleton, *sample(of(name), times))[0]
        legs[name] = placed[:, [of(name).skeleton.index(n) for n in LEGS]] - placed[:, :1]
    apart = {(a, b): float(np.linalg.norm(legs[a] - legs[b], axis=2).mean()) for a, b in combinations(legs, 2)}
    assert min(apart.values()) > 0.025, apart


def test_feet_go_as_high_as_the_style_says() -> None:
    lift = {}
    for name in config_names("styles"):
        low = _soles(of(name), np.arange(1.0, 12.0, 1 / 60))[0][..., 1].min(axis=2)
        lift[name] = float(low[low > 0.004].mean())
    assert lift["lazy"] < 0.75 * lift["neutral"] and lift["heavy"] < 0.9 * lift["neutral"]
    assert lift["fierce"] > 1.4 * lift["neutral"], lift
