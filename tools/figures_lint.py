"""Figures of the 435 test charts: how often rules find something, and what presets step."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import lint_table
from figures_base import Figures, corpus, markdown

from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import find_files
from dancetutor_cli.lint.analysis import solve_selected
from dancetutor_cli.lint.run import LintRequest, LintRun
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.run.errors import DancetutorError

MOVES = {
    "crossovers": "crossover", "180° crossovers": "crossover-full", "spins": "spin",
    "unforced doublesteps": "doublestep", "brackets": "bracket", "hand presses": "hand", "unplayable": "unplayable",
}  # fmt: skip
HIGHEST = 7  # meter of the charts that presets are compared on


def rules() -> str:
    """Findings per 100 charts, by rule and meter."""
    return lint_table.table(None, lint_table.kept(corpus()))


def easy_charts(preset: str) -> Iterator[ChartSubject]:
    """The dance-single charts of low meters, with the feet of a preset. Raises MissingError."""
    run = LintRun(LintRequest(config="default", preset=preset))
    for path in find_files([corpus()]):
        try:
            song = load(path)
        except DancetutorError:
            continue
        charts = [one for one in song.charts if one.steps_type == "dance-single" and 1 <= one.meter <= HIGHEST]
        yield from solve_selected(song, charts, run.task(path))


def preset_rows() -> str:
    """Rows with each move, by preset."""
    presets, found, charts = ("itg", "beginner"), Counter[tuple[str, str]](), 0
    for preset in presets:
        charts = 0
        for subject in easy_charts(preset):
            if subject.play is None:
                continue
            charts += 1
            found[preset, "rows"] += len(subject.play.rows)
            for words, move in MOVES.items():
                found[preset, words] += len(subject.rows_with(move))
    rows = [(words, *(f"{found[preset, words]:,}" for preset in presets)) for words in ("rows", *MOVES)]
    rows[0] = (f"all rows, of {charts} charts", *rows[0][1:])
    return markdown(("rows with", *(f"`{preset}`" for preset in presets)), rows)


FIGURES: Figures = {"rules": ("linter.md", rules), "preset-rows": ("presets.md", preset_rows)}
