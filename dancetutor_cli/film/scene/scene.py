"""The stage, the still scene, and the state of one frame."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Character, rest_vertices
from dancetutor_cli.dance.units import PANEL as PANEL
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import LimbColours, limb_colours
from dancetutor_cli.film.picture import PadLike
from dancetutor_cli.film.scene.camera import WHOLE, Camera, Region, parse_camera
from dancetutor_cli.film.scene.look import Look, StageLook, default_look
from dancetutor_cli.run.errors import UsageError

# The stage: floor, wall and pad as flat surfaces, whose kinds determine their colours.
#
# The colours (`cpu.stage_colours`) depend only on the position on the surface; there are no textures, so the stage is
# sharp at any size.

_SIDES = 24  # number of the room's sides
_WALL_HEIGHT = 5.0
_FLOOR_REACH = 40.0


class SurfaceKind(IntEnum):
    """The kind of a surface, which determines its colours."""

    FLOOR = 0
    PAD = 1
    PAD_SIDE = 2
    WALL = 3


@dataclass(frozen=True, slots=True)
class Tiles:
    """The pad's surface as a grid of tiles: a tiles across (to -X), b tiles deep (to +Z).

    corner : world (x, z) of the first tile's outer corner: greatest x, least z
    panel : int32 (a, b), column of the tile's panel, or -1
    arrow : float64 (a, b, 2), world (x, z) direction of the panel's arrow, (0, 0) for none
    """

    corner: tuple[float, float]
    panel: NDArray[np.int32]
    arrow: Array


@dataclass(frozen=True, slots=True)
class Stage:
    """The stage as q quadrilaterals, counter-clockwise from their front; their backs are not drawn.

    corners : float64 (q, 4, 3), world; uv : float64 (q, 4, 2), places on a wall; kinds : int32 (q,), `SurfaceKind`
    """

    corners: Array
    uv: Array
    kinds: NDArray[np.int32]
    tiles: Tiles


def tiles_of(pad: PadLike) -> Tiles:
    """Return the grid of tiles under the panels: squares of 3 by 3 that hold all panels, the first around (0, 0)."""
    panels = np.asarray(pad.panels, dtype=np.float64)
    first = 3 * np.floor((np.round(panels.min(0)) + 1) / 3) - 1
    squares = np.floor((np.round(panels.max(0)) + 1 - (first + 1)) / 3) + 1
    across, deep = (int(3 * n) for n in squares)
    panel = np.full((across, deep), -1, dtype=np.int32)
    arrow = np.zeros((across, deep, 2))
    for column, ((x, y), (right, ahead)) in enumerate(
        zip(panels, np.asarray(pad.arrows, dtype=np.float64), strict=True)
    ):
        a, b = round(x - first[0]), round(y - first[1])
        panel[a, b] = column
        length = math.hypot(right, ahead)
        if length > 0:
            arrow[a, b] = (-right / length, ahead / length)
    x, z = (-PANEL * (first[0] - 0.5 - pad.centre[0]), PANEL * (first[1] - 0.5 - pad.centre[1]))
    return Tiles((float(x), float(z)), panel, arrow)


def build_stage(pad: PadLike, look: StageLook) -> Stage:
    """Build the surfaces of floor, wall and pad."""
    tiles = tiles_of(pad)
    low, high = pad_extent(tiles)
    bottom = -look.pad_height
    reach, radius = _FLOOR_REACH, look.radius + float(high[0])
    parts: list[tuple[SurfaceKind, list[tuple[float, float, float]]]] = [
        (SurfaceKind.FLOOR, _flat(-reach, -reach, reach, reach, bottom)),
        (SurfaceKind.PAD, _flat(low[0], low[2], high[0], high[2], 0.0)),
    ]
    ring = [(low[0], low[2]), (high[0], low[2]), (high[0], high[2]), (low[0], high[2])]
    for (x0, z0), (x1, z1) in zip(ring, [*ring[1:], ring[0]], strict=True):
        parts.append((SurfaceKind.PAD_SIDE, [(x0, bottom, z0), (x0, 0.0, z0), (x1, 0.0, z1), (x1, bottom, z1)]))
    for side in range(_SIDES):
        a, b = (2 * math.pi * (side + k - 0.5) / _SIDES for k in (0, 1))
        (x0, z0), (x1, z1) = ((radius * math.sin(t), radius * math.cos(t)) for t in (a, b))
        top = bottom + _WALL_HEIGHT
        parts.append((SurfaceKind.WALL, [(x0, bottom, z0), (x0, top, z0), (x1, top, z1), (x1, bottom, z1)]))
    wall = [(-1.0, 0.0), (-1.0, 1.0), (1.0, 1.0), (1.0, 0.0)]
    return Stage(
        np.array([corners for _, corners in parts], dtype=np.float64),
        np.array([wall for _ in parts], dtype=np.float64),
        np.array([kind for kind, _ in parts], dtype=np.int32),
        tiles,
    )


def pad_extent(tiles: Tiles) -> tuple[Array, Array]:
    """Return the least and greatest corner (3,) of the pad's surface in the world."""
    across, deep = tiles.panel.shape
    x, z = tiles.corner
    return np.array([x - across * PANEL, 0.0, z]), np.array([x, 0.0, z + deep * PANEL])


def _flat(x0: float, z0: float, x1: float, z1: float, y: float) -> list[tuple[float, float, float]]:
    return [(x0, y, z0), (x0, y, z1), (x1, y, z1), (x1, y, z0)]


FAR_AWAY = 1e6  # metres; a dancer who is farther away is an error
_JUMP = 0.10  # metres for a jump above the dancer's own height
SOLE_RADIUS = 0.052  # metres; a sole on the floor is all points this near to the line from heel to toe
TOE_AHEAD = 0.022  # metres by which this line reaches beyond the ball, and beyond the ankle
_HEEL, _TOE = (0.0, -TOE_AHEAD), (0.0, TOE_AHEAD)  # both ends of the line, (x, z) from ankle and ball at rest


@dataclass(frozen=True, slots=True)
class Scene:
    """The parts of the picture that do not change during a film.

    character : the dancer; pad : the panels; stage : the surfaces around her
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
        """The least and greatest corner (3,) of the pad's surface in the world, metres."""
        return pad_extent(self.stage.tiles)

    @property
    def panels(self) -> int:
        """The number of panels that can light up."""
        return len(self.pad.panels)

    def camera(self, text: str, size: tuple[int, int], region: Region = WHOLE) -> Camera:
        """Return a camera by name or ``x,y,z/x,y,z`` for a picture of that size; the dancer fills `region` (0..1)."""
        return parse_camera(text, self.extent, size, self.look, region, self.dancer_height)

    @property
    def dancer_height(self) -> float:
        """The height that the dancer needs above the ground, metres: her own height and a jump."""
        return float(rest_vertices(self.character)[:, 1].max()) + _JUMP


@dataclass(frozen=True, slots=True)
class FrameState:
    """The state of one frame.

    joints : float64 (j, 4, 4), world matrices of the character's joints, see `dance.rig.body.joint_matrices`; None for
        the room without the dancer
    camera : the camera of the frame; a change of its pan is fast, any other change redraws the stage
    lit : float (panels,), 0 dark to 1 fully lit; lit_by : int (panels,), `feet.limbs.Limb` whose colour a panel has
    """

    joints: Array | None
    camera: Camera
    lit: NDArray[np.floating]
    lit_by: NDArray[np.integer]


@dataclass(frozen=True, slots=True)
class FootMark:
    """The mark of a foot on the floor: the line from heel to toe, world (x, z), and the height of the sole, metres."""

    heel: tuple[float, float]
    toe: tuple[float, float]
    height: float
    ground: float  # height of the pad or floor below the foot


def check_state(scene: Scene, state: FrameState) -> None:
    """Raise UsageError if the arrays do not fit the scene."""
    joints = len(scene.character.skeleton.names)
    if state.joints is not None and state.joints.shape != (joints, 4, 4):
        raise UsageError(f"frame: joints have shape {state.joints.shape}, the character needs ({joints}, 4, 4)")
    if len(state.lit) != scene.panels or len(state.lit_by) != scene.panels:
        raise UsageError(f"frame: lit and lit_by need one entry for each of the pad's {scene.panels} panels")
    # NaN fails the comparison too.
    if state.joints is not None and not np.abs(state.joints).max() < FAR_AWAY:
        raise UsageError("frame: the positions of joints are out of range; bake the motion again")


def foot_marks(scene: Scene, joints: Array, whose: str = "") -> tuple[FootMark | None, FootMark | None]:
    """Return the left and the right foot, for marks and contact shadows; None for a character without feet.

    whose : prefix of the joints' names, `character.mesh.PREFIX` for the second of two dancers
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
    """Return the marks of the palms, as `foot_marks` does for feet; heel and toe of a palm are one point."""
    from dancetutor_cli.dance.rig.body import palm_points  # imports numba, which the choice of a scene must not

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
    """Return the unit vector (3,) to the light, which is beside the camera, so that the visible side is lit."""
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
    """Return the light's view of the world, (3, 3): rows u, v (downwards) and the direction to the light."""
    u = np.array([light[2], 0.0, -light[0]]) / math.hypot(light[0], light[2])
    v = np.array(
        [u[1] * light[2] - u[2] * light[1], u[2] * light[0] - u[0] * light[2], u[0] * light[1] - u[1] * light[0]]
    )
    return np.array([u, v, light])
