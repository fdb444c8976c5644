"""`animate --physics` and `--style` from the command line: distances, the same bytes, one line for errors."""

from __future__ import annotations

import json
from pathlib import Path

from test_cli_animate import HARD, SONG, animate, said

from dancetutor_cli.formats.npz import read_npz

PART = (SONG, *HARD, "--section", "8:10")


def test_the_report_reports_the_distances_of_every_point_and_draws_them(tmp_path: Path) -> None:
    out, data, plot = tmp_path / "a.npz", tmp_path / "r.json", tmp_path / "r.svg"
    printed = animate(*PART, "-o", out, "--physics", "--report", data, "--plot", plot).output
    assert "Distance of the ragdoll, cm" in printed and "l_talocrural" in printed
    report = json.loads(data.read_text())
    figures = {f["name"]: f for f in report["figures"]}
    for name, goal in (("largest mean", 0.9), ("largest deviation", 0.5), ("farthest", 3.5)):
        figure = figures[f"retargeting, {name}"]
        assert figure["goal"] == goal and figure["met"] and figure["value"] > 0
    hand = report["distances_cm"]["l_hand_tip"]
    assert hand["minimum"] <= hand["mean"] <= hand["maximum"] <= figures["retargeting, farthest"]["value"]
    assert figures["contact error"]["met"] and figures["plant slide"]["met"]
    assert "distance of l_hand_tip, cm" in plot.read_text()


def test_physics_is_style_neutral_with_the_same_bytes_each_time(tmp_path: Path) -> None:
    files = [tmp_path / f"{k}.npz" for k in range(3)]
    for file, how in zip(files, (("--physics",), ("--style", "neutral"), ()), strict=True):
        animate(*PART, "-o", file, *how)
    assert files[0].read_bytes() == files[1].read_bytes() != files[2].read_bytes()
    assert (read_npz(files[0]).times == read_npz(files[2]).times).all()


def test_what_is_wrong_is_reported_in_one_line_and_nothing_is_written(tmp_path: Path) -> None:
    out = tmp_path / "a.npz"
    assert "there is no style 'lazzy'" in said(*PART, "-o", out, "--style", "lazzy")
    wild = tmp_path / "wild.yaml"
    wild.write_text("body: {update_rate: 40}\n")
    line = said(*PART, "-o", out, "--style", wild)
    assert line.startswith("style wild: the simulation fails at ") and ", joint " in line and "\n" not in line
    assert not out.exists()


def test_a_push_is_reported_and_a_wrong_one_refused_before_the_work(tmp_path: Path) -> None:
    out = tmp_path / "a.npz"
    result = animate(*PART, "-o", out, "--push", "9:300:left", "--trip", "9.4")
    assert "warning: pushed at 9.000 s with 300 N: the hips move by " in result.stderr
    assert "foot is caught" in result.stderr and out.exists()
    assert "there is no direction 'up'" in said(*PART, "-o", tmp_path / "b.npz", "--push", "9:300:up")
    assert "give a time within the motion, 8.000 s" in said(*PART, "-o", tmp_path / "b.npz", "--push", "99:300:left")
    assert not (tmp_path / "b.npz").exists()
