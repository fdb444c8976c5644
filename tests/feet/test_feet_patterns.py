"""Made pattern charts of research/feet_patterns.py: their feet keep the rules that they are made by, and the solver
steps those of seeds that no fit has seen as the rules do.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from dancetutor_cli.feet.preset import load_preset

RESEARCH = Path(__file__).parents[2] / "research"
X = (-1, 0, 0, 1)  # of left, down, up, right
Row = dict[int, int]  # panel -> foot


@pytest.fixture(scope="module")
def tools() -> Iterator[SimpleNamespace]:
    sys.path.insert(0, str(RESEARCH))
    try:
        import feet_data
        import feet_patterns

        yield SimpleNamespace(data=feet_data, patterns=feet_patterns)
    finally:
        sys.path.remove(str(RESEARCH))


def feet_of(label) -> list[Row]:  # type: ignore[no-untyped-def]
    out: list[Row] = [{} for _ in range(len(label.rows))]
    for row, column, foot in zip(label.row.tolist(), label.column.tolist(), label.foot.tolist(), strict=True):
        out[row][column] = foot
    return out


def stands(rows: list[Row]) -> Iterator[list[int]]:
    """Where left and right foot are after each row."""
    where = [0, 3]
    for row in rows:
        for panel, foot in row.items():
            where[foot] = panel
        yield list(where)


def is_clean(rows: list[Row], where: list[int], first: int) -> bool:
    """Whether single steps by turns from a foot on stay uncrossed, each on a panel on which no foot stands."""
    for number, row in enumerate(rows):
        (panel,) = row
        if panel in where:
            return False
        where = [panel if foot == (first + number) % 2 else where[foot] for foot in range(2)]
        if X[where[1]] < X[where[0]]:
            return False
    return True


def test_one_foot_alone_can_go_on_after_a_jump_or_a_switch(tools: SimpleNamespace) -> None:
    counted = 0
    for label in tools.patterns.load_patterns(range(2000, 2010)):
        rows = feet_of(label)
        if label.name.startswith("after a jump"):
            at = next(n for n, row in enumerate(rows) if len(row) == 2) + 1
        elif label.name.startswith("switch"):
            at = next(n for n in range(1, len(rows)) if set(rows[n]) == set(rows[n - 1])) + 1
        else:
            continue
        (foot,), where = rows[at].values(), list(stands(rows))[at - 1]
        assert is_clean(rows[at:], where, foot) and not is_clean(rows[at:], where, 1 - foot), label.name
        counted += 1
    assert counted == 10 * (2 + 3)


def test_no_foot_steps_while_it_holds_and_only_turns_cross(tools: SimpleNamespace) -> None:
    crossings = 0
    for label in tools.patterns.load_patterns(range(2000, 2010)):
        rows, held = feet_of(label), {}
        for number, row in enumerate(rows):
            tick = int(label.rows.tick[number])
            for panel, foot in row.items():
                assert held.get(foot, -1) < tick, label.name
                if label.rows.hold_end[number, panel] >= 0:
                    held[foot] = int(label.rows.hold_end[number, panel])
        crossed = sum(X[right] < X[left] for left, right in stands(rows))
        assert not crossed or label.name.startswith("turn"), label.name
        crossings += crossed
    assert crossings > 50


def test_feet_of_made_patterns(tools: SimpleNamespace) -> None:
    """97.5 % of the rows of seeds that chose nothing."""
    itg = load_preset("itg")
    right = [tools.data.right_rows(label, itg)[0] for label in tools.patterns.load_patterns(range(5000, 5012))]
    assert np.concatenate(right).mean() >= 0.975
