#!/usr/bin/env python3
"""How far the legs of styles are apart, and strips of legs alone without names: can a person who has not seen them sort
them?

usage: tools/style_legs.py [--count 6] [--seed 1] [--section 8] [--style NAME ...] [--meters 3:9] [--out FOLDER]
Takes COUNT charts of the corpus as tools/motion_report.py does, and of each a section at a place that the seed says.
Prints a line a style: how high feet go, how long they are in the air, how far heels come up, the pelvis' height and
bounce, feet beside each other; and the mean distance of knees, ankles and toes between any two styles.
With --out it also writes, for each chart, a film strip of legs per style, named by random letters; FOLDER_key.txt says
which is which.
"""

from __future__ import annotations

import argparse
import random
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from motion_report import Wanted, pick, section_start
from PIL import Image, ImageDraw

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.bake import bake_piece
from dancetutor_cli.dance.foot_path import both_feet
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.physics.blend import Blend
from dancetutor_cli.dance.physics.pipeline import RagdollOptions
from dancetutor_cli.dance.physics.style import load_style
from dancetutor_cli.dance.pieces import MORE_PLANNED, RagdollStyle, piece_of
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import place, sole_points, world_transforms
from dancetutor_cli.run.reading import config_names

Array = np.ndarray[Any, Any]
RATE = 60.0  # frames per second that are compared
FIGURES = ("lift", "peak", "air", "heel", "pelvis", "bounce", "sway", "knees")  # see _figures; knees: between them
BONES = ("hip", "knee", "talocrural", "metatarsal")
COLOURS = {"l": (80, 150, 255), "r": (255, 120, 70)}
CELL, SCALE = (118, 190), 165.0  # pixels of one moment, and of a metre
FRAMES, EVERY = 18, 0.075  # moments of a strip, seconds from one to the next


@dataclass(frozen=True)
class Legs:
    """One style's legs at even times: joints (f, 2, 4, 3), soles (f, 2, 6, 3), air (f, 2), pitch (f, 2) degrees."""

    times: Array
    joints: Array
    soles: Array
    air: Array
    pitch: Array


def main() -> None:
    """The command line."""
    options = _options()
    low, high = (int(x) for x in options.meters.split(":"))
    wanted = [one for one in pick(80, options.seed) if low <= one.meter <= high][: options.count]
    names = options.style or config_names("styles")
    every: dict[str, list[Legs]] = {name: [] for name in names}
    letters = random.Random(options.seed)
    keys = []
    for number, chart in enumerate(wanted):
        for name in names:
            every[name].append(legs_of(chart, name, options.section))
        print(f"{Path(chart.path).name} {chart.label}", flush=True)
        if options.out is not None:
            order = letters.sample("ABCDEFGHJKMNPQRSTUVWXYZ", len(names))
            shared = _busy(every[names[0]][-1])
            for letter, name in sorted(zip(order, names, strict=True)):
                options.out.mkdir(parents=True, exist_ok=True)
                strip(every[name][-1], shared).save(options.out / f"chart{number + 1}_{letter}.png")
                keys.append(f"chart{number + 1}_{letter} {name}\n")
    if options.out is not None:
        Path(f"{options.out}_key.txt").write_text("".join(keys), encoding="utf-8")
    print(table(every))


def legs_of(chart: Wanted, style: str, length: float) -> Legs:
    """A section of a chart in a style."""
    request = DanceRequest(Path(chart.path), Selection(index=chart.index, player=1), style=style)
    performance = perform(solve(request), request)
    (dancer,) = performance.dancers
    stepped = dancer.play.rows.second[(dancer.play.limb >= 0).any(axis=1)]
    start = section_start(stepped, chart.place, length)
    span = (start, start + length)
    ragdoll = RagdollStyle(Blend.of(load_style(style)), RagdollOptions())
    motion = bake_piece(piece_of(dancer.plan, dancer.context, RATE, (span, span, MORE_PLANNED), ragdoll)).motion
    times = np.arange(np.ceil(start * RATE), np.floor(span[1] * RATE)) / RATE
    feet = both_feet(dancer.plan.feet, times, dancer.context.settings)
    return _legs(motion, times, np.column_stack([~foot.down for foot in feet]))


def _legs(motion: Motion, times: Array, air: Array) -> Legs:
    skeleton = motion.skeleton
    placed = world_transforms(skeleton, *sample(motion, times))
    joints = np.stack([placed[0][:, [skeleton.index(f"{s}_{b}") for b in BONES]] for s in "lr"], axis=1)
    soles = np.stack([place(points, *placed) for points in sole_points(skeleton)], axis=1)
    heel, ball = soles[:, :, :2].mean(axis=2), soles[:, :, 2:4].mean(axis=2)
    way = heel - ball
    pitch = np.degrees(np.arctan2(way[..., 1], np.hypot(way[..., 0], way[..., 2])))
    return Legs(times, joints, soles, air, pitch)


def table(every: dict[str, list[Legs]]) -> str:
    """The figures of each style, means over charts, and the distances of all pairs."""
    lines = [f"{'style':9s}" + " ".join(f"{name:>6s}" for name in FIGURES) + "  (cm, %, degrees)"]
    for name, charts in every.items():
        lines.append(f"{name:9s}" + " ".join(f"{v:6.1f}" for v in means(charts).values()))
    lines.append("pair: mean distance of knees, ankles and toes, cm: all frames, legs in the air, pelvis")
    for one, other in combinations(every, 2):
        lines.append(f"{one} {other}: " + ", ".join(f"{v:.1f}" for v in distances(every[one], every[other])))
    return "\n".join(lines)


def means(charts: list[Legs]) -> dict[str, float]:
    """The figures of a style by their names, means over its charts."""
    return dict(zip(FIGURES, np.mean([_figures(legs) for legs in charts], axis=0), strict=True))


def distances(one: list[Legs], other: list[Legs]) -> tuple[float, ...]:
    """Mean distance of knees, ankles and toes of two styles, cm: all frames, legs in the air, pelvis."""
    return tuple(np.mean([_apart(a, b) for a, b in zip(one, other, strict=True)], axis=0))


def _figures(legs: Legs) -> tuple[float, ...]:
    low = legs.soles[..., 1].min(axis=2)
    swings = [low[run, side].max() for side in (0, 1) for run in _runs(legs.air[:, side])]
    lift = low[legs.air].mean() if legs.air.any() else 0.0
    pelvis = legs.joints[:, :, 0].mean(axis=1)
    around = np.convolve(pelvis[:, 1], np.ones(61) / 61, "same")
    bounce = np.std((pelvis[:, 1] - around)[60:-60])
    knees = np.linalg.norm(legs.joints[:, 0, 1] - legs.joints[:, 1, 1], axis=1).mean()
    sway = np.std(legs.joints[:, 0, 0, 1] - legs.joints[:, 1, 0, 1])
    heel = legs.pitch[legs.air].mean() if legs.air.any() else 0.0
    peak = float(np.mean(swings)) if swings else 0.0
    return (100 * lift, 100 * peak, 100 * legs.air.mean(), heel, 100 * pelvis[:, 1].mean(), 100 * bounce, 100 * sway,
            100 * knees)  # fmt: skip


def _runs(flags: Array) -> list[slice]:
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(int), [0]))))
    return [slice(a, b) for a, b in edges.reshape(-1, 2)]


def _apart(a: Legs, b: Legs) -> tuple[float, float, float]:
    n = min(len(a.times), len(b.times))
    far = 100 * np.linalg.norm(a.joints[:n] - b.joints[:n], axis=3)
    air = a.air[:n] | b.air[:n]
    pelvis = 100 * np.linalg.norm((a.joints[:n, :, 0] - b.joints[:n, :, 0]).mean(axis=1), axis=1)
    return float(far[:, :, 1:].mean()), float(far[:, :, 1:].mean(axis=2)[air].mean()), float(pelvis.mean())


def _busy(legs: Legs) -> float:
    """The second from which on feet are in the air most in one strip's time."""
    count = round(FRAMES * EVERY * RATE)
    most = np.convolve(legs.air.sum(axis=1), np.ones(count), "valid")
    return float(legs.times[int(np.argmax(most))])


def strip(legs: Legs, start: float) -> Image.Image:
    """Legs from the front and from her left, moments from left to right."""
    out = Image.new("RGB", (CELL[0] * FRAMES, 2 * CELL[1]), (18, 18, 24))
    pen = ImageDraw.Draw(out)
    for k in range(FRAMES):
        f = int(np.clip(np.searchsorted(legs.times, start + k * EVERY), 0, len(legs.times) - 1))
        middle = legs.joints[f, :, 0].mean(axis=0)
        for row, (axis, depth) in enumerate((((1.0, 0.0), 2), ((0.0, -1.0), 0))):
            base = np.array([CELL[0] * (k + 0.5), CELL[1] * (row + 1) - 14.0])

            def at(p: Array, axis: tuple[float, float] = axis, base: Array = base, middle: Array = middle) -> Any:
                across = axis[0] * (p[..., 0] - middle[0]) + axis[1] * (p[..., 2] - middle[2])
                return np.stack((base[0] + SCALE * across, base[1] - SCALE * p[..., 1]), axis=-1)

            left = CELL[0] * k
            pen.line([(left, base[1]), (left + CELL[0] - 4, base[1])], fill=(90, 90, 100), width=1)
            order = sorted((0, 1), key=lambda s: legs.joints[f, s, 1, depth])
            hips = at(legs.joints[f, :, 0])
            pen.line([tuple(hips[0]), tuple(hips[1])], fill=(200, 200, 200), width=7)
            for side in order:
                colour = COLOURS["lr"[side]]
                hip, knee, ankle, ball = at(legs.joints[f, side])
                pen.line([tuple(hip), tuple(knee)], fill=colour, width=9)
                pen.line([tuple(knee), tuple(ankle)], fill=colour, width=7)
                pen.ellipse([*(knee - 5), *(knee + 5)], fill=(240, 240, 240))
                sole = at(legs.soles[f, side])
                foot = [tuple(p) for p in (ankle, *sole[[0, 1]], *sole[[2, 3, 5, 4]], ball)]
                pen.polygon(_hull(foot), fill=tuple(int(0.75 * c) for c in colour))
    return out


def _hull(points: list[Any]) -> list[Any]:
    """Convex hull by the monotone chain."""
    points = sorted(set(points))

    def half(ordered: Any) -> list[Any]:
        chain: list[Any] = []
        for p in ordered:
            while (
                len(chain) > 1
                and (
                    (chain[-1][0] - chain[-2][0]) * (p[1] - chain[-2][1])
                    - (chain[-1][1] - chain[-2][1]) * (p[0] - chain[-2][0])
                )
                <= 0
            ):
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(points) + half(reversed(points))


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=6, help="charts of the corpus")
    parser.add_argument("--seed", type=int, default=1, help="of charts, sections and letters")
    parser.add_argument("--section", type=float, default=8.0, help="seconds of each chart")
    parser.add_argument("--style", action="append", help="names or files; all of configs/styles unless given")
    parser.add_argument("--meters", default="3:9", metavar="LOW:HIGH", help="of the charts")
    parser.add_argument("--out", type=Path, help="folder of strips")
    return parser.parse_args()


if __name__ == "__main__":
    main()
