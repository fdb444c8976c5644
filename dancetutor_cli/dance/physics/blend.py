"""The share of each style: one style, a blend such as `fierce:0.6,heavy:0.4`, or changes by measures of a song."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.names import TICKS_PER_MEASURE
from dancetutor_cli.dance.motion import Distances
from dancetutor_cli.dance.physics.style import NEUTRAL, Style, load_style
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.settings import MotionSettings, SettingsCourse, Span, load_settings, state_weights
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.run.errors import DancetutorError, UsageError, choose_text
from dancetutor_cli.run.reading import config_names, is_outside, named_file
from dancetutor_cli.run.yaml_files import read

if TYPE_CHECKING:
    from dancetutor_cli.chart.timing import Timing

TOLERANCE = 1e-6  # by which weights may sum to more than 1, for thirds that are written with six digits
SHORTEST_CHANGE = 0.5  # seconds; least duration of a change, if a warp skips its measure


@dataclass(frozen=True, slots=True)
class Blend:
    """Styles, and their shares over a song. It can be pickled.

    styles : s of them; states : before the first change, after it, ..., each with s shares that sum to 1
    changes : when each state turns into the next one, seconds, in order, without overlap
    """

    styles: tuple[Style, ...]
    states: tuple[tuple[float, ...], ...]
    changes: tuple[Span, ...] = ()

    @classmethod
    def of(cls, style: Style) -> Blend:
        """Return a blend of one style, all the time."""
        return cls((style,), ((1.0,),))

    def shares(self, times: Array) -> Array:
        """Return the shares (f, s) of the styles at times (f,), seconds."""
        return np.asarray(state_weights(self.changes, times) @ np.array(self.states))

    def within(self, times: Array) -> tuple[list[Style], Array]:
        """Return the styles that are used at any of the times (f,), the largest share first, and shares (f, s)."""
        shares = self.shares(times)
        total = shares.sum(axis=0)
        order = [int(k) for k in np.argsort(-total, kind="stable") if total[k] > 0.0]
        return [self.styles[k] for k in order], shares[:, order]

    def settings(self, motion: Path | None, form: str) -> MotionSettings | SettingsCourse:
        """Return the numbers of the motion for a form and a file of changes, as `load_settings` takes them."""
        numbers = [style.motion for style in self.styles]
        states = tuple(load_settings(motion, form, tuple(zip(numbers, state, strict=True))) for state in self.states)
        return states[0] if len(set(states)) == 1 else SettingsCourse(states, self.changes)


@dataclass(frozen=True, slots=True)
class StyleChoice:
    """The value of `--style`. styles, states : as in `Blend`; measures : of each change, at which it is complete"""

    text: str
    styles: tuple[Style, ...]
    states: tuple[tuple[float, ...], ...]
    measures: tuple[int, ...] = ()

    def blend(self, timing: Timing | None = None) -> Blend:
        """Return the blend in a song; each change is in the measure before it. Raises UsageError without a song."""
        if self.measures and timing is None:
            raise UsageError(
                f"style {self.text} changes by measures, and captured motion has none; name a style without 'measures'"
            )
        changes: list[Span] = []
        for measure in self.measures:
            assert timing is not None
            ticks = np.array([measure - 1, measure], dtype=np.int64) * TICKS_PER_MEASURE
            start, end = timing.seconds(ticks).tolist()
            start = max(min(start, end - SHORTEST_CHANGE), changes[-1][1] if changes else -np.inf)
            changes.append((start, max(end, start + SHORTEST_CHANGE)))
        return Blend(self.styles, self.states, tuple(changes))


@cache
def load_choice(text: str) -> StyleChoice:
    """Load a `--style`: NAME or FILE, or NAME:WEIGHT,NAME:WEIGHT; a file may change by measures.

    Raises UsageError for a text in another form and for unknown names, FileError with the line for a wrong file.
    """
    weights = weights_of(text)
    parts = _parts(text, weights)
    changing = [style for style, _ in parts if style.measures]
    if not changing:
        return StyleChoice(text, *_states([parts]))
    if len(parts) > 1:
        name = changing[0].name
        raise UsageError(f"style {name} changes by measures and cannot be blended; write the blend in its file")
    own, source = changing[0], read(named_file("styles", weights[0][0]))
    blends, measures = [parts], sorted(own.measures)
    for measure in measures:
        try:
            other = own.measures[measure]
            blends.append(_parts(other, weights_within(other, source.path.parent)))
            if nested := [style.name for style, _ in blends[-1] if style.measures]:
                raise UsageError(f"style {nested[0]} changes by measures itself; name another one")
        except DancetutorError as error:
            raise source.error(("measures", str(measure)), f"measures.{measure}: {error}") from error
    if measures[0] == 0:
        del blends[0], measures[0]
    return StyleChoice(text, *_states(blends), tuple(measures))


def style_sources(text: str) -> tuple[tuple[str | Path, float], ...]:
    """Return the parts of a `--style`, for fingerprints: names of `configs/styles` and files, with their weights."""
    out: list[tuple[str | Path, float]] = []
    for name, weight in weights_of(text):
        is_file = name not in config_names("styles")
        out.append((Path(name) if is_file else name, weight))
        if is_file:
            for _, other in sorted(load_style(name).measures.items()):
                own = weights_within(other, Path(name).parent)
                out += ((one if one in config_names("styles") else Path(one), share) for one, share in own)
    return tuple(out)


def weights_of(text: str, folder: Path = Path()) -> list[tuple[str, float]]:
    """Return the styles and weights, above 0 to 1, of a `--style`; a single name has 1. folder : of the files

    Raises UsageError for a text in another form.
    """
    parts = [part.strip() for part in text.split(",")]
    if len(parts) == 1 or is_one_name(text, folder):
        name, colon, weight = text.rpartition(":")
        return [(name, _weight(text, weight))] if colon and _is_number(weight) else [(text, 1.0)]
    out = []
    for part in parts:
        name, _, weight = part.rpartition(":")
        if not name:
            raise UsageError(f"style '{text}': give each style a weight, such as fierce:0.6,heavy:0.4")
        out.append((name, _weight(text, weight)))
    return out


def is_one_name(text: str, folder: Path = Path()) -> bool:
    """Whether a text is the name of one file, with any signs in it."""
    return text in config_names("styles") or (folder / text).is_file()


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _weight(text: str, weight: str) -> float:
    if not _is_number(weight) or not 0.0 < float(weight) <= 1.0:
        raise UsageError(f"style '{text}': a weight must be a number above 0, at most 1, not '{weight}'")
    return float(weight)


def weights_within(text: str, folder: Path) -> list[tuple[str, float]]:
    """Return the same as `weights_of` for a text in a style file: names of `configs/styles`, or paths below its folder.

    Raises UsageError for a file elsewhere, because another user may have written the style file.
    """
    names, out = config_names("styles"), []
    for name, weight in weights_of(text, folder):
        path = folder / name
        if is_outside(path, folder):
            raise UsageError(f"'{name}' is outside the folder of the style file; put it beside it")
        if name not in names and not path.suffix and not path.is_file():
            raise UsageError(f"there is no style '{name}'{choose_text(name, names)}")
        out.append((name if name in names else str(path), weight))
    return out


def _parts(text: str, weights: Sequence[tuple[str, float]]) -> list[tuple[Style, float]]:
    """Return styles with their shares, which sum to 1: the rest is neutral. text : for errors"""
    parts = [(load_style(name), weight) for name, weight in weights]
    total = sum(weight for _, weight in parts)
    if any(one is other for (one, _), (other, _) in combinations(parts, 2)):
        raise UsageError(f"style '{text}' names one style twice; name each once")
    if total > 1.0 + TOLERANCE:
        raise UsageError(
            f"style '{text}': the weights sum to {total:g}; they may sum to 1 at most, and what is missing is {NEUTRAL}"
        )
    if total < 1.0 - TOLERANCE:
        return [*parts, (load_style(NEUTRAL), 1.0 - total)]
    return [(style, weight / total) for style, weight in parts]


def _states(blends: list[list[tuple[Style, float]]]) -> tuple[tuple[Style, ...], tuple[tuple[float, ...], ...]]:
    """Return all styles of some blends, and the share of each style in each blend."""
    styles: list[Style] = []
    for style, _ in (part for blend in blends for part in blend):
        if not any(style is one for one in styles):
            styles.append(style)
    states = tuple(tuple(sum(w for one, w in blend if one is style) for style in styles) for blend in blends)
    return tuple(styles), states


# The mean of the results of the ragdolls of several styles.


def mean_poses(poses: Sequence[Poses], shares: Array) -> Poses:
    """Return the mean of poses, local rotations (f, j, 4) and root (f, 3), each with its share (f, s)."""
    if len(poses) == 1:
        return poses[0]
    root = sum(shares[:, k, None] * one for k, (_, one) in enumerate(poses))
    return Poses(quat.mean([rotations for rotations, _ in poses], shares), np.asarray(root))


def mean_distances(runs: Sequence[Distances], times: Array, shares: Array) -> Distances:
    """Return the mean of the distances of ragdolls with the same points, each with its share (f, s) at times (f,)."""
    first = runs[0]
    if len(runs) == 1:
        return first
    values = np.zeros_like(first.values)
    for k, one in enumerate(runs):
        share = np.interp(first.times, times, shares[:, k])
        values += share[:, None] * np.column_stack([np.interp(first.times, one.times, own) for own in one.values.T])
    return Distances(first.names, first.times, values)
