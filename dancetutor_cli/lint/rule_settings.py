"""Which rules run on which chart, with which severity and options: layers of configuration; times of moves."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, TypeVar

from dancetutor_cli.feet.conditions import Condition
from dancetutor_cli.lint.rule import BY_METER, all_rules, match_codes, named_singly, rule_named
from dancetutor_cli.run.errors import DancetutorError, FileError
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import Keys, MarkedYaml, NotNegative, Parsed, Text, Texts, check_value
from dancetutor_cli.run.yaml_files import load, read

# A layer has the settings of one file, or of one entry of its `overrides`. Later layers win, in this order:
# configs/lint/default.yaml, the files that `extends` names, dancetutor.yaml, the command line.

Options = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Layer:
    """The settings of rules from one place.

    select : codes of the only rules that run; None if the place does not say
    ignore : codes of rules that do not run
    rules : code -> {"severity": ..., option: ...}
    named : codes of `select` that were named one by one: these run as a warning, even if they are off
    """

    when: Condition = field(default_factory=Condition)
    select: frozenset[str] | None = None
    ignore: frozenset[str] = frozenset()
    rules: Mapping[str, Options] = field(default_factory=dict)
    named: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Settings:
    """All layers in order, as plain data that pickles and can be part of a cache key.

    stream_rows : the least number of rows in a measure that counts as stream
    sure_feet : a finding about feet with less confidence than this, per cent, is an info
    coin_toss : a finding is an ambiguity if other feet cost at most so many cost units more
    sync : whether the music is decoded, for the rules about it
    """

    layers: tuple[Layer, ...] = ()
    stream_rows: int = 16
    sure_feet: float = 85
    coin_toss: int = 5
    sync: bool = False
    _resolved: dict[tuple[int, ...], dict[str, Options]] = field(default_factory=dict, compare=False, repr=False)

    def with_layer(self, layer: Layer) -> Settings:
        """Return the settings with one more layer on top."""
        return replace(self, layers=(*self.layers, layer), _resolved={})

    def fingerprint(self) -> str:
        """Return a text that is the same for the same settings in every process."""
        layers = [
            (x.when, x.select and sorted(x.select), sorted(x.ignore), x.rules, sorted(x.named)) for x in self.layers
        ]
        return repr((self.stream_rows, self.sure_feet, self.coin_toss, self.sync, layers))

    def for_file(self, path: Path) -> dict[str, Options]:
        """Return code -> severity and options of the rules that run on a file as a whole."""
        return self._of(n for n, layer in enumerate(self.layers) if layer.when.holds_for_file(path))

    def for_chart(self, path: Path, steps_type: str, difficulty: str, meter: int) -> dict[str, Options]:
        """Return code -> severity and options of the rules that run on a chart."""
        kind = (steps_type, difficulty, meter)
        return self._of(n for n, layer in enumerate(self.layers) if layer.when.holds(path, *kind))

    def _of(self, layers: Iterable[int]) -> dict[str, Options]:
        """Return the rules of the layers with these indices. They are cached, because most charts have the same."""
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


# The settings of a configuration as layers: the defaults of rules, and the settings on top. Errors name their place.

_Meaning = TypeVar("_Meaning")


@cache
def default_rules() -> Mapping[str, Options]:
    """Return code -> default severity and options of every rule, from configs/lint/default.yaml.

    FileError if a rule has no entry.
    """
    path = config_path("lint/default.yaml")
    rules = dict(read(path).data["rules"])
    for code in sorted(all_rules().keys() - rules.keys()):
        raise FileError(
            path, f"rule {code} has no line under 'rules'; give it one, for example {code}: {{severity: info}}"
        )
    return rules


@cache
def default_severity(code: str) -> str:
    """Return a rule's default severity for people: "off", or "off; warning for Beginner of meter 6 or less"."""
    data = read(config_path("lint/default.yaml")).data
    severity = str(data["rules"][code]["severity"])
    for entry in data.get("overrides", ()):
        for name, options in entry["rules"].items():
            if match_codes(str(name)) == {code} and not isinstance(options, Mapping):
                severity += f"; {options} for {' of '.join(map(_worded, entry['when'].values()))}"
    return severity


def _worded(value: object) -> str:
    """Return a condition's value in words: a list as "A, B", a range of meters as "meter 6 or less"."""
    if isinstance(value, list):
        return ", ".join(map(str, value))
    low, _, high = str(value).partition("-")
    return f"meter {value}" if low and high else f"meter {high} or less" if high else f"meter {low} or more"


@dataclass(eq=False, repr=False)
class RulesKeys:
    """The keys about rules in a file, or in an entry of its overrides; `layer_of` checks `rules`."""

    select: Texts | None = None
    ignore: Texts = ()
    rules: dict[Text, Any] = field(default_factory=dict)


def layer_of(source: MarkedYaml, entry: RulesKeys, when: Condition, place: Keys) -> Layer:
    """Return the layer of a file or of one of its overrides, for a condition; FileError for a wrong value."""
    rules: dict[str, Options] = {}
    for name, options in entry.rules.items():
        at = (*place, "rules", name)
        code = resolve_name(source, rule_named, name, at).code
        rules[code] = _options(source, code, options, at)
    selected, ignored = (
        [resolve_name(source, match_codes, selector, (*place, key)) for selector in getattr(entry, key) or ()]
        for key in ("select", "ignore")
    )
    select = None if entry.select is None else frozenset[str]().union(*selected)
    return Layer(when, select, frozenset[str]().union(*ignored), rules, named_singly(entry.select or ()))


def _options(source: MarkedYaml, code: str, options: Any, place: Keys) -> Options:
    defaults = default_rules()[code]
    if isinstance(options, str) or options is False:
        options = {"severity": options}
    elif not isinstance(options, dict):
        raise source.error(place, f"the settings of a rule are a severity or a mapping of {', '.join(defaults)}")
    source.check_names(place, options, defaults)
    for key, value in options.items():
        at = (*place, key)
        try:
            check_value(source, at, value, _Severity if key == "severity" else _like(defaults[key], value))
        except FileError as error:
            raise source.error(at, f"{error.message}; by default it is {defaults[key]!r}") from None
        if fault := all_rules()[code].fault(key, value):
            raise source.error(at, f"{code} {key}: {fault}")
    return {key: _off(value) if key == "severity" else value for key, value in options.items()}


def _off(severity: Any) -> Any:
    """YAML 1.1 reads a bare `off` as False."""
    return "off" if severity is False else severity


_Severity = Annotated[Literal["error", "warning", "info", "off"], Parsed(_off)]


def _like(default: Any, value: Any) -> Any:
    """Return the type of an option by its default value. Numbers may not be negative."""
    if isinstance(default, list):
        return tuple[float, ...] if default and not isinstance(default[0], str) else tuple[str, ...]
    if default == BY_METER:  # a number or this word; `Rule.fault` checks words
        return str if isinstance(value, str) else NotNegative
    return type(default) if isinstance(default, bool | str) else NotNegative


def resolve_name(source: MarkedYaml, look_up: Callable[[str], _Meaning], name: str, place: Keys) -> _Meaning:
    """Return the result of `look_up` for a name in a file; FileError with its place if there is none."""
    try:
        return look_up(name)
    except DancetutorError as error:
        raise source.error(place, str(error)) from None


# How quick a move must be to be reported. configs/move_times.yaml has the share of charts that contain the move.
#
# A move that one chart in five of a meter has is usual for this meter. No chart may have the same move twice as quick.

_OTHERS = "dance-single"  # the pad whose table holds for pads without a table


class Band(NamedTuple):
    """Charts for one kind of pad, of meters `first` to `last` (None: no limit).

    within : for each time of the table, the per cent of charts that have the move within it
    """

    pad: str
    first: int
    last: int | None
    charts: int
    within: tuple[float, ...]

    @property
    def meters(self) -> str:
        """The meters of the band for people: "4 to 6", "13 and more"."""
        return f"{self.first} and more" if self.last is None else f"{self.first} to {self.last}"


def pad_of(steps_type: str) -> str:
    """Return the pad of the table that holds for a steps type."""
    family, _, kind = steps_type.partition("-")
    pad = f"{family}-{'double' if kind in ('halfdouble', 'double', 'routine') else 'single'}"
    return pad if pad in _times().meters else _OTHERS


def bands(move: str) -> Iterator[Band]:
    """Yield every band of charts with the shares of a move."""
    times = _times()
    for pad, lasts in times.meters.items():
        edges: Sequence[int | None] = [*lasts, None]
        first = 1
        for number, last in enumerate(edges):
            yield Band(pad, first, last, times.charts[pad][number], times.moves[move][pad][number])
            first = 0 if last is None else last + 1


@cache
def limit(move: str, share: float, steps_type: str, meter: int) -> float:
    """Return the longest time (s) within which at most `share` per cent of a meter's charts have the move, or 0."""
    pad = pad_of(steps_type)
    here = next(band for band in bands(move) if band.pad == pad and (band.last is None or meter <= band.last))
    return limit_of(here, share) / 1000


def limit_of(band: Band, share: float) -> int:
    """Return the limit for a band in milliseconds, see `limit`."""
    few = [time for time, part in zip(_times().milliseconds, band.within, strict=True) if part <= share]
    return max(few, default=0)


def describe_bands(move: str, share: float, slowest: float = math.inf) -> Iterator[str]:
    """Yield a line for each band: the limit, at most `slowest` (s), and the shares of charts on both sides of it."""
    times = _times().milliseconds
    for band in bands(move):
        at = limit_of(band, share)
        parts = dict(zip(times, band.within, strict=True))
        if at > slowest * 1000:
            yield f"{band.pad:12} meter {band.meters:12} up to {slowest * 1000:g} ms, the rule's limit"
            continue
        quick = f"up to {at} ms ({parts[at]:g} % of {band.charts} charts" if at else f"none ({band.charts} charts"
        more = next((time for time in times if time > at), None)
        quick += f"; {parts[more]:g} % up to {more} ms)" if more else ")"
        yield f"{band.pad:12} meter {band.meters:12} {quick}"


@dataclass(eq=False, repr=False)
class _MoveTimes:
    """The contents of configs/move_times.yaml.

    meters, charts : for each pad, the last meter and the number of charts of each band
    moves : per cent of charts, by move, pad, band and time
    """

    meters: dict[str, tuple[int, ...]]
    charts: dict[str, tuple[int, ...]]
    milliseconds: tuple[int, ...]
    moves: dict[str, dict[str, tuple[tuple[float, ...], ...]]]


@cache
def _times() -> _MoveTimes:
    return load(config_path("move_times.yaml"), _MoveTimes)
