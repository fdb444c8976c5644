"""From the timing tags of a song, or of a chart that has its own, to a `Timing`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from dancetutor_cli.chart import negatives, segments
from dancetutor_cli.chart.decimals import number
from dancetutor_cli.chart.decoding import shown
from dancetutor_cli.chart.model import ReadWarning
from dancetutor_cli.chart.timing import Timing

TIMING_TAGS = frozenset({
    "BPMS", "STOPS", "DELAYS", "WARPS", "FAKES", "OFFSET", "TIMESIGNATURES", "TICKCOUNTS", "COMBOS", "SPEEDS",
    "SCROLLS", "LABELS",
})  # fmt: skip
_PAIRS = ("BPMS", "STOPS", "DELAYS", "WARPS", "FAKES")
_SSC_ONLY = ("WARPS", "FAKES")
_LONG = 3600  # seconds; a stop longer than this is named
SPLIT_TIMING_VERSION = Fraction(7, 10)  # older .ssc: no timing of a chart's own, warps say where they end


@dataclass(frozen=True, slots=True)
class Text:
    """A timing tag: its value, and the line of its `#`."""

    value: str
    line: int


@dataclass(frozen=True, slots=True)
class Source:
    """Where timing tags come from. sm : negative values are warps; version : of the .ssc file"""

    sm: bool
    version: Fraction = Fraction(1)


def read(tags: Mapping[str, Text], source: Source, offset: Fraction, warnings: list[ReadWarning], line: int) -> Timing:
    """The timing that tags describe; `offset` holds where they have no OFFSET, `line` where they have no BPMS."""
    raw = segments.Raw(offset=offset)
    for name, into in zip(_PAIRS, (raw.bpms, raw.stops, raw.delays, raw.warps, raw.fakes), strict=True):
        if tag := tags.get(name):
            warn = segments.warner(warnings, tag.line)
            if source.sm and name in _SSC_ONLY:
                if tag.value.strip():
                    warn("odd-timing", f"{name} is ignored: the games read it only in .ssc files")
                continue
            negative = source.sm and name in ("BPMS", "STOPS")
            into.extend(segments.pairs(tag.value, name, negative, warn))
    if tag := tags.get("OFFSET"):
        raw.offset = _offset(tag, warnings)
    if tag := tags.get("TIMESIGNATURES"):
        warn = segments.warner(warnings, tag.line)
        for entry in segments.odd_signatures(tag.value):
            warn("odd-time-signature", f"time signature '{entry}' is ignored; measures have 4 beats in note data")
    at = tags["BPMS"].line if "BPMS" in tags else line
    if not source.sm and source.version < SPLIT_TIMING_VERSION:
        raw.warps = [(beat, end - beat if end > beat else end) for beat, end in raw.warps]
    if source.sm:
        raw.bpms.sort(key=lambda pair: pair[0])
        raw.stops.sort(key=lambda pair: pair[0])
    return _built(raw, warnings, at)


def is_own(tags: Mapping[str, Text], source: Source) -> bool:
    """Whether a chart's tags hold any timing segment: then it uses nothing of the song's timing but the offset."""
    if source.version < SPLIT_TIMING_VERSION:
        return False
    return any(
        bool(segments.pairs(tag.value, name, False, lambda code, message: None))
        if name in _PAIRS
        else segments.holds_segment(name, tag.value)
        for name, tag in tags.items()
        if name in TIMING_TAGS and name != "OFFSET"
    )


def _offset(tag: Text, warnings: list[ReadWarning]) -> Fraction:
    value, clean = number(tag.value)
    if not clean and tag.value.strip():
        text = f"OFFSET '{shown(tag.value)}' is no decimal number; read as {float(value):g}"
        warnings.append(ReadWarning("odd-offset", text, tag.line))
    return value


def _built(raw: segments.Raw, warnings: list[ReadWarning], line: int) -> Timing:
    warn = segments.warner(warnings, line)
    for beat in segments.overlaps(raw.warps):
        warn("odd-timing", f"warps overlap at beat {float(beat):g}")
    for beat, value in (*raw.stops, *raw.delays):
        if abs(value) > _LONG:
            warn("odd-timing", f"stop of {float(value):g} s at beat {float(beat):g} is more than an hour")
    if negatives.has_tricks(raw):
        if any(value < 0 for _, value in raw.stops) or not all(0 < v <= segments.FAST_BPM for _, v in raw.bpms):
            warn("negative-timing", "negative or endless BPMs or stops: read as warps")
        raw = negatives.to_warps(raw)
    if not raw.bpms:
        warn("no-bpm", "no usable BPM: 60 is taken")
        raw.bpms.append((Fraction(0), Fraction(60)))
    bpms = segments.at_ticks(raw.bpms)
    return Timing(
        bpms=((0, bpms[0][1]), *bpms[1:]), stops=segments.at_ticks(raw.stops), delays=segments.at_ticks(raw.delays),
        warps=segments.lengths_at_ticks(raw.warps), fakes=segments.lengths_at_ticks(raw.fakes), offset=raw.offset,
    )  # fmt: skip
