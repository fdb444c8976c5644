"""Measured numbers in tables of docs: written by tools/doc_figures.py, or listed here with the reason why not."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from module_file import tool

ROOT = Path(__file__).resolve().parent.parent
PAGES = {path.name: path.read_text("utf-8") for path in sorted((ROOT / "docs").glob("*.md"))}
figures = tool("doc_figures")
WRITTEN = re.compile(
    r"<!-- figures: [\w-]+ -->.*?<!-- end of figures -->"
    r"|<!-- written by tools/(\w+)\.py -->.*?<!-- end of what tools/\1\.py writes -->|```.*?```",
    re.S,
)
TABLE = re.compile(r"(?:^ *\|.*\n?)+", re.M)
DEFINED = "these numbers define something, nothing is measured"
HISTORY = "measured once, as the page says next to it: other programs or songs do not come with the program"
BY_HAND = {  # page, beginning of the table's head: why no command writes it
    ("cost-model.md", "| what, in a row with steps"): DEFINED,
    ("formats.md", "| key | is |"): DEFINED,
    ("formats.md", "| array | shape"): DEFINED,
    ("motion.md", "| figure | goal |"): DEFINED,
    ("references.md", "| source | what"): "numbers of chapters",
    ("sync.md", "| what is printed"): DEFINED,
    ("peers.md", "| technique "): HISTORY,
    ("performance.md", "| program | what it does"): HISTORY,
    ("sync.md", "| of these 44 songs"): HISTORY,
}


def with_numbers(text: str) -> list[str]:
    """The heads of tables with a number at the beginning of a cell, besides those that a command writes."""
    out = []
    for table in TABLE.findall(WRITTEN.sub("", text)):
        head, _, *lines = table.strip().splitlines()
        cells = [cell.strip() for line in lines for cell in line.strip().strip("|").split("|")[1:]]
        if any(re.match(r"\W*\d", cell) for cell in cells):
            out.append(head)
    return out


def blocks(text: str) -> list[str]:
    """The names of blocks of a page, in order."""
    return re.findall(r"<!-- figures: ([\w-]+) -->\n(?=(?:\||.*\n)[\s\S]*?<!-- end of figures -->)", text)


def test_tables_are_found_that_nobody_writes() -> None:
    table = "| a | b |\n| --- | ---: |\n| one | {} |\n"
    inside = f"<!-- figures: x -->\n{table.format('3 ms')}<!-- end of figures -->\n"
    assert with_numbers(f"{inside}\n{table.format('words 3')}\n{table.format('**3** ms')}") == ["| a | b |"]
    assert blocks(inside) == ["x"]


@pytest.mark.parametrize("page", PAGES)
def test_a_command_writes_every_table_of_measured_numbers(page: str) -> None:
    listed = [begin for name, begin in BY_HAND if name == page]
    heads = with_numbers(PAGES[page])
    assert [head for head in heads if not head.startswith(tuple(listed))] == [], "see tools/doc_figures.py"
    assert [begin for begin in listed if not any(head.startswith(begin) for head in heads)] == [], "listed in vain"


@pytest.mark.parametrize("page", [page for (page, _), why in BY_HAND.items() if why == HISTORY])
def test_pages_say_when_something_was_measured_once(page: str) -> None:
    assert re.search(r"[Mm]easured\s+once,\s+in\s+[A-Z][a-z]+\s+\d{4}\s+with\s+commits?\s+[0-9a-f]{8}", PAGES[page])


def test_each_block_is_in_its_page_and_written_by_a_function() -> None:
    there = [(name, page) for page, text in PAGES.items() for name in blocks(text)]
    assert sorted(there) == sorted((name, page) for name, (page, _) in figures.FIGURES.items())


@pytest.mark.parametrize("name", figures.FIGURES)
def test_each_block_has_been_measured(name: str) -> None:
    table = figures.between(PAGES[figures.FIGURES[name][0]], name)
    assert len(TABLE.findall(table)[0].splitlines()) >= 3, f"python tools/doc_figures.py {name}"


def test_pages_and_blocks_can_be_named() -> None:
    assert figures.named(["motion"]) == [name for name, (page, _) in figures.FIGURES.items() if page == "motion.md"]
    assert figures.named(["costs", "films.md", "costs"]) == ["costs", "forms"]
    with pytest.raises(SystemExit, match="no figures 'motions'; there are: costs, "):
        figures.named(["motions"])


def test_a_block_without_its_data_stays_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def missing() -> str:
        raise figures.MissingError("../shared/data/songs")

    text = "<!-- figures: a -->\nold\n<!-- end of figures -->\n<!-- figures: b -->\n{}\n<!-- end of figures -->\n"
    (tmp_path / "page.md").write_text(text.format("old"), encoding="utf-8")
    monkeypatch.setattr(figures, "DOCS", tmp_path)
    monkeypatch.setattr(figures, "FIGURES", {"a": ("page.md", missing), "b": ("page.md", lambda: "new\n")})
    monkeypatch.setattr("sys.argv", ["doc_figures.py"])
    figures.main()
    assert capsys.readouterr().out.splitlines()[0] == (
        "docs/page.md: a stays as it is: ../shared/data/songs is not here"
    )
    assert (tmp_path / "page.md").read_text("utf-8") == text.format("new")


# Blocks that take a second or two are measured again.


def test_the_tables_of_costs_are_those_of_the_presets() -> None:
    assert figures.between(PAGES["cost-model.md"], "costs") == figures.FIGURES["costs"][1](), "make docs-figures"


def test_the_figures_of_the_motion_are_those_that_it_has() -> None:
    """Within a tenth, for other processors round otherwise; names, units and goals to the letter."""
    shown, made = (
        [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]
        for table in (figures.between(PAGES["motion.md"], "demo"), figures.FIGURES["demo"][1]())
    )
    assert [(name, goal) for name, _, goal in shown] == [(name, goal) for name, _, goal in made], "make docs-figures"
    for (name, old, _), (_, new, _) in zip(shown[2:], made[2:], strict=True):
        (a, *unit), (b, *other) = old.split(), new.split()
        assert unit == other and float(a) == pytest.approx(float(b), rel=0.1, abs=0.01), f"{name}: make docs-figures"
