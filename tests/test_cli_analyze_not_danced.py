"""`analyze`, `annotate` and files that are not danced: music of a menu, lights of a cabinet."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from dancetutor_cli.commands.analyze import command
from dancetutor_cli.run.errors import UsageError

MENU = "#TITLE:Menu;\n#MUSIC:menu.ogg;\n#OFFSET:0;\n#BPMS:0=120;\n"
WALK = "1000\n0100\n0010\n0001\n"
CHART = "#NOTES:dance-single:C:Hard:1::\n" + WALK + ";\n"
HEAD = "#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n"
LIGHTS = "#NOTES:lights-cabinet:C:Easy:1::\n10000001\n0x00003\n00300000\n00000001\n;\n"


def run(*arguments: object) -> Result:
    return CliRunner().invoke(command, [str(one) for one in arguments], standalone_mode=False)


@pytest.mark.parametrize("suffix", ["sm", "ssc"])
def test_music_without_notes_is_no_error(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"menu.{suffix}"
    path.write_text(MENU)
    result = run(path, "--no-cache", "--full")
    assert (result.exception, result.return_value) == (None, 0)
    assert "no charts: the file has no NOTES: nothing to dance" in result.output


def test_music_without_notes_does_not_fail_a_pack(tmp_path: Path) -> None:
    (tmp_path / "menu.ssc").write_text(MENU)
    (tmp_path / "walk.sm").write_text(HEAD + CHART)
    result = run(tmp_path, "--no-cache", "--ignore", "DT5,DT107")
    assert (result.exception, result.return_value) == (None, 0)
    found = json.loads(run(tmp_path, "--no-cache", "--format", "json").output)["files"]
    assert [(len(file["charts"]), file["error"]) for file in found] == [(0, None), (1, None)]


def test_annotate_passes_it_by(tmp_path: Path) -> None:
    from dancetutor_cli.commands.annotate import command as annotate

    (tmp_path / "menu.ssc").write_text(MENU)
    (tmp_path / "walk.sm").write_text(HEAD + CHART)
    result = CliRunner().invoke(annotate, [str(tmp_path)], standalone_mode=False)
    assert (result.exception, result.return_value) == (None, 0)
    assert (tmp_path / "menu.ssc").read_text() == MENU and "{dt1" in (tmp_path / "walk.sm").read_text()
    assert "menu.ssc:1: no charts" in result.output


@pytest.mark.parametrize(
    "text",
    ["", "no tags at all", HEAD + "#NOTES:dance-single:C:Hard:9:;\n", "#SOMETHING:else;"],
    ids=["empty", "noise", "a chart cut short", "no song"],
)
def test_what_cannot_be_read_still_is_an_error(tmp_path: Path, text: str) -> None:
    path = tmp_path / "x.sm"
    path.write_text(text)
    assert run(path, "--no-cache").return_value == 2


def test_a_selection_that_fits_no_chart_still_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "x.sm"
    path.write_text(HEAD + CHART)
    assert isinstance(run(path, "--no-cache", "--difficulty", "Easy").exception, UsageError)


def test_lights_are_not_linted(tmp_path: Path) -> None:
    path = tmp_path / "x.sm"
    path.write_text(HEAD + CHART + LIGHTS)
    (file,) = json.loads(run(path, "--no-cache", "--format", "json").output)["files"]
    lights = next(chart for chart in file["charts"] if chart["steps_type"] == "lights-cabinet")
    assert lights["findings"] == [] and not any("lights" in one for one in file["warnings"])


def test_the_same_rows_on_a_pad_are(tmp_path: Path) -> None:
    path = tmp_path / "x.sm"
    path.write_text(HEAD + LIGHTS.replace("lights-cabinet", "dance-single"))
    (file,) = json.loads(run(path, "--no-cache", "--format", "json").output)["files"]
    assert "DT102" in [one["rule"] for one in file["charts"][0]["findings"]]
