"""--motion and --gait: a file changes how she moves in animate and render; a wrong one is told before the work."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from dance_requests import film_request

from dancetutor_cli.__main__ import main
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.work.planning import prepare
from dancetutor_cli.film.work.request import look_up
from dancetutor_cli.formats.npz import read_npz
from dancetutor_cli.run.reading import charts_path

DEMO = str(charts_path() / "two_left_feet" / "two_left_feet.ssc")
ASKED = ["--steps-type", "dance-single", "--difficulty", "hard", "--section", "8:12"]


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as stop:
        main(list(arguments))
    return int(stop.value.code or 0)


def animated(tmp_path: Path, *options: str) -> Motion:
    target = tmp_path / "x.npz"
    assert run("animate", DEMO, *ASKED, "-o", str(target), *options) == 0
    return read_npz(target)


def film(path: Path | None) -> Motion:
    look = FilmLook(load_layout("dancer"), (64, 64), "draft", "cpu")
    request = film_request(Path(DEMO), Selection(index=3), look, section="8:12", mute=True, motion=path)
    return prepare(request, look_up(request)).plan.motions[1.0][0]


def test_a_file_makes_her_stand_lower(tmp_path: Path) -> None:
    low = tmp_path / "low.yaml"
    low.write_text("body: {leg: 0.75}\nlayers: {bounce: 0}\n", encoding="utf-8")
    usual, lower = animated(tmp_path), animated(tmp_path, "--motion", str(low))
    assert np.median(usual.root[:, 1]) - np.median(lower.root[:, 1]) > 0.02
    heights = [np.median(film(path).root[:, 1]) for path in (None, low)]
    assert heights[0] - heights[1] > 0.02


@pytest.mark.parametrize("command", ["animate", "render"])
@pytest.mark.parametrize(
    ("option", "text", "said"),
    [
        ("--motion", "jump:\n  hight: 1\n", ":2: unknown key 'hight' in 'jump'; choose apex_near"),
        ("--motion", None, "no such file or folder"),
        ("--gait", "slow: {}\n", "slow.period is missing"),
    ],
)
def test_what_is_wrong_is_one_line_before_the_work(
    command: str, option: str, text: str | None, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = tmp_path / "wrong.yaml"
    if text is not None:
        wrong.write_text(text, encoding="utf-8")
    output = tmp_path / ("x.glb" if command == "animate" else "x.mp4")
    assert run(command, DEMO, *ASKED, "-o", str(output), option, str(wrong)) == 2
    error = capsys.readouterr().err
    assert len(error.splitlines()) == 1 and said in error and not output.exists()
