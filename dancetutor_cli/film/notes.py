"""The parts of a chart and its play that a picture shows, timed by the music: notes, presses, beats, lights."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import STEP_KINDS, Chart, Kind
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play, StepKind
from dancetutor_cli.film.scroll import ScrollSegments

# The contents of the highway as plain arrays, made from a chart and a play: notes, presses, beat lines.

QUANTISATIONS = (4, 8, 12, 16, 24, 32, 48, 64, 192)  # note values that have a colour of their own


@dataclass(frozen=True, slots=True)
class NoteTrack:
    """The notes of a chart, sorted by time; n notes.

    tick : int64 (n,), ticks of the chart
    second, end_second : float64 (n,), seconds of the music; end_second = second for a note without a hold
    beat, end_beat : float64 (n,), beats as drawn (scroll segments applied)
    column : int16 (n,); kind : uint8 (n,), `chart.model.Kind`
    limb : int8 (n,), `feet.limbs.Limb`; for a mine, the foot that is on it as it passes
    judged : bool (n,)
    player : int8 (n,), the player whose note it is in a chart for two, 1 or 2; 0 for a note of nobody in particular
    gone_second, gone_beat : float64 (n,), the time from which on nobody plays the note; infinite for a note that is
        played to its end. It may be later than the head of a roll. For a mine with a foot on it, it is the mine's time
    """

    tick: NDArray[np.int64]
    second: NDArray[np.float64]
    end_second: NDArray[np.float64]
    beat: NDArray[np.float64]
    end_beat: NDArray[np.float64]
    column: NDArray[np.int16]
    kind: NDArray[np.uint8]
    limb: NDArray[np.int8]
    judged: NDArray[np.bool_]
    player: NDArray[np.int8]
    gone_second: NDArray[np.float64]
    gone_beat: NDArray[np.float64]

    @property
    def quantisation(self) -> NDArray[np.int64]:
        """The index into `QUANTISATIONS` of each note, int64 (n,)."""
        return quantisation(self.tick)


@dataclass(frozen=True, slots=True)
class Presses:
    """The presses of panels by limbs; p presses, sorted by start. A tap ends when it starts.

    start, end : float64 (p,), seconds of the music; column : int16 (p,); limb : int8 (p,)
    """

    start: NDArray[np.float64]
    end: NDArray[np.float64]
    column: NDArray[np.int16]
    limb: NDArray[np.int8]

    def __len__(self) -> int:
        return len(self.start)


@dataclass(frozen=True, slots=True)
class Callout:
    """Words for a passage. second : second of the music at which the passage begins; beat : the same as drawn

    severity : "move", "info", "warning" or "error"
    called_from : second from which the passage is called out; end : second at which it is over
    tag : fewer words, for the place beside the notes
    further : second, beat and tag of the passage's other moves
    with_reasons : the text with the reasons of its moves, shown if there is room for it; "" if there are none
    """

    second: float
    beat: float
    text: str
    severity: str
    called_from: float
    end: float
    tag: str
    further: tuple[tuple[float, float, str], ...] = ()
    with_reasons: str = ""


@dataclass(frozen=True, slots=True)
class Cue:
    """A move to name in subtitles. second, end : seconds of the music at which the move begins and ends

    who : the limbs that make the move, "left foot", ...; move : the name of the move
    """

    second: float
    end: float
    text: str
    who: tuple[str, ...]
    move: str


@dataclass(frozen=True, slots=True)
class BeatLines:
    """The lines of the beats, one entry for each beat from 0 on.

    second, beat (as drawn) : float64 (b,); the index is the number of the beat
    """

    second: NDArray[np.float64]
    beat: NDArray[np.float64]


def quantisation(tick: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the index into `QUANTISATIONS` of each tick (1/48 beat): the coarsest note value on whose grid it lies."""
    out = np.full(len(tick), len(QUANTISATIONS) - 1)
    for i in reversed(range(len(QUANTISATIONS) - 1)):
        out[tick % (192 // QUANTISATIONS[i]) == 0] = i
    return out


# The way from a chart and its play to the contents of a picture: notes, presses and beats, timed by the music.


class OnMine(NamedTuple):
    """A mine that passes while a foot is on its panel. tick, column : place in the chart; foot : 0 left, 1 right

    player : the player of a chart for two whose foot it is, 1 or 2; 0 if there is one dancer
    """

    tick: int
    column: int
    foot: int
    player: int = 0


def note_track(chart: Chart, play: Play | None, scrolls: ScrollSegments, on_mines: Sequence[OnMine] = ()) -> NoteTrack:
    """Return the notes as the highway draws them, without keysounds, which nobody sees."""
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
        tick=tick,
        second=second,
        end_second=chart.timing.seconds(end),
        beat=scrolls.drawn_beats(tick / TICKS_PER_BEAT),
        end_beat=scrolls.drawn_beats(end / TICKS_PER_BEAT),
        column=table.column[keep],
        kind=table.kind[keep],
        limb=limb[keep],
        judged=table.judged[keep],
        player=_players(chart)[keep],
        gone_second=np.where(is_gone, chart.timing.seconds(gone), np.inf),
        gone_beat=np.where(is_gone, scrolls.drawn_beats(gone / TICKS_PER_BEAT), np.inf),
    )
    return NoteTrack(*(getattr(track, field.name)[order] for field in fields(NoteTrack)))


def _gone(chart: Chart, play: Play | None, limb: NDArray[np.int8]) -> NDArray[np.int64]:
    """Return the tick from which on nobody plays each note, -1 for a note that is played.

    A roll ends at its first tap that nobody plays, because from there on nobody can keep it.

    limb : the limb of each note
    """
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
    """Return the player of each note, int8 (n,): 1 or 2 in a chart for two, 0 for mines and for other charts."""
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
    """Return every press of a panel: taps, lifts, holds and rolls.

    A hold or roll lasts from its head to its tail, or to the moment from which on nobody plays it.
    """
    step = track.judged & np.isin(track.kind, STEP_KINDS)
    end = np.maximum(np.minimum(track.end_second, track.gone_second), track.second)
    return Presses(track.second[step], end[step], track.column[step], track.limb[step])


def beat_lines(chart: Chart, scrolls: ScrollSegments, end: float) -> BeatLines:
    """Return one line for each beat, from beat 0 to a minute after the end of the film."""
    beats = np.arange(min(chart.notes.last_tick // TICKS_PER_BEAT + 64, 2_000_000), dtype=np.int64)
    second = chart.timing.seconds(beats * TICKS_PER_BEAT)
    keep = second <= end + 60
    return BeatLines(second[keep], scrolls.drawn_beats(beats.astype(np.float64))[keep])


# The light of a panel or receptor: it flashes at a note, fades after a tap, and stays steady during a hold.
#
# A note that nobody plays gives no light.

HOLD_BRIGHTNESS = 0.62  # brightness during a hold, after the flash at the start
EPSILON = 1e-6  # seconds; a frame exactly at a note already shows its light


def lighting(track: NoteTrack, presses: Presses) -> Presses:
    """Return everything that lights panels: the presses, and the mines that pass under a foot."""
    mines = (track.kind == Kind.MINE) & (track.limb >= 0)
    if not mines.any():
        return presses
    own = Presses(track.second[mines], track.second[mines], track.column[mines], track.limb[mines])
    order = np.argsort(np.concatenate((presses.start, own.start)), kind="stable")
    both = (np.concatenate((getattr(presses, one.name), getattr(own, one.name))) for one in fields(Presses))
    return Presses(*(values[order] for values in both))


class PanelLights:
    """The light of each column over time; fade : seconds from full light to none."""

    def __init__(self, presses: Presses, columns: int, fade: float) -> None:
        self.presses, self.fade = presses, fade
        pressed = presses.limb != Limb.UNPLAYED
        self._columns = [np.flatnonzero((presses.column == c) & pressed) for c in range(columns)]
        self._starts = [presses.start[mine] for mine in self._columns]

    def at(self, column: int, second: float) -> tuple[float, int]:
        """Return the brightness 0..1 at `second` of the music, and the limb of the last press (-1: none or unknown)."""
        last = int(np.searchsorted(self._starts[column], second + EPSILON, side="right")) - 1
        if last < 0:
            return 0.0, -1
        press = self._columns[column][last]
        start, end = float(self.presses.start[press]), float(self.presses.end[press])
        fresh = _fade((second - start) / self.fade)
        if second < end:
            level = max(HOLD_BRIGHTNESS, fresh)
        else:
            level = _fade((second - end) / self.fade) * (1.0 if end == start else HOLD_BRIGHTNESS)
        return min(1.0, level), int(self.presses.limb[press])


def _fade(share: float) -> float:
    """Return the brightness of a light after this share of its time: it stays bright and then goes out quickly."""
    return max(0.0, 1.0 - share * share)
