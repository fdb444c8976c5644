"""The calls of a picture, which name the moves that a learner has to know, a passage at a time.

Findings of the linter are for authors, so they are called out only if the user asks for them.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import CROSSED, FULL, crossover_spans
from dancetutor_cli.feet.solver.techniques import HALF_TURNS, moves_and_turns
from dancetutor_cli.feet.unplayable import UNPLAYABLE
from dancetutor_cli.film.notes import Callout
from dancetutor_cli.film.words import (
    IMPLIED_BY_BRACKET,
    MINE,
    PanelNames,
    Phrase,
    crossing_phrase,
    fill_words,
    plain_phrase,
    short_words,
    stepped_phrase,
    turning_phrase,
)
from dancetutor_cli.run.languages import Language, load_language

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play
    from dancetutor_cli.film.choices import Ahead
    from dancetutor_cli.film.notes import OnMine
    from dancetutor_cli.film.scroll import ScrollSegments
    from dancetutor_cli.lint.findings import Finding

JOIN = 2 * TICKS_PER_BEAT, 0.8  # ticks, or seconds, within which a move joins the passage before it
REST = 1.2  # seconds between two moves that end a passage; a jump with uncrossed feet between them ends it, too
LONGEST = 16 * TICKS_PER_BEAT, 7.5  # longest passage: four measures, or this many seconds
MIN_GAP = 0.4  # minimum seconds between moves of one passage that have their own tag and countdown
KINDS, LETTERS = 2, 42  # maximum of different moves in one call, and of their letters, that can be read in time
_ORDER = ("move", "info", "warning", "error")
_OF_PASSAGES, _PASSAGE = ("DT305", "DT301"), 8 * TICKS_PER_BEAT  # rules with one finding for so long (lint/rules)
_OF_MINES = "DT303"  # the rule about a mine under a foot


@dataclass(frozen=True, slots=True)
class CallStyle:
    """The content and the time of the calls.

    words : name of a move -> its words, with {who} and {places} to be filled in; other moves are not called out
    ahead : the time between a call and its move
    findings : whether the linter's findings are called out, too
    turned : the dancer faces the viewer, and panels are named as the viewer sees them
    language : the language of words and findings
    """

    words: Mapping[str, str]
    ahead: Ahead
    findings: bool = False
    turned: bool = False
    language: Language = field(default_factory=load_language)


class _Notice(NamedTuple):
    """A finding of the linter. tick : tick of the row; rule : code of the rule; weight : index into `_ORDER`"""

    tick: int
    text: str
    rule: str
    weight: int


class _Move(NamedTuple):
    """A move to call out. first, last : ticks; weight : index into `_ORDER`"""

    first: int
    last: int
    phrase: Phrase
    weight: int = 0


@dataclass
class _Passage:
    """A passage of moves that follow each other closely. kinds : name of a move -> its phrases, in order"""

    first: int
    last: int
    kinds: dict[str, list[Phrase]] = field(default_factory=dict)
    weight: int = 0
    moves: list[_Move] = field(default_factory=list)

    def accepts(self, move: _Move, table: _TickTable) -> bool:
        """Whether a move belongs to this passage."""
        second, tick, name = table.second, move.first, move.phrase.move

        def within(since: int, most: tuple[int, float]) -> bool:
            return tick - since <= most[0] or second[tick] - second[since] <= most[1]

        near = within(self.last, JOIN) and second[tick] - second[self.last] < REST and within(self.first, LONGEST)
        near = near and not table.has_uncrossed_jump(self.last, tick)
        short = len(self.kinds) < KINDS and len(", ".join([*self.kinds, name])) <= LETTERS
        return near and move.weight == self.weight and (name in self.kinds or short)

    def add(self, move: _Move) -> None:
        """Add a move to this passage."""
        self.last = max(self.last, move.last)
        self.kinds.setdefault(move.phrase.move, []).append(move.phrase)
        self.moves.append(move)

    def text(self) -> str:
        return ", ".join(words for words, _ in self._words())

    def text_with_reasons(self) -> str:
        """Return the words of each kind of move, each followed by its reason; "" if there is no reason."""
        words, text = self._words(), ""
        for (some, why), (_, after) in pairwise([*words, ("", "")]):  # a reason of two kinds stands after the second
            text += f"{some}: {why}; " if why and why != after else f"{some}, "
        return text[:-2] if any(why for _, why in words) else ""

    def _words(self) -> list[tuple[str, str]]:
        """Return the words of each kind of move and their reason: of moves with the same words the one of all."""
        found = []
        for some in self.kinds.values():
            alike, reasons = len({one.text for one in some}) == 1, {one.why for one in some}
            found.append((some[0].text_of(len(some), alike), "" if alike and len(reasons) > 1 else some[0].why))
        return found

    def tag(self, further: int) -> str:
        """Return the tag of the first move, for the narrow place beside the notes, whose markers show the foot.

        further : the number of other moves with tags of their own; if all have tags, this tag has no count
        """
        some = next(iter(self.kinds.values()))
        counted = len(some) > 1 and further + 1 < len(self.moves)
        return f"{some[0].tag} ×{len(some)}" if counted else some[0].tag

    def further(self, second: Mapping[int, float]) -> list[tuple[int, str]]:
        """Return the tick and the tag of each later move that is at least `MIN_GAP` after the tag before it."""
        found, before = [], self.first
        for move in self.moves:
            if second[move.first] - second[before] >= MIN_GAP:
                found.append((move.first, move.phrase.tag))
                before = move.first
        return found


class _TickTable(NamedTuple):
    """The times of moves and jumps. second : tick of a move -> second

    jumps : ticks of jumps with uncrossed feet, ascending
    """

    second: Mapping[int, float]
    jumps: Sequence[int]

    def has_uncrossed_jump(self, since: int, tick: int) -> bool:
        """Whether there is a jump with uncrossed feet between these ticks."""
        return bisect_right(self.jumps, since) < bisect_left(self.jumps, tick)


class CalloutSubject(NamedTuple):
    """The subject of the calls: a chart, its pad, and the linter's findings there, computed when they are needed."""

    chart: Chart
    pad: Pad | None
    findings: Callable[[], Iterable[Finding]]


def callouts_of(
    about: CalloutSubject,
    play: Play | None,
    style: CallStyle,
    scrolls: ScrollSegments,
    on_mines: Iterable[OnMine] = (),
) -> tuple[Callout, ...]:
    """Return all calls, one for each passage, in order of time.

    Moves in a row, such as one crossover after the other, are one passage with a count. The finding of the linter is
    always called out for a row with a note that nobody plays, or with a mine under a foot.

    about : the chart; play : the play of the part that the picture shows; on_mines : the mines under a foot
    """
    timing = about.chart.timing
    found = _called_moves(about, play, style, on_mines)
    asked = sorted({tick for move in found for tick in move[:2]})
    seconds = dict(zip(asked, timing.seconds(np.array(asked, dtype=np.int64)).tolist(), strict=True))
    passages = _passages(found, _TickTable(seconds, [] if play is None else _jumps(play)))
    ticks = np.array([(p.first, p.last) for p in passages], dtype=np.int64).reshape(-1, 2)
    starts, ends = timing.seconds(ticks[:, 0]), timing.seconds(ticks[:, 1])
    beats = scrolls.drawn_beats(ticks[:, 0] / TICKS_PER_BEAT)

    def further(passage: _Passage) -> Iterator[tuple[float, float, str]]:
        for tick, tag in passage.further(seconds):
            yield seconds[tick], float(scrolls.drawn_beats(np.array([tick / TICKS_PER_BEAT]))[0]), tag

    if style.ahead.in_beats:
        begins = timing.seconds(ticks[:, 0] - round(style.ahead.length * TICKS_PER_BEAT))
    else:
        begins = starts - style.ahead.length
    return tuple(
        Callout(
            float(start),
            float(beat),
            passage.text(),
            _ORDER[passage.weight],
            called_from=float(begin),
            end=float(end),
            tag=passage.tag(len(passage.further(seconds))),
            further=tuple(further(passage)),
            with_reasons=passage.text_with_reasons(),
        )
        for passage, start, beat, begin, end in zip(passages, starts, beats, begins, ends, strict=True)
    )


def _called_moves(
    about: CalloutSubject, play: Play | None, style: CallStyle, on_mines: Iterable[OnMine]
) -> list[_Move]:
    """Return all moves that are called out: those of the play, findings of the linter, mines under a foot."""
    ticks = () if play is None else play.rows.tick[(play.limb == Limb.UNPLAYED).any(axis=1)].tolist()
    mined = sorted({one.tick for one in on_mines}) if MINE in style.words else []
    notices = list(_notices(about.findings(), style)) if style.findings or ticks or mined else []
    why = {} if style.findings else dict(_reasons(ticks, notices))
    under = {} if style.findings else {notice.tick: notice.text for notice in notices if notice.rule == _OF_MINES}
    found = list(_moves(about.pad, play, style, why))
    if style.findings:
        found += (_Move(notice.tick, notice.tick, plain_phrase(notice.text), notice.weight) for notice in notices)
    mine = style.words.get(MINE, "")
    found += (_Move(tick, tick, plain_phrase(mine + (f" ({under[tick]})" if tick in under else ""))) for tick in mined)
    return found


def _passages(moves: Sequence[_Move], table: _TickTable) -> list[_Passage]:
    """Return the passages of moves, in order of time: moves in a row that belong together are one passage."""
    passages: list[_Passage] = []
    for move in sorted(moves):
        here = next((p for p in reversed(passages[-2:]) if p.accepts(move, table)), None)
        if here is None:
            here = _Passage(move.first, move.last, weight=move.weight)
            passages.append(here)
        here.add(move)
    return passages


def _reasons(ticks: Iterable[int], notices: Iterable[_Notice]) -> Iterator[tuple[int, str]]:
    """Return the findings of the linter for the rows at `ticks`.

    A row has its own finding, or the finding of its passage, which lasts as long as such rows follow each other.
    """
    notices = sorted(notices)
    last, passage = -_PASSAGE, ""
    for tick in ticks:
        of_row = [notice.text for notice in notices if notice.tick == tick]
        of_passages = [
            notice.text for notice in notices if notice.rule in _OF_PASSAGES and tick - _PASSAGE <= notice.tick <= tick
        ]
        passage = of_passages[-1] if of_passages else passage if tick - last <= _PASSAGE else ""
        last = tick
        if of_row or passage:
            yield tick, of_row[0] if of_row else passage


def _moves(pad: Pad | None, play: Play | None, style: CallStyle, why: Mapping[int, str]) -> Iterator[_Move]:
    """Return the moves of a play with their words; why : a reason that is added to the words, by tick."""
    words = style.words
    if play is None or pad is None:
        return
    ticks = play.rows.tick.tolist()
    turns = moves_and_turns(play)
    for span in crossover_spans(play):
        for row, kind in span.begins:
            if kind in words and not {*HALF_TURNS}.intersection(turns[row]).intersection(words):
                if kind != FULL:
                    phrase = crossing_phrase(words[kind], (play, row), pad, style.language)
                else:  # the first row's call has said that it is a crossover
                    name = words[kind] if row == span.first else short_words(words[kind])
                    phrase = turning_phrase(name, (play, row), pad, style.language)
                yield _Move(ticks[row], ticks[span.last], phrase)
    for row, names in enumerate(turns):
        named = {n for n in names if n in words and n not in CROSSED}
        for name in sorted(named - IMPLIED_BY_BRACKET if "bracket" in named else named):
            if name in HALF_TURNS:
                turned = turning_phrase(words[name], (play, row), pad, style.language)
                yield _Move(ticks[row], ticks[row], turned)
                continue
            reason = f" ({why[ticks[row]]})" if name == UNPLAYABLE and ticks[row] in why else ""
            if "{" not in words[name] and not reason:
                limbs = play.limb[row].tolist()
                yield _Move(ticks[row], ticks[row], stepped_phrase(words[name], name, limbs, style.language))
                continue
            for text in fill_words(words[name], name, (play, row), PanelNames(pad, style.turned, style.language)):
                yield _Move(ticks[row], ticks[row], plain_phrase(text + reason))


def _jumps(play: Play) -> list[int]:
    rows = zip(play.rows.tick.tolist(), play.moves, strict=True)
    return [tick for tick, names in rows if "jump" in names and not {*CROSSED}.intersection(names)]


def _notices(findings: Iterable[Finding], style: CallStyle) -> Iterator[_Notice]:
    for finding in findings:
        if finding.beat is not None and finding.note_column is not None and finding.severity in _ORDER:
            text = style.language.finding_name(finding.rule, finding.name.replace("-", " "))
            text = text if style.findings else f"{finding.rule} {text}"
            yield _Notice(round(finding.beat * TICKS_PER_BEAT), text, finding.rule, _ORDER.index(finding.severity))
