"""Fit the presets itg and pump to the labelled feet, and show how good the fit is on unseen songs.

fit_weights.py                  the table, by method, and the presets are written (`make fit`)
fit_weights.py --dry-run        the table alone
fit_weights.py --resume         each fit begins where the preset is, with a fifth of the rounds
fit_weights.py --pins SONG.ssc ... --preset itg --out mine.yaml
                                a preset of one's own from the feet that an author has pinned
"""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import feet_data
import numpy as np
from feet_confidence import calibrated, chart_of_calibration, reliability
from feet_data import Labelled
from feet_fit import KNOTS, MOST, Floats, Limits, Share, fitted, likelihood, limits, part, perceptron, shares, vector
from feet_lattice import CURVES, WEIGHTS, with_values
from feet_patterns import load_patterns
from numpy.typing import NDArray

from dancetutor_cli.feet.preset import Preset, load_preset

HERE = Path(__file__).resolve().parent
PRESETS = HERE.parent / "configs" / "presets"
DOCS = HERE.parent / "docs"
LABEL, MADE, CONSENSUS = 20.0, 0.6, 0.1  # what rows count: of a label, of a made pattern, that two programs agree on
SHOWN, UNSHOWN = range(30), range(1000, 1040)  # seeds of made patterns that every fit sees, and that none does
WORSE = 0.15  # per cent of the rows of a set: a preset that loses more is not written
EVERY = 3  # of so many charts of the consensus one is looked at: they are many, and much alike
EVERY_UNSEEN = 9  # and so many, others, say how sure rows are
FOLDS = {"itg": 4, "pump": 5}
# no label on dance pads is a bracket after more than 0.4 s, and the consensus has programs' brackets there: people jump
AT_LEISURE = dict.fromkeys(("bracket", "bracket-again"), np.interp(KNOTS, [370, 500, 700], [0.0, 3.0, 3.7]))
# what one foot does twice in a row is never easier for being quicker: it belongs into the slowest gap of a run
SLOWEST_GAP = ("doublestep", "near-doublestep", "jack")
# no label on dance pads brackets while crossed, and these pads have no centre panel: it costs what other switches do
UNSEEN = {"twisted": MOST, "middle-switch": 2.0}
ROUNDS = 200  # of a fit from nothing; a fold begins where the fit of all ended
ROUNDS_OF_A_FOLD = 50
OWN_PULL = 300.0  # an author's pins are few: weights stay where they are unless many pins say otherwise


@dataclass(frozen=True)
class Task:
    """The data for one preset. judged : the sets on which it is scored; guard : rows that only keep it from drifting;

    made : patterns that every fit sees; unmade : such patterns that no fit sees; unseen : charts that no fit sees:
        they say how sure rows are, beside those that are judged; within : what its parameters may be
    """

    preset: str
    judged: list[Labelled]
    guard: list[Labelled]
    made: list[Labelled]
    unmade: list[Labelled]
    unseen: list[Labelled]
    within: Limits


def tasks() -> list[Task]:
    """Both presets and their labels."""
    floors = {**AT_LEISURE, **UNSEEN}
    guard, unseen = feet_data.load_consensus(EVERY), feet_data.load_consensus(EVERY_UNSEEN, 1)
    made, unmade = load_patterns(SHOWN), load_patterns(UNSHOWN)
    return [
        Task("itg", feet_data.load_dance(), guard, made, unmade, unseen, limits(floors, SLOWEST_GAP)),
        Task("pump", feet_data.load_pump(), [], [], [], [], limits({})),
    ]


def start_of(preset: Preset) -> Floats:
    """Where every fit begins, whatever the preset says today: all things cost much the same."""
    weights = dict.fromkeys(WEIGHTS, 50)
    return vector(with_values(preset, weights=weights, curves=dict.fromkeys(CURVES, ((0, 50),))))


def mixed(whole: Sequence[Share], task: Task, keep: set[str]) -> list[Share]:
    """The judged charts with some names, the guard and the made patterns."""
    guard = part(whole, {label.name for label in task.guard}, CONSENSUS)
    made = part(whole, {label.name for label in task.made}, MADE)
    return [*part(whole, keep, LABEL if guard else 1.0), *guard, *made]


Outcome = list[tuple[Labelled, NDArray[np.bool_], NDArray[np.int64]]]  # chart, right rows, their margins


def outcome(labels: Sequence[Labelled], preset: Preset) -> Outcome:
    """The feet of charts with a preset, by the solver that the program uses."""
    out = []
    for label in labels:
        right, found = feet_data.right_rows(label, preset, margins=True)
        assert found.margin is not None
        out.append((label, right, found.margin[np.unique(label.row)]))
    return out


def fit_of_all(task: Task, home: Preset, *, resume: bool = False) -> tuple[list[Share], Floats]:
    """All charts of a task as graphs, and the weights under which their labels are likeliest.

    resume : whether to look for these near the weights of the preset, in a fifth of the rounds
    """
    whole = shares([*task.judged, *task.guard, *task.made], home)
    everything = mixed(whole, task, {label.name for label in task.judged})
    begin, rounds = (vector(home), ROUNDS // 5) if resume else (start_of(home), ROUNDS)
    return whole, likelihood(begin, everything, task.within, rounds)


def cross_validated(task: Task, whole: Sequence[Share], home: Preset, begin: Floats | None = None) -> Outcome:
    """Every judged chart, scored by a fit that has not seen its song.

    begin : where the fits by likelihood begin, near where they end; None: fits by the perceptron, from nothing
    """
    fold = feet_data.folds(task.judged, FOLDS[task.preset])
    out: Outcome = []
    for number in range(FOLDS[task.preset]):
        seen = {label.name for label, own in zip(task.judged, fold, strict=True) if own != number}
        data = mixed(whole, task, seen)
        found = (
            perceptron(start_of(home), data, task.within)
            if begin is None
            else likelihood(begin, data, task.within, ROUNDS_OF_A_FOLD)
        )
        unseen = [label for label, own in zip(task.judged, fold, strict=True) if own == number]
        out += outcome(unseen, fitted(home, found))
    return out


def percent(results: Outcome) -> dict[str, tuple[int, int]]:
    """Right rows and rows by kind."""
    out: dict[str, tuple[int, int]] = {}
    for label, right, _ in results:
        good, rows = out.get(label.kind, (0, 0))
        out[label.kind] = (good + int(right.sum()), rows + len(right))
    return out


def told(title: str, results: Outcome) -> None:
    """One line of the table."""
    cells = [f"{kind} {100 * a / b:.2f} % of {b:,}" for kind, (a, b) in sorted(percent(results).items())]
    print(f"  {title:<42}", "; ".join(cells), flush=True)


def refreshed(text: str, preset: Preset, confidence: dict[int, int] | None) -> str:
    """The YAML of a preset with other numbers; its comments stay."""
    for name, value in preset.weights:
        text = re.sub(rf"(?m)^(  {name}: )\d+", rf"\g<1>{value}", text)
    for name, curve in preset.curves:
        knots = ", ".join(f"{ms}: {cost}" for ms, cost in curve)
        text = re.sub(rf"(?m)^(  {name}: )\{{.*?\}}", rf"\g<1>{{{knots}}}", text)
    if confidence is not None:
        knots = ", ".join(f"{margin}: {value}" for margin, value in confidence.items())
        text = re.sub(r"(?m)^(confidence: )\{.*?\}", rf"\g<1>{{{knots}}}", text)
    return text


def own_preset(pins: Sequence[Labelled], home: Preset, source: str) -> str:
    """The YAML of a preset that extends another by what an author's pins say."""
    before = vector(home)
    after = likelihood(before, shares(pins, home), pull=OWN_PULL, home=before)
    new, old = fitted(home, after), fitted(home, before)
    weights = [f"  {name}: {a}" for (name, a), (_, b) in zip(new.weights, old.weights, strict=True) if a != b]
    curves = [
        f"  {name}: {{{', '.join(f'{ms}: {cost}' for ms, cost in a)}}}"
        for (name, a), (_, b) in zip(new.curves, old.curves, strict=True)
        if a != b
    ]
    groups = (["weights:", *weights] if weights else []) + (["curves:", *curves] if curves else [])
    told(f"{source}, pinned rows", outcome(pins, home))
    told("with the new preset", outcome(pins, new))
    return "\n".join([f"extends: {source}", *groups, ""])


def how_sure(unseen: Outcome) -> tuple[dict[int, int], list[tuple[float, float, int]]]:
    """A preset's `confidence` from charts that its fits had not seen, and the table of how true it is."""
    return calibrated(unseen), reliability(unseen, feet_data.folds)


def losses(new: Mapping[str, tuple[int, int]], old: Mapping[str, tuple[int, int]]) -> list[str]:
    """The sets, by `percent`, of which a new preset has clearly fewer rows right than the present one."""
    share = {kind: (100 * a / rows, 100 * old[kind][0] / rows) for kind, (a, rows) in new.items()}
    return [f"{kind} {a:.2f} % ({b:.2f} % today)" for kind, (a, b) in share.items() if a < b - WORSE]


def fit_all(write: bool, only: str | None, *, both: bool, resume: bool = False) -> None:
    """The table, and the presets that are no worse than today's.

    both : with the perceptron, of which nothing is written; resume : see `fit_of_all`
    """
    for task in tasks():
        if only not in (None, task.preset):
            continue
        home, began = load_preset(task.preset), time.process_time()
        print(f"{task.preset}: rows right")
        every = [*task.judged, *task.guard, *task.unmade]
        told("before, the preset as it is", before := outcome(every, home))
        whole, found = fit_of_all(task, home, resume=resume)
        held_out = cross_validated(task, whole, home, found)
        told("likelihood, songs not seen", held_out)
        preset = fitted(home, found)
        told("likelihood, fitted to all of it", after := outcome(every, preset))
        lost = losses(percent(after), percent(before))
        confidence, table = how_sure([*held_out, *outcome(task.unseen, preset)])
        print("  confidence on folds not calibrated with (said, right, rows):")
        print("   ", "; ".join(f"{said:.1f} {right:.1f} {rows:,}" for said, right, rows in table), flush=True)
        if lost:
            print(f"  {task.preset} stays as it is: the new one has fewer rows right, {'; '.join(lost)}")
        elif write:
            path = PRESETS / f"{task.preset}.yaml"
            path.write_text(refreshed(path.read_text(encoding="utf-8"), preset, confidence), encoding="utf-8")
            DOCS.mkdir(exist_ok=True)
            picture = chart_of_calibration(task.preset, table)
            (DOCS / f"calibration-{task.preset}.svg").write_text(picture, encoding="utf-8")
        if both:
            told("perceptron, songs not seen", cross_validated(task, whole, home))
        print(f"  {time.process_time() - began:.0f} s of processor time", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description="Fit the weights of the presets to labelled feet.")
    parser.add_argument("--dry-run", action="store_true", help="print the table, write nothing")
    parser.add_argument("--resume", action="store_true", help="begin where the presets are, with a fifth of the rounds")
    parser.add_argument("--likelihood", action="store_true", help="leave the perceptron out of the table")
    parser.add_argument("--only", choices=FOLDS, help="one of the presets")
    parser.add_argument("--pins", nargs="+", type=Path, metavar="FILE", help="chart files with an author's pins")
    parser.add_argument("--preset", default="itg", help="what the author's preset extends")
    parser.add_argument("--out", type=Path, help="the author's preset")
    arguments = parser.parse_args()
    if not arguments.pins:
        if not (feet_data.FEET / "labels.json").is_file():
            sys.exit("there are no labels in ../shared/data/feet: nothing to fit to")
        fit_all(not arguments.dry_run, arguments.only, both=not arguments.likelihood, resume=arguments.resume)
        return
    pins = feet_data.load_pins(arguments.pins)
    if not pins:
        sys.exit("no feet are pinned in these files; see `dancetutor annotate --help` for pins")
    text = own_preset(pins, load_preset(arguments.preset), arguments.preset)
    if arguments.out:
        arguments.out.write_text(text, encoding="utf-8")
    else:
        print(text, end="")


if __name__ == "__main__":
    main()
