"""Read the timing tags of a song, or of a chart with its own timing, into a `Timing`: decimals, segments, warps."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache

from dancetutor_cli.chart.model import ReadWarning
from dancetutor_cli.chart.msd import quote
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.timing import Segments, Timing

# Numbers as the games read them (C's strtof and atoi), but exact.

_NUMBER = re.compile(r"\s*([+-]?)(?:(\d+)(?:\.(\d*))?|\.(\d+))(?:[eE]([+-]?\d+))?(.*)", re.DOTALL | re.ASCII)
_LARGEST = 35 * 10**37  # larger numbers are infinite as the games' floats, and the games read them as 0
_SHORT = 40  # the numbers of texts with fewer characters are cached
_DIGITS = 60  # limit of decimals, more than anyone needs; Python refuses to read thousands


def parse_number(text: str) -> tuple[Fraction, bool]:
    """Return the decimal at the start of a text, and whether the text is only that. Junk and infinite numbers are 0."""
    return _cached_number(text) if len(text) < _SHORT else _number(text)


def _number(text: str) -> tuple[Fraction, bool]:
    match = _NUMBER.match(text)
    if match is None:
        return Fraction(0), False
    sign, whole, decimals, only_decimals, exponent, rest = match.groups()
    decimals = (decimals or only_decimals or "")[:_DIGITS]
    whole = (whole or "").lstrip("0")
    power = int(exponent) if exponent and len(exponent) < 6 else 0 if not exponent else 10**6
    if exponent and exponent.startswith("-") and power == 10**6:
        power = -power
    clean = not rest.strip()
    if len(whole) + power > 39 or len(whole) > 2 * _DIGITS:
        return Fraction(0), False
    if power < -_DIGITS - 39:
        return Fraction(0), clean
    digits = int(whole + decimals or "0")
    if sign == "-":
        digits = -digits
    scale = power - len(decimals)
    value = Fraction(digits * 10**scale) if scale >= 0 else Fraction(digits, 10**-scale)
    if len(whole) + power > 30 and abs(value) > _LARGEST:
        return Fraction(0), False
    return value, clean


_cached_number = lru_cache(maxsize=8192)(_number)  # charts of a song mostly repeat the same texts


def beat(text: str) -> tuple[Fraction, bool]:
    """Return a beat, and whether the text is only that; with the suffix `r` it is given in rows of 1/48 beat."""
    stripped = text.strip()
    bare = stripped.strip("rR")
    value, clean = parse_number(bare)
    return (value / TICKS_PER_BEAT if bare != stripped else value), clean


def tick_of(beat: Fraction) -> int:
    """Return a beat in ticks of 1/48 beat, with halves rounded to even."""
    return round(beat * TICKS_PER_BEAT)


# From the text of timing tags to segments in beats: exact decimals; warnings name junk, which is not guessed at.

FAST_BPM = 9_999_999  # a faster BPM is a warp, as in the games
MAX_BEAT = 2**30 // TICKS_PER_BEAT  # beyond this beat, row numbers overflow in the games

Pairs = list[tuple[Fraction, Fraction]]  # (beat, value) in file order
Warn = Callable[[str, str], None]  # code, message


@dataclass(slots=True)
class Raw:
    """The segments of one song or chart, by beat.

    bpms : BPM; stops, delays, offset : seconds; warps, fakes : length in beats
    """

    bpms: Pairs = field(default_factory=list)
    stops: Pairs = field(default_factory=list)
    delays: Pairs = field(default_factory=list)
    warps: Pairs = field(default_factory=list)
    fakes: Pairs = field(default_factory=list)
    offset: Fraction = Fraction(0)


def entries(text: str) -> list[tuple[str, list[str]]]:
    """Return the entries of `a=b,a=b`, each with its parts; empty parts do not count, as in the games."""
    return [(entry, [p for p in entry.split("=") if p]) for entry in text.split(",") if entry.strip()]


def pairs(text: str, tag: str, negative: bool, warn: Warn) -> Pairs:
    """Return the usable entries of `beat=value,beat=value` in file order.

    negative : whether entries with a negative beat or value are usable
    """
    out: Pairs = []
    for entry, parts in entries(text):
        if len(parts) != 2:
            warn("odd-timing", f"{tag} entry '{quote(entry)}' has not exactly one '=' and is ignored")
            continue
        (at, clean), (value, clean_value) = beat(parts[0]), parse_number(parts[1])
        below = value.numerator < 0  # ten times as fast as a comparison of fractions
        if abs(at.numerator) > MAX_BEAT * at.denominator:
            warn("odd-timing", f"{tag} entry '{quote(entry)}' is too large for any song and is ignored")
        elif (below or (at.numerator < 0 and tag in ("BPMS", "STOPS"))) and not negative:
            warn("odd-timing", f"{tag} entry '{quote(entry)}' is negative and is ignored")
        elif not value.numerator:
            if not clean_value or tag != "STOPS":
                warn("odd-timing", f"{tag} entry '{quote(entry)}' has no usable value and is ignored")
        else:
            if not clean or not clean_value:
                read = f"{float(at):g}={float(value):g}"
                warn("odd-timing", f"{tag} entry '{quote(entry)}' is not a pair of numbers; read as {read}")
            out.append((at, value))
    return out


def at_ticks(segments: Pairs) -> Segments:
    """Return segments by tick; of several segments on one tick, the last one counts."""
    return tuple(sorted({tick_of(at): value for at, value in segments}.items()))


def lengths_at_ticks(segments: Pairs) -> Segments:
    """Return warps or fakes by tick, with their lengths in whole ticks."""
    found = {
        tick_of(at): tick_of(min(length, Fraction(2 * MAX_BEAT))) for at, length in segments
    }  # longer ones end after every song too
    return tuple((at, Fraction(length)) for at, length in sorted(found.items()) if length > 0)


def holds_segment(tag: str, text: str) -> bool:
    """Whether a chart's own timing tag holds a segment, so that the chart leaves the song's timing.

    Source: the games' readers of TIMESIGNATURES, TICKCOUNTS, COMBOS, SPEEDS, SCROLLS and LABELS. For the other timing
    tags, `pairs` decides; an OFFSET alone does not make the chart leave the song's timing.
    """
    least = {"TIMESIGNATURES": 3, "TICKCOUNTS": 2, "COMBOS": 2, "SPEEDS": 3, "SCROLLS": 2, "LABELS": 2}[tag]
    for _, parts in entries(text):
        if len(parts) < least or (tag in ("TICKCOUNTS", "LABELS") and len(parts) != 2):
            continue
        numbers = [parse_number(p)[0] for p in parts]
        if tag == "TIMESIGNATURES" and (numbers[1] < 1 or numbers[2] < 1):
            continue
        if numbers[0] >= 0 or tag in ("TICKCOUNTS", "COMBOS"):
            return True
    return False


def odd_signatures(text: str) -> list[str]:
    """Return the entries of TIMESIGNATURES that the games ignore."""
    out = []
    for entry, parts in entries(text):
        numbers = [math.trunc(parse_number(p)[0]) for p in parts[:3]]
        if len(numbers) < 3 or numbers[0] < 0 or numbers[1] < 1 or numbers[2] < 1:
            out.append(quote(entry))
    return out


def warner(into: list[ReadWarning], line: int) -> Warn:
    """Return a function that adds warnings about one line: for each code the first 20, then one that there are more."""
    seen: dict[str, int] = {}

    def warn(code: str, message: str) -> None:
        seen[code] = seen.get(code, 0) + 1
        if seen[code] <= 20:
            into.append(ReadWarning(code, message, line))
        elif seen[code] == 21:
            into.append(ReadWarning(code, "more like these on this line", line))

    return warn


def overlaps(warps: Sequence[tuple[Fraction, Fraction]]) -> list[Fraction]:
    """Return the beats at which a warp starts inside the warp before it."""
    order = sorted(warps)
    return [order[i + 1][0] for i in range(len(order) - 1) if order[i + 1][0] < sum(order[i])]


# Negative and infinite BPMs and negative stops, the old way to skip beats, become warps.


def has_tricks(raw: Raw) -> bool:
    """Whether the timing has negative or infinite values that become warps, or a stop before beat 0."""
    return any(v < 0 or v > FAST_BPM for _, v in raw.bpms) or any(b < 0 or v < 0 for b, v in raw.stops)


def to_warps(raw: Raw) -> Raw:
    """Return the same timing without tricks, as StepMania 5 and ITGmania convert that of an .sm file.

    Time is followed through the changes. A warp begins where time starts to run backwards or stands still; it ends
    where time is back at that point. Source: the games' `ProcessBPMsAndStops`.
    """
    walk = _Walk(raw)
    before = [pair for pair in sorted(raw.bpms, key=_beat) if pair[0] <= 0]
    bpms = [pair for pair in sorted(raw.bpms, key=_beat) if pair[0] > 0]
    stops = [pair for pair in sorted(raw.stops, key=_beat) if pair[0] >= 0]
    walk.out.offset -= sum((value for at, value in raw.stops if at < 0), Fraction(0))
    walk.start(before[-1][1] if before else bpms.pop(0)[1] if bpms else Fraction(60))
    changes = sorted([(at, 0, v) for at, v in bpms] + [(at, 1, v) for at, v in stops], key=lambda c: c[:2])
    for at, is_stop, value in changes:
        walk.advance(at)
        if is_stop:
            walk.stop(at, value)
        else:
            walk.change(at, value)
    walk.finish()
    return walk.out


def _beat(pair: tuple[Fraction, Fraction]) -> Fraction:
    return pair[0]


def _runs(bpm: Fraction) -> bool:
    return 0 < bpm <= FAST_BPM


def _short(value: Fraction) -> Fraction:
    """Round a value with a very long denominator to 1/2**96; sums over thousands of BPMs would grow without end."""
    return value if value.denominator < 1 << 512 else Fraction(round(value * (1 << 96)), 1 << 96)


class _Walk:
    """Time on its way through the changes. `ahead` : seconds from the time at the start of the open warp to now."""

    def __init__(self, raw: Raw) -> None:
        self.out = Raw(delays=raw.delays, warps=list(raw.warps), fakes=raw.fakes, offset=raw.offset)
        self.bpm = self.bpm_before = Fraction(0)
        self.here = self.ahead = Fraction(0)
        self.warp: Fraction | None = None

    def start(self, bpm: Fraction) -> None:
        self.bpm = bpm
        if _runs(bpm):
            self.out.bpms.append((Fraction(0), bpm))

    def advance(self, at: Fraction) -> None:
        """Advance to the beat of the next change; the open warp may end before it."""
        if self.warp is not None and self.bpm <= FAST_BPM:
            self.ahead = _short(self.ahead + (at - self.here) * 60 / self.bpm)
            if self.bpm > 0 and self.ahead > 0:
                self._end(at - self.ahead * self.bpm / 60)
                self.warp = None
        self.here = at

    def change(self, at: Fraction, bpm: Fraction) -> None:
        if self.warp is None:
            if _runs(bpm):
                self.out.bpms.append((at, bpm))
            else:
                self.warp, self.bpm_before, self.ahead = at, self.bpm, Fraction(0)
        self.bpm = bpm

    def stop(self, at: Fraction, seconds: Fraction) -> None:
        if self.warp is None:
            if seconds < 0:
                self.warp, self.bpm_before, self.ahead = at, self.bpm, seconds
            else:
                self.out.stops.append((at, seconds))
            return
        self.ahead += seconds
        if seconds > 0 and self.ahead > 0:  # the stop is longer than the skipped time: the rest remains
            self.out.stops.append((at, self.ahead))
            if _runs(self.bpm):
                self._end(at)
                self.warp = None
            else:
                self.out.warps.append((self.warp, at - self.warp))
                self.warp, self.ahead = at, Fraction(0)

    def finish(self) -> None:
        if self.warp is not None:
            self._end(self.here - self.ahead * self.bpm / 60 if _runs(self.bpm) else Fraction(MAX_BEAT))

    def _end(self, at: Fraction) -> None:
        """Close the open warp at a beat; a BPM that changed inside the warp counts from its start."""
        assert self.warp is not None
        self.out.warps.append((self.warp, at - self.warp))
        if _runs(self.bpm) and self.bpm != self.bpm_before:
            self.out.bpms.append((self.warp, self.bpm))


TIMING_TAGS = frozenset({
    "BPMS", "STOPS", "DELAYS", "WARPS", "FAKES", "OFFSET", "TIMESIGNATURES", "TICKCOUNTS", "COMBOS", "SPEEDS",
    "SCROLLS", "LABELS",
})  # fmt: skip
_PAIRS = ("BPMS", "STOPS", "DELAYS", "WARPS", "FAKES")
_SSC_ONLY = ("WARPS", "FAKES")
_LONG = 3600  # seconds; a longer stop gets a warning
SPLIT_TIMING_VERSION = Fraction(7, 10)  # in older .ssc files, no chart has its own timing, and warps give their end


@dataclass(frozen=True, slots=True)
class Text:
    """A timing tag: its value, and the line of its `#`."""

    value: str
    line: int


@dataclass(frozen=True, slots=True)
class Source:
    """The file of timing tags. sm : whether it is an .sm file, where negative values are warps; version : of .ssc"""

    sm: bool
    version: Fraction = Fraction(1)


def read(tags: Mapping[str, Text], source: Source, offset: Fraction, warnings: list[ReadWarning], line: int) -> Timing:
    """Return the timing that tags describe.

    offset : seconds, used if the tags have no OFFSET; line : line for warnings if the tags have no BPMS
    """
    raw = Raw(offset=offset)
    for name, into in zip(_PAIRS, (raw.bpms, raw.stops, raw.delays, raw.warps, raw.fakes), strict=True):
        if tag := tags.get(name):
            warn = warner(warnings, tag.line)
            if source.sm and name in _SSC_ONLY:
                if tag.value.strip():
                    warn("odd-timing", f"{name} is ignored: the games read it only in .ssc files")
                continue
            negative = source.sm and name in ("BPMS", "STOPS")
            into.extend(pairs(tag.value, name, negative, warn))
    if tag := tags.get("OFFSET"):
        raw.offset = _offset(tag, warnings)
    if tag := tags.get("TIMESIGNATURES"):
        warn = warner(warnings, tag.line)
        for entry in odd_signatures(tag.value):
            warn("odd-time-signature", f"time signature '{entry}' is ignored; measures have 4 beats in note data")
    at = tags["BPMS"].line if "BPMS" in tags else line
    if not source.sm and source.version < SPLIT_TIMING_VERSION:
        raw.warps = [(beat, end - beat if end > beat else end) for beat, end in raw.warps]
    if source.sm:
        raw.bpms.sort(key=lambda pair: pair[0])
        raw.stops.sort(key=lambda pair: pair[0])
    return _built(raw, warnings, at)


def is_own(tags: Mapping[str, Text], source: Source) -> bool:
    """Whether a chart's tags hold any timing segment; if so, it uses only the offset of the song's timing."""
    if source.version < SPLIT_TIMING_VERSION:
        return False
    return any(
        bool(pairs(tag.value, name, False, lambda code, message: None))
        if name in _PAIRS
        else holds_segment(name, tag.value)
        for name, tag in tags.items()
        if name in TIMING_TAGS and name != "OFFSET"
    )


def _offset(tag: Text, warnings: list[ReadWarning]) -> Fraction:
    value, clean = parse_number(tag.value)
    if not clean and tag.value.strip():
        text = f"OFFSET '{quote(tag.value)}' is not a decimal number; read as {float(value):g}"
        warnings.append(ReadWarning("odd-offset", text, tag.line))
    return value


def _built(raw: Raw, warnings: list[ReadWarning], line: int) -> Timing:
    warn = warner(warnings, line)
    for beat in overlaps(raw.warps):
        warn("odd-timing", f"warps overlap at beat {float(beat):g}")
    for beat, value in (*raw.stops, *raw.delays):
        if abs(value) > _LONG:
            warn("odd-timing", f"stop of {float(value):g} s at beat {float(beat):g} is more than an hour")
    if has_tricks(raw):
        if any(value < 0 for _, value in raw.stops) or not all(0 < v <= FAST_BPM for _, v in raw.bpms):
            warn("negative-timing", "negative or infinite BPMs or stops are read as warps")
        raw = to_warps(raw)
    if not raw.bpms:
        warn("no-bpm", "there is no usable BPM, so 60 BPM is used")
        raw.bpms.append((Fraction(0), Fraction(60)))
    bpms = at_ticks(raw.bpms)
    return Timing(
        bpms=((0, bpms[0][1]), *bpms[1:]), stops=at_ticks(raw.stops), delays=at_ticks(raw.delays),
        warps=lengths_at_ticks(raw.warps), fakes=lengths_at_ticks(raw.fakes), offset=raw.offset,
    )  # fmt: skip
