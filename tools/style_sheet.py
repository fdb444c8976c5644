#!/usr/bin/env python3
"""Draw one phrase in every style, a sheet for each, without names: can a person who has not seen them sort them?

usage: tools/style_sheet.py FILE FOLDER --index N --at 12.0:14.0 [--count 10] [--seed 1]
FOLDER gets A.png to E.png in an order of the seed, FOLDER.key beside it says which is which.
"""

from __future__ import annotations

import argparse
import random
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from motion_sheet import AROUND, sheet

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.motion import Cut
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.run.reading import config_names


def main() -> None:
    """The command line."""
    options = _options()
    start, end = (float(x) for x in options.at.split(":"))
    request = DanceRequest(options.file, Selection(index=options.index, player=1))
    solved = solve(request)
    names = config_names("styles")
    random.Random(options.seed).shuffle(names)
    options.folder.mkdir(parents=True, exist_ok=True)
    key = []
    for letter, name in zip("ABCDEFGHIJ", names, strict=False):
        performance = perform(solved, replace(request, style=name))
        motion = performance.bake(Cut(start - AROUND, end + AROUND))[0].motion
        sheet(motion, performance.pad, np.linspace(start, end, options.count)).save(options.folder / f"{letter}.png")
        key.append(f"{letter} {name}\n")
    Path(f"{options.folder}.key").write_text("".join(key), encoding="utf-8")
    print(f"{options.folder}: {len(key)} sheets; {options.folder}.key")


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--index", type=int, default=0, help="place of the chart in the file")
    parser.add_argument("--at", required=True, metavar="START:END", help="seconds of the music")
    parser.add_argument("--count", type=int, default=10, help="moments")
    parser.add_argument("--seed", type=int, default=1, help="of the order")
    return parser.parse_args()


if __name__ == "__main__":
    main()
