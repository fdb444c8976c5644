"""Figures of docs/films.md: where feet land and how the body turns in each form."""

from __future__ import annotations

import numpy as np
from figures_base import DEMO, HARD, ROOT, Figures, markdown

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.motion import Cut, Motion, sample
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.feet.limbs import Limb, Part

FORMS = {
    "usual": "slow steps on the middle of the panel, quick ones near its inner edge",
    "middle": "every step on the middle: the safest, with the longest distances",
    "edge": "every step at the inner edge: feet stay together, as in streams",
    "heels-in": "toes well out, knees open",
    "heels-out": "feet parallel",
    "screen": "faces the screen: the legs cross under a body that hardly turns; feet pass in front",
    "turning": "the body turns with the feet, only the head still faces the screen; feet pass behind",
}
SECTION = Cut(16.0, 21.3)  # seconds of the demo's Hard chart


def landed(motion: Motion) -> tuple[float, float]:
    """Of feet that land alone: mean distance of the ball from the panel's middle, metres; mean toe-out, degrees."""
    presses = [c for c in motion.contacts if c.limb in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT) and c.part == Part.WHOLE]
    rotations, root = sample(motion, np.array([press.start + 0.002 for press in presses]))
    places, world = world_transforms(motion.skeleton, rotations, root)
    away, out = [], []
    for k, press in enumerate(presses):
        side = "lr"[press.limb]
        ankle, ball = (places[k, motion.skeleton.index(f"{side}_{name}")] for name in ("talocrural", "metatarsal"))
        away.append(np.hypot(*(ball[[0, 2]] - press.panel)))
        front = quat.to_matrix(world[k, :1])[0, :, 2]
        along = ball - ankle
        turned = np.degrees(np.arctan2(along[0], along[2]) - np.arctan2(front[0], front[2]))
        out.append(((turned + 180) % 360 - 180) * (1 if press.limb == Limb.LEFT_FOOT else -1))
    return float(np.mean(away)), float(np.mean(out))


def body_turn(motion: Motion) -> float:
    """How far the pelvis is turned from the screen, degrees, on average."""
    front = quat.to_matrix(motion.rotations[:, 0])[:, :, 2]
    return float(np.degrees(np.abs(np.arctan2(front[:, 0], front[:, 2]))).mean())


def forms() -> str:
    """A line for each form."""
    rows = []
    for name, words in FORMS.items():
        request = DanceRequest(ROOT / DEMO, Selection(index=int(HARD[1])), form=name)
        motion = perform(solve(request), request).bake(SECTION)[0].motion
        away, out = landed(motion)
        rows.append((f"`{name}`", words, f"{1000 * away:.0f}", f"{abs(out):.0f}°", f"{body_turn(motion):.0f}°"))
    return markdown(("form", "what a player does", "ball, mm", "toes out", "turned"), rows, 2)


FIGURES: Figures = {"forms": ("films.md", forms)}
