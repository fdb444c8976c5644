"""Which part of a chart a motion or a film is about: the same for `animate` and `render`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.timing import check_section, parse_section
from dancetutor_cli.run.errors import UsageError

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.feet.preset import Preset

AROUND = 8  # beats before and after a finding
_FINDING = re.compile(r"\s*(DT\d{3})\s*:\s*(\d+)\s*", re.IGNORECASE)
_HARDEST = re.compile(r"\s*hardest\s*:\s*(\d+)\s*", re.IGNORECASE)


def check_part(text: str) -> None:
    """UsageError for what is no part of any chart: so that a slip is told before a chart is read."""
    if not _FINDING.fullmatch(text) and not _HARDEST.fullmatch(text):
        check_section(text)


def part_of(text: str, song: Song, chart: Chart, preset: Preset, end: float) -> tuple[float, float]:
    """First and last second of a part.

    Parameters
    ----------
    text : START:END in seconds, beats or measures (`chart.timing`); RULE:N, four measures around the N-th finding; or
        hardest:N, the N-th hardest passage (`lint.passages`)
    preset : with which the feet are found that the finding is about
    end : second at which the chart ends; no part goes on after it, and one that begins after it is a UsageError
    """
    if match := _FINDING.fullmatch(text):
        first, last = _around_finding(song, chart, preset, match[1].upper(), int(match[2]))
        return max(0.0, first), min(end, last)
    if match := _HARDEST.fullmatch(text):
        first, last = _hardest(song, chart, preset, int(match[1]))
        return first, min(end, last)
    return parse_section(text, chart.timing, end)


def _hardest(song: Song, chart: Chart, preset: Preset, number: int) -> tuple[float, float]:
    from dancetutor_cli.lint.passages import hardest
    from dancetutor_cli.lint.subject import solved_chart

    play = solved_chart(song, chart, preset).play
    found = () if play is None else hardest(play, chart.timing)
    if not 1 <= number <= len(found):
        many = f"{len(found)} passage{'' if len(found) == 1 else 's'}"
        raise UsageError(f"section hardest:{number}: the chart has {many} harder than the rest of it")
    return max(0.0, found[number - 1].start), found[number - 1].end


def _around_finding(song: Song, chart: Chart, preset: Preset, rule: str, number: int) -> tuple[float, float]:
    from dancetutor_cli.lint.check import findings_of
    from dancetutor_cli.lint.subject import solved_chart

    findings = findings_of(solved_chart(song, chart, preset))
    found = [one.beat for one in findings if one.rule == rule and one.beat is not None]
    if not 1 <= number <= len(found):
        has = ", ".join(sorted({one.rule for one in findings})) or "none at all"
        many = f"{len(found)} finding{'' if len(found) == 1 else 's'}"
        raise UsageError(f"section {rule}:{number}: the chart has {many} of {rule}; it has: {has}")
    beat = found[number - 1]
    ends = chart.timing.seconds_of_beats(np.array([max(0.0, beat - AROUND), beat + AROUND]))
    return float(ends[0]), float(ends[1])
