"""Films of charts for two: both dance, each on the panels that the notes are on, in clothes of two colours."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from dance_requests import film_request

from dancetutor_cli.character.characters import load_character, load_dancer
from dancetutor_cli.character.mesh import PREFIX, turned, with_partner
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.limbs import partner_colours
from dancetutor_cli.film.clock import Moment
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.notes import Callout
from dancetutor_cli.film.overlay.diagram import step_rows
from dancetutor_cli.film.scene.scene import PANEL, FrameState
from dancetutor_cli.film.scene.shared import HEEL_X, STRENGTH, feet_on_floor
from dancetutor_cli.film.work import planning
from dancetutor_cli.film.work.film_dance import FilmDance, bake_film_dance
from dancetutor_cli.film.work.planning import _dancers, prepare
from dancetutor_cli.film.work.request import FilmRequest, look_up
from dancetutor_cli.run.errors import UsageError

HEAD = "#TITLE:T;\n#OFFSET:0;\n#BPMS:0=120;\n"
COUPLE = "10000001\n01000010\n00010100\n00101000\n"
ROUTINE = "10000000\n01000000\n00010000\n00100000\n&\n00001000\n00000001\n00001000\n00000010\n"
MARKED = "X00000000Y\n0X000000Y0\n000X00Y000\n0X000000Y0\n"  # by letters, both in the same rows
CHARTS = {"dance-couple": COUPLE, "dance-routine": ROUTINE, "pump-double": MARKED}


def request_for(folder: Path, kind: str, **more: object) -> FilmRequest:
    path = folder / "two.sm"
    path.write_text(HEAD + f"#NOTES:{kind}::Hard:9::\n{CHARTS[kind]};\n")
    look = FilmLook(load_layout("side-by-side"), (320, 180), quality="draft", renderer="cpu")
    return film_request(path, Selection(), look, fps=10, section="0:1.6", mute=True, **more)


@pytest.fixture(scope="module", params=list(CHARTS))
def dance(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> FilmDance:
    wanted = request_for(tmp_path_factory.mktemp("two"), request.param)
    return bake_film_dance(wanted, look_up(wanted))


def test_each_foot_stands_on_the_panel_of_its_note(dance: FilmDance) -> None:
    """On the pad of both: a contact's panel, moved as the body is, is where the picture has the note's panel."""
    whole = dance.pad
    for one, motion in zip(dance.solved, dance.motions[1.0], strict=True):
        chart, pad = one.chart, one.pad
        assert pad is not None and len(motion.contacts) >= 4
        for contact in motion.contacts:
            place = (np.array(whole.centre) - whole.panels[chart.first_column + contact.column])[0] * PANEL
            assert contact.panel[0] == pytest.approx(place)
        end = float(motion.root[-1, 0])
        sides = [
            (np.array(whole.centre) - whole.panels[chart.first_column + c.column])[0] * PANEL for c in motion.contacts
        ]
        assert min(sides) - PANEL < end < max(sides) + PANEL  # she is where her panels are


def test_the_play_of_both_has_every_step_with_its_limb(dance: FilmDance) -> None:
    for one in dance.solved:
        assert one.play is not None
        for row, column in zip(*np.nonzero(one.play.rows.steps), strict=True):
            tick = one.play.rows.tick[row]
            there = int(np.flatnonzero(dance.play.rows.tick == tick)[0])
            assert dance.play.limb[there, column + one.chart.first_column] == one.play.limb[row, column]
    steps = sum(int((one.play.rows.steps > 0).sum()) for one in dance.solved if one.play is not None)
    assert int((dance.play.limb >= 0).sum()) == steps


def test_the_small_pads_know_where_all_four_feet_stand(dance: FilmDance) -> None:
    rows = step_rows(dance.play, _dancers(dance))
    assert rows.feet.shape == (len(rows.second), 4)
    for limbs, feet in zip(rows.limb, rows.feet.tolist(), strict=True):
        for column in np.flatnonzero(limbs >= 0):
            assert column in feet[int(limbs[column]) :: 2], "who steps it stands on it then"
    for player, one in enumerate(dance.solved):
        assert one.play is not None
        here = np.isin(dance.play.rows.tick, one.play.rows.tick)
        expected = np.where(one.play.feet >= 0, one.play.feet + one.chart.first_column, -1)
        for foot in (0, 1):  # before its first step nobody knows where it stands
            expected[: int((one.play.limb == foot).any(axis=1).argmax()), foot] = -1
        assert (rows.feet[here, 2 * player : 2 * player + 2] == expected).all()


def test_all_four_feet_are_in_the_diagram(tmp_path: Path) -> None:
    wanted = request_for(tmp_path, "dance-couple")
    look = replace(wanted.look, layout=load_layout("practice"), size=(640, 360))
    film = Film(prepare(replace(wanted, look=look), look_up(wanted)).plan)
    feet = film._dancer.feet(film._joints.at(8))
    assert len(feet) == 4 and all(foot is not None for foot in feet)
    first, second = ([foot.toe[0] for foot in pair if foot] for pair in (feet[:2], feet[2:]))
    assert max(first) < min(second), "each on her own pad"
    assert film._diagrams[0] is not None and len(set(film._diagrams[0].rims)) == 2


@pytest.mark.parametrize("kind", list(CHARTS))
def test_the_colour_of_a_note_says_whose_it_is(tmp_path: Path, kind: str) -> None:
    """By its player in a chart for two, whatever its quantisation."""
    wanted = request_for(tmp_path, kind)
    wanted = replace(wanted, look=replace(wanted.look, layout=load_layout("highway")))
    subject = look_up(wanted)
    plan = prepare(wanted, subject).plan
    for part in subject.chart.players:
        seconds, columns = part.timing.seconds(part.notes.tick), part.notes.column + part.first_column
        own = set(zip(seconds.tolist(), columns.tolist(), strict=True))
        mine = plan.notes.player == part.player
        assert set(zip(plan.notes.second[mine].tolist(), plan.notes.column[mine].tolist(), strict=True)) == own
        assert len(own) == 4
    highway = Film(plan).highway
    assert highway is not None
    assert [highway.colours[i] for i in highway.colour] == [highway.style.players[n - 1] for n in plan.notes.player]
    alone = replace(wanted, dance=replace(wanted.dance, selection=Selection(player=2)))
    assert not prepare(alone, look_up(alone)).plan.notes.player.any()


def test_what_both_do_is_called_out_and_what_one_does_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    one, two, both = (Callout(at, at, "crossover", "move", at - 0.9, at, "crossover") for at in (1.0, 2.0, 3.0))
    told = {"first": (one, both), "second": (two, both)}
    monkeypatch.setattr(planning, "callouts_of", lambda about, *_: told[about.chart])
    monkeypatch.setattr(planning, "_mines_of_each", lambda *_: ())
    dance = SimpleNamespace(solved=[SimpleNamespace(chart=name, pad=None) for name in told], plays=[None, None])
    assert planning._callouts(dance, None, None) == (both,)  # type: ignore[arg-type]


def test_two_are_drawn_and_each_has_rings_under_her_feet(tmp_path: Path) -> None:
    wanted = request_for(tmp_path, "dance-couple")
    plan = prepare(wanted, look_up(wanted)).plan
    assert plan.callouts == () and len(plan.directions) == 8
    two = Film(plan)
    both = two.frame(8).copy()
    assert two.placement.legend is not None and len(two.placement.legend.lines) == 1 + 2 * 4
    joints = two._dancer.joints([Moment(0.8)])[0]
    assert len(joints) == 2 * len(load_dancer().skeleton.names)
    gap = joints[0, 0, 3] - joints[len(joints) // 2, 0, 3]
    assert gap == pytest.approx(3 * PANEL, abs=1.5 * PANEL)  # the first stands to the left of who looks on
    nobody = np.zeros(8)
    marks = feet_on_floor(two._dancer.scene, FrameState(joints, two._dancer.camera, nobody, nobody.astype(np.int64)))
    places = marks[marks[:, STRENGTH] > 0][:, HEEL_X]
    assert len(places) >= 3 and places.max() - places.min() > 2 * PANEL
    assert both.std() > 10
    green = (both[..., 1].astype(int) > both[..., 2].astype(int) + 25) & (both[..., 1] > both[..., 0])
    assert green.sum() > 30  # the second one's clothes


def test_clothes_change_and_skin_hair_and_white_do_not() -> None:
    one, two = load_dancer(), with_partner(load_dancer())
    count = len(one.skeleton.names)
    assert two.skeleton.names[count:] == tuple(PREFIX + name for name in one.skeleton.names)
    assert np.allclose(two.skeleton.rest[count:], one.skeleton.rest)
    assert [mesh.joints.min() >= count for mesh in two.meshes] == [False] * len(one.meshes) + [True] * len(one.meshes)
    colours = np.array(
        [[[90, 80, 200], [232, 190, 160], [200, 40, 110], [255, 255, 255], [60, 60, 64]]], dtype=np.uint8
    )
    new = turned(colours, partner_colours())
    assert new[0, 0, 1] > new[0, 0, 2] and (new[0, 1:] == colours[0, 1:]).all()
    assert two.meshes[len(one.meshes)].material.texture is not one.meshes[0].material.texture


def test_a_character_without_such_colours_is_tinted() -> None:
    one = load_character("mannequin")
    two = with_partner(one)
    for mine, others in zip(one.meshes, two.meshes[len(one.meshes) :], strict=True):
        limb = mine.material.name in ("left_foot", "right_foot", "left_hand", "right_hand")
        assert (mine.material.base_color == others.material.base_color) == limb
    worn = [mesh.material.base_color for mesh in load_dancer().meshes]
    assert [m.material.base_color for m in with_partner(load_dancer()).meshes] == [*worn, *worn]


@pytest.mark.parametrize("option", [{"bar": True}, {"play": Path("x.json")}])
def test_options_for_one_dancer_are_reported(tmp_path: Path, option: dict[str, object]) -> None:
    wanted = request_for(tmp_path, "dance-couple", **option)
    with pytest.raises(UsageError, match="for two: choose with --player 1 or 2"):
        bake_film_dance(wanted, look_up(wanted))


def test_one_of_them_is_filmed_alone(tmp_path: Path) -> None:
    wanted = request_for(tmp_path, "dance-couple")
    wanted = film_request(wanted.path, Selection(player=2), wanted.look, section=wanted.section, mute=True)
    dance = bake_film_dance(wanted, look_up(wanted))
    assert len(dance.solved) == 1 == len(dance.motions[1.0]) and dance.pad.steps_type == "dance-single"
