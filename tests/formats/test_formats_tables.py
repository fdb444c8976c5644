"""The tables of formats: what they list is what the options take, and every entry writes a file that can be read."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from dancetutor_cli.character.mesh import Character
from dancetutor_cli.commands.analyze import command as analyze
from dancetutor_cli.commands.animate import command as animate
from dancetutor_cli.commands.render import command as render
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.film.media import encoder
from dancetutor_cli.formats import writers
from dancetutor_cli.reports import analyze_formats as reports
from dancetutor_cli.run.reading import charts_path

DEMO = str(charts_path() / "two_left_feet" / "two_left_feet.ssc")
BEGINS = {".glb": b"glTF", ".npz": b"PK", ".bvh": b"HIERARCHY", ".json": b"{"}


@pytest.mark.parametrize("suffix", [*writers.FORMATS, writers.MOVES])
def test_each_suffix_of_animate_is_written(suffix: str, tmp_path: Path) -> None:
    target = tmp_path / f"x{suffix}"
    run = CliRunner().invoke(animate, [DEMO, "--index", "0", "--section", "m4:m5", "-o", str(target)])
    assert run.exit_code == 0, run.output
    assert target.read_bytes().startswith(BEGINS.get(suffix, b""))
    assert run.stdout.startswith(f"{target}: ") and run.stdout.endswith(", dance-single Beginner 1\n")


def test_a_format_that_is_added_to_the_table_is_a_format(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def write(path: Path, character: Character, motion: Motion) -> str:
        path.write_text(json.dumps(len(motion.times)))
        return "the number of keys"

    monkeypatch.setitem(writers.FORMATS, ".keys", write)
    target = tmp_path / "x.keys"
    run = CliRunner().invoke(animate, [DEMO, "--index", "0", "--section", "m4:m5", "-o", str(target)])
    assert run.exit_code == 0 and "x.keys: the number of keys, dance-single" in run.stdout
    assert json.loads(target.read_text()) > 30


@pytest.mark.parametrize(("command", "name"), [(animate, "x.xyz"), (render, "x.xyz")])
def test_another_suffix_is_refused_with_those_that_there_are(command: object, name: str, tmp_path: Path) -> None:
    run = CliRunner().invoke(command, [DEMO, "--index", "0", "-o", str(tmp_path / name)])  # type: ignore[arg-type]
    known = (*writers.FORMATS, writers.MOVES) if command is animate else encoder.FILES
    assert run.exit_code == 2 or run.exception
    said = run.output + str(run.exception)
    assert all(suffix in said for suffix in known)


@pytest.mark.parametrize("name", reports.FORMATS)
def test_each_format_of_analyze_says_something(name: str) -> None:
    run = CliRunner().invoke(analyze, [DEMO, "--format", name, "--no-cache", "--select", "DT201"])
    assert run.exit_code in (0, 1), run.output
    assert run.stdout.strip()


def test_the_help_lists_the_formats() -> None:
    for command, table in ((animate, writers.FORMATS), (analyze, reports.FORMATS)):
        text = CliRunner().invoke(command, ["--help"]).output
        assert all(name in text for name in table)
    text = CliRunner().invoke(render, ["--help"]).output
    assert all(suffix in text for suffix in encoder.FILES)
