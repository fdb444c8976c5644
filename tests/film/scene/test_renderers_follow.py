"""The camera that follows the dancer across a double pad."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import renderers_scene as rs

from dancetutor_cli.film.scene.follow import Follow, RootTrack, is_wide
from dancetutor_cli.film.scene.renderer import create

SIZE = (640, 360)


def _walk(seconds):
    """From the left pad's middle to the right one's, in jerks, and back."""
    x = 0.42 * np.sign(np.sin(seconds / 5)) + 0.1 * np.sign(np.sin(9 * seconds))
    return np.column_stack([x, np.full_like(x, 0.9), np.zeros_like(x)])


@pytest.fixture(scope="module")
def follow():
    seconds = np.linspace(3.0, 60.0, 2000)
    return Follow(rs.scene("dance-double"), "back", SIZE, RootTrack(seconds, _walk(seconds)))


def test_only_wide_pads_are_followed():
    assert is_wide(rs.scene("dance-double")) and is_wide(rs.scene("pump-halfdouble"))
    assert not is_wide(rs.scene("dance-single")) and not is_wide(rs.scene("pump-single"))


def test_she_stays_near_the_middle_of_the_picture(follow):
    for second in (5.0, 12.0, 20.0, 37.0, 55.0):
        root = _walk(np.array([second]))
        x = follow.at(second).project(root, SIZE)[0, 0]
        assert 0.35 * SIZE[0] < x < 0.65 * SIZE[0]
        fixed = replace(follow.camera, pan=0.0).project(root, SIZE)[0, 0]
        assert abs(x - SIZE[0] / 2) < abs(fixed - SIZE[0] / 2)


def test_it_is_slow_and_smooth(follow):
    seconds = np.arange(3.0, 60.0, 1 / 30)
    pans = np.array([follow.at(s).pan for s in seconds]) * SIZE[0]
    speed = np.diff(pans) * 30
    assert np.ptp(pans) > 50
    assert np.abs(speed).max() < 0.25 * SIZE[0]  # pixels a second
    assert np.abs(np.diff(speed)).max() < 4


def test_it_never_leaves_the_range_that_is_drawn_and_stands_at_both_ends(follow):
    low, high = follow.camera.pan_range
    pans = [follow.at(s).pan for s in np.arange(-10.0, 80.0, 0.37)]
    assert low <= min(pans) and max(pans) <= high and low < 0 < high
    assert follow.at(-10.0).pan == follow.at(3.0).pan
    assert follow.at(80.0).pan == follow.at(60.0).pan


@pytest.mark.parametrize("name", ["back", "front"])
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("size", [(787, 672), (461, 672), (420, 420)])
def test_a_dancer_who_walks_on_is_in_the_picture_from_the_first_frame(name, side, size):
    """On a pad that is not followed: from 1.2 m beside its middle, and off again; on the pad the camera stands."""
    seconds = np.linspace(0.0, 20.0, 400)
    x = side * np.interp(seconds, (0.0, 2.0, 16.0, 18.0), (1.2, 0.0, 0.0, 1.2))
    roots = np.column_stack([x, np.full_like(x, 0.9), np.zeros_like(x)])
    camera = Follow(rs.scene("dance-single"), name, size, RootTrack(seconds, roots))
    for second in np.arange(0.0, 20.0, 0.1):
        at = side * np.interp(second, (0.0, 2.0, 16.0, 18.0), (1.2, 0.0, 0.0, 1.2))
        hands = np.array([[at + aside, 0.9, 0.0] for aside in (-0.4, 0.4)])
        seen = camera.at(second).project(hands, size)[:, 0]
        assert seen.min() > -1 and seen.max() < size[0] + 1
    assert camera.at(3.5).pan == camera.at(9.0).pan == camera.at(14.5).pan == 0
    speed = np.diff([camera.at(s).pan for s in np.arange(0.0, 20.0, 1 / 30)]) * 30
    assert np.abs(np.diff(speed)).max() < 0.05, "it starts and stops softly"


def test_of_two_both_are_shown_as_they_walk_on():
    seconds, size = np.linspace(0.0, 20.0, 400), (666, 672)
    places = [np.interp(seconds, (0.0, 3.0), (x, x - 1.4)) for x in (1.0, 1.9)]
    roots = np.array([np.column_stack([x, np.full_like(x, 0.9), np.zeros_like(x)]) for x in places])
    camera = Follow(rs.scene("dance-double"), "back", size, RootTrack(seconds, roots))
    for second in (0.0, 0.4, 1.0, 3.0):
        for x in places:
            hands = np.array([[np.interp(second, seconds, x) + aside, 0.9, 0.0] for aside in (-0.4, 0.4)])
            seen = camera.at(second).project(hands, size)[:, 0]
            assert seen.min() > -1 and seen.max() < size[0] + 1
    assert camera.at(8.0).pan == 0


def test_it_is_nearer_than_the_camera_that_shows_the_whole_pad(follow):
    tall = (360, 640)
    scene = rs.scene("dance-double")
    near = Follow(scene, "back", tall, RootTrack(np.array([0.0, 1.0]), np.zeros((2, 3)))).camera
    whole = scene.camera("back", tall)
    assert np.linalg.norm(near.position) < 0.9 * np.linalg.norm(whole.position)


def test_its_frames_need_the_room_only_once(follow, monkeypatch):
    from dancetutor_cli.film.scene.cpu import renderer as module

    drawn = []
    original = module.draw_background
    monkeypatch.setattr(module, "draw_background", lambda *a: drawn.append(a) or original(*a))
    scene = rs.scene("dance-double")
    cpu = create(scene, SIZE, "good", "cpu")
    state = rs.state(scene, "step", "back", SIZE)
    frames = [cpu.frame(replace(state, camera=follow.at(s))).copy() for s in (5.0, 15.0, 20.0)]
    assert len(drawn) == 1
    assert (frames[0] != frames[1]).any()
