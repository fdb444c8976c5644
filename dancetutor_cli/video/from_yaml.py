"""Reading a YAML mapping into a frozen dataclass: every key is checked, and an error names the keys that exist."""

from __future__ import annotations

import re
import types
import typing
from dataclasses import MISSING, fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from dancetutor_cli.errors import FileError
from dancetutor_cli.marked_yaml import read

T = TypeVar("T")
RGB = tuple[int, int, int]
Box = tuple[float, float, float, float]


def load(path: Path, kind: type[T]) -> T:
    """Read `path` as the dataclass `kind`. FileError says which key is wrong, and what it should be."""
    return _build(path, "", read(path).data, kind)


def _build(path: Path, where: str, data: Any, kind: type[T]) -> T:
    if not isinstance(data, dict):
        raise FileError(path, f"{where or 'the file'} must be a mapping of names to values")
    assert is_dataclass(kind)
    known = {f.name: f for f in fields(kind)}
    prefix = f"{where}." if where else ""
    for key in data:
        if key not in known:
            raise FileError(path, f"unknown key '{prefix}{key}'; there are: {', '.join(known)}")
    hints = typing.get_type_hints(kind)
    values = {}
    for name, field in known.items():
        if name in data:
            values[name] = _value(path, prefix + name, data[name], hints[name])
        elif field.default is MISSING and field.default_factory is MISSING:
            raise FileError(path, f"key '{prefix}{name}' is missing")
    return kind(**values)


def _value(path: Path, where: str, data: Any, hint: Any) -> Any:
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if origin in (types.UnionType, typing.Union):
        return None if data is None else _value(path, where, data, next(h for h in inner if h is not type(None)))
    if hint == RGB:
        return parse_colour(path, where, data)
    if origin is dict:
        return {k: _value(path, f"{where}.{k}", v, inner[1]) for k, v in _expect(path, where, data, dict).items()}
    if origin is tuple:
        items = _expect(path, where, data, list)
        count = len(inner)
        if inner[-1] is Ellipsis:
            return tuple(_value(path, where, item, inner[0]) for item in items)
        if len(items) != count:
            raise FileError(path, f"{where} must be a list of {count} values")
        return tuple(_value(path, where, item, i) for item, i in zip(items, inner, strict=True))
    if origin is typing.Literal:
        if data not in inner:
            raise FileError(path, f"{where}: {data!r} is unknown; there are: {', '.join(map(str, inner))}")
        return data
    if is_dataclass(hint):
        return _build(path, where, data, typing.cast(type, hint))
    if hint is float:
        return float(_expect(path, where, data, (int, float)))
    return _expect(path, where, data, hint)


@cache
def _noun(kind: Any) -> str:
    kinds = kind if isinstance(kind, tuple) else (kind,)
    names = {int: "a whole number", float: "a number", str: "text", bool: "true or false", list: "a list"}
    return names.get(kinds[-1], "a mapping")


def _expect(path: Path, where: str, data: Any, kind: Any) -> Any:
    if not isinstance(data, kind) or (isinstance(data, bool) and kind is not bool):
        raise FileError(path, f"{where}: {data!r} must be {_noun(kind)}")
    return data


def parse_colour(path: Path, where: str, value: Any) -> RGB:
    """ "#rrggbb" to three numbers 0..255."""
    if not isinstance(value, str) or not re.fullmatch(r"#[0-9a-fA-F]{6}", value):
        raise FileError(path, f'{where}: {value!r} is not a colour; write it as "#rrggbb"')
    return int(value[1:3], 16), int(value[3:5], 16), int(value[5:7], 16)
