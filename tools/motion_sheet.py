#!/usr/bin/env python3
"""Draw moments of a baked chart side by side, from in front of the dancer and from her left: what the report's numbers
look like.

usage: tools/motion_sheet.py FILE --out SHEET.png [--index N] --at 12.0:14.0 [--count 12] [--bar] [--steps]
                             [--beside COMMIT]
The section's moments are even; with --steps they are those at which the section's notes fall. Each column is a moment.
With --beside the same moments as an earlier commit bakes them stand above today's, drawn by today's renderer with
today's dancer, so that only the motion is another one. tools/before_after.py has a list of such sheets.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from earlier import baked_by
from PIL import Image, ImageDraw

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.motion import Cut, Motion, sample
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import joint_matrices
from dancetutor_cli.film.scene import renderer
from dancetutor_cli.film.scene.look import default_look
from dancetutor_cli.film.scene.props import bar_matrix, with_bar
from dancetutor_cli.film.scene.scene import FrameState, Scene

Array = np.ndarray[Any, Any]
SIZE = (168, 250)  # pixels of one picture
VIEWS = {"front": (0.0, 1.05, 3.5), "side": (3.5, 1.05, 0.0)}  # of the camera from her place, metres
TARGET = 0.84  # metres over the pad that the camera looks at
AROUND = 1.5  # seconds baked before and after the section
NEAR = 0.35  # metres; who goes no farther from her middle place is seen from one camera, so that one sees her sway
BAND = 16  # pixels over the pictures of a commit, for its name


@dataclass(frozen=True)
class Moments:
    """Which moments of which chart. at : first and last second of the music; steps : those of the notes there."""

    chart: Path
    at: tuple[float, float]
    index: int = 0
    count: int = 12
    steps: bool = False
    bar: bool = False

    @property
    def section(self) -> tuple[float, float]:
        """What is baked, seconds."""
        return max(self.at[0] - AROUND, 0.0), self.at[1] + AROUND

    def times(self, motion: Motion) -> Array:
        start, end = self.at
        if self.steps:
            return np.unique([c.start for c in motion.contacts if start <= c.start <= end])[: self.count]
        return np.linspace(start, end, self.count)


def main() -> None:
    options = _options()
    start, end = (float(x) for x in options.at.split(":"))
    moments = Moments(options.file, (start, end), options.index, options.count, options.steps, options.bar)
    motion, pad = baked(moments, options.motion)
    times = moments.times(motion)
    picture = sheet(motion, pad, times)
    if options.beside is not None:
        before = sheet(baked_before(options.beside, moments), pad, times)
        picture = under({f"before: {options.beside}": before, "now": picture})
    picture.save(options.out)
    print(f"{options.out}: {len(times)} moments")


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--index", type=int, default=0, help="place of the chart in the file")
    parser.add_argument("--at", required=True, metavar="START:END", help="seconds of the music")
    parser.add_argument("--count", type=int, default=12, help="moments")
    parser.add_argument("--steps", action="store_true", help="moments of the notes")
    parser.add_argument("--bar", action="store_true", help="she holds the bar")
    parser.add_argument("--motion", type=Path, help="a file of changed numbers, as for animate")
    parser.add_argument("--beside", metavar="COMMIT", help="the same as this commit bakes it, above today's")
    parser.add_argument("--out", type=Path, required=True)
    return parser.parse_args()


def baked(moments: Moments, changed: Path | None = None) -> tuple[Motion, Any]:
    """The motion around these moments, and its pad; changed : a file of changed numbers of the motion."""
    request = DanceRequest(moments.chart, Selection(index=moments.index, player=1), bar=moments.bar, motion=changed)
    performance = perform(solve(request), request)
    return performance.bake(Cut(*moments.section))[0].motion, performance.pad


def baked_before(commit: str, moments: Moments) -> Motion:
    """The same as an earlier commit bakes it."""
    call = ["--index", str(moments.index), "--section", "{:g}:{:g}".format(*moments.section)]
    return baked_by(commit, moments.chart, [*call, *(["--bar"] if moments.bar else [])])


def sheet(motion: Motion, pad: Any, times: Array, words: Sequence[str] = ()) -> Image.Image:
    """A picture with a column for each of the times, seconds, and a row for each view; words : beside each time."""
    character = load_dancer()
    scene = Scene(with_bar(character, motion.bar, -default_look().stage.pad_height), pad)
    ours = [j for j, name in enumerate(character.skeleton.names) if name in motion.skeleton.names]
    theirs = [motion.skeleton.names.index(character.skeleton.names[j]) for j in ours]
    sampled, root = sample(motion, times)
    turns = np.zeros((len(times), len(character.skeleton.names), 4))
    turns[..., 0] = 1.0
    turns[:, ours] = sampled[:, theirs]
    joints = joint_matrices(character.skeleton, turns, root)
    if motion.bar is not None:
        still = np.broadcast_to(bar_matrix(motion.bar), (len(times), 1, 4, 4))
        joints = np.concatenate((joints, still), axis=1)
    middle = root.mean(axis=0)
    stays = np.hypot(*(root - middle)[:, [0, 2]].T).max() < NEAR
    draw = renderer.create(scene, SIZE, "draft", "cpu")
    out = Image.new("RGB", (SIZE[0] * len(times), SIZE[1] * len(VIEWS)))
    pen = ImageDraw.Draw(out)
    for k, time in enumerate(times):
        lit = np.zeros(scene.panels)
        by = np.zeros(scene.panels, dtype=np.int64)
        for contact in motion.contacts:
            if contact.start - 1e-3 <= time <= max(contact.end, contact.start + 0.05):
                lit[contact.column], by[contact.column] = 1.0, contact.limb
        for row, (dx, y, dz) in enumerate(VIEWS.values()):
            x, _, z = middle if stays else root[k]
            camera = scene.camera(f"{x + dx:.3f},{y},{z + dz:.3f}/{x:.3f},{TARGET},{z:.3f}", SIZE)
            out.paste(
                Image.fromarray(draw.frame(FrameState(joints[k], camera, lit, by)).copy()), (SIZE[0] * k, SIZE[1] * row)
            )
        pen.text((SIZE[0] * k + 4, 4), "  ".join((f"{time:.2f}", *words[k : k + 1])), fill=(255, 255, 255))
    draw.close()
    return out


def under(pictures: dict[str, Image.Image]) -> Image.Image:
    """Pictures below each other, each under its name."""
    width, height = max(p.width for p in pictures.values()), sum(p.height + BAND for p in pictures.values())
    out, y = Image.new("RGB", (width, height), (20, 20, 26)), 0
    pen = ImageDraw.Draw(out)
    for name, picture in pictures.items():
        pen.text((4, y + 2), name, fill=(255, 220, 120))
        out.paste(picture, (0, y + BAND))
        y += picture.height + BAND
    return out


if __name__ == "__main__":
    main()
