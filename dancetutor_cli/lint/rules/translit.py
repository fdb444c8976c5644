"""DT513: a title in another script without one in Latin letters."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


_SCRIPTS = ("CJK", "HIRAGANA", "KATAKANA", "HANGUL", "CYRILLIC", "ARABIC", "HEBREW", "THAI", "DEVANAGARI", "GREEK")
_LEAST = {"GREEK": 3}  # letters of a word: single ones stand for something else


class Translit(FileRule):
    """Title, subtitle or artist is in another script than the Latin one, and nothing says how it is read.

    Players who cannot read it search in vain, and some fonts of the games do not have its letters.

    Bad: #TITLE:\u65e5\u672c; without #TITLETRANSLIT. Better: #TITLETRANSLIT:Nihon;
    """

    code = "DT513"
    name = "translit"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each tag."""
        for tag in ("TITLE", "SUBTITLE", "ARTIST"):
            value = subject.song.tags.get(tag, "")
            if _is_other_script(value) and not subject.song.tags.get(f"{tag}TRANSLIT", "").strip():
                yield self.finding(f"#{tag} is in another script, and #{tag}TRANSLIT is empty", subject.tag_place(tag))


def _is_other_script(text: str) -> bool:
    import unicodedata

    if text.isascii():
        return False
    scripts = [unicodedata.name(letter, "").split(" ")[0].split("-")[0] for letter in text if letter.isalpha()]
    return any(scripts.count(script) >= _LEAST.get(script, 1) for script in _SCRIPTS)
