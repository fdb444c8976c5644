"""Which limb steps which note: pads, limbs, feet that people have set, cost presets, and the solver -> `Play`.

    solved.solve_song             the way to feet of a song's charts; `markers` goes it chart by chart: solver.solve
      |   pads, preset              where panels are; what each undesired thing costs; which preset a chart gets
      |   song_feet                 what people laid down: annotations in the file, sme (SMEditor), dancetutor.yaml
      |   overrides                 the same for one chart, and what of it cannot be danced
      |   play.prepare_all          rows of notes
      |   solver.solve              the play that costs least
    solved.Solved                 a chart, its `play.Play`, its pad and preset

    limbs, play_json              names and letters of limbs; plays in the JSON of `analyze`

Names are looked up when they are used, so that importing the data model does not import numba.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dancetutor_cli.feet.limbs import Limb, Part
    from dancetutor_cli.feet.overrides import FeetProblem, Ignores, Overrides
    from dancetutor_cli.feet.pads import MAX_PANELS, Pad, load_pad, load_pads
    from dancetutor_cli.feet.play import Ambiguity, Play, Rows, StepKind, prepare
    from dancetutor_cli.feet.preset import DEFAULT_PRESET, Preset, default_preset, load_preset, preset_names
    from dancetutor_cli.feet.solver.alternatives import Alternative, Blame, alternatives, blame
    from dancetutor_cli.feet.solver.solve import solve, solve_chart
    from dancetutor_cli.feet.song_feet import SongFeet, overrides_for

__all__ = [
    "DEFAULT_PRESET", "MAX_PANELS", "Alternative", "Ambiguity", "Blame", "FeetProblem", "Ignores", "Limb", "Overrides",
    "Pad", "Part", "Play", "Preset", "Rows", "SongFeet", "StepKind", "alternatives", "blame", "default_preset",
    "load_pad", "load_pads", "load_preset", "overrides_for", "prepare", "preset_names", "solve", "solve_chart",
]  # fmt: skip
_MODULES = {
    "limbs": ("Limb", "Part"),
    "overrides": ("FeetProblem", "Ignores", "Overrides"),
    "pads": ("MAX_PANELS", "Pad", "load_pad", "load_pads"),
    "play": ("Ambiguity", "Play", "Rows", "StepKind", "prepare"),
    "preset": ("DEFAULT_PRESET", "Preset", "default_preset", "load_preset", "preset_names"),
    "solver.alternatives": ("Alternative", "Blame", "alternatives", "blame"),
    "solver.solve": ("solve", "solve_chart"),
    "song_feet": ("SongFeet", "overrides_for"),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
