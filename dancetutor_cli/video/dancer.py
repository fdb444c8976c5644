"""The dancer's part of the picture: from a motion and a second of the music to a state for the renderer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character import load_dancer
from dancetutor_cli.motion.sampling import sample
from dancetutor_cli.rig.kinematics import joint_matrices
from dancetutor_cli.video import renderer
from dancetutor_cli.video.blit import Frame
from dancetutor_cli.video.camera import WHOLE, Region
from dancetutor_cli.video.diagram import Foot
from dancetutor_cli.video.follow import Follow, is_wide
from dancetutor_cli.video.look import default_look
from dancetutor_cli.video.props import JOINT, bar_matrix, with_bar
from dancetutor_cli.video.scene import FootMark, FrameState, Scene, foot_marks
from dancetutor_cli.video.stage import PANEL

if TYPE_CHECKING:
    from dancetutor_cli.character.model import Character
    from dancetutor_cli.motion.model import Motion
    from dancetutor_cli.video.camera import Camera
    from dancetutor_cli.video.lights import PanelLights
    from dancetutor_cli.video.stage import PadLike


class Dancer:
    """Draws the dancer at any second. Made in the process that draws: it may hold a GL context.

    region : share of the picture that she fills
    stands : the camera may not follow her, because something else in the picture is drawn for one place
    """

    def __init__(
        self,
        motion: Motion,
        pad: PadLike,
        lights: PanelLights,
        size: tuple[int, int],
        camera: str,
        quality: renderer.Quality,
        kind: renderer.RendererKind,
        character: Character | None = None,
        region: Region = WHOLE,
        stands: bool = False,
    ) -> None:
        self.motion, self.lights = motion, lights
        floor = -default_look().stage.pad_height
        self.scene = Scene(with_bar(character or load_dancer(), motion.bar, floor), pad)
        self.camera: Camera = self.scene.camera(camera, size, region)
        self._follow = None if stands else self._follower(camera, size, region)
        self.renderer = renderer.create(self.scene, size, quality, kind)
        skeleton, names = self.scene.character.skeleton, motion.skeleton.names
        self._ours = np.array([j for j, name in enumerate(skeleton.names) if name in names])
        self._theirs = np.array([names.index(skeleton.names[j]) for j in self._ours])

    def frame(self, second: float, joints: NDArray[np.float64]) -> Frame:
        """The picture at `second` of the music, uint8 (h, w, 3); overwritten by the next call."""
        lit, by = self._lit(second)
        return self.renderer.frame(FrameState(joints, self.view(second), lit, by))

    def view(self, second: float) -> Camera:
        """The camera at `second`: the standing one, or the one that follows her across a wide pad."""
        return self.camera if self._follow is None else self._follow.at(second)

    def _follower(self, camera: str, size: tuple[int, int], region: Region) -> Follow | None:
        """The camera that goes with her across a wide pad, if it looks along the pad's short side.

        It is made from the motion of the whole film, so that a frame does not depend on which process draws it.
        """
        look = self.scene.look
        along = abs(float(self.camera.axes()[0][0])) > look.follow.along
        named = camera in look.cameras
        if not (named and along and is_wide(self.scene)) or self.camera.feet_only:
            return None
        if region == WHOLE:
            region = look.follow.region
        return Follow(self.scene, camera, size, self.motion.times, self.motion.root, region)

    def still(self) -> Frame:
        """The room without the dancer."""
        joints = self.joints(np.zeros(1))[0]
        joints[:, 1, 3] += 1000.0
        nobody = np.zeros(self.scene.panels)
        return self.renderer.frame(FrameState(joints, self.camera, nobody, nobody.astype(np.int64))).copy()

    def feet(self, joints: NDArray[np.float64]) -> tuple[Foot | None, Foot | None]:
        """Both feet from above, in panel widths of the pad."""
        left, right = foot_marks(self.scene, joints)
        return self._foot(left), self._foot(right)

    def _foot(self, mark: FootMark | None) -> Foot | None:
        if mark is None:
            return None
        cx, cy = self.scene.pad.centre
        heel, toe = ((cx - x / PANEL, cy + z / PANEL) for x, z in (mark.heel, mark.toe))
        return Foot(heel, toe, mark.height)

    def joints(self, seconds: NDArray[np.float64]) -> NDArray[np.float64]:
        """World matrices (f, j, 4, 4) of the character's joints at `seconds` (f,).

        Joints go by name: a character's file may order them its own way.
        """
        skeleton = self.scene.character.skeleton
        sampled, root = sample(self.motion, seconds)
        rotations = np.zeros((len(seconds), len(skeleton.names), 4))
        rotations[..., 0] = 1.0
        rotations[:, self._ours] = sampled[:, self._theirs]
        out = joint_matrices(skeleton, rotations, root)
        if self.motion.bar is not None:
            out[:, skeleton.index(JOINT)] = bar_matrix(self.motion.bar)
        return out

    def _lit(self, second: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        levels = [self.lights.at(column, second) for column in range(self.scene.panels)]
        return np.array([level for level, _ in levels]), np.array([max(0, limb) for _, limb in levels])
