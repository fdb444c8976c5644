"""Fits the weights and curves of a preset to labelled feet, by two methods that look at whole plays.

likelihood : plays are as likely as their costs are small, exp(-cost / 100); the weights under which the labelled feet
    are likeliest (Lafferty et al. 2001, conditional random fields), by forward-backward sums and L-BFGS
perceptron : weights move from the terms of the labelled play to those of the play found (Collins 2002), averaged
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from feet_data import Labelled
from feet_lattice import (
    BY_SIZE,
    CURVES,
    FIXED,
    WEIGHTS,
    Asked,
    Book,
    Charges,
    Lattice,
    Slopes,
    book,
    flags,
    move_costs,
    sums,
    viterbi,
    with_values,
)  # fmt: skip
from numpy.typing import NDArray
from scipy.optimize import minimize

from dancetutor_cli.feet.preset import MAX_WEIGHT, Preset
from dancetutor_cli.feet.solver.engine import cost_at
from dancetutor_cli.feet.solver.packing import DISTANCE_UNIT
from dancetutor_cli.feet.solver.vocabulary import MOST_MS

Floats = NDArray[np.float64]
SCALE = 100.0  # a cost of so much makes a play e times less likely
FORBIDDEN = 30.0  # what `FIXED` weights cost while fitting, in units of SCALE
_AT_ONCE = 8  # charts between two steps of the perceptron
MOST = 60.0  # of any weight, in units of SCALE
KNOTS = np.array([50, 80, 110, 150, 200, 270, 370, 500, 700, 1000, 1500])  # of every curve, milliseconds
SMALL, SMOOTH = 3e-6, 3e-5  # what the square of a weight costs, and of the difference of neighbouring knots, a row

# what a foot cannot do is no label's business
_GIVEN = {"teleport": np.where(KNOTS <= 80, FORBIDDEN, 0.0)}
_HIGH = np.concatenate(
    [np.full(len(WEIGHTS), MOST), *(_GIVEN.get(name, np.full(len(KNOTS), MOST)) for name in CURVES)]
)  # fmt: skip
_FREE = np.array([name not in FIXED for name in WEIGHTS])
_UNIT = np.array([DISTANCE_UNIT if name in BY_SIZE else 1 for name in WEIGHTS])
_HAT = np.stack([np.interp(np.arange(MOST_MS + 1), KNOTS, row) for row in np.eye(len(KNOTS))], axis=1)


@dataclass(frozen=True)
class Share:
    """Charts of one pad that a fit looks at, and how much each of their rows counts."""

    book: Book
    lattices: Sequence[Lattice]
    weight: float = 1.0


def shares(labels: Sequence[Labelled], preset: Preset) -> list[Share]:
    """All charts, by pad."""
    by_pad: dict[str, list[Labelled]] = defaultdict(list)
    for label in labels:
        by_pad[label.pad.steps_type].append(label)
    books = [book(charts, preset) for charts in by_pad.values()]
    return [Share(each, each.lattices) for each in books]


def part(whole: Iterable[Share], keep: set[str], weight: float = 1.0) -> list[Share]:
    """The charts with some names, with a weight."""
    out = [Share(s.book, [x for x in s.lattices if x.label.name in keep], weight) for s in whole]
    return [share for share in out if share.lattices]


def vector(preset: Preset) -> Floats:
    """Weights, then the curves at `KNOTS`, in units of SCALE."""
    weights = np.array([preset.weight(name) for name in WEIGHTS]) / _UNIT
    curves = np.array([cost_at(preset.curve(name), KNOTS) for name in CURVES])
    return np.clip(np.concatenate([weights, curves.ravel()]) / SCALE, 0.0, MOST)


def fitted(preset: Preset, found: Floats) -> Preset:
    """The preset with the values of a vector, in whole numbers."""
    weights, curves = _split(found)
    whole = np.rint(weights * _UNIT * SCALE).astype(int).clip(max=MAX_WEIGHT)
    knots = [
        tuple((int(ms), round(float(cost) * SCALE)) for ms, cost in zip(KNOTS, row, strict=True)) for row in curves
    ]
    return with_values(
        preset,
        weights={name: int(value) for name, value, free in zip(WEIGHTS, whole, _FREE, strict=True) if free},
        curves=dict(zip(CURVES, knots, strict=True)),
    )


def _split(found: Floats) -> tuple[Floats, Floats]:
    weights = np.where(_FREE, found[: len(WEIGHTS)], FORBIDDEN)
    return weights, found[len(WEIGHTS) :].reshape(len(CURVES), len(KNOTS))


def _priced(share: Share, found: Floats) -> tuple[Floats, Floats]:
    """The costs of the moves of a share without time, and what time adds by milliseconds and facts."""
    weights, curves = _split(found)
    return move_costs(share.book, weights), (_HAT @ curves.T) @ flags(share.book).T


def _by_parameter(share: Share, moves: Floats, timed: Floats) -> Floats:
    """Sums over moves and over (ms, facts) as sums over the parameters."""
    b = share.book
    rows = np.bincount(b.terms, weights=moves, minlength=len(b.counts))[: len(b.counts)]
    return np.concatenate([np.where(_FREE, rows @ b.counts, 0.0), (_HAT.T @ (timed @ flags(b))).T.ravel()])


class Limits(NamedTuple):
    """Limits of the parameters. low : the least of each; falling : bool (curves,), those that never rise with time"""

    low: Floats
    falling: NDArray[np.bool_]


def limits(floors: Mapping[str, Floats | float], falling: Sequence[str] = ()) -> Limits:
    """At least 0, what is given, and floors of some weights, and of some curves at `KNOTS`."""
    given = {**floors, **_GIVEN}
    sizes = [1] * len(WEIGHTS) + [len(KNOTS)] * len(CURVES)
    low = [np.broadcast_to(given.get(name, 0.0), size) for name, size in zip(WEIGHTS + CURVES, sizes, strict=True)]
    return Limits(np.concatenate(low).astype(float), np.isin(CURVES, falling))


AT_LEAST_0 = limits({})


def _sums_of_steps(falling: NDArray[np.bool_]) -> Floats:
    """A matrix from steps to parameters: a knot of a falling curve is the sum of its own step and all later ones."""
    out = np.eye(len(WEIGHTS) + len(CURVES) * len(KNOTS))
    for number in np.flatnonzero(falling):
        own = slice(len(WEIGHTS) + number * len(KNOTS), len(WEIGHTS) + (number + 1) * len(KNOTS))
        out[own, own] = np.triu(out[own, own] + 1.0).clip(max=1.0)
    return out


def _steps(found: Floats, within: Limits) -> Floats:
    """The steps whose sums are the parameters, or the next larger ones that fall."""
    weights, curves = found[: len(WEIGHTS)], found[len(WEIGHTS) :].reshape(len(CURVES), len(KNOTS))
    raised = np.maximum.accumulate(curves[:, ::-1], axis=1)[:, ::-1]
    steps = raised - np.pad(raised[:, 1:], ((0, 0), (0, 1)))
    return np.concatenate([weights, np.where(within.falling[:, None], steps, curves).ravel()])


def loss(found: Floats, data: Sequence[Share], pull: float = 1.0, home: Floats | None = None) -> tuple[float, Floats]:
    """Minus the mean log-likelihood of a labelled row, and its gradient.

    pull : how much it costs that weights are away from `home`, which is 0 if it is not given
    """
    total, gradient, rows = 0.0, np.zeros_like(found), 0.0
    for share in data:
        b = share.book
        cost, timed = _priced(share, found)
        by_move, by_time = np.zeros(len(b.terms)), np.zeros_like(timed)
        charges = Charges(b.facts, b.action, cost, timed)
        slopes = Slopes(by_move, by_time, np.zeros(max(len(x.move) for x in share.lattices)))
        for x in share.lattices:
            total -= share.weight * sums(x.ways, x.asked, charges, slopes)
            rows += share.weight * int(x.labelled.sum())
        gradient -= share.weight * _by_parameter(share, by_move, by_time)
    curves = found[len(WEIGHTS) :].reshape(len(CURVES), len(KNOTS))
    step = np.diff(curves, axis=1)
    rough = np.zeros_like(curves)
    rough[:, 1:] += 2 * step
    rough[:, :-1] -= 2 * step
    kept = found if home is None else found - home
    kept = np.concatenate([kept[: len(WEIGHTS)] * _FREE, kept[len(WEIGHTS) :]])
    value = total / rows + pull * (SMALL * float((kept**2).sum()) + SMOOTH * float((step**2).sum()))
    pulled = 2 * SMALL * kept
    pulled[len(WEIGHTS) :] += SMOOTH * rough.ravel()
    return value, gradient / rows + pull * pulled


def likelihood(
    start: Floats, data: Sequence[Share], within: Limits = AT_LEAST_0, rounds: int = 120, pull: float = 1.0,
    home: Floats | None = None,
) -> Floats:  # fmt: skip
    """The weights within limits under which the labels are likeliest; see `loss`."""
    sums_of = _sums_of_steps(within.falling)
    scale = np.sqrt(sums_of.T @ _frequency(data, len(start)) + 1e-4)  # what seldom happens has a flat slope
    low, high = _steps(within.low, within), _steps(_HIGH, Limits(within.low, np.zeros_like(within.falling)))

    def scaled(z: Floats) -> tuple[float, Floats]:
        value, gradient = loss(sums_of @ (z / scale), data, pull, home)
        return value, sums_of.T @ gradient / scale

    found = minimize(
        scaled, _steps(start.clip(within.low, _HIGH), within).clip(low, high) * scale, jac=True, method="L-BFGS-B",
        bounds=list(zip(low * scale, high * scale, strict=True)),
        options={"maxiter": rounds, "maxcor": 30},
    )  # fmt: skip
    return np.asarray(sums_of @ (found.x / scale))


def _frequency(data: Sequence[Share], size: int) -> Floats:
    """About how often each parameter is charged in a row, squared."""
    out, rows = np.zeros(size), 0.0
    for share in data:
        b = share.book
        squared = Book(b.pad, b.lattices, b.counts**2, b.terms, b.facts, b.timed, b.action)
        by_move, by_time = np.zeros(len(b.terms)), np.zeros((MOST_MS + 1, len(b.timed)))
        for x in share.lattices[::3]:
            many = np.diff(x.first)
            each = np.repeat(1.0 / np.maximum(many, 1), many)
            np.add.at(by_move, x.move, each)
            np.add.at(by_time, (np.repeat(x.elapsed, many), b.facts[x.move]), each)
            rows += share.weight * len(x.elapsed)
        out += share.weight * _by_parameter(Share(squared, ()), by_move, by_time)
    return out / max(rows, 1.0)


def perceptron(
    start: Floats, data: Sequence[Share], within: Limits = AT_LEAST_0, rounds: int = 6, rate: float = 2e-3
) -> Floats:
    """The averaged weights after passes over all charts, some at once, in an order of chance."""
    found, mean, count = start.copy(), np.zeros_like(start), 0
    order = np.random.default_rng(1)
    some = [
        Share(share.book, share.lattices[at : at + _AT_ONCE], share.weight)
        for share in data
        for at in range(0, len(share.lattices), _AT_ONCE)
    ]
    for _ in range(rounds):
        for number in order.permutation(len(some)):
            found = np.clip(found - rate * _mistakes(some[number], found), within.low, _HIGH)
            found = _sums_of_steps(within.falling) @ _steps(found, within)
            mean += found
            count += 1
    return mean / count


def _mistakes(share: Share, found: Floats) -> Floats:
    """How much more often the labelled plays are charged for each parameter than the plays found, as the root of a
    row's.
    """
    cost, timed = _priced(share, found)
    by_move, by_time = np.zeros(len(share.book.terms)), np.zeros_like(timed)
    for x in share.lattices:
        each = 1.0 / np.sqrt(len(x.elapsed))
        for bound, sign in ((False, -each), (True, each)):
            path = _path(share.book, x, cost, timed, bound=bound)
            np.add.at(by_move, path, sign)
            np.add.at(by_time, (x.elapsed, share.book.facts[path]), sign)
    return share.weight * _by_parameter(share, by_move, by_time)


def _path(b: Book, x: Lattice, cost: Floats, timed: Floats, *, bound: bool) -> NDArray[np.int64]:
    mask = x.mask if bound else np.zeros_like(x.mask)
    return np.asarray(viterbi(x.ways, Asked(mask, x.value, x.skip), Charges(b.facts, b.action, cost, timed)))


def right(found: Floats, data: Iterable[Share]) -> dict[str, NDArray[np.bool_]]:
    """For each chart by name, which of its labelled rows have all feet right."""
    out = {}
    for share in data:
        cost, timed = _priced(share, found)
        for x in share.lattices:
            path = _path(share.book, x, cost, timed, bound=False)
            out[x.label.name] = (share.book.action[path] & x.mask == x.value)[x.labelled]
    return out
