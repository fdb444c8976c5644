"""Mines that a foot is on as they pass, in a film: a cross, words, the linter's finding, and the panel's light."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dance_requests import film_request

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.notes import PanelLights, lighting
from dancetutor_cli.film.overlay import sprites
from dancetutor_cli.film.work.planning import PreparedFilm, prepare
from dancetutor_cli.film.work.request import look_up

# the right foot holds, the left one steps, and 12 ms later mines pass on its panel and on another one
ROWS = ["0001", *["0000"] * 23, "0002", *["0000"] * 23, "1000", "M0M0", *["0000"] * 38, "0003", *["0000"] * 7]


@pytest.fixture(scope="module")
def film(tmp_path_factory: pytest.TempPathFactory) -> PreparedFilm:
    path = tmp_path_factory.mktemp("mines") / "mines.sm"
    rows = "\n".join(ROWS)
    path.write_text(f"#TITLE:T;\n#OFFSET:0;\n#BPMS:0=200;\n#NOTES:dance-single::Hard:9::\n{rows}\n;\n")
    look = FilmLook(load_layout("practice"), (320, 180), quality="draft", renderer="cpu")
    request = film_request(path, Selection(), look, fps=10, mute=True)
    return prepare(request, look_up(request))


def test_the_mine_under_the_foot_is_marked_and_no_other(film: PreparedFilm) -> None:
    notes = film.plan.notes
    mines = notes.kind == Kind.MINE
    assert mines.sum() == 2 and notes.limb[mines & (notes.column == 0)] == 0
    assert notes.limb[mines & (notes.column == 2)] == -1
    (said,) = (note for note in film.warnings if "mine" in note)
    assert said == f"a foot is on a mine as it passes, or less than 3 cm over: {notes.second[mines][0]:.2f} s"


def test_words_say_it_and_what_the_linter_finds_there(film: PreparedFilm) -> None:
    (one,) = (one for one in film.plan.callouts if "mine" in one.text)
    assert one.text == "mine: not avoided (DT303 mine under hold)" and one.tag == "not avoided"
    assert one.severity == "move"


@pytest.mark.parametrize("whose", [1, 2])
def test_for_two_dancers_it_says_whose_foot_it_is(whose: int, tmp_path: Path) -> None:
    clear = [row.replace("M", "0") for row in ROWS]
    rows = "\n".join(map("".join, zip(*((ROWS, clear) if whose == 1 else (clear, ROWS)), strict=True)))
    path = tmp_path / "two.sm"
    path.write_text(f"#TITLE:T;\n#OFFSET:0;\n#BPMS:0=200;\n#NOTES:dance-couple::Hard:9::\n{rows}\n;\n")
    look = FilmLook(load_layout("side-by-side"), (320, 180), quality="draft", renderer="cpu")
    request = film_request(path, Selection(), look, fps=10, mute=True)
    plan = prepare(request, look_up(request)).plan
    (one,) = (one for one in plan.callouts if "mine" in one.text)
    assert one.text == f"player {whose}: mine not avoided (DT303 mine under hold)" and one.tag == "not avoided"
    assert plan.notes.limb[(plan.notes.kind == Kind.MINE) & (plan.notes.column == 4 * whose - 4)].tolist() == [0]


def test_its_panel_is_lit_and_it_is_no_step(film: PreparedFilm) -> None:
    """Nothing claps on it either: that goes by presses."""
    plan = film.plan
    second = float(plan.notes.second[plan.notes.kind == Kind.MINE][0])
    assert second not in plan.presses.start
    lights = PanelLights(lighting(plan.notes, plan.presses), 4, 0.3)
    assert lights.at(0, second) == (1.0, 0) and lights.at(2, second) == (0.0, -1)


def test_only_the_mine_under_the_foot_has_a_cross(film: PreparedFilm) -> None:
    look = FilmLook(load_layout("highway"), (320, 360), quality="draft", renderer="cpu")
    highway = Film(replace(film.plan, look=look)).highway
    assert highway is not None
    second = float(film.plan.notes.second[film.plan.notes.kind == Kind.MINE][0])
    frame = np.zeros((360, 320, 3), np.uint8)
    highway.draw(frame, second, second * 200 / 60)
    grey = np.abs(frame.astype(int) - sprites.NOBODY).sum(axis=2) < 30
    y, half = round(highway.geometry.receptor), highway.size // 5
    middles = [round(highway.geometry.corner(column, 0.0, 0.0)[0]) for column in (0, 2)]
    here, other = (int(grey[y - half : y + half, x - half : x + half].sum()) for x in middles)
    assert here > 5 and other == 0
