"""Motions, moves and plays in files: what was written is read, what is wrong is said in one line."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bake_plays import plan_of

from dancetutor_cli.chart.reader import load
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.performance import as_heard
from dancetutor_cli.dance.plan import Press
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.play import prepare_rows
from dancetutor_cli.feet.play_json import read_play
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.formats.moves_json import moves_data, write_moves
from dancetutor_cli.formats.npz import read_npz, write_npz
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import charts_path


@pytest.fixture(scope="module")
def demo():  # type: ignore[no-untyped-def]
    song = load(charts_path() / "two_left_feet" / "two_left_feet.ssc")
    chart = next(c for c in song.charts if c.steps_type == "dance-single" and c.difficulty == "Hard")
    play, pad = solve_chart(chart, load_preset("thesis")), load_pad(chart.steps_type)
    return chart, play, pad


def test_npz_gives_back_the_motion(demo, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    motion = bake(demo[0].timing, *demo[1:], section=(2.0, 6.0))
    write_npz(tmp_path / "a.npz", motion)
    back = read_npz(tmp_path / "a.npz")
    np.testing.assert_array_equal(back.rotations, motion.rotations)
    np.testing.assert_array_equal(back.times, motion.times)
    assert back.contacts == motion.contacts and back.skeleton.names == motion.skeleton.names
    write_npz(tmp_path / "b.npz", motion)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_other_files_are_no_motion(tmp_path: Path) -> None:
    (tmp_path / "a.npz").write_bytes(b"not a zip")
    np.savez(tmp_path / "b.npz", x=np.zeros(3))
    for name, said in (("a", "not an .npz"), ("b", "is missing"), ("none", "no such file")):
        with pytest.raises(FileError, match=said):
            read_npz(tmp_path / f"{name}.npz")


def test_moves_name_every_step_and_join_up(demo, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    plan = plan_of(demo[0].timing, *demo[1:])
    write_moves(tmp_path / "m.json", moves_data(plan, "Two Left Feet", "x", (-1e9, 1e9)))
    data = json.loads((tmp_path / "m.json").read_text(encoding="utf-8"))
    assert len(data["contacts"]) == int((demo[1].limb >= 0).sum())
    for limb in ("left_foot", "right_foot"):
        place, end = data["start"][limb]["at"], -1e9
        for move in (m for m in data["moves"] if m["limb"] == limb):
            assert move["from"] == place and move["start"] >= end - 1e-6 and move["end"] > move["start"]
            place, end = move["to"], move["end"]
    late = moves_data(plan, "", "", (10.0, 20.0))
    assert all(10.0 <= m["start"] <= 20.0 for m in late["moves"])


def test_moves_of_a_section_begin_where_she_stands(demo) -> None:  # type: ignore[no-untyped-def]
    plan = plan_of(demo[0].timing, *demo[1:])
    for begin in (10.0, 17.3, 24.9):
        data = moves_data(plan, "", "", (begin, begin + 8.0))
        for limb in ("left_foot", "right_foot"):
            first = next(m for m in data["moves"] if m["limb"] == limb)
            assert data["start"][limb]["at"] == first["from"]
        turns = moves_data(plan, "", "", (-1e9, 1e9))["turns"]
        assert data["start"]["body"]["yaw"] == [t["yaw"] for t in turns if t["start"] < begin][-1]


def test_hands_reach_from_panel_to_panel(demo) -> None:  # type: ignore[no-untyped-def]
    presses = (
        Press(10.0, 10.1, 1, (0.28, 0.0), lead=0.7),
        Press(10.5, 11.5, 1, (0.0, 0.28), lead=0.4),
        Press(14.0, 14.1, 0, (-0.28, 0.0), lead=0.7),
    )
    data = moves_data(replace(plan_of(demo[0].timing, *demo[1:]), presses=presses), "", "", (-1e9, 1e9))
    moves = [m for m in data["moves"] if m["limb"].endswith("hand")]
    right = [m for m in moves if m["limb"] == "right_hand"]
    assert [m["kind"] for m in right] == ["reach", "press", "reach", "press"]
    assert [(m["start"], m["end"]) for m in right] == [(9.3, 10.0), (10.0, 10.1), (10.1, 10.5), (10.5, 11.5)]
    assert [m.get("from") for m in right] == [None, None, [0.28, 0.0], None]
    assert [m["to"] for m in moves if m["limb"] == "left_hand"] == [[-0.28, 0.0]] * 2


def as_json(chart, play) -> dict:  # type: ignore[no-untyped-def, type-arg]
    """The part of the JSON of analyze that a play needs, written here by hand from the page that describes it."""
    limbs = {0: "left_foot", 1: "right_foot", 2: "left_hand", 3: "right_hand"}
    rows = [
        {
            "beat": tick / 48,
            "steps": [
                {"column": int(c), "limb": limbs.get(int(play.limb[i, c])), "part": None} for c in np.flatnonzero(s)
            ],
            "feet": {k: None if f < 0 else int(f) for k, f in zip(("left", "right"), play.feet[i], strict=True)},
            "facing": float(play.facing[i]),
        }
        for i, (tick, s) in enumerate(zip(play.rows.tick, play.rows.steps, strict=True))
        if s.any()
    ]
    return {"schema": 1, "files": [{"charts": [{"index": chart.index, "steps_type": chart.steps_type, "rows": rows}]}]}


def test_a_play_from_json_dances_the_same(demo, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    chart, play, pad = demo
    path = tmp_path / "play.json"
    path.write_text(json.dumps(as_json(chart, play)), encoding="utf-8")
    back = read_play(path, chart, prepare_rows(chart, pad, 0.35))
    np.testing.assert_array_equal(back.limb, play.limb)
    np.testing.assert_array_equal(back.feet, play.feet)
    section = (24.0, 30.0)  # mines and rolls
    first, second = (bake(chart.timing, p, pad, section=section) for p in (play, back))
    np.testing.assert_array_equal(first.rotations, second.rotations)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda d: d["files"][0]["charts"][0].update(index=99), "holds no chart"),
        (lambda d: d["files"][0]["charts"][0]["rows"].pop(3), "is missing"),
        (lambda d: d["files"][0]["charts"][0]["rows"][0].update(beat=0.01), "no row|is missing"),
        (lambda d: d["files"][0]["charts"][0]["rows"][0]["steps"][0].update(limb="tail"), "there is no limb 'tail'"),
        (lambda d: d["files"][0]["charts"][0]["rows"][0]["feet"].update(left=7), "not a panel"),
        (lambda d: d["files"][0]["charts"][0]["rows"][0].update(facing="north"), "not a number"),
        (lambda d: d.update(schema=2), "schema 2"),
        (lambda d: d.pop("files"), "not the JSON"),
    ],
)
def test_a_play_that_does_not_fit_is_refused(demo, spoil, said: str, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    chart, play, pad = demo
    data = as_json(chart, play)
    spoil(data)
    path = tmp_path / "play.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    with pytest.raises(FileError, match=said):
        read_play(path, chart, prepare_rows(chart, pad, 0.35))


def test_half_speed_keeps_gravity(demo) -> None:  # type: ignore[no-untyped-def]
    from dancetutor_cli.dance.quality.report import report

    chart, play, pad = demo
    slow = chart.timing.at_rate(0.5)
    motion = bake(slow, as_heard(play, slow), pad, section=(10.0, 40.0))
    measured = report(motion)
    assert measured["flights"].value > 0 and measured["flight gravity off by"].is_met
    assert measured["contact error"].is_met and measured["contacts missed"].value == 0
