"""The hash by which GrooveStats, ITL and other leaderboards identify a chart, computed from its file.

    hash = first 16 hexadecimal digits of SHA-1(minimised rows + normalised BPMs)

The hash depends only on notes and BPMs: a mirrored chart, or a chart at another tempo, has another hash. Titles,
offset, stops, comments, blanks and line breaks do not change it.

Source: chart hash version 3, as themes for StepMania 5 and ITGmania compute it from the text of a file. Newer releases
of ITGmania compute it in the engine from the parsed notes and BPMs. It is not known whether that hash is the same for
every file. Here, as in the engine, no comment ends the notes; in those themes a comment with a `;` does, see
`hash_input`.
"""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Iterator
from functools import lru_cache

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import is_lights
from dancetutor_cli.run.errors import DancetutorError

DIGITS = 16  # number of hexadecimal digits of the hash
COMMENT = re.compile(rb"//[^\n]*")
_BLANKS = b" \t\r\f\v"
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)


class HashError(DancetutorError):
    """A chart that cannot be hashed."""


def chart_hash(song: Song, chart: Chart) -> str | None:
    """Return the hash of a chart, in lower case; None for lights, and if its file has no BPM.

    In a chart for several players, each player's part has the hash of the whole chart.
    """
    whole = chart.written or chart
    bpms = normalised_bpms(whole.tags.get("BPMS", "")) or normalised_bpms(song.tags.get("BPMS", ""))
    if not bpms or not whole.columns or is_lights(whole.steps_type):
        return None
    return hash_of(song.data[slice(*whole.notes_span)], whole.columns, bpms)


def hash_of(note_data: bytes, columns: int, bpms: str) -> str:
    """Return the hash of note data as written in the file, between `:` and `;`. bpms : from `normalised_bpms`"""
    text = minimised(note_data, columns) + bpms.encode("ascii")
    return hashlib.sha1(text, usedforsecurity=False).hexdigest()[:DIGITS]


def hash_input(song: Song, chart: Chart) -> bytes:
    """Return the text that themes without the engine's hash take for a chart's notes, before they shorten the measures.

    They look for its end before they drop comments: at a `;`, and in .sm also at a `:`, even in a comment. The engine
    hashes all notes, and so does `chart_hash`; no edit may change what either of them sees.
    """
    end = rb"[:;]" if song.format == "sm" else b";"
    return _without_comments(re.split(end, song.data[slice(*chart.notes_span)], maxsplit=1)[0])


def minimised(note_data: bytes, columns: int) -> bytes:
    """Return each measure in the fewest rows that hold its notes, one row per line, with a line `,` between measures.

    Rows are cut to the columns of the pad; shorter lines are not rows. Measures without notes stay, even at the end.
    """
    if columns < 1:
        raise HashError(f"{columns} columns: a chart has at least one")
    lines: list[bytes] = []
    for number, measure in enumerate(_measures(note_data, columns)):
        if number:
            lines.append(b",")
        lines += _fewest(measure, b"0" * columns)
    return b"\n".join(lines)


def _measures(note_data: bytes, columns: int) -> Iterator[list[bytes]]:
    """Yield the rows of each measure.

    A line that begins with `,` ends a measure; a line that begins with `;` ends the chart.
    """
    measure: list[bytes] = []
    for line in _without_comments(note_data).split(b"\n"):
        if line.startswith(b","):
            yield measure
            measure = []
        elif line.startswith(b";"):
            break
        elif len(line) >= columns and not line.startswith(b"/"):
            measure.append(line[:columns])
    yield measure


def _without_comments(note_data: bytes) -> bytes:
    """Drop comments and blanks; each line end becomes LF."""
    text = note_data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return (COMMENT.sub(b"", text) if b"//" in text else text).translate(None, _BLANKS)


def _fewest(rows: list[bytes], empty: bytes) -> list[bytes]:
    """Drop every second row, as long as the number of rows is even and all of the dropped rows are empty."""
    while rows and len(rows) % 2 == 0 and set(rows[1::2]) == {empty}:
        rows = rows[::2]
    return rows


@lru_cache(maxsize=64)
def normalised_bpms(text: str) -> str:
    """Return the valid pairs of a #BPMS, beat and BPM with three decimals: "0.000=120.000,4.000=60.500"."""
    pairs = (entry.partition("=") for entry in text.split(","))
    numbers = ((_decimals(beat), _decimals(bpm)) for beat, _, bpm in pairs)
    return ",".join(f"{beat}={bpm}" for beat, bpm in numbers if beat and bpm)


def _decimals(text: str) -> str:
    """Return a number with three decimals, halves rounded up (not to even, as by `%.3f`); "" for other text."""
    plain = "".join(c for c in text if c.isprintable()).strip()
    thousandths = float(plain) * 1000 + 0.5 if _NUMBER.fullmatch(plain) else math.inf
    if not math.isfinite(thousandths):
        return ""
    whole, rest = divmod(abs(floored := math.floor(thousandths)), 1000)
    return f"{'-' if floored < 0 else ''}{whole}.{rest:03}"
