"""The reader of untrusted .npz files, which checks shapes, types and sizes by a table before it unpacks arrays.

An .npz is a zip of .npy files, each a short header (type, shape, order) and the numbers. The headers are read first;
only when all of them fit the table and each other is the rest unpacked, and no more bytes of it than they declare.
"""

from __future__ import annotations

import io
import math
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import MEGABYTE, read_bytes, shown_key

# limit of the file and of its unpacked arrays: half an hour of a whole body at 60 frames per second
LIMIT = 256 * MEGABYTE
MOST_ENTRIES = 1000
LONGEST_NAME = 64  # letters of a string
_ENTRY_MARK = b"PK\x01\x02"  # begins each entry of a zip's directory
_BROKEN = (
    zipfile.BadZipFile,
    zlib.error,
    tokenize.TokenError,
    EOFError,
    ValueError,
    TypeError,
    SyntaxError,
    RuntimeError,
)

Kind = Literal["float", "integer", "string"]
_TAKEN: Mapping[Kind, str] = {
    "float": "float32, float64 or whole numbers",
    "integer": "whole numbers",
    "string": f"strings of at most {LONGEST_NAME} letters",
}


@dataclass(frozen=True, slots=True)
class Field:
    """The required form of an array. shape : sizes; a letter means the same size in all arrays, () one number

    low, high : the least and the greatest value; required : whether a file without the array is refused
    """

    kind: Kind
    shape: tuple[int | str, ...] = ()
    low: float = -math.inf
    high: float = math.inf
    required: bool = True


@dataclass(frozen=True, slots=True)
class _Header:
    """The header of one array. at : offset of its numbers in the entry"""

    entry: zipfile.ZipInfo
    dtype: np.dtype[Any]
    shape: tuple[int, ...]
    fortran: bool
    at: int

    @property
    def size(self) -> int:
        """The declared size of the numbers in bytes, as a Python integer, which cannot overflow."""
        return math.prod(self.shape) * self.dtype.itemsize


def read_arrays(path: Path, fields: Mapping[str, Field]) -> dict[str, NDArray[Any]]:
    """Read the arrays of `fields` as float64, int32 or strings; other arrays in the file are ignored.

    Raises FileError, one line: no regular file, no .npz, an array that is missing or is not as its field says, or
    together more than `LIMIT` bytes.
    """
    data = read_bytes(path, LIMIT)
    if data.count(_ENTRY_MARK) > MOST_ENTRIES:
        raise FileError(path, f"is an .npz of more than {MOST_ENTRIES} arrays; it is not read")
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            headers = _headers(path, archive, fields)
            _check_shapes(path, headers, fields)
            return {name: _values(path, name, archive, header, fields[name]) for name, header in headers.items()}
    except _BROKEN:
        raise FileError(path, "not an .npz file of a motion, or a broken one") from None
    except (MemoryError, OverflowError):
        raise FileError(path, "declares arrays that do not fit into memory; it is not read") from None


def _headers(path: Path, archive: zipfile.ZipFile, fields: Mapping[str, Field]) -> dict[str, _Header]:
    """Return the headers of the fields that the file has, in the order of the table."""
    entries: dict[str, zipfile.ZipInfo] = {}
    for entry in archive.infolist():
        name = entry.filename.removesuffix(".npy")
        if name in entries:
            raise FileError(path, f"has the array '{shown_key(name)}' twice; remove one")
        entries[name] = entry
    found = {}
    for name, field in fields.items():
        if name in entries:
            found[name] = _header(path, name, archive, entries[name])
            _check_type(path, name, found[name], field)
        elif field.required:
            raise FileError(path, f"not a motion: array '{name}' is missing")
    return found


def _header(path: Path, name: str, archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> _Header:
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise FileError(path, f"array '{name}' is packed in a way that numpy does not use; save it again")
    with archive.open(entry) as file:
        if np.lib.format.read_magic(file) != (1, 0):  # the only version with a header of bounded length
            raise FileError(path, f"array '{name}' has no plain type; save numbers")
        shape, fortran, dtype = np.lib.format.read_array_header_1_0(file)
        return _Header(entry, dtype, shape, fortran, file.tell())


def _check_type(path: Path, name: str, header: _Header, field: Field) -> None:
    kind, width = header.dtype.kind, header.dtype.itemsize
    fits = {
        "float": (kind == "f" and width in (4, 8)) or kind in "iu",
        "integer": kind in "iub",
        "string": kind == "U" and 0 < width <= 4 * LONGEST_NAME,
    }[field.kind]
    if not fits:
        content = "Python objects, which are never unpacked" if header.dtype.hasobject else f"{header.dtype}"
        raise FileError(path, f"array '{name}' holds {content[:80]}; it must hold {_TAKEN[field.kind]}")


def _check_shapes(path: Path, headers: Mapping[str, _Header], fields: Mapping[str, Field]) -> None:
    """Check each shape against its field, and the total size against `LIMIT`."""
    sizes: dict[str, int] = {}
    for name, header in headers.items():
        wanted = fields[name].shape
        fits = len(wanted) == len(header.shape)
        for size, rule in zip(header.shape, wanted, strict=False):
            fits &= size == (sizes.setdefault(rule, size) if isinstance(rule, str) else rule)
        if not fits:
            shape = _shape_text(header.shape)
            raise FileError(path, f"array '{name}' has the shape {shape}; it must be {_rule(wanted, sizes)}")
    total = sum(header.size for header in headers.values())
    if total > LIMIT:
        raise FileError(path, f"declares arrays of {total / MEGABYTE:,.0f} MB; at most {LIMIT / MEGABYTE:.0f} are read")
    for name, header in headers.items():
        if header.entry.file_size != header.at + header.size:
            raise FileError(path, f"array '{name}' is not as long as its shape {_shape_text(header.shape)} says")


def _shape_text(shape: tuple[int, ...]) -> str:
    return f"({', '.join(f'{size:,}'.replace(',', ' ') for size in shape[:6])}{', ...' if len(shape) > 6 else ''})"


def _rule(wanted: tuple[int | str, ...], sizes: Mapping[str, int]) -> str:
    if not wanted:
        return "one number, shape ()"
    return f"({', '.join(str(sizes.get(rule, rule) if isinstance(rule, str) else rule) for rule in wanted)})"


def _values(path: Path, name: str, archive: zipfile.ZipFile, header: _Header, field: Field) -> NDArray[Any]:
    with archive.open(header.entry) as file:
        file.seek(header.at)
        data = file.read(header.size)
        if file.read(1):
            raise zipfile.BadZipFile  # also lets the zip check its sum, which it does at the end of an entry
    raw = np.frombuffer(data, header.dtype).reshape(header.shape, order="F" if header.fortran else "C")
    if field.kind == "string":
        return raw.copy()
    if not np.isfinite(raw).all():
        raise FileError(path, f"its {name} hold values that are not numbers")
    if raw.size and not (raw.min() >= field.low and raw.max() <= field.high):
        raise FileError(path, f"array '{name}' holds values that are not from {field.low:g} to {field.high:g}")
    return np.ascontiguousarray(raw, dtype=np.float64 if field.kind == "float" else np.int32).reshape(header.shape)
