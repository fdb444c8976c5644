"""How often the linter finds what: findings per 100 charts by rule and meter, and findings with their rows to be read.

    tools/lint_table.py FOLDER --keep after.json            # lint a folder by the defaults, keep what was found
    tools/lint_table.py --before before.json --after after.json     # the table of docs/linter.md
    tools/lint_table.py FOLDER --sample DT201 --seed 1       # 20 findings of a rule with the rows around them

The findings of another version: run this file with that version's package first on PYTHONPATH.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dancetutor_cli import chart as reader
from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.jobs.analyze import solved
from dancetutor_cli.jobs.lint_run import LintRun, Request
from dancetutor_cli.library import find_files
from dancetutor_cli.lint.check import check_chart
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.play.model import Part, Play

BANDS = {"dance": (3, 6, 9, 12, 999), "pump": (7, 13, 17, 20, 999)}  # the last meter of each band
_LETTERS = "? LR<> lr<>"


def band(steps_type: str, meter: int) -> str:
    """ "dance 4-6": what a chart is counted with."""
    pad = "pump" if steps_type.startswith(("pump", "smx")) else "dance"
    low = 0
    for high in BANDS[pad]:
        if meter <= high:
            return f"{pad} {low}{f'-{high}' if high < BANDS[pad][-1] else '+'}"
        low = high + 1
    raise AssertionError(meter)


def linted(folder: Path) -> Iterator[tuple[ChartSubject, tuple[Finding, ...]]]:
    """Every chart below a folder with what the defaults find in it."""
    run = LintRun(Request(config="default"))
    for path in find_files([folder]):
        task = run.task(path)
        try:
            song = reader.load(path)
        except DancetutorError:
            continue
        for subject in solved(song, song.charts, task):
            yield subject, check_chart(subject, task.settings)


def kept(folder: Path) -> dict[str, Any]:
    """What the table needs of a folder: charts by band, findings by rule, severity and band."""
    charts: Counter[str] = Counter()
    found: Counter[str] = Counter()
    names: dict[str, str] = {}
    for subject, findings in linted(folder):
        where = band(subject.chart.steps_type, subject.chart.meter)
        charts[where] += 1
        for one in findings:
            names[one.rule] = one.name
            found[f"{one.rule}|{one.severity}|{where}"] += 1
    return {"charts": dict(charts), "names": names, "found": dict(found)}


def table(before: dict[str, Any], after: dict[str, Any]) -> str:
    """Findings per 100 charts, before and after, a line for each rule and severity, a column for each band."""
    bands = sorted(after["charts"], key=lambda name: (name.split()[0], int(name.split()[1].rstrip("+").split("-")[0])))
    names = before["names"] | after["names"]
    lines = [f"| rule | {' | '.join(bands)} | all |", f"| --- |{' ---: |' * (len(bands) + 1)}"]
    lines.append(
        "| charts | " + " | ".join(f"{after['charts'][one]}" for one in bands) + f" | {sum(after['charts'].values())} |"
    )
    keys = {tuple(key.split("|")[:2]) for kind in (before, after) for key in kind["found"]}
    for rule, severity in sorted(keys):
        cells = []
        for where in (*bands, None):
            pair = []
            for kind in (before, after):
                many = sum(
                    n
                    for key, n in kind["found"].items()
                    if key.split("|")[:2] == [rule, severity] and where in (None, key.split("|")[2])
                )
                charts = sum(kind["charts"].values()) if where is None else kind["charts"].get(where, 0)
                pair.append(_short(100 * many / max(charts, 1)))
            cells.append(" → ".join(pair) if pair != ["0", "0"] else "")
        lines.append(f"| {rule} {names[rule]}, {severity} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _short(value: float) -> str:
    return f"{value:.0f}" if value >= 10 or value == 0 else f"{value:.1f}"


def sample(folder: Path, rule: str, count: int, seed: int, severity: str | None) -> str:
    """So many findings of a rule, each of another chart as far as there are, with the rows around them."""
    per_chart: dict[int, list[tuple[ChartSubject, Finding]]] = defaultdict(list)
    for number, (subject, findings) in enumerate(linted(folder)):
        for one in findings:
            if one.rule == rule and severity in (None, one.severity):
                per_chart[number].append((subject, one))
    chosen = random.Random(seed)
    order = sorted(per_chart)
    chosen.shuffle(order)
    picked = [chosen.choice(per_chart[number]) for number in order[:count]]
    return f"{sum(map(len, per_chart.values()))} findings in {len(per_chart)} charts\n\n" + "\n".join(
        f"#{number} {drawn(subject, one)}" for number, (subject, one) in enumerate(picked, 1)
    )


def drawn(subject: ChartSubject, finding: Finding, before: int = 7, after: int = 4) -> str:
    """A finding with its rows: beat, ms since the row before, notes, who steps, facing, how sure, what happens."""
    chart, play = subject.chart, subject.play
    lines = [f"{finding.rule} {finding.severity}: {finding.message}"]
    lines.append(f"   {subject.song.path.name} {chart.steps_type} {chart.difficulty} {chart.meter}")
    if play is not None and finding.beat is not None:
        at = int(play.rows.tick.searchsorted(round(finding.beat * TICKS_PER_BEAT)))
        rows = range(max(at - before, 0), min(at + after + 1, len(play.rows)))
        lines += [f" {'>' if row == at else ' '} {_row(play, row)}" for row in rows]
    return "\n".join(lines) + "\n"


def _row(play: Play, row: int) -> str:
    rows, cells = play.rows, range(play.limb.shape[1])
    limbs = "".join(_LETTERS[int(play.limb[row, c]) + 2 + 5 * (play.part[row, c] == Part.TOE)] for c in cells)
    sure = play.confidence is not None and play.confidence[row] == play.confidence[row]
    percent = f"{play.confidence[row]:.0%}" if play.confidence is not None and sure else ""
    time = f"{rows.tick[row] / TICKS_PER_BEAT:9.3f} {1000 * (rows.second[row] - rows.second[max(row - 1, 0)]):6.0f} ms"
    notes = "".join(_note(play, row, c) for c in cells)
    return f"{time}  {notes}  {limbs}  {play.facing[row]:5.0f}° {percent:>4}  {' '.join(play.moves[row])}"


def _note(play: Play, row: int, column: int) -> str:
    rows = play.rows
    if rows.steps[row, column]:
        return "·1L24."[rows.steps[row, column]]
    held = (rows.hold_end[:row, column] > rows.tick[row]).any()
    return "M" if rows.mines[row, column] else "|" if held else "·"


def main() -> int:
    """Do what the command line says."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--before", type=Path)
    parser.add_argument("--after", type=Path)
    parser.add_argument("--sample")
    parser.add_argument("--severity")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    if given.before and given.after:
        sys.stdout.write(table(json.loads(given.before.read_text()), json.loads(given.after.read_text())))
    elif given.folder and given.keep:
        given.keep.write_text(json.dumps(kept(given.folder), indent=1, sort_keys=True))
    elif given.folder and given.sample:
        sys.stdout.write(sample(given.folder, given.sample, given.count, given.seed, given.severity))
    else:
        parser.error("give FOLDER with --keep or --sample, or --before and --after")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
