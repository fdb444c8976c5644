"""The key of a film: it changes with every field of the request and with every file that says whose foot it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.chart.pack_files import places_of_feet
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.film.choices import parse_ahead
from dancetutor_cli.film.clock import Practice
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.media.encoder import Encoding
from dancetutor_cli.film.scroll import parse_scroll
from dancetutor_cli.film.work.request import FilmRequest, film_key, look_up
from dancetutor_cli.lint import configuration
from dancetutor_cli.lint.analysis import AnalyzeTask
from dancetutor_cli.lint.results import ResultCache
from dancetutor_cli.lint.run import LintRequest, LintRun

ENCODING = Encoding("mp4", (64, 64), 12)
CHARTS = "".join(
    f"#NOTES:\n dance-single:\n :\n {name}:\n 8:\n :{{}}\n1000\n0001\n1000\n0001\n;\n" for name in ("Easy", "Hard")
)
SONG = "#TITLE:x;\n#BPMS:0=120;\n" + CHARTS
SETTINGS = "feet:\n  - when: {{path: 'song/*'}}\n    steps: {{0: {}}}\n"


@pytest.fixture
def song(tmp_path: Path) -> Path:
    path = tmp_path / "pack" / "song" / "song.sm"
    path.parent.mkdir(parents=True)
    path.write_text(SONG.format("", ""))
    return path


def request_of(song: Path) -> FilmRequest:
    return FilmRequest(DanceRequest(song, Selection(index=0)), FilmLook(load_layout("highway"), (64, 64)), fps=12)


def key(request: FilmRequest) -> str:
    return film_key(request, look_up(request), ENCODING)


def other_values(song: Path) -> dict[str, list[Any]]:
    """For each field of a request values other than `request_of` has."""
    folder = song.parent.parent.parent
    other = folder / "other.sm"
    other.write_text(SONG.format("//{dt1! RLRL}", ""))
    (folder / "play.json").write_text("{}")
    (folder / "font.ttf").write_bytes(b"letters")
    (folder / "base.yaml").write_text("extends: itg\nroll-window: 0.25\n")
    (folder / "mine.yaml").write_text("extends: base.yaml\n")
    (folder / "strut.yaml").write_text("slow: {}")
    (folder / "motion.yaml").write_text("jump: {far: 0.5}")
    (folder / "sway.yaml").write_text("limits: false")
    (folder / "her.glb").write_bytes(b"a character")
    (folder / "her.npz").write_bytes(b"a motion")
    request = request_of(song)
    looks = {
        "layout": load_layout("vertical"),
        "size": (96, 64),
        "quality": "draft",
        "renderer": "cpu",
        "camera": "front",
        "scroll": parse_scroll("C500"),
        "down": True,
        "font": folder / "font.ttf",
        "ahead": parse_ahead("b2"),
        "findings": True,
        "language": "de",
    }
    practices = {"loop": 2, "count_in": 4, "rest": 1.5, "claps": True, "metronome": True}
    dances = {
        "path": [other],
        "selection": [Selection(index=1)],
        "preset": ["thesis", str(folder / "mine.yaml")],
        "play": [folder / "play.json"],
        "rates": [(0.5,), (0.5, 1.0)],
        "fps": [30.0],
        "bar": [True],
        "gait": ["heels", str(folder / "strut.yaml")],
        "form": ["edge", str(folder / "strut.yaml")],
        "motion": [folder / "motion.yaml"],
        "style": ["neutral", str(folder / "sway.yaml")],
        "push": [("1:300:left",)],
        "trip": [(1.0,)],
    }
    for kind, others in ((FilmLook, looks), (Practice, practices), (DanceRequest, dances)):
        assert set(others) == {f.name for f in fields(kind)}, "a field that this test does not know"
    return {
        "dance": [replace(request.dance, **{name: one}) for name, some in dances.items() for one in some],
        "look": [replace(request.look, **{name: value}) for name, value in looks.items()],
        "fps": [24],
        "section": ["0:1"],
        "sync": [0.009],
        "mute": [True],
        "practice": [replace(Practice(), **{name: value}) for name, value in practices.items()],
        "character": ["mannequin", str(folder / "her.glb")],
        "background": [True],
        "motions": [(folder / "her.npz",)],
    }


def test_without_settings_no_rules_are_read(song: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(configuration, "load_configuration", lambda *_, **__: pytest.fail("the rules are read"))
    key(request_of(song))
    (song.parent / "dancetutor.yaml").write_text("rules: {spin: error}\n")
    with pytest.raises(pytest.fail.Exception, match="rules are read"):
        key(request_of(song))


def test_every_field_of_a_request_counts(song: Path) -> None:
    request, others = request_of(song), other_values(song)
    assert set(others) == {f.name for f in fields(FilmRequest)}, "a field of the request that this test does not know"
    keys = [key(request)]
    keys += [key(replace(request, **{name: value})) for name, values in others.items() for value in values]
    assert len(set(keys)) == len(keys)
    assert key(request) == keys[0]


def test_files_count_by_their_content(song: Path) -> None:
    others, folder = other_values(song), song.parent.parent.parent
    request = request_of(song)
    request = replace(
        request,
        dance=replace(request.dance, play=folder / "play.json", preset=str(folder / "mine.yaml")),
        look=replace(request.look, font=folder / "font.ttf"),
        character=others["character"][1],
        motions=(folder / "her.npz",),
    )
    keys = [key(request)]
    for name, text in (
        ("play.json", "{ }"), ("font.ttf", "other"), ("base.yaml", "extends: itg\nroll-window: 0.3\n"),
        ("her.glb", "x"), ("her.npz", "another motion"),
    ):  # fmt: skip
        (folder / name).write_text(text)
        keys.append(key(request))
    assert len(set(keys)) == len(keys)


def _analysis(song: Path) -> str:
    task: AnalyzeTask = LintRun(LintRequest()).task(song)
    found = ResultCache(song.parent.parent.parent / "cache").key(task)
    assert found is not None
    return found


@pytest.mark.parametrize("key_of", [lambda song: key(request_of(song)), _analysis], ids=["film", "analysis"])
def test_every_source_of_feet_counts(song: Path, key_of: Callable[[Path], str]) -> None:
    pack = song.parent.parent
    changes = {
        "pinned measures": (song, SONG.format("//{dt1! RLRL}", "")),
        "data.sme": (song.parent / "data.sme", '{"parity": {"dance-single": [{"overrides": [[0, 0, "Right"]]}]}}'),
        "a second song, for which data.sme is not": (song.parent / "second.sm", SONG.format("", "")),
        "dancetutor.yaml above": (pack / "dancetutor.yaml", SETTINGS.format("R")),
        "dancetutor.yaml changed": (pack / "dancetutor.yaml", SETTINGS.format("L")),
        "dancetutor.yaml beside it": (song.parent / "dancetutor.yaml", "rules: {spin: error}\n"),
    }
    keys = {"nothing": key_of(song)}
    for name, (path, text) in changes.items():
        assert path.name == "second.sm" or path in set(places_of_feet(song))
        path.write_text(text)
        keys[name] = key_of(song)
    assert len(set(keys.values())) == len(keys), keys
    assert key_of(song) == list(keys.values())[-1]


def test_what_is_called_out_counts(song: Path) -> None:
    settings, base = song.parent / "dancetutor.yaml", song.parent / "base.yaml"
    base.write_text("rules: {spin: error}\n")
    settings.write_text("extends: base.yaml\n")
    before = key(request_of(song))
    base.write_text("rules: {spin: off}\n")
    assert key(request_of(song)) != before
