#!/usr/bin/env python3
"""Restage chapters 5 and 6 of the thesis on retargeting by physics: each setting off and on, measured and drawn.

usage: tools/thesis_restaged.py [FOLDER]     (of captures: a walk `*walk*.bvh` and others)
Writes tests/data/thesis_restaged.json, docs/physics-limits.svg and others, and the part of docs/thesis.md between its
two marks. Three seconds of the walk, forward and then backward as in the thesis, through the ragdoll; the last column
of each table has its figure for every clip in FOLDER. tests/test_thesis_restaged.py checks that page and pictures are
what this makes of the JSON, and measures a table anew.
"""

from __future__ import annotations

import argparse
import json
import textwrap
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from thesis_figures import (
    Figure,
    Taken,
    forearm,
    height,
    knee,
    knees_bent,
    lean,
    mean,
    most,
    nod,
    sinks,
    slide,
    tip,
    wobble,
    worst,
)
from thesis_pictures import picture

from dancetutor_cli.character.retargeting import Retargeting, RetargetTask
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.physics.blend import Blend
from dancetutor_cli.dance.physics.pipeline import CORRECTIONS, RagdollOptions, through_ragdoll
from dancetutor_cli.dance.physics.style import PARTS, Spring, Style, load_style
from dancetutor_cli.dance.units import Array
from dancetutor_cli.formats.captured import read_source
from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.files import write_atomic

ROOT = Path(__file__).resolve().parent.parent
DATA, PAGE = ROOT / "tests" / "data" / "thesis_restaged.json", ROOT / "docs" / "thesis.md"
MARKS = ("<!-- written by tools/thesis_restaged.py -->", "<!-- end of what tools/thesis_restaged.py writes -->")
SECONDS, START, TURN = 3.0, 1.0, 0.4  # of a clip that goes forward, and from where; then it goes backward
LOOSE = (
    5.0  # hertz: springs at which this ragdoll is as far from its input as the thesis's (mean 1 to 2, most 3 to 7 cm)
)
LINE = 140  # letters of a line of the page
DRAWN = 60  # values of a curve that are kept
NEUTRAL = load_style("neutral")


def sprung(style: Style, frequency: float, parts: tuple[str, ...] = PARTS) -> Style:
    """The style with springs of that many hertz at some parts."""
    return replace(style, springs=style.springs | {p: Spring((frequency,) * 3, (0.5,) * 3) for p in parts})


def body(style: Style, **numbers: float) -> Style:
    return replace(style, body=replace(style.body, **numbers))


SOFTER = sprung(NEUTRAL, 20.0)  # which 60 steps a second hold
STILL = body(sprung(NEUTRAL, LOOSE), gravity=0.0)
FULL, OWN = RagdollOptions(CORRECTIONS, own_legs=True), RagdollOptions(own_legs=True)
HEAVIER = {"arms": 10000.0, "hands": 10000.0, "head": 10000.0}


@dataclass(frozen=True)
class Setting:
    """A row. corrected : through the default corrections of `retarget`, else the ragdoll's own legs"""

    words: str
    style: Style
    corrected: bool = False
    source: str = ""


@dataclass(frozen=True)
class Experiment:
    """A table: a title, what the thesis found, its rows, its columns with their decimals.

    curve : what is drawn of the rows `drawn`; () are all
    """

    key: str
    title: str
    source: str
    rows: tuple[Setting, ...]
    columns: tuple[tuple[str, Figure, int], ...]
    everywhere: tuple[str, Figure, int]
    curve: tuple[str, Callable[[Taken], Array]]
    drawn: tuple[str, ...] = ()


def experiments() -> tuple[Experiment, ...]:
    """All tables, in the order of the thesis."""
    knees_off = replace(NEUTRAL, disabled=("l_knee", "r_knee"), points=_soft_ankles())
    bare = replace(body(NEUTRAL, stiffness=0.0), extra_points=False)
    spine = tuple((f"{w} of vt10, {u}", f("vt10"), 2) for w, u, f in _SPINE)
    heavier = replace(STILL, density=STILL.density | HEAVIER)
    return (
        Experiment(
            "limits",
            "5.1 Joint limits",
            "with all points the knee is right without limits, too (5 degrees apart at one moment). Without the "
            "knees' points and limits it bends the wrong way, and each of its distances is twice as large",
            (
                Setting("all points, no limits", replace(NEUTRAL, limits=False)),
                Setting("all points, limits", NEUTRAL),
                Setting("no knee points, no limits", replace(knees_off, limits=False)),
                Setting("no knee points, limits", knees_off),
            ),
            (
                ("least bend of the knee, degrees", lambda r: float(knee(r).min()), 1),
                ("mean of the knee, cm", mean("l_knee"), 2),
                ("largest, cm", most("l_knee"), 2),
                ("mean of the ankle, cm", mean("l_talocrural"), 2),
            ),
            ("largest of the knee, cm", most("l_knee"), 1),
            ("bend of the left knee, degrees", knee),
        ),
        Experiment(
            "stiffness",
            "5.2 Extra points and joint stiffness",
            "without extra points all distances of the spine are at least twice as large. Stiffness removes the rest "
            "of the wobble",
            (
                Setting("no stiffness, no extra points", bare),
                Setting("no stiffness, extra points", body(NEUTRAL, stiffness=0.0)),
                Setting("stiffness, no extra points", replace(body(NEUTRAL, stiffness=1.0), extra_points=False)),
                Setting("stiffness, extra points", body(NEUTRAL, stiffness=1.0)),
                Setting(
                    "stiffness of vl5, vt10 and vt4 alone, extra points",
                    replace(body(NEUTRAL, stiffness=0.0), stiffness={"vl5": 1.0, "vt10": 1.0, "vt4": 1.0}),
                ),
            ),
            spine,
            ("largest of vt10, cm", most("vt10"), 2),
            ("distance of vt10, cm", lambda r: r.apart("vt10")),
        ),
        Experiment(
            "rotation",
            "5.3 Extra points for rotation",
            "without them the right hand turns between 20 and 90 degrees, although it should stay at 40. Distances are "
            "twice as large",
            (Setting("no extra points", replace(NEUTRAL, extra_points=False)), Setting("extra points", NEUTRAL)),
            (
                ("mean turn off, degrees", lambda r: float(np.abs(forearm(r)).mean()), 1),
                ("largest, degrees", lambda r: float(np.abs(forearm(r)).max()), 1),
                ("mean of the hand, cm", lambda r: tip(r)[0], 2),
                ("largest, cm", lambda r: tip(r)[1], 2),
            ),
            ("mean turn off, degrees", lambda r: float(np.abs(forearm(r)).mean()), 0),
            ("turn of the right hand away from the input, degrees", forearm),
        ),
        Experiment(
            "rates",
            "5.4 Update rate and sample rate",
            "at 60 steps and 30 samples a second shoulders and feet go up and down. Distances of the left foot are at "
            "least twice those at 1000 steps (170 on average) and 180 samples",
            (
                Setting("60 steps, 30 samples, springs of 32 Hz", body(NEUTRAL, update_rate=60.0, sample_rate=30.0)),
                Setting("60 steps, 30 samples", body(SOFTER, update_rate=60.0, sample_rate=30.0)),
                Setting("60 steps, 180 samples", body(SOFTER, update_rate=60.0, sample_rate=180.0)),
                Setting("240 steps, 30 samples", body(SOFTER, sample_rate=30.0)),
                Setting("240 steps, 240 samples", SOFTER),
                Setting("1000 steps, 180 samples", body(SOFTER, update_rate=1000.0, sample_rate=180.0)),
            ),
            (
                ("mean of the foot, cm", mean("l_metatarsal"), 2),
                ("largest, cm", most("l_metatarsal"), 2),
                ("wobble of the foot, mm", wobble("l_metatarsal"), 2),
                ("wobble of the shoulder, mm", wobble("l_shoulder"), 2),
            ),
            ("largest of the foot, cm", most("l_metatarsal"), 1),
            ("distance of the left ball, cm", lambda r: r.apart("l_metatarsal")),
        ),
        Experiment(
            "placement",
            "6.1 One on one: End, Center and Hybrid Center",
            "End has means of 1 to 2 cm, deviations of 0.5 to 1, at most 3 to 7, the root below 1. Center is up to "
            "twice as far, feet 8 on average and 15.5 at most. With Hybrid, feet are at 1 and 6 again",
            tuple(
                Setting(f"{place}, {words}", replace(style, placement=place))
                for words, style in ((f"{LOOSE:g} Hz", STILL), ("32 Hz", NEUTRAL))
                for place in ("end", "center", "hybrid")
            ),
            (
                ("largest mean, cm", worst(0), 2),
                ("largest deviation, cm", worst(1), 2),
                ("farthest, cm", worst(2), 2),
                ("mean of the root, cm", mean("HumanoidRoot"), 2),
                ("mean of the foot, cm", mean("l_metatarsal"), 2),
                ("largest, cm", most("l_metatarsal"), 2),
            ),
            ("largest mean, cm", worst(0), 2),
            ("distance of the left ball, cm", lambda r: r.apart("l_metatarsal")),
        ),
        Experiment(
            "forces",
            "6.2 to 6.5 Springs, friction, density, gravity, points that are off",
            "soft arms swing on, and friction makes feet drag. Heads and arms ten times as dense swing more and are "
            "late. Gravity of 3 and 4 m/s^2 pulls the body down while feet stay, so knees and spine bend more. Gravity "
            "of 1 upward lifts it. Without the point on top of the head it looks up",
            _forces(heavier),
            (
                ("pelvis up, cm", height("HumanoidRoot"), 1),
                ("knees bent more, degrees", knees_bent, 1),
                ("leans ahead, degrees", lean, 1),
                ("looks up, degrees", nod, 1),
                ("hands off, cm", mean("l_radiocarpal"), 1),
                ("feet off, cm", mean("l_talocrural"), 1),
                ("slide, mm", slide, 1),
            ),
            ("pelvis up, cm", height("HumanoidRoot"), 1),
            ("height of the pelvis over the input's, cm", sinks),
            ("nothing", "gravity 4", "gravity 20", "gravity 1 upward", "density of head and arms 10,000"),
        ),
    )


_SPINE = (("mean", "cm", mean), ("largest", "cm", most), ("wobble", "mm", wobble))


def _forces(heavier: Style) -> tuple[Setting, ...]:
    """The rows of chapter 6's styles: the ragdoll's own legs, and some with the default corrections of `retarget`."""
    rows = (
        Setting("nothing", STILL),
        Setting("arms at 2 Hz", sprung(STILL, 2.0, ("arms", "hands"))),
        Setting("left wrist alone at 1 Hz", replace(STILL, points={"l_radiocarpal": Spring((1.0,) * 3, (0.5,) * 3)})),
        Setting("friction 0, gravity 9.81", body(STILL, gravity=9.81, friction=0.0)),
        Setting("friction 1, gravity 9.81", body(STILL, gravity=9.81, friction=1.0)),
        Setting("friction 8, gravity 9.81", body(STILL, gravity=9.81, friction=8.0)),
        Setting("density of head and arms 10,000", heavier),
        Setting("the same, gravity 3", body(heavier, gravity=3.0)),
        Setting("gravity 3", body(STILL, gravity=3.0)),
        Setting("gravity 4", body(STILL, gravity=4.0)),
        Setting("gravity 20", body(STILL, gravity=20.0)),
        Setting("gravity 1 upward", body(STILL, gravity=-1.0)),
        Setting("no point on top of the head, gravity 4", replace(body(STILL, gravity=4.0), disabled=("skull_tip",))),
        Setting("gravity 20, springs of 32 Hz", body(NEUTRAL, gravity=20.0)),
    )
    reach = [row for row in rows if row.words in ("nothing", "gravity 4", "gravity 20", "the same, gravity 3")]
    return (*rows, *(replace(row, words=f"{row.words}; corrected", corrected=True) for row in reach))


def _soft_ankles() -> dict[str, Spring]:
    """Springs that leave the plane of the legs free: ankles softer, so that knees go where limits let them."""
    return {f"{side}_{name}": Spring((4.0,) * 3, (0.5,) * 3) for side in "lr" for name in ("talocrural", "metatarsal")}


def clip(path: Path) -> Motion:
    """`SECONDS` of a capture on the dancer's body, forward and then backward; it begins, turns and ends slowly."""
    motion = Retargeting(RetargetTask(path, "dancer", "neutral", RagdollOptions()), read_source(path)).input_on_body
    times = np.arange(round(2 * SECONDS * motion.fps) + 1) / motion.fps
    speed = np.clip((SECONDS - times) / TURN, -1.0, 1.0) * np.clip(
        np.minimum(times, 2 * SECONDS - times) / TURN, 0.0, 1.0
    )
    at = motion.times[0] + START + np.concatenate(([0.0], np.cumsum((speed[1:] + speed[:-1]) / 2) / motion.fps))
    rotations, root = sample(motion, np.clip(at, motion.times[0], motion.times[-1]))
    return replace(motion, times=times, rotations=rotations, root=root)


def measured(experiment: Experiment, clips: dict[str, Motion]) -> list[dict[str, Any]]:
    """Of each row its figures on the walk, the last column's on all clips, and the curve."""
    out = []
    walk = next(name for name in clips if "walk" in name)
    for row in experiment.rows:
        try:
            options = FULL if row.corrected else OWN
            runs = {
                name: Taken(motion, through_ragdoll(motion, Blend.of(row.style), options))
                for name, motion in clips.items()
            }
        except DancetutorError:  # the engine says that it fails
            out.append({"words": row.words})
            continue
        curve = experiment.curve[1](runs[walk])
        step = max(1, len(curve) // DRAWN)
        out.append(
            {
                "words": row.words,
                "figures": [round(figure(runs[walk]), digits + 1) for _, figure, digits in experiment.columns],
                "everywhere": {
                    n: round(experiment.everywhere[1](run), experiment.everywhere[2] + 1) for n, run in runs.items()
                },
                "curve": [round(float(x), 2) for x in curve[::step]],
            }
        )
    return out


def block(data: dict[str, Any]) -> str:
    """The part of the page that is made of the measured figures, with its marks."""
    out = [MARKS[0], ""]
    for experiment in experiments():
        rows = data[experiment.key]
        names = next(list(row["everywhere"]) for row in rows if "everywhere" in row)
        head = [
            "",
            *(name for name, _, _ in experiment.columns),
            f"{experiment.everywhere[0]}: {' / '.join(map(_short, names))}",
        ]
        said = textwrap.fill(f"The thesis: {experiment.source}.", LINE, break_long_words=False, break_on_hyphens=False)
        out += [f"### {experiment.title}", "", said, ""]
        out += [_line(head), _line(["---"] * len(head))]
        for row in rows:
            if "figures" not in row:
                out.append(_line([row["words"], "the simulation fails", *[""] * (len(head) - 2)]))
                continue
            values = [f"{x:.{digits}f}" for x, (_, _, digits) in zip(row["figures"], experiment.columns, strict=True)]
            last = " / ".join(f"{row['everywhere'][n]:.{experiment.everywhere[2]}f}" for n in names)
            out.append(_line([row["words"], *values, last]))
        out += ["", f"![{experiment.curve[0]}, walk](physics-{experiment.key}.svg)", ""]
    return "\n".join([*out, MARKS[1]])


def _short(name: str) -> str:
    return next((word for word in ("walk", "jumps", "dab", "jacks") if word in name), name)


def _line(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _as_text(data: dict[str, Any]) -> str:
    """The figures as JSON, a line for each row."""
    rows = (f'"{key}": [\n' + ",\n".join(map(json.dumps, value)) + "\n]" for key, value in data.items())
    return "{\n" + ",\n".join(rows) + "\n}\n"


def pictures(data: dict[str, Any]) -> dict[str, str]:
    """The pictures of the page, by file name."""
    return {f"physics-{e.key}.svg": picture(e.curve[0], 2 * SECONDS, _curves(e, data[e.key])) for e in experiments()}


def _curves(experiment: Experiment, rows: list[dict[str, Any]]) -> dict[str, list[float]]:
    """The curves that are drawn, by row."""
    drawn = experiment.drawn or tuple(row["words"] for row in rows)
    return {row["words"]: row["curve"] for row in rows if "curve" in row and row["words"] in drawn}


def page_with(text: str, new: str) -> str:
    """The page with the part between the marks replaced."""
    before, rest = text.split(MARKS[0])
    return before + new + rest.split(MARKS[1])[1]


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "folder", type=Path, nargs="?", help="without it page and pictures are made of the figures there are"
    )
    parser.add_argument("--only", default="", help="write nothing, print one table")
    options = parser.parse_args()
    if options.folder is None:
        data = json.loads(DATA.read_text())
    else:
        captures = sorted(options.folder.glob("*.bvh"), key=lambda path: "walk" not in path.stem)
        clips = {path.stem: clip(path) for path in captures}
        data = {}
        for experiment in experiments():
            if options.only in experiment.key:
                data[experiment.key] = measured(experiment, clips)
                for row in data[experiment.key]:
                    print(experiment.key, *list(row.values())[:3], flush=True)
    if options.only:
        return
    write_atomic(DATA, _as_text(data).encode())
    for name, text in pictures(data).items():
        write_atomic(PAGE.parent / name, text.encode())
    write_atomic(PAGE, page_with(PAGE.read_text(encoding="utf-8"), block(data)).encode())


if __name__ == "__main__":
    main()
