"""What is called out covers neither her head nor her feet, wherever she goes and however high she jumps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from film_plans import film_plan

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.clock import Clock, Pass
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.notes import Callout, Presses
from dancetutor_cli.film.placement import MOMENT_STEP, MOST_MOMENTS, call_moments, clear_part, step_moments
from dancetutor_cli.run.reading import config_names

BOX = (100, 10, 300, 60)


def taken(*boxes: tuple[float, float, float, float]) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    return np.array(boxes, dtype=np.float64).reshape(-1, 4)


def test_a_box_that_nobody_comes_into_stays() -> None:
    assert clear_part(BOX, taken(), 80) == BOX
    assert clear_part(BOX, taken((120, 60, 180, 90), (20, 0, 100, 90)), 80) == BOX


def test_a_box_begins_behind_her_head_where_there_is_room() -> None:
    assert clear_part(BOX, taken((120, 40, 180.5, 90)), 80) == (181, 10, 300, 60)


def test_without_room_it_stands_below_her_head() -> None:
    left, top, right, bottom = clear_part(BOX, taken((120, 40, 250, 90), (120, 200, 180, 300)), 80)
    assert (left, right) == (100, 300) and top == 90 and bottom == 140


def test_without_any_room_it_stands_on_her_left_or_as_it_was() -> None:
    assert clear_part(BOX, taken((190, 0, 290, 500)), 80) == (100, 10, 190, 60)
    assert clear_part(BOX, taken((110, 0, 290, 500)), 80) == BOX


def callout(begin: float, second: float, end: float, text: str = "crossover") -> Callout:
    return Callout(second, second, text, "move", begin, end, text)


def test_moments_are_those_in_which_something_is_called_out() -> None:
    told = [callout(1.0, 2.0, 2.0), callout(1.5, 3.0, 4.0), callout(90.0, 91.0, 91.0)]
    found = call_moments(told, [Pass(0.0, 80.0)])
    seconds = np.array([one.second for one in found])
    assert seconds.min() == 1.0 and 3.8 < seconds.max() < 4.0 and (np.diff(seconds) > 0).all()
    twice = call_moments(told, [Pass(0.0, 80.0, 0.5), Pass(0.0, 80.0), Pass(0.0, 80.0)])
    assert [one.rate for one in twice] == [0.5] * len(found) + [1.0] * len(found)
    assert len(call_moments([callout(0.0, 900.0, 9000.0)], [Pass(0.0, 9000.0)])) <= MOST_MOMENTS
    assert call_moments([], [Pass(0.0, 9.0)]) == call_moments([callout(9.0, 10.0, 10.0)], [Pass(0.0, 5.0)]) == []


def test_without_a_step_she_stands_there_for_a_whole_run() -> None:
    """The song's words keep off her head then, too."""
    run = Pass(10.0, 12.0)
    for steps in ([], [3.0], [15.0, 16.0]):
        at = np.array(steps)
        presses = Presses(at, at, np.zeros(len(at), np.int16), np.zeros(len(at), np.int8))
        assert [moment.second for moment in step_moments(presses, [run])] == pytest.approx(
            np.arange(10.0, 12.0, MOMENT_STEP)
        )
    at = np.array([11.0, 20.0])
    danced = step_moments(Presses(at, at, np.zeros(2, np.int16), np.zeros(2, np.int8)), [run])
    assert danced[0].second == 11.0 and len(danced) == round(1.0 / MOMENT_STEP)


def jumping(layout: str, camera: str | None) -> Film:
    """She goes from the pad's left to its right and jumps half a metre; something long is called out all the time."""
    skeleton, times = dancer_skeleton(), np.arange(0.0, 8.0, 0.05)
    rotations = np.zeros((len(times), len(skeleton.names), 4))
    rotations[..., 0] = 1.0
    root = np.column_stack([0.3 * np.sin(times), 0.94 + 0.5 * np.maximum(0, np.sin(3 * times)), np.zeros_like(times)])
    plan = film_plan(np.array([1.0, 7.0]), Clock((Pass(0.0, 8.0),), 6))
    part = load_layout(layout)
    look = FilmLook(part, part.size, quality="draft", renderer="cpu", camera=camera)
    motion = Motion(skeleton, 20.0, times, rotations, root, ())
    said = callout(0.0, 1.0, 8.0, "right foot: heel on right, toe on up ×3, footswitch")
    return Film(replace(plan, look=look, motions={1.0: (motion,)}, pad=load_pad("dance-single"), callouts=(said,)))


CAMERAS = (None, "front", "front-high", "three-quarter", "side")
CASES = [
    (n, c) for n in config_names("layouts") if load_layout(n).dancer for c in CAMERAS if c is None or n != "television"
]


@pytest.mark.parametrize(("layout", "camera"), CASES)
def test_calls_cover_neither_head_nor_feet(layout: str, camera: str | None) -> None:
    film = jumping(layout, camera)
    calls = film.placement.calls
    assert calls is not None
    one, (left, top, _, _) = film.plan.callouts[0], film.boxes.box("dancer")
    said = calls._sprite(one.text, one.severity).shape
    box = (calls.box[2] - said[1], calls.box[1], calls.box[2], calls.box[1] + said[0])
    seen = film._dancer.heads_and_feet([film.plan.clock.moment(k) for k in range(film.plan.clock.frames)])
    seen += np.array([left, top, left, top])
    assert len(seen) == 5 * film.plan.clock.frames, "the head, and both halves of two feet"
    within = (seen[:, 0] < box[2]) & (seen[:, 2] > box[0]) & (seen[:, 1] < box[3]) & (seen[:, 3] > box[1])
    assert not within.any()
    assert box[0] >= 0 and box[2] <= film.size[0]


@pytest.mark.parametrize(
    "words", [("Unity", "Simple Crossovers Edition"), ("A Title of Many Words", ""), ("Adore", "")]
)
@pytest.mark.parametrize(("layout", "camera"), [("side-by-side", None), ("side-by-side", "front"), ("vertical", None)])
def test_the_songs_words_end_before_her_head(layout: str, camera: str | None, words: tuple[str, str]) -> None:
    """As she crosses over to the left and jumps; a title of one line stands above her."""
    film = jumping(layout, camera)
    title, subtitle = words
    told = replace(
        film.plan.words, title=title, subtitle=subtitle, artist="Somebody & Others", detail="pump-single · 90 BPM"
    )
    (motion,) = film.plan.motions[1.0]
    root = motion.root * [1.4, 1.0, 1.0] - [0.0, 0.06, 0.0]
    film = Film(replace(film.plan, words=told, motions={1.0: (replace(motion, root=root),)}))
    left, top, _, _ = film.boxes.box("dancer")
    seen = film._dancer.heads_and_feet([film.plan.clock.moment(k) for k in range(6, 42)]) + np.array([left, top] * 2)
    assert film.placement.header is not None
    for number, (ink, x, y) in enumerate(film.placement.header.lines):
        if number == 0 and len(film.placement.header.parts[0].lines) == 1:
            continue
        within = (seen[:, 0] < x + ink.shape[1] - 6 * film.scale) & (seen[:, 2] > x)
        within &= (seen[:, 1] < y + 0.8 * ink.shape[0]) & (seen[:, 3] > y + 0.2 * ink.shape[0])
        assert not within.any(), number
