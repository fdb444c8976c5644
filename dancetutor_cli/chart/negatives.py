"""Negative and infinite BPMs and negative stops, the old way to skip beats, become warps."""

from __future__ import annotations

from fractions import Fraction

from dancetutor_cli.chart.segments import FAST_BPM, MAX_BEAT, Raw


def has_tricks(raw: Raw) -> bool:
    """Whether there is something to turn into warps, or a stop before beat 0."""
    return any(v < 0 or v > FAST_BPM for _, v in raw.bpms) or any(b < 0 or v < 0 for b, v in raw.stops)


def to_warps(raw: Raw) -> Raw:
    """The same timing without tricks, as StepMania 5 and ITGmania make it of an .sm file.

    Time is followed through the changes. Where it starts to run backwards (or not at all) a warp begins; it ends
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
    """Keeps sums over thousands of BPMs from growing without end; exact where people look."""
    return value if value.denominator < 1 << 512 else Fraction(round(value * (1 << 96)), 1 << 96)


class _Walk:
    """Follows time through the changes. `ahead` : how far time is past the start of the open warp, in seconds."""

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
        """Let time pass up to the next change; the open warp may end on the way."""
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
        if seconds > 0 and self.ahead > 0:  # the stop makes up for more than was skipped: it stops for the rest
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
        """Close the open warp; a BPM that changed inside counts from its start."""
        assert self.warp is not None
        self.out.warps.append((self.warp, at - self.warp))
        if _runs(self.bpm) and self.bpm != self.bpm_before:
            self.out.bpms.append((self.warp, self.bpm))
