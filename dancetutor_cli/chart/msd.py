"""The games' file format (`#TAG:value:value;`): tags with the byte span of every value, and text in its encoding."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

# Each branch begins with a different letter, so that the search for the next token is fast.
_TOKEN = re.compile(rb"//[^\n]*|\\.?|##*|:|;", re.DOTALL)
# limit of values of one tag; games read only the first few, and of further values only the last is kept
_MOST_VALUES = 4096
_COMMENT_OR_ESCAPE = re.compile(rb"//[^\n]*|\\(.?)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Tag:
    """One `#NAME:...;`. name : upper case; spans : byte span of each value; start : offset of the `#`."""

    name: str
    start: int
    spans: tuple[tuple[int, int], ...]


def scan(data: bytes) -> list[Tag]:
    """Return all tags of a file in order. A missing `;` is tolerated as in the games; text between tags is dropped.

    A tag with neither name nor value is dropped too, because a file may have millions of them.
    """
    tags: list[Tag] = []
    params: list[tuple[int, int]] = []
    begin = -1  # offset of the '#' of the open tag, -1 between tags
    start = 0  # offset of the open value
    for match in _TOKEN.finditer(data):
        at = match.start()
        token = data[at]
        if token == 35:  # '#'
            # Several `#` in a row count as their last one.
            if begin < 0:
                begin, start = match.end() - 1, match.end()
            elif _first_on_line(data, start, at):
                _end(tags, data, begin, params, (start, at))
                params, begin, start = [], match.end() - 1, match.end()
        elif begin >= 0 and token in b":;":
            if token == 59:  # ';'
                _end(tags, data, begin, params, (start, at))
                params, begin = [], -1
            elif len(params) < _MOST_VALUES:
                params.append((start, at))
            start = at + 1
    if begin >= 0:
        _end(tags, data, begin, params, (start, len(data)))
    return tags


def _end(tags: list[Tag], data: bytes, begin: int, params: list[tuple[int, int]], last: tuple[int, int]) -> None:
    """Add the tag that ends with the value `last`, unless it is empty."""
    (a, b), *values = (*params, last)
    name = plain(data[a:b]).decode("latin-1").upper()
    if values or name.strip():
        tags.append(Tag(name, begin, tuple(values)))


def _first_on_line(data: bytes, start: int, at: int) -> bool:
    """Whether there are only blanks between the start of the line or value and the `#` at an offset."""
    j = at
    while j > start and data[j - 1] in b" \t":
        j -= 1
    return j == start or data[j - 1] in b"\r\n"


def plain(value: bytes) -> bytes:
    """Return the value as the games read it: `//` comments dropped (their LF stays), `\\` escapes resolved."""
    if b"//" in value or b"\\" in value:
        return _COMMENT_OR_ESCAPE.sub(lambda match: match[1] or b"", value)
    return value


def blanked(value: bytes) -> tuple[bytes, frozenset[int]]:
    """Return the value at its full length, with comments and escaping `\\` as blanks, and the offsets of these `\\`.

    An escaping `\\` is not a character of its row: code that reads single characters must skip these offsets.
    """
    if b"//" not in value and b"\\" not in value:
        return value, frozenset()
    escapes: list[int] = []

    def blank(match: re.Match[bytes]) -> bytes:
        if match[0][:1] == b"/":
            return b" " * len(match[0])
        escapes.append(match.start())
        return b" " + match[1]

    return _COMMENT_OR_ESCAPE.sub(blank, value), frozenset(escapes)


# Text of chart files for people: its encoding, and the removal of characters that harm a terminal.

_HIGH = re.compile(rb"[\x80-\xff]")
_PAIR = re.compile(rb"[\x81-\xfe][\x80-\xff]")
_KANA = re.compile(rb"[\x82\x83][\x40-\xf1]")
_HANGUL = re.compile(rb"[\xb0-\xc8][\xa1-\xfe]")
_ESCAPE = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|\](?:[^\x07\x1b]*(?:\x07|\x1b\\))?|.)?", re.DOTALL)
_DROPPED = frozenset({"Cc", "Cf", "Cs", "Cn", "Co", "Zl", "Zp"})


def encoding_of(data: bytes) -> str:
    """Return the encoding of a file, by Python's name: "ascii", "utf-8", "utf-8-sig", "cp932", "cp949" or "cp1252".

    The old encodings can only be guessed. Asian letters are pairs of high bytes (in Shift-JIS often a high and a low
    byte), while high bytes of Western text are single.
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
    """Whether nearly all of the data is valid in an encoding; a few wrong bytes are tolerated."""
    wrong = data.decode(encoding, errors="replace").count("\ufffd")
    return wrong * 20 <= len(_HIGH.findall(data))


def decode_text(value: bytes, encoding: str) -> str:
    """Return a value as text that is safe to print: invalid bytes become U+FFFD; line breaks and tabs stay."""
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
    """Return the text on one line, for titles and names."""
    return " ".join(text.split())


def quote(text: str) -> str:
    """Return the start of a text on one line for messages; unprintable characters become numbers: "12<0x08>5"."""
    return "".join(c if c.isprintable() else f"<{ord(c):#04x}>" for c in one_line(text)[:60])
