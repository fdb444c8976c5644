"""The highway and its parts: things are where they should be at their time, whatever was drawn before."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from film_plans import DIRECTIONS, film_plan

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.film.clock import Clock, Pass
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import load_layout
from dancetutor_cli.film.notes import QUANTISATIONS, Callout, PanelLights, Presses, quantisation
from dancetutor_cli.film.overlay import sprites
from dancetutor_cli.film.overlay.blit import Run, draw_rectangle, draw_sprite, fill_run
from dancetutor_cli.film.overlay.text import Typeface
from dancetutor_cli.film.scroll import parse_scroll
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.reading import config_names, config_path
from dancetutor_cli.run.yaml_files import load


def test_a_sprite_between_pixels_is_shared_by_both() -> None:
    frame = np.zeros((6, 3, 3), dtype=np.uint8)
    sprite = np.full((2, 1, 4), 255, dtype=np.uint8)
    draw_sprite(frame, sprite, 1, 1.25)
    column = frame[:, 1, 0].astype(int)
    assert column.tolist() == [0, 191, 255, 64, 0, 0] or abs(column - [0, 191, 255, 64, 0, 0]).max() <= 1
    assert not frame[:, [0, 2]].any()


def test_sprites_are_cut_at_edges_and_rows() -> None:
    frame = np.zeros((5, 5, 3), dtype=np.uint8)
    sprite = np.full((4, 4, 4), 255, dtype=np.uint8)
    for x, y in ((-2, -2), (3, 3), (-9, 0), (0, 99)):
        draw_sprite(frame, sprite, x, y)
    assert frame[:2, :2].all() and frame[3:, 3:].all() and not frame[2].any()
    frame[:] = 0
    draw_sprite(frame, sprite, 0, 0.5, rows=(2, 4))
    assert not frame[:2].any() and frame[2:4, :4].all() and not frame[4].any()


def test_half_opacity_is_half_way_and_strips_cover_their_share() -> None:
    frame = np.full((4, 1, 3), 100, dtype=np.uint8)
    fill_run(frame, np.full((2, 1, 4), 255, dtype=np.uint8), 0, Run(1.5, 3.0, 0.0))
    assert frame[:, 0, 0].tolist() == [100, 178, 255, 100]
    frame[:] = 100
    draw_rectangle(frame, (0, 0, 1, 2), (200, 200, 200), 0.5)
    assert frame[:, 0, 0].tolist() == [150, 150, 100, 100]


def test_quantisation_is_the_coarsest_note_value() -> None:
    ticks = np.array([0, 24, 16, 12, 8, 6, 4, 3, 1, 192, 36, 32])
    values = [QUANTISATIONS[i] for i in quantisation(ticks)]
    assert values == [4, 8, 12, 16, 24, 32, 48, 64, 192, 4, 16, 12]


def test_arrows_point_where_their_panels_are() -> None:
    for direction, turns in ((0.0, 0), (90.0, 1), (180.0, 2), (270.0, 3)):
        ink = np.rot90(sprites.arrow(64, direction, (255, 0, 0))[..., 3], turns) > 128  # turned until it points up
        rows = np.flatnonzero(ink.any(axis=1))
        assert ink[rows[2]].sum() < 0.6 * ink[rows[-3]].sum(), direction  # the tip is narrow, the shaft is not


@pytest.mark.parametrize("direction", [0.0, 90.0, 45.0, 135.0, 225.0, 315.0, None])
def test_every_note_fills_its_lane(direction: float | None) -> None:
    shown = sprites.arrow(64, direction, (200, 40, 40))[..., 3] > 128
    rows, columns = np.flatnonzero(shown.any(axis=1)), np.flatnonzero(shown.any(axis=0))
    assert 0.82 * 64 <= np.ptp(columns) + 1 <= 64 and 0.8 * 64 <= np.ptp(rows) + 1 <= 64
    assert min(columns[0], rows[0], 63 - columns[-1], 63 - rows[-1]) >= 1  # and is not cut


def test_left_and_right_markers_differ_in_colour_letter_and_shape() -> None:
    left, right = (sprites.marker(40, limb, Typeface()) for limb in (0, 1))
    corners = [int(mark[4, 4, 3]) for mark in (left, right)]
    assert corners[0] < 30 < corners[1]  # a disc and a square, told apart without colour
    for mark, colour in ((left, limb_colours().left_foot), (right, limb_colours().right_foot)):
        assert np.abs(mark[20, 6, :3].astype(int) - colour).max() < 12


def test_a_note_reaches_its_receptor_at_its_time() -> None:
    plan = film_plan(
        np.array([1.0]), Clock((Pass(0.0, 2.0),), 60), (216, 144), np.array([2]), scroll=parse_scroll("C300")
    )
    film = Film(plan)
    assert film.highway is not None
    silent = Presses(plan.presses.start[:0], plan.presses.end[:0], plan.presses.column[:0], plan.presses.limb[:0])
    empty = Film(replace(plan, notes=film_plan(np.array([50.0])).notes, presses=silent))

    def middle(frame: int) -> float:
        changed = np.abs(film.frame(frame).astype(int) - empty.frame(frame)).sum(axis=2) > 60
        return float(np.nonzero(changed)[0].mean())

    receptor = film.highway.geometry.receptor
    assert middle(59) == pytest.approx(receptor + film.highway.geometry.lane * 5 / 60, abs=1.5)
    speed = (middle(36) - middle(54)) / (18 / 60)
    assert speed == pytest.approx(5 * film.highway.geometry.lane, rel=0.03)  # C300: five arrows a second


def test_falling_notes_come_from_above() -> None:
    clock = Clock((Pass(0.0, 2.0),), 30)
    up = Film(film_plan(np.array([1.0]), clock)).highway
    down = Film(film_plan(np.array([1.0]), clock, down=True)).highway
    assert up is not None and down is not None
    assert up.geometry.receptor < 60 < down.geometry.receptor and up.spacing == -down.spacing


def test_lights_flash_fade_and_hold() -> None:
    presses = Presses(np.array([1.0, 2.0]), np.array([1.0, 3.0]), np.array([0, 0], np.int16), np.array([0, 1], np.int8))
    lights = PanelLights(presses, 4, 0.2)
    assert lights.at(0, 0.999) == (0.0, -1)
    assert lights.at(0, 1.0) == (1.0, 0)
    assert lights.at(0, 1.1)[0] == pytest.approx(0.75)
    assert lights.at(0, 1.201)[0] == lights.at(0, 1.3)[0] == 0.0
    fading = np.array([lights.at(0, second)[0] for second in np.linspace(1.0, 1.2, 201)])
    assert (np.diff(fading) <= 0.0).all()
    assert ((fading > 0.0) & (fading < 0.3)).mean() < 0.2, "neither on nor off"
    assert lights.at(0, 2.9)[0] > 0.5 and lights.at(0, 2.9)[1] == 1
    assert lights.at(0, 3.5)[0] == 0.0 and lights.at(1, 2.0) == (0.0, -1)


def test_frames_do_not_depend_on_what_was_drawn_before() -> None:
    kinds = np.array([Kind.TAP, Kind.HOLD, Kind.ROLL, Kind.MINE, Kind.LIFT, Kind.FAKE, Kind.TAP, Kind.TAP])
    seconds = np.arange(8) * 0.25 + 0.5
    ends = seconds + np.where(np.isin(kinds, (Kind.HOLD, Kind.ROLL)), 1.0, 0.0)
    plan = film_plan(seconds, kinds=kinds, ends=ends)
    plan = replace(plan, callouts=(Callout(1.5, 3.0, "spin", "warning", 0.6, 1.5, "spin"),))
    forwards, backwards = Film(plan), Film(plan)
    frames = {k: forwards.frame(k).copy() for k in range(0, 80, 9)}
    for k in reversed(range(0, 80, 9)):
        assert (backwards.frame(k) == frames[k]).all()


@pytest.mark.parametrize("down", [False, True])
def test_no_tag_covers_another(down: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Three rows 30 ms apart: the first stands beside its row, the others farther on."""
    plan = film_plan(np.array([1.0]), Clock((Pass(0.0, 2.0),), 30), size=(640, 360), down=down)
    said = [Callout(1.0 + 0.03 * k, 2.0 + 0.06 * k, "spin", "move", 0.1, 1.0, "spin") for k in range(3)]
    drawn: list[tuple[float, float]] = []
    highway = Film(replace(plan, callouts=tuple(said))).highway
    assert highway is not None
    flag = highway._flag("spin", "move")

    def noted(frame: object, sprite: object, x: float, y: float, *more: object) -> None:
        if sprite is flag:
            drawn.append((y, y + flag.shape[0]))

    monkeypatch.setattr("dancetutor_cli.film.overlay.highway.draw_sprite", noted)
    highway.draw(np.zeros((360, 640, 3), np.uint8), 0.8, 1.6)
    assert len(drawn) == 3
    row = highway.geometry.receptor + highway.spacing * (0.2 if highway.by_time else 0.4)
    assert sum(drawn[0]) / 2 == pytest.approx(row, abs=1.0)
    first, second, third = sorted(drawn)
    assert first[1] <= second[0] and second[1] <= third[0]
    assert (drawn[0] == first) != down, "later rows are farther off"


def test_every_layout_loads_and_names_are_listed() -> None:
    assert {"side-by-side", "dancer", "highway", "television", "vertical", "practice"} <= set(config_names("layouts"))
    for name in config_names("layouts"):
        load_layout(name)
    with pytest.raises(UsageError, match="choose background, dancer, highway"):
        load_layout("nope")


def test_a_wrong_layout_says_what_is_wrong(tmp_path: object) -> None:
    from pathlib import Path

    path = Path(str(tmp_path)) / "mine.yaml"
    for text, said in (
        ("size: [1, 2]\nhighwy: {}\n", ":2: unknown key 'highwy' (did you mean highway?)"),
        ("size: [100, 100]\nhighway: {box: [0, 0, 2, 1], lane: 9}\n", ":2: highway.box must be left, top"),
        ("size: [100, 100]\nhighway: {box: [0, 0, 1, 1], lane: wide}\n", ":2: highway.lane must be a number from 4 to"),
        ("size: [100, 100]\n", "a dancer, a highway or both"),
        ("size: [100\n", "mine.yaml:2"),
    ):
        path.write_text(text)
        with pytest.raises(FileError) as caught:
            load_layout(str(path))
        assert said in str(caught.value), text


def test_the_style_file_is_complete() -> None:
    style = load(config_path("highway.yaml"), sprites.HighwayStyle)
    assert set(style.quantisation) == set(QUANTISATIONS)
    assert len({*style.quantisation.values()} & {*limb_colours().by_limb}) == 0


def test_directions_are_those_of_the_pad() -> None:
    from dancetutor_cli.feet.pads import load_pad

    for steps_type, expected in (("dance-single", DIRECTIONS), ("dance-double", DIRECTIONS * 2)):
        pad = load_pad(steps_type)
        assert pad is not None and pad.directions == pytest.approx(expected)
