"""What the games call things: steps types with their columns, difficulties with their old names."""

from __future__ import annotations

COLUMNS = {
    "dance-single": 4, "dance-double": 8, "dance-couple": 8, "dance-solo": 6, "dance-threepanel": 3, "dance-routine": 8,
    "pump-single": 5, "pump-halfdouble": 6, "pump-double": 10, "pump-couple": 10, "pump-routine": 10,
    "kb7-single": 7, "ez2-single": 5, "ez2-double": 10, "ez2-real": 7, "para-single": 5, "ds3ddx-single": 8,
    "bm-single5": 6, "bm-versus5": 6, "bm-double5": 12, "bm-single7": 8, "bm-versus7": 8, "bm-double7": 16,
    "maniax-single": 4, "maniax-double": 8, "techno-single4": 4, "techno-single5": 5, "techno-single8": 8,
    "techno-double4": 8, "techno-double5": 10, "techno-double8": 16, "pnm-five": 5, "pnm-nine": 9, "lights-cabinet": 6,
    "kickbox-human": 4, "kickbox-quadarm": 4, "kickbox-insect": 6, "kickbox-arachnid": 8,
}  # fmt: skip

DIFFICULTIES = {
    "beginner": "Beginner",
    "easy": "Easy", "basic": "Easy", "light": "Easy",
    "medium": "Medium", "another": "Medium", "trick": "Medium", "standard": "Medium", "difficult": "Medium",
    "hard": "Hard", "ssr": "Hard", "maniac": "Hard", "heavy": "Hard",
    "challenge": "Challenge", "expert": "Challenge", "oni": "Challenge", "smaniac": "Challenge",
    "edit": "Edit",
}  # fmt: skip


def difficulty(text: str, description: str) -> str:
    """The difficulty as the games show it; an unknown one is an Edit. Old files say Challenge in the description."""
    name = DIFFICULTIES.get(text.strip().lower(), "Edit")
    if name == "Hard" and description.strip().lower() in ("smaniac", "challenge"):
        return "Challenge"
    return name
