"""From a chart and its play to what a picture shows of them: notes, presses and beats, on the clock of the music."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Chart, Kind
from dancetutor_cli.play.played import Limb, Play, StepKind
from dancetutor_cli.video.notes import BeatLines, NoteTrack, Presses, quantisation
from dancetutor_cli.video.scroll import ScrollSegments


class OnMine(NamedTuple):
    """A mine that a foot is on as it passes. tick, column : of the chart; foot : 0 left, 1 right

    player : of two who dance whose foot, 1 or 2; 0 where one dances
    """

    tick: int
    column: int
    foot: int
    player: int = 0


def note_track(chart: Chart, play: Play | None, scrolls: ScrollSegments, on_mines: Sequence[OnMine] = ()) -> NoteTrack:
    """The notes as the highway draws them; keysounds are not notes to see."""
    table = chart.notes
    keep = table.kind != Kind.KEYSOUND
    tick, end = table.tick[keep], np.where(table.end[keep] >= 0, table.end[keep], table.tick[keep])
    limb = np.full(len(table), -1, dtype=np.int8)
    if play is not None and len(play.rows):
        row = np.searchsorted(play.rows.tick, table.tick)
        row = np.clip(row, 0, len(play.rows) - 1)
        found = (play.rows.tick[row] == table.tick) & (table.column < play.limb.shape[1])
        limb[found] = play.limb[row[found], table.column[found]]
    limb[table.kind == Kind.MINE] = Limb.NONE
    for one in on_mines:
        limb[(table.kind == Kind.MINE) & (table.tick == one.tick) & (table.column == one.column)] = one.foot
    second = chart.timing.seconds(tick)
    gone = _gone(chart, play, limb)[keep]
    is_gone = gone >= 0
    order = np.argsort(second, kind="stable")
    track = NoteTrack(
        second=second,
        end_second=chart.timing.seconds(end),
        beat=scrolls.shown(tick / TICKS_PER_BEAT),
        end_beat=scrolls.shown(end / TICKS_PER_BEAT),
        column=table.column[keep],
        kind=table.kind[keep],
        limb=limb[keep],
        quantisation=quantisation(tick),
        judged=table.judged[keep],
        player=_players(chart)[keep],
        gone_second=np.where(is_gone, chart.timing.seconds(gone), np.inf),
        gone_beat=np.where(is_gone, scrolls.shown(gone / TICKS_PER_BEAT), np.inf),
    )
    return NoteTrack(*(getattr(track, field.name)[order] for field in fields(NoteTrack)))


def _gone(chart: Chart, play: Play | None, limb: NDArray[np.int8]) -> NDArray[np.int64]:
    """From which tick on nobody plays a note, -1 where it is played; limb : of each. A roll is let go at its first tap
    that nobody plays: from there on no one keeps it."""
    table = chart.notes
    out = np.where((limb == Limb.UNPLAYED) | ((table.kind == Kind.MINE) & (limb >= 0)), table.tick, -1)
    if play is None:
        return out
    row, column = np.nonzero((play.rows.steps == StepKind.ROLL_TAP) & (play.limb == Limb.UNPLAYED))
    for of in np.unique(column).tolist():
        taps = play.rows.tick[row[column == of]]  # in order of time, as rows are
        rolls = np.flatnonzero((table.kind == Kind.ROLL) & (table.column == of) & (out < 0) & (table.tick < taps[-1]))
        first = taps[np.searchsorted(taps, table.tick[rolls], side="right")]
        left = first <= table.end[rolls]
        out[rolls[left]] = first[left]
    return out


def _players(chart: Chart) -> NDArray[np.int8]:
    """Whose each note of a chart is, int8 (n,): 1 or 2 where it is for two, 0 for anybody's, as mines are."""
    owner: dict[tuple[int, int], int] = {}
    for part in chart.players:
        steps = part.notes.kind != Kind.MINE
        columns = (part.notes.column[steps] + part.first_column).tolist()
        owner |= dict.fromkeys(zip(part.notes.tick[steps].tolist(), columns, strict=True), part.player)
    table = chart.notes
    if not owner:
        return np.zeros(len(table), dtype=np.int8)
    places = zip(table.tick.tolist(), table.column.tolist(), strict=True)
    return np.array([owner.get(place, 0) for place in places], dtype=np.int8)


def presses_of(track: NoteTrack) -> Presses:
    """Every press of a panel: taps, lifts, and holds and rolls from head to tail, or to where they are let go."""
    step = track.judged & np.isin(track.kind, (Kind.TAP, Kind.LIFT, Kind.HOLD, Kind.ROLL))
    end = np.maximum(np.minimum(track.end_second, track.gone_second), track.second)
    return Presses(track.second[step], end[step], track.column[step], track.limb[step])


def beat_lines(chart: Chart, scrolls: ScrollSegments, end: float) -> BeatLines:
    """One line per beat, from beat 0 to the end of the film."""
    last = max(int(chart.notes.tick.max(initial=0)), int(chart.notes.end.max(initial=0)))
    beats = np.arange(min(last // TICKS_PER_BEAT + 64, 2_000_000), dtype=np.int64)
    second = chart.timing.seconds(beats * TICKS_PER_BEAT)
    keep = second <= end + 60
    return BeatLines(second[keep], scrolls.shown(beats.astype(np.float64))[keep])
