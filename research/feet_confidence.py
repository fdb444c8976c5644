"""How sure a row is: from its margin to how often rows with such a margin are right.

Isotonic regression of right and wrong rows on their margins, on songs that the weights had not seen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from feet_data import Labelled
from numpy.typing import NDArray
from scipy.optimize import isotonic_regression

from dancetutor_cli.feet.solver.engine import cost_at

Outcome = Sequence[tuple[Labelled, NDArray[np.bool_], NDArray[np.int64]]]
MARGINS = (0, 20, 40, 70, 100, 140, 180, 230, 290, 360, 450, 600, 900)  # knots of the curve
EDGES = (0, 60, 70, 80, 88, 92, 95, 97, 98, 99, 99.5, 100.01)  # of the bins of a table, per cent


def _flat(results: Outcome) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    margin = np.concatenate([m for _, _, m in results])
    right = np.concatenate([r for _, r, _ in results]).astype(float)
    return margin[margin >= 0], right[margin >= 0]


def calibrated(results: Outcome) -> dict[int, int]:
    """Tenths of a per cent by margin, at `MARGINS`; straight lines between them."""
    margin, right = _flat(results)
    order = np.argsort(margin, kind="stable")
    smooth = isotonic_regression(right[order]).x
    middles = [(smooth[_near(margin[order], knot)].mean()) for knot in MARGINS]
    raised = np.maximum.accumulate(np.clip(middles, 0.5, 0.999))
    return {knot: round(1000 * float(value)) for knot, value in zip(MARGINS, raised, strict=True)}


def _near(margins: NDArray[np.int64], knot: int) -> slice:
    """Rows about a margin: at least some, or the mean says nothing."""
    wide = max(4, knot // 8)
    first, end = np.searchsorted(margins, [knot - wide, knot + wide + 1])
    least = 25
    if end - first < least:
        middle = int(np.searchsorted(margins, knot))
        first, end = max(0, middle - least), min(len(margins), middle + least)
    return slice(int(first), int(end))


def reliability(
    results: Outcome, folds: Callable[[list[Labelled], int], NDArray[np.int64]]
) -> list[tuple[float, float, int]]:
    """Predicted and actual per cent, and rows: each half calibrated on the other."""
    half = folds([label for label, _, _ in results], 2)
    said, right = [], []
    for number in range(2):
        known = [x for x, own in zip(results, half, strict=True) if own != number]
        unknown = [x for x, own in zip(results, half, strict=True) if own == number]
        curve = tuple(calibrated(known).items())
        margin, good = _flat(unknown)
        said.append(cost_at(curve, margin) / 10)
        right.append(good)
    every, good = np.concatenate(said), np.concatenate(right)
    bins = np.digitize(every, EDGES)
    return [
        (float(every[bins == b].mean()), 100 * float(good[bins == b].mean()), int((bins == b).sum()))
        for b in np.unique(bins)
    ]


def chart_of_calibration(name: str, table: Sequence[tuple[float, float, int]]) -> str:
    """An SVG: predicted against actual, a circle for each bin, its area by the number of rows."""
    size, edge, low = 360, 46, 50.0

    def place(value: float) -> float:
        return edge + (max(value, low) - low) / (100 - low) * (size - 2 * edge)

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size} {size}" font-family="sans-serif" font-size="12">',
        f'<rect width="{size}" height="{size}" fill="#fff"/>',
        f'<text x="{size / 2}" y="20" text-anchor="middle">preset {name}: confidence on songs not seen</text>',
        f'<line x1="{edge}" y1="{size - edge}" x2="{size - edge}" y2="{edge}" stroke="#bbb" stroke-dasharray="4"/>',
    ]
    for tick in range(50, 101, 10):
        x, y = place(tick), size - place(tick)
        lines += [
            f'<text x="{x:.0f}" y="{size - edge + 18}" text-anchor="middle">{tick}</text>',
            f'<text x="{edge - 8}" y="{y + 4:.0f}" text-anchor="end">{tick}</text>',
        ]
    most = max(rows for _, _, rows in table)
    for said, right, rows in table:
        radius = 3 + 9 * (rows / most) ** 0.5
        lines.append(
            f'<circle cx="{place(said):.1f}" cy="{size - place(right):.1f}" r="{radius:.1f}" fill="#2a6fb0" '
            f'fill-opacity="0.6"><title>said {said:.1f} %, right {right:.1f} % of {rows} rows</title></circle>'
        )
    lines += [
        f'<text x="{size / 2}" y="{size - 8}" text-anchor="middle">said, per cent</text>',
        f'<text x="14" y="{size / 2}" transform="rotate(-90 14 {size / 2})" text-anchor="middle">right, %</text>',
        "</svg>",
    ]
    return "\n".join(lines) + "\n"
