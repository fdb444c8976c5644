"""The estimated meter of a chart with its bill, on the scale that its song is numbered on; and its level of DDR."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from dancetutor_cli.lint.findings import AUTO, Estimate
from dancetutor_cli.lint.meter.features import Feature
from dancetutor_cli.lint.meter.model import MeterModel, Scale, model_for
from dancetutor_cli.lint.meter.score import Level

# What the tag #METERTYPE says -> the scale. "DDR" stands for the old one of 1 to 10, and for others: not trusted.
_TAGS = {"ITG": "itg", "DDR X": "ddr"}
_UNUSUAL = 0.5  # meters that a scale other than the usual one has to fit better by, over all charts of a song
_WORTH = 0.1  # meters that a term has to add to stand on the bill; less goes into its "rest"
_FEWEST = 2  # other charts of a song that tell its scale surely
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

    label : its meter and difficulty; ask : what tells features of its play, at a rate
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
    on = {scale.name: scale.start + sum(of.values()) for scale, of in zip(model.scales, terms, strict=True)}
    return MeteredChart(model, *label, on, terms, terms)


def _interval(scale: Scale, meter: float) -> tuple[float, float]:
    band = sum(meter > end for end in scale.up_to)
    return max(meter - scale.below[band], 0.0), meter + scale.above[band]


def says_scale(tag: str) -> bool:
    """Whether a value of #METERTYPE names a scale."""
    return tag.strip().upper() in _TAGS


def scales_of(charts: Sequence[MeteredChart], tag: str = "", said: str = AUTO) -> list[tuple[str, bool]]:
    """The scale of each of a song's charts for one pad, and whether it is known.

    What the user or #METERTYPE says; else the scale on which the labels of the other charts are missed least, of which
    it takes two. A chart's own label is not asked: that is what the estimate is for.
    """
    if charts and len(charts[0].on) == 1:
        return [(next(iter(charts[0].on)), True)] * len(charts)
    if said != AUTO:
        return [(said, True)] * len(charts)
    if says_scale(tag):
        return [(_TAGS[tag.strip().upper()], True)] * len(charts)
    all_, main = _Misses(), _Misses()
    tells = [one.difficulty != "Edit" and one.label > 0 for one in charts]  # an Edit may be a guest's
    for one, told in zip(charts, tells, strict=True):
        all_.add(one, 1)
        if told:
            main.add(one, 1)
    return [
        (main if main.count > told else all_).best_without(one, told or main.count <= told)
        for one, told in zip(charts, tells, strict=True)
    ]


class _Misses:
    """How far the labels of some charts are from the estimates on each scale."""

    def __init__(self) -> None:
        self.count = 0
        self._by: dict[str, float] = {}

    def add(self, one: MeteredChart, times: int) -> None:
        """Count a chart in, or with -1 out."""
        self.count += times
        for name, meter in one.on.items():
            self._by[name] = self._by.get(name, 0.0) + times * abs(meter - one.label)

    def best_without(self, one: MeteredChart, is_in: bool) -> tuple[str, bool]:
        """The scale that fits the others best, the usual one unless another does clearly; whether they are enough."""
        usual = next(iter(one.on))
        if is_in:
            self.add(one, -1)
        found = min(one.on, key=lambda name: self._by.get(name, 0.0) + (_UNUSUAL if name != usual else 0.0))
        count = self.count
        if is_in:
            self.add(one, 1)
        return (found, count >= _FEWEST) if count else (usual, False)


def on_scale(one: MeteredChart, name: str, known: bool, *, faster: bool = True) -> Estimate:
    """The estimate on a scale (its usual one if the pad lacks it), at the rate asked for unless not `faster`."""
    model = one.model
    number = next((n for n, scale in enumerate(model.scales) if scale.name == name), 0)
    scale, terms = model.scales[number], (one.played if faster else one.terms)[number]
    meter = scale.start + sum(terms.values())
    billed = sorted(((term, value) for term, value in terms.items() if value >= _WORTH), key=lambda bill: -bill[1])
    rest = meter - sum(value for _, value in billed)
    low, high = _interval(scale, meter)
    if not known:
        low, high = min(low, max(meter - model.alone[0], 0.0)), max(high, meter + model.alone[1])
    return Estimate(meter, low, high, scale.name, known, (*billed, ("rest", rest)), one.rate if faster else 1.0)


# The level of DDR that a chart has, by its label: what its score is estimated from.

_LEVELS = "ddr"
_BELIEVED = 3.0  # meters between a label and the estimate; of a label that is further off only so much is heard


def level_of(one: MeteredChart, scale: str, known: bool) -> Level:
    """The level, from the label by the scale that it is on; where that is a guess, by the one that fits it best.

    one : of a pad that has the scale ddr. A label of 0 is none, so that the estimate alone tells.
    """
    on = one.on
    label = scale if known else min(on, key=lambda name: abs(on[name] - one.label))
    off = min(max(one.label - on[label], -_BELIEVED), _BELIEVED) if one.label > 0 else 0.0
    at = next(n for n, of in enumerate(one.model.scales) if of.name == _LEVELS)
    faster = sum(one.played[at].values()) - sum(one.terms[at].values())
    meter = on[_LEVELS] + off
    if label == _LEVELS and one.label > 0:
        return Level(meter + faster)
    low, high = _interval(one.model.scales[at], meter)
    return Level(meter + faster, meter - low, high - meter)
