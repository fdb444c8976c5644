"""The hardest passages: what the practice page lists and `--section hardest:1` means."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import load
from dancetutor_cli.feet.passages import Passage, hardest_passages, passage_settings
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.lint.sections import check_part, part_of
from dancetutor_cli.lint.subject import solved_chart
from dancetutor_cli.page.document import languages
from dancetutor_cli.page.facts import passage_object, tags, without_repeats
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"


@pytest.fixture(scope="module")
def song() -> Song:
    return load(DEMO)


def played(song: Song, index: int = 3) -> Play:
    play = solved_chart(song, song.charts[index], load_preset("itg")).play
    assert play is not None
    return play


def test_the_passage_with_the_spin_is_the_hardest_of_the_demo_song(song: Song) -> None:
    found = hardest_passages(played(song), song.charts[3].timing)
    first = found[0]
    assert first.first <= 11 < first.last  # the spin and the doublestep are in measures 11 and 12
    assert first.spins == 1 and first.doublesteps == 1 and sum(first.crossovers) >= 1
    assert [one.score for one in found] == sorted((one.score for one in found), reverse=True)


@pytest.mark.parametrize("index", range(6))
def test_passages_keep_apart_and_lie_on_measures(song: Song, index: int) -> None:
    chart = song.charts[index]
    found = hardest_passages(played(song, index), chart.timing)
    assert len(found) <= passage_settings().most
    taken: set[int] = set()
    for one in found:
        mine = set(range(one.first, one.last))
        assert not mine & taken
        taken |= mine
        ends = chart.timing.seconds_of_beats(np.array([4.0 * one.first, 4.0 * one.last]))
        assert (one.start, one.end) == pytest.approx(tuple(ends))
        assert one.rate == pytest.approx(one.steps / (one.end - one.start))


def test_a_harder_move_makes_a_passage_harder(song: Song) -> None:
    play, timing = played(song), song.charts[3].timing
    settings = passage_settings()
    before = hardest_passages(play, timing, settings)[0].score
    assert hardest_passages(play, timing, replace(settings, spin=settings.spin + 7.5))[0].score == pytest.approx(
        before + 1.0
    )


def test_nothing_stands_out_where_all_is_alike(song: Song) -> None:
    play = played(song)
    assert hardest_passages(play, song.charts[3].timing, replace(passage_settings(), harder=50.0)) == ()


def test_a_section_can_be_the_hardest_passage(song: Song) -> None:
    chart = song.charts[3]
    found = hardest_passages(played(song), chart.timing)
    check_part("hardest:1")
    part = part_of("Hardest:2", song, chart, load_preset("itg"), 60.0)
    assert part == (found[1].start, found[1].end)
    with pytest.raises(UsageError, match=rf"section hardest:99: the chart has only {len(found)} hard passages: write "):
        part_of("hardest:99", song, chart, load_preset("itg"), 60.0)
    with pytest.raises(UsageError, match="cannot be read"):
        check_part("hardest:x")


def test_tags_report_what_the_feet_do() -> None:
    passage = Passage(8, 12, 1.0, 9.0, 5.0, 4.0, 32, (2, 0), 135.0, 0, 1, 0, 0, 0, 3, 0, 0, 1)
    assert tags(passage) == [
        ("fast", 32), ("crossover", 2), ("bracket", 1), ("jump", 3), ("turn", 135), ("close", 1),
    ]  # fmt: skip
    both = [passage_object(passage, player) for player in (1, 2, 2)]
    assert [(one["player"], one["again"]) for one in without_repeats(both)] == [(1, []), (2, [[8, 12]])]
    for labels in languages().values():
        assert all(f"tag-{name}" in labels for name, _ in tags(passage))


def test_wrong_settings_are_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "passages.yaml"
    path.write_text("measures: -1\n")
    monkeypatch.setattr("dancetutor_cli.feet.passages.config_path", lambda name: path)
    passage_settings.cache_clear()
    try:
        with pytest.raises(Exception, match=r"passages\.yaml:1: measures must be a whole number of 0 or more"):
            passage_settings()
    finally:
        monkeypatch.undo()
        passage_settings.cache_clear()
