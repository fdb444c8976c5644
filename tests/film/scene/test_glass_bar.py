"""The bar between camera and dancer lets feet and panels be seen, and the camera goes as without it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from dancetutor_cli.dance.context import bar_of
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.settings import load_settings
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.clock import Moment
from dancetutor_cli.film.notes import PanelLights, Presses
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.film.scene.camera import with_pan_range
from dancetutor_cli.film.scene.dancer import Dancer, Shot
from dancetutor_cli.film.scene.props import EDGE, INSIDE, STEEL, GlassBar

SIZE = (320, 240)
GREY = 20


def dancer(camera: str, bar: bool, size: tuple[int, int] = (96, 96)) -> Dancer:
    """She stands on the left of a double pad, before or without its bar."""
    skeleton, times = dancer_skeleton(), np.arange(0.0, 4.0, 0.1)
    rotations = np.zeros((len(times), len(skeleton.names), 4))
    rotations[..., 0] = 1.0
    root = np.column_stack([np.full_like(times, 0.75), np.full_like(times, 0.9), np.zeros_like(times)])
    pad = load_pad("dance-double")
    assert pad is not None
    lights = PanelLights(Presses(*(np.zeros(0) for _ in range(4))), len(pad.panels), 0.3)
    motion = Motion(skeleton, 10.0, times, rotations, root, ())
    if bar:
        motion = replace(motion, bar=bar_of(pad, load_settings().bar))
    return Dancer({1.0: (motion,)}, pad, lights, Shot(size, camera, "draft", "cpu"))


def with_and_without(camera: str) -> tuple[Frame, Frame]:
    moment, frames = Moment(1.0, 1.0), []
    for one in (dancer(camera, bar=True, size=SIZE), dancer(camera, bar=False, size=SIZE)):
        frames.append(one.frame(moment, one.joints([moment])[0]).copy())
    return frames[0], frames[1]


@pytest.mark.parametrize("camera", ["back", "-1.7,2.2,-3.7/0,0.8,0"])
def test_what_is_behind_the_bar_is_seen_through_it(camera: str) -> None:
    seen, bare = (frame.astype(float) for frame in with_and_without(camera))
    changed = (seen != bare).any(axis=2)
    assert 0.01 < changed.mean() < 0.25, "a bar, no more"
    share = (seen - bare) / np.where(
        np.abs(255 * np.array(STEEL[:3]) - bare) < 40, np.inf, 255 * np.array(STEEL[:3]) - bare
    )
    assert share.min() > -0.02, "no shadow"
    assert share.max() < EDGE[1] + 0.02
    low = np.s_[int(0.8 * SIZE[1]) :]
    assert share[low].max() < EDGE[0] + 0.02, "posts are fainter than the rail"
    assert np.median(share[low][share[low] > 0.03]) < INSIDE[1]


def test_behind_her_it_is_steel() -> None:
    about = dancer("front", bar=True)
    assert "bar" in about.scene.character.skeleton.names
    assert "bar" not in dancer("back", bar=True).scene.character.skeleton.names


def test_from_above_there_is_none() -> None:
    seen, bare = with_and_without("top")
    assert (seen == bare).all()


@pytest.mark.parametrize("camera", ["back", "front"])
def test_the_camera_goes_as_without_a_bar(camera: str) -> None:
    """It took the bar for her arm, and went so far aside that the pad's other half was cut."""
    moment = Moment(1.0, 1.0)
    assert dancer(camera, bar=True).view(moment) == dancer(camera, bar=False).view(moment)


def test_it_moves_with_the_picture() -> None:
    pad = load_pad("dance-double")
    assert pad is not None
    about = dancer("back", bar=False, size=SIZE)
    glass = GlassBar(bar_of(pad, load_settings().bar), -0.05, SIZE)
    camera = with_pan_range(about.camera, -0.25, 0.25)

    def drawn(pan: float) -> NDArray[np.uint8]:
        frame = np.full((SIZE[1], SIZE[0], 3), GREY, np.uint8)
        glass.draw(frame, replace(camera, pan=pan))
        return frame

    still, moved = drawn(0.0), drawn(0.1)
    by = round(0.1 * SIZE[0])
    assert (still != GREY).any()
    assert (moved[:, by:] == still[:, :-by]).all()
    assert (drawn(-0.1)[:, :-by] == still[:, by:]).all()
