"""The styles that write beside a chart file: the sidecar, SMEditor's `data.sme`, `.edit` files and a theme's cues."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from dancetutor_cli.bounded import CHART_LIMIT, read_bytes
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.errors import FileError, MissingFileError
from dancetutor_cli.feet import sme
from dancetutor_cli.library.feet_files import song_stems
from dancetutor_cli.markers import edit, sidecar, smeditor, theme
from dancetutor_cli.markers.changes import EDIT, SIDECAR, SMEDITOR, THEME, ChartFeet, FileChange, Lack

Planned = tuple[FileChange, list[Lack]]


def write(style: str, song: Song, folder: Path, feet: Sequence[ChartFeet]) -> Iterator[Planned | FileError]:
    """The files that a style puts beside a song. folder : where they go; what is merged lies there or by the song.

    Yields an error in place of a file that there cannot be; the others come nevertheless.
    """
    if style == SIDECAR:
        path = folder / sidecar.path_for(song.path).name
        old = _present(path, song)
        new = sidecar.write(path, old, song, feet)
        why = [(one.chart, sidecar.lack(path, old, song, one.chart, new)) for one in feet]
        yield FileChange(path, old, new), [Lack(text, chart.line) for chart, text in why if text]
    elif style == SMEDITOR:
        path = folder / sme.FILE_NAME
        _one_song(song, path)
        old = _present(path, song)
        merged = smeditor.write(path, old, song, feet)
        lacks = [] if merged == old else [Lack(f"{path.name} has not the feet that the solver finds")]
        yield FileChange(path, old, merged), lacks
    elif style == EDIT:
        for where, data in edit.edit_files(song, feet):
            if isinstance(data, FileError):
                yield data
                continue
            path = folder / where.name
            old = _present(path, song)
            lacks = [] if old == data else [Lack(f"{path.name} is {'missing' if old is None else 'stale'}")]
            yield FileChange(path, old, data), lacks
    elif style == THEME:
        table, lua = (folder / path.name for path in theme.paths_for(song.path))
        before, script = _present(table, song), _present(lua, song)
        theme.check_lua(lua, script)
        said = theme.write(table, before, song, feet)
        for path, old, new in ((table, before, theme.as_json(said)), (lua, script, theme.as_lua(said))):
            lacks = [] if old == new else [Lack(f"{path.name} is {'missing' if old is None else 'stale'}")]
            yield FileChange(path, old, new), lacks


def strip(style: str, song: Song, charts: Sequence[Chart]) -> Iterator[Planned]:
    """What taking a style out again does to the files beside a song."""
    if style == SIDECAR:
        path = sidecar.path_for(song.path)
        old = _read(path)
        yield _removed(path, old, sidecar.strip(path, old, song, charts))
    elif style == SMEDITOR:
        path = song.path.parent / sme.FILE_NAME
        old = _read(path)
        yield _removed(path, old, smeditor.strip(path, old, song, charts))
    elif style == EDIT:
        for path in edit.edit_paths(song, charts):
            yield _removed(path, read_bytes(path, CHART_LIMIT), None)
    elif style == THEME:
        table, lua = theme.paths_for(song.path)
        old, script = _read(table), _read(lua)
        theme.check_lua(lua, script)
        kept = theme.without(table, old, charts)
        said = {**theme.write(table, None, song, ()), "charts": kept}
        yield _removed(table, old, theme.as_json(said) if kept and old else None)
        yield _removed(lua, script, theme.as_lua(said) if kept and script else None)


def _removed(path: Path, old: bytes | None, new: bytes | None) -> Planned:
    return FileChange(path, old, new), [] if old == new else [Lack(f"{path.name} has feet to take out")]


def _one_song(song: Song, path: Path) -> None:
    """`data.sme` knows charts only by their place, so it can only serve one song."""
    if len(stems := song_stems(song.path.parent)) > 1:
        raise FileError(path, f"its folder has {len(stems)} songs, and data.sme can only tell one; it is not written")


def _present(path: Path, song: Song) -> bytes | None:
    """The file as it is, or for a file that goes elsewhere the one that lies by the song."""
    found = _read(path)
    return _read(song.path.with_name(path.name)) if found is None else found


def _read(path: Path) -> bytes | None:
    try:
        return read_bytes(path, CHART_LIMIT)
    except MissingFileError:
        return None
