"""The solver: rows and a cost preset in, the cheapest play out."""

from dancetutor_cli.play.model import Limb, Part, Play, Rows, StepKind
from dancetutor_cli.play.preset import DEFAULT_PRESET, Preset, load_preset, preset_names
from dancetutor_cli.play.rows import prepare
from dancetutor_cli.play.solver import solve, solve_chart

__all__ = [
    "DEFAULT_PRESET", "Limb", "Part", "Play", "Preset", "Rows", "StepKind", "load_preset", "prepare", "preset_names",
    "solve", "solve_chart",
]  # fmt: skip
