"""The demo song shows what its comments say: every named pattern is in the measure that names it."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from dancetutor_cli.chart.model import Chart, Kind, Song
from dancetutor_cli.chart.names import TICKS_PER_MEASURE
from dancetutor_cli.chart.reader import load
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "charts" / "two_left_feet"
# Word in a comment -> a move of the play or a kind of note that must then be in the measure (or the next: a pattern may
# end on its first row).
MOVES = {
    "jump": "jump", "crossover": "crossover-half", "spin": "spin", "gallop": "gallop", "jack": "jack",
    "hand": "hand", "candle": "candle", "forced doublestep": "forced-doublestep", "doublestep:": "doublestep",
}  # fmt: skip
KINDS = {"hold": Kind.HOLD, "roll": Kind.ROLL, "mine": Kind.MINE}


@pytest.fixture(scope="module", params=["ssc", "sm"])
def song(request: pytest.FixtureRequest) -> Song:
    return load(FOLDER / f"two_left_feet.{request.param}")


def comments(song: Song, chart: Chart) -> dict[int, str]:
    """Measure number -> the text of its comment."""
    start, end = chart.notes_span
    text = song.data[start:end].decode()
    return {int(n): words for n, words in re.findall(r"// measure (\d+): (.*)", text)}


def test_both_files_come_from_the_script(tmp_path: Path) -> None:
    before = {p.name: p.read_bytes() for p in FOLDER.iterdir()}
    code = (
        "import sys; sys.path.insert(0, 'research'); import make_demo_song as m\n"
        "from pathlib import Path; m.HERE = Path(sys.argv[1]); sys.argv[1:] = ['--charts-only']; m.main()"
    )
    subprocess.run([sys.executable, "-c", code, str(tmp_path)], cwd=ROOT, check=True)
    for path in tmp_path.iterdir():
        assert path.read_bytes() == before[path.name], f"{path.name} is not what research/make_demo_song.py writes"
    assert {p.suffix for p in tmp_path.iterdir()} == {".ssc", ".sm"}


def test_the_charts_are_those_promised(song: Song) -> None:
    assert [(c.steps_type, c.difficulty) for c in song.charts] == [
        *(("dance-single", d) for d in ("Beginner", "Easy", "Medium", "Hard", "Challenge")),
        ("dance-double", "Hard"),
    ]
    assert not song.warnings
    assert not any(c.warnings for c in song.charts)
    assert 35 < song.timing.seconds(song.charts[0].notes.tick[-1:])[0] < 45


def test_every_pattern_stands_where_its_comment_says(song: Song) -> None:
    preset = load_preset("thesis")
    shown: set[str] = set()
    for chart in song.charts:
        play = solve_chart(chart, preset)
        assert play is not None
        measure = play.rows.tick // TICKS_PER_MEASURE
        for number, text in comments(song, chart).items():
            for word, move in MOVES.items():
                if word not in text or (move == "doublestep" and "forced" in text):
                    continue
                near = [m for row, m in zip(measure, play.moves, strict=True) if row in (number, number + 1)]
                assert any(move in moves for moves in near), f"{chart.label}, measure {number}: no {move}: {text}"
                shown.add(move)
            kinds = chart.notes.kind[chart.notes.tick // TICKS_PER_MEASURE == number]
            for word, kind in KINDS.items():
                if re.search(rf"\b{word}", text) and "both feet hold" not in text:
                    assert kind in kinds, f"{chart.label}, measure {number}: no {word}"
                    shown.add(word)
    assert shown == {*MOVES.values(), *KINDS}


def test_spins_and_doublesteps_stand_nowhere_else(song: Song) -> None:
    preset = load_preset("thesis")
    for chart in song.charts:
        play = solve_chart(chart, preset)
        assert play is not None
        named = comments(song, chart)
        for row, moves in enumerate(play.moves):
            number = int(play.rows.tick[row] // TICKS_PER_MEASURE)
            text = named.get(number, "") + named.get(number - 1, "")
            for move in ("spin", "doublestep"):
                assert move not in moves or move in text, f"{chart.label}, measure {number}: an unannounced {move}"
