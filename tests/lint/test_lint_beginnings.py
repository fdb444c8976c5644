"""Where a dancer begins anew: all steps at once, against one step after the other."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from dancetutor_cli.chart.reader import load
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.lint.other_foot import Beginnings
from dancetutor_cli.run.reading import charts_path


def begins_anew(play: Play, rows: list[int], pauses: list[float], at: int, quick: float) -> bool:
    """docs/linter.md, "How quick" and "What it is", word by word."""
    if at == 0:
        return True
    around = sorted(pauses[max(at - 7, 1) : at + 8])
    pace = around[(len(around) - 1) // 2]
    rest = pauses[at] >= 0.22 and pauses[at] >= 1.75 * pace
    pair = any((play.limb[rows[one]] >= 0).sum() > 1 for one in (at - 1, at))
    wall = any(play.rows.mines[row].sum() >= 3 for row in range(rows[at - 1] + 1, rows[at]))
    return bool(rest or pair or wall or pauses[at] > max(0.45, quick + 1e-6))


def charts(folder: Path) -> list[Path]:
    files = sorted(path for path in folder.rglob("*") if path.suffix.lower() in (".sm", ".ssc"))
    return [charts_path() / "two_left_feet" / "two_left_feet.ssc", *files[::40]]


def test_all_at_once_is_one_after_the_other(corpus: Path) -> None:
    seen = {False: 0, True: 0}
    for path in charts(corpus):
        for chart in load(path).charts[:3]:
            play = solve_chart(chart, load_preset("itg"))
            if play is None:
                continue
            rows = np.flatnonzero(play.rows.steps.any(axis=1))
            pauses = np.concatenate([[math.inf], np.diff(play.rows.second[rows])])[: len(rows)]
            for quick in (0.2, 0.6):
                found = Beginnings(play, rows, pauses)
                known = rows.tolist(), pauses.tolist()
                said = [begins_anew(play, *known, at, quick) for at in range(len(rows))]
                assert found.fresh_starts(quick).tolist() == said
                for at in range(0, len(rows), 37):
                    first, last = found.segment(at, quick)
                    assert said[first] and not any(said[first + 1 : last + 1]) and first <= at <= last
                    assert last + 1 == len(rows) or said[last + 1]
                for one in said:
                    seen[one] += 1
    assert min(seen.values()) > 1000
