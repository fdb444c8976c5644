"""Limbs, and what people said about them: overrides and ignores read from annotations and from data.sme."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dancetutor_cli.feet.overrides import FeetProblem, Ignores, Overrides

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song

__all__ = ["FeetProblem", "Ignores", "Overrides", "overrides_for"]


def overrides_for(song: Song, chart: Chart) -> tuple[Overrides, Ignores, tuple[FeetProblem, ...]]:
    """Everything people said about the feet of a chart; to be asked before the chart is solved.

    Pinned measures in the file, overrides in `data.sme` beside it, `feet` in the dancetutor.yaml up the tree; where
    several speak of a cell, the first of these counts.

    Returns the overrides for the solver, the ignores for the linter, and what was contradictory, for findings.
    FileError : dancetutor.yaml cannot be read
    """
    from dancetutor_cli.feet.configured import read_settings
    from dancetutor_cli.feet.contradictions import contradictions
    from dancetutor_cli.feet.pins import pinned
    from dancetutor_cli.feet.sme import read_sme

    pins, problems = pinned(song, chart)
    editor, settings = read_sme(song, chart), read_settings(song, chart)
    said = {(s.tick, s.column): s for s in (*settings.said, *editor.said, *pins)}  # later ones win
    good, contradictory = contradictions(chart, said.values())
    cells = {(s.tick, s.column): (s.limb, s.part) for s in good}
    ignores = Ignores(editor.ignores, settings.ignores or {})
    return Overrides.of(cells), ignores, (*problems, *editor.problems, *settings.problems, *contradictory)
