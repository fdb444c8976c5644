"""Putting a film into chart files as what the games play behind the notes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from dancetutor_cli.errors import FileError, UsageError
from dancetutor_cli.files import back_up, remove_leftovers, write_atomic


def files_of_song(path: Path) -> list[Path]:
    """The chart files that get the entry: a file that was named alone, of a folder of one song its .sm and .ssc."""
    from dancetutor_cli.library import find_files

    return [path] if not path.is_dir() else find_files([path])


def check_place(film: Path, files: Sequence[Path]) -> None:
    """UsageError if a film there cannot be entered: it has to lie beside its chart, under a name that is ours."""
    from dancetutor_cli.markers.background import check_name

    check_name(film.name)
    for file in files:
        if film.resolve().parent != file.resolve().parent:
            raise UsageError(f"{film}: with --into-file the film lies in the song's folder, beside {file.name}")


def enter(film: Path, files: Sequence[Path], backup: bool = False) -> list[str]:
    """Write the entry of a film into chart files, in place of one that is there; lines for people.

    Raises FileError for the first file that cannot be written; those before it are.
    """
    return [line for file in files for line in _enter(film, file, backup)]


def _enter(film: Path, file: Path, backup: bool) -> list[str]:
    from dancetutor_cli import chart as reader
    from dancetutor_cli.markers import background
    from dancetutor_cli.markers.splice import apply
    from dancetutor_cli.markers.verify import unchanged

    remove_leftovers(file.parent)
    song = reader.load(file)
    without = reader.parse(apply(song.data, background.remove(song)), file)
    added = background.add(without, film.name)
    new = apply(without.data, added.splices)
    after = unchanged(song, new, free=(background.TAG,))
    if reader.parse(apply(new, background.remove(after)), file).data != without.data:
        raise FileError(file, "refused, nothing was written: the entry could not be taken out again")
    if new != song.data:
        if backup:
            back_up(file)
        write_atomic(file, new, expect=song.data)
    told = [f"{file}: plays {film.name} behind the notes; `dancetutor annotate --strip` takes it out"]
    if added.later:
        told.append(f"warning: {file}: a background change at beat {min(added.later):g} takes the film away")
    return told
