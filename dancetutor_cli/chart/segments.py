"""From the text of timing tags to segments: exact decimals, junk named in warnings, negative values as warps."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from fractions import Fraction

from dancetutor_cli.chart.model import TICKS_PER_BEAT, ReadWarning

FAST_BPM = 9_999_999  # anything faster is a warp, as the games have it
MAX_BEAT = 2**30 // TICKS_PER_BEAT  # beyond this row numbers overflow in the games
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(.*)", re.DOTALL)

Pairs = list[tuple[Fraction, Fraction]]


@dataclass(slots=True)
class Raw:
    """Segments of one song or chart as written, (beat, value) sorted by beat."""

    bpms: Pairs = field(default_factory=list)
    stops: Pairs = field(default_factory=list)
    delays: Pairs = field(default_factory=list)
    warps: Pairs = field(default_factory=list)
    fakes: Pairs = field(default_factory=list)
    offset: Fraction = Fraction(0)


def number(text: str) -> Fraction | None:
    """The decimal at the start of a text, as C's strtof reads it; None for junk and what is not finite."""
    match = _NUMBER.match(text)
    if match is None:
        return None
    _mantissa, _, exponent = match[1].lower().partition("e")
    if exponent and abs(int(exponent)) > 60:
        return None
    return Fraction(match[1])


def tick_of(beat: Fraction) -> int:
    """Beat to ticks of 1/48, halves to even."""
    return round(beat * TICKS_PER_BEAT)


def pairs(text: str, tag: str, line: int, warnings: list[ReadWarning]) -> Pairs:
    """The entries of `beat=value,beat=value`; a beat may be given in rows with the suffix `r`."""
    out: Pairs = []
    for entry in text.split(","):
        if not entry.strip():
            continue
        left, equals, right = entry.partition("=")
        beat, value = number(left), number(right)
        if not equals or beat is None or value is None or abs(beat) > MAX_BEAT or not math.isfinite(float(value)):
            shown = " ".join(entry.split())[:40]
            warnings.append(ReadWarning("odd-timing", f"{tag} entry '{shown}' cannot be used and is ignored", line))
            continue
        if left.strip().lower().endswith("r"):
            beat /= TICKS_PER_BEAT
        out.append((beat, value))
    return sorted(out, key=lambda pair: pair[0])


def last_of_each_beat(segments: Pairs) -> Pairs:
    """Of several entries on one tick the last counts."""
    return list({tick_of(beat): (beat, value) for beat, value in segments}.values())


def negative_to_warps(raw: Raw, warnings: list[ReadWarning], line: int) -> Raw:
    """.sm files: negative or infinite BPMs and negative stops become warps, as StepMania 5 reads them.

    Time is followed through the changes; while it lies behind where it first ran backwards, the beats are a warp.
    """
    out = Raw(delays=raw.delays, warps=list(raw.warps), fakes=raw.fakes, offset=raw.offset)
    out.offset -= sum((value for beat, value in raw.stops if beat < 0), Fraction(0))
    stops = [(beat, value) for beat, value in raw.stops if beat >= 0]
    bpm = Fraction(0)
    bpms = [(beat, value) for beat, value in raw.bpms if beat > 0]
    for beat, value in raw.bpms:
        if beat <= 0 and value > 0:
            bpm = value
    if bpm == 0 and bpms:
        bpm = bpms.pop(0)[1]
    if bpm == 0:
        bpm = Fraction(60)
    if 0 < bpm <= FAST_BPM:
        out.bpms.append((Fraction(0), bpm))
    changes = sorted([(b, 0, v) for b, v in bpms] + [(b, 1, v) for b, v in stops], key=lambda c: c[:2])
    warp_start: Fraction | None = None
    before_warp, behind, previous = bpm, Fraction(0), Fraction(0)
    if any(v < 0 for _, _, v in changes) or bpm < 0:
        warnings.append(ReadWarning("negative-timing", "negative BPMs or stops: read as warps", line))
    if bpm < 0 or bpm > FAST_BPM:
        warp_start = Fraction(0)

    def end_warp(end: Fraction) -> None:
        assert warp_start is not None
        out.warps.append((warp_start, end - warp_start))
        if 0 < bpm <= FAST_BPM and bpm != before_warp:
            out.bpms.append((warp_start, bpm))

    for beat, is_stop, value in changes:
        if abs(bpm) <= FAST_BPM:
            behind += (beat - previous) * 60 / bpm
            if warp_start is not None and bpm > 0 and behind > 0:
                end_warp(beat - behind * bpm / 60)
                warp_start = None
        previous = beat
        if not is_stop:
            fast = value < 0 or value > FAST_BPM
            if warp_start is None and fast:
                warp_start, before_warp, behind = beat, bpm, Fraction(0)
            elif warp_start is None:
                out.bpms.append((beat, value))
            bpm = value
        elif warp_start is None and value < 0:
            warp_start, before_warp, behind = beat, bpm, value
        elif warp_start is None:
            out.stops.append((beat, value))
        else:
            behind += value
            if value > 0 and behind > 0:
                end_warp(beat)
                out.stops.append((beat, behind))
                fast = bpm < 0 or bpm > FAST_BPM
                warp_start, before_warp, behind = (beat, bpm, Fraction(0)) if fast else (None, bpm, Fraction(0))
    if warp_start is not None:
        fast = bpm < 0 or bpm > FAST_BPM
        end_warp(Fraction(MAX_BEAT) if fast else previous - behind * bpm / 60)
    out.warps.sort()
    return out
