"""The solver's kernels, one for each model: each finds the cheapest way through rows, and what it needs for that."""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType
from typing import Any

import numpy as np

from dancetutor_cli.play.explore import explorer
from dancetutor_cli.play.itg_moves import expand_itg
from dancetutor_cli.play.jit import inner_kernel, kernel
from dancetutor_cli.play.kernel import advance, begin, margins, tell, trace, wait
from dancetutor_cli.play.store import (
    DONE,
    EDIT_COLUMN,
    EDIT_END,
    EDIT_MINE,
    EDIT_OF,
    EDIT_ROW,
    EDIT_STEP,
    EVENTS,
    FACTS_KNOWN,
    MORE_PATTERNS,
    MORE_TIMED,
    UNEXPLORED,
)
from dancetutor_cli.play.thesis_moves import expand_thesis
from dancetutor_cli.play.vocabulary import EVENTS as NAMES

TELL = -1  # instead of a row to start from
DOUBLESTEP = 1 << NAMES.index("doublestep")
explore: Any = None  # globals of each model's own; see `_way_finder` and `_solver`
find_way: Any = None


def _way_finder(rules_of_model: Any) -> Any:
    """What finds the cheapest way by the rules of one model."""

    def find_way(rows, start_row, t, nodes, making, found):  # type: ignore[no-untyped-def]
        """Go on from `start_row` to the end of the rows. Returns the row reached and what has no room, or DONE."""
        rules, out = making.rules, making.moves
        if start_row == 0 and not begin(rows, t, nodes, rules):
            return start_row, MORE_PATTERNS
        row, wanted = start_row, UNEXPLORED
        while wanted == UNEXPLORED:
            if t.counts[FACTS_KNOWN] > t.timed_cost.shape[1]:
                return row, MORE_TIMED
            row, wanted = advance(row, rows, t, nodes, rules, found.cost[len(found.cost) - 1])
            if wanted == UNEXPLORED:
                lacking = explore(row, rows.pattern, nodes.transition, t, rules, out)
                if lacking != DONE:
                    return row, lacking
        if wanted == DONE:
            trace(t, nodes, found)
        return row, wanted

    return inner_kernel(FunctionType(find_way.__code__, {**globals(), "explore": explorer(rules_of_model)}, "find_way"))


@inner_kernel
def _exchange(rows, edit):  # type: ignore[no-untyped-def]
    """Put what an edit says into its cell, and what was there into the edit."""
    r, p = edit[EDIT_ROW], edit[EDIT_COLUMN]
    step, end, mine = rows.steps[r, p], rows.hold_end[r, p], rows.mines[r, p]
    rows.steps[r, p], rows.hold_end[r, p], rows.mines[r, p] = edit[EDIT_STEP], edit[EDIT_END], edit[EDIT_MINE] != 0
    edit[EDIT_STEP], edit[EDIT_END], edit[EDIT_MINE] = step, end, mine


def _solver(name: str, rules_of_model: Any) -> Any:
    """A solver for the rules of one model. It does all in one call, which takes as long as some hundred rows."""

    def solve(rows, start, t, nodes, making, found):  # type: ignore[no-untyped-def]
        """Go on from the row `start` to the end of the rows. Returns the row reached and what has no room, or DONE.

        From TELL on: write what the rows of `found.move` cost, and what happens in them, into `found`.
        With edits: each is tried alone, from the `start`-th on; returns the first after which no doublestep is left in
        its row, or their number.
        """
        if len(found.edit):
            for number in range(start, len(found.edit)):
                edit = found.edit[number]
                nodes.transition[:] = -1
                _exchange(rows, edit)
                _, wanted = find_way(rows, np.int64(0), t, nodes, making, found)
                _exchange(rows, edit)
                if wanted != DONE or not t.wide[found.move[edit[EDIT_OF]], EVENTS] & DOUBLESTEP:
                    return number, wanted
            return len(found.edit), DONE
        if start == TELL:
            wait(rows)
        else:
            row, wanted = find_way(rows, start, t, nodes, making, found)
            if wanted == DONE and len(found.margin):
                wanted = margins(rows, t, nodes, found)
            if wanted != DONE:
                return row, wanted
        if len(found.events):
            tell(t, rows, making.rules, found)
        return start, DONE

    own = FunctionType(solve.__code__, {**globals(), "find_way": _way_finder(rules_of_model)}, name)
    own.__qualname__ = name
    return kernel(own, results=2)


Solver = Callable[..., tuple[int, int]]
solve_thesis: Solver = _solver("solve_thesis", expand_thesis)
solve_itg: Solver = _solver("solve_itg", expand_itg)
