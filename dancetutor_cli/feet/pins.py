"""Pinned measures, `{dt1! ...}`: the author's own feet, read from the comments of a chart file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.feet.contradictions import Said, contradictions
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.measures import markers_in, measure_lines, step_rows
from dancetutor_cli.feet.notation import MEANING, NotationError, Token, parse
from dancetutor_cli.feet.overrides import FeetProblem, Overrides


@dataclass(frozen=True, slots=True)
class _Pin:
    """One pinned measure. offset : of its letters in the file."""

    measure: int
    line: int
    offset: int
    text: bytes


def read_pins(song: Song, chart: Chart) -> tuple[Overrides, tuple[FeetProblem, ...]]:
    """The feet that the author has pinned in a chart, and what is contradictory in them.

    A measure whose letters do not fit its rows is left out as a whole; of the others only rows that contradict
    themselves or what came before.
    """
    said, problems = pinned(song, chart)
    good, contradictory = contradictions(chart, said)
    cells = {(s.tick, s.column): (s.limb, s.part) for s in good}
    return Overrides.of(cells), (*problems, *contradictory)


def pinned(song: Song, chart: Chart) -> tuple[list[Said], list[FeetProblem]]:
    """Every pinned cell as it stands, and the measures that could not be read."""
    pins = list(_pins(song.data, chart))
    if not pins:
        return [], []
    rows = step_rows(song.data, chart)
    by_measure: dict[int, list[int]] = {}
    for i, measure in enumerate(chart.rows.measure[rows.row].tolist()):
        by_measure.setdefault(measure, []).append(i)
    said: list[Said] = []
    problems: list[FeetProblem] = []
    for pin in pins:
        line_start = song.data.rfind(b"\n", 0, pin.offset) + 1
        column = pin.offset - line_start + 1
        mine = by_measure.get(pin.measure, [])
        columns = [rows.steps[i].nonzero()[0].tolist() for i in mine]
        try:
            tokens = parse(pin.text)
            _check_shape(tokens, columns)
        except NotationError as error:
            text = f"pinned measure {pin.measure}: {error}; the pin is not used"
            problems.append(FeetProblem("pin-unreadable", text, pin.line, column + error.at))
            continue
        ticks = chart.rows.tick[rows.row[mine]].tolist()
        for tick, token, cells in zip(ticks, tokens, columns, strict=True):
            said += _said(tick, token, cells, pin.line, column)
    return said, problems


def has_pins(data: bytes, chart: Chart) -> bool:
    """Whether there may be a pinned measure in a chart."""
    return data.find(b"{dt1!", *chart.notes_span) >= 0


def _pins(data: bytes, chart: Chart) -> Iterator[_Pin]:
    if not has_pins(data, chart):
        return
    for line in measure_lines(data, chart):
        for match in markers_in(data[line.start : line.end]):
            if match["pin"]:
                number = int(chart.measures.line[line.measure])
                yield _Pin(line.measure, number, line.start + match.start("text"), match["text"])


def _check_shape(tokens: list[Token], columns: list[list[int]]) -> None:
    """As many tokens as rows, and in each as many letters as steps; else NotationError at the first that is wrong."""
    if len(tokens) != len(columns):
        at = tokens[len(columns)].at if len(tokens) > len(columns) else 0
        raise NotationError(f"{len(tokens)} tokens for {len(columns)} rows with steps", at)
    for number, (token, cells) in enumerate(zip(tokens, columns, strict=True), 1):
        if len(token.letters) != len(cells):
            text = f"row {number} of its rows with steps has {len(cells)} of them, and {len(token.letters)} letters"
            raise NotationError(text, token.at)


def _said(tick: int, token: Token, columns: list[int], line: int, start: int) -> Iterator[Said]:
    """What one token says. start : column of the marker's text in its line"""
    for letter, place, column in zip(token.letters, token.places, columns, strict=True):
        if letter in MEANING:
            limb, part = MEANING[letter]
            if part is Part.WHOLE and limb in _TOE and _TOE[limb] in token.letters:
                part = Part.HEEL
            yield Said(tick, column, limb, part, "pinned", line, start + place)


_TOE = {Limb.LEFT_FOOT: "l", Limb.RIGHT_FOOT: "r"}
