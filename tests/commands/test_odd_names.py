"""Names of 240 bytes, names that are no text, closed streams, endless charts: done, or one clear line."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from dancetutor_cli.commands import cli
from dancetutor_cli.errors import UsageError

SONG = "#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n1000\n0100\n0010\n0001\n;\n"


def run(*arguments: object, **more: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "dancetutor_cli", *map(os.fspath, map(str, arguments))],
        capture_output=True, text=True, errors="surrogateescape", timeout=120, **more,  # type: ignore[call-overload]
    )  # fmt: skip


@pytest.mark.skipif(os.name == "nt", reason="Windows counts names otherwise")
@pytest.mark.parametrize("name", ["x" * 249 + ".sm", "é" * 118 + ".ssc"])
def test_a_long_name_is_annotated_and_stripped(name: str, tmp_path: Path) -> None:
    """It could be annotated, and not stripped: the names of what might lie beside it are too long to look for."""
    path = tmp_path / name
    text = SONG if name.endswith(".sm") else SONG.replace("#NOTES:dance-single:C:Hard:9::\n", _NOTEDATA)
    path.write_text(text)
    assert run("annotate", path).returncode == 0
    assert path.read_text() != text
    stripped = run("annotate", "--strip", path)
    assert (stripped.returncode, stripped.stderr) == (0, "")
    assert path.read_text() == text
    for style in ("sidecar", "edit"):
        said = run("annotate", "--style", style, path)
        if said.returncode:
            assert "too long" in said.stderr and len(said.stderr.splitlines()) == 1
            assert path.read_text() == text
    assert all(entry.suffix != ".tmp" for entry in tmp_path.iterdir())


_NOTEDATA = "#NOTEDATA:;\n#STEPSTYPE:dance-single;\n#DIFFICULTY:Hard;\n#METER:9;\n#NOTES:\n"


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has names that are no text")
def test_a_name_that_is_no_text_has_a_sidecar_and_a_baseline_that_are_read_back(tmp_path: Path) -> None:
    path = tmp_path / "\udcff\udcfesong.sm"
    path.write_text(SONG + "#NOTES:dance-single::Hard:9::\n1000\n;\n")
    for _ in range(2):
        assert run("annotate", "--style", "sidecar", tmp_path).returncode == 0
    assert run("annotate", "--style", "sidecar", "--check", tmp_path).returncode == 0
    (sidecar,) = tmp_path.glob("*.dancetutor.json")
    assert path.name in json.loads(sidecar.read_text("utf-8"))["files"]
    known = tmp_path / "known.json"
    assert run("analyze", tmp_path, "--baseline", known, "--update-baseline").returncode == 0
    assert json.loads(known.read_text("utf-8"))["entries"]
    assert run("analyze", tmp_path, "--baseline", known).returncode == 0


@pytest.mark.skipif(os.name == "nt", reason="no /dev there")
@pytest.mark.parametrize("command", ["--help", "analyze x.sm", "analyze --format json x.sm", "annotate x.sm"])
def test_a_closed_or_full_output_is_one_line(command: str, tmp_path: Path) -> None:
    (tmp_path / "x.sm").write_text(SONG)
    for how, said in ((">&-", "standard output is closed"), (">/dev/full", "No space left")):
        if how == ">/dev/full" and not Path("/dev/full").exists():
            continue
        ran = subprocess.run(
            ["sh", "-c", f"{sys.executable} -m dancetutor_cli {command} {how}"],
            cwd=tmp_path, capture_output=True, text=True, timeout=120,
        )  # fmt: skip
        assert ran.returncode == 2 and said in ran.stderr.splitlines()[-1], ran.stderr
        assert "internal error" not in ran.stderr and "Traceback" not in ran.stderr


def test_hours_of_motion_are_asked_about(tmp_path: Path) -> None:
    path = tmp_path / "long.sm"
    rest = "0000\n0000\n0000\n0000\n,\n" * 800
    path.write_text(SONG.replace("0001\n;", "0001\n,\n" + rest + "1000\n;"))
    ran = CliRunner().invoke(cli, ["animate", str(path), "-o", str(tmp_path / "x.json")])
    assert isinstance(ran.exception, UsageError) and "--yes" in str(ran.exception)
    for more in (["--yes"], ["--section", "m1:m2"]):
        ran = CliRunner().invoke(cli, ["animate", str(path), "-o", str(tmp_path / "x.json"), *more])
        assert ran.exit_code == 0, ran.output
