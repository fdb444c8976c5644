"""The dynamic programme, margins, ambiguity and alternatives against listing every way to play a few rows."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from play_rows import first, letters, pad_of, rows_of

from dancetutor_cli.feet.pads import Pad
from dancetutor_cli.feet.play import Ambiguity, Rows
from dancetutor_cli.feet.preset import Preset, load_preset, preset_names
from dancetutor_cli.feet.solver.alternatives import alternatives
from dancetutor_cli.feet.solver.engine import Engine, _arrays, _nodes, engine_for
from dancetutor_cli.feet.solver.packing import empty_moves
from dancetutor_cli.feet.solver.solve import solve_rows
from dancetutor_cli.feet.solver.tables import COST, FACTS, FIRST, LIMB_CODES, MOVES, NEXT, TIMES, WIDE_ACTION

PRESETS = {name: load_preset(name) for name in preset_names()}
Ways = dict[tuple[int, ...], int]


def every_way(rows: Rows, pad: Pad, preset: Preset) -> Ways:
    """The least cost of every sequence of limbs, from the moves of the transition tables alone."""
    engine = engine_for(pad, preset)
    layers = engine.layers(rows)
    t = engine.tables
    ways: dict[tuple[int, ...], dict[int, int]] = {(): {layers.states[0][0]: 0}}
    for row in range(len(rows)):
        following: dict[tuple[int, ...], dict[int, int]] = defaultdict(dict)
        for limbs, states in ways.items():
            for state, cost in states.items():
                for move in layers.moves(row, state):
                    time = t.timed_row[layers.elapsed[row]]
                    price = int(t.move[move, COST]) + int(t.timed_cost[time, t.move[move, FACTS]]) - 1
                    reached = following[(*limbs, int(t.wide[move, WIDE_ACTION]) & LIMB_CODES)]
                    to = int(t.move[move, NEXT])
                    reached[to] = min(cost + price, reached.get(to, cost + price))
        ways = following
    return {limbs: min(states.values()) for limbs, states in ways.items()}


@st.composite
def few_rows(draw: st.DrawFn, columns: int = 4) -> Rows:
    words = []
    held: set[int] = set()
    for _ in range(draw(st.integers(1, 6 if columns == 4 else 4))):
        word = ""
        for p in range(columns):
            cell = draw(st.sampled_from("3....") if p in held else st.sampled_from("......112M4r"))
            held = held - {p} if cell == "3" else held | {p} if cell == "2" else held
            word += cell
        words.append(word)
    words.append("".join("3" if p in held else "." for p in range(columns)))
    return rows_of(" ".join(words), gap=draw(st.sampled_from([6, 12, 24, 96])))


@pytest.mark.parametrize(
    ("steps_type", "name"),
    [*(("dance-single", name) for name in ("thesis", "itg", "ddr", "pump")), ("smx-single", "smx")],
)
def test_against_every_way(steps_type: str, name: str) -> None:
    pad, preset = pad_of(steps_type), PRESETS[name]

    @settings(max_examples=60, deadline=None)
    @given(few_rows(len(pad)))
    def check(rows: Rows) -> None:
        if len(rows):
            check_rows(rows, pad, preset)

    check()


def check_rows(rows: Rows, pad: Pad, preset: Preset) -> None:
    ways = every_way(rows, pad, preset)
    least = min(ways.values())
    found = solve_rows(rows, pad, preset)
    assert found.total == least
    assert found.margin is not None and found.ambiguity is not None
    wanted = found.limb.tolist()
    chosen = [way for way, cost in ways.items() if cost == least and codes(way, len(pad)) == wanted]
    assert chosen
    for row in range(len(rows)):
        others = {way: cost for way, cost in ways.items() if way[row] != chosen[0][row]}
        assert found.margin[row] == (min(others.values()) - least if others else -1)
        ties = [way for way, cost in others.items() if cost == least]
        same = any(way[row + 1 :] == chosen[0][row + 1 :] for way in ties)
        assert found.ambiguity[row] == (Ambiguity.RESOLVED if same else Ambiguity.OPEN if ties else Ambiguity.NONE)
    check_alternatives(rows, pad, preset, ways)


def check_alternatives(rows: Rows, pad: Pad, preset: Preset, ways: Ways) -> None:
    best = alternatives(rows, pad, preset, 7)
    assert [other.play.total for other in best] == sorted(ways.values())[:7]
    assert len({other.play.limb.tobytes() for other in best}) == len(best)
    for other in best:
        assert other.extra == other.play.total - best[0].play.total == sum(other.terms.values())
        assert codes_cost(other.play.limb, ways) == other.play.total
        differing = np.flatnonzero((other.play.limb != best[0].play.limb).any(axis=1)).tolist()
        assert list(other.rows) == differing


def codes(way: tuple[int, ...], panels: int) -> list[list[int]]:
    """Packed limb codes as the limbs of `Play.limb`."""
    limbs = {0: -1, 1: 0, 2: 1, 3: 2, 4: 3, 5: -2}
    return [[limbs[action >> 3 * p & 7] for p in range(panels)] for action in way]


def codes_cost(limb: np.ndarray, ways: Ways) -> int:
    return next(cost for way, cost in ways.items() if codes(way, limb.shape[1]) == limb.tolist())


def test_alternatives_say_what_decides() -> None:
    """A run that starts on the wrong foot needs a doublestep or a crossover; the second best says which."""
    rows = rows_of("1... ...1 .1.. ..1. ...1 .1.. 1...")
    first, second = alternatives(rows, pad_of("dance-single"), PRESETS["thesis"], 2)
    assert first.extra == 0 and first.rows == () and first.terms == {}
    assert second.extra == sum(second.terms.values()) and second.rows


def test_cost_terms_add_up_to_the_cost(corpus_rows: list[tuple[str, Rows]]) -> None:
    for steps_type, rows in corpus_rows:
        for preset in PRESETS.values():
            found = solve_rows(rows, pad_of(steps_type), preset)
            assert found.total == alternatives(rows, pad_of(steps_type), preset, 1)[0].play.total
            assert len(found.terms) == found.cost.shape[1] and (found.cost >= 0).all()


def test_of_ways_as_cheap_the_left_foot_begins_and_stands_left() -> None:
    pad, preset = pad_of("dance-single"), PRESETS["itg"]
    assert letters(solve_rows(rows_of("..1."), pad, preset)) == "..L."
    assert solve_rows(rows_of(".11."), pad, preset).limb.tolist() == [[-1, 0, 1, -1]]


def test_what_was_solved_before_changes_nothing(corpus_rows: list[tuple[str, Rows]]) -> None:
    """Not even which of the ways as cheap is taken: the numbers of states, but not their order, come from before."""
    preset = PRESETS["itg"]
    for steps_type, rows in corpus_rows:
        pad = pad_of(steps_type)
        backwards = Rows(
            rows.tick, rows.second, rows.line, *(getattr(rows, name)[::-1] for name in ("steps", "hold_end", "mines")),
            rows.milliseconds,
        )  # fmt: skip
        fresh, used = Engine(pad, preset), Engine(pad, preset)
        used.cheapest(backwards)
        assert (used.cheapest(rows).limb == fresh.cheapest(rows).limb).all()
        assert used.tables.state_key[:40].tolist() != fresh.tables.state_key[:40].tolist()
        assert (used.cheapest(first(rows, 99)).limb == Engine(pad, preset).cheapest(first(rows, 99)).limb).all()
        used.tables.counts[MOVES] = 3_000_000  # so full that the tables start again
        fresh = Engine(pad, preset)
        assert (used.cheapest(rows).limb == fresh.cheapest(rows).limb).all() and used.tables.counts[MOVES] < 3_000_000
        assert used.tables.counts.tolist() == fresh.tables.counts.tolist()
        for field in ("met", "timed_cost", "state_hash", "transition_hash"):  # the used ones may be longer
            kept, new = (np.sort(getattr(engine.tables, field), axis=None) for engine in (used, fresh))
            assert kept[kept > 0].tolist() == new[new > 0].tolist(), field


def test_little_room_changes_nothing(corpus_rows: list[tuple[str, Rows]]) -> None:
    """A kernel that has no room left, for nodes or for a layer, goes on where it was when it gets more."""
    for steps_type, rows in corpus_rows[:6]:
        pad, preset = pad_of(steps_type), PRESETS["itg"]
        usual, little = Engine(pad, preset), Engine(pad, preset)
        expected = usual.cheapest(rows, None, margins=True)
        little._making = little._making._replace(moves=empty_moves(len(preset.weights), 1))
        nodes = usual._run(_arrays(rows, None), usual._empty_path(*rows.steps.shape, margins=False))
        used = int(nodes.row[len(rows) + 1, FIRST])
        for room in (1, used, used + 1):
            found = little._empty_path(*rows.steps.shape, margins=True)
            little._run_to_end(0, _arrays(rows, None), _nodes(len(rows), np.empty(room, dtype=np.int64)), found)
            for field in ("limb", "part", "margin", "ambiguity"):
                assert np.array_equal(getattr(found, field), getattr(expected, field)), (steps_type, room, field)


def test_more_times_between_rows_than_there_is_room_for(corpus_rows: list[tuple[str, Rows]]) -> None:
    """What rows cost by time is kept for each time that is met; the sum of terms is computed without what is kept."""
    for steps_type, rows in corpus_rows:
        pad, preset, n = pad_of(steps_type), PRESETS["itg"], len(rows)
        little, enough = Engine(pad, preset), Engine(pad, preset)
        little.tables = little.tables._replace(timed_cost=np.zeros((2, 3), dtype=np.int32))
        for seed in range(3):
            times = np.random.default_rng(seed).permutation(np.arange(30, 3 * n + 30, 3))
            rows = replace(rows, milliseconds=times)
            found, expected = (engine.cheapest(rows, None, margins=True) for engine in (little, enough))
            for field in ("limb", "part", "margin", "ambiguity"):
                assert np.array_equal(getattr(found, field), getattr(expected, field)), (steps_type, seed, field)
            total = little.cost_and_events(rows)[0]
            assert total == little.with_details(rows, found).cost[:n].sum() > 0
        assert len(little.tables.timed_cost) >= int(little.tables.counts[TIMES]) >= n - 1


@pytest.fixture(scope="module")
def corpus_rows() -> list[tuple[str, Rows]]:
    rng = np.random.default_rng(5)
    out = []
    for steps_type, c in (("dance-single", 4), ("dance-double", 8)):
        words = ["".join("1" if p in rng.choice(c, rng.integers(1, 3)) else "." for p in range(c)) for _ in range(150)]
        out.append((steps_type, rows_of(" ".join(words), gap=12)))
    return out
