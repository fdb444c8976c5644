"""Baking: a play in, a motion out, and what its quality is."""

from dancetutor_cli.bake.bake import bake, bake_plan, mines_of, plan_of, planned
from dancetutor_cli.bake.quality import Figure, MotionReport, report

__all__ = ["Figure", "MotionReport", "bake", "bake_plan", "mines_of", "plan_of", "planned", "report"]
