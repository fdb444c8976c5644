"""`dancetutor annotate`: files that are broken, read-only, linked, changed or on a full disk lose nothing."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest
from annotating import POSIX, Said, files_of

from dancetutor_cli.run.files import temporary_name


def test_a_bad_file_in_a_folder_does_not_stop_the_others(song: Path, hostile: Path) -> None:
    shutil.copy(hostile / "random_bytes.sm", song / "noise.sm")
    said = Said([song])
    assert said.status == 2
    assert said.err.count("noise.sm") == 1
    assert "3 files: 2 changed, 1 failed" in said.out


def test_read_only_files_are_reported_and_nothing_is_lost(song: Path, ssc: Path) -> None:
    before = files_of(song)
    ssc.chmod(0o444)
    said = Said([song])
    assert said.status == 2
    assert "two_left_feet.ssc: is read-only; nothing was written" in said.err
    assert ssc.read_bytes() == before["two_left_feet.ssc"]
    assert (song / "two_left_feet.sm").read_bytes() != before["two_left_feet.sm"]


@POSIX
def test_a_link_is_written_through(song: Path, ssc: Path, tmp_path: Path) -> None:
    link = tmp_path / "link.ssc"
    link.symlink_to(ssc)
    assert Said([link]).status == 0
    assert link.is_symlink()
    assert b"{dt1 " in ssc.read_bytes()


def test_what_a_killed_run_left_is_gone_after_the_next(song: Path, ssc: Path) -> None:
    Said([ssc])
    temporary_name(ssc).write_bytes(b"half a file")
    temporary_name(song / "other.sm").write_bytes(b"half a file")
    Said([ssc])  # nothing to write, but something to clean
    assert sorted(files_of(song)) == ["two_left_feet.sm", "two_left_feet.ssc"]


def test_a_file_that_changes_while_it_is_worked_on_is_left_alone(ssc: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from dancetutor_cli.markers import annotate

    write = annotate.write_atomic
    edited = ssc.read_bytes() + b"// saved by an editor\n"

    def meanwhile(path: Path, data: bytes, *, expect: bytes | None = None) -> None:
        ssc.write_bytes(edited)
        write(path, data, expect=expect)

    monkeypatch.setattr(annotate, "write_atomic", meanwhile)
    said = Said([ssc])
    assert said.status == 2
    assert "changed by another program" in said.err
    assert ssc.read_bytes() == edited


def test_two_commands_on_one_file_end_well(ssc: Path) -> None:
    """Both do the same, one after the other or at once: each ends with 0 and the file is whole."""
    import subprocess

    original = ssc.read_bytes()
    Said([ssc])
    marked = ssc.read_bytes()
    for options, before, after in (([], original, marked), (["--strip"], marked, original)):
        ssc.write_bytes(before)
        code = "import sys; from dancetutor_cli.__main__ import main; main()"
        command_line = [sys.executable, "-c", code, "annotate", ssc, *options]
        running = [subprocess.Popen(command_line, stdout=subprocess.PIPE, stderr=subprocess.PIPE) for _ in range(3)]
        said = [process.communicate(timeout=120)[1] for process in running]
        assert [process.returncode for process in running] == [0, 0, 0], said
        assert ssc.read_bytes() == after
    assert sorted(files_of(ssc.parent)) == ["two_left_feet.sm", "two_left_feet.ssc"]


def test_a_full_disk_is_reported(ssc: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from dancetutor_cli.run import files

    original = ssc.read_bytes()

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files.os, "fsync", full)
    said = Said([ssc])
    assert said.status == 2
    assert "No space left on device; the old file is unchanged" in said.err
    assert files_of(ssc.parent)[ssc.name] == original


def test_hostile_files_lose_no_byte(hostile: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(hostile, tmp_path / "hostile")
    before = files_of(folder)
    said = Said([folder, "--jobs", 1])
    assert said.status == 2
    assert "Traceback" not in said.err
    Said([folder, "--strip", "--jobs", 1])
    assert files_of(folder) == before
    assert "cr_only.sm: lines end at CR alone" in said.err


def test_bom_and_bytes_behind_the_end_stay(ssc: Path) -> None:
    data = b"\xef\xbb\xbf" + ssc.read_bytes().replace(b"\n", b"\r\n") + b"\0\0 behind \xff\xfe"
    ssc.write_bytes(data)
    Said([ssc])
    marked = ssc.read_bytes()
    assert marked != data
    assert marked.count(b"\r\n") == marked.count(b"\n") == data.count(b"\n")
    Said([ssc, "--strip"])
    assert ssc.read_bytes() == data


def test_stubs_in_a_folder_are_one_warning(tmp_path: Path) -> None:
    for n in range(7):
        (tmp_path / f"s{n}.sm").write_text("#TITLE:M;\n#MUSIC:a.ogg;\n#BPMS:0=120;\n")
    said = Said([tmp_path])
    (line,) = said.err.splitlines()
    assert line.startswith(f"warning: {tmp_path / 's0.sm'}:1: no charts: the file has no NOTES; the same for 6 more: ")
    assert said.out.splitlines()[-1] == "7 files: 7 unchanged"
    assert len(Said([tmp_path, "-v"]).err.splitlines()) == 7


def test_a_folder_without_charts_is_no_file(tmp_path: Path) -> None:
    said = Said([tmp_path])
    assert said.status == 2
    assert said.out == "0 files: no file to read in 1 folder\n"


def test_a_text_that_is_no_chart_is_told_what_to_give(tmp_path: Path) -> None:
    (tmp_path / "README.md").write_text("# a\n")
    assert "README.md: not a chart file; give a .sm, .ssc or .ucs file" in Said([tmp_path / "README.md"]).err
