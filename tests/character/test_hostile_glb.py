"""Broken and malicious character files: one line, nothing outside the file is opened, nothing large is allocated."""

from __future__ import annotations

import json
import os
import struct
import tracemalloc
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from glb_edit import edited, joined, parts_of

from dancetutor_cli.character.characters import load_character
from dancetutor_cli.character.gltf import read_character, unit_normals
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import PACKAGE

SOURCE = PACKAGE / "character" / "data" / "mannequin.glb"


def put(*path: Any) -> Callable[[dict[str, Any]], None]:
    """A change that sets document[path[0]][path[1]]... to the last item."""

    def change(document: dict[str, Any]) -> None:
        at: Any = document
        for step in path[:-2]:
            at = at[step]
        at[path[-2]] = path[-1]

    return change


_TEXTURE = ("materials", 0, "pbrMetallicRoughness", "baseColorTexture")
CHANGES: dict[str, Callable[[dict[str, Any]], object]] = {
    "external buffer": put("buffers", 0, "uri", "other.bin"),
    "absolute path": put("buffers", 0, "uri", "/etc/passwd"),
    "windows path": put("buffers", 0, "uri", "C:\\Windows\\win.ini"),
    "network": put("images", 0, "uri", "https://example.org/a.png"),
    "file uri": put("images", 0, "uri", "file:///etc/passwd"),
    "bad data uri": put("images", 0, "uri", "data:image/png;base64,!!!"),
    "huge count": put("accessors", 1, "count", 2**40),
    "count past the buffer": put("accessors", 1, "count", 10_000_000),
    "negative count": put("accessors", 1, "count", -1),
    "float count": put("accessors", 1, "count", 12.5),
    "negative offset": put("bufferViews", 1, "byteOffset", -8),
    "view past the buffer": put("bufferViews", 1, "byteLength", 2**31),
    "huge stride": put("bufferViews", 1, "byteStride", 2**20),
    "no such buffer": put("bufferViews", 1, "buffer", 7),
    "no such accessor": put("meshes", 0, "primitives", 0, "attributes", "POSITION", 10**9),
    "no such material": put("meshes", 0, "primitives", 0, "material", 99),
    "no such skin": put("nodes", 35, "skin", 3),
    "no such joint": put("skins", 0, "joints", [9999]),
    "too many joints": put("skins", 0, "joints", [0] * 5000),
    "fewer matrices than joints": put("accessors", 0, "count", 2),
    "own child": put("nodes", 3, "children", [3]),
    "circle": put("nodes", 4, "children", [0]),
    "two parents": put("nodes", 20, "children", [5]),
    "children no list": put("nodes", 0, "children", "all"),
    "nodes no list": put("nodes", {"a": 1}),
    "many nodes": put("nodes", [{}] * 30_000),
    "unknown component": put("accessors", 1, "componentType", 1),
    "unknown type": put("accessors", 1, "type", "VEC9"),
    "sparse without rows": put("accessors", 1, "sparse", {"count": 1}),
    "sparse no object": put("accessors", 1, "sparse", [1]),
    "endless sparse": put("accessors", 1, "sparse", {"count": 2**40, "indices": {}, "values": {}}),
    "accessor without data": lambda d: d["accessors"][1].pop("bufferView"),
    "nan in a matrix": put("nodes", 0, "matrix", [float("nan")] * 16),
    "endless scale": put("nodes", 0, "scale", [1e300, 1, 1]),
    "zero rotation": put("nodes", 0, "rotation", [0, 0, 0, 0]),
    "draco": put("extensionsRequired", ["KHR_draco_mesh_compression"]),
    "draco in a mesh": put("meshes", 0, "primitives", 0, "extensions", {"KHR_draco_mesh_compression": {}}),
    "meshopt": put("extensionsRequired", ["EXT_meshopt_compression"]),
    "buffer to be unpacked": lambda d: (d["buffers"].append({"byteLength": 9}), d["bufferViews"][1].update(buffer=1)),
    "ktx2": put("textures", 0, {"extensions": {"KHR_texture_basisu": {"source": 0}}}),
    "texture moved by nothing": put(*_TEXTURE, "extensions", {"KHR_texture_transform": {"scale": "x"}}),
    "texture turned by nan": put(*_TEXTURE, "extensions", {"KHR_texture_transform": {"rotation": float("nan")}}),
    "cut at nothing": put("materials", 0, {"alphaMode": "MASK", "alphaCutoff": []}),
    "short colours": put("meshes", 0, "primitives", 0, "attributes", "COLOR_0", 0),
    "many skins": lambda d: d.update(skins=d["skins"] * 1000),
    "no skins": lambda d: d.pop("skins"),
    "no meshes": lambda d: d.pop("meshes"),
    "endless primitives": lambda d: d["meshes"][0].update(primitives=d["meshes"][0]["primitives"] * 5000),
    "image no image": put("images", 0, "bufferView", 0),
}


@pytest.mark.parametrize("name", CHANGES)
def test_one_line_says_what_is_wrong(tmp_path: Path, name: str) -> None:
    path = edited(SOURCE, tmp_path / "x.glb", CHANGES[name])
    tracemalloc.start()
    with pytest.raises(FileError) as error:
        load_character(str(path))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    message = str(error.value)
    assert message.startswith(str(path))
    assert "\n" not in message
    assert len(message) < 600
    assert peak < 200_000_000


@pytest.mark.parametrize("uri", ["secret.bin", "../secret.bin", "/secret.bin"])
def test_a_file_beside_it_is_not_opened(tmp_path: Path, uri: str, monkeypatch: pytest.MonkeyPatch) -> None:
    _, binary = parts_of(SOURCE.read_bytes())
    (tmp_path / "secret.bin").write_bytes(binary)
    path = edited(SOURCE, tmp_path / "x.glb", put("buffers", 0, "uri", uri))
    opened: list[str] = []
    real = os.open
    monkeypatch.setattr(os, "open", lambda path, *how: (opened.append(Path(path).name), real(path, *how))[1])
    with pytest.raises(FileError, match="outside the file"):
        load_character(str(path))
    assert opened == ["x.glb"]


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "not a binary glTF"),
        (b"glTF", "not a binary glTF"),
        (b"PK\3\4" + bytes(100), "not a binary glTF"),
        (struct.pack("<4sII", b"glTF", 1, 28) + bytes(16), "version 1"),
        (struct.pack("<4sIIII", b"glTF", 2, 2**31, 2**31, 0) + bytes(8), "middle of a chunk"),
        (joined(b"{" * 30_000, b""), "JSON"),
        (joined(b"[" * 200_000, b""), "JSON"),
        (joined(b"[]", b""), "not an object"),
        (joined(b"{}", b""), "no nodes"),
        (joined(b"\xff\xfe", b""), "JSON"),
    ],
)
def test_files_that_are_no_glb(tmp_path: Path, data: bytes, says: str) -> None:
    path = tmp_path / "x.glb"
    path.write_bytes(data)
    with pytest.raises(FileError) as error:
        load_character(str(path))
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_a_file_of_100_megabytes_is_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "large.glb"
    with path.open("wb") as file:
        file.truncate(100_000_000)  # a hole: takes no disk

    @contextmanager
    def unread(*_how: object, **_more: object) -> Iterator[SimpleNamespace]:
        yield SimpleNamespace(read=lambda *_: pytest.fail("was read"))

    monkeypatch.setattr("dancetutor_cli.run.reading.open", unread, raising=False)
    with pytest.raises(FileError, match="100 MB"):
        load_character(str(path))


def test_json_of_endless_objects(tmp_path: Path) -> None:
    path = tmp_path / "x.glb"
    path.write_bytes(joined(b"[" + b"{}," * 8_000_000 + b"{}]", b""))
    with pytest.raises(FileError, match="JSON of 24 MB is too large"):
        load_character(str(path))


def test_a_missing_file_and_a_folder(tmp_path: Path) -> None:
    (tmp_path / "folder.glb").mkdir()
    for name in ("none.glb", "folder.glb"):
        with pytest.raises(FileError, match=r"cannot be read|no such file or folder"):
            load_character(str(tmp_path / name))


def test_a_cut_off_file(tmp_path: Path) -> None:
    data = SOURCE.read_bytes()
    path = tmp_path / "x.glb"
    for size in (15, 21, 1000, len(data) // 2, len(data) - 5):
        path.write_bytes(data[:size])
        with pytest.raises(FileError):
            read_character(path)


def test_a_picture_that_unpacks_to_gigabytes(tmp_path: Path) -> None:
    """A PNG header that claims 60,000 x 60,000 pixels."""
    import base64
    import zlib

    head = struct.pack(">IIBBBBB", 60_000, 60_000, 8, 6, 0, 0, 0)
    chunk = struct.pack(">I", len(head)) + b"IHDR" + head + struct.pack(">I", zlib.crc32(b"IHDR" + head))
    uri = "data:image/png;base64," + base64.b64encode(b"\x89PNG\r\n\x1a\n" + chunk).decode()
    path = edited(SOURCE, tmp_path / "x.glb", put("images", 0, {"uri": uri}))
    with pytest.raises(FileError, match="texture"):
        load_character(str(path))


def test_the_unchanged_file_loads(tmp_path: Path) -> None:
    path = edited(SOURCE, tmp_path / "x.glb", lambda d: json.dumps(d))
    assert load_character(str(path)).skeleton.names[0] == "HumanoidRoot"


def test_normals_whose_squares_no_number_holds() -> None:
    normals = np.array([[3e30, 0, 4e30], [0, 0, 0], [0, 2, 0], [1e-12, 0, 0]], dtype=np.float32)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        unit = unit_normals(normals)
    assert unit.dtype == np.float32
    assert unit == pytest.approx(np.array([[0.6, 0, 0.8], [0, 0, 0], [0, 1, 0], [1e-3, 0, 0]]), abs=1e-6)
