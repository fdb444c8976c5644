"""A folder: a page for each chart, and an index."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from page_song import TITLE, write_song

from dancetutor_cli.__main__ import main
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.page.document import IndexEntry, index_page
from dancetutor_cli.page.work import PageRequest, page_jobs
from dancetutor_cli.run.reading import charts_path


def test_every_chart_of_a_folder_gets_a_file_of_its_own(tmp_path: Path) -> None:
    jobs, bad = page_jobs(PageRequest(DanceRequest(charts_path(), Selection())), tmp_path)
    assert bad == [] and len(jobs) == 6
    assert len({job.target for job in jobs}) == 6
    assert [job.request.dance.selection.index for job in jobs] == list(range(6))


def test_a_folder_becomes_pages_and_an_index(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    songs = tmp_path / "songs"
    songs.mkdir()
    write_song(songs)
    (songs / "broken.sm").write_bytes(b"\x00\xff" * 40)
    with pytest.raises(SystemExit) as stop:
        main(["page", str(songs), "-o", str(tmp_path / "out"), "--difficulty", "hard"])
    assert stop.value.code == 2  # one file could not be read
    said = capsys.readouterr()
    assert ": 1 page\n" in said.out and "broken.sm" in said.out + said.err
    index = (tmp_path / "out" / "index.html").read_text("utf-8")
    links = re.findall(r'href="([^"]+\.html)"', index)
    assert len(links) == 1 and (tmp_path / "out" / links[0]).stat().st_size > 100_000


def test_quiet_is_without_warnings(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    song, said = tmp_path / "s.sm", []
    trill = "2000\n" + "0000\n" * 7 + "0010\n0100\n0010\n0100\n0000\n3000\n0000\n0001\n"  # the dancer lets some go
    song.write_text(f"#TITLE:T;\n#OFFSET:0;\n#BPMS:0=200;\n#NOTES:dance-single::Hard:9::\n{trill};\n")
    for path in (song, tmp_path):
        for more in ((), ("-q",)):
            target = tmp_path / ("page.html" if path is song else "pages")
            with pytest.raises(SystemExit) as stop:
                main(["page", str(path), "-o", str(target), *more])
            assert stop.value.code == 0
            said.append(capsys.readouterr())
    assert all("warning: " in one.err for one in said[::2])
    assert all((one.out, one.err) == ("", "") for one in said[1::2])


def test_the_index_never_holds_people_s_markup() -> None:
    text = index_page([IndexEntry("a b&c.html", TITLE, "<i>me</i>", 'x "Hard" 9')], "<pack>").decode()
    assert "<script" not in text and "<img" not in text and "<i>" not in text
    assert 'href="a%20b%26c.html"' in text
    assert "default-src 'none'" in text


def test_what_is_about_one_chart_is_refused_for_folders(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["page", str(charts_path()), "-o", str(tmp_path / "out"), "--play", "x.json"])
    assert stop.value.code == 2
    assert "is a folder" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_folder_of_two_songs_is_not_written_into_one_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, more in (("one", ""), ("two", "#NOTES:dance-single::Easy:2::\n1000\n0100\n0010\n0001\n;\n")):
        (tmp_path / name).mkdir()
        notes = "#NOTES:dance-single::Hard:9::\n1000\n0100\n0010\n0001\n;\n"
        (tmp_path / name / "s.sm").write_text(f"#TITLE:{name};\n#OFFSET:0;\n#BPMS:0=120;\n{notes}{more}")
    target = tmp_path / "x.html"
    with pytest.raises(SystemExit) as stop:
        main(["page", str(tmp_path), "-o", str(target)])
    assert stop.value.code == 2 and not target.exists()
    (line,) = capsys.readouterr().err.splitlines()
    assert "x.html is one page, but 3 charts in" in line and "give a folder to -o" in line
    with pytest.raises(SystemExit) as stop:
        main(["page", str(tmp_path), "-o", str(target), "--difficulty", "easy"])
    assert stop.value.code == 0 and target.is_file()
