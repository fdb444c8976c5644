"""The solver: cost preset -> transition tables -> dynamic programme -> Play (who steps what, and what it costs).

Names are looked up when they are used, so that importing the data model does not import numba.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dancetutor_cli.play.doublestep_causes import Blame, blame
    from dancetutor_cli.play.kbest import Alternative, alternatives
    from dancetutor_cli.play.played import Ambiguity, Limb, Part, Play, Rows, StepKind
    from dancetutor_cli.play.preset import DEFAULT_PRESET, Preset, default_preset, load_preset, preset_names
    from dancetutor_cli.play.rows import prepare
    from dancetutor_cli.play.solver import solve, solve_chart

__all__ = [
    "DEFAULT_PRESET", "Alternative", "Ambiguity", "Blame", "Limb", "Part", "Play", "Preset", "Rows", "StepKind",
    "alternatives", "blame", "default_preset", "load_preset", "prepare", "preset_names", "solve", "solve_chart",
]  # fmt: skip
_MODULES = {
    "kbest": ("Alternative", "alternatives"),
    "doublestep_causes": ("Blame", "blame"),
    "played": ("Ambiguity", "Limb", "Part", "Play", "Rows", "StepKind"),
    "preset": ("DEFAULT_PRESET", "Preset", "default_preset", "load_preset", "preset_names"),
    "rows": ("prepare",),
    "solver": ("solve", "solve_chart"),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
