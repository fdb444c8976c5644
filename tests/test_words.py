"""The words of documents, help, messages and code: none that docs/style.md forbids; no "she" without a dancer."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
import yaml

from dancetutor_cli.commands import COMMANDS, cli
from dancetutor_cli.lint.rule import all_rules

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
# What documents avoid besides: with FORBIDDEN, the second column of docs/style.md.
IN_DOCS = FORBIDDEN | {
    r"double steps?|double-tap\w*": "doublestep",
    r"work(s|ed|ing)? out": "find, compute",
    r"tak(e|es|en|ing) out|took out": "remove",
    r"the price of|dearer": "cost; costlier",
    r"no (limb|foot|hand) (is )?left": "no limb is free",
    r"wish(es)?": "pinned feet",
    r"who dances?": "dancers who",
    r"somebody else": "another user",
    r"by turns": "in turn",
    r"for (it|they|he|she) (is|are|has|have|goes|can|must)": "because",
    r"is no number": "is not a number",
    r"word of warning": "warning",
}
MAY_NAME_THEM = {"docs/style.md"}  # lists what not to write
LONG, LONG_SHARE = 25, 0.05  # words of a long sentence; share of a page's sentences that may be long


def prose(text: str) -> str:
    """Without code, links' targets and comments."""
    text = re.sub(r"```.*?```|<!--.*?-->|^    .*$", "", text, flags=re.S | re.M)
    return re.sub(r"`[^`\n]*`|\]\([^)]*\)|\"[^\"\n]{1,60}\"", " ", text)


def problems(text: str, listed: dict[str, str] = FORBIDDEN) -> list[str]:
    return [
        f"'{found[0]}': write {better}"
        for words, better in listed.items()
        for found in re.finditer(rf"\b(?:{words})\b", text, re.I)
    ]


@pytest.mark.parametrize("name", sorted(set(PAGES) - MAY_NAME_THEM))
def test_no_page_has_a_word_that_only_this_project_uses(name: str) -> None:
    assert problems(prose(PAGES[name]), IN_DOCS) == [], name


def second_column() -> list[str]:
    """What docs/style.md says not to write."""
    rows = re.findall(r"^\|[^|]+\| ([^|]+) \|$", PAGES["docs/style.md"], re.M)[2:]
    return [entry for row in rows for entry in re.split(r"[;,] ", row)]


def test_documents_are_searched_for_the_whole_list_of_the_page_on_style() -> None:
    entries = second_column()
    assert len(entries) > 30
    assert [entry for entry in entries if not problems(entry, IN_DOCS)] == []
    assert [words for words in IN_DOCS if not problems("; ".join(entries), {words: ""})] == []


def test_the_page_on_style_is_one_screen() -> None:
    lines = PAGES["docs/style.md"].splitlines()
    assert sum(max(1, -(-len(line) // 80)) for line in lines) <= 48


def sentences(text: str) -> list[str]:
    """Of paragraphs and lists; not of tables, headings, pictures and what a program writes."""
    text = re.sub(r"<!-- written by.*?<!-- end of what|```.*?```|<!--.*?-->", "\n", text, flags=re.S)
    text = re.sub(r"^(?:[#|!<]| +\|).*$", "\n", text, flags=re.M)
    text = re.sub(r"`[^`\n]*`", "CODE", re.sub(r"\]\([^)]*\)", "]", text))
    blocks = re.split(r"\n\s*\n|^ *(?:[-*]|\d+\.) ", text, flags=re.M)
    return [one for block in blocks for one in re.split(r"(?<=[.!?])[\")*]*\s+(?=[A-Z\"(\[*])", block) if one.strip()]


def test_sentences_are_found_in_paragraphs_and_lists() -> None:
    text = "# A head\n\nOne. Two, with `a. B` and\na break.\n\n- Three: [four](x.md). Five?\n\n| no | no |\n\n"
    text += "```\nNo. No.\n```\n"
    assert [len(one.split()) for one in sentences(text)] == [1, 6, 2, 1]
    assert len(sentences(PAGES["docs/motion.md"])) > 150


@pytest.mark.parametrize("name", sorted(PAGES))
def test_few_sentences_of_a_page_are_long(name: str) -> None:
    said = sentences(PAGES[name])
    long = [one for one in said if len([word for word in one.split() if re.search(r"\w", word)]) > LONG]
    assert len(long) <= max(1, LONG_SHARE * len(said)), long


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


# What people read while they use the program: help, messages, rules.


@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_no_such_word(name: str) -> None:
    command = cli.get_command(click.Context(cli), name)
    assert command is not None
    text = command.get_help(click.Context(command, info_name=name))
    assert problems(text) == [] and not SHE.search(text)


def test_rules_have_no_such_word() -> None:
    found = {code: [*problems(prose(rule.__doc__ or "")), *problems(rule.name)] for code, rule in all_rules().items()}
    assert {code: words for code, words in found.items() if words} == {}


def test_rules_introduce_the_dancer() -> None:
    for code, rule in all_rules().items():
        text = prose(rule.__doc__ or "")
        she = SHE.search(text)
        assert she is None or "dancer" in text[: she.start()], code


CODE = ROOT / "dancetutor_cli"
MODULES = sorted(path.relative_to(CODE).as_posix() for path in CODE.rglob("*.py"))
SHE = re.compile(r"\b(she|her|hers|herself)\b", re.I)
# In code a hold or a hand may let go, a stage is a room, a door is none of ours, and one tells things apart.
IN_CODE = {words: better for words, better in FORBIDDEN.items() if not words.startswith(("told", "rooms", "(let"))} | {
    r"(?:told|tells?|telling)(?!(?:[^.;]|\.\d){0,80}\bapart\b)": "report, print, say",
    r"(?:every|each|other|this) rooms?": "package",
    r"notes? (?:that )?(?:is|are) let go": "not played",
    r"dearer|dearest": "costlier, slower",
}
# Names of fields and modules that docstrings explain, and data that has been called so since before.
NAMED = re.compile(r"\b(?:told|mend)(?= : |, fix\b)", re.M)


def code_texts(name: str) -> Iterator[tuple[int, str, bool]]:
    """Line, text and whether people may see it: texts of several words in a module, and its comments."""
    source = (CODE / name).read_text("utf-8")
    tree = ast.parse(source)
    bodies = (node.body for node in ast.walk(tree) if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef))
    docs = {body[0].value for body in bodies if body and isinstance(body[0], ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value.strip():
            yield node.lineno, node.value, node not in docs
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string, False


def problems_of_code(text: str) -> list[str]:
    text = NAMED.sub(" ", re.sub(r"`[^`\n]*`", " ", text))
    return [
        f"'{found[0]}': write {better}"
        for words, better in IN_CODE.items()
        for found in re.finditer(rf"\b(?:{words})\b", text, re.I)
    ]


@pytest.mark.parametrize("name", MODULES)
def test_no_message_docstring_or_comment_has_such_a_word(name: str) -> None:
    assert [(line, said) for line, text, _ in code_texts(name) for said in problems_of_code(text)] == []


@pytest.mark.parametrize("name", MODULES)
def test_no_message_says_she(name: str) -> None:
    """Whoever reads one line of a message has not met the dancer."""
    assert [(line, text) for line, text, is_seen in code_texts(name) if is_seen and SHE.search(text)] == []


# Packages whose first docstring says who "she" is.
ABOUT_HER = ("dance/", "film/")


@pytest.mark.parametrize("name", [name for name in MODULES if not name.startswith(ABOUT_HER)])
def test_code_introduces_the_dancer(name: str) -> None:
    text = "\n".join(text for _, text, _ in sorted(code_texts(name)))
    she = SHE.search(text)
    assert she is None or "dancer" in text[: she.start()].lower()


def test_packages_about_her_say_who_she_is() -> None:
    for name in ABOUT_HER:
        first = ast.get_docstring(ast.parse((CODE / name / "__init__.py").read_text("utf-8"))) or ""
        assert re.search(r"\bshe\W+is the dancer", first, re.I), name


def test_the_list_for_code_finds_what_it_is_for() -> None:
    assert len(problems_of_code("It is told in every room; a bill is dearer, notes are let go. Shall it mend?")) == 7
    assert problems_of_code("cannot be told apart; a hold is let go; told : whether; there is room; `told`") == []


def test_the_list_finds_what_it_is_for() -> None:
    assert len(problems("For who is told of a bill in this room, which no ear hears: it shall be mended anew.")) == 8
    assert problems("There is room for a mat. A dearly held wish; doorway.") == []


def test_the_changelog_has_a_screen_for_each_version() -> None:
    versions = re.split(r"^## ", PAGES["CHANGELOG.md"], flags=re.M)[1:]
    assert len(versions) >= 2
    assert {one.splitlines()[0]: len(one.splitlines()) for one in versions if len(one.splitlines()) > 40} == {}
