"""The names of the cost models: their switches, their weights (which are also the names of cost terms), their times.

The order of names is the order of the kernels' arrays and of the columns of `Play.cost`.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Model:
    """What a preset of this model has to say; `terms` are the names of the columns of `Play.cost`."""

    switches: tuple[str, ...]
    weights: tuple[str, ...]
    times: tuple[str, ...]
    terms: tuple[str, ...]


_THESIS = (
    "crossover", "doublestep", "jump-footswitch", "spin", "turn-135", "turn-180",
    "hand-hold", "hand-across", "hand-aside", "hand-behind", "unplayable",
)  # fmt: skip

_ITG = (
    "doublestep", "fast-jack", "footswitch", "slow-footswitch", "sideswitch", "jump-footswitch", "holdswitch",
    "bracket", "slow-bracket", "fast-jump", "crossover", "crossover-start", "crossover-back", "crossover-jump",
    "crossover-full", "spin", "turn-135", "turn-180", "facing", "distance", "stretch", "twisted", "mine", "lifted",
    "release", "hand", "hand-hold", "unplayable",
)  # fmt: skip
# weights that take the place of another under some condition; they have no column of their own
_ITG_INSTEAD = ("rested-doublestep", "marked-doublestep", "released-doublestep", "marked-footswitch")
_ITG_TIMES = (
    "doublestep-fast", "doublestep-rest", "doublestep-rested", "jack-fast", "footswitch-slow", "footswitch-slowest",
    "bracket-slow", "bracket-slowest", "jump-fast", "distance-least",
)  # fmt: skip

MODELS = {
    "thesis": Model(("allow-doublestep",), _THESIS, (), _THESIS),
    "itg": Model(("brackets", "holdswitches"), (*_ITG, *_ITG_INSTEAD), _ITG_TIMES, _ITG),
}

# What may happen in a row, by the names players use; the number of a name is its bit in the kernels' events.
EVENTS = (
    "crossover-half", "crossover-full", "spin", "doublestep", "forced-doublestep", "jump-footswitch", "hand", "jump",
    "unplayable", "footswitch-up", "footswitch-down", "sideswitch-left", "sideswitch-right", "bracket", "holdswitch",
    "crossover-front", "crossover-back", "footswitch", "jack", "candle", "gallop", "stream", "drill",
)  # fmt: skip
