"""How many rows of labelled charts get the right feet, with the presets as they are and with fits that had not seen the
song; how true the confidence is on such songs; and how often a foot has to be in two places. The cross-validation takes
some minutes.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import NamedTuple

from dancetutor_cli.feet.preset import Preset, load_preset
from dancetutor_cli.feet.solver.solve import solve_rows

sys.path.append(str(Path(__file__).resolve().parent.parent / "research"))
import feet_data
import fit_weights

GOALS = {"song": "99", "pattern": "97.5", "pump-single": "97.5", "pump-double": "97.5", "pump-halfdouble": "98.5"}
PEERS = {  # on songs, patterns and Pump charts that are not here; see docs/feet.md
    "song": "ITGmania 97.3; SMEditor 98.5",
    "pattern": "ITGmania 85.5; SMEditor 90.9",
    "pump-single": "SMEditor 93.0",
    "pump-double": "SMEditor 92.1",
}
Row = tuple[str, float, str, str, str]


class Judged(NamedTuple):
    """Charts with the preset as it is; by fits that had not seen the song; predicted and actual per cent, and rows."""

    today: fit_weights.Outcome
    unseen: fit_weights.Outcome
    sure: list[tuple[float, float, int]]


def measure() -> list[Row]:
    """Rows for tools/bench.py; nothing where the labels are not here."""
    if not (feet_data.FEET / "labels.json").is_file():
        return []
    out: list[Row] = []
    for task in fit_weights.tasks():
        preset, result = load_preset(task.preset), judged(task)
        out += _rows(f"{task.preset}, ", result.today, judged=False)
        out += _rows(f"{task.preset}, song not seen, ", result.unseen, judged=True)
        off = max(abs(said - right) for said, right, rows in result.sure if rows >= 200)
        rows, steps = zip(*(teleports(label, preset) for label in (*task.judged, *task.guard)), strict=True)
        out.append((f"{task.preset}, a foot in two places", sum(rows), f"of {sum(steps):,} rows", "0", ""))
        out.append((f"{task.preset}, confidence off by, largest bin of 200 rows", off, "% points", "2", ""))
    return out


def judged(task: fit_weights.Task) -> Judged:
    """The cross-validation of a preset."""
    preset = load_preset(task.preset)
    whole, found = fit_weights.fit_of_all(task, preset)
    unseen = fit_weights.cross_validated(task, whole, preset, found)
    fitted = fit_weights.fitted(preset, found)
    _, sure = fit_weights.how_sure([*unseen, *fit_weights.outcome(task.unseen, fitted)])
    return Judged(fit_weights.outcome((*task.judged, *task.guard, *task.unmade), preset), unseen, sure)


def teleports(label: feet_data.Labelled, preset: Preset) -> tuple[int, int]:
    """Rows in which a foot is on a panel apart from the one it has stepped on within 80 ms; and all rows."""
    found = solve_rows(label.rows, label.pad, preset, margins=False)
    return int((found.cost[:, found.terms.index("teleport")] >= preset.curve("teleport")[0][1]).sum()), len(label.rows)


def _rows(what: str, results: fit_weights.Outcome, *, judged: bool) -> list[Row]:
    return [
        (
            f"{what}{kind}",
            100 * right / rows,
            f"% of {rows:,} rows",
            *((GOALS[kind], PEERS.get(kind, "")) if judged else ("", "")),
        )
        for kind, (right, rows) in sorted(fit_weights.percent(results).items())
    ]
