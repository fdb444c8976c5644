"""`make gallery`: what is there and still true is not made again, and the index names every piece."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="module")
def gallery() -> ModuleType:
    spec = importlib.util.spec_from_file_location("gallery", ROOT / "tools" / "gallery.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["gallery"] = module
    spec.loader.exec_module(module)
    return module


def test_it_shows_what_is_asked_for(gallery: ModuleType) -> None:
    every = list(gallery.pieces())
    own = [one for one in every if not one.needs]
    assert len(own) >= 10 and len({one.file for one in every}) == len(every)
    said = " ".join(word for one in own for step in one.steps for word in step)
    for word in (
        "--layout",
        "--style",
        "couple.sm",
        "pump.sm",
        "retarget",
        "--sheet",
        "page",
        "--language",
        "--index 5",
    ):
        assert word in said
    films = [step for one in own for step in one.steps if step[0] == "render" and "--index" in step]
    assert len({step[step.index("--index") + 1] for step in films}) >= 4  # of charts


def test_a_piece_that_is_still_true_is_not_made_again(gallery: ModuleType, tmp_path: Path) -> None:
    sheet = next(one for one in gallery.pieces() if one.file == "sheet.html")
    assert gallery.made(tmp_path, sheet) is True
    when = (tmp_path / "sheet.html").stat().st_mtime_ns
    assert gallery.made(tmp_path, sheet) is False
    assert (tmp_path / "sheet.html").stat().st_mtime_ns == when
    other = gallery.Piece(sheet.file, sheet.title, (tuple("4" if one == "3" else one for one in sheet.steps[0]),))
    assert gallery.made(tmp_path, other) is True
    assert "Challenge 11" in (tmp_path / "sheet.html").read_text("utf-8")


def test_the_index_names_every_piece_and_loads_nothing_from_elsewhere(gallery: ModuleType, tmp_path: Path) -> None:
    every = list(gallery.pieces())
    gallery.write_index(tmp_path, every)
    for page, folder in ((tmp_path / "index.html", ""), (tmp_path / "gallery.md", "gallery/")):
        text = page.read_text("utf-8")
        assert all(f'"{folder}{one.file}"' in text for one in every) and "://" not in text
