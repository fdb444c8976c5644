"""Room for words beside her: the part of a box into which neither her head nor her feet come."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.video.clock import Moment, Pass
from dancetutor_cli.video.layout import Layout, PixelBox
from dancetutor_cli.video.notes import Callout, Presses

CALLS_FROM, CALLS_HIGH = 0.5, 150.0  # where calls begin at the leftmost, share of her box; pixels of their box
CALLS_WIDE, CALLS_OFF = 140.0, 8.0  # pixels that they need at least, and to her head and feet
STEP, MOST = 0.1, 400  # seconds between the moments that are looked at, and how many at most


class CallsRoom(NamedTuple):
    """Where calls may stand, pixels, and how large they are."""

    box: PixelBox
    scale: float


def calls_room(
    layout: Layout, box_of: Callable[[str], PixelBox], scale: float, title_end: tuple[float, float] | None
) -> CallsRoom:
    """The box of what is called out: the layout's, else at the top right of the dancer's; below a long title.

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
    """Moments at which passages are called out, of one pass of each rate; at most `MOST` of each."""
    found: list[Moment] = []
    for rate, one in {one.rate: one for one in passes}.items():
        spans = [(max(told.begin, one.start), min(max(told.end, told.second), one.end)) for told in callouts]
        spans = [(low, high) for low, high in spans if low < high]
        if spans:
            step = max(STEP, sum(high - low for low, high in spans) / MOST)
            seconds = np.unique(np.concatenate([np.arange(low, high, step) for low, high in spans]))
            found += [Moment(second, rate) for second in seconds[:MOST].tolist()]
    return found


def dancing(presses: Presses, passes: Sequence[Pass]) -> list[Moment]:
    """Moments from the first to the last step of a pass, of one of each rate; of one without a step all of it."""
    first, last = float(presses.start.min(initial=math.inf)), float(presses.end.max(initial=-math.inf))
    found: list[Moment] = []
    for rate, one in {one.rate: one for one in passes}.items():
        low, high = max(first, one.start), min(last, one.end)
        if low >= high:
            low, high = one.start, one.end
        step = max(STEP, (high - low) / MOST)
        found += [Moment(second, rate) for second in np.arange(low, high, step)[:MOST].tolist()]
    return found


def clear(box: PixelBox, taken: NDArray[np.float64], least: float) -> PixelBox:
    """The part of a box on the right of what is taken, at least `least` pixels wide.

    Where there is no such room beside her, the box stands lower, beside her trunk; else on her left; else as it is.

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
    """How far down a box may stand: not at all, or below what reaches over `edge` where it is, but above the feet."""
    high = taken[(taken[:, 2] > edge) & (taken[:, 1] < box[3])]
    down = max(0, int(np.ceil(high[:, 3].max(initial=box[1]))) - box[1])
    return [0, down] if box[3] + down <= taken[:, 3].max(initial=0) else [0]
