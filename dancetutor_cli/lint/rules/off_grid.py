"""DT401: a row off the usual grid."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class OffGrid(ChartRule):
    """A note stands where none of the usual quantisations has one, mostly after a conversion or a slip of the mouse.

    `grid`: the quantisations that are usual, as players name them (16 for 16ths). Rows in a run count once.

    Bad (grid = [3]):

        1000  L
        0001  R
        0000
        0000

    Better (grid = [4]):

        1000  L
        0001  R
        0000
        0000
    """

    code = "DT401"
    name = "off-grid"

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """A list of quantisations a measure of 192 ticks can be cut into."""
        fits = option != "grid" or (
            value and all(isinstance(name, int) and name > 0 and 192 % name == 0 for name in value)
        )
        return None if fits else f"a list of divisors of 192, for example [4, 8, 16], not {value}"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each run of such rows, at its first."""
        for tick, line, count in subject.notes.off_grid([int(name) for name in self.options["grid"]]):
            more = f" and {count - 1} more after it" if count > 1 else ""
            yield self.finding(f"this note{more} stands on no {self._names()}", subject.at_tick(tick, line))

    def _names(self) -> str:
        names = [f"{name}{'nd' if name % 10 == 2 and name != 12 else 'th'}" for name in self.options["grid"]]
        return f"{', '.join(names[:-1])} or {names[-1]}"
