"""Subtitles that name the moves, as an .srt file beside the film."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache

from dancetutor_cli.errors import FileError
from dancetutor_cli.resources import config_path
from dancetutor_cli.video.clock import Clock, Pass
from dancetutor_cli.video.from_yaml import load
from dancetutor_cli.video.move_words import move_words
from dancetutor_cli.video.notes import Cue

_GAP = 0.1  # seconds; the same words again so soon are left standing, without a flicker


@dataclass(frozen=True, slots=True)
class SubtitleStyle:
    """configs/subtitles.yaml. before, stays, shortest : seconds of the film; most : moves told together

    moves : names of moves, the most telling first
    """

    before: float
    stays: float
    shortest: float
    most: int
    moves: tuple[str, ...]


@dataclass
class _Line:
    """Moves told together. first, latest : when the first and the latest come; last : when all are over.

    start, end : on the screen; all of these are seconds of the film
    moves : word -> who, both in the order in which they come; names : word -> the move's name
    """

    first: float
    latest: float
    last: float
    moves: dict[str, list[str]] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)
    start: float = 0.0
    end: float = 0.0

    def add(self, cue: Cue, first: float, last: float) -> None:
        self.latest, self.last = max(self.latest, first), max(self.last, last)
        who = self.moves.setdefault(cue.text, [])
        self.names.setdefault(cue.text, cue.move)
        who += (one for one in cue.who if one not in who)

    def text(self, style: SubtitleStyle) -> str:
        """A line for each move; if there are too many, the most telling."""
        kept = sorted(self.moves, key=lambda word: style.moves.index(self.names[word]))[: style.most]
        return "\n".join(", ".join([word, *who]) for word, who in self.moves.items() if word in kept)


@cache
def subtitle_style() -> SubtitleStyle:
    """The style as configured; FileError says what is wrong with it."""
    path = config_path("subtitles.yaml")
    style = load(path, SubtitleStyle)
    if not 0 <= style.stays < style.shortest <= style.before or style.most < 1:
        raise FileError(path, "wants 0 <= stays < shortest <= before, and most at least 1")
    move_words(style.moves, path)
    return style


def subtitle_words() -> dict[str, str]:
    """The moves that subtitles name, and their words."""
    return move_words(subtitle_style().moves, config_path("subtitles.yaml"))


def subtitles(cues: Sequence[Cue], clock: Clock, style: SubtitleStyle) -> str:
    """The text of an .srt file; "" if no move is named.

    cues : by time. Words stand before their move and until it is over, but give way to the next ones; moves that come
    faster than words can be read are told together.
    """
    shown: list[tuple[float, float, str]] = []
    begin = 0.0
    for one in clock.passes:
        for line in _timed(_together(cues, one, begin, style), begin, begin + one.seconds, style):
            text = line.text(style)
            if shown and shown[-1][2] == text and line.start - shown[-1][1] < _GAP:
                shown[-1] = (shown[-1][0], line.end, text)
            else:
                shown.append((line.start, line.end, text))
        begin += one.seconds
    blocks = (f"{n}\n{_stamp(start)} --> {_stamp(end)}\n{text}\n" for n, (start, end, text) in enumerate(shown, 1))
    return "\n".join(blocks)


def _together(cues: Sequence[Cue], one: Pass, begin: float, style: SubtitleStyle) -> list[_Line]:
    """The moves that come in a run, which begins at `begin`; those too close to be read one by one in one line."""
    lines: list[_Line] = []
    for cue in cues:
        if not max(one.start, one.sound_from) <= cue.second < one.end:
            continue
        first, last = (begin + one.shown(min(s, one.end)) for s in (cue.second, cue.end))
        first = max(begin, min(first, begin + one.seconds - style.stays))  # what comes last can be read, too
        if not lines or first >= lines[-1].first + style.shortest:
            lines.append(_Line(first, first, last))
        lines[-1].add(cue, first, last)
    return lines


def _timed(lines: list[_Line], begin: float, over: float, style: SubtitleStyle) -> list[_Line]:
    """Give the lines of a run their times on the screen; none stands with another, or beyond the run."""
    least = style.shortest - style.stays  # seconds that words stand before their move even in a hurry
    before: _Line | None = None
    for line in lines:
        line.start = max(begin, line.first - style.before)
        if before is not None:
            given_way = min(before.latest + style.stays, line.first - least)
            line.start = max(line.start, given_way, before.start + style.shortest)
            before.end = min(before.end, line.start)
        line.end = max(line.last + style.stays, line.start + style.shortest)
        before = line
    if lines:
        lines[-1].end = min(lines[-1].end, over)
    return lines


def _stamp(second: float) -> str:
    minutes, rest = divmod(round(second * 1000), 60_000)
    return f"{minutes // 60:02d}:{minutes % 60:02d}:{rest // 1000:02d},{rest % 1000:03d}"
