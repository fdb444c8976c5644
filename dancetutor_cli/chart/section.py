"""A part of a song, as users write it: `START:END` in seconds, beats or measures."""

from __future__ import annotations

import math
import re

import numpy as np

from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.errors import UsageError

_POINT = re.compile(
    r"\s*(?:(?P<unit>[bm])\s*(?P<after>[\d.]+)|(?P<number>[\d.]+)\s*(?P<suffix>[bms]?))\s*", re.IGNORECASE
)
_HOW = "write START:END in seconds (10:25), beats (b16:b48) or measures (m4:m12); either end may be left out"


def check_section(text: str) -> None:
    """Raise `UsageError` for what is no section, whatever the song: so that a slip is told before a chart is read."""
    _ends(text)


def parse_section(text: str, timing: Timing, end_second: float) -> tuple[float, float]:
    """First and last second of a section.

    Parameters
    ----------
    text : `START:END`; a plain number is seconds, `b16` a beat, `m4` a measure of 4 beats; `16b`, `4m`, `10s` will do
    end_second : where the song ends; an end left out means there, a start left out second 0

    Raises `UsageError` for what is no section, is empty or runs backwards, or lies outside the song.
    """
    first, last = _ends(text)
    start = _second(*first, timing) if first else 0.0
    end = _second(*last, timing) if last else end_second
    if start >= end_second:
        raise UsageError(f"section '{text}' starts at {start:.1f} s, after the end of the song at {end_second:.1f} s")
    if end <= start:
        raise UsageError(f"section '{text}' ends at {end:.1f} s, not after its start at {start:.1f} s")
    return start, min(end, end_second)


def _ends(text: str) -> tuple[tuple[float, str] | None, tuple[float, str] | None]:
    """Number and unit ("s", "b" or "m") of both ends; None for an end that is left out."""
    start, colon, end = text.partition(":")
    if not colon or ":" in end or not (start.strip() or end.strip()):
        raise UsageError(f"section '{text}' cannot be read; {_HOW}")
    return _point(start, text), _point(end, text)


def _point(point: str, whole: str) -> tuple[float, str] | None:
    if not point.strip():
        return None
    match = _POINT.fullmatch(point)
    try:
        number = float(match["after"] or match["number"]) if match else math.nan
    except ValueError:
        number = math.nan
    if match is None or not math.isfinite(number):
        raise UsageError(f"section '{whole}': '{point.strip()}' cannot be read; {_HOW}")
    return number, (match["unit"] or match["suffix"] or "s").lower()


def _second(number: float, unit: str, timing: Timing) -> float:
    if unit == "s":
        return number
    beat = number * 4 if unit == "m" else number
    return float(timing.seconds_of_beats(np.array([beat]))[0])
