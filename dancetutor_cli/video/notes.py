"""What the highway shows, as plain arrays: notes, presses, beat lines; made from a chart and a play."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

QUANTISATIONS = (4, 8, 12, 16, 24, 32, 48, 64, 192)  # note values that have a colour of their own


@dataclass(frozen=True, slots=True)
class NoteTrack:
    """The notes of a chart, sorted by time; n notes.

    second, end_second : float64 (n,), of the music; end_second = second where there is no hold
    beat, end_beat : float64 (n,), as far as they are drawn (scroll segments applied)
    column : int16 (n,); kind : uint8 (n,), `chart.model.Kind`; limb : int8 (n,), `play.played.Limb`
    quantisation : int64 (n,), index into `QUANTISATIONS`; judged : bool (n,)
    player : int8 (n,), of a chart for two whose it is, 1 or 2; 0: anybody's
    gone_second, gone_beat : float64 (n,), from where on nobody plays it, of a roll maybe later than its head; endless
    where it is played to its end. Of a mine with a foot on it when it passes, which has that foot as its limb
    """

    second: NDArray[np.float64]
    end_second: NDArray[np.float64]
    beat: NDArray[np.float64]
    end_beat: NDArray[np.float64]
    column: NDArray[np.int16]
    kind: NDArray[np.uint8]
    limb: NDArray[np.int8]
    quantisation: NDArray[np.int64]
    judged: NDArray[np.bool_]
    player: NDArray[np.int8]
    gone_second: NDArray[np.float64]
    gone_beat: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Presses:
    """When which panel is pressed by whom; p presses sorted by start. Taps end where they start.

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
    """Words for a passage. second : of the music, where it begins; beat : the same as drawn

    severity : "move", "info", "warning" or "error"; begin : second from which it is called out; end : where it is over
    tag : fewer words, for the place beside the notes
    further : where the passage's other moves begin, second and beat, and the tag of each
    """

    second: float
    beat: float
    text: str
    severity: str
    begin: float
    end: float
    tag: str
    further: tuple[tuple[float, float, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Cue:
    """A move to name in subtitles. second, end : of the music, when it comes and is over; who : "left foot", ...

    move : its name
    """

    second: float
    end: float
    text: str
    who: tuple[str, ...]
    move: str


@dataclass(frozen=True, slots=True)
class BeatLines:
    """One entry per beat from 0 on. second, beat (as drawn) : float64 (b,); index = the beat's number."""

    second: NDArray[np.float64]
    beat: NDArray[np.float64]


def quantisation(tick: NDArray[np.int64]) -> NDArray[np.int64]:
    """Index into `QUANTISATIONS` of each tick (1/48 beat): the coarsest note value on whose grid it lies."""
    out = np.full(len(tick), len(QUANTISATIONS) - 1)
    for i in reversed(range(len(QUANTISATIONS) - 1)):
        out[tick % (192 // QUANTISATIONS[i]) == 0] = i
    return out
