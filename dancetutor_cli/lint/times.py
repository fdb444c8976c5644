"""How quick a move has to be to be worth a word: configs/move_times.yaml says what share of charts contain it.

What one chart in five of a meter has belongs to that meter; the same move twice as quick may be in none.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from dancetutor_cli.marked_yaml import read
from dancetutor_cli.resources import config_path

if TYPE_CHECKING:
    from collections.abc import Mapping

_OTHERS = "dance-single"  # the table that holds for pads nobody has measured


class Band(NamedTuple):
    """Charts of one kind of pad, of meters `first` to `last` (None: and above). within : see `Table.milliseconds`"""

    pad: str
    first: int
    last: int | None
    charts: int
    within: tuple[float, ...]

    @property
    def meters(self) -> str:
        """ "4 to 6", "13 and more"."""
        return f"{self.first} and more" if self.last is None else f"{self.first} to {self.last}"


def pad_of(steps_type: str) -> str:
    """The pad in the table that a steps type counts with."""
    family, _, kind = steps_type.partition("-")
    pad = f"{family}-{'double' if kind in ('halfdouble', 'double', 'routine') else 'single'}"
    return pad if pad in _data()["meters"] else _OTHERS


def bands(move: str) -> Iterator[Band]:
    """Every band of charts with the shares of a move."""
    data = _data()
    for pad, lasts in data["meters"].items():
        edges: Sequence[Any] = [*lasts, None]
        first = 1
        for number, last in enumerate(edges):
            yield Band(pad, first, last, data["charts"][pad][number], tuple(data["moves"][move][pad][number]))
            first = 0 if last is None else last + 1


def milliseconds() -> tuple[int, ...]:
    """The times of the table; `Band.within` has for each the per cent of charts with a move at most so long after."""
    return tuple(_data()["milliseconds"])


@cache
def limit(move: str, share: float, steps_type: str, meter: int) -> float:
    """The longest time (s) within which at most `share` per cent of the charts of a meter have the move; 0: none."""
    pad = pad_of(steps_type)
    here = next(band for band in bands(move) if band.pad == pad and (band.last is None or meter <= band.last))
    return limit_of(here, share) / 1000


def limit_of(band: Band, share: float) -> int:
    """The same of a band, in milliseconds."""
    few = [time for time, part in zip(milliseconds(), band.within, strict=True) if part <= share]
    return max(few, default=0)


def described(move: str, share: float) -> Iterator[str]:
    """A line for each band: the limit, and the share of charts on either side of it."""
    times = milliseconds()
    for band in bands(move):
        at = limit_of(band, share)
        parts = dict(zip(times, band.within, strict=True))
        said = f"up to {at} ms ({parts[at]:g} % of {band.charts} charts" if at else f"none ({band.charts} charts"
        more = next((time for time in times if time > at), None)
        said += f"; {parts[more]:g} % up to {more} ms)" if more else ")"
        yield f"{band.pad:12} meter {band.meters:12} {said}"


@cache
def _data() -> Mapping[str, Any]:
    return read(config_path("move_times.yaml")).data
