"""Figures of docs/physics.md about the dancer: styles, pushes, the ragdoll's distance, forces that a motion needs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np
import style_legs
from figures_base import DEMO, HARD, ROOT, Figures, Values, corpus, goals, markdown, reported
from motion_report import pick
from numpy.typing import NDArray

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.bake import bake_piece
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.physics.blend import Blend
from dancetutor_cli.dance.physics.pipeline import RagdollOptions, parse_ragdoll_options
from dancetutor_cli.dance.physics.style import load_style
from dancetutor_cli.dance.pieces import MORE_PLANNED, RagdollStyle, piece_of
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import world_transforms

STYLES = ("neutral", "lazy", "fierce", "heavy", "feminine")
PASSAGE = (8.0, 16.0)  # seconds of the demo's Hard chart
RATE = 60.0  # frames a second
TIMES = np.arange(PASSAGE[0], PASSAGE[1], 1 / RATE)
SMALL = ("braid", "l_eye", "r_eye", "temporo", *(f"{s}_{n}" for s in "lr" for n in ("metacarpo", "carpal")))
LEGS_SEED, LEGS_CHARTS, LEGS_METERS = 5301, 6, (3, 9)  # no number of a style was chosen by this seed
PUSHED, FORCE = 11.0, 300  # second, newtons
KEPT = (
    "contact error", "contacts missed", "plant slide", "balance", "jerk of the root", "jerk of the left hand",
    "jerk of the right hand", "flight residual", "frames past joint limits", "limb in torso",
)  # fmt: skip


def style_leg_figures() -> str:
    """Feet, pelvis and knees of each style, means over sections of charts."""
    corpus()
    low, high = LEGS_METERS
    charts = [one for one in pick(80, LEGS_SEED) if low <= one.meter <= high][:LEGS_CHARTS]
    every = {name: [style_legs.legs_of(chart, name, PASSAGE[1] - PASSAGE[0]) for chart in charts] for name in STYLES}
    rows = []
    for name, legs in every.items():
        means = style_legs.means(legs)
        apart = "" if name == "neutral" else f"{style_legs.distances(legs, every['neutral'])[0]:.1f}"
        rows.append((name, *(f"{means[what]:.1f}" for what in ("peak", "pelvis", "bounce", "knees")), apart))
    head = ("highest in a step", "pelvis, height", "bounce", "between knees", "knees, ankles and toes from `neutral`")
    return markdown(("cm", *head), rows)


@cache
def danced(style: str | None, push: str = "") -> Motion:
    """The passage in a style, perhaps with a push."""
    options = parse_ragdoll_options([push] if push else [], []) if push else RagdollOptions()
    request = DanceRequest(ROOT / DEMO, Selection(index=int(HARD[1])), style=style)
    (dancer,) = perform(solve(request), request).dancers
    ragdoll = None if style is None else RagdollStyle(Blend.of(load_style(style)), options)
    return bake_piece(piece_of(dancer.plan, dancer.context, RATE, (PASSAGE, PASSAGE, MORE_PLANNED), ragdoll)).motion


def joints(motion: Motion, names: Sequence[str] = ()) -> NDArray[np.float64]:
    """Places (f, j, 3) in metres of the joints that are named; without names of all but face, braid and fingers.

    At even times of the passage: keys of two dances are at other times.
    """
    shown = [k for k, n in enumerate(motion.skeleton.names) if (n in names if names else not n.startswith(SMALL))]
    placed: NDArray[np.float64] = world_transforms(motion.skeleton, *sample(motion, TIMES))[0][:, shown]
    return placed


def style_distances() -> str:
    """The mean distance of joints between any two styles, cm."""
    places = {name: joints(danced(name)) for name in STYLES}
    rows = [
        (a, *("" if a == b else f"{100 * np.linalg.norm(places[a] - places[b], axis=2).mean():.1f}" for b in STYLES))
        for a in STYLES
    ]
    return markdown(("cm", *STYLES), rows)


def passage(style: str | None) -> tuple[str, ...]:
    """The call of `animate` for the passage."""
    section = ("--section", f"{PASSAGE[0]:g}:{PASSAGE[1]:g}")
    return ("animate", DEMO, *HARD, *section, *(("--style", style) if style else ()))


def styles_kept() -> str:
    """The worst of all styles, of the figures that a style could spoil."""
    reports = {name: reported(*passage(name)) for name in STYLES}
    asked = goals(*passage("neutral"))
    units = {name: goal.split(" ", 3)[3:] for name, goal in asked.items()}  # "at most 1 mm" has one
    rows = []
    for name in KEPT:
        values = {style: report[name] for style, report in reports.items()}
        worst = (min if name == "balance" else max)(values, key=lambda style: values[style])
        value = " ".join((f"{values[worst]:.3g}", *units[name]))
        rows.append((name, value, worst if values[worst] else "", asked[name]))
    return markdown(("figure", "worst value", "style", "goal"), rows)


def pushes() -> str:
    """How far hips and head give way to a push, and what is left a second later."""
    plain, rows = danced("neutral"), []
    later = TIMES >= PUSHED + 1.15
    for direction in ("left", "ahead", "back"):
        moved = danced("neutral", f"{PUSHED:g}:{FORCE}:{direction}")
        moves = [joints(moved, (name,)) - joints(plain, (name,)) for name in ("HumanoidRoot", "skullbase")]
        off = [100 * np.linalg.norm(one, axis=2) for one in moves]
        rest = 100 * np.linalg.norm(joints(moved) - joints(plain), axis=2)[later].max()
        rows.append((direction, *(f"{one.max():.0f}" for one in off), f"{rest:.2f}"))
    return markdown(("direction", "hips, cm", "head, cm", "any joint, a second later, cm"), rows)


def ragdoll() -> str:
    """How closely the ragdoll follows the dance."""
    call = ("animate", DEMO, *HARD, "--section", "10:20", "--physics")
    values, asked = reported(*call), goals(*call)
    names = ("retargeting, largest mean", "retargeting, largest deviation", "retargeting, farthest")
    thesis = ("1 to 2", "0.5 to 1", "3 to 7")
    rows = [(name, asked[name], f"{values[name]:.2f} cm", f"{was} cm") for name, was in zip(names, thesis, strict=True)]
    return markdown(("of any point", "goal", "here", "the thesis's walk"), rows)


def residual_row(name: str, values: Values) -> tuple[str, ...]:
    """A line of the table of residuals."""
    pairs = [
        f"{values[f'residual {what}, median']:.3f} / {values[f'residual {what}, 99th percentile']:.2f}"
        for what in ("force", "moment")
    ]
    rest = [f"{values[one]:.2f}" for one in ("skating ratio (GMD)", "PFC (EDGE)", "penetration (PhysDiff)")]
    return (name, *pairs, *rest)


RESIDUALS = ("", "residual force", "residual moment", "skating ratio", "PFC", "penetration, mm")


def residuals() -> str:
    """Forces that the dance would need from outside, and measures of others."""
    rows = [residual_row(style or "without a ragdoll", reported(*passage(style))) for style in (None, *STYLES)]
    return markdown(RESIDUALS, rows)


FIGURES: Figures = {
    "style-legs": ("physics.md", style_leg_figures),
    "style-distances": ("physics.md", style_distances),
    "styles-kept": ("physics.md", styles_kept),
    "pushes": ("physics.md", pushes),
    "ragdoll": ("physics.md", ragdoll),
    "residuals": ("physics.md", residuals),
}
