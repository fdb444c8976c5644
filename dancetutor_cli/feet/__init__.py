"""Limbs, and what people said about them: overrides and ignores read from annotations and from data.sme."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from dancetutor_cli.feet.overrides import FeetProblem, Ignores, Overrides

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.feet.contradictions import Said

__all__ = ["FeetProblem", "Ignores", "Overrides", "SongFeet", "overrides_for"]


Told = tuple[Overrides, Ignores, tuple[FeetProblem, ...]]


def overrides_for(song: Song, chart: Chart) -> Told:
    """Everything people said about the feet of a chart, see `SongFeet.told`."""
    return SongFeet(song).told(chart)


class SongFeet:
    """Everything people said about the feet of a song's charts; where it may stand is looked up once for all."""

    def __init__(self, song: Song) -> None:
        from dancetutor_cli.feet.sme import editor_file
        from dancetutor_cli.library.settings_file import find_settings_file

        self._song = song
        self._editor = editor_file(song.path)
        self._settings = find_settings_file(song.path.parent)

    def told(self, chart: Chart) -> Told:
        """What was said about a chart; to be asked before the chart is solved.

        Pinned measures in the file, overrides in `data.sme` beside it, `feet` in the dancetutor.yaml up the tree; where
        several speak of a cell, the first of these counts.

        Returns the overrides for the solver, the ignores for the linter, and what was contradictory, for findings.
        FileError : dancetutor.yaml cannot be read
        """
        from dancetutor_cli.chart.players import shares_rows
        from dancetutor_cli.feet.configured import read_settings
        from dancetutor_cli.feet.contradictions import contradictions
        from dancetutor_cli.feet.pins import has_pins, pinned
        from dancetutor_cli.feet.sme import ChartData, read_sme

        song = self._song
        whole = chart if chart.written is None else chart.written  # people speak of a chart as it stands in the file
        in_file = whole if shares_rows(chart) else chart
        if self._editor is None and self._settings is None and not has_pins(song.data, in_file):
            return Overrides.none(), Ignores(), ()
        pins, problems = pinned(song, in_file)
        editor = ChartData() if self._editor is None else read_sme(song, whole)
        settings = read_settings(song, whole, self._settings)
        told = (*settings.said, *editor.said, *pins)
        said = {
            (s.tick, s.column): s for s in (told if chart.written is None else _of_player(chart, told))
        }  # later win
        good, contradictory = contradictions(chart, said.values())
        if chart.player > 1:  # what is wrong beside the notes is told with the first player's
            editor, settings = replace(editor, problems=()), replace(settings, problems=())
            problems = [] if shares_rows(chart) else problems
        cells = {(s.tick, s.column): (s.limb, s.part) for s in good}
        ignores = Ignores(editor.ignores, settings.ignores or {})
        return Overrides.of(cells), ignores, (*problems, *editor.problems, *settings.problems, *contradictory)


def _of_player(chart: Chart, said: Iterable[Said]) -> Iterator[Said]:
    """What is about the notes of one of two players, in this player's columns."""
    mine = set(zip(chart.notes.tick.tolist(), chart.notes.column.tolist(), strict=True))
    for one in said:
        column = one.column - chart.first_column
        if (one.tick, column) in mine:
            yield replace(one, column=column)
