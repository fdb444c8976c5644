"""Edits of `--fix` for a reader who knows charting: rows before and after. Would you accept it as the author?

tools/fix_reading.py FOLDER --seed 1 --count 20 --rules DT201,DT202

Takes findings by the seed, each from another chart if possible, repairs each alone in its chart, and prints the rows
around with the feet before and after. The last line counts the findings with an edit, and new jacks among the edits.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections import Counter
from pathlib import Path

from lint_reading import collected

from dancetutor_cli.chart.edits import apply
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.preset import PresetChoice, preset_for
from dancetutor_cli.lint.check import check_chart
from dancetutor_cli.lint.configuration import load_configuration
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.fix_edits import move_notes
from dancetutor_cli.lint.rule import match_codes
from dancetutor_cli.lint.subject import ChartSubject, solved_chart
from dancetutor_cli.lint.suggest import move_edits

AROUND = 9  # rows
_LIMBS = "LR<>"


def drawn(before: Play, after: Play, first: int, last: int) -> str:
    """Rows of the chart before and after beside each other, each with who steps."""
    lines = []
    for row in range(max(first - AROUND, 0), min(last + AROUND + 1, len(before.rows))):
        tick = before.rows.tick[row] / TICKS_PER_BEAT
        seconds = before.rows.second[row] - before.rows.second[max(row - 1, 0)]
        sides = [_cells(play, row) for play in (before, after)]
        changed = " <" if (before.rows.steps[row] != after.rows.steps[row]).any() else ""
        lines.append(f"    {tick:9.3f} {1000 * seconds:6.0f}   {sides[0]}   {sides[1]}{changed}")
    return "\n".join(lines)


def _cells(play: Play, row: int) -> str:
    notes = "".join("·1L24."[kind] for kind in play.rows.steps[row])
    limbs = "".join("·" if limb < 0 else _LIMBS[limb] for limb in play.limb[row].tolist())
    return f"{notes} {limbs} {'x' if abs(play.facing[row]) > 91 else ' '}"


def jacks(play: Play) -> int:
    """Pairs of neighbouring rows at most a second apart that share a panel."""
    stepped = (play.rows.steps > 0).any(axis=1)
    steps, seconds = (play.rows.steps > 0)[stepped], play.rows.second[stepped]
    return int(((steps[1:] & steps[:-1]).any(axis=1) & (seconds[1:] - seconds[:-1] <= 1)).sum())


def main() -> int:
    """Print the edits."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--rules", default="DT201,DT202,DT203,DT207,DT209")
    parser.add_argument("--severity", action="append")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    codes = {code for one in given.rules.split(",") for code in match_codes(one)}
    wanted = given.severity or ["warning"]
    found: list[tuple[ChartSubject, Finding]] = []
    for (code, severity), places in collected(given.folder).items():
        if code in codes and severity in wanted:
            found += [one for of_chart in places.values() for one in of_chart if isinstance(one[0], ChartSubject)]
    random.Random(given.seed).shuffle(found)
    counts: Counter[str] = Counter()
    settings = load_configuration(None).settings
    seen: set[int] = set()
    for subject, finding in found:
        counts["findings"] += 1
        preset = preset_for(subject.chart, subject.song.path, PresetChoice())
        findings = check_chart(subject, settings)
        for edit in move_edits(finding, findings, subject, settings, preset):
            fix = move_notes(subject.song.data, subject.chart, finding, edit)
            if fix is None or subject.play is None or subject.chart.written is not None:
                continue
            song = parse(apply(subject.song.data, list(fix.splices)), subject.song.path)
            after = solved_chart(song, song.charts[subject.chart.index], preset)
            assert after.play is not None
            counts["with an edit"] += 1
            counts["turned phrases"] += edit.words.startswith("turn")
            counts["new jacks"] += jacks(after.play) > jacks(subject.play)
            if counts["shown"] < given.count and id(subject) not in seen:
                seen.add(id(subject))
                counts["shown"] += 1
                rows = [int(subject.play.rows.tick.searchsorted(one.tick)) for one in edit.notes]
                print(f"#{counts['shown']} {finding.rule} beat {finding.beat:g}: {edit.words}")
                print(f"    {Path(*subject.song.path.parts[-2:])}   {subject.chart.label}")
                print(drawn(subject.play, after.play, rows[0], min(rows[-1], rows[0] + 14)) + "\n")
            break
    print(dict(counts))
    return 0


if __name__ == "__main__":
    sys.exit(main())
