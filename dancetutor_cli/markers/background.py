"""The entry of a film in `#BGCHANGES`, which the games play behind the notes.

An entry belongs to this program if its file's name ends in `.dancetutor.` and a suffix. So no other mark is needed, and
editors keep the entry when they save the file.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dancetutor_cli.chart.edits import Splice, apply, check_edit
from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.msd import Tag, blanked, scan
from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.chart.selection import find_files
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.files import UCS_SUFFIX, remove_leftovers, write_atomic

TAG = "BGCHANGES"
OURS = ".dancetutor"  # before the suffix of a film that this program has made for a song
MARK = b"//{dt1 background}"  # before a tag that was not there
# The games show the song's picture after the last note unless an entry prevents it; with this one, the film goes on.
_NO_PICTURE = b"-nosongbg-"
_ALONE = b",99999=%b=1.000=0=0=0" % _NO_PICTURE
_NAME = re.compile(rf"[^,;:=#\\/\r\n\x00-\x1f]+{re.escape(OURS)}\.\w+")
_ENTRY = re.compile(rf"[^,;=]*=\s*[^,;=]*{re.escape(OURS)}\.\w+\s*(?:=[^,;]*)?".encode())
_SONG_ENDS = ("NOTES", "NOTES2", "NOTEDATA")


@dataclass(frozen=True, slots=True)
class EntryInsertion:
    """The replacements that insert an entry. later : beats of other entries after it, which end the film"""

    splices: tuple[Splice, ...]
    later: tuple[float, ...]


def check_film_name(name: str) -> None:
    """Raise UsageError for a film's name that games cannot read, or that `annotate --strip` cannot recognise."""
    if not _NAME.fullmatch(name):
        raise UsageError(
            f"{name}: with --into-file the film's name must end in {OURS}.mp4, so that `annotate --strip` knows it, "
            "and must not contain , ; : = # \\"
        )


def entry(song: Song, name: str) -> bytes:
    """Return the text of the entry: the film begins at the beat at which the music begins."""
    beat = float(song.timing.beats(np.array([0.0]))[0])
    return f"{beat:.3f}={name}=1.000=0=0=0=StretchNoLoop====".encode()


def insert_entry(song: Song, name: str) -> EntryInsertion:
    """Insert the entry of a film into a chart file without one. Raises FileError if there is no place for it."""
    text, tag = entry(song, name), _tag(song.data)
    if tag is None:
        return EntryInsertion((_new_tag(song, text + _ALONE),), ())
    start, end = tag.spans[0]
    value, _ = blanked(song.data[start:end])
    at = start + len(value.rstrip())
    text = b"," + text if value.strip() else text + _ALONE
    later = tuple(beat for beat in _beats(value) if beat > float(song.timing.beats(np.array([0.0]))[0]))
    return EntryInsertion((Splice(at, at, text),), later)


def remove_entries(song: Song) -> list[Splice]:
    """Return the replacements that remove this program's entries, and the tag if the program added it."""
    tag = _tag(song.data)
    if tag is None or not tag.spans:
        return []
    start, end = tag.spans[0]
    value, _ = blanked(song.data[start:end])
    entries: list[tuple[int, int]] = []
    for match in _ENTRY.finditer(value):
        first, last = match.start(), match.end() + len(_ALONE) * value.startswith(_ALONE, match.end())
        between = value[entries[-1][1] : first].strip() if entries else None
        if between in (b",", b""):  # neighbours go with the comma between them
            entries[-1] = entries[-1][0], last
        else:
            entries.append((first, last))
    spans = [_with_comma(value, *entry) for entry in entries]
    if not spans:
        return []
    rest = b"".join(value[a:b] for a, b in _between(spans, len(value)))
    mark = re.compile(re.escape(MARK) + rb"\r?\n\Z").search(song.data, 0, tag.start)
    if not rest.strip() and mark is not None:
        after = re.compile(rb";\r?\n?").match(song.data, end)
        return [Splice(mark.start(), after.end() if after else end, b"")]
    return [Splice(start + a, start + b, b"") for a, b in spans]


def _with_comma(value: bytes, start: int, end: int) -> tuple[int, int]:
    """Return an entry's span with its comma: the one before it, or the one after it for the first entry."""
    while start < end and value[start : start + 1].isspace():
        start += 1
    while end > start and value[end - 1 : end].isspace():
        end -= 1
    if value[start - 1 : start] == b"," and start:
        return start - 1, end
    return start, end + (value[end : end + 1] == b",")


def _between(spans: list[tuple[int, int]], length: int) -> Iterator[tuple[int, int]]:
    at = 0
    for start, end in spans:
        yield at, start
        at = end
    yield at, length


def _tag(data: bytes) -> Tag | None:
    """Return the tag that the games use: the last `#BGCHANGES` of the song."""
    found, in_chart = None, False
    for tag in scan(data):
        if tag.name == "NOTEDATA":
            in_chart = True
        elif tag.name in ("NOTES", "NOTES2"):
            in_chart = False
        elif tag.name == TAG and not in_chart and tag.spans:
            found = tag
    return found


def _new_tag(song: Song, text: bytes) -> Splice:
    """Return the insertion of the tag on a new line before the first chart."""
    first = next((tag for tag in scan(song.data) if tag.name in _SONG_ENDS), None)
    if first is None:
        raise FileError(song.path, "has no chart, so #BGCHANGES cannot be put before one")
    at = song.data.rfind(b"\n", 0, first.start) + 1
    if song.data[at : first.start].strip():
        raise FileError(song.path, "its first chart begins in the middle of a line; put #BGCHANGES:; before it")
    eol = b"\r\n" if song.data[max(at - 2, 0) : at] == b"\r\n" else b"\n"
    return Splice(at, at, MARK + eol + b"#BGCHANGES:" + text + b";" + eol)


def _beats(value: bytes) -> Iterator[float]:
    for part in value.split(b","):
        if _NO_PICTURE in part:
            continue
        try:
            yield float(part.split(b"=")[0])
        except ValueError:
            continue


def files_of_song(path: Path) -> list[Path]:
    """Return the chart files that get the entry: the named file, or the .sm and .ssc of a song's folder."""
    return [path] if not path.is_dir() else [file for file in find_files([path]) if file.suffix.lower() != UCS_SUFFIX]


def check_place(film: Path, files: Sequence[Path]) -> None:
    """Raise UsageError unless a film is beside its chart, with a name that this program recognises."""
    check_film_name(film.name)
    for file in files:
        if file.suffix.lower() == UCS_SUFFIX:
            raise UsageError(f"{file}: a .ucs file cannot name a film; leave --into-file out")
        if film.resolve().parent != file.resolve().parent:
            raise UsageError(f"{film}: with --into-file the film must be in the song's folder, beside {file.name}")


def write_entries(film: Path, files: Sequence[Path]) -> list[str]:
    """Write or replace the entry of a film in chart files; return lines for people.

    Raises FileError for the first file that cannot be written; earlier files are written.
    """
    return [line for file in files for line in _write_entry(film, file)]


def _write_entry(film: Path, file: Path) -> list[str]:
    remove_leftovers(file.parent)
    song = load(file)
    without = parse(apply(song.data, remove_entries(song)), file)
    added = insert_entry(without, film.name)
    new = apply(without.data, added.splices)
    after = check_edit(song, new, free=(TAG,))
    if parse(apply(new, remove_entries(after)), file).data != without.data:
        raise FileError(file, "refused, nothing was written: the entry could not be removed again")
    if new != song.data:
        write_atomic(file, new, expect=song.data)
    lines = [f"{file}: plays {film.name} behind the notes; `dancetutor annotate --strip` removes it"]
    if added.later:
        lines.append(f"warning: {file}: a background change at beat {min(added.later):g} ends the film")
    return lines
