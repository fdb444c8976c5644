"""Words that come and go: the run of a practice film, the count-in, and the calls of moves."""

from __future__ import annotations

import math
import re
from functools import lru_cache
from operator import itemgetter

import numpy as np

from dancetutor_cli.feet.limbs import LABELS, limb_colours
from dancetutor_cli.film.clock import Clock
from dancetutor_cli.film.layout import PixelBox
from dancetutor_cli.film.notes import Callout
from dancetutor_cli.film.overlay.blit import Box, Sprite, draw_rectangle, draw_sprite
from dancetutor_cli.film.overlay.sprites import FLAG_EDGE, SOFT, WHITE, WordStyle, box_of, flag, flag_height
from dancetutor_cli.film.overlay.text import Typeface, fit_text, wrap_words
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.run.languages import Language
from dancetutor_cli.run.schema import RGB

CALL_LEAST = 0.75  # smallest size of a call's letters before words are left out
REASON_LEAST = 0.55  # smallest size of the letters of a call with reasons
CALL_SMALL = 0.5  # smallest size of the letters before a call takes more than two lines
SHARES = np.arange(1.0, CALL_LEAST - 0.01, -0.05)  # sizes of letters that are tried
# Seconds that a call stays after its note; seconds in which it fades, short enough to leave no ghost.
CALL_STAYS, CALL_FADES = 0.2, 0.06


class Runs:
    """The labels of the runs of a practice film, with number and speed, and the numbers of the count-in.

    box : the box in whose middle the label stands, or the top left corner of the label, (left, top)
    count : the box of the count-in's numbers
    """

    def __init__(self, clock: Clock, box: tuple[float, ...], count: PixelBox, scale: float, style: WordStyle) -> None:
        self.clock, self.box, self.count = clock, box, count
        face, self._words = style.face, style.language.film
        several = len(clock.passes) > 1 or any(one.rate != 1 for one in clock.passes)
        texts = [self._text(number) for number in range(len(clock.passes))] if several else []
        self.labels = [flag([text], 19 * scale, SOFT, face) for text in texts]
        counts = range(1, max(one.count for one in clock.passes) + 1)
        room, small = count[3] - count[1], min(20 * scale, 0.2 * (count[3] - count[1]))
        (label,), small = fit_text(self._words["count-in"], small, 0.9 * (count[2] - count[0]), face, most=1)
        self.counted = face.sprite(label, small, SOFT, weight=small / 80, shadow=small / 14)
        big = min(150 * scale, 0.8 * (room - self.counted.shape[0]))
        self.numbers = {n: face.sprite(str(n), big, WHITE, weight=big / 50, shadow=big / 30) for n in counts}

    def _text(self, number: int) -> str:
        one, count = self.clock.passes[number], len(self.clock.passes)
        speed = self._words["speed"].replace("{percent}", f"{100 * one.rate:.0f}")
        speed = speed if one.rate != 1 else self._words["full-speed"]
        run = self._words["run"].replace("{number}", str(number + 1)).replace("{count}", str(count))
        return f"{speed} · {run}" if count > 1 else speed

    def _corner(self, label: Sprite) -> tuple[float, float]:
        return (self.box[0], self.box[1]) if len(self.box) == 2 else _middle(label, self.box)

    @property
    def boxes(self) -> list[Box]:
        """The boxes of the labels: left, top, right, bottom."""
        return [box_of(label, *self._corner(label)) for label in self.labels]

    def draw(self, frame: Frame, second: float, pass_number: int, opacity: float = 1.0) -> None:
        """Draw the label and the count-in at `second` of the music in a pass; opacity : opacity of the label."""
        if self.labels:
            label = self.labels[pass_number]
            x, y = self._corner(label)
            draw_sprite(frame, label, x, round(y), opacity)
        one = self.clock.passes[pass_number]
        if one.count and second < one.sound_from - 1e-6:
            left = (one.sound_from - second) / (one.sound_from - one.start) * one.count
            number = self.numbers[min(one.count, max(1, math.ceil(left - 1e-6)))]
            x, y = _middle(number, self.count)
            above = self.counted.shape[0]
            draw_sprite(frame, number, x, round(y + above / 2))
            draw_sprite(frame, self.counted, _middle(self.counted, self.count)[0], round(y - above / 2))


def _middle(sprite: Sprite, box: tuple[float, ...]) -> tuple[float, float]:
    left, top, right, bottom = box
    return (left + right - sprite.shape[1]) / 2, (top + bottom - sprite.shape[0]) / 2


def _phrases(
    text: str, size: float, room: tuple[float, float], face: Typeface, language: Language, short: str = ""
) -> tuple[list[str], float]:
    """Return the lines of a call and the size of their letters, without cutting words off.

    There are one or two lines, or more if the letters would be too small.

    room : greatest width and height of the words, pixels
    short : the text without the limb, for a place in which even "right: " does not fit in two lines
    """
    width, height = room
    named = text
    for limb in LABELS:
        named = named.replace(f"{language.limbs[limb]}:", f"{language.limbs[f'{limb}-short']}:")
    tries = [(text, CALL_LEAST), (named, CALL_LEAST), (text, CALL_SMALL)]
    if short and text.endswith(short):
        tries += [(named, CALL_SMALL), (short, CALL_LEAST), (short, CALL_SMALL)]
    for label, least in tries:
        lines, fits = _few_lines(label, size, width, face)
        if fits >= least * size:
            return lines, fits
    for ends in (",", ",:"):
        for share in SHARES:
            lines = wrap_words(_parts(text, ends), share * size, width, face)
            low = len(lines) == 1 or flag_height(len(lines), share * size) <= height
            if low and max(face.width(line, share * size) for line in lines) <= width:
                return lines, float(share * size)
    return fit_text(text, size, width, face, 3)


def _few_lines(text: str, size: float, width: float, face: Typeface, most: int = 2) -> tuple[list[str], float]:
    """Return a text in at most `most` lines, and the size of the letters that fits.

    A line ends at a comma if possible, otherwise at a colon, otherwise anywhere.
    """
    for ends in (",;", ",;:"):
        for share in SHARES:
            lines = wrap_words(_parts(text, ends), share * size, width, face)
            if len(lines) <= most and max(face.width(line, share * size) for line in lines) <= width:
                return lines, float(share * size)
    return fit_text(text, size, width, face, most)


def _parts(text: str, ends: str) -> list[str]:
    return re.sub(f"([{ends}]) ", r"\1\n", text).split("\n")


def _foot_colour(text: str, language: Language) -> RGB | None:
    """Return the colour of the foot that a call names; None if it names both feet or no foot."""
    named = [foot for foot in range(2) if language.limbs[LABELS[foot]] in text]
    return limb_colours().by_limb[named[0]] if len(named) == 1 else None


def _remaining_share(call: Callout, second: float) -> float:
    """Return the remaining share of the time to the next move of a passage, 1 to 0; 0 from the last move on."""
    begin = call.called_from
    for move in (call.second, *(move for move, *_ in call.further)):
        if second < move:
            return min(1.0, (move - second) / max(move - begin, 1e-9))
        begin = move
    return 0.0


class Calls:
    """The calls of passages before they begin, at the top right of `box`, with a bar for the remaining time.

    The words stand until the passage is over. The count of its moves stands beside them all the time.
    """

    MAX_LINES = 2  # calls at a time, the nearest on top

    def __init__(
        self,
        callouts: tuple[Callout, ...],
        box: PixelBox,
        scale: float,
        style: WordStyle,
    ) -> None:
        self.callouts, self.box, self.scale = callouts, box, scale
        self.face, self.style, self._language = style
        self._begins = np.array([one.called_from for one in callouts])
        self._ends = np.array([max(one.end, one.second) + CALL_STAYS for one in callouts])
        self._sprite = lru_cache(maxsize=32)(self._plate)

    def _plate(self, text: str, severity: str, tag: str = "", with_reasons: str = "") -> Sprite:
        """Draw the plate of a call, with its reasons if up to five lines of readable letters have room for them."""
        size = 24 * self.scale
        width, height = self.box[2] - self.box[0] - (FLAG_EDGE + 0.1) * size, self.box[3] - self.box[1]
        lines, fits = _phrases(text, size, (width, height), self.face, self._language, tag)
        if with_reasons:
            tries = (_few_lines(with_reasons, size, width, self.face, most) for most in (2, 3, 4, 5))
            low = [(longer, smaller) for longer, smaller in tries if flag_height(len(longer), smaller) <= height]
            longer, smaller = max(low, key=itemgetter(1), default=(lines, 0.0))
            if smaller >= min(REASON_LEAST * size, fits):
                lines, fits = longer, smaller
        return flag(lines, fits, self.style.callout[severity], self.face, _foot_colour(text, self._language))

    def _current_calls(self, second: float) -> list[Callout]:
        shown = np.flatnonzero((self._begins <= second) & (second < self._ends))
        return [self.callouts[k] for k in shown[: self.MAX_LINES]]

    def draw(self, frame: Frame, second: float) -> None:
        """Draw the calls of the present passage at `second` and of the next passage."""
        y = float(self.box[1])
        for one in self._current_calls(second):
            label = self._sprite(one.text, one.severity, one.tag, one.with_reasons)
            if y > self.box[1] and y + label.shape[0] > self.box[3]:
                break  # the call would cover the words below the box; the tag beside the notes has the same words
            x = self.box[2] - label.shape[1]
            over = max(one.end, one.second) + CALL_STAYS
            fade = min(1.0, (second - one.called_from) / 0.12, (over - second) / CALL_FADES)
            draw_sprite(frame, label, x, round(y), fade)
            y += label.shape[0] + 4 * self.scale
            share = _remaining_share(one, second)
            bar = (label.shape[1] - 8 * self.scale) * share
            edge = x + 4 * self.scale
            line = (edge, y, edge + bar, y + 4 * self.scale)
            draw_rectangle(frame, line, self.style.callout[one.severity], 0.9 * fade)
            y += 14 * self.scale
