"""The demo song in a folder of its own, to be annotated."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from annotating import SONG


@pytest.fixture
def song(tmp_path: Path) -> Path:
    """A folder with the demo song as .sm and .ssc."""
    folder = tmp_path / "pack" / "song"
    folder.mkdir(parents=True)
    for name in ("two_left_feet.sm", "two_left_feet.ssc"):
        shutil.copy(SONG / name, folder / name)
    return folder


@pytest.fixture
def ssc(song: Path) -> Path:
    return song / "two_left_feet.ssc"
