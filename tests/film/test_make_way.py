"""Words are not drawn over her while she walks on or off, and stand while she dances."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from film_plans import film_plan
from numpy.typing import NDArray

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.character.mesh import rest_vertices
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig.body import joint_matrices
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.clock import Clock, Pass
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.notes import Callout, Presses
from dancetutor_cli.film.placement import PASSING_STEP, WORDS_FADE, stay_of
from dancetutor_cli.film.scene.camera import Camera
from dancetutor_cli.film.scene.visibility import Silhouette

SIZE = (320, 180)
CALL = Callout(4.0, 8.0, "right foot: heel down-right, toe centre", "move", 3.0, 4.0, "heel down-right, toe centre")


def presses(*seconds: float) -> Presses:
    at = np.array(seconds)
    return Presses(at, at, np.zeros(len(at), np.int16), np.zeros(len(at), np.int8))


def test_words_come_when_she_has_passed_and_go_before_she_comes_back() -> None:
    def covered(seconds: NDArray[np.float64], step: float) -> NDArray[np.bool_]:
        return (seconds < 2.0) | (seconds > 18.0)

    one = stay_of(Pass(0.0, 20.0), presses(5.0, 15.0), covered)
    assert one.opacity(0.0) == one.opacity(1.99) == one.opacity(18.01) == one.opacity(20.0) == 0
    assert all(
        one.opacity(t) == 1
        for t in (2.0 + 2 * PASSING_STEP + WORDS_FADE, 5.0, 10.0, 15.0, 18.0 - 2 * PASSING_STEP - WORDS_FADE)
    )


def test_words_that_nobody_passes_always_stand() -> None:
    assert stay_of(Pass(0.0, 20.0), presses(), lambda t, _: t > 0).opacity(1.0) == 1
    assert stay_of(Pass(6.0, 9.0), presses(5.0, 15.0), lambda t, _: t > 0).opacity(6.0) == 1
    assert stay_of(Pass(0.0, 20.0), presses(5.0), lambda t, _: t < 0).opacity(0.0) == 1


def test_at_half_speed_they_come_as_slowly_as_at_full() -> None:
    one = stay_of(Pass(0.0, 20.0, 0.5), presses(5.0), lambda t, _: t < 2.0)
    ramp = [t for t in np.arange(2.0, 3.0, 0.001) if 0 < one.opacity(t) < 1]
    assert ramp[-1] - ramp[0] == pytest.approx(0.5 * WORDS_FADE, abs=0.01)


def test_all_of_her_is_inside_her_silhouette() -> None:
    who = load_dancer()
    rest = np.zeros((1, len(who.skeleton.names), 4))
    rest[..., 0] = 1.0
    camera = Camera((0.0, 1.0, -4.0), (0.0, 1.0, 0.0), 1.2)
    joints = joint_matrices(who.skeleton, rest, who.skeleton.rest[:1].astype(np.float64))[0]
    outline, size = Silhouette(who), (320, 320)
    for x, y, _ in camera.project(rest_vertices(who)[::97], size):
        assert outline.behind([(x - 0.5, y - 0.5, x + 0.5, y + 0.5)], joints, camera, size)
    assert not outline.behind([(0, 0, 20, 320), (300, 0, 320, 320)], joints, camera, size)


def walked(layout: str, start: float, away: bool) -> Film:
    """She stands `start` m left of the pad's middle for 2 s, is there after 3 s, steps at 5 s and 7 s, and leaves."""
    skeleton, times = dancer_skeleton(), np.arange(0.0, 12.0, 0.1)
    rotations = np.zeros((len(times), len(skeleton.names), 4))
    rotations[..., 0] = 1.0
    x = np.interp(times, (2.0, 3.0, 8.0, 9.0), (start, 0.0, 0.0, start if away else 0.0))
    root = np.column_stack([x, np.full_like(times, 0.94), np.full_like(times, -0.5)])
    plan = film_plan(np.array([5.0, 7.0]), Clock((Pass(0.0, 11.0),), 4))
    motion = Motion(skeleton, 10.0, times, rotations, root, ())
    look = FilmLook(load_layout(layout), SIZE, quality="draft", renderer="cpu")
    return Film(replace(plan, look=look, motions={1.0: (motion,)}, pad=load_pad("dance-single")))


@pytest.mark.parametrize(("layout", "start"), [("side-by-side", 1.1), ("dancer", 1.7)])
def test_the_legend_waits_until_she_has_walked_past_it(layout: str, start: float) -> None:
    film = walked(layout, start, away=True)
    look = replace(film.plan.look, layout=replace(film.layout, legend=None))
    words = Film(replace(film.plan, look=look))
    left, top, right, bottom = (round(edge) for edge in film.placement.legend.boxes[0])  # type: ignore[union-attr]
    for number in (0, 4, 8, 12, 20, 28, 40):
        one, bare = (each.frame(number)[top:bottom, max(0, left) : right] for each in (film, words))
        assert (one != bare).any() == (12 <= number < 32), number


def test_from_the_other_side_the_legend_stands_all_the_time() -> None:
    film = walked("side-by-side", -1.1, away=True)
    legend = film.placement.legend
    assert legend is not None
    assert film._stay(legend, 0).opacity(0.0) == film._stay(legend, 0).opacity(10.0) == 1


def test_words_beside_her_picture_do_not_wait_for_her() -> None:
    """In the practice layout the speed of the run stands beside it, however far out she begins."""
    film = walked("practice", -2.5, away=True)
    runs = replace(film.plan, clock=Clock((Pass(0.0, 11.0, 0.5),), 4), motions={0.5: film.plan.motions[1.0]})
    film = Film(runs)
    assert film.placement.runs.boxes and film.placement.runs.boxes[0][0] > film.boxes.box("dancer")[2]
    assert film._stay(film.placement.runs, 0).opacity(0.0) == 1


def test_what_is_called_out_on_a_phone_does_not_cover_her_head() -> None:
    film, size = walked("vertical", 0.0, away=False), (1080, 1920)
    film = Film(replace(film.plan, look=replace(film.plan.look, size=size), callouts=(CALL,)))
    calls, (left, top, right, bottom) = film.placement.calls, film.boxes.box("dancer")
    assert calls is not None and film.placement.header is not None
    said = calls._sprite(CALL.text, CALL.severity).shape
    box = (calls.box[2] - said[1] - left, calls.box[1] - top, calls.box[2] - left, calls.box[1] + said[0] - top)
    joints, who = film._joints.at(20), film._dancer
    outline = Silhouette(who.scene.character)
    assert not outline.behind([box], joints, who.camera, (right - left, bottom - top))
    assert box[0] + left >= max(line[2] for part in film.placement.header.parts for line in part.boxes)


def test_a_title_of_one_line_is_always_there() -> None:
    film = walked("side-by-side", 1.1, away=False)
    assert film.placement.header is not None
    title, below = film.placement.header.parts
    assert len(title.lines) == 1 and film._stay(title, 0).opacity(0.0) == 1
    assert film._stay(below, 0).opacity(0.0) == 0


def titled(layout: str) -> Film:
    film = walked(layout, 1.1 if layout == "side-by-side" else 0.55, away=False)
    words = replace(film.plan.words, title="A Title of Many Words That Go On and On and On")
    look = replace(film.plan.look, size=(270, 480)) if layout == "vertical" else film.plan.look
    return Film(replace(film.plan, words=words, look=look))


def test_a_title_of_several_lines_makes_way_for_her() -> None:
    """Its second line would go through her head as she walks on."""
    film = titled("side-by-side")
    assert film.placement.header is not None
    title, _ = film.placement.header.parts
    assert len(title.lines) > 1
    assert title.boxes[0][1] == film.placement.header.top
    stays = film._stay(title, 0)
    assert stays.opacity(0.0) == 0 and stays.opacity(5.0) == 1
    picture = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    title.draw(picture, 0.0)
    assert not picture.any()
    title.draw(picture, 1.0)
    assert picture[: round(film.placement.header.title_end[1])].any()


def test_on_a_phone_a_title_stands_from_the_first_picture_on() -> None:
    """It stands above her head even in two lines; what is below it waits until she has walked past."""
    film = titled("vertical")
    assert film.placement.header is not None
    title, below = film.placement.header.parts
    assert len(title.lines) > 1
    assert film._stay(title, 0).opacity(0.0) == 1
    assert film._stay(below, 0).opacity(0.0) == 0
