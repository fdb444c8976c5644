"""What a path means: files, folders, pairs, music, and which chart is meant."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.music import music_file
from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import Selection, find_files, twin
from dancetutor_cli.run.errors import FileError, UsageError

NOTES = "#NOTES:{}:d:{}:{}:0:\n1000\n;"


def song(
    folder: Path, music: str = "", charts: tuple[tuple[str, str, int], ...] = (("dance-single", "Hard", 9),)
) -> Song:
    text = f"#MUSIC:{music};#BPMS:0=120;" + "".join(NOTES.format(*c) for c in charts)
    path = folder / "x.sm"
    path.write_bytes(text.encode())
    return load(path)


def touch(folder: Path, *names: str) -> None:
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"")


def test_folders_are_searched_in_order_and_nothing_comes_twice(tmp_path: Path) -> None:
    touch(tmp_path, "b/x.SM", "b/x.ssc", "b/x.sm.old", "a/y.ssc", "a/._y.ssc", "a/y.txt", "z.sm")
    relative = [p.relative_to(tmp_path).as_posix() for p in find_files([tmp_path, tmp_path / "b" / "x.ssc"])]
    assert relative == ["z.sm", "a/y.ssc", "b/x.SM", "b/x.ssc"]
    assert find_files([tmp_path / "b" / "x.ssc", tmp_path / "b" / ".." / "b"])[0] == tmp_path / "b" / "x.ssc"
    assert len(find_files([tmp_path / "b", tmp_path / "b" / ".." / "b"])) == 2


def test_what_cannot_be_looked_into_stands_for_itself(tmp_path: Path) -> None:
    touch(tmp_path, "a/y.ssc", "empty/readme.txt")
    found = find_files([tmp_path / "missing.sm", tmp_path / "a", tmp_path / "empty"])
    assert found == [tmp_path / "missing.sm", tmp_path / "a" / "y.ssc", tmp_path / "empty"]
    for path in (found[0], found[2]):
        with pytest.raises(FileError, match=r"no such file|no \.sm, \.ssc or \.ucs"):
            load(path)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read every folder")
def test_a_closed_folder_does_not_stop_the_others(tmp_path: Path) -> None:
    touch(tmp_path, "a/y.ssc", "closed/x.sm")
    (tmp_path / "closed").chmod(0)
    assert find_files([tmp_path]) == [tmp_path / "a" / "y.ssc", tmp_path / "closed"]
    (tmp_path / "closed").chmod(0o700)


def test_links_that_go_round_end(tmp_path: Path) -> None:
    touch(tmp_path, "a/y.ssc")
    try:
        (tmp_path / "a" / "loop").symlink_to(tmp_path, target_is_directory=True)
    except OSError:
        pytest.skip("no symbolic links here")
    assert find_files([tmp_path]) == [tmp_path / "a" / "y.ssc"]


def test_twins(tmp_path: Path) -> None:
    touch(tmp_path, "x.sm", "x.ssc", "y.sm")
    assert twin(tmp_path / "x.sm") == tmp_path / "x.ssc"
    assert twin(tmp_path / "x.ssc") == tmp_path / "x.sm"
    assert twin(tmp_path / "y.sm") is None


def test_music_is_found_in_any_case_and_in_folders_below(tmp_path: Path) -> None:
    touch(tmp_path, "Song.OGG", "sub/Other.mp3")
    assert music_file(song(tmp_path, "song.ogg")).name == "Song.OGG"
    assert music_file(song(tmp_path, "SUB\\\\other.MP3")).name == "Other.mp3"
    assert music_file(song(tmp_path, "./Song.OGG")).name == "Song.OGG"


def test_without_a_name_the_only_audio_file_is_the_music(tmp_path: Path) -> None:
    touch(tmp_path, "a.flac", "b.png")
    assert music_file(song(tmp_path)).name == "a.flac"
    touch(tmp_path, "c.wav")
    with pytest.raises(FileError, match="2 audio files"):
        music_file(song(tmp_path))


def test_a_chart_may_have_music_of_its_own(tmp_path: Path) -> None:
    touch(tmp_path, "a.ogg", "b.ogg")
    text = b"#VERSION:0.83;#MUSIC:a.ogg;#BPMS:0=120;#NOTEDATA:;#STEPSTYPE:dance-single;#MUSIC:b.ogg;#NOTES:\n1000\n;"
    (tmp_path / "y.ssc").write_bytes(text)
    both = load(tmp_path / "y.ssc")
    assert music_file(both).name == "a.ogg"
    assert music_file(both, both.charts[0]).name == "b.ogg"


@pytest.mark.parametrize(
    "name",
    ["../a.ogg", "sub/../../a.ogg", "/etc/a.ogg", "\\\\\\\\host\\\\share\\\\a.ogg", "C\\:\\\\a.ogg",
     "http\\:\\/\\/x/a.ogg", "-i.ogg", "~/a.ogg", "concat\\:a.ogg|b.ogg", "a.txt", "missing.ogg"],
)  # fmt: skip
def test_names_that_lead_elsewhere_are_refused(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "song"
    touch(tmp_path, "a.ogg", "song/a.txt", "song/sub/b.ogg")
    with pytest.raises(FileError) as caught:
        music_file(song(folder, name))
    assert "\n" not in str(caught.value)


def test_a_link_out_of_the_folder_is_refused(tmp_path: Path) -> None:
    touch(tmp_path, "a.ogg", "song/keep.txt")
    try:
        (tmp_path / "song" / "b.ogg").symlink_to(tmp_path / "a.ogg")
    except OSError:
        pytest.skip("no symbolic links here")
    with pytest.raises(FileError, match="link"):
        music_file(song(tmp_path / "song", "b.ogg"))
    with pytest.raises(FileError, match="link"):
        music_file(song(tmp_path / "song"))


def test_selection(tmp_path: Path) -> None:
    found = song(
        tmp_path,
        charts=(
            ("dance-single", "Easy", 3),
            ("dance-single", "Hard", 9),
            ("dance-single", "Hard", 10),
            ("dance-double", "Hard", 8),
        ),
    )

    def picked(*values: str | int | None) -> list[int]:
        return [chart.index for chart in Selection(*values).charts(found)]  # type: ignore[arg-type]

    assert picked() == [0, 1, 2, 3]
    assert picked("DANCE-Single") == [0, 1, 2]
    assert picked(None, "hard, EASY") == [0, 1, 2, 3]
    assert picked("dance-double", "Heavy") == [3]
    assert picked(None, None, 2) == [2]
    assert picked("pump-single") == []
    assert Selection("dance-double").only_chart(found).index == 3
    with pytest.raises(UsageError, match=r"--index N: 1: dance-single Hard 9, 2: dance-single Hard 10"):
        Selection("dance-single", "hard").only_chart(found)
    with pytest.raises(UsageError, match="choose one with --index N: 0: dance-single Easy 3"):
        Selection("pump-single").only_chart(found)
    with pytest.raises(UsageError, match="Beginner, Easy, Medium, Hard, Challenge, Edit"):
        Selection(None, "insane").charts(found)


def test_a_folder_of_one_song_stands_for_its_file(tmp_path: Path) -> None:
    from dancetutor_cli.chart.selection import one_song

    song = tmp_path / "pack" / "song"
    song.mkdir(parents=True)
    assert one_song(song) == song  # nothing in it
    (song / "a.sm").write_text("")
    assert one_song(song) == song / "a.sm" == one_song(song / "a.sm")
    (song / "a.ssc").write_text("")
    assert one_song(tmp_path) == song / "a.ssc"
    (song / "b.sm").write_text("")
    assert one_song(song) == song


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such files")
def test_special_files_of_a_searched_folder_are_a_line_each(tmp_path: Path) -> None:
    """A link to itself aborted the run, a named pipe hung it, a link to /dev/zero ate the memory."""
    notes = "#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n1000\n0001\n;\n"
    (tmp_path / "good.sm").write_text(notes)
    os.mkfifo(tmp_path / "pipe.sm")
    os.mkfifo(tmp_path / "good.ssc")
    os.mkfifo(tmp_path / "data.sme")
    for name, to in (("self.sm", "self.sm"), ("zero.sm", "/dev/zero"), ("gone.ssc", "nowhere"), ("b.png", "b.png")):
        (tmp_path / name).symlink_to(to)
    for arguments in (["analyze", "--jobs", "1"], ["annotate", "--check"]):
        ran = subprocess.run(
            [sys.executable, "-m", "dancetutor_cli", *arguments, str(tmp_path)],
            capture_output=True, text=True, timeout=60, env={**os.environ, "DANCETUTOR_CACHE": str(tmp_path / "cache")},
        )  # fmt: skip
        lines = [line for line in ran.stderr.splitlines() if line.startswith("dancetutor:")]
        assert ran.returncode == 2 and len(lines) == 5, ran.stderr
        assert sum("named pipe" in line for line in lines) == 2
        assert "good.sm" in ran.stdout
