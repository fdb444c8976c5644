"""The games' names of steps types (with their columns) and of difficulties; the ticks of a beat and of a measure."""

from __future__ import annotations

TICKS_PER_BEAT = 48
TICKS_PER_MEASURE = 4 * TICKS_PER_BEAT

COLUMNS = {
    "dance-single": 4, "dance-double": 8, "dance-couple": 8, "dance-solo": 6, "dance-threepanel": 3, "dance-routine": 8,
    "pump-single": 5, "pump-halfdouble": 6, "pump-double": 10, "pump-couple": 10, "pump-routine": 10,
    "kb7-single": 7, "ez2-single": 5, "ez2-double": 10, "ez2-real": 7, "para-single": 5, "ds3ddx-single": 8,
    "bm-single5": 6, "bm-versus5": 6, "bm-double5": 12, "bm-single7": 8, "bm-versus7": 8, "bm-double7": 16,
    "maniax-single": 4, "maniax-double": 8, "techno-single4": 4, "techno-single5": 5, "techno-single8": 8,
    "techno-double4": 8, "techno-double5": 10, "techno-double8": 16, "pnm-five": 5, "pnm-nine": 9, "lights-cabinet": 6,
    "kickbox-human": 4, "kickbox-quadarm": 4, "kickbox-insect": 6, "kickbox-arachnid": 8,
    # steps types of StepManiaX and SMEditor, which other games do not know
    "smx-beginner": 3, "smx-single": 5, "smx-double6": 6, "smx-double10": 10, "smx-team": 10,
    "dance-solodouble": 12, "dance-threedouble": 6,
}  # fmt: skip

_OTHER_NAMES = {
    "para": "para-single", "ez2-single-hard": "ez2-single",
    "smx-dual": "smx-double6", "smx-full": "smx-double10",  # editors' names of StepManiaX's modes
}  # fmt: skip

DIFFICULTIES = ("Beginner", "Easy", "Medium", "Hard", "Challenge", "Edit")

_BY_NAME = {name.lower(): name for name in DIFFICULTIES}

_OLD_DIFFICULTIES = _BY_NAME | {
    "basic": "Easy", "light": "Easy",
    "another": "Medium", "trick": "Medium", "standard": "Medium", "difficult": "Medium",
    "ssr": "Hard", "maniac": "Hard", "heavy": "Hard",
    "expert": "Challenge", "oni": "Challenge", "smaniac": "Challenge",
}  # fmt: skip


def steps_type(text: str) -> str:
    """Return the steps type in lower case; old and alternative names become the name used in this program."""
    name = text.strip().lower()
    return _OTHER_NAMES.get(name, name)


def is_routine(steps_type: str) -> bool:
    """Whether `&` splits the note data between players."""
    return steps_type.endswith(("-routine", "-team"))


def is_lights(steps_type: str) -> bool:
    """Whether the chart is for the lights of a cabinet, not for feet."""
    return steps_type.startswith("lights")


def difficulty(text: str, description: str, meter: int, old: bool) -> tuple[str, bool]:
    """Return the difficulty that StepMania 5 and ITGmania show, and whether the tag itself is a known name.

    With `old` (.sm), old names ("Basic", "Oni", ...) are known, and a Hard described as "smaniac" or "challenge" is
    Challenge. If the name is unknown, the description is tried, and then the meter gives the difficulty.
    """
    described = description.strip().lower()
    name = (_OLD_DIFFICULTIES if old else _BY_NAME).get(text.strip().lower())
    if name == "Hard" and old and described in ("smaniac", "challenge"):
        name = "Challenge"
    if name:
        return name, True
    if described in _BY_NAME:
        return _BY_NAME[described], False
    if meter == 1:
        return "Beginner", False
    return "Easy" if meter <= 3 else "Medium" if meter <= 6 else "Hard", False
