"""What kernels behind doors are called with, as machine code sees it: whole numbers, numpy arrays, tuples of those.

Machine code takes addresses and shapes out of Python's and numpy's own objects, as numba does: to write them down by
Python takes longer than to solve a short chart. Before it believes an object it looks whether type, dimensions, order
in memory and numbers are those that it was made for.
"""

from __future__ import annotations

import ctypes
import sys
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

HEAD: int = object.__basicsize__  # bytes before what an object holds
TYPE = HEAD - 8  # where its type stands
LENGTH = HEAD  # of a tuple
ITEMS: int = tuple.__basicsize__
# of an array, as numpy promises extensions, and of the kind of its numbers
DATA, DIMENSIONS, SHAPE, STRIDES, NUMBERS, FLAGS = (HEAD + 8 * n for n in (0, 1, 2, 3, 5, 6))
KIND = HEAD + 8
KIND_MASK = ~(0xFF << 24 if sys.byteorder == "little" else 0xFF << 32) & (1 << 63) - 1  # without flags
IN_A_ROW, ALIGNED = 0x1, 0x100  # flags
COMMON = 3  # words of a table before those of the arguments: how numbers are read, types of arrays and numbers
_WORD: Any = ctypes.c_int64


def kinds_of(argument: Any) -> str:
    """What kind of thing an argument is: things of one kind have one machine code. TypeError if there is none."""
    if isinstance(argument, np.ndarray):
        if argument.dtype.kind not in "biuf" or not argument.flags.aligned:
            raise TypeError(f"a kernel behind a door takes no arrays of {argument.dtype} that lie as this one")
        return f"{argument.dtype.str}{argument.ndim}{'' if argument.flags.c_contiguous else 'A'} "
    if isinstance(argument, tuple):
        names = ",".join(getattr(argument, "_fields", ()))
        return f"{type(argument).__name__}[{names}]({''.join(map(kinds_of, argument))})"
    if isinstance(argument, int | np.integer) and -(1 << 63) <= argument < 1 << 63:
        return "i "
    raise TypeError(f"a kernel behind a door takes no {type(argument).__name__}")


def plain(argument: Any) -> Any:
    """The same as the types that machine code looks for: no subclass, no dtype that only equals numpy's own."""
    if isinstance(argument, np.ndarray):
        return np.asarray(argument).view(np.dtype(argument.dtype.str))
    if isinstance(argument, tuple):
        return remade(argument, map(plain, argument))
    return int(argument)


def remade(of: tuple[Any, ...], items: Any) -> Any:
    """Another tuple of a type, named or not."""
    return type(of)(*items) if hasattr(of, "_fields") else tuple(items)


def table_of(arguments: tuple[Any, ...]) -> tuple[Any, list[Any]]:
    """Words that machine code compares the objects of a call with, and what must live as long as they."""
    words = [
        ctypes.cast(ctypes.pythonapi.PyLong_AsLongLongAndOverflow, ctypes.c_void_p).value,
        id(np.ndarray),
        id(int),
    ]
    kept: list[Any] = []
    _add_words(arguments, words, kept)
    return (_WORD * len(words))(*words), kept


def _add_words(argument: Any, words: list[Any], kept: list[Any]) -> None:
    if isinstance(argument, np.ndarray):
        words.append(_at(id(argument.dtype) + KIND) & KIND_MASK)
    elif isinstance(argument, tuple):
        words.append(id(type(argument)))
        kept.append(type(argument))
        for one in argument:
            _add_words(one, words, kept)


@cache
def is_known() -> bool:
    """Whether objects of this Python and numpy hold what machine code reads, where it reads it: a look at some."""
    if sys.implementation.name != "cpython" or ctypes.sizeof(ctypes.c_void_p) != 8:
        return False
    if np.ndarray.__basicsize__ < FLAGS + 4:
        return False
    every_other: NDArray[np.int16] = np.zeros((4, 6), dtype=np.int16)[::2, ::3]
    arrays: tuple[NDArray[Any], ...] = (every_other, np.zeros((2, 3)), np.zeros(1, dtype=np.bool_))
    return all(map(_is_known_array, arrays)) and _is_known_tuple()


def _is_known_array(array: NDArray[Any]) -> bool:
    """What is a number is compared first: only then the others are taken for addresses."""
    at, n = id(array), array.ndim
    words = {DATA: array.__array_interface__["data"][0], NUMBERS: id(array.dtype), TYPE: id(np.ndarray)}
    numbers = {DIMENSIONS: n, FLAGS: array.flags.num}
    if any(_at(at + place) != word for place, word in words.items()):
        return False
    if any(ctypes.c_int32.from_address(at + place).value != number for place, number in numbers.items()):
        return False
    shape, strides = ((_WORD * n).from_address(_at(at + place)) for place in (SHAPE, STRIDES))
    kind = ctypes.string_at(id(array.dtype) + KIND, 8)
    dtype = array.dtype
    number = int.from_bytes(kind[4:], sys.byteorder)
    return (
        (*shape, *strides) == (*array.shape, *array.strides)
        and kind[:2].decode("latin-1") == dtype.kind + dtype.char
        and kind[2:3].decode("latin-1") == dtype.byteorder
        and number == dtype.num
    )


def _is_known_tuple() -> bool:
    pair = (every := np.zeros(1), (every,))
    return [_at(id(pair) + place) for place in (TYPE, LENGTH, ITEMS, ITEMS + 8)] == [id(tuple), 2, *map(id, pair)]


def _at(address: int) -> int:
    word: int = _WORD.from_address(address).value
    return word
