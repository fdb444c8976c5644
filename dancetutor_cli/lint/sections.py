"""Parse the part of a chart that a motion or a film shows: a section, the rows around a finding, a hard passage."""

from __future__ import annotations

import math
import re
from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.feet.passages import hardest_passages
from dancetutor_cli.run.errors import UsageError, plural

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.chart.timing import Timing
    from dancetutor_cli.feet.preset import Preset

_POINT = re.compile(
    r"\s*(?:(?P<unit>[bm])\s*(?P<after>[\d.]+)|(?P<number>[\d.]+)\s*(?P<suffix>[bms]?))\s*", re.IGNORECASE
)
_SECTION_HELP = "write START:END in seconds (10:25), beats (b16:b48) or measures (m4:m12); either end may be left out"
AROUND = 8  # beats before and after a finding
_FINDING = re.compile(r"\s*(DT\d{3})\s*:\s*(\d+)\s*", re.IGNORECASE)
_HARDEST = re.compile(r"\s*hardest\s*:\s*(\d+)\s*", re.IGNORECASE)


def check_part(text: str) -> None:
    """Raise `UsageError` for a text that can be no part of any chart, before a chart is read."""
    if not _FINDING.fullmatch(text) and not _HARDEST.fullmatch(text):
        _ends(text)


def part_of(text: str, song: Song, chart: Chart, preset: Preset, end: float) -> tuple[float, float]:
    """Return the first and the last second of a part.

    Parameters
    ----------
    text : START:END in seconds, beats or measures (`parse_section`); RULE:N, four measures around the N-th finding; or
        hardest:N, the N-th hardest passage (`hardest_passages`)
    preset : the cost preset with which the feet are found
    end : second at which the chart ends; no part continues after it, and UsageError if a part begins after it
    """
    if match := _FINDING.fullmatch(text):
        first, last = _around_finding(song, chart, preset, match[1].upper(), int(match[2]))
        return max(0.0, first), min(end, last)
    if match := _HARDEST.fullmatch(text):
        first, last = _hardest(song, chart, preset, int(match[1]))
        return first, min(end, last)
    return parse_section(text, chart.timing, end)


def _hardest(song: Song, chart: Chart, preset: Preset, number: int) -> tuple[float, float]:
    from dancetutor_cli.lint.subject import solved_chart

    play = solved_chart(song, chart, preset).play
    found = () if play is None else hardest_passages(play, chart.timing)
    if not 1 <= number <= len(found):
        most = len(found)
        has = f"only {plural(most, 'hard passage')}: write {_numbered('hardest', most)}" if most else "no hard passage"
        raise UsageError(f"--section hardest:{number}: the chart has {has}")
    return max(0.0, found[number - 1].start), found[number - 1].end


def _around_finding(song: Song, chart: Chart, preset: Preset, rule: str, number: int) -> tuple[float, float]:
    from dancetutor_cli.lint.check import findings_of
    from dancetutor_cli.lint.rule import rule_named
    from dancetutor_cli.lint.subject import solved_chart

    findings = findings_of(solved_chart(song, chart, preset))
    found = [one.beat for one in findings if one.rule == rule and one.beat is not None]
    if not 1 <= number <= len(found):
        rule_named(rule)
        counts = Counter(one.rule for one in findings if one.beat is not None)
        choices = [_numbered(code, count) for code, count in sorted(counts.items())]
        has = " or ".join(filter(None, (", ".join(choices[:-1]), *choices[-1:])))
        many = plural(len(found), "finding") if found else "no finding"
        there = f"; choose {has}" if has else ""
        raise UsageError(f"--section {rule}:{number}: the chart has {many} of {rule}{there}")
    beat = found[number - 1]
    ends = chart.timing.seconds_of_beats(np.array([max(0.0, beat - AROUND), beat + AROUND]))
    return float(ends[0]), float(ends[1])


def _numbered(name: str, count: int) -> str:
    """All of `count` choices that are numbered from 1: "DT202:1", "DT213:1 to DT213:4"."""
    return f"{name}:1" + (f" to {name}:{count}" if count > 1 else "")


def parse_section(text: str, timing: Timing, end_second: float) -> tuple[float, float]:
    """Return the first and the last second of a section.

    Parameters
    ----------
    text : `START:END`; a plain number is seconds, `b16` a beat, `m4` a measure of 4 beats; also `16b`, `4m`, `10s`
    end_second : where the song ends; it stands for a missing end, and second 0 for a missing start

    Raises `UsageError` if the text is not a section, or if the section is empty, runs backwards or is after the song.
    """
    first, last = _ends(text)
    start = _second(*first, timing) if first else 0.0
    end = _second(*last, timing) if last else end_second
    if start >= end_second:
        raise UsageError(f"--section {text} starts at {start:.1f} s, after the end of the song at {end_second:.1f} s")
    if end < start:
        raise UsageError(f"--section {text} ends at {end:.1f} s, before it starts at {start:.1f} s: exchange the two")
    if end == start:
        raise UsageError(f"--section {text} starts and ends at {start:.1f} s; write a later end")
    return start, min(end, end_second)


def _ends(text: str) -> tuple[tuple[float, str] | None, tuple[float, str] | None]:
    """Return number and unit ("s", "b" or "m") of both ends; None for an end that is left out."""
    start, colon, end = text.partition(":")
    if not colon or ":" in end or not (start.strip() or end.strip()):
        raise UsageError(f"--section {text} cannot be read; {_SECTION_HELP}")
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
        raise UsageError(f"--section {whole}: '{point.strip()}' cannot be read; {_SECTION_HELP}")
    return number, (match["unit"] or match["suffix"] or "s").lower()


def _second(number: float, unit: str, timing: Timing) -> float:
    if unit == "s":
        return number
    beat = number * 4 if unit == "m" else number
    return float(timing.seconds_of_beats(np.array([beat]))[0])
