"""`doctor`: one line for each thing, what is missing is named with its mend, and only what is needed is broken."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from dancetutor_cli.__main__ import main
from dancetutor_cli.commands import doctor
from dancetutor_cli.commands.doctor import Check, examine
from dancetutor_cli.film.media import encoder as probe
from dancetutor_cli.film.overlay import text
from dancetutor_cli.film.scene.gl import available as gl_available
from dancetutor_cli.run.errors import UnavailableError

pytestmark = pytest.mark.usefixtures("own_records")


def by_name() -> dict[str, Check]:
    return {check.name: check for check in examine()}


def test_everything_a_film_needs_is_looked_at() -> None:
    found = by_name()
    for name in ("cpu renderer", "ffmpeg", "encoder x264", "encoder aac", "speed change"):
        assert found[name].state == "ok", found[name]
    assert {"gl renderer", "encoder nvenc", "encoder vaapi", "numba cache", "font", "disk"} <= set(found)
    for check in found.values():
        assert "\n" not in check.message + check.remedy
        assert check.state == "ok" or check.remedy, check


def test_a_hardware_encoder_is_tried_and_not_believed(monkeypatch: pytest.MonkeyPatch) -> None:
    tried = []

    def encoder_problem(encoder: str) -> str | None:
        tried.append(encoder)
        return None if encoder in ("libx264", "aac") else "no such device"

    monkeypatch.setattr(probe, "encoder_problem", encoder_problem)
    found = by_name()
    assert {"h264_nvenc", "h264_vaapi"} <= set(tried)
    assert found["encoder nvenc"] == Check(
        "encoder nvenc",
        "without",
        "no such device",
        "an NVIDIA GPU and its driver; x264 needs neither",
    )
    monkeypatch.setattr(probe, "_has_cuda", lambda: True)
    assert probe.choose_encoder("auto") == "x264"
    with pytest.raises(UnavailableError, match="vaapi does not work here: no such device"):
        probe.choose_encoder("vaapi")
    monkeypatch.setattr(probe, "encoder_problem", lambda encoder: None)
    assert probe.choose_encoder("auto") == "nvenc" and probe.choose_encoder("vaapi") == "vaapi"


def test_without_ffmpeg_there_are_no_films(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", "/nowhere/ffmpeg")
    with pytest.raises(SystemExit) as stop:
        main(["doctor", "--json"])
    assert stop.value.code == 2
    checks = {check["name"]: check for check in json.loads(capsys.readouterr().out)["checks"]}
    assert checks["ffmpeg"]["state"] == "broken" and checks["cpu renderer"]["state"] == "ok"
    assert "encoder x264" not in checks


def test_lines_are_short_and_the_repair_is_below(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        probe, "encoder_problem", lambda encoder: None if encoder in ("libx264", "aac") else "no device"
    )
    with pytest.raises(SystemExit) as stop:
        main(["doctor"])
    assert stop.value.code == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    at = lines.index("missing encoder nvenc  no device")
    assert lines[at + 1].startswith(" " * 23 + "to repair: an NVIDIA GPU")
    assert sum(line[0] != " " for line in lines) == len(examine())


def test_no_opengl_is_no_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing() -> None:
        raise UnavailableError("No OpenGL found. Debian/Ubuntu: apt-get install libegl1 libgl1.")

    monkeypatch.setattr(gl_available, "require_gl", missing)
    check = doctor._guarded("gl renderer", doctor._gl)
    assert (check.state, check.message) == ("without", "No OpenGL found") and "apt-get" in check.remedy


def test_fonts_and_disk_say_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text, "system_fonts", lambda: ())
    text._font_of.cache_clear()
    try:
        check = doctor._font()
    finally:
        text._font_of.cache_clear()
    assert check.state == "without" and "Western, Cyrillic, Japanese" in check.message and "--font" in check.remedy
    monkeypatch.setattr(doctor, "_ROOM", 1e30)
    assert doctor._disk().state == "without" and str(Path.cwd()) in doctor._disk().message
