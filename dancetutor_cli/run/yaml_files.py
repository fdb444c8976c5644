"""YAML by schema: mappings with the line of every key, read into frozen dataclasses."""

from __future__ import annotations

import re
import types
import typing
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import cache
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

import yaml

from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import MAX_DEPTH, SETTINGS_LIMIT, read_bytes, shown_key

# A YAML mapping with the line of every key, so that an error can say where in the file it is.
#
# The file may be a stranger's, and made to break whoever reads it: its size, its depth and the length of a value are
# bounded before anything is built of it, aliases are refused, every key stands once, and numbers are finite.

_Base: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # libyaml where the wheel has it: ten times faster
_LONGEST = 10_000  # characters of one value


@dataclass(frozen=True, slots=True)
class MarkedYaml:
    """What a YAML file says.

    path : the file; data : its top mapping
    lines : 1-based line of every key, by its key path, e.g. ("weights", "spin"); items of lists by their number
    """

    path: Path
    data: dict[str, Any]
    lines: Mapping[tuple[str | int, ...], int]

    def error(self, keys: tuple[str | int, ...], message: str) -> FileError:
        """An error at a key, or at the nearest key above it that has a line."""
        while keys and keys not in self.lines:
            keys = keys[:-1]
        return FileError(self.path, message, self.lines.get(keys))

    def only(self, keys: tuple[str | int, ...], known: Iterable[str]) -> None:
        """Raise unless every key of the mapping at `keys` is one of `known`."""
        inside: Any = self.data
        for key in keys:
            inside = inside[key]
        if not isinstance(inside, dict):
            raise self.error(keys, f"'{keys[-1]}' must be a mapping of names to values")
        for key in inside:
            if key not in known:
                where = f" in '{keys[-1]}'" if keys else ""
                raise self.error((*keys, key), f"unknown key '{shown_key(key)}'{where}; there are: {', '.join(known)}")


def read(path: Path) -> MarkedYaml:
    """Read a file whose top is a mapping. FileError says what is wrong and where."""
    data, lines = _parsed(read_bytes(path, SETTINGS_LIMIT), path)
    if data is None:
        data = {}
    if not isinstance(data, dict):
        raise FileError(path, "must be a mapping of names to values", 1)
    return MarkedYaml(path, data, lines)


def parse_value(text: str, where: str) -> Any:
    """A value of the command line in YAML; FileError at `where` if it is none."""
    return _parsed(text.encode("utf-8", "surrogateescape"), Path(where))[0]


def _parsed(content: bytes, path: Path) -> tuple[Any, dict[tuple[str | int, ...], int]]:
    lines: dict[tuple[str | int, ...], int] = {}
    try:
        loader = _Loader(content)
        try:
            node = loader.get_single_node()
            if node is None:
                return None, lines
            _mark(node, (), lines, set())
            return loader.construct_document(node), lines
        finally:
            loader.dispose()
    except yaml.reader.ReaderError as error:  # bytes that are no text
        line = content.count(b"\n", 0, error.position) + 1
        raise FileError(path, f"not YAML: {error.reason}", line) from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or "not YAML"
        syntax = isinstance(error, yaml.scanner.ScannerError | yaml.parser.ParserError)
        said = f"not YAML: {problem}" if syntax else _without_tag(str(problem))
        raise FileError(path, said, None if mark is None else mark.line + 1) from error
    except (ValueError, OverflowError) as error:  # numbers without end, dates that do not exist, bytes that are no text
        why = "has a number of too many digits" if "digits" in str(error) else str(error)
        raise FileError(path, f"cannot be read: {why}") from error


class _Loader(_Base):  # type: ignore[misc]
    """Bounds what a file may make us do; libyaml calls the `..._resolver` methods for every node on its way down."""

    _depth = 0

    def descend_resolver(self, current_node: Any, current_index: Any) -> None:
        self._depth += 1
        if self._depth > MAX_DEPTH:
            mark = getattr(current_node, "start_mark", None)
            raise yaml.MarkedYAMLError(problem=f"is nested deeper than {MAX_DEPTH} levels", problem_mark=mark)
        super().descend_resolver(current_node, current_index)

    def ascend_resolver(self) -> None:
        self._depth -= 1
        super().ascend_resolver()

    def flatten_mapping(self, node: Any) -> None:
        """`<<` merges what an alias names, and there are no aliases."""

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        mapping: dict[Any, Any] = super().construct_mapping(node, deep)
        if len(mapping) < len(node.value):
            seen: set[Any] = set()
            for key_node, _ in node.value:
                key = self.construct_object(key_node)
                if key in seen:
                    problem = f"the key '{shown_key(key)}' stands here twice; only one of them can be meant"
                    raise yaml.MarkedYAMLError(problem=problem, problem_mark=key_node.start_mark)
                seen.add(key)
        return mapping

    def construct_yaml_float(self, node: Any) -> float:
        number = float(super().construct_yaml_float(node))
        if not isfinite(number):
            raise yaml.MarkedYAMLError(
                problem="a number must be finite; write an ordinary one", problem_mark=node.start_mark
            )
        return number

    def construct_yaml_int(self, node: Any) -> int:
        try:
            return int(super().construct_yaml_int(node))
        except IndexError:  # "!!int" of nothing, or of underscores alone
            raise yaml.MarkedYAMLError(problem="has a number without digits", problem_mark=node.start_mark) from None


_Loader.add_constructor("tag:yaml.org,2002:float", _Loader.construct_yaml_float)
_Loader.add_constructor("tag:yaml.org,2002:int", _Loader.construct_yaml_int)


def _without_tag(problem: str) -> str:
    """What libyaml says, without the name of a tag: that may be anything."""
    head, found, _ = problem.partition("could not determine a constructor for the tag")
    return f"{head}has a tag (!...), which nothing here has a use for" if found else problem


def _mark(node: Any, keys: tuple[str | int, ...], lines: dict[tuple[str | int, ...], int], met: set[int]) -> None:
    """Note the line of every key, and refuse what stands at several places or is too long."""
    if id(node) in met:
        # The node has the place of its anchor; that of the alias is not known any more.
        problem = "aliases (*name) are not read; write out what they stand for"
        raise yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)
    met.add(id(node))
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            place = (*keys, str(key.value)[:_LONGEST])
            lines[place] = key.start_mark.line + 1
            _mark(key, place, {}, met)
            _mark(value, place, lines, met)
    elif isinstance(node, yaml.SequenceNode):
        for number, value in enumerate(node.value):
            lines[(*keys, number)] = value.start_mark.line + 1
            _mark(value, (*keys, number), lines, met)
    elif len(node.value) > _LONGEST:
        raise yaml.MarkedYAMLError(problem=f"a value has more than {_LONGEST} characters", problem_mark=node.start_mark)


# Reading a YAML mapping into a frozen dataclass: every key is checked, and an error names the keys that exist.

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
