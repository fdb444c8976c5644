"""Words that come and go: which run of a practice film this is, the count-in, and the moves called out."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from dancetutor_cli.video.blit import Frame, Sprite, blit, rectangle
from dancetutor_cli.video.clock import Clock
from dancetutor_cli.video.layout import PixelBox
from dancetutor_cli.video.notes import Callout
from dancetutor_cli.video.overlay import WHITE, pill
from dancetutor_cli.video.sprites import HighwayStyle
from dancetutor_cli.video.text import Typeface

CALL_STAYS = 0.35  # seconds that a call stays after its note


class Runs:
    """Which run of a practice film this is and how fast; and the count-in, large in the middle of the picture.

    box : what the label stands in, in its middle; or only its top left corner, (left, top)
    """

    def __init__(
        self, clock: Clock, size: tuple[int, int], box: tuple[float, ...], scale: float, face: Typeface
    ) -> None:
        self.clock, self.size, self.box = clock, size, box
        several = len(clock.passes) > 1 or any(one.rate != 1 for one in clock.passes)
        texts = [self._text(number) for number in range(len(clock.passes))] if several else []
        self.labels = [pill(text, 20 * scale, WHITE, face) for text in texts]
        counts = range(1, max(one.count for one in clock.passes) + 1)
        big = 150 * scale
        self.numbers = {n: face.sprite(str(n), big, WHITE, weight=3 * scale, shadow=5 * scale) for n in counts}

    def _text(self, number: int) -> str:
        one, count = self.clock.passes[number], len(self.clock.passes)
        speed = f"{one.rate:.0%} speed" if one.rate != 1 else "full speed"
        return f"{speed} · {number + 1} of {count}" if count > 1 else speed

    def _place(self, label: Sprite) -> tuple[float, float]:
        if len(self.box) == 2:
            return self.box[0], self.box[1]
        left, top, right, bottom = self.box
        return (left + right - label.shape[1]) / 2, (top + bottom - label.shape[0]) / 2

    def draw(self, frame: Frame, second: float, run: int) -> None:
        """Draw at `second` of the music in pass `run`."""
        if self.labels:
            x, y = self._place(self.labels[run])
            blit(frame, self.labels[run], x, round(y))
        one = self.clock.passes[run]
        if one.count and second < one.sound_from - 1e-6:
            left = (one.sound_from - second) / (one.sound_from - one.start) * one.count
            number = self.numbers[min(one.count, max(1, math.ceil(left - 1e-6)))]
            fade = min(1.0, 0.35 + 0.65 * (left % 1.0 or 1.0))
            x, y = (self.size[0] - number.shape[1]) / 2, (self.size[1] - number.shape[0]) / 2
            blit(frame, number, x, round(y), fade)


class Calls:
    """Moves called out before they come, at the top right of `box`, with the time left as a bar."""

    SHOWN = 2  # at a time, the nearest on top

    def __init__(
        self, callouts: tuple[Callout, ...], box: PixelBox, scale: float, face: Typeface, style: HighwayStyle
    ) -> None:
        self.callouts, self.box, self.scale, self.face, self.style = callouts, box, scale, face, style
        self.seconds = np.array([one.second for one in callouts])
        self._sprite = lru_cache(maxsize=32)(self._pill)

    def _pill(self, text: str, severity: str) -> Sprite:
        size = 24 * self.scale
        text, size = self.face.shrink(text, size, self.box[2] - self.box[0] - 0.8 * size)
        return pill(text, size, self.style.callout[severity], self.face)

    def draw(self, frame: Frame, second: float) -> None:
        """Draw what comes within the next `callout_seconds` after `second`."""
        first = int(np.searchsorted(self.seconds, second - CALL_STAYS))
        y = float(self.box[1])
        for one in self.callouts[first : first + self.SHOWN]:
            left = one.second - second
            if left > self.style.callout_seconds:
                break
            label = self._sprite(one.text, one.severity)
            x = self.box[2] - label.shape[1]
            fade = min(1.0, (self.style.callout_seconds - left) / 0.15, 1.0 + left / CALL_STAYS)
            blit(frame, label, x, round(y), fade)
            y += label.shape[0] + 4 * self.scale
            share = min(1.0, max(0.0, left / self.style.callout_seconds))
            bar = (label.shape[1] - 8 * self.scale) * share
            edge = x + 4 * self.scale
            rectangle(frame, edge, y, edge + bar, y + 4 * self.scale, self.style.callout[one.severity], 0.9 * fade)
            y += 14 * self.scale
