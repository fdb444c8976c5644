"""Layouts that nothing can be drawn with, damaged fonts, options that are no number: one clear line each."""

from __future__ import annotations

import os
import random
from pathlib import Path

import pytest
from click.testing import CliRunner
from PIL import ImageFont

from dancetutor_cli.commands import cli
from dancetutor_cli.film.layout import load_layout
from dancetutor_cli.film.overlay.text import font, has_glyph
from dancetutor_cli.run.errors import DancetutorError, FileError
from dancetutor_cli.run.reading import charts_path, config_names

NOTES = "size: [640, 360]\nhighway: {box: [0, 0, 1, 1], lane: 64}\n"
SONG = charts_path() / "two_left_feet" / "two_left_feet.ssc"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("size: [0, 0]\nhighway: {box: [0, 0, 1, 1], lane: 64}", "size"),
        ("size: [640, 90000]\nhighway: {box: [0, 0, 1, 1], lane: 64}", "size"),
        ("size: [640, 360]\nhighway: {box: [0, 0, 1, 1], lane: 0}", "lane"),
        ("size: [640, 360]\nhighway: {box: [0, 0, 0, 1], lane: 64}", "highway.box"),
        ("size: [640, 360]\nhighway: {box: [0, 0, 1, 1], lane: 64, receptor: 7}", "receptor"),
        ("size: [640, 360]\nhighway: {box: [0, 0, 1, 1], lane: 64, scroll: C0}", "C0"),
        (NOTES + "header: {box: [0, 0, 1, 1], text: 0}", "header.text"),
        (NOTES + "header: {box: [0, 0, 1, 1], room: -1}", "header.room"),
        (NOTES + "next: {box: [0, 0, 1, 1], count: 0}", "next.count"),
        (NOTES + "practice: {rates: []}", "practice.rates"),
        (NOTES + "practice: {rates: [0]}", "practice.rates"),
        (NOTES + "practice: {count_in: -4}", "count_in"),
        (NOTES + "dancer: {box: [0, 0, 1, 1]}\nscreen: {centre: [0, 1, 2], size: [0, 1], pixels: [64, 64]}", "n.size"),
        (NOTES + "dancer: {box: [0, 0, 1, 1]}\nscreen: {centre: [0, 1, 2], size: [1, 1], pixels: [0, 64]}", "pixels"),
    ],
)  # fmt: skip
def test_a_layout_with_impossible_numbers_is_refused(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(text + "\n")
    with pytest.raises(DancetutorError, match=said):
        load_layout(str(path))


def test_those_of_the_program_are_taken(tmp_path: Path) -> None:
    assert all(load_layout(name) for name in config_names("layouts"))
    (tmp_path / "mine.yaml").write_text(NOTES)
    assert load_layout(str(tmp_path / "mine.yaml")).size == (640, 360)


def test_damaged_fonts_are_refused_or_lack_letters(tmp_path: Path) -> None:
    built_in = ImageFont.load_default(24)
    assert isinstance(built_in, ImageFont.FreeTypeFont)
    whole = built_in.font_bytes
    chance = random.Random(5)
    outcomes = set()
    for number in range(60):
        data = bytearray(whole)
        for _ in range(20):
            data[chance.randrange(len(data))] = chance.randrange(256)
        cut = chance.randrange(len(data)) if number % 3 == 0 else len(data)
        path = tmp_path / f"{number}.ttf"
        path.write_bytes(bytes(data[:cut]))
        try:
            font(str(path), 24)
            outcomes.add("taken")
            assert has_glyph(str(path), "A") in (True, False)
        except FileError as error:
            outcomes.add("refused")
            assert "\n" not in str(error)
    assert outcomes == {"taken", "refused"}


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--sync-offset", "nan"], "--sync-offset nan: write a number from -60000 to 60000"),
        (["--sync-offset", "inf"], "--sync-offset inf: write a number from -60000 to 60000"),
        (["--font", "{tmp}/damaged.ttf"], "is not a font file that can be read"),
        (["--font", "{tmp}/pipe.ttf"], "named pipe"),
        (["--layout", "{tmp}/zero.yaml"], "size"),
    ],
)
def test_render_refuses_before_the_work(options: list[str], said: str, tmp_path: Path) -> None:
    (tmp_path / "damaged.ttf").write_bytes(b"\0\1\0\0" + bytes(100))
    (tmp_path / "zero.yaml").write_text(NOTES.replace("640", "0"))
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe.ttf")
    elif "pipe" in options[1]:
        pytest.skip("no named pipes here")
    given = [option.replace("{tmp}", str(tmp_path)) for option in options]
    ran = CliRunner().invoke(cli, ["render", str(SONG), "--difficulty", "hard", "-o", str(tmp_path / "x.mp4"), *given])
    assert ran.exit_code != 0 and said in f"{ran.output}{ran.exception}"
    assert not (tmp_path / "x.mp4").exists()
