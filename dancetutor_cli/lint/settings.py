"""Which rules look at which chart, with which severity and options: layers of configuration, resolved.

A layer is what one file says, or one entry of its `overrides`. Later layers win: configs/lint/default.yaml, what
`extends` names, dancetutor.yaml, the command line.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import PurePath
from typing import Any

SEVERITIES = ("error", "warning", "info", "off")
Options = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Condition:
    """When a layer holds; an empty part always does.

    paths : shell patterns, relative to the folder of the configuration `root`
    steps_types, difficulties : lower case
    meters : least and greatest meter
    """

    root: str = ""
    paths: tuple[str, ...] = ()
    steps_types: tuple[str, ...] = ()
    difficulties: tuple[str, ...] = ()
    meters: tuple[int, int] | None = None

    @property
    def is_about_charts(self) -> bool:
        """Whether it can only be decided for a chart."""
        return bool(self.steps_types or self.difficulties or self.meters)

    def holds_for_path(self, path: PurePath) -> bool:
        """Whether one of the patterns fits; a pattern without a slash fits any part of the path, as in .gitignore."""
        if not self.paths:
            return True
        if path.is_relative_to(self.root):
            path = path.relative_to(self.root)
        whole = path.as_posix()
        return any(
            fnmatchcase(whole, pattern) if "/" in pattern else any(fnmatchcase(part, pattern) for part in path.parts)
            for pattern in self.paths
        )

    def holds_for_chart(self, steps_type: str, difficulty: str, meter: int) -> bool:
        """Whether steps type, difficulty and meter fit."""
        return (
            (not self.steps_types or steps_type.lower() in self.steps_types)
            and (not self.difficulties or difficulty.lower() in self.difficulties)
            and (self.meters is None or self.meters[0] <= meter <= self.meters[1])
        )


@dataclass(frozen=True, slots=True)
class Layer:
    """What one place says about rules.

    select : codes of the only rules that are to run, None: says nothing
    ignore : codes of rules that are not to run
    rules : code -> {"severity": ..., option: ...}
    """

    when: Condition = Condition()
    select: frozenset[str] | None = None
    ignore: frozenset[str] = frozenset()
    rules: Mapping[str, Options] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Settings:
    """All layers in order. Plain data, so that it pickles and can be part of a cache key.

    stream_rows : a measure with at least so many rows counts as stream
    """

    layers: tuple[Layer, ...] = ()
    stream_rows: int = 16

    def with_layer(self, layer: Layer) -> Settings:
        """The same with one more layer on top."""
        return replace(self, layers=(*self.layers, layer))

    def fingerprint(self) -> str:
        """The same text for the same settings, in every process."""
        layers = [(x.when, x.select and sorted(x.select), sorted(x.ignore), x.rules) for x in self.layers]
        return repr((self.stream_rows, layers))

    def for_file(self, path: PurePath) -> dict[str, Options]:
        """Code -> severity and options of the rules that run on a file as a whole."""
        return _resolve(
            layer for layer in self.layers if not layer.when.is_about_charts and layer.when.holds_for_path(path)
        )

    def for_chart(self, path: PurePath, steps_type: str, difficulty: str, meter: int) -> dict[str, Options]:
        """Code -> severity and options of the rules that run on a chart."""
        return _resolve(
            layer
            for layer in self.layers
            if layer.when.holds_for_path(path) and layer.when.holds_for_chart(steps_type, difficulty, meter)
        )


def _resolve(layers: Any) -> dict[str, Options]:
    rules: dict[str, dict[str, Any]] = {}
    selected: frozenset[str] | None = None
    ignored: frozenset[str] = frozenset()
    for layer in layers:
        for code, options in layer.rules.items():
            rules[code] = {**rules.get(code, {}), **options}
        if layer.select is not None:
            selected, ignored = layer.select, ignored - layer.select
        ignored |= layer.ignore
    return {
        code: options
        for code, options in sorted(rules.items())
        if options["severity"] != "off" and code not in ignored and (selected is None or code in selected)
    }
