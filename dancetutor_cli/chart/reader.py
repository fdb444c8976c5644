"""Read the bytes of a chart file into a `Song`: the values of its tags, its charts, and its oddities."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from dancetutor_cli.chart import msd, names, timing_tags
from dancetutor_cli.chart.grid import LineIndex
from dancetutor_cli.chart.model import Chart, ReadWarning, Song
from dancetutor_cli.chart.msd import Tag
from dancetutor_cli.chart.note_data import NoteForm, Value, read_notes, width_of_first_row
from dancetutor_cli.chart.players import with_players
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.chart.timing_tags import parse_number
from dancetutor_cli.run.errors import ChartError, FileError, NoChartsError
from dancetutor_cli.run.files import CHART_SUFFIXES, EDIT_SUFFIX, UCS_SUFFIX
from dancetutor_cli.run.reading import CHART_LIMIT, read_bytes

# Tags whose loss a player sees or hears in a game.
_TEXT_TAGS = frozenset({
    "TITLE", "SUBTITLE", "ARTIST", "TITLETRANSLIT", "SUBTITLETRANSLIT", "ARTISTTRANSLIT", "GENRE", "CREDIT", "BANNER",
    "BACKGROUND", "JACKET", "CDTITLE", "LYRICSPATH", "PREVIEWVID", "MUSIC", "OFFSET", "SAMPLESTART", "SAMPLELENGTH",
    "DISPLAYBPM", "BPMS", "STOPS", "DELAYS", "WARPS", "BGCHANGES", "FGCHANGES",
})  # fmt: skip
_OF_A_SONG = ("TITLE", "MUSIC", "BPMS")
_LARGEST_METER = 2**31 - 1


class _Head(NamedTuple):
    """The values of a chart that come before its note data; see `Chart`."""

    steps_type: str
    difficulty: str
    meter: int
    description: str
    line: int
    tags: dict[str, str]
    warnings: list[ReadWarning]


class SongReader:
    """The reader of one file. Each format has a subclass, whose `song` adds the charts and then calls `finished`."""

    format = ""

    def __init__(self, data: bytes, path: Path, tags: list[Tag]) -> None:
        self.data, self.path, self.tags = data, path, tags
        self.lines = LineIndex(data)
        self.encoding = msd.encoding_of(data)
        self.warnings: list[ReadWarning] = []
        self.charts: list[Chart] = []
        self._heads: list[_Head] = []
        self._values: list[Value] = []

    def song(self) -> Song:
        raise NotImplementedError

    def no_charts_error(self) -> ChartError:
        """Return the error of a file without charts; it names the first skipped chart, or a wrong suffix."""
        raise NotImplementedError

    def usual_no_charts_error(self) -> ChartError:
        skipped = next((w for w in self.warnings if w.code == "chart-skipped"), None)
        if skipped:
            return ChartError(self.path, f"no charts: {skipped.message}", skipped.line)
        a_song = any(tag.name in _OF_A_SONG for tag in self.tags)
        if not a_song and self.path.suffix.lower() not in CHART_SUFFIXES:
            return ChartError(self.path, _NO_CHART_FILE)
        return (NoChartsError if a_song else ChartError)(self.path, "no charts: the file has no NOTES", 1)

    def text(self, tag: Tag, index: int = 0) -> str:
        if index >= len(tag.spans):
            return ""
        a, b = tag.spans[index]
        value = self.data[a:b]
        if value.isascii() and b"//" not in value and b"\\" not in value:  # most values; the same in every encoding
            plain = value.decode("ascii")
            if plain.isprintable():
                return plain.strip()
        return msd.decode_text(msd.plain(self.data[a:b]), self.encoding).strip()

    def values(self, tags: Iterable[Tag]) -> dict[str, str]:
        """Return the first value of each tag by name; both values of a #DISPLAYBPM are joined as written, "90:180"."""
        return {tag.name: self._value(tag) for tag in tags if tag.name not in ("NOTES", "NOTEDATA")}

    def _value(self, tag: Tag) -> str:
        if tag.name == "DISPLAYBPM" and len(tag.spans) > 1:
            return ":".join(self.text(tag, k) for k in range(min(3, len(tag.spans))))
        return self.text(tag)

    def timing_texts(self, tags: Iterable[Tag]) -> dict[str, timing_tags.Text]:
        """Return the timing tags by name, one character per byte; of tags with the same name, the last one counts."""
        latest = {tag.name: tag for tag in tags if tag.name in timing_tags.TIMING_TAGS and tag.spans}
        return {
            name: timing_tags.Text(msd.plain(self.data[slice(*tag.spans[0])]).decode("latin-1"), self.lines(tag.start))
            for name, tag in latest.items()
        }

    def skip(self, reason: str, offset: int) -> None:
        self.warnings.append(ReadWarning("chart-skipped", f"{reason}; the chart is skipped", self.lines(offset)))

    def add_chart(
        self, tags: dict[str, str], notes: tuple[int, int], timing: Timing, line: int, warnings: list[ReadWarning]
    ) -> None:
        """Add one chart. tags : values of its tags by name; notes : span of its note data; line : its first line"""
        kind = names.steps_type(tags.get("STEPSTYPE", ""))
        columns = names.COLUMNS.get(kind)
        if columns is None:
            columns = width_of_first_row(self.data, notes)
            message = (
                f"steps type '{msd.quote(kind)}' is unknown; it is read with the {columns} columns of its first row"
            )
            warnings.append(ReadWarning("unknown-steps-type", message, line))
        meter = _meter(tags.get("METER", ""), line, warnings)
        description = msd.one_line(tags.get("DESCRIPTION", ""))
        difficulty, named = names.difficulty(tags.get("DIFFICULTY", ""), description, meter, self.format == "sm")
        if self.path.suffix.lower() == EDIT_SUFFIX:
            difficulty = "Edit"
        elif not named:
            message = f"difficulty '{msd.quote(tags.get('DIFFICULTY', ''))}' is unknown; the games show {difficulty}"
            warnings.append(ReadWarning("odd-difficulty", message, line))
        form = NoteForm(columns, names.is_routine(kind), trimmed=self.format == "sm")
        self._values.append(Value(notes, form, timing))
        self._heads.append(_Head(msd.one_line(kind), difficulty, meter, description, line, tags, warnings))

    @property
    def timing_before(self) -> Timing | None:
        """The timing of the chart that was added last; None before the first chart."""
        return self._values[-1].timing if self._values else None

    def _read_charts(self) -> None:
        """Read the note data of all charts."""
        read_data = read_notes(self.data, self._values, self.lines)
        for index, (read, head, value) in enumerate(zip(read_data, self._heads, self._values, strict=True)):
            chart = Chart(
                index=index, steps_type=head.steps_type, difficulty=head.difficulty, meter=head.meter,
                description=head.description, columns=value.form.columns, notes=read.notes, rows=read.rows,
                measures=read.measures, timing=value.timing, notes_span=value.span, line=head.line, tags=head.tags,
                warnings=(*head.warnings, *_unexpected(read.warnings, head.steps_type)),
            )  # fmt: skip
            self.charts.append(with_players(chart, read, self.data))

    def finish(self, song_tags: list[Tag], timing: Timing) -> Song:
        self._read_charts()
        values = self.values(song_tags)
        self._oddities(song_tags, values)
        title, subtitle, artist, music = (
            msd.one_line(values.get(name, "")) for name in ("TITLE", "SUBTITLE", "ARTIST", "MUSIC")
        )
        return Song(
            path=self.path, format=self.format, data=self.data, encoding=self.encoding, title=title, subtitle=subtitle,
            artist=artist, music=music, tags=values, timing=timing, charts=tuple(self.charts),
            warnings=tuple(self.warnings),
        )  # fmt: skip

    def _oddities(self, song_tags: list[Tag], values: Mapping[str, str]) -> None:
        for tag in song_tags:
            ended = tag.spans and self.data[tag.spans[-1][1] : tag.spans[-1][1] + 1] == b"#"
            if ended and not self.text(tag) and self._on_one_line(tag):
                message = f"the value of {msd.quote(tag.name)} starts with '#': the games read that as the next tag"
                code = "hash-in-value" if tag.name in _TEXT_TAGS else "hash-in-unused-value"
                self.warnings.append(ReadWarning(code, message, self.lines(tag.start)))
        if b"\r" in self.data and b"\n" not in self.data:
            message = "lines end at CR alone: the games read each measure as one row"
            self.warnings.append(ReadWarning("cr-only", message, 1))
        if (nul := self.data.find(b"\0")) >= 0:
            self.warnings.append(ReadWarning("nul-byte", "the file has NUL bytes", self.lines(nul)))
        seen: set[tuple[str, str]] = set()
        for chart in self.charts:
            key = (chart.steps_type, chart.difficulty)
            if key in seen and chart.difficulty != "Edit":
                message = f"a second {chart.steps_type} {chart.difficulty}: the games show one as an Edit"
                self.warnings.append(ReadWarning("duplicate-difficulty", message, chart.line))
            seen.add(key)
        if (name := values.get("MUSIC", "")) and suspicious_music(name):
            message = (
                f"MUSIC '{msd.quote(name)}' is not a plain file name inside the song's folder; it will not be opened"
            )
            line = next((self.lines(tag.start) for tag in reversed(song_tags) if tag.name == "MUSIC"), None)
            self.warnings.append(ReadWarning("unsafe-music", message, line))

    def _on_one_line(self, tag: Tag) -> bool:
        return not re.search(rb"[\r\n]", self.data[tag.start : tag.spans[-1][1]])


def _unexpected(warnings: Iterable[ReadWarning], steps_type: str) -> Iterator[ReadWarning]:
    """Return the warnings of note data, except those about notes of one game in a chart for that game."""
    own = "stepmaniax-note" if steps_type.startswith("smx-") else ""
    return (warning for warning in warnings if warning.code != own)


def _meter(value: str, line: int, warnings: list[ReadWarning]) -> int:
    """Return the meter as the games read it: the whole number at the start; 1 if there is no usable number."""
    meter, clean = parse_number(value)
    if not clean or not 0 <= meter <= _LARGEST_METER:
        read = int(meter) if 0 < meter <= _LARGEST_METER else 1
        message = f"meter '{msd.quote(value)}' is not a usable number; read as {read}"
        warnings.append(ReadWarning("odd-meter", message, line))
        return read
    return int(meter)


def suspicious_music(name: str) -> bool:
    """Whether a music name is not a plain relative path: it is absolute, has `..`, or is a URL or an option."""
    plain = name.strip().replace("\\", "/")
    return plain.startswith(("/", "-", "~")) or ":" in plain or "|" in plain or ".." in plain.split("/")


_KINDS = f"{', '.join(CHART_SUFFIXES[:-1])} or {CHART_SUFFIXES[-1]}"
_NO_CHART_FILE = f"not a chart file; give a {_KINDS} file, or a folder"
_ALIASES = {"FREEZES": "STOPS", "NOTES2": "NOTES"}
_SM_FIELDS = ("STEPSTYPE", "DESCRIPTION", "DIFFICULTY", "METER", "RADARVALUES")
_NUL_TEXT = re.compile(rb"\A\s*(?:[^\0]\0){4}|\A\s*(?:\0[^\0]){4}")


def load(path: Path) -> Song:
    """Read a chart file. Raises `ChartError` if it is not a valid chart file, `FileError` if it cannot be read."""
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
        # Commands that take folders search them first: a folder here has no charts, or the command needs one file.
        inside = any(entry.suffix.lower() in CHART_SUFFIXES for entry in path.rglob("*"))
        return "is a folder; name one of its files" if inside else f"no {_KINDS} file in this folder or below it"
    return error.message.removeprefix("cannot be read: ")


def parse(data: bytes, path: Path) -> Song:
    """Read the bytes of a chart file; the suffix of `path` gives the format, and errors name the path."""
    path = Path(path)
    if wide := _wide_encoding(data):
        raise ChartError(path, f"no charts: the text is {wide}, which no game reads; save it as UTF-8", 1)
    if (suffix := path.suffix.lower()) == UCS_SUFFIX:
        from dancetutor_cli.chart.ucs import read_ucs

        return read_ucs(data, path)
    tags = [Tag(_ALIASES.get(tag.name, tag.name), tag.start, tag.spans) for tag in msd.scan(data)]
    if not data.strip():
        raise ChartError(path, "no charts: the file is empty; save it again from the editor", 1)
    if not tags and suffix not in CHART_SUFFIXES:
        raise ChartError(path, _NO_CHART_FILE)
    if not tags:
        raise ChartError(path, "no charts: the file has no tags such as #TITLE; check that it is a chart file", 1)
    is_ssc = suffix == ".ssc" or (suffix == EDIT_SUFFIX and any(tag.name == "NOTEDATA" for tag in tags))
    reader = (_Ssc if is_ssc else _Sm)(data, path, tags)
    song = reader.song()
    if not song.charts:
        raise reader.no_charts_error()
    if all(names.is_lights(chart.steps_type) for chart in song.charts):
        raise ChartError(path, "no charts to dance: all of them are for lights", song.charts[0].line)
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

    def no_charts_error(self) -> ChartError:
        if any(tag.name == "NOTEDATA" for tag in self.tags):
            line = next(self.lines(tag.start) for tag in self.tags if tag.name == "NOTEDATA")
            return ChartError(self.path, "no charts: the text is in .ssc form; rename the file to .ssc", line)
        return self.usual_no_charts_error()

    def song(self) -> Song:
        song_tags = [tag for tag in self.tags if tag.name != "NOTES"]
        source = timing_tags.Source(sm=True)
        timing = timing_tags.read(self.timing_texts(song_tags), source, Fraction(0), self.warnings, 1)
        for tag in self.tags:
            if tag.name == "NOTES" and len(tag.spans) <= len(_SM_FIELDS):
                self.skip(f"NOTES has {len(tag.spans)} of 6 fields", tag.start)
            elif tag.name == "NOTES":
                fields = {name: self.text(tag, i) for i, name in enumerate(_SM_FIELDS)}
                self.add_chart(fields, tag.spans[len(_SM_FIELDS)], timing, self.lines(tag.start), [])
        return self.finish(song_tags, timing)


class _Ssc(SongReader):
    format = "ssc"

    def no_charts_error(self) -> ChartError:
        for tag in self.tags:
            if tag.name == "NOTES" and len(tag.spans) > len(_SM_FIELDS):
                message = "no charts: the text is in .sm form; rename the file to .sm"
                return ChartError(self.path, message, self.lines(tag.start))
        return self.usual_no_charts_error()

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
            self.add_chart(fields, span, self._timing(group, timing, source, line, warnings), line, warnings)
        return self.finish(song_tags, timing)

    def _timing(
        self, group: list[Tag], song: Timing, source: timing_tags.Source, line: int, warnings: list[ReadWarning]
    ) -> Timing:
        """Return the chart's own timing if it has any, else the song's."""
        own = self.timing_texts(group)
        if not timing_tags.is_own(own, source):
            return song
        if "BPMS" not in own:
            message = f"{', '.join('#' + n for n in sorted(own))} gives the chart its own timing, but #BPMS is missing"
            warnings.append(ReadWarning("split-timing-without-bpms", message, line))
        timing = timing_tags.read(own, source, song.offset, warnings, line)
        return next((known for known in (song, self.timing_before) if known == timing), timing)  # to share caches

    def _version(self, song_tags: list[Tag]) -> Fraction:
        version = [self.text(tag) for tag in song_tags if tag.name == "VERSION"]
        return parse_number(version[-1])[0] if version else Fraction(1)

    def _groups(self) -> tuple[list[Tag], list[tuple[list[Tag], Tag]]]:
        """Return the song's tags, and the tags and the NOTES of each chart.

        Tags between NOTES and the next NOTEDATA are the song's.
        """
        song_tags: list[Tag] = []
        groups: list[tuple[list[Tag], Tag]] = []
        current: list[Tag] | None = None
        opened = 0
        for tag in self.tags:
            if tag.name == "NOTEDATA":
                if current is not None:
                    message = "#NOTEDATA without #NOTES: the games read its tags as part of the next chart"
                    self.warnings.append(ReadWarning("notedata-without-notes", message, self.lines(opened)))
                current, opened = current if current is not None else [], tag.start
            elif tag.name == "NOTES":
                if current is None:
                    self.skip("NOTES is outside NOTEDATA", tag.start)
                else:
                    groups.append((current, tag))
                current = None
            else:
                (song_tags if current is None else current).append(tag)
        if current is not None:
            self.skip("the last NOTEDATA has no NOTES", opened)
        return song_tags, groups
