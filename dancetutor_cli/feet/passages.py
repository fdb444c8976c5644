"""The hardest passages of a chart, found from the solver's play alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.names import TICKS_PER_MEASURE
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play, StepKind
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import Bounds, NotNegative
from dancetutor_cli.run.yaml_files import load

if TYPE_CHECKING:
    from dancetutor_cli.chart.timing import Timing

_CROSSED = ("crossover-half", "crossover-full")
_SWITCHES = ("footswitch-up", "footswitch-down", "footswitch", "sideswitch-left", "sideswitch-right", "jump-footswitch")
_SHORTEST = 0.12  # seconds; a passage that warps make shorter than this has no meaningful speed


@dataclass(frozen=True, slots=True)
class PassageSettings:
    """The keys of configs/passages.yaml.

    A row weighs `step`, plus the weight of each of its moves; a passage is `measures` long.
    """

    measures: Annotated[int, Bounds(0)]
    most: Annotated[int, Bounds(0)]
    harder: NotNegative
    close: NotNegative
    step: NotNegative
    jump: NotNegative
    bracket: NotNegative
    hand: NotNegative
    crossover: NotNegative
    spin: NotNegative
    footswitch: NotNegative
    doublestep: NotNegative
    jack: NotNegative
    turn: NotNegative
    unsure: NotNegative


@dataclass(frozen=True, slots=True)
class Passage:
    """One passage: from the start of measure `first` to the start of measure `last`, from `start` to `end` seconds.

    score : weight of the rows per second; rate : rows per second; steps : number of rows
    crossovers : how often the left and the right foot cross over; turn : the largest angle between the dancer and the
    screen, degrees
    spins, brackets, footswitches, doublesteps, jacks, jumps, hands : number of rows with each move
    stream : number of rows in streams; unsure : number of rows in which other limbs cost hardly more
    """

    first: int
    last: int
    start: float
    end: float
    score: float
    rate: float
    steps: int
    crossovers: tuple[int, int]
    turn: float
    spins: int
    brackets: int
    footswitches: int
    doublesteps: int
    jacks: int
    jumps: int
    hands: int
    stream: int
    unsure: int


@cache
def passage_settings() -> PassageSettings:
    """Load configs/passages.yaml. Raises FileError if a value is wrong."""
    return load(config_path("passages.yaml"), PassageSettings)


def hardest_passages(play: Play, timing: Timing, settings: PassageSettings | None = None) -> tuple[Passage, ...]:
    """Return the hardest passages, the hardest first; passages do not overlap. A chart without steps has no passages.

    A passage begins at the start of a measure and is `measures` of the settings long, or as long as a shorter chart.
    Its rows weigh at least `harder` times as much per second as the mean of the chart.
    """
    settings = settings or passage_settings()
    stepped = _visible_steps(play)
    rows = np.flatnonzero(stepped.any(axis=1))
    if not len(rows):
        return ()
    weight = _weights(play, rows, stepped, settings)
    measure = play.rows.tick[rows] // TICKS_PER_MEASURE
    per_measure = np.bincount(measure - measure[0], weights=weight)
    ticks = (measure[0] + np.arange(len(per_measure) + 1)) * TICKS_PER_MEASURE
    edges = np.asarray(timing.seconds(ticks), dtype=np.float64)
    length = min(settings.measures, len(per_measure))
    totals = np.convolve(per_measure, np.ones(length), "valid")
    spans = edges[length:] - edges[:-length]
    scores = np.where(spans > _SHORTEST, totals / np.maximum(spans, _SHORTEST), 0.0)
    least = settings.harder * per_measure.sum() / max(edges[-1] - edges[0], _SHORTEST)
    out: list[Passage] = []
    taken = np.zeros(len(per_measure), dtype=bool)
    for at in np.argsort(-scores, kind="stable").tolist():
        if len(out) == settings.most or scores[at] < least or scores[at] <= 0:
            break
        if taken[at : at + length].any():
            continue
        taken[at : at + length] = True
        inside = rows[(measure - measure[0] >= at) & (measure - measure[0] < at + length)]
        first = int(measure[0]) + at
        start, end = float(edges[at]), float(edges[at + length])
        counts = _counts(play, inside, stepped[inside], settings)
        rate = len(inside) / (end - start)
        out.append(Passage(first, first + length, start, end, float(scores[at]), rate, len(inside), **counts))
    return tuple(out)


def _visible_steps(play: Play) -> NDArray[np.bool_]:
    """Whether each cell (n, c) has a step that a person sees; the virtual taps of rolls are left out."""
    steps = play.rows.steps
    return np.asarray((steps != StepKind.NONE) & (steps != StepKind.ROLL_TAP))


def _has_move(play: Play, rows: NDArray[np.int64], names: tuple[str, ...]) -> NDArray[np.bool_]:
    """Whether each of the rows has one of these moves."""
    return np.array([any(name in play.moves[row] for name in names) for row in rows.tolist()], dtype=bool)


def _is_first(marked: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether each row is the first of a run of marked rows; feet that stay crossed count as one crossover."""
    return np.asarray(marked & ~np.concatenate([[False], marked[:-1]]))


def _turns(play: Play, rows: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the angles (n,) by which the dancer turns between the row before and each row, degrees."""
    facing = play.facing[rows]
    change = np.abs(np.diff(facing, prepend=facing[:1]))
    return np.asarray(np.minimum(change, 360.0 - np.minimum(change, 360.0)))


def _is_unsure(play: Play, rows: NDArray[np.int64], close: float) -> NDArray[np.bool_]:
    """Whether each row can be stepped with other limbs at hardly more cost."""
    if play.margin is None:
        return np.zeros(len(rows), dtype=bool)
    mean = max(float(play.cost.sum()) / max(len(play.rows), 1), 1.0)
    margin = play.margin[rows]
    return np.asarray((margin >= 0) & (margin <= close * mean))


def _weights(
    play: Play, rows: NDArray[np.int64], stepped: NDArray[np.bool_], settings: PassageSettings
) -> NDArray[np.float64]:
    out = np.full(len(rows), settings.step)
    for share, names in (
        (settings.bracket, ("bracket",)),
        (settings.hand, ("hand",)),
        (settings.spin, ("spin",)),
        (settings.footswitch, _SWITCHES),
        (settings.doublestep, ("doublestep",)),
        (settings.jack, ("jack",)),
    ):
        out += share * _has_move(play, rows, names)
    out += settings.crossover * _is_first(_has_move(play, rows, _CROSSED))
    out += settings.jump * ((stepped[rows].sum(axis=1) > 1) & ~_has_move(play, rows, ("bracket",)))
    out += settings.turn * _turns(play, rows) / 90.0
    return np.asarray(out + settings.unsure * _is_unsure(play, rows, settings.close))


def _counts(
    play: Play, rows: NDArray[np.int64], stepped: NDArray[np.bool_], settings: PassageSettings
) -> dict[str, Any]:
    """Return the counts of some rows, as in `Passage`; stepped : (rows, columns), the visible steps"""

    def count(*names: str) -> int:
        return int(_has_move(play, rows, names).sum())

    crossing = rows[_is_first(_has_move(play, rows, _CROSSED))]
    limbs = play.limb[crossing]
    two = (stepped.sum(axis=1) > 1) & ~_has_move(play, rows, ("bracket",))
    return {
        "crossovers": tuple(int((limbs == foot).any(axis=1).sum()) for foot in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)),
        "turn": float(np.abs(play.facing[rows]).max(initial=0.0)),
        "spins": count("spin"),
        "brackets": count("bracket"),
        "footswitches": count(*_SWITCHES),
        "doublesteps": count("doublestep"),
        "jacks": count("jack"),
        "jumps": int(two.sum()),
        "hands": count("hand"),
        "stream": count("stream"),
        "unsure": int(_is_unsure(play, rows, settings.close).sum()),
    }
