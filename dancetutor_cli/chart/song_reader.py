"""What both formats share: the values of a song's tags, making charts of note data, and what is odd in a file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from dancetutor_cli.chart import decoding as text
from dancetutor_cli.chart import msd, names, timing_tags
from dancetutor_cli.chart.decimals import number
from dancetutor_cli.chart.grid import LineIndex
from dancetutor_cli.chart.model import Chart, ReadWarning, Song
from dancetutor_cli.chart.msd import Tag
from dancetutor_cli.chart.note_data import NoteForm, Value, read_notes, width_of_first_row
from dancetutor_cli.chart.players import with_players
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.errors import ChartError, NoChartsError
from dancetutor_cli.suffixes import EDIT_SUFFIX

# Tags whose loss somebody sees or hears in a game.
_SEEN = frozenset({
    "TITLE", "SUBTITLE", "ARTIST", "TITLETRANSLIT", "SUBTITLETRANSLIT", "ARTISTTRANSLIT", "GENRE", "CREDIT", "BANNER",
    "BACKGROUND", "JACKET", "CDTITLE", "LYRICSPATH", "PREVIEWVID", "MUSIC", "OFFSET", "SAMPLESTART", "SAMPLELENGTH",
    "DISPLAYBPM", "BPMS", "STOPS", "DELAYS", "WARPS", "BGCHANGES", "FGCHANGES",
})  # fmt: skip
_OF_A_SONG = ("TITLE", "MUSIC", "BPMS")
_LARGEST_METER = 2**31 - 1


class _Head(NamedTuple):
    """What stands before the note data of a chart; see `Chart`."""

    steps_type: str
    difficulty: str
    meter: int
    description: str
    line: int
    tags: dict[str, str]
    warnings: list[ReadWarning]


class SongReader:
    """Reads one file: `song` of a form of it takes down its charts and hands over to `finished`."""

    format = ""

    def __init__(self, data: bytes, path: Path, tags: list[Tag]) -> None:
        self.data, self.path, self.tags = data, path, tags
        self.lines = LineIndex(data)
        self.encoding = text.encoding_of(data)
        self.warnings: list[ReadWarning] = []
        self.charts: list[Chart] = []
        self._heads: list[_Head] = []
        self._values: list[Value] = []

    def song(self) -> Song:
        raise NotImplementedError

    def no_charts(self) -> ChartError:
        """Why there is no chart; names the first that was skipped, and a wrong suffix."""
        raise NotImplementedError

    def without_charts(self) -> ChartError:
        skipped = next((w for w in self.warnings if w.code == "chart-skipped"), None)
        if skipped:
            return ChartError(self.path, f"no charts: {skipped.message}", skipped.line)
        a_song = any(tag.name in _OF_A_SONG for tag in self.tags)
        return (NoChartsError if a_song else ChartError)(self.path, "no charts: the file has no NOTES", 1)

    def text(self, tag: Tag, index: int = 0) -> str:
        if index >= len(tag.spans):
            return ""
        a, b = tag.spans[index]
        value = self.data[a:b]
        if value.isascii() and b"//" not in value and b"\\" not in value:  # most are, and the same in each encoding
            plain = value.decode("ascii")
            if plain.isprintable():
                return plain.strip()
        return text.decode(msd.plain(self.data[a:b]), self.encoding).strip()

    def values(self, tags: Iterable[Tag]) -> dict[str, str]:
        """Their first values; of #DISPLAYBPM both, as they are written, "90:180"."""
        return {tag.name: self._value(tag) for tag in tags if tag.name not in ("NOTES", "NOTEDATA")}

    def _value(self, tag: Tag) -> str:
        if tag.name == "DISPLAYBPM" and len(tag.spans) > 1:
            return ":".join(self.text(tag, k) for k in range(min(3, len(tag.spans))))
        return self.text(tag)

    def timing_texts(self, tags: Iterable[Tag]) -> dict[str, timing_tags.Text]:
        """The timing tags, each character a byte; of several of one name the last."""
        latest = {tag.name: tag for tag in tags if tag.name in timing_tags.TIMING_TAGS and tag.spans}
        return {
            name: timing_tags.Text(msd.plain(self.data[slice(*tag.spans[0])]).decode("latin-1"), self.lines(tag.start))
            for name, tag in latest.items()
        }

    def skip(self, reason: str, offset: int) -> None:
        self.warnings.append(ReadWarning("chart-skipped", f"{reason}; the chart is skipped", self.lines(offset)))

    def chart(
        self, tags: dict[str, str], notes: tuple[int, int], timing: Timing, line: int, warnings: list[ReadWarning]
    ) -> None:
        """Take down one chart. tags : its values by name; notes : span of its note data; line : where it starts"""
        kind = names.steps_type(tags.get("STEPSTYPE", ""))
        columns = names.COLUMNS.get(kind)
        if columns is None:
            columns = width_of_first_row(self.data, notes)
            message = (
                f"steps type '{text.shown(kind)}' is unknown; it is read with the {columns} columns of its first row"
            )
            warnings.append(ReadWarning("unknown-steps-type", message, line))
        meter = _meter(tags.get("METER", ""), line, warnings)
        description = text.one_line(tags.get("DESCRIPTION", ""))
        difficulty, said = names.difficulty(tags.get("DIFFICULTY", ""), description, meter, self.format == "sm")
        if self.path.suffix.lower() == EDIT_SUFFIX:
            difficulty = "Edit"
        elif not said:
            message = f"difficulty '{text.shown(tags.get('DIFFICULTY', ''))}' is unknown; the games show {difficulty}"
            warnings.append(ReadWarning("odd-difficulty", message, line))
        form = NoteForm(columns, names.is_routine(kind), trimmed=self.format == "sm")
        self._values.append(Value(notes, form, timing))
        self._heads.append(_Head(text.one_line(kind), difficulty, meter, description, line, tags, warnings))

    @property
    def timing_before(self) -> Timing | None:
        """That of the chart taken down last, if there is one."""
        return self._values[-1].timing if self._values else None

    def _read_charts(self) -> None:
        """Read the note data of all charts."""
        read_data = read_notes(self.data, self._values, self.lines)
        for index, (read, head, value) in enumerate(zip(read_data, self._heads, self._values, strict=True)):
            chart = Chart(
                index=index, steps_type=head.steps_type, difficulty=head.difficulty, meter=head.meter,
                description=head.description, columns=value.form.columns, notes=read.notes, rows=read.rows,
                measures=read.measures, timing=value.timing, notes_span=value.span, line=head.line, tags=head.tags,
                warnings=(*head.warnings, *read.warnings),
            )  # fmt: skip
            self.charts.append(with_players(chart, read, self.data))

    def finished(self, song_tags: list[Tag], timing: Timing) -> Song:
        self._read_charts()
        values = self.values(song_tags)
        self._oddities(song_tags, values)
        title, subtitle, artist, music = (
            text.one_line(values.get(name, "")) for name in ("TITLE", "SUBTITLE", "ARTIST", "MUSIC")
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
                message = f"the value of {text.shown(tag.name)} starts with '#': the games read that as the next tag"
                code = "hash-in-value" if tag.name in _SEEN else "hash-in-unused-value"
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
                f"MUSIC '{text.shown(name)}' is not a plain file name inside the song's folder; it will not be opened"
            )
            line = next((self.lines(tag.start) for tag in reversed(song_tags) if tag.name == "MUSIC"), None)
            self.warnings.append(ReadWarning("unsafe-music", message, line))

    def _on_one_line(self, tag: Tag) -> bool:
        return not re.search(rb"[\r\n]", self.data[tag.start : tag.spans[-1][1]])


def _meter(value: str, line: int, warnings: list[ReadWarning]) -> int:
    """The meter as the games read it: the whole number at the start; what is no usable number is 1."""
    meter, clean = number(value)
    if not clean or not 0 <= meter <= _LARGEST_METER:
        read = int(meter) if 0 < meter <= _LARGEST_METER else 1
        message = f"meter '{text.shown(value)}' is no usable number; read as {read}"
        warnings.append(ReadWarning("odd-meter", message, line))
        return read
    return int(meter)


def suspicious_music(name: str) -> bool:
    """Whether a music name is more than a plain relative file name: absolute, climbing, a URL or an option."""
    plain = name.strip().replace("\\", "/")
    return plain.startswith(("/", "-", "~")) or ":" in plain or "|" in plain or ".." in plain.split("/")
