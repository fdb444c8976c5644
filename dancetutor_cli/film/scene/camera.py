"""Cameras: the place from which the picture is taken, and the part of the picture that the dancer fills.

A pinhole camera in pixels: a point at depth d before the camera appears at ``centre + focal / d`` times its offset.
The camera does not turn. Instead `centre` moves, which puts the dancer beside the highway without bending the picture.
A pan of the centre follows her across a double pad, while all still parts only shift by whole pixels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.scene.look import CameraLook, Look
from dancetutor_cli.run.errors import UsageError, choose_text

Region = tuple[float, float, float, float]
WHOLE: Region = (0.0, 0.0, 1.0, 1.0)
_FACING, _STRAIGHT_DOWN = -0.35, 85.0  # limits of a front view: cosine of the azimuth, degrees of the elevation
NEAR = 0.05  # the least depth that is drawn, metres


@dataclass(frozen=True, slots=True)
class Camera:
    """A pinhole camera.

    position, target : world, metres; the picture is upright unless the camera looks straight down
    focal : focal length in picture heights
    centre : the point at which the line of sight meets the picture, 0..1 of its width and height
    pan : shift of the whole picture to the right, in picture widths
    pan_range : least and greatest `pan` that will be used; the still part of the picture is drawn once, wider by these
    feet_only : whether only the dancer's feet are drawn, because her head would hide them in a view from above
    """

    position: tuple[float, float, float]
    target: tuple[float, float, float]
    focal: float
    centre: tuple[float, float] = (0.5, 0.5)
    pan: float = 0.0
    pan_range: tuple[float, float] = (0.0, 0.0)
    feet_only: bool = False

    def axes(self) -> Array:
        """Return the rows right, up and forward in the world, (3, 3)."""
        return _axes(self.position, self.target)

    def matrix(self, size: tuple[int, int]) -> Array:
        """Return the matrix from world to picture, (3, 4).

        Its rows give x * depth, y * depth and depth in pixels and metres (y downwards).

        size : (width, height) in pixels; the pan is rounded to whole pixels
        """
        width, height = size
        right, up, forward = self.axes()
        focal = self.focal * height
        x0 = self.centre[0] * width + self.pan_pixels(width)
        y0 = self.centre[1] * height
        out = np.empty((3, 4))
        out[0, :3] = focal * right + x0 * forward
        out[1, :3] = -focal * up + y0 * forward
        out[2, :3] = forward
        out[:, 3] = -(out[:, 0] * self.position[0] + out[:, 1] * self.position[1] + out[:, 2] * self.position[2])
        return out

    def pan_pixels(self, width: int) -> int:
        """Return the pan in whole pixels."""
        low, high = self.pan_range
        return round(min(max(self.pan, low), high) * width)

    def project(self, points: Array, size: tuple[int, int]) -> Array:
        """Return the pixel places and depths, (n, 3), of world points (n, 3)."""
        m = self.matrix(size)
        p = points @ m[:, :3].T + m[:, 3]
        out = p.copy()
        out[:, :2] /= p[:, 2:]
        return out


@lru_cache(maxsize=64)
def _axes(position: tuple[float, float, float], target: tuple[float, float, float]) -> Array:
    """Return `Camera.axes`, computed once for each place, because every frame needs the axes several times."""
    forward = np.subtract(target, position)
    length = math.sqrt(float(forward[0] ** 2 + forward[1] ** 2 + forward[2] ** 2))
    if length < 1e-9:
        raise UsageError("the camera's position and target are the same point; move one of them")
    forward = forward / length
    flat = math.hypot(forward[0], forward[2])
    if flat < 1e-3:
        # A view straight down (or up) has no upright direction; the screen side is up, as on a plan of the pad.
        forward = np.array([0.0, math.copysign(1.0, forward[1]), 0.0])
        right = np.array([-1.0, 0.0, 0.0])
    else:
        right = np.array([-forward[2], 0.0, forward[0]]) / flat
    up = np.array(
        [
            right[1] * forward[2] - right[2] * forward[1],
            right[2] * forward[0] - right[0] * forward[2],
            right[0] * forward[1] - right[1] * forward[0],
        ]
    )
    axes = np.array([right, up, forward])
    axes.setflags(write=False)
    return axes


def preset_camera(
    name: str, extent: tuple[Array, Array], size: tuple[int, int], look: Look, region: Region = WHOLE, tall: float = 0.0
) -> Camera:
    """Return a camera by name that shows the whole dancer, jumping and with her arms up, in a part of the picture.

    Parameters
    ----------
    name : one of `look.cameras` (back, front, side, three-quarter, top)
    extent : least and greatest corner (3,) of the pad's surface in the world, see `Scene.extent`
    size : (width, height) of the picture; region : left, top, right, bottom of the part that she fills, 0..1;
        the camera's own region replaces a region of the whole picture
    tall : height of the dancer, metres, if it is more than the configured `height` of a camera that shows all of her
    """
    settings = _named(name, look)
    if region == WHOLE:
        region = settings.region
    if not settings.feet_only:
        settings = replace(settings, height=max(settings.height, tall))
    box = _box(extent, settings, look.stage.pad_height)
    target = (box.min(0) + box.max(0)) / 2
    azimuth, elevation = math.radians(settings.azimuth), math.radians(settings.elevation)
    away = np.array(
        [
            -math.sin(azimuth) * math.cos(elevation),
            math.sin(elevation),
            -math.cos(azimuth) * math.cos(elevation),
        ]
    )
    focal = 0.5 / math.tan(math.radians(settings.field) / 2)
    near, far = 0.5, 200.0
    for _ in range(50):  # bisection of the smallest distance at which everything fits
        middle = math.sqrt(near * far)
        fits, _ = _fit(box, target, target + middle * away, focal, size, region)
        near, far = (near, middle) if fits else (middle, far)
    _, camera = _fit(box, target, target + far * away, focal, size, region)
    return replace(camera, feet_only=settings.feet_only)


def free_camera(
    position: tuple[float, float, float],
    target: tuple[float, float, float],
    look: Look,
    region: Region = WHOLE,
) -> Camera:
    """Return a camera that stands at `position` and looks at `target`, which appears in the middle of `region`."""
    camera = Camera(
        position,
        target,
        0.5 / math.tan(math.radians(look.free_field) / 2),
        ((region[0] + region[2]) / 2, (region[1] + region[3]) / 2),
    )
    camera.axes()  # raises an error if the two are the same point
    return camera


def parse_camera(
    text: str, extent: tuple[Array, Array], size: tuple[int, int], look: Look, region: Region = WHOLE, tall: float = 0.0
) -> Camera:
    """Parse a camera of the command line: a preset's name, or ``x,y,z/x,y,z``, position and target in metres."""
    if _is_name(text):
        return preset_camera(text, extent, size, look, region, tall)
    (a, b, c), (d, e, f) = _points(text)
    return free_camera((a, b, c), (d, e, f), look, region)


def is_front_view(text: str, look: Look) -> bool:
    """Whether the dancer faces this camera of the command line, so that her left is on the right of the picture."""
    if _is_name(text):
        about = _named(text, look)
        return math.cos(math.radians(about.azimuth)) < _FACING and about.elevation < _STRAIGHT_DOWN
    (px, _, pz), (tx, _, tz) = _points(text)
    away = math.hypot(px - tx, pz - tz)
    return away > 1e-3 and (tz - pz) / away < _FACING


def _is_name(text: str) -> bool:
    return "/" not in text and "," not in text


def _named(name: str, look: Look) -> CameraLook:
    if name in look.cameras:
        return look.cameras[name]
    raise UsageError(f"there is no camera '{name}'{choose_text(name, look.cameras, 'POSITION/TARGET as x,y,z/x,y,z')}")


def _points(text: str) -> list[list[float]]:
    """Return position and target, three numbers each."""
    try:
        numbers = [[float(n) for n in part.split(",")] for part in text.split("/")]
    except ValueError:
        numbers = []
    if len(numbers) != 2 or any(len(n) != 3 or not all(map(math.isfinite, n)) for n in numbers):
        raise UsageError(f"camera '{text}' is neither a name nor POSITION/TARGET, for example 1.5,1.8,-4/0,0.9,0")
    return numbers


def with_pan_range(camera: Camera, low: float, high: float) -> Camera:
    """Return the camera with a range of pans between `low` and `high` picture widths."""
    return replace(camera, pan_range=(min(low, high), max(low, high)))


def _box(extent: tuple[Array, Array], settings: CameraLook, thick: float) -> Array:
    """Return points (n, 3) that must be visible: the pad, arms stretched sideways, and hands up in the middle."""
    low, high = extent
    middle = (low[2] + high[2]) / 2
    shoulder = min(1.45, settings.height)
    layers = (
        (-thick, settings.margin, low[2] - settings.margin, high[2] + settings.margin),
        (0.0, settings.margin, low[2] - settings.margin, high[2] + settings.margin),
        (shoulder, settings.arms, middle - 0.2, middle + 0.2),
        (settings.height, -0.1, middle - 0.2, middle + 0.2),
    )
    points = []
    for y, wider, near, far in layers:
        for x in (low[0] - wider, high[0] + wider):
            points += [(x, y, near), (x, y, far)]
    return np.array(points, dtype=np.float64)


def _fit(
    box: Array, target: Array, position: Array, focal: float, size: tuple[int, int], region: Region
) -> tuple[bool, Camera]:
    """Return whether the box fits into the region, and the camera whose centre puts the box in the region's middle."""
    width, height = size
    camera = Camera(
        (float(position[0]), float(position[1]), float(position[2])),
        (float(target[0]), float(target[1]), float(target[2])),
        focal,
        (0.0, 0.0),
    )
    if np.min((box - position) @ camera.axes()[2]) < NEAR:
        return False, camera
    places = camera.project(box, size)[:, :2]
    low, high = places.min(0), places.max(0)
    room = ((region[2] - region[0]) * width, (region[3] - region[1]) * height)
    centre = (
        (region[0] + region[2]) / 2 - float(low[0] + high[0]) / 2 / width,
        (region[1] + region[3]) / 2 - float(low[1] + high[1]) / 2 / height,
    )
    fits = high[0] - low[0] <= room[0] and high[1] - low[1] <= room[1]
    return bool(fits), replace(camera, centre=centre)
