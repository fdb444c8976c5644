"""In doubles the camera goes with her, and a frame is the same whoever draws it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.__main__ import main
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.clock import Moment
from dancetutor_cli.film.notes import PanelLights, Presses
from dancetutor_cli.film.scene.dancer import Dancer, Shot
from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"
ASKED = [
    "--steps-type",
    "dance-double",
    "--section",
    "18:24",
    "--fps",
    "2",
    "-q",
    "--renderer",
    "cpu",
    "--size",
    "160x90",
]


def dancer(
    pad_name: str, camera: str, stands: bool = False, size: tuple[int, int] = (96, 96), first: float = 0.5
) -> Dancer:
    """She is 0.5 m to +x for ten seconds, where she walks to from `first` in two, then 0.5 m to -x."""
    skeleton, times = dancer_skeleton(), np.arange(0.0, 20.0, 0.1)
    rotations = np.zeros((len(times), len(skeleton.names), 4))
    rotations[..., 0] = 1.0
    across = np.where(times < 10, np.maximum(0.5, np.interp(times, [0, 2], [first, 0.5])), -0.5)
    root = np.column_stack([across, np.full_like(times, 0.9), np.zeros_like(times)])
    pad = load_pad(pad_name)
    assert pad is not None
    lights = PanelLights(Presses(*(np.zeros(0) for _ in range(4))), len(pad.panels), 0.3)
    motions = {rate: (Motion(skeleton, 10.0, times / rate, rotations, root, ()),) for rate in (0.5, 1.0)}
    return Dancer(motions, pad, lights, Shot(size, camera, "draft", "cpu", stands=stands))


@pytest.mark.parametrize("rate", [1.0, 0.5])
@pytest.mark.parametrize("camera", ["back", "front"])
def test_the_camera_goes_with_her_in_doubles(camera: str, rate: float) -> None:
    who = dancer("dance-double", camera)
    for second, x in ((2.0, 0.5), (18.0, -0.5)):
        place = np.array([[x, 0.9, 0.0]])
        assert abs(who.view(Moment(second, rate)).project(place, (96, 96))[0, 0] - 48) < 12
        assert abs(who.camera.project(place, (96, 96))[0, 0] - 48) > 12


@pytest.mark.parametrize(
    ("pad", "camera", "stands"),
    [
        ("dance-single", "back", False),
        ("dance-double", "back", True),
        ("dance-double", "top", False),
        ("dance-double", "side", False),
        ("dance-double", "0,2,-4/0,1,0", False),
    ],
)
def test_other_cameras_stand(pad: str, camera: str, stands: bool) -> None:
    who = dancer(pad, camera, stands)
    assert who.view(Moment(2.0)) == who.view(Moment(18.0)) == who.camera


@pytest.mark.parametrize("pad_name", ["dance-double", "pump-double"])
@pytest.mark.parametrize("camera", ["back", "front"])
def test_the_pad_of_a_double_is_never_cut(pad_name: str, camera: str) -> None:
    who, size = dancer(pad_name, camera, size=(666, 672)), (666, 672)
    low, high = who.scene.extent
    corners = np.array([(x, high[1], z) for x in (low[0], high[0]) for z in (low[2], high[2])])
    for second in (2.0, 10.0, 18.0):
        seen = who.view(Moment(second)).project(corners, size)[:, 0]
        assert seen.min() >= -1
        assert seen.max() <= size[0] + 1
    assert who.view(Moment(2.0)).pan != who.view(Moment(18.0)).pan


@pytest.mark.parametrize(
    ("pad_name", "size", "first"), [("dance-double", (666, 672), 1.35), ("dance-single", (461, 672), 0.95)]
)
def test_pad_and_a_dancer_who_walks_on_are_seen_whole(pad_name: str, size: tuple[int, int], first: float) -> None:
    """The camera stands as much farther away as it must, and no more than it may."""
    who, near = dancer(pad_name, "back", size=size, first=first), dancer(pad_name, "back", size=size, first=0.0)
    low, high = who.scene.extent
    pad = np.array([(x, y, z) for x in (low[0], high[0]) for y in (high[1], 0) for z in (low[2], high[2])])
    for second in np.arange(0.0, 9.0, 0.1):
        view = who.view(Moment(float(second)))
        root = who.joints([Moment(float(second))])[0, 0, :3, 3]
        hands = root + np.array([[0.4, 0, 0], [-0.4, 0, 0]])
        seen = view.project(np.vstack([pad, hands]), size)[:, 0]
        assert seen.min() >= -1
        assert seen.max() <= size[0] + 1
    away = [float(np.linalg.norm(np.array(one.view(Moment(5.0)).position))) for one in (near, who)]
    assert 1.02 < away[1] / away[0] < 1.2


def test_the_followed_frame_is_the_same_whoever_draws_it(tmp_path: Path) -> None:
    for jobs in ("1", "2"):
        with pytest.raises(SystemExit) as stop:
            main(["render", str(DEMO), *ASKED, "--frames", str(tmp_path / jobs), "--jobs", jobs])
        assert stop.value.code == 0
    names = sorted(p.name for p in (tmp_path / "1").iterdir())
    assert len(names) == 17  # more than one segment of work, and the rest after it
    for name in names:
        assert (tmp_path / "1" / name).read_bytes() == (tmp_path / "2" / name).read_bytes()
