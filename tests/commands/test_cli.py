"""The installed command as a user drives it: help, bad input, exit statuses; every failure is one clear line."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import pytest

from dancetutor_cli.commands import COMMANDS

ROOT = Path(__file__).resolve().parent.parent.parent
DANCETUTOR = Path(sys.executable).with_name("dancetutor.exe" if os.name == "nt" else "dancetutor")
SONG = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
WORKERS = ("analyze", "annotate", "animate", "render")


def run(arguments: Sequence[object], cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [str(DANCETUTOR), *(str(a) for a in arguments)]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=240, stdin=subprocess.DEVNULL)


def assert_one_clear_line(result: subprocess.CompletedProcess[str], *words: str) -> None:
    """Exit status 2 and one line on standard error that has the words in it."""
    assert result.returncode == 2, result.stdout + result.stderr
    assert "Traceback" not in result.stderr + result.stdout
    (line,) = result.stderr.splitlines()
    for word in words:
        assert word.lower() in line.lower(), line


def test_a_section_that_is_none_is_reported_before_the_file_is_looked_at(tmp_path: Path) -> None:
    for name, output in (("animate", "x.npz"), ("render", "x.mp4")):
        result = run([name, SONG, "--section", "m1", "-o", tmp_path / output], tmp_path)  # several charts match, too
        assert_one_clear_line(result, "--section m1 cannot be read")


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["analyze", "--formt"], "there is no option --formt (did you mean --format?); see dancetutor analyze --help"),
        (["analyze"], "PATH is missing; see dancetutor analyze --help"),
        (["analyze", ".", "--preset"], "--preset needs a value"),
        (["analyze", ".", "--no-cache=3"], "--no-cache takes no value"),
        (["render", ".", "--size", "12"], "--size 12: write width x height, such as 1280x720"),
        (["render", ".", "--renderer", "gpu"], "--renderer gpu: choose auto, cpu or gl"),
        (["completion", "tcsh"], "shell tcsh: choose bash, zsh, fish or powershell"),
        (["analyze", ".", "--tech-counts", "nope"], "--tech-counts nope: no such file or folder"),
        (["analyze", "-"], "standard input: nothing was read; send a chart to it"),
        (["animate", "a", "b", "-o", "c"], "got unexpected extra argument (b); see dancetutor animate --help"),
    ],
)
def test_a_wrong_command_line_is_one_line(arguments: list[str], line: str, tmp_path: Path) -> None:
    result = run(arguments, tmp_path)
    assert (result.returncode, result.stderr, result.stdout) == (2, f"dancetutor: {line}\n", "")


def files_of(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_help_names_every_command(tmp_path: Path) -> None:
    result = run(["--help"], tmp_path)
    assert result.returncode == 0
    assert all(name in result.stdout for name in COMMANDS)


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_help_of_each_command(name: str, tmp_path: Path) -> None:
    result = run([name, "--help"], tmp_path)
    assert result.returncode == 0
    assert result.stdout.startswith(f"Usage: dancetutor {name}")


@pytest.mark.parametrize("arguments", [["--help"], *([name, "--help"] for name in sorted(COMMANDS))])
def test_help_imports_nothing_heavy(arguments: list[str], tmp_path: Path) -> None:
    code = (
        "import sys\nfrom dancetutor_cli.__main__ import main\n"
        "try:\n    main(sys.argv[1:])\nexcept SystemExit:\n    pass\n"
        "heavy = {'numba', 'OpenGL', 'pyrender', 'scipy', 'imageio'} & set(sys.modules)\n"
        "sys.exit(f'imports {heavy}' if heavy else 0)\n"
    )
    result = subprocess.run([sys.executable, "-c", code, *arguments], cwd=tmp_path, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr


def test_an_unknown_command_is_refused(tmp_path: Path) -> None:
    assert_one_clear_line(run(["analyse", SONG], tmp_path), "analyse")


@pytest.mark.parametrize("name", WORKERS)
class TestBadInput:
    def test_missing_file(self, name: str, tmp_path: Path) -> None:
        assert_one_clear_line(run([name, "nowhere.ssc"], tmp_path), "nowhere.ssc")
        assert files_of(tmp_path) == {}

    def test_no_such_difficulty(self, name: str, tmp_path: Path) -> None:
        song = shutil.copytree(SONG.parent, tmp_path / "song") / SONG.name
        before = files_of(tmp_path)
        assert_one_clear_line(
            run([name, song, "--steps-type", "dance-double", "--difficulty", "easy"], tmp_path), "hard"
        )
        assert files_of(tmp_path) == before

    def test_unreadable_chart(self, name: str, tmp_path: Path, hostile: Path) -> None:
        shutil.copy(hostile / "random_bytes.sm", tmp_path / "noise.sm")
        before = files_of(tmp_path)
        assert_one_clear_line(run([name, "noise.sm"], tmp_path), "noise.sm")
        assert files_of(tmp_path) == before

    def test_unknown_option(self, name: str, tmp_path: Path) -> None:
        assert_one_clear_line(run([name, SONG, "--colour-of-shoes", "red"], tmp_path), "--colour-of-shoes")

    def test_unknown_preset(self, name: str, tmp_path: Path) -> None:
        copy = shutil.copytree(SONG.parent, tmp_path / "song") / SONG.name
        chart = (copy, "--steps-type", "dance-single", "--difficulty", "easy")
        assert_one_clear_line(run([name, *chart, "--preset", "gpt"], tmp_path), "gpt", "thesis")


@pytest.mark.parametrize(("name", "suffix"), [("animate", "npz"), ("animate", "glb"), ("render", "mp4")])
class TestBadOutput:
    CHART = (SONG, "--steps-type", "dance-single", "--difficulty", "beginner", "--section", "m1:m2")

    def test_folder_that_is_not_there(self, name: str, suffix: str, tmp_path: Path) -> None:
        result = run([name, *self.CHART, "-o", tmp_path / "no" / "such" / f"out.{suffix}"], tmp_path)
        assert_one_clear_line(result, "such")

    def test_a_folder_in_place_of_the_file(self, name: str, suffix: str, tmp_path: Path) -> None:
        (tmp_path / f"out.{suffix}").mkdir()
        assert_one_clear_line(run([name, *self.CHART, "-o", tmp_path / f"out.{suffix}"], tmp_path), f"out.{suffix}")
        assert files_of(tmp_path) == {}

    def test_a_section_outside_the_song(self, name: str, suffix: str, tmp_path: Path) -> None:
        chart = [*self.CHART[:-1], "m900:m901"]
        assert_one_clear_line(run([name, *chart, "-o", f"out.{suffix}"], tmp_path), "section")
        assert files_of(tmp_path) == {}


def hears_ctrl_c() -> None:
    """A shell starts what runs in its background deaf to Ctrl-C, and these tests with it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.skipif(os.name == "nt", reason="sends SIGINT to one process, which Windows cannot")
def test_ctrl_c_ends_a_render_and_leaves_nothing(tmp_path: Path) -> None:
    command = [str(DANCETUTOR), "render", str(SONG), "--steps-type", "dance-single", "--difficulty", "hard"]
    process = subprocess.Popen(
        [*command, "-o", str(tmp_path / "out.mp4")], cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL,
        text=True, start_new_session=True, preexec_fn=hears_ctrl_c,
    )  # fmt: skip
    time.sleep(6)  # somewhere between start and end; the song takes longer than this to render
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=20)
    assert process.returncode == 130, errors
    assert "Traceback" not in errors
    assert "interrupted" in errors
    assert files_of(tmp_path) == {}


@pytest.mark.skipif(os.name == "nt", reason="needs a pipe that nobody reads")
@pytest.mark.parametrize(
    "arguments",
    [
        ["--help"],
        ["doctor"],
        ["analyze", "--explain", "all"],
        ["analyze", "--format", "json", SONG],
        ["analyze", SONG],
        ["annotate", "--diff", SONG],
    ],
    ids=lambda arguments: " ".join(map(str, arguments[:2])),
)
def test_a_reader_that_leaves_early_is_no_error_and_no_finding(arguments: list[object], tmp_path: Path) -> None:
    read, write = os.pipe()
    os.close(read)
    command = [str(DANCETUTOR), *map(str, arguments)]
    try:
        result = subprocess.run(command, cwd=tmp_path, stdout=write, stderr=subprocess.PIPE, text=True, timeout=240)
    finally:
        os.close(write)
    assert (result.returncode, result.stderr) == (141, "")
