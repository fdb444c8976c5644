"""Where the lanes of a highway lie in the picture."""

from __future__ import annotations

from dataclasses import dataclass

NUMBER_EDGE, NUMBER_ROOM = 0.009, 0.045  # heights of the box beside a measure's number, and that three digits take
NUMBERS = 0.26  # of the width that lanes leave, the part on their left, where numbers stand
NUMBER_OFF, EDGE = 0.2, 0.14  # lane widths from numbers to the first lane, and from the last one to its frame
TAG_LEFT, TAG_EDGE = 3, 0.0105  # pixels on the left of words beside the notes; heights of the box on their right
LEAST_LANES = 0.7  # of their usual width that lanes have at least, whatever words stand beside them


@dataclass(frozen=True, slots=True)
class HighwayGeometry:
    """Where the highway lies, in pixels: box (left, top, right, bottom); lane width; y of the receptors' middle.

    directions : per column, degrees clockwise from up, None for a middle panel; down : notes fall instead of rise
    turned : she faces who looks on; the lanes stand the other way round, and `directions` are as they are seen then
    tags : words stand beside the notes; letters : their size that room is left for, pixels
    """

    box: tuple[int, int, int, int]
    lane: float
    receptor: float
    directions: tuple[float | None, ...]
    down: bool = False
    turned: bool = False
    tags: bool = True
    letters: float = 10.0

    def lane_of(self, column: int) -> int:
        """Which lane from the left a column has."""
        return len(self.directions) - 1 - column if self.turned else column

    @property
    def left(self) -> float:
        """x of the first lane; where words stand, more room is left for them on the right than for measure numbers."""
        spare = self.box[2] - self.box[0] - self.lane * len(self.directions)
        least = NUMBER_OFF * self.lane + NUMBER_ROOM * (self.box[3] - self.box[1])
        return self.box[0] + (min(max(NUMBERS * spare, least), 0.5 * spare) if self.tags else 0.5 * spare)

    @property
    def tags_left(self) -> float:
        """x where words beside the notes begin."""
        return self.left + self.lane * (len(self.directions) + EDGE) + TAG_LEFT

    @property
    def tags_room(self) -> float:
        """Pixels that such words may be wide, with their label."""
        return self.box[2] - self.tags_left - TAG_EDGE * (self.box[3] - self.box[1])

    def corner(self, column: int, y: float, size: float) -> tuple[float, float]:
        """Top left corner of what is so large, in the middle of a column's lane at `y`."""
        return self.left + (self.lane_of(column) + 0.5) * self.lane - size / 2, y - size / 2


def lane_beside(words: float, lane: float, box: tuple[int, int, int, int], columns: int) -> float:
    """The width of lanes beside which words so wide have room: `lane`, or less; the inverse of `tags_room`.

    words : pixels; lane : pixels that a lane has where there are none
    """
    width, height = box[2] - box[0], box[3] - box[1]
    free = width - words - TAG_LEFT - TAG_EDGE * height
    beside_numbers = (free - NUMBER_ROOM * height) / (columns + NUMBER_OFF + EDGE)
    beside_part = (free - NUMBERS * width) / ((1 - NUMBERS) * columns + EDGE)
    return max(LEAST_LANES * lane, min(lane, beside_numbers, beside_part))
