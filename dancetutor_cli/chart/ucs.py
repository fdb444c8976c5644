"""Read Andamiro's User Custom Steps (.ucs), a text format of Pump charts: blocks of rows, each with its own tempo.

    :Format=1
    :Mode=Single           or Double; S-Performance and D-Performance use the same pads
    :BPM=150               start of a block: beats per minute
    :Delay=480             milliseconds before its first row; for the first block, from the start of the music
    :Beat=4                beats per measure
    :Split=2               rows per beat
    X....                  a letter for each panel: X a step; M, H, W the head, the body and the end of a hold
    ..M.M

The format has no published specification; its editors and converters agree on this much. A file holds one chart,
without title and meter. The title is the file's name, and the meter is read from that name ("Song S17.ucs").
"""

from __future__ import annotations

import math
import re
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import numpy as np

from dancetutor_cli.chart import msd
from dancetutor_cli.chart.cells import add_warnings
from dancetutor_cli.chart.model import Chart, Kind, MeasureTable, NoteTable, ReadWarning, RowTable, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.chart.timing_tags import MAX_BEAT, parse_number
from dancetutor_cli.run.errors import ChartError

# Lines -> blocks and rows.

_MODES = {
    "single": ("pump-single", 5), "double": ("pump-double", 10),
    "s-performance": ("pump-single", 5), "d-performance": ("pump-double", 10),
}  # fmt: skip
_BLOCK = ("BPM", "Delay", "Beat", "Split")
_NAMES = {name.lower(): name for name in ("Format", "Mode", *_BLOCK)}
_LETTERS = b".XMHW"
_MOST_ROWS = 1_000_000
_FINEST = 1000  # limit of rows per beat, and of beats per measure
_LONGEST = 86_400  # seconds
_OVERTAKEN = Fraction(1, 1000)  # seconds from a block's last note to a next block that would begin before that note
_LEVEL = re.compile(r"(?<![a-z])(?:s|d|sp|dp|hd)(\d{1,2})(?!\d)", re.IGNORECASE)  # in a file's name


@dataclass(slots=True)
class _Block:
    """A block. line : line of its first tag; delay : seconds before its first row; first : index of its first row in
    the file; count : number of rows
    """

    line: int
    bpm: Fraction
    delay: Fraction
    split: int
    first: int
    count: int = 0

    @property
    def row_seconds(self) -> Fraction:
        return 60 / self.bpm / self.split


@dataclass(slots=True)
class _Text:
    """The contents of a file. spans : (line, start, end) of each row; unknown, rowless : lines for warnings"""

    path: Path
    data: bytes
    format: str = ""
    mode: str = ""
    blocks: list[_Block] = field(default_factory=list)
    spans: list[tuple[int, int, int]] = field(default_factory=list)
    unknown: list[int] = field(default_factory=list)
    rowless: list[int] = field(default_factory=list)

    def read(self) -> None:
        """Read the blocks and rows. Raises ChartError for the first line that does not follow the format."""
        head: dict[str, tuple[str, int]] = {}
        pause, lines = Fraction(0), 0
        for line, start, text in _lines(self.data):
            lines = line
            if text.startswith(b":"):
                name, value = self._tag(line, text)
                if name in head:
                    self.rowless.append(line)
                    pause += self._block(head).delay
                    head = {}
                if name in _BLOCK:
                    head[name] = value, line
                continue
            if head:
                self.blocks.append(block := self._block(head))
                block.delay += pause
                pause, head = Fraction(0), {}
            self._row(line, start, text)
        if not self.blocks:
            raise ChartError(self.path, "no charts: the file has no block with rows", max(lines, 1))
        if head:
            self.rowless.append(lines)

    def _tag(self, line: int, text: bytes) -> tuple[str, str]:
        """Return the name and the value of a line `:Name=value`; "" for an unknown name."""
        given, equals, value = msd.decode_text(text[1:], msd.encoding_of(text)).partition("=")
        name, value = _NAMES.get(given.strip().lower(), ""), value.strip()
        if not equals or not given.strip():
            raise ChartError(self.path, f"':{msd.quote(given)}' is not a line like :BPM=150", line)
        if not name:
            self.unknown.append(line)
        elif name == "Format":
            if value != "1":
                raise ChartError(self.path, f"format '{msd.quote(value)}' is unknown; there is :Format=1", line)
            self.format = value
        elif name == "Mode":
            if value.lower() not in _MODES:
                there = "Single, Double, S-Performance, D-Performance"
                raise ChartError(self.path, f"mode '{msd.quote(value)}' is unknown; choose {there}", line)
            if self.spans:
                raise ChartError(self.path, "the mode changes after rows: a file holds one chart", line)
            self.mode = value
        return name, value

    def _block(self, head: dict[str, tuple[str, int]]) -> _Block:
        line = min(line for _, line in head.values())
        if lacking := [f":{name}=" for name in _BLOCK if name not in head]:
            raise ChartError(self.path, f"the block that begins here has no {' and no '.join(lacking)}", line)
        bpm, delay, beat, split = (self._number(name, *head[name]) for name in _BLOCK)
        if bpm <= 0:
            raise ChartError(self.path, f"BPM {float(bpm):g} is not above 0", head["BPM"][1])
        for name, value, most in (("Beat", beat, _FINEST), ("Split", split, _FINEST)):
            if value.denominator != 1 or not 1 <= value <= most:
                raise ChartError(
                    self.path, f":{name}={head[name][0]} is not a whole number from 1 to {most}", head[name][1]
                )
        return _Block(line, bpm, delay / 1000, int(split), len(self.spans))

    def _number(self, name: str, value: str, line: int) -> Fraction:
        """Return a decimal number, with a comma or a point: some editors write a comma."""
        found, clean = parse_number(value.replace(",", "."))
        if not clean:
            raise ChartError(self.path, f":{name}='{msd.quote(value)}' is not a number", line)
        return found

    def _row(self, line: int, start: int, text: bytes) -> None:
        if not (self.format and self.mode and self.blocks):
            lacks = ":Format=1" if not self.format else ":Mode=" if not self.mode else ":BPM=, :Delay=, :Beat=, :Split="
            raise ChartError(self.path, f"'{_shown(text)}' is here, but no {lacks} has come yet", line)
        columns = _MODES[self.mode.lower()][1]
        if wrong := text.strip(_LETTERS):
            column = text.index(wrong[:1])
            raise ChartError(
                self.path, f"'{_shown(wrong[:1])}' is not a step: a row has only . X M H W", line, column + 1
            )
        if len(text) != columns:
            raise ChartError(self.path, f"a row of {len(text)} letters; mode {self.mode} has {columns}", line)
        if len(self.spans) == _MOST_ROWS:
            raise ChartError(self.path, f"more than {_MOST_ROWS} rows", line)
        self.spans.append((line, start, start + len(text)))
        self.blocks[-1].count += 1


def _lines(data: bytes) -> Iterator[tuple[int, int, bytes]]:
    """Yield the number, the offset and the text of each line that is not blank, without surrounding blanks."""
    at = 0
    for line, raw in enumerate(data.splitlines(keepends=True), 1):
        text = raw.lstrip(b" \t\xef\xbb\xbf" if line == 1 else b" \t")
        start = at + len(raw) - len(text)
        at += len(raw)
        if text := text.rstrip():
            yield line, start, text


def _shown(text: bytes) -> str:
    return "".join(chr(one) if 32 <= one < 127 else f"\\x{one:02x}" for one in text[:20])


# Rows -> steps and holds.
#
# Each letter is a panel that is pressed at its row; M, H and W in one column form a hold. Rows of `.` between M and W
# hide the body of a hold and do not end it. A hold without M begins at its first row; one without W ends at its last.


@dataclass(slots=True)
class _Hold:
    first: int
    last: int


@dataclass(slots=True)
class _Steps:
    """The steps of a file. notes : (row, column, kind, row of the end or -1); headless, endless : rows for warnings"""

    notes: list[tuple[int, int, Kind, int]] = field(default_factory=list)
    headless: list[int] = field(default_factory=list)
    endless: list[int] = field(default_factory=list)

    def read(self, rows: Sequence[bytes], columns: int) -> None:
        """Find the steps and holds of all rows."""
        held: dict[int, _Hold] = {}
        empty = b"." * columns
        for row, text in enumerate(rows):
            if text == empty:
                continue
            for column, letter in enumerate(text.decode("ascii")):
                if letter != ".":
                    self._press(row, column, letter, held)
        for column, hold in sorted(held.items()):
            self._cut(column, hold)

    def _press(self, row: int, column: int, letter: str, held: dict[int, _Hold]) -> None:
        hold = held.pop(column, None)
        if letter in "XM" and hold is not None:
            self._cut(column, hold)
            hold = None
        if letter == "X":
            self.notes.append((row, column, Kind.TAP, -1))
            return
        if hold is None:
            hold = _Hold(row, row)
            if letter != "M":
                self.headless.append(row)
        hold.last = row
        if letter == "W":
            self._end(column, hold)
        else:
            held[column] = hold

    def _cut(self, column: int, hold: _Hold) -> None:
        self.endless.append(hold.first)
        self._end(column, hold)

    def _end(self, column: int, hold: _Hold) -> None:
        long = hold.last > hold.first
        self.notes.append((hold.first, column, Kind.HOLD if long else Kind.TAP, hold.last if long else -1))


# Blocks -> ticks and timing. Seconds are exact; beats are those of the file if ticks of 1/48 beat can express them.


@dataclass(slots=True)
class _Clock:
    """The ticks and the timing of a file.

    ticks : tick of each row in which a note begins or ends
    bpms, delays : (tick, value), delays in seconds
    altered : whether a BPM differs from those of the file
    overtaken : lines for warnings
    """

    ticks: dict[int, int] = field(default_factory=dict)
    bpms: list[tuple[int, Fraction]] = field(default_factory=list)
    delays: list[tuple[int, Fraction]] = field(default_factory=list)
    altered: bool = False
    overtaken: list[int] = field(default_factory=list)

    def run(self, blocks: Sequence[_Block], rows: Sequence[int]) -> None:
        """Place the blocks one after the other. rows : rows in which a note begins or ends, ascending"""
        start = 0
        for block, following in zip(blocks, [*blocks[1:], None], strict=True):
            inside = rows[bisect_left(rows, block.first) : bisect_left(rows, block.first + block.count)]
            start = self._lay(block, start, [row - block.first for row in inside], following)

    def _lay(self, block: _Block, start: int, filled: Sequence[int], following: _Block | None) -> int:
        """Place one block, and return the tick of the next one.

        If filled rows do not fall on whole ticks, a beat counts as several beats, at a BPM as many times higher. The
        time after the last filled row, less a negative delay of the next block, has its own BPM. With it, the next
        block begins on a whole tick at its exact time.
        """
        spacing = Fraction(TICKS_PER_BEAT, block.split)
        if any((row * spacing).denominator != 1 for row in filled):
            spacing = Fraction(TICKS_PER_BEAT // math.gcd(TICKS_PER_BEAT, block.split))
        self.ticks.update((block.first + row, start + int(row * spacing)) for row in filled)
        last = filled[-1] if filled else 0
        here = start + int(last * spacing)
        end = max(start + round(block.count * spacing), here + 1)
        rest = (block.count - last) * block.row_seconds
        pause = following.delay if following is not None else Fraction(0)
        if pause < 0:
            rest += pause
            if rest <= 0 and following is not None:
                self.overtaken.append(following.line)
                rest = _OVERTAKEN
        elif pause > 0:
            self.delays.append((end, pause))
        if here > start:
            self._tempo(start, spacing / block.row_seconds, block.bpm)
        self._tempo(here, (end - here) / rest, block.bpm)
        return end

    def _tempo(self, tick: int, ticks_per_second: Fraction, written: Fraction) -> None:
        bpm = 60 * ticks_per_second / TICKS_PER_BEAT
        self.altered |= bpm != written
        if not self.bpms or self.bpms[-1][1] != bpm:
            self.bpms.append((tick, bpm))


def read_ucs(data: bytes, path: Path) -> Song:
    """Read the bytes of a .ucs file. Raises `ChartError`, with a line, for the first violation of the format."""
    text = _Text(path, data)
    text.read()
    steps_type, columns = _MODES[text.mode.lower()]
    steps, clock = _Steps(), _Clock()
    steps.read([data[start:end] for _, start, end in text.spans], columns)
    rows = sorted({row for first, _, _, end in steps.notes for row in (first, end) if row >= 0})
    clock.run(text.blocks, rows)
    timing = _timing(text, clock)
    line_of = np.array([line for line, _, _ in text.spans], dtype=np.int64)
    warnings: list[ReadWarning] = []
    for code, found, message in (
        ("odd-directive", text.unknown, "the game does not know this line; it is ignored"),
        ("odd-timing", text.rowless, "a block ends here without rows; of its tags the delay alone counts"),
        ("odd-timing", clock.overtaken, "this block begins before the notes above it; it is read as 1 ms behind them"),
        ("unmatched-head", line_of[sorted(steps.endless)], "a hold has no end, W; it is read up to its last H"),
        ("unmatched-tail", line_of[sorted(steps.headless)], "a hold has no head, M; it is read from here on"),
    ):
        add_warnings(warnings, code, message, np.asarray(found, dtype=np.int64))
    chart = Chart(
        index=0, steps_type=steps_type, difficulty="Edit", meter=_level(path),
        description=text.mode if "-" in text.mode else "", columns=columns, notes=_note_table(steps, clock, line_of),
        rows=_row_table(text, clock, rows), measures=_measure_table(clock, rows), timing=timing,
        notes_span=(text.spans[0][1], len(data)), line=text.blocks[0].line, tags=_tags(text, clock),
        warnings=tuple(warnings), marked=True,
    )  # fmt: skip
    return Song(
        path=path, format="ucs", data=data, encoding=msd.encoding_of(data), title=msd.one_line(path.stem), subtitle="",
        artist="", music="", tags={}, timing=timing, charts=(chart,), warnings=(),
    )  # fmt: skip


def _level(path: Path) -> int:
    """Return the meter in a file's name, "Song D22.ucs"; 0 if the name has none."""
    found = _LEVEL.findall(path.stem)
    return int(found[-1]) if found else 0


def _timing(text: _Text, clock: _Clock) -> Timing:
    first, last = text.blocks[0], text.blocks[-1]
    length = sum((block.count * block.row_seconds + abs(block.delay) for block in text.blocks), Fraction(0))
    if length > _LONGEST or clock.bpms[-1][0] > MAX_BEAT * TICKS_PER_BEAT:
        raise ChartError(text.path, "is longer than every song: more than a day, or 20 million beats", last.line)
    return Timing(bpms=tuple(clock.bpms), delays=tuple(clock.delays), offset=-first.delay)


def _tags(text: _Text, clock: _Clock) -> dict[str, str]:
    """Return a DISPLAYBPM with the tempos of the file if the timing has other BPMs, else no tags."""
    if not clock.altered:
        return {}
    lasting = [block.bpm for block in text.blocks if 2 * block.count * block.row_seconds >= 1]
    shown = lasting or [block.bpm for block in text.blocks]
    return {"DISPLAYBPM": ":".join(f"{float(bpm):g}" for bpm in sorted({min(shown), max(shown)}))}


def _note_table(steps: _Steps, clock: _Clock, line_of: np.ndarray) -> NoteTable:
    notes = sorted((clock.ticks[row], column, kind, end, row) for row, column, kind, end in steps.notes)
    return NoteTable(
        tick=np.array([note[0] for note in notes], dtype=np.int64),
        column=np.array([note[1] for note in notes], dtype=np.int16),
        kind=np.array([note[2] for note in notes], dtype=np.uint8),
        end=np.array([clock.ticks.get(note[3], -1) for note in notes], dtype=np.int64),
        line=line_of[[note[4] for note in notes]].astype(np.int32),
        judged=np.ones(len(notes), dtype=bool),
    )


def _row_table(text: _Text, clock: _Clock, rows: Sequence[int]) -> RowTable:
    """Return the table of the rows in which a note begins or ends."""
    spans = np.array([text.spans[row] for row in rows], dtype=np.int64).reshape(-1, 3)
    tick = np.array([clock.ticks[row] for row in rows], dtype=np.int64)
    line, start, end = spans[:, 0].astype(np.int32), spans[:, 1], spans[:, 2]
    return RowTable(start, end, line, tick, (tick // TICKS_PER_MEASURE).astype(np.int32))


def _measure_table(clock: _Clock, rows: Sequence[int]) -> MeasureTable:
    """Return measures of four beats; the file does not mark them, so their anchors and lines are 0."""
    ticks = np.array([clock.ticks[row] for row in rows], dtype=np.int64)
    count = int(ticks.max(initial=0)) // TICKS_PER_MEASURE + 1
    nowhere = np.zeros(count, dtype=np.int64)
    return MeasureTable(nowhere, nowhere.astype(np.int32))
