"""Words in films: the names of moves, and the room beside the dancer in which words stand."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.film.clock import Moment, Pass
from dancetutor_cli.film.layout import Layout, PixelBox
from dancetutor_cli.film.notes import Callout, Presses
from dancetutor_cli.run.errors import FileError

if TYPE_CHECKING:
    from pathlib import Path

    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play
    from dancetutor_cli.run.languages import Language


# The names of moves in films: one table of a dancer's words in each language, for callouts and for subtitles.

HOLD, MINE = "hold", "mine"  # a note held, a mine that a foot is on: not in `EVENTS`; neither are half turns
LIMBS = ("left-foot", "right-foot", "left-hand", "right-hand")  # labels of a language, by `feet.limbs.Limb`
IMPLIED_BY_BRACKET = {"doublestep", "forced-doublestep"}  # the words of a bracket already say which foot it is
_OPPOSITE = {"left": "right", "right": "left", "up": "down", "down": "up"}


def move_words(names: Iterable[str], path: Path, language: Language) -> dict[str, str]:
    """The words of these moves, in their order; `path` : where they are named, for a FileError about one without."""
    table, names = language.moves, tuple(names)
    if unknown := set(names) - set(table):
        raise FileError(path, f"there is no move '{min(unknown)}'; choose {', '.join(sorted(table))}")
    return {name: table[name] for name in names}


def filled(words: str, name: str, at: tuple[Play, int], view: PanelNames) -> list[str]:
    """A move's words with the limb and the place: "right foot: heel on right, toe on up"; for several limbs, those of
    each.

    at : the play and the row
    """
    if "{" not in words:
        return [words]
    play, row = at
    limbs = play.limb[row].tolist()
    texts = []
    for who in _doers(name, limbs):
        heel = int(play.feet[row, who]) if 0 <= who < 2 else -1
        columns = [column for column, limb in enumerate(limbs) if limb == who]
        film, limb = view.language.film, view.language.limbs[LIMBS[who] if who >= 0 else "foot"]
        parts = sorted((column != heel, view.name(column)) for column in columns)
        places = ", ".join(film["toe" if toe else "heel"].replace("{panel}", panel) for toe, panel in parts)
        texts.append(words.replace("{who}", limb).replace("{places}", places))
    return texts


def _doers(name: str, limbs: list[int]) -> list[int]:
    """The limbs of a move: for a bracket each foot on two panels, for a hand the hands, otherwise the first foot that
    steps.
    """
    feet = [limb for limb in range(2) if limb in limbs][:1]
    if name == "bracket":
        return [limb for limb in range(4) if limbs.count(limb) > 1] or feet or [-1]
    if name == "hand":
        return [limb for limb in range(2, 4) if limb in limbs] or [-1]
    return feet or [-1]


def short_words(text: str) -> str:
    """The words of a move without its limb and its reason, for the narrow place beside the notes: "toe on up"."""
    return (text.partition(": ")[2] or text).partition(" (")[0]


@dataclass(frozen=True, slots=True)
class PanelNames:
    """What the panels of a pad are called. turned : the dancer faces the viewer, and panels are named as seen then"""

    pad: Pad
    turned: bool
    language: Language

    def name(self, column: int) -> str:
        """Of a column, whichever pad of a double it is on: "up-left"; the pad's own name where no language has one."""
        plain = re.sub(r"-\d+$", "", self.pad.names[column])
        seen = "-".join(_OPPOSITE.get(word, word) for word in plain.split("-")) if self.turned else plain
        return self.language.panels.get(seen, seen)


# Room for words beside the dancer: the part of a box into which neither her head nor her feet come.

CALLS_FROM, CALLS_HIGH = 0.5, 150.0  # where calls begin at the leftmost, share of her box; pixels of their box
CALLS_WIDE, CALLS_OFF = 140.0, 8.0  # pixels that they need at least, and to her head and feet
MOMENT_STEP, MOST_MOMENTS = 0.1, 400  # seconds between the moments that are looked at, and how many at most


class CallsRoom(NamedTuple):
    """Where calls may stand, pixels, and how large they are."""

    box: PixelBox
    scale: float


def calls_room(
    layout: Layout, box_of: Callable[[str], PixelBox], scale: float, title_end: tuple[float, float] | None
) -> CallsRoom:
    """The box of the calls: the layout's, otherwise at the top right of the dancer's; below a long title.

    title_end : right and bottom of the song's title
    """
    if (part := layout.calls) is not None:
        left, top, right, bottom = box_of("calls")
        if title_end is not None and title_end[0] > left:
            top = min(max(top, round(title_end[1])), bottom)
        return CallsRoom((left, top, right, bottom), scale * part.text)
    left, top, right, _ = box_of("dancer")
    scale *= layout.header.text if layout.header is not None else 1.0
    gap = round(22 * scale)
    left, right, top = left + round(CALLS_FROM * (right - left)), right - gap, top + gap
    if title_end is not None and title_end[0] > left:
        top = max(top, round(title_end[1]) + gap // 2)
    return CallsRoom((left, top, right, top + round(CALLS_HIGH * scale)), scale)


def moments(callouts: Sequence[Callout], passes: Sequence[Pass]) -> list[Moment]:
    """Moments at which passages are called out, of one pass of each rate; at most `MOST_MOMENTS` of each."""
    found: list[Moment] = []
    for rate, one in {one.rate: one for one in passes}.items():
        spans = [(max(call.begin, one.start), min(max(call.end, call.second), one.end)) for call in callouts]
        spans = [(low, high) for low, high in spans if low < high]
        if spans:
            step = max(MOMENT_STEP, sum(high - low for low, high in spans) / MOST_MOMENTS)
            seconds = np.unique(np.concatenate([np.arange(low, high, step) for low, high in spans]))
            found += [Moment(second, rate) for second in seconds[:MOST_MOMENTS].tolist()]
    return found


def dancing(presses: Presses, passes: Sequence[Pass]) -> list[Moment]:
    """Moments from the first to the last step of a pass, for one pass of each rate; all of a pass without steps."""
    first, last = float(presses.start.min(initial=math.inf)), float(presses.end.max(initial=-math.inf))
    found: list[Moment] = []
    for rate, one in {one.rate: one for one in passes}.items():
        low, high = max(first, one.start), min(last, one.end)
        if low >= high:
            low, high = one.start, one.end
        step = max(MOMENT_STEP, (high - low) / MOST_MOMENTS)
        found += [Moment(second, rate) for second in np.arange(low, high, step)[:MOST_MOMENTS].tolist()]
    return found


def clear(box: PixelBox, taken: NDArray[np.float64], least: float) -> PixelBox:
    """The part of a box to the right of the taken places, at least `least` pixels wide.

    If there is no such room beside the dancer, the box stands lower, beside her trunk; otherwise on her left; otherwise
    as it is.

    taken : float64 (n, 4), left, top, right and bottom of heads and feet, pixels
    """
    left, top, right, bottom = box
    for down in _heights(box, taken, right - least):
        here = taken[(taken[:, 1] < bottom + down) & (taken[:, 3] > top + down)]
        begins = max(left, int(np.ceil(here[:, 2].max(initial=left))))
        if right - begins >= least:
            return begins, top + down, right, bottom + down
    here = taken[(taken[:, 1] < bottom) & (taken[:, 3] > top)]
    ends = min(right, int(here[:, 0].min(initial=right)))
    return (left, top, ends, bottom) if ends - left >= least else box


def _heights(box: PixelBox, taken: NDArray[np.float64], edge: float) -> list[int]:
    """How far down a box may stand: not at all, or below what reaches over `edge` there, but above the feet."""
    high = taken[(taken[:, 2] > edge) & (taken[:, 1] < box[3])]
    down = max(0, int(np.ceil(high[:, 3].max(initial=box[1]))) - box[1])
    return [0, down] if box[3] + down <= taken[:, 3].max(initial=0) else [0]


# Words that the dancer walks through on her way onto the pad or off it are hidden until she has passed.

FADE = 0.3  # seconds of the film in which words come and go
PASSING_STEP = 1 / 15  # seconds of the film between the moments that are looked at
MOST_PASSING = 3000  # number of these moments
Covered = Callable[[NDArray[np.float64], float], NDArray[np.bool_]]


@dataclass(frozen=True, slots=True)
class Stay:
    """From when to when words stand in the picture, seconds of the music; rate : of the pass."""

    since: float = -math.inf
    until: float = math.inf
    rate: float = 1.0

    def opacity(self, second: float) -> float:
        """How visible the words are, 0 to 1."""
        return min(1.0, max(0.0, min(second - self.since, self.until - second) / (FADE * self.rate)))


def stay(one: Pass, presses: Presses, covered: Covered) -> Stay:
    """When words stand in a pass: from when the dancer has walked past them before the first step, to when she leaves.

    covered : for seconds of the music (n,) and the step that she walks to or from, whether she walks behind them then;
    made from the whole pass, so that a frame does not depend on which process draws it
    """
    if not len(presses):
        return Stay()
    first, last = float(presses.start.min()), float(presses.end.max())
    step, since, until = PASSING_STEP * one.rate, -math.inf, math.inf
    if first > one.start:
        before = _moments(first, one.start, step)
        since = float(before[covered(before, first)].max(initial=-math.inf)) + step
    if last < one.end:
        after = _moments(last, one.end, step)
        until = float(after[covered(after, last)].min(initial=math.inf)) - step
    return Stay(since, until, one.rate)


def _moments(near: float, far: float, step: float) -> NDArray[np.float64]:
    return np.linspace(near, far, min(MOST_PASSING, 2 + math.ceil(abs(far - near) / step)))
