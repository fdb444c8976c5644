"""Text as sprites, in the built-in font or a file of the user's; missing letters come from the system's fonts."""

from __future__ import annotations

import io
import os
import sys
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib.util import find_spec
from itertools import groupby
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from dancetutor_cli.film.overlay.blit import Sprite
from dancetutor_cli.run.errors import FileError, UnavailableError
from dancetutor_cli.run.languages import ENGLISH, load_language
from dancetutor_cli.run.reading import FONT_LIMIT, read_bytes

# Fonts: Pillow's built-in font, a file of the user's, and the system's fonts for letters that neither of them has.

# File names of systems' fonts with many letters, by script: Latin, Greek and Cyrillic; Japanese; Korean; Chinese;
# signs. For each script, the fonts that look most like the built-in font come first.
_SYSTEM_FONTS = (
    "segoeui.ttf", "NotoSans-Regular.ttf", "HelveticaNeue.ttc", "LiberationSans-Regular.ttf", "DejaVuSans.ttf",
    "arial.ttf", "Arial.ttf",
    "NotoSansCJK-Regular.ttc", "NotoSansCJKjp-Regular.otf", "NotoSansJP-Regular.ttf", "NotoSansJP-Regular.otf",
    "YuGothM.ttc", "meiryo.ttc", "msgothic.ttc", "ヒラギノ角ゴシック W3.ttc", "Hiragino Sans W3.ttc", "ipaexg.ttf",
    "ipagp.ttf", "ipag.ttf", "fonts-japanese-gothic.ttf", "VL-PGothic-Regular.ttf", "TakaoPGothic.ttf",
    "malgun.ttf", "AppleSDGothicNeo.ttc", "NanumGothic.ttf",
    "msyh.ttc", "PingFang.ttc", "Hiragino Sans GB.ttc", "simsun.ttc", "wqy-microhei.ttc", "wqy-zenhei.ttc",
    "DroidSansFallbackFull.ttf", "DroidSansFallback.ttf",
    "seguisym.ttf", "Symbola.ttf", "Symbola_hint.ttf", "NotoSansSymbols2-Regular.ttf", "Arial Unicode.ttf",
    "unifont.ttf", "unifont.otf",
)  # fmt: skip


def _folders() -> list[Path]:
    """Return the folders in which this system keeps fonts, and matplotlib's, which many Python environments have."""
    home = Path.home()
    if sys.platform == "win32":
        found = [Path(os.environ.get("WINDIR", r"C:\Windows")) / "Fonts"]
        found.append(home / "AppData" / "Local" / "Microsoft" / "Windows" / "Fonts")
    elif sys.platform == "darwin":
        found = [Path("/System/Library/Fonts"), Path("/Library/Fonts"), home / "Library" / "Fonts"]
    else:
        found = [Path("/usr/share/fonts"), Path("/usr/local/share/fonts"), home / ".local" / "share" / "fonts"]
        found.append(home / ".fonts")
    plots = find_spec("matplotlib")
    if plots is not None and plots.origin is not None:
        found.append(Path(plots.origin).parent / "mpl-data" / "fonts" / "ttf")
    return found


@cache
def system_fonts() -> tuple[str, ...]:
    """Return the files of the known fonts that this system has, in the order in which they are tried."""
    rank = {name: place for place, name in reversed(list(enumerate(_SYSTEM_FONTS)))}
    found: dict[int, str] = {}
    for folder in _folders():
        for where, below, names in os.walk(folder):
            below.sort()
            for name in sorted(names):
                if name in rank:
                    found.setdefault(rank[name], str(Path(where) / name))
    return tuple(found[place] for place in sorted(found))


@lru_cache(maxsize=128)
def font(path: str | None, size: float) -> ImageFont.FreeTypeFont:
    """Load a font, None for the built-in one; size : pixels. FileError if the file is not a font."""
    if path is None:
        built_in = ImageFont.load_default(size)
        assert isinstance(built_in, ImageFont.FreeTypeFont)  # it is scalable whenever Pillow has FreeType
        return built_in
    data = _content(path)
    try:
        found = ImageFont.truetype(io.BytesIO(data), size)
        found.getmask("Ag 1")  # detects damaged letters
    except (OSError, ValueError, MemoryError) as error:
        raise FileError(path, "is not a font file that can be read; give a .ttf or .otf file") from error
    return found


@lru_cache(maxsize=16)
def _content(path: str) -> bytes:
    return read_bytes(Path(path), FONT_LIMIT)


@lru_cache(maxsize=65536)
def has_glyph(path: str | None, character: str) -> bool:
    """Whether a font can draw a character: a missing character looks like a character that does not exist."""
    one = font(path, 24)
    try:
        missing, mask = one.getmask("\U0010ffff"), one.getmask(character)
    except (OSError, ValueError):  # a damaged letter counts as missing
        return False
    return mask.size != missing.size or bytes(mask) != bytes(missing)


def has_all(path: str | None, text: str) -> bool:
    """Whether a font can draw all characters of a text."""
    return all(has_glyph(path, c) for c in text)


# Text as sprites.

RGB = tuple[int, int, int]
FINE = 4  # text is drawn larger by this factor and made smaller, so that letters can stand between pixels
LEAST = 4.0  # size of letters, pixels, at which hostile words stop to shrink; nobody can read them
_NOT_FIRST = frozenset("、。，．・：；？！ー～〜）］｝」』】〉》ぁぃぅぇぉっゃゅょァィゥェォッャュョ)]}!?,.:;…々")
_NOT_LAST = frozenset("（［｛「『【〈《([{")
EVEN = 4  # maximum number of lines that are made equally long
LONGEST = 1000  # characters of one line that are read: titles may be 100 kB long
_FOLD = {"–": "-", "—": "-", "～": "~", "〜": "~", "†": "+", "•": "·", "\u00a0": " ", "æ": "ae", "Æ": "AE", "ø": "o",
         "Ø": "O", "ß": "ss", "ð": "d", "þ": "th", "ł": "l", "Ł": "L", "œ": "oe", "Œ": "OE", "×": "x"}  # fmt: skip


_PACKAGES = {"ja": "fonts-noto-cjk", "ko": "fonts-noto-cjk"}  # Debian packages with fonts for a language; else _PACKAGE
_PACKAGE = "fonts-dejavu-core"


@lru_cache(maxsize=4096)
def _font_of(main: str | None, character: str) -> str | None:
    """Return the first font that has a character, or the main font if none has it."""
    for path in (main, None, *system_fonts()):
        if has_glyph(path, character):
            return path
    return main


def _can(main: str | None, character: str) -> bool:
    return has_glyph(main, character) or has_glyph(_font_of(main, character), character)


@lru_cache(maxsize=1024)
def _runs(main: str | None, text: str) -> tuple[tuple[str | None, str], ...]:
    """Cut a text into (font, part), with one font for all letters if a font has them: a mixture of fonts is ugly.

    Signs may come from another font: "crossover ×4" entirely in another font was uglier.
    """
    if has_all(main, text):
        return ((main, text),)
    if not all(has_glyph(main, c) for c in text if c.isalpha()):
        for path in (None, *system_fonts()):
            if has_all(path, text):
                return ((path, text),)
    parts = groupby(text, lambda c: _font_of(main, c))
    return tuple((path, "".join(part)) for path, part in parts)


@dataclass(frozen=True, slots=True)
class Typeface:
    """A typeface that draws text as premultiplied sprites. path : a font file, or None for the built-in font"""

    path: Path | None = None

    @property
    def _key(self) -> str | None:
        return None if self.path is None else str(self.path)

    def missing(self, text: str) -> str:
        """Return the characters of `text` that neither this font nor the system's fonts can draw, each once."""
        return "".join(c for c in dict.fromkeys(text) if not _can(self._key, c))

    def drawable(self, text: str) -> str:
        """Return `text` without control characters; a character without a font becomes its base letter or "?"."""
        return "".join(self._drawable(clean(text)))

    def _drawable(self, text: str) -> Iterator[str]:
        for c in text:
            if _can(self._key, c):
                yield c
                continue
            plain = "".join(d for d in unicodedata.normalize("NFKD", c) if not unicodedata.combining(d))
            folded = _FOLD.get(c) or plain
            yield folded if folded and not self.missing(folded) else "?"

    def width(self, text: str, size: float) -> float:
        """Return the advance width of a text in pixels."""
        return sum(float(font(path, FINE * size).getlength(part)) for path, part in _runs(self._key, text)) / FINE

    def fit(self, text: str, size: float, width: float) -> str:
        """Return `text`, shortened with an ellipsis to at most `width` pixels, at the end of a word if one is near."""
        if len(text) <= LONGEST and self.width(text, size) <= width:
            return text
        low, high = 0, min(len(text), LONGEST)
        while low < high:
            middle = (low + high + 1) // 2
            if self.width(text[:middle].rstrip() + "…", size) <= width:
                low = middle
            else:
                high = middle - 1
        kept = text[:low]
        words = kept if text[low : low + 1].isspace() else kept[: max(0, kept.rfind(" "))]
        kept = words if len(words) > 0.5 * low else kept
        return kept.rstrip(" ,;:-~/·&([") + "…"

    def shrink(self, text: str, size: float, width: float) -> tuple[str, float]:
        """Return a text and a size that make it at most `width` wide: smaller, down to four fifths, then shortened."""
        low = 0.8 * size
        while size > low and self.width(text[:LONGEST], size) > width:
            size = max(low, 0.98 * size)
        return self.fit(text, size, width), size

    def sprite(self, text: str, size: float, colour: RGB, weight: float = 0.0, shadow: float = 0.0) -> Sprite:
        """Draw one line of text. The sprite's height depends on `size` alone, so that baselines line up.

        weight : extra stroke in pixels (0 regular, size/25 bold); shadow : width of a dark halo in pixels
        """
        ascent, descent = (part / FINE for part in font(self._key, FINE * size).getmetrics())
        pad = int(np.ceil(weight + shadow)) + 1
        box = (int(np.ceil(self.width(text, size))) + 2 * pad + 2, int(np.ceil(ascent + descent)) + 2 * pad)
        ink = self._ink(text, size, box, (pad, pad + ascent), weight)
        out = np.zeros((box[1], box[0], 4))
        if shadow > 0:
            out[..., 3] = 0.62 * self._ink(text, size, box, (pad, pad + ascent), weight + shadow)
        out *= 1 - ink[..., None]
        out[..., :3] += ink[..., None] * np.array(colour) / 255
        out[..., 3] += ink
        return np.rint(out * 255).astype(np.uint8)

    def _ink(
        self, text: str, size: float, box: tuple[int, int], at: tuple[float, float], weight: float
    ) -> NDArray[np.float64]:
        """Return the covered share of each pixel of `box` (width, height); at : start of the baseline, pixels."""
        image = Image.new("L", (FINE * box[0], FINE * box[1]), 0)
        draw = ImageDraw.Draw(image)
        x, y = FINE * at[0], round(FINE * at[1])
        for path, part in _runs(self._key, text):
            one = font(path, FINE * size)
            draw.text((x, y), part, fill=255, font=one, anchor="ls", stroke_width=FINE * weight)
            x += float(one.getlength(part))
        fine = np.asarray(image, dtype=np.float64).reshape(box[1], FINE, box[0], FINE)
        return np.asarray(fine.mean(axis=(1, 3)) / 255)


def check_letters(name: str, path: Path | None) -> None:
    """Raise UnavailableError if a letter of a language has no font. path : a font file, None for the built-in font"""
    if name == ENGLISH:
        return
    language = load_language(name)
    if missing := Typeface(path).missing("".join(sorted(set("".join(language.film_texts()))))):
        raise UnavailableError(
            f"no font here has all letters of --language {name} ({language.language}), for example {missing[:3]!r}; "
            f"install one, on Debian {_PACKAGES.get(name, _PACKAGE)}, or give it with --font FILE"
        )


def clean(text: str) -> str:
    """Remove control characters and escapes, which hostile metadata has; each run of whitespace becomes one blank."""
    kept = "".join(c if unicodedata.category(c)[0] != "C" else (" " if c in "\t\r\n" else "") for c in text)
    return " ".join(kept.split())


def wrap_words(words: list[str], size: float, width: float, face: Typeface) -> list[str]:
    """Lay words in lines of at most `width` pixels; a wider word has a line of its own."""
    return _laid([words[0], *(f" {word}" for word in words[1:])], size, width, face)


def _laid(parts: list[str], size: float, width: float, face: Typeface, most: int = LONGEST) -> list[str]:
    """Lay parts of a text, with the blanks before them, in lines of at most `width` pixels if no part is wider.

    most : number of lines after which the rest is left out
    """
    lines: list[str] = []
    first = 0
    while first < len(parts):
        low, high = first + 1, len(parts)  # bisection, because an unknown title may have 500 words
        while low < high:
            middle = (low + high + 1) // 2
            if face.width("".join(parts[first:middle]).lstrip(), size) <= width:
                low = middle
            else:
                high = middle - 1
        lines.append("".join(parts[first:low]).lstrip())
        first = low
        if len(lines) == most:
            break
    return lines


def parts_of(text: str) -> list[str]:
    """Cut a text into the parts between which a line may end, each with the blank before it; "" is one part.

    A line may end between words, and between two letters of scripts without blanks, but not before a closing sign.
    """
    parts: list[str] = []
    for word in text[:LONGEST].split():
        blank = " " if parts else ""
        for k, letter in enumerate(word):
            wide = unicodedata.east_asian_width(letter) in "WF"
            joined = k > 0 and (not (wide or _wide_before(word, k)) or letter in _NOT_FIRST or word[k - 1] in _NOT_LAST)
            if joined:
                parts[-1] += letter
            else:
                parts.append(blank + letter if k == 0 else letter)
    return parts or [""]


def _wide_before(word: str, k: int) -> bool:
    return unicodedata.east_asian_width(word[k - 1]) in "WF"


def lay_in_lines(text: str, size: float, width: float, face: Typeface, most: int) -> list[str]:
    """Lay a text in at most `most` lines of at most `width` pixels; an ellipsis ends the last line of a longer text."""
    lines = _laid(parts_of(text), size, width, face, most + 1)
    if len(lines) > most:
        rest = _after(text, lines[: most - 1])
        lines = [*lines[: most - 1], rest]
    return [face.fit(line, size, width) for line in lines]


def _after(text: str, lines: list[str]) -> str:
    """Return the part of a text after its first lines."""
    rest = " ".join(text[:LONGEST].split())
    for line in lines:
        rest = rest[len(line) :].lstrip()
    return rest


def fit_text(text: str, size: float, width: float, face: Typeface, most: int = 4) -> tuple[list[str], float]:
    """Return a text in at most `most` lines of at most `width` pixels, and the size that makes it fit without a cut.

    The text is wrapped before it is made smaller, and its lines are about equally long.
    """
    parts = parts_of(text)
    while True:
        lines = _laid(parts, size, width, face, most + 1)
        if size <= LEAST or (len(lines) <= most and max(face.width(line, size) for line in lines) <= width):
            return _even(parts, lines, (size, width), face), size
        size = max(LEAST, 0.96 * size)


def narrowest_width(text: str, size: float, face: Typeface, most: int) -> float:
    """Return the width, pixels, that a text needs at this size in at most `most` lines."""
    parts = parts_of(text)
    width = max(face.width(part.lstrip(), size) for part in parts)
    while len(_laid(parts, size, width, face, most + 1)) > most:
        width *= 1.04
    return width


def _even(parts: list[str], lines: list[str], room: tuple[float, float], face: Typeface) -> list[str]:
    """Return the same number of lines, the longest as short as possible, to avoid a last line of one word.

    room : size and width, pixels
    """
    if not 1 < len(lines) <= EVEN:
        return lines
    (size, width), count = room, len(lines)
    for share in np.arange(0.95, 1 / count, -0.05):
        other = _laid(parts, size, float(share) * width, face, count + 1)
        if len(other) > count or max(face.width(line, size) for line in other) > share * width:
            break
        lines = other
    return lines
