"""`dancetutor annotate` as a user calls it: styles, options, exit statuses, and files that cannot be written."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
from click.testing import CliRunner

from dancetutor_cli.commands.annotate import command
from dancetutor_cli.errors import DancetutorError, UsageError
from dancetutor_cli.files import temporary_name

SONG = Path(__file__).resolve().parent.parent / "charts" / "two_left_feet"
ALL = "measure,rows,sidecar,smeditor,edit"
POSIX = pytest.mark.skipif(os.name == "nt", reason="POSIX modes and links")


class Said:
    """How a call ended: exit status, standard output and standard error."""

    def __init__(self, arguments: Sequence[object], **options: object) -> None:
        result = CliRunner().invoke(command, [str(a) for a in arguments], standalone_mode=False, **options)  # type: ignore[arg-type]
        if result.exception is not None and not isinstance(result.exception, DancetutorError):
            raise result.exception
        self.error = result.exception
        self.status = result.return_value if self.error is None else 2
        self.out, self.err = result.stdout, result.stderr


def files_of(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.fixture
def song(tmp_path: Path) -> Path:
    """A folder with the demo song as .sm and .ssc."""
    folder = tmp_path / "pack" / "song"
    folder.mkdir(parents=True)
    for name in ("two_left_feet.sm", "two_left_feet.ssc"):
        shutil.copy(SONG / name, folder / name)
    return folder


@pytest.fixture
def ssc(song: Path) -> Path:
    return song / "two_left_feet.ssc"


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
    [["--style", style] for style in (*ALL.split(","), ALL)] + [["--style", "measure,rows,edit", "--into-file"]],
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
    Said([song, "--style", ALL])
    for style in ALL.split(","):
        assert Said([song, "--style", style, "--strip"]).status == 0
        for other in ALL.split(",")[ALL.split(",").index(style) + 1 :]:
            assert Said([song, "--style", other, "--check"]).status == 0, (style, other)
    assert files_of(song) == before


@pytest.mark.parametrize("written", [*ALL.split(","), ALL, "measure,rows,edit --into-file"])
def test_strip_alone_takes_every_style_out(song: Path, written: str) -> None:
    before = files_of(song)
    assert Said([song, "--style", *written.split()]).status == 0
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
    assert Said([song, "--strip", "--style", "smeditor"]).status == 2, "who names a style wants to know"


def test_what_is_not_written_would_change(song: Path) -> None:
    assert Said([song, "--check"]).out.splitlines()[-1] == "2 files: 2 would change"
    assert Said([song, "--dry-run"]).out.splitlines()[-1] == "2 files: 2 would change"
    assert Said([song, "--diff"]).err.splitlines()[-1] == "2 files: 2 would change"
    assert Said([song]).out.splitlines()[-1] == "2 files: 2 changed"
    assert Said([song, "--check"]).out.splitlines()[-1] == "2 files: 2 unchanged"


def test_check_says_where_and_why(song: Path, ssc: Path) -> None:
    said = Said([ssc, "--check"])
    assert said.status == 1
    line = ssc.read_bytes().split(b"\n").index(b",  // measure 1") + 1
    assert f"two_left_feet.ssc:{line}: dance-single Beginner 1: 20 measures have no feet yet" in said.out
    Said([ssc])
    text = ssc.read_bytes()
    at = text.index(b"{dt1 ")
    ssc.write_bytes(text[:at] + text[at:].replace(b"{dt1 LR}", b"{dt1 RL}", 1).replace(b"{dt1 LRL", b"{dt1 LR", 1))
    said = Said([ssc, "--check"])
    assert said.status == 1
    assert "has feet other than the solver finds" in said.out
    assert "has feet that do not fit their rows any more" in said.out


def test_diff_is_plain_in_a_pipe_and_coloured_on_a_terminal(song: Path, ssc: Path) -> None:
    before = files_of(song)
    plain = Said([ssc, "--diff"]).out
    assert "\x1b" not in plain
    assert "-,  // measure 1\n" in plain
    assert "+,  // measure 1 {dt1 LR}\n" in plain
    coloured = Said([ssc, "--diff"], color=True).out
    assert "\x1b[32m+,  // measure 1 {dt1 LR}\x1b[0m\n" in coloured
    assert "\x1b[31m-,  // measure 1\x1b[0m\n" in coloured
    assert files_of(song) == before
    assert Said([ssc, "--diff", "--check"]).status == 1


@pytest.mark.skipif(shutil.which("patch") is None, reason="the program patch is not here")
def test_the_diff_can_be_applied_with_patch(song: Path, ssc: Path, tmp_path: Path) -> None:
    """The diff is right in every line number, also where a chart is added at the end."""
    import subprocess

    options = [ssc, "--style", "measure,edit", "--into-file"]
    diff = Said([*options, "--diff"]).out
    subprocess.run(["patch", "-s", ssc], input=diff.encode(), check=True, cwd=tmp_path)
    patched = ssc.read_bytes()
    shutil.copy(SONG / ssc.name, ssc)
    Said(options)
    assert ssc.read_bytes() == patched


def test_output_folder(song: Path, tmp_path: Path) -> None:
    before, out = files_of(song), tmp_path / "out"
    assert Said([song.parent, "-o", out, "--style", ALL]).status == 0
    assert files_of(song) == before
    made = files_of(out)
    assert Said([song.parent, "-o", out, "--style", ALL]).status == 0
    assert files_of(out) == made
    Said([song, "--style", ALL])
    assert files_of(song) == files_of(out / "song")
    Said([song, "-o", song.parent / "." / "song"])  # in place after all
    assert b"{dt1 " in (song / "two_left_feet.sm").read_bytes()
    with pytest.raises(UsageError, match="both become"):
        raise Said([song / "two_left_feet.ssc", out / "song" / "two_left_feet.ssc", "-o", tmp_path / "x"]).error  # type: ignore[misc]


def test_worker_processes_do_the_same(song: Path, tmp_path: Path) -> None:
    for number in range(4):
        shutil.copytree(song, song.parent / f"copy {number}")
    Said([song.parent, "-o", tmp_path / "one", "--jobs", 1, "--style", ALL])
    said = Said([song.parent, "-o", tmp_path / "two", "--jobs", 2, "--style", ALL])
    assert files_of(tmp_path / "one") == files_of(tmp_path / "two")
    order = [line.split(": ")[0] for line in said.out.splitlines() if line.startswith("annotated")]
    assert order == sorted(order)
    assert len(order) == 10


def test_backups_keep_every_old_version(song: Path, ssc: Path) -> None:
    original = ssc.read_bytes()
    Said([ssc, "--backup"])
    marked = ssc.read_bytes()
    Said([ssc, "--backup"])  # nothing changes, nothing is kept
    assert sorted(files_of(song)) == ["two_left_feet.sm", "two_left_feet.ssc", "two_left_feet.ssc.bak"]
    Said([ssc, "--strip", "--backup"])
    assert (song / "two_left_feet.ssc.bak").read_bytes() == original
    assert (song / "two_left_feet.ssc.bak2").read_bytes() == marked
    Said([ssc, "--backup"])
    assert not (song / "two_left_feet.ssc.bak3").exists()  # the first copy has the same bytes


def test_only_the_charts_that_are_meant(ssc: Path) -> None:
    original = ssc.read_bytes()
    Said([ssc, "--difficulty", "hard", "--steps-type", "dance-single"])
    some = ssc.read_bytes()
    assert 0 < some.count(b"{dt1 ") <= 22
    Said([ssc])
    assert ssc.read_bytes().count(b"{dt1 ") > 90
    Said([ssc, "--difficulty", "easy", "--strip"])
    assert Said([ssc, "--difficulty", "hard", "--check"]).status == 0
    assert Said([ssc, "--difficulty", "easy", "--check"]).status == 1
    Said([ssc, "--strip"])
    assert ssc.read_bytes() == original
    said = Said([ssc, "--difficulty", "edit"])
    assert isinstance(said.error, UsageError)
    assert "dance-single Hard 8" in str(said.error)


def test_another_preset_changes_the_feet_in_place(ssc: Path) -> None:
    preset = ssc.parent / "free.yaml"
    preset.write_text("extends: thesis\nweights: {doublestep: 0, crossover: 1000}\n")
    Said([ssc])
    thesis = ssc.read_bytes()
    said = Said([ssc, "--preset", preset])
    other = ssc.read_bytes()
    assert other != thesis
    assert "other feet" in said.out
    assert other.count(b"{dt1 ") == thesis.count(b"{dt1 ")
    Said([ssc])
    assert ssc.read_bytes() == thesis


def test_the_preset_of_the_configuration_holds(ssc: Path) -> None:
    (ssc.parent / "free.yaml").write_text("extends: thesis\nweights: {doublestep: 0, crossover: 1000}\n")
    Said([ssc, "--preset", ssc.parent / "free.yaml"])
    wanted = ssc.read_bytes()
    (ssc.parent.parent / "dancetutor.yaml").write_text("preset: song/free.yaml\n")
    Said([ssc, "--strip"])
    Said([ssc])
    assert ssc.read_bytes() == wanted
    assert Said([ssc, "--preset", "thesis", "--check"]).status == 1


def test_pinned_feet_stay_and_guide_the_solver(ssc: Path) -> None:
    Said([ssc, "--preset", "thesis", "--index", 0])
    marked = ssc.read_bytes()
    pinned = marked.replace(b"measure 1 {dt1 LR}", b"measure 1 {dt1! RL}", 1)
    assert pinned != marked
    ssc.write_bytes(pinned)
    said = Said([ssc, "--preset", "thesis", "--index", 0])
    assert said.status == 0
    assert "1 pinned, left alone" in said.out
    after = ssc.read_bytes()
    assert b"{dt1! RL}" in after
    assert after != pinned, "the feet around a pinned measure must follow it"
    assert Said([ssc, "--preset", "thesis", "--index", 0, "--check"]).status == 0
    assert "would be stripped:" in (said := Said([ssc, "--strip", "--dry-run"])).out
    assert "1 file: 1 would change" in said.out
    kept = "two_left_feet.ssc: 1 pinned measure left alone; --force takes it out"
    assert f"stripped {ssc}".removesuffix(ssc.name) + kept in Said([ssc, "--strip"]).out
    assert ssc.read_bytes().count(b"{dt1") == 1
    assert kept in Said([ssc, "--strip"]).out, "the second time nothing changes, and the pin is still there"
    assert "left alone" not in Said([ssc, "--strip", "--force"]).out
    assert ssc.read_bytes() == (SONG / ssc.name).read_bytes()


def test_a_pin_that_does_not_fit_is_told_with_line_and_column(ssc: Path) -> None:
    Said([ssc, "--index", 0])
    text = ssc.read_bytes().replace(b"measure 1 {dt1 LR}", b"measure 1 {dt1! LRR}", 1)
    ssc.write_bytes(text)
    line = text[: text.index(b"{dt1!")].count(b"\n") + 1
    column = len(b",  // measure 1 {dt1! LR") + 1
    said = Said([ssc, "--index", 0])
    assert said.status == 0
    assert f"two_left_feet.ssc:{line}:{column}: pinned measure 1: 3 tokens for 2 rows with steps" in said.err
    said = Said([ssc, "--index", 0, "--check"])
    assert said.status == 1
    assert f":{line}:{column}: pinned measure 1" in said.out


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--style", "tattoo"], "there is no style 'tattoo'; there are measure, rows"),
        (["--style", ""], "name one or more"),
        (["--into-file"], "--style edit"),
        (["--preset", "gpt"], "thesis"),
    ],
)
def test_wrong_options_are_told(ssc: Path, arguments: list[str], word: str) -> None:
    before = files_of(ssc.parent)
    said = Said([ssc, *arguments])
    assert isinstance(said.error, UsageError)
    assert word in str(said.error)
    assert files_of(ssc.parent) == before


def test_a_bad_file_in_a_folder_does_not_stop_the_others(song: Path, hostile: Path) -> None:
    shutil.copy(hostile / "random_bytes.sm", song / "noise.sm")
    said = Said([song])
    assert said.status == 2
    assert said.err.count("noise.sm") == 1
    assert "3 files: 2 changed, 1 failed" in said.out


def test_read_only_files_are_told_and_nothing_is_lost(song: Path, ssc: Path) -> None:
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
    from dancetutor_cli.jobs import annotate

    write = annotate.write_atomic
    edited = ssc.read_bytes() + b"// saved by an editor\n"

    def meanwhile(path: Path, data: bytes, *, expect: bytes | None = None) -> None:
        ssc.write_bytes(edited)
        write(path, data, expect=expect)

    monkeypatch.setattr(annotate, "write_atomic", meanwhile)
    said = Said([ssc])
    assert said.status == 2
    assert "changed by somebody else" in said.err
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


def test_a_full_disk_is_told(ssc: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from dancetutor_cli import files

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


def test_strip_needs_no_solver(ssc: Path) -> None:
    """Taking markers out starts quickly: numba is not imported."""
    import subprocess

    code = (
        "import sys; from dancetutor_cli.commands.annotate import command\n"
        "command(sys.argv[1:], standalone_mode=False)\nsys.exit('numba' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code, ssc, "--strip"], cwd=ssc.parent).returncode == 0


def test_data_sme_is_input_and_keeps_what_a_person_said(ssc: Path) -> None:
    """Overrides of SMEditor force feet; those that we wrote ourselves do not."""
    data = ssc.parent / "data.sme"
    theirs = {
        "version": 1,
        "mine": [1],
        "parity": {"dance-single": [{"overrides": [[4, 0, "Right"]], "ignores": {"6": ["DS"]}}]},
    }
    data.write_text(json.dumps(theirs, indent=2))
    before = data.read_bytes()
    Said([ssc, "--index", 0, "--style", "measure,smeditor"])
    assert b"measure 1 {dt1 R" in ssc.read_bytes()
    merged = json.loads(data.read_bytes())
    assert list(merged)[:3] == ["version", "mine", "parity"]
    assert merged["parity"]["dance-single"][0]["overrides"][0] == [4, 0, "Right"]
    assert len(merged["parity"]["dance-single"][0]["overrides"]) > 20
    assert merged["parity"]["dance-single"][0]["ignores"] == {"6": ["DS"]}
    once = data.read_bytes()
    Said([ssc, "--index", 0, "--style", "measure,smeditor"])
    assert data.read_bytes() == once
    Said([ssc, "--style", "smeditor", "--strip"])
    assert data.read_bytes() == before
