"""`dancetutor annotate`: what the options do: checks, diffs, folders, processes, charts, presets."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from annotating import ALL, SONG, Said, files_of

from dancetutor_cli.run.errors import UsageError


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
    assert "has other feet than the solver finds" in said.out
    assert "has feet that no longer fit their rows" in said.out


def test_diff_is_plain_in_a_pipe_and_coloured_on_a_terminal(
    song: Path, ssc: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = files_of(song)
    plain = Said([ssc, "--diff"]).out
    assert "\x1b" not in plain
    assert "-,  // measure 1\n" in plain
    assert "+,  // measure 1 {dt1 LR}\n" in plain
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.delenv("NO_COLOR", raising=False)
    coloured = Said([ssc, "--diff"], color=True).out
    assert "\x1b[32m+,  // measure 1 {dt1 LR}\x1b[0m\n" in coloured
    assert "\x1b[31m-,  // measure 1\x1b[0m\n" in coloured
    monkeypatch.setenv("NO_COLOR", "1")
    assert Said([ssc, "--diff"], color=True).out == plain
    assert files_of(song) == before
    assert Said([ssc, "--diff", "--check"]).status == 1


@pytest.mark.skipif(shutil.which("patch") is None, reason="the program patch is not here")
def test_the_diff_can_be_applied_with_patch(song: Path, ssc: Path, tmp_path: Path) -> None:
    """The diff is right in every line number, also where a chart is added at the end."""
    import subprocess

    options = [ssc, "--markers", "measure,edit", "--into-file"]
    diff = Said([*options, "--diff"]).out
    subprocess.run(["patch", "-s", ssc], input=diff.encode(), check=True, cwd=tmp_path)
    patched = ssc.read_bytes()
    shutil.copy(SONG / ssc.name, ssc)
    Said(options)
    assert ssc.read_bytes() == patched


def test_output_folder(song: Path, tmp_path: Path) -> None:
    before, out = files_of(song), tmp_path / "out"
    assert Said([song.parent, "-o", out, "--markers", ALL]).status == 0
    assert files_of(song) == before
    made = files_of(out)
    assert Said([song.parent, "-o", out, "--markers", ALL]).status == 0
    assert files_of(out) == made
    Said([song, "--markers", ALL])
    assert files_of(song) == files_of(out / "song")
    Said([song, "-o", song.parent / "." / "song"])  # in place after all
    assert b"{dt1 " in (song / "two_left_feet.sm").read_bytes()
    with pytest.raises(UsageError, match="both become"):
        raise Said([song / "two_left_feet.ssc", out / "song" / "two_left_feet.ssc", "-o", tmp_path / "x"]).error  # type: ignore[misc]


def test_worker_processes_do_the_same(song: Path, tmp_path: Path) -> None:
    for number in range(4):
        shutil.copytree(song, song.parent / f"copy {number}")
    Said([song.parent, "-o", tmp_path / "one", "--jobs", 1, "--markers", ALL])
    said = Said([song.parent, "-o", tmp_path / "two", "--jobs", 2, "--markers", ALL])
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


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--style", "tattoo"], "there is no kind of markers 'tattoo'; choose measure, rows"),
        (["--style", ""], "name one or more"),
        (["--into-file"], "--markers edit"),
        (["--preset", "gpt"], "thesis"),
    ],
)
def test_wrong_options_are_reported(ssc: Path, arguments: list[str], word: str) -> None:
    before = files_of(ssc.parent)
    said = Said([ssc, *arguments])
    assert isinstance(said.error, UsageError)
    assert word in str(said.error)
    assert files_of(ssc.parent) == before
