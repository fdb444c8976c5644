"""From a play to a plan: when each foot leaves and lands, where, and how it is turned. One rule to a module.

A rule is asked about a row (or a wait) and the footing as it is, changes neither, and returns what it proposes: another
footing (`footing.Proposal`) or a walk (`walks.WalkProposal`). Only `planner` and `insertion` apply a proposal.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from dancetutor_cli.motion.footwork.insertion import with_shakes, with_walks
from dancetutor_cli.motion.footwork.planner import Planner
from dancetutor_cli.motion.footwork.shaking import leg_shakes

if TYPE_CHECKING:
    from dancetutor_cli.motion.context import Context
    from dancetutor_cli.motion.plan import Plan
    from dancetutor_cli.play.played import Play

__all__ = ["plan_footwork"]


def plan_footwork(play: Play, second: Callable[[int], float], gait: str, context: Context) -> Plan:
    """What both feet and hands do in a song.

    second : seconds of the music at a tick; gait : how she walks, a name or file as for `gait.load_gait`
    Raises DancetutorError if the play has no steps.
    """
    plan = Planner(play, second, context).run()
    mines = play.rows.second[play.rows.mines.any(axis=1)]
    plan = with_walks(plan, mines, gait, context)
    return with_shakes(plan, leg_shakes(plan, mines, context))
