"""What the tests of films share: records of films of their own, and not those of whoever runs the tests."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def film_records(own_records: Path) -> Path:
    """The folder in which records of films are kept."""
    return own_records
