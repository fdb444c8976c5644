"""How hard the charts of a song are, all together, because the scale of each chart depends on the others."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from dancetutor_cli.chart.model import Song
from dancetutor_cli.lint.findings import AUTO, Estimate, Finding, ScoreEstimate
from dancetutor_cli.lint.meter.estimate import MeteredChart, label_scales_of, level_of, on_scale, scales_of
from dancetutor_cli.lint.meter.score import Oddities, score_model_for
from dancetutor_cli.lint.rule import RatedChart, SongRule, all_rules
from dancetutor_cli.lint.rule_settings import Settings
from dancetutor_cli.lint.subject import ChartSubject


@dataclass(frozen=True, slots=True)
class MeterReport:
    """The report on one chart: its estimates, and the findings of rules about the meters of a song."""

    estimate: Estimate
    score: ScoreEstimate | None
    findings: tuple[Finding, ...]

    def with_findings(self, others: tuple[Finding, ...]) -> tuple[Finding, ...]:
        """Return these findings and others of the chart, in order of lines."""
        if not self.findings:
            return others
        return tuple(sorted((*self.findings, *others), key=lambda f: (f.line or 0, f.beat or 0.0, f.rule)))


@dataclass(frozen=True, slots=True)
class _SongChart:
    """A chart that waits for the others of its song. oddities : None on a pad without a score model"""

    index: int
    sized: MeteredChart
    oddities: Oddities | None


class Meters:
    """Collects the charts of a song as they are solved, then reports on all of them."""

    def __init__(self, song: Song, settings: Settings) -> None:
        self._song, self._settings = song, settings
        self._sized: dict[str, list[_SongChart]] = defaultdict(list)

    def add(self, subject: ChartSubject, rate: float = 1.0) -> None:
        """Add a chart, if its pad has a meter model and the chart has steps."""
        chart = subject.chart
        if subject.play is None or not len(subject.step_rows) or chart.player:  # a meter is for both players together
            return
        found = subject.metered_chart(rate)
        if found is not None:
            oddities = subject.oddities() if score_model_for(chart.steps_type) else None
            self._sized[chart.steps_type].append(_SongChart(chart.index, found, oddities))

    def ask_for_others(self, scale: str = AUTO) -> frozenset[str]:
        """Return the steps types whose scale only the song's other charts can set."""
        if scale != AUTO:
            return frozenset()
        return frozenset(kind for kind, of_pad in self._sized.items() if len(of_pad[0].sized.on) > 1)

    def reports(self, scale: str = AUTO) -> dict[int, MeterReport]:
        """Return index of the chart -> its report."""
        out: dict[int, MeterReport] = {}
        tag = self._song.tags.get("METERTYPE", "")
        for steps_type, of_pad in self._sized.items():
            one_pad = [one.sized for one in of_pad]
            scales = scales_of(one_pad, tag, scale)
            usual = [
                on_scale(one, name, known, faster=False) for one, (name, known) in zip(one_pad, scales, strict=True)
            ]
            here = [self._rated_chart(one.index, estimate) for one, estimate in zip(of_pad, usual, strict=True)]
            sure = [one for one in here if one.estimate.is_scale_known]  # no findings if the scale is a guess
            labels = label_scales_of(one_pad, tag, scale)
            for one, played, label_scale in zip(of_pad, here, labels, strict=True):
                at_1 = played.estimate
                own = at_1 if one.sized.rate == 1.0 else on_scale(one.sized, at_1.scale, at_1.is_scale_known)
                findings = self._check_meter(played, sure) if at_1.is_scale_known else ()
                out[one.index] = MeterReport(own, _score(steps_type, one, label_scale), findings)
        return out

    def _rated_chart(self, index: int, estimate: Estimate) -> RatedChart:
        """Return a chart as the rules receive it."""
        chart = self._song.charts[index]
        place = {"line": chart.line, "column": 1, "chart": index}
        return RatedChart(chart.steps_type, chart.difficulty, chart.meter, chart.label, estimate, place)

    def _check_meter(self, here: RatedChart, charts: list[RatedChart]) -> tuple[Finding, ...]:
        rules = self._settings.for_chart(self._song.path, here.steps_type, here.difficulty, here.meter)
        found: list[Finding] = []
        for code, rule in _rules().items():
            if code in rules:
                found += rule(rules[code]).check(here, charts)
        return tuple(found)


def _score(steps_type: str, one: _SongChart, label_scale: str) -> ScoreEstimate | None:
    """Return how hard a chart is to score on, by the scale of its label; None without a score model."""
    model = score_model_for(steps_type)
    if model is None or one.oddities is None:
        return None
    return model.estimate(steps_type, level_of(one.sized, label_scale), one.oddities)


@cache
def _rules() -> Mapping[str, type[SongRule]]:
    return {code: rule for code, rule in all_rules().items() if issubclass(rule, SongRule)}
