"""The shoe of a foot behind the other leg is drawn over it, in its colour, and nothing else of the picture changes."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.character.mesh import PREFIX, with_partner
from dancetutor_cli.dance.rig.body import joint_matrices
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.scene.scene import SOLE_RADIUS, Scene, foot_marks
from dancetutor_cli.film.scene.visibility import draw_hidden_feet

SIZE = (640, 480)
GREY = 90


def scene(two: bool = False) -> Scene:
    pad = load_pad("dance-single")
    assert pad is not None
    return Scene(with_partner(load_dancer()) if two else load_dancer(), pad)


def pose(about: Scene, moved: dict[str, tuple[float, float, float]]) -> NDArray[np.float64]:
    """She stands upright; the joints of some legs ("l", "r") are moved by so many metres."""
    skeleton = about.character.skeleton
    rest = np.zeros((1, len(skeleton.names), 4))
    rest[..., 0] = 1.0
    joints = joint_matrices(skeleton, rest, skeleton.rest[:1].astype(np.float64))[0].copy()
    for j, name in enumerate(skeleton.names):
        for leg, by in moved.items():
            if name in {f"{leg}_{part}" for part in ("knee", "talocrural", "metatarsal")}:
                joints[j, :3, 3] += by
    return joints


def drawn(about: Scene, joints: NDArray[np.float64], camera: str = "back") -> NDArray[np.uint8]:
    frame = np.full((SIZE[1], SIZE[0], 3), GREY, np.uint8)
    draw_hidden_feet(frame, about, joints, about.camera(camera, SIZE))
    return frame


def near(frame: NDArray[np.uint8], limb: int) -> int:
    """Pixels that have a foot's colour."""
    return int((np.abs(frame.astype(int) - limb_colours().by_limb[limb]).sum(axis=2) < 40).sum())


def across(about: Scene) -> float:
    """From the left ankle to the right one, metres along x."""
    names, rest = about.character.skeleton.names, about.character.skeleton.rest
    return float(rest[names.index("r_talocrural"), 0] - rest[names.index("l_talocrural"), 0])


@pytest.mark.parametrize("leg", ["l", "r"])
def test_the_foot_behind_is_outlined_in_its_colour(leg: str) -> None:
    about = scene()
    way = across(about) if leg == "l" else -across(about)
    frame = drawn(about, pose(about, {leg: (way, 0.0, -0.28)}))
    hidden = 1 if leg == "l" else 0
    assert near(frame, hidden) > 20
    assert near(frame, 1 - hidden) == 0, "the one before it is seen anyhow"
    assert (frame != GREY).any(axis=2).mean() < 0.005, "thin"


def test_it_is_the_shoe_and_no_ring_around_the_leg() -> None:
    about = scene()
    joints = pose(about, {"l": (across(about), 0.0, -0.28)})
    mark, camera = foot_marks(about, joints)[1], about.camera("back", SIZE)
    assert mark is not None
    rows, columns = np.nonzero((drawn(about, joints) != GREY).any(axis=2))
    line = np.linspace(mark.heel, mark.toe, 50)
    on = camera.project(np.column_stack([line[:, 0], np.full(50, mark.ground + 0.04), line[:, 1]]), SIZE)
    pixels = np.hypot(columns[:, None] + 0.5 - on[:, 0], rows[:, None] + 0.5 - on[:, 1]).min(axis=1)
    metre = camera.focal * SIZE[1] / float(on[:, 2].mean())
    assert 0.03 * metre < pixels.max() < SOLE_RADIUS * metre + 1.0, "a ring is 13 mm outside of the sole"


@pytest.mark.parametrize("by", [(0.0, 0.0, 0.0), (0.0, 0.0, -0.28), (0.0, 0.0, 0.28), (-0.3, 0.0, 0.0)])
def test_feet_beside_each_other_are_not(by: tuple[float, float, float]) -> None:
    about = scene()
    assert (drawn(about, pose(about, {"l": by})) == GREY).all()


def test_a_foot_high_in_the_air_and_one_from_above_are_not() -> None:
    about = scene()
    crossed = {"l": (across(about), 0.0, -0.28)}
    assert (drawn(about, pose(about, crossed), "top") == GREY).all()
    assert (drawn(about, pose(about, {**crossed, "r": (0.0, 0.3, 0.0)})) == GREY).all()


def test_it_fades_in_as_the_leg_comes_before_it() -> None:
    about = scene()
    way = across(about)
    marks = [
        int(np.abs(drawn(about, pose(about, {"l": (way * share, 0.0, -0.28)})).astype(int) - GREY).sum())
        for share in np.linspace(0.0, 1.0, 81)
    ]
    assert marks[0] == 0 < max(marks)
    assert np.abs(np.diff(marks)).max() < 0.25 * max(marks)


def test_the_second_dancers_feet_have_it_too() -> None:
    about = scene(two=True)
    joints = pose(about, {f"{PREFIX}l": (across(about), 0.0, -0.28)})
    aside = [j for j, name in enumerate(about.character.skeleton.names) if name.startswith(PREFIX)]
    joints[aside, 0, 3] += 0.45
    assert near(drawn(about, joints), 1) > 10
