"""The estimated meter of a chart with its terms, on the scale that its song is numbered on; and its level of DDR."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from dancetutor_cli.lint.findings import AUTO, Estimate
from dancetutor_cli.lint.meter.model import Feature, MeterModel, Scale, model_for
from dancetutor_cli.lint.meter.score import Level

_WORTH = 0.1  # meters that a term has to add to have a term of its own; less goes into its "rest"
Ask = Callable[[Sequence[Feature], float], Sequence[float]]  # the features of a play, at a rate


@dataclass(frozen=True, slots=True)
class MeteredChart:
    """A chart before its scale is known.

    label : the meter it has in the file; on : scale -> its meter there at rate 1
    terms, played : for each scale the meters that terms add, at rate 1 and at the rate asked for
    """

    model: MeterModel
    label: int
    difficulty: str
    on: Mapping[str, float]
    terms: Sequence[Mapping[str, float]]
    played: Sequence[Mapping[str, float]]
    rate: float = 1.0


def size(steps_type: str, label: tuple[int, str], ask: Ask, rate: float = 1.0) -> MeteredChart | None:
    """A chart's meters on every scale; None for a pad without a model.

    label : its meter and difficulty; ask : what gives features of its play, at a rate
    """
    model = model_for(steps_type)
    if model is None:
        return None
    one = sized(model, ask(model.features, 1.0), label)
    if rate == 1.0:
        return one
    return replace(one, played=model.terms(ask(model.features, rate)), rate=rate)


def sized(model: MeterModel, values: Sequence[float], label: tuple[int, str]) -> MeteredChart:
    """The same by the features of `model.wanted`."""
    terms = model.terms(values)
    on = {scale.name: scale.meter(of) for scale, of in zip(model.scales, terms, strict=True)}
    return MeteredChart(model, *label, on, terms, terms)


# The scale that the charts of a song are numbered on.

# What the tag #METERTYPE says -> the scale. "DDR" stands for the old one of 1 to 10, and for others: it says nothing.
_TAGS = {"ITG": "itg", "DDR X": "ddr"}
TAGGED = 3.0  # meters that all labels together have to be nearer to another scale than the tag's: some tags are wrong
_CLEAR = 1.0  # meters by which one scale has to fit them better than any other; else it is a guess
_MOST = 3.0  # meters that a label is missed by; more counts as this, for it may be a joke
_FEWEST = 2  # other charts of a song that give its scale surely
_GUEST = 1 / 3  # what the label of another chart says of the scale of an Edit, which may be a guest's


def tagged_scale(tag: str) -> str | None:
    """The scale that a value of #METERTYPE names."""
    return _TAGS.get(tag.strip().upper())


def scales_of(charts: Sequence[MeteredChart], tag: str = "", scale: str = AUTO) -> list[tuple[str, bool]]:
    """The scale of each of a song's charts for one pad, and whether it is known.

    The user's scale; otherwise the scale on which the labels of the other charts have clearly the least error, for
    which at least two are needed, unless a tag names another one. A chart's own label does not count, because the
    estimate is compared with it. It counts if the scale is a guess: if there are too few labels, and for an Edit, which
    may be numbered unlike its song.
    """
    if charts and len(charts[0].on) == 1:
        return [(next(iter(charts[0].on)), True)] * len(charts)
    if scale != AUTO:
        return [(scale, True)] * len(charts)
    main, edits = _votes(charts)
    return [_scale_of(one, main, edits, tagged_scale(tag)) for one in charts]


def label_scales_of(charts: Sequence[MeteredChart], tag: str = "", scale: str = AUTO) -> list[str]:
    """The scale that each chart's label is on: that of all labels of the song, its own among them; an Edit's own."""
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
    """Those of the charts, and those of Edits; a label of 0 is none."""
    main, edits = _Misses(), _Misses()
    for one in charts:
        if one.label > 0:
            (edits if _is_guests(one) else main).add(one)
    return main, edits


def _scale_of(one: MeteredChart, main: _Misses, edits: _Misses, tagged: str | None) -> tuple[str, bool]:
    """The scale of a chart that is among those that have voted, and whether it is known."""
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
    """How far the labels of some charts are from the estimates on each scale, in meters."""

    def __init__(self, count: int = 0, by: Mapping[str, float] | None = None) -> None:
        self.count = count
        self._by = dict(by or {})

    def add(self, one: MeteredChart, times: int = 1) -> None:
        """Count a chart in, or with -1 out."""
        self.count += times
        for name, meter in one.on.items():
            self._by[name] = self._by.get(name, 0.0) + times * min(abs(meter - one.label), _MOST)

    def without(self, one: MeteredChart) -> _Misses:
        """The same without a chart that is in it."""
        out = _Misses(self.count, self._by)
        out.add(one, -1)
        return out

    def by_scale(self, one: MeteredChart, tagged: str | None) -> dict[str, float]:
        """Each scale of a chart's pad, the usual one first; those that a tag does not name fit so much worse."""
        worse = TAGGED if tagged in one.on else 0.0
        return {name: self._by.get(name, 0.0) + (worse if name != tagged else 0.0) for name in one.on}


def _interval(scale: Scale, meter: float) -> tuple[float, float]:
    interval = scale.interval
    band = sum(meter > end for end in interval.up_to)
    return max(meter - interval.below[band], 0.0), min(meter + interval.above[band], scale.most)


def on_scale(one: MeteredChart, name: str, known: bool, *, faster: bool = True) -> Estimate:
    """The estimate on a scale (its usual one if the pad lacks it), at the rate asked for unless not `faster`."""
    model = one.model
    number = next((n for n, scale in enumerate(model.scales) if scale.name == name), 0)
    scale, terms = model.scales[number], (one.played if faster else one.terms)[number]
    meter = scale.meter(terms)
    billed = sorted(((term, value) for term, value in terms.items() if value >= _WORTH), key=lambda bill: -bill[1])
    rest = meter - sum(value for _, value in billed)
    low, high = _interval(scale, meter)
    if not known:
        low, high = min(low, max(meter - model.alone[0], 0.0)), max(high, min(meter + model.alone[1], scale.most))
    return Estimate(meter, low, high, scale.name, known, (*billed, ("rest", rest)), one.rate if faster else 1.0)


# The level of DDR that a chart has, by its label: what its score is estimated from.

_LEVELS = "ddr"
_BELIEVED = 3.0  # meters between a label and the estimate; of a label that is further off only so much is heard


def level_of(one: MeteredChart, scale: str) -> Level:
    """The level, from the label and its scale; for a label of 0, which is no label, from the estimate alone.

    one : of a pad that has the scale ddr
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
