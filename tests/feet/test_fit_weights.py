"""The fits of research/fit_weights.py: true gradients, weights that learn what labels say, an author's own preset."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from play_rows import pad_of, rows_of, with_values

from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.engine import cost_at
from dancetutor_cli.feet.solver.solve import solve_rows

RESEARCH = Path(__file__).parents[2] / "research"
ITG = load_preset("itg")


@pytest.fixture(scope="module")
def tools() -> Iterator[SimpleNamespace]:
    sys.path.insert(0, str(RESEARCH))
    try:
        import feet_confidence
        import feet_data
        import feet_fit
        import fit_weights

        yield SimpleNamespace(confidence=feet_confidence, data=feet_data, fit=feet_fit, weights=fit_weights)
    finally:
        sys.path.remove(str(RESEARCH))


@pytest.fixture(scope="module")
def jumper(tools: SimpleNamespace):  # type: ignore[no-untyped-def]
    """Somebody who switches feet wherever she can: left, down, down again with the other foot, right; and mirrored."""
    out = []
    for name, (picture, feet) in {
        "one": ("1... .1.. .1.. ...1 1... ..1. ..1. ...1", "LRLRLRLR"),
        "two": ("...1 .1.. .1.. 1... ...1 ..1. ..1. 1...", "RLRLRLRL"),
    }.items():
        column = np.array([word.index("1") for word in picture.split()])
        foot = np.array(["LR".index(letter) for letter in feet])
        pad = pad_of("dance-single")
        rows = rows_of(picture, 48, 150.0)
        out.append(tools.data.Labelled(name, "mine", name, rows, pad, np.arange(len(column)), column, foot))
    return out


def test_the_gradient_is_that_of_the_likelihood(tools: SimpleNamespace, jumper) -> None:  # type: ignore[no-untyped-def]
    data, at = tools.fit.shares(jumper, ITG), tools.fit.vector(ITG)
    _, gradient = tools.fit.loss(at, data)
    for number in np.argsort(-np.abs(gradient))[:12]:
        step = np.zeros_like(at)
        step[number] = 1e-5
        slope = (tools.fit.loss(at + step, data)[0] - tools.fit.loss(at - step, data)[0]) / 2e-5
        assert slope == pytest.approx(gradient[number], rel=1e-4, abs=1e-8)


@pytest.mark.parametrize("method", ["likelihood", "perceptron"])
def test_a_fit_takes_over_what_labels_say(tools: SimpleNamespace, jumper, method: str) -> None:  # type: ignore[no-untyped-def]
    never = with_values(ITG, curves={"footswitch": ((100, 900),)})
    data, start = tools.fit.shares(jumper, never), tools.fit.vector(never)
    before = np.concatenate(list(tools.fit.right(start, data).values())).mean()
    found = (
        tools.fit.likelihood(start, data)
        if method == "likelihood"
        else tools.fit.perceptron(start, data, rounds=200, rate=0.05)
    )
    after = np.concatenate(list(tools.fit.right(found, data).values())).mean()
    assert before < 1.0 == after


def test_a_falling_curve_never_rises_with_time(tools: SimpleNamespace, jumper) -> None:  # type: ignore[no-untyped-def]
    """She switches feet at 400 ms, so a switch gets cheap there and, held to fall, at every longer time."""
    never = with_values(ITG, curves={"footswitch": ((100, 900),)})
    data, start = tools.fit.shares(jumper, never), tools.fit.vector(never)
    free, held = (
        dict(tools.fit.fitted(never, tools.fit.likelihood(start, data, within)).curves)["footswitch"]
        for within in (tools.fit.limits({}), tools.fit.limits({}, ("footswitch",)))
    )
    costs = {name: [cost for _, cost in curve] for name, curve in (("free", free), ("held", held))}
    assert costs["free"] != sorted(costs["free"], reverse=True)
    assert costs["held"] == sorted(costs["held"], reverse=True)
    for curve in (free, held):
        assert cost_at(curve, np.array([400]))[0] < 300


def test_the_fit_sees_what_the_solver_finds(tools: SimpleNamespace, jumper) -> None:  # type: ignore[no-untyped-def]
    """The cheapest way through the graph is the solver's play, with the preset that a vector makes."""
    vector = tools.fit.vector(ITG)
    preset = tools.fit.fitted(ITG, vector)
    assert preset.weights == ITG.weights and preset.curves == ITG.curves
    for label in jumper:
        right, _ = tools.data.right_rows(label, preset)
        assert (tools.fit.right(vector, tools.fit.shares([label], ITG))[label.name] == right).all()


def test_an_authors_pins_make_a_preset(tools: SimpleNamespace, jumper, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    never = with_values(ITG, curves={"footswitch": ((100, 900),)})
    many = jumper * 40
    path = tmp_path / "mine.yaml"
    path.write_text(tools.weights.own_preset(many, never, "itg"), encoding="utf-8")
    mine = load_preset(path)
    assert mine.name == "mine" and cost_at(mine.curve("footswitch"), np.array([400]))[0] < 900
    assert tools.weights.own_preset(jumper[:1], ITG, "itg").startswith("extends: itg\n")


def test_numbers_of_a_preset_are_written_between_its_comments(tools: SimpleNamespace) -> None:
    text = "weights:\n  spin: 1  # turns on\ncurves:\n  # too\n  jack: {0: 1, 9: 2}\nconfidence: {0: 500}\n"
    preset = with_values(ITG, weights={"spin": 77}, curves={"jack": ((100, 5), (200, 0))})
    assert tools.weights.refreshed(text, preset, {0: 510, 10: 700}) == (
        "weights:\n  spin: 77  # turns on\ncurves:\n  # too\n  jack: {100: 5, 200: 0}\nconfidence: {0: 510, 10: 700}\n"
    )


def test_a_preset_that_loses_rows_of_a_set_is_not_written(
    tools: SimpleNamespace, jumper, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:  # type: ignore[no-untyped-def]
    """Labels say that she jacks and crosses over; other charts, that no fit sees, have the feet of today's preset."""
    weights = tools.weights
    words = ("LRRLRLLR", "RLLRLRRL")
    jacks = [replace(x, foot=np.array(["LR".index(f) for f in word])) for x, word in zip(jumper, words, strict=True)]
    solved = [solve_rows(label.rows, label.pad, ITG).limb[label.row, label.column] for label in jumper]
    others = [replace(label, kind="other", foot=feet) for label, feet in zip(jumper, solved, strict=True)]
    for name in ("itg.yaml", "pump.yaml"):
        (tmp_path / name).write_text((weights.PRESETS / name).read_text(encoding="utf-8"), encoding="utf-8")
    before = (tmp_path / "itg.yaml").read_text(encoding="utf-8")
    monkeypatch.setattr(weights, "PRESETS", tmp_path)
    monkeypatch.setattr(weights, "DOCS", tmp_path)
    monkeypatch.setattr(weights, "FOLDS", {"itg": 2})
    written = []
    for unmade in (others, []):
        task = weights.Task("itg", jacks, [], [], unmade, [], tools.fit.limits({}))
        monkeypatch.setattr(weights, "tasks", lambda task=task: [task])
        weights.fit_all(True, None, both=False)
        written.append((tmp_path / "itg.yaml").read_text(encoding="utf-8") != before)
    assert written == [False, True]
    assert "itg stays as it is: the new one has fewer rows right, other " in capsys.readouterr().out


def test_songs_stay_together_in_folds(tools: SimpleNamespace) -> None:
    labels = [SimpleNamespace(group=group) for group in "aabbccddeeff"]
    fold = tools.data.folds(labels, 3)
    assert (fold[::2] == fold[1::2]).all() and set(fold.tolist()) == {0, 1, 2}


def test_confidence_is_as_often_right_as_it_says(tools: SimpleNamespace) -> None:
    """On rows whose chance is known: margins m that are right with 1 / (1 + exp(-m / 100))."""
    rng = np.random.default_rng(3)
    results = []
    for number in range(20):
        margin = rng.integers(0, 600, 2000)
        right = rng.random(2000) < 1 / (1 + np.exp(-margin / 100))
        results.append((SimpleNamespace(group=str(number)), right, margin))
    curve = tuple(tools.confidence.calibrated(results).items())
    for margin in (0, 50, 100, 200, 400):
        said = cost_at(curve, np.array([margin]))[0] / 1000
        assert said == pytest.approx(1 / (1 + np.exp(-margin / 100)), abs=0.03)
    for said, right, rows in tools.confidence.reliability(results, tools.data.folds):
        assert rows < 300 or abs(said - right) < 2
