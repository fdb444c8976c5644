"""Subtitles that name the moves and the feet that make them, as an .srt file beside the film."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.feet.limbs import LABELS, Limb
from dancetutor_cli.feet.play import CROSSED, FULL, crossover_spans, spans
from dancetutor_cli.feet.solver.techniques import HALF_TURNS, moves_and_turns
from dancetutor_cli.film.clock import Clock, Pass
from dancetutor_cli.film.notes import Cue
from dancetutor_cli.film.words import HOLD, IMPLIED_BY_BRACKET, PanelNames, fill_words, move_words
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.languages import Language, load_language
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.yaml_files import load

if TYPE_CHECKING:
    from dancetutor_cli.chart.timing import Timing
    from dancetutor_cli.feet.play import Play


# The moves of a play that subtitles name, each from its beginning to its end, with the foot that makes it.

_WAYS = ("crossover-front", "crossover-back")  # more precise than crossover-half, which comes with them
_RUNS = ("stream", "drill")


def cues_of(play: Play, timing: Timing, words: Mapping[str, str], view: PanelNames) -> tuple[Cue, ...]:
    """Return every move that has a word, sorted by time.

    Crossed feet are reported once, from their first row until they are uncrossed, but not if a half turn is reported at
    that row. A stream or drill is reported once, at its first row.

    words : name of a move (`feet.solver.vocabulary.EVENTS`), or "hold" -> its words; other moves are left out
    view : names of panels and limbs
    """
    found = [
        *_crossovers(play, words, view.language),
        *_moments(play, words, view),
        *_holds(play, timing, words, view.language),
    ]
    for name in _RUNS:
        if name in words:
            found += (
                Cue(float(play.rows.second[first]), float(play.rows.second[last]), words[name], (), name)
                for first, last in spans(play, (name,))
            )
    return tuple(sorted(found, key=lambda cue: (cue.second, cue.text)))


def _crossovers(play: Play, words: Mapping[str, str], language: Language) -> Iterator[Cue]:
    """Return the crossovers, each until the row in which the feet are uncrossed.

    A crossover that becomes full is reported again at that row.
    """
    second, turns = play.rows.second, moves_and_turns(play)
    for span in crossover_spans(play):
        for row, kind in span.begins:
            way = [name for name in _WAYS if name in play.moves[row] and name in words and kind != FULL]
            name = way[0] if way else kind
            if (word := words.get(name)) and not {*HALF_TURNS}.intersection(turns[row]):
                yield Cue(float(second[row]), float(second[span.end]), word, _limb_names(play, row, language), name)


def _moments(play: Play, words: Mapping[str, str], view: PanelNames) -> Iterator[Cue]:
    """Return the moves of single rows, each time that they occur."""
    named = set(words) - {*CROSSED, *_WAYS, *_RUNS, HOLD}
    for row, names in enumerate(moves_and_turns(play)):
        for name in named.intersection(names) - (IMPLIED_BY_BRACKET if "bracket" in names else set()):
            second = float(play.rows.second[row])
            who = () if "{" in words[name] else _limb_names(play, row, view.language)
            for text in fill_words(words[name], name, (play, row), view):
                yield Cue(second, second, text, who, name)


def _holds(play: Play, timing: Timing, words: Mapping[str, str], language: Language) -> Iterator[Cue]:
    if HOLD not in words:
        return
    row, column = np.nonzero(play.rows.hold_end >= 0)
    ends = timing.seconds(play.rows.hold_end[row, column])
    for r, c, end in zip(row.tolist(), column.tolist(), ends.tolist(), strict=True):
        limb = int(play.limb[r, c])
        who = (language.limbs[LABELS[limb]],) if 0 <= limb < len(LABELS) else ()
        yield Cue(float(play.rows.second[r]), end, words[HOLD], who, HOLD)


def _limb_names(play: Play, row: int, language: Language) -> tuple[str, ...]:
    """Return the names of the limbs that step in a row; none for a move of both feet."""
    limbs = {limb for limb in play.limb[row].tolist() if 0 <= limb < len(LABELS)}
    return (
        ()
        if {Limb.LEFT_FOOT, Limb.RIGHT_FOOT} <= limbs
        else tuple(language.limbs[LABELS[limb]] for limb in sorted(limbs))
    )


# The text of the subtitles.

_GAP = 0.1  # seconds; if the same words come again within this time, they stay without a flicker


@dataclass(frozen=True, slots=True)
class SubtitleStyle:
    """The settings of configs/subtitles.yaml. before, stays, shortest : seconds of the film

    most : maximum number of moves that are named together; moves : names of moves, the most important first
    """

    before: float
    stays: float
    shortest: float
    most: int
    moves: tuple[str, ...]


@dataclass
class _Line:
    """Moves that are named together. All times are seconds of the film.

    first, latest : the beginning of the first and of the latest move; last : the end of all moves
    start, end : the time on the screen
    moves : word -> limbs, both in the order in which they occur; names : word -> the move's name
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
        """Return one line for each move, for the most important moves if there are too many."""
        kept = sorted(self.moves, key=lambda word: style.moves.index(self.names[word]))[: style.most]
        return "\n".join(", ".join([word, *who]) for word, who in self.moves.items() if word in kept)


@cache
def subtitle_style() -> SubtitleStyle:
    """Load the style from the configuration; FileError describes a mistake in it."""
    path = config_path("subtitles.yaml")
    style = load(path, SubtitleStyle)
    if not 0 <= style.stays < style.shortest <= style.before or style.most < 1:
        raise FileError(path, "wants 0 <= stays < shortest <= before, and most at least 1")
    move_words(style.moves, path, load_language())
    return style


def subtitle_words(language: Language) -> dict[str, str]:
    """Return the moves that subtitles name, and their words."""
    return move_words(subtitle_style().moves, config_path("subtitles.yaml"), language)


def subtitles(cues: Sequence[Cue], clock: Clock, style: SubtitleStyle) -> str:
    """Return the text of an .srt file; "" if no move is named.

    Words stand from before their move until it is over, or until the next words come. Moves that come faster than
    people can read are named together.

    cues : the moves, sorted by time
    """
    shown: list[tuple[float, float, str]] = []
    begin = 0.0
    for one in clock.passes:
        for line in _timed(_merge_close_moves(cues, one, begin, style), begin, begin + one.seconds, style):
            text = line.text(style)
            if shown and shown[-1][2] == text and line.start - shown[-1][1] < _GAP:
                shown[-1] = (shown[-1][0], line.end, text)
            else:
                shown.append((line.start, line.end, text))
        begin += one.seconds
    blocks = (f"{n}\n{_stamp(start)} --> {_stamp(end)}\n{text}\n" for n, (start, end, text) in enumerate(shown, 1))
    return "\n".join(blocks)


def _merge_close_moves(cues: Sequence[Cue], one: Pass, begin: float, style: SubtitleStyle) -> list[_Line]:
    """Return the lines of a run, with moves that are too close to be read one by one in the same line.

    begin : the beginning of the run, seconds of the film
    """
    lines: list[_Line] = []
    for cue in cues:
        if not max(one.start, one.sound_from) <= cue.second < one.end:
            continue
        first, last = (begin + one.film_seconds(min(s, one.end)) for s in (cue.second, cue.end))
        first = max(begin, min(first, begin + one.seconds - style.stays))  # the last words can be read, too
        if not lines or first >= lines[-1].first + style.shortest:
            lines.append(_Line(first, first, last))
        lines[-1].add(cue, first, last)
    return lines


def _timed(lines: list[_Line], begin: float, over: float, style: SubtitleStyle) -> list[_Line]:
    """Set the times at which the lines of a run are on the screen: one line at a time, and none after the run."""
    least = style.shortest - style.stays  # seconds that words stand before their move, even in a hurry
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
