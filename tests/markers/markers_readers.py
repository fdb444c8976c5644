"""Models of how other programs read comments, from the table in the file format's description. For tests only.

Each reader is a function from the bytes of a file to what it sees: for every chart its fields and its rows by measure.
They are small on purpose and share nothing with the project's own reader: tags are found by pattern, and a reader is
the way it treats comments, blank lines and blanks in rows.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

Rows = list[list[bytes]]
View = list[tuple[list[bytes], Rows]]

_TAG = re.compile(rb"#([^#:;]*):([^;]*?)(?:;|(?=^[ \t]*#)|\Z)", re.MULTILINE)
_COMMENT = re.compile(rb"//[^\n]*")
_SPACE = b" \t\r\n\x0b\x0c"


def _notes(text: bytes) -> Iterator[tuple[list[bytes], bytes]]:
    """The fields before the note data and the note data of each NOTES tag; in .ssc there are no fields."""
    for match in _TAG.finditer(text):
        if match[1].strip().upper() in (b"NOTES", b"NOTES2"):
            yield _fields(match[2])


def _fields(value: bytes) -> tuple[list[bytes], bytes]:
    """Of .sm five fields and then the note data, of .ssc only note data."""
    pieces = value.split(b":")
    return ([piece.strip(_SPACE) for piece in pieces[:5]], pieces[5]) if len(pieces) > 5 else ([], pieces[0])


def _read(text: bytes, rows_of: Callable[[bytes], list[bytes]]) -> View:
    return [(fields, [rows_of(m) for m in data.split(b",")]) for fields, data in _notes(text)]


def stepmania(data: bytes) -> View:
    """StepMania 5, ITGmania: comments go, their LF stays; rows are trimmed lines; blank lines are none."""

    def rows(measure: bytes) -> list[bytes]:
        return [line.strip(_SPACE) for line in measure.split(b"\n") if line.strip(_SPACE)]

    return _read(_COMMENT.sub(b"", data), rows)


def openitg(data: bytes) -> View:
    """OpenITG, 3.9: as above, but a line that holds nothing but a comment counts as an empty row."""
    own = re.sub(rb"^[ \t]*//[^\n]*", b"<empty row>", data, flags=re.MULTILINE)

    def rows(measure: bytes) -> list[bytes]:
        return [line.strip(_SPACE) for line in measure.strip(_SPACE).split(b"\n") if line.strip(_SPACE)]

    return _read(_COMMENT.sub(b"", own), rows)


def etterna(data: bytes) -> View:
    """Etterna: a comment takes its line end with it, so that the row joins the next; its `:` and `;` still count."""

    def live(match: re.Match[bytes]) -> bytes:
        return re.sub(rb"[^:;]", b"", match[0])

    def rows(measure: bytes) -> list[bytes]:
        return [line.strip(_SPACE) for line in measure.split(b"\n") if line.strip(_SPACE)]

    return _read(re.sub(rb"//[^\n]*\n?", live, data), rows)


def arrowvortex(data: bytes) -> View:
    """ArrowVortex: the first row tells the number of columns, and a blank before its comment counts as one."""
    view: View = []
    for fields, notes in _notes(re.sub(rb"^[ \t]*//[^\n]*", b"", data, flags=re.MULTILINE)):
        first = next((line for line in notes.split(b"\n") if re.match(rb"[ \t]*[^\s,/]", line)), b"")
        columns = len(first.split(b"//")[0].strip(b"\r\n") if b"//" in first else first.strip(_SPACE))
        text = _COMMENT.sub(b"", notes)
        measures = [[row.strip(_SPACE) for row in m.split(b"\n") if row.strip(_SPACE)] for m in text.split(b",")]
        view.append(([*fields, b"%d columns" % columns], measures))
    return view


def smeditor(data: bytes) -> View:
    """SMEditor: comments go; in a trimmed measure every line is a row, also a blank one."""

    def rows(measure: bytes) -> list[bytes]:
        return [line.strip(_SPACE) for line in measure.strip(_SPACE).split(b"\n")]

    return _read(_COMMENT.sub(b"", data), rows)


def grooveauthor(data: bytes) -> View:
    """GrooveAuthor: a comment on a line of its own is ignored, but an indented one counts as a row."""
    marked = re.sub(rb"^[ \t]+//[^\n]*", b"<empty row>", data, flags=re.MULTILINE)

    def rows(measure: bytes) -> list[bytes]:
        return [line.strip(_SPACE) for line in measure.split(b"\n") if line.strip(_SPACE)]

    return _read(_COMMENT.sub(b"", marked), rows)


def simply_love(data: bytes) -> View:
    """The Simply Love score hash: cut at `:` and `;` first, those in comments too, then comments and blanks go."""
    view: View = []
    normal = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    for match in re.finditer(rb"#NOTES2?:([^;]*)", normal, re.IGNORECASE):
        fields, notes = _fields(match[1])
        text = re.sub(rb"[\r\t\f\v ]+", b"", _COMMENT.sub(b"", notes))
        view.append((fields, [[row for row in m.split(b"\n") if row] for m in text.split(b",")]))
    return view


READERS: dict[str, Callable[[bytes], View]] = {
    "StepMania 5, ITGmania": stepmania,
    "OpenITG, 3.9": openitg,
    "Etterna": etterna,
    "ArrowVortex": arrowvortex,
    "SMEditor": smeditor,
    "GrooveAuthor": grooveauthor,
    "Simply Love score hash": simply_love,
}
