"""A page is made to be shared: it names files, and says nothing of the folders that they lie in."""

from __future__ import annotations

import base64
import re
import zlib
from pathlib import Path

from click.testing import CliRunner

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.commands import cli
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.page.work import PageRequest, make_page

NOTES = "1000\n0100\n0010\n0001\n,\n1000\n0010\n0100\n0001\n"
SONG = f"#TITLE:T;\n#ARTIST:A;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n{NOTES};\n"


def write_song(folder: Path) -> Path:
    """A chart of two measures."""
    path = folder / "song.sm"
    path.write_text(SONG)
    return path


def everything(page: bytes) -> bytes:
    """A page, and what is packed in it."""
    packed = [base64.b64decode(one) for one in re.findall(rb"[A-Za-z0-9+/]{400,}={0,2}", page) if len(one) % 4 == 0]
    return page + b"".join(zlib.decompress(one) for one in packed if one[:1] == b"\x78")


def test_feet_of_a_file_are_named_without_its_folder(tmp_path: Path) -> None:
    folder = tmp_path / "privatefolder"
    folder.mkdir()
    song, feet = write_song(folder), folder / "feet.json"
    said = CliRunner().invoke(cli, ["analyze", "--format", "json", "--exit-zero", str(song)])
    feet.write_text(said.stdout)
    for dance in (DanceRequest(song, Selection(), fps=10.0, play=feet), DanceRequest(song, Selection(), fps=10.0)):
        second = None if dance.play else str(feet)
        data = everything(make_page(PageRequest(dance, second=second, character="mannequin")).html)
        assert b"feet" in data and b"privatefolder" not in data


def test_the_page_of_a_pack_names_files_below_it(tmp_path: Path) -> None:
    pack, page = tmp_path / "privatefolder" / "pack", tmp_path / "page.html"
    (pack / "good").mkdir(parents=True)
    (pack / "bad").mkdir()
    write_song(pack / "good")
    (pack / "bad" / "bad.sm").write_text("nothing")
    CliRunner().invoke(cli, ["analyze", "--exit-zero", "--no-cache", str(pack), "--report-html", str(page)])
    data = page.read_bytes()
    assert b"bad.sm" in data and b"privatefolder" not in data
