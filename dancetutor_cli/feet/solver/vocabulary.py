"""The names of the cost models: their switches, and their weights and curves, which are also the names of cost terms.

The order of names is the order of the kernels' arrays and of the columns of `Play.cost`.
"""

from __future__ import annotations

from dataclasses import dataclass

MOST_MS = 2047  # milliseconds since the last row with steps; longer times cost the same


@dataclass(frozen=True, slots=True)
class CostModel:
    """The values of a model's presets.

    A weight is one number; a curve has a number for each time since the last row.
    """

    switches: tuple[str, ...]
    weights: tuple[str, ...]
    curves: tuple[str, ...]

    @property
    def terms(self) -> tuple[str, ...]:
        """Names of the columns of `Play.cost`."""
        return self.weights + self.curves


_THESIS = (
    "crossover", "doublestep", "jump-footswitch", "spin", "turn-135", "turn-180",
    "hand-hold", "hand-across", "hand-aside", "hand-behind", "unplayable",
)  # fmt: skip

_ITG = (
    "marked-doublestep", "marked-footswitch", "sideswitch", "jump-footswitch", "holdswitch", "bracket-in-front",
    "bracket-in-back", "bracket-out-back", "bracket-aside", "twisted", "crossover-jump", "crossover-full", "spin",
    "turn-135", "turn-180", "facing", "facing-aside", "stretch", "leap", "mine", "lifted", "release", "hand",
    "hand-hold", "hand-behind", "unplayable", "split-in-front", "split-in-back", "split-out-back", "near-holdswitch",
)  # fmt: skip
# `distance` comes last, because it has a size; the other facts are true or false
_ITG_CURVES = (
    "doublestep", "near-doublestep", "released-doublestep", "freed-doublestep", "early-freed-doublestep",
    "forced-doublestep", "grown-bracket", "jack", "footswitch", "bracket", "held-bracket", "bracket-jump", "jump",
    "after-jump", "teleport", "crossover", "crossover-start", "freed-step", "middle-switch", "released-switch",
    "shared-jack", "jump-move", "jump-exchange", "other-split", "bracket-again", "held-again", "held-tap",
    "jump-again", "distance",
)  # fmt: skip

MODELS = {
    "thesis": CostModel(("allow-doublestep",), _THESIS, ()),
    "itg": CostModel(("brackets", "holdswitches"), _ITG, _ITG_CURVES),
}

# The events of a row, by the names that players use; the index of a name is its bit in the kernels' events.
EVENTS = (
    "crossover-half", "crossover-full", "spin", "doublestep", "forced-doublestep", "jump-footswitch", "hand", "jump",
    "unplayable", "footswitch-up", "footswitch-down", "sideswitch-left", "sideswitch-right", "bracket", "holdswitch",
    "crossover-front", "crossover-back", "footswitch", "jack", "candle", "gallop", "stream", "drill",
)  # fmt: skip
