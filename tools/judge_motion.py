#!/usr/bin/env python3
"""Judge a dance from the file that others get: a second opinion on `animate --report`, which shares no code with it.

usage: tools/judge_motion.py FILE [...] [--index N] [--section START:END] [--rate 120] [--json OUT.json]
FILE is a .glb or .bvh file of `animate`, or a chart (.ssc, .sm), which the command itself bakes into a .glb file of
120 frames per second; then a second column has the rows of its `--report`. `asked` is what docs/motion.md asks for, or
issues did, and `NO` stands where it is missed. Exit status 0 whatever the figures are; 1 if a file cannot be judged.

What it measures by: its own reader of the file, its own forward kinematics and skin, the vertices of the shoes, and the
body by Winter's table. Where its figures differ from the report's, and why:
- balance, ground force, gravity: the bake balances a body with de Leva's masses exactly, and this is another one. Its
  flights fall a little differently and its zero-moment point is up to some centimetres elsewhere, so its balance is
  mostly the lower of both; forces and balance are of 60 frames per second, whatever the rate.
- feet touch when a vertex of the shoe is 1.5 mm over the pad (the report: a point of the sole 1 mm), so flights are
  some frames shorter; under a .bvh file, which has no shoes, a flat box is her sole.
- plant slide is that of the sole's stillest point (the report: the longest path of one; of a pivot, the ball's).
- limbs in each other are given in milliseconds, because frames depend on the rate; shoes by their outlines.
- without notes: jerk counts runs of jumps too, which the report exempts, and the weight shifts wherever both feet
  stay down for 1.9 s (0.7 s at both ends left out), while the report takes waits over 4.5 s from note to note.
- beside the pad the floor may be lower, which the file does not contain: leave walks on and off out with --section.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from judge_figures import Row, figures
from judge_files import read_dance

BAKED = 120  # frames per second of charts that are baked for it
CHARTS = (".ssc", ".sm")


def main() -> None:
    options = _options()
    everything, failed = {}, False
    for path in options.files:
        try:
            rows, told = judge(path, options)
        except (ValueError, OSError, KeyError) as error:
            print(f"{path}: {error}", file=sys.stderr)
            failed = True
            continue
        print(table(f"{path}", rows, told), flush=True)
        everything[str(path)] = [_plain(row) for row in rows]
    if options.json is not None:
        options.json.write_text(json.dumps(everything, indent=1) + "\n", encoding="utf-8")
    sys.exit(failed)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, usage=argparse.SUPPRESS, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("files", type=Path, nargs="+", metavar="FILE")
    parser.add_argument("--index", type=int, default=0, help="of a chart: its place in the file")
    parser.add_argument("--section", metavar="START:END", help="seconds; of a chart this alone is baked")
    parser.add_argument("--rate", type=float, default=120.0, help="frames per second that are looked at")
    parser.add_argument("--json", type=Path, help="all figures, for programs")
    return parser.parse_args()


def judge(path: Path, options: argparse.Namespace) -> tuple[list[Row], dict[str, float | None]]:
    """The rows of a file or chart; of a chart also the values of the command's own report, by name.

    Raises ValueError, OSError or KeyError if there is nothing to judge.
    """
    if path.suffix.lower() not in CHARTS:
        start, end = (float(x) for x in (options.section or "-inf:inf").split(":"))
        return figures(read_dance(path, options.rate, (start, end))), {}
    with tempfile.TemporaryDirectory() as folder:
        out, report = Path(folder) / "dance.glb", Path(folder) / "report.json"
        call = [sys.executable, "-m", "dancetutor_cli", "animate", str(path.resolve()), "--index", str(options.index)]
        call += ["--fps", str(BAKED), "-o", str(out), "--report", str(report), "--yes"]
        call += ["--section", options.section] if options.section else []
        done = subprocess.run(call, capture_output=True, text=True, check=False)
        if done.returncode or not out.exists():
            raise ValueError((done.stderr or done.stdout).strip().splitlines()[-1])
        told = {figure["name"]: figure["value"] for figure in json.loads(report.read_text("utf-8"))["figures"]}
        return figures(read_dance(out, options.rate)), told


def _plain(row: Row) -> dict[str, Any]:
    """For JSON, which knows neither nan nor infinity: both are null."""
    least, most = row.asked or (-math.inf, math.inf)
    numbers = {"value": row.value, "at": row.at, "least": least, "most": most}
    told = {name: number if math.isfinite(number) else None for name, number in numbers.items()}
    return {"name": row.name.strip(), "unit": row.unit, **told, "met": row.is_met}


def table(title: str, rows: list[Row], told: dict[str, float | None]) -> str:
    """As text: name, value, what the report says, what is asked, and NO where it is missed."""
    lines = [title, f"  {'figure':38}{'judged':>10}{'report':>10}  {'':13}{'asked':>14}"]
    for row in rows:
        said = told.get(row.same) if row.same else None
        frames = row.unit == "ms" and said is not None  # the report counts frames
        shown = "" if said is None else _number(said * 1000.0 / BAKED if frames else said)
        asked = "" if row.asked is None else _asked(*row.asked)
        missed, at = "NO" if row.is_met is False else "", "" if row.at != row.at else f"at {row.at:.2f} s"
        start = f"  {row.name:38}{_number(row.value):>10}{shown:>10}  {row.unit:13}{asked:>14}"
        lines.append(f"{start}  {missed:3}{at}".rstrip())
    return "\n".join(lines)


def _number(value: float) -> str:
    return "-" if value != value else f"{value:.4g}"


def _asked(least: float, most: float) -> str:
    if most == float("inf"):
        return f"from {least:g}"
    return f"{most:g}" if least == most else f"{least:g} to {most:g}" if least > 0 else f"to {most:g}"


if __name__ == "__main__":
    main()
