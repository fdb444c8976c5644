"""The song's music, which must be a file inside the song's folder."""

from __future__ import annotations

import os
import unicodedata
from pathlib import Path

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.msd import quote
from dancetutor_cli.chart.reader import suspicious_music
from dancetutor_cli.run.errors import FileError, MissingFileError, plural

SUFFIXES = (".ogg", ".oga", ".mp3", ".wav", ".flac", ".opus")


def music_file(song: Song, chart: Chart | None = None) -> Path:
    """Return the music of a song, or of a chart with music of its own.

    The case of the name is ignored, as by the games on Windows. If the tag is empty, the music is the only audio file
    in the folder. The music of a .ucs file has the name of that file.

    Raises
    ------
    FileError : the name leaves the song's folder (absolute, `..`, a network name, a link), looks like an option or a
        protocol, or does not have the suffix of an audio file
    MissingFileError : the file does not exist
    """
    folder = song.path.parent.resolve()
    name = ((chart.tags.get("MUSIC") if chart else None) or song.music).strip()
    if not name:
        return _only_audio_file(song, folder) if song.format != "ucs" else _of_same_name(song, folder)
    if suspicious_music(name):
        raise FileError(
            song.path, f"music '{quote(name)}' is refused: it must be a plain file name in the song's folder"
        )
    current = named_file(folder, name)
    if not os.path.isfile(current):  # noqa: PTH113 (Path.is_file may raise)
        raise MissingFileError(song.path, f"music '{quote(name)}' is not there; put it into the song's folder")
    return _inside(song, current, folder)


def find_music(song: Song, chart: Chart) -> tuple[Path | None, str | None]:
    """Return the music of a chart or its song, or None and a message if it is missing.

    Raises FileError as `music_file`.
    """
    try:
        return music_file(song, chart), None
    except MissingFileError as error:
        return None, str(error)


def named_file(folder: Path, name: str) -> Path:
    """Return the path of the file that a tag names, ignoring case; the file need not exist."""
    current = folder
    for part in name.replace("\\", "/").split("/"):
        if part not in ("", "."):
            current = _entry(current, part)
    return current


def other_case(folder: Path, name: str) -> str | None:
    """Return the real relative path of a file if the tag's name differs in case; None if it does not differ."""
    current, parts = folder, []
    for part in name.replace("\\", "/").split("/"):
        names = _names(current) if part not in ("", ".", "..") else [part]
        same = sorted(entry for entry in names if _plain(entry) == _plain(part))
        if not same:
            return None
        parts.append(part if part in same else same[0])
        current = current / parts[-1]
    found = "/".join(parts)
    return None if found == name.replace("\\", "/") else found


def _of_same_name(song: Song, folder: Path) -> Path:
    """Return the audio file with the stem of the chart file, as "CS001.mp3", else the folder's only audio file."""
    wanted = _plain(song.path.stem)
    audio = [name for name in _names(folder) if name.lower().endswith(SUFFIXES) and _plain(Path(name).stem) == wanted]
    return _inside(song, folder / min(audio), folder) if audio else _only_audio_file(song, folder)


def _only_audio_file(song: Song, folder: Path) -> Path:
    audio = [name for name in _names(folder) if name.lower().endswith(SUFFIXES) and not name.startswith("._")]
    if len(audio) != 1:
        found = plural(len(audio), "audio file") if audio else "no audio file"
        raise MissingFileError(song.path, f"#MUSIC is empty, and the folder has {found}; name the music in the tag")
    return _inside(song, folder / audio[0], folder)


def _entry(folder: Path, name: str) -> Path:
    exact = folder / name
    if os.path.exists(exact):  # noqa: PTH110 (Path.exists may raise)
        return exact
    wanted = _plain(name)
    same = sorted(folder / entry for entry in _names(folder) if _plain(entry) == wanted)
    return same[0] if same else exact


def _plain(name: str) -> str:
    return name.lower() if name.isascii() else unicodedata.normalize("NFC", name).casefold()


def _names(folder: Path) -> list[str]:
    try:
        return os.listdir(folder)  # noqa: PTH208 (many times quicker)
    except OSError:
        return []


def _inside(song: Song, path: Path, folder: Path) -> Path:
    real = path.resolve()
    if not real.is_relative_to(folder):
        raise FileError(
            song.path, f"music '{quote(path.name)}' is refused: it is a link to a file outside the song's folder"
        )
    if real.suffix.lower() not in SUFFIXES:
        raise FileError(song.path, f"music '{quote(path.name)}' is not an audio file ({', '.join(SUFFIXES)})")
    return real
