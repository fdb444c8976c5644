"""Colours of places on the dancer, many at a time: toon light, self shadow, rim and texture.

Each step goes over all places of a block before the next one begins: small loops without branches, of which a processor
does several rounds at once. That takes a third of the time of one place after the other.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import float32, uint64
from numpy.typing import NDArray

from dancetutor_cli.video.scene.cpu.uncounted import inner_kernel
from dancetutor_cli.video.scene.look import ToonLook
from dancetutor_cli.video.scene.textures import LEVELS

F32 = NDArray[np.float32]
BLOCK = 256  # places that are coloured together: what is known of them stays in the nearest cache

# Places in the rows that `shade.light_vertices` writes, one row of 64 bytes for each vertex.
X, Y, W, TO_LIGHT, FACING, UP, SU, SV, HEIGHT, U, V, MATERIAL = range(12)
_ROW = 16
# Places in the row of numbers `toon`; see `toon_numbers`.
_BANDS, _STEEP, _LEVELS, _RIM, _SHADE, OUTLINE, _CAST, _LIMBS, PER_METRE = 0, 2, 3, 6, 8, 11, 14, 15, 16
_RIM_WIDTH = 0.2
_BELOW = 100.0  # what `raster.project_light` adds to heights
_ONE, _HALF, _NONE = float32(1.0), float32(0.5), float32(0.0)


def toon_numbers(toon: ToonLook, cast: bool) -> F32:
    """The numbers of the shading in one row; cast : is there a shadow map?

    The last, `PER_METRE`, is for the pixels that a metre of the dancer has, which changes with the camera.
    """
    shade, outline = np.array(toon.shade) / 255.0, np.array(toon.outline) / 255.0
    starts = [edge - toon.soft for edge in toon.bands]  # each edge is a step from here, 1 / steepness wide
    numbers = [*starts, 0.5 / toon.soft, *toon.levels, toon.rim, toon.rim_from, *shade, *outline, float(cast)]
    numbers += [toon.limbs, 0.0]
    return np.array(numbers, dtype=np.float32)


class Surface(NamedTuple):
    """What does not change of the triangles' look; see `geometry.Packed` and `textures.Skins.flat`."""

    uv: F32
    material: NDArray[np.int32]
    patch: NDArray[np.int32]
    density: F32
    texels: NDArray[np.uint8]
    textures: NDArray[np.int32]
    meshes: F32


class Light(NamedTuple):
    """What colours are made with. vertex : of `shade.light_vertices`; shadow : the map; toon : `toon_numbers`"""

    vertex: F32
    shadow: F32
    toon: F32


class Fragments(NamedTuple):
    """A block of places on the dancer.

    triangle : int32 (n,); spot : float32 (n, 2), where in samples; share : float32 (n,), of which pixel, int32 (n,)
    mean : float32 (n, 16), what the rows of the triangle's vertices come to there
    sun : float32 (n,), how much of the light is not taken by her own shadow; colour : float32 (n, 4), 0..1
    """

    triangle: NDArray[np.int32]
    spot: F32
    share: F32
    pixel: NDArray[np.int32]
    mean: F32
    sun: F32
    colour: F32


def empty_fragments() -> Fragments:
    """Room for a block."""
    numbers = (np.zeros((BLOCK, n), np.float32) for n in (2, _ROW, 4))
    spot, mean, colour = numbers
    return Fragments(
        np.zeros(BLOCK, np.int32),
        spot,
        np.zeros(BLOCK, np.float32),
        np.zeros(BLOCK, np.int32),
        mean,
        np.ones(BLOCK, np.float32),
        colour,
    )


@inner_kernel
def _interpolate(count: int, some: Any, triangles: Any, vertex: Any) -> None:  # pragma: no cover
    """Fill `mean`: weights on the picture, kept inside of the triangle (a pixel's middle may lie just outside)."""
    mean = some.mean
    for n in range(count):
        i = uint64(n)
        t = uint64(some.triangle[i])
        a, b, c = uint64(triangles[t, 0]), uint64(triangles[t, 1]), uint64(triangles[t, 2])
        px, py = some.spot[i, 0], some.spot[i, 1]
        x0, y0, x1, y1 = vertex[a, X], vertex[a, Y], vertex[b, X], vertex[b, Y]
        x2, y2 = vertex[c, X], vertex[c, Y]
        w0 = max((px - x1) * (y2 - y1) - (py - y1) * (x2 - x1), _NONE) * vertex[a, W]
        w1 = max((px - x2) * (y0 - y2) - (py - y2) * (x0 - x2), _NONE) * vertex[b, W]
        w2 = max((px - x0) * (y1 - y0) - (py - y0) * (x1 - x0), _NONE) * vertex[c, W]
        whole = _ONE / (w0 + w1 + w2)
        w0, w1, w2 = w0 * whole, w1 * whole, w2 * whole
        # all is read before anything is written, so that the processor can do it in one go
        to_light = vertex[a, TO_LIGHT] * w0 + vertex[b, TO_LIGHT] * w1 + vertex[c, TO_LIGHT] * w2
        facing = vertex[a, FACING] * w0 + vertex[b, FACING] * w1 + vertex[c, FACING] * w2
        up = vertex[a, UP] * w0 + vertex[b, UP] * w1 + vertex[c, UP] * w2
        su = vertex[a, SU] * w0 + vertex[b, SU] * w1 + vertex[c, SU] * w2
        sv = vertex[a, SV] * w0 + vertex[b, SV] * w1 + vertex[c, SV] * w2
        height = vertex[a, HEIGHT] * w0 + vertex[b, HEIGHT] * w1 + vertex[c, HEIGHT] * w2
        u = vertex[a, U] * w0 + vertex[b, U] * w1 + vertex[c, U] * w2
        v = vertex[a, V] * w0 + vertex[b, V] * w1 + vertex[c, V] * w2
        material = vertex[a, MATERIAL]
        mean[i, TO_LIGHT], mean[i, FACING], mean[i, UP], mean[i, SU] = to_light, facing, up, su
        mean[i, SV], mean[i, HEIGHT], mean[i, U], mean[i, V] = sv, height, u, v
        mean[i, MATERIAL] = material


@inner_kernel
def _shadowed(count: int, some: Any, light: Any) -> None:  # pragma: no cover
    """Fill `sun`: nine comparisons, the mean over two by two texels; 1 outside of the map.

    The same as four taps of a graphics card, half a texel away from the place in both directions.
    """
    shadow, toon, mean, sun = light.shadow, light.toon, some.mean, some.sun
    least = toon[_BANDS]
    for n in range(count):
        i = uint64(n)
        sun[i] = _ONE
        if mean[i, TO_LIGHT] <= least:
            continue
        x, y, height = mean[i, SU] - _ONE, mean[i, SV] - _ONE, mean[i, HEIGHT] + float32(_BELOW)
        left, top = np.floor(x), np.floor(y)
        c, r = int(left), int(top)
        if c < 0 or r < 0 or c >= shadow.shape[1] - 2 or r >= shadow.shape[0] - 2:
            continue
        fx, fy = x - left, y - top
        column, row = uint64(c), uint64(r)
        total = _NONE
        for k in range(3):
            j = row + uint64(k)
            first = _ONE - fx if shadow[j, column] <= height else _NONE
            second = _ONE if shadow[j, column + uint64(1)] <= height else _NONE
            third = fx if shadow[j, column + uint64(2)] <= height else _NONE
            total += (first + second + third) * (_ONE - fy if k == 0 else (_ONE if k == 1 else fy))
        sun[i] = float32(0.25) * total


@inner_kernel
def _step(t: Any) -> Any:  # pragma: no cover
    """0 below 0, 1 above 1, a cubic between."""
    t = min(_ONE, max(_NONE, t))
    return t * t * (float32(3.0) - float32(2.0) * t)


@inner_kernel
def _coloured(count: int, some: Any, surface: Any, toon: Any) -> None:  # pragma: no cover
    """Fill `colour`: the texture, bilinear and repeating, in toon light."""
    mean, colour, density = some.mean, some.colour, surface.density
    texels, textures, meshes = surface.texels, surface.textures, surface.meshes
    low, middle, high = toon[_LEVELS], toon[_LEVELS + 1] - toon[_LEVELS], toon[_LEVELS + 2] - toon[_LEVELS + 1]
    for n in range(count):
        i = uint64(n)
        m, up = uint64(int(mean[i, MATERIAL] + _HALF)), mean[i, UP]
        # a cast shadow is lighter than shade
        half = _step((mean[i, TO_LIGHT] - toon[_BANDS]) * toon[_STEEP]) * (_HALF + _HALF * some.sun[i])
        full = _step((mean[i, TO_LIGHT] - toon[_BANDS + 1]) * toon[_STEEP]) * some.sun[i]
        half = max(half, meshes[m, 4] * toon[_LIMBS])
        level = (low + middle * half + high * full) * (float32(0.95) + float32(0.05) * up)
        rim = _step((_ONE - mean[i, FACING] - toon[_RIM + 1]) * float32(1.0 / _RIM_WIDTH))
        rim *= toon[_RIM] * (float32(0.6) + float32(0.4) * up)
        # The image of the texture in which a texel is about a pixel.
        dense, image = float32(0.7) * density[uint64(some.triangle[i])], uint64(int(meshes[m, 3]))
        for _ in range(LEVELS - 1):
            if dense > toon[PER_METRE]:
                image += uint64(1)
                dense *= _HALF
        first, width, height = textures[image, 0], textures[image, 1], textures[image, 2]
        u, v = mean[i, U], mean[i, V]
        x = (u - np.floor(u)) * float32(width) - _HALF
        y = (v - np.floor(v)) * float32(height) - _HALF
        left, top = np.floor(x), np.floor(y)
        fx, fy = x - left, y - top
        i0, j0 = int(left), int(top)
        i1 = i0 + 1 if i0 + 1 < width else 0
        j1 = j0 + 1 if j0 + 1 < height else 0
        i0 = i0 if i0 >= 0 else width - 1
        j0 = j0 if j0 >= 0 else height - 1
        upper, lower = first + j0 * width, first + j1 * width
        a, b, c, d = uint64(upper + i0), uint64(upper + i1), uint64(lower + i0), uint64(lower + i1)
        wa, wb, wc, wd = (_ONE - fx) * (_ONE - fy), fx * (_ONE - fy), (_ONE - fx) * fy, fx * fy
        red = float32(texels[a, 0]) * wa + float32(texels[b, 0]) * wb
        green = float32(texels[a, 1]) * wa + float32(texels[b, 1]) * wb
        blue = float32(texels[a, 2]) * wa + float32(texels[b, 2]) * wb
        red += float32(texels[c, 0]) * wc + float32(texels[d, 0]) * wd
        green += float32(texels[c, 1]) * wc + float32(texels[d, 1]) * wd
        blue += float32(texels[c, 2]) * wc + float32(texels[d, 2]) * wd
        red *= meshes[m, 0] * level * (toon[_SHADE] + (_ONE - toon[_SHADE]) * half)
        green *= meshes[m, 1] * level * (toon[_SHADE + 1] + (_ONE - toon[_SHADE + 1]) * half)
        blue *= meshes[m, 2] * level * (toon[_SHADE + 2] + (_ONE - toon[_SHADE + 2]) * half)
        colour[i, 0] = min(red + (_ONE - red) * rim, _ONE)
        colour[i, 1] = min(green + (_ONE - green) * rim, _ONE)
        colour[i, 2] = min(blue + (_ONE - blue) * rim, _ONE)


@inner_kernel
def colour(count: int, some: Any, triangles: Any, surface: Any, light: Any) -> None:  # pragma: no cover
    """Fill the colours of the first `count` of `Fragments`, whose triangles, places and shares are there."""
    _interpolate(count, some, triangles, light.vertex)
    if light.toon[_CAST] > 0.0:
        _shadowed(count, some, light)
    _coloured(count, some, surface, light.toon)
