"""What the tests of jobs share: records of films of their own, and not those of whoever runs the tests."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def own_records(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which records of films are kept."""
    folder = tmp_path_factory.mktemp("cache")
    monkeypatch.setenv("DANCETUTOR_CACHE", str(folder))
    return folder
