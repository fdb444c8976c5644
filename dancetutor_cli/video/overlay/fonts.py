"""Fonts: Pillow's built-in one, a file of the user's, and the system's fonts for letters that neither of them has."""

from __future__ import annotations

import io
import os
import sys
from functools import cache, lru_cache
from importlib.util import find_spec
from pathlib import Path

from PIL import ImageFont

from dancetutor_cli.bounded import FONT_LIMIT, read_bytes
from dancetutor_cli.errors import FileError

# Fonts with many letters that systems bring, by file name, those that look most like the built-in one first, and for
# each script one after the other: Latin, Greek and Cyrillic; Japanese; Korean; Chinese; signs.
_KNOWN = (
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
    """Where this system keeps fonts; also matplotlib's, which many Python environments have."""
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
    """Files of the known fonts that this system has, in the order in which they are tried."""
    rank = {name: place for place, name in reversed(list(enumerate(_KNOWN)))}
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
    """A font, None: the built-in one, in a size in pixels. FileError if the file is no font."""
    if path is None:
        built_in = ImageFont.load_default(size)
        assert isinstance(built_in, ImageFont.FreeTypeFont)  # it is scalable whenever Pillow has FreeType
        return built_in
    data = _content(path)
    try:
        found = ImageFont.truetype(io.BytesIO(data), size)
        found.getmask("Ag 1")  # damage to the letters shows only here
    except (OSError, ValueError, MemoryError) as error:
        raise FileError(path, f"cannot be used as a font: {error}") from error
    return found


@lru_cache(maxsize=16)
def _content(path: str) -> bytes:
    return read_bytes(Path(path), FONT_LIMIT)


@lru_cache(maxsize=65536)
def has_glyph(path: str | None, character: str) -> bool:
    """Whether a font can draw a character: what it cannot draw looks like a character that does not exist."""
    one = font(path, 24)
    try:
        missing, mask = one.getmask("\U0010ffff"), one.getmask(character)
    except (OSError, ValueError):  # a damaged letter is none
        return False
    return mask.size != missing.size or bytes(mask) != bytes(missing)


def has_all(path: str | None, text: str) -> bool:
    """Whether a font can draw all characters of a text."""
    return all(has_glyph(path, c) for c in text)
