"""Rows from small pictures, and between the solver's arrays and the plain reference."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray
from play_reference import Reference, Row

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import Pad, load_pad
from dancetutor_cli.feet.play import Play, Rows, StepKind
from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.feet.solver.solve import solve_rows

KINDS = {".": 0, "1": StepKind.TAP, "L": StepKind.LIFT, "2": StepKind.HOLD, "4": StepKind.ROLL, "r": StepKind.ROLL_TAP}
OTHER_LIMB = {-2: -2, -1: -1, 0: 1, 1: 0, 2: 3, 3: 2}
LIMBS = {Limb.LEFT_FOOT: "L", Limb.RIGHT_FOOT: "R", Limb.LEFT_HAND: "l", Limb.RIGHT_HAND: "r"}


def with_values(preset: Preset, **changes: Mapping[str, Any]) -> Preset:
    """The preset with some of its `weights`, `switches` or `curves` changed."""
    both = {kind: {**dict(getattr(preset, kind)), **new} for kind, new in changes.items()}
    return replace(preset, **{kind: tuple(values.items()) for kind, values in both.items()})


def pad_of(steps_type: str) -> Pad:
    pad = load_pad(steps_type)
    assert pad is not None
    return pad


def rows_of(picture: str, gap: int = 24, bpm: float = 120.0) -> Rows:
    """Rows from text: one word a row, `gap` ticks apart.

    `.` nothing, `1` tap, `L` lift, `2` head of a hold, `3` its tail, `4` head of a roll, `r` a virtual tap, `M` mine,
    `B` tap and mine. A word of dots only is time without a row.
    """
    words = picture.split()
    ticks, kept = [], []
    heads: dict[int, int] = {}
    ends: dict[tuple[int, int], int] = {}
    for number, word in enumerate(words):
        for p, cell in enumerate(word):
            if cell == "3":
                ends[heads.pop(p), p] = number * gap
        if set(word) - set(".3"):
            for p, cell in enumerate(word):
                if cell == "2":
                    heads[p] = len(ticks)
            ticks.append(number * gap)
            kept.append(word)
    cells = np.array([list(word) for word in kept]).reshape(len(kept), len(words[0]) if words else 4)
    steps = np.vectorize(lambda cell: KINDS.get("1" if cell == "B" else cell, 0), otypes=[np.uint8])(cells)
    hold_end = np.full(cells.shape, -1, dtype=np.int64)
    for place, end in ends.items():
        hold_end[place] = end
    return timed(np.array(ticks, dtype=np.int64), steps, hold_end, (cells == "M") | (cells == "B"), bpm)


def timed(
    ticks: NDArray[np.int64],
    steps: NDArray[np.uint8],
    hold_end: NDArray[np.int64],
    mines: NDArray[np.bool_],
    bpm: float = 120.0,
) -> Rows:
    """Rows at a steady tempo; beat 0 is at second 0."""
    ms = np.zeros(len(ticks), dtype=np.int64)
    ms[1:] = np.floor(np.diff(ticks) * 60000.0 / TICKS_PER_BEAT / bpm + 0.5)
    line = np.arange(1, len(ticks) + 1, dtype=np.int32)
    second = ticks / TICKS_PER_BEAT * 60.0 / bpm
    return Rows(ticks.astype(np.int64), second, line, steps.astype(np.uint8), hold_end.astype(np.int64), mines, ms)


def first(rows: Rows, n: int) -> Rows:
    """The first n rows."""
    return Rows(*(getattr(rows, name)[:n] for name in Rows.__slots__))


def reference_of(pad: Pad, allow_doublestep: bool = True) -> Reference:
    """The plain solver on any pad."""
    reference = Reference("dance-single", allow_doublestep)
    reference.panels, reference.cx, reference.cy = [tuple(p) for p in pad.panels.tolist()], *pad.centre
    return reference


def plain(rows: Rows) -> list[Row]:
    """For the plain solver."""
    out = []
    for i in range(len(rows)):
        steps: dict[int, Fraction | None] = {}
        for p in np.flatnonzero(rows.steps[i]).tolist():
            held = rows.steps[i, p] == StepKind.HOLD
            steps[p] = Fraction(int(rows.hold_end[i, p]), TICKS_PER_BEAT) if held else None
        mines = set(np.flatnonzero(rows.mines[i]).tolist())
        out.append(Row(Fraction(int(rows.tick[i]), TICKS_PER_BEAT), steps, mines))
    return out


def plain_play(play: Play) -> list[dict[int, str]]:
    """For the plain solver: {panel: limb} of every row, unplayed steps left out."""
    return [{c: LIMBS[Limb(v)] for c, v in enumerate(row) if v >= 0} for row in play.limb.tolist()]


def letters(play: Play) -> str:
    """Every row as a word: L R feet (l r where their toe presses), < > hands, ? nobody, . no step."""
    names = {-1: ".", -2: "?", 0: "L", 1: "R", 2: "<", 3: ">"}
    words = []
    for limbs, parts in zip(play.limb.tolist(), play.part.tolist(), strict=True):
        cells = (names[limb].lower() if part == 2 else names[limb] for limb, part in zip(limbs, parts, strict=True))
        words.append("".join(cells))
    return " ".join(words)


def mirrored_rows(rows: Rows, image: NDArray[np.int64]) -> Rows:
    """The rows with every panel's notes on its image."""
    back = np.argsort(image)
    return replace(rows, steps=rows.steps[:, back], hold_end=rows.hold_end[:, back], mines=rows.mines[:, back])


def check_mirror(rows: Rows, pad: Pad, preset: Preset, *, left_right: bool) -> int:
    """Rows with a margin have mirrored limbs; returns how many there are."""
    image = pad.mirror_columns(left_right=left_right)
    assert image is not None
    found, mirror = solve_rows(rows, pad, preset), solve_rows(mirrored_rows(rows, image), pad, preset)
    assert found.total == mirror.total
    assert found.margin is not None and mirror.margin is not None
    assert found.margin.tolist() == mirror.margin.tolist()
    limb = mirror.limb[:, image]
    if left_right:
        limb = np.vectorize(OTHER_LIMB.get, otypes=[np.int8])(limb) if limb.size else limb
    sure = found.margin != 0
    assert (limb[sure] == found.limb[sure]).all()
    return int(sure.sum())
