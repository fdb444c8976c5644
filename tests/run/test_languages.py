"""Languages: every label in every file, with the same places; no label that nothing shows; letters that a font has."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner

from dancetutor_cli.commands import cli
from dancetutor_cli.feet.limbs import LABELS
from dancetutor_cli.feet.solver.techniques import HALF_TURNS
from dancetutor_cli.feet.solver.vocabulary import EVENTS
from dancetutor_cli.film.overlay import text
from dancetutor_cli.film.words import BACK, FRONT, HOLD, JUMP, MINE
from dancetutor_cli.lint.rule import all_rules
from dancetutor_cli.run.errors import FileError, UnavailableError, UsageError
from dancetutor_cli.run.languages import load_language
from dancetutor_cli.run.reading import config_names, config_path

PACKAGE = Path(__file__).resolve().parents[2] / "dancetutor_cli"
NAMES = config_names("languages")
SECTIONS = ("limbs", "panels", "moves", "calls", "findings", "film", "sheet", "page")
HEAD = "#TITLE:t;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:\n dance-single:\n :\n Hard:\n 5:\n :\n"


def written(name: str) -> dict[str, dict[str, str]]:
    data: dict[str, dict[str, str]] = yaml.safe_load(config_path(f"languages/{name}.yaml").read_text("utf-8"))
    return data


def test_the_five_languages_are_there() -> None:
    assert set(NAMES) == {"de", "en", "es", "ja", "ko"}


@pytest.mark.parametrize("name", NAMES)
def test_no_label_is_missing_and_places_are_those_of_the_english_words(name: str) -> None:
    english, here = written("en"), written(name)
    for section in SECTIONS:
        assert list(here[section]) == list(english[section]), section
        for label, words in here[section].items():
            places = re.findall(r"\{(\w+)\}", words)
            assert words.strip(), label
            assert set(places) == set(re.findall(r"\{(\w+)\}", english[section][label])), label


@pytest.mark.parametrize("name", sorted(set(NAMES) - {"en"}))
def test_a_language_is_not_the_english_words_again(name: str) -> None:
    """Words that are the same in both are names and signs; a file that was copied and left so would be caught."""
    english, here = written("en"), written(name)
    both = [(words, here[section][label]) for section in SECTIONS for label, words in english[section].items()]
    same = [words for words, other in both if words == other]
    assert len(same) < 0.1 * len(both), same


@pytest.mark.parametrize("name", NAMES)
def test_every_move_rule_panel_and_limb_has_words(name: str) -> None:
    language = load_language(name)
    assert set(language.moves) == {*EVENTS, *HALF_TURNS, HOLD, MINE}
    assert set(language.findings) == set(all_rules())
    for rule, words in language.findings.items():
        called, _, meaning = words.partition(": ")
        assert called and meaning.endswith((".", "。")), rule
    pads = yaml.safe_load(config_path("pads.yaml").read_text("utf-8")).values()
    panels = {re.sub(r"-\d+$", "", panel) for pad in pads for panel, *_ in pad["panels"]}
    assert panels == set(language.panels)
    assert {*LABELS, *(f"{limb}-short" for limb in LABELS), "foot", "none"} == set(language.limbs)


def test_no_label_is_unused() -> None:
    """A label of a film or sheet is named in the package; one of the page in its script, whole or without a prefix.

    Of calls: a move of one foot by its name in the vocabulary, a crossover with its tag.
    """
    python = "".join(path.read_text("utf-8") for path in PACKAGE.rglob("*.py"))
    script = "".join(path.read_text("utf-8") for path in (PACKAGE / "page" / "js").glob("*.js"))
    english = load_language()
    calls = [label.removesuffix("-tag") for label in english.calls]
    assert [label for label in calls if label not in EVENTS and f'"{label}"' not in python] == []
    assert sorted(label for label in english.calls if label.endswith("-tag")) == sorted(
        f"{name}-tag" for name in (BACK, FRONT, JUMP)
    )
    assert [label for label in (*english.film, *english.sheet) if not re.search(f"[\"']{label}[\"']", python)] == []
    prefixes = tuple(re.findall(r"t\(`([\w]+-)\$\{", script)) + tuple(re.findall(r'f"(\w+-)\{', python))
    assert len(set(prefixes)) > 8
    called = "|".join(re.findall(r"\bt\(`\$\{[^`]*`", script))
    quoted = set(re.findall(r"""["'`](\w[\w-]*)["'`]""", script + python)) | {"decimal"}

    def is_used(label: str) -> bool:
        ends = [label.removeprefix(start) for start in ("given", "cost") if label.startswith(start) and called]
        done = label.removesuffix("Done")
        return label in quoted or label.startswith(prefixes) or done in quoted or any(end in quoted for end in ends)

    assert [label for label in english.page if not is_used(label) and f".{label}" not in script] == []


def test_a_wrong_label_or_place_is_one_line_with_its_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    broken = tmp_path / "xx.yaml"
    files = {"xx": broken, "en": config_path("languages/en.yaml")}
    monkeypatch.setattr("dancetutor_cli.run.languages.named_file", lambda _, name: files[name])
    broken.write_text("language: X\nfilm:\n  nxt: y\n")
    with pytest.raises(FileError, match=r"xx.yaml:3: unknown key 'nxt' in 'film' \(did you mean next\?\)"):
        load_language.__wrapped__("xx")
    broken.write_text("language: X\nfilm:\n  run: y\n")
    with pytest.raises(FileError, match=r"xx.yaml:3: film.run must have \{count\} \{number\}"):
        load_language.__wrapped__("xx")
    broken.write_text("language: X\nfilm:\n  next: y\n")
    found = load_language.__wrapped__("xx")
    assert found.film["next"] == "y" and found.film["then"] == "then"  # what is not there is English


def test_letters_that_no_font_has_are_one_line_and_no_boxes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text, "system_fonts", tuple)
    text._font_of.cache_clear()
    with pytest.raises(UnavailableError, match=r"no font here has all letters of --language ja .*--font FILE"):
        text.check_letters("ja", None)
    with pytest.raises(UnavailableError, match=r"--language de .*fonts-dejavu-core"):
        text.check_letters("de", None)
    text.check_letters("en", None)  # the built-in font has no more than these
    chart = tmp_path / "t.sm"
    chart.write_text(HEAD + "1000\n0100\n0010\n0001\n;\n")
    done = CliRunner().invoke(cli, ["render", str(chart), "--language", "ko", "-o", str(tmp_path / "t.mp4")])
    assert isinstance(done.exception, UnavailableError) and not (tmp_path / "t.mp4").exists()
    text._font_of.cache_clear()


def test_an_unknown_language_names_those_there_are() -> None:
    done = CliRunner().invoke(cli, ["page", "charts", "--language", "jp"])
    assert isinstance(done.exception, UsageError)
    assert str(done.exception) == "there is no language 'jp'; choose de, en, es, ja, ko"


def test_the_language_of_analyze_is_that_of_a_sheet(tmp_path: Path) -> None:
    chart, sheet = tmp_path / "t.sm", tmp_path / "t.html"
    chart.write_text(HEAD + "1000\n0100\n0010\n0001\n;\n")
    done = CliRunner().invoke(cli, ["analyze", str(chart), "--language", "de"])
    assert isinstance(done.exception, UsageError) and "add --sheet" in str(done.exception)
    assert CliRunner().invoke(cli, ["analyze", str(chart), "--language", "de", "--sheet", str(sheet)]).exit_code < 2
    page = sheet.read_text("utf-8")
    assert '<html lang="de">' in page and "linker Fuß" in page and "left foot" not in page
