"""The report on a chart besides findings: other ways to play it, causes of doublesteps, technique counts, excerpts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import Part, letter
from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.play import Play, StepKind
from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.feet.solver.alternatives import alternatives, doublestep_causes
from dancetutor_cli.lint.findings import TECH_COUNTS, AlternativeResult, Cause, DifferentRun, ExcerptRow, Finding
from dancetutor_cli.lint.subject import ChartSubject

# The next best plays of a chart as plain data: the rows that other limbs step, and the cost terms that differ.


def alternatives_of(subject: ChartSubject, preset: Preset, count: int) -> tuple[AlternativeResult, ...]:
    """Return the `count` cheapest plays after the best play, the cheapest first; fewer if there are no more."""
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
    """Yield the runs of rows that differ. Rows with no other stepped row between them make one run."""
    stepped = np.flatnonzero(best.rows.steps.any(axis=1))
    places = np.searchsorted(stepped, rows)
    for group in np.split(np.array(rows, dtype=np.int64), np.flatnonzero(np.diff(places) != 1) + 1):
        if len(group):
            beats = best.rows.tick[group[[0, -1]]] / TICKS_PER_BEAT
            letters = (" ".join(_letters(play, row) for row in group.tolist()) for play in (best, other))
            yield DifferentRun(float(beats[0]), float(beats[1]), *letters)


def _letters(play: Play, row: int) -> str:
    """Return the letters of the limbs that step a row, left to right: "L", "LR"."""
    columns = np.flatnonzero(play.rows.steps[row] != StepKind.NONE).tolist()
    return "".join(letter(int(play.limb[row, column]), int(play.part[row, column])) for column in columns)


# The causes of the doublesteps of a chart, as plain data and in words.

_DOUBLESTEP = "DT201"


def causes_of(subject: ChartSubject, preset: Preset) -> tuple[Cause, ...]:
    """Return the cause of every doublestep of a chart, forced or unforced, in order of rows."""
    play = subject.play
    if play is None or subject.pad is None:
        return ()
    beats = (play.rows.tick / TICKS_PER_BEAT).tolist()
    return tuple(
        Cause(
            round(beats[one.row], 6),
            one.forced,
            one.cause,
            round(beats[one.cause_row], 6) if one.cause_row >= 0 else None,
            one.cause_column if one.cause_column >= 0 else None,
        )
        for one in doublestep_causes(play, subject.pad, preset)
    )


def with_causes(findings: Sequence[Finding], causes: Sequence[Cause], panels: Sequence[str]) -> tuple[Finding, ...]:
    """Return the findings. A finding about a doublestep names its cause, unless the cause is the pattern itself."""
    by_beat = {cause.beat: cause for cause in causes if cause.at_beat is not None and cause.column is not None}
    results = []
    for finding in findings:
        cause = by_beat.get(round(finding.beat, 6)) if finding.beat is not None else None
        if finding.rule == _DOUBLESTEP and cause is not None and cause.column is not None:
            where = f"on beat {round(cause.at_beat or 0.0, 3):g}"
            where += f" ({panels[cause.column]})" if cause.cause != "jump" else ""
            finding = replace(finding, message=f"{finding.message}, because of the {cause.cause} {where}")
        results.append(finding)
    return tuple(results)


# Technical steps of a chart by the names and rules of ITGmania (see `techniques`), and how far the dancer faces away.


def tech_counts(subject: ChartSubject) -> dict[str, int]:
    """Return how often each of `TECH_COUNTS` happens; all 0 for a chart without a play."""
    if subject.facts is None:
        return dict.fromkeys(TECH_COUNTS, 0)
    return subject.facts.own(subject.facts.candidates.tech_counts)


def hand_rows(subject: ChartSubject) -> list[int]:
    """Return the rows with a step in which a hand presses or three panels are down, as the games and DT302 count."""
    facts = subject.facts
    return [] if facts is None else sorted({*subject.rows_with("hand"), *facts.own(facts.candidates.triples)})


def tech_rows(subject: ChartSubject) -> dict[str, NDArray[np.int64]]:
    """Return the rows of the play that count as each of `TECH_COUNTS`, one row for each occurrence, in order."""
    if subject.facts is None:
        return {name: np.zeros(0, dtype=np.int64) for name in TECH_COUNTS}
    candidates, number = subject.facts.candidates, subject.facts.number
    return {name: candidates.plays.own(np.sort(candidates.techniques[name]), number) for name in TECH_COUNTS}


def facing_counts(subject: ChartSubject) -> tuple[int, ...]:
    """Return the number of rows by how far the dancer is turned away (`Figures.facing`); () without a play."""
    return () if subject.facts is None else subject.facts.own(subject.facts.candidates.facing_counts)


# The rows around a finding, which are shown below it.

ROWS = 4
_BEFORE = 2
_NOTES = np.frombuffer(b" 1L244", dtype=np.uint8)  # by StepKind: nothing, tap, lift, hold, roll, tap of a roll
_MINE, _HELD = b"M|"
_LETTERS = np.frombuffer(b"? LR<> lr<>", dtype=np.uint8)  # by Limb, from -2 on; the last five are letters of toes
_TOE = int(Part.TOE)
_ARROWS = {(-1, 0): "←", (0, -1): "↓", (0, 1): "↑", (1, 0): "→", (-1, -1): "↙", (-1, 1): "↖", (0, 0): "■",
           (1, 1): "↗", (1, -1): "↘"}  # fmt: skip


def with_excerpts(findings: Sequence[Finding], play: Play) -> tuple[Finding, ...]:
    """Return the findings; those with a beat have up to four rows around it, two of them before it."""
    ticks = np.array([round(finding.beat * TICKS_PER_BEAT) for finding in findings if finding.beat is not None])
    if not len(ticks) or not len(play.rows):
        return tuple(findings)
    at = play.rows.tick.searchsorted(ticks)
    first = np.maximum(np.minimum(at - _BEFORE, len(play.rows) - ROWS), 0).tolist()
    here = np.where(play.rows.tick[np.minimum(at, len(play.rows) - 1)] == ticks, at, -1).tolist()
    count = min(ROWS, len(play.rows))
    shown = np.array(sorted({row + more for row in first for more in range(count)}), dtype=np.int64)
    drawn = dict(zip(shown.tolist(), _excerpt_rows(play, shown), strict=True))
    excerpts = (
        tuple([drawn[row]._replace(here=True) if row == this else drawn[row] for row in range(start, start + count)])
        for start, this in zip(first, here, strict=True)
    )
    return tuple([f if f.beat is None else f.with_excerpt(next(excerpts)) for f in findings])


def _excerpt_rows(play: Play, shown: NDArray[np.int64]) -> Iterator[ExcerptRow]:
    """Yield some rows of the play with `here` false; the caller marks the row of the finding."""
    rows, c = play.rows, play.limb.shape[1]
    kinds = rows.steps[shown]
    notes = np.where(kinds > 0, _NOTES[kinds], np.where(rows.mines[shown], _MINE, _hold_characters(play, shown)))
    toes = 5 * (play.part[shown] == _TOE)
    letters = np.where(kinds > 0, _LETTERS[play.limb[shown] + 2 + toes], ord(" "))
    note_text, limb_text = (array.astype(np.uint8).tobytes().decode("ascii") for array in (notes, letters))
    for place, tick in enumerate(rows.tick[shown].tolist()):
        cells = slice(place * c, place * c + c)
        yield ExcerptRow(round(tick / TICKS_PER_BEAT, 6), note_text[cells], limb_text[cells], here=False)


def _hold_characters(play: Play, shown: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return, for each cell of some rows, the character of a hold that is down from a row before, or a blank."""
    rows = play.rows
    out = np.full((len(shown), play.limb.shape[1]), ord(" "))
    for column in np.flatnonzero((rows.hold_end >= 0).any(axis=0)).tolist():
        ends = rows.hold_end[:, column]
        heads = np.flatnonzero(ends >= 0)
        before = heads.searchsorted(shown) - 1
        down = (before >= 0) & (ends[heads[before]] > rows.tick[shown])
        out[down, column] = _HELD
    return out


def arrows(pad: Pad) -> str:
    """Return a sign for each panel of a pad, in the direction of its arrow."""
    return _arrows(tuple(map(tuple, pad.arrows.tolist())))


@lru_cache(maxsize=64)
def _arrows(ways: tuple[tuple[float, ...], ...]) -> str:
    return "".join(_ARROWS.get((int(np.sign(x)), int(np.sign(y))), "■") for x, y in ways)
