"""From the text of timing tags to segments in beats: exact decimals; junk is named in warnings, not guessed."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from dancetutor_cli.chart.decimals import beat, number, tick_of
from dancetutor_cli.chart.decoding import shown
from dancetutor_cli.chart.model import TICKS_PER_BEAT, ReadWarning
from dancetutor_cli.chart.timing import Segments

FAST_BPM = 9_999_999  # anything faster is a warp, as the games have it
MAX_BEAT = 2**30 // TICKS_PER_BEAT  # beyond this row numbers overflow in the games

Pairs = list[tuple[Fraction, Fraction]]  # (beat, value) in file order
Warn = Callable[[str, str], None]  # code, message


@dataclass(slots=True)
class Raw:
    """Segments of one song or chart in beats: BPM, seconds, seconds, beats, beats; offset in seconds."""

    bpms: Pairs = field(default_factory=list)
    stops: Pairs = field(default_factory=list)
    delays: Pairs = field(default_factory=list)
    warps: Pairs = field(default_factory=list)
    fakes: Pairs = field(default_factory=list)
    offset: Fraction = Fraction(0)


def entries(text: str) -> list[tuple[str, list[str]]]:
    """The entries of `a=b,a=b`, each with its parts; empty parts do not count, as in the games."""
    return [(entry, [p for p in entry.split("=") if p]) for entry in text.split(",") if entry.strip()]


def pairs(text: str, tag: str, negative: bool, warn: Warn) -> Pairs:
    """The usable entries of `beat=value,beat=value` in file order. Only with `negative` may value and beat be so."""
    out: Pairs = []
    for entry, parts in entries(text):
        if len(parts) != 2:
            warn("odd-timing", f"{tag} entry '{shown(entry)}' has not exactly one '=' and is ignored")
            continue
        (at, clean), (value, clean_value) = beat(parts[0]), number(parts[1])
        below = value.numerator < 0  # ten times as quick as to compare fractions
        if abs(at.numerator) > MAX_BEAT * at.denominator:
            warn("odd-timing", f"{tag} entry '{shown(entry)}' is beyond every song and is ignored")
        elif (below or (at.numerator < 0 and tag in ("BPMS", "STOPS"))) and not negative:
            warn("odd-timing", f"{tag} entry '{shown(entry)}' is negative and is ignored")
        elif not value.numerator:
            if not clean_value or tag != "STOPS":
                warn("odd-timing", f"{tag} entry '{shown(entry)}' has no usable value and is ignored")
        else:
            if not clean or not clean_value:
                read = f"{float(at):g}={float(value):g}"
                warn("odd-timing", f"{tag} entry '{shown(entry)}' is no pair of numbers; read as {read}")
            out.append((at, value))
    return out


def at_ticks(segments: Pairs) -> Segments:
    """Beats to ticks; of several entries on one tick the last counts."""
    return tuple(sorted({tick_of(at): value for at, value in segments}.items()))


def lengths_at_ticks(segments: Pairs) -> Segments:
    """The same for warps and fakes, whose values are lengths: whole ticks too."""
    found = {
        tick_of(at): tick_of(min(length, Fraction(2 * MAX_BEAT))) for at, length in segments
    }  # to the end of every song
    return tuple((at, Fraction(length)) for at, length in sorted(found.items()) if length > 0)


def holds_segment(tag: str, text: str) -> bool:
    """Whether a chart's own timing tag holds a segment, so that the chart leaves the song's timing.

    Source: the games' readers of TIMESIGNATURES, TICKCOUNTS, COMBOS, SPEEDS, SCROLLS and LABELS. The other timing
    tags are asked through their pairs; an OFFSET alone switches nothing.
    """
    least = {"TIMESIGNATURES": 3, "TICKCOUNTS": 2, "COMBOS": 2, "SPEEDS": 3, "SCROLLS": 2, "LABELS": 2}[tag]
    for _, parts in entries(text):
        if len(parts) < least or (tag in ("TICKCOUNTS", "LABELS") and len(parts) != 2):
            continue
        numbers = [number(p)[0] for p in parts]
        if tag == "TIMESIGNATURES" and (numbers[1] < 1 or numbers[2] < 1):
            continue
        if numbers[0] >= 0 or tag in ("TICKCOUNTS", "COMBOS"):
            return True
    return False


def odd_signatures(text: str) -> list[str]:
    """Entries of TIMESIGNATURES that the games ignore."""
    out = []
    for entry, parts in entries(text):
        numbers = [math.trunc(number(p)[0]) for p in parts[:3]]
        if len(numbers) < 3 or numbers[0] < 0 or numbers[1] < 1 or numbers[2] < 1:
            out.append(shown(entry))
    return out


def warner(into: list[ReadWarning], line: int) -> Warn:
    """A function that adds warnings about one line; of more than 20 with one code the rest is only counted."""
    seen: dict[str, int] = {}

    def warn(code: str, message: str) -> None:
        seen[code] = seen.get(code, 0) + 1
        if seen[code] <= 20:
            into.append(ReadWarning(code, message, line))
        elif seen[code] == 21:
            into.append(ReadWarning(code, "more like these on this line", line))

    return warn


def overlaps(warps: Sequence[tuple[Fraction, Fraction]]) -> list[Fraction]:
    """Beats at which a warp starts inside the one before."""
    order = sorted(warps)
    return [order[i + 1][0] for i in range(len(order) - 1) if order[i + 1][0] < sum(order[i])]
