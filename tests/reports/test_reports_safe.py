"""What is printed of other people's text can not steer a terminal."""

from __future__ import annotations

import os

import pytest

from dancetutor_cli.run.foreign_text import safe, safe_path


@pytest.mark.parametrize(
    ("given", "printed"),
    [
        ("plain", "plain"),
        ("\x1b[2Jboo\x07", "[2Jboo"),
        ("a\r\nb", "a b"),
        ("x\x9b31my", "x 31my"),
        ("right\u202eleft", "right left"),
        ("half \ud800 character", "half ? character"),
        ("[bold]stays[/bold]", "[bold]stays[/bold]"),
        ("다람쥐 ♪", "다람쥐 ♪"),
    ],
)
def test_safe(given: str, printed: str) -> None:
    assert safe(given) == printed


@pytest.mark.skipif(os.name == "nt", reason="paths are text on Windows")
def test_a_path_that_is_no_utf8_can_be_printed() -> None:
    path = safe_path(os.fsdecode(b"song\xff\n.sm"))
    assert path == "song\ufffd?.sm"
    path.encode("utf-8")


def test_a_name_out_of_a_cache_may_have_letters_that_names_here_have_not(monkeypatch: pytest.MonkeyPatch) -> None:
    def ascii_only(path: str) -> bytes:
        return path.encode("ascii", "surrogateescape")

    monkeypatch.setattr(os, "fsencode", ascii_only)
    assert safe_path("e\u0301.sm") == "e\u0301.sm"
