"""The song's music: a file inside the song's folder, and nothing else."""

from __future__ import annotations

from pathlib import Path

from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import suspicious_music
from dancetutor_cli.errors import FileError, MissingFileError

SUFFIXES = (".ogg", ".oga", ".mp3", ".wav", ".flac", ".opus")


def music_file(song: Song) -> Path:
    """The music of a song, case-insensitive like the games on Windows; with an empty tag the only audio file there.

    Raises `FileError` for a name that leaves the folder (absolute, `..`, a network name, a link), that looks like an
    option or a protocol, for an unknown kind of file; `MissingFileError` if there is no such file.
    """
    folder = song.path.resolve().parent
    name = song.music.strip()
    if not name:
        audio = sorted(p for p in folder.iterdir() if p.suffix.lower() in SUFFIXES and p.is_file())
        if len(audio) != 1:
            raise MissingFileError(song.path, f"the file names no music, and its folder has {len(audio)} audio files")
        return _inside(song, audio[0], folder)
    if suspicious_music(name):
        raise FileError(song.path, f"music '{name[:80]}' is refused: it must be a plain file name in the song's folder")
    current = folder
    for part in name.replace("\\", "/").split("/"):
        if part in ("", "."):
            continue
        current = _entry(current, part)
    if not current.is_file():
        raise MissingFileError(song.path, f"music '{name[:80]}' is not there; put it into the song's folder")
    return _inside(song, current, folder)


def _entry(folder: Path, name: str) -> Path:
    exact = folder / name
    if exact.exists() or not folder.is_dir():
        return exact
    return next((p for p in sorted(folder.iterdir()) if p.name.lower() == name.lower()), exact)


def _inside(song: Song, path: Path, folder: Path) -> Path:
    real = path.resolve()
    if not real.is_relative_to(folder):
        raise FileError(song.path, f"music '{path.name}' is refused: it is a link that leaves the song's folder")
    if real.suffix.lower() not in SUFFIXES:
        raise FileError(song.path, f"music '{path.name}' is no audio file ({', '.join(SUFFIXES)})")
    return real
