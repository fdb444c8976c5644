"""Notes that nobody plays, in a film: a cross, words, the linter's finding, and no light."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from dance_requests import film_request

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.notes import PanelLights
from dancetutor_cli.film.overlay import sprites
from dancetutor_cli.film.overlay.diagram import Lettering, NextRows, PadView
from dancetutor_cli.film.overlay.text import Typeface
from dancetutor_cli.film.work.planning import PreparedFilm, prepare
from dancetutor_cli.film.work.request import look_up
from dancetutor_cli.run.languages import load_language

# the left foot holds, and the right one is asked for up and down 75 ms apart
TRILL = "2000\n0000\n0000\n0000\n0000\n0000\n0000\n0000\n0010\n0100\n0010\n0100\n0000\n3000\n0000\n0001\n"


def prepared(folder: Path, **more: object) -> PreparedFilm:
    path = folder / "trill.sm"
    path.write_text(f"#TITLE:T;\n#OFFSET:0;\n#BPMS:0=200;\n#NOTES:dance-single::Hard:9::\n{TRILL};\n")
    look = FilmLook(load_layout("practice"), (320, 180), quality="draft", renderer="cpu")
    request = film_request(path, Selection(), look, fps=10, mute=True, **more)
    return prepare(request, look_up(request))


@pytest.fixture(scope="module")
def film(tmp_path_factory: pytest.TempPathFactory) -> PreparedFilm:
    return prepared(tmp_path_factory.mktemp("trill"))


def test_the_notes_are_marked_and_light_nothing(film: PreparedFilm) -> None:
    left = film.plan.notes.limb == Limb.UNPLAYED
    assert left.sum() == 2 and (film.plan.notes.column[left] == 1).all()
    lights = PanelLights(film.plan.presses, 4, 0.3)
    for second in film.plan.notes.second[left]:
        assert lights.at(1, float(second)) == (0.0, -1)
    assert lights.at(0, float(film.plan.notes.second[0]))[0] > 0.5
    assert film.warnings[0].startswith("2 notes not played")


def test_words_say_it_and_what_the_linter_finds_there(film: PreparedFilm) -> None:
    """Without --show-findings; what it finds in rows that can be played is for authors."""
    (one,) = (one for one in film.plan.callouts if "no free foot" in one.text)
    assert one.text == "no free foot (DT305 fast step) ×2" and one.tag == "no free foot ×2"
    assert all(one.severity == "move" for one in film.plan.callouts)


def test_a_small_pad_has_a_cross_where_no_foot_comes(film: PreparedFilm) -> None:
    rows = film.plan.rows
    assert rows is not None
    row = int(np.flatnonzero((rows.limb == Limb.UNPLAYED).any(axis=1))[0])
    face, pad = Typeface(None), film.plan.pad
    assert pad is not None
    frame = np.zeros((120, 120, 3), np.uint8)
    view = PadView(pad, pad.directions)
    small = NextRows(rows, view, (0, 0, 120, 120), 1, Lettering(face, 1.0, load_language().film))
    small.draw(frame, float(rows.second[row]) - 0.01)
    x, y = small.pads[0].place(*pad.panels[1])
    grey = frame[round(y) - 8 : round(y) + 8, round(x) - 8 : round(x) + 8].astype(int)
    assert (np.abs(grey - sprites.NOBODY).sum(axis=2) < 30).sum() > 20


def test_runs_at_all_rates_let_the_same_notes_go(tmp_path: Path) -> None:
    """At half speed she could play them; but the picture marks one play."""
    two = prepared(tmp_path, rates=(0.5, 1.0))
    assert sorted(two.plan.motions) == [0.5, 1.0]
    for (motion,) in two.plan.motions.values():
        assert len(motion.dropped) == 2 and len({one.reason for one in motion.dropped}) == 1
    slow = prepared(tmp_path, rates=(0.5,))
    assert not slow.plan.motions[0.5][0].dropped and not (slow.plan.notes.limb == Limb.UNPLAYED).any()


def test_a_roll_that_no_hand_keeps_goes_dark_where_it_is_let_go(tmp_path: Path) -> None:
    """Feet drum theirs to the end; the hands' panels are lit for their heads only."""
    path = tmp_path / "rolls.sm"
    rows = "44044\n" + "00000\n" * 7 + "33033\n" + "00000\n" * 7
    path.write_text(f"#TITLE:R;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:pump-single::Hard:99::\n{rows};\n")
    look = FilmLook(load_layout("highway"), (160, 180), quality="draft", renderer="cpu")
    request = film_request(path, Selection(), look, fps=10, mute=True)
    plan = prepare(request, look_up(request)).plan
    hands = plan.notes.limb >= Limb.LEFT_HAND
    assert hands.sum() == 2 and np.isinf(plan.notes.gone_second[~hands]).all()
    assert (plan.notes.gone_second[hands] < 0.5).all() and (plan.notes.end_second == 1.0).all()
    lights = PanelLights(plan.presses, 5, 0.1)
    lit = np.array([lights.at(column, 0.9)[0] for column in range(5)])
    assert not lit[plan.notes.column[hands]].any() and (lit[plan.notes.column[~hands]] > 0.5).all()
    highway = Film(plan).highway
    assert highway is not None
    frame = np.zeros((180, 160, 3), np.uint8)
    highway.draw(frame, 0.5, 1.0)
    geometry, tail = highway.geometry, 0.5 if highway.by_time else 1.0
    y = round(geometry.receptor + 0.6 * tail * highway.spacing)  # on the bodies that are left
    light = np.array([frame[y, round(geometry.corner(column, 0.0, 0.0)[0])].astype(int).sum() for column in range(5)])
    assert light[plan.notes.column[hands]].max() < 0.5 * light[plan.notes.column[~hands]].min()
