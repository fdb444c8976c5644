"""DT103: the steps type has no pad, so feet cannot be found."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class NoPad(ChartRule):
    """This steps type has no entry in configs/pads.yaml: the chart is read, but its feet are not known.

    Bad: a kb7-single chart, which is played with fingers.

    Better: add the pad's panels to configs/pads.yaml, or leave such charts out with --steps-type.
    """

    code = "DT103"
    name = "no-pad"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding if there is no play."""
        if subject.play is None:
            message = f"steps type '{subject.chart.steps_type}' has no pad: no feet"
            yield self.finding(message, subject.at_chart())
