"""Shapes as signed distances in pixels, negative inside: clean edges, outlines and glows at any size."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Field = NDArray[np.float64]
SAMPLES = 2  # supersampling per axis: distances are exact, but corners and thin outlines want it


def grid(height: int, width: int) -> tuple[Field, Field]:
    """Sample places (x, y) from the centre of a picture, (height * SAMPLES, width * SAMPLES), in pixels."""
    y = (np.arange(height * SAMPLES) + 0.5) / SAMPLES - height / 2
    x = (np.arange(width * SAMPLES) + 0.5) / SAMPLES - width / 2
    return np.meshgrid(x, y)


def polygon(x: Field, y: Field, points: NDArray[np.float64]) -> Field:
    """Distance to a closed polygon with corners `points` (n, 2)."""
    nearest = np.full(x.shape, np.inf)
    inside = np.zeros(x.shape, dtype=bool)
    for (ax, ay), (bx, by) in zip(points, np.roll(points, -1, axis=0), strict=True):
        ex, ey = bx - ax, by - ay
        t = np.clip(((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey), 0, 1)
        nearest = np.minimum(nearest, (x - ax - t * ex) ** 2 + (y - ay - t * ey) ** 2)
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * ex)
    return np.asarray(np.where(inside, -1, 1) * np.sqrt(nearest))


def disc(x: Field, y: Field, radius: float) -> Field:
    """Distance to a disc around the centre."""
    return np.asarray(np.hypot(x, y) - radius)


def rounded_box(x: Field, y: Field, half_width: float, half_height: float, radius: float) -> Field:
    """Distance to a rectangle around the centre with round corners."""
    qx, qy = np.abs(x) - half_width + radius, np.abs(y) - half_height + radius
    outside = np.hypot(np.maximum(qx, 0), np.maximum(qy, 0))
    return np.asarray(outside + np.minimum(np.maximum(qx, qy), 0) - radius)


def cover(distance: Field, width: float = 1.0) -> Field:
    """Share of each sample inside the shape, its edge `width` samples soft."""
    return np.asarray(np.clip(0.5 - distance * SAMPLES / width, 0, 1))


class Painter:
    """Lays colours over each other on a premultiplied picture, then averages the samples."""

    def __init__(self, height: int, width: int) -> None:
        self.x, self.y = grid(height, width)
        self.planes = np.zeros((4, *self.x.shape), dtype=np.float32)  # one after the other: they add up quicker

    def paint(self, share: Field, colour: NDArray[np.float64] | tuple[float, ...], opacity: float = 1.0) -> None:
        """Lay `colour`, 0..255 (3,) or per sample (h, w, 3), over the picture where `share` is more than 0."""
        alpha = np.clip(share * opacity, 0, 1).astype(np.float32)
        self.planes *= 1 - alpha
        inks = np.asarray(colour, dtype=np.float32) / 255
        for plane, ink in zip(self.planes, np.moveaxis(inks, -1, 0), strict=False):
            plane += alpha * ink
        self.planes[3] += alpha

    def sprite(self) -> NDArray[np.uint8]:
        """The picture as a premultiplied uint8 sprite (h, w, 4)."""
        h, w = (n // SAMPLES for n in self.x.shape)
        mean = self.planes.reshape(4, h, SAMPLES, w, SAMPLES).mean(axis=(2, 4))
        return np.ascontiguousarray(np.rint(mean * 255).astype(np.uint8).transpose(1, 2, 0))
