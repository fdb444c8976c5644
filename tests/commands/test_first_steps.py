"""The first five minutes: what `dancetutor` alone says, a console that is not UTF-8, the Tab key."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from annotating import SONG
from click.testing import CliRunner

from dancetutor_cli.commands import COMMANDS, cli
from dancetutor_cli.commands.completion import SHELLS, place_for, script_for
from dancetutor_cli.commands.first_run import first_steps
from dancetutor_cli.run.errors import FileError, UsageError


def run(*arguments: object, **environment: str) -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, "-m", "dancetutor_cli", *map(str, arguments)]
    return subprocess.run(command, env={**os.environ, **environment}, capture_output=True, check=False)


def test_alone_it_says_what_to_try_with_a_song_that_is_there(tmp_path: Path) -> None:
    assert "with the demo song" in first_steps(tmp_path)
    folder = tmp_path / "mein Lied"
    folder.mkdir()
    (folder / "a b.sm").touch()
    assert "with your song" in first_steps(tmp_path) and "a b.sm" in first_steps(tmp_path)
    (folder / "a b.ssc").touch()
    assert "a b.ssc" in first_steps(tmp_path)
    (tmp_path / "._x.ssc").touch()
    (tmp_path / "y.sm").touch()
    assert "dancetutor analyze y.sm" in first_steps(tmp_path)
    assert "with the demo song" in first_steps(tmp_path / "not there")


def test_every_line_of_it_is_a_command_that_exists() -> None:
    said = CliRunner().invoke(cli, [])
    assert said.exit_code == 0
    tried = [shlex.split(line)[1] for line in said.stdout.splitlines() if line.startswith("  dancetutor ")]
    assert len(tried) == 8 and set(tried) - {"--help"} <= set(COMMANDS)
    assert Path(shlex.split(said.stdout.splitlines()[3])[2]).is_file()


@pytest.mark.parametrize("encoding", ["cp437", "ascii"])
def test_a_console_that_lacks_letters_gets_their_numbers(encoding: str, tmp_path: Path) -> None:
    folder = tmp_path / "♥ Größe"
    shutil.copytree(SONG, folder, ignore=shutil.ignore_patterns("*.ogg"))
    path = folder / "two_left_feet.sm"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("Two Left Feet", "\u7121\u97f3 ♥", 1), encoding="utf-8")
    for arguments in (["annotate", folder, "--check"], ["analyze", folder, "--full"], ["annotate", folder, "--diff"]):
        done = run(*arguments, PYTHONIOENCODING=encoding)
        assert done.returncode in (0, 1), done.stderr
        assert b"internal error" not in done.stderr


@pytest.mark.parametrize(
    ("words", "number", "wanted"),
    [
        ("dancetutor an", 1, {"analyze", "annotate", "animate"}),
        ("dancetutor annotate --str", 2, {"--strip"}),
        ("dancetutor analyze --fix DT20", 3, {"DT201", "DT202", "DT203", "DT207", "DT209"}),
        ("dancetutor render x.ssc --layout b", 4, {"background"}),
        ("dancetutor analyze --steps-type pump-d", 3, {"pump-double"}),
    ],
)
def test_the_tab_key_knows_commands_options_and_names(words: str, number: int, wanted: set[str]) -> None:
    done = run(_DANCETUTOR_COMPLETE="bash_complete", COMP_WORDS=words, COMP_CWORD=str(number))
    assert {line.split(",", 1)[1] for line in done.stdout.decode().splitlines()} == wanted


def test_powershell_gets_the_words() -> None:
    done = run(_DANCETUTOR_COMPLETE="powershell_complete", COMP_WORDS="dancetutor\nannotate\n--str", COMP_CWORD="--str")
    kind, value, text = done.stdout.decode().rstrip("\r\n").split("\t")
    assert (kind, value) == ("plain", "--strip") and text.startswith("Remove the markers")
    done = run(_DANCETUTOR_COMPLETE="powershell_complete", COMP_WORDS="dancetutor", COMP_CWORD="")
    assert [line.split("\t")[1] for line in done.stdout.decode().splitlines()] == list(COMMANDS)


@pytest.mark.parametrize("shell", SHELLS)
def test_one_command_sets_it_up_and_one_takes_it_out(
    shell: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("XDG_DATA_HOME", "XDG_CONFIG_HOME", "ZDOTDIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    place, alone = place_for(shell)
    assert place.is_relative_to(tmp_path)
    before = "" if alone else "alias ll='ls -l'"  # without a line end
    if before:
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(before)
    for word in ("written", "is up to date"):
        said = CliRunner().invoke(cli, ["completion", shell], catch_exceptions=False)
        assert said.exit_code == 0 and word in said.output
    assert script_for(shell).strip() in place.read_text() and place.read_text().startswith(before)
    CliRunner().invoke(cli, ["completion", shell, "--remove"], catch_exceptions=False)
    assert (place.read_text().rstrip("\n") == before) if before else not place.exists()
    assert CliRunner().invoke(cli, ["completion", shell, "--print"]).output == script_for(shell)


@pytest.mark.skipif(os.name == "nt", reason="there it is PowerShell")
def test_an_unknown_shell_and_a_closed_home_are_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SHELL", "/bin/tcsh")
    said = CliRunner().invoke(cli, ["completion"])
    assert isinstance(said.exception, UsageError) and "name one: bash, zsh, fish, powershell" in str(said.exception)
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "file"))
    monkeypatch.setenv("SHELL", "/usr/bin/fish")
    said = CliRunner().invoke(cli, ["completion"])
    assert isinstance(said.exception, FileError) and "--print prints the script" in str(said.exception)


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash here")
def test_bash_takes_the_script(tmp_path: Path) -> None:
    (tmp_path / "script").write_text(script_for("bash"))
    asked = ["bash", "-c", ". ./script; complete -p dancetutor"]
    done = subprocess.run(asked, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "_dancetutor_completion" in done.stdout, done.stderr
