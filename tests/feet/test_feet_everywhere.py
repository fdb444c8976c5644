"""Feet that a person laid down hold in every command: analyze, annotate, animate and render dance the same play."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from dance_requests import film_request, solved_one

from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play
from dancetutor_cli.lint.analysis import solve_selected
from dancetutor_cli.lint.run import LintRequest, LintRun

CHART = "#TITLE:x;\n#BPMS:0=120;\n#NOTES:\n dance-single:\n :\n Hard:\n 8:\n :{}\n1000\n0001\n1000\n0001\n;\n"
MIRRORED = [Limb.RIGHT_FOOT, Limb.LEFT_FOOT, Limb.RIGHT_FOOT, Limb.LEFT_FOOT]


@pytest.fixture(params=["pin", "data.sme"])
def song(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A chart that nobody would start with the right foot, and somebody who says so."""
    path = tmp_path / "song.sm"
    path.write_text(CHART.format("//{dt1! RLRL}" if request.param == "pin" else ""))
    if request.param == "data.sme":
        overrides = [[0, 0, "Right"], [1, 3, "Left"], [2, 0, "Right"], [3, 3, "Left"]]
        parity = {"dance-single": [{"overrides": overrides, "ignores": {"1": ["DS"]}}]}
        (tmp_path / "data.sme").write_text(json.dumps({"version": 1, "parity": parity}))
    return path


def limbs(play: Play | None) -> list[int]:
    assert play is not None
    return [int(row.max()) for row in play.limb]


def test_analyze(song: Path) -> None:
    read = load(song)
    (subject,) = solve_selected(read, read.charts, LintRun(LintRequest()).task(song))
    assert limbs(subject.play) == MIRRORED
    assert subject.ignores.is_silenced(48, "DS") == (song.parent / "data.sme").exists()


def test_animate(song: Path) -> None:
    assert limbs(solved_one(song, Selection(), "thesis").play) == MIRRORED


def test_render(song: Path) -> None:
    from dancetutor_cli.film.layout import FilmLook, load_layout
    from dancetutor_cli.film.work import planning
    from dancetutor_cli.film.work.request import look_up

    request = film_request(song, Selection(), FilmLook(load_layout("highway"), (64, 48)), fps=12, mute=True)
    prepared = planning.prepare(request, look_up(request))
    assert [int(limb) for limb in prepared.plan.notes.limb] == MIRRORED
