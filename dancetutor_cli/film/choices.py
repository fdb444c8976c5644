"""The choices for a picture, as options name them; a light module, for quick help texts."""

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


# How long before a move its call comes, as the user writes it: "0.9" seconds, or "b2" beats.

MOST_AHEAD = 30.0  # seconds, or beats


@dataclass(frozen=True, slots=True)
class Ahead:
    """How long before a move its call comes: seconds of the music, or beats."""

    length: float
    in_beats: bool = False


def parse_ahead(text: str) -> Ahead:
    """ "0.9" seconds, or "b2" beats; UsageError says how it is written."""
    match = re.fullmatch(r"(b?)(\d{1,4}(?:\.\d{1,6})?)", text.strip().lower())
    if match is None or not 0 < float(match[2]) <= MOST_AHEAD:
        raise UsageError(f"'{text}': write the time before a move as 0.9 (seconds) or b2 (beats)")
    return Ahead(float(match[2]), bool(match[1]))
