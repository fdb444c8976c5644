"""The estimated meter of a chart with its terms, on the scale of its song's labels; and the chart's level of DDR."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from dancetutor_cli.lint.findings import AUTO, Estimate
from dancetutor_cli.lint.meter.model import Feature, MeterModel, Scale, model_for
from dancetutor_cli.lint.meter.score import Level

_WORTH = 0.1  # meters; a term that adds less is part of "rest"
Ask = Callable[[Sequence[Feature], float], Sequence[float]]  # the features of a play, at a rate


@dataclass(frozen=True, slots=True)
class MeteredChart:
    """A chart before its scale is known.

    label : the chart's meter in the file; on : scale -> estimated meter on it at rate 1
    terms, played : for each scale, the meters that terms add, at rate 1 and at `rate`
    """

    model: MeterModel
    label: int
    difficulty: str
    on: Mapping[str, float]
    terms: Sequence[Mapping[str, float]]
    played: Sequence[Mapping[str, float]]
    rate: float = 1.0


def size(steps_type: str, label: tuple[int, str], ask: Ask, rate: float = 1.0) -> MeteredChart | None:
    """Return a chart's meters on every scale; None for a pad without a model.

    label : the chart's meter and difficulty; ask : function that gives the features of the play at a rate
    """
    model = model_for(steps_type)
    if model is None:
        return None
    one = measure_chart(model, ask(model.features, 1.0), label)
    if rate == 1.0:
        return one
    return replace(one, played=model.terms(ask(model.features, rate)), rate=rate)


def measure_chart(model: MeterModel, values: Sequence[float], label: tuple[int, str]) -> MeteredChart:
    """Return a chart's meters on every scale at rate 1. values : the values of `model.features`"""
    terms = model.terms(values)
    on = {scale.name: scale.meter(of) for scale, of in zip(model.scales, terms, strict=True)}
    return MeteredChart(model, *label, on, terms, terms)


# The scale of the labels of a song.

# Value of the tag #METERTYPE -> the scale. "DDR" may be the old scale of 1 to 10 or another one, so it is not listed.
_TAGS = {"ITG": "itg", "DDR X": "ddr"}
TAGGED = 3.0  # meters by which all labels together must fit another scale better, because some tags are wrong
_CLEAR = 1.0  # meters by which one scale must fit the labels better than any other; else it is a guess
_MOST = 3.0  # the most meters that a label counts as missed by, because some labels are jokes
_FEWEST = 2  # other charts of a song that are enough to know its scale
_GUEST = 1 / 3  # weight of the other charts' labels for the scale of an Edit, which may be by another author


def tagged_scale(tag: str) -> str | None:
    """Return the scale that a value of #METERTYPE names, or None."""
    return _TAGS.get(tag.strip().upper())


def scales_of(charts: Sequence[MeteredChart], tag: str = "", scale: str = AUTO) -> list[tuple[str, bool]]:
    """Return the scale of each of a song's charts for one pad, and whether it is known.

    The user's scale counts first. Otherwise it is the scale on which the labels of the other charts have clearly the
    least error. At least two other charts or a tag must set it, and a tag makes the other scales fit worse. A chart's
    own label does not count, because the estimate is compared with it. It counts only if the scale is a guess: if there
    are too few labels, and for an Edit, whose label may be on another scale than its song.
    """
    if charts and len(charts[0].on) == 1:
        return [(next(iter(charts[0].on)), True)] * len(charts)
    if scale != AUTO:
        return [(scale, True)] * len(charts)
    main, edits = _votes(charts)
    return [_scale_of(one, main, edits, tagged_scale(tag)) for one in charts]


def label_scales_of(charts: Sequence[MeteredChart], tag: str = "", scale: str = AUTO) -> list[str]:
    """Return the scale of each chart's label: the scale that all labels of the song fit best; for an Edit its own."""
    if scale != AUTO or (charts and len(charts[0].on) == 1):
        return [name for name, _ in scales_of(charts, tag, scale)]
    main, edits = _votes(charts)
    tagged = tagged_scale(tag)
    found = []
    for one in charts:
        missed = (main if main.count else edits).by_scale(one, tagged)
        of_song = min(missed, key=missed.__getitem__)
        found.append(_scale_of(one, main, edits, tagged)[0] if _is_guests(one) else of_song)
    return found


def _is_guests(one: MeteredChart) -> bool:
    return one.difficulty == "Edit"


def _votes(charts: Sequence[MeteredChart]) -> tuple[_Misses, _Misses]:
    """Return the misses of ordinary charts, and the misses of Edits. A label of 0 does not count."""
    main, edits = _Misses(), _Misses()
    for one in charts:
        if one.label > 0:
            (edits if _is_guests(one) else main).add(one)
    return main, edits


def _scale_of(one: MeteredChart, main: _Misses, edits: _Misses, tagged: str | None) -> tuple[str, bool]:
    """Return the scale of a chart, and whether it is known. The misses must include the chart's own label."""
    others = main if _is_guests(one) or not one.label else main.without(one)
    if not others.count:
        others = edits.without(one) if _is_guests(one) and one.label else edits
    missed = others.by_scale(one, tagged)
    best, *rest = sorted(missed.values())
    enough = tagged is not None or others.count >= _FEWEST
    known = enough and not _is_guests(one) and (not rest or rest[0] - best >= _CLEAR)
    if not known and one.label:
        weight = _GUEST if _is_guests(one) else 1.0
        missed = {name: weight * missed[name] + abs(meter - one.label) for name, meter in one.on.items()}
    return min(missed, key=missed.__getitem__), known


class _Misses:
    """The sum of the distances between the labels and the estimates of some charts on each scale, in meters."""

    def __init__(self, count: int = 0, by: Mapping[str, float] | None = None) -> None:
        self.count = count
        self._by = dict(by or {})

    def add(self, one: MeteredChart, times: int = 1) -> None:
        """Add a chart's misses, or remove them with `times` -1."""
        self.count += times
        for name, meter in one.on.items():
            self._by[name] = self._by.get(name, 0.0) + times * min(abs(meter - one.label), _MOST)

    def without(self, one: MeteredChart) -> _Misses:
        """Return these misses without those of a chart that was added."""
        out = _Misses(self.count, self._by)
        out.add(one, -1)
        return out

    def by_scale(self, one: MeteredChart, tagged: str | None) -> dict[str, float]:
        """Return the misses on each scale of a chart's pad, the usual scale first, in meters.

        If a tag names one of the scales, the misses of the others are `TAGGED` larger.
        """
        worse = TAGGED if tagged in one.on else 0.0
        return {name: self._by.get(name, 0.0) + (worse if name != tagged else 0.0) for name in one.on}


def _interval(scale: Scale, meter: float) -> tuple[float, float]:
    interval = scale.interval
    band = sum(meter > end for end in interval.up_to)
    return max(meter - interval.below[band], 0.0), min(meter + interval.above[band], scale.most)


def on_scale(one: MeteredChart, name: str, known: bool, *, faster: bool = True) -> Estimate:
    """Return the estimate on a scale, or on the pad's usual scale if the pad lacks it; at rate 1 if not `faster`."""
    model = one.model
    number = next((n for n, scale in enumerate(model.scales) if scale.name == name), 0)
    scale, terms = model.scales[number], (one.played if faster else one.terms)[number]
    meter = scale.meter(terms)
    named = sorted(((term, value) for term, value in terms.items() if value >= _WORTH), key=lambda term: -term[1])
    rest = meter - sum(value for _, value in named)
    low, high = _interval(scale, meter)
    if not known:
        low, high = min(low, max(meter - model.alone[0], 0.0)), max(high, min(meter + model.alone[1], scale.most))
    return Estimate(meter, low, high, scale.name, known, (*named, ("rest", rest)), one.rate if faster else 1.0)


# A chart's level of DDR by its label. The score is estimated from it.

_LEVELS = "ddr"
_BELIEVED = 3.0  # the most meters between a label and the estimate that count


def level_of(one: MeteredChart, scale: str) -> Level:
    """Return the level of a chart by its label and the label's scale; by the estimate alone if the label is 0 (none).

    one : a chart for a pad that has the scale ddr
    """
    on = one.on
    off = min(max(one.label - on[scale], -_BELIEVED), _BELIEVED) if one.label > 0 else 0.0
    at = next(n for n, of in enumerate(one.model.scales) if of.name == _LEVELS)
    faster = one.model.scales[at].meter(one.played[at]) - on[_LEVELS]
    meter = on[_LEVELS] + off
    if scale == _LEVELS and one.label > 0:
        return Level(meter + faster)
    low, high = _interval(one.model.scales[at], meter)
    return Level(meter + faster, meter - low, high - meter)
