"""Parts of charts and speeds of music: `animate` and `render` take the same and say the same."""

from __future__ import annotations

import importlib
from pathlib import Path

import click
import numpy as np
import pytest

from dancetutor_cli.__main__ import main
from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.timing import FASTEST, SLOWEST
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.film.clock import parse_rates
from dancetutor_cli.lint.sections import check_part, part_of
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"
ENDS = 40.0


@pytest.fixture(scope="module")
def song() -> Song:
    return load(DEMO)


def part(song: Song, text: str) -> tuple[float, float]:
    check_part(text)
    return part_of(text, song, song.charts[3], load_preset("itg"), ENDS)


def test_every_form_that_help_names_is_read(song: Song) -> None:
    seconds = song.charts[3].timing.seconds_of_beats
    assert part(song, "10:25") == (10.0, 25.0)
    assert part(song, "b16:b48") == pytest.approx(tuple(seconds(np.array([16.0, 48.0]))))
    assert part(song, "m4:m12") == pytest.approx(tuple(seconds(np.array([16.0, 48.0]))))
    first, last = part(song, "DT202:1")  # the spin in beat 45.5, as `analyze` tells it
    assert (first, last) == pytest.approx(tuple(seconds(np.array([37.5, 53.5]))))
    assert part(song, "dt202:1") == (first, last)


@pytest.mark.parametrize("text", ["DT202:99", "DT202:0", "spin", "9:2", ""])
def test_a_wrong_section_is_reported(song: Song, text: str) -> None:
    with pytest.raises(UsageError, match="section"):
        part(song, text)


def test_a_section_of_a_rule_that_does_not_exist(song: Song) -> None:
    with pytest.raises(UsageError, match="there is no rule 'DT999'"):
        part(song, "DT999:1")


@pytest.mark.parametrize("command", ["animate", "render"])
def test_help_says_the_same_everywhere(command: str) -> None:
    options = {p.name: p for p in importlib.import_module(f"dancetutor_cli.commands.{command}").command.params}
    section = options["section"]
    assert isinstance(section, click.Option)
    assert all(form in str(section.help) for form in ("10:25", "b16:b48", "m4:m12", "DT201:3"))
    with pytest.raises(UsageError, match="b16:b48"):
        check_part("soon")


def test_the_speeds_are_those_of_the_other_command(capsys: pytest.CaptureFixture[str]) -> None:
    animate = {p.name: p for p in importlib.import_module("dancetutor_cli.commands.animate").command.params}
    kind = animate["rate"].type
    assert isinstance(kind, click.FloatRange)
    assert (kind.min, kind.max) == (SLOWEST, FASTEST) == parse_rates("0.25,2")
    for wrong in ("0.24", "2.01"):
        with pytest.raises(UsageError, match=r"0\.25 to 2"):
            parse_rates(wrong)
        with pytest.raises(SystemExit) as stop:
            main(["animate", str(DEMO), "--rate", wrong])
        assert stop.value.code == 2
        assert "write a number from 0.25 to 2" in capsys.readouterr().err


def test_animate_bakes_what_is_around_a_finding(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "part.npz"
    with pytest.raises(SystemExit) as stop:
        main(["animate", str(DEMO), "--index", "3", "--section", "DT202:1", "-o", str(target)])
    assert stop.value.code == 0, capsys.readouterr().err
    with np.load(target) as file:
        assert file["times"][-1] - file["times"][0] == pytest.approx(16 * 60 / 128, abs=0.05)  # 16 beats at 128 BPM
