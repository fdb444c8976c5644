"""A file may hold thousands of charts: no question about all of them takes time that grows with the square."""

from __future__ import annotations

import time
from types import SimpleNamespace
from typing import Any

from dancetutor_cli.lint.note_facts import _by_key

MANY = 20_000


def test_charts_of_one_difficulty_are_distinguished_at_once() -> None:
    """Two minutes, once: each chart counted up past all before it."""
    charts = [SimpleNamespace(steps_type="dance-single", difficulty="Edit", index=k) for k in range(MANY)]
    song: Any = SimpleNamespace(charts=charts)
    began = time.process_time()
    found = _by_key(song)
    assert time.process_time() - began < 2.0
    assert len(found) == MANY and found["dance-single", "Edit", 7] is charts[7]
