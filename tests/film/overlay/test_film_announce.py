"""Words that come and go: the count-in stands beside what it counts in, and a move is called once at a time."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.film.clock import Clock, Pass
from dancetutor_cli.film.layout import PixelBox, load_layout
from dancetutor_cli.film.notes import Callout
from dancetutor_cli.film.overlay import announce
from dancetutor_cli.film.overlay.announce import CALL_STAYS, Calls, Runs, _foot_colour, _phrases, _remaining_share
from dancetutor_cli.film.overlay.sprites import WordStyle, highway_style
from dancetutor_cli.film.overlay.text import Typeface
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.film.placement import CALLS_WIDE, PartBoxes, calls_room
from dancetutor_cli.run.languages import load_language
from dancetutor_cli.run.reading import config_names

SIZE = (640, 360)
FACE = Typeface()
STYLE = WordStyle(FACE, highway_style(), load_language())


def black() -> Frame:
    return np.zeros((SIZE[1], SIZE[0], 3), dtype=np.uint8)


def drawn(frame: Frame) -> PixelBox:
    """The box of what is not black."""
    y, x = np.nonzero(frame.any(axis=2))
    return int(x.min()), int(y.min()), int(x.max()) + 1, int(y.max()) + 1


def apart(a: PixelBox, b: PixelBox) -> bool:
    return a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]


@pytest.mark.parametrize(("name", "columns"), [*product(config_names("layouts"), (4, 8))])
def test_the_count_in_covers_nothing_that_is_taught(name: str, columns: int) -> None:
    layout = load_layout(name)
    count = layout.box("count", layout.size, columns)
    others = ["feet", "next", "runs", "legend", "calls", "header"]
    if layout.screen is None and layout.dancer is not None:
        others.append("highway")
    for other in others:
        if getattr(layout, other) is not None and (name, other) != ("highway", "header"):
            assert apart(count, layout.box(other, layout.size, columns)), other
    if layout.dancer is not None and layout.feet is None:
        left, top, right, bottom = layout.box("dancer", layout.size, columns)
        middle = (left + right) / 2
        assert count[0] > middle or count[2] < middle, "she stands there"
        assert count[3] < top + 0.75 * (bottom - top), "the pad lies there"


def test_numbers_are_counted_down_inside_their_box() -> None:
    box = (400, 20, 520, 100)
    clock = Clock((Pass(8.0, 12.0, 1.0, sound_from=10.0, count=4),), 30)
    runs = Runs(clock, (0, 300), box, 1.0, STYLE)
    seen = []
    said = runs.counted.shape
    for beat in range(4):
        frame = black()
        runs.draw(frame, 8.0 + beat * 0.5, 0)
        assert frame[box[1] : box[1] + said[0], (box[0] + box[2] - said[1]) // 2 :].any(), "what it counts is said"
        left, top, right, bottom = drawn(frame)
        assert box[0] <= left < right <= box[2] and box[1] <= top < bottom <= box[3]
        assert bottom - top > 0.4 * (box[3] - box[1]), "large enough to be seen"
        seen.append(frame.tobytes())
    assert len(set(seen)) == 4
    frame = black()
    runs.draw(frame, 10.0, 0)
    assert not frame.any(), "counted in"


def test_the_label_of_a_run_is_quieter_than_the_feet() -> None:
    """It was the brightest thing of the picture, dark words on white."""
    clock = Clock((Pass(0.0, 4.0, 0.5), Pass(0.0, 4.0)), 30)
    runs = Runs(clock, (0, 0, 640, 40), (400, 20, 520, 100), 1.0, STYLE)
    for run in (0, 1):
        frame = black()
        runs.draw(frame, 1.0, run)
        left, top, right, bottom = drawn(frame)
        assert frame[top:bottom, left:right].mean() < 90 < frame.max()


def test_a_call_breaks_where_there_is_a_comma() -> None:
    said = "left foot: heel on down-left, toe on centre ×2"
    lines, size = _phrases(said, 20, (230.0, 94.0), FACE, load_language())
    assert lines == ["left foot: heel on down-left,", "toe on centre ×2"] and size >= 15


def test_a_call_in_a_narrow_place_breaks_behind_the_foots_name_not_within_what_it_does() -> None:
    lines, _ = _phrases("footswitch, right foot: heel on down, toe on right", 20, (105.0, 120.0), FACE, load_language())
    assert lines == ["footswitch,", "right foot:", "heel on down,", "toe on right"]


def test_a_bracket_names_its_foot_wherever_two_lines_have_room_for_it() -> None:
    short = "heel on down-right, toe on up-left ×12"
    for wide, said in ((250, "right: "), (180, "right foot: "), (150, "right: "), (110, "")):
        lines, size = _phrases(f"right foot: {short}", 24, (wide, 94.0), FACE, load_language(), short)
        assert " ".join(lines) == said + short and len(lines) == 2 and size >= 12, wide


def test_the_edge_of_a_call_has_the_colour_of_its_foot() -> None:
    left, right = limb_colours().by_limb[:2]
    assert (
        _foot_colour("right foot: toe on up ×2", load_language()),
        _foot_colour("left foot again", load_language()),
    ) == (right, left)
    assert (
        _foot_colour("crossover", load_language())
        is _foot_colour("left foot again, right foot again", load_language())
        is None
    )


@pytest.mark.parametrize("lines", [["crossover"], ["right foot: heel on", "down"], ["on", "toe up"]])
def test_words_stand_in_the_middle_of_their_label(lines: list[str]) -> None:
    picture = announce.flag(lines, 40, (255, 255, 255), FACE)
    rows = np.flatnonzero((picture[:, 12:-12, 0] > 120).any(axis=1))[:, None]
    inner = rows[(rows > 5) & (rows < len(picture) - 6)]
    assert abs(inner[0] - (len(picture) - 1 - inner[-1])) <= 2


def test_the_time_left_is_that_to_the_next_move_of_a_passage() -> None:
    call = Callout(5.0, 10.0, "crossover ×2", "move", 4.0, 7.0, "crossover ×2", ((7.0, 14.0, "crossover"),))
    assert [_remaining_share(call, second) for second in (4.0, 4.5, 5.0, 6.0, 7.0, 7.1)] == [
        1.0,
        0.5,
        1.0,
        0.5,
        0.0,
        0.0,
    ]


@pytest.mark.parametrize("name", ["side-by-side", "dancer", "vertical", "practice", "television"])
@pytest.mark.parametrize("columns", [4, 10])
def test_a_call_has_two_lines_at_most(name: str, columns: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a layout's box, and in the narrowest place beside her that calls are put in."""
    layout = load_layout(name)
    room = calls_room(PartBoxes(layout, layout.size, columns), None)
    left, top, right, bottom = room.box
    made: list[tuple[list[str], float]] = []
    label = announce.flag
    monkeypatch.setattr(
        announce, "flag", lambda lines, size, *rest: (made.append((lines, size)), label(lines, size, *rest))[1]
    )
    long = "heel on down-right, toe on up-left ×12"
    for text, tag in ((f"right foot: {long}", long), ("full crossover ×12, left foot again ×12", "full crossover ×12")):
        for wide in (right - left, CALLS_WIDE * room.scale):
            one = Calls((), (0, top, int(wide), bottom), room.scale, STYLE)
            picture = one._plate(text, "move", tag)
            assert len(made[-1][0]) <= 2 and made[-1][1] >= 11.5, (text, wide)
            assert " ".join(made[-1][0]) in (text, text.replace(" foot:", ":"), long)
            assert picture.shape[1] <= wide + 2


def test_a_call_gives_its_reason_where_a_few_lines_have_room_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[list[str]] = []
    label = announce.flag
    monkeypatch.setattr(announce, "flag", lambda lines, *rest: (made.append(lines), label(lines, *rest))[1])
    text = "left foot crosses behind, spin"
    longer = "left foot crosses behind: right foot has just stepped; spin"
    for wide, high, count in ((800, 150, 1), (400, 150, 2), (240, 150, 3), (150, 150, 5), (240, 40, 2), (80, 150, 3)):
        Calls((), (0, 0, wide, high), 1.0, STYLE)._plate(text, "move", "cross behind", longer)
        words = " ".join(made[-1])
        assert (len(made[-1]), words) == (count, longer if wide > 80 and high > 50 else text), (wide, high)


def calls(*passages: tuple[float, float, str]) -> Calls:
    """Calls of passages (begin, end, words), called out a second before."""
    found = tuple(Callout(begin, 2 * begin, text, "move", begin - 1.0, end, text) for begin, end, text in passages)
    return Calls(found, (300, 10, 630, 350), 1.0, STYLE)


def test_a_passage_is_called_out_before_it_begins_and_until_it_is_over() -> None:
    one = calls((5.0, 7.0, "crossover ×3"))
    for second, shown in (
        (3.99, False),
        (4.5, True),
        (5.5, True),
        (7.0 + CALL_STAYS / 2, True),
        (7.0 + CALL_STAYS + 0.01, False),
    ):
        frame = black()
        one.draw(frame, second)
        assert frame.any() == shown, second


def test_what_comes_next_stands_below_what_goes_on() -> None:
    both = calls((5.0, 6.0, "crossover"), (6.5, 6.5, "spin"))
    frame, alone = black(), black()
    both.draw(frame, 5.9)
    calls((5.0, 6.0, "crossover")).draw(alone, 5.9)
    assert drawn(frame)[3] > drawn(alone)[3] + 20
    late = black()
    both.draw(late, 6.5 + CALL_STAYS + 0.01)
    assert not late.any()


@pytest.mark.parametrize("name", ["practice", "vertical"])
def test_calls_stay_in_a_box_of_their_own(name: str) -> None:
    """One of three lines and the next: the next waits, for below stands what is taught. Two short ones both fit."""
    layout = load_layout(name)
    box = layout.box("calls", layout.size, 4)
    assert layout.calls is not None
    long = "left foot: heel on left, toe on up ×3, right foot: heel on down, toe on right"
    for texts, least in ((("crossover", "spin"), 0.5), ((long, "spin"), 0.4), ((long, long + " ×2"), 0.4)):
        found = tuple(Callout(5.0 + k, 10.0, text, "move", 4.0, 9.0, text) for k, text in enumerate(texts))
        frame = np.zeros((layout.size[1], layout.size[0], 3), dtype=np.uint8)
        Calls(found, box, layout.calls.text, STYLE).draw(frame, 6.5)
        _, top, _, bottom = drawn(frame)
        assert top >= box[1] and bottom <= box[3], texts
        assert bottom - top > least * (box[3] - box[1])


@pytest.mark.parametrize("width", [90, 200, 330])
def test_words_of_a_call_are_never_cut(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    written: list[str] = []
    ink = Typeface.sprite

    def sprite(self: Typeface, text: str, *rest: object, **more: object) -> object:
        written.append(text)
        return ink(self, text, *rest, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(Typeface, "sprite", sprite)
    said = "right foot: heel on down-right, toe on centre, footswitch"
    found = (Callout(5.0, 10.0, said, "move", 4.0, 5.0, said),)
    frame = black()
    Calls(found, (300, 10, 300 + width, 350), 1.0, STYLE).draw(frame, 4.5)
    assert " ".join(written) == said
    assert drawn(frame)[0] >= 300 - 2, "inside of its box"


def test_a_call_goes_quickly() -> None:
    """Its grey ghost in the corner was taken for a mistake."""
    one = Callout(2.0, 4.0, "crossover", "move", 1.0, 2.0, "crossover")
    calls = Calls((one,), (0, 0, 600, 200), 1.0, STYLE)
    seen = []
    for second in np.arange(2.0, 2.3, 0.01):
        frame = black()
        calls.draw(frame, float(second))
        seen.append(int(frame.max()))
    faint = [light for light in seen if 0 < light < 0.9 * max(seen)]
    assert seen[0] == max(seen) and seen[-1] == 0
    assert len(faint) <= 6, "hundredths of a second"
