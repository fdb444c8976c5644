"""The games' file format (`#TAG:value:value;`): tags with the byte span of every value, and text in its encoding."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

# Each branch begins with a letter of its own, so that the search for the next one skips the rest quickly.
_TOKEN = re.compile(rb"//[^\n]*|\\.?|##*|:|;", re.DOTALL)
_MOST_VALUES = 4096  # of one tag; games read the first few; of more only the last is kept
_COMMENT_OR_ESCAPE = re.compile(rb"//[^\n]*|\\(.?)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Tag:
    """One `#NAME:...;`. name : upper case; spans : byte span of each value; start : offset of the `#`."""

    name: str
    start: int
    spans: tuple[tuple[int, int], ...]


def scan(data: bytes) -> list[Tag]:
    """All tags of a file in order. A missing `;` is made up for where the games do; text between tags is dropped.

    So is a tag with neither name nor value: a file may hold millions of them.
    """
    tags: list[Tag] = []
    params: list[tuple[int, int]] = []
    begin = -1  # offset of the '#' of the open tag, -1 between tags
    start = 0  # where the open value starts
    for match in _TOKEN.finditer(data):
        at = match.start()
        token = data[at]
        if token == 35:  # '#'
            # Of several in a row each ends the tag of the one before, which has no name; where none counts, none does.
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
    """Add the tag that ends with the value `last`, if there is anything in it."""
    (a, b), *values = (*params, last)
    name = plain(data[a:b]).decode("latin-1").upper()
    if values or name.strip():
        tags.append(Tag(name, begin, tuple(values)))


def _first_on_line(data: bytes, start: int, at: int) -> bool:
    """Whether only blanks stand between the `#` at an offset and the start of its line or of the open value."""
    j = at
    while j > start and data[j - 1] in b" \t":
        j -= 1
    return j == start or data[j - 1] in b"\r\n"


def plain(value: bytes) -> bytes:
    """The value as the games see it: `//` comments dropped (their LF stays), `\\` escapes resolved."""
    if b"//" in value or b"\\" in value:
        return _COMMENT_OR_ESCAPE.sub(lambda match: match[1] or b"", value)
    return value


def blanked(value: bytes) -> tuple[bytes, frozenset[int]]:
    """The value at its length: comments and escaping `\\` as blanks; and the offsets of those `\\`.

    A `\\` is no character of its row: anyone who looks at single characters must leave out these offsets.
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


# Text of chart files for people: which encoding it is in, and no character that harms a terminal.

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


def quote(text: str) -> str:
    """The start of a text on one line, safe to print, for messages; what cannot be seen by its number: "12<0x08>5"."""
    return "".join(c if c.isprintable() else f"<{ord(c):#04x}>" for c in one_line(text)[:60])
