"""Numbers as the games read them (C's strtof and atoi), but exact."""

from __future__ import annotations

import re
from fractions import Fraction
from functools import lru_cache

from dancetutor_cli.chart.model import TICKS_PER_BEAT

_NUMBER = re.compile(r"\s*([+-]?)(?:(\d+)(?:\.(\d*))?|\.(\d+))(?:[eE]([+-]?\d+))?(.*)", re.DOTALL | re.ASCII)
_LARGEST = 35 * 10**37  # beyond it the games' floats are infinite, which they read as 0
_SHORT = 40  # characters of a text that is worth to be kept
_DIGITS = 60  # more decimals than any use has; Python refuses to read thousands


def number(text: str) -> tuple[Fraction, bool]:
    """The decimal at the start of a text, and whether the text is nothing else. Junk and the not finite are 0."""
    return _known(text) if len(text) < _SHORT else _number(text)


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


_known = lru_cache(maxsize=8192)(_number)  # charts of a song mostly say the same again


def beat(text: str) -> tuple[Fraction, bool]:
    """A beat; with the suffix `r` it is given in rows of 1/48 beat."""
    stripped = text.strip()
    bare = stripped.strip("rR")
    value, clean = number(bare)
    return (value / TICKS_PER_BEAT if bare != stripped else value), clean


def tick_of(beat: Fraction) -> int:
    """Beat to ticks of 1/48, halves to even."""
    return round(beat * TICKS_PER_BEAT)
