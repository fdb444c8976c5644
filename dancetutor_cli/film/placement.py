"""The places of a picture's words, found once for all frames, and the times at which the words make way for the dancer.

The song's words are at the top left, beside her head. The pad from above and the legend move down if these words reach
into them. Calls keep clear of the title, and of her head and feet; the name of a run stands below the header.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import LABELS
from dancetutor_cli.film.clock import Moment, Pass
from dancetutor_cli.film.layout import WIDE_PAD, Layout, PixelBox, lowered, overlap
from dancetutor_cli.film.notes import Callout, Presses
from dancetutor_cli.film.overlay.announce import Calls, Runs
from dancetutor_cli.film.overlay.footer import Legend, LegendWords
from dancetutor_cli.film.overlay.header import Header, WordsRoom
from dancetutor_cli.film.overlay.marks import visible_limbs

if TYPE_CHECKING:
    from dancetutor_cli.film.overlay.sprites import WordStyle
    from dancetutor_cli.film.plan import FilmPlan

LEGEND_OFF = 14.0  # pixels between the song's words and a legend below them
RUNS_TOP, RUNS_BOTTOM = 0.84, 0.93  # shares of the picture's height: the name of a run without a box or a header
RUNS_OFF = 9.0  # pixels between the header and the name of a run
BoxesAt = Callable[[Sequence[Moment]], NDArray[np.float64]]


@dataclass(frozen=True, slots=True)
class PartBoxes:
    """The boxes of a layout's parts in a picture, pixels. breadth : the number of columns by which boxes are chosen

    A pad of one square has the usual boxes, also with six panels.
    """

    layout: Layout
    size: tuple[int, int]
    breadth: int

    @classmethod
    def of(cls, plan: FilmPlan) -> PartBoxes:
        """Return the boxes of a film."""
        columns = len(plan.directions)
        square = plan.pad is not None and len(plan.pad.squares) == 1
        return cls(plan.look.layout, plan.look.size, min(columns, WIDE_PAD) if square else columns)

    @property
    def scale(self) -> float:
        """The number of pixels that one pixel of the layout's default size becomes in this picture."""
        return self.layout.scale(self.size)

    def box(self, name: str) -> PixelBox:
        """Return the box of a part of the layout: "dancer", "highway" ..."""
        return self.layout.box(name, self.size, self.breadth)


@dataclass(frozen=True, slots=True)
class Placement:
    """The words of a film in their places; None for words that the film does not have.

    feet : the box of the pad from above
    """

    header: Header | None
    legend: Legend | None
    feet: PixelBox | None
    runs: Runs
    calls: Calls | None


def place_words(
    plan: FilmPlan, boxes: PartBoxes, style: WordStyle, boxes_at: BoxesAt | None, turned: bool
) -> Placement:
    """Find the places of all words of a film.

    boxes_at : returns the boxes (n, 4) of the dancers' heads and feet at these moments, pixels of the dancer's box;
        None without dancers
    turned : whether the dancer faces the viewer
    """

    def heads_and_feet(moments_of: Callable[[], list[Moment]]) -> NDArray[np.float64]:
        """Return the boxes of heads and feet in the picture, with an edge around them."""
        if boxes_at is None:
            return np.zeros((0, 4))
        left, top, _, _ = boxes.box("dancer")
        edge = CALLS_OFF * boxes.scale
        return np.asarray(boxes_at(moments_of()) + np.array([left - edge, top - edge, left + edge, top + edge]))

    passes = plan.clock.passes
    header = None
    if (part := boxes.layout.header) is not None:
        room = WordsRoom(part.room, heads_and_feet(lambda: step_moments(plan.presses, passes)))
        header = Header(plan.words, boxes.box("header"), boxes.scale * part.text, style, room)
    feet = _feet_box(plan, boxes, header)
    legend = _legend(plan, boxes, style, header, feet, turned)
    calls = None
    if boxes.layout.dancer is not None and plan.callouts:
        box, scale = calls_room(boxes, None if header is None else header.title_end)
        box = clear_part(box, heads_and_feet(lambda: call_moments(plan.callouts, passes)), CALLS_WIDE * scale)
        calls = Calls(plan.callouts, box, scale, style)
    return Placement(header, legend, feet, _runs(plan, boxes, style, header), calls)


def _below(box: PixelBox, header: Header | None, off: float) -> PixelBox:
    """Return a box, moved down so that it keeps clear of the song's words, which may be many."""
    return box if header is None else header.clear(box, off)


def _feet_box(plan: FilmPlan, boxes: PartBoxes, header: Header | None) -> PixelBox | None:
    """Return the box of the feet from above; None if there is no room for them beside the picture of two dancers."""
    if (part := boxes.layout.feet) is None or not (part.wide or boxes.breadth <= WIDE_PAD):
        return None
    box = boxes.box("feet")
    if plan.dancers > 1 and overlap(box, boxes.box("dancer")):
        return None
    return _below(box, header, LEGEND_OFF * boxes.scale)


def _legend(
    plan: FilmPlan, boxes: PartBoxes, style: WordStyle, header: Header | None, feet: PixelBox | None, turned: bool
) -> Legend | None:
    """Return the legend, moved below the song's words and the box of the feet if it would overlap them."""
    if (part := boxes.layout.legend) is None:
        return None
    scale = boxes.scale * part.text
    shown = sorted({0, 1} | visible_limbs(plan.notes, plan.clock.passes))
    words, players = style.language.film, style.highway.players if plan.notes.player.any() else ()
    box = _below(boxes.box("legend"), header, LEGEND_OFF * scale)
    if feet is not None and overlap(feet, box):
        under = lowered(box, feet[3] + LEGEND_OFF * boxes.scale)
        box = under if under[3] <= boxes.size[1] else box  # a user's own layout may leave no room there
    explained = LegendWords(
        {limb: style.language.limbs[LABELS[limb]] for limb in shown},
        words["facing"] if turned and not boxes.layout.highway else "",
        [(words["player"].replace("{number}", str(n)), colour) for n, colour in enumerate(players, 1)],
    )
    return Legend(explained, box, scale, style.face)


def _runs(plan: FilmPlan, boxes: PartBoxes, style: WordStyle, header: Header | None) -> Runs:
    """Return the labels of the runs, in their own box, below the header, or at the bottom of the picture."""
    layout, (width, height), scale = boxes.layout, boxes.size, boxes.scale
    box: tuple[float, ...] = 0, RUNS_TOP * height, width, RUNS_BOTTOM * height
    if layout.runs is not None:
        box, scale = boxes.box("runs"), scale * layout.runs.text
    elif header is not None and layout.header is not None:
        scale *= layout.header.text
        box = boxes.box("header")[0], header.bottom + RUNS_OFF * scale
    count = (0, 0, *boxes.size) if layout.count is None else boxes.box("count")
    return Runs(plan.clock, box, count, scale, style)


# Room for words beside the dancer: the part of a box into which neither her head nor her feet come.

CALLS_FROM, CALLS_HIGH = 0.5, 150.0  # leftmost start of calls, share of the dancer's box; height of their box, pixels
CALLS_WIDE, CALLS_OFF = 140.0, 8.0  # minimum width of calls, and their distance to her head and feet, pixels
MOMENT_STEP, MOST_MOMENTS = 0.1, 400  # seconds between the moments that are checked, and their maximum number


class CallsRoom(NamedTuple):
    """The box in which calls may stand, pixels, and the scale of their letters."""

    box: PixelBox
    scale: float


def calls_room(boxes: PartBoxes, title_end: tuple[float, float] | None) -> CallsRoom:
    """Return the box of the calls: the layout's own, or the top right of the dancer's box; below a long title.

    title_end : right and bottom of the song's title
    """
    layout, scale = boxes.layout, boxes.scale
    if (part := layout.calls) is not None:
        left, top, right, bottom = boxes.box("calls")
        if title_end is not None and title_end[0] > left:
            top = min(max(top, round(title_end[1])), bottom)
        return CallsRoom((left, top, right, bottom), scale * part.text)
    left, top, right, _ = boxes.box("dancer")
    scale *= layout.header.text if layout.header is not None else 1.0
    gap = round(22 * scale)
    left, right, top = left + round(CALLS_FROM * (right - left)), right - gap, top + gap
    if title_end is not None and title_end[0] > left:
        top = max(top, round(title_end[1]) + gap // 2)
    return CallsRoom((left, top, right, top + round(CALLS_HIGH * scale)), scale)


def call_moments(callouts: Sequence[Callout], passes: Sequence[Pass]) -> list[Moment]:
    """Return moments at which passages are called out, at most `MOST_MOMENTS` of one pass for each rate."""
    found: list[Moment] = []
    for rate, one in {one.rate: one for one in passes}.items():
        spans = [(max(call.called_from, one.start), min(max(call.end, call.second), one.end)) for call in callouts]
        spans = [(low, high) for low, high in spans if low < high]
        if spans:
            step = max(MOMENT_STEP, sum(high - low for low, high in spans) / MOST_MOMENTS)
            seconds = np.unique(np.concatenate([np.arange(low, high, step) for low, high in spans]))
            found += [Moment(second, rate) for second in seconds[:MOST_MOMENTS].tolist()]
    return found


def step_moments(presses: Presses, passes: Sequence[Pass]) -> list[Moment]:
    """Return moments from the first to the last step of one pass for each rate.

    A pass without steps has moments from its start to its end.
    """
    first, last = float(presses.start.min(initial=math.inf)), float(presses.end.max(initial=-math.inf))
    found: list[Moment] = []
    for rate, one in {one.rate: one for one in passes}.items():
        low, high = max(first, one.start), min(last, one.end)
        if low >= high:
            low, high = one.start, one.end
        step = max(MOMENT_STEP, (high - low) / MOST_MOMENTS)
        found += [Moment(second, rate) for second in np.arange(low, high, step)[:MOST_MOMENTS].tolist()]
    return found


def clear_part(box: PixelBox, taken: NDArray[np.float64], least: float) -> PixelBox:
    """Return the part of a box to the right of the taken places, at least `least` pixels wide.

    If there is no such room beside the dancer's head, the box moves down beside her trunk, or to her left. If no place
    has enough room, the box is unchanged.

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
    """Return the pixels by which a box may move down.

    They are 0, and the distance to below the places that reach over `edge`, if the box then stays above the feet.
    """
    high = taken[(taken[:, 2] > edge) & (taken[:, 1] < box[3])]
    down = max(0, int(np.ceil(high[:, 3].max(initial=box[1]))) - box[1])
    return [0, down] if box[3] + down <= taken[:, 3].max(initial=0) else [0]


# Words that the dancer walks through on her way onto the pad or off it are hidden until she has passed.

WORDS_FADE = 0.3  # seconds of the film in which words come and go
PASSING_STEP = 1 / 15  # seconds of the film between the moments that are checked
MOST_PASSING = 3000  # maximum number of these moments
Covered = Callable[[NDArray[np.float64], float], NDArray[np.bool_]]


@dataclass(frozen=True, slots=True)
class Stay:
    """The time in which words stand in the picture, seconds of the music; rate : the speed of the pass."""

    since: float = -math.inf
    until: float = math.inf
    rate: float = 1.0

    def opacity(self, second: float) -> float:
        """Return the opacity of the words, 0 to 1."""
        return min(1.0, max(0.0, min(second - self.since, self.until - second) / (WORDS_FADE * self.rate)))


def stay_of(one: Pass, presses: Presses, covered: Covered) -> Stay:
    """Return the time in which words stand in the picture during a pass.

    They appear when the dancer has walked past them before the first step, and disappear before she walks past them
    after the last step. The time is found for the whole pass, so that a frame does not depend on the process that draws
    it.

    covered : for seconds of the music (n,) and the step that she walks to or from, whether she walks behind the words
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
