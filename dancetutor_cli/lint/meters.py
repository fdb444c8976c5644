"""How hard the charts of a song play, all together: each needs the others to know the scale they are numbered on."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from dancetutor_cli.chart.model import Song
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.lint.registry import all_rules
from dancetutor_cli.lint.rule import Played, SongRule
from dancetutor_cli.lint.rule_settings import Settings
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.meter.bill import AUTO, Estimate
from dancetutor_cli.meter.estimate import Sized, on_scale, says_scale, scales_of


@dataclass(frozen=True, slots=True)
class Told:
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
        self._sized: dict[str, list[tuple[int, Sized]]] = defaultdict(list)

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

    def told(self, scale: str = AUTO) -> dict[int, Told]:
        """Index of the chart -> what is told of it."""
        out: dict[int, Told] = {}
        for of_pad in self._sized.values():
            one_pad = [sized for _, sized in of_pad]
            scales = scales_of(one_pad, self._song.tags.get("METERTYPE", ""), scale)
            usual = [
                on_scale(one, name, known, faster=False) for one, (name, known) in zip(one_pad, scales, strict=True)
            ]
            here = [self._played(index, estimate) for (index, _), estimate in zip(of_pad, usual, strict=True)]
            sure = [one for one in here if one.estimate.known]  # nothing is said where the scale is a guess
            for (index, one), played in zip(of_pad, here, strict=True):
                at_1 = played.estimate
                estimate = at_1 if one.rate == 1.0 else on_scale(one, at_1.scale, at_1.known)
                out[index] = Told(estimate, self._findings(played, sure) if at_1.known else ())
        return out

    def _played(self, index: int, estimate: Estimate) -> Played:
        """A chart as the rules see it."""
        chart = self._song.charts[index]
        place = {"line": chart.line, "column": 1, "chart": index}
        return Played(chart.steps_type, chart.difficulty, chart.meter, chart.label, estimate, place)

    def _findings(self, here: Played, charts: list[Played]) -> tuple[Finding, ...]:
        rules = self._settings.for_chart(self._song.path, here.steps_type, here.difficulty, here.meter)
        found: list[Finding] = []
        for code, rule in _rules().items():
            if code in rules:
                found += rule(rules[code]).check(here, charts)
        return tuple(found)


@cache
def _rules() -> Mapping[str, type[SongRule]]:
    return {code: rule for code, rule in all_rules().items() if issubclass(rule, SongRule)}
