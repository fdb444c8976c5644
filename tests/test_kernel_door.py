"""What a kernel behind a door is told of a call's arrays, and what is kept of it."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from threading import Thread
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np
import pytest
from module_file import loaded
from numpy.typing import NDArray

from dancetutor_cli import kernel_door, kernel_folder, kernel_making, kernel_target
from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.kernel_door import Door, told_of

MODULE = """
from dancetutor_cli.kernel_door import inner

def twice(x):
    return 2 * x

twice = inner(twice)

def sums(pair, factor, out):
    whole = 0
    for row in range(pair.cells.shape[0]):
        for column in range(pair.cells.shape[1]):
            out[row] += pair.cells[row, column] * (0.5 if pair.marked[row] else 1.0)
            whole += pair.cells[row, column]
    if factor < 0:
        raise ValueError("below nothing")
    return twice(whole) * factor, len(out)

def enter(out):
    out[0] = 7
"""


class Pair(NamedTuple):
    """Two arrays."""

    cells: NDArray[Any]
    marked: NDArray[np.bool_]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Where these kernels are kept."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kept"))
    (tmp_path / "some_kernels.py").write_text(MODULE, "utf-8")
    before = dict(kernel_door.INNER)
    yield tmp_path / "kept"
    kernel_door.INNER.clear()
    kernel_door.INNER.update(before)


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the kernels that were compiled."""
    names, compile_it = [], kernel_making.machine_code

    def machine_code(function: FunctionType, args: tuple[Any, ...]) -> kernel_door.Code:
        names.append(function.__name__)
        return compile_it(function, args)

    monkeypatch.setattr(kernel_making, "machine_code", machine_code)
    return names


def door(folder: Path, name: str = "sums", stamp: str = "ab" * 32) -> Door:
    """A door as a new process has it."""
    return Door(getattr(loaded(folder.parent / "some_kernels.py"), name), (0,), lambda: stamp)


def test_a_kernel_sees_the_arrays_as_they_are(folder: Path, compiled: list[str]) -> None:
    sums, out = door(folder), np.zeros(2)
    cells = np.arange(6, dtype=np.int32).reshape(2, 3)
    pair = Pair(cells, np.array([True, False]))
    assert sums(pair, 3, out) == (2 * 15 * 3, 2)
    assert out.tolist() == [1.5, 12.0]
    cells[0, 0] = 10  # the same memory
    assert sums(pair, np.int64(1), out) == (50, 2)
    assert sums(Pair(cells[:1], pair.marked), 1, out) == (26, 2)  # other arrays, another place
    assert compiled == ["sums"]
    every_other = Pair(np.arange(24, dtype=np.int32).reshape(4, 6)[::2, ::2], pair.marked)
    assert sums(every_other, 1, out) == (2 * int(every_other.cells.sum()), 2)
    narrow = Pair(cells.astype(np.int8), pair.marked)
    assert sums(narrow, 1, out) == (50, 2)
    assert compiled == ["sums"] * 3


def test_what_is_kept_is_fetched_and_what_is_damaged_compiled_again(folder: Path, compiled: list[str]) -> None:
    values = np.zeros(3)
    door(folder, "enter")(values)
    assert values[0] == 7 and compiled == ["enter"]
    (path,) = folder.rglob("*.door")
    whole = path.read_bytes()
    assert door(folder, "enter")(values) is None and compiled == ["enter"]
    flipped = bytearray(whole)
    flipped[-1] ^= 1
    for n, damaged in enumerate((b"", whole[:50], whole[: len(whole) // 2], whole[:-1], bytes(flipped)), 2):
        path.write_bytes(damaged)
        values[0] = 0
        door(folder, "enter")(values)
        assert values[0] == 7 and compiled == ["enter"] * n
        assert door(folder, "enter")(values) is None and compiled == ["enter"] * n  # and kept
    assert [one.suffix for one in path.parent.iterdir()] == [".door"]


def test_what_was_made_of_other_code_or_for_another_processor_is_not_used(
    folder: Path, compiled: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    values = np.zeros(3)
    door(folder, "enter")(values)
    door(folder, "enter", "cd" * 32)(values)
    assert compiled == ["enter"] * 2
    monkeypatch.setattr(kernel_door, "target", lambda: "another")
    door(folder, "enter", "cd" * 32)(values)
    assert compiled == ["enter"] * 3
    monkeypatch.setattr(kernel_folder, "maker", lambda: bytes(32))
    door(folder, "enter", "cd" * 32)(values)
    assert compiled == ["enter"] * 4


def test_nothing_is_kept_where_there_is_no_place(
    folder: Path, compiled: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder.write_text("a file")
    monkeypatch.setattr(kernel_door, "kernel_folder", lambda: kernel_folder.KernelFolder(folder))
    values = np.zeros(3)
    door(folder, "enter")(values)
    assert values[0] == 7 and compiled == ["enter"]


def test_an_exception_is_told_of(folder: Path) -> None:
    pair = Pair(np.ones((1, 1), dtype=np.int32), np.zeros(1, dtype=np.bool_))
    with pytest.raises(DancetutorError, match="the kernel sums raised"):
        door(folder)(pair, -1, np.zeros(1))


def test_what_a_kernel_does_not_take_is_refused() -> None:
    with pytest.raises(TypeError, match="takes no float"):
        told_of(0.5)


def test_threads_do_not_disturb_each_other(folder: Path) -> None:
    sums = door(folder)
    sums(Pair(np.ones((1, 1), dtype=np.int32), np.zeros(1, dtype=np.bool_)), 1, np.zeros(1))
    found: dict[int, set[int]] = {}

    def work(size: int) -> None:
        pair = Pair(np.ones((size, 2), dtype=np.int32), np.zeros(size, dtype=np.bool_))
        found[size] = {sums(pair, 1, np.zeros(size))[0] for _ in range(300)}

    switch = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    threads = [Thread(target=work, args=(size,)) for size in (1, 2, 3, 4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    sys.setswitchinterval(switch)
    assert found == {size: {4 * size} for size in (1, 2, 3, 4)}


def test_versions_are_read_off_the_names_of_folders() -> None:
    from importlib.metadata import version

    assert [kernel_target._version(name) for name in kernel_target.COMPILERS] == [
        version(name) for name in kernel_target.COMPILERS
    ]
