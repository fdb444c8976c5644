#!/usr/bin/env python3
"""Check that a change of the program does not change the motion: bake the same plays before and after it.

usage: tools/same_motion.py freeze FOLDER [--count 40] [--seed 11]     solve, bake, and keep plays and motions
       tools/same_motion.py check FOLDER [--most-mm 0.5] [--most-degrees 0.5] [--every N]
The demo song is baked whole, of COUNT charts of the corpus (as in tools/motion_report.py) half a minute each. Plays are
kept too, so a change of the solver does not matter. Exit status 1 if any joint is farther off than allowed.
"""

from __future__ import annotations

import argparse
import pickle
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import motion_report
import numpy as np

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.performance import solve
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.run.errors import DancetutorError

LENGTH = 30.0  # seconds of a section


@dataclass(frozen=True)
class Scene:
    """What is baked. how : further arguments of `bake`"""

    name: str
    play: Any
    pad: Any
    timing: Any
    section: tuple[float, float] | None
    how: dict[str, Any]


def main() -> None:
    options = _options()
    sys.exit(freeze(options) if options.command == "freeze" else check(options))


def freeze(options: argparse.Namespace) -> int:
    options.folder.mkdir(parents=True, exist_ok=True)
    wanted = motion_report._everything(motion_report.DEMO) + motion_report.pick(options.count, options.seed)
    for number, chart in enumerate(wanted):
        try:
            one = solve(DanceRequest(Path(chart.path), Selection(index=chart.index, player=1)))[0]
        except DancetutorError as error:
            print(f"left out: {error}", file=sys.stderr)
            continue
        whole = chart.path.startswith(str(motion_report.DEMO[0]))
        how = {"bar": True, "gait": "heels"} if number % 5 == 0 else {}
        assert one.play is not None
        section = None if whole else _section(one.play.rows.second, number)
        scene = Scene(
            f"{number:02d} {Path(chart.path).stem[:36]} {chart.label}", one.play, one.pad, one.chart.timing,
            section, how,
        )  # fmt: skip
        (options.folder / f"{number:02d}.pickle").write_bytes(pickle.dumps(scene.__dict__))
        motion = baked(scene)
        np.savez(options.folder / f"{number:02d}.npz", times=motion.times, rotations=motion.rotations, root=motion.root)
        print(scene.name, flush=True)
    return 0


def _section(second: Any, number: int) -> tuple[float, float]:
    """By turns the densest half minute, the first one, and the last one: walks on and off are in them."""
    if number % 4 == 1:
        return min(0.0, float(second[0]) - 2.0), float(second[0]) + LENGTH - 5.0
    if number % 4 == 2:
        return float(second[-1]) - LENGTH + 5.0, float(second[-1]) + 5.0
    start = float(second[np.argmax(np.searchsorted(second, second + LENGTH) - np.arange(len(second)))])
    return start - 1.0, start - 1.0 + LENGTH


def baked(scene: Scene) -> Any:
    """The motion of a scene."""
    return bake(scene.timing, scene.play, scene.pad, section=scene.section, **scene.how)


def check(options: argparse.Namespace) -> int:
    paths = sorted(options.folder.glob("*.pickle"))[:: options.every]
    worst, bad = (0.0, 0.0), 0
    for path in paths:
        scene = Scene(**pickle.loads(path.read_bytes()))
        before, after = np.load(path.with_suffix(".npz")), baked(scene)
        far, turned = apart(before, after)
        worst = max(worst[0], far), max(worst[1], turned)
        if far > options.most_mm or turned > options.most_degrees:
            bad += 1
            print(f"{scene.name}: {far:.3f} mm, {turned:.3f} degrees", flush=True)
    print(f"{len(paths)} motions, {bad} of them moved; at most {worst[0]:.4f} mm and {worst[1]:.4f} degrees")
    return int(bad > 0)


def apart(before: Any, after: Any) -> tuple[float, float]:
    """Largest distance of any joint in millimetres, and angle in degrees; infinite where the keys are others."""
    if len(before["times"]) != len(after.times) or np.abs(before["times"] - after.times).max() > 1e-6:
        return np.inf, np.inf
    skeleton = dancer_skeleton()
    places, turns = world_transforms(skeleton, before["rotations"], before["root"])
    others, other_turns = world_transforms(skeleton, after.rotations, after.root)
    same = np.abs(np.sum(turns * other_turns, axis=-1))
    angle = 2.0 * np.arccos(np.clip(same, 0.0, 1.0))
    return float(1000 * np.linalg.norm(places - others, axis=-1).max()), float(np.degrees(angle.max()))


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("command", choices=("freeze", "check"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", type=int, default=40, help="charts of the corpus")
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--most-mm", type=float, default=0.5)
    parser.add_argument("--most-degrees", type=float, default=0.5)
    parser.add_argument("--every", type=int, default=1, help="check only every N-th motion")
    return parser.parse_args()


if __name__ == "__main__":
    main()
