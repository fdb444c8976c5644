"""The style of a .ucs for people: `SONG.feet.txt`, a copy with the feet after each row, "..M.X ..L.R".

A .ucs file cannot have comments, so nothing is written into it. Lines have the same numbers in both files.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.markers.model import ChartFeet, FileChange, change_of, check_is_ours, old_content, removal_of

SUFFIX = ".feet.txt"
_OURS = b"feet by dancetutor, preset "  # begins its last line


def write(song: Song, folder: Path, feet: Sequence[ChartFeet]) -> Iterator[FileChange]:
    """Yield the text with the feet of a .ucs."""
    path = folder / (song.path.stem + SUFFIX)
    old = old_content(path, song)
    _check_text(path, old)
    lines = [line.rstrip(b"\r\n") for line in song.data.splitlines(keepends=True)]
    newline = b"\r\n" if b"\r\n" in song.data else b"\n"
    for one in feet:
        columns = one.chart.columns
        for row, steps, letters in zip(one.rows.row.tolist(), one.rows.steps, one.letters, strict=True):
            letter = iter(letters.encode("ascii"))
            cells = bytes(next(letter) if step else ord(".") for step in steps[:columns].tolist())
            at = int(one.chart.rows.line[row]) - 1
            lines[at] = lines[at].rstrip() + b"  " + cells
    preset = ", ".join(dict.fromkeys(one.play.preset for one in feet)).encode()
    yield change_of(path, old, newline.join([*lines, _OURS + preset, b""]))


def strip(song: Song, charts: Sequence[Chart]) -> Iterator[FileChange]:
    """Yield the removal of the text."""
    path = song.path.with_name(song.path.stem + SUFFIX)
    old = old_content(path, song)
    _check_text(path, old)
    yield removal_of(path, old, None)


def _check_text(path: Path, old: bytes | None) -> None:
    """Raise FileError if the old file was not written by this program."""
    is_ours = old is None or old.rstrip().rpartition(b"\n")[2].startswith(_OURS)
    check_is_ours(path, is_ours, "a text with feet by dancetutor")
