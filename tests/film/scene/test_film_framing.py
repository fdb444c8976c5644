"""How much of the picture dancer, pad and feet have in each layout, on pads of one square and of two."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from film_plans import film_plan

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.clock import Moment
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import FilmLook, load_layout

TALL, JUMP = 1.70, 0.10  # metres


class Framing(NamedTuple):
    """Shares of the picture's height; sides of the pad in that of its width.

    dancer : from the top of her head to the pad's near edge; pad : how high it is; foot : of 26 cm that points to the
    screen, and aside; top : above her head as she jumps; left, right : of the pad
    """

    dancer: float
    pad: float
    foot: tuple[float, float]
    top: float
    left: float
    right: float


def standing(name: str, steps: str) -> Film:
    """She stands in the middle of the pad."""
    pad, layout, skeleton = load_pad(steps), load_layout(name), dancer_skeleton()
    assert pad is not None
    rotations = np.zeros((2, len(skeleton.names), 4))
    rotations[..., 0] = 1.0
    motion = Motion(skeleton, 1.0, np.array([0.0, 10.0]), rotations, np.tile([0.0, 0.94, 0.0], (2, 1)), ())
    plan = film_plan(np.arange(1.0, 1.0 + len(pad)), columns=np.arange(len(pad)))
    look = FilmLook(layout, layout.size, quality="draft", renderer="cpu")
    return Film(replace(plan, look=look, pad=pad, directions=pad.directions, motions={1.0: (motion,)}))


def framing(film: Film) -> Framing:
    """Of a film in which she stands."""
    left, top, right, bottom = film.boxes.box("dancer")
    camera, (width, height) = film._dancer.view(Moment(5.0, 1.0)), film.size
    low, high = film._dancer.scene.extent
    places = [(x, 0.0, z) for x in (low[0], high[0]) for z in (low[2], high[2])]
    places += [(0.0, TALL, 0.0), (0.0, TALL + JUMP, 0.0)]
    places += [(0.0, 0.0, -0.13), (0.0, 0.0, 0.13), (-0.13, 0.0, 0.0), (0.13, 0.0, 0.0)]
    seen = camera.project(np.array(places), (right - left, bottom - top))[:, :2] + [left, top]
    corners, head, jump, (heel, toe, one, other) = seen[:4], seen[4, 1], seen[5, 1], seen[6:]
    near = corners[:, 1].max()
    assert near <= bottom and left <= corners[:, 0].min() and corners[:, 0].max() <= right, "the whole pad"
    return Framing(
        float(near - head) / height,
        float(np.ptp(corners[:, 1])) / height,
        (float(np.linalg.norm(toe - heel)) / height, float(np.linalg.norm(other - one)) / height),
        float(jump) / height,
        float(corners[:, 0].min()) / width,
        float(corners[:, 0].max()) / width,
    )


# The least of dancer, pad, foot to the screen, foot aside. Before: television 0.66, 0.14, 0.040, 0.086 and on doubles
# 0.69, 0.19, 0.040, 0.086; vertical 0.33, 0.092, 0.028, 0.044 and on doubles 0.29, 0.078, 0.024, 0.038.
LEAST = {
    ("television", "dance-single"): (0.76, 0.20, 0.060, 0.090),
    ("television", "dance-double"): (0.75, 0.24, 0.056, 0.084),
    ("television", "pump-double"): (0.75, 0.24, 0.056, 0.084),
    ("vertical", "dance-single"): (0.36, 0.118, 0.036, 0.050),
    ("vertical", "dance-double"): (0.36, 0.118, 0.036, 0.050),
    ("vertical", "pump-double"): (0.36, 0.118, 0.036, 0.050),
    ("side-by-side", "dance-single"): (0.80, 0.22, 0.070, 0.099),
    ("side-by-side", "dance-double"): (0.57, 0.155, 0.048, 0.075),
    ("dancer", "dance-single"): (0.80, 0.22, 0.070, 0.099),
    ("practice", "dance-single"): (0.62, 0.17, 0.053, 0.080),
    ("practice", "pump-double"): (0.44, 0.12, 0.038, 0.057),
    ("background", "dance-single"): (0.85, 0.24, 0.074, 0.105),
}


@pytest.mark.parametrize(("name", "steps"), LEAST)
def test_dancer_pad_and_feet_have_so_much_of_the_picture(name: str, steps: str) -> None:
    dancer, pad, foot_ahead, foot_aside = LEAST[name, steps]
    found = framing(standing(name, steps))
    assert found.dancer >= dancer and found.pad >= pad, found
    assert found.foot[0] >= foot_ahead and found.foot[1] >= foot_aside, found
    assert found.top > 0.0


@pytest.mark.parametrize("steps", ["dance-single", "pump-single", "dance-double", "pump-double"])
def test_the_upper_sixth_of_vertical_is_not_empty(steps: str) -> None:
    """The title stands there, as high as apps let it, and right below it her head."""
    film = standing("vertical", steps)
    assert film.layout.header is not None
    assert film.layout.header.box[1] + 0.03 < framing(film).top < 1 / 6


@pytest.mark.parametrize("steps", ["dance-single", "dance-double", "pump-double"])
def test_the_pad_does_not_cover_the_television(steps: str) -> None:
    """In the picture the screen ends left of it, and is large enough for notes."""
    film = standing("television", steps)
    screen = film._screen
    assert screen is not None
    left, top, right, bottom = screen.place.box.tolist()
    width, height = film.size
    assert (right - left) / width > 0.36 and (bottom - top) / height > 0.55
    assert right / width < framing(film).left + 0.01
