"""Sheets of before and after: the earlier commit's own code makes what stands above, today's what stands below."""

from __future__ import annotations

import inspect
import os
import subprocess
import sys
from dataclasses import fields, replace
from pathlib import Path
from types import ModuleType

import module_file
import numpy as np
import pytest
from PIL import Image

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.formats.npz import write_npz
from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"
HIGHER = np.array([0.0, 0.5, 0.0])  # metres
# a command that copies what lies beside it, and tells how it was called
COMMAND = """
import shutil, sys
from pathlib import Path
from PIL import Image
here, words = Path(__file__).parent, sys.argv[1:]
if "99" in words:
    sys.exit("dancetutor: no such chart")
with (here / "calls.txt").open("a") as calls:
    print(*words, file=calls)
if words[0] == "animate":
    shutil.copy(here / "dance.npz", words[-1])
else:
    Path(words[-1]).mkdir()
    for k in range(3 if (here / "colour.txt").read_text() == "red" else 5):
        Image.new("RGB", (40, 30), (here / "colour.txt").read_text()).save(Path(words[-1]) / f"frame_{k}.png")
"""


@pytest.fixture(scope="module")
def sheets() -> ModuleType:
    return module_file.tool("motion_sheet")


@pytest.fixture(scope="module")
def points() -> ModuleType:
    return module_file.tool("before_after")


@pytest.fixture(scope="module")
def danced(sheets: ModuleType) -> Motion:
    motion: Motion = sheets.baked(sheets.Moments(DEMO, (4.0, 4.2)))[0]
    return motion


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, danced: Motion) -> Path:
    """A commit, `then`, that dances half a metre higher and draws in red; the working tree behind it draws in blue."""
    package = tmp_path / "dancetutor_cli"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "__main__.py").write_text(COMMAND)
    (package / "colour.txt").write_text("red")
    write_npz(package / "dance.npz", replace(danced, root=danced.root + HIGHER))
    git(tmp_path, "init", "-q")
    git(tmp_path, "add", ".")
    git(tmp_path, "-c", "user.name=t", "-c", "user.email=t@example.org", "commit", "-q", "-m", "then")
    git(tmp_path, "tag", "then")
    (package / "colour.txt").write_text("blue")
    monkeypatch.setattr(module_file.tool("earlier"), "ROOT", tmp_path)
    return tmp_path


def git(folder: Path, *words: str) -> None:
    subprocess.run(
        ["git", "-C", str(folder), "-c", "commit.gpgsign=false", "-c", "tag.gpgsign=false", *words], check=True
    )


def test_a_commit_stands_above_and_today_below(
    repository: Path, sheets: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    call = ["motion_sheet", str(DEMO), "--at", "4.0:4.2", "--count", "2", "--out", str(tmp_path / "alone.png")]
    monkeypatch.setattr(sys, "argv", call)
    sheets.main()
    alone = np.asarray(Image.open(tmp_path / "alone.png"))
    monkeypatch.setattr(sys, "argv", [*call[:-1], str(tmp_path / "both.png"), "--beside", "then"])
    sheets.main()
    both = np.asarray(Image.open(tmp_path / "both.png"))
    band = sheets.BAND
    assert both.shape == (2 * (alone.shape[0] + band), *alone.shape[1:])
    above, below = (half[band:] for half in np.split(both, 2))
    assert (below == alone).all()
    assert (above != alone).any(axis=2).mean() > 0.1  # she hangs in the air
    (line,) = calls(repository)
    assert line.startswith(f"animate {DEMO} --index 0 --section 2.5:5.7 --yes -o ")


def calls(repository: Path) -> list[str]:
    (folder,) = (repository / "build" / "beside").iterdir()
    return (folder / "dancetutor_cli" / "calls.txt").read_text().splitlines()


def test_what_a_commit_made_is_kept(repository: Path, danced: Motion) -> None:
    earlier = module_file.tool("earlier")
    for _ in range(2):
        motion = earlier.baked_by("then", DEMO, ["--index", "0"])
        np.testing.assert_allclose(motion.root, danced.root + HIGHER)
    assert len(calls(repository)) == 1
    earlier.baked_by("then", DEMO, ["--index", "0", "--bar"])
    assert len(calls(repository)) == 2 and "--bar" in calls(repository)[1]


def test_what_goes_wrong_is_one_line(repository: Path) -> None:
    earlier = module_file.tool("earlier")
    with pytest.raises(SystemExit, match=r"^there is no commit nowhere$"):
        earlier.baked_by("nowhere", DEMO, [])
    for _ in range(2):  # nothing is kept of it
        with pytest.raises(SystemExit, match=r"^then: dancetutor: no such chart$"):
            earlier.baked_by("then", DEMO, ["--index", "99"])


def test_films_are_each_commits_own(repository: Path, points: ModuleType) -> None:
    made = points.film("then", "two_left_feet/two_left_feet.ssc", "4:5.5", 2, columns=2, width=20, options=["--mute"])
    assert list(made) == ["then", "now"]
    for picture, colour in zip(made.values(), ((255, 0, 0), (0, 0, 255)), strict=True):
        assert picture.size == (40, 30) and picture.getpixel((0, 0)) == colour
        assert picture.getpixel((39, 29)) == (0, 0, 0)  # three pictures in rows of two, though today has five


def test_the_worst_moments_are_of_the_section_and_apart(points: ModuleType, sheets: ModuleType) -> None:
    seconds = np.arange(0.0, 10.0, 0.1)
    values = np.zeros(100)
    values[[10, 41, 42, 43, 60, 95]] = [9.0, 3.0, 5.0, 4.0, 2.0, 8.0]
    found = points.largest(seconds, values, sheets.Moments(DEMO, (2.0, 9.0), count=2))
    assert found == pytest.approx([4.2, 6.0])


def test_figures_are_reported_at_each_of_the_times(points: ModuleType, danced: Motion) -> None:
    for name, figure in points.FIGURES.items():
        seconds, values, words = figure(danced)
        assert len(seconds) == len(values) > 30 and np.isfinite(values).all(), name
        assert words.format(values[0]) != words
    knees = points.FIGURES["knees"](danced)[1]
    assert 5.0 < knees.min() < knees.max() < 80.0
    assert points.figures(danced)[0].endswith("is met") or "goal" in points.figures(danced)[0]


def test_every_point_has_sheets_that_can_be_drawn(points: ModuleType, sheets: ModuleType) -> None:
    made = points.sheets()
    assert len({one.point for one in made}) == 13
    assert len({one.name for one in made}) == len(made) and all(one.shows for one in made)
    also = {"motion": {f.name for f in fields(sheets.Moments)}, "film": set(points.HOW), "character": set()}
    for one in made:
        given = inspect.signature(points.KINDS[one.kind]).parameters
        assert set(one.what) <= set(given) - {"commit", "which", "how"} | also[one.kind], one.name
        assert one.what.get("figure", "knees") in points.FIGURES


def test_the_charts_of_the_points_are_there(points: ModuleType, corpus: Path) -> None:
    assert {points.place(one.what["chart"]) for one in points.sheets() if "chart" in one.what}


def test_points_are_reported_and_unknown_ones_too(
    points: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["before_after", "--list", "jumps", "bar"])
    with pytest.raises(SystemExit, match="there is no point bar; --list"):
        points.main()
    monkeypatch.setattr(sys, "argv", ["before_after", "--list", "jumps"])
    points.main()
    assert capsys.readouterr().out.startswith("02-jumps-demo: ")


def test_the_dancer_herself_is_drawn_on_each_package_in_the_tools_order(
    points: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not by name: 45 degrees come before 315."""

    def drawn(commit: str, words: list[str]) -> None:
        assert Path(words[0]).is_file() and words[2:] == ["dancer", "faces"]
        for k, name in enumerate(("b", "a", "sheet")):
            path = Path(words[1]) / f"{name}.png"
            Image.new("RGB", (10, 20), (commit == "now", 7 * k + 1, 0)).save(path)
            os.utime(path, (k, k))

    monkeypatch.setattr(points, "run_on", drawn)
    made = points.character("then", "faces", columns=2)
    for name, picture in made.items():
        assert picture.size == (20, 20)
        assert [picture.getpixel((x, 0)) for x in (0, 10)] == [(name == "now", 1, 0), (name == "now", 8, 0)]
