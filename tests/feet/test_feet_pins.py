"""Pinned measures: the author's letters as overrides, and contradictions with their line and column."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.annotations import pinned_cells
from dancetutor_cli.feet.limbs import LETTERS, Limb, NotationError, Part, letter, marker_text, parse_marker
from dancetutor_cli.feet.overrides import FeetProblem, Overrides, split_contradictions
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.feet.song_feet import SongFeet

LEFT, RIGHT, LEFT_HAND, RIGHT_HAND = Limb.LEFT_FOOT, Limb.RIGHT_FOOT, Limb.LEFT_HAND, Limb.RIGHT_HAND
HEAD = (
    b"#TITLE:x;\n#BPMS:0=120;\n#NOTES:\n dance-single:\n :\n Hard:\n 8:\n :\n"  # 8 lines; the first measure opens in 8
)


def song_of(measures: bytes) -> Song:
    return parse(HEAD.removesuffix(b"\n") + measures, Path("song.sm"))


def read_pins(song: Song) -> tuple[Overrides, tuple[FeetProblem, ...]]:
    """The pinned feet of the first chart, but those that contradict themselves or what came before; all problems."""
    said, problems = pinned_cells(song, song.charts[0])
    good, contradictory = split_contradictions(song.charts[0], said)
    return Overrides.of({(s.tick, s.column): (s.limb, s.part) for s in good}), (*problems, *contradictory)


def cells(song: Song) -> dict[tuple[int, int], tuple[int, int]]:
    overrides, problems = read_pins(song)
    assert problems == ()
    return overrides.cells()


def problem(song: Song) -> tuple[str, str, int | None, int | None]:
    _, (found,) = read_pins(song)
    return found.code, found.message, found.line, found.column


def test_letters_become_limbs_at_their_beats() -> None:
    song = song_of(b"\n0000\n,// mine {dt1! L(.R)<>} x\n1000\n0110\n0001\n0002\n,\n0003\n;\n")
    assert cells(song) == {
        (192, 0): (LEFT, Part.WHOLE),
        (240, 2): (RIGHT, Part.WHOLE),
        (288, 3): (LEFT_HAND, Part.WHOLE),
        (336, 3): (RIGHT_HAND, Part.WHOLE),
    }


def test_brackets_distinguish_heel_and_toe() -> None:
    song = song_of(b"//{dt1! (Ll)(rR)}\n1100\n0011\n;\n")
    assert cells(song) == {
        (0, 0): (LEFT, Part.HEEL),
        (0, 1): (LEFT, Part.TOE),
        (96, 2): (RIGHT, Part.TOE),
        (96, 3): (RIGHT, Part.HEEL),
    }


def test_measures_without_the_mark_are_no_overrides() -> None:
    song = song_of(b"//{dt1 L}\n1000\n;\n//{dt1! R}\n")
    assert cells(song) == {}


@pytest.mark.parametrize(
    ("pin", "rows", "code", "words", "column"),
    [
        (b"L", b"1000\n0100\n", "pin-unreadable", "1 tokens for 2 rows", 10),
        (b"LRL", b"1000\n0100\n", "pin-unreadable", "3 tokens for 2 rows", 12),
        (b"L(LR)", b"1000\n0100\n", "pin-unreadable", "row 2 of its rows with steps has 1 step but 2 letters", 12),
        (b"Lx", b"1000\n0100\n", "pin-unreadable", "'x' is not a foot", 11),
        (b"L(R", b"1000\n0100\n", "pin-unreadable", "'(' without its other bracket", 11),
        (b"L()", b"1000\n0100\n", "pin-unreadable", "brackets without letters", 12),
        (b"(Ll)", b"1001\n", "feet-far", "the left foot cannot be on columns 1 and 4 at once", 12),
        (b"(RR)", b"1001\n", "feet-far", "the right foot cannot be on columns 1 and 4 at once", 12),
        (b"(LL)", b"1100\n", "feet-twice", "the left foot is named twice", 12),
        (b"(<<)", b"1100\n", "feet-twice", "the left hand is named twice", 12),
        (
            b"LL",
            b"2000\n0001\n3000\n0000\n",
            "feet-far",
            "column 4 while it is on a hold in column 1",
            11,
        ),
    ],
)
def test_contradictions_have_a_line_and_a_column(pin: bytes, rows: bytes, code: str, words: str, column: int) -> None:
    song = song_of(b"//{dt1! " + pin + b"}\n" + rows + b";\n")
    found, message, line, at = problem(song)
    assert (found, line, at) == (code, 8, column - 1 + 2), message  # behind ' :'
    assert words in message


def test_a_contradiction_drops_only_what_contradicts() -> None:
    song = song_of(b"//{dt1! (Ll)R}\n1001\n0010\n,//{dt1! LL}\n1000\n,//{dt1! L}\n0100\n;\n")
    overrides, problems = read_pins(song)
    assert overrides.cells() == {(96, 2): (RIGHT, Part.WHOLE), (384, 1): (LEFT, Part.WHOLE)}
    assert [p.line for p in problems] == [11, 8]


def test_a_foot_may_reach_a_near_panel_while_it_holds() -> None:
    song = song_of(b"//{dt1! LL}\n2000\n0100\n3000\n0000\n;\n")
    assert len(cells(song)) == 2


def test_the_solver_keeps_pinned_feet() -> None:
    plain = song_of(b"\n1000\n0001\n1000\n0001\n;\n")
    pinned = song_of(b"//{dt1! RLRL}\n1000\n0001\n1000\n0001\n;\n")
    limbs = []
    for song in (plain, pinned):
        overrides, _, problems = SongFeet(song).author_feet(song.charts[0])
        assert problems == ()
        play = solve_chart(song.charts[0], load_preset("thesis"), overrides)
        assert play is not None
        limbs.append([int(limb.max()) for limb in play.limb])
    assert limbs == [[LEFT, RIGHT, LEFT, RIGHT], [RIGHT, LEFT, RIGHT, LEFT]]


@given(st.lists(st.text(alphabet=sorted(LETTERS), min_size=1, max_size=4), max_size=20))
def test_markers_are_read_as_they_were_written(tokens: list[str]) -> None:
    text = marker_text(tokens)
    assert not set(text) & set(b":;#,&\\/")
    inner = text.removeprefix(b"{dt1 ").removesuffix(b"}")
    assert [token.letters for token in parse_marker(inner)] == tokens


@given(st.binary(max_size=30))
def test_any_text_is_read_or_refused(text: bytes) -> None:
    try:
        tokens = parse_marker(text)
    except NotationError as error:
        assert 0 <= error.at <= len(text)
        return
    for token in tokens:
        assert text[token.at : token.at + 1].decode("latin-1") in {token.letters[0], " "}


def test_every_limb_has_its_letter() -> None:
    written = {letter(limb, part) for limb in Limb for part in Part}
    assert written == LETTERS
