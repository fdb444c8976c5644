"""A film of a motion without a chart: the character on a bare floor, the camera goes along."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.jobs.render import work_folder
from dancetutor_cli.motion.sampling import sample
from dancetutor_cli.numerics.smoothing import low_pass
from dancetutor_cli.rig.kinematics import joint_matrices
from dancetutor_cli.video.media.encoder import Encoding, encode_segment, join
from dancetutor_cli.video.scene import renderer
from dancetutor_cli.video.scene.camera import Camera
from dancetutor_cli.video.scene.scene import FrameState, Scene
from dancetutor_cli.video.scene.stage import PANEL

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.motion.baked import Motion
    from dancetutor_cli.video.picture import Frame

SIZE, FPS = (720, 720), 30
EYE = np.array([1.5, 0.45, 3.1])  # from what the camera looks at, metres
LOOK = 0.9  # height that it looks at, metres
FOCAL, ALONG = 1.35, 0.4  # focal length in picture heights; hertz below which the camera goes along
ROOM = 2.0  # panels of floor around her way


@dataclass(frozen=True, slots=True)
class _Floor:
    """A pad of tiles without arrows, as large as her way."""

    panels: NDArray[np.float64]
    arrows: NDArray[np.float64]
    centre: tuple[float, float]


def film(path: Path, character: Character, motion: Motion) -> int:
    """Write an .mp4 and return its frames; nothing is left if that fails. Raises FileError or UnavailableError."""
    count = max(1, int((motion.times[-1] - motion.times[0]) * FPS) + 1)
    encoding = Encoding("mp4", SIZE, FPS, "good")
    with work_folder(path) as folder:
        part, whole = folder / f"part{encoding.format.segment}", folder / "film.mp4"
        encode_segment(_frames(character, motion, count), encoding, part)
        join([part], encoding, None, folder, whole)
        whole.replace(path)
    return count


def _frames(character: Character, motion: Motion, count: int) -> Iterator[Frame]:
    times = motion.times[0] + np.arange(count) / FPS
    rotations, root = sample(motion, times)
    scene = Scene(character, _floor(root))
    draw = renderer.create(scene, SIZE, "good", "cpu")
    slow = low_pass(root, FPS, ALONG)
    nobody = np.zeros(scene.panels)
    joints = joint_matrices(character.skeleton, rotations, root)
    for k in range(count):
        x, z = float(slow[k, 0]), float(slow[k, 2])
        eye = (x + float(EYE[0]), LOOK + float(EYE[1]), z + float(EYE[2]))
        yield draw.frame(FrameState(joints[k], Camera(eye, (x, LOOK, z), FOCAL), nobody, nobody.astype(np.int64)))
    draw.close()


def _floor(root: NDArray[np.float64]) -> _Floor:
    low, high = root[:, [0, 2]].min(axis=0) / PANEL, root[:, [0, 2]].max(axis=0) / PANEL
    corners = np.array([[-high[0] - ROOM, low[1] - ROOM], [-low[0] + ROOM, high[1] + ROOM]])
    return _Floor(np.round(corners), np.zeros((2, 2)), (0.0, 0.0))
