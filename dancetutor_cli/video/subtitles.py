"""Subtitles that name the moves, as an .srt file beside the film."""

from __future__ import annotations

from dancetutor_cli.video.clock import Clock
from dancetutor_cli.video.notes import Callout

SHOWN = 1.5  # seconds of film before a move that its subtitle appears
STAYS = 0.6  # seconds of film after it


def subtitles(callouts: tuple[Callout, ...], clock: Clock) -> str:
    """The text of an .srt file: each move of each run, numbered from 1; a line ends where the next one begins."""
    times: list[tuple[float, float, str]] = []
    passed = 0.0
    for one in clock.passes:
        for call in callouts:
            if one.start <= call.second < one.end and call.second >= one.sound_from:
                at = passed + (call.second - one.start) / one.rate
                times.append((max(passed, at - SHOWN), min(clock.seconds, at + STAYS), call.text))
        passed += one.seconds
    lines = []
    for number, (start, end, text) in enumerate(times):
        if number + 1 < len(times):
            end = min(end, max(start + 0.05, times[number + 1][0]))
        lines.append(f"{number + 1}\n{_stamp(start)} --> {_stamp(end)}\n{text}\n")
    return "\n".join(lines)


def _stamp(second: float) -> str:
    milliseconds = round(second * 1000)
    minutes, rest = divmod(milliseconds, 60_000)
    return f"{minutes // 60:02d}:{minutes % 60:02d}:{rest // 1000:02d},{rest % 1000:03d}"
