"""The marks of who steps a note: beside an arrow's tip, and none over another where notes are dense."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from film_plans import film_plan

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.film.overlay import sprites
from dancetutor_cli.film.overlay.highway import Highway, Score
from dancetutor_cli.film.overlay.marks import HighwayGeometry
from dancetutor_cli.film.overlay.text import Typeface
from dancetutor_cli.film.scroll import parse_scroll

FACE = Typeface()
NARROW, USUAL, PHONE = (0, 0, 512, 672), (0, 0, 400, 672), (0, 0, 940, 800)


def highway(seconds: list[float], limbs: list[int], lane: float, box: tuple[int, int, int, int]) -> Highway:
    """One lane of notes; C60 makes a second as long as a lane is wide."""
    plan = film_plan(np.array(seconds))
    alone = np.zeros(len(seconds), np.int16)
    notes = replace(plan.notes, column=alone, limb=np.array(limbs, np.int8))
    score = Score(notes, replace(plan.presses, column=alone), plan.lines)
    return Highway(score, HighwayGeometry(box, lane, 0.0, (0.0,)), parse_scroll("C60"), 120.0, FACE)


@pytest.mark.parametrize("direction", [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0])
@pytest.mark.parametrize(("lane", "box"), [(40.0, NARROW), (76.0, USUAL), (139.0, PHONE)])
def test_a_mark_stands_on_the_tail_of_an_arrow(direction: float, lane: float, box: tuple[int, int, int, int]) -> None:
    """Of the arrow's half towards which it points most is to be seen beside the mark, which keeps to its lane.

    In the middle of a lane of 40 pixels it left a third.
    """
    plan = film_plan(np.array([1.0]))
    geometry = HighwayGeometry(box, lane, 50.0, (direction,))
    alone = np.zeros(1, np.int16)
    score = Score(replace(plan.notes, column=alone), replace(plan.presses, column=alone), plan.lines)
    marks = Highway(score, geometry, parse_scroll("M300"), 120.0, FACE).marks
    size = round(lane * sprites.highway_style().arrow)
    arrow = sprites.arrow(size, direction, (200, 60, 60))[..., 3] > 128
    y, x = np.mgrid[:size, :size] + 0.5 - size / 2
    aside, below = marks.behind(direction)
    radius = marks.of(direction) / 2
    covered = (np.abs(x - aside) < radius) & (np.abs(y - below) < radius)
    a = np.radians(direction)
    ahead = x * np.sin(a) - y * np.cos(a) > 0
    assert (arrow & ahead & ~covered).sum() > (0.85 if direction % 90 else 0.7) * (arrow & ahead).sum()
    if not direction % 90 or lane > 40:  # the tail's end is seen whole, no crumbs of it
        behind = y * np.cos(a) - x * np.sin(a) > (0.39 if direction % 90 else 0.4) * size
        assert (arrow & behind).any() and not (np.hypot(x - aside, y - below) < radius)[behind].any()
    assert abs(aside) + radius <= lane / 2 and abs(below) + radius <= lane / 2
    frame = np.zeros((200, box[2], 3), np.uint8)
    marks.draw(frame, 0, 100.0, marks.places(300.0))
    rows, columns = np.nonzero(frame.any(axis=2))
    middle = geometry.left + lane / 2
    assert columns.mean() - middle == pytest.approx(aside, abs=1.5) and rows.mean() - 99.5 == pytest.approx(
        below, abs=1.5
    )


@pytest.mark.parametrize(("lane", "box"), [(40.0, NARROW), (76.0, USUAL), (139.0, PHONE)])
@pytest.mark.parametrize("apart", [0.5, 0.25, 0.12, 0.06, 0.01])
@pytest.mark.parametrize(
    "limbs",
    [[0] * 12, [0, 1] * 6, [0, 0, 1, 1, 1, 0] * 2, [0, -1] * 6, [-1, 0, 1] * 4, [-1] * 12, [0, 1, 1, -1, -1, 0] * 2],
)
def test_no_mark_covers_another_however_dense_notes_are(
    lane: float, box: tuple[int, int, int, int], apart: float, limbs: list[int]
) -> None:
    marks = highway([1 + apart * k for k in range(12)], limbs, lane, box).marks
    places = marks.places(lane)
    middle = places.side * 0.25 * lane
    shown = np.flatnonzero(places.size)
    for n, i in enumerate(shown):
        for j in shown[n + 1 :]:
            least = (places.size[i] + places.size[j]) / 2 - 1
            down = (j - i) * apart * lane + places.below[j] - places.below[i]
            assert max(abs(middle[i] - middle[j]), down) >= least, (i, j)
    assert (places.size[shown] >= marks.least).all()
    for limb in set(limbs) - {-1}:
        assert places.size[limbs.index(limb)] > 0, "the first of each foot is marked"
    assert (abs(middle) + places.size / 2 <= lane / 2).all()


@pytest.mark.parametrize("limbs", [[0, 1] * 6, [0, -1, 1] * 4])
def test_marks_have_the_room_that_there_is(limbs: list[int]) -> None:
    """Whatever the spacing: sizes are found for few of them, and none is for more room than there is."""
    marks = highway([1 + 0.25 * k for k in range(12)], limbs, 76.0, USUAL).marks
    for spacing in np.geomspace(20.0, 300.0, 40).tolist():
        places = marks.places(spacing)
        shown = np.flatnonzero(places.size)
        for i in shown.tolist():
            for j in shown[shown > i].tolist():
                apart = (places.size[i] + places.size[j]) / 2
                if abs(places.side[i] - places.side[j]) * 0.25 * 76.0 < apart:
                    down = (j - i) * 0.25 * spacing + places.below[j] - places.below[i]
                    assert down >= apart - 1e-6, (spacing, i, j)


def test_a_cross_is_seen_between_marks_where_there_is_room_for_it() -> None:
    marks = highway([1 + 0.25 * k for k in range(6)], [0, -1, 1, -1, 0, 1], 76.0, USUAL).marks
    roomy = marks.places(4 * (marks.least + 6) * 1.0)
    assert (roomy.size >= marks.least).all() and roomy.side.tolist() == [-1, 0, 1, 0, -1, 1]
    assert (marks.places(2 * marks.least).size > 0).tolist()[1] is False, "a foot's mark comes before it"


def test_marks_say_the_foot_by_their_side_where_notes_are_dense() -> None:
    marks = highway([1.0, 1.1, 1.2, 3.0], [0, 1, 0, 1], 76.0, USUAL).marks
    places = marks.places(76.0)
    assert places.side.tolist() == [-1, 1, -1, 0]
    assert places.size[3] == marks.of(0.0) == places.size.max(), "one with room is as large as ever"


def test_notes_that_nobody_steps_have_no_mark() -> None:
    mine = highway([1.0, 2.0], [-1, 0], 76.0, USUAL)
    kinds = mine.notes.kind.copy()
    kinds[0] = Kind.MINE
    score = Score(replace(mine.notes, kind=kinds), mine.presses, mine.lines)
    again = Highway(score, mine.geometry, parse_scroll("C60"), 120.0, FACE)
    assert mine.marks.places(76.0).size[0] > 0, "a note that is let go has one"
    assert (again.marks.places(76.0).size > 0).tolist() == [False, True]


def test_an_arrow_that_comes_sooner_does_not_cover_a_mark() -> None:
    """The second note's mark is as whole as it is alone, where it is then."""
    seen: list[int] = []
    for seconds in ([1.0, 1.45], [0.2, 1.45]):
        drawn = highway(seconds, [0, 1], 76.0, USUAL)
        frame = np.zeros((672, 400, 3), np.uint8)
        places = drawn.marks.places(76.0)
        x, y = drawn.geometry.left + 38, 1.45 * 76 + places.below[1]
        drawn.draw(frame, (y - round(y)) / 76, 0.0)  # so that both marks are as sharp
        half = places.size[1] // 2
        here = frame[round(y) - half : round(y) + half, round(x) - half : round(x) + half].astype(int)
        seen.append((np.abs(here - limb_colours().by_limb[1]).sum(axis=2) < 60).sum())
    assert seen[0] > 150 and seen[0] == pytest.approx(seen[1], rel=0.06)


DENSE = [
    [0, 0, 0, 0, 0, 0], [1, 0, 1, 0, 1, 0], [0, 0, 1, 1, 0, 1], [-1, 0, 1, -1, 0, 1],
]  # fmt: skip


def covered_share(drawn: Highway, number: int, spacing: float) -> float:
    """Return the largest share of an arrow's visible pixels that the mark of another note covers. number : of notes"""
    geometry, size = drawn.geometry, drawn.size
    places, way = drawn.marks.places(spacing), -1 if geometry.down else 1
    shape = sprites.arrow(size, geometry.directions[0], (200, 60, 60))[..., 3] > 128
    picture = np.full((2 * round(number * spacing + size) + 2 * size, size), -1)
    middles = [len(picture) // 2 + way * round(spacing * (k - number / 2)) for k in range(number)]
    for k in reversed(range(number)):  # the earlier ones on top
        top = middles[k] - size // 2
        picture[top : top + size][shape] = k
    seen, worst = np.bincount(picture[picture >= 0], minlength=number), 0.0
    for k in np.flatnonzero(places.size).tolist():
        mark = sprites.marker(int(places.size[k]), int(drawn.notes.limb[k]), FACE, rim=True)[..., 3] > 128
        across = (
            places.side[k] * 0.25 * geometry.lane if places.side[k] else drawn.marks.behind(geometry.directions[0])[0]
        )
        high = len(mark)
        top, left = round(middles[k] + places.below[k] - high / 2), round((size - high) / 2 + across)
        cut = max(0, -left), min(high, size - left)
        under = picture[top : top + high, left + cut[0] : left + cut[1]][mark[:, cut[0] : cut[1]]]
        shares = np.bincount(under[under >= 0], minlength=number) / seen
        shares[[k, 0, number - 1]] = 0.0  # its own arrow, and those without arrows on both sides
        worst = max(worst, float(shares.max()))
    return worst


@pytest.mark.parametrize("down", [False, True])
@pytest.mark.parametrize("direction", [225.0, 315.0, None, 45.0, 135.0, 0.0, 90.0, 180.0])
@pytest.mark.parametrize(("lane", "box"), [(40.0, NARROW), (76.0, USUAL), (139.0, PHONE)])
def test_a_mark_on_dense_rows_hardly_covers_another_arrow(
    lane: float, box: tuple[int, int, int, int], direction: float | None, down: bool
) -> None:
    """It covered a quarter of the visible part of straight arrows, and a fifth of Pump's diagonals.

    Down to the spacing at which a mark could not be read any more. Of an arrow under another one only a strip is seen.
    Crosses, of notes that nobody plays, stand between the marks of both feet, where there is less room.
    """
    plan = film_plan(np.arange(1.0, 7.0))
    alone = np.zeros(6, np.int16)
    for limbs in DENSE:
        notes = replace(plan.notes, column=alone, limb=np.array(limbs, np.int8))
        score = Score(notes, replace(plan.presses, column=alone), plan.lines)
        drawn = Highway(score, HighwayGeometry(box, lane, 0.0, (direction,), down), parse_scroll("C60"), 120.0, FACE)
        marks, half = drawn.marks, drawn.size / 2
        for apart in np.linspace(marks.least * 1.1, 1.4 * lane, 8).tolist():
            places = marks.places(apart)
            shown = np.flatnonzero(places.size)
            assert {limbs[i] for i in shown} >= set(limbs) - {-1}
            assert covered_share(drawn, 6, apart) <= (0.11 if -1 in limbs else 0.055)
            assert (np.abs(places.below[shown]) + places.size[shown] / 2 <= half + 1e-6).all(), "on its own arrow"
            across = np.where(places.side, places.side * 0.25 * lane, marks.behind(direction)[0])
            assert (np.abs(across) + places.size / 2 <= lane / 2)[shown].all()


@pytest.mark.parametrize("limb", [0, 1])
def test_letters_of_a_small_picture_are_eight_pixels_high_on_diagonals_too(limb: int) -> None:
    """The lane of a pump-single's GIF, 720x404."""
    one = highway([1.0], [limb], 36.0, (0, 0, 230, 378)).marks
    size = one.of(45.0)
    letter = sprites.marker(size, limb, FACE)
    dark = (letter[..., :3].max(axis=2) < 90) & (letter[..., 3] > 250)
    y, x = np.mgrid[:size, :size] + 0.5 - size / 2
    dark &= np.hypot(x, y) < 0.38 * size
    assert np.ptp(np.flatnonzero(dark.any(axis=1))) + 1 >= 8


@pytest.mark.parametrize("hollow", [False, True])
@pytest.mark.parametrize("direction", [0.0, 45.0, 135.0, 225.0, 270.0, 315.0])
def test_the_tail_of_an_arrow_is_darker_than_its_head(direction: float, hollow: bool) -> None:
    """A mark on a tail as bright as the head was taken for the head: diagonal arrows seemed to point backwards."""
    size = 72
    arrow = sprites.arrow(size, direction, (120, 120, 120), hollow)
    y, x = np.mgrid[:size, :size] + 0.5 - size / 2
    a = np.radians(direction)
    ahead, shown = (x * np.sin(a) - y * np.cos(a)) / (size / 2), arrow[..., 3] > 250
    head, tail = (arrow[shown & part][:, :3].max() for part in (ahead > 0.2, ahead < -0.65))
    assert tail < 0.55 * head


@pytest.mark.parametrize("limb", [-1, 0, 1, 2, 3])
def test_a_mark_on_a_note_has_a_light_and_a_dark_rim(limb: int) -> None:
    """Cyan on blue and orange on red were hardly seen."""
    mark = sprites.marker(32, limb, FACE, rim=True).astype(int)[16]
    light, dark = mark[:, :3].min(axis=1) > 180, (mark[:, :3].max(axis=1) < 90) & (mark[:, 3] > 250)
    assert light.any() and dark.any() and np.flatnonzero(light)[0] < np.flatnonzero(dark)[0] < 6
