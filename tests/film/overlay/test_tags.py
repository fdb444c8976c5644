"""Words beside the notes: their letters can be read, and lanes leave room for them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from film_plans import film_plan

from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.media.encoder import FORMATS
from dancetutor_cli.film.notes import Callout
from dancetutor_cli.film.overlay import sprites, text
from dancetutor_cli.film.overlay.blit import Sprite
from dancetutor_cli.film.overlay.highway import Highway
from dancetutor_cli.film.overlay.marks import row_tags
from dancetutor_cli.run.reading import config_names

GIF = round(FORMATS["gif"].side)
CALL = Callout(2.0, 4.0, "crossover", "move", 1.0, 2.0, "crossover")
TAGS = ("crossover ×12", "footswitch", "full crossover ×2", "left foot again ×14", "no free foot",
        "heel on down-right, toe on centre ×3")  # fmt: skip
COLUMNS = ["dance-single", "pump-single", "dance-solo", "pump-halfdouble", "dance-double", "pump-double"]


@pytest.fixture(autouse=True)
def no_other_fonts(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A sign that the built-in font lacks is as wide as the system's font has it: 9.98 px of 10 in DejaVu Sans."""
    monkeypatch.setattr(text, "system_fonts", lambda: ())
    for known in (text._font_of, text._runs):
        known.cache_clear()
    yield
    for known in (text._font_of, text._runs):
        known.cache_clear()


def tagged(steps: str, name: str, wide: int, tags: tuple[str, ...]) -> Highway:
    """A highway with these tags beside it, in a film so wide."""
    pad, layout = load_pad(steps), load_layout(name)
    assert pad is not None
    size = (wide, round(wide * layout.size[1] / layout.size[0]))
    plan = film_plan(np.arange(1.0, 1.0 + len(pad)), columns=np.arange(len(pad)))
    calls = (CALL, *(replace(CALL, second=90.0, tag=said) for said in tags))
    film = Film(replace(plan, look=FilmLook(layout, size), pad=pad, directions=pad.directions, callouts=calls))
    assert film.highway is not None
    return film.highway


def drawn_tag(highway: Highway, said: str, monkeypatch: pytest.MonkeyPatch) -> tuple[list[str], float]:
    """Lines and size of the letters of a tag, which lies within the highway's box."""
    found: list[tuple[list[str], float]] = []
    flag = sprites.flag

    def noted(lines: list[str], size: float, *rest: Any) -> Sprite:
        found.append((lines, size))
        return flag(lines, size, *rest)

    with monkeypatch.context() as patch:
        patch.setattr(sprites, "flag", noted)
        picture = highway._flag(said, "move")
    assert highway.geometry.tags_left + picture.shape[1] <= highway.geometry.box[2]
    return found[0]


@pytest.mark.parametrize(
    ("name", "wide", "steps", "least"),
    [*((name, 1280, steps, 12) for name in ("side-by-side", "practice") for steps in COLUMNS),
     *(("side-by-side", GIF, steps, 10) for steps in COLUMNS),
     *(("practice", GIF, steps, 9 if steps == "pump-single" else 10) for steps in COLUMNS),
     *(("television", 1280, steps, 11 if steps == "pump-single" else 12) for steps in COLUMNS),
     *(("highway", 1080, steps, 12) for steps in COLUMNS),
     ("highway", GIF, "pump-double", 10), ("side-by-side", 1920, "pump-single", 16),
     ("side-by-side", 640, "dance-solo", 10)],
)  # fmt: skip
def test_the_tags_beside_the_notes_can_be_read(
    name: str, wide: int, steps: str, least: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Their letters are at least so many pixels, a phrase of them has two lines at most, and nothing is cut."""
    highway = tagged(steps, name, wide, TAGS)
    for said in TAGS:
        lines, letters = drawn_tag(highway, said, monkeypatch)
        assert letters >= least, said
        assert len(lines) <= 2 * len(said.split(", ")) and " ".join(lines) == said
    geometry = highway.geometry
    left, _, right, _ = geometry.box
    assert geometry.lane * len(geometry.directions) > 0.5 * (right - left) or geometry.lane > 60, (
        "notes are the message"
    )


@pytest.mark.parametrize(
    ("name", "wide", "steps", "least"),
    [("side-by-side", 1280, "dance-single", 17), ("side-by-side", 1280, "dance-double", 14),
     ("side-by-side", 1280, "pump-double", 14), ("side-by-side", 640, "dance-single", 10),
     ("television", 1280, "dance-single", 20), ("practice", 1280, "dance-single", 14),
     ("practice", 1280, "dance-double", 14), ("practice", 1280, "pump-double", 14)],
)  # fmt: skip
def test_short_tags_of_usual_pads_are_larger(
    name: str, wide: int, steps: str, least: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    highway = tagged(steps, name, wide, TAGS)
    for said in ("crossover ×12", "footswitch", "full crossover ×2", "left foot again"):
        assert drawn_tag(highway, said, monkeypatch)[1] >= least, said


@pytest.mark.parametrize("name", config_names("layouts"))
def test_these_are_all_the_layouts_with_tags(name: str) -> None:
    part = load_layout(name).highway
    assert (part is not None and part.tags) == (name in ("side-by-side", "practice", "television", "highway"))


def test_words_too_long_for_their_place_leave_lanes_most_of_their_width(monkeypatch: pytest.MonkeyPatch) -> None:
    said = "Donaudampfschifffahrtsgesellschaftskapitänsmütze"
    highway, plain = (tagged("pump-single", "practice", 1280, (word,)) for word in (said, "spin"))
    lines, _ = drawn_tag(highway, said, monkeypatch)
    assert lines == [said]
    assert highway.geometry.lane > 0.75 * plain.geometry.lane


def test_of_long_tags_that_follow_quickly_the_first_stands() -> None:
    """Quick brackets made a wall of small words that nobody reads."""
    bracket = "heel on down-left, toe on centre"
    calls = [replace(CALL, second=2.0 + 0.5 * k, beat=4.0 + k, tag=bracket) for k in range(6)]
    calls.append(replace(CALL, second=3.1, beat=6.2, tag="crossover ×12"))
    found = [(tag.second, tag.words) for tag in row_tags(calls)]
    assert found == [(2.0, bracket), (3.1, "crossover ×12"), (3.5, bracket)]


@pytest.mark.parametrize("down", [False, True])
def test_a_tag_is_seen_whole_or_not_at_all(down: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """The edge that notes come from cut its words."""
    layout = load_layout("side-by-side")
    plan = film_plan(np.array([1.0, 2.0, 3.0]))
    plan = replace(plan, callouts=(CALL,), look=FilmLook(layout, (1280, 720), down=down))
    highway = Film(plan).highway
    assert highway is not None
    drawn: list[tuple[float, int]] = []

    def noted(frame: Any, sprite: Sprite, x: float, y: float, *rest: Any) -> None:
        if x == highway.geometry.tags_left:
            drawn.append((y, sprite.shape[0]))

    monkeypatch.setattr("dancetutor_cli.film.overlay.highway.draw_sprite", noted)
    frame = np.zeros((720, 1280, 3), np.uint8)
    for second in np.arange(0.0, 2.0, 1 / 60):
        highway.draw(frame, float(second), float(2 * second))
    _, top, _, bottom = highway.geometry.box
    assert len(drawn) > 20
    assert all(top <= y and y + high <= bottom for y, high in drawn)
