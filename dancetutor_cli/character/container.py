"""The GLB container: JSON, binary chunk, accessors and images with every size checked, and its tree of nodes.

A user's file may be broken or hostile: nothing outside the file is ever opened, and all limits are defined here.
Source: glTF 2.0 specification, Khronos Group, sections 3.6 (binary data) and 4 (GLB).
"""

from __future__ import annotations

import base64
import binascii
import io
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import parse_json, read_bytes

if TYPE_CHECKING:
    from PIL import Image


MAX_FILE = 100_000_000  # bytes; a file of this size or more is refused unread
MAX_JSON = 16_000_000  # bytes
MAX_ITEMS = 20_000  # nodes, accessors, buffer views, meshes ...
MAX_ELEMENTS = 4_000_000  # numbers in one accessor
MAX_PIXELS = 4096 * 4096  # of one image
MAX_ALL_PIXELS = 8 * MAX_PIXELS  # of all images of a file

_DTYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_SUPPORTED = ("KHR_materials_", "KHR_mesh_quantization", "KHR_texture_transform", "EXT_texture_webp", "VRM")  # starts


@dataclass(slots=True)
class Container:
    """A checked GLB. document : the JSON; binary : the binary chunk"""

    path: Path
    document: dict[str, Any]
    binary: memoryview
    _pixels: int = field(default=0)
    _checked: dict[str, list[dict[str, Any]]] = field(default_factory=dict)

    def fail(self, message: str) -> FileError:
        """Return the error to raise about this file."""
        return FileError(self.path, message)

    def items(self, name: str) -> list[dict[str, Any]]:
        """Return a top-level array of objects, empty if absent.

        Raises FileError if it is something else or too long.
        """
        if name in self._checked:
            return self._checked[name]
        value = self.document.get(name, [])
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            raise self.fail(f"'{name}' is not a list of objects; export the character again")
        if len(value) > MAX_ITEMS:
            raise self.fail(f"{len(value)} {name} are more than the {MAX_ITEMS} allowed")
        self._checked[name] = value
        return value

    def item(self, name: str, index: object) -> dict[str, Any]:
        """Return one object of a top-level array. Raises FileError if the index is out of range."""
        items = self.items(name)
        return items[self.integer(index, 0, len(items) - 1, f"index into {name}")]

    def integer(self, value: object, low: int, high: int, what: str) -> int:
        """Return `value` if it is an int in low..high, else raise FileError."""
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise self.fail(f"{what} {str(value)[:40]} is not from {low} to {high}; the file is broken")
        return value

    def numbers(self, value: object, count: int, what: str) -> NDArray[np.float64]:
        """Return `value` if it is a list of `count` finite numbers, else raise FileError."""
        rows = value if isinstance(value, list) and len(value) == count else [None]
        if not all(isinstance(x, (int, float)) and abs(x) < 1e12 for x in rows):
            raise self.fail(f"{what} is not a list of {count} numbers; the file is broken")
        return np.array(rows, dtype=np.float64)

    def view(self, index: object) -> tuple[memoryview, int]:
        """Return the bytes of a buffer view and its stride (0 if elements are packed)."""
        view = self.item("bufferViews", index)
        data = self._buffer(view.get("buffer"))
        start = self.integer(view.get("byteOffset", 0), 0, len(data), "byteOffset")
        length = self.integer(view.get("byteLength"), 1, len(data) - start, "byteLength")
        return data[start : start + length], self.integer(view.get("byteStride", 0), 0, 252, "byteStride")

    def accessor(self, index: object) -> NDArray[Any]:
        """Return the values of an accessor, (n,) or (n, width); normalised integers become float64."""
        item = self.item("accessors", index)
        dtype = np.dtype(_DTYPES.get(self.integer(item.get("componentType"), 0, 2**16, "componentType"), "V1"))
        width = _WIDTHS.get(str(item.get("type")), 0)
        if dtype.kind == "V" or not width:
            raise self.fail(f"accessor {index} has an unknown type; the file is broken")
        count = self.integer(item.get("count"), 1, 2**32, "accessor count")
        if count * width > MAX_ELEMENTS:
            raise self.fail(f"accessor {index} holds more than {MAX_ELEMENTS} numbers; reduce the character's mesh")
        if "bufferView" in item:
            raw = self._array(item, dtype, count, width)
        elif "sparse" in item:
            raw = np.zeros((count, width), dtype)
        else:
            raise self.fail(f"accessor {index} has no data; export the character without compression")
        if "sparse" in item:
            raw = self._with_sparse(item["sparse"], raw)
        normalized = item.get("normalized") is True and dtype.kind in "iu"
        values = raw.astype(np.float64) / np.iinfo(dtype).max if normalized else raw
        if values.dtype.kind == "f" and not np.isfinite(values).all():
            raise self.fail(f"accessor {index} holds values that are not numbers; the file is broken")
        if normalized and dtype.kind == "i":
            values = np.maximum(values, -1.0)
        return values[:, 0] if width == 1 else values

    def _array(self, item: dict[str, Any], dtype: np.dtype[Any], count: int, width: int) -> NDArray[Any]:
        """Return `count` rows of `width` numbers at the item's bufferView and byteOffset, without a copy."""
        data, stride = self.view(item.get("bufferView"))
        size = dtype.itemsize * width
        stride = stride or size
        offset = self.integer(item.get("byteOffset", 0), 0, len(data), "byteOffset")
        if stride < size or offset + stride * (count - 1) + size > len(data):
            raise self.fail("an accessor reaches past its buffer; the file is broken")
        return np.ndarray((count, width), dtype, data, offset, (stride, dtype.itemsize))

    def _with_sparse(self, sparse: object, raw: NDArray[Any]) -> NDArray[Any]:
        """Return the rows with the replacements of a sparse accessor."""
        sparse = as_dict(sparse)
        indices, values = as_dict(sparse.get("indices")), as_dict(sparse.get("values"))
        count = self.integer(sparse.get("count"), 1, len(raw), "count of a sparse accessor")
        kind = _DTYPES.get(self.integer(indices.get("componentType"), 5121, 5125, "componentType"), "")
        if not kind.startswith("<u"):
            raise self.fail("a sparse accessor has an unknown type; the file is broken")
        rows = self._array(indices, np.dtype(kind), count, 1)[:, 0]
        if int(rows.max()) >= len(raw):
            raise self.fail("a sparse accessor's indices point past its rows; the file is broken")
        out = raw.copy()
        out[rows] = self._array(values, raw.dtype, count, raw.shape[1])
        return out

    def image_size(self, index: object) -> tuple[int, int]:
        """Return the width and height of an image, from its header."""
        with self._open(index) as picture:
            return picture.width, picture.height

    def image(self, index: object, side: int = 4096) -> NDArray[np.uint8]:
        """Return the pixels of an image, (h, w, 4) sRGB, reduced until neither side is longer than `side`."""
        with self._open(index) as picture:
            pixels = picture.width * picture.height
            self._pixels += pixels
            if pixels > MAX_PIXELS or self._pixels > MAX_ALL_PIXELS:
                raise self.fail(f"a texture of {picture.width} x {picture.height} is too large; use 4096 x 4096")
            whole = picture.convert("RGBA")
            factor = -(-max(whole.size) // side)
            return np.array(whole.reduce(factor) if factor > 1 else whole)

    @contextmanager
    def _open(self, index: object) -> Iterator[Image.Image]:
        from PIL import Image, UnidentifiedImageError

        item = self.item("images", index)
        data = self._uri(item["uri"]) if "uri" in item else self.view(item.get("bufferView"))[0]
        try:
            with Image.open(io.BytesIO(data), formats=("PNG", "JPEG", "WEBP")) as picture:
                yield picture
        except (UnidentifiedImageError, OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
            raise self.fail(f"texture {index} cannot be read: {' '.join(str(error).split())[:160]}") from error

    def _buffer(self, index: object) -> memoryview:
        item = self.item("buffers", index)
        if "uri" in item:
            return memoryview(self._uri(item["uri"]))
        if index != 0:
            raise self.fail(f"buffer {index} has no data; export the character without compression")
        return self.binary

    def _uri(self, uri: object) -> bytes:
        head, _, body = str(uri).partition(",")
        if not head.startswith("data:") or not head.endswith(";base64"):
            raise self.fail(
                f"refers to something outside the file ({str(uri)[:60]!r}), which is never opened; "
                "export one .glb with everything in it"
            )
        try:
            return base64.b64decode(body, validate=True)
        except binascii.Error as error:
            raise self.fail("a data: URI is not base64; the file is broken") from error


def as_dict(value: object) -> dict[str, Any]:
    """Return `value` if it is a JSON object, else an empty one."""
    return value if isinstance(value, dict) else {}


def read_container(path: Path) -> Container:
    """Read a .glb or .vrm file.

    Raises FileError, one line, for a file that is missing, too large, no GLB 2.0, damaged, or needs an extension
    this reader lacks.
    """
    data = memoryview(read_bytes(path, MAX_FILE - 1))
    document, binary = _chunks(path, data)
    container = Container(path, _parse(path, document), binary)
    _check_head(container)
    return container


def _chunks(path: Path, data: memoryview) -> tuple[memoryview, memoryview]:
    if len(data) < 20 or bytes(data[:4]) != b"glTF":
        raise FileError(path, "is not a binary glTF file; name a .glb or .vrm file")
    version, total = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise FileError(path, f"is glTF version {version}; export it as glTF 2.0")
    chunks: dict[bytes, memoryview] = {}
    at = 12
    end = min(total, len(data))
    while at + 8 <= end:
        length, kind = struct.unpack_from("<I4s", data, at)
        if at + 8 + length > end:
            raise FileError(path, "ends in the middle of a chunk; the file is cut off")
        chunks.setdefault(kind, data[at + 8 : at + 8 + length])
        at += 8 + length + (-length % 4)
    if b"JSON" not in chunks:
        raise FileError(path, "has no JSON chunk; the file is broken")
    return chunks[b"JSON"], chunks.get(b"BIN\0", memoryview(b""))


def _parse(path: Path, data: memoryview) -> dict[str, Any]:
    if len(data) > MAX_JSON:
        raise FileError(
            path, f"its JSON of {len(data) / 1e6:.0f} MB is too large; the limit is {MAX_JSON / 1e6:.0f} MB"
        )
    try:
        document = parse_json(bytes(data), path)
    except FileError as error:
        raise FileError(path, f"its JSON cannot be read: it {error.message}") from error
    if not isinstance(document, dict):
        raise FileError(path, "its JSON is not an object; the file is broken")
    return document


def _check_head(container: Container) -> None:
    required = container.document.get("extensionsRequired", [])
    names = [str(name) for name in required] if isinstance(required, list) else []
    missing = [n for n in names if not n.startswith(_SUPPORTED)]
    if missing:
        raise container.fail(f"needs {', '.join(missing)[:120]}, not supported here; export it without compression")
    for name in ("buffers", "images"):
        for item in container.items(name):
            if "uri" in item and not str(item["uri"]).startswith("data:"):
                container._uri(item["uri"])


# The node tree of a glTF file: parents, names and rest matrices; a graph that is not a tree is refused.


@dataclass(frozen=True, slots=True)
class Nodes:
    """n nodes. names : of each node ("" if it has none); parents : int32 (n,), -1 for a root

    order : node indices, parents before children; world : float64 (n, 4, 4), node to world at rest
    """

    names: tuple[str, ...]
    parents: NDArray[np.int32]
    order: tuple[int, ...]
    world: NDArray[np.float64]


def read_nodes(container: Container) -> Nodes:
    """Read all nodes; FileError where a node has two parents, is its own ancestor or has a broken transform."""
    items = container.items("nodes")
    if not items:
        raise container.fail("holds no nodes; export the character with its skeleton")
    parents = np.full(len(items), -1, dtype=np.int32)
    for i, node in enumerate(items):
        children = node.get("children", [])
        if not isinstance(children, list):
            raise container.fail(f"children of node {i} are not a list; the file is broken")
        for child in children:
            c = container.integer(child, 0, len(items) - 1, "child of a node")
            if parents[c] >= 0 or c == i:
                raise container.fail(f"node {c} has two parents or is its own; the file is broken")
            parents[c] = i
    order = _order(parents)
    if len(order) != len(items):
        raise container.fail("its nodes form a circle; the file is broken")
    world = np.empty((len(items), 4, 4))
    for i in order:
        local = _local(container, items[i])
        world[i] = local if parents[i] < 0 else world[parents[i]] @ local
    if not np.isfinite(world).all() or (np.abs(world) > 1e9).any():
        raise container.fail("a node's transform is out of range; the file is broken")
    return Nodes(tuple(str(node.get("name", ""))[:200] for node in items), parents, order, world)


def _order(parents: NDArray[np.int32]) -> tuple[int, ...]:
    children: dict[int, list[int]] = {}
    for i, p in enumerate(parents.tolist()):
        children.setdefault(p, []).append(i)
    order = list(children.get(-1, []))
    for i in order:  # grows while it is walked: breadth first
        order.extend(children.get(i, []))
    return tuple(order)


def _local(container: Container, node: dict[str, Any]) -> NDArray[np.float64]:
    if "matrix" in node:
        return container.numbers(node["matrix"], 16, "a node's matrix").reshape(4, 4).T
    local = np.eye(4)
    x, y, z, w = container.numbers(node.get("rotation", [0, 0, 0, 1]), 4, "a node's rotation")
    norm = x * x + y * y + z * z + w * w
    if norm < 1e-12:
        raise container.fail("a node's rotation is zero; the file is broken")
    s = 2.0 / norm
    local[:3, :3] = [
        [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
    ]
    local[:3, :3] *= container.numbers(node.get("scale", [1, 1, 1]), 3, "a node's scale")
    local[:3, 3] = container.numbers(node.get("translation", [0, 0, 0]), 3, "a node's translation")
    return local
