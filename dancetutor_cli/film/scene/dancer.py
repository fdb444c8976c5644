"""The dancer's part of the picture, which draws her state at a moment of the music."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.character.mesh import PREFIX, with_partner
from dancetutor_cli.dance.motion import sample
from dancetutor_cli.dance.rig.body import BALL_AHEAD, HALF_SHOE, joint_matrices
from dancetutor_cli.film.clock import Moment
from dancetutor_cli.film.picture import FootFromAbove, Frame
from dancetutor_cli.film.scene import renderer
from dancetutor_cli.film.scene.camera import WHOLE, Camera, Region, with_pan_range
from dancetutor_cli.film.scene.follow import Follow, RootTrack, farther, is_wide
from dancetutor_cli.film.scene.look import default_look
from dancetutor_cli.film.scene.props import GlassBar, bar_matrix, stands_before, with_bar
from dancetutor_cli.film.scene.scene import PANEL, TOE_AHEAD, FootMark, FrameState, Scene, foot_marks
from dancetutor_cli.film.scene.visibility import Silhouette, draw_hidden_feet

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.motion import Motion
    from dancetutor_cli.film.choices import Quality, RendererKind
    from dancetutor_cli.film.notes import PanelLights
    from dancetutor_cli.film.picture import PadLike


AWAY = 0.3  # metres from the place of her steps beyond which the dancer walks and does not only sway in a wait


def sole_line(mark: FootMark) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return both ends of the line in the middle of a shoe, world (x, z).

    The line's middle is the middle of the sole, which stands on its panel. The line of a mark goes from the ankle to
    the ball, and its middle is farther back.
    """
    heel, toe = np.array(mark.heel), np.array(mark.toe)
    along = (toe - heel) / max(float(np.linalg.norm(toe - heel)), 1e-9)
    middle = toe - (TOE_AHEAD + BALL_AHEAD) * along
    (x, z), (u, v) = (middle - HALF_SHOE * along).tolist(), (middle + HALF_SHOE * along).tolist()
    return (x, z), (u, v)


@dataclass(frozen=True, slots=True)
class Shot:
    """The view of the dancer. size : (width, height); camera : name or place; kind : the renderer

    region : share of the picture that she fills
    stands : whether the camera must not follow the dancer, because a part of the picture is drawn for one camera
    """

    size: tuple[int, int]
    camera: str
    quality: Quality
    kind: RendererKind
    region: Region = WHOLE
    stands: bool = False


class Dancer:
    """A picture of the dancer at any moment. It is created in the process that draws, because it may hold a GL context.

    motions : the motions of one or two dancers at each rate, in seconds of the music as it is heard at that rate
    character : the character who dances; None for the project's own dancer
    """

    def __init__(
        self,
        motions: Mapping[float, tuple[Motion, ...]],
        pad: PadLike,
        lights: PanelLights,
        shot: Shot,
        character: Character | None = None,
    ) -> None:
        self.motions, self.lights = motions, lights
        self._count = max(map(len, motions.values()))
        self._size = shot.size
        bar, joints = next((some[0].bar, some[0].skeleton.names) for some in motions.values())
        floor = -default_look().stage.pad_height
        self.alone = character or load_dancer()
        seen = with_partner(self.alone) if self._count > 1 else self.alone
        self.scene = Scene(seen, pad)
        self.camera: Camera = self.scene.camera(shot.camera, shot.size, shot.region)
        glass = bar is not None and stands_before(bar, self.camera)
        self._glass = GlassBar(bar, floor, shot.size) if bar is not None and glass else None
        self._bar = None if glass else bar
        self._follow = {} if shot.stands else self._followers(shot.camera, shot.size, shot.region)
        self.scene = Scene(with_bar(seen, self._bar, floor), pad)
        self.renderer = renderer.create(self.scene, shot.size, shot.quality, shot.kind)
        skeleton = self.alone.skeleton
        self._ours = np.array([j for j, name in enumerate(skeleton.names) if name in joints])
        self._theirs = np.array([joints.index(skeleton.names[j]) for j in self._ours])

    def frame(self, moment: Moment, joints: NDArray[np.float64]) -> Frame:
        """Draw the picture at a moment of the music, uint8 (h, w, 3), which the next call overwrites."""
        (lit, by), view = self._lit(moment.second), self.view(moment)
        frame = self.renderer.frame(FrameState(joints, view, lit, by))
        draw_hidden_feet(frame, self.scene, joints, view)
        if self._glass is not None and not view.feet_only:
            self._glass.draw(frame, view)
        return frame

    def view(self, moment: Moment) -> Camera:
        """Return the camera at a moment: the still camera, or the camera that follows the dancer across a wide pad."""
        return self._follow[moment.rate].at(moment.heard_second) if self._follow else self.camera

    def _followers(self, camera: str, size: tuple[int, int], region: Region) -> dict[float, Follow]:
        """Return the camera for each rate that follows the dancer across a wide pad; none from another direction.

        The camera looks along the pad's short side. On other pads, it moves only while she walks on or off at the
        picture's edge.

        It is made from the motion of the whole film, so that a frame does not depend on the process that draws it.
        """
        look = self.scene.look
        along = abs(float(self.camera.axes()[0][0])) > look.follow.along
        named = camera in look.cameras
        if not (named and along) or self.camera.feet_only:
            return {}
        if region == WHOLE and is_wide(self.scene):
            region = look.follow.region
        usual = look.cameras[camera].region if region == WHOLE else region
        for back in (*np.arange(1.0, look.follow.back - 0.01, 0.04), look.follow.back):
            box = farther(usual, float(back)) if back > 1 else region
            found = {
                rate: Follow(self.scene, camera, size, RootTrack(some[0].times, self._roots(rate)), box)
                for rate, some in self.motions.items()
            }
            if max(follow.cut for follow in found.values()) * size[0] < 1:
                break
        low, high = zip(*(follow.camera.pan_range for follow in found.values()), strict=True)
        for follow in found.values():  # one still picture is wide enough for the cameras of all rates
            follow.camera = with_pan_range(follow.camera, min(low), max(high))
        return found

    def _roots(self, rate: float) -> NDArray[np.float64]:
        """Return the dancer's root, (f, 3) metres, at the times of her motion; (2, f, 3) for two dancers."""
        hers, *others = self.motions[rate]
        if not others:
            return hers.root
        roots = [np.column_stack([np.interp(hers.times, one.times, x) for x in one.root.T]) for one in others]
        return np.stack([hers.root, *roots])

    def walks_behind(
        self, boxes: Sequence[tuple[float, float, float, float]], seconds: NDArray[np.float64], step: float, rate: float
    ) -> NDArray[np.bool_]:
        """Return for each second whether the dancer, while she walks, is in one of `boxes` (pixels of her picture).

        She walks if she is more than `AWAY` from her place at the second `step`.

        seconds : float64 (n,), seconds of the music; rate : the rate at which the music plays
        """
        moments = [Moment(float(second), rate) for second in (*seconds, step)]
        joints = self.joints(moments)
        root = joints[:, 0, :3, 3][:, (0, 2)]
        away = np.hypot(*(root[:-1] - root[-1]).T) > AWAY
        outline, size = Silhouette(self.scene.character), self._size
        found = [
            bool(far) and outline.behind(boxes, joints[k], self.view(moments[k]), size) for k, far in enumerate(away)
        ]
        return np.array(found)

    def heads_and_feet(self, moments: Sequence[Moment]) -> NDArray[np.float64]:
        """Return the boxes of the dancer's head and feet in her picture at some moments.

        (n, 4): left, top, right, bottom, pixels
        """
        outline = Silhouette(self.scene.character)
        joints = self.joints(moments)
        seen = [
            outline.heads_and_feet(j, self.view(moment), self._size) for j, moment in zip(joints, moments, strict=True)
        ]
        return np.concatenate([np.zeros((0, 4)), *seen])

    def still(self) -> Frame:
        """Draw the room without the dancer."""
        joints = self.joints([Moment(0.0, next(iter(self.motions)))])[0]
        joints[:, 1, 3] += 1000.0
        nobody = np.zeros(self.scene.panels)
        return self.renderer.frame(FrameState(joints, self.camera, nobody, nobody.astype(np.int64))).copy()

    def feet(self, joints: NDArray[np.float64]) -> list[FootFromAbove | None]:
        """Return the feet of all dancers seen from above, in panel widths of the pad."""
        whose = ("", PREFIX)[: self._count]
        return [self._foot(mark) for one in whose for mark in foot_marks(self.scene, joints, one)]

    def _foot(self, mark: FootMark | None) -> FootFromAbove | None:
        if mark is None:
            return None
        cx, cy = self.scene.pad.centre
        heel, toe = ((cx - x / PANEL, cy + z / PANEL) for x, z in sole_line(mark))
        return FootFromAbove(heel, toe, mark.height)

    def joints(self, moments: Sequence[Moment]) -> NDArray[np.float64]:
        """Return the world matrices (f, j, 4, 4) of the character's joints at f moments.

        Joints are matched by name, because a character's file may have its own order.
        """
        parts = [self._joints_of(number, moments) for number in range(self._count)]
        if self._bar is not None:
            parts.append(np.broadcast_to(bar_matrix(self._bar), (len(moments), 1, 4, 4)))
        return np.concatenate(parts, axis=1)

    def _joints_of(self, number: int, moments: Sequence[Moment]) -> NDArray[np.float64]:
        skeleton = self.alone.skeleton
        rotations, root = np.zeros((len(moments), len(skeleton.names), 4)), np.zeros((len(moments), 3))
        rotations[..., 0] = 1.0
        rate, heard = (np.array([getattr(moment, name) for moment in moments]) for name in ("rate", "heard_second"))
        for one in np.unique(rate):
            here = np.flatnonzero(rate == one)
            sampled, root[here] = sample(self.motions[float(one)][number], heard[here])
            rotations[here[:, None], self._ours] = sampled[:, self._theirs]
        return joint_matrices(skeleton, rotations, root)

    def _lit(self, second: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        levels = [self.lights.at(column, second) for column in range(self.scene.panels)]
        return np.array([level for level, _ in levels]), np.array([max(0, limb) for _, limb in levels])
