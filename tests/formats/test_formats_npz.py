"""A stranger's .npz: what does not fit is one line with exit status 2, and is not unpacked."""

from __future__ import annotations

import io
import os
import re
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from physics_phrase import phrase

from dancetutor_cli.commands.retarget import command
from dancetutor_cli.formats.npz import FIELDS, read_npz, write_npz
from dancetutor_cli.run.errors import FileError

Arrays = dict[str, np.ndarray[Any, Any]]


@pytest.fixture(scope="module")
def arrays(tmp_path_factory: pytest.TempPathFactory) -> Arrays:
    """Those of a good file."""
    path = tmp_path_factory.mktemp("npz") / "good.npz"
    write_npz(path, phrase(0.5))
    with np.load(path) as data:
        return dict(data)


def entry(header: dict[str, object], data: bytes = b"", version: bytes = b"\x01\x00") -> bytes:
    """A .npy with any header."""
    text = repr(header).encode()
    text += b" " * (64 - (len(text) + 11) % 64) + b"\n"
    return b"\x93NUMPY" + version + len(text).to_bytes(2, "little") + text + data


def spoilt(path: Path, arrays: Arrays, entries: dict[str, bytes]) -> Path:
    """The good file with some entries in place of others; zeros pack a thousand times smaller."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            out = io.BytesIO()
            if name not in entries:
                np.lib.format.write_array(out, array)
            archive.writestr(f"{name}.npy", entries.get(name, out.getvalue()))
    return path


def declared(shape: tuple[int, ...], descr: object = "<f8", data: bytes = b"") -> bytes:
    return entry({"descr": descr, "fortran_order": False, "shape": shape}, data)


SHAPES: dict[str, tuple[str, Callable[[Arrays], Any], str]] = {
    "fps of nine": ("fps", lambda a: np.full((3, 3), 60.0), r"'fps' has the shape \(3, 3\); it must be one number"),
    "fps of none": ("fps", lambda a: np.array(0.0), "'fps' holds values that are not from 0.01 to 1000"),
    "fps in words": ("fps", lambda a: np.array("sixty"), "'fps' holds <U5; it must hold float32, float64"),
    "fps imaginary": ("fps", lambda a: np.array(1j), "'fps' holds complex128"),
    "half precision": ("rotations", lambda a: a["rotations"].astype("f2"), "'rotations' holds float16; it must hold"),
    "a short root": ("root", lambda a: a["root"][:-3], r"'root' has the shape \(28, 3\); it must be \(31, 3\)"),
    "a flat root": ("root", lambda a: a["root"].ravel(), r"'root' has the shape \(93\)"),
    "too few joints": ("rotations", lambda a: a["rotations"][:, :-1], "'rotations' has the shape"),
    "no turns": ("rotations", lambda a: np.zeros_like(a["rotations"]), "must hold unit quaternions"),
    "no numbers": ("offsets", lambda a: a["offsets"] * np.nan, "its offsets hold values that are not numbers"),
    "far away": ("root", lambda a: a["root"] + 1e300, "'root' holds values that are not from"),
    "time stands": ("times", lambda a: a["times"] * 0.0, "'times' must grow"),
    "no frames": ("times", lambda a: a["times"][:0], "'rotations' has the shape"),
    "a child first": ("parents", lambda a: a["parents"][::-1].copy(), "'parents' must have -1 for the first joint"),
    "a circle": ("parents", lambda a: np.arange(len(a["parents"])), "'parents' must have -1 for the first joint"),
    "fractions": ("parents", lambda a: a["parents"] + 0.5, "'parents' holds float64; it must hold whole numbers"),
    "one name": ("names", lambda a: np.full(len(a["names"]), "hip"), "'names' must name each joint"),
    "a long name": ("names", lambda a: np.full(len(a["names"]), "x" * 100), "'names' holds <U100; it must hold"),
    "a third hand": ("grip_side", lambda a: np.array([2]), "'grip_side' holds values that are not from 0 to 1"),
    "a panel short": ("contact_panel", lambda a: a["contact_panel"][:, :1], "'contact_panel' has the shape"),
    "two schemas": ("schema", lambda a: np.array([1, 1]), "'schema' has the shape"),
    "ground of three": ("ground", lambda a: np.zeros(3), r"'ground' has the shape \(3\); it must be \(5\)"),
    "a bar of words": ("bar", lambda a: np.array(["a", "b", "c"]), "'bar' holds <U1"),
    "half a grip": ("grip_end", lambda a: np.zeros((2, 2)), r"'grip_end' has the shape \(2, 2\)"),
    "why at all": ("let_go_why", lambda a: np.array([7]), "'let_go_why' holds values that are not from 0 to 2"),
}  # fmt: skip


@pytest.mark.parametrize("case", SHAPES)
def test_what_does_not_fit_is_one_line(case: str, arrays: Arrays, tmp_path: Path) -> None:
    name, change, said = SHAPES[case]
    path = tmp_path / "a.npz"
    np.savez(path, **{**arrays, name: change(arrays)})
    with pytest.raises(FileError, match=said) as caught:
        read_npz(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("case", ["fps of nine", "half precision", "a short root"])
def test_retarget_ends_with_2_and_one_line(case: str, arrays: Arrays, tmp_path: Path) -> None:
    name, change, said = SHAPES[case]
    np.savez(tmp_path / "a.npz", **{**arrays, name: change(arrays)})
    result = CliRunner().invoke(command, [str(tmp_path / "a.npz"), "-o", str(tmp_path / "b.glb")])
    assert isinstance(result.exception, FileError) and result.exception.exit_status == 2
    assert re.search(said, str(result.exception)) and not (tmp_path / "b.glb").exists()


GIGABYTE = 10**9
ENTRIES = {
    "declared gigabytes": ({"root": declared((GIGABYTE, 3))}, "'root' has the shape"),
    "gigabytes of frames": (
        {
            "times": declared((GIGABYTE,)),
            "rotations": declared((GIGABYTE, 55, 4)),
            "root": declared((GIGABYTE, 3)),
        },
        "declares arrays of|it must be",
    ),
    "gigabytes of contacts": (
        {
            f"contact_{name}": declared((GIGABYTE, 2) if name == "panel" else (GIGABYTE,), kind)
            for name, kind in {
                "start": "<f8", "end": "<f8", "limb": "|i1", "column": "<i4",
                "kind": "|i1", "part": "|i1", "row": "<i4", "panel": "<f8",
            }.items()
        },
        "declares arrays of .* MB; at most 256 are read",
    ),
    "more than any size": ({"bar_spans": declared((10**30, 2))}, "declares arrays of"),
    "less than it declares": ({"fps": declared((), data=b"123")}, "'fps' is not as long as its shape"),
    "more than it declares": ({"fps": declared((), data=b"0" * 9)}, "'fps' is not as long as its shape"),
    "objects": ({"fps": declared((), "|O", b"cos\nsystem\n.")}, "'fps' holds Python objects, which are never unpacked"),
    "records": ({"fps": declared((), [("a", "<f8")], b"12345678")}, "'fps' holds "),
    "a negative size": ({"times": declared((-1,))}, "not an .npz file|not as long|has the shape"),
    "no header": ({"fps": b"\x93NUMPY\x01\x00\x10\x00{"}, "not an .npz file of a motion, or a broken one"),
    "a header of depth": ({"fps": entry({}, version=b"\x01\x00").replace(b"{}", b"((")}, "not an .npz file"),
    "another version": ({"fps": entry({"descr": "<f8"}, version=b"\x02\x00")}, "'fps' has no plain type"),
    "not numpy's": ({"fps": b"hello"}, "not an .npz file of a motion, or a broken one"),
    "empty": ({"fps": b""}, "not an .npz file of a motion, or a broken one"),
}  # fmt: skip


@pytest.mark.parametrize("case", ENTRIES)
def test_declared_sizes_are_not_believed(case: str, arrays: Arrays, tmp_path: Path) -> None:
    entries, said = ENTRIES[case]
    full = {**arrays, "bar_spans": np.zeros((0, 2))} if "bar_spans" in entries else arrays
    path = spoilt(tmp_path / "a.npz", full, entries)
    tracemalloc.start()
    try:
        with pytest.raises(FileError, match=said):
            read_npz(path)
        assert tracemalloc.get_traced_memory()[1] < 20e6
    finally:
        tracemalloc.stop()


def test_a_bomb_is_not_unpacked(arrays: Arrays, tmp_path: Path) -> None:
    """100 MB of zeros in 0.1 MB: as the numbers of an array, as a header without end, as an array nobody asks for."""
    zeros = bytes(100_000_000)
    for name, data, fine in (("root", declared((4_166_666, 3), data=zeros), False), ("more", zeros, True)):
        path = tmp_path / f"{name}.npz"
        spoilt(path, arrays if name in arrays else {**arrays, name: np.zeros(1)}, {name: data})
        assert path.stat().st_size < 1e6
        tracemalloc.start()
        try:
            if fine:
                assert len(read_npz(path).times) == 31
            else:
                with pytest.raises(FileError, match="'root' has the shape"):
                    read_npz(path)
            assert tracemalloc.get_traced_memory()[1] < 20e6
        finally:
            tracemalloc.stop()


def test_odd_zips(arrays: Arrays, tmp_path: Path) -> None:
    twice, many, packed, flipped = (tmp_path / f"{name}.npz" for name in ("twice", "many", "packed", "flipped"))
    spoilt(twice, arrays, {})
    with pytest.warns(UserWarning, match="Duplicate"), zipfile.ZipFile(twice, "a") as archive:
        archive.writestr("fps.npy", b"")
    with zipfile.ZipFile(many, "w") as archive:
        for number in range(1001):
            archive.writestr(f"{number}.npy", b"")
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr("schema.npy", b"x")
    data = bytearray(spoilt(flipped, arrays, {}).read_bytes())
    data[len(data) // 2] ^= 255
    flipped.write_bytes(data)
    for path, said in (
        (twice, "'fps' twice"),
        (many, "more than 1000"),
        (packed, "packed in a way"),
        (flipped, "broken|not"),
    ):
        with pytest.raises(FileError, match=said):
            read_npz(path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_a_pipe_does_not_hang(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.npz")
    with pytest.raises(FileError, match="named pipe"):
        read_npz(tmp_path / "a.npz")


def test_other_good_files_are_read(arrays: Arrays, tmp_path: Path) -> None:
    """Single precision, other whole numbers, columns first, arrays of others: as float64 and int32."""
    path = tmp_path / "a.npz"
    other = {
        name: array.astype("f4") if array.dtype == "f8" else array.astype("i8") if array.dtype.kind == "i" else array
        for name, array in arrays.items()
    }
    other["rotations"] = np.asfortranarray(other["rotations"])
    np.savez_compressed(path, **other, fps_of_others=np.zeros((3, 3)), words=np.array(["ä"]))
    motion = read_npz(path)
    assert motion.rotations.dtype == motion.root.dtype == np.float64 and motion.skeleton.parents.dtype == np.int32
    np.testing.assert_allclose(motion.rotations, arrays["rotations"], atol=1e-6)


def test_the_table_has_all_that_is_written(arrays: Arrays) -> None:
    assert set(arrays) <= set(FIELDS)
