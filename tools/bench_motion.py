"""Speed of the bake: one core, numba cache full."""

from __future__ import annotations

import time

import numpy as np

from dancetutor_cli.chart.reader import load
from dancetutor_cli.dance.bake import bake, bake_plan
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.ik import full_body as ik
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.run.reading import charts_path

Row = tuple[str, float, str, str, str]
FPS, LENGTH = 60.0, 120.0


def _repeated(plan_seconds: float, times: int):  # type: ignore[no-untyped-def]
    """The demo song's hardest single chart, again and again: a play of any length."""
    from dataclasses import replace

    song = load(charts_path() / "two_left_feet" / "two_left_feet.ssc")
    chart = next(c for c in song.charts if c.steps_type == "dance-single" and c.difficulty == "Hard")
    play, pad = solve_chart(chart, load_preset("thesis")), load_pad(chart.steps_type)
    assert play is not None and pad is not None
    rows = play.rows
    second = np.concatenate([rows.second + k * plan_seconds for k in range(times)])

    def tile(a):  # type: ignore[no-untyped-def]
        return np.concatenate([a] * times)

    tiled = replace(
        rows, second=second, steps=np.where(tile(rows.steps) == 3, 1, tile(rows.steps)).astype(np.uint8),
        hold_end=tile(rows.hold_end) * 0 - 1, tick=tile(rows.tick), line=tile(rows.line), mines=tile(rows.mines),
        milliseconds=tile(rows.milliseconds),
    )  # fmt: skip
    whole = replace(
        play, rows=tiled, limb=tile(play.limb), part=tile(play.part), feet=tile(play.feet), facing=tile(play.facing)
    )
    return chart, whole, pad


def _seconds(work, rounds: int = 3) -> float:  # type: ignore[no-untyped-def]
    best = float("inf")
    for _ in range(rounds):
        start = time.process_time()
        work()
        best = min(best, time.process_time() - start)
    return best


def measure() -> list[Row]:
    """Rows (name, value, unit, goal, peer) for `tools/bench.py`."""
    out: list[Row] = []
    took = {}
    for copies in (3, 12):
        chart, play, pad = _repeated(40.0, copies)
        plan, context = plan_dance(chart.timing, play, pad)
        length = 40.0 * copies
        bake_plan(plan, context, FPS, (0.0, 5.0))
        took[copies] = _seconds(lambda p=plan, c=context, end=length: bake_plan(p, c, FPS, (0.0, end)), 2)
    out.append(("bake of two minutes at 60 fps", took[3], "s", "at most 4", ""))
    out.append(("animate frames", LENGTH * FPS / took[3], "frames/s", "", ""))
    out.append(("eight minutes against two, per second", took[12] / took[3] / 4, "x", "about 1", ""))
    out.append(("IK poses", _ik_rate(), "poses/s", "200,000", "300,000 measured elsewhere"))
    out.append(("an hour, largest memory", _hour_memory(), "GiB", "at most 1.5", ""))
    chart, play, pad = _repeated(40.0, 1)
    out.append(("whole bake call of the demo, 41 s", _seconds(lambda: bake(chart.timing, play, pad)), "s", "", ""))
    return out


def _hour_memory() -> float:
    """Largest memory of a process that bakes an hour, in GiB; nan where the system does not tell."""
    import subprocess
    import sys
    from pathlib import Path

    work = (
        f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); import resource, bench_motion as b;"
        "chart, play, pad = b._repeated(40.0, 90); m = b.bake(chart.timing, play, pad, section=(0.0, 3600.0));"
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
    )
    done = subprocess.run([sys.executable, "-c", work], capture_output=True, text=True, check=False)
    return int(done.stdout) / 2 ** (30 if sys.platform == "darwin" else 20) if done.returncode == 0 else float("nan")


def _ik_rate() -> float:
    from dancetutor_cli.dance.ik.full_body import Targets

    frames, rng = 20000, np.random.default_rng(1)
    turn = np.tile([1.0, 0.0, 0.0, 0.0], (frames, 1))
    pair = np.repeat(turn[:, None], 2, axis=1)
    skeleton = dancer_skeleton()
    pelvis = np.tile([0.0, 0.85, 0.0], (frames, 1)) + rng.uniform(-0.05, 0.05, (frames, 3))
    sides = np.array([[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]])
    shoulders = pelvis[:, None] + sides * [0.16, 0.44, -0.015]
    wrists = shoulders + sides * [0.1, -0.35, 0.15]
    ankles = np.tile(sides * [0.15, 0.09, 0.0], (frames, 1, 1)) + rng.uniform(-0.1, 0.1, (frames, 2, 3)) * [1, 0, 1]
    poles = np.tile([0.0, 0.0, 1.0], (frames, 2, 1))
    targets = Targets(
        pelvis, turn, turn, shoulders, wrists, pair, np.zeros((frames, 2)), -poles, ankles, pair, pair, poles
    )
    ik.solve_poses(skeleton, targets, 0.8055)
    return frames / _seconds(lambda: ik.solve_poses(skeleton, targets, 0.8055))


if __name__ == "__main__":
    for row in measure():
        print(row)
