"""The next best plays of a chart in words: which rows other limbs step, and which cost terms decide against them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.feet.notation import letter
from dancetutor_cli.lint.chart_figures import AlternativeResult, DifferentRun
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.play import Play, StepKind, alternatives
from dancetutor_cli.play.preset import Preset


def alternatives_of(subject: ChartSubject, preset: Preset, count: int) -> tuple[AlternativeResult, ...]:
    """The `count` cheapest plays after the one that was found, the cheapest first; fewer if there are no more."""
    play = subject.play
    if play is None or subject.pad is None or count < 1:
        return ()
    best, *others = alternatives(play.rows, subject.pad, preset, count + 1, subject.overrides) or (None,)
    if best is None:
        return ()
    return tuple(
        AlternativeResult(
            other.extra,
            tuple(sorted(other.terms.items(), key=lambda term: (-abs(term[1]), term[0]))),
            tuple(_runs(best.play, other.play, other.rows)),
        )
        for other in others
    )


def _runs(best: Play, other: Play, rows: tuple[int, ...]) -> Iterator[DifferentRun]:
    """The rows that differ, those without a stepped row between them together."""
    stepped = np.flatnonzero(best.rows.steps.any(axis=1))
    places = np.searchsorted(stepped, rows)
    for group in np.split(np.array(rows, dtype=np.int64), np.flatnonzero(np.diff(places) != 1) + 1):
        if len(group):
            beats = best.rows.tick[group[[0, -1]]] / TICKS_PER_BEAT
            letters = (" ".join(_letters(play, row) for row in group.tolist()) for play in (best, other))
            yield DifferentRun(float(beats[0]), float(beats[1]), *letters)


def _letters(play: Play, row: int) -> str:
    """Who steps a row, left to right: "L", "LR"."""
    columns = np.flatnonzero(play.rows.steps[row] != StepKind.NONE).tolist()
    return "".join(letter(int(play.limb[row, column]), int(play.part[row, column])) for column in columns)
