"""What renderers compute before they draw a frame: skin, the shadow map's place, feet, regions; matrices for OpenGL."""

from __future__ import annotations

from enum import Enum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import PREFIX
from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.choices import Quality
from dancetutor_cli.film.scene.camera import NEAR, Camera
from dancetutor_cli.film.scene.scene import (
    PANEL,
    FootMark,
    FrameState,
    Scene,
    foot_marks,
    hand_marks,
    light_direction,
    shadow_axes,
)

SAMPLES: dict[Quality, int] = {"draft": 1, "good": 2, "best": 4}  # samples across and down a pixel
SHADOW_MAP: dict[Quality, int] = {"draft": 0, "good": 512, "best": 1024}  # texels across, 0: no cast shadow
SHADOW_REACH = 2.5  # metres of the world that the shadow map shows, around the dancer's root
_MARK_REACH = 0.1  # metres around a foot that its mark and its contact shadow may reach
_MARK_HEIGHT = 1.0  # greatest height of a foot with a mark, metres
SHADOW_FADE = (0.25, 0.95)  # metres from the dancer, on the floor, over which her shadow fades
NO_FOOT = -1.0
_UNDER = 0.75  # greatest distance from a panel's middle, in panel widths, at which a sole may press it
RING_SHARE = 0.2  # share of its ring that a foot keeps beside the panel that it presses; on the panel the ring is white
PLANTED = (0.88, 0.95)  # nearness to the ground over which a foot begins to stand: 26 mm above the ground, and 11 mm


class Cast(NamedTuple):
    """The place of the shadow map. axes : (3, 3), rows u, v and the direction to the light

    origin : (2,), u and v of the map's corner, metres; scale : texels a metre, 0 for no map
    """

    axes: Array
    origin: Array
    scale: float


class DancerVisibility(Enum):
    """The part of the dancer that a frame shows."""

    NOTHING = 0
    FEET = 1
    ALL = 2


def dancer_visibility(state: FrameState) -> DancerVisibility:
    """Return the part of the dancer that this frame shows."""
    if state.joints is None:
        return DancerVisibility.NOTHING
    return DancerVisibility.FEET if state.camera.feet_only else DancerVisibility.ALL


def joints_of(scene: Scene, state: FrameState) -> Array:
    """Return the joints' world matrices; the binding pose if the dancer is not shown."""
    if state.joints is not None:
        return state.joints
    return np.asarray(np.linalg.inv(scene.character.inverse_bind), dtype=np.float64)


def skin_matrices(scene: Scene, joints: Array) -> Array:
    """Return the matrices from binding pose to world, (j, 3, 4).

    The order of additions is fixed, because matrix libraries differ in the last bit.
    """
    inverse = scene.character.inverse_bind
    out = joints[:, :3, 0, None] * inverse[:, None, 0, :]
    for k in (1, 2, 3):
        out = out + joints[:, :3, k, None] * inverse[:, None, k, :]
    return np.ascontiguousarray(out)


def place_cast(scene: Scene, camera: Camera, joints: Array, texels: int) -> Cast:
    """Return the shadow map around the dancer, on a texel grid fixed in the world.

    With another grid, the shadow's edge would crawl as she moves.
    """
    axes = shadow_axes(light_direction(scene.look, camera))
    if texels == 0:
        return Cast(axes, np.zeros(2), 0.0)
    scale = texels / SHADOW_REACH
    root = joints[0, :3, 3]
    corner = [np.floor((axes[k] * root).sum() * scale) / scale - SHADOW_REACH / 2 for k in (0, 1)]
    return Cast(axes, np.array(corner), scale)


def shadow_middles(scene: Scene, joints: Array) -> Array:
    """Return the dancers' places on the floor, x and z, (2, 2); both rows are equal for a single dancer."""
    names = scene.character.skeleton.names
    roots = [j for j, name in enumerate(names) if name.removeprefix(PREFIX) == "HumanoidRoot"] or [0]
    return np.ascontiguousarray(joints[[roots[0], roots[-1]]][:, (0, 2), 3])


def pixels_per_metre(camera: Camera, joints: Array, size: tuple[int, int]) -> float:
    """Return the pixels of a metre at the depth of the dancer's root."""
    forward = camera.axes()[2]
    depth = float(((joints[0, :3, 3] - camera.position) * forward).sum())
    return camera.focal * size[1] / max(depth, NEAR)


# Entries of a row of `feet_on_floor`, for the marks and shadows of a foot or hand on the floor.
HEEL_X, HEEL_Z, TOE_X, TOE_Z, GROUND = range(5)  # the line between heel and toe, the height of the ground, metres
NEARNESS = 5  # nearness to the ground, 0 to 1, or NO_FOOT
RED, GREEN, BLUE = 6, 7, 8  # colour of the mark, 0 to 255
STRENGTH, PRESSED = 9, 10  # strength of the mark, and of the press on a lit panel, 0 to 1


def feet_on_floor(scene: Scene, state: FrameState) -> Array:
    """Return the rows of feet, then of hands, (4, 11), with the entries above.

    A hand that is not near the floor has no mark. For two dancers, the feet of the second dancer replace the hands.
    """
    out = np.zeros((4, 11))
    out[:, NEARNESS] = NO_FOOT
    if state.joints is None:
        return out
    low = scene.look.light.contact_height
    colours = scene.colours.by_limb
    partner = any(name.startswith(PREFIX) for name in scene.character.skeleton.names)
    others = foot_marks(scene, state.joints, PREFIX) if partner else hand_marks(scene, state.joints)
    colours = (*colours[:2], *colours[:2]) if partner else colours
    for limb, (mark, colour) in enumerate(zip((*foot_marks(scene, state.joints), *others), colours, strict=True)):
        foot = limb < 2 or partner
        if mark is not None and mark.height < (_MARK_HEIGHT if foot else low):
            near = max(0.0, 1.0 - mark.height / low)
            strength = scene.look.stage.mark * (_strength(near) if foot else near)
            pressed = _pressed(scene, state, mark, limb % 2 if partner else limb) * (_planted(near) if foot else near)
            out[limb] = (*mark.heel, *mark.toe, mark.ground, near, *colour, strength, pressed)
    return out


def _pressed(scene: Scene, state: FrameState, mark: FootMark, limb: int) -> float:
    """Return the light, 0..1, of the panel that this limb presses, if the panel is at least partly under the limb."""
    ours = np.flatnonzero((np.asarray(state.lit) > 0.0) & (np.asarray(state.lit_by) == limb))
    if len(ours) == 0:
        return 0.0
    places = (np.asarray(scene.pad.panels, dtype=np.float64)[ours] - scene.pad.centre) * (-PANEL, PANEL)
    heel, line = np.array(mark.heel), np.subtract(mark.toe, mark.heel)
    along = np.clip((places - heel) @ line / max(float(line @ line), 1e-9), 0.0, 1.0)
    far = np.linalg.norm(places - heel - along[:, None] * line, axis=1)
    lit = np.asarray(state.lit, dtype=np.float64)[ours[far < _UNDER * PANEL]]
    return float(np.clip(lit, 0.0, 1.0).max(initial=0.0))


def _planted(near: float) -> float:
    """Return the degree to which a foot stands, 0..1."""
    t = min(1.0, max(0.0, (near - PLANTED[0]) / (PLANTED[1] - PLANTED[0])))
    return t * t * (3.0 - 2.0 * t)


def _strength(near: float) -> float:
    """Return the strength of a foot's ring: solid for a standing foot, a faded trace for a foot in the air."""
    planted = _planted(near)
    return planted + (1.0 - planted) * (0.12 + 0.38 * near)


def panel_lights(scene: Scene, state: FrameState) -> tuple[Array, Array]:
    """Return the light of each panel, (panels,) 0..1, and its colour, (panels, 3) 0..255."""
    colours = np.array(scene.colours.by_limb, dtype=np.float64)
    lit = np.clip(np.asarray(state.lit, dtype=np.float64), 0.0, 1.0)
    return lit, colours[np.clip(np.asarray(state.lit_by, dtype=np.int64), 0, len(colours) - 1)]


def ground_box(scene: Scene, camera: Camera, size: tuple[int, int], bounds: tuple[Array, Array], cast: Cast) -> Array:
    """Return the part of the picture, x0, y0, x1, y1 in pixels, with the pad and all shadows and marks on the floor.

    bounds : least and greatest corner (3,) of the dancer
    """
    low, high = scene.extent
    ground = -scene.look.stage.pad_height
    points = [(x, y, z) for x in (low[0], high[0]) for y in (0.0, ground) for z in (low[2], high[2])]
    least, most = bounds[0] - _MARK_REACH, bounds[1] + _MARK_REACH
    under = [(x, ground, z) for x in (least[0], most[0]) for z in (least[2], most[2])]
    if cast.scale > 0:  # the corners of her box, cast on the floor
        slope = cast.axes[2] / cast.axes[2][1]
        for x, _, z in tuple(under):
            for y in (least[1] - ground, most[1] - ground):
                under.append((x - slope[0] * y, ground, z - slope[2] * y))
    return pixel_box(camera, np.array(points + under, dtype=np.float64), size)


def pixel_box(camera: Camera, points: Array, size: tuple[int, int]) -> Array:
    """Return the bounds of world points on the picture, int64 x0, y0, x1, y1.

    They are the whole picture if a point is behind the camera.
    """
    places = camera.project(points, size)
    if (places[:, 2] < NEAR).any():
        return np.array([0, 0, *size], dtype=np.int64)
    low, high = np.floor(places[:, :2].min(0)) - 2, np.ceil(places[:, :2].max(0)) + 3
    return np.concatenate([np.clip(low, 0, size), np.clip(high, 0, size)]).astype(np.int64)


# Matrices of the OpenGL renderer, and boxes around the dancer; needs no OpenGL.

FAR = 100.0  # the greatest depth that is drawn, metres
CAST_DEPTH = (-2.0, 6.0)  # metres along the light that the shadow map covers


def camera_matrix(camera: Camera, size: tuple[int, int]) -> Array:
    """Return the matrix from world to clip space (4, 4), with the picture's first row at y = -1."""
    m = camera.matrix(size)
    out = np.empty((4, 4))
    out[0] = 2.0 / size[0] * m[0] - m[2]
    out[1] = 2.0 / size[1] * m[1] - m[2]
    out[2] = (FAR + NEAR) / (FAR - NEAR) * m[2]
    out[2, 3] -= 2.0 * FAR * NEAR / (FAR - NEAR)
    out[3] = m[2]
    return out


def light_matrix(cast: Cast) -> Array:
    """Return the matrix from world to clip space of the shadow map (4, 4); the depth is less nearer to the light."""
    out = np.zeros((4, 4))
    for k in (0, 1):
        out[k, :3] = cast.axes[k] * (2.0 / SHADOW_REACH)
        out[k, 3] = -cast.origin[k] * (2.0 / SHADOW_REACH) - 1.0
    low, high = CAST_DEPTH
    out[2, :3] = -cast.axes[2] * (2.0 / (high - low))
    out[2, 3] = (high + low) / (high - low)
    out[3, 3] = 1.0
    return out


class JointBoxes(NamedTuple):
    """The box of each joint's vertices; the skin lies within these boxes in any pose, so that no skinning is needed.

    joint : int (k,), the joints with vertices; corners : (k, 8, 3), corners of the boxes in the binding pose
    """

    joint: NDArray[np.intp]
    corners: Array


def joint_boxes(positions: NDArray[Any], joints: NDArray[Any], weights: NDArray[Any]) -> JointBoxes:
    """Return the boxes of a mesh (v, 3), whose vertices follow joints (v, 4) with weights (v, 4) that sum to 1."""
    held = weights > 0
    owner, vertex = joints[held], np.nonzero(held)[0]
    ends = np.empty((2, int(joints.max()) + 1, 3))
    ends[0], ends[1] = np.inf, -np.inf
    np.minimum.at(ends[0], owner, positions[vertex])
    np.maximum.at(ends[1], owner, positions[vertex])
    joint = np.unique(owner)
    corner = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    return JointBoxes(joint, np.stack([ends[corner[:, k], joint[:, None], k] for k in range(3)], axis=-1))


def hull_points(held: JointBoxes, matrices: Array) -> Array:
    """Return world points (n, 3) whose hull holds the dancer. matrices : (j, 3, 4), from binding pose to world"""
    turn = matrices[held.joint]
    return np.asarray(held.corners @ turn[:, :, :3].transpose(0, 2, 1) + turn[:, None, :, 3]).reshape(-1, 3)


def shadow_part(light: Array, places: Array) -> Array:
    """Return the part of the shadow map that holds the dancer: left, top, right and bottom from 0 to 1, (4,).

    light : `light_matrix`; places : `hull_points`
    """
    there = (places @ light[:2, :3].T + light[:2, 3]) * 0.5 + 0.5
    return np.concatenate([there.min(0), there.max(0)])
