"""The estimate of a chart's meter as it is kept and told. Imports no numpy, so that kept results are read quickly."""

from __future__ import annotations

from dataclasses import dataclass

AUTO = "auto"
SCALES = (AUTO, "itg", "ddr", "low")


@dataclass(frozen=True, slots=True)
class Estimate:
    """How hard a chart plays.

    meter : the estimate; low, high : 80 of 100 labels lie between; scale : name of the scale
    known : whether something says that it is this scale: a tag, two other charts of the song, or the user
    terms : (name, meters) of what adds to it, the largest first, then "rest", small ones together; their sum is `meter`
    rate : that it was estimated for
    """

    meter: float
    low: float
    high: float
    scale: str
    known: bool
    terms: tuple[tuple[str, float], ...]
    rate: float = 1.0

    @property
    def bill(self) -> str:
        """For people: "11.4: streams +3.1, crossovers +0.6, rest +0.2"."""
        return f"{self.meter:.1f}: {', '.join(self._told())}"

    def most(self, count: int) -> str:
        """The same with so many terms at most."""
        return f"{self.meter:.1f}: {', '.join(self._told()[:count])}"

    def _told(self) -> list[str]:
        return [f"{name} {meters:+.1f}" for name, meters in self.terms if round(abs(meters), 1) > 0]

    @property
    def span(self) -> str:
        """For people: "10.2 to 12.6 on the scale itg"; what is not known is said."""
        rate = "" if self.rate == 1.0 else f" at rate {self.rate:g}"
        guess = "" if self.known else ", a guess: nothing tells the scale"
        return f"{self.low:.1f} to {self.high:.1f} on the scale {self.scale}{rate}{guess}"
