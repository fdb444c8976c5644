"""What is called out beside the notes: passages with a count, in a dancer's words, as long before as is asked for."""

from __future__ import annotations

from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.solver.techniques import half_turned
from dancetutor_cli.film.choices import Ahead, parse_ahead
from dancetutor_cli.film.notes import Callout
from dancetutor_cli.film.overlay.callouts import CalloutSubject, CallStyle, _Notice, _reasons, callouts_of
from dancetutor_cli.film.overlay.sprites import callout_words, highway_style
from dancetutor_cli.film.scroll import parse_segments
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.languages import load_language

WORDS = callout_words(load_language())
SECOND = 1.0  # before


def subject(*rows: tuple[float, tuple[str, ...], dict[int, int], dict[int, int]], steps: str = "dance-single") -> Any:
    """Rows of (beat, moves, column -> limb, foot -> column it stands on), at 120 BPM."""
    pad = load_pad(steps)
    assert pad is not None
    limb = np.full((len(rows), len(pad)), -1, dtype=np.int8)
    feet = np.full((len(rows), 2), -1, dtype=np.int16)
    for number, (_, _, pressed, stands) in enumerate(rows):
        for column, who in pressed.items():
            limb[number, column] = who
        for foot, column in stands.items():
            feet[number, foot] = column
    ticks = np.array([round(beat * 48) for beat, *_ in rows], dtype=np.int64)
    play = SimpleNamespace(
        rows=SimpleNamespace(tick=ticks),
        moves=tuple(moves for _, moves, _, _ in rows),
        limb=limb,
        feet=feet,
        facing=np.zeros(len(rows)),
    )
    timing = SimpleNamespace(seconds=lambda t: np.asarray(t) / 96.0)
    return SimpleNamespace(play=play, pad=pad, chart=SimpleNamespace(timing=timing))


def called(what: Any, found: Iterable[Any] = (), **how: Any) -> tuple[Callout, ...]:
    """found : by the linter"""
    style = CallStyle(WORDS, how.pop("ahead", Ahead(SECOND)), **how)
    return callouts_of(CalloutSubject(what.chart, what.pad, lambda: found), what.play, style, parse_segments(""))


def moves(*beats_and_names: tuple[float, str]) -> Any:
    return subject(*((beat, tuple(name.split()), {0: 0}, {0: 0}) for beat, name in beats_and_names))


def test_crossovers_in_a_row_are_one_passage_with_a_count() -> None:
    rows = [(beat, "crossover-half" if beat % 2 else "") for beat in range(8)]
    (one,) = called(moves(*((float(beat), name) for beat, name in rows)))
    assert (one.text, one.tag) == ("crossover ×4", "crossover")
    assert [tag for *_, tag in one.further] == ["crossover"] * 3, "each has its tag, so none has a count"
    assert (one.second, one.end) == (0.5, 3.5)


def test_the_first_of_quick_moves_has_the_count_in_its_tag() -> None:
    """The others stand too close for tags of their own."""
    (one,) = called(moves(*((0.5 * k, "footswitch-up") for k in range(4))))
    assert (one.text, one.tag) == ("footswitch: swap to left foot ×4", "swap feet ×4")
    assert len(one.further) == 1


def test_a_crossover_that_goes_on_is_counted_once() -> None:
    (one,) = called(moves((0.0, ""), (1.0, "crossover-half"), (1.5, "crossover-half"), (2.0, "")))
    assert (one.text, one.second, one.end) == ("crossover", 0.5, 0.75)


def turning(*rows: tuple[float, str, float]) -> Any:
    """Rows of (beat, moves, facing)."""
    what = moves(*((beat, names) for beat, names, _ in rows))
    what.play.facing = np.array([facing for *_, facing in rows])
    return what


def test_a_turn_away_from_the_screen_is_reported_where_it_is_full() -> None:
    """Left on right, right on left, and back: one crossing."""
    half, full = "crossover-half", "crossover-full"
    (one,) = called(turning((0, "", -45), (1, half, -135), (2, full, -180), (3, half, -135), (4, "", -45)))
    assert (one.text, one.second, one.end) == ("crossover, back to the screen", 0.5, 1.5)
    assert one.further == ((1.0, 2.0, "back to the screen"),)
    (one,) = called(turning((0, "", -45), (1, full, -180), (2, "", -45)))
    assert (one.text, one.tag) == ("crossover: back to the screen", "back to the screen")


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [(45, -135, "half turn: back to the screen"), (-135, 45, "half turn: face the screen"), (90, -90, "half turn")],
)
def test_a_half_turn_is_reported_by_the_rules_definition_and_before_its_crossover(
    before: float, after: float, said: str
) -> None:
    crossed = "crossover-half" if abs(after) > 90 else ""
    (one,) = called(turning((0, "", before), (1, crossed, after)))
    assert (one.text, one.second) == (said, 0.5)
    assert half_turned(np.array([before, after], dtype=float)).all()
    assert called(turning((0, "", before), (1, "", after + 45))) == ()


def test_an_uncrossed_jump_or_a_rest_parts_what_is_called_out() -> None:
    x = "crossover-half"
    found = called(moves((0, x), (1, "jump"), (2, x), (3, ""), (4, x), (5, ""), (7, x)))
    assert [(one.text, one.second, one.end) for one in found] == [
        ("crossover", 0.0, 0.0),
        ("crossover ×2", 1.0, 2.0),
        ("crossover", 3.5, 3.5),
    ]
    assert [one.further for one in found] == [(), ((2.0, 4.0, "crossover"),), ()]
    slow = moves((0, x), (1, ""), (2, x))
    slow.chart.timing = SimpleNamespace(seconds=lambda t: np.asarray(t) / 48.0)
    assert len(called(slow)) == 2, "two beats, but two seconds"


def test_moves_that_follow_closely_are_joined_and_others_are_not() -> None:
    found = called(moves((0.0, "crossover-half"), (1.0, "footswitch-up"), (20.0, "footswitch-up")))
    assert [one.text for one in found] == ["crossover, footswitch: swap to left foot", "footswitch: swap to left foot"]
    assert found[0].tag == "crossover", "the place beside the notes is narrow"


def test_nothing_is_called_out_for_longer_than_four_measures() -> None:
    found = called(moves(*((float(beat), "footswitch-up") for beat in range(40))))
    assert [one.text for one in found] == [f"footswitch: swap to left foot ×{times}" for times in (17, 17, 6)]


def test_at_a_chart_of_false_tempo_seconds_join_them() -> None:
    """Pump's charts may run at 312 BPM and more: a measure there is less than a second."""
    quick = moves(*((float(beat), "footswitch-up") for beat in (0, 4, 8)))
    quick.chart.timing = SimpleNamespace(seconds=lambda t: np.asarray(t) / 48 * 60 / 312)
    assert [one.text for one in called(quick)] == ["footswitch: swap to left foot ×3"]


def test_a_bracket_says_which_foot_and_which_part_of_it() -> None:
    row = (4.0, ("bracket",), {2: 1, 3: 1}, {0: 0, 1: 3})
    (one,) = called(subject(row))
    assert (one.text, one.tag) == ("right foot: heel on right, toe on up", "heel on right, toe on up")
    (one,) = called(subject(row), turned=True)
    assert one.text == "right foot: heel on left, toe on down", "as her panels are seen by whom she faces"


def test_a_bracket_over_a_held_panel_names_the_end_that_steps() -> None:
    """What the other one does is seen; "heel stays" made calls of four lines."""
    (one,) = called(subject((4.0, ("bracket",), {2: 1}, {0: 0, 1: 3})))
    assert (one.text, one.tag) == ("right foot: toe on up", "toe on up")
    (one,) = called(subject((4.0, ("bracket",), {3: 1}, {0: 0, 1: 3})))
    assert one.text == "right foot: heel on right"


def test_two_moves_are_joined_if_they_are_short() -> None:
    """Two brackets are read one after the other, in two lines each."""
    left, right = ({0: 0, 1: 0}, {0: 1, 1: 3}), ({2: 1, 3: 1}, {0: 0, 1: 3})
    rows = [(float(beat), ("bracket",), *(right if beat % 2 else left)) for beat in range(4)]
    found = called(subject(*rows))
    assert [one.text for one in found] == [
        "left foot: heel on down, toe on left ×2",
        "right foot: heel on right, toe on up ×2",
    ]
    crossed = called(subject((0.0, ("crossover-half",), {0: 1}, {0: 3, 1: 0}), (1.0, ("bracket",), *left)))
    assert [one.text for one in crossed] == ["crossover", "left foot: heel on down, toe on left"]


def test_panels_of_a_double_have_no_number() -> None:
    (one,) = called(subject((4.0, ("bracket",), {0: 0, 2: 0}, {0: 0, 1: 4}), steps="pump-double"))
    assert one.text == "left foot: heel on down-left, toe on centre"


def test_the_foot_and_the_hand_are_named() -> None:
    found = called(
        subject((0.0, ("doublestep",), {3: 1}, {0: 0, 1: 3}), (9.0, ("hand",), {0: 0, 2: 1, 1: 2}, {0: 0, 1: 2}))
    )
    assert [one.text for one in found] == ["right foot: twice in a row", "left hand down"]


def test_a_note_that_is_let_go_is_reported() -> None:
    (one,) = called(moves((4.0, "unplayable")))
    assert one.text == "no free foot"


def test_a_finding_for_a_passage_is_reported_of_all_its_rows() -> None:
    notices = [
        _Notice(48, "fast step", "DT305", 3),
        _Notice(96, "jump footswitch", "DT209", 1),
        _Notice(576, "unplayable", "DT301", 3),
    ]
    said = dict(_reasons([0, 48, 72, 96, 400, 480, 576, 800], notices))
    assert said == {
        48: "fast step",
        72: "fast step",
        96: "jump footswitch",
        400: "fast step",
        480: "fast step",
        576: "unplayable",
        800: "unplayable",
    }


@pytest.mark.parametrize(("ahead", "begin"), [("0.5", 1.5), ("b1", 1.5), ("b2.5", 0.75)])
def test_how_long_before_is_a_setting_in_seconds_or_beats(ahead: str, begin: float) -> None:
    (one,) = called(moves((4.0, "footswitch")), ahead=parse_ahead(ahead))
    assert one.second == 2.0
    assert one.called_from == pytest.approx(begin)


def test_the_default_is_a_second_or_a_little_less() -> None:
    assert 0.5 <= parse_ahead(highway_style().callout_ahead).length <= 1.0


@pytest.mark.parametrize("text", ["", "b", "-1", "0", "2b", "nan", "1e3", "99999", "b31"])
def test_other_words_for_a_time_are_refused_in_one_line(text: str) -> None:
    with pytest.raises(UsageError, match=r"--call-ahead .*: write seconds, such as 0\.9, or beats, such as b2"):
        parse_ahead(text)


def test_findings_are_for_authors_who_ask_for_them() -> None:
    finding = SimpleNamespace(beat=4.0, note_column=0, severity="warning", rule="DT305", name="fast-step")
    what = moves((8.0, "footswitch"))
    assert [one.text for one in called(what, [finding])] == ["footswitch: swap to left foot"]
    assert [(one.text, one.severity) for one in called(what, [finding], findings=True)] == [
        ("fast step", "warning"),
        ("footswitch: swap to left foot", "move"),
    ]
