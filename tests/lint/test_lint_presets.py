"""Which preset a chart gets: the same for every command, by --preset, dancetutor.yaml or the steps type."""

from __future__ import annotations

import csv
import io
import json
import pickle
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from dance_requests import film_request, solved_one

from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.commands.analyze import command as analyze
from dancetutor_cli.dance.request import DanceRequest, choice_for, read_chart
from dancetutor_cli.feet.preset import (
    Preset,
    PresetChoice,
    choice_of,
    load_preset,
    mismatch_message,
    preset_for,
    preset_names,
)
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.media.encoder import Encoding
from dancetutor_cli.film.work.batch import BatchRequest, film_list
from dancetutor_cli.film.work.request import look_up
from dancetutor_cli.lint import figures, suggest
from dancetutor_cli.lint.analysis import solve_selected
from dancetutor_cli.lint.results import ResultCache
from dancetutor_cli.lint.run import LintRequest, LintRun
from dancetutor_cli.markers.annotate import AnnotateRequest, Item, _configured, annotate_song
from dancetutor_cli.run.errors import DancetutorError

CHART = "#NOTES:\n {}:\n :\n {}:\n {}:\n :\n{}\n;\n"
DANCE, PUMP = "1000\n0001\n1000\n0001", "10000\n00001\n10000\n00001"
MIXED = "#TITLE:T;\n#BPMS:0=120;\n" + "".join(
    CHART.format(*one)
    for one in (
        ("dance-single", "Easy", 3, DANCE),
        ("dance-single", "Hard", 9, DANCE),
        ("pump-single", "Easy", 3, PUMP),
        ("pump-double", "Hard", 9, "1000000000\n0000000001\n1000000000\n0000000001"),
    )
)
BY_PAD = ["itg", "itg", "pump", "pump"]


@pytest.fixture
def song(tmp_path: Path) -> Path:
    path = tmp_path / "song" / "song.sm"
    path.parent.mkdir()
    path.write_text(MIXED)
    return path


def analyzed(song: Path, given: str | None = None) -> list[str]:
    read = load(song)
    plays = [
        subject.play for subject in solve_selected(read, read.charts, LintRun(LintRequest(preset=given)).task(song))
    ]
    return [play.preset for play in plays if play is not None]


def annotated(song: Path, given: str | None = None) -> list[str]:
    _configured.cache_clear()  # it lives as long as a command
    outcomes = annotate_song([Item(song, song)], AnnotateRequest(("sidecar",), given, Selection()))
    assert [one.error for one in outcomes] == [None]
    data = json.loads(song.with_name("song.dancetutor.json").read_text())
    return [chart["preset"] for chart in data["files"]["song.sm"]["charts"]]


def animated(song: Path, given: str | None = None) -> list[str]:
    plays = [solved_one(song, Selection(index=n), given).play for n in range(4)]
    return [play.preset for play in plays if play is not None]


def filmed(song: Path, given: str | None = None) -> list[str]:
    look = FilmLook(load_layout("highway"), (64, 48))
    wanted = [film_request(song, Selection(index=n), look, mute=True, preset=given) for n in range(4)]
    return [look_up(request).choice.presets[0].name for request in wanted]


EVERYWHERE = pytest.mark.parametrize("found", [analyzed, annotated, animated, filmed])
Found = Callable[..., list[str]]


@EVERYWHERE
def test_each_chart_of_a_mixed_file_gets_its_own(found: Found, song: Path) -> None:
    assert found(song) == BY_PAD


@EVERYWHERE
def test_the_command_line_overrules_all(found: Found, song: Path) -> None:
    (song.parent / "dancetutor.yaml").write_text("preset: thesis\n")
    assert found(song, "stamina") == ["stamina"] * 4


@EVERYWHERE
def test_the_configuration_overrules_the_pads(found: Found, song: Path) -> None:
    (song.parent.parent / "dancetutor.yaml").write_text("preset: thesis\n")
    assert found(song) == ["thesis"] * 4


BY_DIFFICULTY = """\
preset: stamina
overrides:
  - when: {difficulty: Light}
    preset: beginner
  - when: {steps-type: "pump-*", meter: "8-"}
    preset: presets/mine.yaml
  - when: {path: "elsewhere/*"}
    preset: thesis
"""


@EVERYWHERE
def test_the_configuration_goes_by_difficulty_meter_and_pad(found: Found, song: Path) -> None:
    top = song.parent.parent
    (top / "dancetutor.yaml").write_text(BY_DIFFICULTY)
    (top / "presets").mkdir()
    (top / "presets" / "mine.yaml").write_text("extends: pump\nweights: {spin: 7}\n")
    assert found(song) == ["beginner", "stamina", "beginner", "mine"]


@EVERYWHERE
def test_later_entries_and_the_file_that_extends_win(found: Found, song: Path) -> None:
    top = song.parent.parent
    (top / "base.yaml").write_text(BY_DIFFICULTY.replace("presets/mine.yaml", "ddr"))
    (top / "dancetutor.yaml").write_text("extends: base.yaml\noverrides:\n  - {when: {meter: 9}, preset: itg}\n")
    assert found(song) == ["beginner", "itg", "beginner", "itg"]
    (top / "dancetutor.yaml").write_text("extends: base.yaml\npreset: thesis\n")  # of all charts
    assert found(song) == ["thesis"] * 4


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("beginner", ["beginner", "itg", "beginner", "pump"]),
        ("stamina", ["stamina", "stamina", "pump", "pump"]),
        ("contest", BY_PAD),
        ("pack", BY_PAD),
        ("default", BY_PAD),
    ],
)
def test_the_configurations_that_come_along_name_presets(name: str, expected: list[str], song: Path) -> None:
    data = json.loads(run(song, "--format", "json", "--config", name))
    assert [chart["preset"] for chart in data["files"][0]["charts"]] == expected
    (song.parent / "dancetutor.yaml").write_text(f"extends: {name}\n")
    assert [analyzed(song), animated(song), annotated(song), filmed(song)] == [expected] * 4


def test_a_batch_of_films_gives_each_chart_its_own(song: Path) -> None:
    (song.parent.parent / "dancetutor.yaml").write_text(BY_DIFFICULTY.replace("presets/mine.yaml", "ddr"))
    request = film_request(Path(), Selection(), FilmLook(load_layout("highway"), (64, 48)), mute=True)
    batch = BatchRequest((song.parent,), request, Encoding("mp4", (64, 48), 12), song.parent / "films")
    films = film_list(batch).films
    assert [look_up(film.request).choice.presets[0].name for film in films] == [
        "beginner",
        "stamina",
        "beginner",
        "ddr",
    ]


def test_suggestions_and_alternatives_are_of_the_charts_own(song: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (song.parent.parent / "dancetutor.yaml").write_text(BY_DIFFICULTY.replace("presets/mine.yaml", "ddr"))
    used: list[str] = []
    for module, name in ((suggest, "with_suggestions"), (figures, "alternatives_of"), (figures, "causes_of")):
        monkeypatch.setattr(module, name, _noting(used, getattr(module, name)))
    run(song, "--suggest", "--alternatives", 1)
    assert used == [name for name in ("beginner", "stamina", "beginner", "ddr") for _ in range(3)]


def _noting(used: list[str], work: Callable[..., Any]) -> Callable[..., Any]:
    """The same, but the names of the presets that it is called with are noted."""

    def noting(*words: Any) -> Any:
        used.extend(word.name for word in words if isinstance(word, Preset))
        return work(*words)

    return noting


def test_a_preset_for_other_pads_works_and_says_so(song: Path) -> None:
    itg, pump = load_preset("itg"), load_preset("pump")
    assert mismatch_message(itg, "dance-double") is None and mismatch_message(pump, "pump-single") is None
    assert mismatch_message(pump, "dance-single") == "preset 'pump' was made for pump pads, not for dance-single"
    choice = read_chart(DanceRequest(song, Selection(index=0), "pump"))
    assert choice.warnings == ("dance-single Easy 3: preset 'pump' was made for pump pads, not for dance-single",)
    request = film_request(
        song, Selection(index=2), FilmLook(load_layout("highway"), (64, 48)), mute=True, preset="ddr"
    )
    assert look_up(request).warnings == (
        "pump-single Easy 3: preset 'ddr' was made for dance pads, not for pump-single",
    )
    outcomes = annotate_song([Item(song, song)], AnnotateRequest(("measure",), "pump", Selection(), write=False))
    assert len(outcomes[0].notes) == 2 and "dance-single Hard 9: preset 'pump' was made" in outcomes[0].notes[1]


def run(*words: object) -> str:
    result = CliRunner().invoke(analyze, [*map(str, words), "--no-cache", "--exit-zero"], standalone_mode=False)
    assert result.exception is None, result.exception
    return result.stdout


def test_json_says_which_was_used(song: Path) -> None:
    data = json.loads(run(song, "--format", "json"))
    assert data["preset"] == "itg" and data["files"][0]["warnings"] == []
    assert [chart["preset"] for chart in data["files"][0]["charts"]] == BY_PAD
    data = json.loads(run(song, "--format", "json", "--steps-type", "pump-single"))
    assert data["preset"] == "pump"
    data = json.loads(run(song, "--format", "json", "--preset", "pump"))
    assert data["preset"] == "pump" and len(data["files"][0]["warnings"]) == 2


def test_json_without_a_chart_has_a_head(tmp_path: Path) -> None:
    (tmp_path / "x.sm").write_text("no chart at all")
    data = json.loads(run(tmp_path / "x.sm", "--format", "json"))
    assert data["preset"] == "itg" and data["files"][0]["error"]


def test_other_formats_say_which_was_used(song: Path) -> None:
    found = run(song, "--format", "jsonl", "--select", "length,missing-music", "--set", "length.min_seconds=100")
    lines = [json.loads(line) for line in found.splitlines()]
    assert {(line["index"], line["preset"]) for line in lines} == {*enumerate(BY_PAD), (None, None)}
    table = csv.DictReader(io.StringIO(run(song, "--format", "csv")))
    assert [row["preset"] for row in table] == BY_PAD
    text = run(song, "--full")
    assert "\ndance-single Easy 3  preset itg  hash " in text and "\npump-double Hard 9  preset pump  hash " in text
    assert "\ndance-single Easy 3  preset 'pump' was made for pump pads, not for" in run(
        song, "--full", "--preset", "pump"
    )


def test_the_sheet_says_which_was_used(song: Path) -> None:
    page = song.with_name("sheet.html")
    run(song, "--sheet", page)
    assert [page.read_text().count(f", preset {name}") for name in ("itg", "pump")] == [2, 2]


def test_a_lights_chart_has_none(song: Path) -> None:
    song.write_text("#TITLE:T;\n#BPMS:0=120;\n" + CHART.format("kb7-single", "Easy", 3, "1000000\n0000000"))
    chart = json.loads(run(song, "--format", "json"))["files"][0]["charts"][0]
    assert chart["preset"] is None and chart["rows"] == []
    assert "preset" not in run(song)


def test_the_choice_pickles_and_reports_all_in_its_repr(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    reprs = set()
    for spin in (1, 2):
        path.write_text(f"extends: itg\nweights: {{spin: {spin}}}\n")
        choice = choice_of(str(path))
        assert pickle.loads(pickle.dumps(choice)) == choice
        reprs.add(repr(choice))
    assert len(reprs) == 2


def test_a_kept_result_knows_its_preset(song: Path, tmp_path: Path) -> None:
    """Whatever of a preset changes, the result is found anew: its name, its file, the file that it extends."""
    cache, settings = ResultCache(tmp_path / "cache"), song.parent.parent / "dancetutor.yaml"
    mine, base = song.parent.parent / "mine.yaml", song.parent.parent / "base.yaml"
    keys = [cache.key(LintRun(LintRequest(preset=given)).task(song)) for given in (None, "thesis", "pump")]
    base.write_text("extends: itg\n")
    mine.write_text("extends: base.yaml\n")
    settings.write_text("preset: mine.yaml\n")
    keys.append(cache.key(LintRun(LintRequest()).task(song)))
    base.write_text("extends: itg\nweights: {spin: 3}\n")
    keys.append(cache.key(LintRun(LintRequest()).task(song)))
    assert None not in keys and len(set(keys)) == len(keys)


def test_a_wrong_name_is_refused_before_a_chart_is_read(tmp_path: Path) -> None:
    for given in ("gpt", str(tmp_path / "none.yaml")):
        with pytest.raises(DancetutorError, match=r"pump|no such file or folder"):
            choice_for(tmp_path / "nowhere.sm", given)


def test_the_path_of_a_chart_may_be_relative(song: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (song.parent.parent / "dancetutor.yaml").write_text(
        "overrides:\n  - when: {path: 'song/*', difficulty: Hard}\n    preset: stamina\n"
    )
    monkeypatch.chdir(song.parent)
    chart = load(song).charts[1]
    assert preset_for(chart, Path("song.sm"), choice_for(Path("song.sm"), None)).name == "stamina"
    assert preset_for(chart, Path("song.sm"), PresetChoice()).name == "itg"


def test_the_page_about_presets_is_true(song: Path) -> None:
    page = (Path(__file__).resolve().parent.parent.parent / "docs" / "presets.md").read_text("utf-8")
    assert sorted(re.findall(r"^\| `(\w+)` \|", page, re.M)) == preset_names()
    settings, mine, rewritten = re.findall(r"```yaml\n(.*?)```", page, re.S)
    assert "before:" in rewritten, "how a preset of 0.1 is rewritten"
    top = song.parent.parent
    (top / "presets").mkdir()
    (top / "presets" / "mine.yaml").write_text(mine)
    (top / "dancetutor.yaml").write_text(settings)
    assert analyzed(song) == ["beginner", "itg", "mine", "mine"]
