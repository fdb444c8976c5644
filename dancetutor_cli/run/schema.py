"""The schema of all YAML files: the type hints of a dataclass define the allowed content. YAML is not imported here."""

from __future__ import annotations

import re
import types
import typing
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import cache
from math import inf
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, TypeVar, Union, get_args, get_origin

from dancetutor_cli.run.errors import FileError, choose_text
from dancetutor_cli.run.reading import shown_key

T = TypeVar("T")
Keys = tuple[str | int, ...]  # a key path: names in mappings, numbers in lists


# Marks of types in `Annotated[...]`. They are plain classes, because each dataclass takes 0.5 ms at start-up.


class Bounds:
    """The bounds of a number. unit : unit in messages; above : whether `least` itself is excluded"""

    def __init__(self, least: float = -inf, most: float = inf, unit: str = "", *, above: bool = False) -> None:
        self.least, self.most, self.unit, self.above = least, most, unit, above


class Entries:
    """The allowed number of entries of a list or a mapping."""

    def __init__(self, least: int, most: float = inf) -> None:
        self.least, self.most = least, most


class Names:
    """The allowed texts of a value, or of the keys of a mapping."""

    def __init__(self, names: tuple[str, ...]) -> None:
        self.names = names


class Meaning:
    """A description of the value for messages, if its type is not enough."""

    def __init__(self, what: str) -> None:
        self.what = what


class Parsed(Meaning):
    """The conversion of a value before its type is checked.

    parse : the function; its ValueError may have a message with more detail than `what`
    what : description of the value for messages; empty: the description of the type
    """

    def __init__(self, parse: Callable[[Any], Any], what: str = "") -> None:
        super().__init__(what)
        self.parse = parse


class _NotInFiles:
    """The mark of a field that the program sets: it has a default, and files cannot have it."""


NOT_IN_FILES = _NotInFiles()


# Types that several files use.


def _text(value: Any) -> str:
    if isinstance(value, dict | list) or value is None:
        raise ValueError
    return str(value)


def _as_list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


def _three(value: Any) -> Any:
    if isinstance(value, list) and len(value) != 3:
        raise ValueError
    return value if isinstance(value, list) else [value] * 3


def _colour(value: Any) -> tuple[int, int, int]:
    if not isinstance(value, str) or not re.fullmatch(r"#[0-9a-fA-F]{6}", value):
        raise ValueError
    return int(value[1:3], 16), int(value[3:5], 16), int(value[5:7], 16)


def _hex_colour(value: Any) -> Any:
    _colour(value)
    return value


def _box(value: Any) -> Any:
    if not isinstance(value, list) or len(value) != 4 or not all(isinstance(side, int | float) for side in value):
        raise ValueError
    if not (0 <= value[0] < value[2] <= 1 and 0 <= value[1] < value[3] <= 1):
        raise ValueError
    return value


_COLOUR = 'a colour, written as "#rrggbb"'
Text = Annotated[str, Parsed(_text, "text")]  # a name that YAML may parse as a number
SEVERAL = Parsed(_as_list, "one value or a list of them")  # beside a list
Texts = Annotated[tuple[Text, ...], SEVERAL]
THREE = Parsed(_three, "one number or three")  # beside a list of three: for the axes, or one for all of them
RGB = Annotated[tuple[int, int, int], Parsed(_colour, _COLOUR)]  # 0..255
HexColour = Annotated[str, Parsed(_hex_colour, _COLOUR)]
Box = Annotated[
    tuple[float, float, float, float], Parsed(_box, "left, top, right, bottom: shares 0 to 1 in rising order")
]
Share = Annotated[float, Bounds(0, 1)]
NotNegative = Annotated[float, Bounds(0)]
Positive = Annotated[float, Bounds(0, above=True)]


@dataclass(frozen=True, slots=True)
class MarkedYaml:
    """The content of a YAML file.

    path : the file; data : its top mapping
    lines : 1-based line of every key, by its key path, e.g. ("weights", "spin"); items of lists by their number
    """

    path: Path
    data: dict[str, Any]
    lines: Mapping[Keys, int]

    def error(self, keys: Keys, message: str) -> FileError:
        """Return an error at a key, or at the nearest key above it that has a line."""
        while keys and keys not in self.lines:
            keys = keys[:-1]
        return FileError(self.path, message, self.lines.get(keys))

    def check_names(self, keys: Keys, names: Iterable[Any], known: Collection[str]) -> None:
        """Raise FileError, with the known names, unless all names in the mapping at `keys` are known."""
        for name in names:
            if name not in known:
                where = f" in '{_path(keys)}'" if keys else ""
                message = f"unknown key '{shown_key(name)}'{where}{choose_text(str(name), known)}"
                raise self.error((*keys, str(name)), message)


def convert(source: MarkedYaml, kind: type[T], keys: Keys = (), base: T | None = None) -> T:
    """Convert the value at a key path to a dataclass or another type. Raises FileError with the line of a wrong value.

    kind : a type whose fields are the allowed keys (`HYPHENS = True`: with "-" in place of "_"). Its hints define the
    values: numbers, text, `bool`, `Literal`, `tuple` for lists, `dict`, dataclasses, `X | None`, all of them with marks
    in `Annotated`. A key without a default must be there
    base : the values of keys that the file leaves out; mappings are merged with those of `base`
    """
    data: Any = source.data
    for key in keys:
        data = data[key]
    return typing.cast(T, _value(source, keys, data, kind, base))


def check_value(source: MarkedYaml, keys: Keys, data: Any, hint: Any) -> None:
    """Raise FileError unless a value fits a hint that is known only while the file is read."""
    _value(source, keys, data, hint)


def _value(source: MarkedYaml, keys: Keys, data: Any, hint: Any, base: Any = None) -> Any:
    kind, marks = _marks(hint)
    for mark in marks:
        if isinstance(mark, Parsed):
            try:
                data = mark.parse(data)
            except ValueError as error:
                raise _wrong(source, keys, data, hint, str(error)) from None
    origin, inner = get_origin(kind), get_args(kind)
    if kind is Any or (data is None and types.NoneType in inner):
        return data
    if origin in (types.UnionType, Union):
        return _value(source, keys, data, _first(inner), base)
    is_mapping = origin is dict or is_dataclass(kind)
    if is_mapping or origin is tuple:
        length = next((mark for mark in marks if isinstance(mark, Entries)), Entries(0))
        if not isinstance(data, dict if is_mapping else list | tuple) or not length.least <= len(data) <= length.most:
            raise _wrong(source, keys, data, hint)
        if is_dataclass(kind):
            return _build(source, keys, data, kind, base)
        return _mapping(source, keys, data, inner, base) if is_mapping else _list(source, keys, data, hint)
    names = _names_of(kind, marks)
    if names and (not isinstance(data, str) or data not in names):
        there = choose_text(data if isinstance(data, str) else "", names)
        raise _wrong(source, keys, data, hint, f"there is no {_shown(data)}{there}")
    if not names and not _fits(data, kind, _bounds(marks)):
        raise _wrong(source, keys, data, hint)
    return float(data) if kind is float else data


def _marks(hint: Any) -> tuple[Any, tuple[Any, ...]]:
    """Return a type and its marks."""
    if get_origin(hint) is not Annotated:
        return hint, ()
    kind, *marks = get_args(hint)
    return kind, tuple(marks)


def _first(inner: tuple[Any, ...]) -> Any:
    """Return the type X of `X | None`."""
    return next(one for one in inner if one is not types.NoneType)


def _bounds(marks: tuple[Any, ...]) -> Bounds:
    return next((mark for mark in marks if isinstance(mark, Bounds)), Bounds())


def _names(hint: Any) -> tuple[str, ...]:
    """Return the names that a hint allows; empty: any."""
    return _names_of(*_marks(hint))


def _names_of(kind: Any, marks: tuple[Any, ...]) -> tuple[str, ...]:
    if get_origin(kind) is Literal:
        return get_args(kind)
    return next((mark.names for mark in marks if isinstance(mark, Names)), ())


def _fits(data: Any, kind: Any, bounds: Bounds) -> bool:
    if isinstance(data, bool) or kind not in (int, float):
        return isinstance(data, kind) and isinstance(data, bool) == (kind is bool)
    is_number = isinstance(data, int) or (kind is float and isinstance(data, float))
    return is_number and bounds.least <= data <= bounds.most and not (bounds.above and data == bounds.least)


class _Key(NamedTuple):
    """A key of a dataclass.

    field : name of the field; is_needed : whether it has no default; may_be_empty : whether "key:" without a value is
    allowed
    """

    field: str
    hint: Any
    is_needed: bool
    may_be_empty: bool


@cache
def _keys_of(kind: Any) -> dict[str, _Key]:
    hints = typing.get_type_hints(kind, include_extras=True)
    out = {}
    for field in fields(kind):
        hint, marks = _marks(hints[field.name])
        if NOT_IN_FILES not in marks:
            origin = get_origin(hint)
            is_container = origin in (dict, tuple, Union, types.UnionType) or is_dataclass(hint)
            is_needed = field.default is MISSING and field.default_factory is MISSING
            name = field.name.removesuffix("_")  # `from_`, because `from` is a keyword of Python
            name = name.replace("_", "-") if getattr(kind, "HYPHENS", False) else name
            out[name] = _Key(field.name, hints[field.name], is_needed, is_container)
    return out


def _build(source: MarkedYaml, keys: Keys, data: Any, kind: Any, base: Any) -> Any:
    known = _keys_of(kind)
    source.check_names(keys, data, known)
    values = {} if base is None else {field.name: getattr(base, field.name) for field in fields(kind)}
    for name, key in known.items():
        place, value = (*keys, name), data.get(name)
        if name in data and not (value is None and key.may_be_empty):
            values[key.field] = _value(source, place, value, key.hint, values.get(key.field))
        elif base is None and key.is_needed:
            raise source.error(place, f"{_path(place)} is missing; it must be {_description(key.hint)}")
    return kind(**values)


def _mapping(source: MarkedYaml, keys: Keys, data: Any, inner: tuple[Any, ...], base: Any) -> dict[Any, Any]:
    if names := _names(inner[0]):
        source.check_names(keys, data, names)
    out = dict(base or {})
    for name, value in data.items():
        place = (*keys, str(name))
        out[_value(source, place, name, inner[0])] = _value(source, place, value, inner[1])
    return out


def _list(source: MarkedYaml, keys: Keys, data: Any, hint: Any) -> tuple[Any, ...]:
    inner = get_args(_marks(hint)[0])
    if inner == (float, Ellipsis) and all(type(number) in (int, float) for number in data):
        return tuple(map(float, data))  # most lists
    if inner[-1] is Ellipsis:
        inner = inner[:1] * len(data)
    if len(data) != len(inner):
        raise _wrong(source, keys, data, hint)
    return tuple(_value(source, (*keys, n), *pair) for n, pair in enumerate(zip(data, inner, strict=True)))


# Messages about wrong values.

_MOST_NAMED = 16  # limit of the keys that a message lists


def _wrong(source: MarkedYaml, keys: Keys, data: Any, hint: Any, why: str = "") -> FileError:
    message = f": {why}" if why else f" must be {_description(hint)}, not {_shown(data)}"
    return source.error(keys, _path(keys) + message)


def _description(hint: Any) -> str:
    """Describe the allowed values: "a number from 0 to 1", "a list of values, each text"."""
    kind, marks = _marks(hint)
    if what := next((mark.what for mark in marks if isinstance(mark, Meaning) and mark.what), ""):
        return what
    if names := _names(hint):
        return f"one of {', '.join(names)}"
    origin, inner = get_origin(kind), get_args(kind)
    if origin in (types.UnionType, Union):
        return _description(_first(inner))
    length = next((_range(mark).partition(" ")[2] + " " for mark in marks if isinstance(mark, Entries)), "")
    if is_dataclass(kind):
        names = tuple(_keys_of(typing.cast(type, kind)))
        return f"a mapping of {', '.join(names) if len(names) <= _MOST_NAMED else 'names to values'}"
    if origin is dict:
        return f"a mapping of {length}names to values, each {_description(inner[1])}"
    if origin is tuple:
        if inner[-1] is Ellipsis:
            return f"a list of {length}values, each {_description(inner[0])}"
        return f"a list [{', '.join(map(_description, inner))}]"
    words = {int: "a whole number", float: "a number", str: "text", bool: "true or false"}.get(kind, "a value")
    bounds = _bounds(marks)
    return " ".join(part for part in (words, _range(bounds), bounds.unit) if part)


def _range(bounds: Bounds | Entries) -> str:
    """Return bounds in words: "from 0 to 1", "of 0 or more"; empty without bounds."""
    least, most, above = bounds.least, bounds.most, getattr(bounds, "above", False)
    if least == -inf:
        return ""
    if most == inf:
        return f"above {least:g}" if above else f"of {least:g} or more"
    return f"above {least:g}, at most {most:.9g}" if above else f"from {least:g} to {most:.9g}"


def _path(keys: Keys) -> str:
    """Return a key path as text: "overrides[0].when.meter"."""
    parts = (f"[{key}]" if isinstance(key, int) else f".{shown_key(key)}" for key in keys)
    return "".join(parts).removeprefix(".")


def _shown(value: Any) -> str:
    return shown_key(repr(value))
