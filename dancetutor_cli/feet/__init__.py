"""Limbs, and what people said about them: overrides and ignores read from annotations and from data.sme."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dancetutor_cli.feet.model import FeetProblem, Ignores, Overrides

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song

__all__ = ["FeetProblem", "Ignores", "Overrides", "overrides_for"]


def overrides_for(song: Song, chart: Chart) -> tuple[Overrides, Ignores, tuple[FeetProblem, ...]]:
    """Everything people said about the feet of a chart; to be asked before the chart is solved.

    Pinned measures in the file and overrides in `data.sme` beside it; where both speak of a cell, the pin counts.

    Returns the overrides for the solver, the ignores for the linter, and what was contradictory, for findings.
    """
    from dancetutor_cli.feet.contradictions import contradictions
    from dancetutor_cli.feet.pins import pinned
    from dancetutor_cli.feet.sme import read_sme

    pins, problems = pinned(song, chart)
    editor = read_sme(song, chart)
    taken = {(s.tick, s.column) for s in pins}
    said = [*pins, *(s for s in editor.said if (s.tick, s.column) not in taken)]
    good, contradictory = contradictions(chart, said)
    cells = {(s.tick, s.column): (s.limb, s.part) for s in good}
    return Overrides.of(cells), Ignores(editor.ignores), (*problems, *editor.problems, *contradictory)
