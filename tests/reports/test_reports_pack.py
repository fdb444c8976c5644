"""The page of a pack: what is counted, missing and standing out, as text and as one HTML file."""

from __future__ import annotations

import re
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest
from click.testing import CliRunner

from dancetutor_cli.chart.pack_files import read_pack_ini
from dancetutor_cli.commands.analyze import command
from dancetutor_cli.reports.pack import LINES

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests" / "page"))
from page_chromium import Browser  # noqa: E402

HOSTILE = "</title><script>window.hacked=1</script><img src=x onerror=window.hacked=1>&quot;'"
NOTES = ",\n".join(["1000\n0100\n0001\n0010\n"] * 6)


def song(folder: Path, name: str, *, title: str = "", difficulties: tuple[str, ...] = ("Easy", "Hard")) -> Path:
    """A song's folder with a chart for each difficulty, meters 3 and 6 and so on."""
    place = folder / name
    place.mkdir(parents=True)
    (place / "a.ogg").write_bytes(b"x")
    text = f"#TITLE:{title or name};\n#ARTIST:A;\n#MUSIC:a.ogg;\n#BPMS:0=120;\n"
    for n, difficulty in enumerate(difficulties):
        text += f"#NOTES:\ndance-single:\nC:\n{difficulty}:\n{3 * n + 3}:\n:\n{NOTES};\n"
    path = place / f"{name}.sm"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture
def pack(tmp_path: Path) -> Path:
    """Six songs; one lacks its Hard, one its music, one has a hostile title, and the pack an odd sync."""
    folder = tmp_path / "My Pack & Co"
    for name in ("one", "two", "three", "four"):
        song(folder, name)
    song(folder, "lacks", difficulties=("Easy",))
    song(folder, "hostile", title=HOSTILE.replace(";", "\\;"))
    (folder / "two" / "a.ogg").unlink()
    (folder / "Pack.ini").write_text("[Group]\nVersion=1\nSyncOffset=OUTFOX\n", encoding="utf-8")
    return folder


def printed(*words: str | Path) -> str:
    result = CliRunner().invoke(command, [*map(str, words), "--no-cache", "--jobs", "1", "--exit-zero"])
    assert result.exit_code == 0, result.output
    return result.stdout


def test_a_run_over_a_pack_ends_with_its_page(pack: Path) -> None:
    for form in ("--full", "--brief"):
        text = printed(pack, form)
        page = text[text.index("pack My Pack & Co") :].splitlines()
        assert page[0] == "pack My Pack & Co: 6 songs, 11 charts"
        assert len(page) <= LINES + 1 and page[-1].startswith("6 files, 11 charts")
        assert any("missing: dance-single Hard of lacks" in line for line in page)
        assert any("missing: music of two" in line for line in page)
        assert any("Pack.ini: SyncOffset is 'OUTFOX'" in line for line in page)


def test_labels_are_counted_by_meter(pack: Path) -> None:
    (line,) = [line for line in printed(pack, "--full").splitlines() if line.startswith("  dance-single: ")]
    assert line.startswith("  dance-single: 11 charts, middle half rated 3 to 6; 10 play like ITG ")


def test_a_song_or_a_quiet_run_has_no_page(pack: Path) -> None:
    assert "pack My Pack" not in printed(pack / "one", "--full")
    assert "pack My Pack" not in printed(pack, "--full", "--quiet")
    assert "pack My Pack" not in printed(pack, "--format", "csv")


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("[Group]\nSyncOffset=ITG\n", None),
        ("\ufeff[group]\r\nsyncoffset = null\r\n", None),
        ("[Other]\nSyncOffset=ITG\n", "has no SyncOffset"),
        ("[Group]\n;SyncOffset=ITG\n", "has no SyncOffset"),
        ("[Group]\nSyncOffset=0.009\n", "the game knows only NULL and ITG"),
    ],
)
def test_the_sync_of_a_pack(tmp_path: Path, text: str, problem: str | None) -> None:
    (tmp_path / "PACK.INI").write_text(text, encoding="utf-8")
    found = read_pack_ini(tmp_path)
    assert found is not None
    assert (problem or "") in (found.problem or "") and (found.problem is None) == (problem is None)


def test_a_folder_without_pack_ini_has_none(tmp_path: Path) -> None:
    assert read_pack_ini(tmp_path) is None
    assert read_pack_ini(tmp_path / "nowhere") is None


class Tags(HTMLParser):
    """Every tag and attribute of a page, and whether what is opened is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.seen: set[str] = set()
        self.links: list[str] = []
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.add(tag)
        self.links += [f"{tag} {name}" for name, _ in attrs if name in ("src", "href", "onerror", "onload")]
        if tag not in ("br", "meta", "path", "rect", "circle", "polyline"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag in self.open:
            assert self.open.pop() == tag


def test_the_html_is_one_file_and_what_people_wrote_is_text(pack: Path, tmp_path: Path) -> None:
    out = tmp_path / "page.html"
    printed(pack, "--brief", "--report-html", out)
    text = out.read_text(encoding="utf-8")
    tags = Tags()
    tags.feed(text)
    assert "svg" in tags.seen and "script" not in tags.seen and "img" not in tags.seen
    assert tags.links == [] and tags.open == []
    assert "http://" not in text and "https://" not in text
    assert "default-src 'none'" in text
    assert text.count("<figure>") == 5
    assert re.search(r"<th>to score on \(DDR scale\)</th>.*<td>\d+\.\d</td><td>\d+\.\d\d</td>", text)
    for said in ("missing: dance-single Hard of lacks", "missing: music of two", "OUTFOX", "&lt;script&gt;"):
        assert said in text


def test_a_browser_shows_it_without_a_word(pack: Path, tmp_path: Path) -> None:
    out = tmp_path / "page.html"
    printed(pack, "--brief", "--report-html", out)
    browser = Browser()
    try:
        browser.call("Page.navigate", url=out.as_uri())
        browser.wait("location.protocol === 'file:' && document.readyState === 'complete'")
        assert browser.run("window.hacked") is None
        assert browser.run("document.querySelectorAll('svg').length") == 5
        assert browser.run("document.documentElement.scrollWidth <= window.innerWidth") is True
        assert browser.problems == [] and browser.requests == [out.as_uri()]
    finally:
        browser.close()


def test_a_page_needs_a_name_that_says_so(pack: Path) -> None:
    result = CliRunner().invoke(command, [str(pack), "--report-html", "x.txt"])
    assert result.exit_code != 0 and ".html" in str(result.exception)
