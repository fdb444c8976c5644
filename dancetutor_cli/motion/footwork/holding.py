"""Holds: a foot that holds a panel may not leave it before the hold ends."""

from __future__ import annotations

from dataclasses import replace

from dancetutor_cli.motion.footwork.footing import Footing, FootState, Proposal
from dancetutor_cli.play.played import Limb

FORGOTTEN = 1.0  # seconds after which a hold that has ended is of no account


def hold(footing: Footing, limb: int, column: int, time: float, end: float) -> Proposal:
    """A limb holds a column from `time` to `end`, seconds; only feet are bound by it."""
    if limb >= Limb.LEFT_HAND:
        return Proposal(footing)
    foot: FootState = footing.feet[limb]
    holds = {c: e for c, e in foot.holds if e > time - FORGOTTEN} | {column: end}
    return Proposal(footing.with_foot(replace(foot, free=max(foot.free, end), holds=tuple(holds.items()))))
