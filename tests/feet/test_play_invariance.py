"""What must not change the feet: mirroring the chart, shifting its offset, writing its rows on a finer grid."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from play_rows import check_mirror, pad_of, timed

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.play import Rows, StepKind, prepare_rows
from dancetutor_cli.feet.preset import load_preset, preset_names
from dancetutor_cli.feet.solver.solve import solve_chart, solve_rows
from dancetutor_cli.run.errors import DancetutorError

PRESETS = {name: load_preset(name) for name in preset_names()}


@cache
def sample(
    corpus: Path, every: int, steps_types: tuple[str, ...] = ("dance-single", "dance-double")
) -> list[tuple[Song, Chart]]:
    """Every n-th real chart of the given types."""
    found = []
    for path in sorted(p for p in corpus.rglob("*") if p.suffix.lower() in (".sm", ".ssc")):
        try:
            song = load(path)
        except DancetutorError:
            continue
        found += [(song, chart) for chart in song.charts if chart.steps_type in steps_types]
    return found[::every]


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_mirroring_real_charts_left_right_mirrors_the_feet(corpus: Path, name: str) -> None:
    sure = total = 0
    for _, chart in sample(corpus, 20):
        pad = pad_of(chart.steps_type)
        rows = prepare_rows(chart, pad)
        sure += check_mirror(rows, pad, PRESETS[name], left_right=True)
        total += len(rows)
    assert total > 20_000 and sure > total // 2


def test_mirroring_up_down_mirrors_the_feet_of_thesis_without_hands(corpus: Path) -> None:
    checked = 0
    for _, chart in sample(corpus, 20):
        pad = pad_of(chart.steps_type)
        rows = prepare_rows(chart, pad)
        if ((rows.steps > 0).sum(axis=1) <= 2).all() and (solve_rows(rows, pad, PRESETS["thesis"]).limb <= 1).all():
            checked += check_mirror(rows, pad, PRESETS["thesis"], left_right=False)
    assert checked > 5_000


@st.composite
def busy_rows(draw: st.DrawFn) -> Rows:
    """Rows with brackets, hands, mines, holds and rolls, more of them than real charts have."""
    n = draw(st.integers(1, 16))
    ticks = np.cumsum(draw(st.lists(st.sampled_from([6, 12, 24, 48, 192]), min_size=n, max_size=n)))
    cells = np.array(draw(st.lists(st.sampled_from("....11124rM"), min_size=4 * n, max_size=4 * n))).reshape(n, 4)
    steps = np.zeros((n, 4), dtype=np.uint8)
    for letter, kind in {"1": StepKind.TAP, "2": StepKind.HOLD, "4": StepKind.ROLL, "r": StepKind.ROLL_TAP}.items():
        steps[cells == letter] = kind
    hold_end = np.where(steps == StepKind.HOLD, ticks[:, None] + 30, -1)
    mines = cells == "M"
    for row in range(1, n):  # what a hold is under is not there
        held = (hold_end[:row] > ticks[row]).any(axis=0)
        steps[row, held], mines[row, held], hold_end[row, held] = 0, False, -1
    kept = (steps > 0).any(axis=1) | mines.any(axis=1)
    return timed(ticks[kept], steps[kept], hold_end[kept], mines[kept], 140.0)


@settings(max_examples=60, deadline=None)
@given(busy_rows(), st.sampled_from(sorted(PRESETS)))
def test_mirroring_odd_rows(rows: Rows, name: str) -> None:
    check_mirror(rows, pad_of("dance-single"), PRESETS[name], left_right=True)


def same_feet(before: Chart, after: Chart) -> None:
    """Both charts have the same rows, limbs and costs in every preset."""
    for preset in PRESETS.values():
        one, other = solve_chart(before, preset), solve_chart(after, preset)
        assert one is not None and other is not None
        assert one.rows.tick.tolist() == other.rows.tick.tolist()
        assert np.array_equal(one.limb, other.limb) and np.array_equal(one.cost, other.cost)
        assert one.margin is not None and np.array_equal(one.margin, other.margin) and one.moves == other.moves


def test_shifting_the_offset_changes_nothing(corpus: Path) -> None:
    checked = 0
    for song, chart in sample(corpus, 60):
        shifted = re.sub(rb"#OFFSET:([^;]*);", lambda m: b"#OFFSET:%.3f;" % (float(m[1] or 0) + 0.123), song.data)
        if shifted != song.data:
            after = parse(shifted, song.path).charts[chart.index]
            assert after.timing.offset != chart.timing.offset
            same_feet(chart, after)
            checked += 1
    assert checked > 10


def finer(song: Song, chart: Chart) -> bytes:
    """The file with the chart's measures written in 192 rows where that is possible, zeros between."""
    lines = {int(line): 1 for line in chart.rows.line}
    counts = np.bincount(chart.rows.measure)
    for measure, count in enumerate(counts.tolist()):
        first = int(counts[:measure].sum())
        if count and 192 % count == 0:
            for row in range(first, first + count):
                lines[int(chart.rows.line[row])] = 192 // count
    out = []
    for number, text in enumerate(song.data.split(b"\n"), start=1):
        out.append(text)
        out += [b"0" * chart.columns] * (lines.get(number, 1) - 1)
    return b"\n".join(out)


def test_writing_rows_on_a_finer_grid_changes_nothing(corpus: Path) -> None:
    checked = 0
    for song, chart in sample(corpus, 60):
        count = np.bincount(chart.rows.measure)
        if len(set(chart.rows.line.tolist())) < len(chart.rows.line) or not len(count):
            continue  # several rows on one line
        after = parse(finer(song, chart), song.path).charts[chart.index]
        if count.max() <= 192 and len(after.rows.tick) > len(chart.rows.tick):
            same_feet(chart, after)
            checked += 1
    assert checked > 10


@pytest.mark.parametrize("name", ["thesis", "itg"])
def test_limbs_and_panels_agree(corpus: Path, name: str) -> None:
    """Where a foot pressed is where it stands after the row (a bracket: its heel)."""
    for _, chart in sample(corpus, 80):
        found = solve_chart(chart, PRESETS[name])
        assert found is not None
        for foot in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
            rows, columns = np.nonzero((found.limb == foot) & (found.part != Part.TOE))
            whole = np.isin(found.rows.steps[rows, columns], (StepKind.TAP, StepKind.HOLD, StepKind.LIFT))
            assert (found.feet[rows[whole], foot] == columns[whole]).all()
