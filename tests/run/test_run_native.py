"""What machine code sees of a call's arrays, what is kept of it, and what happens where it cannot be had."""

from __future__ import annotations

import json
import pickle
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

from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.kernels import compiling, native, stored_code
from dancetutor_cli.run.kernels.native import Kernel, MachineCode

MODULE = """
from dancetutor_cli.run.kernels.native import native_inner

def twice(x):
    return 2 * x

twice = native_inner(twice)

def sums(pair, factor, out):
    whole = 0
    for row in range(pair.cells.shape[0]):
        for column in range(pair.cells.shape[1]):
            out[row] += pair.cells[row, column] * (0.5 if pair.marked[row] else 1.0)
            whole += pair.cells[row, column]
    if factor < 0:
        raise ValueError("below nothing")
    return twice(whole) * factor, len(out)

def first(numbers):
    return numbers[0]

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
    before = dict(native.INNER_KERNELS)
    yield tmp_path / "kept"
    native.INNER_KERNELS.clear()
    native.INNER_KERNELS.update(before)


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the kernels that were compiled."""
    names, compile_it = [], compiling.machine_code

    def machine_code(function: FunctionType, args: tuple[Any, ...], results: int) -> MachineCode:
        names.append(function.__name__)
        return compile_it(function, args, results)

    monkeypatch.setattr(compiling, "machine_code", machine_code)
    return names


def kernel(folder: Path, name: str = "sums", comment: str = "") -> Kernel:
    """A kernel as a new process has it. comment : what its module ends with"""
    module = folder.parent / "some_kernels.py"
    module.write_text(MODULE + comment, "utf-8")
    stored_code.source_digest.cache_clear()
    return Kernel(getattr(loaded(module), name), {"sums": 2, "first": 1}.get(name, 0))


def test_a_kernel_sees_the_arrays_as_they_are(folder: Path, compiled: list[str]) -> None:
    sums, out = kernel(folder), np.zeros(2)
    cells = np.arange(6, dtype=np.int32).reshape(2, 3)
    pair = Pair(cells, np.array([True, False]))
    assert sums(pair, 3, out) == (2 * 15 * 3, 2)
    assert out.tolist() == [1.5, 12.0]
    cells[0, 0] = 10  # the same memory
    assert sums(pair, np.int64(1), out) == (50, 2)
    assert sums(Pair(cells[:1], pair.marked), 1, out) == (26, 2)  # other arrays, another place
    assert compiled == ["sums"]
    every_other = Pair(np.arange(24, dtype=np.int32).reshape(4, 6)[::2, ::2], pair.marked)
    assert sums(every_other, 1, out) == (2 * int(every_other.cells.sum()), 2)  # as Python
    cells.flags.writeable = False
    assert sums(pair, 1, out) == (50, 2)
    narrow = Pair(cells.astype(np.int8), pair.marked)
    assert sums(narrow, 1, out) == (50, 2)
    assert compiled == ["sums"] * 2
    first = kernel(folder, "first")
    assert first(np.array([9, 8])) == 9 and type(first(np.array([9]))) is int


def test_what_is_kept_is_fetched_and_what_is_damaged_compiled_again(folder: Path, compiled: list[str]) -> None:
    values = np.zeros(3)
    kernel(folder, "enter")(values)
    assert values[0] == 7 and compiled == ["enter"]
    (path,) = folder.rglob("*.kernel")
    whole = path.read_bytes()
    assert kernel(folder, "enter")(values) is None and compiled == ["enter"]
    flipped = bytearray(whole)
    flipped[-1] ^= 1
    for n, damaged in enumerate((b"", whole[:50], whole[: len(whole) // 2], whole[:-1], bytes(flipped)), 2):
        path.write_bytes(damaged)
        values[0] = 0
        kernel(folder, "enter")(values)
        assert values[0] == 7 and compiled == ["enter"] * n
        assert kernel(folder, "enter")(values) is None and compiled == ["enter"] * n  # and kept
    assert [one.suffix for one in path.parent.iterdir()] == [".kernel"]


def test_what_was_made_of_other_code_or_for_another_processor_is_not_used(
    folder: Path, compiled: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    values = np.zeros(3)
    kernel(folder, "enter")(values)
    kernel(folder, "enter", "# more")(values)
    assert compiled == ["enter"] * 2
    for name, other in (("processor", ("another", "")), ("_version", "0.1"), ("_settings", {"NUMBA_OPT": "0"})):
        before = stored_code.maker()
        with monkeypatch.context() as changed:
            changed.setattr(stored_code, name, lambda *_, other=other: other)
            stored_code.maker.cache_clear()
            assert stored_code.maker() != before, name
        stored_code.maker.cache_clear()
    monkeypatch.setattr(stored_code, "maker", lambda: bytes(32))
    kernel(folder, "enter", "# more")(values)
    assert compiled == ["enter"] * 3


def test_nothing_is_kept_where_there_is_no_place(
    folder: Path, compiled: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder.write_text("a file")
    monkeypatch.setattr(stored_code, "kernel_folder", lambda: stored_code.KernelFolder(folder))
    values = np.zeros(3)
    kernel(folder, "enter")(values)
    assert values[0] == 7 and compiled == ["enter"]


def test_an_exception_is_reported(folder: Path) -> None:
    pair = Pair(np.ones((1, 1), dtype=np.int32), np.zeros(1, dtype=np.bool_))
    with pytest.raises(DancetutorError, match="the kernel sums raised"):
        kernel(folder)(pair, -1, np.zeros(1))


def test_what_machine_code_does_not_take_runs_as_python(folder: Path, compiled: list[str]) -> None:
    unaligned = np.zeros(17, dtype=np.uint8)[1:].view(np.float64)
    for numbers, found in (
        (unaligned, 0.0), (np.array(["a", "b"]), "a"), (np.arange(3, dtype=">i4")[1:], 1), ([5], 5),
        (np.array([1 << 63], dtype=np.uint64), 1 << 63),
    ):  # fmt: skip
        first = kernel(folder, "first")
        if isinstance(numbers, np.ndarray) and numbers.dtype == np.uint64:
            continue  # a word has a sign, and a kernel says which numbers it gives
        assert first(numbers) == found
    kernel(folder, "first")(np.arange(3))
    assert set(compiled) == {"first"}


class Own(np.ndarray[Any, Any]):
    """A kind of array that machine code does not know."""


def test_no_object_is_taken_for_what_it_is_not(folder: Path, compiled: list[str]) -> None:
    sums, out = kernel(folder), np.zeros(4)
    cells = np.arange(12, dtype=np.int32).reshape(4, 3)
    marked = np.zeros(4, dtype=np.bool_)
    for _ in range(2):  # after each kind of thing each other one
        assert sums(Pair(cells, marked), 1, out) == (132, 4)
        for other in (
            cells.astype(np.int64),
            cells.astype(np.float32).astype(np.int16),
            cells[:, ::-1],
            cells.T[:, :3],
        ):
            assert sums(Pair(other, marked), 1, out) == (2 * int(other.sum()), 4)
        assert sums(Pair(cells[:0], marked), 1, out) == (0, 4)
        assert sums(Pair(cells, marked), np.int8(-0), out) == (0, 4)
        assert sums(Pair(cells, marked), True, out) == (132, 4)
        assert sums(Pair(cells, marked), 1 << 40, out) == (132 << 40, 4)
        assert sums(Pair(cells.view(Own), marked), 1, out) == (132, 4)
        assert sums(Pair(pickle.loads(pickle.dumps(cells)), marked), 1, out) == (132, 4)  # has a dtype of its own
        with pytest.raises(DancetutorError, match="the kernel sums"):
            sums(Pair([1], marked), 1, out)
    assert len(compiled) == 3  # those of each dtype; what has steps between runs as Python
    flat = np.zeros(6, dtype=np.int32)
    with pytest.raises(DancetutorError, match="the kernel sums"):
        kernel(folder)(Pair(flat, marked), 1, out)  # has one dimension: no kernel can be made of that
    with pytest.raises(DancetutorError, match="the kernel sums"):
        kernel(folder)(Pair(cells, marked), 1)


def test_a_number_keeps_its_place_while_an_array_grows(folder: Path) -> None:
    enter, values = kernel(folder, "enter"), np.zeros(3)
    enter(values)
    values.resize(1 << 20, refcheck=False)
    values[:] = 0
    enter(values)
    assert values[0] == 7


def fails(*args: object) -> Any:
    """What LLVM or numba may do on another system."""
    raise RuntimeError("no such processor")


def lacking(function: FunctionType, args: tuple[Any, ...], results: int) -> MachineCode:
    """Machine code that calls what no process has."""
    return MachineCode("entry", ["no_such_function"], b"\x7fELF")


@pytest.mark.parametrize(
    ("module", "name", "instead"),
    [
        (compiling, "machine_code", fails),
        (compiling, "machine_code", lacking),
        (compiling, "njit", fails),
        (native, "_load", fails),
    ],
)
def test_where_there_can_be_no_machine_code_the_kernel_runs_all_the_same(
    folder: Path, monkeypatch: pytest.MonkeyPatch, module: Any, name: str, instead: Any
) -> None:
    monkeypatch.setattr(module, name, instead)
    sums, out = kernel(folder), np.zeros(2)
    pair = Pair(np.arange(6, dtype=np.int32).reshape(2, 3), np.array([True, False]))
    assert sums(pair, 3, out) == (2 * 15 * 3, 2)
    assert out.tolist() == [1.5, 12.0]
    assert sums(pair._replace(cells=pair.cells.astype(np.int8)), np.int64(1), out) == (30, 2)
    assert not list(folder.rglob("*.kernel"))
    with pytest.raises(DancetutorError, match="the kernel sums raised"):
        sums(pair, -1, out)


def test_what_is_kept_but_cannot_be_loaded_is_made_again(folder: Path, compiled: list[str]) -> None:
    values = np.zeros(3)
    kernel(folder, "enter")(values)
    (path,) = folder.rglob("*.kernel")
    kept = kernel(folder, "enter")._stored_code
    (name,) = ["<f81"]
    for n, (needs, data) in enumerate(((["no_such_function"], b"\x7fELF"), ([], b"no machine code")), 2):
        kept.write(name, json.dumps(["entry", needs]).encode() + b"\n" + data)
        assert list(folder.rglob("*.kernel")) == [path]
        for _ in range(2):  # and kept
            values[0] = 0
            kernel(folder, "enter")(values)
            assert values[0] == 7 and compiled == ["enter"] * n


def test_threads_do_not_disturb_each_other(folder: Path) -> None:
    sums = kernel(folder)
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

    assert [stored_code._version(name) for name in stored_code.COMPILERS] == [
        version(name) for name in stored_code.COMPILERS
    ]
