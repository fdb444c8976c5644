"""From the bytes of a .sm or .ssc file to a `Song`."""

from __future__ import annotations

import os
import re
from fractions import Fraction
from pathlib import Path

from dancetutor_cli.bounded import CHART_LIMIT, read_bytes
from dancetutor_cli.chart import msd, names, timing_tags
from dancetutor_cli.chart.decimals import number
from dancetutor_cli.chart.model import ReadWarning, Song
from dancetutor_cli.chart.msd import Tag
from dancetutor_cli.chart.song_reader import SongReader
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.errors import ChartError, FileError
from dancetutor_cli.suffixes import EDIT_SUFFIX

_ALIASES = {"FREEZES": "STOPS", "NOTES2": "NOTES"}
_SM_FIELDS = ("STEPSTYPE", "DESCRIPTION", "DIFFICULTY", "METER", "RADARVALUES")
_NUL_TEXT = re.compile(rb"\A\s*(?:[^\0]\0){4}|\A\s*(?:\0[^\0]){4}")


def load(path: Path) -> Song:
    """Read a chart file. Raises `ChartError` for what cannot be understood, `FileError` for what cannot be read."""
    path = Path(path)
    try:
        data = read_bytes(path, CHART_LIMIT)
    except FileError as error:
        raise FileError(path, _why_unreadable(path, error)) from None
    return parse(data, path)


def _why_unreadable(path: Path, error: FileError) -> str:
    if os.path.isdir(path):  # noqa: PTH112 (Path.is_dir may raise)
        readable = os.access(path, os.R_OK | os.X_OK)
        if not readable:
            return "the folder cannot be read"
        # Commands that take folders search them first; what comes here has no charts, or one file was wanted.
        inside = any(entry.suffix.lower() in (".sm", ".ssc") for entry in path.rglob("*"))
        return "is a folder; name one of its files" if inside else "no .sm or .ssc file in this folder or below it"
    return error.message.removeprefix("cannot be read: ")


def parse(data: bytes, path: Path) -> Song:
    """Read the bytes of a chart file; `path` gives the format by its suffix, and the name in errors."""
    path = Path(path)
    if wide := _wide_encoding(data):
        raise ChartError(path, f"the text is {wide}, which no game reads: no charts; save it as UTF-8", 1)
    tags = [Tag(_ALIASES.get(tag.name, tag.name), tag.start, tag.spans) for tag in msd.scan(data)]
    if not tags:
        raise ChartError(path, "no charts: the file has no tags like #TITLE:...;", 1)
    suffix = path.suffix.lower()
    is_ssc = suffix == ".ssc" or (suffix == EDIT_SUFFIX and any(tag.name == "NOTEDATA" for tag in tags))
    reader = (_Ssc if is_ssc else _Sm)(data, path, tags)
    song = reader.song()
    if not song.charts:
        raise reader.no_charts()
    if all(names.is_lights(chart.steps_type) for chart in song.charts):
        raise ChartError(path, "no charts besides lights", song.charts[0].line)
    return song


def _wide_encoding(data: bytes) -> str | None:
    if data.startswith((b"\xff\xfe\0\0", b"\0\0\xfe\xff")):
        return "UTF-32"
    if data.startswith(b"\xff\xfe"):
        return "UTF-16 (little endian)"
    if data.startswith(b"\xfe\xff"):
        return "UTF-16 (big endian)"
    return "UTF-16 without a byte order mark" if _NUL_TEXT.match(data) else None


class _Sm(SongReader):
    format = "sm"

    def no_charts(self) -> ChartError:
        if any(tag.name == "NOTEDATA" for tag in self.tags):
            line = next(self.lines(tag.start) for tag in self.tags if tag.name == "NOTEDATA")
            return ChartError(self.path, "no charts: the text is in .ssc form; rename the file to .ssc", line)
        return self.without_charts()

    def song(self) -> Song:
        song_tags = [tag for tag in self.tags if tag.name != "NOTES"]
        source = timing_tags.Source(sm=True)
        timing = timing_tags.read(self.timing_texts(song_tags), source, Fraction(0), self.warnings, 1)
        for tag in self.tags:
            if tag.name == "NOTES" and len(tag.spans) <= len(_SM_FIELDS):
                self.skip(f"NOTES has {len(tag.spans)} of 6 fields", tag.start)
            elif tag.name == "NOTES":
                fields = {name: self.text(tag, i) for i, name in enumerate(_SM_FIELDS)}
                self.chart(fields, tag.spans[len(_SM_FIELDS)], timing, self.lines(tag.start), [])
        return self.finished(song_tags, timing)


class _Ssc(SongReader):
    format = "ssc"

    def no_charts(self) -> ChartError:
        for tag in self.tags:
            if tag.name == "NOTES" and len(tag.spans) > len(_SM_FIELDS):
                message = "no charts: the text is in .sm form; rename the file to .sm"
                return ChartError(self.path, message, self.lines(tag.start))
        return self.without_charts()

    def song(self) -> Song:
        song_tags, groups = self._groups()
        source = timing_tags.Source(sm=False, version=self._version(song_tags))
        timing = timing_tags.read(self.timing_texts(song_tags), source, Fraction(0), self.warnings, 1)
        for group, notes in groups:
            line = self.lines(notes.start)
            fields = self.values(group)
            if not fields.get("STEPSTYPE"):
                self.skip("a chart has no STEPSTYPE", notes.start)
                continue
            warnings: list[ReadWarning] = []
            span = notes.spans[0] if notes.spans else (len(self.data), len(self.data))
            self.chart(fields, span, self._timing(group, timing, source, line, warnings), line, warnings)
        return self.finished(song_tags, timing)

    def _timing(
        self, group: list[Tag], song: Timing, source: timing_tags.Source, line: int, warnings: list[ReadWarning]
    ) -> Timing:
        """The chart's own timing if it has any, else the song's."""
        own = self.timing_texts(group)
        if not timing_tags.is_own(own, source):
            return song
        if "BPMS" not in own:
            message = f"{', '.join(sorted(own))} gives the chart timing of its own, without BPMS: it plays at 60 BPM"
            warnings.append(ReadWarning("split-timing-without-bpms", message, line))
        timing = timing_tags.read(own, source, song.offset, warnings, line)
        return next((known for known in (song, self.timing_before) if known == timing), timing)  # charts share its work

    def _version(self, song_tags: list[Tag]) -> Fraction:
        version = [self.text(tag) for tag in song_tags if tag.name == "VERSION"]
        return number(version[-1])[0] if version else Fraction(1)

    def _groups(self) -> tuple[list[Tag], list[tuple[list[Tag], Tag]]]:
        """Song tags; and per chart its tags and its NOTES. Tags between NOTES and the next NOTEDATA are the song's."""
        song_tags: list[Tag] = []
        groups: list[tuple[list[Tag], Tag]] = []
        current: list[Tag] | None = None
        opened = 0
        for tag in self.tags:
            if tag.name == "NOTEDATA":
                if current is not None:
                    message = "NOTEDATA without NOTES: its tags merge into the next chart"
                    self.warnings.append(ReadWarning("notedata-without-notes", message, self.lines(opened)))
                current, opened = current if current is not None else [], tag.start
            elif tag.name == "NOTES":
                if current is None:
                    self.skip("NOTES stands outside NOTEDATA", tag.start)
                else:
                    groups.append((current, tag))
                current = None
            else:
                (song_tags if current is None else current).append(tag)
        if current is not None:
            self.skip("the last NOTEDATA has no NOTES", opened)
        return song_tags, groups
