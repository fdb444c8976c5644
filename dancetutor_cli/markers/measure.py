"""The style `measure`, the default: one `{dt1 ...}` in a comment on the line that opens a measure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from dancetutor_cli.chart.edits import Splice
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.feet.annotations import StepRows, markers_in, measure_lines
from dancetutor_cli.feet.limbs import NotationError, marker_text, parse_marker
from dancetutor_cli.markers.model import ChartFeet, CheckLine, NoteChange


class State(Enum):
    """The state of a measure's marker compared with the solved feet."""

    CURRENT = "current"
    MISSING = "missing"
    STALE = "stale"  # the tokens do not fit the rows
    DIFFERENT = "different"  # the tokens fit, but with other feet
    PINNED = "pinned"
    IMPOSSIBLE = "impossible"  # the line of the comma has rows


@dataclass(frozen=True, slots=True)
class MeasureState:
    """One measure that has a marker or should have one. line : 1-based line of the comment."""

    measure: int
    line: int
    state: State


_WORDS = {
    State.MISSING: "have no feet yet",
    State.STALE: "have feet that no longer fit their rows",
    State.DIFFERENT: "have other feet than the solver finds",
}


def write(song: Song, feet: ChartFeet, force: bool) -> NoteChange:
    """Update the markers of a chart. One line for each kind of missing or stale marker gives the first measure."""
    chart = feet.chart
    splices, states = _updates(song.data, feet, force)
    change = NoteChange(splices, Counter(one.state.value for one in states))
    by_state = {state: [one for one in states if one.state is state] for state in State}
    for state, text in _WORDS.items():
        if found := by_state[state]:
            number = f"{len(found)} measures" if len(found) > 1 else f"measure {found[0].measure}"
            text = text if len(found) > 1 else text.replace("have", "has", 1)
            change.lacks.append(CheckLine(f"{chart.label}: {number} {text}", found[0].line))
    if found := by_state[State.IMPOSSIBLE]:
        single = len(found) == 1
        text = "1 measure begins on the line of its" if single else f"{len(found)} measures begin on the line of their"
        left = "it is" if single else "they are"
        change.notes.append(f"{song.path}:{found[0].line}: {chart.label}: {text} comma; {left} left alone")
    return change


def strip(song: Song, chart: Chart, force: bool) -> NoteChange:
    """Remove the markers of a chart, and count the pinned ones, which stay without `force`."""
    left = 0 if force else count_pinned(song.data, chart)
    splices = []
    for line in measure_lines(song.data, chart):
        comment = song.data[line.start : line.end]
        new = _without(comment, force)
        if new != comment:
            splices.append(Splice(line.start, line.end, new))
    return NoteChange(splices, Counter(pinned=left))


def _updates(data: bytes, feet: ChartFeet, force: bool) -> tuple[list[Splice], list[MeasureState]]:
    """Return the replacements that update the markers of a chart, and the old state of each measure.

    data : the bytes of the chart's file
    """
    chart, wanted = feet.chart, _by_measure(feet.chart, feet.rows, feet.letters)
    splices, states = [], []
    for line in measure_lines(data, chart):
        comment = data[line.start : line.end]
        tokens = wanted.pop(line.measure, None)
        if not comment and tokens is None:
            continue
        state = _state(comment, tokens, force)
        if state is not None:
            states.append(MeasureState(line.measure, int(chart.measures.line[line.measure]), state))
        if state in (State.PINNED, None):
            continue
        new = _with(comment, marker_text(tokens), force) if tokens else _without(comment, force)
        if new != comment:
            splices.append(Splice(line.start, line.end, new))
    states += (MeasureState(m, int(chart.measures.line[m]), State.IMPOSSIBLE) for m in wanted)
    return splices, states


def count_pinned(data: bytes, chart: Chart) -> int:
    """Return the number of pinned measures of a chart."""
    comments = (data[line.start : line.end] for line in measure_lines(data, chart))
    return sum(any(match["pin"] for match in markers_in(comment)) for comment in comments)


def _by_measure(chart: Chart, rows: StepRows, letters: Sequence[str]) -> dict[int, list[str]]:
    wanted: dict[int, list[str]] = {}
    for measure, text in zip(chart.rows.measure[rows.row].tolist(), letters, strict=True):
        wanted.setdefault(measure, []).append(text)
    return wanted


def _state(comment: bytes, tokens: list[str] | None, force: bool) -> State | None:
    """Return the state of a comment's marker; None: there is no marker, and none is needed."""
    found = markers_in(comment)
    if not found:
        return State.MISSING if tokens else None
    if not force and any(m["pin"] for m in found):
        return State.PINNED
    if tokens and len(found) == 1 and found[0][0] == marker_text(tokens):
        return State.CURRENT
    try:
        shape = [len(token.letters) for token in parse_marker(found[0]["text"])]
    except NotationError:
        return State.STALE
    return State.DIFFERENT if tokens and shape == [len(text) for text in tokens] else State.STALE


def _with(comment: bytes, text: bytes, force: bool) -> bytes:
    """Return the comment with one marker: its first marker is replaced, or a marker is added."""
    found = markers_in(comment)
    if not found:
        return comment + b" " + text if comment else b"//" + text
    first = found[0]
    rest = comment[first.end() :]
    if len(found) > 1:
        rest = _without(b"//" + rest, force)[2:]
    return comment[: first.start()] + text + rest


def _without(comment: bytes, force: bool) -> bytes:
    """Return the comment without markers; b"" if it had only markers."""
    while ours := [match for match in markers_in(comment) if force or not match["pin"]]:
        comment = _cut(comment, *ours[-1].span())  # the parts around a removed marker may form another marker
    return comment


def _cut(comment: bytes, start: int, end: int) -> bytes:
    """Remove one marker and the blank between it and other text from a comment."""
    before, after = comment[:start], comment[end:]
    if before == b"//" and not after.strip(b" \t"):
        return after
    if before.endswith(b" "):
        return before[:-1] + after
    return before + after.removeprefix(b" ")
