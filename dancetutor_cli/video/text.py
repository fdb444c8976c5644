"""Text as sprites, in Pillow's built-in font or a font file of the user's."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from dancetutor_cli.errors import FileError
from dancetutor_cli.video.blit import Sprite

RGB = tuple[int, int, int]
_FOLD = {"–": "-", "—": "-", "～": "~", "〜": "~", "†": "+", "•": "·", "\u00a0": " ", "æ": "ae", "Æ": "AE", "ø": "o",
         "Ø": "O", "ß": "ss", "ð": "d", "þ": "th", "ł": "l", "Ł": "L", "œ": "oe", "Œ": "OE", "×": "x"}  # fmt: skip


@lru_cache(maxsize=64)
def _font(path: str | None, size: float) -> ImageFont.FreeTypeFont:
    if path is None:
        font = ImageFont.load_default(size)
        assert isinstance(font, ImageFont.FreeTypeFont)  # Pillow's own is scalable whenever FreeType is there
        return font
    try:
        return ImageFont.truetype(path, size)
    except OSError as error:
        raise FileError(path, f"cannot be used as a font: {error}") from error


@lru_cache(maxsize=4096)
def _has_glyph(path: str | None, character: str) -> bool:
    font = _font(path, 24)
    missing = font.getmask("\U0010ffff")
    mask = font.getmask(character)
    return mask.size != missing.size or bytes(mask) != bytes(missing)


@dataclass(frozen=True, slots=True)
class Typeface:
    """Draws text as premultiplied sprites. path : a font file, or None for the built-in one."""

    path: Path | None = None

    @property
    def _key(self) -> str | None:
        return None if self.path is None else str(self.path)

    def missing(self, text: str) -> str:
        """The characters of `text` that this font cannot draw, each once."""
        return "".join(dict.fromkeys(c for c in text if not _has_glyph(self._key, c)))

    def drawable(self, text: str) -> str:
        """`text` without control characters; what the font lacks is folded to a base letter, or becomes "?"."""
        out = []
        for c in clean(text):
            if _has_glyph(self._key, c):
                out.append(c)
                continue
            folded = _FOLD.get(c) or "".join(
                d for d in unicodedata.normalize("NFKD", c) if not unicodedata.combining(d)
            )
            out.append(folded if folded and not self.missing(folded) else "?")
        return "".join(out)

    def width(self, text: str, size: float) -> float:
        """Advance width in pixels."""
        return float(_font(self._key, size).getlength(text))

    def fit(self, text: str, size: float, width: float) -> str:
        """`text`, shortened with an ellipsis until it is at most `width` pixels wide."""
        if self.width(text, size) <= width:
            return text
        low, high = 0, len(text)
        while low < high:  # binary search: titles may be 100 kB long
            middle = (low + high + 1) // 2
            if self.width(text[:middle].rstrip() + "…", size) <= width:
                low = middle
            else:
                high = middle - 1
        return text[:low].rstrip() + "…"

    def sprite(
        self, text: str, size: float, colour: RGB, weight: float = 0.0, shadow: float = 0.0, opacity: float = 1.0
    ) -> Sprite:
        """One line of text. The sprite's height depends on `size` alone, so that baselines line up.

        weight : extra stroke in pixels (0 regular, size/25 bold); shadow : width of a dark halo in pixels
        """
        font = _font(self._key, size)
        ascent, descent = font.getmetrics()
        pad = int(np.ceil(weight + shadow)) + 1
        box = (int(np.ceil(font.getlength(text))) + 2 * pad + 2, ascent + descent + 2 * pad)
        ink = _stroke(box, text, font, (pad, pad), weight)
        out = np.zeros((box[1], box[0], 4))
        if shadow > 0:
            halo = _stroke(box, text, font, (pad, pad), weight + shadow)
            out[..., 3] = 0.62 * halo
        out *= 1 - ink[..., None]
        out[..., :3] += ink[..., None] * np.array(colour) / 255
        out[..., 3] += ink
        return np.rint(out * opacity * 255).astype(np.uint8)


def _stroke(
    box: tuple[int, int], text: str, font: ImageFont.FreeTypeFont, at: tuple[int, int], weight: float
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    image = Image.new("L", box, 0)
    ImageDraw.Draw(image).text(at, text, fill=255, font=font, stroke_width=weight)
    return np.asarray(image, dtype=np.float64) / 255


def clean(text: str) -> str:
    """Without control characters and escapes, which metadata of hostile files carries; whitespace runs become one."""
    kept = "".join(c if unicodedata.category(c)[0] != "C" else (" " if c in "\t\r\n" else "") for c in text)
    return " ".join(kept.split())
