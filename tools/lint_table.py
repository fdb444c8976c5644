"""How often the linter finds what: findings per 100 charts by rule and meter.

    tools/lint_table.py FOLDER --keep after.json            # lint a folder by the defaults, keep what was found
    tools/lint_table.py --before before.json --after after.json     # a table of both

`tools/doc_figures.py rules` writes the table of docs/linter.md. The findings of another version: run this file with
that version's package first on PYTHONPATH.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import find_files
from dancetutor_cli.lint.analysis import solve_selected
from dancetutor_cli.lint.check import check_chart, check_file, merged_by_foot
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.run import LintRequest, LintRun
from dancetutor_cli.lint.subject import ChartSubject, FileSubject
from dancetutor_cli.run.errors import DancetutorError

BANDS = {"dance": (3, 6, 9, 12, 999), "pump": (7, 13, 17, 20, 999)}  # the last meter of each band


def band(steps_type: str, meter: int) -> str:
    """ "dance 4-6": what a chart is counted with."""
    pad = "pump" if steps_type.startswith(("pump", "smx")) else "dance"
    low = 0
    for high in BANDS[pad]:
        if meter <= high:
            return f"{pad} {low}{f'-{high}' if high < BANDS[pad][-1] else '+'}"
        low = high + 1
    raise AssertionError(meter)


def linted(
    folder: Path, assignments: Sequence[str] = ()
) -> Iterator[tuple[FileSubject | ChartSubject, tuple[Finding, ...]]]:
    """Every file below a folder, and every chart in it, with what the defaults find. assignments : as of --set"""
    run = LintRun(LintRequest(config="default", assignments=assignments))
    for path in find_files([folder]):
        task = run.task(path)
        try:
            song = load(path)
        except DancetutorError:
            continue
        file = FileSubject(song)
        yield file, check_file(file, task.settings)
        for subject in solve_selected(song, song.charts, task):
            yield subject, merged_by_foot(check_chart(subject, task.settings), subject)


def kept(folder: Path) -> dict[str, Any]:
    """The data of a folder for the table: charts by band, findings by rule, severity and band."""
    charts: Counter[str] = Counter()
    found: Counter[str] = Counter()
    names: dict[str, str] = {}
    for subject, findings in linted(folder):
        if not isinstance(subject, ChartSubject):
            continue
        where = band(subject.chart.steps_type, subject.chart.meter)
        charts[where] += 1
        for one in findings:
            names[one.rule] = one.name
            found[f"{one.rule}|{one.severity}|{where}"] += 1
    return {"charts": dict(charts), "names": names, "found": dict(found)}


def table(before: dict[str, Any] | None, after: dict[str, Any]) -> str:
    """Findings per 100 charts, before (if given) and after: a line for each rule and severity, columns for bands."""
    kinds = [kind for kind in (before, after) if kind is not None]
    bands = sorted(after["charts"], key=lambda name: (name.split()[0], int(name.split()[1].rstrip("+").split("-")[0])))
    names = {rule: name for kind in kinds for rule, name in kind["names"].items()}
    lines = [f"| rule | {' | '.join(bands)} | all |", f"| --- |{' ---: |' * (len(bands) + 1)}"]
    lines.append(
        "| charts | " + " | ".join(f"{after['charts'][one]}" for one in bands) + f" | {sum(after['charts'].values())} |"
    )
    for rule, severity in sorted({tuple(key.split("|")[:2]) for kind in kinds for key in kind["found"]}):
        cells = []
        for where in (*bands, None):
            values = [_short(_share(kind, f"{rule}|{severity}|", where)) for kind in kinds]
            cells.append(" → ".join(values) if set(values) != {"0"} else "")
        lines.append(f"| {rule} {names[rule]}, {severity} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _share(kind: dict[str, Any], begin: str, where: str | None) -> float:
    """Findings per 100 charts of a band, or of all."""
    many = sum(n for key, n in kind["found"].items() if key.startswith(begin) and where in (None, key.split("|")[2]))
    charts = sum(kind["charts"].values()) if where is None else kind["charts"].get(where, 0)
    return 100 * many / max(charts, 1)


def _short(value: float) -> str:
    return f"{value:.0f}" if value >= 10 or value == 0 else f"{value:.1f}"


def main() -> int:
    """Do what the command line says."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--before", type=Path)
    parser.add_argument("--after", type=Path)
    given = parser.parse_args()
    if given.before and given.after:
        sys.stdout.write(table(json.loads(given.before.read_text()), json.loads(given.after.read_text())))
    elif given.folder and given.keep:
        given.keep.write_text(json.dumps(kept(given.folder), indent=1, sort_keys=True))
    else:
        parser.error("give FOLDER with --keep, or --before and --after")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
