"""The dancer's pixels: toon light, self shadow, rim and outline, averaged over the samples of a pixel."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from dancetutor_cli.video.cpu.surfaces import smooth


@njit(cache=True, inline="always")
def _texel(texels: Any, texture: Any, u: float, v: float) -> Any:  # pragma: no cover
    """Bilinear, repeating."""
    first, width, height = texture[0], texture[1], texture[2]
    if width == 1 and height == 1:
        return texels[first, 0], texels[first, 1], texels[first, 2]
    x, y = (u - np.floor(u)) * width - 0.5, (v - np.floor(v)) * height - 0.5
    i, j = int(np.floor(x)), int(np.floor(y))
    fx, fy = x - i, y - j
    i0, j0 = (i + width) % width, (j + height) % height
    i1, j1 = (i0 + 1) % width, (j0 + 1) % height
    a, b = first + j0 * width + i0, first + j0 * width + i1
    c, d = first + j1 * width + i0, first + j1 * width + i1
    wa, wb, wc, wd = (1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy
    return (
        texels[a, 0] * wa + texels[b, 0] * wb + texels[c, 0] * wc + texels[d, 0] * wd,
        texels[a, 1] * wa + texels[b, 1] * wb + texels[c, 1] * wc + texels[d, 1] * wd,
        texels[a, 2] * wa + texels[b, 2] * wb + texels[c, 2] * wc + texels[d, 2] * wd,
    )


@njit(cache=True, inline="always")
def _sunlit(shadow: Any, u: float, v: float, height: float) -> float:  # pragma: no cover
    """Part of the light that reaches a place: four comparisons, weighted by nearness. 1 outside of the map."""
    u -= 0.5
    v -= 0.5
    i, j = int(np.floor(u)), int(np.floor(v))
    if i < 0 or j < 0 or i >= shadow.shape[1] - 1 or j >= shadow.shape[0] - 1:
        return 1.0
    fx, fy = u - i, v - j
    a = 1.0 if shadow[j, i] <= height else 0.0
    b = 1.0 if shadow[j, i + 1] <= height else 0.0
    c = 1.0 if shadow[j + 1, i] <= height else 0.0
    d = 1.0 if shadow[j + 1, i + 1] <= height else 0.0
    top, bottom = a + (b - a) * fx, c + (d - c) * fx
    return top + (bottom - top) * fy


@njit(cache=True)
def _colour(
    t: int, px: float, py: float, triangles: Any, points: Any, world: Any, uv: Any, material: Any, texels: Any,
    textures: Any, eye: Any, light: Any, shadow: Any, axes: Any, origin: Any, scale: float, toon: Any,
) -> Any:  # fmt: skip  # pragma: no cover
    """Colour 0..1 of triangle t at a place in samples."""
    a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
    x0, y0, x1, y1, x2, y2 = points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
    area = (x2 - x0) * (y1 - y0) - (x1 - x0) * (y2 - y0)
    # Weights on the picture, kept inside of the triangle: a pixel's middle may lie just outside.
    w0 = max(((px - x1) * (y2 - y1) - (py - y1) * (x2 - x1)) / area, 0.0)
    w1 = max(((px - x2) * (y0 - y2) - (py - y2) * (x0 - x2)) / area, 0.0)
    w2 = max(1.0 - w0 - w1, 0.0)
    w0, w1, w2 = w0 * points[a, 2], w1 * points[b, 2], w2 * points[c, 2]
    total = 1.0 / (w0 + w1 + w2)
    w0, w1, w2 = w0 * total, w1 * total, w2 * total
    x = world[a, 0] * w0 + world[b, 0] * w1 + world[c, 0] * w2
    y = world[a, 1] * w0 + world[b, 1] * w1 + world[c, 1] * w2
    z = world[a, 2] * w0 + world[b, 2] * w1 + world[c, 2] * w2
    nx = world[a, 3] * w0 + world[b, 3] * w1 + world[c, 3] * w2
    ny = world[a, 4] * w0 + world[b, 4] * w1 + world[c, 4] * w2
    nz = world[a, 5] * w0 + world[b, 5] * w1 + world[c, 5] * w2
    n = 1.0 / np.sqrt(max(nx * nx + ny * ny + nz * nz, 1e-12))
    nx, ny, nz = nx * n, ny * n, nz * n
    vx, vy, vz = eye[0] - x, eye[1] - y, eye[2] - z
    n = 1.0 / np.sqrt(vx * vx + vy * vy + vz * vz)
    facing = (nx * vx + ny * vy + nz * vz) * n
    to_light = nx * light[0] + ny * light[1] + nz * light[2]
    sun = 1.0
    if scale > 0.0 and to_light > toon[0] - toon[2]:
        # A centimetre out of the surface, so that it does not shadow itself.
        bx, by, bz = (
            x + nx * 0.012 + light[0] * 0.006,
            y + ny * 0.012 + light[1] * 0.006,
            z + nz * 0.012 + light[2] * 0.006,
        )
        su = (axes[0, 0] * bx + axes[0, 1] * by + axes[0, 2] * bz - origin[0]) * scale
        sv = (axes[1, 0] * bx + axes[1, 1] * by + axes[1, 2] * bz - origin[1]) * scale
        sun = _sunlit(shadow, su, sv, axes[2, 0] * bx + axes[2, 1] * by + axes[2, 2] * bz + 100.0)
    half = smooth(toon[0] - toon[2], toon[0] + toon[2], to_light) * sun
    full = smooth(toon[1] - toon[2], toon[1] + toon[2], to_light) * sun
    level = toon[3] + (toon[4] - toon[3]) * half + (toon[5] - toon[4]) * full
    level *= 0.95 + 0.05 * ny
    edge = toon[6] * smooth(toon[7], toon[7] + 0.2, 1.0 - facing) * (0.6 + 0.4 * ny)
    m = material[a]
    r, g, bl = _texel(
        texels,
        textures[m],
        uv[a, 0] * w0 + uv[b, 0] * w1 + uv[c, 0] * w2,
        uv[a, 1] * w0 + uv[b, 1] * w1 + uv[c, 1] * w2,
    )
    r *= level * (toon[8] + (1.0 - toon[8]) * half)
    g *= level * (toon[9] + (1.0 - toon[9]) * half)
    bl *= level * (toon[10] + (1.0 - toon[10]) * half)
    edge = max(edge, 0.0)
    return min(r + (1.0 - r) * edge, 1.0), min(g + (1.0 - g) * edge, 1.0), min(bl + (1.0 - bl) * edge, 1.0)


@njit(cache=True)
def resolve(
    out: Any, box: Any, samples: int, ids: Any, count: int, triangles: Any, points: Any, world: Any, uv: Any,
    material: Any, texels: Any, textures: Any, eye: Any, light: Any, shadow: Any, axes: Any, origin: Any, scale: float,
    toon: Any,
) -> None:  # fmt: skip  # pragma: no cover
    """Put the samples of `box` (x0, y0, x1, y1 in pixels) on the picture.

    ids : triangle of each sample, -1 for none, those from `count` on are outline. One colour serves all samples of a
    pixel that see the same triangle.
    """
    share = 1.0 / (samples * samples)
    for row in range(box[1], box[3]):
        for column in range(box[0], box[2]):
            first = ids[row * samples, column * samples]
            same = True
            for j in range(samples):
                for i in range(samples):
                    if ids[row * samples + j, column * samples + i] != first:
                        same = False
            if same:
                if first < 0:
                    continue
                if first >= count:
                    r, g, b = toon[11], toon[12], toon[13]
                else:
                    r, g, b = _colour(
                        first, (column + 0.5) * samples, (row + 0.5) * samples, triangles, points, world, uv, material,
                        texels, textures, eye, light, shadow, axes, origin, scale, toon,
                    )  # fmt: skip
                covered = 1.0
            else:
                r, g, b, covered = 0.0, 0.0, 0.0, 0.0
                last = -1
                lr, lg, lb = 0.0, 0.0, 0.0
                for j in range(samples):
                    for i in range(samples):
                        y, x = row * samples + j, column * samples + i
                        t = ids[y, x]
                        if t < 0:
                            continue
                        if t >= count:
                            lr, lg, lb = toon[11], toon[12], toon[13]
                        elif t != last:
                            lr, lg, lb = _colour(
                                t, x + 0.5, y + 0.5, triangles, points, world, uv, material, texels, textures, eye,
                                light, shadow, axes, origin, scale, toon,
                            )  # fmt: skip
                        last = t
                        r += lr * share
                        g += lg * share
                        b += lb * share
                        covered += share
            rest = 1.0 - covered
            out[row, column, 0] = int(255.0 * r + out[row, column, 0] * rest + 0.5)
            out[row, column, 1] = int(255.0 * g + out[row, column, 1] * rest + 0.5)
            out[row, column, 2] = int(255.0 * b + out[row, column, 2] * rest + 0.5)
