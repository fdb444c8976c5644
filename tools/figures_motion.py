"""Figures of docs/motion.md: the report of the demo song, and how often the goals are met on other charts."""

from __future__ import annotations

import math
import statistics
from collections import Counter
from collections.abc import Callable, Iterable
from functools import cache
from itertools import pairwise
from typing import Any

import motion_report
from figures_base import DEMO, HARD, Figures, corpus, goal_text, goals, markdown, reported, with_unit
from motion_report import Measured

from dancetutor_cli.run.pool import default_jobs

SHOWN = (
    "contact error", "contacts missed", "plant slide", "penetration", "flight gravity off by", "ground force, largest",
    "balance", "frames past joint limits", "limb in torso", "leg in leg",
)  # fmt: skip
UNITS = {
    "contact error": " ms", "plant slide": " mm", "penetration": " mm", "flight gravity off by": " %",
    "ground force, largest": " body weights", "balance": " %", "limb in torso": " % of frames", "leg in leg": " frames",
}  # fmt: skip
RESIDUALS = ("residual force", "residual moment")
CAPTURED = (  # beginnings of names: what captured dancers have
    "lean of", "twist of", "tilt of", "wrists in", "bounce of", "give of", "roll of",
)  # fmt: skip
COUNT, SEED, SECTION = 40, 211, 40.0  # charts, by a seed that chose nothing; seconds of each


def demo() -> str:
    """Figures of `animate --report` for the demo's hard chart."""
    call = ("animate", DEMO, *HARD)
    values, asked = reported(*call), goals(*call)
    rows = [(name, f"{round(values[name], 3):.3g}{UNITS.get(name, '')}", asked[name]) for name in SHOWN]
    return markdown(("figure", "here", "goal"), rows)


@cache
def measured() -> list[Measured]:
    """The sections that both tables below are about. Raises MissingError."""
    corpus()
    found = motion_report.measured(motion_report.pick(COUNT, SEED), None, False, SECTION, default_jobs())
    if broken := [f"{one.path} {one.label}: {one.error}" for one in found if one.error]:
        raise RuntimeError("\n".join(broken))
    return found


def goals_met() -> str:
    """How many sections meet all goals, by steps a second on average."""
    every = measured()
    groups = {
        f"{low:g} to {high:g}" if high < math.inf else f"{low:g} and more": [m for m in every if low <= m.pace < high]
        for low, high in pairwise(motion_report.BANDS)
    }
    groups = {name: group for name, group in groups.items() if group} | {"all": every}

    def line(words: str, misses: Callable[[Measured], list[str]]) -> list[str]:
        return [words, *(f"{sum(not misses(m) for m in group)} of {len(group)}" for group in groups.values())]

    rows = [
        line("all goals but those of the next two lines", lambda m: without(m, RESIDUALS, CAPTURED)),
        line("and those of captured dancers", lambda m: without(m, RESIDUALS)),
        line("and those of inverse dynamics", lambda m: without(m)),
    ]
    return markdown(("sections that meet", *groups), rows)


def goals_missed() -> str:
    """Which goals sections miss, most often missed first."""
    every = measured()
    missed = Counter(name for m in every for name in names_of(m.missed))
    rows = []
    for name, count in missed.most_common():
        values = [(f["value"], f) for m in every for f in m.figures if f["name"] == name and f["value"] is not None]
        figure = values[0][1]
        median = statistics.median(value for value, _ in values)
        rows.append(
            (name, goal_text(figure), f"{count} of {len(values)}", with_unit(f"{round(median, 4):.3g}", figure))
        )
    return markdown(("figure", "goal", "sections that miss it", "median of all sections"), rows, 2)


def names_of(figures: Iterable[dict[str, Any]]) -> list[str]:
    """Their names."""
    return [figure["name"] for figure in figures]


def without(one: Measured, *groups: tuple[str, ...]) -> list[str]:
    """The goals that a section misses, without those whose names begin with a word of the groups."""
    left_out = tuple(begin for group in groups for begin in group)
    return [name for name in names_of(one.missed) if not name.startswith(left_out)]


FIGURES: Figures = {
    "demo": ("motion.md", demo),
    "goals-met": ("motion.md", goals_met),
    "goals-missed": ("motion.md", goals_missed),
}
