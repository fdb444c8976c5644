"""Where results go, the same for every command: asked before the work, folders are made, files want theirs."""

from __future__ import annotations

import errno
import os
import shutil
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.__main__ import main
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.files import check_file, check_folder, make_folder
from dancetutor_cli.run.reading import charts_path

FILM = ("--size", "64x64", "--layout", "highway", "--fps", "10", "--jobs", "1", "--mute", "--section", "4:5")
ONE = ("--index", "3")


@pytest.fixture
def demo(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "work" / "song"
    folder.mkdir(parents=True)
    shutil.copy(charts_path() / "two_left_feet" / "two_left_feet.ssc", folder / "song.ssc")
    monkeypatch.chdir(tmp_path / "work")
    return Path("song/song.ssc")


def run(*arguments: object) -> int:
    with pytest.raises(SystemExit) as stop:
        main([str(a) for a in arguments])
    assert isinstance(stop.value.code, int)
    return stop.value.code


@pytest.mark.parametrize(
    ("command", "option", "name"),
    [
        ("animate", "-o", "none/dance.glb"),
        ("animate", "--plot", "none/dance.svg"),
        ("animate", "--report", "none/report.json"),
        ("render", "-o", "none/film.mp4"),
        ("render", "--poster", "none/film.png"),
        ("analyze", "--sheet", "none/sheet.html"),
        ("analyze", "--update-baseline --baseline", "none/known.json"),
    ],
)
def test_a_file_wants_its_folder_before_the_work(
    demo: Path, capsys: pytest.CaptureFixture[str], command: str, option: str, name: str
) -> None:
    assert run(command, demo, *ONE, *option.split(), name) == 2
    said = capsys.readouterr()
    assert said.out == "", "the work was done, and then there was no place for it"
    lines = [line for line in said.err.splitlines() if line.startswith("dancetutor:")]
    assert lines == [f"dancetutor: {Path(name)}: its folder 'none' does not exist; make it first"]
    assert sorted(p.name for p in Path().rglob("*")) == ["song", "song.ssc"]


def test_a_sheet_of_another_kind_is_refused_before_the_work(demo: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("analyze", demo, "--sheet", "sheet.pdf") == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err == "dancetutor: sheet.pdf: the name must end in .html, .htm or .svg\n"
    shutil.copy(demo, demo.with_name("other.ssc"))
    assert run("analyze", demo.parent, "--sheet", "sheet.html") == 2
    assert capsys.readouterr().out == ""


@pytest.mark.skipif(os.name == "nt", reason="links need a right there, and there are no such devices")
def test_a_film_is_written_through_a_link_and_takes_no_devices_place(
    demo: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("films").mkdir()
    Path("films/old.mp4").write_bytes(b"old")
    Path("film.mp4").symlink_to("films/old.mp4")
    assert run("render", demo, *ONE, *FILM, "-o", "film.mp4") == 0
    assert Path("film.mp4").is_symlink() and Path("films/old.mp4").stat().st_size > 1000
    assert [path.name for path in Path("films").iterdir()] == ["old.mp4"]
    Path("null.mp4").symlink_to("/dev/null")
    Path("gone.mp4").symlink_to("nothing.mp4")
    Path("films/old.mp4").chmod(0o444)
    capsys.readouterr()
    whys = {"null": "is not a regular file", "gone": "is a link to a file that is not there", "film": "is read-only"}
    for name, why in whys.items():
        assert run("render", demo, *ONE, *FILM, "-o", f"{name}.mp4") == 2
        assert f"dancetutor: {name}.mp4: {why}" in capsys.readouterr().err.splitlines()[-1]
        assert Path(f"{name}.mp4").is_symlink()


@pytest.mark.parametrize("players", [1, 2])
def test_a_pages_own_name_that_is_taken_is_reported_before_the_work(
    demo: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, players: int
) -> None:
    def bake(*_: object) -> None:
        raise AssertionError("the work was begun, and there is no place for it")

    monkeypatch.setattr("dancetutor_cli.page.work.perform", bake)
    name = "two_left_feet-dance-single_hard_8.html"
    if players == 2:
        demo, name = Path("two.sm"), "two-dance-couple_hard_9.html"
        demo.write_text("#TITLE:Two;\n#BPMS:0=120;\n#NOTES:dance-couple::Hard:9::\n10000001\n01000010\n;\n")
    Path(name).mkdir()
    assert run("page", demo, *(ONE if players == 1 else ())) == 2
    assert capsys.readouterr().err.splitlines()[-1] == f"dancetutor: {name}: is a folder; give a file name"


@pytest.mark.parametrize(
    ("command", "option"), [("render", "--poster"), ("render", "--results"), ("animate", "--report")]
)
def test_nothing_is_written_over_a_chart(
    demo: Path, capsys: pytest.CaptureFixture[str], command: str, option: str
) -> None:
    before = demo.read_bytes()
    path = demo.parent if option == "--results" else demo
    assert run(command, path, *ONE, option, demo) == 2
    said = capsys.readouterr()
    assert (
        said.err.splitlines()[-1]
        == f"dancetutor: {demo}: is the name of a chart, which would be overwritten; give another name"
    )
    assert demo.read_bytes() == before


@pytest.mark.parametrize(
    ("command", "option", "name", "why"),
    [
        ("render", "--poster", "own.edit", "is the name of a chart, which would be overwritten; give another name"),
        ("animate", "--report", "own.edit", "is the name of a chart, which would be overwritten; give another name"),
        ("render", "--results", "own.edit", "is the name of a chart, which would be overwritten; give another name"),
        ("render", "--poster", "m.ogg", "the name must end in .png"),
        ("animate", "--report", "m.ogg", "the name must end in .json"),
        ("render", "--results", "m.ogg", "the name must end in .jsonl or .json"),
    ],
)
def test_nor_over_an_edit_or_music(
    demo: Path, capsys: pytest.CaptureFixture[str], command: str, option: str, name: str, why: str
) -> None:
    taken = demo.parent / name
    taken.write_bytes(b"somebody's")
    assert run(command, demo.parent if option == "--results" else demo, *ONE, option, taken) == 2
    assert capsys.readouterr().err.splitlines()[-1] == f"dancetutor: {taken}: {why}"
    assert taken.read_bytes() == b"somebody's"


@pytest.mark.skipif(not Path(os.devnull).is_char_device(), reason="the null device has no path here")
def test_what_is_beside_a_result_may_go_to_a_device() -> None:
    check_file(Path(os.devnull), (".json",), or_device=True)
    with pytest.raises(UsageError, match=r"must end in \.html"):
        check_file(Path(os.devnull), (".html",))


def test_folders_are_made_with_those_above(demo: Path) -> None:
    assert run("annotate", demo, *ONE, "-o", "a/b/marked") == 0
    assert b"{dt1 " in Path("a/b/marked/song.ssc").read_bytes()
    assert run("render", demo, *ONE, *FILM, "--frames", "a/c/frames") == 0
    assert len(list(Path("a/c/frames").glob("*.png"))) == 32
    assert run("render", demo, *ONE, *FILM, "--poses", "a/d/poses") == 0
    assert Path("a/d/poses/poses.json").is_file()
    assert run("render", demo.parent, *ONE, *FILM, "-o", "a/e/videos") == 0
    assert len(list(Path("a/e/videos").glob("*.mp4"))) == 1


@pytest.mark.parametrize(
    ("command", "option"), [("annotate", "-o"), ("render", "--frames"), ("render", "--poses"), ("render", "-o")]
)
def test_a_file_in_the_place_of_a_folder_is_reported(
    demo: Path, capsys: pytest.CaptureFixture[str], command: str, option: str
) -> None:
    Path("taken").write_text("mine")
    path = demo.parent if option == "-o" else demo
    assert run(command, path, *ONE, option, "taken/below") == 2
    assert "'taken' is a file, not a folder" in capsys.readouterr().err
    assert Path("taken").read_text() == "mine"


def test_the_rule_itself(tmp_path: Path) -> None:
    check_file(tmp_path / "new.html", (".html",))
    check_folder(tmp_path / "a" / "b")
    assert list(tmp_path.iterdir()) == []
    make_folder(tmp_path / "a" / "b")
    make_folder(tmp_path / "a" / "b")
    with pytest.raises(FileError, match="is a folder; give a file name"):
        check_file(tmp_path / "a")
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="is a file; give a folder"):
        make_folder(tmp_path / "file")


def test_a_batch_says_which_songs_have_no_such_chart(demo: Path, capsys: pytest.CaptureFixture[str]) -> None:
    other = Path("song2/song2.ssc")
    other.parent.mkdir()
    other.write_bytes(demo.read_bytes().replace(b"#DIFFICULTY:Hard;", b"#DIFFICULTY:Edit;"))
    options = ("--difficulty", "hard", "--steps-type", "dance-single", *FILM, "-o", "videos")
    assert run("render", Path(), *options) == 0
    assert capsys.readouterr().err.splitlines()[-1] == "1 done, 1 song has no such chart"
    assert run("render", Path(), *options, "--shard", "2/2") in (0, 2)
    assert "no such chart" not in capsys.readouterr().err


@pytest.mark.parametrize("command", ["render", "page"])
def test_menu_music_fails_no_folder(demo: Path, capsys: pytest.CaptureFixture[str], command: str) -> None:
    """The music of a menu has a file without notes; annotate and analyze pass it by, too."""
    song = "#TITLE:T;\n#BPMS:0=120;\n#MUSIC:a.ogg;\n"
    demo.write_text(song + "#NOTES:dance-single::Hard:9::\n1000\n0100\n0010\n0001\n;\n")
    demo.rename(demo.with_suffix(".sm"))
    (demo.parent / "menu.sm").write_text(song)
    more = ("--size", "64x64", "--layout", "highway", "--fps", "5", "--jobs", "1") if command == "render" else ()
    assert run(command, Path("song"), "-o", "out", *more) == 0
    said = capsys.readouterr()
    assert "Failed" not in said.err and "[1/1]" in said.out + said.err
    demo.with_suffix(".sm").unlink()
    assert run(command, Path("song"), "-o", "out", *more) == 2
    assert "no chart" in capsys.readouterr().err.splitlines()[-1]


@pytest.fixture
def closed(demo: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder that nobody may write into; simulated, as root may write everywhere."""
    folder = Path("ro")
    folder.mkdir()
    real = os.access

    def access(path: Any, mode: int, **options: Any) -> bool:
        return not (Path(path).name == "ro" and mode & os.W_OK) and real(path, mode, **options)

    monkeypatch.setattr(os, "access", access)
    return folder


@pytest.mark.parametrize(
    ("command", "option", "name"),
    [
        ("animate", "-o", "ro/dance.glb"),
        ("page", "-o", "ro/page.html"),
        ("render", "-o", "ro/film.mp4"),
        ("analyze", "--sheet", "ro/sheet.html"),
        ("analyze", "--report-html", "ro/pack.html"),
        ("analyze", "--update-baseline --baseline", "ro/known.json"),
    ],
)
@pytest.mark.usefixtures("closed")
def test_a_folder_that_is_closed_is_reported_before_the_work(
    demo: Path, capsys: pytest.CaptureFixture[str], command: str, option: str, name: str
) -> None:
    which = ONE if command != "analyze" else ()
    assert run(command, demo, *which, *option.split(), name) == 2
    said = capsys.readouterr()
    assert said.out == "", "the work was done, and then there was no place for it"
    lines = [line for line in said.err.splitlines() if line.startswith("dancetutor:")]
    assert lines == [f"dancetutor: {Path(name)}: its folder 'ro' cannot be written: {os.strerror(errno.EACCES)}"]


@pytest.mark.parametrize(("command", "option"), [("annotate", "-o"), ("render", "--frames"), ("page", "-o")])
def test_a_folder_that_cannot_be_made_is_the_one_that_is_named(
    demo: Path, closed: Path, capsys: pytest.CaptureFixture[str], command: str, option: str
) -> None:
    path = demo.parent if command == "page" else demo
    assert run(command, path, *(() if command == "page" else ONE), option, closed / "out") == 2
    denied = os.strerror(errno.EACCES)
    assert capsys.readouterr().err.endswith(f"dancetutor: {closed / 'out'}: cannot be used as a folder: {denied}\n")


@pytest.mark.parametrize("command", ["render", "page"])
def test_a_folder_without_charts_is_one_line_and_makes_nothing(
    demo: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    Path("empty").mkdir()
    assert run(command, "empty", "-o", "out") == 2
    said = capsys.readouterr()
    lines = [line for line in said.err.splitlines() if "compil" not in line]
    assert (said.out, lines) == ("", ["dancetutor: empty: no .sm, .ssc or .ucs file in this folder or below it"])
    assert not Path("out").exists()
    (Path("empty") / "bad.sm").write_text("no tags")
    assert run(command, "empty", "-o", "out") == 2
    assert "bad.sm" in capsys.readouterr().err and not Path("out").exists()


def test_a_folder_in_place_of_the_settings_is_reported(demo: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (demo.parent / "dancetutor.yaml").mkdir()
    assert run("analyze", demo) == 2
    assert "dancetutor.yaml: is a folder; it cannot be read as a file" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["analyze", "annotate", "animate", "render", "page"])
def test_an_empty_name_is_not_the_folder_one_stands_in(
    demo: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    """As of a variable of a shell that is not set: `annotate "$SONG"` wrote into every file here and below."""
    before = demo.read_bytes()
    assert run(command, "") == 2
    said = capsys.readouterr()
    assert said.out == "" and "the name is empty" in said.err.splitlines()[-1]
    assert demo.read_bytes() == before
    assert run(command, demo, *ONE, *(("-o", "") if command != "analyze" else ("--sheet", ""))) == 2
    assert "the name is empty" in capsys.readouterr().err.splitlines()[-1]
    assert sorted(path.name for path in Path().rglob("*")) == ["song", "song.ssc"]
