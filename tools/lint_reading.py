"""Findings with their rows, for a reader who knows the game and not the code: do you want to know this?

tools/lint_reading.py FOLDER --to READING --seed 1     # of every warning and error rule 20, a file each
tools/lint_reading.py FOLDER --to READING --rules DT201 --severity info --count 50
tools/lint_reading.py FOLDER --to READING --rules DT212 --set DT212.severity=warning      # of a rule that is off
"""

from __future__ import annotations

import argparse
import random
import sys
import textwrap
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

from lint_table import linted

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import Part
from dancetutor_cli.feet.play import Play
from dancetutor_cli.lint.figures import arrows
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import all_rules, match_codes
from dancetutor_cli.lint.subject import ChartSubject, FileSubject

BEFORE, AFTER = 9, 5  # rows, and lines of the file
COUNTED = ("warning", "error")
HEAD = """\
{code} {name}: {found} findings in {places} charts or files; {shown} of them, of different charts as far as there are.

{about}

Question for each: as the author of this chart, or as who checks a pack: would I want to know this? yes / no / unsure

How to read: beat; ms since the row before; what lies on the panels (1 note, 2 hold begins, 4 roll begins, | held,
M mine, L lift, . tick of a roll); which foot presses it (L R; l r: the toe of a foot that brackets; < > a hand;
? nobody); where the body faces (0: the screen, +: to the left, beyond 90: feet crossed); how sure the program is of the
feet; names of moves.
"""
_LETTERS = "? LR<> lr<>"
Place = FileSubject | ChartSubject


def collected(
    folder: Path, assignments: Sequence[str] = ()
) -> dict[tuple[str, str], dict[int, list[tuple[Place, Finding]]]]:
    """What is found below a folder: (rule, severity) -> number of the chart or file -> its findings."""
    found: dict[tuple[str, str], dict[int, list[tuple[Place, Finding]]]] = defaultdict(lambda: defaultdict(list))
    for number, (subject, findings) in enumerate(linted(folder, assignments)):
        for one in findings:
            found[one.rule, one.severity][number].append((subject, one))
    return found


def reading(code: str, per_place: dict[int, list[tuple[Place, Finding]]], count: int, seed: int) -> str:
    """So many findings of a rule by a seed, each of another chart or file as far as there are."""
    chosen = random.Random(f"{seed} {code}")
    order = sorted(per_place)
    chosen.shuffle(order)
    picked = []
    while len(picked) < count and order:
        for number in list(order):
            left = per_place[number]
            picked.append((*left.pop(chosen.randrange(len(left))), len(left) + 1))
            if not left:
                order.remove(number)
            if len(picked) == count:
                break
    return "\n".join(f"#{n} {drawn(subject, one, times)}" for n, (subject, one, times) in enumerate(picked, 1))


def drawn(subject: Place, finding: Finding, times: int = 1) -> str:
    """A finding with its rows and feet; one about the file with the lines around it."""
    lines = [finding.message, f"    {Path(*subject.song.path.parts[-3:])}"]
    if isinstance(subject, ChartSubject):
        chart, play = subject.chart, subject.play
        lines[1] += f"   {chart.steps_type} {chart.difficulty} {chart.meter}"
        lines[1] += f"   ({times} of this rule in this chart)" if times > 1 else ""
        if play is not None and finding.beat is not None and subject.pad is not None and finding.rule >= "DT2":
            at = int(play.rows.tick.searchsorted(round(finding.beat * TICKS_PER_BEAT)))
            lines[1] += f"   {chart.timing.bpm_at(round(finding.beat * TICKS_PER_BEAT)):.0f} BPM"
            panels = arrows(subject.pad)
            lines.append(f"    {'beat':>9} {'ms':>6}    {panels}  {panels}")
            rows = range(max(at - BEFORE, 0), min(at + AFTER + 1, len(play.rows)))
            lines += [f"   {'>' if row == at else ' '}{_row(play, row)}" for row in rows]
            return "\n".join(lines) + "\n"
    return "\n".join([*lines, *_text_lines(subject, finding.line)]) + "\n"


def _text_lines(subject: Place, line: int | None) -> list[str]:
    if line is None:
        return []
    text = subject.song.data.decode("utf-8", "replace").splitlines()
    around = range(max(line - BEFORE, 1), min(line + AFTER, len(text)) + 1)
    return [f"   {'>' if n == line else ' '}{n:6}  {text[n - 1][:100]}" for n in around]


def _row(play: Play, row: int) -> str:
    rows, cells = play.rows, range(play.limb.shape[1])
    limbs = "".join(_LETTERS[int(play.limb[row, c]) + 2 + 5 * (play.part[row, c] == Part.TOE)] for c in cells)
    sure = play.confidence is not None and play.confidence[row] == play.confidence[row]
    percent = f"{play.confidence[row]:.0%}" if play.confidence is not None and sure else ""
    time = f"{rows.tick[row] / TICKS_PER_BEAT:9.3f} {1000 * (rows.second[row] - rows.second[max(row - 1, 0)]):6.0f}"
    notes = "".join(_note(play, row, c) for c in cells)
    feet = limbs.replace(" ", "·")
    return f" {time}    {notes}  {feet}  {play.facing[row]:5.0f}° {percent:>4}  {' '.join(play.moves[row])}"


def _note(play: Play, row: int, column: int) -> str:
    rows = play.rows
    if rows.steps[row, column]:
        return "·1L24."[rows.steps[row, column]]
    held = (rows.hold_end[:row, column] > rows.tick[row]).any()
    return "M" if rows.mines[row, column] else "|" if held else "·"


def _about(docstring: str) -> str:
    """The documentation of a rule without its options and its examples."""
    paragraphs = [" ".join(one.split()) for one in docstring.split("\n\n")]
    words = [one for one in paragraphs if not one.startswith(("`", "Bad", "Better", "0", "1", "2"))]
    return "\n".join(textwrap.fill(one, 118) for one in words)


def main() -> int:
    """Write a file for each rule, named by its code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--to", type=Path, required=True)
    parser.add_argument("--rules", default="all")
    parser.add_argument("--severity", action="append")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--set", dest="assignments", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    given.to.mkdir(parents=True, exist_ok=True)
    codes = {code for one in given.rules.split(",") for code in match_codes(one)}
    for (code, severity), places in sorted(collected(given.folder, given.assignments).items()):
        if code not in codes or severity not in (given.severity or COUNTED):
            continue
        about = _about(all_rules()[code].__doc__ or "")
        many = sum(map(len, places.values()))
        head = HEAD.format(code=code, name=all_rules()[code].name, found=many, places=len(places),
                           shown=min(given.count, many), about=about)  # fmt: skip
        text = reading(code, places, given.count, given.seed)
        (given.to / f"{code}-{severity}.txt").write_text(f"{head}\n{text}", encoding="utf-8")
        sys.stdout.write(f"{code} {severity}: {many} in {len(places)}\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
