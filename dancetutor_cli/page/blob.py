"""Numbers for the page: arrays in one compressed block, in a form that compresses well and is quick to read back."""

from __future__ import annotations

import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

_DTYPES = {"u1": np.uint8, "i1": np.int8, "u2": np.uint16, "i2": np.int16, "u4": np.uint32, "i4": np.int32,
           "f4": np.float32, "f8": np.float64}  # fmt: skip


class Blob:
    """Collects arrays under names; `js/blob.js` reads them."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0
        self.index: dict[str, list[Any]] = {}  # name -> [type, count, row length, rounds of differences, offset]
        self.sizes: dict[str, int] = {}  # compressed bytes of each array alone, for reports

    def add(self, name: str, values: NDArray[Any], kind: str, differences: int = 0) -> None:
        """Add an array as little-endian numbers of a kind ("i2", "f4", ...).

        differences : 0, 1 or 2: how often each row (the last axis) of whole numbers is replaced by its differences.
        Numbers of more than a byte are stored byte by byte: first all low ones, which vary, then those that repeat.
        """
        array = np.ascontiguousarray(values, dtype=np.dtype(_DTYPES[kind]).newbyteorder("<"))
        row = array.shape[-1] if array.ndim else 1
        for _ in range(differences):
            first = np.zeros((*array.shape[:-1], 1), dtype=array.dtype)
            array = np.diff(array, axis=-1, prepend=first)  # wraps round, and so does adding up
        planes = np.frombuffer(array.tobytes(), dtype=np.uint8).reshape(-1, array.dtype.itemsize).T
        data = np.ascontiguousarray(planes).tobytes()
        self.index[name] = [kind, int(array.size), int(row), differences, self._size]
        self.sizes[name] = len(zlib.compress(data, 6))
        self._parts.append(data)
        self._size += len(data)

    def add_bytes(self, name: str, data: bytes) -> None:
        """Add bytes as they are, for example an image."""
        self.add(name, np.frombuffer(data, dtype=np.uint8), "u1")

    def whole(self) -> bytes:
        """All of it, not compressed yet."""
        return b"".join(self._parts)
