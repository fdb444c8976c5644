"""Figures of docs/physics.md about captured motion, of the clips in ../shared/data/bvh."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path

import capture_table
import spoil_bvh
from figures_base import Figures, Values, goals, markdown, reported, shared
from figures_physics import RESIDUALS, residual_row

from dancetutor_cli.formats.bvh import write_bvh

CLIPS = {"walk": "pymo_8walk", "jumps": "cmu_01_01_jumps", "dab": "fair_dab", "jumping jacks": "fair_jumping_jacks"}
CHARACTERS = {
    "KayKit's rogue (legs of half the length)": "kaykit_rogue",
    "Kenney's man": "m2m_human_kenney",
    "make-human's woman": "m2m_human_female",
}
SPOILED = (0.1, 12.0)  # seconds of a clip that are spoiled
MADE, SEED = 46, 31415  # clips made from these; no number was chosen by this seed
FAULTS = {  # what is made, what is measured: the figure, its unit
    "popping": ("knees snap straight", ("knee acceleration near straight", "degrees/s²")),
    "skating": ("feet skate by 10 cm", ("slide per plant", "mm")),
    "elbows": ("elbows bend backward", ("elbows bent backward", "frames")),
}


def clip(name: str) -> str:
    """The file of a clip. Raises MissingError."""
    return str(shared(f"bvh/{CLIPS[name]}.bvh"))


def uncorrected() -> str:
    """How closely the ragdoll follows a capture without corrections."""
    clips = ("jumps", "walk")
    every = [reported("retarget", clip(name), "--correct", "none") for name in clips]
    asked = goals("retarget", clip("walk"), "--correct", "none")
    names = {"largest mean": "1 to 2", "largest deviation": "0.5 to 1", "farthest": "3 to 7"}
    rows = [
        (name, asked[f"retargeting, {name}"], *(f"{one[f'retargeting, {name}']:.2f} cm" for one in every), f"{was} cm")
        for name, was in names.items()
    ]
    return markdown(("of any point", "goal", "CMU subject 1 trial 1, jumps", "walk", "the thesis's walk"), rows)


@cache
def _spoiled(name: str, fault: str) -> Values:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "spoiled.bvh"
        write_bvh(path, spoil_bvh.spoiled(Path(clip(name)), (fault,), SPOILED))
        return reported("retarget", str(path))


def corrections() -> str:
    """Faults that were made, before and after correction."""
    rows = []
    for fault, (words, (figure, unit)) in FAULTS.items():
        every = [_spoiled(name, fault) for name in ("walk", "jumps")]
        before = [f"{one[f'{figure}, input']:,.0f}" if f"{figure}, input" in one else "-" for one in every]
        after = [f"{one[figure]:,.1f}".removesuffix(".0") if figure in one else "never straight" for one in every]
        rows.append((words, f"{figure}, {unit}", " / ".join(before), " / ".join(after)))
    return markdown(("fault made", "figure", "before", "after"), rows, 2)


@cache
def _measured() -> tuple[tuple[str, list[float], list[float]], ...]:
    """Every clip, also those that are made: what it is called, its figures before and after."""
    folder = shared("bvh")
    return tuple(capture_table.measured(sorted(folder.glob("*.bvh")), MADE, SEED, "dancer")[0])


def slides() -> str:
    """The slide of feet that stand, and other faults, of whole clips."""
    labels = {stem: name for name, stem in CLIPS.items()}
    rows = []
    for label, before, after in _measured():
        if label in labels:
            slide = [f"{one[0]:.0f} / {one[1]:.0f}" for one in (before, after)]
            rest = [f"{before[k]:.0f}, {after[k]:.0f}" for k in (2, 3)]
            rows.append((labels[label], *slide, *rest))
    head = ("slide before", "slide after", "frames past limits", "forearm in the trunk, % of frames")
    return markdown(("clip", *head), rows)


def made_clips() -> str:
    """How many of all clips miss what."""
    after = [figures for _, _, figures in _measured()]
    limits = (
        ("slide more than 5 mm in the median", 0, 5.0),
        ("slide more than 25 mm at worst", 1, 25.0),
        ("have frames past limits", 2, 0.0),
        ("have a forearm in the trunk", 3, 0.1),
        ("have a knee that turns faster than 10,000 degrees/s² near straight", 4, 10000.0),
    )
    rows = [(words, f"{sum(one[k] > most for one in after)} of {len(after)}") for words, k, most in limits]
    worst = max(one[1] for one in after)
    return markdown(("clips that", "count"), [*rows, ("largest slide of all, mm", f"{worst:.0f}")])


def characters() -> str:
    """Other bodies: slide and limits of two clips."""
    rows = []
    for words, stem in CHARACTERS.items():
        character = str(shared(f"characters/{stem}.glb"))
        every = [reported("retarget", clip(name), "--character", character) for name in ("jumps", "walk")]
        slide = [
            f"{one['slide by height and speed, median']:.0f}, {one['slide by height and speed, worst']:.0f}"
            for one in every
        ]
        past = [f"{one['frames past limits']:.0f}" for one in every]
        rows.append((words, *slide, *past))
    head = ("slide in the jumps", "in the walk", "frames past limits in the jumps", "in the walk")
    return markdown(("character", *head), rows)


def captured_residuals() -> str:
    """Forces that captured motion would need from outside, before and after correction."""
    rows = []
    for name in ("jumps", "walk"):
        for words, correct in (("without corrections", "none"), ("corrected", "knees,feet,limits")):
            rows.append(residual_row(f"{name}, {words}", reported("retarget", clip(name), "--correct", correct)))
    return markdown(RESIDUALS, rows)


FIGURES: Figures = {
    "uncorrected": ("physics.md", uncorrected),
    "corrections": ("physics.md", corrections),
    "slides": ("physics.md", slides),
    "made-clips": ("physics.md", made_clips),
    "characters": ("physics.md", characters),
    "captured-residuals": ("physics.md", captured_residuals),
}
