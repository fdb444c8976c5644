"""How many rows of labelled charts get the right feet: with preset itg, and where no fit has seen the chart.

For the latter each chart in turn is left out of a fit that starts from other programs' weights; a minute and more.
"""

from __future__ import annotations

from pathlib import Path

import fit_weights

from dancetutor_cli.play import load_preset

HERE = Path(__file__).resolve().parent
LABELS = HERE.parent.parent / "shared" / "data" / "feet"
GOALS = {"song": "99.5", "pattern": "97"}
PEERS = {"song": "ITGmania 97.6; SMEditor 98.7", "pattern": "ITGmania 84.2; SMEditor 93.3"}
ROUNDS = 3
Row = tuple[str, float, str, str, str]


def measure() -> list[Row]:
    """Rows for tools/bench.py; nothing where the labels are not here."""
    if not (LABELS / "labels.json").is_file():
        return []
    labels = fit_weights.load_labels(LABELS)
    start = load_preset(HERE / "peer_weights.yaml")
    left_out = fit_weights.leave_one_out(
        fit_weights.Losses(labels, start), [name for name, _ in start.weights], ROUNDS, lambda *_: None
    )
    return [
        *_rows("itg, ", fit_weights.score(labels, load_preset("itg")), GOALS),
        *_rows("left out of the fit, ", left_out, {}),
    ]


def _rows(what: str, scores: dict[str, tuple[int, int]], goals: dict[str, str]) -> list[Row]:
    return [
        (f"{what}{kind}s", 100 * right / rows, f"% of {rows:,} rows", goals.get(kind, ""), PEERS.get(kind, ""))
        for kind, (right, rows) in sorted(scores.items())
    ]
