"""Technical steps of a chart by the names and rules of ITGmania (see `techniques`), and how far she faces away."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.lint.chart_figures import TECH_COUNTS
from dancetutor_cli.lint.subject import ChartSubject


def tech_counts(subject: ChartSubject) -> dict[str, int]:
    """How often each of `TECH_COUNTS` happens; all 0 for a chart without a play."""
    if subject.play is None or subject.pad is None:
        return dict.fromkeys(TECH_COUNTS, 0)
    return subject.shared.candidates.tech_counts[subject.shared.number]


def tech_rows(subject: ChartSubject) -> dict[str, NDArray[np.int64]]:
    """The rows of the play that are counted as each of `TECH_COUNTS`, one for each time, in order."""
    if subject.play is None or subject.pad is None:
        return {name: np.zeros(0, dtype=np.int64) for name in TECH_COUNTS}
    candidates, number = subject.shared
    return {name: candidates.plays.own(np.sort(candidates.techniques[name]), number) for name in TECH_COUNTS}


def facing_counts(subject: ChartSubject) -> tuple[int, ...]:
    """Rows with a step by how far she faces away from the screen, see `Figures.facing`; () without a play."""
    if subject.play is None or subject.pad is None:
        return ()
    return subject.shared.candidates.facing_counts[subject.shared.number]
