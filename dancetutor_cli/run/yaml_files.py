"""YAML files, read with the line of every key and converted to dataclasses by `run/schema.py`."""

from __future__ import annotations

from math import isfinite
from pathlib import Path
from typing import Any

import yaml

from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import MAX_DEPTH, SETTINGS_LIMIT, read_bytes, shown_key
from dancetutor_cli.run.schema import Keys, MarkedYaml, T, convert

# Parsing of YAML with the line of every key, for errors.
#
# The file may be malicious: its size, its depth and the length of values are limited before objects are built. Aliases
# and repeated keys are refused, and numbers must be finite.

_Base: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # libyaml is ten times faster, if the wheel has it
_LONGEST = 10_000  # characters of one value


def read(path: Path) -> MarkedYaml:
    """Read a file whose top level is a mapping. Raises FileError with the line."""
    data, lines = _parsed(read_bytes(path, SETTINGS_LIMIT), path)
    if data is None:
        data = {}
    if not isinstance(data, dict):
        raise FileError(path, "must be a mapping of names to values", 1)
    return MarkedYaml(path, data, lines)


def load(path: Path, kind: type[T], base: T | None = None) -> T:
    """Read `path` as the dataclass `kind`, see `schema.convert`. Raises FileError with the wrong key and its line."""
    return convert(read(path), kind, (), base)


def parse_value(text: str, where: str) -> Any:
    """Parse a value of the command line as YAML. Raises FileError at `where`."""
    return _parsed(text.encode("utf-8", "surrogateescape"), Path(where))[0]


def _parsed(content: bytes, path: Path) -> tuple[Any, dict[Keys, int]]:
    lines: dict[Keys, int] = {}
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
    except yaml.reader.ReaderError as error:  # bytes that are not text
        line = content.count(b"\n", 0, error.position) + 1
        raise FileError(path, f"not YAML: {error.reason}", line) from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = getattr(error, "problem", None) or "not YAML"
        syntax = isinstance(error, yaml.scanner.ScannerError | yaml.parser.ParserError)
        message = f"not YAML: {problem}" if syntax else _without_tag(str(problem))
        raise FileError(path, message, None if mark is None else mark.line + 1) from error
    except (ValueError, OverflowError) as error:  # endless numbers, dates that do not exist, bytes that are not text
        why = "has a number of too many digits" if "digits" in str(error) else str(error)
        raise FileError(path, f"cannot be read: {why}") from error


class _Loader(_Base):  # type: ignore[misc]
    """A loader with limits; libyaml calls the `..._resolver` methods for every node during its descent."""

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
        """Do nothing: `<<` merges the mapping of an alias, and aliases are refused."""

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        mapping: dict[Any, Any] = super().construct_mapping(node, deep)
        if len(mapping) < len(node.value):
            seen: set[Any] = set()
            for key_node, _ in node.value:
                key = self.construct_object(key_node)
                if key in seen:
                    problem = f"the key '{shown_key(key)}' is here twice; remove one"
                    raise yaml.MarkedYAMLError(problem=problem, problem_mark=key_node.start_mark)
                seen.add(key)
        return mapping

    def construct_yaml_float(self, node: Any) -> float:
        number = float(super().construct_yaml_float(node))
        if not isfinite(number):
            raise yaml.MarkedYAMLError(problem="a number must be finite", problem_mark=node.start_mark)
        return number

    def construct_yaml_int(self, node: Any) -> int:
        try:
            return int(super().construct_yaml_int(node))
        except IndexError:  # "!!int" without text, or with underscores only
            raise yaml.MarkedYAMLError(problem="has a number without digits", problem_mark=node.start_mark) from None


_Loader.add_constructor("tag:yaml.org,2002:float", _Loader.construct_yaml_float)
_Loader.add_constructor("tag:yaml.org,2002:int", _Loader.construct_yaml_int)


def _without_tag(problem: str) -> str:
    """Return libyaml's message without the name of a tag, which may be any text."""
    head, found, _ = problem.partition("could not determine a constructor for the tag")
    return f"{head}has a tag (!...), which is not supported" if found else problem


def _mark(node: Any, keys: Keys, lines: dict[Keys, int], met: set[int]) -> None:
    """Record the line of every key, and refuse aliases and values that are too long."""
    if id(node) in met:
        # The node has the line of its anchor; the line of the alias is not known.
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
