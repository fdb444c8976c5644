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

MODELS = {"thesis": Model(("allow-doublestep",), _THESIS, (), _THESIS)}

# What may happen in a row, by the names players use; the number of a name is its bit in the kernels' events.
EVENTS = (
    "crossover-half", "crossover-full", "spin", "doublestep", "forced-doublestep", "jump-footswitch", "hand", "jump",
    "unplayable", "footswitch-up", "footswitch-down", "sideswitch-left", "sideswitch-right", "bracket", "holdswitch",
    "crossover-front", "crossover-back", "jack", "candle", "gallop", "stream", "drill",
)  # fmt: skip
