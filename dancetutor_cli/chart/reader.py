"""From the bytes of a .sm or .ssc file to a `Song`."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

from dancetutor_cli.chart import msd, names, segments
from dancetutor_cli.chart.model import TICKS_PER_BEAT, Chart, ReadWarning, Song
from dancetutor_cli.chart.msd import Tag
from dancetutor_cli.chart.notes import LineIndex, first_row, read_notes
from dancetutor_cli.chart.timing import Segments, Timing
from dancetutor_cli.errors import ChartError, FileError

TIMING_TAGS = {
    "BPMS", "STOPS", "DELAYS", "WARPS", "FAKES", "OFFSET", "TIMESIGNATURES", "TICKCOUNTS", "COMBOS", "SPEEDS",
    "SCROLLS", "LABELS",
}  # fmt: skip
_ALIASES = {"FREEZES": "STOPS", "NOTES2": "NOTES"}


def load(path: Path) -> Song:
    """Read a chart file. Raises `ChartError` for what cannot be understood, `FileError` for what cannot be read."""
    path = Path(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise FileError(path, error.strerror or str(error)) from None
    return parse(data, path)


def parse(data: bytes, path: Path) -> Song:
    """Read the bytes of a chart file; `path` gives the format by its suffix and the name in errors."""
    path = Path(path)
    if data[:2] in (b"\xff\xfe", b"\xfe\xff") or (len(data) > 8 and data[1:16:2].count(0) >= 7):
        raise ChartError(path, "the text is UTF-16, which no game reads; save it as UTF-8")
    tags = [_renamed(tag) for tag in msd.scan(data)]
    if not tags:
        raise ChartError(path, "no charts: the file has no tags")
    reader = _Ssc if path.suffix.lower() == ".ssc" else _Sm
    song = reader(data, path, tags).song()
    if not song.charts:
        raise ChartError(path, f"no charts{reader.hint(tags)}")
    if all(chart.steps_type.startswith("lights") for chart in song.charts):
        raise ChartError(path, "no chart besides lights")
    return song


def _renamed(tag: Tag) -> Tag:
    new = _ALIASES.get(tag.name)
    return Tag(new, tag.start, tag.spans) if new else tag


class _Reader:
    """What both formats share: values, timing, making a chart."""

    format = ""

    def __init__(self, data: bytes, path: Path, tags: list[Tag]) -> None:
        self.data, self.path, self.tags = data, path, tags
        self.lines = LineIndex(data)
        self.warnings: list[ReadWarning] = []
        self.charts: list[Chart] = []

    @staticmethod
    def hint(tags: list[Tag]) -> str:
        return ""

    def raw(self, span: tuple[int, int]) -> bytes:
        return msd.without_comments(self.data[span[0] : span[1]])

    def text(self, tag: Tag, index: int = 0) -> str:
        return msd.decode(self.raw(tag.spans[index])).strip() if len(tag.spans) > index else ""

    def values(self, tags: list[Tag]) -> dict[str, str]:
        return {tag.name: self.text(tag) for tag in tags if tag.name not in ("NOTES", "NOTEDATA")}

    def timing(self, tags: list[Tag], warnings: list[ReadWarning]) -> Timing:
        latest = {tag.name: tag for tag in tags}
        raw = segments.Raw()
        lists = {"BPMS": raw.bpms, "STOPS": raw.stops, "DELAYS": raw.delays, "WARPS": raw.warps, "FAKES": raw.fakes}
        line = 1
        for name, into in lists.items():
            if tag := latest.get(name):
                at = self.lines(tag.start)
                line = at if name == "BPMS" else line
                into.extend(segments.pairs(self.text(tag), name, at, warnings))
        if tag := latest.get("OFFSET"):
            raw.offset = self._offset(tag, warnings)
        self._signatures(latest.get("TIMESIGNATURES"), warnings)
        if self.format == "sm":
            raw = segments.negative_to_warps(raw, warnings, line)
        return _timing(raw, warnings, line)

    def _offset(self, tag: Tag, warnings: list[ReadWarning]) -> Fraction:
        text = self.text(tag)
        value = segments.number(text)
        if value is None or text.strip(" \t\r\n").lstrip("+-").strip("0123456789.eE+-"):
            if text:
                warnings.append(
                    ReadWarning("odd-offset", f"OFFSET '{text[:40]}' is not a number; read as {float(value or 0):g}",
                                self.lines(tag.start))
                )  # fmt: skip
            return value or Fraction(0)
        return value

    def _signatures(self, tag: Tag | None, warnings: list[ReadWarning]) -> None:
        for entry in self.text(tag).split(",") if tag else []:
            parts = [segments.number(p) for p in entry.split("=")]
            if entry.strip() and (len(parts) < 3 or any(p is None or p <= 0 for p in parts[1:3])):
                assert tag is not None
                text = f"time signature '{entry.strip()[:40]}' is ignored"
                warnings.append(ReadWarning("odd-time-signature", text, self.lines(tag.start)))

    def chart(
        self, fields: dict[str, str], span: tuple[int, int], timing: Timing, line: int, warnings: list[ReadWarning],
        tags: dict[str, str],
    ) -> None:  # fmt: skip
        steps_type = fields["STEPSTYPE"].lower().strip()
        columns = names.COLUMNS.get(steps_type, 0)
        if not columns:
            columns = len(first_row(self.data, span))
            text = f"steps type '{steps_type}' is unknown; its first row has {columns} columns"
            warnings.append(ReadWarning("unknown-steps-type", text, line))
        read = read_notes(self.data, span, max(columns, 1), timing, self.lines)
        self.charts.append(
            Chart(
                index=len(self.charts), steps_type=steps_type,
                difficulty=names.difficulty(fields.get("DIFFICULTY", ""), fields.get("DESCRIPTION", "")),
                meter=self._meter(fields.get("METER", ""), line, warnings),
                description=fields.get("DESCRIPTION", ""), columns=columns, notes=read.notes, rows=read.rows,
                measures=read.measures, timing=timing, notes_span=span, line=line, tags=tags,
                warnings=(*warnings, *read.warnings),
            )
        )  # fmt: skip

    def _meter(self, text: str, line: int, warnings: list[ReadWarning]) -> int:
        value = segments.number(text)
        if value is not None and 0 <= value < 2**31:
            return int(value)
        warnings.append(ReadWarning("odd-meter", f"meter '{text[:40]}' is no usable number; read as 1", line))
        return 1

    def finish(self, song_tags: list[Tag], timing: Timing) -> Song:
        values = self.values(song_tags)
        for tag in song_tags:
            raw = self.data[tag.spans[-1][1] : tag.spans[-1][1] + 1] if tag.spans else b""
            if raw == b"#" and tag.name in ("TITLE", "SUBTITLE", "ARTIST", "MUSIC") and not self.text(tag):
                text = f"the value of {tag.name} starts with '#', which starts a new tag in the games"
                self.warnings.append(ReadWarning("hash-in-value", text, self.lines(tag.start)))
        self._oddities(values)
        return Song(
            path=self.path, format=self.format, data=self.data, encoding=_encoding(self.data),
            title=values.get("TITLE", ""), subtitle=values.get("SUBTITLE", ""), artist=values.get("ARTIST", ""),
            music=values.get("MUSIC", ""), tags=values, timing=timing, charts=tuple(self.charts),
            warnings=tuple(self.warnings),
        )  # fmt: skip

    def _oddities(self, values: dict[str, str]) -> None:
        if b"\r" in self.data and b"\n" not in self.data:
            self.warnings.append(
                ReadWarning("cr-only", "lines end at CR alone: the games read each measure as one row")
            )
        if b"\0" in self.data:
            self.warnings.append(ReadWarning("nul-byte", "the file has NUL bytes"))
        seen: dict[tuple[str, str], Chart] = {}
        for chart in self.charts:
            first = seen.setdefault((chart.steps_type, chart.difficulty), chart)
            if first is not chart and chart.difficulty != "Edit":
                text = f"a second {chart.steps_type} {chart.difficulty}: the games show it as an Edit; choose by index"
                self.warnings.append(ReadWarning("duplicate-difficulty", text, chart.line))
        if (name := values.get("MUSIC", "")) and suspicious_music(name):
            text = f"MUSIC '{name[:60]}' is not a plain file name inside the song's folder; it will not be opened"
            self.warnings.append(ReadWarning("unsafe-music", text))


class _Sm(_Reader):
    format = "sm"

    @staticmethod
    def hint(tags: list[Tag]) -> str:
        if any(tag.name == "NOTEDATA" for tag in tags):
            return ": the text is in .ssc form; rename the file to .ssc"
        return ""

    def song(self) -> Song:
        song_tags = [tag for tag in self.tags if tag.name != "NOTES"]
        timing = self.timing(song_tags, self.warnings)
        for tag in self.tags:
            if tag.name != "NOTES":
                continue
            line = self.lines(tag.start)
            if len(tag.spans) < 6:
                text = f"NOTES has {len(tag.spans)} of 6 fields; the chart is skipped"
                self.warnings.append(ReadWarning("chart-skipped", text, line))
                continue
            keys = ("STEPSTYPE", "DESCRIPTION", "DIFFICULTY", "METER", "RADARVALUES")
            fields = {key: self.text(tag, i) for i, key in enumerate(keys)}
            self.chart(fields, tag.spans[5], timing, line, [], fields)
        return self.finish(song_tags, timing)


class _Ssc(_Reader):
    format = "ssc"

    def song(self) -> Song:
        song_tags, groups = self._groups()
        timing = self.timing(song_tags, self.warnings)
        for group, notes in groups:
            fields = self.values(group)
            line = self.lines(notes.start)
            if not fields.get("STEPSTYPE"):
                text = "a chart without STEPSTYPE is skipped"
                self.warnings.append(ReadWarning("chart-skipped", text, line))
                continue
            warnings: list[ReadWarning] = []
            own = [tag for tag in group if tag.name in TIMING_TAGS]
            chart_timing = timing
            if own:
                if not any(tag.name == "BPMS" for tag in own):
                    named = ", ".join(sorted({tag.name for tag in own}))
                    text = f"{named} switches the chart to timing of its own, which has no BPMS: it plays at 60 BPM"
                    warnings.append(ReadWarning("split-timing-without-bpms", text, line))
                chart_timing = self.timing(own, warnings)
            span = notes.spans[0] if notes.spans else (notes.start, notes.start)
            self.chart(fields, span, chart_timing, line, warnings, fields)
        return self.finish(song_tags, timing)

    def _groups(self) -> tuple[list[Tag], list[tuple[list[Tag], Tag]]]:
        """Song tags, and per chart its tags and its NOTES. Tags between NOTES and NOTEDATA are the song's."""
        song_tags: list[Tag] = []
        groups: list[tuple[list[Tag], Tag]] = []
        current: list[Tag] | None = None
        opened = 0
        for tag in self.tags:
            if tag.name == "NOTEDATA":
                if current is not None:
                    text = "NOTEDATA without NOTES: its tags merge into the next chart"
                    self.warnings.append(ReadWarning("notedata-without-notes", text, self.lines(opened)))
                else:
                    current = []
                opened = tag.start
            elif current is None:
                if tag.name != "NOTES":
                    song_tags.append(tag)
            elif tag.name == "NOTES":
                groups.append((current, tag))
                current = None
            else:
                current.append(tag)
        if current is not None:
            text = "the last NOTEDATA has no NOTES; the chart is skipped"
            self.warnings.append(ReadWarning("chart-skipped", text, self.lines(opened)))
        return song_tags, groups


def suspicious_music(name: str) -> bool:
    """Whether a music name is more than a plain relative file name: absolute, climbing, a URL or an option."""
    plain = name.replace("\\", "/")
    return plain.startswith(("/", "-", "~")) or ":" in plain or ".." in plain.split("/") or "|" in plain


def _encoding(data: bytes) -> str:
    try:
        data.decode("utf-8")
        return "utf-8-sig" if data.startswith(b"\xef\xbb\xbf") else "utf-8"
    except UnicodeDecodeError:
        return "legacy"


def _timing(raw: segments.Raw, warnings: list[ReadWarning], line: int) -> Timing:
    """Check values and bring beats to ticks."""
    bpms = []
    for beat, value in raw.bpms:
        if value > 0:
            bpms.append((beat, value))
        elif raw.bpms:
            text = f"BPM {float(value):g} at beat {float(beat):g} is ignored"
            warnings.append(ReadWarning("odd-timing", text, line))
    if not bpms:
        warnings.append(ReadWarning("no-bpm", "no usable BPM: 60 is taken", line))
        bpms = [(Fraction(0), Fraction(60))]
    at_start = [pair for pair in bpms if pair[0] <= 0][-1:] or bpms[:1]
    bpms = [(Fraction(0), at_start[0][1]), *(pair for pair in bpms if pair[0] > 0)]
    warps = [pair for pair in raw.warps if pair[1] > 0]
    for beat, length in raw.warps:
        if length <= 0:
            text = f"warp of {float(length):g} beats at {float(beat):g} is ignored"
            warnings.append(ReadWarning("odd-timing", text, line))
    for (a, length), (b, _) in itertools.pairwise(warps):
        if b < a + length:
            warnings.append(ReadWarning("odd-timing", f"warps overlap at beat {float(b):g}", line))
    for beat, value in (*raw.stops, *raw.delays):
        if abs(value) > 3600:
            text = f"stop of {float(value):g} s at beat {float(beat):g} is more than an hour"
            warnings.append(ReadWarning("odd-timing", text, line))
    seconds: Callable[[segments.Pairs], Segments] = _at_ticks
    return Timing(
        bpms=_at_ticks(bpms), stops=seconds(raw.stops), delays=seconds(raw.delays), warps=_lengths(warps),
        fakes=_lengths([pair for pair in raw.fakes if pair[1] > 0]), offset=raw.offset,
    )  # fmt: skip


def _at_ticks(pairs: segments.Pairs) -> Segments:
    return tuple((segments.tick_of(beat), value) for beat, value in segments.last_of_each_beat(pairs))


def _lengths(pairs: segments.Pairs) -> Segments:
    kept = segments.last_of_each_beat(pairs)
    return tuple((segments.tick_of(beat), length * TICKS_PER_BEAT) for beat, length in kept)
