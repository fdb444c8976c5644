"""The words of the documents: none that docs/style.md forbids, and the dancer is introduced before "she" is."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent
PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text("utf-8")
    for path in (*(ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")), *ROOT.glob("docs/*.md"))
}
# Word -> what to write; docs/style.md has the reasons. Code between backticks is not looked at.
FORBIDDEN = {
    r"told|tells?|telling": "report, print, say",
    r"rooms?(?! (for|to|there))|houses?|doors?": "package, module, folder",
    r"bills?": "terms",
    r"for who": "for people who",
    r"whoever": "people who, the one who",
    r"anew": "again",
    r"heeds?|heeded": "use, follow",
    r"shall": "must, will",
    r"(let|lets) go": "not played",
    r"mend\w*": "repair, correct, remove",
    r"dear(?!ly)": "slow, costs much",
    r"no ear|by ear": "inaudible; by sound",
}
MAY_NAME_THEM = {"docs/style.md"}  # lists what not to write


def prose(text: str) -> str:
    """Without code, links' targets and comments."""
    text = re.sub(r"```.*?```|<!--.*?-->|^    .*$", "", text, flags=re.S | re.M)
    return re.sub(r"`[^`\n]*`|\]\([^)]*\)|\"[^\"\n]{1,60}\"", " ", text)


def problems(text: str) -> list[str]:
    return [
        f"'{found[0]}': write {better}"
        for words, better in FORBIDDEN.items()
        for found in re.finditer(rf"\b(?:{words})\b", text, re.I)
    ]


@pytest.mark.parametrize("name", sorted(set(PAGES) - MAY_NAME_THEM))
def test_no_page_has_a_word_that_only_this_project_uses(name: str) -> None:
    assert problems(prose(PAGES[name])) == [], name


@pytest.mark.parametrize("name", sorted(set(PAGES) - MAY_NAME_THEM))
def test_the_dancer_is_introduced_before_she_is_she(name: str) -> None:
    text = prose(PAGES[name])
    she, dancer = re.search(r"\b(she|her|hers)\b", text, re.I), re.search(r"\bdancers?\b", text, re.I)
    assert she is None or (dancer is not None and dancer.start() < she.start()), name


@pytest.mark.parametrize("name", ["films", "sheet", "moves", "findings", "limbs", "panels"])
def test_words_of_films_and_sheets_keep_to_the_list(name: str) -> None:
    english = yaml.safe_load((ROOT / "configs" / "languages" / "en.yaml").read_text("utf-8"))
    for label, words in english["film" if name == "films" else name].items():
        assert problems(words) == [], label


def test_the_list_finds_what_it_is_for() -> None:
    assert len(problems("For who is told of a bill in this room, which no ear hears: it shall be mended anew.")) == 8
    assert problems("There is room for a mat. A dearly held wish; doorway.") == []


def test_the_changelog_has_a_screen_for_each_version() -> None:
    versions = re.split(r"^## ", PAGES["CHANGELOG.md"], flags=re.M)[1:]
    assert len(versions) >= 2
    assert {one.splitlines()[0]: len(one.splitlines()) for one in versions if len(one.splitlines()) > 40} == {}
