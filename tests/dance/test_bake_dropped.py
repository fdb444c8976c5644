"""A dancer lets go what nobody plays: her contacts, the report and the files say so."""

from __future__ import annotations

from pathlib import Path

import pytest
from bake_plays import plan_of

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.preset import DropReason
from dancetutor_cli.formats.moves_json import moves_data
from dancetutor_cli.formats.npz import read_npz, write_npz
from tests.dance.bake_plays import L, R, chart, pad, play


def trill() -> Play:
    """The left foot holds while the right one would have to leap up and down, 75 ms apart."""
    rows = [(0.0, {0: L}), *((0.6 + 0.075 * k, {(2, 1)[k % 2]: R}) for k in range(5)), (2.0, {3: R})]
    return play(rows, holds={(0, 0): 1.5})


@pytest.fixture(scope="module")
def motion() -> Motion:
    return bake(chart().timing, trill(), pad(), fps=30.0)


def test_only_what_she_plays_is_a_contact(motion: Motion) -> None:
    assert [c.row for c in motion.contacts] == [0, 1, 3, 5, 6]
    assert [(one.row, one.column, one.reason) for one in motion.dropped] == [
        (2, 1, DropReason.LEAP),
        (4, 1, DropReason.LEAP),
    ]
    assert motion.notes[0].startswith("2 notes not played")
    figures = {f.name: f for f in report(motion).figures}
    assert figures["notes not played"].value == 2 and figures["notes not played"].goal is None
    assert figures["contacts"].value == 5 and figures["contacts missed"].value == 0
    assert figures["contact error"].is_met


def test_a_section_reports_only_its_own() -> None:
    one = bake(chart().timing, trill(), pad(), fps=30.0, section=(0.7, 1.9))
    assert [g.row for g in one.dropped] == [4]


def test_files_have_them(motion: Motion, tmp_path: Path) -> None:
    write_npz(tmp_path / "x.npz", motion)
    assert read_npz(tmp_path / "x.npz").dropped == motion.dropped
    data = moves_data(plan_of(chart().timing, trill(), pad()), "T", "c", (-10.0, 10.0))
    assert data["let_go"] == [
        {"second": 0.675, "column": 1, "why": "leap"},
        {"second": 0.825, "column": 1, "why": "leap"},
    ]
