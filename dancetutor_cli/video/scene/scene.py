"""What is in the picture: the scene that stands still, and the state of one frame. Both renderers draw from these."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Character, rest_vertices
from dancetutor_cli.colours import LimbColours, limb_colours
from dancetutor_cli.errors import UsageError
from dancetutor_cli.video.picture import PadLike
from dancetutor_cli.video.scene.camera import WHOLE, Camera, Region, parse
from dancetutor_cli.video.scene.look import Look, default_look
from dancetutor_cli.video.scene.stage import Stage, build_stage, pad_extent

Array = NDArray[np.float64]
FAR_AWAY = 1e6  # metres: a dancer who is farther away is a mistake
_JUMP = 0.10  # metres above her own height that a camera shows: a jump
SOLE_RADIUS = 0.052  # metres: a sole is drawn on the floor as all points so near to the line from heel to toe
_HEEL, _TOE = (0.0, -0.022), (0.0, 0.022)  # how far that line reaches beyond ankle and ball, (x, z) at rest


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything that does not change during a video.

    character : the dancer; pad : where the panels are; stage : the surfaces around her
    """

    character: Character
    pad: PadLike
    look: Look = field(default_factory=default_look)
    colours: LimbColours = field(default_factory=limb_colours)
    stage: Stage = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "stage", build_stage(self.pad, self.look.stage))

    @property
    def extent(self) -> tuple[Array, Array]:
        """Least and greatest corner (3,) of the pad's surface in the world, metres."""
        return pad_extent(self.stage.tiles)

    @property
    def panels(self) -> int:
        """Number of panels that can light up."""
        return len(self.pad.panels)

    def camera(self, text: str, size: tuple[int, int], region: Region = WHOLE) -> Camera:
        """A camera by name or ``x,y,z/x,y,z`` for a picture of that size; she fills `region` (0..1) of it."""
        return parse(text, self.extent, size, self.look, region, self.tall)

    @property
    def tall(self) -> float:
        """How much room she needs above the ground, metres: her height, and a jump."""
        return float(rest_vertices(self.character)[:, 1].max()) + _JUMP


@dataclass(frozen=True, slots=True)
class FrameState:
    """One frame.

    joints : float64 (j, 4, 4), world matrices of the character's joints, see `rig.kinematics.joint_matrices`; None for
    the room without her
    camera : where it is seen from; frames from one camera (but for its pan) are quick, a moved camera redraws the stage
    lit : float (panels,), 0 dark to 1 fully lit; lit_by : int (panels,), `play.played.Limb` whose colour a panel has
    """

    joints: Array | None
    camera: Camera
    lit: NDArray[np.floating]
    lit_by: NDArray[np.integer]


@dataclass(frozen=True, slots=True)
class FootMark:
    """A foot as seen on the floor: the line from heel to toe, world (x, z), and how high its sole is, metres."""

    heel: tuple[float, float]
    toe: tuple[float, float]
    height: float
    ground: float  # height of what is below it: the pad, or the floor beside it


def check_state(scene: Scene, state: FrameState) -> None:
    """UsageError if the arrays do not fit the scene."""
    joints = len(scene.character.skeleton.names)
    if state.joints is not None and state.joints.shape != (joints, 4, 4):
        raise UsageError(f"frame: joints have shape {state.joints.shape}, the character needs ({joints}, 4, 4)")
    if len(state.lit) != scene.panels or len(state.lit_by) != scene.panels:
        raise UsageError(f"frame: lit and lit_by need one entry for each of the pad's {scene.panels} panels")
    # NaN fails the comparison too.
    if state.joints is not None and not np.abs(state.joints).max() < FAR_AWAY:
        raise UsageError("frame: the joints have places that are no place on Earth; bake the motion again")


def foot_marks(scene: Scene, joints: Array, whose: str = "") -> tuple[FootMark | None, FootMark | None]:
    """Where the left and the right foot are, for marks and contact shadows; None for a character without feet.

    whose : before the names of the joints, `character.partner.PREFIX` for the second of two
    """
    names = scene.character.skeleton.names
    rest = scene.character.skeleton.rest
    out: list[FootMark | None] = []
    for side in "lr":
        needed = f"{whose}{side}_talocrural", f"{whose}{side}_metatarsal"
        if not set(needed) <= set(names):
            out.append(None)
            continue
        ankle, ball = map(names.index, needed)
        heel, toe = (
            joints[j, :3, :3] @ np.array([dx, -rest[j, 1], dz]) + joints[j, :3, 3]
            for j, (dx, dz) in ((ankle, _HEEL), (ball, _TOE))
        )
        ground = 0.0 if _on_pad(scene, (heel + toe) / 2) else -scene.look.stage.pad_height
        height = max(0.0, min(heel[1], toe[1]) - ground)
        out.append(FootMark((heel[0], heel[2]), (toe[0], toe[2]), float(height), ground))
    return out[0], out[1]


def hand_marks(scene: Scene, joints: Array) -> tuple[FootMark | None, FootMark | None]:
    """As `foot_marks`, for the palms: a palm is a foot whose heel and toe are one point."""
    from dancetutor_cli.rig.soles import palm_points  # brings numba, which choosing a scene must not

    skeleton = scene.character.skeleton
    needed = [f"{side}_{part}" for side in "lr" for part in ("shoulder", "elbow", "radiocarpal")]
    if not set(needed) <= set(skeleton.names):
        return None, None
    out = []
    for palm in palm_points(skeleton):
        x, y, z = (float(v) for v in joints[palm.joint, :3, :3] @ palm.offset + joints[palm.joint, :3, 3])
        ground = 0.0 if _on_pad(scene, np.array([x, y, z])) else -scene.look.stage.pad_height
        out.append(FootMark((x, z), (x, z), max(0.0, y - ground), ground))
    return out[0], out[1]


def light_direction(look: Look, camera: Camera) -> Array:
    """Unit vector (3,) to the light, which stands beside the camera: she is lit from where she is seen."""
    forward, up = camera.axes()[2], camera.axes()[1]
    heading = forward if math.hypot(forward[0], forward[2]) > 1e-3 else up
    yaw = math.atan2(-heading[0], -heading[2]) + math.radians(look.light.azimuth)
    elevation = math.radians(look.light.elevation)
    flat = math.cos(elevation)
    return np.array([flat * math.sin(yaw), math.sin(elevation), flat * math.cos(yaw)])


def _on_pad(scene: Scene, point: Array) -> bool:
    low, high = scene.extent
    return bool(low[0] <= point[0] <= high[0] and low[2] <= point[2] <= high[2])


def shadow_axes(light: Array) -> Array:
    """Rows u, v and the direction to the light: the light's view of the world, v downwards, (3, 3)."""
    u = np.array([light[2], 0.0, -light[0]]) / math.hypot(light[0], light[2])
    v = np.array(
        [u[1] * light[2] - u[2] * light[1], u[2] * light[0] - u[0] * light[2], u[0] * light[1] - u[1] * light[0]]
    )
    return np.array([u, v, light])
