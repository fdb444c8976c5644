"""Where the lanes of a highway lie in the picture."""

from __future__ import annotations

from dataclasses import dataclass

NUMBER_EDGE, NUMBER_ROOM = 0.009, 0.045  # heights of the box beside a measure's number, and that three digits take


@dataclass(frozen=True, slots=True)
class HighwayGeometry:
    """Where the highway lies, in pixels: box (left, top, right, bottom); lane width; y of the receptors' middle.

    directions : per column, degrees clockwise from up, None for a middle panel; down : notes fall instead of rise
    turned : she faces who looks on; the lanes stand the other way round, and `directions` are as they are seen then
    tags : words stand beside the notes
    """

    box: tuple[int, int, int, int]
    lane: float
    receptor: float
    directions: tuple[float | None, ...]
    down: bool = False
    turned: bool = False
    tags: bool = True

    def lane_of(self, column: int) -> int:
        """Which lane from the left a column has."""
        return len(self.directions) - 1 - column if self.turned else column

    @property
    def left(self) -> float:
        """x of the first lane; where words stand, more room is left for them on the right than for measure numbers."""
        spare = self.box[2] - self.box[0] - self.lane * len(self.directions)
        least = 0.2 * self.lane + NUMBER_ROOM * (self.box[3] - self.box[1])
        return self.box[0] + (min(max(0.26 * spare, least), 0.5 * spare) if self.tags else 0.5 * spare)

    def corner(self, column: int, y: float, size: float) -> tuple[float, float]:
        """Top left corner of what is so large, in the middle of a column's lane at `y`."""
        return self.left + (self.lane_of(column) + 0.5) * self.lane - size / 2, y - size / 2
