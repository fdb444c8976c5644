"""The objects on the stage: the bar, which is drawn as glass if it is in front of the dancer, and the screen."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Character, Material, Mesh
from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.film.scene.camera import NEAR, Camera
from dancetutor_cli.run.kernels.compiling import njit

if TYPE_CHECKING:
    from dancetutor_cli.dance.motion import Bar


# The bar behind the pad, drawn with the dancer so that each can hide the other.

JOINT = "bar"  # name of the bar's joint, which never moves
STEEL = (0.62, 0.66, 0.74, 1.0)
SIDES, CORNER = 12, 6  # number of the tube's sides; pieces of a rounded corner
ROUND = 0.10  # metres, radius of the corners


def with_bar(character: Character, bar: Bar | None, floor: float) -> Character:
    """Return the character with the bar on a joint of its own, or unchanged if there is no bar.

    The joint's place in the world is `bar_matrix`, independent of the dancer.

    floor : height of the lower ends of the posts, metres
    """
    if bar is None:
        return character
    skeleton, joint = character.skeleton, len(character.skeleton.names)
    grown = replace(
        skeleton,
        names=(*skeleton.names, JOINT),
        parents=np.append(skeleton.parents, 0).astype(skeleton.parents.dtype),
        offsets=np.vstack((skeleton.offsets, [_middle(bar) - skeleton.rest[0]])),
    )
    inverse = np.linalg.inv(bar_matrix(bar))[None]
    meshes = tuple(_tube(middle_line(bar, span, floor), bar.radius, joint, k) for k, span in enumerate(bar.spans))
    return replace(
        character,
        skeleton=grown,
        meshes=(*character.meshes, *meshes),
        inverse_bind=np.concatenate((character.inverse_bind, inverse)),
    )


def bar_matrix(bar: Bar) -> Array:
    """Return the matrix (4, 4) from the bar's joint to the world: the middle of all rails, without a rotation."""
    out = np.eye(4)
    out[:3, 3] = _middle(bar)
    return out


def _middle(bar: Bar) -> Array:
    return np.array([np.mean(bar.spans), bar.height, bar.behind])


def middle_line(bar: Bar, span: tuple[float, float], floor: float) -> Array:
    """Return the middle line (n, 3) of one piece: up a post, along the rail, down the other post."""
    turn = np.linspace(0.0, np.pi / 2, CORNER + 1)
    x0, x1 = span
    left = np.column_stack((x0 + ROUND * (1 - np.cos(turn)), bar.height - ROUND * (1 - np.sin(turn))))
    right = np.column_stack((x1 - (left[::-1, 0] - x0), left[::-1, 1]))
    flat = np.vstack(([x0, floor], left, right, [x1, floor]))
    return np.column_stack((flat, np.full(len(flat), bar.behind)))


def _tube(line: Array, radius: float, joint: int, number: int) -> Mesh:
    """Return a round tube along a line in a plane of constant z."""
    along = np.gradient(line, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.array([0.0, 0.0, 1.0])
    outward = np.cross(along, across)
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    normals = np.cos(angle)[None, :, None] * across + np.sin(angle)[None, :, None] * outward[:, None]
    places = line[:, None] + radius * normals
    a = np.arange((len(line) - 1) * SIDES)
    b = a // SIDES * SIDES + (a + 1) % SIDES
    triangles = np.concatenate((np.column_stack((a, b, a + SIDES)), np.column_stack((b, b + SIDES, a + SIDES))))
    count = len(line) * SIDES
    joints = np.zeros((count, 4), dtype=np.uint16)
    joints[:, 0] = joint
    return Mesh(
        f"bar{number}",
        places.reshape(-1, 3).astype(np.float32),
        normals.reshape(-1, 3).astype(np.float32),
        np.zeros((count, 2), dtype=np.float32),
        triangles.astype(np.int32),
        joints,
        np.tile(np.array([1.0, 0.0, 0.0, 0.0], dtype=np.float32), (count, 1)),
        Material("bar", STEEL),
    )


# The bar in front of the dancer: a shell of glass with thin posts, through which feet, legs and panels can be seen.
#
# It is drawn over the finished picture, so that both renderers show the same bar, and casts no shadow on the pad.

EDGE, INSIDE = (0.45, 0.75), (0.12, 0.35)  # share of the steel's colour at edges and between them: posts, rail
LINE = 0.003  # metres, half an edge's width


def stands_before(bar: Bar, camera: Camera) -> bool:
    """Whether the bar is between this camera and the dancer, so that the camera is farther behind her than the bar."""
    return (camera.position[2] - bar.behind) * bar.behind > 0.0


class GlassBar:
    """The glass bar over pictures of `size` (width, height) pixels; floor : height at which its posts end, metres"""

    def __init__(self, bar: Bar, floor: float, size: tuple[int, int]) -> None:
        self._lines = [middle_line(bar, span, floor) for span in bar.spans]
        self._height, self._radius, self._size = bar.height, bar.radius, size
        self._made: tuple[Camera, NDArray[np.intp], Array] | None = None

    def draw(self, frame: Frame, camera: Camera) -> None:
        """Draw the bar over a frame of this camera."""
        key = replace(camera, pan=0.0)
        if self._made is None or self._made[0] != key:
            self._made = (key, *self._shell(key))
        _, (row, column), share = self._made
        column = column + camera.pan_pixels(self._size[0])
        seen = (column >= 0) & (column < self._size[0])
        row, column, share = row[seen], column[seen], share[seen, None]
        under = frame[row, column]
        frame[row, column] = np.rint(under + (255.0 * np.array(STEEL[:3]) - under) * share)

    def _shell(self, camera: Camera) -> tuple[NDArray[np.intp], Array]:
        """Return row and column (2, n) of the bar's pixels in the unpanned picture, and its share of each, (n,)."""
        width, height = self._size
        left, right = (max(0, round(pan * width)) for pan in (camera.pan_range[1], -camera.pan_range[0]))
        # For each pixel: distance to the bar's edge, pixels, negative inside; pixels of a metre; 0 to 1 for the rail.
        found = np.zeros((3, height, left + width + right))
        found[0] = np.inf
        for line in self._lines:
            places = replace(camera, pan_range=(0.0, 0.0)).project(line, self._size)
            if (places[:, 2] < NEAR).any():
                continue
            rail = np.clip(1.0 - (self._height - line[:, 1]) / ROUND, 0.0, 1.0)
            points = np.column_stack([places[:, :2] + (left, 0), camera.focal * height / places[:, 2], rail])
            for k in range(len(points) - 1):
                self._segment(found, points[k : k + 2])
        off, metre, rail = found
        (post, strong), (thin, thick) = EDGE, INSIDE
        edge = np.clip(LINE * metre + 0.5 - np.abs(off), 0.0, 1.0) * (post + rail * (strong - post))
        share = np.maximum(edge, np.clip(0.5 - off, 0.0, 1.0) * (thin + rail * (thick - thin)))
        at = np.array(np.nonzero(share > 0.0))
        return at - np.array([[0], [left]]), share[at[0], at[1]]

    def _segment(self, found: Array, ends: Array) -> None:
        """Enter a straight piece at the pixels to which it is nearer than all pieces before.

        ends : (2, 4), x, y, pixels of a metre, 0 to 1 for the rail
        """
        size = found.shape[:0:-1]
        around = self._radius * ends[:, 2].max() + 3.0
        low = np.clip(np.floor(ends[:, :2].min(0) - around), 0, size).astype(int)
        high = np.clip(np.ceil(ends[:, :2].max(0) + around), 0, size).astype(int)
        if (low >= high).any():
            return
        y, x = np.mgrid[low[1] : high[1], low[0] : high[0]] + 0.5
        place, along = np.stack([x, y], axis=-1) - ends[0, :2], ends[1] - ends[0]
        t = np.clip(place @ along[:2] / max(float(along[:2] @ along[:2]), 1e-9), 0.0, 1.0)
        away, metre = place - t[..., None] * along[:2], ends[0, 2] + t * along[2]
        off = np.hypot(away[..., 0], away[..., 1]) - self._radius * metre
        part = found[:, low[1] : high[1], low[0] : high[0]]
        part[:, off < part[0]] = np.stack([off, metre, ends[0, 3] + t * along[3]])[:, off < part[0]]


# A screen in the dancer's room: a flat picture, drawn in perspective behind her.

FRAME = (14, 15, 24)
RIM = (96, 104, 150)
THICK = 0.035  # thickness of the rim, as a share of the screen's sides


class _Place(NamedTuple):
    """The place of the screen. inverse : (3, 3), from pixels to places on the screen, 0..1

    box : the box around the screen, pixels; rim : thickness of the rim
    """

    inverse: NDArray[np.float64]
    box: NDArray[np.int64]
    rim: float


@njit(cache=True)
def _warp(frame: Any, picture: Any, still: Any, place: Any, colours: Any) -> None:  # pragma: no cover
    """Draw `picture` at the pixels at which the frame equals `still`.

    place : `_Place`; colours : colours of frame and rim, (2, 3)
    """
    inverse, box, rim = place
    rows, columns = picture.shape[0], picture.shape[1]
    for y in range(box[1], box[3]):
        for x in range(box[0], box[2]):
            w = inverse[2, 0] * x + inverse[2, 1] * y + inverse[2, 2]
            u = (inverse[0, 0] * x + inverse[0, 1] * y + inverse[0, 2]) / w
            v = (inverse[1, 0] * x + inverse[1, 1] * y + inverse[1, 2]) / w
            if u < -rim or u > 1 + rim or v < -rim or v > 1 + rim:
                continue
            hidden = False
            for k in range(3):
                if frame[y, x, k] != still[y, x, k]:
                    hidden = True
            if hidden:  # behind the dancer
                continue
            if u < 0 or u >= 1 or v < 0 or v >= 1:
                edge = 1 if max(-u, u - 1, -v, v - 1) > 0.7 * rim else 0
                for k in range(3):
                    frame[y, x, k] = colours[edge, k]
                continue
            px, py = u * columns - 0.5, v * rows - 0.5
            x0, y0 = int(np.floor(px)), int(np.floor(py))
            fx, fy = int(256 * (px - x0)), int(256 * (py - y0))
            xa, xb = max(x0, 0), min(x0 + 1, columns - 1)
            ya, yb = max(y0, 0), min(y0 + 1, rows - 1)
            for k in range(3):
                a = picture[ya, xa, k] * (256 - fx) + picture[ya, xb, k] * fx
                b = picture[yb, xa, k] * (256 - fx) + picture[yb, xb, k] * fx
                frame[y, x, k] = (a * (256 - fy) + b * fy + 32768) >> 16


class Television:
    """A screen at a place in the world, for a camera that never moves.

    centre : world, metres; size : width and height, metres; still : the room without the dancer, uint8 (h, w, 3)
    """

    def __init__(
        self, centre: tuple[float, float, float], size: tuple[float, float], camera: Camera, still: Frame
    ) -> None:
        self.still = still
        height, width = still.shape[:2]
        x, y, z = centre
        w, h = size[0] / 2, size[1] / 2
        # The dancer looks to +Z, so the screen looks to -Z, and its left edge, as she sees it, is at greater x.
        corners = np.array([(x + w, y + h, z), (x - w, y + h, z), (x - w, y - h, z), (x + w, y - h, z)])
        places = camera.project(corners, (width, height))[:, :2]
        grown = places.mean(0) + (places - places.mean(0)) * (1 + 3 * THICK)
        low, high = np.floor(grown.min(0)), np.ceil(grown.max(0))
        box = np.array([max(0, low[0]), max(0, low[1]), min(width, high[0]), min(height, high[1])], dtype=np.int64)
        self.place = _Place(np.linalg.inv(_homography(places)).astype(np.float64), box, THICK)

    def draw(self, frame: Frame, picture: Frame) -> None:
        """Show `picture` on the screen."""
        colours = np.array([FRAME, RIM], dtype=np.int64)
        _warp(frame, picture, self.still, self.place, colours)


def _homography(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the matrix (3, 3) from the corners (0,0), (1,0), (1,1), (0,1) to four places (4, 2) in the picture."""
    rows, wanted = [], []
    for (u, v), (x, y) in zip(((0, 0), (1, 0), (1, 1), (0, 1)), places, strict=True):
        rows.append([u, v, 1, 0, 0, 0, -u * x, -v * x])
        rows.append([0, 0, 0, u, v, 1, -u * y, -v * y])
        wanted += [x, y]
    solution = np.linalg.solve(np.array(rows, dtype=np.float64), np.array(wanted))
    return np.append(solution, 1.0).reshape(3, 3)
