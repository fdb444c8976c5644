"""The conversion of frames from RGB to YUV 4:2:0 with BT.709, in whole numbers, the same on every machine.

ffmpeg can convert frames too, but takes nine times as long and needs twice as many bytes through the pipe.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.kernels.compiling import int32, njit, njit_inner, uint32

# Weights of red, green and blue in 1/65536: BT.709, luma 16..235 and chroma 16..240 of 255.
_KR, _KB = 0.2126, 0.0722
_KG = 1.0 - _KR - _KB
_UNIT = 65536 * 219 / 255
_LUMA = tuple(round(k * _UNIT) for k in (_KR, _KG, _KB))
_CHROMA = 65536 * 224 / 255 / 2
_BLUE = tuple(round(k * _CHROMA / (1 - _KB)) for k in (-_KR, -_KG, 1 - _KB))
_RED = tuple(round(k * _CHROMA / (1 - _KR)) for k in (1 - _KR, -_KG, -_KB))
_Y0, _Y1, _Y2 = _LUMA
_U0, _U1, _U2 = _BLUE
_V0, _V1, _V2 = _RED
_Y_BIAS = (16 << 16) + (1 << 15)
_C_BIAS = (128 << 18) + (1 << 17)  # chroma is a sum over four pixels


@njit_inner
def _luma(flat: Any, out: Any) -> None:  # pragma: no cover
    """Convert pixels to luma. The function is separate and simple so that the compiler makes vector code of it."""
    for i in range(out.shape[0]):
        r, g, b = uint32(flat[3 * i]), uint32(flat[3 * i + 1]), uint32(flat[3 * i + 2])
        out[i] = (uint32(_Y0) * r + uint32(_Y1) * g + uint32(_Y2) * b + uint32(_Y_BIAS)) >> uint32(16)


@njit_inner
def _chroma(upper: Any, lower: Any, us: Any, vs: Any) -> None:  # pragma: no cover
    """Convert two rows of pixels to a row of chroma."""
    for i in range(us.shape[0]):
        k = 6 * i
        r = int32(upper[k]) + int32(upper[k + 3]) + int32(lower[k]) + int32(lower[k + 3])
        g = int32(upper[k + 1]) + int32(upper[k + 4]) + int32(lower[k + 1]) + int32(lower[k + 4])
        b = int32(upper[k + 2]) + int32(upper[k + 5]) + int32(lower[k + 2]) + int32(lower[k + 5])
        us[i] = (int32(_U0) * r + int32(_U1) * g + int32(_U2) * b + int32(_C_BIAS)) >> int32(18)
        vs[i] = (int32(_V0) * r + int32(_V1) * g + int32(_V2) * b + int32(_C_BIAS)) >> int32(18)


@njit(cache=True)
def _planes(flat: Any, width: int, height: int, out: Any) -> None:  # pragma: no cover
    size, half = width * height, width // 2
    _luma(flat, out[:size])
    for row in range(height // 2):
        first = 6 * width * row
        u, v = size + row * half, size + size // 4 + row * half
        _chroma(
            flat[first : first + 3 * width], flat[first + 3 * width : first + 6 * width],
            out[u : u + half], out[v : v + half],
        )  # fmt: skip


def yuv420(frame: NDArray[np.uint8], out: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Convert a frame to the planes Y, U and V, one after the other.

    frame : uint8 (h, w, 3), sRGB, h and w even; out : uint8 (h * w * 3 / 2,), filled and returned
    """
    height, width = frame.shape[:2]
    if height % 2 or width % 2 or out.shape != (height * width * 3 // 2,):
        raise ValueError(f"a frame of {width}x{height} does not fit YUV 4:2:0 of {out.shape[0]} bytes")
    _planes(np.ascontiguousarray(frame).reshape(-1), width, height, out)
    return out
