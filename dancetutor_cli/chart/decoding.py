"""Text of chart files for people: which encoding it is in, and no character that harms a terminal."""

from __future__ import annotations

import re
import unicodedata

_HIGH = re.compile(rb"[\x80-\xff]")
_PAIR = re.compile(rb"[\x81-\xfe][\x80-\xff]")
_KANA = re.compile(rb"[\x82\x83][\x40-\xf1]")
_HANGUL = re.compile(rb"[\xb0-\xc8][\xa1-\xfe]")
_ESCAPE = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|\](?:[^\x07\x1b]*(?:\x07|\x1b\\))?|.)?", re.DOTALL)
_DROPPED = frozenset({"Cc", "Cf", "Cs", "Cn", "Co", "Zl", "Zp"})


def encoding_of(data: bytes) -> str:
    """The encoding of a file, by Python's name: "ascii", "utf-8", "utf-8-sig", "cp932", "cp949" or "cp1252".

    The old encodings can only be guessed: Asian letters are pairs of high bytes (of Shift-JIS often a high and a low
    one), high bytes of Western text stand alone.
    """
    if data.isascii():
        return "ascii"
    try:
        data.decode("utf-8")
        return "utf-8-sig" if data.startswith(b"\xef\xbb\xbf") else "utf-8"
    except UnicodeDecodeError:
        pass
    high = len(_HIGH.findall(data))
    paired = 2 * len(_PAIR.findall(data))
    korean = 2 * len(_HANGUL.findall(data))
    if 2 * korean > high and _fits(data, "cp949"):
        return "cp949"
    if (2 * paired > high or 2 * len(_KANA.findall(data)) > high) and _fits(data, "cp932"):
        return "cp932"
    return "cp1252"


def _fits(data: bytes, encoding: str) -> bool:
    """Whether nearly all of the data is valid: one wrong byte does not make Japanese Western."""
    wrong = data.decode(encoding, errors="replace").count("\ufffd")
    return wrong * 20 <= len(_HIGH.findall(data))


def decode(value: bytes, encoding: str) -> str:
    """A value as text, safe to print: bytes that do not fit become U+FFFD, line ends and tabs stay."""
    text = value.decode("utf-8" if encoding == "utf-8-sig" else encoding, errors="replace")
    if _is_plain(text):
        return text
    text = _ESCAPE.sub("", text)
    if _is_plain(text):
        return text
    return "".join(c for c in text if c in "\r\n\t" or unicodedata.category(c) not in _DROPPED)


def _is_plain(text: str) -> bool:
    return text.isprintable() or text.replace("\n", "").replace("\r", "").replace("\t", "").isprintable()


def one_line(text: str) -> str:
    """The text on one line, for titles and names."""
    return " ".join(text.split())


def shown(text: str) -> str:
    """The start of a text on one line, safe to print, for messages; what cannot be seen by its number: "12<0x08>5"."""
    return "".join(c if c.isprintable() else f"<{ord(c):#04x}>" for c in one_line(text)[:60])
