"""The colours of places on the dancer, many at a time: toon light, self shadow, rim and texture.

Each step handles all places of a block before the next step begins. Some steps only fetch scattered data. The others
calculate in small loops without branches, which the compiler turns into vector code. This takes a third of the time of
a loop over single places.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.film.scene.cpu.raster import njit_raster_inner
from dancetutor_cli.film.scene.geometry import LEVELS
from dancetutor_cli.film.scene.look import ToonLook
from dancetutor_cli.run.kernels.compiling import float32, int32, njit, uint64

F32 = NDArray[np.float32]
BLOCK = 256  # places that are coloured together, whose data stay in the nearest cache

# Indices in the rows that `shade.light_vertices` writes, one row of 64 bytes for each vertex.
X, Y, W, TO_LIGHT, FACING, UP, SU, SV, HEIGHT, U, V, MATERIAL = range(12)
# Indices in the row of numbers `toon`; see `toon_numbers`.
_BANDS, _STEEP, _LEVELS, _RIM, _SHADE, OUTLINE, _CAST, _LIMBS, PER_METRE = 0, 2, 3, 6, 8, 11, 14, 15, 16
_RIM_WIDTH = 0.2
_BELOW = 100.0  # the constant that `raster.project_light` adds to heights
_ONE, _HALF, _NONE = float32(1.0), float32(0.5), float32(0.0)


def toon_numbers(toon: ToonLook, cast: bool) -> F32:
    """Return the numbers of the shading in one row; cast : whether there is a shadow map.

    The last number, `PER_METRE`, is the pixels of a metre of the dancer, which changes with the camera.
    """
    shade, outline = np.array(toon.shade) / 255.0, np.array(toon.outline) / 255.0
    starts = [edge - toon.soft for edge in toon.bands]  # each edge is a step that starts here, 1 / steepness wide
    numbers = [*starts, 0.5 / toon.soft, *toon.levels, toon.rim, toon.rim_from, *shade, *outline, float(cast)]
    numbers += [toon.limbs, 0.0]
    return np.array(numbers, dtype=np.float32)


class Surface(NamedTuple):
    """The constant part of the triangles' look; see `geometry.PackedMeshes` and `geometry.Skins.flat`."""

    uv: F32
    above: F32
    material: NDArray[np.int32]
    patch: NDArray[np.int32]
    density: F32
    texels: NDArray[np.int32]
    textures: NDArray[np.int32]
    meshes: F32


class Light(NamedTuple):
    """The data for colours. vertex : rows of `shade.light_vertices`; shadow : the shadow map; toon : `toon_numbers`"""

    vertex: F32
    shadow: F32
    toon: F32


# The data of a block's places are in rows of one flat array, at a fixed distance from each other. With this layout the
# compiler can see that rows do not overlap, and makes vector code of the loops over them.
(
    _LIT, _FACE, _UPWARD, _LEFT, _TOP, _HIGH, _ACROSS, _ALONG,  # interpolated rows of the triangle's vertices
    _SUN,  # share of the light that the dancer's own shadow leaves
    _LEAST, _TINT_RED, _TINT_GREEN, _TINT_BLUE,  # numbers of the mesh
    _LEVEL, _HALF_LIGHT, _EDGE,  # numbers of the toon light
    _UPPER_LEFT, _UPPER_RIGHT, _LOWER_LEFT, _LOWER_RIGHT,  # weights of four texels
    RED, GREEN, BLUE,  # 0..1
) = (np.uint64(row * BLOCK) for row in range(23))  # fmt: skip
_FIRST, _WIDTH, _TALL, _A, _B, _C, _D = (np.uint64(row * BLOCK) for row in range(7))  # whole numbers of the image


class Fragments(NamedTuple):
    """A block of places on the dancer.

    triangle : int32 (n,); spot : float32 (n, 2), place in samples; share : float32 (n,), share of a pixel
    pixel : int32 (n,), the number of the pixel in `shade`
    rows : float32 (23 * n,) and places : int32 (7 * n,), the data of each place; three rows are the colours, 0..1
    """

    triangle: NDArray[np.int32]
    spot: F32
    share: F32
    pixel: NDArray[np.int32]
    rows: F32
    places: NDArray[np.int32]


def empty_fragments() -> Fragments:
    """Return memory for a block."""
    rows = np.zeros(23 * BLOCK, np.float32)
    rows[int(_SUN) : int(_SUN) + BLOCK] = 1.0
    return Fragments(
        np.zeros(BLOCK, np.int32),
        np.zeros((BLOCK, 2), np.float32),
        np.zeros(BLOCK, np.float32),
        np.zeros(BLOCK, np.int32),
        rows,
        np.zeros(7 * BLOCK, np.int32),
    )


@njit_raster_inner
def _interpolate(count: int, some: Any, triangles: Any, surface: Any, light: Any) -> None:  # pragma: no cover
    """Gather the data of triangles and meshes.

    The weights come from the place on the picture, kept inside the triangle (a pixel's middle may lie just outside).
    """
    rows, places, vertex = some.rows, some.places, light.vertex
    meshes, textures, near = surface.meshes, surface.textures, light.toon[PER_METRE]
    cast = light.toon[_CAST] > _NONE
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
        # All reads come before all writes, which is faster.
        to_light = vertex[a, TO_LIGHT] * w0 + vertex[b, TO_LIGHT] * w1 + vertex[c, TO_LIGHT] * w2
        facing = vertex[a, FACING] * w0 + vertex[b, FACING] * w1 + vertex[c, FACING] * w2
        up = vertex[a, UP] * w0 + vertex[b, UP] * w1 + vertex[c, UP] * w2
        u = vertex[a, U] * w0 + vertex[b, U] * w1 + vertex[c, U] * w2
        v = vertex[a, V] * w0 + vertex[b, V] * w1 + vertex[c, V] * w2
        if cast:
            su = vertex[a, SU] * w0 + vertex[b, SU] * w1 + vertex[c, SU] * w2
            sv = vertex[a, SV] * w0 + vertex[b, SV] * w1 + vertex[c, SV] * w2
            height = vertex[a, HEIGHT] * w0 + vertex[b, HEIGHT] * w1 + vertex[c, HEIGHT] * w2
            rows[_LEFT + i], rows[_TOP + i], rows[_HIGH + i] = su, sv, height
        m = uint64(int(vertex[a, MATERIAL] + _HALF))
        # Choose the image of the texture in which a texel is about a pixel.
        dense, image = float32(0.7) * surface.density[t], uint64(int(meshes[m, 3]))
        for _ in range(LEVELS - 1):
            if dense > near:
                image += uint64(1)
                dense *= _HALF
        least, red, green, blue = meshes[m, 4], meshes[m, 0], meshes[m, 1], meshes[m, 2]
        first, width, tall = textures[image, 0], textures[image, 1], textures[image, 2]
        rows[_LIT + i], rows[_FACE + i], rows[_UPWARD + i] = to_light, facing, up
        rows[_ACROSS + i], rows[_ALONG + i], rows[_LEAST + i] = u, v, least
        rows[_TINT_RED + i], rows[_TINT_GREEN + i], rows[_TINT_BLUE + i] = red, green, blue
        places[_FIRST + i], places[_WIDTH + i], places[_TALL + i] = first, width, tall


@njit_raster_inner
def _shadowed(count: int, some: Any, light: Any) -> None:  # pragma: no cover
    """Fill the row of the sun by nine comparisons, as the mean over two by two texels; 1 outside of the map.

    The result is the same as four taps of a graphics card, half a texel away from the place in both directions.
    """
    shadow, toon, rows = light.shadow, light.toon, some.rows
    least = toon[_BANDS]
    for n in range(count):
        i = uint64(n)
        rows[_SUN + i] = _ONE
        if rows[_LIT + i] <= least:
            continue
        x, y, height = rows[_LEFT + i] - _ONE, rows[_TOP + i] - _ONE, rows[_HIGH + i] + float32(_BELOW)
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
        rows[_SUN + i] = float32(0.25) * total


@njit(cache=True, inline="always")
def _step(t: Any) -> Any:  # pragma: no cover
    """Return 0 below 0, 1 above 1, and a cubic between them."""
    t = min(_ONE, max(_NONE, t))
    return t * t * (float32(3.0) - float32(2.0) * t)


@njit_raster_inner
def _toon_light(count: int, rows: Any, toon: Any) -> None:  # pragma: no cover
    """Fill the rows of the toon light."""
    half_from, full_from, steep, limbs = toon[_BANDS], toon[_BANDS + 1], toon[_STEEP], toon[_LIMBS]
    low, middle, high = toon[_LEVELS], toon[_LEVELS + 1] - toon[_LEVELS], toon[_LEVELS + 2] - toon[_LEVELS + 1]
    rim_strength, rim_from = toon[_RIM], toon[_RIM + 1]
    for n in range(count):
        i = uint64(n)
        to_light, up, sun = rows[_LIT + i], rows[_UPWARD + i], rows[_SUN + i]
        # A cast shadow is lighter than shade.
        half = _step((to_light - half_from) * steep) * (_HALF + _HALF * sun)
        full = _step((to_light - full_from) * steep) * sun
        half = max(half, rows[_LEAST + i] * limbs)
        level = (low + middle * half + high * full) * (float32(0.95) + float32(0.05) * up)
        rim = _step((_ONE - rows[_FACE + i] - rim_from) * float32(1.0 / _RIM_WIDTH))
        rim *= rim_strength * (float32(0.6) + float32(0.4) * up)
        rows[_HALF_LIGHT + i], rows[_LEVEL + i], rows[_EDGE + i] = half, level, rim


@njit_raster_inner
def _texel_places(count: int, rows: Any, places: Any) -> None:  # pragma: no cover
    """Fill the indices and weights of four texels, of a texture that repeats."""
    for n in range(count):
        i = uint64(n)
        u, v, first, width, tall = (
            rows[_ACROSS + i],
            rows[_ALONG + i],
            places[_FIRST + i],
            places[_WIDTH + i],
            places[_TALL + i],
        )
        x = (u - np.floor(u)) * float32(width) - _HALF
        y = (v - np.floor(v)) * float32(tall) - _HALF
        left, top = np.floor(x), np.floor(y)
        fx, fy = x - left, y - top
        i0, j0 = int32(left), int32(top)
        i1 = int32(i0 + int32(1)) if i0 + int32(1) < width else int32(0)
        j1 = int32(j0 + int32(1)) if j0 + int32(1) < tall else int32(0)
        i0 = i0 if i0 >= int32(0) else int32(width - int32(1))
        j0 = j0 if j0 >= int32(0) else int32(tall - int32(1))
        upper, lower = int32(first + j0 * width), int32(first + j1 * width)
        places[_A + i], places[_B + i], places[_C + i], places[_D + i] = upper + i0, upper + i1, lower + i0, lower + i1
        rows[_UPPER_LEFT + i], rows[_UPPER_RIGHT + i] = (_ONE - fx) * (_ONE - fy), fx * (_ONE - fy)
        rows[_LOWER_LEFT + i], rows[_LOWER_RIGHT + i] = (_ONE - fx) * fy, fx * fy


@njit_raster_inner
def _fetch(count: int, places: Any, texels: Any) -> None:  # pragma: no cover
    """Replace the indices of the four texels by the texels."""
    for n in range(count):
        i = uint64(n)
        a, b = texels[uint64(places[_A + i])], texels[uint64(places[_B + i])]
        c, d = texels[uint64(places[_C + i])], texels[uint64(places[_D + i])]
        places[_A + i], places[_B + i], places[_C + i], places[_D + i] = a, b, c, d


@njit(cache=True, inline="always")
def _channel(texel: Any, shift: Any) -> Any:  # pragma: no cover
    return float32((texel >> shift) & int32(255))


@njit_raster_inner
def _lit(count: int, rows: Any, places: Any, toon: Any) -> None:  # pragma: no cover
    """Fill the colours from the texture, interpolated and lit."""
    shade_red, shade_green, shade_blue = toon[_SHADE], toon[_SHADE + 1], toon[_SHADE + 2]
    for n in range(count):
        i = uint64(n)
        a, b, c, d = places[_A + i], places[_B + i], places[_C + i], places[_D + i]
        wa, wb, wc, wd = rows[_UPPER_LEFT + i], rows[_UPPER_RIGHT + i], rows[_LOWER_LEFT + i], rows[_LOWER_RIGHT + i]
        red = _channel(a, int32(0)) * wa + _channel(b, int32(0)) * wb
        green = _channel(a, int32(8)) * wa + _channel(b, int32(8)) * wb
        blue = _channel(a, int32(16)) * wa + _channel(b, int32(16)) * wb
        red += _channel(c, int32(0)) * wc + _channel(d, int32(0)) * wd
        green += _channel(c, int32(8)) * wc + _channel(d, int32(8)) * wd
        blue += _channel(c, int32(16)) * wc + _channel(d, int32(16)) * wd
        half, level, rim = rows[_HALF_LIGHT + i], rows[_LEVEL + i], rows[_EDGE + i]
        red *= rows[_TINT_RED + i] * level * (shade_red + (_ONE - shade_red) * half)
        green *= rows[_TINT_GREEN + i] * level * (shade_green + (_ONE - shade_green) * half)
        blue *= rows[_TINT_BLUE + i] * level * (shade_blue + (_ONE - shade_blue) * half)
        rows[RED + i] = min(red + (_ONE - red) * rim, _ONE)
        rows[GREEN + i] = min(green + (_ONE - green) * rim, _ONE)
        rows[BLUE + i] = min(blue + (_ONE - blue) * rim, _ONE)


@njit_raster_inner
def colour_places(count: int, some: Any, triangles: Any, surface: Any, light: Any) -> None:  # pragma: no cover
    """Fill the colours of the first `count` places of `Fragments`, which have triangles, spots and shares."""
    _interpolate(count, some, triangles, surface, light)
    if light.toon[_CAST] > 0.0:
        _shadowed(count, some, light)
    _toon_light(count, some.rows, light.toon)
    _texel_places(count, some.rows, some.places)
    _fetch(count, some.places, surface.texels)
    _lit(count, some.rows, some.places, light.toon)
