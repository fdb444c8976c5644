"""A camera that slowly follows the dancer across a wide pad, and shows all of her as she walks on and off.

The camera does not turn or travel: the picture pans (see `Camera.pan`) by whole pixels, so the still part of the
picture is drawn only once. The pan is the dancer's place, smoothed over a window that is symmetric in time. It has no
lag, because the whole song is known.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from dancetutor_cli.character.mesh import rest_vertices
from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.scene.camera import WHOLE, Camera, Region, preset_camera, with_pan_range
from dancetutor_cli.film.scene.scene import PANEL, Scene

_STEP = 1.0 / 30.0  # seconds between the places that are smoothed
_ASIDE = 0.45  # metres from the dancer's root to her hands as she walks
# Seconds by which the camera is ahead of the dancer at the picture's edge, and over which its move is smoothed.
_COME, _EASE = 0.2, 0.6


def is_wide(scene: Scene) -> bool:
    """Whether the pad is wider than one square of 3 by 3 panels, so that following the dancer shows more."""
    low, high = scene.extent
    return bool(high[0] - low[0] > 3.5 * PANEL)


class RootTrack(NamedTuple):
    """Where the root of one dancer, or of two, is at the seconds of a film.

    seconds : float64 (f,), increasing; places : float64 (f, 3), metres, or (2, f, 3) for two dancers
    """

    seconds: Array
    places: Array


class Follow:
    """The camera at every second of a song.

    scene : the scene with its pad; name : a preset camera; size : (width, height) of the picture
    track : the places of the dancer's root; two dancers are not followed, but shown as they walk on and off
    region : the part of the picture that the dancer fills
    cut : the width of the pad that is outside of the picture at the worst moment, picture widths
    """

    def __init__(
        self, scene: Scene, name: str, size: tuple[int, int], track: RootTrack, region: Region = WHOLE
    ) -> None:
        seconds, roots = track
        self._start = float(seconds[0])
        count = max(2, int(np.ceil((float(seconds[-1]) - self._start) / _STEP)) + 1)
        regular = self._start + _STEP * np.arange(count)
        across = np.array([np.interp(regular, seconds, x) for x in np.atleast_2d(roots[..., 0])])
        if is_wide(scene) and len(across) == 1:
            camera, pans = _along(scene, _nearer(scene, name, size, region), size, across[0])
        else:
            camera, pans = scene.camera(name, size, region), np.zeros(count)
        aside = max(_ASIDE, 1.1 * float(np.abs(rest_vertices(scene.character)[:, 2]).max()))  # seen from her side
        seen = np.array([_picture_x(scene, camera, size, one) + pans for one in across])
        pans = pans + _into_the_picture(seen, camera, size, aside)
        self.cut = _pad_cut(scene, camera, size, pans)
        self._pans = pans
        self.camera = with_pan_range(camera, float(pans.min()), float(pans.max()))

    def at(self, second: float) -> Camera:
        """Return the camera at `second`; it does not move before the first second and after the last."""
        place = min(max((second - self._start) / _STEP, 0.0), len(self._pans) - 1.0)
        pan = float(np.interp(place, np.arange(len(self._pans)), self._pans))
        return replace(self.camera, pan=pan)


def _nearer(scene: Scene, name: str, size: tuple[int, int], region: Region) -> Camera:
    """Return the preset camera for the middle square of a wide pad, nearer than the camera for the whole pad."""
    low, high = scene.extent
    middle, half = (low + high) / 2, 1.5 * PANEL
    square = low.copy(), high.copy()
    square[0][0], square[1][0] = middle[0] - half, middle[0] + half
    return preset_camera(name, square, size, scene.look, region, scene.dancer_height)


def _along(scene: Scene, camera: Camera, size: tuple[int, int], across: Array) -> tuple[Camera, Array]:
    """Return the camera and its pans (n,) along a wide pad.

    across : the dancer's place at every `_STEP`, (n,), metres to her left
    """
    low, high = scene.extent
    middle = (low[0] + high[0]) / 2
    reach = min((high[0] - low[0]) / 2 - 1.5 * PANEL, _reach_with_whole_pad(camera, size, low, high))
    # Clipped before the smoothing, so that the path stays within the limits and has no corner at them.
    places = _smooth(np.clip(across, middle - reach, middle + reach), scene.look.follow.seconds)
    there = _picture_x(scene, camera, size, np.append(places, middle))
    return camera, there[-1] - there[:-1]


def _picture_x(scene: Scene, camera: Camera, size: tuple[int, int], across: Array) -> Array:
    """Return the x coordinates in the picture of places across the pad, (n,), picture widths.

    The dancer's height and depth do not move the camera: each place is a point at waist height over the pad's middle.
    """
    low, high = scene.extent
    points = np.column_stack([across, np.full(len(across), 0.9), np.full(len(across), (low[2] + high[2]) / 2)])
    return np.asarray(camera.project(points, size)[:, 0] / size[0])


def _into_the_picture(seen: Array, camera: Camera, size: tuple[int, int], aside: float) -> Array:
    """Return pans (n,) that bring all dancers into the picture when one of them is at its edge.

    seen : the dancers' middles, (p, n), picture widths; aside : a dancer's reach from her middle, metres
    """
    depth = float(np.linalg.norm(np.subtract(camera.target, camera.position)))
    half = min(0.5, aside * camera.focal * size[1] / size[0] / depth)
    from_left = np.maximum(half - seen.min(axis=0), 0.0)
    from_right = np.maximum(seen.max(axis=0) - (1.0 - half), 0.0)
    return _early(from_left) - _early(from_right)


def _pad_cut(scene: Scene, camera: Camera, size: tuple[int, int], pans: Array) -> float:
    """Return the width of the pad that is outside of the picture at the worst moment, picture widths."""
    low, high = scene.extent
    corners = np.array([(x, high[1], z) for x in (low[0], high[0]) for z in (low[2], high[2])])
    edges = camera.project(corners, size)[:, 0] / size[0]
    return max(0.0, -float(edges.min() + pans.min()), float(edges.max() + pans.max()) - 1.0)


def farther(region: Region, back: float) -> Region:
    """Return the part of the picture that a region fills at `back` times the distance, with the same lower edge."""
    left, top, right, bottom = region
    middle, half = (left + right) / 2, (right - left) / 2 / back
    return middle - half, bottom - (bottom - top) / back, middle + half, bottom


def _early(pans: Array) -> Array:
    """Return smooth pans of the same size that begin earlier and end later."""
    half = max(1, round(_COME / _STEP / 2)) + round(_EASE / _STEP)
    if not pans.any():
        return pans
    padded = np.pad(pans, half, mode="edge")
    most = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1).max(axis=1)
    return _smooth(most, _EASE)


def _reach_with_whole_pad(camera: Camera, size: tuple[int, int], low: Array, high: Array) -> float:
    """Return how far from the pad's middle a camera may follow, metres, with the whole pad in the picture.

    There is no limit if the picture does not show the whole pad.

    low, high : corners (3,) of the pad's surface
    """
    corners = np.array([(x, high[1], z) for x in (low[0], high[0]) for z in (low[2], high[2])])
    edges = camera.project(corners, size)[:, 0]
    spare = min(float(edges.min()), size[0] - float(edges.max()))
    middle = (low + high) / 2
    waist = np.array([(middle[0] + x, 0.9, middle[2]) for x in (-0.5, 0.5)])
    metre = abs(float(np.diff(camera.project(waist, size)[:, 0])[0]))
    return spare / metre if spare > 0 else np.inf


def _smooth(values: Array, seconds: float) -> Array:
    """Smooth values by two running means over `seconds` each, which leave no corner; both ends are extended."""
    half = max(1, round(seconds / _STEP / 2))
    for _ in range(2):
        padded = np.concatenate([np.full(half, values[0]), values, np.full(half, values[-1])])
        total = np.cumsum(np.concatenate([[0.0], padded]))
        values = (total[2 * half + 1 :] - total[: -2 * half - 1]) / (2 * half + 1)
    return values


# A motion without a chart: the bare floor under it, and the numbers of a camera that follows the character from aside.
# The film of a motion and the page of a capture show it alike.

EYE = np.array([1.5, 0.45, 3.1])  # place of the camera, from its target, metres
TARGET_HEIGHT = 0.9  # height of the camera's target, metres
FOCAL, FOLLOWED_BELOW = 1.35, 0.4  # focal length in picture heights; hertz below which the camera follows
ROOM = 2.0  # panels of floor around the character's path
FULL_RED = 10.0  # smallest distance of a point from the input that is drawn in full red, centimetres


@dataclass(frozen=True, slots=True)
class BareFloor:
    """A pad of tiles without arrows, as large as the character's path."""

    panels: Array
    arrows: Array
    centre: tuple[float, float]
    squares: Array


def floor_under(root: Array) -> BareFloor:
    """Return a floor around the path (f, 3) of one or more roots, metres."""
    low, high = root[:, [0, 2]].min(axis=0) / PANEL, root[:, [0, 2]].max(axis=0) / PANEL
    corners = np.array([[-high[0] - ROOM, low[1] - ROOM], [-low[0] + ROOM, high[1] + ROOM]])
    return BareFloor(np.round(corners), np.zeros((2, 2)), (0.0, 0.0), np.zeros((1, 2)))
