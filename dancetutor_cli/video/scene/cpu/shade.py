"""The dancer's pixels: toon light, self shadow, rim and outline, averaged over the samples of a pixel."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.kernels import njit
from dancetutor_cli.video.scene.cpu.raster import BAND, Canvas
from dancetutor_cli.video.scene.cpu.uncounted import kernel
from dancetutor_cli.video.scene.look import ToonLook
from dancetutor_cli.video.scene.textures import LEVELS

Array = NDArray[np.float64]


# Places in the rows that `light_vertices` writes, one row of 64 bytes for each vertex.
_X, _Y, _W, _TO_LIGHT, _FACING, _UP, _SU, _SV, _HEIGHT, _U, _V, _MATERIAL = range(12)
# Places in the row of numbers `toon` that `resolve` takes; see `toon_numbers`.
_BANDS, _STEEP, _LEVELS, _RIM, _SHADE, _OUTLINE, _CAST, _LIMBS, PER_METRE = 0, 2, 3, 6, 8, 11, 14, 15, 16
_RIM_WIDTH = 0.2
_CLOSE = 0.006  # of its depth: samples farther from each other are coloured apart
OFF_SURFACE = (0.012, 0.006)  # metres along normal and light: a surface must not shadow itself


def toon_numbers(toon: ToonLook, cast: bool) -> Array:
    """The numbers of the shading in one row; cast : is there a shadow map?

    The last, `PER_METRE`, is for the pixels that a metre of the dancer has, which changes with the camera.
    """
    shade, outline = np.array(toon.shade) / 255.0, np.array(toon.outline) / 255.0
    starts = [edge - toon.soft for edge in toon.bands]  # each edge is a step from here, 1 / steepness wide
    numbers = [*starts, 0.5 / toon.soft, *toon.levels, toon.rim, toon.rim_from, *shade, *outline, float(cast)]
    numbers += [toon.limbs, 0.0]
    return np.array(numbers, dtype=np.float64)


class Surface(NamedTuple):
    """What does not change of the triangles' look; see `geometry.Packed` and `textures.Skins.flat`."""

    uv: NDArray[np.float32]
    material: NDArray[np.int32]
    patch: NDArray[np.int32]
    density: NDArray[np.float32]
    texels: NDArray[np.uint8]
    textures: NDArray[np.int32]
    meshes: NDArray[np.float32]


class Drawn(NamedTuple):
    """What `raster.fill` has drawn of which triangles; numbers from their count on are outline."""

    canvas: Canvas
    triangles: NDArray[np.int32]


class Light(NamedTuple):
    """What colours are made with. vertex : of `light_vertices`; shadow : the map; toon : `toon_numbers`"""

    vertex: NDArray[np.float32]
    shadow: NDArray[np.float32]
    toon: Array


class Room(NamedTuple):
    """Room for one number a sample of a pixel: its triangle, -1 once it is coloured, and its depth."""

    seen: NDArray[np.int64]
    depths: Array


@njit(cache=True)
def light_vertices(world: Any, points: Any, surface: Any, eye: Any, cast: Any, out: Any) -> None:  # pragma: no cover
    """What is interpolated over a triangle, out float32 (v, 16).

    world (v, 9), points (v, 3) from `raster`; cast : `prepare.Cast`
    """
    uv, material = surface.uv, surface.material
    axes, origin, scale = cast.axes, cast.origin, cast.scale
    for v in range(world.shape[0]):
        x, y, z = world[v, 0], world[v, 1], world[v, 2]
        nx, ny, nz = world[v, 3], world[v, 4], world[v, 5]
        vx, vy, vz = eye[0] - x, eye[1] - y, eye[2] - z
        out[v, _X], out[v, _Y], out[v, _W] = points[v, 0], points[v, 1], points[v, 2]
        out[v, _TO_LIGHT] = nx * axes[2, 0] + ny * axes[2, 1] + nz * axes[2, 2]
        out[v, _FACING] = (nx * vx + ny * vy + nz * vz) / np.sqrt(vx * vx + vy * vy + vz * vz)
        out[v, _UP] = ny
        x += nx * OFF_SURFACE[0] + axes[2, 0] * OFF_SURFACE[1]
        y += ny * OFF_SURFACE[0] + axes[2, 1] * OFF_SURFACE[1]
        z += nz * OFF_SURFACE[0] + axes[2, 2] * OFF_SURFACE[1]
        out[v, _SU] = (axes[0, 0] * x + axes[0, 1] * y + axes[0, 2] * z - origin[0]) * scale
        out[v, _SV] = (axes[1, 0] * x + axes[1, 1] * y + axes[1, 2] * z - origin[1]) * scale
        out[v, _HEIGHT] = axes[2, 0] * x + axes[2, 1] * y + axes[2, 2] * z
        out[v, _U], out[v, _V], out[v, _MATERIAL] = uv[v, 0], uv[v, 1], material[v]


@njit(cache=True, inline="always")
def _step(t: float) -> float:  # pragma: no cover
    """0 below 0, 1 above 1, a cubic between."""
    t = min(1.0, max(0.0, t))
    return t * t * (3.0 - 2.0 * t)


@njit(cache=True, inline="always")
def _texel(texels: Any, first: int, width: int, height: int, u: float, v: float) -> Any:  # pragma: no cover
    """Bilinear, repeating."""
    x, y = (u - np.floor(u)) * width - 0.5, (v - np.floor(v)) * height - 0.5
    i0, j0 = int(np.floor(x)), int(np.floor(y))
    fx, fy = x - i0, y - j0
    i1, j1 = i0 + 1, j0 + 1
    if i0 < 0:
        i0 = width - 1
    if j0 < 0:
        j0 = height - 1
    if i1 >= width:
        i1 = 0
    if j1 >= height:
        j1 = 0
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
    """Part of the light that reaches a place: nine comparisons, the mean over two by two texels. 1 outside of the map.

    The same as four taps of a graphics card, half a texel away from the place in both directions.
    """
    x, y = u - 1.0, v - 1.0
    i, j = int(np.floor(x)), int(np.floor(y))
    if i < 0 or j < 0 or i >= shadow.shape[1] - 2 or j >= shadow.shape[0] - 2:
        return 1.0
    fx, fy = x - i, y - j
    light = 0.0
    for row in range(3):
        here = 0.0
        if shadow[j + row, i] <= height:
            here = 1.0 - fx
        if shadow[j + row, i + 1] <= height:
            here += 1.0
        if shadow[j + row, i + 2] <= height:
            here += fx
        light += here * (1.0 - fy if row == 0 else (1.0 if row == 1 else fy))
    return 0.25 * light


@njit(cache=True, inline="always")
def _colour(corners: Any, px: float, py: float, dense: float, surface: Any, light: Any) -> Any:  # pragma: no cover
    """Colour 0..1 of a triangle, by its vertices, at a place in samples; dense : texels a metre, a little less."""
    a, b, c = corners
    vertex, shadow, toon = light.vertex, light.shadow, light.toon
    texels, textures, meshes = surface.texels, surface.textures, surface.meshes
    x0, y0, x1, y1 = vertex[a, _X], vertex[a, _Y], vertex[b, _X], vertex[b, _Y]
    x2, y2 = vertex[c, _X], vertex[c, _Y]
    # Weights on the picture, kept inside of the triangle (a pixel's middle may lie just outside), then in space.
    w0 = max((px - x1) * (y2 - y1) - (py - y1) * (x2 - x1), 0.0) * vertex[a, _W]
    w1 = max((px - x2) * (y0 - y2) - (py - y2) * (x0 - x2), 0.0) * vertex[b, _W]
    w2 = max((px - x0) * (y1 - y0) - (py - y0) * (x1 - x0), 0.0) * vertex[c, _W]
    total = 1.0 / (w0 + w1 + w2)
    w0, w1, w2 = w0 * total, w1 * total, w2 * total
    to_light = vertex[a, _TO_LIGHT] * w0 + vertex[b, _TO_LIGHT] * w1 + vertex[c, _TO_LIGHT] * w2
    facing = vertex[a, _FACING] * w0 + vertex[b, _FACING] * w1 + vertex[c, _FACING] * w2
    up = vertex[a, _UP] * w0 + vertex[b, _UP] * w1 + vertex[c, _UP] * w2
    sun = 1.0
    if toon[_CAST] > 0.0 and to_light > toon[_BANDS]:
        su = vertex[a, _SU] * w0 + vertex[b, _SU] * w1 + vertex[c, _SU] * w2
        sv = vertex[a, _SV] * w0 + vertex[b, _SV] * w1 + vertex[c, _SV] * w2
        height = vertex[a, _HEIGHT] * w0 + vertex[b, _HEIGHT] * w1 + vertex[c, _HEIGHT] * w2
        sun = _sunlit(shadow, su, sv, height + 100.0)
    half = _step((to_light - toon[_BANDS]) * toon[_STEEP]) * (0.5 + 0.5 * sun)  # a cast shadow is lighter than shade
    full = _step((to_light - toon[_BANDS + 1]) * toon[_STEEP]) * sun
    m = int(vertex[a, _MATERIAL])
    half = max(half, meshes[m, 4] * toon[_LIMBS])
    level = toon[_LEVELS] + (toon[_LEVELS + 1] - toon[_LEVELS]) * half
    level = (level + (toon[_LEVELS + 2] - toon[_LEVELS + 1]) * full) * (0.95 + 0.05 * up)
    rim = 1.0 - facing - toon[_RIM + 1]
    rim = toon[_RIM] * _step(rim * (1.0 / _RIM_WIDTH)) * (0.6 + 0.4 * up) if rim > 0.0 else 0.0
    u = vertex[a, _U] * w0 + vertex[b, _U] * w1 + vertex[c, _U] * w2
    v = vertex[a, _V] * w0 + vertex[b, _V] * w1 + vertex[c, _V] * w2
    # The image of the texture in which a texel is about a pixel.
    image, smallest = int(meshes[m, 3]), int(meshes[m, 3]) + LEVELS - 1
    while image < smallest and dense > toon[PER_METRE]:
        image += 1
        dense *= 0.5
    red, green, blue = _texel(texels, textures[image, 0], textures[image, 1], textures[image, 2], u, v)
    red *= meshes[m, 0] * level * (toon[_SHADE] + (1.0 - toon[_SHADE]) * half)
    green *= meshes[m, 1] * level * (toon[_SHADE + 1] + (1.0 - toon[_SHADE + 1]) * half)
    blue *= meshes[m, 2] * level * (toon[_SHADE + 2] + (1.0 - toon[_SHADE + 2]) * half)
    return min(red + (1.0 - red) * rim, 1.0), min(green + (1.0 - green) * rim, 1.0), min(blue + (1.0 - blue) * rim, 1.0)


@njit(cache=True, inline="always")
def _one_piece(keys: Any, row: int, column: int, samples: int, triangles: Any) -> bool:  # pragma: no cover
    """Do all samples of a pixel see one triangle, or one piece of surface at about the same depth?

    keys : of `raster.Canvas.nearest`, the first sample's place; triangles : their count, and the piece of each
    """
    count, patch = triangles
    key = keys[row, column]
    number, depth = (key & 0xFFFFFFFF) - 1, key >> 32
    close = _CLOSE * depth
    for j in range(samples):
        for i in range(samples):
            other = keys[row + j, column + i]
            t = (other & 0xFFFFFFFF) - 1
            if t == number:
                continue
            if t < 0 or t >= count or number < 0 or number >= count or patch[t] != patch[number]:
                return False
            if abs((other >> 32) - depth) >= close:
                return False
    return True


@kernel
def resolve(out: Any, samples: int, drawn: Any, surface: Any, light: Any, room: Any) -> None:  # pragma: no cover
    """Put the samples on the picture and forget them: nothing is left on the canvas.

    drawn : `Drawn`; surface : `Surface`; light : `Light`; room : `Room`
    One colour serves all samples of a pixel that see the same piece of surface at about the same depth.
    """
    nearest, spans, triangles = drawn.canvas.nearest, drawn.canvas.spans, drawn.triangles
    patch, density, toon, seen, depths = surface.patch, surface.density, light.toon, room.seen, room.depths
    count = triangles.shape[0]
    total = samples * samples
    share = 1.0 / total
    for row in range(out.shape[0]):
        top, band = row * samples, row * samples // BAND
        for column in range(spans[band, 0] // samples, (spans[band, 1] + samples - 1) // samples):
            left = column * samples
            whole = _one_piece(nearest, top, left, samples, (count, patch))
            covered, k = total, 0
            if whole:
                seen[0] = (nearest[top, left] & 0xFFFFFFFF) - 1
                if seen[0] < 0:
                    continue
            else:
                covered = 0
                for j in range(samples):
                    for i in range(samples):
                        key = nearest[top + j, left + i]
                        seen[k] = (key & 0xFFFFFFFF) - 1
                        depths[k] = key >> 32
                        covered += key != 0
                        k += 1
            for j in range(samples):
                for i in range(samples):
                    nearest[top + j, left + i] = 0
            r, g, b = 0.0, 0.0, 0.0
            for k in range(1 if whole else total):
                t = seen[k]
                if t < 0:
                    continue
                weight = 1.0 if whole else share
                if t >= count:
                    r += weight * toon[_OUTLINE]
                    g += weight * toon[_OUTLINE + 1]
                    b += weight * toon[_OUTLINE + 2]
                    continue
                if not whole:
                    piece, close = patch[t], _CLOSE * depths[k]
                    for m in range(k + 1, total):
                        other = seen[m]
                        if other == t or (
                            0 <= other < count and patch[other] == piece and abs(depths[m] - depths[k]) < close
                        ):
                            seen[m] = -1
                            weight += share
                px, py = (column + 0.5) * samples, (row + 0.5) * samples
                if weight < 0.5:
                    px, py = left + k % samples + 0.5, top + k // samples + 0.5
                corners = triangles[t, 0], triangles[t, 1], triangles[t, 2]
                cr, cg, cb = _colour(corners, px, py, 0.7 * density[t], surface, light)
                r += weight * cr
                g += weight * cg
                b += weight * cb
            rest = 1.0 - covered * share
            out[row, column, 0] = int(255.0 * r + out[row, column, 0] * rest + 0.5)
            out[row, column, 1] = int(255.0 * g + out[row, column, 1] * rest + 0.5)
            out[row, column, 2] = int(255.0 * b + out[row, column, 2] * rest + 0.5)
    for band in range(spans.shape[0]):
        spans[band, 0] = nearest.shape[1]
        spans[band, 1] = 0
