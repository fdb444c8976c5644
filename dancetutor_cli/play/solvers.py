"""The solver's kernels, one for each model: each finds the cheapest way through rows, and what it needs for that."""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType
from typing import Any

from dancetutor_cli.play.explore import explorer
from dancetutor_cli.play.itg_moves import expand_itg
from dancetutor_cli.play.jit import door
from dancetutor_cli.play.kernel import advance, begin, margins, tell, trace, wait
from dancetutor_cli.play.store import DONE, FACTS_KNOWN, MORE_PATTERNS, MORE_TIMED, UNEXPLORED
from dancetutor_cli.play.thesis_moves import expand_thesis

TELL = -1  # instead of a row to start from
explore: Any = None  # a global of each solver's own; see `_solver`


def _solver(name: str, rules_of_model: Any) -> Any:
    """A solver for the rules of one model. It does all in one call, which takes as long as some hundred rows."""

    def solve(rows, start_row, t, nodes, making, found):  # type: ignore[no-untyped-def]
        """Go on from `start_row` to the end of the rows. Returns the row reached and what has no room, or DONE.

        From TELL on: write what the rows of `found.move` cost, and what happens in them, into `found`.
        """
        rules, out = making.rules, making.moves
        if start_row == TELL:
            wait(rows)
        else:
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
            if wanted != DONE:
                return row, wanted
            trace(t, nodes, found)
            if len(found.margin):
                wanted = margins(rows, t, nodes, found)
                if wanted != DONE:
                    return row, wanted
        if len(found.events):
            tell(t, rows, rules, found)
        return start_row, DONE

    own = FunctionType(solve.__code__, {**globals(), "explore": explorer(rules_of_model)}, name)
    own.__qualname__ = name
    return door(0, 2, 4, 5)(own)


Solver = Callable[..., tuple[int, int]]
solve_thesis: Solver = _solver("solve_thesis", expand_thesis)
solve_itg: Solver = _solver("solve_itg", expand_itg)
