"""`dancetutor annotate`: which styles are written where, and how they come out again."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from annotating import ALL, Said, files_of


def test_a_folder_does_both_files_and_a_name_only_one(song: Path, ssc: Path) -> None:
    before = files_of(song)
    assert Said([ssc]).status == 0
    assert b"{dt1 " in ssc.read_bytes()
    assert (song / "two_left_feet.sm").read_bytes() == before["two_left_feet.sm"]
    assert Said([song.parent]).status == 0
    assert all(b"{dt1 " in data for data in files_of(song).values())
    assert Said([song, "--strip"]).out.count("stripped ") == 2
    assert files_of(song) == before


@pytest.mark.parametrize(
    "options",
    [["--markers", style] for style in (*ALL.split(","), ALL)] + [["--markers", "measure,rows,edit", "--into-file"]],
)
def test_every_style_is_written_once_checked_and_taken_out(song: Path, options: list[str]) -> None:
    before = files_of(song)
    assert Said([song, *options, "--check"]).status == 1
    assert files_of(song) == before
    assert Said([song, *options]).status == 0
    once = files_of(song)
    assert once != before
    said = Said([song, *options])
    assert files_of(song) == once
    assert said.out.count("unchanged") == 3  # two files and the sum
    assert Said([song, *options, "--check"]).status == 0
    assert Said([song, *options, "--strip", "--check"]).status == 1
    assert Said([song, *options, "--strip", "--dry-run"]).status == 0
    assert files_of(song) == once
    assert Said([song, *options, "--strip"]).status == 0
    assert files_of(song) == before
    assert Said([song, *options, "--strip", "--check"]).status == 0


def test_styles_come_out_one_by_one(song: Path) -> None:
    before = files_of(song)
    Said([song, "--markers", ALL])
    for style in ALL.split(","):
        assert Said([song, "--markers", style, "--strip"]).status == 0
        for other in ALL.split(",")[ALL.split(",").index(style) + 1 :]:
            assert Said([song, "--markers", other, "--check"]).status == 0, (style, other)
    assert files_of(song) == before


@pytest.mark.parametrize("written", [*ALL.split(","), ALL, "measure,rows,edit --into-file"])
def test_strip_alone_takes_every_style_out(song: Path, written: str) -> None:
    before = files_of(song)
    assert Said([song, "--markers", *written.split()]).status == 0
    assert files_of(song) != before
    said = Said([song, "--strip"])
    assert said.status == 0
    assert "unchanged" not in said.out.splitlines()[-2], said.out
    assert files_of(song) == before
    assert Said([song, "--strip", "--check"]).status == 0


def test_strip_alone_leaves_files_that_are_not_ours(song: Path, ssc: Path) -> None:
    before = ssc.read_bytes()
    (song / "data.sme").write_bytes(b"not SMEditor's")
    (song / "two_left_feet.dancetutor.json").write_bytes(b"{}")
    Said([song])
    said = Said([song, "--strip"])
    assert said.status == 0, said.err
    assert ssc.read_bytes() == before
    assert (song / "data.sme").read_bytes() == b"not SMEditor's"
    assert "warning: " in said.err
    assert "is not JSON" in said.err
    assert Said([song, "--strip", "--markers", "smeditor"]).status == 2, "who names a style wants to know"


def test_strip_needs_no_solver(ssc: Path) -> None:
    """Taking markers out starts quickly: numba is not imported."""
    import subprocess

    code = (
        "import sys; from dancetutor_cli.commands.annotate import command\n"
        "command(sys.argv[1:], standalone_mode=False)\nsys.exit('numba' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code, ssc, "--strip"], cwd=ssc.parent).returncode == 0
