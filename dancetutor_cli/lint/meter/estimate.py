"""The estimated meter of a chart with its bill, and the charts of a song together on the scale they are numbered on."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

from dancetutor_cli.chart.model import Song
from dancetutor_cli.lint.findings import AUTO, Estimate, Finding
from dancetutor_cli.lint.meter.features import Feature
from dancetutor_cli.lint.meter.model import MeterModel, Scale, model_for
from dancetutor_cli.lint.rule import RatedChart, SongRule, all_rules
from dancetutor_cli.lint.rule_settings import Settings
from dancetutor_cli.lint.subject import ChartSubject

# The estimated meter of a chart with its bill, on the scale that its song is numbered on.

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


# How hard the charts of a song play, all together: each needs the others to know the scale they are numbered on.


@dataclass(frozen=True, slots=True)
class MeterReport:
    """What is told of one chart: its estimate, and findings of the rules about a song's meters."""

    estimate: Estimate
    findings: tuple[Finding, ...]

    def among(self, others: tuple[Finding, ...]) -> tuple[Finding, ...]:
        """These findings and others of the chart in the order of lines."""
        if not self.findings:
            return others
        return tuple(sorted((*self.findings, *others), key=lambda f: (f.line or 0, f.beat or 0.0, f.rule)))


class Meters:
    """Takes the charts of a song as they are solved; then tells of all."""

    def __init__(self, song: Song, settings: Settings) -> None:
        self._song, self._settings = song, settings
        self._sized: dict[str, list[tuple[int, MeteredChart]]] = defaultdict(list)

    def add(self, subject: ChartSubject, rate: float = 1.0) -> None:
        """Take note of a chart, if its pad has a model of meters and it has steps."""
        chart = subject.chart
        if subject.play is None or not len(subject.step_rows) or chart.player:  # a meter is for both players
            return
        found = subject.sized(rate)
        if found is not None:
            self._sized[chart.steps_type].append((chart.index, found))

    def ask_for_others(self, scale: str = AUTO) -> frozenset[str]:
        """Steps types of which the song's other charts have to tell the scale, for nothing else does."""
        if scale != AUTO or says_scale(self._song.tags.get("METERTYPE", "")):
            return frozenset()
        return frozenset(kind for kind, of_pad in self._sized.items() if len(of_pad[0][1].on) > 1)

    def reports(self, scale: str = AUTO) -> dict[int, MeterReport]:
        """Index of the chart -> what is told of it."""
        out: dict[int, MeterReport] = {}
        for of_pad in self._sized.values():
            one_pad = [sized for _, sized in of_pad]
            scales = scales_of(one_pad, self._song.tags.get("METERTYPE", ""), scale)
            usual = [
                on_scale(one, name, known, faster=False) for one, (name, known) in zip(one_pad, scales, strict=True)
            ]
            here = [self._played(index, estimate) for (index, _), estimate in zip(of_pad, usual, strict=True)]
            sure = [one for one in here if one.estimate.is_scale_known]  # nothing is said where the scale is a guess
            for (index, one), played in zip(of_pad, here, strict=True):
                at_1 = played.estimate
                estimate = at_1 if one.rate == 1.0 else on_scale(one, at_1.scale, at_1.is_scale_known)
                out[index] = MeterReport(estimate, self._findings(played, sure) if at_1.is_scale_known else ())
        return out

    def _played(self, index: int, estimate: Estimate) -> RatedChart:
        """A chart as the rules see it."""
        chart = self._song.charts[index]
        place = {"line": chart.line, "column": 1, "chart": index}
        return RatedChart(chart.steps_type, chart.difficulty, chart.meter, chart.label, estimate, place)

    def _findings(self, here: RatedChart, charts: list[RatedChart]) -> tuple[Finding, ...]:
        rules = self._settings.for_chart(self._song.path, here.steps_type, here.difficulty, here.meter)
        found: list[Finding] = []
        for code, rule in _rules().items():
            if code in rules:
                found += rule(rules[code]).check(here, charts)
        return tuple(found)


@cache
def _rules() -> Mapping[str, type[SongRule]]:
    return {code: rule for code, rule in all_rules().items() if issubclass(rule, SongRule)}
