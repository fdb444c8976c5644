"""The texts of films, practice pages and sheets, with one file in configs/languages for each language."""

from __future__ import annotations

import re
from dataclasses import dataclass, fields
from functools import cache
from typing import TYPE_CHECKING

from dancetutor_cli.run.reading import named_file

if TYPE_CHECKING:
    from dancetutor_cli.run.schema import MarkedYaml

ENGLISH = "en"  # the language that has all labels; a label that another language does not have is English
_PLACE = re.compile(r"\{(\w+)\}")


@dataclass(frozen=True, slots=True)
class Language:
    """configs/languages/*.yaml: label -> words, in which {places} are filled in.

    language : the language's own name
    limbs, panels : names of limbs and panels; "left-foot-short" is used if there is no room for "left-foot"
    moves : the names of moves in films and subtitles, with {who} and {places}
    calls : other texts of a film's callouts: the foot, where it crosses, and why; labels with "-tag" are shown beside
    the notes
    findings : code of a rule -> its name, ": ", and what it means
    film, sheet, page : the other texts of these outputs
    """

    language: str
    limbs: dict[str, str]
    panels: dict[str, str]
    moves: dict[str, str]
    calls: dict[str, str]
    findings: dict[str, str]
    film: dict[str, str]
    sheet: dict[str, str]
    page: dict[str, str]

    def finding_name(self, rule: str, otherwise: str) -> str:
        """Return the name of a rule's findings; `otherwise` for a rule that the file does not have."""
        return self.findings.get(rule, otherwise).partition(": ")[0]

    def film_texts(self) -> list[str]:
        """Return all texts that a film may draw."""
        names = [self.finding_name(rule, "") for rule in self.findings]
        parts = (self.limbs, self.panels, self.moves, self.calls, self.film)
        return [*names, *(text for part in parts for text in part.values())]


@cache
def load_language(name: str = ENGLISH) -> Language:
    """Load the texts of a language. Raises UsageError for an unknown name, and FileError if the file is wrong."""
    from dancetutor_cli.run.schema import convert
    from dancetutor_cli.run.yaml_files import read

    source = read(named_file("languages", name))
    if name == ENGLISH:
        return convert(source, Language)
    english = load_language()
    found = convert(source, Language, (), english)
    for field in fields(Language):
        words = getattr(found, field.name)
        if isinstance(words, dict):
            _check(source, field.name, words, getattr(english, field.name))
    return found


def _check(source: MarkedYaml, section: str, words: dict[str, str], english: dict[str, str]) -> None:
    """Raise FileError if a label is not in English, or if its text has other {places} than the English text."""
    if section in source.data:
        source.check_names((section,), words, english)
    for label, text in words.items():
        wanted, there = (sorted(set(_PLACE.findall(one))) for one in (english[label], text))
        if wanted != there:
            must = " ".join(f"{{{place}}}" for place in wanted) or "no {places}"
            raise source.error((section, label), f"{section}.{label} must have {must}, like the English text")
