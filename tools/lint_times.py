"""How many charts of each meter contain a move, by how quick it is: writes configs/move_times.yaml.

    tools/lint_times.py FOLDER          # of charts, searched for .sm and .ssc

Charts with the same notes count once; a move counts where the feet are sure (`sure-feet` in configs/lint/default.yaml).
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import find_files
from dancetutor_cli.lint.analysis import solve_selected
from dancetutor_cli.lint.rule import TimedRule, all_rules
from dancetutor_cli.lint.rule_settings import default_rules
from dancetutor_cli.lint.run import LintRequest, LintRun
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.reading import config_path

TARGET = config_path("lint/default.yaml").parent.parent / "move_times.yaml"
MILLISECONDS = (75, 100, 125, 150, 175, 200, 225, 250, 275, 300, 350, 400, 450)
METERS = {"dance-single": (3, 6, 9, 12), "dance-double": (3, 6, 9, 12), "pump-single": (7, 13, 17, 20),
          "pump-double": (7, 13, 17, 20)}  # fmt: skip
HEAD = """\
# What share of charts contain a move at most so quick, in per cent: what rules with `max_seconds: by-meter` go by.
# Written by tools/lint_times.py from {charts} charts; a move counts where its feet are sure.
# meters: the last meter of each band of a pad, one more band above them. charts: how many there are of each band.
"""


def subjects(folder: Path) -> Iterator[tuple[ChartSubject, Any]]:
    """Every different chart below a folder that has feet, with its settings."""
    run = LintRun(LintRequest(config="default"))
    seen: set[tuple[str, bytes, bytes]] = set()
    for path in find_files([folder]):
        try:
            song = load(path)
        except DancetutorError:
            continue
        task = run.task(path)
        for subject in solve_selected(song, song.charts, task):
            play = subject.play
            if play is None or not subject.row_count:
                continue
            key = (subject.chart.steps_type, play.rows.steps.tobytes(), play.rows.tick.tobytes())
            if key not in seen:
                seen.add(key)
                yield subject, task.settings


def quickest(rule: type[TimedRule], subject: ChartSubject, sure: float) -> float:
    """Milliseconds of the quickest move of a rule in a chart, endless without one."""
    assert subject.play is not None
    options = {
        **default_rules()[rule.code],
        "severity": "info",
        "max_seconds": MILLISECONDS[-1] / 1000,
        "least_meter": 10**9,
    }
    found = [float("inf")]
    for row, seconds, _, _ in rule(options).occurrences(subject):
        confidence = subject.confidence(float(subject.play.rows.tick[row]) / 48)[1]
        if seconds > 0 and (confidence is None or 100 * confidence >= sure):
            found.append(1000 * seconds)
    return min(found)


def main() -> int:
    """Measure, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--output", type=Path, default=TARGET)
    given = parser.parse_args()
    rules = {rule.times: rule for rule in all_rules().values() if issubclass(rule, TimedRule) and rule.times}
    rules["doublestep"] = next(rule for rule in all_rules().values() if rule.name == "doublestep")  # type: ignore[assignment]
    fastest: dict[tuple[str, str, int], list[float]] = defaultdict(list)
    count: dict[tuple[str, int], int] = defaultdict(int)
    for subject, settings in subjects(given.folder):
        pad = _pad(subject.chart.steps_type)
        band = sum(subject.chart.meter > last for last in METERS[pad])
        count[pad, band] += 1
        for move, rule in rules.items():
            fastest[move, pad, band].append(quickest(rule, subject, settings.sure_feet))
    given.output.write_text(_written(sorted(rules), fastest, count), encoding="utf-8")
    return 0


def _pad(steps_type: str) -> str:
    family, _, kind = steps_type.partition("-")
    pad = f"{family}-{'double' if kind in ('halfdouble', 'double', 'routine') else 'single'}"
    return pad if pad in METERS else "dance-single"


def _written(moves: list[str], fastest: dict[Any, list[float]], count: dict[Any, int]) -> str:
    lines = [HEAD.format(charts=f"{sum(count.values()):,}"), "meters:\n"]
    lines += [f"  {pad}: {list(lasts)}\n" for pad, lasts in METERS.items()]
    lines.append("charts:\n")
    lines += [f"  {pad}: {[count[pad, band] for band in range(len(lasts) + 1)]}\n" for pad, lasts in METERS.items()]
    lines.append(f"milliseconds: {list(MILLISECONDS)}\nmoves:\n")
    for move in moves:
        lines.append(f"  {move}:\n")
        for pad, lasts in METERS.items():
            lines.append(f"    {pad}:\n")
            for band in range(len(lasts) + 1):
                times = fastest[move, pad, band]
                shares = [
                    round(100 * sum(t <= most + 1e-3 for t in times) / max(len(times), 1)) for most in MILLISECONDS
                ]
                lines.append(f"      - {shares}\n")
    return "".join(lines)


if __name__ == "__main__":
    raise SystemExit(main())
