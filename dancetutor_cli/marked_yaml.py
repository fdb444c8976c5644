"""A YAML mapping with the line of every key, so that an error can say where in the file it is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from dancetutor_cli.errors import FileError

_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # libyaml where the wheel has it: ten times faster


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
                raise self.error((*keys, key), f"unknown key '{key}'{where}; there are: {', '.join(known)}")


def read(path: Path) -> MarkedYaml:
    """Read a file whose top is a mapping. FileError says what is wrong and where."""
    try:
        loader = _Loader(path.read_bytes())
        try:
            node = loader.get_single_node()
            data = loader.construct_document(node) if node is not None else {}
        finally:
            loader.dispose()
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or "not YAML"
        raise FileError(path, str(problem), None if mark is None else mark.line + 1) from error
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror or error}") from error
    except ValueError as error:  # bytes that are no text, dates that do not exist
        raise FileError(path, f"cannot be read: {error}") from error
    if not isinstance(data, dict):
        raise FileError(path, "must be a mapping of names to values", 1)
    lines: dict[tuple[str | int, ...], int] = {}
    _mark(node, (), lines)
    return MarkedYaml(path, data, lines)


def _mark(node: Any, keys: tuple[str | int, ...], lines: dict[tuple[str | int, ...], int]) -> None:
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            place = (*keys, str(key.value))
            lines[place] = key.start_mark.line + 1
            _mark(value, place, lines)
    elif isinstance(node, yaml.SequenceNode):
        for number, value in enumerate(node.value):
            lines[(*keys, number)] = value.start_mark.line + 1
            _mark(value, (*keys, number), lines)
