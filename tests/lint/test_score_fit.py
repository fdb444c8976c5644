"""The fit of scores: the ridge against a dense solve and its own conditions, pairs against a loop, whole songs."""

from __future__ import annotations

import sys
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize

from dancetutor_cli.lint.meter.score import ODDITIES, Oddities, TimingOddities, load_score_model

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "research"))
from meter_data import Labelled
from score_fit import Rated, community_level, deal, fitted, pairs_of, ridge, scores, shares, yaml_of

CHART = Labelled("a.sm", "", "t", "dance-single", "Hard", 9, 400, 100.0, ())


def problem(seed: int, n: int = 60, j: int = 5) -> tuple[np.ndarray, np.ndarray]:
    dice = np.random.default_rng(seed)
    columns = dice.normal(size=(n, j)) @ dice.normal(size=(j, j)) * dice.uniform(0.1, 5, j)
    target = columns @ dice.normal(size=j) + dice.normal(size=n)
    return columns - columns.mean(axis=0), target - target.mean()


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("pull", [0.1, 10.0, 1000.0])
def test_free_weights_are_those_of_a_dense_solve(seed: int, pull: float) -> None:
    """w = (Z^T Z + k S^2)^-1 Z^T y, Hoerl and Kennard 1970."""
    columns, target = problem(seed)
    dense = np.linalg.solve(columns.T @ columns + pull * np.diag(columns.var(axis=0)), columns.T @ target)
    assert ridge(columns, target, pull, np.ones(5, dtype=bool)) == pytest.approx(dense, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_bounded_weights_are_the_least_there_is(seed: int) -> None:
    """Against a minimiser that knows nothing of active sets, and by the conditions of Karush, Kuhn and Tucker."""
    columns, target = problem(seed + 100)
    free = np.array([True, False, False, False, False])
    found = ridge(columns, target, 10.0, free)
    spread = columns.var(axis=0)

    def missed(w: np.ndarray) -> float:
        return float(((target - columns @ w) ** 2).sum() + 10.0 * (spread * w**2).sum())

    bounds = [(None, None), *[(0.0, None)] * 4]
    other = minimize(missed, np.zeros(5), method="L-BFGS-B", bounds=bounds, options={"ftol": 1e-15, "gtol": 1e-10})
    assert missed(found) <= other.fun * (1 + 1e-6)
    slope = 2 * (columns.T @ (columns @ found - target) + 10.0 * spread * found)
    scale = np.abs(columns.T @ target).max()
    assert (found[1:] >= 0).all()
    assert np.abs(slope[(found > 0) | free]).max() < 1e-6 * scale
    assert (slope[(found == 0) & ~free] > -1e-6 * scale).all()


def test_a_greater_pull_makes_weights_shorter_and_a_constant_column_none() -> None:
    columns, target = problem(1)
    columns[:, 2] = 0.0
    free = np.ones(5, dtype=bool)
    found = [ridge(columns, target, pull, free) for pull in (1.0, 100.0, 10000.0)]
    lengths = [float(np.linalg.norm(one * columns.std(axis=0))) for one in found]
    assert lengths[0] > lengths[1] > lengths[2] > 0
    assert all(one[2] == 0.0 for one in found)


def made(seed: int, songs: int = 30) -> list[Rated]:
    """Charts of which the tier is half a level of odd waits, some of changes, and noise; the rest says nothing."""
    dice, out = np.random.default_rng(seed), []
    for song in range(songs):
        changes = int(dice.integers(0, 2) * dice.integers(1, 20))
        for pad in ("dance-single", "dance-double"):
            for level in dice.choice(np.arange(3, 18), 4, replace=False).tolist():
                numbers = dict(zip(ODDITIES, dice.uniform(0, 1, len(ODDITIES)).tolist(), strict=True))
                timing = TimingOddities(changes // 2, changes - changes // 2, 0.0)
                numbers |= dict(zip(ODDITIES[-2:], timing.numbers, strict=True))
                part = 0.5 * numbers["odd waits"] + 0.1 * numbers["changes"] + dice.normal(0, 0.02)
                chart = Oddities(tuple(numbers.values()), timing)
                out.append(Rated(f"song {song}", pad, level, level + min(part, 0.95), chart, CHART))
    return out


def test_the_fit_finds_what_tiers_are_made_of() -> None:
    charts = made(0)
    model = fitted(charts, 0.1)
    weights = {one.of: one.weight for of in model.terms.values() for one in of}
    assert weights["odd waits"] == pytest.approx(0.5, abs=0.03)
    assert weights["changes"] == pytest.approx(0.1, abs=0.02)
    assert all(abs(weight) < 0.05 for of, weight in weights.items() if of not in ("odd waits", "changes"))
    whole, untimed = scores(model, charts, community_level)
    assert np.abs(whole - [one.tier for one in charts]).mean() < 0.04
    assert (untimed <= whole + 1e-12).all()


def test_pairs_are_those_of_a_loop() -> None:
    charts = made(3, songs=12)
    looped = {
        (a, b) if charts[a].tier > charts[b].tier else (b, a)
        for a, b in combinations(range(len(charts)), 2)
        if (charts[a].steps_type, charts[a].level) == (charts[b].steps_type, charts[b].level)
        and charts[a].level >= 5 and abs(charts[a].tier - charts[b].tier) >= 0.3
    }  # fmt: skip
    pairs = pairs_of(charts)
    assert {*zip(pairs.harder.tolist(), pairs.easier.tolist(), strict=True)} == looped
    tiers = np.array([one.tier for one in charts])
    dice = np.random.default_rng(0).normal(size=len(charts))
    found = shares(pairs, (tiers, dice))
    assert found.whole == 1.0
    assert found.untimed == pytest.approx(np.mean([dice[a] > dice[b] for a, b in looped]))
    assert shares(pairs, (-tiers, 0 * tiers)) == type(found)(0.0, 0.5, len(looped))


def test_songs_are_dealt_whole_and_differently_each_time() -> None:
    charts = made(1)
    deals = [deal(charts, 4, seed).tolist() for seed in range(3)]
    for folds in deals:
        assert {*folds} == {0, 1, 2, 3}
        of_song = {(one.family, fold) for one, fold in zip(charts, folds, strict=True)}
        assert len(of_song) == len({one.family for one in charts})
    assert deals[0] != deals[1] != deals[2]
    assert 0 < sum(one.is_held for one in charts) < len(charts) / 2


def test_what_is_written_is_read_as_it_was(tmp_path: Path) -> None:
    charts = made(2)
    model = replace(fitted(charts, 1.0), below=0.2, above=0.25)
    path = tmp_path / "score.yaml"
    path.write_text(yaml_of(model, charts), encoding="utf-8")
    read = load_score_model(path)
    for one in charts[::7]:
        level = community_level(one)
        there = read.estimate(one.steps_type, level, one.oddities)
        assert there.meter == pytest.approx(model.estimate(one.steps_type, level, one.oddities).meter, abs=1e-3)
