"""A screen in the dancer's room: a flat picture, drawn in perspective behind her."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.kernels.compiling import njit
from dancetutor_cli.video.picture import Frame

if TYPE_CHECKING:
    from dancetutor_cli.video.scene.camera import Camera

FRAME = (14, 15, 24)
RIM = (96, 104, 150)
THICK = 0.035  # of the rim, as a part of the screen's sides


class _Place(NamedTuple):
    """Where the screen is. inverse : (3, 3), pixels to places on it, 0..1; box : pixels around it; rim : thickness."""

    inverse: NDArray[np.float64]
    box: NDArray[np.int64]
    rim: float


@njit(cache=True)
def _warp(frame: Any, picture: Any, still: Any, place: Any, colours: Any) -> None:  # pragma: no cover
    """Draw `picture` where the frame still shows `still`; place : `_Place`; colours : of screen and rim, (2, 3)."""
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
            if hidden:  # the dancer stands before it
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
    """A screen at a place in the world, seen by a camera that never moves.

    centre : world, metres; size : width and height, metres; still : the room without the dancer, uint8 (h, w, 3)
    """

    def __init__(
        self, centre: tuple[float, float, float], size: tuple[float, float], camera: Camera, still: Frame
    ) -> None:
        self.still = still
        height, width = still.shape[:2]
        x, y, z = centre
        w, h = size[0] / 2, size[1] / 2
        # She looks to +Z, so the screen looks to -Z, and its left edge, as she sees it, is at greater x.
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
    """The matrix (3, 3) that takes the corners (0,0), (1,0), (1,1), (0,1) to four places (4, 2) in the picture."""
    rows, wanted = [], []
    for (u, v), (x, y) in zip(((0, 0), (1, 0), (1, 1), (0, 1)), places, strict=True):
        rows.append([u, v, 1, 0, 0, 0, -u * x, -v * x])
        rows.append([0, 0, 0, u, v, 1, -u * y, -v * y])
        wanted += [x, y]
    solution = np.linalg.solve(np.array(rows, dtype=np.float64), np.array(wanted))
    return np.append(solution, 1.0).reshape(3, 3)
