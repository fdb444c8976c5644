"""A search of a folder writes nothing outside of it, whatever links lie in it; a link that is named is followed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from annotating import POSIX, Said
from click.testing import CliRunner

from dancetutor_cli.chart.selection import find_files, split_links_out
from dancetutor_cli.commands.analyze import command as analyze

NOTES = "1000\n0100\n0010\n0001\n"
SONG = f"#TITLE:T;\n#ARTIST:A;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n{NOTES};\n"


@pytest.fixture
def pack(tmp_path: Path) -> Path:
    """A folder with a song, a link to it, and a link to a chart outside."""
    folder = tmp_path / "pack"
    (folder / "song").mkdir(parents=True)
    (folder / "song" / "x.sm").write_text(SONG)
    (tmp_path / "outside.sm").write_text(SONG)
    (folder / "out.sm").symlink_to(tmp_path / "outside.sm")
    (folder / "within.sm").symlink_to("song/x.sm")
    return folder


@POSIX
def test_annotate_leaves_a_link_out_of_the_folder_alone(pack: Path, tmp_path: Path) -> None:
    said = Said([pack])
    assert said.status == 0 and (tmp_path / "outside.sm").read_text() == SONG
    assert (pack / "song" / "x.sm").read_text() != SONG
    assert said.err.splitlines() == [
        f"warning: {pack / 'out.sm'}: is a link to {os.path.realpath(tmp_path)}/outside.sm, outside the folder that is "
        "searched; it is not changed; name it to change it"
    ]
    assert Said([pack, "--check"]).status == 0
    assert Said([pack / "out.sm"]).status == 0 and (tmp_path / "outside.sm").read_text() != SONG
    assert (pack / "out.sm").is_symlink()


@POSIX
def test_fix_leaves_a_link_out_of_the_folder_alone(pack: Path, tmp_path: Path) -> None:
    spoilt = SONG.replace(NOTES, "2001\nM000\n0010\n3000\n,\n4000\n0100\n0001\n0010\n")
    for file in (tmp_path / "outside.sm", pack / "song" / "x.sm"):
        file.write_text(spoilt)
    result = CliRunner().invoke(analyze, ["--fix", "safe", str(pack)], standalone_mode=False)
    assert (tmp_path / "outside.sm").read_text() == spoilt != (pack / "song" / "x.sm").read_text()
    assert "out.sm: is a link to" in result.stderr and result.stderr.count("is a link to") == 1
    assert "2 files:" in result.stdout


@POSIX
def test_a_link_that_is_named_or_stays_within_is_no_way_out(pack: Path, tmp_path: Path) -> None:
    (pack / "dead.sm").symlink_to("nowhere.sm")
    files = find_files([pack])
    kept, out = split_links_out([pack], files)
    assert out == [pack / "out.sm"] and len(kept) == len(files) - 1
    both = [pack, pack / "out.sm"]
    assert split_links_out(both, find_files(both))[1] == []
    assert split_links_out([pack, tmp_path], find_files([pack, tmp_path]))[1] == []
