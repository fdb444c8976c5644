"""What is read on a phone: free zones, sizes of pads, words, arrows that turn with her."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from film_plans import DIRECTIONS, film_plan

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.media.encoder import FORMATS
from dancetutor_cli.film.notes import Callout
from dancetutor_cli.film.overlay import sprites
from dancetutor_cli.film.overlay.diagram import DiagramRows, Lettering, NextRows, PadView
from dancetutor_cli.film.overlay.text import Typeface
from dancetutor_cli.film.plan import faces_viewer
from dancetutor_cli.film.scene.scene import Scene
from dancetutor_cli.run.languages import load_language

FACE = Typeface()
LETTERS = Lettering(FACE, 1.0, load_language().film)
CALL = Callout(2.0, 4.0, "crossover", "move", 1.0, 2.0, "crossover")


@pytest.mark.parametrize("columns", [4, 5, 8, 10])
def test_vertical_keeps_free_what_short_video_apps_lay_buttons_over(columns: int) -> None:
    """The right 0.12 and the lower 0.18 have buttons and captions, the upper 0.07 tabs: no words or receptors there."""
    layout = load_layout("vertical")
    width, height = layout.size
    for name in ("header", "calls", "legend", "progress", "count", "feet"):
        _, top, right, bottom = layout.box(name, layout.size, columns)
        assert top >= 0.07 * height and bottom <= 0.82 * height and right <= 0.88 * width, name
    _, top, _, bottom = layout.box("highway", layout.size, columns)
    plan = film_plan(np.arange(1.0, 1.0 + columns), columns=np.arange(columns))
    ways = (DIRECTIONS * 3)[:columns]
    highway = Film(replace(plan, look=FilmLook(layout, layout.size), directions=ways)).highway
    assert highway is not None
    first, lanes = highway.geometry.left, highway.geometry.lane * columns
    assert first + lanes <= 0.88 * width
    if columns > 5:  # in the middle: no empty column beside them
        assert first + lanes / 2 == pytest.approx(width / 2, abs=1) and lanes > 0.7 * width
    part = layout.highway
    assert part is not None and top + part.receptor * (bottom - top) < 0.7 * height


@pytest.mark.parametrize("steps", ["dance-single", "dance-double", "pump-single", "pump-double", "pump-halfdouble"])
def test_pads_of_the_next_rows_are_large_enough(steps: str) -> None:
    pad, layout = load_pad(steps), load_layout("practice")
    assert pad is not None and layout.next is not None
    rows = DiagramRows(np.zeros(0), np.zeros((0, len(pad)), np.int8), np.zeros((0, 2), np.int16))
    box = layout.box("next", layout.size, len(pad))
    small = NextRows(rows, PadView(pad, pad.directions), box, layout.next.count, LETTERS)
    assert len(small.pads) >= 2
    assert min(one.smaller for one in small.pads) >= 90


@pytest.mark.parametrize("steps", ["dance-single", "dance-double", "pump-single", "pump-double"])
def test_small_pads_say_which_rows_they_are(steps: str) -> None:
    """ "next", "then" or "again" stand beside or above the pads, in their box, and cover none of them."""
    pad, layout = load_pad(steps), load_layout("practice")
    assert pad is not None and layout.next is not None
    rows = DiagramRows(np.arange(1.0, 4.0), np.full((3, len(pad)), -1, np.int8), np.full((3, 2), -1, np.int16))
    box = layout.box("next", layout.size, len(pad))
    small = NextRows(rows, PadView(pad, pad.directions), box, layout.next.count, LETTERS)
    frame = np.zeros((layout.size[1], layout.size[0], 3), np.uint8)
    small.draw(frame, 0.0)
    for place, one in enumerate(small.pads):
        name = small.name(place, place)
        x, y = small._corner(one, name)
        assert box[0] <= x and box[1] <= y and x + name.shape[1] <= box[2] and y + name.shape[0] <= box[3] + 2
        assert frame[round(y) : round(y) + name.shape[0], round(x) : round(x) + name.shape[1]].max() > 150
        left, top, *_ = one.edges
        assert x + name.shape[1] <= left or y + name.shape[0] <= top
    last = np.zeros_like(frame)
    small.draw(last, 3.0)
    assert not last.any(), "no row comes any more"


@pytest.mark.parametrize("steps", ["dance-single", "dance-double", "pump-single", "pump-double"])
def test_marks_of_the_next_rows_are_as_large_as_their_panels(steps: str) -> None:
    """Who steps a panel fills it with colour, shape and letter; who only stands somewhere is smaller and faded."""
    pad, layout = load_pad(steps), load_layout("practice")
    assert pad is not None and layout.next is not None
    limb = np.full((1, len(pad)), -1, np.int8)
    limb[0, 0] = 0
    rows = DiagramRows(np.array([1.0]), limb, np.array([[0, len(pad) - 1]], np.int16))
    box = layout.box("next", layout.size, len(pad))
    small = NextRows(rows, PadView(pad, pad.directions), box, layout.next.count, LETTERS)
    frame = np.zeros((layout.size[1], layout.size[0], 3), np.uint8)
    small.draw(frame, 0.0)
    found = {}
    for foot, column in enumerate(rows.feet[0]):
        x, y = small.pads[0].place(*small.pads[0].panels[column])
        half = small.pads[0].unit / 2
        here = frame[round(y - half) : round(y + half), round(x - half) : round(x + half)].astype(int)
        found[foot] = (np.abs(here - limb_colours().by_limb[foot]).sum(axis=2) < 24).sum() / here[..., 0].size
    assert found[0] > 0.35
    assert found[1] < 0.02, "faded"


@pytest.mark.parametrize(("steps", "wide"), [("dance-solo", False), ("pump-halfdouble", True), ("dance-double", True)])
def test_only_pads_of_more_than_a_square_have_the_wide_boxes(steps: str, wide: bool) -> None:
    pad = load_pad(steps)
    assert pad is not None
    plan = film_plan(np.arange(1.0, 7.0), columns=np.arange(6))
    layout = load_layout("side-by-side")
    film = Film(replace(plan, look=FilmLook(layout, layout.size), pad=pad, directions=pad.directions))
    assert film.boxes.box("dancer") == layout.box("dancer", layout.size, 8 if wide else 4)


def standing() -> Motion:
    """She stands in the middle of the pad for ten seconds."""
    skeleton, times = dancer_skeleton(), np.array([0.0, 10.0])
    rotations = np.zeros((2, len(skeleton.names), 4))
    rotations[..., 0] = 1.0
    return Motion(skeleton, 1.0, times, rotations, np.tile([0.0, 0.94, 0.0], (2, 1)), ())


@pytest.mark.parametrize("two", [False, True])
def test_on_a_phone_the_feet_are_seen_from_above_on_doubles_too(two: bool) -> None:
    """Beside her head, below the song's words however many; where two dance there is no room for them."""
    pad, layout = load_pad("dance-double"), load_layout("vertical")
    plan = film_plan(np.arange(1.0, 9.0), columns=np.arange(8))
    motions = {1.0: (standing(), standing())} if two else {}
    for title in ("Title", "A Title of Very Many Words That Never Ends, Not Even Here " * 2):
        words = replace(plan.words, title=title)
        look = FilmLook(layout, layout.size, quality="draft", renderer="cpu")
        film = Film(replace(plan, look=look, pad=pad, directions=pad.directions, motions=motions, words=words))  # type: ignore[union-attr, arg-type]
        box = film.placement.feet
        assert (box is None) == two
        assert film.placement.legend is not None and film.placement.header is not None
        if box is not None:
            assert box[1] > film.placement.header.bottom and film.placement.legend.boxes[0][1] > box[3]
            assert box[3] < layout.box("dancer", layout.size, 8)[3]
            assert (box[2] - box[0]) / 6 > 48, "pixels of a panel"


def test_a_gif_is_at_least_640_pixels_wide() -> None:
    assert min(FORMATS[name].side or 0 for name in ("gif", "webp")) >= 640


@pytest.mark.parametrize("camera", ["back", "front", "front-high"])
@pytest.mark.parametrize("steps", ["dance-single", "dance-double", "pump-single"])
def test_arrows_of_the_highway_point_as_those_of_the_pad_in_the_picture(camera: str, steps: str) -> None:
    from dancetutor_cli.character.characters import load_dancer

    pad = load_pad(steps)
    assert pad is not None
    columns = len(pad)
    plan = film_plan(np.arange(1.0, 1.0 + columns), columns=np.arange(columns))
    look = FilmLook(load_layout("side-by-side"), (1280, 720), camera=camera)
    film = Film(replace(plan, look=look, directions=pad.directions))
    assert film.faces_viewer == faces_viewer(look) == (camera != "back")
    assert film.highway is not None
    scene = Scene(load_dancer(), pad)
    size = (838, 672)
    view = scene.camera(camera, size)
    lanes, places = [], []
    for column in range(columns):
        at = np.asarray(pad.panels[column]) - pad.centre
        middle = np.array([-at[0], 0.0, at[1]]) * 0.28
        places.append(view.project(middle[None], size)[0, 0])
        lanes.append(film.highway.geometry.corner(column, 0.0, 0.0)[0])
        way = np.asarray(pad.arrows[column], dtype=float)
        if not way.any():
            continue
        tip = middle + np.array([-way[0], 0.0, way[1]]) * 0.05
        seen = view.project(np.array([middle, tip]), size)[:, :2]
        a = np.radians(film.highway.geometry.directions[column])
        drawn = np.array([np.sin(a), -np.cos(a)])
        assert float((seen[1] - seen[0]) @ drawn) > 0
    order = np.argsort(np.round(places, 3), kind="stable")
    for a, b in pairwise(order):
        assert lanes[b] > lanes[a] or abs(places[a] - places[b]) < 20


@pytest.mark.parametrize("down", [False, True])
@pytest.mark.parametrize("name", ["side-by-side", "vertical", "practice"])
def test_from_the_front_the_highway_says_that_its_arrows_are_turned(name: str, down: bool) -> None:
    """Beyond the receptors, where no note comes, and nowhere else."""
    plan = film_plan(np.array([1.0, 2.0]))
    layout = load_layout(name)
    shown = []
    for camera in ("back", "front"):
        look = FilmLook(replace(layout, dancer=replace(layout.dancer, camera=camera)), layout.size, down=down)  # type: ignore[type-var]
        highway = Film(replace(plan, look=look)).highway
        assert highway is not None
        shown.append(highway)
    geometry = shown[1].geometry
    assert (shown[0].geometry.turned, geometry.turned) == (False, True)
    frame = np.zeros((layout.size[1], layout.size[0], 3), np.uint8)
    shown[1]._draw_turned(frame)
    rows, columns = np.nonzero(frame.any(2))
    edge = geometry.receptor + (0.5 if down else -0.5) * shown[1].size
    assert (rows > edge).all() if down else (rows < edge).all()
    assert columns.min() >= geometry.left
    assert columns.max() <= geometry.left + len(geometry.directions) * geometry.lane


def test_a_note_that_no_foot_is_left_for_has_a_mark_of_its_own() -> None:
    plan = film_plan(np.array([1.0, 2.0, 3.0]))
    notes = replace(plan.notes, limb=np.array([0, -1, 1], dtype=np.int8))
    film, all_stepped = Film(replace(plan, notes=notes)), Film(plan)
    nobody = Film(replace(plan, notes=replace(plan.notes, limb=np.full(3, -1, dtype=np.int8))))
    frame, usual, bare = (one.frame(45) for one in (film, all_stepped, nobody))
    assert (frame != usual).any()
    assert (bare != frame).any(), "a chart without feet has no such marks"
    grey = np.abs(sprites.marker(32, -1, FACE)[..., :3].astype(int) - np.array(sprites.NOBODY)).sum(axis=-1) < 12
    assert grey.sum() > 100


@pytest.mark.parametrize("name", ["side-by-side", "television", "practice"])
def test_without_words_beside_them_the_lanes_stand_in_the_middle(name: str) -> None:
    plan = film_plan(np.arange(1.0, 5.0))
    layout = load_layout(name)
    look = FilmLook(layout, layout.size)
    alone, told = (Film(replace(plan, look=look, callouts=calls)).highway for calls in ((), (CALL,)))
    later = Film(replace(plan, look=look, callouts=(replace(CALL, second=90.0),))).highway
    assert alone is not None and told is not None and later is not None
    left, _, right, _ = alone.geometry.box
    middle = alone.geometry.left + 2 * alone.geometry.lane
    assert middle == pytest.approx((left + right) / 2)
    assert later.geometry.left == alone.geometry.left > told.geometry.left, "what is called out after the film"


@pytest.mark.parametrize(
    ("name", "columns"), [("side-by-side", 4), ("side-by-side", 8), ("practice", 8), ("vertical", 8)]
)
@pytest.mark.parametrize("calls", [(), (CALL,)])
def test_numbers_of_measures_can_be_read(name: str, columns: int, calls: tuple[Callout, ...]) -> None:
    """Three digits are not made much smaller than one, and keep off the edge."""
    layout = load_layout(name)
    look = FilmLook(layout, layout.size)
    plan = replace(film_plan(np.arange(1.0, 5.0)), look=look, directions=DIRECTIONS * (columns // 4), callouts=calls)
    highway = Film(plan).highway
    assert highway is not None
    one, three = (highway._draw_number(measure) for measure in (7, 148))
    assert three.shape[0] > 0.75 * one.shape[0]
    geometry = highway.geometry
    edge = geometry.left - 0.2 * geometry.lane - three.shape[1]
    assert edge >= geometry.box[0]


@pytest.mark.parametrize("steps", ["dance-double", "pump-double", "pump-halfdouble"])
def test_practice_shows_the_whole_of_a_wide_pad(steps: str) -> None:
    """Wherever she is on it, and her no smaller for it."""
    from dancetutor_cli.character.characters import load_dancer

    pad, layout = load_pad(steps), load_layout("practice")
    assert pad is not None and layout.dancer is not None
    columns = len(pad)
    left, top, right, bottom = layout.box("dancer", layout.size, columns)
    scene, size = Scene(load_dancer(), pad), (right - left, bottom - top)
    assert layout.region(columns) != layout.region(4) == layout.dancer.region
    camera = scene.camera(layout.dancer.camera, size, layout.region(columns))
    low, high = scene.extent
    corners = np.array([(x, 0.0, z) for x in (low[0], high[0]) for z in (low[2], high[2])])
    seen = camera.project(corners, size)
    assert (seen[:, :2] >= 0).all() and (seen[:, :2] <= size).all()
    feet, head = camera.project(np.array([(0.0, 0.0, 0.0), (0.0, 1.7, 0.0)]), size)
    assert feet[1] - head[1] > 0.42 * layout.size[1]
