#!/usr/bin/env python3
"""Check that every cut of a chart shows the same dance: random sections beside the whole, alone, at the bar, with a
style.

usage: tools/cut_check.py [--count 12] [--seed 1]
Prints for each section the largest distance of any joint, in millimetres, from the same moment of the whole dance, of
`animate` and of a film, whose first and last second may differ.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import motion_report
import numpy as np

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.motion import Cut, Motion, sample
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.run.errors import DancetutorError

KINDS = ({}, {"bar": True}, {"style": "lazy"}, {"rates": (0.75,)})
END = 1.0  # seconds at either end of a film that may differ


def main() -> None:
    """Print one line for each cut."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=12)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    chance, worst = np.random.default_rng(options.seed), 0.0
    for number, chart in enumerate(motion_report.pick(options.count, options.seed)):
        kind = KINDS[number % len(KINDS)]
        request = DanceRequest(Path(chart.path), Selection(index=chart.index), **kind)  # type: ignore[arg-type]
        try:
            performance = perform(solve(request), request, request.rates[-1])
        except DancetutorError as error:
            print(error)
            continue
        whole = performance.bake()
        first, last = performance.span
        for _ in range(2):
            start = float(chance.uniform(first, max(last - 8.0, first)))
            end = start + float(chance.uniform(3.0, 8.0))
            found = []
            for cut in (Cut(start, end), Cut(start - 2.0, end + 1.5, start, end)):
                edge = END if cut.start < start else 0.0
                parts = performance.bake(replace(cut, walks_off=edge == 0.0))
                pairs = zip(whole, parts, strict=True)
                found.append(max(apart(a.motion, b.motion, start + edge, end - edge) for a, b in pairs))
            worst = max(worst, *found)
            name = f"{Path(chart.path).stem[:30]} {chart.label}"
            print(f"{name}, {kind or 'plain'}, {start:.2f} to {end:.2f} s: {found[0]:.4f} mm, film {found[1]:.4f} mm")
    print(f"at most {worst:.4f} mm")


def apart(one: Motion, other: Motion, start: float, end: float) -> float:
    """Largest distance of any joint at the keys of `one` from `start` to `end`, millimetres."""
    at = other.times[(other.times >= start) & (other.times <= end)]
    if not len(at):
        return 0.0
    places = [world_transforms(motion.skeleton, *sample(motion, at))[0] for motion in (one, other)]
    return float(1000 * np.linalg.norm(places[0] - places[1], axis=2).max())


if __name__ == "__main__":
    main()
