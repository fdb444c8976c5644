#!/usr/bin/env python3
"""Draw what changed about the dancer, point by point: a contact sheet for each, an earlier commit's pictures above
today's.

usage: tools/before_after.py --beside COMMIT [--out FOLDER] [--list] [POINT ...]
The points and their sheets are in tools/before_after.yaml. Without POINT all of them are drawn, which takes about five
minutes on two cores, and longer the first time with a commit, whose pictures are kept. Charts are those of charts/ and
of the test data, which the tests unpack. There are three kinds of sheets: moments of a motion, all drawn by today's
renderer with today's dancer (with the figure in question beside each time); pictures of a film, each commit's own; the
dancer by herself.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from earlier import HERE, ROOT, filmed_by, run_on
from motion_sheet import Array, Moments, baked, baked_before, sheet, under
from PIL import Image, ImageDraw

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.quality.dynamics import ground_force, zmp_margin
from dancetutor_cli.dance.quality.figures import Body, body_of
from dancetutor_cli.dance.quality.posture import knee_angles, speeds
from dancetutor_cli.dance.quality.report import report

POINTS = ROOT / "tools" / "before_after.yaml"
CHARTS = (ROOT / "charts", ROOT / "build" / "corpus" / "dev")
CHARACTERS = ROOT.parent / "shared" / "data" / "characters"
APART = 0.15  # seconds between two of the worst moments
HOW = ("options", "character", "gif", "count", "crop", "width", "columns")  # of `film`
LABEL = (255, 255, 255)
Beside = dict[str, Image.Image]
Curve = tuple[Array, Array, str]  # seconds, values, words for a value


@dataclass(frozen=True)
class Sheet:
    """One sheet: whose point it is, its file's name, what to look at, how it is made and of what."""

    point: str
    name: str
    shows: str
    kind: str
    what: dict[str, Any]


def sheets(path: Path = POINTS) -> list[Sheet]:
    """All sheets of the file, in its order; names begin with the number of their point."""
    out = []
    for number, (point, told) in enumerate(yaml.safe_load(path.read_text("utf-8")).items(), 1):
        for name, made in told["sheets"].items():
            ((kind, what),) = made.items()
            out.append(Sheet(point, f"{number:02d}-{point}-{name}", told["shows"], kind, what))
    return out


def main() -> None:
    options = _options()
    wanted = [one for one in sheets() if not options.points or {one.point, one.name} & set(options.points)]
    if unknown := set(options.points) - {name for one in wanted for name in (one.point, one.name)}:
        sys.exit(f"there is no point {', '.join(sorted(unknown))}; --list tells them")
    for one in wanted:
        if options.list:
            print(f"{one.name}: {one.shows}")
            continue
        pictures = KINDS[one.kind](options.beside, **one.what)
        options.out.mkdir(parents=True, exist_ok=True)
        path = options.out / f"{one.name}.png"
        under({f"before: {options.beside}" if name != HERE else name: p for name, p in pictures.items()}).save(path)
        print(f"{path}: {one.shows}", flush=True)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("points", nargs="*", metavar="POINT", help="only these points, or sheets")
    parser.add_argument("--beside", metavar="COMMIT", default="HEAD", help="whose pictures stand above today's")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "before-after", help="folder of the sheets")
    parser.add_argument("--list", action="store_true", help="only tell points and sheets")
    return parser.parse_args()


def place(chart: str) -> Path:
    """Where a chart of the list is."""
    for folder in CHARTS:
        if (folder / chart).is_file():
            return folder / chart
    sys.exit(f"{chart} is in neither {' nor '.join(str(folder) for folder in CHARTS)}; the tests unpack the latter")


def motion(commit: str, chart: str, at: list[float], figure: str = "", worst: bool = False, **which: Any) -> Beside:
    """Moments of a motion.

    figure : of FIGURES, told at each moment, and below which goals are missed; worst : those moments in which the
    earlier motion has most of it; which : as in `Moments`
    """
    moments = Moments(place(chart), (at[0], at[1]), **which)
    now, pad = baked(moments)
    motions = {commit: baked_before(commit, moments), HERE: now}
    if not figure:
        times = moments.times(now)
        return {name: sheet(one, pad, times) for name, one in motions.items()}
    curves = {name: FIGURES[figure](one) for name, one in motions.items()}
    times = largest(*curves[commit][:2], moments) if worst else moments.times(now)
    out = {}
    for name, (seconds, values, words) in curves.items():
        told = [words.format(values[np.abs(seconds - time).argmin()]) for time in times]
        out[name] = _captioned(sheet(motions[name], pad, times, told), figures(motions[name]))
    return out


def film(commit: str, chart: str, section: str, fps: int, **how: Any) -> Beside:
    """Pictures of a film.

    section : goes on after the pictures, for notes behind its end are not shown
    how : options of `render`; character, a file of the test data; gif; count of the pictures; crop, (left, top, right,
    bottom) of 1; width of a picture, pixels; columns of them
    """
    call = ["--section", section, "--fps", str(fps), "--jobs", "1", *(str(word) for word in how.get("options", ()))]
    if "character" in how:
        call += ["--character", str(CHARACTERS / how["character"])]
    films = {name: filmed_by(name, place(chart), call, how.get("gif", False)) for name in (commit, HERE)}
    both = min(len(pictures) for pictures in films.values())  # today's go on after the section
    return {
        name: _row([_cut(one, how) for one in pictures[:both][: how.get("count")]], how.get("columns", 4))
        for name, pictures in films.items()
    }


def character(commit: str, groups: str, columns: int = 4) -> Beside:
    """The dancer by herself as films draw her, by today's tools/character_sheet.py on each commit's package."""
    out = {}
    for name in (commit, HERE):
        with tempfile.TemporaryDirectory() as new:
            run_on(name, [str(ROOT / "tools" / "character_sheet.py"), new, "dancer", *([groups] if groups else [])])
            paths = [path for path in sorted(Path(new).glob("*.png"), key=_made) if path.stem != "sheet"]
            pictures = [Image.open(path).convert("RGB") for path in paths]
        out[name] = _row(pictures, columns)
    return out


KINDS: dict[str, Callable[..., Beside]] = {"motion": motion, "film": film, "character": character}


def _balance(motion: Motion) -> Curve:
    """How far the zero-moment point is outside of the soles, centimetres."""
    body = body_of(motion)
    return _firm(body), 100.0 * zmp_margin(body), "outside {:+.1f} cm"


def _force(motion: Motion) -> Curve:
    """The force of the ground in body weights."""
    body = body_of(motion)
    return _firm(body), ground_force(body), "{:.1f} body weights"


def _wrists(motion: Motion) -> Curve:
    """The speed of the faster wrist, metres a second."""
    body = body_of(motion)
    both = [speeds(body, motion.skeleton.index(f"{side}_radiocarpal")) for side in "lr"]
    return body.times[: len(both[0])], np.maximum(*both), "wrist {:.1f} m/s"


def _knees(motion: Motion) -> Curve:
    """Flexion of the knees, the mean of both, degrees."""
    body = body_of(motion)
    return body.times, 180.0 - knee_angles(body, motion.skeleton).mean(axis=1), "knees {:.0f} degrees"


def _hips(motion: Motion) -> Curve:
    """Where the hips are over the feet, from the middle between them to the screen's right, centimetres."""
    body = body_of(motion)
    feet = body.soles[..., 0].mean(axis=(1, 2))
    return body.times, 100.0 * (feet - body.joints[:, 0, 0]), "hips {:+.1f} cm"


def _firm(body: Body) -> Array:
    """The seconds at which a foot stands, as in the frames before and after: there balance and force are measured."""
    standing = np.asarray(body.is_standing.any(axis=1))
    return body.times[1:-1][standing[1:-1] & standing[2:] & standing[:-2]]


FIGURES = {"balance": _balance, "force": _force, "wrists": _wrists, "knees": _knees, "hips": _hips}


def largest(seconds: Array, values: Array, moments: Moments) -> Array:
    """The seconds of the largest values within `moments.at`, APART from each other, in order."""
    found: list[float] = []
    for k in np.argsort(-values):
        second = float(seconds[k])
        if moments.at[0] <= second <= moments.at[1] and all(abs(second - other) >= APART for other in found):
            found.append(second)
        if len(found) == moments.count:
            break
    return np.array(sorted(found))


def figures(motion: Motion) -> list[str]:
    """A line for each goal that a motion does not meet."""
    missed = [one for one in report(motion).figures if one.is_met is False]
    return [f"{one.name} {one.value:.4g} {one.unit}, goal {one.goal:g}" for one in missed] or ["every goal is met"]


def _captioned(picture: Image.Image, lines: list[str]) -> Image.Image:
    out = Image.new("RGB", (picture.width, picture.height + 14 * len(lines) + 6))
    out.paste(picture, (0, 0))
    ImageDraw.Draw(out).text((4, picture.height + 2), "\n".join(lines), fill=LABEL)
    return out


def _cut(picture: Image.Image, how: dict[str, Any]) -> Image.Image:
    left, top, right, bottom = how.get("crop", (0.0, 0.0, 1.0, 1.0))
    w, h = picture.size
    part = picture.crop((round(left * w), round(top * h), round(right * w), round(bottom * h)))
    width = how.get("width", part.width)
    return part if width == part.width else part.resize((width, round(part.height * width / part.width)))


def _row(pictures: list[Image.Image], columns: int) -> Image.Image:
    """Pictures of one size in rows of so many."""
    width, height = pictures[0].size
    rows = -(-len(pictures) // columns)
    out = Image.new("RGB", (width * min(columns, len(pictures)), height * rows))
    for k, picture in enumerate(pictures):
        out.paste(picture, (k % columns * width, k // columns * height))
    return out


def _made(path: Path) -> int:
    return path.stat().st_mtime_ns


if __name__ == "__main__":
    main()
