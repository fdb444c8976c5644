"""Which rules look at which chart, with which severity and options: layers of configuration, resolved.

A layer is what one file says, or one entry of its `overrides`. Later layers win: configs/lint/default.yaml, what
`extends` names, dancetutor.yaml, the command line.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from dancetutor_cli.library.settings_file import Condition

SEVERITIES = ("error", "warning", "info", "off")
Options = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Layer:
    """What one place says about rules.

    select : codes of the only rules that are to run, None: says nothing
    ignore : codes of rules that are not to run
    rules : code -> {"severity": ..., option: ...}
    named : codes of `select` that were named singly: these run, as a warning, even if they are off
    """

    when: Condition = field(default_factory=Condition)
    select: frozenset[str] | None = None
    ignore: frozenset[str] = frozenset()
    rules: Mapping[str, Options] = field(default_factory=dict)
    named: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Settings:
    """All layers in order. Plain data, so that it pickles and can be part of a cache key.

    stream_rows : a measure with at least so many rows counts as stream
    sure_feet : a finding about feet that are less sure than this, per cent, is an info
    coin_toss : it is an ambiguity where other feet cost at most so much more
    """

    layers: tuple[Layer, ...] = ()
    stream_rows: int = 16
    sure_feet: float = 85
    coin_toss: int = 5
    _resolved: dict[tuple[int, ...], dict[str, Options]] = field(default_factory=dict, compare=False, repr=False)
    _holding: dict[tuple[str, str, int], tuple[int, ...]] = field(default_factory=dict, compare=False, repr=False)

    def with_layer(self, layer: Layer) -> Settings:
        """The same with one more layer on top."""
        return replace(self, layers=(*self.layers, layer), _resolved={}, _holding={})

    def fingerprint(self) -> str:
        """The same text for the same settings, in every process."""
        layers = [
            (x.when, x.select and sorted(x.select), sorted(x.ignore), x.rules, sorted(x.named)) for x in self.layers
        ]
        return repr((self.stream_rows, self.sure_feet, self.coin_toss, layers))

    def for_file(self, path: Path) -> dict[str, Options]:
        """Code -> severity and options of the rules that run on a file as a whole."""
        return self._of(
            n for n, layer in enumerate(self.layers)
            if not layer.when.is_about_charts and layer.when.holds_for_path(path)
        )  # fmt: skip

    def for_chart(self, path: Path, steps_type: str, difficulty: str, meter: int) -> dict[str, Options]:
        """Code -> severity and options of the rules that run on a chart."""
        kind = (steps_type, difficulty, meter)
        holding = self._holding.get(kind)
        if holding is None:
            holds = (n for n, layer in enumerate(self.layers) if layer.when.holds_for_chart(*kind))
            holding = self._holding[kind] = tuple(holds)
        return self._of(n for n in holding if self.layers[n].when.holds_for_path(path))

    def _of(self, layers: Iterable[int]) -> dict[str, Options]:
        """The rules of some of the layers; most files and charts have the same."""
        holding = tuple(layers)
        if holding not in self._resolved:
            self._resolved[holding] = _resolve(self.layers[n] for n in holding)
        return self._resolved[holding]


def _resolve(layers: Any) -> dict[str, Options]:
    rules: dict[str, dict[str, Any]] = {}
    selected: frozenset[str] | None = None
    ignored: frozenset[str] = frozenset()
    named: frozenset[str] = frozenset()
    for layer in layers:
        for code, options in layer.rules.items():
            rules[code] = {**rules.get(code, {}), **options}
        if layer.select is not None:
            selected, ignored, named = layer.select, ignored - layer.select, layer.named
        ignored |= layer.ignore
    for code in named & set(rules):
        if rules[code]["severity"] == "off":
            rules[code]["severity"] = "warning"
    return {
        code: options
        for code, options in sorted(rules.items())
        if options["severity"] != "off" and code not in ignored and (selected is None or code in selected)
    }
