"""The choices for a picture, as the options name them. The module imports little, so that help texts are quick."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from dancetutor_cli.run.errors import UsageError

LEAST_SIDE = 64  # pixels
MOST_SIDE = 7680

Quality = Literal["draft", "good", "best"]
QUALITIES: tuple[Quality, ...] = ("draft", "good", "best")
RendererKind = Literal["auto", "cpu", "gl"]
RENDERERS: tuple[RendererKind, ...] = ("auto", "cpu", "gl")


# The time between a call and its move, as the user writes it: "0.9" seconds, or "b2" beats.

MOST_AHEAD = 30.0  # seconds, or beats


@dataclass(frozen=True, slots=True)
class Ahead:
    """The time between a call and its move, in seconds of the music or in beats."""

    length: float
    in_beats: bool = False


def parse_ahead(text: str) -> Ahead:
    """Parse the time before a move, such as "0.9" (seconds) or "b2" (beats); UsageError shows both forms."""
    match = re.fullmatch(r"(b?)(\d{1,4}(?:\.\d{1,6})?)", text.strip().lower())
    if match is None or not 0 < float(match[2]) <= MOST_AHEAD:
        raise UsageError(f"--call-ahead {text}: write seconds, such as 0.9, or beats, such as b2")
    return Ahead(float(match[2]), bool(match[1]))
