"""DT510: a difficulty that plays easier than one below it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import RatedChart, SongRule


class OrderOfPlay(SongRule):
    """A difficulty plays easier than one that is easier by name, whatever their meters say (DT503 reads those).

    `by`: how many meters easier, at least.

    Bad: a Medium that plays like 7, a Hard that plays like 5. Better: the two exchanged.
    """

    code = "DT510"
    name = "order-of-play"

    _ORDER = ("Beginner", "Easy", "Medium", "Hard", "Challenge")

    def check(self, chart: RatedChart, charts: Sequence[RatedChart]) -> Iterable[Finding]:
        """One finding for the hardest of the easier difficulties that plays harder."""
        if chart.difficulty not in self._ORDER:
            return
        rank = self._ORDER.index(chart.difficulty)
        below = [one for one in charts if one.difficulty in self._ORDER[:rank]]
        hardest = max(below, key=lambda one: one.estimate.meter, default=None)
        if hardest is not None and hardest.estimate.meter - chart.estimate.meter >= self.options["by"]:
            here, there = f"{chart.estimate.meter:.1f}", f"{hardest.estimate.meter:.1f}"
            message = f"plays like {here}, easier than {hardest.label}: that plays like {there}"
            yield self.finding(message, chart.place)
