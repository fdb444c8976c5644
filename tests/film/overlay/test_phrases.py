"""Which foot crosses, in front or behind, and why: said as the dancer's feet do it."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.motion import Cut, Motion, sample
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import joint_matrices
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.solved import Solved
from dancetutor_cli.feet.solver.techniques import half_turned
from dancetutor_cli.film.choices import Ahead
from dancetutor_cli.film.overlay import callouts
from dancetutor_cli.film.overlay.announce import _foot_colour
from dancetutor_cli.film.overlay.callouts import CalloutSubject, CallStyle, callouts_of
from dancetutor_cli.film.overlay.sprites import callout_words
from dancetutor_cli.film.scroll import parse_segments
from dancetutor_cli.film.words import (
    Phrase,
    crossing_phrase,
    standing_tags,
    stepped_phrase,
    turning_phrase,
)
from dancetutor_cli.run.languages import load_language
from dancetutor_cli.run.reading import config_names

ENGLISH = load_language()
HEAD = "#TITLE:Crossed;\n#OFFSET:0;\n#BPMS:0=100;\n#NOTES:{}::Hard:9::\n{};\n"
# Each two measures, a step a beat, left and right in turn; a star begins a hold that lasts over the next step.
PATTERNS = {
    "dance-single": ("L D R D L", "L U R U L", "R D L D R", "R U L U R", "L *D R", "R *D L", "R *U L", "L *U R"),
    "pump-single": ("DL C DR C DL", "DR C DL C DR", "UR C UL C UR", "UL C UR C UL", "DL C UR C DL"),
}
ROUND = ("DL C UR C UL", "DR C UL C UR", "UL C DR C DL", "UR C DL C DR")  # half turns and back
NONE = parse_segments("")
COLUMNS = {"dance-single": ("L", "D", "U", "R"), "pump-single": ("DL", "UL", "C", "UR", "DR")}
JUMP = {"dance-single": "1001", "pump-single": "10001"}  # before each pattern: her feet are apart then


def written(folder: Path, steps: str, patterns: tuple[str, ...] = ()) -> Path:
    """A chart of all patterns."""
    names, lines = COLUMNS[steps], []
    for pattern in patterns or PATTERNS[steps]:
        rows = [list(JUMP[steps]), *(["0"] * len(names) for _ in range(7))]
        held = None
        for beat, name in enumerate(pattern.split(), 1):
            rows[beat][names.index(name.strip("*"))] = "2" if name.startswith("*") else "1"
            held = beat if name.startswith("*") else held
        if held is not None:
            rows[held + 2][names.index(pattern.split()[held - 1].strip("*"))] = "3"
        lines += ["".join(row) for row in rows]
    path = folder / f"{steps}.sm"
    measures = ["\n".join(lines[k : k + 4]) for k in range(0, len(lines), 4)]
    path.write_text(HEAD.format(steps, "\n,\n".join(measures)))
    return path


class Danced(NamedTuple):
    """solved : of a chart of hand; motion : how she dances it"""

    solved: Solved
    motion: Motion


@pytest.fixture(scope="module", params=PATTERNS)
def danced(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Danced:
    """Every pattern in turn."""
    wanted = DanceRequest(written(tmp_path_factory.mktemp("crossed"), request.param), Selection(index=0), fps=60.0)
    (solved,) = some = solve(wanted)
    assert solved.play is not None
    second = solved.play.rows.second
    whole = Cut(float(second[0]) - 1.0, float(second[-1]) + 0.5)
    return Danced(solved, perform(some, wanted, 1.0).bake(whole)[0].motion)


def passes(motion: Motion, second: float, foot: int) -> float | None:
    """How far a foot is nearer to the screen than the other one as it passes it, metres; None: it never does.

    second : when it lands; from the ball joints of the half second before, across the pad
    """
    skeleton = motion.skeleton
    rotations, root = sample(motion, np.arange(second - 0.55, second + 0.02, 1 / 120))
    joints = joint_matrices(skeleton, rotations, root)
    left, right = (joints[:, skeleton.index(f"{side}_metatarsal"), :3, 3] for side in "lr")
    apart = left[:, 0] - right[:, 0]  # her left is where x is greater
    crossed = np.flatnonzero((apart[:-1] > 0) & (apart[1:] <= 0))
    if len(crossed) == 0:
        return None
    ahead = (left - right)[crossed[-1], 2]
    return float(ahead if foot == 0 else -ahead)


def crossings(play: Play) -> list[int]:
    """Rows at which legs are crossed by one foot, and were not before."""
    crossed = [any(name.startswith("crossover") for name in names) for names in play.moves]
    begins = [row + 1 for row, (before, now) in enumerate(pairwise(crossed)) if now and not before]
    return [row for row in begins if len({0, 1} & set(play.limb[row].tolist())) == 1]


def test_calls_say_which_foot_crosses_and_whether_in_front_as_the_feet_do(danced: Danced) -> None:
    solved = danced.solved
    play, pad = solved.play, solved.pad
    assert play is not None and pad is not None
    found = crossings(play)
    ways = set()
    for row in found:
        (foot,) = {0, 1} & set(play.limb[row].tolist())
        ahead = passes(danced.motion, float(play.rows.second[row]), foot)
        assert ahead is not None and abs(ahead) > 0.05
        said = crossing_phrase("crossover", (play, row), pad, ENGLISH)
        way = "in front" if ahead > 0 else "behind"
        assert said.text == f"{('left', 'right')[foot]} foot crosses {way}"
        assert said.tag == f"cross {way}"
        ways.add((foot, way))
    assert len(found) >= 4 and ways == {(foot, way) for foot in (0, 1) for way in ("in front", "behind")}


def test_a_call_of_two_kinds_of_moves_says_why_for_each() -> None:
    """A passage of a crossover over a hold and a spin had no reason at all."""
    toe = Phrase("bracket", "right foot: toe on up", "toe on up")
    cross = Phrase("crossover", "left foot crosses behind", "cross behind", "right foot is on the hold")
    turn = Phrase("half turn", "half turn, left foot in front", "half turn", "right foot has just stepped")
    both, other = turn._replace(why=cross.why), cross._replace(why=turn.why)
    switched = cross._replace(text="right foot crosses", why="left foot has just stepped", several="{said} first")
    for phrases, words in (
        ((toe, cross), f"{toe.text}, {cross.text}: {cross.why}"),
        ((cross, toe), f"{cross.text}: {cross.why}; {toe.text}"),
        ((cross, turn), f"{cross.text}: {cross.why}; {turn.text}: {turn.why}"),
        ((cross, both), f"{cross.text}, {both.text}: {cross.why}"),
        ((switched, cross), f"{switched.text} first: {switched.why}"),
        ((cross, cross), f"{cross.text} ×2: {cross.why}"),
        ((cross, other, toe), ""),  # the same words for two reasons
        ((toe,), ""),
    ):
        passage = callouts._Passage(0, 0)
        for tick, phrase in enumerate(phrases):
            passage.add(callouts._Move(tick, tick, phrase))
        assert passage.text_with_reasons() == words


def test_a_call_says_why(danced: Danced) -> None:
    """Because the other foot is on a hold, else because it has just stepped."""
    solved = danced.solved
    play, pad = solved.play, solved.pad
    assert play is not None and pad is not None
    style = CallStyle(callout_words(ENGLISH), Ahead(0.5))
    called = callouts_of(CalloutSubject(solved.chart, pad, tuple), play, style, parse_segments(""))
    by_second = {round(one.second, 3): one for one in called}
    reasons = set()
    for row in crossings(play):
        one = by_second[round(float(play.rows.second[row]), 3)]
        (foot,) = {0, 1} & set(play.limb[row].tolist())
        other, tick = 1 - foot, int(play.rows.tick[row])
        holds = any(
            play.limb[r, c] == other and play.rows.hold_end[r, c] > tick for r in range(row) for c in range(len(pad))
        )
        reason = "is on the hold" if holds else "has just stepped"
        assert one.with_reasons == f"{one.text}: {('left', 'right')[other]} foot {reason}"
        assert " crosses " in one.text or one.text.startswith("half turn")
        reasons.add(reason)
    holds_too = bool((play.rows.hold_end >= 0).any())
    assert reasons == {"has just stepped", *(["is on the hold"] if holds_too else [])}


def test_calls_of_half_turns_say_which_foot_comes_down_where(tmp_path: Path) -> None:
    """As the ball of that foot does in the file's own joints, away from the screen and back to it, of both feet."""
    wanted = DanceRequest(written(tmp_path, "pump-single", ROUND), Selection(index=0), fps=60.0)
    (solved,) = some = solve(wanted)
    play, pad = solved.play, solved.pad
    assert play is not None and pad is not None
    style = CallStyle(callout_words(ENGLISH), Ahead(0.5))
    calls = {round(c.second, 3): c for c in callouts_of(CalloutSubject(solved.chart, pad, tuple), play, style, NONE)}
    second = play.rows.second
    motion = perform(some, wanted, 1.0).bake(Cut(float(second[0]) - 1.0, float(second[-1]) + 0.5))[0].motion
    told = set()
    for row in (np.flatnonzero(half_turned(play.facing)) + 1).tolist():
        (foot,) = {0, 1} & set(play.limb[row].tolist())
        joints = joint_matrices(motion.skeleton, *sample(motion, second[row : row + 1]))[0]
        depth = [joints[motion.skeleton.index(f"{side}_metatarsal"), 2, 3] for side in "lr"]
        ahead = depth[foot] - depth[1 - foot]
        assert abs(ahead) > 0.05
        screen = "face the screen" if abs(play.facing[row]) < 90 else "back to the screen"
        one = ("left", "right")[foot], "in front" if ahead > 0 else "behind"
        phrase = turning_phrase(f"half turn: {screen}", (play, row), pad, ENGLISH)
        assert phrase.text == f"half turn: {screen}, {one[0]} foot {one[1]}"
        assert phrase.why == f"{('right', 'left')[foot]} foot has just stepped"
        if (call := calls.get(round(float(second[row]), 3))) is not None:
            assert call.text.startswith(f"half turn: {screen}") and f"{one[0]} foot {one[1]}" in call.text
        told.add(one)
    assert told == {(foot, way) for foot in ("left", "right") for way in ("in front", "behind")}


AWAY = {"L U R L": "LRLR", "R U L R": "RLRL", "L D R L": "LRLR", "R D L R": "RLRL"}  # panels and feet of a beat each


def test_calls_of_feet_crossed_all_the_way_say_which_foot_goes_where(tmp_path: Path) -> None:
    """Before or behind the other foot, as the balls of the feet are halfway in the file's own joints, and why."""
    path = written(tmp_path, "dance-single", tuple(AWAY))
    head, _, notes = path.read_text().rpartition(":\n")
    pins = [part for feet in AWAY.values() for part in (f"(LR){feet[:3]}", feet[3])]
    measures = zip(pins, notes.rstrip(";\n").split("\n,\n"), strict=True)
    path.write_text(head + ":" + "\n,".join(f"  // {{dt1! {pin}}}\n{rows}" for pin, rows in measures) + "\n;\n")
    wanted = DanceRequest(path, Selection(index=0), fps=60.0)
    (solved,) = some = solve(wanted)
    play, pad = solved.play, solved.pad
    assert play is not None and pad is not None
    style = CallStyle(callout_words(ENGLISH), Ahead(0.5))
    calls = callouts_of(CalloutSubject(solved.chart, pad, tuple), play, style, NONE)
    second = play.rows.second
    motion = perform(some, wanted, 1.0).bake(Cut(float(second[0]) - 1.0, float(second[-1]) + 0.5))[0].motion
    found = set()
    for row in [row for row, names in enumerate(play.moves) if "crossover-full" in names]:
        (foot,) = {0, 1} & set(play.limb[row].tolist())
        halfway = (second[row - 1 : row] + second[row : row + 1]) / 2
        joints = joint_matrices(motion.skeleton, *sample(motion, halfway))[0]
        depth = [joints[motion.skeleton.index(f"{side}_metatarsal"), 2, 3] for side in "lr"]
        ahead = depth[foot] - depth[1 - foot]
        assert abs(ahead) > 0.05
        who, way = ("left", "right")[foot], "in front" if ahead > 0 else "behind"
        words = f"back to the screen, {who} foot {way}: {('right', 'left')[foot]} foot has just stepped"
        assert any(words in call.with_reasons and call.second <= second[row] <= call.end for call in calls)
        found.add((who, way))
    assert found == {(foot, way) for foot in ("left", "right") for way in ("in front", "behind")}


def test_on_a_level_way_the_side_of_the_turn_says_which_foot_is_in_front() -> None:
    """On two pads a foot can go round the other one along a straight line, and she does not turn back there."""
    full, words = ("crossover-full",), "back to the screen"
    way = ((), {4: 0}, (4, 7)), (full, {3: 1}, (4, 3)), ((), {2: 0}, (2, 3))
    for facing, said in (((0, 180, 135), "in front"), ((0, 180, -135), "behind"), ((0, 180, 0), "in front")):
        play, pad = rows(*way, steps="dance-double")
        play.facing = np.array(facing, float)
        assert turning_phrase(words, (play, 1), pad, ENGLISH).text == f"{words}, right foot {said}"


def rows(*some: tuple[tuple[str, ...], dict[int, int], tuple[int, int]], steps: str = "dance-single") -> Any:
    """A play of rows of (moves, column -> limb, where the feet stand), a second apart."""
    pad = load_pad(steps)
    assert pad is not None
    limb = np.full((len(some), len(pad)), -1, np.int8)
    for number, (_, pressed, _) in enumerate(some):
        for column, who in pressed.items():
            limb[number, column] = who
    of_rows = SimpleNamespace(
        second=np.arange(float(len(some))), tick=96 * np.arange(len(some)), hold_end=np.full(limb.shape, -1)
    )
    feet = np.array([stand for *_, stand in some])
    moves = tuple(names for names, *_ in some)
    return SimpleNamespace(rows=of_rows, limb=limb, feet=feet, facing=np.zeros(len(some)), moves=moves), pad


def test_a_jump_that_crosses_names_the_foot_in_front() -> None:
    half = ("crossover-half", "jump")
    play, pad = rows(((), {0: 0, 3: 1}, (0, 3)), (half, {3: 0, 1: 1}, (3, 1)))
    assert crossing_phrase("crossover", (play, 1), pad, ENGLISH).text == "feet cross, left foot in front"
    play, pad = rows(((), {0: 0, 3: 1}, (0, 3)), (half, {3: 0, 2: 1}, (3, 2)))
    assert crossing_phrase("crossover", (play, 1), pad, ENGLISH) == Phrase(
        "crossover", "feet cross, right foot in front", "feet cross", "", "{move} ×{count}: first {said}"
    )


@pytest.mark.parametrize("name", config_names("languages"))
def test_every_language_names_the_one_foot_that_a_call_is_of(name: str) -> None:
    """As its label; so the edge of the call has its colour, and the tag names no foot."""
    language = load_language(name)
    own, other = language.limbs["right-foot"], language.limbs["left-foot"]
    crossing, pad = rows(((), {0: 0}, (0, 3)), (("crossover-back", "crossover-half"), {0: 1}, (3, 0)))
    turn = crossing_phrase(language.moves["crossover-half"], (crossing, 1), pad, language)
    swap = stepped_phrase(language.moves["footswitch-up"], "footswitch-up", [-1, -1, 1, -1], language)
    away = turning_phrase(language.moves["half-turn-away"], (crossing, 1), pad, language)
    for phrase in (turn, swap, away):
        assert own in phrase.text and other not in phrase.text and "{" not in "".join(phrase[:4])
        assert _foot_colour(phrase.text, language) == limb_colours().by_limb[1]
        assert own not in phrase.tag
    assert other in turn.why and turn.tag in standing_tags(language)
    assert swap.move == language.moves["footswitch-up"] != swap.text


def test_a_foot_that_steps_twice_has_no_such_reason() -> None:
    half = ("crossover-front", "crossover-half")
    twice, pad = rows(((), {0: 0}, (0, 1)), (half, {3: 0}, (3, 1)))
    assert crossing_phrase("crossover", (twice, 1), pad, ENGLISH).why == ""
    turn, pad = rows(((), {0: 0}, (0, 3)), ((), {1: 1}, (0, 1)), (half, {3: 0}, (3, 1)))
    assert crossing_phrase("crossover", (turn, 2), pad, ENGLISH).why == "right foot has just stepped"
    turn.rows.second[2] = 9.0
    assert crossing_phrase("crossover", (turn, 2), pad, ENGLISH).why == "", "long ago"


def test_crossovers_of_both_feet_are_counted_and_the_first_is_reported() -> None:
    left = Phrase("crossover", "left foot crosses in front", "cross in front", "", "{move} ×{count}: first {said}")
    assert left.text_of(1, True) == left.text
    assert left.text_of(3, True) == "left foot crosses in front ×3"
    assert left.text_of(3, False) == "crossover ×3: first left foot crosses in front"
